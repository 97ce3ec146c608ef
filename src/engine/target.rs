//! The machine that code is made for: a triple, what its processor offers beyond the least, and how C calls there.
//!
//! An object must only use what was asked for, so that nothing is taken from the machine that Rung runs on, but where
//! [`Target::host`] says so. What is wrong with a target is a coded error.

mod features;
mod floats;
mod riscv;
#[cfg(test)]
mod tests;

use std::fmt;

use cranelift_codegen::isa::{self, LookupError, OwnedTargetIsa};
use cranelift_codegen::settings::Configurable;
use target_lexicon::{Aarch64Architecture, Architecture, BinaryFormat, Riscv64Architecture, Triple};

use super::clif;
use crate::diagnostic::Code;

pub(in crate::engine) use floats::first_beyond;
pub use riscv::FloatAbi;

/// Which floating point a processor computes in.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Floats {
    /// None.
    No,
    /// REAL.
    Single,
    /// REAL and LREAL.
    Double,
}

/// A machine that there is a back end for.
#[derive(Clone)]
pub struct Target {
    isa: OwnedTargetIsa,
    floats: Floats,
    /// The word of an ELF header that names the ABI, where the architecture has one.
    elf_flags: Option<u32>,
    /// What the processor offers, as it was asked for; empty where nothing was.
    extensions: String,
}

impl fmt::Debug for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Target({self})")
    }
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.isa.triple())?;
        if self.extensions.is_empty() { Ok(()) } else { write!(f, ", {}", self.extensions) }
    }
}

/// Why there is no such target.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct BadTarget {
    /// [`Code::UnknownTarget`] or [`Code::BadIsa`].
    pub code: Code,
    /// What is wrong, one line.
    pub message: String,
    /// What to do about it.
    pub hint: String,
}

impl BadTarget {
    fn unknown(message: String, hint: impl Into<String>) -> Self {
        Self { code: Code::UnknownTarget, message, hint: hint.into() }
    }

    fn isa(message: String, hint: impl Into<String>) -> Self {
        Self { code: Code::BadIsa, message, hint: hint.into() }
    }
}

impl fmt::Display for BadTarget {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for BadTarget {}

/// Triples for hints.
const EXAMPLES: &str =
    "as in `riscv64-unknown-elf`, `aarch64-unknown-linux-gnu`, `x86_64-unknown-linux-gnu`, `aarch64-apple-darwin`";

impl Target {
    /// The machine that Rung runs on, with all that its processor offers.
    ///
    /// # Errors
    /// [`Code::UnknownTarget`] when there is no back end for it.
    pub fn host() -> Result<Self, BadTarget> {
        let unknown = |reason: String| BadTarget::unknown(format!("no code for this machine: {reason}"), NO_BACK_END);
        let builder = cranelift_native::builder().map_err(|reason| unknown(reason.to_owned()))?;
        let flags = clif::flags(false).map_err(|error| unknown(error.to_string()))?;
        let isa = builder.finish(flags).map_err(|error| unknown(error.to_string()))?;
        Ok(Self { isa, floats: Floats::Double, elf_flags: None, extensions: "all that this processor has".to_owned() })
    }

    /// The triple of the machine that Rung runs on.
    pub fn host_triple() -> String {
        Triple::host().to_string()
    }

    /// A machine by its triple, as compilers name it; by what its processor offers; and by the ABI of its C.
    ///
    /// - RISC-V takes an ISA string such as `rv64imac_zba_zbb`; without one it is that of the triple's architecture, and
    ///   `rv64gc` of plain `riscv64`. The ABI is `lp64`, `lp64f` or `lp64d`; without one, what the registers allow.
    /// - x86-64 and AArch64 take names of features, such as `avx2,bmi1` or `lse`; without them, no more than every such
    ///   processor has. They have one ABI, the system's.
    ///
    /// # Errors
    /// [`Code::UnknownTarget`] for a triple that there is no back end for, [`Code::BadIsa`] for what such a processor or
    /// its ABI cannot be.
    pub fn new(triple: &str, extensions: Option<&str>, abi: Option<&str>) -> Result<Self, BadTarget> {
        let triple = parse(triple)?;
        let mut builder = isa::lookup(triple.clone()).map_err(|error| match error {
            LookupError::SupportDisabled => {
                BadTarget::unknown(format!("this Rung was built without a back end for `{triple}`"), NO_BACK_END)
            }
            LookupError::Unsupported => BadTarget::unknown(format!("there is no back end for `{triple}`"), EXAMPLES),
        })?;
        let refused = |reason: String| BadTarget::isa(format!("no code for `{triple}`: {reason}"), EXAMPLES);
        // Mach-O has no short way to the address of data but by its table of them.
        let by_table = triple.binary_format == BinaryFormat::Macho && triple.architecture == Architecture::X86_64;
        let flags = clif::flags(by_table).map_err(|error| refused(error.to_string()))?;
        let mut enable = |setting: &str| builder.enable(setting).map_err(|error| refused(error.to_string()));
        let (floats, elf_flags, extensions) = match triple.architecture {
            Architecture::Riscv64(architecture) => {
                let processor = riscv::Processor::parse(extensions.unwrap_or(default_isa(architecture)))?;
                let abi = processor.abi(abi)?;
                for setting in processor.settings() {
                    enable(setting)?;
                }
                (processor.floats(), Some(processor.elf_flags(abi)), format!("{processor}, {abi}"))
            }
            _ => {
                if let Some(abi) = abi {
                    return Err(BadTarget::isa(
                        format!("`{triple}` has one ABI, and `{abi}` cannot be chosen"),
                        "leave `--abi` out; it is for RISC-V",
                    ));
                }
                let extensions = extensions.unwrap_or_default();
                for setting in features::settings(triple.architecture, extensions)? {
                    enable(setting)?;
                }
                (Floats::Double, None, extensions.to_owned())
            }
        };
        let isa = builder.finish(flags).map_err(|error| refused(error.to_string()))?;
        Ok(Self { isa, floats, elf_flags, extensions })
    }

    /// Cranelift's code generator for it.
    pub fn isa(&self) -> &OwnedTargetIsa {
        &self.isa
    }

    /// Its triple.
    pub fn triple(&self) -> &Triple {
        self.isa.triple()
    }

    /// What it computes of REAL and LREAL.
    pub fn floats(&self) -> Floats {
        self.floats
    }

    /// The flags of an ELF header that the ABI wants, where the architecture has such.
    pub fn elf_flags(&self) -> Option<u32> {
        self.elf_flags
    }
}

const NO_BACK_END: &str =
    "build Rung with the feature `all-targets`, as in `cargo build --release --features all-targets`";

/// What was given, fit for one line of a message.
fn shown(text: &str) -> String {
    text.chars().filter(|c| !c.is_control()).take(80).collect()
}

/// A triple of a 64-bit architecture that Rung makes code for, in a format of objects.
fn parse(text: &str) -> Result<Triple, BadTarget> {
    let unknown = |hint: &str| BadTarget::unknown(format!("`{}` is no target", shown(text)), hint);
    let mut triple: Triple = text.parse().map_err(|_| unknown(EXAMPLES))?;
    match triple.architecture {
        Architecture::X86_64 | Architecture::Aarch64(Aarch64Architecture::Aarch64) | Architecture::Riscv64(_) => {}
        _ if triple.pointer_width().is_ok_and(|width| width.bits() < 64) => {
            return Err(unknown("32-bit targets are reached through a C compiler: `--emit c`"));
        }
        _ => return Err(unknown(EXAMPLES)),
    }
    match (triple.binary_format, triple.architecture) {
        // Bare metal: what every tool there takes.
        (BinaryFormat::Unknown, _) => triple.binary_format = BinaryFormat::Elf,
        (BinaryFormat::Elf, _) => {}
        (BinaryFormat::Macho, Architecture::X86_64 | Architecture::Aarch64(_)) => {}
        // Of AArch64, the writer of objects has no addresses in COFF.
        (BinaryFormat::Coff, Architecture::X86_64) => {}
        _ => return Err(unknown("objects are ELF, and of x86-64 and AArch64 also Mach-O, and of x86-64 also COFF")),
    }
    Ok(triple)
}

/// What a RISC-V triple says of the processor.
fn default_isa(architecture: Riscv64Architecture) -> &'static str {
    match architecture {
        Riscv64Architecture::Riscv64imac => "rv64imac",
        Riscv64Architecture::Riscv64a23 => "rv64gc_zba_zbb_zbs_zcb_zicond",
        _ => "rv64gc",
    }
}
