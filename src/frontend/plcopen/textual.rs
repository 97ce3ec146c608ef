//! Bodies in LD whose rungs are written out: `<rung>` holds its elements in series, each naming its variable in an attribute.
//! Tools for verification write them so. They have no durations: a whole number at a TIME pin counts scans.

use lean_string::LeanString;
use thin_vec::thin_vec;

use super::xml::Node;
use crate::diagnostic::{Code, Diagnostic};
use crate::elementary::Elementary;
use crate::frontend::graph::coil_kind;
use crate::frontend::graph::expression;
use crate::frontend::graph::pins;
use crate::frontend::graph::report::Report;
use crate::frontend::graph::types::{Scope, Signatures};
use crate::ladder::functions::Function;
use crate::ladder::{
    Argument, BinaryOperator, BlockCall, Branch, Circuit, ContactKind, Element, ElementKind, Expression,
    ExpressionKind, FunctionArgument, Literal, Name, Program, Reference, Rung, Step, Unit, Wire,
};
use crate::source::Span;

/// What a body stands in.
pub(super) struct Around<'p> {
    pub(super) unit: &'p Unit,
    pub(super) program: &'p Program,
    pub(super) signatures: &'p Signatures,
}

/// A millisecond, in nanoseconds.
const MILLISECOND: i64 = 1_000_000;

impl Around<'_> {
    /// How long a scan of the unit is, in nanoseconds: the interval of its task, or of the only one that there is; else a
    /// millisecond.
    fn scan(&self) -> i64 {
        let tasks = &self.program.tasks;
        let of_instance = self.program.instances.iter().find(|instance| instance.program.key() == self.unit.name.key());
        let named = of_instance.and_then(|instance| instance.task.as_ref());
        let task = match (named, tasks.as_slice()) {
            (Some(named), _) => tasks.iter().find(|task| task.name.key() == named.key()),
            (None, [only]) => Some(only),
            _ => None,
        };
        match task.and_then(|task| task.interval.as_ref()).map(|interval| &interval.kind) {
            Some(ExpressionKind::Literal(Literal::Time(interval))) => *interval,
            _ => MILLISECOND,
        }
    }

    /// Whether a pin of a standard block takes or gives a duration.
    fn is_duration(&self, block: &str, pin: &str) -> bool {
        let ty = self.signatures.pin(block, pin, Span::default());
        self.signatures.is_standard(block)
            && ty.is_some_and(|ty| ty.name.text.eq_ignore_ascii_case(Elementary::Time.name()))
    }

    /// The integer type of a value, where it has one.
    fn integer(&self, value: &Expression) -> Option<Elementary> {
        let ty = match &value.kind {
            ExpressionKind::Literal(Literal::Integer { .. }) => return Some(Elementary::Int),
            _ => Scope::new(self.signatures, self.unit).value(value)?,
        };
        let ty = Elementary::from_name(&ty.name.text).filter(|_| ty.dimensions.is_empty())?;
        ty.is_integer().then_some(ty)
    }
}

/// The rungs of a body.
pub(super) fn read(content: Node<'_, '_>, around: &Around<'_>, report: &mut Report) -> Vec<Rung> {
    let mut rungs = Vec::new();
    let mut comment = None;
    for node in content.children_and_comments() {
        match node.name() {
            "" => comment = Some(node.text().split_whitespace().collect::<Vec<_>>().join(" ").into()),
            "rung" => {
                let span = node.span();
                let mut counted = Vec::new();
                let elements: Vec<Element> = node
                    .children()
                    .filter_map(|element| self::element(element, around, &mut counted, report))
                    .collect();
                let title = comment.take().or_else(|| node.attribute("comment").map(LeanString::from));
                let title = title.filter(|title| !title.is_empty());
                let name = node.attribute("label").map(|label| Name::new(label, span));
                // What counts scans is written behind the block, whether there is power or not.
                let branch = |elements: Vec<Element>| Branch { from: None, elements, to: None, span };
                let branches = [branch(elements)].into_iter().chain((!counted.is_empty()).then(|| branch(counted)));
                let circuit = Circuit { branches: branches.collect(), span };
                rungs.push(Rung { name, title, enabled: true, circuit, span });
            }
            name => report.not_supported(format!("element `<{name}>` between rungs"), node.span()),
        }
    }
    rungs
}

/// An element; `counted` takes the assignments of what counts scans.
fn element(
    node: Node<'_, '_>,
    around: &Around<'_>,
    counted: &mut Vec<Element>,
    report: &mut Report,
) -> Option<Element> {
    let span = node.span();
    let operand = |report: &mut Report| {
        let text = node.attribute("variable").or_else(|| node.child("variable").map(Node::text));
        let Some(text) = text else {
            report.error(Code::BadElement, span, format!("this `<{}>` names no variable", node.name()));
            return None;
        };
        report.read(expression::expression(text, span), span)
    };
    let says = |word: &str| {
        ["kind", "storage", "edge", "type"]
            .iter()
            .any(|name| node.attribute(name).is_some_and(|value| value.eq_ignore_ascii_case(word)))
    };
    let negated = node.flag("negated") || says("negated");
    let rising = if says("rising") { Some(true) } else { says("falling").then_some(false) };
    let kind = match node.name() {
        "contact" => {
            let operand = operand(report)?;
            let kind = match rising {
                Some(rising) if rising != negated => ContactKind::Rising,
                Some(_) => ContactKind::Falling,
                None if negated => ContactKind::Closed,
                None => ContactKind::Open,
            };
            ElementKind::Contact { kind, operand }
        }
        "coil" => {
            let ExpressionKind::Read(target) = operand(report)?.kind else {
                report.error(Code::NotWritable, span, "this coil names no variable");
                return None;
            };
            let set = if says("set") { Some(true) } else { says("reset").then_some(false) };
            ElementKind::Coil { kind: coil_kind(set, negated, rising), target }
        }
        "block" => ElementKind::Block(Box::new(block(node, around, counted, report)?)),
        name => {
            report.not_supported(format!("element `<{name}>` in a rung"), span);
            return None;
        }
    };
    Some(Element { kind, span })
}

fn block(
    node: Node<'_, '_>,
    around: &Around<'_>,
    counted: &mut Vec<Element>,
    report: &mut Report,
) -> Option<BlockCall> {
    let span = node.span();
    let Some(type_name) = node.attribute("typeName") else {
        report.error(Code::BadElement, span, "this `<block>` has no typeName");
        return None;
    };
    let instance = match node.attribute("instanceName") {
        Some(name) => Some(report.read(expression::reference(name, span), span)?),
        None => None,
    };
    let mut arguments = Vec::new();
    for pin in node.all("variable") {
        let Some(name) = pin.attribute("formalParameter") else {
            report.error(Code::BadElement, pin.span(), "this pin has no formalParameter");
            continue;
        };
        let Some(value) = report.read(expression::expression(pin.text(), pin.span()), pin.span()) else { continue };
        let counts = around.is_duration(type_name, name).then(|| around.integer(&value)).flatten();
        if counts.is_some() {
            let scan = around.scan() / MILLISECOND;
            let message = format!("the whole number at `{name}` counts scans, of {scan} ms each");
            report.push(Diagnostic::new(Code::ScanCount, pin.span(), message));
        }
        let wire = match (value.kind, counts) {
            (ExpressionKind::Read(target), counts) if is_output(type_name, name, around.signatures) => {
                if let (Some(ty), Some(instance)) = (counts, &instance) {
                    counted.push(scans_of(instance, name, target, ty, around.scan(), pin.span()));
                    continue;
                }
                Wire::Output(target)
            }
            (kind, Some(_)) => {
                let count = Expression { kind, span: pin.span() };
                Wire::Value(duration_of(count, around.scan()))
            }
            (kind, None) => Wire::Value(Expression { kind, span: pin.span() }),
        };
        arguments.push(Argument { pin: Name::new(name, pin.span()), wire, span: pin.span() });
    }
    // Every box has a name there, functions too.
    let function = Function::from_name(type_name).filter(|_| around.signatures.is_standard(type_name));
    if let Some(function) = function {
        let inputs = arguments.iter_mut().filter(|argument| !matches!(argument.wire, Wire::Output(_)));
        let names = inputs.map(|argument| &mut argument.pin.text).filter(|name| !name.eq_ignore_ascii_case("EN"));
        pins::operands(names.collect(), function);
    }
    let (instance, type_name) = match instance.filter(|_| !around.signatures.is_function(type_name)) {
        Some(instance) => (instance, Some(Name::new(type_name, span))),
        None => (Reference::of_name(Name::new(type_name, span)), None),
    };
    Some(BlockCall { instance, type_name, arguments, power_output: None })
}

/// So many scans as a duration.
fn duration_of(count: Expression, scan: i64) -> Expression {
    let span = count.span;
    let scan = Expression { kind: ExpressionKind::Literal(Literal::Time(scan)), span };
    let kind = ExpressionKind::Binary(BinaryOperator::Multiply, Box::new(scan), Box::new(count));
    Expression { kind, span }
}

/// `{target := LREAL_TO_INT(TIME_TO_LREAL(instance.pin) / 0.01)}`: a duration at an output as a number of scans.
fn scans_of(instance: &Reference, pin: &str, target: Reference, ty: Elementary, scan: i64, span: Span) -> Element {
    let at = |kind: ExpressionKind| Expression { kind, span };
    let call = |function: String, value: Expression| {
        let arguments = thin_vec![FunctionArgument { parameter: None, value }];
        at(ExpressionKind::Call { function: Name::new(function, span), arguments })
    };
    let mut read = instance.clone();
    read.steps.push(Step::Member(Name::new(pin, span)));
    let duration = call("TIME_TO_LREAL".to_owned(), at(ExpressionKind::Read(read)));
    #[expect(clippy::cast_precision_loss, reason = "the interval of a task has fewer than 53 bits of nanoseconds")]
    let seconds = Literal::Real { value: scan as f64 / 1e9, ty: Some(Elementary::Lreal) };
    let seconds = at(ExpressionKind::Literal(seconds));
    let count = at(ExpressionKind::Binary(BinaryOperator::Divide, Box::new(duration), Box::new(seconds)));
    let value = call(format!("LREAL_TO_{ty}"), count);
    Element { kind: ElementKind::Assignment { target, value: Box::new(value) }, span }
}

/// Whether a pin gives a value; of what is not known, by the names that outputs have.
fn is_output(block: &str, pin: &str, signatures: &Signatures) -> bool {
    if signatures.is_known_block(block) {
        return signatures.is_output(block, pin);
    }
    let names: &[&str] =
        if Function::from_name(block).is_some() { &["OUT", "ENO"] } else { &["OUT", "ENO", "Q", "ET", "CV"] };
    names.iter().any(|name| name.eq_ignore_ascii_case(pin))
}
