//! Machine code as text, and what of it may change the flow of control. Only looks at bytes; runs nothing.

use std::fmt::Write as _;

use capstone::InsnGroupType::{CS_GRP_CALL, CS_GRP_JUMP};
use capstone::arch::{self, BuildsCapstone, BuildsCapstoneExtraMode};
use capstone::{Capstone, InsnGroupId};
use target_lexicon::{Architecture, Triple};

use super::clif::{Chunk, heading};
use crate::logic::Program;

/// One decoded instruction.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Line {
    /// Bytes from the start of the code.
    pub offset: u64,
    /// Its bytes.
    pub bytes: Vec<u8>,
    /// Mnemonic and operands.
    pub text: String,
    /// Whether it jumps, branches or calls; a return does not count.
    pub jumps: bool,
    /// Whether it calls.
    pub calls: bool,
}

/// Decodes code for a target, up to the first bytes that are no instruction.
///
/// # Errors
/// When the disassembler does not know the target.
pub fn lines(code: &[u8], target: &Triple) -> Result<Vec<Line>, String> {
    let capstone = decoder(target)?;
    let instructions = capstone.disasm_all(code, 0).map_err(|error| error.to_string())?;
    let mut lines = Vec::with_capacity(instructions.len());
    for instruction in instructions.iter() {
        let detail = capstone.insn_detail(instruction).map_err(|error| error.to_string())?;
        let is_of = |group| detail.groups().contains(&InsnGroupId(u8::try_from(group).unwrap_or_default()));
        let mnemonic = instruction.mnemonic().unwrap_or_default();
        let operands = instruction.op_str().unwrap_or_default();
        let returns = mnemonic.starts_with("ret") || matches!((mnemonic, operands), ("jr" | "c.jr", "ra"));
        lines.push(Line {
            offset: instruction.address(),
            bytes: instruction.bytes().to_vec(),
            text: format!("{mnemonic} {operands}").trim_end().to_owned(),
            jumps: !returns && (is_of(CS_GRP_JUMP) || is_of(CS_GRP_CALL)),
            calls: is_of(CS_GRP_CALL),
        });
    }
    Ok(lines)
}

fn decoder(target: &Triple) -> Result<Capstone, String> {
    let built = match target.architecture {
        Architecture::X86_64 => Capstone::new().x86().mode(arch::x86::ArchMode::Mode64).detail(true).build(),
        Architecture::Aarch64(_) => Capstone::new().arm64().mode(arch::arm64::ArchMode::Arm).detail(true).build(),
        Architecture::Riscv64(_) => Capstone::new()
            .riscv()
            .mode(arch::riscv::ArchMode::RiscV64)
            .extra_mode(std::iter::once(arch::riscv::ArchExtraMode::RiscVC))
            .detail(true)
            .build(),
        other => return Err(format!("no disassembler for {other}")),
    };
    built.map_err(|error| error.to_string())
}

/// A listing of compiled chunks, each section headed by its label.
///
/// # Errors
/// When the disassembler does not know the target.
pub fn listing(program: &Program, chunks: &[Chunk], target: &Triple) -> Result<String, String> {
    let mut out = String::new();
    for chunk in chunks {
        let (first, last) = (chunk.sections.start, chunk.sections.end.saturating_sub(1));
        let _ = writeln!(out, "; sections {first} to {last}, bases at image + {:?}", chunk.bases);
        let mut marks = chunk.marks.iter().peekable();
        let lines = lines(&chunk.code[..chunk.instruction_bytes], target)?;
        for line in &lines {
            while let Some((_, section)) = marks.next_if(|(offset, _)| u64::from(*offset) <= line.offset) {
                out.push_str(&heading(program, *section, ";"));
            }
            let _ = write!(out, "{:6x}:  ", line.offset);
            for byte in &line.bytes {
                let _ = write!(out, "{byte:02x} ");
            }
            let _ = writeln!(out, "{:width$} {}", "", line.text, width = 30usize.saturating_sub(3 * line.bytes.len()));
        }
        for (index, constant) in chunk.code[chunk.instruction_bytes..].chunks(8).enumerate() {
            let _ = write!(out, "{:6x}:  .byte", chunk.instruction_bytes + 8 * index);
            for byte in constant {
                let _ = write!(out, " {byte:02x}");
            }
            out.push('\n');
        }
        out.push('\n');
    }
    Ok(out)
}
