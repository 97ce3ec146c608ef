//! A trace as waves: a value change dump (IEEE 1364), which every wave viewer reads.
//!
//! One module holds the program, and scopes in it, one in the other, what stands for several: programs, block
//! instances, structures. BOOLs are wires; bit strings and unsigned
//! integers are wires as wide as their type; signed integers are `integer`s in two's complement; REAL and LREAL
//! are reals, and so is TIME, in milliseconds, which viewers can draw as a curve. Only changes are written.

use std::fmt;
use std::io::{self, Write};

use vcd::{IdCode, TimescaleUnit, Value as Bit, VarType, Writer};

use super::{Signal, Trace};
use crate::elementary::{Elementary, Value};

/// Writes the declarations and then every change, as it is recorded.
pub struct VcdTrace<W: Write> {
    waves: Vec<Wave>,
    out: Writer<W>,
    last_time: Option<i64>,
    last_written: Option<i64>,
}

#[derive(Debug)]
struct Wave {
    signal: Signal,
    id: IdCode,
    last: Option<Value>,
}

impl<W: Write> fmt::Debug for VcdTrace<W> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("VcdTrace")
            .field("waves", &self.waves)
            .field("last_time", &self.last_time)
            .finish_non_exhaustive()
    }
}

impl<W: Write> VcdTrace<W> {
    /// Starts a dump of these signals with its declarations.
    ///
    /// # Errors
    /// When `out` fails.
    pub fn new(program: &str, signals: Vec<Signal>, out: W) -> io::Result<Self> {
        let mut out = Writer::new(out);
        out.timescale(1, TimescaleUnit::NS)?;
        out.add_module(&identifier(program))?;
        let mut waves = Vec::with_capacity(signals.len());
        let mut open: Vec<String> = Vec::new();
        for signal in signals {
            let (owner, member) = signal.parts();
            let path: Vec<&str> = owner.into_iter().flat_map(|owner| owner.split('.')).collect();
            let common = open.iter().zip(&path).take_while(|(open, scope)| open == *scope).count();
            for _ in common..open.len() {
                out.upscope()?;
            }
            open.truncate(common);
            for scope in &path[common..] {
                out.add_module(&identifier(scope))?;
                open.push((*scope).to_owned());
            }
            let (kind, width) = match signal.ty() {
                Elementary::Real | Elementary::Lreal | Elementary::Time => (VarType::Real, 64),
                ty if ty.is_signed() => (VarType::Integer, ty.bits()),
                ty => (VarType::Wire, ty.bits()),
            };
            let id = out.add_var(kind, width, &identifier(member), None)?;
            waves.push(Wave { signal, id, last: None });
        }
        // What is still open, and the program.
        for _ in 0..=open.len() {
            out.upscope()?;
        }
        out.enddefinitions()?;
        Ok(Self { waves, out, last_time: None, last_written: None })
    }
}

impl<W: Write> Trace for VcdTrace<W> {
    fn record(&mut self, now: i64, image: &[u8]) -> io::Result<()> {
        for wave in &mut self.waves {
            let value = wave.signal.read(image);
            if wave.last == Some(value) {
                continue;
            }
            wave.last = Some(value);
            if self.last_written != Some(now) {
                self.out.timestamp(timestamp(now))?;
                self.last_written = Some(now);
            }
            change(&mut self.out, wave.id, value)?;
        }
        self.last_time = Some(now);
        Ok(())
    }

    fn finish(&mut self) -> io::Result<()> {
        // The last scan's time, so that a viewer shows the trace to its end.
        if let Some(last) = self.last_time.filter(|last| self.last_written != Some(*last)) {
            self.out.timestamp(timestamp(last))?;
        }
        self.out.flush()
    }
}

fn timestamp(now: i64) -> u64 {
    u64::try_from(now).unwrap_or(0)
}

fn change<W: Write>(out: &mut Writer<W>, id: IdCode, value: Value) -> io::Result<()> {
    let ty = value.ty();
    match (ty, value.as_real()) {
        (Elementary::Bool, _) => out.change_scalar(id, Bit::from(value.is_true())),
        (Elementary::Time, _) => change_real(out, id, milliseconds(value.bits().cast_signed())),
        (_, Some(real)) => change_real(out, id, real),
        (_, None) => {
            let bit = |place: u32| Bit::from(value.bits() >> place & 1 == 1);
            out.change_vector(id, (0..ty.bits()).rev().map(bit))
        }
    }
}

/// Like [`Writer::change_real`], but with an exponent where it makes the number shorter: readers refuse long words.
fn change_real<W: Write>(out: &mut Writer<W>, id: IdCode, real: f64) -> io::Result<()> {
    writeln!(out.writer(), "r{real:?} {id}")
}

/// The nearest number of milliseconds.
fn milliseconds(nanoseconds: i64) -> f64 {
    nanoseconds as f64 / 1e6
}

/// A name as one word of the format, in which white space parts words and `$` starts a command.
fn identifier(name: &str) -> String {
    if name.is_empty() {
        return "_".to_owned();
    }
    let word = |c: char| if c.is_whitespace() || c.is_control() || c == '$' { '_' } else { c };
    name.chars().map(word).collect()
}
