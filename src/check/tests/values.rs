//! Types, constants, and what is read and written.

use thin_vec::ThinVec;

use super::build::*;
use super::*;
use crate::check::{Element, Expression, ExpressionKind, Initial, Place, VariableId};
use crate::elementary::{Elementary, Value};
use crate::ladder::{self, BinaryOperator, CoilKind, ContactKind, Variable};
use BinaryOperator::{Add, And, Divide, Equal, Greater, Modulo, Multiply, Or, Subtract};

/// A program that assigns to the first of its variables, `x`.
fn assigning(ty: &str, others: Vec<Variable>, value: ladder::Expression) -> Program {
    program([vec![memory("x", ty)], others].concat(), vec![rung(vec![assign("x", value)])])
}

/// What such a program assigns.
fn assigned(ty: &str, others: Vec<Variable>, value: ladder::Expression) -> Expression {
    match &clean(&assigning(ty, others, value)).units()[0].rungs[0].circuit.branches[0].elements[0] {
        Element::Assignment { value, .. } => (**value).clone(),
        other => panic!("{other:?}"),
    }
}

fn place(variable: u32) -> Place {
    Place { variable: VariableId(variable), path: ThinVec::new(), bit: None }
}

fn folded(value: Option<Value>) -> Expression {
    let value = value.unwrap();
    Expression { ty: value.ty(), kind: ExpressionKind::Constant(value) }
}

#[test]
fn constants_fold_in_their_type() {
    let integer = |ty, value| folded(Value::integer(ty, value));
    let c = |ty: &str, value| vec![constant("c", ty, value)];
    assert_eq!(assigned("INT", vec![], binary(int(2), Add, int(3))), integer(Elementary::Int, 5));
    assert_eq!(
        assigned("SINT", vec![], binary(binary(int(100), Add, int(100)), Subtract, int(150))),
        integer(Elementary::Sint, 50)
    );
    assert_eq!(assigned("INT", vec![], negate(int(32_768))), integer(Elementary::Int, -32_768));
    assert_eq!(assigned("INT", vec![], negate(typed(Elementary::Int, 32_768))), integer(Elementary::Int, -32_768));
    assert_eq!(assigned("INT", vec![], binary(negate(int(7)), Modulo, int(4))), integer(Elementary::Int, -3));
    assert_eq!(assigned("ULINT", vec![], int(u64::MAX.into())), integer(Elementary::Ulint, u64::MAX.into()));
    assert_eq!(assigned("DINT", c("INT", int(7)), binary(read("c"), Divide, int(2))), integer(Elementary::Dint, 3));
    assert_eq!(assigned("WORD", vec![], not(int(15))), integer(Elementary::Word, 0xFFF0));
    assert_eq!(assigned("BYTE", c("BYTE", int(3)), not(read("c"))), integer(Elementary::Byte, 0xFC));
    assert_eq!(assigned("BOOL", c("WORD", int(4)), read("c.2")), folded(Some(Value::bool(true))));
    assert_eq!(
        assigned("BOOL", c("INT", int(4)), binary(int(3), Greater, read("c"))),
        folded(Some(Value::bool(false)))
    );
    assert_eq!(
        assigned("TIME", c("TIME", seconds(2)), binary(read("c"), Subtract, seconds(3))),
        folded(Some(Value::time(-1_000_000_000)))
    );
    assert_eq!(assigned("REAL", vec![], binary(int(1), Divide, real(2.0))), folded(Value::real(Elementary::Real, 0.5)));
    assert_eq!(assigned("LREAL", c("INT", int(3)), read("c")), folded(Value::real(Elementary::Lreal, 3.0)));
}

#[test]
fn reals_are_rounded_after_each_operation() {
    let c = || vec![constant("c", "REAL", real(0.1))];
    let sum = f64::from(0.1_f32 + 0.2_f32);
    assert_eq!(assigned("REAL", c(), binary(read("c"), Add, real(0.2))), folded(Value::real(Elementary::Real, sum)));
    let wide = assigned("LREAL", c(), read("c"));
    assert_eq!(wide, folded(Value::real(Elementary::Lreal, f64::from(0.1_f32))));
}

#[test]
fn operands_widen_to_the_wider_of_their_types_only() {
    let others = || vec![memory("i", "INT"), memory("d", "DINT")];
    let read_of = |variable, ty| Expression { ty, kind: ExpressionKind::Read(place(variable)) };
    let widened =
        Expression { ty: Elementary::Dint, kind: ExpressionKind::Widen(Box::new(read_of(1, Elementary::Int))) };
    let sum = ExpressionKind::Binary(Multiply, Box::new(widened.clone()), Box::new(read_of(2, Elementary::Dint)));
    let expected = Expression { ty: Elementary::Dint, kind: sum };
    assert_eq!(assigned("DINT", others(), binary(read("i"), Multiply, read("d"))), expected);
    let expected =
        Expression { ty: Elementary::Dint, kind: ExpressionKind::Widen(Box::new(read_of(1, Elementary::Int))) };
    let two = others().into_iter().take(1).collect();
    assert_eq!(assigned("DINT", two, read("i")), expected);
}

#[test]
fn a_real_literal_beside_an_integer_makes_both_real() {
    let integer = Expression { ty: Elementary::Int, kind: ExpressionKind::Read(place(1)) };
    let widened = Expression { ty: Elementary::Real, kind: ExpressionKind::Widen(Box::new(integer)) };
    let half = folded(Value::real(Elementary::Real, 0.5));
    let kind = ExpressionKind::Binary(Multiply, Box::new(widened), Box::new(half));
    let found = assigned("REAL", vec![memory("i", "INT")], binary(read("i"), Multiply, real(0.5)));
    assert_eq!(found, Expression { ty: Elementary::Real, kind });
}

#[test]
fn what_does_not_fit_its_type_is_out_of_range() {
    let big = || vec![constant("c", "INT", int(30_000))];
    table(vec![
        (assigning("INT", vec![], int(40_000)), Code::OutOfRange, "40000"),
        (assigning("INT", vec![], negate(int(32_769))), Code::OutOfRange, "-32769"),
        (assigning("USINT", vec![], negate(int(1))), Code::OutOfRange, "-1"),
        (assigning("BOOL", vec![], int(2)), Code::OutOfRange, "2"),
        (assigning("DINT", vec![], typed(Elementary::Sint, 200)), Code::OutOfRange, "SINT#200"),
        (assigning("ULINT", vec![], int(u128::MAX)), Code::OutOfRange, &u128::MAX.to_string()),
        (assigning("INT", big(), binary(read("c"), Add, read("c"))), Code::OutOfRange, "c + c"),
        (assigning("DINT", big(), binary(read("c"), Multiply, int(2))), Code::OutOfRange, "c * 2"),
        (assigning("REAL", vec![], real(1e39)), Code::OutOfRange, "1e39"),
        (assigning("LREAL", vec![], binary(real(1.0), Divide, real(0.0))), Code::OutOfRange, "1.0 / 0.0"),
        (assigning("BOOL", vec![memory("s", "SINT")], binary(read("s"), Equal, int(128))), Code::OutOfRange, "128"),
        (assigning("BOOL", vec![memory("w", "WORD")], read("w.16")), Code::OutOfRange, "16"),
        (
            program(
                vec![constant("a", "INT", int(40_000)), output("q")],
                vec![rung(vec![when(binary(read("a"), Equal, int(1))), coil("q")])],
            ),
            Code::OutOfRange,
            "40000",
        ),
    ]);
}

#[test]
fn what_has_another_type_is_a_mismatch() {
    let with = |name: &str, ty: &str| vec![memory(name, ty)];
    let two = |a: &str, b: &str| vec![memory("a", a), memory("b", b)];
    table(vec![
        (assigning("INT", with("d", "DINT"), read("d")), Code::TypeMismatch, "d"),
        (assigning("REAL", with("d", "DINT"), read("d")), Code::TypeMismatch, "d"),
        (assigning("BYTE", with("b", "BOOL"), read("b")), Code::TypeMismatch, "b"),
        (assigning("WORD", with("n", "INT"), read("n")), Code::TypeMismatch, "n"),
        (assigning("INT", vec![], real(1.5)), Code::TypeMismatch, "1.5"),
        (assigning("TIME", vec![], int(5)), Code::TypeMismatch, "5"),
        (assigning("INT", vec![], not(int(5))), Code::TypeMismatch, "NOT 5"),
        (assigning("INT", vec![], seconds(5)), Code::TypeMismatch, "T#5s"),
        (assigning("INT", two("INT", "UINT"), binary(read("a"), Add, read("b"))), Code::TypeMismatch, "a + b"),
        (assigning("INT", two("INT", "INT"), binary(read("a"), And, read("b"))), Code::TypeMismatch, "a AND b"),
        (assigning("REAL", two("REAL", "REAL"), binary(read("a"), Modulo, read("b"))), Code::TypeMismatch, "a MOD b"),
        (assigning("TIME", two("TIME", "TIME"), binary(read("a"), Multiply, read("b"))), Code::TypeMismatch, "a * b"),
        (assigning("REAL", vec![], binary(real(1.0), Or, int(1))), Code::TypeMismatch, "1.0 OR 1"),
        (assigning("UINT", with("u", "UINT"), negate(read("u"))), Code::TypeMismatch, "u"),
        (assigning("INT", with("n", "INT"), not(read("n"))), Code::TypeMismatch, "n"),
        (assigning("UINT", vec![], negate(typed(Elementary::Uint, 0))), Code::TypeMismatch, "UINT#0"),
        (assigning("BOOL", with("n", "INT"), read("n.3")), Code::TypeMismatch, "3"),
        (assigning("BOOL", with("t", "TON"), read("t")), Code::TypeMismatch, "t"),
        (program(vec![memory("n", "INT")], vec![rung(vec![coil("n")])]), Code::TypeMismatch, "n"),
        (
            program(vec![memory("n", "INT"), output("q")], vec![rung(vec![open("n"), coil("q")])]),
            Code::TypeMismatch,
            "n",
        ),
        (
            program(vec![input("t").typed("TON"), output("q")], vec![rung(vec![open("t.Q"), coil("q")])]),
            Code::TypeMismatch,
            "t",
        ),
        (
            program(vec![memory("t", "TON").starting(int(1)), output("q")], vec![rung(vec![open("t.Q"), coil("q")])]),
            Code::TypeMismatch,
            "1",
        ),
    ]);
}

#[test]
fn initial_values_are_constants_of_constants_before_them() {
    let variables = vec![
        constant("a", "INT", int(5)),
        constant("b", "DINT", binary(read("a"), Multiply, int(3))),
        memory("x", "DINT").starting(binary(read("b"), Add, int(1))),
    ];
    let checked = clean(&program(variables, vec![rung(vec![assign("x", read("a"))])]));
    let initial: Vec<_> = checked.variables().iter().map(|variable| variable.initial.clone()).collect();
    let value = |ty, value| Initial::Value(Value::integer(ty, value).unwrap());
    assert_eq!(initial, [value(Elementary::Int, 5), value(Elementary::Dint, 15), value(Elementary::Dint, 16)]);
}

#[test]
fn a_value_that_tells_a_missing_type_says_so() {
    for (value, ty) in [(seconds(5), "TIME"), (int(5), "INT"), (real(0.5), "REAL")] {
        let untyped = Variable { ty: None, ..constant("_c", "BOOL", value) };
        let found = only(&program(vec![untyped], vec![]));
        assert_eq!((found.code, found.hint), (Code::TypeMismatch, Some(format!("write its type, as in `_c : {ty}`"))));
    }
    clean(&program(vec![input("_i"), output("_q").starting(int(1)), output("_r").starting(truth(true))], vec![]));
}

#[test]
fn initial_values_that_are_not_known_at_the_start_are_refused() {
    let assign_x = || vec![rung(vec![assign("x", int(0)), assign("y", int(0))])];
    let refused = |x: Variable, y: Variable| program(vec![x, y], assign_x());
    table(vec![
        (refused(memory("x", "INT").starting(read("y")), memory("y", "INT")), Code::NotConstant, "y"),
        (refused(memory("x", "WORD").starting(read("%IW7")), memory("y", "INT")), Code::NotConstant, "%IW7"),
    ]);
    let uses = |name: &str| vec![rung(vec![assign("x", read(name))])];
    let later = vec![constant("a", "INT", read("b")), constant("b", "INT", int(1)), memory("x", "INT")];
    let itself = vec![constant("a", "INT", read("a")), memory("x", "INT")];
    let none = Variable { initial: None, ..constant("a", "INT", int(1)) };
    table(vec![
        (program(later, uses("a")), Code::NotConstant, "b"),
        (program(itself, uses("a")), Code::NotConstant, "a"),
        (program(vec![none, memory("x", "INT")], uses("a")), Code::NotConstant, "a"),
    ]);
}

#[test]
fn division_by_the_constant_zero_is_a_warning() {
    let n = || vec![memory("n", "INT")];
    table(vec![
        (assigning("INT", n(), binary(read("n"), Divide, int(0))), Code::DivisionByZero, "0"),
        (assigning("INT", n(), binary(read("n"), Modulo, int(0))), Code::DivisionByZero, "0"),
        (assigning("INT", vec![], binary(int(1), Divide, int(0))), Code::DivisionByZero, "0"),
        (
            assigning("REAL", vec![memory("r", "REAL")], binary(read("r"), Divide, real(0.0))),
            Code::DivisionByZero,
            "0.0",
        ),
    ]);
}

#[test]
fn only_what_may_be_written_is() {
    let input_coil = || program(vec![input("a")], vec![rung(vec![coil("a")])]);
    let timer = |target: &str| program(vec![], vec![rung(vec![call("t:TON", vec![])]), rung(vec![coil(target)])]);
    table(vec![
        (input_coil(), Code::CoilOnInput, "a"),
        (program(vec![], vec![rung(vec![coil("%IX0.0")])]), Code::CoilOnInput, "%IX0.0"),
        (program(vec![constant("c", "BOOL", truth(true))], vec![rung(vec![coil("c")])]), Code::NotWritable, "c"),
        (timer("t.Q"), Code::NotWritable, "t.Q"),
        (
            program(vec![input("n").typed("INT")], vec![rung(vec![call("c:CTU", vec![to("CV", "n")])])]),
            Code::CoilOnInput,
            "n",
        ),
    ]);
    let (checked, diagnostics) = check(&imported(input_coil()));
    assert!(checked.is_some());
    assert_eq!(diagnostics.iter().map(|found| found.code).collect::<Vec<_>>(), [Code::OverwrittenInput]);
    clean(&timer("t.IN"));
    clean(&program(vec![], vec![rung(vec![call("t:TON", vec![]), assign("t.PT", seconds(5))])]));
}

#[test]
fn a_coil_writes_a_bit_of_a_word() {
    let checked = clean(&program(
        vec![memory("w", "WORD")],
        vec![rung(vec![contact(ContactKind::Closed, read("w.3")), coil("w.15")])],
    ));
    let bit = |bit| Place { bit: Some(bit), ..place(0) };
    let operand = Expression { ty: Elementary::Bool, kind: ExpressionKind::Read(bit(3)) };
    let expected = [
        Element::Contact { kind: ContactKind::Closed, operand },
        Element::Coil { kind: CoilKind::Plain, target: bit(15) },
    ];
    assert_eq!(checked.units()[0].rungs[0].circuit.branches[0].elements, expected.into());
}
