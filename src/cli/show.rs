//! `rung show`: the ladder, drawn.

use std::path::PathBuf;

use super::{Failure, load, print, report, write_whole};
use crate::diagnostic::{self, any_error};
use crate::draw;

/// Draws a program's rungs in the terminal, or as a picture
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// The program; `-` is the standard input
    file: PathBuf,
    /// Columns to draw in; the terminal's width, or 100 where there is none
    #[arg(long, value_parser = clap::value_parser!(u16).range(20..))]
    width: Option<u16>,
    /// Write an SVG picture to this file instead; `-` is the standard output
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut loaded = load(&arguments.file)?;
    // What Rung has not is drawn too.
    let program = loaded.program.clone();
    loaded.check();
    report(&diagnostic::render(&loaded.source, &loaded.diagnostics));
    // What could be read is drawn in any case: a drawing helps to find the error.
    match &arguments.svg {
        Some(path) => write_whole(path, draw::svg(&program).as_bytes())?,
        None => {
            let width = arguments.width.map_or_else(terminal_width, usize::from);
            print(&draw::text(&program, &draw::TextOptions { width }))?;
        }
    }
    if any_error(&loaded.diagnostics) { Err(Failure::Said) } else { Ok(()) }
}

fn terminal_width() -> usize {
    let stdout_is_terminal = std::io::IsTerminal::is_terminal(&std::io::stdout());
    let size = stdout_is_terminal.then(crossterm::terminal::size).and_then(Result::ok);
    size.map_or(100, |(columns, _)| usize::from(columns).max(20))
}
