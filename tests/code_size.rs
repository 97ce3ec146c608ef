//! The longest things that one rung can say stay short in machine code: `docs/machine-code.md` has the figures, and what is
//! compiled here must keep to them, with some room for other processors of the kind.

#![cfg(target_arch = "x86_64")]

use std::path::{Path, PathBuf};

use rung::engine::disassemble::{self, Line};
use rung::engine::jit::{Jit, host_isa};
use rung::source::Source;
use rung::{check, frontend, lower, opt};

/// What is compiled, and what it must keep within whatever the page says: instructions, bytes, stores.
const BOUNDS: [(&str, Size); 4] = [
    ("shift_512.rung", Size { instructions: 300, bytes: 1200, stores: 60 }),
    ("drum_16.rung", Size { instructions: 150, bytes: 600, stores: 60 }),
    ("copy_1000.rung", Size { instructions: 30, bytes: 100, stores: 0 }),
    ("copy_512.rung", Size { instructions: 150, bytes: 1000, stores: 64 }),
];

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
struct Size {
    instructions: usize,
    bytes: usize,
    stores: usize,
}

impl Size {
    fn is_within(self, bound: Self) -> bool {
        self.instructions <= bound.instructions && self.bytes <= bound.bytes && self.stores <= bound.stores
    }

    /// A quarter more, for a processor that has fewer instructions.
    fn with_room(self) -> Self {
        let more = |number: usize| number + number / 4;
        Self { instructions: more(self.instructions), bytes: more(self.bytes), stores: more(self.stores) }
    }
}

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("docs")
}

/// Whether an instruction writes memory: its first operand is in brackets, and it is a move or sets a byte.
fn stores(line: &Line) -> bool {
    let (mnemonic, operands) = line.text.split_once(' ').unwrap_or((&line.text, ""));
    let first = operands.split(',').next().unwrap_or_default();
    // What the frame of the function saves is no store of the program's.
    first.contains('[')
        && !first.contains("rsp")
        && ["mov", "vmov", "set"].iter().any(|start| mnemonic.starts_with(start))
}

/// The program of a page, compiled for this machine and decoded.
fn decoded(name: &str) -> Vec<Line> {
    let text = std::fs::read(docs().join("src").join(name)).expect("a program of the page");
    let source = Source::decode(name, text).unwrap_or_else(|_| panic!("{name} is not UTF-8"));
    let parsed = frontend::parse(&source);
    let (checked, problems) = check::check(&parsed.program);
    assert!(parsed.diagnostics.is_empty() && problems.is_empty(), "{name} has errors");
    let logic = lower::lower(&checked.expect("it has no errors"), &source, None).expect("a small image");
    let jit = Jit::compile(&opt::optimise(logic)).expect("it compiles");
    let isa = host_isa().expect("this machine is known");
    let chunks = jit.chunks().iter();
    chunks.flat_map(|chunk| disassemble::lines(&chunk.code[..chunk.instruction_bytes], isa.triple()).unwrap()).collect()
}

fn size(lines: &[Line]) -> Size {
    Size {
        instructions: lines.len(),
        bytes: lines.iter().map(|line| line.bytes.len()).sum(),
        stores: lines.iter().filter(|line| stores(line)).count(),
    }
}

/// The figures of the page: of each program the three in its row.
fn stated(page: &str, name: &str) -> Size {
    let row = page.lines().find(|line| line.starts_with(&format!("| [`{name}`]"))).expect("a row for each program");
    let cells: Vec<usize> = row.split('|').filter_map(|cell| cell.trim().parse().ok()).collect();
    let [instructions, bytes, stores] = cells[..] else { panic!("three figures: {row}") };
    Size { instructions, bytes, stores }
}

#[test]
#[expect(clippy::print_stdout, reason = "the manual tells how to see the figures")]
fn the_longest_rungs_keep_within_the_figures_of_the_manual() {
    let page = std::fs::read_to_string(docs().join("machine-code.md")).expect("the page about machine code");
    for (name, bound) in BOUNDS {
        let size = size(&decoded(name));
        println!("{name}: {size:?}");
        assert!(size.is_within(bound), "{name}: {size:?} is beyond {bound:?}");
        let stated = stated(&page, name);
        assert!(size.is_within(stated.with_room()), "{name}: {size:?} is beyond the page's {stated:?}");
        assert!(stated.is_within(size.with_room()), "{name}: the page's {stated:?} is beyond {size:?}");
    }
}

#[test]
fn they_have_no_loop_and_a_long_copy_one_call() {
    for (name, _) in BOUNDS {
        let lines = decoded(name);
        let calls = lines.iter().filter(|line| line.calls).count();
        assert_eq!(calls, usize::from(name == "copy_1000.rung"), "{name}");
        assert_eq!(lines.iter().filter(|line| line.jumps && !line.calls).count(), 0, "{name}");
    }
}
