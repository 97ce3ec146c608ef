use std::collections::HashSet;

use super::*;
use crate::ladder::Step;

/// A program in a notation of its own, so that these tests do not depend on the printer.
fn drawn(program: &Program) -> String {
    let mut text = String::new();
    for variable in &program.units[0].variables {
        text += &format!("{:?} {}\n", variable.class, variable.name.text);
    }
    for rung in &program.units[0].rungs {
        text += &circuit(&rung.circuit);
        text += "\n";
    }
    text
}

fn circuit(circuit: &Circuit) -> String {
    let branches = circuit.branches.iter().map(|branch| branch.elements.iter().map(drawn_element).collect::<String>());
    branches.collect::<Vec<_>>().join(" |")
}

fn drawn_element(element: &Element) -> String {
    match &element.kind {
        ElementKind::Contact { kind: ContactKind::Open, operand } => format!(" {}", operand_name(operand)),
        ElementKind::Contact { kind: ContactKind::Closed, operand } => format!(" /{}", operand_name(operand)),
        ElementKind::Coil { kind: CoilKind::Plain, target } => format!(" ({})", root(target)),
        ElementKind::Parallel(inner) => format!(" [{} ]", circuit(inner)),
        ElementKind::Block(call) => match call.arguments.as_slice() {
            [
                Argument {
                    wire: Wire::Value(Expression { kind: ExpressionKind::Literal(Literal::Time(preset)), .. }),
                    ..
                },
            ] => {
                format!(" {}:{}ms", call.instance.as_name().map_or("", |name| &name.text), preset / 1_000_000)
            }
            other => panic!("a timer has a preset only, not {other:?}"),
        },
        other => panic!("no program of the generator has {other:?}"),
    }
}

fn operand_name(operand: &Expression) -> String {
    match &operand.kind {
        ExpressionKind::Read(reference) => root(reference),
        other => panic!("a contact reads {other:?}"),
    }
}

fn root(reference: &Reference) -> String {
    assert_eq!(reference.steps, Vec::<Step>::new());
    match &reference.root {
        Root::Name(name) => name.text.to_string(),
        Root::Address(address) => panic!("{address:?}"),
    }
}

/// Timers and contacts of a program.
fn counts(program: &Program) -> (usize, usize) {
    let text = drawn(program);
    let rungs = text.lines().skip(program.units[0].variables.len());
    let words: Vec<&str> = rungs.flat_map(str::split_whitespace).collect();
    let timers = words.iter().filter(|word| word.contains(':')).count();
    let others = words.iter().filter(|word| word.starts_with('(') || matches!(**word, "[" | "]" | "|")).count();
    (timers, words.len() - timers - others)
}

#[test]
fn a_small_program_is_what_it_always_was() {
    let options = Options { rungs: 6, timers: 2, contacts_per_rung: 4, near_percent: 50, seed: 7 };
    let program = generate(&options).unwrap();
    let expected = "\
Input i0
Input i1
Output q0
Memory m1
Memory m2
Memory m3
Output q4
Memory m5
 i0 i1 (q0)
 [ /i1 m3 | /q4 | /i1 i1 ] (m1)
 q0 /i0 m1 t2:1680ms (m2)
 [ i1 | q0 ] (m3)
 [ i0 /m2 | /m3 m2 m2 ] (q4)
 [ m5 q4 | /m2 q0 /q0 | q0 ] t5:640ms (m5)
";
    assert_eq!(drawn(&program), expected);
}

#[test]
fn equal_options_give_equal_programs_and_another_seed_another() {
    let options = Options { rungs: 200, timers: 33, ..Options::default() };
    assert_eq!(generate(&options), generate(&options));
    assert_ne!(generate(&options), generate(&Options { seed: 1, ..options }));
}

#[test]
fn there_are_exactly_as_many_rungs_and_timers_as_asked_for() {
    for (rungs, timers) in [(0, 0), (1, 0), (1, 1), (2, 1), (7, 3), (18, 3), (1451, 246), (100, 100), (99, 98)] {
        let program = generate(&Options { rungs, timers, ..Options::default() }).unwrap();
        assert_eq!((program.units[0].rungs.len(), counts(&program).0), (rungs as usize, timers as usize));
        assert_eq!(program.units[0].variables.len(), (rungs + rungs.div_ceil(3)) as usize);
    }
}

#[test]
fn contacts_in_a_rung_have_the_mean_asked_for() {
    for contacts_per_rung in [1, 2, 3, 6, 20] {
        let program = generate(&Options { rungs: 3000, timers: 500, contacts_per_rung, ..Options::default() }).unwrap();
        let expected = 3000 * contacts_per_rung as usize;
        let contacts = counts(&program).1;
        assert!(contacts.abs_diff(expected) * 25 < expected, "{contacts} contacts instead of {expected}");
    }
}

#[test]
fn every_variable_is_used_and_every_coil_written_once() {
    let program = generate(&Options { rungs: 100, timers: 10, contacts_per_rung: 1, ..Options::default() }).unwrap();
    let text = drawn(&program);
    let rungs: Vec<&str> =
        text.lines().skip(program.units[0].variables.len()).flat_map(str::split_whitespace).collect();
    let coils: Vec<&str> = rungs.iter().filter_map(|word| word.strip_prefix('(')?.strip_suffix(')')).collect();
    let written: HashSet<&str> = coils.iter().copied().collect();
    assert_eq!(written.len(), coils.len());
    for variable in &program.units[0].variables {
        let name = variable.name.text.as_str();
        let is_read = rungs.iter().any(|word| word.trim_start_matches('/') == name);
        assert!(if variable.class == VariableClass::Input { is_read } else { written.contains(name) }, "{name}");
    }
}

#[test]
fn near_references_stay_near() {
    let options = Options { rungs: 2000, timers: 0, near_percent: 100, ..Options::default() };
    let program = generate(&options).unwrap();
    let text = drawn(&program);
    for (rung, line) in text.lines().skip(program.units[0].variables.len()).enumerate() {
        for word in line.split_whitespace().map(|word| word.trim_matches(['/', '(', ')'])) {
            let number = |prefix: &str| word.strip_prefix(prefix)?.parse::<usize>().ok();
            let from = number("i").map(|input| input * 3).or_else(|| number("q")).or_else(|| number("m"));
            assert!(from.is_none_or(|from| from.abs_diff(rung) <= NEAR_RUNGS as usize + 2), "{word} in rung {rung}");
        }
    }
}

#[test]
fn impossible_options_are_refused() {
    let with = |change: fn(&mut Options)| {
        let mut options = Options::default();
        change(&mut options);
        generate(&options).unwrap_err()
    };
    assert_eq!(with(|options| options.timers = 101), OptionsError::TooManyTimers { timers: 101, rungs: 100 });
    assert_eq!(with(|options| options.contacts_per_rung = 0), OptionsError::NoContacts);
    assert_eq!(with(|options| options.near_percent = 101), OptionsError::NotAPercentage(101));
    let most = u64::from(u32::MAX);
    assert_eq!(with(|options| options.rungs = u32::MAX), OptionsError::TooLarge { contacts: most * 6 });
    assert_eq!(with(|options| options.contacts_per_rung = u32::MAX), OptionsError::TooLarge { contacts: most * 100 });
}

#[test]
fn checking_finds_nothing_to_say() {
    for seed in 0..20 {
        let program = generate(&Options { rungs: 300, timers: 50, seed, ..Options::default() }).unwrap();
        let (checked, diagnostics) = crate::check::check(&program);
        assert_eq!((checked.is_some(), diagnostics), (true, Vec::new()), "seed {seed}");
    }
}
