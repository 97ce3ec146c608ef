//! Declarations: `TYPE … END_TYPE` and the blocks `VAR … END_VAR`. An error costs its declaration, and the block goes on.

use super::parser::Parser;
use crate::diagnostic::{Code, Diagnostic};
use crate::frontend::located;
use crate::frontend::text::Parse;
use crate::frontend::text::token::{Keyword, Kind};
use crate::ladder::{Name, Variable, VariableClass};
use crate::source::Span;

/// What the words behind `VAR` say of all declarations of the block.
struct Block {
    class: VariableClass,
    retain: bool,
    external: bool,
}

impl Parser<'_> {
    /// `TYPE colour : (red, green); END_TYPE`
    pub(super) fn types(&mut self) -> Parse<()> {
        let open = self.token.span;
        self.advance();
        while !self.token.kind.starts_item() {
            self.start_item();
            if self.one_type().is_err() {
                self.skip_declaration();
            }
        }
        self.end_of_block(Keyword::EndType, "END_TYPE", open)
    }

    fn one_type(&mut self) -> Parse<()> {
        self.anchor_here();
        let declaration = self.type_declaration()?;
        self.semicolon_of_declaration()?;
        self.program.types.push(declaration);
        Ok(())
    }

    /// `VAR_INPUT a, b : BOOL; END_VAR`, at its first word. Those of `VAR_EXTERNAL` are noted and not given.
    pub(super) fn variable_block(&mut self) -> Parse<Vec<Variable>> {
        let open = self.token.span;
        let Kind::Keyword(keyword) = self.token.kind else { return Ok(Vec::new()) };
        self.advance();
        let mut block =
            Block { class: Self::class_of(keyword), retain: false, external: keyword == Keyword::VarExternal };
        loop {
            match self.token.kind {
                Kind::Keyword(Keyword::Constant) => block.class = VariableClass::Constant,
                Kind::Keyword(Keyword::Retain) => block.retain = true,
                Kind::Keyword(Keyword::NonRetain) => block.retain = false,
                // A word of some tools, for what IEC calls RETAIN.
                Kind::Name if self.at_word("PERSISTENT") && !self.is_declared_here() => block.retain = true,
                _ => break,
            }
            self.advance();
        }
        let mut variables = Vec::new();
        while !self.token.kind.starts_item() {
            self.start_item();
            if self.variables(&block, &mut variables).is_err() {
                self.skip_declaration();
            }
        }
        self.end_of_block(Keyword::EndVar, "END_VAR", open)?;
        if !block.external {
            return Ok(variables);
        }
        self.externals.extend(variables.into_iter().map(|variable| (variable.name, variable.ty)));
        Ok(Vec::new())
    }

    /// Whether the current word is a name that is declared, and not one that says something of the block.
    fn is_declared_here(&self) -> bool {
        let behind = self.source.text()[self.token.span.range().end..].trim_start();
        behind.starts_with([':', ','])
    }

    /// `a, b AT %MW4 : INT := 5;`
    fn variables(&mut self, block: &Block, variables: &mut Vec<Variable>) -> Parse<()> {
        let start = self.token.span;
        let mut names = Vec::new();
        loop {
            let at = self.token.span.start;
            names.push(self.name("the name of a variable")?);
            self.anchor(at);
            if !self.take(Kind::Comma) {
                break;
            }
        }
        let from = self.copied_from();
        let mut address = if self.take(Kind::Keyword(Keyword::At)) { Some(self.located()?) } else { None };
        if !self.take(Kind::Colon) {
            let problem = self.unexpected("`:`");
            return self.give_up(problem.hint("a declaration looks like this: a : BOOL := TRUE;"));
        }
        let ty = self.type_reference()?;
        let lower = self.subrange()?;
        // OpenPLC Editor 4 writes the address behind the type.
        if address.is_none() && self.take(Kind::Keyword(Keyword::At)) {
            address = Some(self.located()?);
        }
        let initial = if self.take(Kind::Assign) { Some(self.initial_value()?) } else { lower };
        for edge in ["R_EDGE", "F_EDGE"] {
            if self.at_word(edge) {
                let place = self.token.span;
                self.missing.note(&format!("{edge} at an input"), place);
                self.advance();
            }
        }
        let span = self.since(start.start);
        self.count_copies(&from, names.len(), span)?;
        self.semicolon_of_declaration()?;
        let variable = |name: Name| Variable {
            class: block.class,
            name,
            ty: Some(ty.clone()),
            address: address.clone().map(Box::new),
            initial: initial.clone().map(Box::new),
            retain: block.retain,
            span,
        };
        variables.extend(names.into_iter().map(variable));
        Ok(())
    }

    /// The address behind AT.
    fn located(&mut self) -> Parse<crate::ladder::Address> {
        if self.token.kind != Kind::Address {
            let problem = self.unexpected("an address");
            return self.give_up(problem);
        }
        let span = self.token.span;
        if self.source.text()[span.range().end..].starts_with('*') {
            let text = self.source.text().get(span.range().start..=span.range().end).unwrap_or("");
            self.advance();
            self.take(Kind::Star);
            if let Some(address) = located::open(text, span) {
                return Ok(address);
            }
            let problem = Diagnostic::new(Code::BadAddress, span, "this is not an address");
            return self.give_up(problem.hint("an address looks like %IX0.3, %QW2 or %I*"));
        }
        Ok(self.address())
    }

    pub(super) fn semicolon_of_declaration(&mut self) -> Parse<()> {
        if self.take(Kind::Semicolon) {
            return Ok(());
        }
        let problem = self.unexpected("`;`");
        self.give_up(problem.hint("each declaration ends with a semicolon"))
    }

    /// Goes on behind the declaration that was given up, the members of a structure included.
    pub(super) fn skip_declaration(&mut self) {
        let mut structures = 0usize;
        while !self.token.kind.starts_item() {
            match self.token.kind {
                Kind::Keyword(Keyword::Struct) => structures += 1,
                Kind::Keyword(Keyword::EndStruct) => structures = structures.saturating_sub(1),
                Kind::Semicolon if structures == 0 => {
                    self.advance();
                    return;
                }
                _ => {}
            }
            self.advance();
        }
    }

    /// The last word of a block.
    pub(super) fn end_of_block(&mut self, end: Keyword, spelling: &str, open: Span) -> Parse<()> {
        self.anchor_here();
        if self.take(Kind::Keyword(end)) {
            return Ok(());
        }
        let what = self.source.slice(open).to_ascii_uppercase();
        let problem = Diagnostic::new(Code::Unclosed, open, format!("{what} is not closed"));
        let problem = problem.related(self.token.span, format!("{spelling} should stand before this"));
        self.give_up(problem)
    }
}
