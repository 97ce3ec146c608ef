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
