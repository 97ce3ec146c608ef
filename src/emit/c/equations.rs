//! A program as the C that a compiler likes best: equations over variables at fixed addresses, so many rungs a function.
//!
//! This is what an optimising compiler is measured on beside Rung's own code: no pointer to an image, no clock, no interface
//! but the scan itself. It computes what [`emit`](super::emit) computes, in one image, with all tasks in every scan.

use std::fmt::Write;
use std::ops::Range;

use super::body::{Body, Places};
use super::library::Library;
use super::{INCLUDES, REALS, helper, names, reads_now, uses_reals};
use crate::diagnostic::Diagnostic;
use crate::emit::notes::Notes;
use crate::emit::structure::Structure;
use crate::interface::Interface;
use crate::logic::{Program, verify};
use crate::source::Span;

/// A verified program as equations, at least one and at most `rungs` of its rungs in a function. The file defines
/// `P_image`, laid out as the program's, and `P_scan`, which takes a pointer that it does not use.
///
/// # Errors
/// As [`emit`](super::emit).
pub fn equations(program: &Program, interface: &Interface, rungs: usize) -> Result<String, Vec<Diagnostic>> {
    debug_assert_eq!(verify(program), Ok(()), "emitters take verified programs only");
    names::validate(program, interface, &|_, _| Span::default())?;
    let prefix = interface.prefix();
    let mut structure = Structure::new(program);
    let (definition, _) = structure.text(interface, &Notes::default());
    let (mut functions, mut calls) = (String::new(), String::new());
    for (number, sections) in groups(program.sections.len(), rungs).enumerate() {
        let mut body = Body::new(program, Places::Image(&structure), program.instruction_range(sections.clone()));
        for place in sections.flat_map(|section| program.section_range(section)) {
            body.instruction(place);
        }
        let body = body.finish();
        let (now, argument) = if reads_now(&body) { ("const int64_t now", "now") } else { ("void", "") };
        let image = if body.contains("image->") {
            format!("    {prefix}_image_t *const image = &{prefix}_image;\n")
        } else {
            String::new()
        };
        let _ =
            write!(functions, "\n__attribute__((noinline)) static void rungs_{number}({now})\n{{\n{image}{body}}}\n");
        let _ = writeln!(calls, "    rungs_{number}({argument});");
    }
    let mut library = Library::default();
    library.take_calls(&functions);
    let helpers = helper::definitions(&functions);
    library.take_calls(&helpers);
    let reals = if uses_reals(program) { REALS } else { "" };
    Ok(format!(
        "{INCLUDES}{reals}\n{definition}\n{prefix}_image_t {prefix}_image;\n{}{helpers}{functions}\nvoid \
         {prefix}_scan(void *image, int64_t now)\n{{\n    (void)image;\n    (void)now;\n{calls}}}\n",
        library.text()
    ))
}

/// Runs of at most `most` of `count` places.
fn groups(count: usize, most: usize) -> impl Iterator<Item = Range<usize>> {
    let most = most.max(1);
    (0..count).step_by(most).map(move |start| start..start.saturating_add(most).min(count))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::{Options, generate};
    use crate::source::Source;
    use crate::{check, lower};

    #[test]
    fn a_function_holds_so_many_rungs_and_no_pointer_is_passed() {
        let options = Options { rungs: 130, timers: 21, ..Options::default() };
        let checked = check::check(&generate(&options).expect("options")).0.expect("no errors");
        let program = lower::lower(&checked, &Source::new("t", ""), None).expect("a small image");
        let interface = Interface::new("plain", 1_000_000).expect("a prefix");
        let text = equations(&program, &interface, 64).expect("C");
        assert_eq!(text.matches("static void rungs_").count(), 3);
        assert!(!text.contains("(plain_image_t *"), "{text}");
        let one = equations(&program, &interface, usize::MAX).expect("C");
        assert_eq!(one.matches("static void rungs_").count(), 1);
        // A program without rungs scans, too.
        assert_eq!(groups(0, 64).count(), 0);
    }
}
