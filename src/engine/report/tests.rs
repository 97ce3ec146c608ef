//! The report against the code that it counts.

use super::*;
use crate::engine::object::assemble;

use crate::interface::Interface;
use crate::logic::random;

#[test]
fn rungs_and_the_rest_add_up_to_all_that_is_in_the_chunks() {
    for triple in ["x86_64-unknown-linux-gnu", "aarch64-unknown-linux-gnu", "riscv64-unknown-elf"] {
        let Ok(target) = Target::new(triple, None, None) else { continue };
        let (mut loads, mut stores) = (0, 0);
        for seed in 0..20 {
            let program = random::program(seed);
            let object = assemble(&program, &Interface::default(), &target).expect("an object");
            let report = report(&program, &object, &target).expect("code that can be decoded");
            let round = object.functions.iter().filter(|function| function.role == Role::Round);
            let round: usize = round.map(|function| function.instruction_bytes).sum();
            let chunks: usize = object.chunks.iter().map(|chunk| chunk.instruction_bytes).sum();
            assert_eq!(report.scan.bytes, chunks + round, "{triple}, seed {seed}");
            assert_eq!(report.rungs.len(), program.sections.len());
            loads += report.scan.loads;
            stores += report.scan.stores;
            assert!(report.scan.instructions >= report.scan.loads.max(report.scan.stores));
        }
        assert!(loads > 100 && stores > 100, "{triple}: {loads} loads and {stores} stores");
    }
}

#[test]
fn instructions_are_told_by_what_they_do_to_memory() {
    let x86 = |text| memory(text, Architecture::X86_64);
    assert_eq!(x86("mov eax, dword ptr [rdi + 4]"), (true, false));
    assert_eq!(x86("mov byte ptr [rdi], al"), (false, true));
    assert_eq!(x86("add dword ptr [rax], 1"), (true, true));
    assert_eq!(x86("and eax, dword ptr [rdi]"), (true, false));
    assert_eq!(x86("cmp byte ptr [rdi], 0"), (true, false));
    assert_eq!(x86("lea rax, [rdi + 4]"), (false, false));
    assert_eq!(x86("push rbp"), (false, true));
    assert_eq!(x86("ret"), (true, false));
    let riscv = |text| memory(text, Architecture::Riscv64(target_lexicon::Riscv64Architecture::Riscv64gc));
    assert_eq!(riscv("lbu a2, -0x5c(a0)"), (true, false));
    assert_eq!(riscv("c.sdsp ra, 8(sp)"), (false, true));
    assert_eq!(riscv("sltu a0, a1, a2"), (false, false));
    assert_eq!(riscv("sub a0, a1, a2"), (false, false));
    let arm = |text| memory(text, Architecture::Aarch64(target_lexicon::Aarch64Architecture::Aarch64));
    assert_eq!(arm("ldrb w0, [x1, #4]"), (true, false));
    assert_eq!(arm("stp x29, x30, [sp, #-0x10]!"), (false, true));
    assert_eq!(arm("stub"), (false, false));
}

#[test]
fn the_table_and_the_json_say_the_same() {
    let program = random::program(4);
    let target = Target::new(&Target::host_triple(), None, None).expect("this machine");
    let object = assemble(&program, &Interface::default(), &target).expect("an object");
    let report = report(&program, &object, &target).expect("code that can be decoded");
    let (table, json) = (report.table(), report.json());
    let value: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(value["scan"]["instructions"], report.scan.instructions);
    let row = table.lines().find_map(|line| line.strip_prefix("P_scan")).expect("a row for the scan");
    assert_eq!(row.split_whitespace().next(), Some(report.scan.instructions.to_string().as_str()), "{table}");
    assert!(table.contains("cycles"), "{table}");
}
