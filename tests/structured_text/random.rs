//! Random programs, written as structured text and read again, have the same trace.

use rung::check::{Checked, check};
use rung::diagnostic::render;
use rung::elementary::Value;
use rung::engine::interp::Interpreter;
use rung::frontend::{self, native, structured_text};
use rung::ladder::Program;
use rung::logic::Layout;
use rung::lower::lower;
use rung::source::Source;
use rung_runtime::Scan;

use crate::support::random_program::random_program;
use crate::support::random_stimuli::Stimuli;

/// A program on the interpreter.
struct Machine {
    layout: Layout,
    interpreter: Interpreter,
    image: Vec<u8>,
}

impl Machine {
    fn new(checked: &Checked) -> Self {
        let logic = lower(checked, &Source::new("drawn", ""), None).expect("a small image");
        let interpreter = Interpreter::new(&logic);
        let image = logic.layout.initial_image();
        Self { layout: logic.layout, interpreter, image }
    }

    fn set(&mut self, name: &str, value: Value) {
        let observed = self.layout.observed().iter().find(|observed| observed.name.eq_ignore_ascii_case(name));
        let slot = self.layout.slot(observed.unwrap_or_else(|| panic!("nothing is named {name}")).slot);
        slot.write(&mut self.image, value);
    }

    fn observed(&self) -> Vec<(String, Value)> {
        let observed = self.layout.observed().iter();
        observed.map(|one| (one.name.clone(), self.layout.slot(one.slot).read(&self.image))).collect()
    }

    fn get(&self, name: &str) -> Option<Value> {
        let observed = self.layout.observed().iter().find(|observed| observed.name.eq_ignore_ascii_case(name))?;
        Some(self.layout.slot(observed.slot).read(&self.image))
    }
}

fn checked(program: &Program) -> Option<Checked> {
    check(program).0
}

/// Leaves out the rungs that structured text cannot say; `None` where the rest is no program.
fn writable(mut program: Program) -> Option<Program> {
    let mut place = program.units[0].rungs.len();
    while structured_text::print(&program).is_err() && place > 0 {
        place -= 1;
        let mut alone = program.clone();
        let rung = alone.units[0].rungs.remove(place);
        let before = structured_text::print(&program).err().map_or(0, |problems| problems.len());
        let after = structured_text::print(&alone).err().map_or(0, |problems| problems.len());
        if after < before {
            program = alone;
        }
        drop(rung);
    }
    (structured_text::print(&program).is_ok() && checked(&program).is_some()).then_some(program)
}

#[test]
fn a_random_program_read_again_from_structured_text_has_the_same_trace() {
    let mut compared = 0;
    for seed in seeds() {
        let Some(program) = writable(random_program(seed)) else { continue };
        let text = structured_text::print(&program).expect("it was tried");
        let native = native::print(&program);
        let source = Source::new("random.st", text.as_str());
        assert!(structured_text::recognises(&text), "{text}");
        let parsed = frontend::parse(&source);
        let problems = render(&source, &parsed.diagnostics);
        assert!(parsed.diagnostics.is_empty(), "seed {seed}\n{problems}\n{native}\n{text}");
        let (again, problems) = check(&parsed.program);
        let again = again.unwrap_or_else(|| {
            panic!(
                "seed {seed}\n{}\n{native}\n{text}",
                render(
                    &source,
                    &problems.into_iter().filter(rung::diagnostic::Diagnostic::is_error).collect::<Vec<_>>()
                )
            )
        });
        let drawn = checked(&program).expect("it was tried");
        let (mut first, mut second) = (Machine::new(&drawn), Machine::new(&again));
        let mut stimuli = Stimuli::new(seed, &drawn, &first.observed());
        for scan in 0..100 {
            let (now, changes) = stimuli.next();
            for (name, value) in changes {
                first.set(&name, value);
                second.set(&name, value);
            }
            first.interpreter.scan(&mut first.image, now);
            second.interpreter.scan(&mut second.image, now);
            for observed in first.layout.observed().iter().filter(|observed| !is_renamed(&program, &observed.name)) {
                let expected = first.get(&observed.name);
                let found = second.get(&observed.name);
                assert_eq!(found, expected, "seed {seed}, scan {scan}: {}\n{native}\n{text}", observed.name);
            }
        }
        compared += 1;
    }
    assert!(compared > 100, "only {compared} programs could be written");
}

/// Whether a variable has a name that IEC 61131-3 has not, and so another one in structured text.
fn is_renamed(program: &Program, name: &str) -> bool {
    let is_foreign = !name.starts_with('%') && name.contains(|sign: char| !sign.is_ascii_alphanumeric() && sign != '_');
    is_foreign && program.units[0].variables.iter().any(|variable| variable.name.text == name)
}

/// The seeds; `RUNG_FIRST_SEED=17 RUNG_SEEDS=1` looks at one again.
fn seeds() -> std::ops::Range<u64> {
    let number = |name, otherwise| match std::env::var(name) {
        Ok(text) => text.parse().unwrap_or_else(|error| panic!("{name}: {error}")),
        Err(_) => otherwise,
    };
    let first = number("RUNG_FIRST_SEED", 0);
    first..first + number("RUNG_SEEDS", 200)
}
