//! `rung build --verify`: the optimiser's output proved equal to its input, and what is said of it.

use std::fmt::Write as _;

use super::place_of;
use crate::cli::Failure;
use crate::diagnostic::{Code, Diagnostic};
use crate::logic::{Origin, Program};
use crate::opt::Pass;
use crate::opt::prove::{Fault, Report, optimise_proved};
use crate::source::Source;

/// Unproved values that are named.
const MOST_NAMED: usize = 10;

/// The program after some passes, and what to say of the proof.
///
/// # Errors
/// That a pass changes what the program computes, at the rung that stores what differs.
pub(super) fn optimised(program: Program, passes: &[Pass], source: &Source) -> Result<(Program, String), Failure> {
    match optimise_proved(program, passes) {
        Ok((program, report)) => Ok((program, said(&report))),
        Err(fault) => Err(refused(&fault, source)),
    }
}

fn said(report: &Report) -> String {
    let mut text = format!("verified: {report}\n");
    for unproved in report.unproved.iter().take(MOST_NAMED) {
        let _ = match &unproved.origin {
            Some(Origin { label, line }) => {
                writeln!(text, "  unproved: `{}` of `{label}` (line {line})", unproved.slot)
            }
            None => writeln!(text, "  unproved: `{}`", unproved.slot),
        };
    }
    if report.unproved.len() > MOST_NAMED {
        let _ = writeln!(text, "  … and {} more", report.unproved.len() - MOST_NAMED);
    }
    text
}

fn refused(fault: &Fault, source: &Source) -> Failure {
    let hint =
        "this is a fault of Rung: please report it with the program; `--after lower` builds without the optimiser";
    let code = Code::OptimiserDiffers;
    match fault {
        Fault::Broken { pass, problems } => {
            let problem = problems.first().map_or(String::new(), |problem| format!(": {problem}"));
            Failure::hinted(code, format!("the pass `{pass}` makes what is no program{problem}"), hint)
        }
        Fault::Reshaped { pass } => {
            Failure::hinted(code, format!("the pass `{pass}` changes the image, the rungs or the tasks"), hint)
        }
        Fault::Different { pass, difference } => {
            let message = format!("after the pass `{pass}`, {difference}");
            match &difference.origin {
                Some(Origin { label, line }) => {
                    let span = place_of(source, *line, label);
                    Failure::diagnostics(source, &[Diagnostic::new(code, span, message).hint(hint)])
                }
                None => Failure::hinted(code, message, hint),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;
    use std::sync::Arc;

    use clap::Parser;

    use super::said;
    use crate::cli::Failure;
    use crate::cli::build::{Arguments, build};
    use crate::logic::{Binary, Op, Origin, Program};
    use crate::opt::Pass;
    use crate::opt::prove::{Report, Unproved};

    #[derive(Parser)]
    struct Command {
        #[command(flatten)]
        build: Arguments,
    }

    /// What `rung build --verify` with one pass comes to, for a program of two rungs; and whether it left an output.
    fn built(run: fn(Program) -> Program) -> (Result<(), Failure>, bool) {
        let folder = tempfile::tempdir().expect("a folder");
        let (source, object) = (folder.path().join("motor.rung"), folder.path().join("motor.o"));
        let text = "program motor\ninput a, b\noutput x, y\n\nrung r10\n  a b (x)\n\nrung r20\n  [ a | b ] (y)\n";
        std::fs::write(&source, text).expect("a file");
        let map = folder.path().join("motor.json");
        let path = |path: &Path| path.to_string_lossy().into_owned();
        let words =
            ["build", &path(&source), "--verify", "-o", &path(&object), "--map", &path(&map)].map(str::to_owned);
        let arguments = Command::parse_from(words).build;
        let outcome = build(&arguments, &[Pass { name: "test", run, of_all: true }]);
        (outcome, object.exists() || map.exists())
    }

    #[test]
    fn a_pass_that_changes_a_program_is_refused_at_the_rung_and_nothing_is_written() {
        let (outcome, written) = built(|mut program| {
            let and = program.instructions.iter_mut().find_map(|instruction| match &mut instruction.op {
                Op::Binary(op @ Binary::Or, ..) => Some(op),
                _ => None,
            });
            *and.expect("the second rung is an OR") = Binary::Xor;
            program
        });
        let Err(Failure::Error(text)) = outcome else { panic!("{outcome:?}") };
        for part in [
            "error[R0908]: after the pass `test`, `y` of `r20` (line 8) becomes BOOL#0 in place of BOOL#1 where \
             `a` is BOOL#1 and `b` is BOOL#1",
            "motor.rung:8:6",
            "hint: this is a fault of Rung",
        ] {
            assert!(text.contains(part), "{text}");
        }
        assert!(!written);
        let (outcome, written) = built(|mut program| {
            program.instructions.pop();
            program
        });
        let Err(Failure::Error(text)) = outcome else { panic!("{outcome:?}") };
        assert!(text.starts_with("error[R0908]: the pass `test` makes what is no program: "), "{text}");
        assert!(!written);
        let (outcome, written) = built(|mut program| {
            program.layout =
                Arc::new(Arc::unwrap_or_clone(program.layout).by_use(None, &[3, 2, 1, 0]).expect("a small image"));
            program
        });
        let Err(Failure::Error(text)) = outcome else { panic!("{outcome:?}") };
        assert!(
            text.starts_with("error[R0908]: the pass `test` changes the image, the rungs or the tasks\n"),
            "{text}"
        );
        assert!(!written);
    }

    #[test]
    fn a_pass_that_keeps_a_program_is_not() {
        let (outcome, written) = built(|program| program);
        assert!(outcome.is_ok() && written, "{outcome:?}");
    }

    #[test]
    fn a_few_of_the_values_that_are_not_proved_are_named() {
        let unproved = |number: u32| Unproved {
            slot: format!("x{number}"),
            origin: (number > 0).then(|| Origin { label: format!("r{number}").into(), line: number }),
        };
        let report = Report { by_structure: 5, exhaustively: 2, by_sat: 1, unproved: (0..13).map(unproved).collect() };
        let text = said(&report);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(
            lines[..3],
            [
                "verified: 8 of 21 stored values proved equal (5 by structure, 2 exhaustively, 1 by SAT), 13 unproved",
                "  unproved: `x0`",
                "  unproved: `x1` of `r1` (line 1)",
            ]
        );
        assert_eq!((lines.len(), lines[11]), (12, "  … and 3 more"));
    }
}
