//! What a scan costs, from the code itself: instructions, loads, stores and bytes, rung by rung and in all.
//!
//! A scan is a straight line, so that its count of instructions is exact: each is executed once. What is not exact is
//! marked: calls of helpers, whose own counts stand apart, and operations that branch on the target. Cycles depend on the
//! processor and its memory, and nothing may be said of them here.

#[cfg(test)]
mod tests;

use std::fmt::Write as _;
use std::ops::AddAssign;

use serde::Serialize;
use target_lexicon::{Architecture, Triple};

use super::clif::{BRANCHING, Chunk, copy_is_called};
use super::disassemble;
use super::object::{Function, Object, Role};
use super::target::Target;
use crate::logic::{Binary, Instruction, Op, Program};

/// Counts of some code.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug, Serialize)]
pub struct Cost {
    /// Instructions.
    pub instructions: usize,
    /// Those that read memory, the stack's among it.
    pub loads: usize,
    /// Those that write memory.
    pub stores: usize,
    /// Bytes of instructions.
    pub bytes: usize,
}

impl AddAssign for Cost {
    fn add_assign(&mut self, other: Self) {
        self.instructions += other.instructions;
        self.loads += other.loads;
        self.stores += other.stores;
        self.bytes += other.bytes;
    }
}

/// What one rung costs.
#[derive(Clone, PartialEq, Eq, Debug, Serialize)]
pub struct Rung {
    /// Its label.
    pub name: String,
    /// Its line in the source, from 1, or 0.
    pub line: u32,
    /// Its code. What several rungs share counts where it stands.
    #[serde(flatten)]
    pub cost: Cost,
    /// Operations that branch on the target, of those that the manual lists.
    pub branching: usize,
    /// Calls of helpers, each of which takes as long as its operands need.
    pub helper_calls: usize,
}

/// What something costs that is no rung.
#[derive(Clone, PartialEq, Eq, Debug, Serialize)]
pub struct Part {
    /// Its symbol.
    pub name: String,
    /// Its code; of what has loops, each instruction once.
    #[serde(flatten)]
    pub cost: Cost,
}

/// What an object costs.
#[derive(Clone, PartialEq, Eq, Debug, Serialize)]
pub struct Report {
    /// The triple, and what its processor offers.
    pub target: String,
    /// The rungs, in the order in which they run.
    pub rungs: Vec<Rung>,
    /// Entries of the functions that hold the rungs.
    pub entries: Cost,
    /// All of `P_scan`: rungs, entries, and the calls between; without what helpers execute.
    pub scan: Cost,
    /// What `P_cycle` does before it scans.
    pub cycle: Cost,
    /// What `P_tick` does.
    pub tick: Cost,
    /// The helpers that are called, each with all that it executes; copies have a loop.
    pub helpers: Vec<Part>,
    /// All other functions, which have loops.
    pub others: Vec<Part>,
}

/// Counts what is in an object.
///
/// # Errors
/// When the code cannot be decoded.
pub fn report(program: &Program, object: &Object, target: &Target) -> Result<Report, String> {
    let triple = target.triple();
    let mut rungs: Vec<Rung> = (0..program.sections.len()).map(|section| rung(program, section, triple)).collect();
    let mut entries = Cost::default();
    for chunk in &object.chunks {
        count_chunk(chunk, triple, &mut rungs, &mut entries)?;
    }
    let mut scan = entries;
    rungs.iter().for_each(|rung| scan += rung.cost);
    let of = |role: Role| -> Result<Cost, String> {
        let mut cost = Cost::default();
        for function in object.functions.iter().filter(|function| function.role == role) {
            cost += count_function(function, triple)?;
        }
        Ok(cost)
    };
    scan += of(Role::Round)?;
    let part = |function: &Function| -> Result<Part, String> {
        Ok(Part { name: function.name.clone(), cost: count_function(function, triple)? })
    };
    let parts = |role: Role| -> Result<Vec<Part>, String> {
        object.functions.iter().filter(|function| function.role == role).map(part).collect()
    };
    let mut helpers = parts(Role::Helper)?;
    for (helper, chunks) in &object.helpers {
        let own = format!(".{}", helper.mnemonic());
        let Some(part) = helpers.iter_mut().find(|part| part.name.ends_with(&own)) else { continue };
        for chunk in chunks {
            part.cost += count(&chunk.code[..chunk.instruction_bytes], triple)?;
        }
    }
    Ok(Report {
        target: target.to_string(),
        rungs,
        entries,
        scan,
        cycle: of(Role::Cycle)?,
        tick: of(Role::Tick)?,
        helpers,
        others: parts(Role::Image)?,
    })
}

/// A rung's name, and what of it is not exact.
fn rung(program: &Program, section: usize, triple: &Triple) -> Rung {
    let origin = &program.origins[program.sections[section].origin as usize];
    let architecture = triple.architecture.to_string();
    let listed = |op: Binary| {
        let row = BRANCHING.iter().find(|row| row.op == op);
        row.is_some_and(|row| row.architectures.iter().any(|name| architecture.starts_with(name)))
    };
    let branches = |Instruction { ty, op }: &&Instruction| {
        let Op::Binary(op, _, divisor) = *op else { return false };
        // A constant divisor is seen not to be 0.
        let constant = matches!(program.instructions[divisor.index()].op, Op::Constant(bits) if bits != 0);
        listed(op) && !ty.is_real() && !constant
    };
    let calls = |instruction: &&Instruction| match instruction.op {
        Op::CopyArray(to, ..) => copy_is_called(program, to),
        op => matches!(op, Op::Call(..)),
    };
    let instructions = || program.instructions[program.section_range(section)].iter();
    Rung {
        name: origin.label.chars().filter(|c| !c.is_control()).collect(),
        line: origin.line,
        cost: Cost::default(),
        branching: instructions().filter(branches).count(),
        helper_calls: instructions().filter(calls).count(),
    }
}

/// Adds a chunk's code to the rungs that it holds.
fn count_chunk(chunk: &Chunk, triple: &Triple, rungs: &mut [Rung], entries: &mut Cost) -> Result<(), String> {
    let mut starts: Vec<(usize, Option<usize>)> = vec![(0, None)];
    starts.extend(chunk.marks.iter().map(|(offset, section)| (*offset as usize, Some(*section))));
    let ends = starts.iter().skip(1).map(|(start, _)| *start).chain([chunk.instruction_bytes]).collect::<Vec<_>>();
    for ((start, section), end) in starts.into_iter().zip(ends) {
        let cost = count(&chunk.code[start..end.max(start)], triple)?;
        match section.and_then(|section| rungs.get_mut(section)) {
            Some(rung) => rung.cost += cost,
            None => *entries += cost,
        }
    }
    Ok(())
}

fn count_function(function: &Function, triple: &Triple) -> Result<Cost, String> {
    count(&function.code[..function.instruction_bytes], triple)
}

/// Counts instructions, and what they do to memory.
fn count(code: &[u8], triple: &Triple) -> Result<Cost, String> {
    let mut cost = Cost::default();
    for line in disassemble::lines(code, triple)? {
        if line.is_data {
            cost.bytes += line.bytes.len();
            continue;
        }
        let (loads, stores) = memory(&line.text, triple.architecture);
        cost +=
            Cost { instructions: 1, loads: usize::from(loads), stores: usize::from(stores), bytes: line.bytes.len() };
    }
    if cost.bytes == code.len() {
        Ok(cost)
    } else {
        Err(format!("{} bytes cannot be decoded", code.len() - cost.bytes))
    }
}

/// Whether an instruction reads memory, and whether it writes it.
fn memory(text: &str, architecture: Architecture) -> (bool, bool) {
    let (mnemonic, operands) = text.split_once(' ').unwrap_or((text, ""));
    match architecture {
        Architecture::X86_64 => {
            let at = operands.find('[');
            let Some(at) = at.filter(|_| !matches!(mnemonic, "lea" | "nop")) else {
                return (matches!(mnemonic, "pop" | "ret"), matches!(mnemonic, "push" | "call"));
            };
            // What is written stands first; moves and `set` do not read it, and comparisons do not write it.
            let first = operands.find(',').is_none_or(|comma| at < comma);
            let writes =
                first && !matches!(mnemonic, "cmp" | "test" | "call" | "jmp" | "push" | "div" | "idiv" | "mul");
            let reads = !writes || !["mov", "vmov", "set"].iter().any(|start| mnemonic.starts_with(start));
            (reads, writes || matches!(mnemonic, "call" | "push"))
        }
        Architecture::Riscv64(_) => {
            let plain = mnemonic.strip_prefix("c.").unwrap_or(mnemonic);
            let plain = plain.strip_suffix("sp").unwrap_or(plain);
            let loads = matches!(plain, "lb" | "lbu" | "lh" | "lhu" | "lw" | "lwu" | "ld" | "flw" | "fld");
            (loads, matches!(plain, "sb" | "sh" | "sw" | "sd" | "fsw" | "fsd"))
        }
        _ => {
            let memory = operands.contains('[');
            (memory && mnemonic.starts_with("ld"), memory && mnemonic.starts_with("st"))
        }
    }
}

impl Report {
    /// The report as a table for people.
    pub fn table(&self) -> String {
        let mut text = format!("What a scan costs on {}\n\n", self.target);
        let width = self.rungs.iter().map(|rung| rung.name.chars().count()).max().unwrap_or(0).clamp(12, 40);
        let mut line = |name: &str, cost: Cost, note: &str| {
            let Cost { instructions, loads, stores, bytes } = cost;
            let row = format!("{name:width$} {instructions:>12} {loads:>8} {stores:>8} {bytes:>9}  {note}");
            let _ = writeln!(text, "{}", row.trim_end());
        };
        for rung in &self.rungs {
            let mut notes = Vec::new();
            if rung.branching > 0 {
                notes.push(format!("{} operations that test for zero", rung.branching));
            }
            if rung.helper_calls > 0 {
                notes.push(format!("{} calls of helpers", rung.helper_calls));
            }
            let name: String = rung.name.chars().take(width).collect();
            line(&name, rung.cost, &notes.join(", "));
        }
        line("entries", self.entries, "");
        line("P_scan", self.scan, "all of the above, and the calls between");
        line("P_cycle", self.cycle, "before it scans");
        line("P_tick", self.tick, "");
        for part in &self.helpers {
            line(&part.name, part.cost, "each call");
        }
        for part in &self.others {
            line(&part.name, part.cost, "has loops; each instruction counted once");
        }
        let heading = format!("{:width$} {:>12} {:>8} {:>8} {:>9}", "rung", "instructions", "loads", "stores", "bytes");
        let at = text.find("\n\n").map_or(0, |at| at + 2);
        text.insert_str(at, &format!("{heading}\n"));
        text.push_str(
            "\nA scan is a straight line: each instruction is executed once, but for what is marked, and for tasks that \
             are not due.\nHow many cycles that takes is the target's matter.\n",
        );
        text
    }

    /// The report for programs, in JSON.
    pub fn json(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }
}
