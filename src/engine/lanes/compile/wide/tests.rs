//! The code as a disassembler reads it. That it computes what it should is for the tests of [`lanes`](crate::engine::lanes).

use super::*;
use crate::engine::disassemble;
use crate::engine::lanes::compile::fold::fold;
use crate::engine::lanes::plan::{Bit, BitOp};

/// What a disassembler reads, an instruction a line.
fn read(code: &[u8]) -> Vec<String> {
    let target = "x86_64-unknown-linux-gnu".parse().expect("a known target");
    let lines = disassemble::lines(code, &target).expect("a decoder");
    assert_eq!(lines.iter().map(|line| line.bytes.len()).sum::<usize>(), code.len(), "all of it is instructions");
    lines.into_iter().map(|line| line.text.split_whitespace().collect::<Vec<_>>().join(" ")).collect()
}

fn word(word: u32) -> BitOp {
    BitOp::Load(Cell::Word(word))
}

/// So many values that are all made before the first is used.
fn many(count: u32) -> Vec<Instruction> {
    let mut ops: Vec<BitOp> = (0..count).flat_map(|index| [word(index), word(index + 1)]).collect();
    let first = ops.len();
    let at = |index: usize| u32::try_from(index).expect("few");
    ops.extend((0..count).map(|index| BitOp::Xor(2 * index, 2 * index + 1)));
    for index in 0..count as usize {
        ops.push(BitOp::Store(Cell::Row(at(index)), Bit::Made(at(first + index))));
    }
    fold(&ops)
}

#[test]
fn operations_become_one_instruction_each_with_what_is_in_memory_as_its_operand() {
    let ops = [
        word(2),
        word(3),
        BitOp::And(0, 1),
        BitOp::Load(Cell::Row(1)),
        BitOp::Not(3),
        BitOp::And(2, 4),
        BitOp::Or(5, 0),
        BitOp::Not(6),
        BitOp::Store(Cell::Word(4), Bit::Made(7)),
        BitOp::Store(Cell::Row(0), Bit::Constant(true)),
    ];
    let code = assemble(&fold(&ops), [true, true]).expect("few values");
    let lines = read(&code);
    let expected = [
        "vpcmpeqd ymm15, ymm15, ymm15",
        "vmovdqu ymm0, ymmword ptr [rdi + 0x80]",
        "vpand ymm0, ymm0, ymmword ptr [rdi + 0xc0]",
        "vmovdqu ymm1, ymmword ptr [rsi + 0x40]",
        "vpandn ymm1, ymm1, ymm0",
        "vpor ymm0, ymm1, ymmword ptr [rdi + 0x80]",
        "vpxor ymm0, ymm15, ymm0",
        "vmovdqu ymmword ptr [rdi + 0x100], ymm0",
        "vmovdqu ymm14, ymmword ptr [rdi]",
        "vmovdqu ymmword ptr [rsi], ymm14",
        "add rdi, 0x20",
        "add rsi, 0x20",
        "sub rdx, 1",
    ];
    assert_eq!(lines[..expected.len()], expected, "{lines:#?}");
    // Behind the comparison, which is 5 bytes.
    assert_eq!(lines[expected.len()..], ["jne 5", "vzeroupper", "ret"]);
}

#[test]
fn a_pointer_that_does_not_move_is_left_alone() {
    let code = assemble(&many(1), [false, true]).expect("few values");
    let lines = read(&code);
    assert!(!lines.iter().any(|line| line.starts_with("add rdi")) && lines.contains(&"add rsi, 0x20".to_owned()));
}

#[test]
fn every_register_is_written_as_it_is_read_and_the_rest_waits_on_the_stack() {
    let lines = read(&assemble(&many(30), [true, true]).expect("few values"));
    for register in 0..REGISTERS {
        let made = format!("vpxor ymm{register}, ymm{register}, ymmword ptr [rdi");
        assert!(lines.iter().any(|line| line.starts_with(&made)), "{made} is not in {lines:#?}");
    }
    let frame = 0x20 * (30 - usize::from(REGISTERS));
    assert_eq!(lines[0], format!("sub rsp, {frame:#x}"));
    assert_eq!(lines.iter().filter(|line| line.starts_with("vmovdqu ymmword ptr [rsp")).count(), frame / 0x20);
    assert!(lines.contains(&format!("add rsp, {frame:#x}")));
}

#[test]
fn code_that_would_need_too_much_of_the_stack_is_left_to_cranelift() {
    let most = MOST_SLOTS + u32::from(REGISTERS);
    assert!(assemble(&many(most), [true, true]).is_some());
    assert_eq!(assemble(&many(most + 1), [true, true]), None);
}

#[test]
fn only_the_loop_jumps() {
    let target = "x86_64-unknown-linux-gnu".parse().expect("a known target");
    let code = assemble(&many(40), [true, true]).expect("few values");
    let lines = disassemble::lines(&code, &target).expect("a decoder");
    assert_eq!(lines.iter().filter(|line| line.jumps || line.calls).count(), 1);
}
