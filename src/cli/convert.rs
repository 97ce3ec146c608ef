//! `rung convert`: a program in another format, with the same trace.

use std::path::PathBuf;

use clap::ValueEnum;

use super::{Failure, load, report, write_whole};
use crate::check::check;
use crate::diagnostic::{self, any_error};
use crate::frontend::{native, plcopen, structured_text};
use crate::ladder::Origin;

/// Writes a program in another format; what it computes stays the same
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// The program, in any format that Rung reads; `-` is the standard input
    file: PathBuf,
    /// The format to write
    #[arg(long, value_enum, default_value_t = Format::Native, value_name = "FORMAT")]
    to: Format,
    /// The file to write, whole or not at all; `-` is the standard output
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Format {
    /// Rung's own text
    Native,
    /// PLCopen TC6 XML, as OpenPLC Editor and Beremiz open it
    Plcopen,
    /// Structured Text for other IEC compilers
    St,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut loaded = load(&arguments.file)?;
    loaded.check();
    if any_error(&loaded.diagnostics) {
        return Err(Failure::diagnostics(&loaded.source, &loaded.diagnostics));
    }
    report(&diagnostic::render(&loaded.source, &loaded.diagnostics));
    let mut program = loaded.program;
    let text = match arguments.to {
        Format::Native => {
            // Only what is doubtful in native text has to say that it is not of it.
            let origin = std::mem::replace(&mut program.origin, Origin::Native);
            if check(&program).0.is_none() {
                program.origin = origin;
            }
            Ok(native::print(&program))
        }
        Format::Plcopen => plcopen::print(&program),
        Format::St => structured_text::print(&program),
    };
    let text = text.map_err(|problems| Failure::diagnostics(&loaded.source, &problems))?;
    write_whole(&arguments.output, text.as_bytes())
}
