//! Boxes of functions, and functions of the program's own.

use super::written::*;
use super::{Checked, Code};
use crate::check::{Callee, Element, ExpressionKind, Input, Output, Type, UnitId, Wire};
use crate::elementary::{Elementary, Value};
use crate::ladder::functions::{Function, StandardFunction};

/// The only element of the only rung of the last unit.
fn element(checked: &Checked) -> &Element {
    &checked.units().last().unwrap().rungs[0].circuit.branches[0].elements[0]
}

fn call(checked: &Checked) -> &crate::check::Call {
    match element(checked) {
        Element::Call(call) => call,
        other => panic!("{other:?}"),
    }
}

fn constants(inputs: &[Input]) -> Vec<Option<Value>> {
    let constant = |input: &Input| match &input.wire {
        Wire::Value(value) => value.constant(),
        Wire::Circuit(_) => None,
    };
    inputs.iter().map(constant).collect()
}

const BEFORE: &str = "program p\nvar _a : INT var _b : INT var _d : DINT var _e : BOOL var _t : TIME var _r : REAL\n";

fn of(function: StandardFunction, ty: Elementary) -> Callee {
    Callee::Function(Function::Standard(function), ty)
}

#[test]
fn a_box_has_the_type_that_its_inputs_or_else_its_output_have() {
    use Elementary::{Bool, Dint, Int, Time, Word};
    use StandardFunction as F;
    let cases = [
        ("ADD(IN1 := _a, IN2 := 2, OUT => _b)", F::Add, Int),
        ("ADD(IN2 := 2, IN1 := _d, OUT => _d)", F::Add, Dint),
        ("ADD(IN1 := 1, IN2 := 2, OUT => _d)", F::Add, Dint),
        ("ADD(IN1 := _a, IN2 := _d, IN3 := 3, ADD => _d)", F::Add, Dint),
        ("GT(IN1 := 1, IN2 := 2, IN3 := _a, OUT => _e)", F::Greater, Bool),
        ("GT(IN1 := 1, IN2 := 70000)", F::Greater, Bool),
        ("MUL(IN1 := _t, IN2 := 2, OUT => _t)", F::MultiplyTime, Time),
        ("MOD(IN1 := _t, IN2 := T#2s, OUT => _t)", F::Modulo, Time),
        ("NOT(IN := 5)", F::Not, Word),
        ("MOVE(IN := 5, OUT => _d)", F::Move, Dint),
    ];
    for (text, function, ty) in cases {
        let checked = clean(&format!("{BEFORE}rung {text}"));
        assert_eq!(call(&checked).callee, of(function, ty), "{text}");
        assert_eq!((call(&checked).power_output, call(&checked).power_input), (Output::Eno, None), "{text}");
    }
    let converted = clean(&format!("{BEFORE}rung INT_TO_REAL(IN := _a, OUT => _r, ENO => _e)"));
    let function = Function::Convert { from: Some(Int), to: Elementary::Real };
    assert_eq!(call(&converted).callee, Callee::Function(function, Elementary::Real));
    let outputs: Vec<Output> = call(&converted).outputs.iter().map(|(output, _)| *output).collect();
    assert_eq!(outputs, [Output::Pin(0), Output::Eno]);
}

#[test]
fn nothing_in_a_box_is_folded_and_its_inputs_stand_in_their_places() {
    let checked = clean(&format!("{BEFORE}rung SUB(IN2 := 2, IN1 := 1, OUT => _a)"));
    assert_eq!(constants(&call(&checked).inputs), [1, 2].map(|number| Value::integer(Elementary::Int, number)));
    let checked = clean(&format!("{BEFORE}rung AND(IN1 := [_e /_e], IN2 := _e, EN := [_e]).OUT (_e)"));
    assert!(matches!(call(&checked).inputs[0].wire, Wire::Circuit(_)));
    assert!(matches!(call(&checked).enable, Some(Wire::Circuit(_))));
    assert_eq!(call(&checked).power_output, Output::Pin(0));
}

#[test]
fn what_a_drawing_leaves_open_at_a_box_is_zero() {
    let text = format!("{BEFORE}rung ADD(IN1 := _t, IN3 := T#1s, OUT => _t)");
    assert_eq!(found(&text), [(Code::WrongArguments, "ADD".to_owned())]);
    let checked = clean_imported(&text);
    assert_eq!(constants(&call(&checked).inputs), [None, Some(Value::time(0)), Some(Value::time(1_000_000_000))]);
    let checked = clean_imported(&format!("{BEFORE}rung ADD()"));
    let zero = Value::integer(Elementary::Int, 0);
    assert_eq!(constants(&call(&checked).inputs), [zero, zero]);
    assert_eq!(
        found_imported(&format!("{BEFORE}rung ADD(IN900000000 := 1)")),
        [(Code::WrongArguments, "ADD".to_owned())]
    );
}

#[test]
fn a_whole_array_or_structure_is_moved_by_a_copy() {
    let before = "type point : struct x, y : INT end_struct\nprogram p\nvar a, b : point var c : array [0..2] of INT var e : BOOL\n";
    let checked = clean(&format!("{before}rung MOVE(IN := a, OUT => b, EN := e, ENO => e) MOVE(IN := c, OUT => c)"));
    let Element::Parallel(circuit) = element(&checked) else { panic!("{checked:?}") };
    let kinds: Vec<&str> = circuit.branches[0]
        .elements
        .iter()
        .map(|element| match element {
            Element::Condition(_) => "condition",
            Element::Statements(_) => "statements",
            Element::Coil { .. } => "coil",
            _ => "other",
        })
        .collect();
    assert_eq!(kinds, ["condition", "statements", "coil"]);
    let used = "rung {c[0] := c[1]; b := a;} [e (e)]\n";
    each(
        &format!("{before}{used}"),
        &[
            ("rung MOVE(IN := a, OUT => c)", Code::TypeMismatch, "c"),
            ("rung MOVE(IN := a)", Code::WrongArguments, "MOVE"),
            ("rung MOVE(IN := a, OUT => b).OUT", Code::PowerNotTaken, "OUT"),
            ("rung MOVE(IN := a, OUT => b, EN := [e])", Code::WrongArguments, "MOVE"),
            ("rung MOVE(IN := a.z, OUT => b)", Code::UnknownMember, "z"),
        ],
    );
}

#[test]
fn faults_of_boxes_point_at_the_pin() {
    each(
        BEFORE,
        &[
            ("rung ADD(IN1 := _a)", Code::WrongArguments, "ADD"),
            ("rung ADD(IN1 := _a, IN1 := 3, IN2 := 2)", Code::DuplicatePin, "IN1"),
            ("rung ADD(IN1 := _a, X := 3, IN2 := 2)", Code::UnknownPin, "X"),
            ("rung ADD(IN1 := _a, IN2 := 3, Q => _b)", Code::UnknownPin, "Q"),
            ("rung ADD(IN1 := _a, IN2 := 3, OUT => _d)", Code::TypeMismatch, "_d"),
            ("rung ADD(IN1 := _a, IN2 := 3, ENO => _d)", Code::TypeMismatch, "_d"),
            ("rung ADD(IN1 := _a, IN2 := 3).OUT", Code::PowerNotTaken, "OUT"),
            ("rung ADD(IN1 := _a, IN2 := 3).Q", Code::UnknownPin, "Q"),
            ("rung ADD(IN1 := _a, IN2 := [_e])", Code::TypeMismatch, "_a, IN2 := [_e]"),
            ("rung ADD(IN1 := _a, IN2 := 3, EN := _a)", Code::TypeMismatch, "_a"),
            ("rung DIV(IN1 := _a, IN2 := 0)", Code::DivisionByZero, "0"),
            ("rung ADDD(IN1 := _a, IN2 := 0)", Code::UndeclaredName, "ADDD"),
            ("rung {_a := ADD(IN1 := _a, IN2 := 2, EN := _e)}", Code::UnknownPin, "EN"),
        ],
    );
}

const FUNCTIONS: &str = "function scale : REAL\ninput x : INT input k : INT := 3\nrung {scale := INT_TO_REAL(x * k)}\n\
    function swap\ninout a, b : INT temp t : INT\nrung {t := a; a := b; b := t;}\n\
    program p\nvar n : INT var m : INT var r : REAL var w : WORD\nrung {n := 1; m := 2; w := 3; w.1 := TRUE; r := 1.5;}\n";

#[test]
fn own_functions_are_called_in_boxes_and_expressions() {
    let checked = clean(&format!(
        "{FUNCTIONS}rung scale(x := n, OUT => r) swap(a := n, b := m) {{r := scale(n, 2) + scale(k := 4);}}"
    ));
    let elements = &checked.units()[2].rungs[1].circuit.branches[0].elements;
    let Element::Call(scale) = &elements[0] else { panic!("{elements:?}") };
    assert_eq!((&scale.callee, scale.power_output), (&Callee::UserFunction(UnitId(0)), Output::Eno));
    assert_eq!((scale.inputs.len(), scale.outputs[0].0), (1, Output::Pin(0)));
    let Element::Call(swap) = &elements[1] else { panic!("{elements:?}") };
    assert_eq!((&swap.callee, swap.references.len()), (&Callee::UserFunction(UnitId(1)), 2));
    let Element::Statements(statements) = &elements[2] else { panic!("{elements:?}") };
    let crate::check::Statement::Assignment { value, .. } = &statements[0] else { panic!("{statements:?}") };
    let ExpressionKind::Binary(_, left, right) = &value.kind else { panic!("{value:?}") };
    let given = |value: &crate::check::Expression| match &value.kind {
        ExpressionKind::UserCall { arguments, .. } => {
            arguments.iter().map(|argument| argument.as_ref().map(|value| value.constant())).collect::<Vec<_>>()
        }
        _ => vec![],
    };
    let int = |number| Some(Value::integer(Elementary::Int, number));
    assert_eq!(given(left), [Some(None), Some(int(2))].map(|value| value.map(Option::flatten)));
    assert_eq!(given(right), [None, Some(int(4).flatten())]);
    assert_eq!(checked.variable(checked.units()[0].result().unwrap()).ty, Type::Elementary(Elementary::Real));
}

#[test]
fn faults_of_calls_of_own_functions_are_found() {
    let used = "rung scale(x := n) swap(a := n, b := m)\n";
    each(
        &format!("{FUNCTIONS}{used}"),
        &[
            ("rung {r := scale(1, 2, 3)}", Code::WrongArguments, "scale"),
            ("rung {r := scale(1, x := 3)}", Code::WrongArguments, "scale"),
            ("rung {r := scale(y := 3)}", Code::UnknownPin, "y"),
            ("rung {r := scale(x := 3, x := 4)}", Code::DuplicatePin, "x"),
            ("rung {r := scale(x := 3, EN := TRUE)}", Code::UnknownPin, "EN"),
            ("rung {r := scale(r, 1)}", Code::TypeMismatch, "r"),
            ("rung {n := scale(1, 1)}", Code::TypeMismatch, "scale(1, 1)"),
            ("rung {n := swap(n, m)}", Code::TypeMismatch, "swap"),
            ("rung swap(a := n)", Code::WrongArguments, "swap"),
            ("rung swap(a := n, b := 3)", Code::TypeMismatch, "3"),
            ("rung swap(a := n, b := r)", Code::TypeMismatch, "r"),
            ("rung swap(a := n, b := [TRUE])", Code::TypeMismatch, "[TRUE]"),
            ("rung scale(x := n, OUT => r, scale => r)", Code::DuplicatePin, "scale"),
            ("rung scale(x := n).scale", Code::PowerNotTaken, "scale"),
            ("rung scale(k := w)", Code::TypeMismatch, "w"),
        ],
    );
}

#[test]
fn a_function_remembers_nothing() {
    let after = "program p\nvar b : BOOL\nrung f(x := b) f(x := b) (b)\n";
    let cases = [
        ("rung ^x {f := 1}", "^x"),
        ("rung x (P y)", "(P y)"),
        ("rung x t:TON(PT := T#1s)", "t:TON(PT := T#1s)"),
        ("var t : TON rung x t(PT := T#1s)", "t"),
        ("var z : INT retain rung x {f := z}", "z"),
    ];
    for (text, place) in cases {
        let text = format!("function f : INT\ninput x\nvar _y, y : BOOL\n{text} [y | {{f := 2}}]\n{after}");
        let code = if text.contains("retain") { Code::MisplacedDeclaration } else { Code::NoMemoryHere };
        assert_eq!(found(&text), [(code, place.to_owned())], "{text}");
    }
    // Set and reset coils, addresses and global variables are others' memory.
    clean(
        "global g : INT\nfunction f : INT\ninput x\nrung x (S %MX0.0) {g := g + 1} {f := g}\nprogram p\nvar b : BOOL\nrung f(x := b) (b)\n",
    );
}

#[test]
fn in_a_statement_arguments_without_names_stand_in_their_places() {
    let named = "{SUB(IN1 := _a, IN2 := 2, OUT => _a); t1(IN := _e, PT := T#1s);}";
    let placed = "{SUB(_a, 2, OUT => _a); t1(_e, T#1s);}";
    let of = |text: &str| clean(&format!("{BEFORE}var t1 : TON\nrung {text}"));
    let [named, placed] = [named, placed].map(of);
    assert_eq!(element(&named), element(&placed));
    let too_many = found(&format!("{BEFORE}var t1 : TON\nrung {{t1(_e, T#1s, 3);}}"));
    assert_eq!(too_many.iter().map(|(code, _)| *code).collect::<Vec<_>>(), [Code::UnknownPin]);
}

#[test]
fn what_is_moved_may_be_widened_as_what_is_assigned_may() {
    let checked = clean(&format!("{BEFORE}rung MOVE(IN := _a, OUT => _d)"));
    assert_eq!(call(&checked).callee, of(StandardFunction::Move, Elementary::Dint));
    let codes: Vec<Code> =
        found(&format!("{BEFORE}rung MOVE(IN := _d, OUT => _a)")).iter().map(|(code, _)| *code).collect();
    assert_eq!(codes, [Code::TypeMismatch]);
}
