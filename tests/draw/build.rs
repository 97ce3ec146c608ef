//! Short ways to build a program in code, as a front end would.

use rung::elementary::Elementary;
use rung::ladder::{
    Address, Area, Argument, BinaryOperator, BlockCall, Branch, Circuit, CoilKind, Comment, ConditionalBranch,
    ContactKind, Element, ElementKind, Expression, ExpressionKind, Literal, Name, Origin, Program, Reference, Root,
    Rung, Statement, StatementKind, TypeReference, Variable, VariableClass, Width, Wire,
};
use rung::source::Span;

pub(crate) const NOWHERE: Span = Span { start: 0, end: 0 };

pub(crate) fn name(text: &str) -> Name {
    Name::new(text, NOWHERE)
}

pub(crate) fn reference(text: &str) -> Reference {
    Reference { root: Root::Name(name(text)), steps: [].into(), span: NOWHERE }
}

pub(crate) fn expression(kind: ExpressionKind) -> Expression {
    Expression { kind, span: NOWHERE }
}

pub(crate) fn read(text: &str) -> Expression {
    expression(ExpressionKind::Read(reference(text)))
}

pub(crate) fn number(value: u128) -> Expression {
    expression(ExpressionKind::Literal(Literal::Integer { value: value.into(), base: 10, ty: None }))
}

pub(crate) fn seconds(value: i64) -> Expression {
    expression(ExpressionKind::Literal(Literal::Time(value * 1_000_000_000)))
}

pub(crate) fn integer(ty: Elementary, value: u128) -> Expression {
    expression(ExpressionKind::Literal(Literal::Integer { value: value.into(), base: 10, ty: Some(ty) }))
}

pub(crate) fn binary(operator: BinaryOperator, left: Expression, right: Expression) -> Expression {
    expression(ExpressionKind::Binary(operator, Box::new(left), Box::new(right)))
}

pub(crate) fn element(kind: ElementKind) -> Element {
    Element { kind, span: NOWHERE }
}

pub(crate) fn contact(kind: ContactKind, text: &str) -> Element {
    element(ElementKind::Contact { kind, operand: read(text) })
}

pub(crate) fn open(text: &str) -> Element {
    contact(ContactKind::Open, text)
}

pub(crate) fn closed(text: &str) -> Element {
    contact(ContactKind::Closed, text)
}

pub(crate) fn coil(kind: CoilKind, text: &str) -> Element {
    element(ElementKind::Coil { kind, target: reference(text) })
}

pub(crate) fn out(text: &str) -> Element {
    coil(CoilKind::Plain, text)
}

pub(crate) fn condition(value: Expression) -> Element {
    element(ElementKind::Condition(value))
}

pub(crate) fn assignment(target: &str, value: Expression) -> Element {
    element(ElementKind::Assignment { target: reference(target), value: Box::new(value) })
}

pub(crate) fn statements(list: Vec<Statement>) -> Element {
    element(ElementKind::Statements(list))
}

pub(crate) fn assign(target: &str, value: Expression) -> Statement {
    let kind = StatementKind::Assignment { target: reference(target), value };
    Statement { kind, span: NOWHERE }
}

pub(crate) fn when(condition: Expression, body: Vec<Statement>) -> Statement {
    let kind = StatementKind::If { branches: vec![ConditionalBranch { condition, body }], otherwise: vec![] };
    Statement { kind, span: NOWHERE }
}

pub(crate) fn jump(text: &str) -> Element {
    element(ElementKind::Jump { target: name(text) })
}

pub(crate) fn branch(elements: Vec<Element>) -> Branch {
    Branch { from: None, elements, to: None, span: NOWHERE }
}

/// A branch that starts and ends at nodes; an empty name for none.
pub(crate) fn node_branch(from: &str, elements: Vec<Element>, to: &str) -> Branch {
    let node = |text: &str| (!text.is_empty()).then(|| name(text));
    Branch { from: node(from).map(Box::new), elements, to: node(to).map(Box::new), span: NOWHERE }
}

pub(crate) fn circuit(branches: Vec<Branch>) -> Circuit {
    Circuit { branches, span: NOWHERE }
}

pub(crate) fn parallel(branches: Vec<Vec<Element>>) -> Element {
    element(ElementKind::Parallel(circuit(branches.into_iter().map(branch).collect())))
}

pub(crate) fn block(instance: &str, ty: &str, arguments: Vec<(&str, Wire)>) -> Element {
    chosen(instance, ty, arguments, "")
}

/// A block with a chosen power output; empty texts for no type and no choice.
pub(crate) fn chosen(instance: &str, ty: &str, arguments: Vec<(&str, Wire)>, output: &str) -> Element {
    let some = |text: &str| (!text.is_empty()).then(|| name(text));
    element(ElementKind::Block(Box::new(BlockCall {
        instance: reference(instance),
        type_name: some(ty),
        arguments: arguments.into_iter().map(|(pin, wire)| Argument { pin: name(pin), wire, span: NOWHERE }).collect(),
        power_output: some(output),
    })))
}

pub(crate) fn value(value: Expression) -> Wire {
    Wire::Value(value)
}

pub(crate) fn to(text: &str) -> Wire {
    Wire::Output(reference(text))
}

pub(crate) fn wired(branches: Vec<Vec<Element>>) -> Wire {
    Wire::Circuit(circuit(branches.into_iter().map(branch).collect()))
}

pub(crate) fn rung(text: &str, title: &str, elements: Vec<Element>) -> Rung {
    rung_of(text, title, vec![branch(elements)])
}

/// A rung; empty texts for no name and no title.
pub(crate) fn rung_of(text: &str, title: &str, branches: Vec<Branch>) -> Rung {
    Rung {
        name: (!text.is_empty()).then(|| name(text)),
        title: (!title.is_empty()).then(|| title.into()),
        enabled: true,
        circuit: circuit(branches),
        span: NOWHERE,
    }
}

pub(crate) fn program(text: &str, variables: Vec<Variable>, rungs: Vec<Rung>) -> Program {
    Program::of_one(Origin::Native, name(text), variables, rungs)
}

pub(crate) fn variable(class: VariableClass, text: &str) -> Variable {
    Variable { class, name: name(text), ty: None, address: None, initial: None, retain: false, span: NOWHERE }
}

pub(crate) fn typed(class: VariableClass, text: &str, ty: &str) -> Variable {
    Variable { ty: Some(TypeReference::of_name(name(ty))), ..variable(class, text) }
}

pub(crate) fn address(area: Area, numbers: &[u32]) -> Option<Address> {
    Some(Address { area, width: Width::Bit, numbers: numbers.to_vec(), span: NOWHERE })
}

pub(crate) fn comment(text: &str, start: usize, own_line: bool) -> Comment {
    Comment { text: text.to_owned(), span: Span::new(start, start + 1), own_line }
}
