//! RISC-V's ISA strings, such as `rv64imac_zba_zbb`, and its ABIs.
//!
//! A string is read in either case and, behind `rv64i` or `rv64g`, in any order; versions are not taken. Extensions that
//! no code of a ladder can use are known, and change nothing.

use std::collections::BTreeSet;
use std::fmt;

use super::{BadTarget, Floats, shown};

/// `EF_RISCV_RVC` of an ELF header: code may hold compressed instructions.
const COMPRESSED: u32 = 0x1;
/// `EF_RISCV_FLOAT_ABI_SINGLE`.
const SINGLE: u32 = 0x2;
/// `EF_RISCV_FLOAT_ABI_DOUBLE`.
const DOUBLE: u32 = 0x4;

/// Extensions with what each brings along.
const KNOWN: &[(&str, &[&str])] = &[
    ("i", &[]),
    ("m", &["zmmul"]),
    ("a", &[]),
    ("f", &["zicsr"]),
    ("d", &["f", "zicsr"]),
    ("q", &["d", "f", "zicsr"]),
    ("c", &["zca"]),
    ("b", &["zba", "zbb", "zbs"]),
    ("v", &[]),
    ("h", &[]),
    ("zmmul", &[]),
    ("zicsr", &[]),
    ("zifencei", &[]),
    ("zicntr", &[]),
    ("zihpm", &[]),
    ("zicond", &[]),
    ("zaamo", &[]),
    ("zalrsc", &[]),
    ("zacas", &[]),
    ("zawrs", &[]),
    ("zba", &[]),
    ("zbb", &[]),
    ("zbc", &[]),
    ("zbs", &[]),
    ("zbkb", &[]),
    ("zbkc", &[]),
    ("zbkx", &[]),
    ("zca", &[]),
    ("zcb", &["zca"]),
    ("zcd", &["zca"]),
    ("zfa", &["f", "zicsr"]),
    ("zfh", &["f", "zicsr", "zfhmin"]),
    ("zfhmin", &["f", "zicsr"]),
    ("zicbom", &[]),
    ("zicbop", &[]),
    ("zicboz", &[]),
    ("zihintpause", &[]),
    ("zihintntl", &[]),
    ("zimop", &[]),
    ("zcmop", &["zca"]),
    ("zkn", &[]),
    ("zks", &[]),
    ("zkt", &[]),
];

/// Those that code uses, with Cranelift's settings. Zcd only moves doubles, and goes with C and D.
const USED: &[(&str, &str)] = &[
    ("zca", "has_zca"),
    ("zcd", "has_zcd"),
    ("zcb", "has_zcb"),
    ("zba", "has_zba"),
    ("zbb", "has_zbb"),
    ("zbs", "has_zbs"),
    ("zicond", "has_zicond"),
];

/// In which registers C passes reals.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum FloatAbi {
    /// In those of integers, `lp64`.
    Soft,
    /// A REAL in one of its own, `lp64f`.
    Single,
    /// Both in their own, `lp64d`.
    Double,
}

impl fmt::Display for FloatAbi {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Soft => "lp64",
            Self::Single => "lp64f",
            Self::Double => "lp64d",
        })
    }
}

/// A processor of 64 bits.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Processor {
    /// As it was given, in lower case.
    text: String,
    /// What it has, with all that is brought along.
    extensions: BTreeSet<&'static str>,
}

impl fmt::Display for Processor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl Processor {
    /// Reads an ISA string.
    pub(super) fn parse(given: &str) -> Result<Self, BadTarget> {
        let text: String = given.trim().to_ascii_lowercase();
        let refused =
            |reason: String, hint: &str| BadTarget::isa(format!("`{}`: {}", shown(&text), shown(&reason)), hint);
        let Some(rest) = text.strip_prefix("rv64") else {
            let hint = "32-bit cores are reached through a C compiler: `--emit c`";
            let hint = if text.starts_with("rv32") { hint } else { EXAMPLE };
            return Err(refused("an ISA string starts with `rv64`".to_owned(), hint));
        };
        let mut parts = rest.split('_');
        let mut names: Vec<&str> = Vec::new();
        let singles = parts.next().unwrap_or_default();
        // The first run of letters may end in one long name: `rv64imaczba`.
        let long = singles.find(['z', 's', 'x']).unwrap_or(singles.len());
        let (singles, long) = singles.split_at(long);
        names.extend(singles.char_indices().map(|(at, c)| &singles[at..at + c.len_utf8()]));
        names.extend(Some(long).filter(|long| !long.is_empty()));
        names.extend(parts);
        let Some(base @ ("i" | "g")) = names.first().copied() else {
            let hint = if names.first() == Some(&"e") { "code needs 32 registers" } else { EXAMPLE };
            return Err(refused("behind `rv64` stands the base, `i` or `g`".to_owned(), hint));
        };
        let mut extensions = BTreeSet::new();
        if base == "g" {
            names.splice(..1, ["i", "m", "a", "f", "d", "zicsr", "zifencei"]);
        }
        let mut seen = BTreeSet::new();
        for name in names {
            if name.bytes().all(|byte| byte.is_ascii_digit()) {
                return Err(refused("versions of extensions are not taken".to_owned(), EXAMPLE));
            }
            if !seen.insert(name) && name.len() == 1 {
                return Err(refused(format!("`{name}` stands there twice"), "leave one out"));
            }
            // What vendors and supervisors add is nothing that a ladder's code uses.
            if name.len() > 1 && name.starts_with(['s', 'x']) {
                continue;
            }
            let Some((name, brings)) = KNOWN.iter().find(|(known, _)| *known == name) else {
                return Err(refused(format!("there is no extension `{name}`"), EXAMPLE));
            };
            extensions.insert(*name);
            extensions.extend(*brings);
        }
        if extensions.contains("c") && extensions.contains("d") {
            extensions.insert("zcd");
        }
        if !extensions.contains("m") {
            let hint = "a core without it is reached through a C compiler: `--emit c`";
            return Err(refused("code needs multiplication and division, the extension M".to_owned(), hint));
        }
        Ok(Self { text, extensions })
    }

    fn has(&self, extension: &str) -> bool {
        self.extensions.contains(extension)
    }

    /// What it computes of REAL and LREAL.
    pub(super) fn floats(&self) -> Floats {
        match (self.has("f"), self.has("d")) {
            (_, true) => Floats::Double,
            (true, false) => Floats::Single,
            (false, false) => Floats::No,
        }
    }

    /// Its ABI by name, or the one that its registers allow.
    pub(super) fn abi(&self, name: Option<&str>) -> Result<FloatAbi, BadTarget> {
        let most = match self.floats() {
            Floats::No => FloatAbi::Soft,
            Floats::Single => FloatAbi::Single,
            Floats::Double => FloatAbi::Double,
        };
        let Some(name) = name else { return Ok(most) };
        let known = [FloatAbi::Soft, FloatAbi::Single, FloatAbi::Double];
        let Some(abi) = known.into_iter().find(|abi| abi.to_string().eq_ignore_ascii_case(name)) else {
            return Err(BadTarget::isa(
                format!("`{}` is no ABI of RV64", shown(name)),
                "`--abi` takes lp64, lp64f or lp64d",
            ));
        };
        if abi as u8 > most as u8 {
            return Err(BadTarget::isa(
                format!("the ABI {abi} passes reals in registers that `{self}` has not"),
                format!("take `--abi {most}`, or an `--isa` with those registers"),
            ));
        }
        Ok(abi)
    }

    /// Cranelift's settings for what it has. Of those that Cranelift takes for granted, code of integers uses M only.
    pub(super) fn settings(&self) -> impl Iterator<Item = &'static str> {
        USED.iter().filter(|(name, _)| self.has(name)).map(|(_, setting)| *setting)
    }

    /// The flags of an ELF header.
    pub(super) fn elf_flags(&self, abi: FloatAbi) -> u32 {
        let compressed = if self.has("zca") { COMPRESSED } else { 0 };
        compressed
            | match abi {
                FloatAbi::Soft => 0,
                FloatAbi::Single => SINGLE,
                FloatAbi::Double => DOUBLE,
            }
    }
}

const EXAMPLE: &str = "an ISA string is such as `rv64imac`, `rv64gc` or `rv64imac_zba_zbb_zbs_zicond`";
