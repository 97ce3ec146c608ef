//! What each element computes, as whole traces: the evaluator and every engine must give them.

use rung::elementary::{Elementary, Value};
use rung::ladder::library::StandardBlock;
use rung::ladder::{
    BinaryOperator, Branch, Circuit, CoilKind, ContactKind, Element, ElementKind, Expression, ExpressionKind, Literal,
    Program, UnaryOperator, VariableClass, Wire,
};

use crate::support::drawing::{
    NOWHERE, argument, branch, call, coil, contact, contact_of, element, expression, integer, name, parallel, program,
    read, reference, rung, variable,
};
use crate::support::oracle::Oracle;
use crate::support::rig::{Rig, checked};

/// A program with BOOL inputs `a` and `b`, outputs `x` and `y`, INT memory `n` and REAL memory `z`.
fn drawn(rungs: Vec<Vec<Element>>) -> Program {
    let mut program = program("elements");
    for (class, text, ty) in [
        (VariableClass::Input, "a", Elementary::Bool),
        (VariableClass::Input, "b", Elementary::Bool),
        (VariableClass::Output, "x", Elementary::Bool),
        (VariableClass::Output, "y", Elementary::Bool),
        (VariableClass::Memory, "n", Elementary::Int),
        (VariableClass::Memory, "z", Elementary::Real),
        (VariableClass::Memory, "w", Elementary::Word),
    ] {
        program.units[0].variables.push(variable(class, text, ty));
    }
    program.units[0].rungs = rungs.into_iter().map(rung).collect();
    program
}

/// The values of a name after scans a second apart, with `a` and `b` as two lists of 0 and 1 say.
fn trace(program: &Program, watched: &str, a: &str, b: &str) -> Vec<Value> {
    let checked = checked(program).unwrap();
    let mut oracle = Oracle::new(&checked);
    let scans = a.bytes().zip(b.bytes()).enumerate();
    scans
        .map(|(scan, (a, b))| {
            oracle.set("a", Value::bool(a == b'1'));
            oracle.set("b", Value::bool(b == b'1'));
            oracle.scan(i64::try_from(scan).unwrap() * 1_000_000_000);
            oracle.get(watched)
        })
        .collect()
}

/// The same of a BOOL, as 0 and 1.
fn bits(program: &Program, watched: &str, a: &str, b: &str) -> String {
    trace(program, watched, a, b).iter().map(|value| if value.is_true() { '1' } else { '0' }).collect()
}

/// Runs the same on every engine.
fn engines_agree(program: &Program, a: &str, b: &str) {
    let checked = checked(program).unwrap();
    let mut rig = Rig::new(&checked).unwrap();
    for (scan, (a, b)) in a.bytes().zip(b.bytes()).enumerate() {
        rig.set("a", Value::bool(a == b'1'));
        rig.set("b", Value::bool(b == b'1'));
        let same = rig.scan(i64::try_from(scan).unwrap() * 1_000_000_000);
        same.unwrap_or_else(|difference| panic!("scan {scan}: {difference:?}"));
    }
}

fn through(kind: ContactKind) -> String {
    let program = drawn(vec![vec![contact("b"), contact_of(kind, "a"), coil(CoilKind::Plain, "x")]]);
    bits(&program, "x", "0011010110", "1111111000")
}

#[test]
fn contacts_pass_power_as_their_operand_says() {
    assert_eq!(through(ContactKind::Open), "0011010000");
    assert_eq!(through(ContactKind::Closed), "1100101000");
}

#[test]
fn an_edge_contact_remembers_its_operand_whether_or_not_it_has_power() {
    let edges = |kind| {
        let program = drawn(vec![vec![contact("b"), contact_of(kind, "a"), coil(CoilKind::Plain, "x")]]);
        bits(&program, "x", "0110111010", "1111001111")
    };
    // The rise in scan 4 comes without power and is over when power comes back in scan 6.
    assert_eq!(edges(ContactKind::Rising), "0100000010");
    // FALSE on the first scan is a fall, for M starts at 0.
    assert_eq!(edges(ContactKind::Falling), "1001000101");
}

#[test]
fn two_edge_contacts_on_one_variable_have_a_memory_each() {
    let rising = || contact_of(ContactKind::Rising, "a");
    let rungs = vec![vec![rising(), coil(CoilKind::Plain, "x")], vec![rising(), coil(CoilKind::Plain, "y")]];
    assert_eq!(bits(&drawn(rungs.clone()), "x", "0110", "0000"), "0100");
    assert_eq!(bits(&drawn(rungs), "y", "0110", "0000"), "0100");
}

fn driven(kind: CoilKind) -> String {
    bits(&drawn(vec![vec![contact("a"), coil(kind, "x")]]), "x", "00110100", "00000000")
}

#[test]
fn coils_write_what_their_kind_says() {
    assert_eq!(driven(CoilKind::Plain), "00110100");
    assert_eq!(driven(CoilKind::Negated), "11001011");
    assert_eq!(driven(CoilKind::Set), "00111111");
    assert_eq!(driven(CoilKind::Reset), "00000000");
    assert_eq!(driven(CoilKind::Rising), "00100100");
    // No power on the first scan is a fall, for M starts at 0.
    assert_eq!(driven(CoilKind::Falling), "10001010");
}

#[test]
fn of_a_set_and_a_reset_coil_the_later_one_wins() {
    let set = vec![contact("a"), coil(CoilKind::Set, "x")];
    let reset = vec![contact("b"), coil(CoilKind::Reset, "x")];
    assert_eq!(bits(&drawn(vec![set.clone(), reset.clone()]), "x", "010010", "000110"), "011000");
    assert_eq!(bits(&drawn(vec![reset, set]), "x", "010010", "000110"), "011011");
}

#[test]
fn every_coil_passes_its_left_power_on() {
    for kind in
        [CoilKind::Plain, CoilKind::Negated, CoilKind::Set, CoilKind::Reset, CoilKind::Rising, CoilKind::Falling]
    {
        let program = drawn(vec![vec![contact("a"), coil(kind, "x"), coil(CoilKind::Plain, "y")]]);
        assert_eq!(bits(&program, "y", "0110", "0000"), "0110", "{kind:?}");
    }
}

#[test]
fn what_a_coil_writes_is_seen_later_in_the_same_scan_and_earlier_in_the_next() {
    let rungs = vec![
        vec![contact("x"), coil(CoilKind::Plain, "y")],
        vec![contact("a"), coil(CoilKind::Plain, "x"), contact("x"), assign("n", add("n", 1))],
    ];
    assert_eq!(bits(&drawn(rungs.clone()), "y", "0110", "0000"), "0011");
    assert_eq!(integers(&drawn(rungs), "n", "0110"), [0, 1, 2, 2]);
}

#[test]
fn parallel_branches_or_and_all_of_them_run() {
    let branches = vec![branch(vec![contact("a"), coil(CoilKind::Plain, "y")]), branch(vec![contact("b")])];
    let program = drawn(vec![vec![parallel(branches), coil(CoilKind::Plain, "x")]]);
    assert_eq!(bits(&program, "x", "0101", "0011"), "0111");
    assert_eq!(bits(&program, "y", "0101", "0011"), "0101");
}

#[test]
fn a_bridge_of_nodes_conducts_along_every_path() {
    let to = |node: &str, elements| Branch { to: Some(Box::new(name(node))), ..branch(elements) };
    let from = |node: &str, elements| Branch { from: Some(Box::new(name(node))), ..branch(elements) };
    let branches = vec![
        to("left", vec![contact("a")]),
        to("right", vec![contact("b")]),
        Branch { from: Some(Box::new(name("left"))), ..to("right", vec![contact_of(ContactKind::Closed, "b")]) },
        from("right", vec![coil(CoilKind::Plain, "x")]),
        from("left", vec![contact("b")]),
    ];
    let program = drawn(vec![vec![parallel(branches), coil(CoilKind::Plain, "y")]]);
    assert_eq!(bits(&program, "x", "0101", "0011"), "0111");
    assert_eq!(bits(&program, "y", "0101", "0011"), "0111");
}

#[test]
fn a_block_without_power_runs_all_the_same_and_its_output_may_be_power() {
    let timer = call("t", StandardBlock::Tof, vec![argument("PT", Wire::Value(time(2_000_000_000)))]);
    let program = drawn(vec![vec![contact("a"), timer, coil(CoilKind::Plain, "x")]]);
    assert_eq!(bits(&program, "x", "0100000", "0000000"), "0111000");
}

#[test]
fn without_enable_a_block_holds_its_outputs_and_writes_none() {
    let count = argument("CV", Wire::Output(reference("n")));
    let arguments = vec![argument("CU", Wire::Value(read("b"))), argument("PV", Wire::Value(integer(9))), count];
    let program = drawn(vec![
        vec![contact("a"), call("c", StandardBlock::Ctu, arguments), coil(CoilKind::Plain, "x")],
        vec![contact_of(ContactKind::Closed, "a"), assign("n", integer(9))],
    ]);
    assert_eq!(integers_of(&program, "n", "1100111", "1010101"), [1, 1, 9, 9, 2, 2, 3]);
    assert_eq!(integers_of(&program, "c.CV", "1100111", "1010101"), [1, 1, 1, 1, 2, 2, 3]);
}

#[test]
fn on_the_right_of_a_block_without_a_bool_output_the_power_is_eno() {
    let always = drawn(vec![vec![
        contact("a"),
        call("d", StandardBlock::Derivative, vec![argument("XIN", Wire::Value(read("z")))]),
        coil(CoilKind::Plain, "x"),
    ]]);
    assert_eq!(bits(&always, "x", "0101", "0000"), "1111", "the power is RUN, so that the block always runs");
    let enabled = drawn(vec![vec![
        contact("a"),
        call("d", StandardBlock::Derivative, vec![argument("RUN", Wire::Value(read("b")))]),
        coil(CoilKind::Plain, "x"),
    ]]);
    assert_eq!(bits(&enabled, "x", "0101", "0011"), "0101", "the power is EN");
}

#[test]
fn of_a_block_without_a_bool_input_the_power_on_the_left_is_en() {
    let inputs = vec![argument("XIN1", Wire::Value(integer(1)))];
    let program =
        drawn(vec![vec![contact("a"), call("h", StandardBlock::Hysteresis, inputs), coil(CoilKind::Plain, "x")]]);
    assert_eq!(bits(&program, "x", "0010", "0000"), "0011");
}

#[test]
fn a_circuit_at_a_pin_starts_at_the_left_rail_and_runs_whatever_the_power_is() {
    let circuit = Circuit { branches: vec![branch(vec![contact("b"), coil(CoilKind::Plain, "y")])], span: NOWHERE };
    let latch = call("s", StandardBlock::Rs, vec![argument("R1", Wire::Circuit(circuit))]);
    let program = drawn(vec![vec![contact("a"), latch, coil(CoilKind::Plain, "x")]]);
    assert_eq!(bits(&program, "x", "010010", "000110"), "011000");
    assert_eq!(bits(&program, "y", "010010", "000110"), "000110");
}

#[test]
fn a_call_runs_with_what_a_call_of_the_same_instance_at_one_of_its_pins_left_on_the_others() {
    let inner = vec![contact("b"), call("s", StandardBlock::Rs, Vec::new()), contact_of(ContactKind::Closed, "b")];
    let circuit = Circuit { branches: vec![branch(inner)], span: NOWHERE };
    let latch = call("s", StandardBlock::Rs, vec![argument("R1", Wire::Circuit(circuit))]);
    let program = drawn(vec![vec![contact("a"), latch, coil(CoilKind::Plain, "x")]]);
    let (a, b) = ("1011", "0100");
    // S of the outer call is `a` at first, and then `b`, from the inner one.
    assert_eq!(bits(&program, "x", a, b), "0100");
    engines_agree(&program, a, b);
}

#[test]
fn an_assignment_writes_only_under_power_and_passes_it_on() {
    let program = drawn(vec![vec![contact("a"), assign("n", add("n", 5)), coil(CoilKind::Plain, "x")]]);
    assert_eq!(integers(&program, "n", "01101"), [0, 5, 10, 10, 15]);
    assert_eq!(bits(&program, "x", "01101", "00000"), "01101");
}

#[test]
fn integers_wrap_around_and_what_is_divided_by_zero_is_zero() {
    let with = |start: i128, operator, operand| {
        let rungs = vec![vec![assign("n", integer(start)), assign("n", binary(operator, read("n"), operand))]];
        integers(&drawn(rungs), "n", "0")[0]
    };
    let zero = || binary(BinaryOperator::Subtract, read("n"), read("n"));
    assert_eq!(with(32767, BinaryOperator::Add, integer(1)), -32768);
    assert_eq!(with(-32768, BinaryOperator::Subtract, integer(1)), 32767);
    assert_eq!(with(-32768, BinaryOperator::Divide, integer(-1)), -32768);
    assert_eq!(with(300, BinaryOperator::Multiply, integer(300)), 24464);
    assert_eq!(with(-7, BinaryOperator::Divide, integer(2)), -3);
    assert_eq!(with(-7, BinaryOperator::Modulo, integer(2)), -1);
    assert_eq!(with(7, BinaryOperator::Divide, zero()), 0);
    assert_eq!(with(7, BinaryOperator::Modulo, zero()), 0);
}

#[test]
fn reals_follow_ieee_754_with_one_nan() {
    let with = |left: f64, operator, right: f64| {
        let rungs = vec![vec![assign("z", real(left)), assign("z", binary(operator, read("z"), real(right)))]];
        trace(&drawn(rungs), "z", "0", "0")[0].bits()
    };
    assert_eq!(with(1.0, BinaryOperator::Divide, 0.0), u64::from(f32::INFINITY.to_bits()));
    assert_eq!(with(0.0, BinaryOperator::Divide, 0.0), 0x7FC0_0000);
    assert_eq!(with(0.1, BinaryOperator::Add, 0.2), u64::from((0.1_f32 + 0.2_f32).to_bits()));
    let nan = vec![
        vec![assign("z", binary(BinaryOperator::Subtract, read("z"), read("z")))],
        vec![assign("z", binary(BinaryOperator::Divide, read("z"), read("z")))],
        vec![condition(binary(BinaryOperator::Equal, read("z"), read("z"))), coil(CoilKind::Plain, "x")],
        vec![condition(binary(BinaryOperator::NotEqual, read("z"), read("z"))), coil(CoilKind::Plain, "y")],
    ];
    assert_eq!((bits(&drawn(nan.clone()), "x", "0", "0"), bits(&drawn(nan), "y", "0", "0")), ("0".into(), "1".into()));
}

#[test]
fn a_bit_is_read_and_written_alone() {
    let mut bit = reference("w");
    bit.steps.push(rung::ladder::Step::Bit(15, NOWHERE));
    let word = expression(ExpressionKind::Unary(UnaryOperator::Not, Box::new(read("w"))));
    let write = element(ElementKind::Coil { kind: CoilKind::Plain, target: bit.clone() });
    let operand = expression(ExpressionKind::Read(bit));
    let seen = element(ElementKind::Contact { kind: ContactKind::Open, operand });
    let program = drawn(vec![vec![assign("w", word), contact("a"), write], vec![seen, coil(CoilKind::Plain, "x")]]);
    let words: Vec<u64> = trace(&program, "w", "0110", "0000").iter().map(|value| value.bits()).collect();
    assert_eq!(words, [0x7FFF, 0x8000, 0xFFFF, 0]);
    assert_eq!(bits(&program, "x", "0110", "0000"), "0110");
}

#[test]
fn the_engines_give_the_same_traces_for_each_element() {
    let kinds =
        [CoilKind::Plain, CoilKind::Negated, CoilKind::Set, CoilKind::Reset, CoilKind::Rising, CoilKind::Falling];
    let contacts = [ContactKind::Open, ContactKind::Closed, ContactKind::Rising, ContactKind::Falling];
    for coil_kind in kinds {
        for contact_kind in contacts {
            let program = drawn(vec![vec![contact("b"), contact_of(contact_kind, "a"), coil(coil_kind, "x")]]);
            let checked = checked(&program).unwrap();
            let mut rig = Rig::new(&checked).unwrap();
            for (scan, (a, b)) in
                [(0, 0), (0, 1), (1, 1), (1, 1), (0, 1), (1, 0), (1, 1), (0, 0), (0, 1)].iter().enumerate()
            {
                rig.set("a", Value::bool(*a == 1));
                rig.set("b", Value::bool(*b == 1));
                let same = rig.scan(i64::try_from(scan).unwrap());
                same.unwrap_or_else(|difference| panic!("{contact_kind:?} {coil_kind:?}, scan {scan}: {difference:?}"));
            }
        }
    }
}

fn integers(program: &Program, watched: &str, a: &str) -> Vec<i128> {
    integers_of(program, watched, a, a)
}

fn integers_of(program: &Program, watched: &str, a: &str, b: &str) -> Vec<i128> {
    trace(program, watched, a, b).iter().map(|value| value.as_integer().unwrap()).collect()
}

fn assign(target: &str, value: Expression) -> Element {
    element(ElementKind::Assignment { target: reference(target), value: Box::new(value) })
}

fn condition(value: Expression) -> Element {
    element(ElementKind::Condition(value))
}

fn binary(operator: BinaryOperator, left: Expression, right: Expression) -> Expression {
    expression(ExpressionKind::Binary(operator, Box::new(left), Box::new(right)))
}

fn add(text: &str, value: i128) -> Expression {
    binary(BinaryOperator::Add, read(text), integer(value))
}

fn real(value: f64) -> Expression {
    expression(ExpressionKind::Literal(Literal::Real { value, ty: None }))
}

fn time(nanoseconds: i64) -> Expression {
    expression(ExpressionKind::Literal(Literal::Time(nanoseconds)))
}
