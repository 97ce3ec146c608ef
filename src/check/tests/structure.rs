//! Rungs: nodes, blocks, coils that collide, rungs that do nothing.

use thin_vec::thin_vec;

use super::build::*;
use super::*;
use crate::check::{
    Branch, Call, Callee, Circuit, Element, Expression, ExpressionKind, Input, NodeId, Output, PinId, Place, Step,
    VariableId, Wire,
};
use crate::elementary::{Elementary, Value};
use crate::ladder::library::StandardBlock;
use crate::ladder::{BinaryOperator, CoilKind, ContactKind, Variable};

fn place(variable: u32) -> Place {
    Place::of(VariableId(variable))
}

fn contact_on(variable: u32) -> Element {
    let operand = Expression { ty: Elementary::Bool, kind: ExpressionKind::Read(place(variable)) };
    Element::Contact { kind: ContactKind::Open, operand }
}

fn coil_on(variable: u32) -> Element {
    Element::Coil { kind: CoilKind::Plain, target: place(variable) }
}

fn seconds_of(count: i64) -> Expression {
    let value = Value::time(count * 1_000_000_000);
    Expression { ty: Elementary::Time, kind: ExpressionKind::Constant(value) }
}

/// The variables a to d, all BOOL.
fn abcd() -> Vec<Variable> {
    ["_a", "_b", "_c", "_d"].map(|name| memory(name, "BOOL")).to_vec()
}

#[test]
fn a_seal_in_becomes_a_tree_with_everything_resolved() {
    let seal = parallel(vec![branch(vec![open("start")]), branch(vec![open("pump")])]);
    let rungs = vec![named("r10", vec![seal, contact(ContactKind::Closed, read("stop")), coil("pump")])];
    let checked = clean(&program(vec![input("start"), input("stop"), output("pump")], rungs));
    let series = |elements: Vec<Element>| Branch { from: None, elements: elements.into(), to: None };
    let operand = Expression { ty: Elementary::Bool, kind: ExpressionKind::Read(place(1)) };
    let expected = series(vec![
        Element::Parallel(Circuit { branches: Box::new([series(vec![contact_on(0)]), series(vec![contact_on(2)])]) }),
        Element::Contact { kind: ContactKind::Closed, operand },
        coil_on(2),
    ]);
    assert_eq!(checked.units()[0].rungs.len(), 1);
    assert_eq!(checked.units()[0].rungs[0].circuit.branches, [expected].into());
    assert_eq!((checked.units()[0].rungs[0].label.as_str(), checked.units()[0].rungs[0].nodes), ("r10", 0));
}

#[test]
fn rungs_without_a_name_are_numbered_among_all_rungs_and_those_that_are_off_are_left_out() {
    let rungs = vec![off(rung(vec![coil("_a")])), rung(vec![coil("_a")]), named("last", vec![coil("_b")])];
    let checked = clean(&program(abcd(), rungs));
    assert_eq!(checked.units()[0].rungs.iter().map(|rung| rung.label.as_str()).collect::<Vec<_>>(), ["rung 2", "last"]);
}

#[test]
fn a_rung_that_is_off_is_checked_and_its_names_are_used() {
    let rungs = vec![off(rung(vec![open("a"), coil("nobody")]))];
    assert_eq!(findings(&program(vec![input("a")], rungs)), [(Code::UndeclaredName, "nobody".to_owned())]);
}

#[test]
fn a_bridge_of_nodes_is_resolved() {
    let checked = clean(&program(
        abcd(),
        vec![network(vec![
            between("", vec![open("_a")], "w1"),
            between("", vec![open("_b")], "W2"),
            between("w1", vec![open("_c")], "w2"),
            between("w1", vec![coil("_c")], ""),
            between("w2", vec![coil("_d")], ""),
        ])],
    ));
    let of = |from: Option<u32>, element: Element, to: Option<u32>| Branch {
        from: from.map(NodeId),
        elements: Box::new([element]),
        to: to.map(NodeId),
    };
    let expected = [
        of(None, contact_on(0), Some(0)),
        of(None, contact_on(1), Some(1)),
        of(Some(0), contact_on(2), Some(1)),
        of(Some(0), coil_on(2), None),
        of(Some(1), coil_on(3), None),
    ];
    assert_eq!(
        (checked.units()[0].rungs[0].nodes, &*checked.units()[0].rungs[0].circuit.branches),
        (2, expected.as_slice())
    );
}

#[test]
fn nodes_are_fed_before_they_are_used_and_used_in_their_rung() {
    let never_fed = vec![between("w1", vec![coil("_a")], "")];
    let fed_late = vec![
        between("", vec![open("_a")], "w1"),
        between("w1", vec![coil("_b")], ""),
        between("", vec![open("_c")], "W1"),
    ];
    let fed_only_later = vec![between("w2", vec![coil("_b")], ""), between("", vec![open("_c")], "W2")];
    let itself = vec![between("w3", vec![coil("_b")], "w3")];
    let never_used = || network(vec![between("", vec![coil("_a")], "w4")]);
    table(vec![
        (program(abcd(), vec![network(never_fed)]), Code::NodeMisuse, "w1"),
        (program(abcd(), vec![network(fed_late)]), Code::NodeMisuse, "W1"),
        (program(abcd(), vec![network(fed_only_later)]), Code::NodeMisuse, "w2"),
        (program(abcd(), vec![network(itself)]), Code::NodeMisuse, "w3"),
        (program(abcd(), vec![never_used()]), Code::NodeMisuse, "w4"),
    ]);
    let in_another_rung = network(vec![between("w4", vec![coil("_b")], "")]);
    let both = ["w4", "w4"].map(|node| (Code::NodeMisuse, node.to_owned()));
    assert_eq!(findings(&program(abcd(), vec![never_used(), in_another_rung])), both);
}

#[test]
fn power_feeds_the_first_bool_input_unless_that_is_wired() {
    let variables = vec![input("a"), memory("n", "INT"), output("q")];
    let left =
        vec![open("a"), call("c:CTUD", vec![value("CD", read("a")), value("PV", int(9)), to("CV", "n")]), coil("q")];
    let checked = clean(&program(variables.clone(), vec![rung(left)]));
    let constant = |value: i128| Expression {
        ty: Elementary::Int,
        kind: ExpressionKind::Constant(Value::integer(Elementary::Int, value).unwrap()),
    };
    let read_a = || Expression { ty: Elementary::Bool, kind: ExpressionKind::Read(place(0)) };
    let input_of = |pin, value| Input { pin, wire: Wire::Value(value) };
    let expected = Call {
        callee: Callee::Standard(StandardBlock::Ctud, place(3)),
        enable: None,
        power_input: Some(0),
        inputs: vec![input_of(1, read_a()), input_of(4, constant(9))],
        references: vec![],
        outputs: vec![(Output::Pin(2), place(1))],
        power_output: Output::Pin(0),
    };
    assert_eq!(checked.units()[0].rungs[0].circuit.branches[0].elements[1], Element::Call(Box::new(expected.clone())));

    let enabled = vec![
        call_through("c:CTUD", vec![value("PV", int(9)), value("cu", read("a")), to("CV", "n")], Some("qd")),
        coil("q"),
    ];
    let checked = clean(&program(variables, vec![rung(enabled)]));
    let inputs = vec![input_of(4, constant(9)), input_of(0, read_a())];
    let expected = Call { power_input: None, power_output: Output::Pin(1), inputs, ..expected };
    assert_eq!(checked.units()[0].rungs[0].circuit.branches[0].elements[0], Element::Call(Box::new(expected)));
}

#[test]
fn a_circuit_may_be_wired_to_a_bool_input() {
    let timer = call("t:TON", vec![wired("IN", vec![open("a")]), value("PT", seconds(2))]);
    let checked = clean(&program(vec![input("a"), output("q")], vec![rung(vec![timer, coil("q")])]));
    let branch = Branch { from: None, elements: Box::new([contact_on(0)]), to: None };
    let expected = Call {
        callee: Callee::Standard(StandardBlock::Ton, place(2)),
        enable: None,
        power_input: None,
        inputs: vec![
            Input { pin: 0, wire: Wire::Circuit(Circuit { branches: Box::new([branch]) }) },
            Input { pin: 1, wire: Wire::Value(seconds_of(2)) },
        ],
        references: vec![],
        outputs: vec![],
        power_output: Output::Pin(0),
    };
    assert_eq!(checked.units()[0].rungs[0].circuit.branches[0].elements[0], Element::Call(Box::new(expected)));
}

#[test]
fn members_are_read_and_written_by_pin() {
    let rungs =
        vec![rung(vec![call("t:TON", vec![]), assign("t.PT", seconds(1))]), rung(vec![assign("_e", read("T.et"))])];
    let checked = clean(&program(vec![memory("_e", "TIME")], rungs));
    let pin = |pin| Place { path: thin_vec![Step::Pin(pin)], ..place(1) };
    let assignment = |rung: usize, at: usize| checked.units()[0].rungs[rung].circuit.branches[0].elements[at].clone();
    assert_eq!(assignment(0, 1), Element::Assignment { target: pin(PinId::Input(1)), value: Box::new(seconds_of(1)) });
    let elapsed = Expression { ty: Elementary::Time, kind: ExpressionKind::Read(pin(PinId::Output(1))) };
    assert_eq!(assignment(1, 0), Element::Assignment { target: place(0), value: Box::new(elapsed) });
}

#[test]
fn faults_of_calls_point_at_the_pin() {
    let calling =
        |element| program([abcd(), vec![memory("_n", "INT"), memory("_t", "TON")]].concat(), vec![rung(vec![element])]);
    table(vec![
        (calling(call("t:TON", vec![value("PTT", seconds(1))])), Code::UnknownPin, "PTT"),
        (calling(call("t:TON", vec![value("Q", truth(true))])), Code::UnknownPin, "Q"),
        (calling(call("t:TON", vec![to("IN", "_a")])), Code::UnknownPin, "IN"),
        (calling(call("t:TON", vec![value("PT", seconds(1)), value("pt", seconds(2))])), Code::DuplicatePin, "pt"),
        (calling(call("t:TON", vec![to("Q", "_a"), to("Q", "_b")])), Code::DuplicatePin, "Q"),
        (calling(call("t:TON", vec![value("PT", int(5))])), Code::TypeMismatch, "5"),
        (calling(call("t:TON", vec![wired("PT", vec![open("_a")])])), Code::TypeMismatch, "circuit"),
        (calling(call("t:TON", vec![to("ET", "_n")])), Code::TypeMismatch, "_n"),
        (calling(call_through("t:TON", vec![], Some("ET"))), Code::PowerNotTaken, "ET"),
        (calling(call_through("t:TON", vec![], Some("QD"))), Code::UnknownPin, "QD"),
        (calling(call("_t:TOF", vec![])), Code::TypeMismatch, "TOF"),
        (calling(call("_a:TOF", vec![])), Code::TypeMismatch, "_a"),
        (calling(call("_a", vec![])), Code::TypeMismatch, "_a"),
        (calling(call("t:INT", vec![])), Code::TypeMismatch, "INT"),
        (calling(call("nobody", vec![])), Code::UndeclaredName, "nobody"),
    ]);
}

#[test]
fn a_call_of_an_unknown_type_is_checked_all_the_same() {
    let variables = vec![memory("_a", "BOOL").at("%IX0.0"), memory("_n", "INT")];
    let arguments = vec![value("X", read("nobody")), wired("Y", vec![open("_n")]), to("Z", "_a")];
    let found = findings(&program(variables, vec![rung(vec![call("t:NONE", arguments)])]));
    let expected = [
        (Code::UndeclaredName, "nobody"),
        (Code::TypeMismatch, "_n"),
        (Code::CoilOnInput, "_a"),
        (Code::UnknownType, "NONE"),
    ];
    assert_eq!(found, expected.map(|(code, text)| (code, text.to_owned())));
}

#[test]
fn an_arrow_the_wrong_way_is_told_the_other() {
    let hint = |argument| only(&program(abcd(), vec![rung(vec![call("t:TON", vec![argument])])])).hint;
    assert_eq!(hint(value("Q", truth(true))).as_deref(), Some("`Q` is an output: write `Q => variable`"));
    assert_eq!(hint(to("IN", "_a")).as_deref(), Some("`IN` is an input: write `IN := value`"));
    assert_eq!(hint(value("X", int(1))).as_deref(), Some("its inputs are `IN`, `PT`"));
}

#[test]
fn two_coils_of_which_one_always_writes_collide() {
    let colliding = |first, second| {
        program(abcd(), vec![named("r1", vec![coil_of(first, "_a")]), named("r2", vec![coil_of(second, "_A")])])
    };
    for kind in
        [CoilKind::Plain, CoilKind::Negated, CoilKind::Set, CoilKind::Reset, CoilKind::Rising, CoilKind::Falling]
    {
        assert_eq!(findings(&colliding(CoilKind::Plain, kind)), [(Code::DoubleCoil, "(_A)".to_owned())], "{kind:?}");
    }
    clean(&colliding(CoilKind::Set, CoilKind::Reset));
    clean(&colliding(CoilKind::Set, CoilKind::Set));
    let found = only(&colliding(CoilKind::Plain, CoilKind::Negated));
    assert_eq!(found.message, "`_a` is written by coils in rung r1 and rung r2");
    let related: Vec<_> = found.related.iter().map(|(span, note)| (text_at(*span), note.as_str())).collect();
    assert_eq!(related, [("(_a)".to_owned(), "`_a` is written here, in rung r1")]);
}

#[test]
fn coils_collide_at_one_address_and_on_one_bit_and_once_per_variable() {
    let shared = vec![memory("_a", "BOOL").at("%QX0.0"), memory("_b", "BOOL").at("%QX0.0"), memory("_w", "WORD")];
    let all = |coils: &[&str]| program(shared.clone(), coils.iter().map(|name| rung(vec![coil(name)])).collect());
    assert_eq!(findings(&all(&["_a", "_b"])), [(Code::DoubleCoil, "(_b)".to_owned())]);
    assert_eq!(findings(&all(&["_a", "%QX0.0", "_a"])), [(Code::DoubleCoil, "(_a)".to_owned())]);
    assert_eq!(findings(&all(&["_w.1", "_w.1"])), [(Code::DoubleCoil, "(_w.1)".to_owned())]);
    clean(&all(&["_w.1", "_w.2"]));
    clean(&program(shared, vec![rung(vec![coil("_a")]), off(rung(vec![coil("_a")]))]));
}

#[test]
fn an_instance_that_is_called_twice_is_reported_once() {
    let three = || (0..3).map(|_| rung(vec![call("t:TON", vec![])])).collect();
    let found = only(&program(vec![], three()));
    assert_eq!((found.code, found.message.as_str()), (Code::RepeatedBlock, "`t` is called in rung 1 and rung 3"));
}

#[test]
fn a_rung_all_of_whose_coils_lack_power_for_ever_never_conducts() {
    let of = |elements| program(abcd(), vec![rung(elements)]);
    let constant_false = vec![constant("no", "BOOL", truth(false))];
    let with_constant = program([abcd(), constant_false].concat(), vec![rung(vec![open("no"), coil("_a")])]);
    let dead = || branch(vec![open("_b"), fixed(false)]);
    let nodes = vec![
        between("", vec![fixed(false)], "w"),
        between("", vec![fixed(false)], "w"),
        between("w", vec![coil("_a")], ""),
    ];
    let edge = |kind, value| of(vec![contact(kind, truth(value)), coil("_a")]);
    table(vec![
        (of(vec![fixed(false), open("_b"), coil("_a")]), Code::NeverConducts, "FALSE"),
        (with_constant, Code::NeverConducts, "no"),
        (edge(ContactKind::Closed, true), Code::NeverConducts, "TRUE"),
        (edge(ContactKind::Rising, false), Code::NeverConducts, "FALSE"),
        (edge(ContactKind::Falling, true), Code::NeverConducts, "TRUE"),
        (
            of(vec![when(binary(int(1), BinaryOperator::Greater, int(2))), assign("_a", truth(true))]),
            Code::NeverConducts,
            "1 > 2",
        ),
        (of(vec![parallel(vec![dead(), dead()]), coil("_a")]), Code::NeverConducts, "FALSE"),
        (program(abcd(), vec![network(nodes)]), Code::NeverConducts, "FALSE"),
    ]);
}

#[test]
fn a_rung_in_which_some_coil_may_have_power_conducts() {
    let of = |elements| program(abcd(), vec![rung(elements)]);
    let dead = || branch(vec![fixed(false)]);
    let live = || branch(vec![open("_b")]);
    clean(&of(vec![fixed(false), call("t:TOF", vec![]), coil("_a")]));
    clean(&of(vec![parallel(vec![dead(), live()]), coil("_a")]));
    clean(&of(vec![parallel(vec![branch(vec![fixed(false), coil("_a")]), branch(vec![coil("_b")])])]));
    clean(&of(vec![contact(ContactKind::Rising, truth(true)), coil("_a")]));
    let nodes =
        vec![between("", vec![fixed(false)], "w"), between("", vec![], "w"), between("w", vec![coil("_a")], "")];
    clean(&program(abcd(), vec![network(nodes)]));
}

#[test]
fn a_rung_without_effect_is_empty() {
    table(vec![
        (program(abcd(), vec![rung(vec![])]), Code::EmptyRung, "rung"),
        (program(abcd(), vec![rung(vec![open("_a")])]), Code::EmptyRung, "rung"),
    ]);
    clean(&program(vec![], vec![rung(vec![call("t:TON", vec![])])]));
}
