//! What the functions look like: text, pointers, and loads that are part of the instructions that use them.

use super::place::Stored;
use super::{ALIVE, BRANCHING, Chunk, Compiler, MOVED, text};
use crate::elementary::{Elementary, Value};
use crate::engine::disassemble;
use crate::engine::jit::host_isa;
use crate::logic::{
    Area, Binary, Builder, CHUNK_SECTIONS, Helper, LayoutBuilder, Op, Origin, Program, Slot, SlotId, random,
};

/// A program of sections over `slots` BOOLs, each made by `section`.
fn booleans(slots: u32, sections: u32, mut section: impl FnMut(&mut Builder, u32, &[SlotId])) -> Program {
    let mut layout = LayoutBuilder::new();
    let slots: Vec<SlotId> = (0..slots)
        .map(|index| {
            let (ty, initial) = (Elementary::Bool, Value::bool(false));
            layout.slot(Slot {
                name: format!("b{index}").into(),
                ty,
                offset: 0,
                area: Area::Memory,
                retain: false,
                initial,
                line: 0,
            })
        })
        .collect();
    let mut logic = Builder::new("booleans", layout.finish(None).expect("a small image"));
    for index in 0..sections {
        section(&mut logic, index, &slots);
        logic.end_section(Origin { label: format!("rung_{index}").into(), line: index + 10 });
    }
    logic.finish()
}

fn first_chunk(program: &Program) -> Chunk {
    let isa = host_isa().expect("a host with a back end");
    Compiler::new(program, &*isa).chunk(program.chunks()[0].clone()).expect("code")
}

#[test]
fn text_heads_each_section_with_its_label() {
    let program = booleans(4, 2, |logic, index, slots| {
        let value = logic.load(slots[index as usize]);
        logic.store(slots[index as usize + 2], value);
    });
    let isa = host_isa().expect("a host with a back end");
    let text = text(&program, &*isa);
    let headings: Vec<&str> = text.lines().filter(|line| line.starts_with("; rung")).collect();
    assert_eq!(headings, ["; rung_0 (line 10)", "; rung_1 (line 11)"], "{text}");
    assert!(text.contains("return"), "{text}");
}

#[test]
fn a_listing_heads_each_section_and_ends_with_the_return() {
    let program = booleans(4, 2, |logic, index, slots| {
        let value = logic.load(slots[index as usize]);
        logic.store(slots[index as usize + 2], value);
    });
    let chunk = first_chunk(&program);
    let isa = host_isa().expect("a host with a back end");
    let listing = disassemble::listing(&program, &[chunk], isa.triple()).expect("a decoder for the host");
    assert!(listing.contains("; rung_0 (line 10)") && listing.contains("; rung_1 (line 11)"), "{listing}");
    assert!(listing.trim_end().lines().last().is_some_and(|line| line.ends_with("ret")), "{listing}");
}

#[test]
#[cfg(target_arch = "x86_64")]
fn a_contact_is_one_instruction() {
    // Stored far behind, so that the loads may be wide.
    let contacts = 40;
    let program = booleans(contacts + 1, 1, |logic, _, slots| {
        let mut power = logic.load(slots[0]);
        for slot in &slots[1..contacts as usize] {
            let contact = logic.load(*slot);
            power = logic.and(power, contact);
        }
        // Used twice: stored, and inverted.
        logic.store(slots[contacts as usize], power);
        let inverse = logic.not(power);
        logic.store(slots[0], inverse);
    });
    let isa = host_isa().expect("a host with a back end");
    let chunk = first_chunk(&program);
    let lines = disassemble::lines(&chunk.code[..chunk.instruction_bytes], isa.triple()).expect("a decoder");
    let joined = lines.iter().filter(|line| line.text.starts_with("and") && line.text.contains("dword ptr")).count();
    assert!(joined >= contacts as usize - 4, "only {joined}: {lines:#?}");
}

#[test]
fn pointers_lie_within_the_image() {
    let program = booleans(5000, 128, |logic, index, slots| {
        let value = logic.load(slots[(index as usize * 1543) % 5000]);
        logic.store(slots[(index as usize * 37) % 5000], value);
    });
    for base in first_chunk(&program).bases {
        assert!(base <= program.layout.size());
    }
}

#[test]
fn stores_of_the_last_sections_count_as_lately_also_across_the_end_of_a_scan() {
    let program = booleans(200, 200, |logic, index, slots| {
        let value = logic.bool(true);
        logic.store(slots[index as usize], value);
    });
    let at = |index: usize| program.layout.slots()[index].offset;
    let stored = Stored::before(&program, 0);
    assert!(stored.lately(at(199), 0));
    assert!(!stored.lately(at(50), 0), "150 sections ago");
    let stored = Stored::before(&program, 150);
    assert!(stored.lately(at(100), 150));
    // A wide load reaches 3 bytes on.
    assert!(stored.lately(at(54) - 3, 150));
    assert!(!stored.lately(at(50) - 4, 150));
}

#[test]
fn every_listed_operation_is_an_integer_one_with_a_reason() {
    for listed in BRANCHING {
        assert!(matches!(listed.op, Binary::Divide | Binary::Remainder));
        assert!(!listed.reason.is_empty() && !listed.architectures.is_empty());
    }
}

#[test]
fn random_programs_have_text_with_every_section_that_stores() {
    let isa = host_isa().expect("a host with a back end");
    for seed in 0..20 {
        let program = random::program(seed);
        let text = text(&program, &*isa);
        for (index, section) in program.sections.iter().enumerate() {
            let mut range = program.section_range(index);
            if range.any(|at| matches!(program.instructions[at].op, Op::Store(..))) {
                let label = &program.origins[section.origin as usize].label;
                assert!(text.contains(&format!("; {label} (line")), "seed {seed}, {label}:\n{text}");
            }
        }
    }
}

#[test]
fn the_page_on_machine_code_lists_what_branches() {
    let page = include_str!("../../../docs/machine-code.md");
    let rows: Vec<&str> = page.lines().filter(|line| line.starts_with("| `")).collect();
    let expected: Vec<String> = BRANCHING
        .iter()
        .map(|row| format!("| `{}` | {} | {} |", row.op.mnemonic(), row.architectures.join(", "), row.reason))
        .collect();
    assert_eq!(rows, expected);
    assert!(page.contains(&format!("At most {ALIVE} values")));
    assert!(page.contains(&format!("an array of more than {MOVED} bytes")));
    assert!(page.contains(&format!("each {CHUNK_SECTIONS} of them make a chunk")));
}

#[test]
fn only_chunks_that_call_helpers_take_the_table_of_them() {
    let real = |name: &str| {
        let (ty, initial) = (Elementary::Real, Value::default_of(Elementary::Real));
        Slot { name: name.into(), ty, offset: 0, area: Area::Memory, retain: false, initial, line: 0 }
    };
    let mut layout = LayoutBuilder::new();
    let (a, b) = (layout.slot(real("a")), layout.slot(real("b")));
    let mut logic = Builder::new("angles", layout.finish(None).expect("a small image"));
    for helper in [None, Some(Helper::Sin), None] {
        let angle = logic.load(a);
        let result = helper.map_or(angle, |helper| logic.call(helper, angle, None));
        logic.store(b, result);
        logic.end_section(Origin { label: "r".into(), line: 1 });
    }
    let mut program = logic.finish();
    program.sections.iter_mut().for_each(|section| section.starts_chunk = true);
    let isa = host_isa().expect("a host with a back end");
    let mut compiler = Compiler::new(&program, &*isa);
    let chunks: Vec<Chunk> = program.chunks().into_iter().map(|chunk| compiler.chunk(chunk).expect("code")).collect();
    assert_eq!(chunks.iter().map(|chunk| chunk.calls_helpers).collect::<Vec<_>>(), [false, true, false]);
    assert_eq!(chunks[0].code, chunks[2].code);
}
