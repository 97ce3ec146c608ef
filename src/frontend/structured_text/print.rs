//! Any program as structured text that other IEC compilers read: matiec and what is built on it, CODESYS and its kin. Read again it is
//! a program with the same trace.
//!
//! Only what IEC 61131-3 has is written; a program that uses more is refused with a diagnostic for each such part, and nothing is
//! left out silently.

mod calls;
mod declarations;
mod names;
mod order;
mod power;
mod rungs;
mod words;

pub(in crate::frontend) use calls::is_iec;
pub(in crate::frontend) use declarations::{Instances, instances, used};
pub(in crate::frontend) use names::Names;
pub(in crate::frontend) use order::of_units;
use rungs::Rungs;
pub(in crate::frontend) use words::Words;

use crate::diagnostic::{Code, Diagnostic};
use crate::ladder::{Comment, Program, Rung, Unit, UnitKind, key};

/// Prints a program, which may come from any front end; it should have been checked.
///
/// # Errors
/// A diagnostic for each part that structured text has not: registers and blocks of the register machine, and a few circuits
/// whose meaning statements cannot say.
pub fn print(program: &Program) -> Result<String, Vec<Diagnostic>> {
    let mut problems = Vec::new();
    if let Some(registers) = &program.registers {
        let message = "the registers of the register machine have no counterpart";
        problems.push(Diagnostic::new(Code::CannotConvert, registers.span, message));
    }
    let mut names = Names::of(program);
    let instances = instances(program, &mut names);
    let mut text = String::new();
    let mut comments = Comments { rest: &program.comments };
    declarations::types(&mut text, program, Words { names: &names });
    for place in of_units(program) {
        let unit = &program.units[place];
        text.push_str(&self::unit(program, unit, &instances, &mut names, &mut comments, &mut problems));
    }
    declarations::configuration(&mut text, program, &instances, Words { names: &names });
    let rest = comments.before(u32::MAX, 0);
    text.push_str(&rest);
    if problems.is_empty() { Ok(text) } else { Err(problems) }
}

fn unit(
    program: &Program,
    unit: &Unit,
    instances: &Instances,
    names: &mut Names,
    comments: &mut Comments<'_>,
    problems: &mut Vec<Diagnostic>,
) -> String {
    let mut text = comments.before(unit.span.start, 0);
    let (word, result, name) = match &unit.kind {
        UnitKind::Program { .. } => {
            let name = instances.types.get(&key(&unit.name.text)).cloned();
            ("PROGRAM", String::new(), name)
        }
        UnitKind::FunctionBlock => ("FUNCTION_BLOCK", String::new(), None),
        UnitKind::Function { result } => {
            let words = Words { names };
            let result = result.as_ref().map(|ty| format!(" : {}", words.type_reference(ty)));
            ("FUNCTION", result.unwrap_or_default(), None)
        }
    };
    let name = name.unwrap_or_else(|| names.spell(&unit.name.text).into_owned());
    text.push_str(&format!("{word} {name}{result}\n"));
    let first_rung = unit.rungs.first().map_or(unit.span.end, |rung| rung.span.start);
    let declared = comments.before(first_rung, 1);
    let (body, variables) = statements(program, unit, names, comments, problems);
    declarations::variables(&mut text, program, unit, &variables, Words { names }, problems);
    text.push_str(&declared);
    text.push('\n');
    text.push_str(&body);
    text.push_str(&format!("END_{word}\n\n"));
    text
}

/// The body of a unit, and the variables that it needs beside the declared ones: name and type.
fn statements(
    program: &Program,
    unit: &Unit,
    names: &mut Names,
    comments: &mut Comments<'_>,
    problems: &mut Vec<Diagnostic>,
) -> (String, Vec<(String, String)>) {
    let mut rungs = Rungs::new(program, unit, names, problems);
    let body = rungs.all(|rung| before_rung(rung, comments));
    (body, std::mem::take(&mut rungs.variables))
}

/// The body of a unit for files of other formats; as [`statements`], without the comments of the file.
pub(in crate::frontend) fn body(
    program: &Program,
    unit: &Unit,
    names: &mut Names,
    problems: &mut Vec<Diagnostic>,
) -> (String, Vec<(String, String)>) {
    statements(program, unit, names, &mut Comments { rest: &[] }, problems)
}

/// The comments before a rung, and its name and title as one more.
fn before_rung(rung: &Rung, comments: &mut Comments<'_>) -> String {
    let mut text = comments.before(rung.span.start, 1);
    let off = (!rung.enabled).then_some("off");
    let parts = [rung.name.as_ref().map(|name| name.text.as_str()), rung.title.as_deref(), off];
    let parts: Vec<&str> = parts.into_iter().flatten().collect();
    if !parts.is_empty() {
        text.push_str(&comment(&parts.join(": "), 1));
    }
    text
}

/// The comments that are still to be written.
struct Comments<'a> {
    rest: &'a [Comment],
}

impl Comments<'_> {
    /// Those that stand before a place.
    fn before(&mut self, place: u32, indent: usize) -> String {
        let count = self.rest.iter().take_while(|comment| comment.span.start < place).count();
        let (now, rest) = self.rest.split_at(count);
        self.rest = rest;
        now.iter().map(|one| comment(&one.text, indent)).collect()
    }
}

fn comment(text: &str, indent: usize) -> String {
    // What would open or close a comment within it.
    let text = text.replace("(*", "( *").replace("*)", "* )").replace(['\r', '\n'], " ");
    format!("{}(* {} *)\n", "  ".repeat(indent), text.trim())
}
