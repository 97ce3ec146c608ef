//! What stands on one line whatever its length: names, literals, references, expressions, and whole elements where
//! there is room.

use std::borrow::Cow;

use crate::elementary::Elementary;
use crate::frontend::text::literals::UNITS;
use crate::frontend::text::token::is_plain_name;
use crate::ladder::{
    Argument, BinaryOperator, BlockCall, Branch, CaseLabel, Circuit, CoilKind, ContactKind, Element, ElementKind,
    Expression, ExpressionKind, Literal, Name, Reference, Root, Setting, Statement, StatementKind, Step, Task,
    TypeReference, UnaryOperator, Wire,
};

/// A name, in back quotes if it needs them.
pub(super) fn name(text: &str) -> Cow<'_, str> {
    if is_plain_name(text) {
        return Cow::Borrowed(text);
    }
    let spelled = text.replace('`', "'").replace(['\n', '\r'], " ");
    Cow::Owned(format!("`{spelled}`"))
}

/// A title in quotes, with escapes for what cannot stand between them.
pub(super) fn title(text: &str) -> String {
    let mut quoted = String::from("\"");
    for character in text.chars() {
        match character {
            '"' => quoted.push_str("$\""),
            '$' => quoted.push_str("$$"),
            '\n' => quoted.push_str("$N"),
            '\r' => quoted.push_str("$R"),
            '\t' => quoted.push_str("$T"),
            control if control.is_control() => quoted.push_str(&format!("${:04X}", u32::from(control))),
            other => quoted.push(other),
        }
    }
    quoted.push('"');
    quoted
}

pub(super) fn reference(reference: &Reference) -> String {
    let (mut text, mut dot) = match &reference.root {
        Root::Name(root) => (name(&root.text).into_owned(), "."),
        // Touching, the bit would be one more number of the address.
        Root::Address(root) => (root.to_string(), " ."),
    };
    for step in &reference.steps {
        if !matches!(step, Step::Index(..)) {
            text.push_str(dot);
        }
        dot = ".";
        match step {
            Step::Member(member) => text.push_str(&name(&member.text)),
            Step::Bit(bit, _) => text.push_str(&bit.to_string()),
            Step::Index(indices, _) => {
                let indices: Vec<String> = indices.iter().map(expression).collect();
                text.push_str(&format!("[{}]", indices.join(", ")));
            }
        }
    }
    text
}

pub(super) fn expression(expression: &Expression) -> String {
    let mut text = String::new();
    push_expression(&mut text, expression);
    text
}

fn push_expression(text: &mut String, expression: &Expression) {
    match &expression.kind {
        ExpressionKind::Literal(value) => text.push_str(&literal(value)),
        ExpressionKind::Read(read) => text.push_str(&reference(read)),
        ExpressionKind::Unary(operator, operand) => {
            text.push_str(match operator {
                UnaryOperator::Not => "NOT ",
                UnaryOperator::Negate => "-",
            });
            // Two minus signs would start a comment.
            let minus = *operator == UnaryOperator::Negate && starts_with_minus(operand);
            push_operand(text, operand, minus || matches!(operand.kind, ExpressionKind::Binary(..)));
        }
        ExpressionKind::Binary(operator, left, right) => {
            push_operand(text, left, precedence(left) < operator.precedence());
            text.push(' ');
            text.push_str(operator.symbol());
            text.push(' ');
            push_operand(text, right, precedence(right) <= operator.precedence());
        }
        ExpressionKind::Call { function, arguments } => {
            text.push_str(&function_name(&function.text));
            text.push('(');
            for (index, argument) in arguments.iter().enumerate() {
                text.push_str(if index == 0 { "" } else { ", " });
                if let Some(parameter) = &argument.parameter {
                    text.push_str(&name(&parameter.text));
                    text.push_str(" := ");
                }
                push_expression(text, &argument.value);
            }
            text.push(')');
        }
        ExpressionKind::Array(items) => {
            text.push('[');
            for (index, item) in items.iter().enumerate() {
                text.push_str(if index == 0 { "" } else { ", " });
                match (&item.repeat, &item.value) {
                    (None, Some(value)) => push_expression(text, value),
                    (repeat, value) => {
                        // A name before the parenthesis would be that of a function.
                        let bare = |repeat: &Expression| matches!(repeat.kind, ExpressionKind::Literal(_));
                        repeat.iter().for_each(|repeat| push_operand(text, repeat, !bare(repeat)));
                        text.push('(');
                        value.iter().for_each(|value| push_expression(text, value));
                        text.push(')');
                    }
                }
            }
            text.push(']');
        }
        ExpressionKind::Structure(members) => {
            text.push('(');
            for (index, member) in members.iter().enumerate() {
                text.push_str(if index == 0 { "" } else { ", " });
                text.push_str(&name(&member.member.text));
                text.push_str(" := ");
                push_expression(text, &member.value);
            }
            text.push(')');
        }
    }
}

/// Operators that are functions too need no back quotes, but NOT, which before a parenthesis is always the operator.
fn function_name(text: &str) -> Cow<'_, str> {
    let operator = ["AND", "OR", "XOR", "MOD"].iter().any(|word| text.eq_ignore_ascii_case(word));
    if operator { Cow::Borrowed(text) } else { name(text) }
}

fn push_operand(text: &mut String, operand: &Expression, parentheses: bool) {
    if parentheses {
        text.push('(');
    }
    push_expression(text, operand);
    if parentheses {
        text.push(')');
    }
}

/// How tightly the outermost operator binds; what has none binds tightest.
fn precedence(expression: &Expression) -> u8 {
    match &expression.kind {
        ExpressionKind::Binary(operator, ..) => operator.precedence(),
        _ => BinaryOperator::Multiply.precedence() + 1,
    }
}

fn starts_with_minus(expression: &Expression) -> bool {
    match &expression.kind {
        ExpressionKind::Unary(operator, _) => *operator == UnaryOperator::Negate,
        ExpressionKind::Literal(Literal::Real { value, ty: None }) => value.is_sign_negative(),
        _ => false,
    }
}

pub(in crate::frontend) fn literal(literal: &Literal) -> String {
    let typed = |ty: &Option<_>, digits: String| match ty {
        Some(ty) => format!("{ty}#{digits}"),
        None => digits,
    };
    match literal {
        Literal::Bool(true) => "TRUE".to_owned(),
        Literal::Bool(false) => "FALSE".to_owned(),
        Literal::Integer { value, base, ty } => typed(
            ty,
            match base {
                2 => format!("2#{:b}", value.get()),
                8 => format!("8#{:o}", value.get()),
                16 => format!("16#{:X}", value.get()),
                _ => value.get().to_string(),
            },
        ),
        Literal::Real { value, ty } => typed(ty, real(*value)),
        Literal::Time(nanoseconds) => duration(*nanoseconds),
        Literal::Enumerated { ty, value } => {
            // Bare, the name of an elementary type would begin another kind of literal.
            let elementary = Elementary::from_name(&ty.text).is_some();
            let ty = if elementary { format!("`{}`", ty.text).into() } else { name(&ty.text) };
            format!("{ty}#{}", name(&value.text))
        }
    }
}

/// The shortest digits that give the value again, always with a point.
fn real(value: f64) -> String {
    let digits = format!("{value:?}");
    match digits.split_once('e') {
        Some((mantissa, exponent)) if !mantissa.contains('.') => format!("{mantissa}.0e{exponent}"),
        _ => digits,
    }
}

fn duration(nanoseconds: i64) -> String {
    let mut text = String::from(if nanoseconds < 0 { "T#-" } else { "T#" });
    let mut rest = nanoseconds.unsigned_abs();
    for (unit, size) in UNITS {
        if rest >= size {
            text.push_str(&format!("{}{unit}", rest / size));
            rest %= size;
        }
    }
    if nanoseconds == 0 {
        text.push_str("0s");
    }
    text
}

/// A rung's node, `>name>`.
pub(super) fn node(text: &str) -> String {
    format!(">{}>", name(text))
}

/// Whether a branch has to say that it is a wire: without elements it would otherwise start at its node.
pub(super) fn is_bare_feed(branch: &Branch) -> bool {
    branch.from.is_none() && branch.elements.is_empty() && branch.to.is_some()
}

/// `array [0..9, 1..3] of INT`
pub(super) fn type_reference(ty: &TypeReference) -> String {
    let name = name(&ty.name.text);
    if ty.dimensions.is_empty() {
        return name.into_owned();
    }
    let dimensions: Vec<String> = ty
        .dimensions
        .iter()
        .map(|dimension| format!("{}..{}", expression(&dimension.first), expression(&dimension.last)))
        .collect();
    format!("array [{}] of {name}", dimensions.join(", "))
}

/// ` := value`, if there is one.
pub(super) fn initial(value: Option<&Expression>) -> String {
    value.map_or(String::new(), |value| format!(" := {}", expression(value)))
}

/// ` with task`, if there is one.
pub(super) fn with_task(task: Option<&Name>) -> String {
    task.map_or(String::new(), |task| format!(" with {}", name(&task.text)))
}

/// `hreg := 64, timers := 128`
pub(super) fn settings(settings: &[Setting]) -> String {
    let settings: Vec<String> = settings
        .iter()
        .map(|setting| format!("{} := {}", name(&setting.name.text), expression(&setting.value)))
        .collect();
    settings.join(", ")
}

/// `task fast(interval := T#10ms, priority := 1)`
pub(super) fn task(task: &Task) -> String {
    let interval = task.interval.as_ref().map(|interval| format!("interval := {}", expression(interval)));
    let priority = task.priority.as_ref().map(|priority| format!("priority := {}", expression(priority)));
    let settings: Vec<String> = interval.into_iter().chain(priority).collect();
    let name = name(&task.name.text);
    if settings.is_empty() { format!("task {name}") } else { format!("task {name}({})", settings.join(", ")) }
}

/// A label of a CASE.
pub(super) fn label(label: &CaseLabel) -> String {
    match &label.last {
        Some(last) => format!("{}..{}", expression(&label.first), expression(last)),
        None => expression(&label.first),
    }
}

/// A statement without statements in it, on one line; `None` for one with them.
pub(super) fn simple_statement(statement: &Statement) -> Option<String> {
    Some(match &statement.kind {
        StatementKind::Assignment { target, value } => format!("{} := {};", reference(target), expression(value)),
        StatementKind::Call(call) => {
            let arguments: Vec<String> = call.arguments.iter().map(argument).collect();
            format!("{}{}{};", statement_head(call), arguments.join(", "), block_tail(call))
        }
        StatementKind::Exit => "EXIT;".to_owned(),
        StatementKind::Return => "RETURN;".to_owned(),
        StatementKind::If { .. } | StatementKind::Case { .. } | StatementKind::For { .. } => return None,
    })
}

/// The start of a call that is a statement. There NOT before a parenthesis is the operator.
pub(super) fn statement_head(call: &BlockCall) -> String {
    match call.instance.as_name() {
        Some(function) if call.type_name.is_none() => format!("{}(", function_name(&function.text)),
        _ => block_head(call),
    }
}

/// An argument on one line.
pub(super) fn argument(argument: &Argument) -> String {
    match &argument.wire {
        Wire::Value(value) if argument.pin.text.is_empty() => expression(value),
        Wire::Circuit(circuit) => {
            let mut text = format!("{} := ", name(&argument.pin.text));
            // A circuit that is too long for a line ends where the line does.
            let _ = push_circuit(&mut text, circuit);
            text
        }
        _ => simple_argument(argument).unwrap_or_default(),
    }
}

/// `instance:TYPE(`
pub(super) fn block_head(call: &BlockCall) -> String {
    let operator =
        |name: &&Name| ["AND", "OR", "XOR", "NOT", "MOD"].iter().any(|word| name.text.eq_ignore_ascii_case(word));
    let instance = match call.instance.as_name().filter(operator) {
        Some(function) if call.type_name.is_none() => function.text.to_string(),
        _ => reference(&call.instance),
    };
    match &call.type_name {
        Some(type_name) => format!("{instance}:{}(", name(&type_name.text)),
        None => format!("{instance}("),
    }
}

/// `).Q`
pub(super) fn block_tail(call: &BlockCall) -> String {
    call.power_output.as_ref().map_or(")".to_owned(), |output| format!(").{}", name(&output.text)))
}

/// An argument that is no circuit; `None` for one that is.
pub(super) fn simple_argument(argument: &Argument) -> Option<String> {
    let pin = name(&argument.pin.text);
    match &argument.wire {
        Wire::Value(value) => Some(format!("{pin} := {}", expression(value))),
        Wire::Output(target) => Some(format!("{pin} => {}", reference(target))),
        Wire::Circuit(_) => None,
    }
}

/// A contact, a coil, braces or a jump; `None` for what has circuits or arguments in it.
pub(super) fn simple_element(element: &Element) -> Option<String> {
    Some(match &element.kind {
        ElementKind::Contact { kind, operand } => {
            let sign = match kind {
                ContactKind::Open => "",
                ContactKind::Closed => "/",
                ContactKind::Rising => "^",
                ContactKind::Falling => "^/",
            };
            format!("{sign}{}", expression(operand))
        }
        ElementKind::Coil { kind, target } => {
            let sign = match kind {
                CoilKind::Plain => "",
                CoilKind::Negated => "/",
                CoilKind::Set => "S ",
                CoilKind::Reset => "R ",
                CoilKind::Rising => "P ",
                CoilKind::Falling => "N ",
            };
            format!("({sign}{})", reference(target))
        }
        ElementKind::Condition(condition) => format!("{{{}}}", expression(condition)),
        ElementKind::Assignment { target, value } => format!("{{{} := {}}}", reference(target), expression(value)),
        ElementKind::Jump { target } => {
            // Bare, this name would leave the program.
            let is_return = target.text.eq_ignore_ascii_case("return");
            format!(">> {}", if is_return { format!("`{}`", target.text).into() } else { name(&target.text) })
        }
        ElementKind::Return => ">> return".to_owned(),
        ElementKind::Statements(statements) => match statements.as_slice() {
            [] => "{;}".to_owned(),
            [statement] => format!("{{{}}}", simple_statement(statement)?),
            _ => return None,
        },
        ElementKind::Block(_) | ElementKind::Parallel(_) => return None,
    })
}

/// Bytes after which an element is certainly too wide for a line, so that trying costs little at every level.
const LONGEST_LINE: usize = 4 * super::LINE_WIDTH;

/// A circuit in brackets on one line; `None` if it is too long.
pub(super) fn short_circuit(circuit: &Circuit) -> Option<String> {
    let mut text = String::new();
    push_circuit(&mut text, circuit)?;
    Some(text)
}

/// An element on one line; `None` if it is too long.
pub(super) fn short_element(element: &Element) -> Option<String> {
    let mut text = String::new();
    push_element(&mut text, element)?;
    Some(text)
}

fn push_element(text: &mut String, element: &Element) -> Option<()> {
    match &element.kind {
        ElementKind::Parallel(circuit) => push_circuit(text, circuit)?,
        ElementKind::Block(call) => {
            text.push_str(&block_head(call));
            for (index, argument) in call.arguments.iter().enumerate() {
                text.push_str(if index == 0 { "" } else { ", " });
                match &argument.wire {
                    Wire::Circuit(circuit) => {
                        text.push_str(&name(&argument.pin.text));
                        text.push_str(" := ");
                        push_circuit(text, circuit)?;
                    }
                    _ => text.push_str(&simple_argument(argument)?),
                }
                still_short(text)?;
            }
            text.push_str(&block_tail(call));
        }
        _ => text.push_str(&simple_element(element)?),
    }
    still_short(text)
}

fn push_circuit(text: &mut String, circuit: &Circuit) -> Option<()> {
    text.push('[');
    for (index, branch) in circuit.branches.iter().enumerate() {
        text.push_str(if index == 0 { "" } else { " |" });
        if let Some(from) = &branch.from {
            text.push(' ');
            text.push_str(&node(&from.text));
        }
        if is_bare_feed(branch) {
            text.push_str(" -");
        }
        for element in &branch.elements {
            text.push(' ');
            push_element(text, element)?;
        }
        if let Some(to) = &branch.to {
            text.push(' ');
            text.push_str(&node(&to.text));
        }
        still_short(text)?;
    }
    text.push_str(" ]");
    Some(())
}

fn still_short(text: &str) -> Option<()> {
    (text.len() <= LONGEST_LINE).then_some(())
}
