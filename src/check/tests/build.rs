//! Short ways to write ladder programs. Each part made has a span of its own, of which [`text_at`] gives the text.

use std::cell::RefCell;

use thin_vec::ThinVec;

use crate::elementary::Elementary;
use crate::ladder::{
    Address, Area, Argument, BinaryOperator, BlockCall, Branch, Circuit, CoilKind, ContactKind, Element, ElementKind,
    Expression, ExpressionKind, Literal, Name, Origin, Program, Reference, Root, Rung, Step, TypeReference,
    UnaryOperator, Variable, VariableClass, Width, Wire,
};
use crate::source::Span;

thread_local! {
    static TEXTS: RefCell<Vec<String>> = const { RefCell::new(Vec::new()) };
}

pub(super) fn span(text: impl Into<String>) -> Span {
    TEXTS.with_borrow_mut(|texts| {
        texts.push(text.into());
        Span::new(texts.len(), texts.len() + 1)
    })
}

pub(super) fn text_at(span: Span) -> String {
    TEXTS.with_borrow(|texts| texts.get(span.start as usize - 1).cloned().unwrap_or_default())
}

pub(super) fn name(text: &str) -> Name {
    Name::new(text, span(text))
}

/// `%IX0.3`
pub(super) fn address(text: &str) -> Address {
    let mut letters = text[1..].chars();
    let area = match letters.next() {
        Some('I') => Area::Input,
        Some('Q') => Area::Output,
        _ => Area::Memory,
    };
    let width = match letters.next() {
        Some('X') => Width::Bit,
        Some('B') => Width::Byte,
        Some('W') => Width::Word,
        Some('D') => Width::Double,
        _ => Width::Long,
    };
    let numbers = letters.as_str().split('.').map(|number| number.parse().unwrap()).collect();
    Address { area, width, numbers, span: span(text) }
}

/// `a`, `t.Q`, `w.3`, `%IX0.3`
pub(super) fn reference(text: &str) -> Reference {
    if text.starts_with('%') {
        return Reference { root: Root::Address(Box::new(address(text))), steps: ThinVec::new(), span: span(text) };
    }
    let mut parts = text.split('.');
    let root = Root::Name(name(parts.next().unwrap_or_default()));
    let step = |part: &str| match part.parse() {
        Ok(bit) => Step::Bit(bit, span(part)),
        Err(_) => Step::Member(name(part)),
    };
    Reference { root, steps: parts.map(step).collect(), span: span(text) }
}

fn declared(class: VariableClass, text: &str, ty: Option<&str>) -> Variable {
    let name = name(text);
    let ty = ty.map(|ty| TypeReference::of_name(self::name(ty)));
    Variable {
        class,
        name,
        ty,
        address: None,
        initial: None,
        retain: false,
        span: span(format!("declaration of {text}")),
    }
}

pub(super) fn input(text: &str) -> Variable {
    declared(VariableClass::Input, text, None)
}

pub(super) fn output(text: &str) -> Variable {
    declared(VariableClass::Output, text, None)
}

pub(super) fn memory(text: &str, ty: &str) -> Variable {
    declared(VariableClass::Memory, text, Some(ty))
}

pub(super) fn constant(text: &str, ty: &str, value: Expression) -> Variable {
    declared(VariableClass::Constant, text, Some(ty)).starting(value)
}

pub(super) trait Declare: Sized {
    fn starting(self, value: Expression) -> Self;
    fn at(self, address: &str) -> Self;
    fn typed(self, ty: &str) -> Self;
    fn retained(self) -> Self;
}

impl Declare for Variable {
    fn starting(self, value: Expression) -> Self {
        Self { initial: Some(Box::new(value)), ..self }
    }

    fn at(self, text: &str) -> Self {
        Self { address: Some(Box::new(address(text))), ..self }
    }

    fn typed(self, ty: &str) -> Self {
        Self { ty: Some(TypeReference::of_name(name(ty))), ..self }
    }

    fn retained(self) -> Self {
        Self { retain: true, ..self }
    }
}

fn literal(literal: Literal, text: impl Into<String>) -> Expression {
    Expression { kind: ExpressionKind::Literal(literal), span: span(text) }
}

pub(super) fn int(value: u128) -> Expression {
    literal(Literal::Integer { value: value.into(), base: 10, ty: None }, value.to_string())
}

pub(super) fn typed(ty: Elementary, value: u128) -> Expression {
    literal(Literal::Integer { value: value.into(), base: 10, ty: Some(ty) }, format!("{ty}#{value}"))
}

pub(super) fn real(value: f64) -> Expression {
    literal(Literal::Real { value, ty: None }, format!("{value:?}"))
}

pub(super) fn truth(value: bool) -> Expression {
    literal(Literal::Bool(value), if value { "TRUE" } else { "FALSE" })
}

pub(super) fn seconds(value: i64) -> Expression {
    literal(Literal::Time(value * 1_000_000_000), format!("T#{value}s"))
}

pub(super) fn read(text: &str) -> Expression {
    Expression { kind: ExpressionKind::Read(reference(text)), span: span(text) }
}

pub(super) fn negate(operand: Expression) -> Expression {
    let span = span(format!("-{}", text_at(operand.span)));
    Expression { kind: ExpressionKind::Unary(UnaryOperator::Negate, Box::new(operand)), span }
}

pub(super) fn not(operand: Expression) -> Expression {
    let span = span(format!("NOT {}", text_at(operand.span)));
    Expression { kind: ExpressionKind::Unary(UnaryOperator::Not, Box::new(operand)), span }
}

pub(super) fn binary(left: Expression, op: BinaryOperator, right: Expression) -> Expression {
    let span = span(format!("{} {} {}", text_at(left.span), op.symbol(), text_at(right.span)));
    Expression { kind: ExpressionKind::Binary(op, Box::new(left), Box::new(right)), span }
}

fn element(kind: ElementKind, text: impl Into<String>) -> Element {
    Element { kind, span: span(text) }
}

pub(super) fn contact(kind: ContactKind, operand: Expression) -> Element {
    let text = text_at(operand.span);
    element(ElementKind::Contact { kind, operand }, text)
}

/// A normally open contact.
pub(super) fn open(text: &str) -> Element {
    contact(ContactKind::Open, read(text))
}

pub(super) fn fixed(value: bool) -> Element {
    contact(ContactKind::Open, truth(value))
}

pub(super) fn coil_of(kind: CoilKind, text: &str) -> Element {
    element(ElementKind::Coil { kind, target: reference(text) }, format!("({text})"))
}

pub(super) fn coil(text: &str) -> Element {
    coil_of(CoilKind::Plain, text)
}

pub(super) fn when(condition: Expression) -> Element {
    let text = text_at(condition.span);
    element(ElementKind::Condition(condition), text)
}

pub(super) fn assign(target: &str, value: Expression) -> Element {
    element(ElementKind::Assignment { target: reference(target), value: Box::new(value) }, target)
}

/// `>> name`, pointed at as a whole.
pub(super) fn jump(text: &str) -> Element {
    element(ElementKind::Jump { target: name(text) }, format!(">> {text}"))
}

pub(super) fn leave() -> Element {
    element(ElementKind::Return, ">> return")
}

pub(super) fn branch(elements: Vec<Element>) -> Branch {
    Branch { from: None, elements, to: None, span: span("branch") }
}

pub(super) fn between(from: &str, elements: Vec<Element>, to: &str) -> Branch {
    let node = |text: &str| (!text.is_empty()).then(|| name(text));
    Branch { from: node(from).map(Box::new), elements, to: node(to).map(Box::new), span: span("branch") }
}

pub(super) fn circuit(branches: Vec<Branch>) -> Circuit {
    Circuit { branches, span: span("circuit") }
}

pub(super) fn parallel(branches: Vec<Branch>) -> Element {
    element(ElementKind::Parallel(circuit(branches)), "parallel")
}

pub(super) fn value(pin: &str, value: Expression) -> Argument {
    Argument { pin: name(pin), wire: Wire::Value(value), span: span(pin) }
}

pub(super) fn wired(pin: &str, elements: Vec<Element>) -> Argument {
    Argument { pin: name(pin), wire: Wire::Circuit(circuit(vec![branch(elements)])), span: span(pin) }
}

pub(super) fn to(pin: &str, target: &str) -> Argument {
    Argument { pin: name(pin), wire: Wire::Output(reference(target)), span: span(pin) }
}

/// `t:TON`, or `t` for an instance declared elsewhere.
pub(super) fn call(text: &str, arguments: Vec<Argument>) -> Element {
    call_through(text, arguments, None)
}

/// A call that gives its power from a chosen output.
pub(super) fn call_through(text: &str, arguments: Vec<Argument>, power: Option<&str>) -> Element {
    let (instance, ty) = text.split_once(':').map_or((text, None), |(instance, ty)| (instance, Some(ty)));
    let power_output = power.map(name);
    let call =
        BlockCall { instance: Reference::of_name(name(instance)), type_name: ty.map(name), arguments, power_output };
    element(ElementKind::Block(Box::new(call)), text)
}

pub(super) fn network(branches: Vec<Branch>) -> Rung {
    Rung { name: None, title: None, enabled: true, circuit: circuit(branches), span: span("rung") }
}

pub(super) fn rung(elements: Vec<Element>) -> Rung {
    network(vec![branch(elements)])
}

pub(super) fn named(text: &str, elements: Vec<Element>) -> Rung {
    let name = Some(name(text));
    Rung { name, ..rung(elements) }
}

pub(super) fn off(rung: Rung) -> Rung {
    Rung { enabled: false, ..rung }
}

pub(super) fn program(variables: Vec<Variable>, rungs: Vec<Rung>) -> Program {
    Program::of_one(Origin::Native, name("test"), variables, rungs)
}

pub(super) fn imported(program: Program) -> Program {
    Program { origin: Origin::Imported, ..program }
}
