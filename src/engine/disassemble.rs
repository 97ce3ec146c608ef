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
    /// Whether these are constants that the code jumps over, and no instruction.
    pub is_data: bool,
}

/// Major opcodes of RISC-V that hold arithmetic and nothing that jumps or touches memory: OP-IMM, OP-IMM-32, OP, OP-32. The
/// extensions that Capstone does not know add to these.
const ARITHMETIC: [u8; 4] = [0x13, 0x1B, 0x33, 0x3B];

/// Decodes code for a target, up to the first bytes that are no instruction. Arithmetic of RISC-V that the disassembler
/// does not know is shown as its number. In long functions for RISC-V some constants lie among the instructions, behind a jump
/// over them: in a straight line nothing else jumps forward and always, so what is left out by it is data, and the jump none
/// that counts.
///
/// # Errors
/// When the disassembler does not know the target.
pub fn lines(code: &[u8], target: &Triple) -> Result<Vec<Line>, String> {
    let capstone = decoder(target)?;
    let mut lines = Vec::new();
    let mut at = 0;
    while at < code.len() {
        decode(&capstone, &code[at..], at as u64, &mut lines)?;
        if let Some(end) = cut_at_constants(&mut lines, code, at, target) {
            at = end;
            continue;
        }
        at = lines.last().map_or(0, |line: &Line| usize::try_from(line.offset).unwrap_or(0) + line.bytes.len());
        match (&code[at..], target.architecture) {
            ([first, b, c, d, ..], Architecture::Riscv64(_)) if ARITHMETIC.contains(&(first & 0x7F)) => {
                let bytes = [*first, *b, *c, *d];
                let text = format!(".insn {:#010x}", u32::from_le_bytes(bytes));
                lines.push(Line {
                    offset: at as u64,
                    bytes: bytes.to_vec(),
                    text,
                    jumps: false,
                    calls: false,
                    is_data: false,
                });
                at += bytes.len();
            }
            _ => break,
        }
    }
    Ok(lines)
}

/// Adds what can be decoded.
fn decode(capstone: &Capstone, code: &[u8], offset: u64, lines: &mut Vec<Line>) -> Result<(), String> {
    let instructions = capstone.disasm_all(code, offset).map_err(|error| error.to_string())?;
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
            is_data: false,
        });
    }
    Ok(())
}

/// Replaces what was decoded from `from` on, behind the first jump over constants, by these; gives where they end.
fn cut_at_constants(lines: &mut Vec<Line>, code: &[u8], from: usize, target: &Triple) -> Option<usize> {
    if !matches!(target.architecture, Architecture::Riscv64(_)) {
        return None;
    }
    let place = |line: &Line| usize::try_from(line.offset).unwrap_or(usize::MAX);
    let first = lines.iter().position(|line| place(line) >= from)?;
    let (jump, end) = lines.iter().enumerate().skip(first).find_map(|(index, line)| {
        let way = line.text.strip_prefix("c.j 0x").or_else(|| line.text.strip_prefix("j 0x"))?;
        let end = place(line).checked_add(usize::from_str_radix(way, 16).ok()?)?;
        (end > place(line) + line.bytes.len() && end <= code.len()).then_some((index, end))
    })?;
    lines.truncate(jump + 1);
    let line = lines.last_mut()?;
    line.jumps = false;
    let start = place(line) + line.bytes.len();
    let (bytes, text) = (code[start..end].to_vec(), ".data".to_owned());
    lines.push(Line { offset: start as u64, bytes, text, jumps: false, calls: false, is_data: true });
    Some(end)
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
