//! The order of a file: types, units, global variables and configurations, each as often and in whatever order they come.

use std::ops::{Deref, DerefMut};

use lean_string::LeanString;

use super::body::{self, Scope};
use crate::diagnostic::{Code, Diagnostic};
use crate::frontend::events::{self, Event};
use crate::frontend::text::token::{Dialect, Keyword, Kind};
use crate::frontend::text::{Parse, Reader};
use crate::frontend::{Parsed, located};
use crate::ladder::{Name, Origin, Program, Statement, TypeReference, Unit, UnitKind, VariableClass, key};
use crate::source::{Source, Span};

/// Reads a program: a [`Reader`] with what only files of structured text have.
pub(super) struct Parser<'a> {
    reader: Reader<'a>,
    pub(super) program: Program,
    /// What each unit does, as far as its units are read; it becomes rungs when all declarations are known.
    bodies: Vec<Vec<Statement>>,
    /// The variables that units say are global, with their types.
    pub(super) externals: Vec<(Name, Option<TypeReference>)>,
    /// Whether a configuration says what runs.
    pub(super) configured: bool,
    /// The tasks that an event starts.
    pub(super) events: Vec<Event>,
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
        let reader = Reader::new(source, Dialect::StructuredText, most_tokens);
        let program = Program::empty(Origin::Imported, reader.stem());
        Self { reader, program, bodies: Vec::new(), externals: Vec::new(), configured: false, events: Vec::new() }
    }

    /// The whole file.
    pub(super) fn program(mut self) -> Parsed {
        while self.token.kind != Kind::End {
            self.start_item();
            let start = self.token.span;
            if self.item().is_err() {
                // Where an item starts that cannot stand here, reading has to get past it.
                if self.token.span == start {
                    self.advance();
                }
                self.skip_item();
            }
        }
        self.anchor(u32::MAX);
        self.check_externals();
        self.leave_out_what_does_not_run();
        let mut programs = self.program.units.iter().filter(|unit| matches!(unit.kind, UnitKind::Program { .. }));
        if let (Some(only), None) = (programs.next(), programs.next()) {
            self.program.name = only.name.clone();
        }
        let mut declared: Vec<&mut Unit> = self.program.units.iter_mut().collect();
        let found = located::settle(&mut self.program.globals, &mut declared);
        self.diagnostics.extend(found);
        let hidden = std::mem::take(&mut self.hidden);
        self.program.types.splice(0..0, hidden);
        let mut units = std::mem::take(&mut self.program.units);
        for (unit, statements) in units.iter_mut().zip(std::mem::take(&mut self.bodies)) {
            let result = match &unit.kind {
                UnitKind::Function { result: Some(ty) } => Some((&unit.name, ty)),
                _ => None,
            };
            let scope = Scope {
                types: &self.program.types,
                globals: &self.program.globals,
                variables: &unit.variables,
                result,
            };
            unit.rungs = body::rungs(statements, &scope, &mut self.reader);
        }
        self.program.units = units;
        let events = std::mem::take(&mut self.events);
        let found = events::settle(&mut self.program, events);
        self.diagnostics.extend(found);
        let Reader { source, comments, mut diagnostics, missing, .. } = self.reader;
        self.program.comments = body::titles(source.text(), &mut self.program.units, comments);
        diagnostics.extend(missing.into_diagnostics());
        Parsed { program: self.program, diagnostics }
    }

    fn item(&mut self) -> Parse<()> {
        let kind = self.token.kind;
        match kind {
            Kind::Keyword(Keyword::Type) => self.types(),
            Kind::Keyword(Keyword::Program | Keyword::FunctionBlock | Keyword::Function) => self.unit(),
            Kind::Keyword(Keyword::Configuration) => self.configuration(),
            Kind::Keyword(Keyword::VarGlobal) => {
                let globals = self.variable_block()?;
                self.program.globals.extend(globals);
                Ok(())
            }
            Kind::Semicolon => {
                self.advance();
                Ok(())
            }
            _ if self.skip_unsupported() => Ok(()),
            _ => {
                let problem = self.unexpected("TYPE, FUNCTION, FUNCTION_BLOCK, PROGRAM, CONFIGURATION or VAR_GLOBAL");
                self.give_up(problem)
            }
        }
    }

    /// `PROGRAM name … END_PROGRAM`, and the same of function blocks and functions.
    fn unit(&mut self) -> Parse<()> {
        let start = self.token.span;
        let Kind::Keyword(keyword) = self.token.kind else { return Ok(()) };
        self.anchor(start.start);
        self.advance();
        let name = self.name("the name of the unit")?;
        let mut header = self.since(start.start);
        let (kind, end, spelling) = match keyword {
            Keyword::Program => (UnitKind::Program { task: None }, Keyword::EndProgram, "END_PROGRAM"),
            Keyword::FunctionBlock => (UnitKind::FunctionBlock, Keyword::EndFunctionBlock, "END_FUNCTION_BLOCK"),
            _ => {
                let result = if self.take(Kind::Colon) { Some(self.type_reference()?) } else { None };
                header = self.since(start.start);
                (UnitKind::Function { result }, Keyword::EndFunction, "END_FUNCTION")
            }
        };
        self.take(Kind::Semicolon);
        let mut unit = Unit { kind, name, variables: Vec::new(), rungs: Vec::new(), span: header };
        while let Kind::Keyword(
            list @ (Keyword::Var
            | Keyword::VarInput
            | Keyword::VarOutput
            | Keyword::VarInOut
            | Keyword::VarTemp
            | Keyword::VarExternal
            | Keyword::VarGlobal),
        ) = self.token.kind
        {
            let variables = self.variable_block()?;
            // What a program declares for the blocks that it calls.
            let list = if list == Keyword::VarGlobal { &mut self.program.globals } else { &mut unit.variables };
            list.extend(variables);
        }
        let statements = self.unit_body(&unit.name, Kind::Keyword(end));
        self.program.units.push(unit);
        self.bodies.push(statements);
        self.anchor_here();
        if self.take(Kind::Keyword(end)) {
            return Ok(());
        }
        let problem = self.unexpected(&format!("`{spelling}`")).related(header, "the unit starts here");
        self.give_up(problem)
    }

    fn unit_body(&mut self, unit: &Name, end: Kind) -> Vec<Statement> {
        let mut statements = Vec::new();
        if let Some(language) = self.other_language() {
            let place = self.token.span;
            let hint = Some("draw it as a ladder, or write it in structured text");
            self.missing.note_with_hint(
                &format!("{language}, which the body of `{}` is written in,", unit.text),
                place,
                hint,
            );
            self.skip_item();
            return statements;
        }
        loop {
            self.start_item();
            statements.extend(self.statements().unwrap_or_default());
            if self.token.kind == end || self.token.kind.starts_item() {
                return statements;
            }
            // What closes a bracket that nothing opened.
            let problem = self.unexpected("a statement");
            self.report(problem);
            self.advance();
        }
    }

    /// The language of a body, as far as its first word shows that it is not structured text.
    fn other_language(&self) -> Option<&'static str> {
        const CHART: [&str; 4] = ["INITIAL_STEP", "STEP", "TRANSITION", "ACTION"];
        const LIST: [&str; 8] = ["LD", "LDN", "CAL", "CALC", "CALCN", "JMP", "JMPC", "JMPCN"];
        let behind = self.source.text()[self.token.span.range().end..].trim_start();
        if behind.starts_with([':', '(', '.', '[', ';', '=']) {
            return None;
        }
        if CHART.into_iter().any(|word| self.at_word(word)) {
            Some("a sequential function chart")
        } else if LIST.into_iter().any(|word| self.at_word(word)) {
            Some("instruction list")
        } else {
            None
        }
    }

    /// Leaves out a part of the language that Rung has not, if one starts here.
    pub(super) fn skip_unsupported(&mut self) -> bool {
        const PARTS: [(&str, &str); 9] = [
            ("CLASS", "END_CLASS"),
            ("INTERFACE", "END_INTERFACE"),
            ("NAMESPACE", "END_NAMESPACE"),
            ("METHOD", "END_METHOD"),
            ("PROPERTY", "END_PROPERTY"),
            ("ACTION", "END_ACTION"),
            ("VAR_ACCESS", "END_VAR"),
            ("VAR_CONFIG", "END_VAR"),
            ("USING", ";"),
        ];
        let Some((word, end)) = PARTS.into_iter().find(|(word, _)| self.at_word(word)) else { return false };
        let place = self.token.span;
        self.missing.note(word, place);
        while self.token.kind != Kind::End {
            let found = self.source.slice(self.token.span).eq_ignore_ascii_case(end);
            self.advance();
            if found {
                break;
            }
        }
        true
    }

    /// Reports what a unit takes for global and nothing declares.
    fn check_externals(&mut self) {
        for (name, ty) in std::mem::take(&mut self.externals) {
            let wanted = name.key();
            let Some(global) = self.program.globals.iter().find(|global| global.name.key() == wanted) else {
                let message = format!("no VAR_GLOBAL declares `{}`", name.text);
                self.report(Diagnostic::new(Code::UndeclaredName, name.span, message));
                continue;
            };
            let names = [&ty, &global.ty].map(|ty| ty.as_ref().map(|ty| (ty.name.key(), ty.dimensions.len())));
            if names[0] != names[1] {
                let place = global.name.span;
                let message = format!("`{}` is declared with another type", name.text);
                let problem = Diagnostic::new(Code::TypeMismatch, name.span, message).related(place, "declared here");
                self.report(problem);
            }
        }
    }

    /// Where a configuration says what runs, a program that it does not name never does.
    fn leave_out_what_does_not_run(&mut self) {
        if !self.configured {
            return;
        }
        let named: Vec<String> = self.program.instances.iter().map(|instance| key(&instance.program.text)).collect();
        let runs = |unit: &Unit| !matches!(unit.kind, UnitKind::Program { .. }) || named.contains(&unit.name.key());
        let idle: Vec<(LeanString, Span)> = self
            .program
            .units
            .iter()
            .filter(|unit| !runs(unit))
            .map(|unit| (unit.name.text.clone(), unit.name.span))
            .collect();
        for (name, place) in idle {
            let message = format!("no resource runs the program `{name}`: it is left out");
            self.report(Diagnostic::new(Code::UnusedName, place, message));
        }
        let mut units = Vec::new();
        let mut bodies = Vec::new();
        let all = std::mem::take(&mut self.program.units).into_iter().zip(std::mem::take(&mut self.bodies));
        for (unit, body) in all.filter(|(unit, _)| runs(unit)) {
            units.push(unit);
            bodies.push(body);
        }
        self.program.units = units;
        self.bodies = bodies;
    }

    /// What the declarations of a block keyword declare.
    pub(super) fn class_of(keyword: Keyword) -> VariableClass {
        match keyword {
            Keyword::VarInput => VariableClass::Input,
            Keyword::VarOutput => VariableClass::Output,
            Keyword::VarInOut => VariableClass::InOut,
            Keyword::VarTemp => VariableClass::Temporary,
            _ => VariableClass::Memory,
        }
    }
}
