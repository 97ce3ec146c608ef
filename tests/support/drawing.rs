//! Ladder programs drawn by hand, without text and without places.

use rung::elementary::Elementary;
use rung::ladder::library::StandardBlock;
use rung::ladder::{
    Argument, BlockCall, Branch, Circuit, CoilKind, ContactKind, Element, ElementKind, Expression, ExpressionKind,
    Name, Origin, Program, Reference, Root, Rung, Step, Variable, VariableClass, Wire,
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
    Program { origin: Origin::Native, name: name(text), variables: Vec::new(), rungs: Vec::new(), comments: Vec::new() }
}

/// A declaration with neither address nor initial value.
pub(crate) fn variable(class: VariableClass, text: &str, ty: Elementary) -> Variable {
    Variable {
        class,
        name: name(text),
        type_name: Some(name(ty.name())),
        address: None,
        initial: None,
        retain: false,
        span: NOWHERE,
    }
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

/// A reference to a name or, with a dot, to a member.
pub(crate) fn reference(text: &str) -> Reference {
    let (root, member) = text.split_once('.').map_or((text, None), |(root, member)| (root, Some(member)));
    let steps = member.map(|member| Step::Member(name(member))).into_iter().collect();
    Reference { root: Root::Name(name(root)), steps, span: NOWHERE }
}

/// An expression that reads such a reference.
pub(crate) fn read(text: &str) -> Expression {
    expression(ExpressionKind::Read(reference(text)))
}

/// An expression.
pub(crate) fn expression(kind: ExpressionKind) -> Expression {
    Expression { kind, span: NOWHERE }
}

/// A wired pin.
pub(crate) fn argument(pin: &str, wire: Wire) -> Argument {
    Argument { pin: name(pin), wire, span: NOWHERE }
}

/// A call that declares its instance.
pub(crate) fn call(instance: &str, block: StandardBlock, arguments: Vec<Argument>) -> Element {
    element(ElementKind::Block(BlockCall {
        instance: name(instance),
        type_name: Some(name(block.name())),
        arguments,
        power_output: None,
    }))
}
