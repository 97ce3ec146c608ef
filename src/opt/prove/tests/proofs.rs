//! How two values are proved equal, or told apart.

use super::super::judge::{Method, Verdict};
use super::super::sat::{Answer, Effort, ask};
use super::super::space::Space;
use super::super::{Fault, Report, compare, optimise_proved};
use super::{pass, program};
use crate::elementary::Elementary::{self, Bool, Dint, Int, Lint, Lreal, Real, Time, Udint};
use crate::elementary::Value;
use crate::logic::{Binary, Builder, Compare, Program, SlotId, ValueId};

type Section = fn(&mut Builder, &[ValueId]) -> ValueId;

fn constant(logic: &mut Builder, ty: Elementary, number: i128) -> ValueId {
    logic.constant(Value::integer(ty, number).expect("a number of the type"))
}

/// What comes of comparing two ways to compute a value.
fn compared(types: &[Elementary], result: Elementary, before: Section, after: Section) -> Result<Report, String> {
    let (before, after) = (program(types, result, before), program(types, result, after));
    compare(&before, &after).map_err(|different| different.1.to_string())
}

#[test]
fn equal_values_are_proved_by_the_least_that_does() {
    let cases: [(&[Elementary], Elementary, Section, Section, Method); 8] = [
        // Distribution.
        (
            &[Bool, Bool, Bool],
            Bool,
            |logic, x| {
                let (ab, ac) = (logic.and(x[0], x[1]), logic.and(x[0], x[2]));
                logic.or(ab, ac)
            },
            |logic, x| {
                let either = logic.or(x[1], x[2]);
                logic.and(x[0], either)
            },
            Method::Exhaustion,
        ),
        (
            &[Int, Int],
            Int,
            |logic, x| logic.binary(Binary::Add, x[0], x[1]),
            |logic, x| logic.binary(Binary::Add, x[1], x[0]),
            Method::Structure,
        ),
        // A sum of wide numbers of which only the low bits are wanted.
        (
            &[Int, Int],
            Int,
            |logic, x| {
                let wide: Vec<ValueId> = x.iter().map(|value| logic.convert(*value, Dint)).collect();
                let sum = logic.binary(Binary::Add, wide[0], wide[1]);
                logic.convert(sum, Int)
            },
            |logic, x| logic.binary(Binary::Add, x[0], x[1]),
            Method::Structure,
        ),
        // (a + b) - b is a.
        (
            &[Int, Int],
            Int,
            |logic, x| {
                let sum = logic.binary(Binary::Add, x[0], x[1]);
                logic.binary(Binary::Subtract, sum, x[1])
            },
            |_, x| x[0],
            Method::Sat,
        ),
        // A product is not taken apart, but equal operands are known to be.
        (
            &[Lint, Lint, Bool, Bool],
            Lint,
            |logic, x| {
                let both = logic.and(x[2], x[3]);
                let factor = logic.select(both, x[0], x[1]);
                logic.binary(Binary::Multiply, factor, x[1])
            },
            |logic, x| {
                let inner = logic.select(x[3], x[0], x[1]);
                let factor = logic.select(x[2], inner, x[1]);
                logic.binary(Binary::Multiply, x[1], factor)
            },
            Method::Exhaustion,
        ),
        (
            &[Real, Real],
            Real,
            |logic, x| logic.binary(Binary::Add, x[0], x[1]),
            |logic, x| logic.binary(Binary::Add, x[1], x[0]),
            Method::Structure,
        ),
        // The comparison of another width.
        (
            &[Udint],
            Bool,
            |logic, x| {
                let (wide, ten) = (logic.convert(x[0], Lint), constant(logic, Lint, 10));
                logic.compare(Compare::Less, wide, ten)
            },
            |logic, x| {
                let ten = constant(logic, Udint, 10);
                let reaches = logic.compare(Compare::GreaterOrEqual, x[0], ten);
                logic.not(reaches)
            },
            Method::Structure,
        ),
        (
            &[Time, Time],
            Bool,
            |logic, x| logic.compare(Compare::Less, x[0], x[1]),
            |logic, x| logic.compare(Compare::Greater, x[1], x[0]),
            Method::Structure,
        ),
    ];
    for (place, (types, result, before, after, method)) in cases.into_iter().enumerate() {
        let report = compared(types, result, before, after).unwrap_or_else(|differ| panic!("case {place}: {differ}"));
        let mut expected = Report::default();
        expected.count(method);
        assert_eq!(report, expected, "case {place}");
    }
}

#[test]
fn what_is_not_known_of_functions_stays_unproved_and_is_no_difference() {
    // Neither is known without knowing what a product is.
    let distributive = compared(
        &[Lint, Lint, Lint],
        Lint,
        |logic, x| {
            let sum = logic.binary(Binary::Add, x[1], x[2]);
            logic.binary(Binary::Multiply, x[0], sum)
        },
        |logic, x| {
            let (a, b) = (logic.binary(Binary::Multiply, x[0], x[1]), logic.binary(Binary::Multiply, x[0], x[2]));
            logic.binary(Binary::Add, a, b)
        },
    );
    let report = distributive.expect("no difference");
    assert_eq!((report.proved(), report.unproved.len()), (0, 1));
    assert_eq!(report.unproved[0].slot, "y");
    assert_eq!(report.unproved[0].origin.as_ref().map(|origin| origin.label.as_str()), Some("r"));
    let text = "0 of 1 stored values proved equal (0 by structure, 0 exhaustively, 0 by SAT), 1 unproved";
    assert_eq!(report.to_string(), text);
}

#[test]
fn differences_are_told_with_the_fewest_values_that_show_them() {
    let cases: [(&[Elementary], Elementary, Section, Section, &str); 4] = [
        (
            &[Bool, Bool, Bool],
            Bool,
            |logic, x| logic.and(x[0], x[1]),
            |logic, x| logic.or(x[0], x[1]),
            "`y` of `r` (line 1) becomes BOOL#1 in place of BOOL#0 where `x",
        ),
        // One value in 2^32.
        (
            &[Dint, Bool],
            Bool,
            |logic, x| {
                let rare = constant(logic, Dint, 123_456_789);
                logic.compare(Compare::Equal, x[0], rare)
            },
            |logic, _| logic.bool(false),
            "`y` of `r` (line 1) becomes BOOL#0 in place of BOOL#1 where `x0` is DINT#123456789",
        ),
        // A REAL sum is not associative.
        (
            &[Lreal, Lreal, Lreal],
            Lreal,
            |logic, x| {
                let sum = logic.binary(Binary::Add, x[0], x[1]);
                logic.binary(Binary::Add, sum, x[2])
            },
            |logic, x| {
                let sum = logic.binary(Binary::Add, x[1], x[2]);
                logic.binary(Binary::Add, x[0], sum)
            },
            "`y` of `r` (line 1) becomes LREAL#",
        ),
        (
            &[Int],
            Int,
            |_, x| x[0],
            |logic, _| constant(logic, Int, 7),
            "`y` of `r` (line 1) becomes INT#7 in place of INT#0 on the image at the start",
        ),
    ];
    for (place, (types, result, before, after, expected)) in cases.into_iter().enumerate() {
        let told = compared(types, result, before, after).expect_err("they differ");
        assert!(told.starts_with(expected), "case {place}: {told}");
    }
}

#[test]
fn a_pass_that_changes_or_breaks_a_program_is_named() {
    let original = || program(&[Bool, Bool], Bool, |logic, x| logic.and(x[0], x[1]));
    let keeps = pass(|program| program);
    let differs = pass(|mut program| {
        for instruction in &mut program.instructions {
            if let crate::logic::Op::Binary(Binary::And, a, b) = instruction.op {
                instruction.op = crate::logic::Op::Binary(Binary::Or, a, b);
            }
        }
        program
    });
    let breaks = pass(|mut program| {
        program.instructions[2].op = crate::logic::Op::Unary(crate::logic::Unary::Not, ValueId(2));
        program
    });
    let renames = pass(|mut program| {
        program.origins[0].line = 9;
        program
    });
    let named = |name, pass: crate::opt::Pass| crate::opt::Pass { name, ..pass };
    let outcome =
        |last: crate::opt::Pass| optimise_proved(original(), &[named("first", keeps), named("last", last), keeps]);
    let Err(Fault::Different { pass, difference }) = outcome(differs) else { panic!("a difference") };
    assert_eq!((pass, difference.slot.name.as_str()), ("last", "y"));
    assert_eq!(difference.because.len(), 1, "one of the two is enough: {difference}");
    assert!(matches!(outcome(breaks), Err(Fault::Broken { pass: "last", .. })));
    assert_eq!(outcome(renames), Err(Fault::Reshaped { pass: "last" }));
    assert!(outcome(keeps).is_ok());
}

#[test]
fn a_solver_gives_up_when_all_is_spent_and_says_nothing_of_what_it_was_not_told() {
    let layout = program(&[Lint, Lint, Bool], Lint, |_, x| x[0]).layout;
    let mut space = Space::new(&layout);
    let held = [0, 1].map(|slot| space.initially(SlotId(slot)));
    let [a, b] = held.map(|held| space.bits(held));
    let (sum, carry) = (space.graph.add(&a, &b), space.graph.subtract(&a, &b));
    let back = space.graph.add(&carry, &b);
    let effort = |nodes, conflicts| Effort { nodes, conflicts, work: u64::MAX };
    let top = a.len() - 1;
    assert!(matches!(ask(&space.graph, back[top], a[top], effort(1, 10_000)).0, Answer::Unknown));
    let (answer, taken) = ask(&space.graph, back[top], a[top], effort(1 << 20, 3));
    assert!(matches!(answer, Answer::Unknown) && taken < 4 * 2000, "{answer:?} after {taken}");
    let (answer, taken) = ask(&space.graph, back[top], a[top], Effort { work: 100_000, ..effort(1 << 20, 100_000) });
    assert!(matches!(answer, Answer::Unknown) && taken < 110_000, "{answer:?} after {taken}");
    let (answer, _) = ask(&space.graph, back[5], a[5], effort(1 << 20, 100_000));
    assert!(matches!(answer, Answer::Equal), "{answer:?}");
    let (answer, _) = ask(&space.graph, sum[top], carry[top], effort(1 << 20, 100_000));
    let Answer::Differ(values) = answer else { panic!("{answer:?}") };
    // What was found is one of the samples then.
    space.refine(&values);
    let column = space.graph.columns().len() - 1;
    assert_ne!(space.graph.sample(column, sum[top]) & 1, space.graph.sample(column, carry[top]) & 1);
    assert!(matches!(space.judge(sum[top], carry[top]), Verdict::Differ(..)));
}

#[test]
fn parts_are_chunks_and_sections_that_values_cross_stay_together() {
    let section = |logic: &mut Builder, value: Option<ValueId>| {
        let value = value.unwrap_or_else(|| logic.load(SlotId(0)));
        let inverse = logic.not(value);
        logic.store(SlotId(1), inverse);
        logic.end_section(crate::logic::Origin { label: "r".into(), line: 1 });
        inverse
    };
    let layout = program(&[Bool], Bool, |_, x| x[0]).layout;
    let build = |starts: [bool; 4]| -> Program {
        let mut logic = Builder::new("p", layout.clone());
        let first = section(&mut logic, None);
        section(&mut logic, Some(first));
        section(&mut logic, None);
        section(&mut logic, None);
        let mut program = logic.finish();
        for (section, start) in program.sections.iter_mut().zip(starts) {
            section.starts_chunk = start;
        }
        program
    };
    let parts = |starts| {
        let parts = super::super::part::parts(&build([true, false, false, false]), &build(starts));
        parts.into_iter().map(|part| (part.after.start, part.after.end)).collect::<Vec<_>>()
    };
    assert_eq!(parts([true, false, false, false]), [(0, 4)]);
    assert_eq!(parts([true, false, true, true]), [(0, 2), (2, 3), (3, 4)]);
    assert_eq!(parts([true, true, false, true]), [(0, 3), (3, 4)], "a value crosses into the second section");
}
