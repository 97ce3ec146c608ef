//! What people wrote in a source beside its program, for the comments of emitted code.

use std::collections::HashMap;

use crate::emit::{Declaration, Notes};
use crate::ladder::{Program, UnitKind, Variable};
use crate::source::Source;

/// The titles of rungs, and what stands at and behind the declarations of global variables and of programs.
pub(super) fn of(program: &Program, source: &Source) -> Notes {
    let line = |byte: u32| u32::try_from(source.line(byte)).unwrap_or(0);
    let titles =
        program.rungs().filter_map(|rung| Some((line(rung.span.start), rung.title.as_ref()?.to_string()))).collect();
    let behind: HashMap<u32, &str> = (program.comments.iter())
        .filter(|comment| !comment.own_line)
        .map(|comment| (line(comment.span.start), comment.text.as_str()))
        .collect();
    let declaration = |variable: &Variable| {
        let address = variable.address.as_ref().map(ToString::to_string).unwrap_or_default();
        let comment = behind.get(&line(variable.span.end)).copied().unwrap_or_default().to_owned();
        let said = !address.is_empty() || !comment.is_empty();
        said.then(|| (variable.name.text.as_str().to_ascii_lowercase(), Declaration { address, comment }))
    };
    let programs = program.units.iter().filter(|unit| matches!(unit.kind, UnitKind::Program { .. }));
    let variables = program.globals.iter().chain(programs.flat_map(|unit| &unit.variables));
    Notes { source: source.name().to_owned(), titles, declarations: variables.filter_map(declaration).collect() }
}
