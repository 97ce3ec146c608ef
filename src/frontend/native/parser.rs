//! The order of a file: origin, types, registers, globals, tasks, units. The rules of its parts are in `declarations`, `units`, `rungs`
//! and `elements`, those of expressions and statements in [`text`](super::super::text).

use std::ops::{Deref, DerefMut};

use crate::diagnostic::{Code, Diagnostic};
use crate::frontend::Parsed;
use crate::frontend::text::token::{Dialect, Keyword, Kind};
use crate::frontend::text::{Parse, Reader};
use crate::ladder::{Origin, Program, Unit, UnitKind, VariableClass};
use crate::source::{Source, Span};

/// Reads a program: a [`Reader`] with what only the native text has.
pub(super) struct Parser<'a> {
    reader: Reader<'a>,
    pub(super) program: Program,
    /// What the file has come to.
    place: Place,
}

/// The parts of a file, in their order.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Place {
    Origin,
    Types,
    Registers,
    Globals,
    Tasks,
    Units,
    Instances,
}

impl<'a> Deref for Parser<'a> {
    type Target = Reader<'a>;

    fn deref(&self) -> &Reader<'a> {
        &self.reader
    }
}

impl<'a> DerefMut for Parser<'a> {
    fn deref_mut(&mut self) -> &mut Reader<'a> {
        &mut self.reader
    }
}

impl<'a> Parser<'a> {
    /// A parser of a source that may have so many tokens.
    pub(super) fn new(source: &'a Source, most_tokens: usize) -> Self {
        let reader = Reader::new(source, Dialect::Native, most_tokens);
        let program = Program::empty(Origin::Native, reader.stem());
        Self { reader, program, place: Place::Origin }
    }

    /// The whole file.
    pub(super) fn program(mut self) -> Parsed {
        while self.token.kind != Kind::End {
            self.start_item();
            if self.item().is_err() {
                self.skip_item();
            }
        }
        self.anchor(u32::MAX);
        if self.program.units.is_empty() {
            self.start_unit_without_header();
        }
        let mut programs = self.program.units.iter().filter(|unit| matches!(unit.kind, UnitKind::Program { .. }));
        if let (Some(only), None) = (programs.next(), programs.next()) {
            self.program.name = only.name.clone();
        }
        self.program.comments = self.reader.comments;
        Parsed { program: self.program, diagnostics: self.reader.diagnostics }
    }

    fn item(&mut self) -> Parse<()> {
        match self.token.kind {
            Kind::Keyword(Keyword::Imported) => self.imported(),
            Kind::Keyword(Keyword::Type) => self.type_item(),
            Kind::Keyword(Keyword::Registers) => self.registers(),
            Kind::Keyword(Keyword::Global) => self.global(),
            Kind::Keyword(Keyword::Task) => self.task(),
            Kind::Keyword(Keyword::Program) => self.program_line(),
            Kind::Keyword(Keyword::FunctionBlock) => self.function_block_line(),
            Kind::Keyword(Keyword::Function) => self.function_line(),
            Kind::Keyword(Keyword::Input) => self.declaration(VariableClass::Input),
            Kind::Keyword(Keyword::Output) => self.declaration(VariableClass::Output),
            Kind::Keyword(Keyword::InOut) => self.declaration(VariableClass::InOut),
            Kind::Keyword(Keyword::Temp) => self.declaration(VariableClass::Temporary),
            Kind::Keyword(Keyword::Var) => self.declaration(VariableClass::Memory),
            Kind::Keyword(Keyword::Const) => self.declaration(VariableClass::Constant),
            Kind::Keyword(Keyword::Rung) => self.rung(),
            _ => {
                let problem = self.unexpected("a declaration or a rung").hint(
                    "a line starts with imported, type, registers, global, task, program, function_block, function, input, output, \
                     inout, temp, var, const or rung",
                );
                self.give_up(problem)
            }
        }
    }

    /// Notes which part of the file starts here, and reports one that stands behind a later part.
    pub(super) fn come_to(&mut self, place: Place, start: Span) {
        if place < self.place {
            let what = self.source.slice(start);
            let problem = Diagnostic::new(Code::UnexpectedToken, start, format!("`{what}` stands here too late"));
            let order = "the order is: imported, types, registers, globals, tasks, units, instances of programs";
            self.report(problem.hint(order));
        }
        self.place = self.place.max(place);
    }

    /// The unit that declarations and rungs belong to. A file that starts without the header of a unit is one program.
    pub(super) fn unit(&mut self) -> &mut Unit {
        if self.program.units.is_empty() {
            self.start_unit_without_header();
        }
        let last = self.program.units.len() - 1;
        &mut self.program.units[last]
    }

    fn start_unit_without_header(&mut self) {
        let name = self.stem();
        let kind = UnitKind::Program { task: None };
        let span = name.span;
        self.program.units.push(Unit { kind, name, variables: Vec::new(), rungs: Vec::new(), span });
    }

    /// Makes sure that a declaration or rung is over.
    pub(super) fn item_end(&mut self, expected: &str) -> Parse<()> {
        if self.token.kind.starts_item() {
            return Ok(());
        }
        let problem = self.unexpected(expected);
        let semicolon = self.token.kind == Kind::Semicolon;
        self.give_up(if semicolon { problem.hint("nothing ends with a semicolon here") } else { problem })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn codes(text: &str, most_tokens: usize) -> Vec<Code> {
        let source = Source::new("x.rung", text);
        Parser::new(&source, most_tokens).program().diagnostics.iter().map(|problem| problem.code).collect()
    }

    #[test]
    fn a_file_of_more_tokens_than_permitted_is_not_read_to_its_end() {
        let text = "-- c\ninput a\noutput o\nrung\n  a (o) -- c\n";
        assert_eq!(codes(text, 11), []);
        assert_eq!(codes(text, 10), [Code::FileTooLarge]);
        let source = Source::new("x.rung", text);
        assert_eq!(Parser::new(&source, 4).program().program.units[0].rungs, []);
    }

    #[test]
    fn tokens_that_a_list_of_names_copies_count() {
        // 14 that are read, and twice the 7 behind the colon.
        let text = "var a, b, c : INT := 1 + 1 + 1\n";
        assert_eq!(codes(text, 28), []);
        assert_eq!(codes(text, 27), [Code::FileTooLarge]);
    }

    #[test]
    fn a_program_from_the_standard_input_is_called_main_where_it_says_nothing() {
        let name = |file| Parser::new(&Source::new(file, "rung\n"), 10).program().program.name.text;
        assert_eq!(["-", "folder/pump.rung", ""].map(name), ["main", "pump", "main"]);
    }
}
