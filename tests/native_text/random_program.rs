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
    let root = prop_oneof![4 => name().prop_map(Root::Name), 1 => address().prop_map(|address| Root::Address(Box::new(address)))];
    let step = prop_oneof![
        2 => name().prop_map(Step::Member),
        2 => any::<u8>().prop_map(|bit| Step::Bit(bit, NOWHERE)),
        1 => vec(index(), 1..3).prop_map(|indices| Step::Index(indices, NOWHERE)),
    ];
    (root, prop_oneof![3 => Just(Vec::new()), 1 => vec(step, 1..3)])
        .prop_map(|(root, steps)| Reference { root, steps: steps.into(), span: NOWHERE })
        .boxed()
}

fn index() -> BoxedStrategy<Expression> {
    let name = name().prop_map(|name| ExpressionKind::Read(Reference::of_name(name)));
    let sum = (literal(), literal()).prop_map(|(left, right)| {
        let operand = |value| Box::new(Expression { kind: ExpressionKind::Literal(value), span: NOWHERE });
        ExpressionKind::Binary(BinaryOperator::Add, operand(left), operand(right))
    });
    prop_oneof![name, literal().prop_map(ExpressionKind::Literal), sum]
        .prop_map(|kind| Expression { kind, span: NOWHERE })
        .boxed()
}

/// What can be called: an instance does not start with an address or end with a bit.
fn instance_reference() -> BoxedStrategy<Reference> {
    let operators = prop::sample::select(vec!["NOT", "and", "MOD", "Xor", "OR"]);
    let callable = |reference: &Reference| {
        matches!(reference.root, Root::Name(_)) && !matches!(reference.steps.last(), Some(Step::Bit(..)))
    };
    prop_oneof![
        2 => name().prop_map(Reference::of_name),
        1 => operators.prop_map(|operator| Reference::of_name(Name::new(operator, NOWHERE))),
        1 => reference().prop_filter("callable", callable),
    ]
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
        integer.prop_map(|(value, base, ty)| Literal::Integer { value: value.into(), base, ty }),
        real.prop_filter("finite", |(value, _)| value.is_finite())
            .prop_map(|(value, ty)| Literal::Real { value: value.abs(), ty }),
        any::<i64>().prop_map(Literal::Time),
        (name(), name()).prop_map(|(ty, value)| Literal::Enumerated { ty: Box::new(ty), value: Box::new(value) }),
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

fn statement_call() -> BoxedStrategy<StatementKind> {
    let wire = prop_oneof![expression().prop_map(Wire::Value), reference().prop_map(Wire::Output)];
    let argument = (option::of(name()), wire).prop_map(|(pin, wire)| {
        let by_place = matches!(wire, Wire::Value(_));
        let unnamed = if by_place { "" } else { "Q" };
        Argument { pin: pin.unwrap_or_else(|| Name::new(unnamed, NOWHERE)), wire, span: NOWHERE }
    });
    (instance_reference(), vec(argument, 0..4))
        .prop_map(|(instance, arguments)| {
            StatementKind::Call(BlockCall { instance, type_name: None, arguments, power_output: None })
        })
        .boxed()
}

fn statement() -> BoxedStrategy<Statement> {
    let place = |kind| Statement { kind, span: NOWHERE };
    let simple = prop_oneof![
        3 => (reference(), expression()).prop_map(|(target, value)| StatementKind::Assignment { target, value }),
        2 => statement_call(),
        1 => Just(StatementKind::Exit),
        1 => Just(StatementKind::Return),
    ];
    simple
        .prop_map(place)
        .prop_recursive(3, 16, 3, move |inner| {
            let body = || vec(inner.clone(), 0..3);
            let conditional =
                (expression(), body()).prop_map(|(condition, body)| ConditionalBranch { condition, body });
            let label = (expression(), option::of(expression())).prop_map(|(first, last)| CaseLabel { first, last });
            let case = (vec(label, 1..3), body()).prop_map(|(labels, body)| CaseBranch { labels, body });
            prop_oneof![
                (vec(conditional, 1..3), body())
                    .prop_map(|(branches, otherwise)| StatementKind::If { branches, otherwise }),
                (expression(), vec(case, 0..3), body())
                    .prop_map(|(selector, branches, otherwise)| StatementKind::Case { selector, branches, otherwise }),
                (reference(), expression(), expression(), option::of(expression()), body()).prop_map(
                    |(variable, first, last, step, body)| StatementKind::For { variable, first, last, step, body }
                ),
            ]
            .prop_map(place)
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
        1 => (reference(), expression()).prop_map(|(target, value)| ElementKind::Assignment { target, value: Box::new(value) }),
        1 => vec(statement(), 0..4).prop_map(ElementKind::Statements),
        1 => name().prop_map(|target| ElementKind::Jump { target }),
        1 => Just(ElementKind::Return),
    ]
    .boxed()
}

fn circuit_of(element: impl Strategy<Value = ElementKind> + Clone) -> impl Strategy<Value = Circuit> {
    let element = element.prop_map(|kind| Element { kind, span: NOWHERE });
    let node = || prop_oneof![8 => Just(None), 1 => name().prop_map(Some)];
    let branch = (node(), vec(element, 0..5), node()).prop_map(|(from, elements, to)| Branch {
        from: from.map(Box::new),
        elements,
        to: to.map(Box::new),
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
    (instance_reference(), option::of(name()), vec(argument, 0..4), option::of(name())).prop_map(
        |(instance, type_name, arguments, power_output)| {
            // The type is named where the instance is declared, by its name alone.
            let type_name = type_name.filter(|_| instance.steps.is_empty());
            ElementKind::Block(Box::new(BlockCall { instance, type_name, arguments, power_output }))
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

fn type_reference() -> BoxedStrategy<TypeReference> {
    let dimension = (expression(), expression()).prop_map(|(first, last)| Dimension { first, last });
    (prop_oneof![3 => Just(Vec::new()), 1 => vec(dimension, 1..3)], name())
        .prop_map(|(dimensions, name)| TypeReference { dimensions: dimensions.into(), name, span: NOWHERE })
        .boxed()
}

/// An expression, or the values of an array or a structure.
fn initial() -> BoxedStrategy<Expression> {
    let kind = |kind| Expression { kind, span: NOWHERE };
    expression()
        .prop_recursive(3, 12, 3, move |inner| {
            let repeated = (option::of(expression()), option::of(inner.clone())).prop_map(|(repeat, value)| {
                // Without a number of times there is a value.
                let value = value.or_else(|| if repeat.is_none() { Some(bare()) } else { None });
                ArrayItem { repeat, value }
            });
            let member = (name(), inner).prop_map(|(member, value)| MemberValue { member, value });
            prop_oneof![
                vec(repeated, 0..4).prop_map(ExpressionKind::Array),
                vec(member, 1..4).prop_map(ExpressionKind::Structure),
            ]
            .prop_map(kind)
        })
        .boxed()
}

fn bare() -> Expression {
    Expression { kind: ExpressionKind::Literal(Literal::Bool(true)), span: NOWHERE }
}

fn variables(classes: Vec<VariableClass>) -> BoxedStrategy<Vec<Variable>> {
    let class = prop::sample::select(classes);
    let variable =
        (class, name(), option::of(type_reference()), option::of(address()), option::of(initial()), any::<bool>())
            .prop_map(|(class, name, ty, address, initial, retain)| Variable {
                class,
                name,
                ty,
                address: address.map(Box::new),
                initial: initial.map(Box::new),
                retain,
                span: NOWHERE,
            });
    vec(variable, 0..4).boxed()
}

fn rung() -> BoxedStrategy<Rung> {
    (option::of(name()), option::of("\\PC{0,12}|[\t\r\n\"$\u{1b}a]{0,8}"), any::<bool>(), circuit())
        .prop_map(|(name, title, enabled, circuit)| Rung {
            name,
            title: title.map(Into::into),
            enabled,
            circuit,
            span: NOWHERE,
        })
        .boxed()
}

fn unit() -> BoxedStrategy<Unit> {
    use VariableClass::{Constant, InOut, Input, Memory, Output, Temporary};
    let kind = prop_oneof![
        option::of(name()).prop_map(|task| UnitKind::Program { task }),
        Just(UnitKind::FunctionBlock),
        option::of(type_reference()).prop_map(|result| UnitKind::Function { result }),
    ];
    let variables = variables(vec![Input, Output, Memory, Constant, InOut, Temporary]);
    (kind, name(), variables, vec(rung(), 0..3))
        .prop_map(|(kind, name, variables, rungs)| Unit { kind, name, variables, rungs, span: NOWHERE })
        .boxed()
}

fn type_declaration() -> BoxedStrategy<TypeDeclaration> {
    let field =
        (name(), type_reference(), option::of(initial())).prop_map(|(name, ty, initial)| Field { name, ty, initial });
    let values = vec((name(), option::of(expression())), 1..12);
    let kind =
        prop_oneof![
            (type_reference(), option::of(initial())).prop_map(|(ty, initial)| TypeKind::Alias { ty, initial }),
            vec(field, 0..4).prop_map(TypeKind::Structure),
            (option::of(name()), values, option::of(name()))
                .prop_map(|(base, values, initial)| TypeKind::Enumeration { base, values, initial }),
        ];
    (name(), kind).prop_map(|(name, kind)| TypeDeclaration { name, kind, span: NOWHERE }).boxed()
}

fn task() -> BoxedStrategy<Task> {
    (name(), option::of(expression()), option::of(expression()))
        .prop_map(|(name, interval, priority)| Task { name, interval, priority, span: NOWHERE })
        .boxed()
}

fn instance() -> BoxedStrategy<ProgramInstance> {
    (name(), name(), option::of(name()))
        .prop_map(|(name, program, task)| ProgramInstance { name, program, task, span: NOWHERE })
        .boxed()
}

/// Programs without comments, which no front end but one with true spans can place.
pub(crate) fn program() -> impl Strategy<Value = Program> {
    use VariableClass::{Constant, Memory};
    let setting = (name(), expression()).prop_map(|(name, value)| Setting { name, value });
    let registers = vec(setting, 0..3).prop_map(|settings| Registers { settings, span: NOWHERE });
    (
        vec(type_declaration(), 0..3),
        option::of(registers),
        variables(vec![Memory, Constant]),
        vec(task(), 0..3),
        vec(unit(), 1..4),
        vec(instance(), 0..3),
    )
        .prop_map(|(types, registers, globals, tasks, units, instances)| {
            let mut programs = units.iter().filter(|unit| matches!(unit.kind, UnitKind::Program { .. }));
            let name = match (programs.next(), programs.next()) {
                (Some(only), None) => only.name.clone(),
                _ => Name::new("test", NOWHERE),
            };
            let empty = Program::empty(Origin::Native, name);
            Program { types, globals, registers, tasks, units, instances, ..empty }
        })
}
