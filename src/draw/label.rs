//! Short texts of a picture: names, references, expressions and small circuits on one line, cut to a width.
//!
//! What is cut says so with `…`. Widths are in terminal columns. This module must never print a line break or
//! another control character, whatever a name holds, nor work longer on a text than its limit asks for.

use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

use crate::ladder::{
    BinaryOperator, BlockCall, Branch, Circuit, CoilKind, ContactKind, ElementKind, Expression, ExpressionKind,
    Literal, Reference, Root, Step, TypeReference, UnaryOperator, Wire,
};

/// What stands for that which was cut.
const CUT: &str = "…";
/// How deep an expression or circuit is followed; what lies deeper is cut.
const MAXIMUM_DEPTH: u32 = 200;
/// How tightly a unary operator binds: tighter than every [`BinaryOperator`].
const UNARY_PRECEDENCE: u8 = 8;

/// The columns that a text takes on a terminal.
pub(super) fn width(text: &str) -> usize {
    UnicodeWidthStr::width(text)
}

/// The text with everything replaced that would break a line, turn its direction, or is no XML character.
pub(super) fn clean(text: &str) -> String {
    let presentable = |c: char| match c {
        '\t' => Some(' '),
        // Joiners and variation selectors make the width of a text differ from that of its characters.
        '\u{200B}'..='\u{200F}' | '\u{202A}'..='\u{202E}' | '\u{2060}'..='\u{206F}' | '\u{FE00}'..='\u{FE0F}' => None,
        '\u{2028}' | '\u{2029}' | '\u{FFFE}' | '\u{FFFF}' => Some('\u{FFFD}'),
        c if c.is_control() => Some('\u{FFFD}'),
        c => Some(c),
    };
    text.chars().filter_map(presentable).collect()
}

/// The longest start of a text that fits.
pub(super) fn start_of(text: &str, limit: usize) -> &str {
    let mut used = 0;
    let end = text.char_indices().find(|(_, c)| {
        used += c.width().unwrap_or(0);
        used > limit
    });
    &text[..end.map_or(text.len(), |(at, _)| at)]
}

/// The longest end of a text that fits.
fn end_of(text: &str, limit: usize) -> &str {
    let mut used = 0;
    let start = text.char_indices().rev().find(|(_, c)| {
        used += c.width().unwrap_or(0);
        used > limit
    });
    &text[start.map_or(0, |(at, c)| at + c.len_utf8())..]
}

/// A text cut at its end.
pub(super) fn cut_end(text: &str, limit: usize) -> String {
    let text = clean(text);
    if width(&text) <= limit {
        return text;
    }
    let start = start_of(&text, limit.saturating_sub(1)).trim_end();
    format!("{start}{CUT}")
}

/// Breaks a text into lines of at most `limit` columns, between words where possible.
pub(super) fn wrap(text: &str, limit: usize) -> Vec<String> {
    let mut lines = Vec::new();
    for paragraph in text.lines() {
        let paragraph = clean(paragraph);
        let mut line = String::new();
        let mut used = 0;
        for (index, word) in paragraph.trim_end().split(' ').enumerate() {
            let blank = usize::from(index > 0);
            let mut word = word;
            let mut columns = width(word);
            if used + blank + columns <= limit {
                line.extend((blank > 0).then_some(' '));
                used += blank;
            } else if used > 0 {
                lines.push(std::mem::take(&mut line).trim_end().to_owned());
                used = 0;
            }
            while columns > limit {
                let start = start_of(word, limit);
                if start.is_empty() {
                    break;
                }
                lines.push(start.to_owned());
                word = &word[start.len()..];
                columns = columns.saturating_sub(width(start));
            }
            line.push_str(word);
            used += columns;
        }
        lines.push(line.trim_end().to_owned());
    }
    lines
}

/// A name cut in its middle, since names differ at their ends as often as at their starts.
pub(super) fn cut_name(text: &str, limit: usize) -> String {
    let text = clean(text);
    if width(&text) <= limit {
        return text;
    }
    let room = limit.saturating_sub(1);
    let start = start_of(&text, room - room / 2);
    let end = end_of(&text, room / 2);
    format!("{start}{CUT}{end}")
}

/// A reference, cut in its middle.
pub(super) fn reference(reference: &Reference, limit: usize) -> String {
    let mut writer = Writer::new(usize::MAX);
    writer.reference(reference);
    cut_name(&writer.text, limit)
}

/// An expression: a lone reference is cut in its middle, all else at its end.
pub(super) fn expression(expression: &Expression, limit: usize) -> String {
    if let ExpressionKind::Read(read) = &expression.kind {
        return reference(read, limit);
    }
    let mut writer = Writer::new(limit);
    writer.expression(expression, 0);
    cut_end(&writer.text, limit)
}

/// A type, cut in its middle.
pub(super) fn type_reference(ty: &TypeReference, limit: usize) -> String {
    if ty.dimensions.is_empty() {
        return cut_name(&ty.name.text, limit);
    }
    let mut writer = Writer::new(limit);
    writer.push("array [");
    writer.list(&ty.dimensions, |writer, dimension| {
        writer.expression(&dimension.first, 0);
        writer.push("..");
        writer.expression(&dimension.last, 0);
    });
    cut_name(&format!("{}] of {}", writer.text, ty.name.text), limit)
}

/// `target := value`, cut at its end.
pub(super) fn assignment(target: &Reference, value: &Expression, limit: usize) -> String {
    let target = reference(target, limit);
    let rest = limit.saturating_sub(width(&target) + 4).max(1);
    cut_end(&format!("{target} := {}", expression(value, rest)), limit)
}

/// A circuit in native text without its outer brackets where it needs none; `None` where it does not fit.
pub(super) fn circuit(circuit: &Circuit, limit: usize) -> Option<String> {
    let mut writer = Writer::new(limit);
    match circuit.branches.as_slice() {
        [only] => writer.branch(only),
        _ => writer.circuit(circuit),
    }
    let text = clean(&writer.text);
    (!writer.incomplete && width(&text) <= limit).then_some(text)
}

/// Writes native text until a limit is passed.
struct Writer {
    text: String,
    /// In characters; reached, nothing more is written.
    limit: usize,
    written: usize,
    depth: u32,
    /// Whether something was left out.
    incomplete: bool,
}

impl Writer {
    fn new(limit: usize) -> Self {
        Self { text: String::new(), limit, written: 0, depth: 0, incomplete: false }
    }

    fn push(&mut self, text: &str) {
        if self.written > self.limit {
            self.incomplete = true;
        } else {
            self.text.push_str(text);
            self.written += text.chars().count();
        }
    }

    /// Writes what lies one level deeper, if there is room for more and it does not lie too deep.
    fn deeper(&mut self, write: impl FnOnce(&mut Self)) {
        if self.written > self.limit || self.depth >= MAXIMUM_DEPTH {
            self.push(CUT);
            self.incomplete = true;
        } else {
            self.depth += 1;
            write(self);
            self.depth -= 1;
        }
    }

    fn reference(&mut self, reference: &Reference) {
        match &reference.root {
            Root::Name(name) => self.push(&name.text),
            Root::Address(at) => self.push(&at.to_string()),
        }
        for step in &reference.steps {
            match step {
                Step::Member(name) => self.push(&format!(".{}", name.text)),
                Step::Bit(bit, _) => self.push(&format!(".{bit}")),
                Step::Index(indices, _) => {
                    self.push("[");
                    self.list(indices, |writer, index| writer.expression(index, 0));
                    self.push("]");
                }
            }
        }
    }

    /// Writes an expression that stands where only operators above a precedence may stand without parentheses.
    fn expression(&mut self, expression: &Expression, above: u8) {
        match &expression.kind {
            ExpressionKind::Literal(value) => self.push(&literal(value)),
            ExpressionKind::Read(read) => self.reference(read),
            ExpressionKind::Unary(operator, operand) => {
                self.push(match operator {
                    UnaryOperator::Not => "NOT ",
                    UnaryOperator::Negate => "-",
                });
                let doubled = matches!(operand.kind, ExpressionKind::Unary(UnaryOperator::Negate, _));
                self.enclosed(doubled, |writer| writer.deeper(|writer| writer.expression(operand, UNARY_PRECEDENCE)));
            }
            ExpressionKind::Binary(operator, left, right) => {
                let precedence = operator.precedence();
                self.enclosed(precedence < above, |writer| {
                    writer.deeper(|writer| writer.expression(left, precedence));
                    writer.push(&format!(" {} ", BinaryOperator::symbol(*operator)));
                    writer.deeper(|writer| writer.expression(right, precedence + 1));
                });
            }
            ExpressionKind::Call { function, arguments } => {
                self.push(&function.text);
                self.push("(");
                self.list(arguments, |writer, argument| {
                    if let Some(parameter) = &argument.parameter {
                        writer.push(&parameter.text);
                        writer.push(" := ");
                    }
                    writer.expression(&argument.value, 0);
                });
                self.push(")");
            }
            ExpressionKind::Array(items) => {
                self.push("[");
                self.list(items, |writer, item| {
                    if let Some(repeat) = &item.repeat {
                        writer.expression(repeat, 0);
                        writer.push("(");
                    }
                    item.value.iter().for_each(|value| writer.expression(value, 0));
                    writer.push(if item.repeat.is_some() { ")" } else { "" });
                });
                self.push("]");
            }
            ExpressionKind::Structure(members) => {
                self.push("(");
                self.list(members, |writer, member| {
                    writer.push(&format!("{} := ", member.member.text));
                    writer.expression(&member.value, 0);
                });
                self.push(")");
            }
        }
    }

    /// Writes items with commas between them, each one level deeper, as long as there is room.
    fn list<T>(&mut self, items: &[T], mut write: impl FnMut(&mut Self, &T)) {
        for (index, item) in items.iter().enumerate() {
            if self.written > self.limit {
                self.incomplete = true;
                return;
            }
            self.push(if index > 0 { ", " } else { "" });
            self.deeper(|writer| write(writer, item));
        }
    }

    fn enclosed(&mut self, in_parentheses: bool, write: impl FnOnce(&mut Self)) {
        if in_parentheses {
            self.push("(");
            write(self);
            self.push(")");
        } else {
            write(self);
        }
    }

    fn circuit(&mut self, circuit: &Circuit) {
        self.deeper(|writer| {
            writer.push("[ ");
            for (index, branch) in circuit.branches.iter().enumerate() {
                if writer.written > writer.limit {
                    writer.incomplete = true;
                    return;
                }
                if index > 0 {
                    writer.push(" | ");
                }
                writer.branch(branch);
            }
            writer.push(" ]");
        });
    }

    fn branch(&mut self, branch: &Branch) {
        let mut separator = "";
        if let Some(from) = &branch.from {
            self.push(&format!(">{}>", from.text));
            separator = " ";
        }
        for element in &branch.elements {
            if self.written > self.limit {
                self.incomplete = true;
                return;
            }
            self.push(separator);
            self.element(&element.kind);
            separator = " ";
        }
        if let Some(to) = &branch.to {
            self.push(&format!("{separator}>{}>", to.text));
        }
    }

    fn element(&mut self, element: &ElementKind) {
        match element {
            ElementKind::Contact { kind, operand } => {
                self.push(match kind {
                    ContactKind::Open => "",
                    ContactKind::Closed => "/",
                    ContactKind::Rising => "^",
                    ContactKind::Falling => "^/",
                });
                self.expression(operand, UNARY_PRECEDENCE);
            }
            ElementKind::Coil { kind, target } => {
                self.push(match kind {
                    CoilKind::Plain => "(",
                    CoilKind::Negated => "(/",
                    CoilKind::Set => "(S ",
                    CoilKind::Reset => "(R ",
                    CoilKind::Rising => "(P ",
                    CoilKind::Falling => "(N ",
                });
                self.reference(target);
                self.push(")");
            }
            ElementKind::Condition(condition) => {
                self.push("{");
                self.expression(condition, 0);
                self.push("}");
            }
            ElementKind::Assignment { target, value } => {
                self.push("{");
                self.reference(target);
                self.push(" := ");
                self.expression(value, 0);
                self.push("}");
            }
            ElementKind::Parallel(inner) => self.circuit(inner),
            ElementKind::Statements(_) => {
                // They have a box of their own and no short form.
                self.push("{…}");
                self.incomplete = true;
            }
            ElementKind::Block(call) => self.block(call),
            ElementKind::Jump { target } => self.push(&format!(">> {}", target.text)),
            ElementKind::Return => self.push(">> return"),
        }
    }

    fn block(&mut self, call: &BlockCall) {
        self.reference(&call.instance);
        if let Some(ty) = &call.type_name {
            self.push(&format!(":{}", ty.text));
        }
        self.push("(");
        for (index, argument) in call.arguments.iter().enumerate() {
            if self.written > self.limit {
                self.incomplete = true;
                return;
            }
            self.push(if index > 0 { ", " } else { "" });
            self.push(&argument.pin.text);
            match &argument.wire {
                Wire::Value(value) => {
                    self.push(" := ");
                    self.expression(value, 0);
                }
                Wire::Circuit(inner) => {
                    self.push(" := ");
                    self.circuit(inner);
                }
                Wire::Output(target) => {
                    self.push(" => ");
                    self.reference(target);
                }
            }
        }
        self.push(")");
        if let Some(output) = &call.power_output {
            self.push(&format!(".{}", output.text));
        }
    }
}

fn literal(literal: &Literal) -> String {
    let prefix = |ty: &Option<_>| ty.map_or(String::new(), |ty: crate::elementary::Elementary| format!("{ty}#"));
    match literal {
        Literal::Bool(value) => if *value { "TRUE" } else { "FALSE" }.to_owned(),
        Literal::Integer { value, base, ty } => match base {
            2 => format!("{}2#{:b}", prefix(ty), value.get()),
            8 => format!("{}8#{:o}", prefix(ty), value.get()),
            16 => format!("{}16#{:X}", prefix(ty), value.get()),
            _ => format!("{}{}", prefix(ty), value.get()),
        },
        Literal::Real { value, ty } => {
            let digits = format!("{value:?}");
            match digits.split_once('e') {
                Some((mantissa, exponent)) if !mantissa.contains('.') => {
                    format!("{}{mantissa}.0e{exponent}", prefix(ty))
                }
                _ => format!("{}{digits}", prefix(ty)),
            }
        }
        Literal::Time(nanoseconds) => time(*nanoseconds),
        Literal::Enumerated { ty, value } => format!("{}#{}", ty.text, value.text),
    }
}

/// A duration as `T#1m30s`.
fn time(nanoseconds: i64) -> String {
    const UNITS: [(u64, &str); 7] = [
        (86_400_000_000_000, "d"),
        (3_600_000_000_000, "h"),
        (60_000_000_000, "m"),
        (1_000_000_000, "s"),
        (1_000_000, "ms"),
        (1_000, "us"),
        (1, "ns"),
    ];
    let mut text = String::from(if nanoseconds < 0 { "T#-" } else { "T#" });
    let mut rest = nanoseconds.unsigned_abs();
    if rest == 0 {
        text.push_str("0s");
    }
    for (unit, name) in UNITS {
        if rest >= unit {
            text.push_str(&format!("{}{name}", rest / unit));
            rest %= unit;
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use thin_vec::ThinVec;

    use super::*;
    use crate::ladder::Name;
    use crate::source::Span;

    fn expression_of(kind: ExpressionKind) -> Expression {
        Expression { kind, span: Span::default() }
    }

    fn read(name: &str) -> Expression {
        let root = Root::Name(Name::new(name, Span::default()));
        expression_of(ExpressionKind::Read(Reference { root, steps: ThinVec::new(), span: Span::default() }))
    }

    fn binary(operator: BinaryOperator, left: Expression, right: Expression) -> Expression {
        expression_of(ExpressionKind::Binary(operator, Box::new(left), Box::new(right)))
    }

    fn unary(operator: UnaryOperator, operand: Expression) -> Expression {
        expression_of(ExpressionKind::Unary(operator, Box::new(operand)))
    }

    #[test]
    fn parentheses_stand_only_where_precedence_asks_for_them() {
        use BinaryOperator::{Add, And, Multiply, Or, Subtract};
        let text = |value: &Expression| expression(value, 80);
        assert_eq!(text(&binary(Add, read("a"), binary(Multiply, read("b"), read("c")))), "a + b * c");
        assert_eq!(text(&binary(Multiply, binary(Add, read("a"), read("b")), read("c"))), "(a + b) * c");
        assert_eq!(text(&binary(Subtract, binary(Subtract, read("a"), read("b")), read("c"))), "a - b - c");
        assert_eq!(text(&binary(Subtract, read("a"), binary(Subtract, read("b"), read("c")))), "a - (b - c)");
        assert_eq!(
            text(&unary(UnaryOperator::Not, binary(Or, read("a"), binary(And, read("b"), read("c"))))),
            "NOT (a OR b AND c)"
        );
        assert_eq!(text(&unary(UnaryOperator::Negate, unary(UnaryOperator::Negate, read("a")))), "-(-a)");
    }

    #[test]
    fn literals_are_written_in_their_base_and_unit() {
        use crate::elementary::Elementary::{Int, Real};
        assert_eq!(literal(&Literal::Integer { value: 255.into(), base: 16, ty: Some(Int) }), "INT#16#FF");
        assert_eq!(literal(&Literal::Integer { value: 5.into(), base: 2, ty: None }), "2#101");
        assert_eq!(literal(&Literal::Real { value: 1e300, ty: Some(Real) }), "REAL#1.0e300");
        assert_eq!(literal(&Literal::Real { value: 2.5, ty: None }), "2.5");
        assert_eq!(literal(&Literal::Time(90_000_000_000)), "T#1m30s");
        assert_eq!(literal(&Literal::Time(i64::MIN)), "T#-106751d23h47m16s854ms775us808ns");
        assert_eq!(literal(&Literal::Time(0)), "T#0s");
    }

    #[test]
    fn a_long_name_keeps_its_start_and_its_end() {
        assert_eq!(cut_name("conveyor_3_motor_overload", 12), "convey…rload");
        assert_eq!(cut_name("conveyor", 8), "conveyor");
        assert_eq!(cut_name("漢字漢字漢字", 7), "漢…字");
        assert_eq!(cut_end("seal-in: stop wins", 9), "seal-in:…");
    }

    #[test]
    fn a_chain_of_a_hundred_thousand_operators_ends_at_the_limit() {
        let mut long = read("a");
        for _ in 0..150 {
            long = binary(BinaryOperator::Add, long, read("b"));
        }
        assert_eq!(expression(&long, 9), "a + b +…");
        for _ in 0..100_000 {
            long = unary(UnaryOperator::Negate, long);
        }
        assert_eq!(expression(&long, 6), "-(-(-…");
        // Its own destructor would recurse.
        std::mem::forget(long);
    }

    #[test]
    fn control_characters_do_not_reach_the_picture() {
        assert_eq!(clean("a\nb\u{202E}c\td\u{0}"), "a\u{FFFD}bc d\u{FFFD}");
    }
}
