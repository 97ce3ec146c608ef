//! What stands on one line: references, expressions, types, and statements with what is in them.

use super::names::Names;
use crate::frontend::native::print::words::literal;
use crate::ladder::functions::{Function, StandardFunction};
use crate::ladder::{
    Argument, BinaryOperator, BlockCall, Expression, ExpressionKind, Literal, Reference, Root, Statement,
    StatementKind, Step, TypeReference, UnaryOperator, Wire,
};

/// Writes words with the names of a program.
#[derive(Clone, Copy)]
pub(in crate::frontend) struct Words<'a> {
    pub(in crate::frontend) names: &'a Names,
}

impl Words<'_> {
    pub(in crate::frontend) fn reference(self, reference: &Reference) -> String {
        let mut text = match &reference.root {
            Root::Name(name) => self.names.spell(&name.text).into_owned(),
            Root::Address(address) => address.to_string(),
        };
        for step in &reference.steps {
            match step {
                Step::Member(member) => text.push_str(&format!(".{}", self.names.spell(&member.text))),
                // Touching, the bit would be one more number of the address.
                Step::Bit(bit, _) if matches!(reference.root, Root::Address(_)) => text.push_str(&format!(" .{bit}")),
                Step::Bit(bit, _) => text.push_str(&format!(".{bit}")),
                Step::Index(indices, _) => text.push_str(&format!("[{}]", self.list(indices.iter()))),
            }
        }
        text
    }

    fn list<'e>(self, expressions: impl Iterator<Item = &'e Expression>) -> String {
        expressions.map(|one| self.expression(one)).collect::<Vec<_>>().join(", ")
    }

    pub(in crate::frontend) fn expression(self, expression: &Expression) -> String {
        let mut text = String::new();
        self.push(&mut text, expression);
        text
    }

    fn push(self, text: &mut String, expression: &Expression) {
        match &expression.kind {
            ExpressionKind::Literal(Literal::Enumerated { ty, value }) => {
                text.push_str(&format!("{}#{}", self.names.spell(&ty.text), self.names.spell(&value.text)));
            }
            ExpressionKind::Literal(value) => text.push_str(&literal(value)),
            ExpressionKind::Read(read) => text.push_str(&self.reference(read)),
            ExpressionKind::Unary(operator, operand) => {
                text.push_str(match operator {
                    UnaryOperator::Not => "NOT ",
                    UnaryOperator::Negate => "-",
                });
                let bare = matches!(operand.kind, ExpressionKind::Read(_) | ExpressionKind::Call { .. })
                    || matches!(&operand.kind, ExpressionKind::Literal(value) if !literal(value).starts_with('-'));
                self.push_operand(text, operand, !bare);
            }
            ExpressionKind::Binary(operator, left, right) => {
                self.push_operand(text, left, precedence(left) < operator.precedence());
                text.push_str(&format!(" {} ", operator.symbol()));
                self.push_operand(text, right, precedence(right) <= operator.precedence());
            }
            // Before a parenthesis it is the operator, which names no parameter.
            ExpressionKind::Call { function, arguments } if function.key() == "not" && arguments.len() == 1 => {
                text.push_str("NOT ");
                arguments.iter().for_each(|argument| self.push_operand(text, &argument.value, true));
            }
            ExpressionKind::Call { function, arguments } => {
                text.push_str(&format!("{}(", self.names.spell_function(&function.text)));
                for (index, argument) in arguments.iter().enumerate() {
                    text.push_str(if index == 0 { "" } else { ", " });
                    if let Some(parameter) = &argument.parameter {
                        text.push_str(&format!("{} := ", self.names.spell(&parameter.text)));
                    }
                    self.push(text, &argument.value);
                }
                text.push(')');
            }
            ExpressionKind::Array(items) => {
                text.push('[');
                for (index, item) in items.iter().enumerate() {
                    text.push_str(if index == 0 { "" } else { ", " });
                    if let Some(repeat) = &item.repeat {
                        self.push_operand(text, repeat, !matches!(repeat.kind, ExpressionKind::Literal(_)));
                        text.push('(');
                    }
                    item.value.iter().for_each(|value| self.push(text, value));
                    text.push_str(if item.repeat.is_some() { ")" } else { "" });
                }
                text.push(']');
            }
            ExpressionKind::Structure(members) => {
                text.push('(');
                for (index, member) in members.iter().enumerate() {
                    text.push_str(if index == 0 { "" } else { ", " });
                    text.push_str(&format!("{} := ", self.names.spell(&member.member.text)));
                    self.push(text, &member.value);
                }
                text.push(')');
            }
        }
    }

    fn push_operand(self, text: &mut String, operand: &Expression, parentheses: bool) {
        text.push_str(if parentheses { "(" } else { "" });
        self.push(text, operand);
        text.push_str(if parentheses { ")" } else { "" });
    }

    pub(in crate::frontend) fn type_reference(self, ty: &TypeReference) -> String {
        let name = self.names.spell_type(&ty.name.text);
        if ty.dimensions.is_empty() {
            return name.into_owned();
        }
        let bounds =
            ty.dimensions.iter().map(|one| format!("{}..{}", self.expression(&one.first), self.expression(&one.last)));
        format!("ARRAY [{}] OF {name}", bounds.collect::<Vec<_>>().join(", "))
    }

    /// ` := value`, if there is one.
    pub(in crate::frontend) fn initial(self, value: Option<&Expression>) -> String {
        value.map_or(String::new(), |value| format!(" := {}", self.expression(value)))
    }

    /// Statements, each line with its indent.
    pub(in crate::frontend) fn statements(
        self,
        list: &[Statement],
        indent: usize,
        text: &mut String,
        is_function: &dyn Fn(&BlockCall) -> bool,
    ) {
        let pad = "  ".repeat(indent);
        for statement in list {
            match &statement.kind {
                StatementKind::Assignment { target, value } => {
                    text.push_str(&format!("{pad}{} := {};\n", self.reference(target), self.expression(value)));
                }
                StatementKind::Call(call) if is_function(call) => {
                    let enable = pin(call, "EN").and_then(|argument| match &argument.wire {
                        Wire::Value(value) => Some(self.expression(value)),
                        _ => None,
                    });
                    let line = format!("{};", self.function_box(call));
                    let not_enabled = self
                        .not_enabled(call)
                        .map_or(String::new(), |otherwise| format!("{pad}ELSE\n{pad}  {otherwise}\n"));
                    match enable {
                        Some(enable) => {
                            text.push_str(&format!("{pad}IF {enable} THEN\n{pad}  {line}\n{not_enabled}{pad}END_IF;\n"))
                        }
                        None => text.push_str(&format!("{pad}{line}\n")),
                    }
                }
                StatementKind::Call(call) => {
                    let arguments: Vec<String> = call.arguments.iter().filter_map(|one| self.argument(one)).collect();
                    text.push_str(&format!("{pad}{}({});\n", self.reference(&call.instance), arguments.join(", ")));
                }
                StatementKind::If { branches, otherwise } => {
                    for (index, branch) in branches.iter().enumerate() {
                        let word = if index == 0 { "IF" } else { "ELSIF" };
                        text.push_str(&format!("{pad}{word} {} THEN\n", self.expression(&branch.condition)));
                        self.body(&branch.body, indent + 1, text, is_function);
                    }
                    if !otherwise.is_empty() {
                        text.push_str(&format!("{pad}ELSE\n"));
                        self.statements(otherwise, indent + 1, text, is_function);
                    }
                    text.push_str(&format!("{pad}END_IF;\n"));
                }
                StatementKind::Case { selector, branches, otherwise } => {
                    text.push_str(&format!("{pad}CASE {} OF\n", self.expression(selector)));
                    for branch in branches {
                        let labels = branch.labels.iter().map(|label| match &label.last {
                            Some(last) => format!("{}..{}", self.expression(&label.first), self.expression(last)),
                            None => self.expression(&label.first),
                        });
                        text.push_str(&format!("{pad}  {}:\n", labels.collect::<Vec<_>>().join(", ")));
                        self.body(&branch.body, indent + 2, text, is_function);
                    }
                    if !otherwise.is_empty() {
                        text.push_str(&format!("{pad}ELSE\n"));
                        self.statements(otherwise, indent + 1, text, is_function);
                    }
                    text.push_str(&format!("{pad}END_CASE;\n"));
                }
                StatementKind::For { variable, first, last, step, body } => {
                    let step = step.as_ref().map_or(String::new(), |step| format!(" BY {}", self.expression(step)));
                    text.push_str(&format!(
                        "{pad}FOR {} := {} TO {}{step} DO\n",
                        self.reference(variable),
                        self.expression(first),
                        self.expression(last)
                    ));
                    self.body(body, indent + 1, text, is_function);
                    text.push_str(&format!("{pad}END_FOR;\n"));
                }
                StatementKind::Exit => text.push_str(&format!("{pad}EXIT;\n")),
                StatementKind::Return => text.push_str(&format!("{pad}RETURN;\n")),
            }
        }
    }

    /// Statements where there has to be one.
    fn body(self, list: &[Statement], indent: usize, text: &mut String, is_function: &dyn Fn(&BlockCall) -> bool) {
        if list.is_empty() {
            text.push_str(&format!("{};\n", "  ".repeat(indent)));
        }
        self.statements(list, indent, text, is_function);
    }

    /// `IN := a`, `Q => b`; `None` for a circuit, which is no word.
    pub(in crate::frontend) fn argument(self, argument: &Argument) -> Option<String> {
        let pin = self.names.spell(&argument.pin.text);
        Some(match &argument.wire {
            Wire::Value(value) if argument.pin.text.is_empty() => self.expression(value),
            Wire::Value(value) => format!("{} := {}", spell_pin(&argument.pin.text, &pin), self.expression(value)),
            Wire::Output(target) => format!("{} => {}", spell_pin(&argument.pin.text, &pin), self.reference(target)),
            Wire::Circuit(_) => return None,
        })
    }

    /// `c := ADD(a, b)`: a box of a function without its EN.
    pub(in crate::frontend) fn function_box(self, call: &BlockCall) -> String {
        let name = call.instance.as_name().map_or("", |name| name.text.as_str());
        let is_result = |argument: &&Argument| {
            let pin = &argument.pin.text;
            matches!(argument.wire, Wire::Output(_))
                && (pin.eq_ignore_ascii_case("OUT") || crate::ladder::key(pin) == crate::ladder::key(name))
        };
        let target = call.arguments.iter().find(is_result).and_then(|argument| match &argument.wire {
            Wire::Output(target) => Some(format!("{} := ", self.reference(target))),
            _ => None,
        });
        let others: Vec<&Argument> = call
            .arguments
            .iter()
            .filter(|argument| !is_result(argument) && !argument.pin.text.eq_ignore_ascii_case("EN"))
            .collect();
        // A whole array or structure, which only an assignment takes; of other values it says the same.
        if Function::from_name(name) == Some(Function::Standard(StandardFunction::Move))
            && let (Some(target), [Argument { wire: Wire::Value(value), .. }]) = (&target, others.as_slice())
        {
            return format!("{target}{}", self.expression(value));
        }
        let arguments = self
            .positional(name, &others)
            .unwrap_or_else(|| others.iter().filter_map(|one| self.argument(one)).collect());
        format!("{}{}({})", target.unwrap_or_default(), self.names.spell_function(name), arguments.join(", "))
    }

    /// What a box does that is not enabled, if anything: ENO is FALSE.
    pub(in crate::frontend) fn not_enabled(self, call: &BlockCall) -> Option<String> {
        match &pin(call, "ENO")?.wire {
            Wire::Output(target) => Some(format!("{} := FALSE;", self.reference(target))),
            _ => None,
        }
    }

    /// The arguments of a standard function in the order of its parameters, where nothing else is wired: all compilers take that.
    fn positional(self, name: &str, arguments: &[&Argument]) -> Option<Vec<String>> {
        let function = Function::from_name(name)?;
        let mut placed = Vec::new();
        for argument in arguments {
            let Wire::Value(value) = &argument.wire else { return None };
            let place = match function {
                Function::Standard(function) => function.place(&argument.pin.text)?,
                _ => 0,
            };
            placed.push((place, self.expression(value)));
        }
        placed.sort_by_key(|(place, _)| *place);
        let complete = placed.iter().enumerate().all(|(index, (place, _))| index == *place);
        complete.then(|| placed.into_iter().map(|(_, text)| text).collect())
    }
}

/// EN and ENO are keywords, and the names of pins.
fn spell_pin<'a>(pin: &'a str, spelled: &'a str) -> &'a str {
    if pin.eq_ignore_ascii_case("EN") || pin.eq_ignore_ascii_case("ENO") { pin } else { spelled }
}

/// The argument of a pin.
pub(in crate::frontend) fn pin<'a>(call: &'a BlockCall, name: &str) -> Option<&'a Argument> {
    call.arguments.iter().find(|argument| argument.pin.text.eq_ignore_ascii_case(name))
}

/// How tightly the outermost operator binds; what has none binds tightest.
fn precedence(expression: &Expression) -> u8 {
    match &expression.kind {
        ExpressionKind::Binary(operator, ..) => operator.precedence(),
        _ => BinaryOperator::Multiply.precedence() + 1,
    }
}
