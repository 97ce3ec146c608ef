//! Short ways to build a program in code, as a front end would.

use rung::elementary::Elementary;
use rung::ladder::{
    Address, Area, Argument, BinaryOperator, BlockCall, Branch, Circuit, CoilKind, Comment, ContactKind, Element,
    ElementKind, Expression, ExpressionKind, Literal, Name, Origin, Program, Reference, Root, Rung, Variable,
    VariableClass, Width, Wire,
};
use rung::source::Span;

pub const NOWHERE: Span = Span { start: 0, end: 0 };

pub fn name(text: &str) -> Name {
    Name::new(text, NOWHERE)
}

pub fn reference(text: &str) -> Reference {
    Reference { root: Root::Name(name(text)), steps: vec![], span: NOWHERE }
}

pub fn expression(kind: ExpressionKind) -> Expression {
    Expression { kind, span: NOWHERE }
}

pub fn read(text: &str) -> Expression {
    expression(ExpressionKind::Read(reference(text)))
}

pub fn number(value: u128) -> Expression {
    expression(ExpressionKind::Literal(Literal::Integer { value, base: 10, ty: None }))
}

pub fn seconds(value: i64) -> Expression {
    expression(ExpressionKind::Literal(Literal::Time(value * 1_000_000_000)))
}

pub fn integer(ty: Elementary, value: u128) -> Expression {
    expression(ExpressionKind::Literal(Literal::Integer { value, base: 10, ty: Some(ty) }))
}

pub fn binary(operator: BinaryOperator, left: Expression, right: Expression) -> Expression {
    expression(ExpressionKind::Binary(operator, Box::new(left), Box::new(right)))
}

pub fn element(kind: ElementKind) -> Element {
    Element { kind, span: NOWHERE }
}

pub fn contact(kind: ContactKind, text: &str) -> Element {
    element(ElementKind::Contact { kind, operand: read(text) })
}

pub fn open(text: &str) -> Element {
    contact(ContactKind::Open, text)
}

pub fn closed(text: &str) -> Element {
    contact(ContactKind::Closed, text)
}

pub fn coil(kind: CoilKind, text: &str) -> Element {
    element(ElementKind::Coil { kind, target: reference(text) })
}

pub fn out(text: &str) -> Element {
    coil(CoilKind::Plain, text)
}

pub fn condition(value: Expression) -> Element {
    element(ElementKind::Condition(value))
}

pub fn assignment(target: &str, value: Expression) -> Element {
    element(ElementKind::Assignment { target: reference(target), value })
}

pub fn branch(elements: Vec<Element>) -> Branch {
    Branch { from: None, elements, to: None, span: NOWHERE }
}

/// A branch that starts and ends at nodes; an empty name for none.
pub fn node_branch(from: &str, elements: Vec<Element>, to: &str) -> Branch {
    let node = |text: &str| (!text.is_empty()).then(|| name(text));
    Branch { from: node(from), elements, to: node(to), span: NOWHERE }
}

pub fn circuit(branches: Vec<Branch>) -> Circuit {
    Circuit { branches, span: NOWHERE }
}

pub fn parallel(branches: Vec<Vec<Element>>) -> Element {
    element(ElementKind::Parallel(circuit(branches.into_iter().map(branch).collect())))
}

pub fn block(instance: &str, ty: &str, arguments: Vec<(&str, Wire)>) -> Element {
    chosen(instance, ty, arguments, "")
}

/// A block with a chosen power output; empty texts for no type and no choice.
pub fn chosen(instance: &str, ty: &str, arguments: Vec<(&str, Wire)>, output: &str) -> Element {
    let some = |text: &str| (!text.is_empty()).then(|| name(text));
    element(ElementKind::Block(BlockCall {
        instance: name(instance),
        type_name: some(ty),
        arguments: arguments.into_iter().map(|(pin, wire)| Argument { pin: name(pin), wire, span: NOWHERE }).collect(),
        power_output: some(output),
    }))
}

pub fn value(value: Expression) -> Wire {
    Wire::Value(value)
}

pub fn to(text: &str) -> Wire {
    Wire::Output(reference(text))
}

pub fn wired(branches: Vec<Vec<Element>>) -> Wire {
    Wire::Circuit(circuit(branches.into_iter().map(branch).collect()))
}

pub fn rung(text: &str, title: &str, elements: Vec<Element>) -> Rung {
    rung_of(text, title, vec![branch(elements)])
}

/// A rung; empty texts for no name and no title.
pub fn rung_of(text: &str, title: &str, branches: Vec<Branch>) -> Rung {
    Rung {
        name: (!text.is_empty()).then(|| name(text)),
        title: (!title.is_empty()).then(|| title.to_owned()),
        enabled: true,
        circuit: circuit(branches),
        span: NOWHERE,
    }
}

pub fn program(text: &str, variables: Vec<Variable>, rungs: Vec<Rung>) -> Program {
    Program { origin: Origin::Native, name: name(text), variables, rungs, comments: vec![] }
}

pub fn variable(class: VariableClass, text: &str) -> Variable {
    Variable { class, name: name(text), type_name: None, address: None, initial: None, retain: false, span: NOWHERE }
}

pub fn typed(class: VariableClass, text: &str, ty: &str) -> Variable {
    Variable { type_name: Some(name(ty)), ..variable(class, text) }
}

pub fn address(area: Area, numbers: &[u32]) -> Option<Address> {
    Some(Address { area, width: Width::Bit, numbers: numbers.to_vec(), span: NOWHERE })
}

pub fn comment(text: &str, start: usize, own_line: bool) -> Comment {
    Comment { text: text.to_owned(), span: Span::new(start, start + 1), own_line }
}
