//! Checking folds constants by arithmetic of its own. What it folds must be what the program would have computed.

use rung::check::{self, Element, ExpressionKind};
use rung::diagnostic::Code;
use rung::elementary::{Elementary, Value};
use rung::engine::interp::Interpreter;
use rung::ladder::BinaryOperator;
use rung::source::Source;
use rung::{frontend, lower};
use rung_runtime::Scan;

/// Literals of a type, among them its ends.
fn literals(ty: Elementary) -> Vec<String> {
    match (ty, ty.range()) {
        (Elementary::Bool, _) => ["FALSE", "TRUE"].map(str::to_owned).to_vec(),
        (Elementary::Time, _) => ["T#0s", "T#1500ms", "-T#1ms", "T#2d"].map(str::to_owned).to_vec(),
        (_, Some((least, greatest))) => {
            let mut values = vec![least, greatest, 0, 1, 7, 100];
            values.extend(ty.is_signed().then_some(-3));
            values.iter().map(i128::to_string).collect()
        }
        (_, None) => ["0.0", "-0.0", "1.0", "0.1", "-2.5", "3.0e38", "1.0e-40"].map(str::to_owned).to_vec(),
    }
}

/// What `expression` is when its operands are constants and when they are variables; the codes of the errors if it
/// cannot be the former.
fn both_ways(ty: Elementary, values: &[&str], expression: &str, result: Elementary) -> Result<[Value; 2], Vec<Code>> {
    let mut text = "program folding\n".to_owned();
    for (name, value) in ["a", "b"].iter().zip(values) {
        text += &format!("const {name} : {ty} := {value}\nvar v{name} : {ty} := {value}\n");
    }
    let of_variables = expression.replace(" b", " vb").replace("a ", "va ").replace("(a)", "(va)");
    text += &format!(
        "var folded : {result}\nvar computed : {result}\nrung r\n{{folded := {expression}}} {{computed := {of_variables}}}\n"
    );
    let source = Source::new("folding.rung", text);
    let parsed = frontend::parse(&source);
    assert_eq!(parsed.diagnostics, [], "{}", source.text());
    let (checked, diagnostics) = check::check(&parsed.program);
    let errors = diagnostics.iter().filter(|found| found.is_error()).map(|found| found.code);
    let Some(checked) = checked else { return Err(errors.collect()) };
    match &checked.units()[0].rungs[0].circuit.branches[0].elements[0] {
        Element::Assignment { value, .. } => assert!(matches!(value.kind, ExpressionKind::Constant(_)), "{value:?}"),
        other => panic!("{other:?}"),
    }
    let logic = lower::lower(&checked, &source, None).expect("a small program");
    let mut image = logic.layout.initial_image();
    Interpreter::new(&logic).scan(&mut image, 0);
    Ok(["folded", "computed"].map(|name| {
        let observed = logic.layout.observed().iter().find(|observed| observed.name == name).expect("it is declared");
        logic.layout.slot(observed.slot).read(&image)
    }))
}

#[test]
fn what_is_folded_is_what_would_be_computed() {
    let mut compared = 0;
    for ty in Elementary::ALL {
        let literals = literals(ty);
        for op in BinaryOperator::ALL {
            let result = if op.is_comparison() { Elementary::Bool } else { ty };
            let expression = format!("a {} b", op.symbol());
            for (a, b) in literals.iter().flat_map(|a| literals.iter().map(move |b| (a, b))) {
                match both_ways(ty, &[a, b], &expression, result) {
                    Ok([folded, computed]) => {
                        assert_eq!(folded, computed, "{ty}: {a} {} {b}", op.symbol());
                        compared += 1;
                    }
                    Err(codes) => {
                        let expected = [Code::OutOfRange, Code::TypeMismatch];
                        assert!(codes.iter().all(|code| expected.contains(code)), "{codes:?}");
                    }
                }
            }
        }
        for (a, expression) in literals.iter().flat_map(|a| [(a, "NOT (a)"), (a, "-(a)")]) {
            if let Ok([folded, computed]) = both_ways(ty, &[a], expression, ty) {
                assert_eq!(folded, computed, "{ty}: {expression} of {a}");
                compared += 1;
            }
        }
    }
    assert!(compared > 4_000, "only {compared} were compared");
}

#[test]
fn what_is_widened_is_what_would_be_converted() {
    let mut compared = 0;
    for from in Elementary::ALL {
        for (to, value) in Elementary::ALL.into_iter().flat_map(|to| literals(from).into_iter().map(move |v| (to, v))) {
            if let Ok([folded, computed]) = both_ways(from, &[&value], "(a)", to) {
                assert_eq!((folded.ty(), folded), (to, computed), "{value} from {from} to {to}");
                compared += 1;
            }
        }
    }
    assert!(compared > 300, "only {compared} were compared");
}
