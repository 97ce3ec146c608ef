//! Ladder programs drawn by hand, without text and without places.

use rung::elementary::Elementary;
use rung::ladder::library::StandardBlock;
use rung::ladder::{
    Argument, BlockCall, Branch, Circuit, CoilKind, ContactKind, Dimension, Element, ElementKind, Expression,
    ExpressionKind, Literal, Name, Origin, Program, Reference, Root, Rung, Step, TypeReference, UnaryOperator,
    Variable, VariableClass, Wire,
};
use rung::source::Span;

/// The place of what was never written.
pub(crate) const NOWHERE: Span = Span { start: 0, end: 0 };

/// A name.
pub(crate) fn name(text: &str) -> Name {
    Name::new(text, NOWHERE)
}

/// A program without variables and rungs.
pub(crate) fn program(text: &str) -> Program {
    Program::of_one(Origin::Native, name(text), Vec::new(), Vec::new())
}

/// A declaration with neither address nor initial value.
pub(crate) fn variable(class: VariableClass, text: &str, ty: Elementary) -> Variable {
    Variable {
        class,
        name: name(text),
        ty: Some(TypeReference::of_name(name(ty.name()))),
        address: None,
        initial: None,
        retain: false,
        span: NOWHERE,
    }
}

/// A declaration of an array with one dimension, from index 0.
pub(crate) fn array(class: VariableClass, text: &str, count: u32, ty: Elementary) -> Variable {
    let dimension = Dimension { first: integer(0), last: integer(i128::from(count) - 1) };
    let ty = TypeReference { dimensions: [dimension].into(), ..TypeReference::of_name(name(ty.name())) };
    Variable { ty: Some(ty), ..variable(class, text, Elementary::Bool) }
}

/// A rung of elements in series.
pub(crate) fn rung(elements: Vec<Element>) -> Rung {
    let circuit = Circuit { branches: vec![branch(elements)], span: NOWHERE };
    Rung { name: None, title: None, enabled: true, circuit, span: NOWHERE }
}

/// A branch without nodes.
pub(crate) fn branch(elements: Vec<Element>) -> Branch {
    Branch { from: None, elements, to: None, span: NOWHERE }
}

/// An element.
pub(crate) fn element(kind: ElementKind) -> Element {
    Element { kind, span: NOWHERE }
}

/// Branches in parallel.
pub(crate) fn parallel(branches: Vec<Branch>) -> Element {
    element(ElementKind::Parallel(Circuit { branches, span: NOWHERE }))
}

/// A normally open contact.
pub(crate) fn contact(text: &str) -> Element {
    contact_of(ContactKind::Open, text)
}

/// A contact.
pub(crate) fn contact_of(kind: ContactKind, text: &str) -> Element {
    element(ElementKind::Contact { kind, operand: read(text) })
}

/// A coil.
pub(crate) fn coil(kind: CoilKind, text: &str) -> Element {
    element(ElementKind::Coil { kind, target: reference(text) })
}

/// A reference to a name or, with a dot, to a member, or, with a number in brackets, to an element.
pub(crate) fn reference(text: &str) -> Reference {
    let (root, step) = if let Some((root, index)) = text.strip_suffix(']').and_then(|text| text.split_once('[')) {
        let index = index.parse().unwrap_or_else(|error| panic!("{text}: {error}"));
        (root, Some(Step::Index(vec![integer(index)], NOWHERE)))
    } else if let Some((root, member)) = text.split_once('.') {
        (root, Some(Step::Member(name(member))))
    } else {
        (text, None)
    };
    Reference { root: Root::Name(name(root)), steps: step.into_iter().collect(), span: NOWHERE }
}

/// An expression that reads such a reference.
pub(crate) fn read(text: &str) -> Expression {
    expression(ExpressionKind::Read(reference(text)))
}

/// An expression.
pub(crate) fn expression(kind: ExpressionKind) -> Expression {
    Expression { kind, span: NOWHERE }
}

/// A literal without a type, behind the operator where it is negative.
pub(crate) fn integer(value: i128) -> Expression {
    let magnitude = Literal::Integer { value: value.unsigned_abs().into(), base: 10, ty: None };
    let magnitude = expression(ExpressionKind::Literal(magnitude));
    if value < 0 { expression(ExpressionKind::Unary(UnaryOperator::Negate, Box::new(magnitude))) } else { magnitude }
}

/// A wired pin.
pub(crate) fn argument(pin: &str, wire: Wire) -> Argument {
    Argument { pin: name(pin), wire, span: NOWHERE }
}

/// A call that declares its instance.
pub(crate) fn call(instance: &str, block: StandardBlock, arguments: Vec<Argument>) -> Element {
    element(ElementKind::Block(Box::new(BlockCall {
        instance: reference(instance),
        type_name: Some(name(block.name())),
        arguments,
        power_output: None,
    })))
}
