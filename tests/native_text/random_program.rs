//! A strategy for programs as any front end could make them: without true spans, with any names.

use proptest::collection::vec;
use proptest::option;
use proptest::prelude::*;
use rung::elementary::Elementary;
use rung::ladder::*;
use rung::source::Span;

const NOWHERE: Span = Span { start: 0, end: 0 };

fn name() -> BoxedStrategy<Name> {
    prop_oneof![
        4 => "[a-zA-Z_][a-zA-Z0-9_]{0,8}",
        1 => "[a-zA-Z_]{20,40}",
        1 => prop::sample::select(vec!["s", "R", "off", "at", "retain", "rung", "Not", "TRUE", "task", "T", "Return"])
            .prop_map(str::to_owned),
        1 => "[^`\n\r\0]{1,6}",
    ]
    .prop_map(|text| Name::new(text, NOWHERE))
    .boxed()
}

fn address() -> BoxedStrategy<Address> {
    let area = prop::sample::select(vec![Area::Input, Area::Output, Area::Memory]);
    let width = prop::sample::select(vec![Width::Bit, Width::Byte, Width::Word, Width::Double, Width::Long]);
    (area, width, vec(any::<u32>(), 1..4))
        .prop_map(|(area, width, numbers)| Address { area, width, numbers, span: NOWHERE })
        .boxed()
}

fn reference() -> BoxedStrategy<Reference> {
    let root = prop_oneof![4 => name().prop_map(Root::Name), 1 => address().prop_map(Root::Address)];
    let step = prop_oneof![name().prop_map(Step::Member), any::<u8>().prop_map(|bit| Step::Bit(bit, NOWHERE))];
    (root, prop_oneof![3 => Just(Vec::new()), 1 => vec(step, 1..3)])
        .prop_map(|(root, steps)| Reference { root, steps, span: NOWHERE })
        .boxed()
}

fn literal() -> BoxedStrategy<Literal> {
    let whole = Elementary::ALL.into_iter().filter(|ty| !ty.is_real() && *ty != Elementary::Time).collect::<Vec<_>>();
    let integer = (
        prop_oneof![any::<u128>(), (0..100u128)],
        prop::sample::select(vec![2, 8, 10, 16]),
        option::of(prop::sample::select(whole)),
    );
    let real = (
        prop_oneof![any::<f64>(), (-1000i32..1000).prop_map(|number| f64::from(number) / 8.0)],
        option::of(prop::sample::select(vec![Elementary::Real, Elementary::Lreal])),
    );
    prop_oneof![
        any::<bool>().prop_map(Literal::Bool),
        integer.prop_map(|(value, base, ty)| Literal::Integer { value, base, ty }),
        real.prop_filter("finite", |(value, _)| value.is_finite())
            .prop_map(|(value, ty)| Literal::Real { value: value.abs(), ty }),
        any::<i64>().prop_map(Literal::Time),
        (-100_000i64..100_000).prop_map(|milliseconds| Literal::Time(milliseconds * 1_000_000)),
    ]
    .boxed()
}

fn expression() -> BoxedStrategy<Expression> {
    let kind = |kind| Expression { kind, span: NOWHERE };
    let leaf = prop_oneof![literal().prop_map(ExpressionKind::Literal), reference().prop_map(ExpressionKind::Read),];
    leaf.prop_map(kind)
        .prop_recursive(5, 24, 2, move |inner| {
            let unary = prop::sample::select(vec![UnaryOperator::Not, UnaryOperator::Negate]);
            let binary = prop::sample::select(BinaryOperator::ALL.to_vec());
            let operators = prop::sample::select(vec!["NOT", "and", "MOD", "Xor", "OR"]);
            let function = prop_oneof![name(), operators.prop_map(|operator| Name::new(operator, NOWHERE))];
            prop_oneof![
                (unary, inner.clone())
                    .prop_map(|(operator, operand)| ExpressionKind::Unary(operator, Box::new(operand))),
                (binary, inner.clone(), inner.clone()).prop_map(|(operator, left, right)| ExpressionKind::Binary(
                    operator,
                    Box::new(left),
                    Box::new(right)
                )),
                (function, vec((option::of(name()), inner), 0..4)).prop_map(|(function, arguments)| {
                    let argument = |(parameter, value)| FunctionArgument { parameter, value };
                    ExpressionKind::Call { function, arguments: arguments.into_iter().map(argument).collect() }
                }),
            ]
            .prop_map(kind)
        })
        .boxed()
}

fn simple_element() -> BoxedStrategy<ElementKind> {
    use {CoilKind as Coil, ContactKind as Contact};
    let contact = vec![Contact::Open, Contact::Closed, Contact::Rising, Contact::Falling];
    let coil = vec![Coil::Plain, Coil::Negated, Coil::Set, Coil::Reset, Coil::Rising, Coil::Falling];
    let operand = prop_oneof![
        4 => reference().prop_map(ExpressionKind::Read),
        1 => any::<bool>().prop_map(|value| ExpressionKind::Literal(Literal::Bool(value))),
    ];
    prop_oneof![
        4 => (prop::sample::select(contact), operand).prop_map(|(kind, operand)| ElementKind::Contact {
            kind,
            operand: Expression { kind: operand, span: NOWHERE }
        }),
        2 => (prop::sample::select(coil), reference()).prop_map(|(kind, target)| ElementKind::Coil { kind, target }),
        1 => expression().prop_map(ElementKind::Condition),
        1 => (reference(), expression()).prop_map(|(target, value)| ElementKind::Assignment { target, value }),
        1 => name().prop_map(|target| ElementKind::Jump { target }),
        1 => Just(ElementKind::Return),
    ]
    .boxed()
}

fn circuit_of(element: impl Strategy<Value = ElementKind> + Clone) -> impl Strategy<Value = Circuit> {
    let element = element.prop_map(|kind| Element { kind, span: NOWHERE });
    let node = || prop_oneof![8 => Just(None), 1 => name().prop_map(Some)];
    let branch = (node(), vec(element, 0..5), node()).prop_map(|(from, elements, to)| Branch {
        from,
        elements,
        to,
        span: NOWHERE,
    });
    vec(branch, 1..4).prop_map(|branches| Circuit { branches, span: NOWHERE })
}

fn block(circuit: impl Strategy<Value = Circuit>) -> impl Strategy<Value = ElementKind> {
    let wire = prop_oneof![
        expression().prop_map(Wire::Value),
        circuit.prop_map(Wire::Circuit),
        reference().prop_map(Wire::Output),
    ];
    let argument = (name(), wire).prop_map(|(pin, wire)| Argument { pin, wire, span: NOWHERE });
    (name(), option::of(name()), vec(argument, 0..4), option::of(name())).prop_map(
        |(instance, type_name, arguments, power_output)| {
            ElementKind::Block(BlockCall { instance, type_name, arguments, power_output })
        },
    )
}

fn circuit() -> BoxedStrategy<Circuit> {
    let element = simple_element().prop_recursive(4, 24, 4, |inner| {
        let circuit = circuit_of(inner.clone()).boxed();
        prop_oneof![
            2 => inner,
            2 => circuit.clone().prop_map(ElementKind::Parallel),
            1 => block(circuit),
        ]
    });
    circuit_of(element).boxed()
}

fn variable() -> BoxedStrategy<Variable> {
    use VariableClass::{Constant, Input, Memory, Output};
    let class = prop::sample::select(vec![Input, Output, Memory, Constant]);
    (class, name(), option::of(name()), option::of(address()), option::of(expression()), any::<bool>())
        .prop_map(|(class, name, type_name, address, initial, retain)| Variable {
            class,
            name,
            type_name,
            address,
            initial,
            retain,
            span: NOWHERE,
        })
        .boxed()
}

fn rung() -> BoxedStrategy<Rung> {
    (option::of(name()), option::of("\\PC{0,12}|[\t\r\n\"$\u{1b}a]{0,8}"), any::<bool>(), circuit())
        .prop_map(|(name, title, enabled, circuit)| Rung { name, title, enabled, circuit, span: NOWHERE })
        .boxed()
}

/// Programs without comments, which no front end but one with true spans can place.
pub(crate) fn program() -> impl Strategy<Value = Program> {
    (name(), vec(variable(), 0..6), vec(rung(), 0..4)).prop_map(|(name, variables, rungs)| Program {
        origin: Origin::Native,
        name,
        variables,
        rungs,
        comments: Vec::new(),
    })
}
