//! The functions that [`Op::Call`](crate::logic::Op::Call) names: each is a program of logic, and becomes a function of C as
//! rungs do, with variables in place of an image. Nothing may be computed here that is not in that program.

use super::body::{Body, Places};
use super::library::called;
use crate::logic::{Helper, mathematics};

/// How a helper is called.
pub(super) fn name(helper: Helper) -> String {
    format!("{}_f64", helper.mnemonic())
}

/// The definitions of all helpers that a text calls.
pub(super) fn definitions(text: &str) -> String {
    let names: std::collections::HashSet<&str> = called(text).collect();
    let used = Helper::ALL.iter().copied().filter(|helper| names.contains(name(*helper).as_str()));
    used.map(definition).collect()
}

fn definition(helper: Helper) -> String {
    let program = mathematics::program(helper);
    let mut body = Body::new(&program, Places::Variables(&["a", "b", "result"]), 0..program.instructions.len());
    for place in 0..program.instructions.len() {
        body.instruction(place);
    }
    let second = if helper.takes_two() { ", const double b" } else { "" };
    format!(
        "\n/* {}, as every engine computes it. */\nstatic double {}(const double a{second})\n{{\n    double \
         result;\n\n{}    return result;\n}}\n",
        helper.mnemonic(),
        name(helper),
        body.finish()
    )
}
