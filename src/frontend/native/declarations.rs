//! Declarations: `var runs, faults : INT at %MW4 := 5 retain`.

use super::parser::{Parser, Place};
use crate::diagnostic::{Code, Diagnostic};
use crate::frontend::text::Parse;
use crate::frontend::text::token::Kind;
use crate::ladder::{Address, Expression, Name, TypeReference, Variable, VariableClass};
use crate::source::Span;

/// What stands behind the names of a declaration, each with its place.
#[derive(Default)]
struct Clauses {
    ty: Option<(TypeReference, Span)>,
    address: Option<(Address, Span)>,
    initial: Option<(Expression, Span)>,
    retain: Option<((), Span)>,
}

impl Parser<'_> {
    /// A declaration of the current unit.
    pub(super) fn declaration(&mut self, class: VariableClass) -> Parse<()> {
        let start = self.token.span;
        self.come_to(Place::Units, start);
        if !self.unit().rungs.is_empty() {
            let problem = Diagnostic::new(Code::UnexpectedToken, start, "a declaration stands behind a rung");
            self.report(problem.hint("declarations stand before the first rung"));
        }
        self.advance();
        let variables = self.variables(class, start)?;
        self.unit().variables.extend(variables);
        Ok(())
    }

    /// What stands behind the keywords, which began at `start`.
    pub(super) fn variables(&mut self, class: VariableClass, start: Span) -> Parse<Vec<Variable>> {
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
        let clauses = self.clauses()?;
        let span = self.since(start.start);
        self.count_copies(&from, names.len(), span)?;
        self.item_end("a clause (`: TYPE`, `at`, `:=`, `retain`), another declaration or a rung")?;
        let mut variable = Variable {
            class,
            name: Name::new("", span),
            ty: clauses.ty.map(|(ty, _)| ty),
            address: clauses.address.map(|(address, _)| Box::new(address)),
            initial: clauses.initial.map(|(initial, _)| Box::new(initial)),
            retain: clauses.retain.is_some(),
            span,
        };
        let mut variables = Vec::with_capacity(names.len());
        if let Some(last) = names.pop() {
            variables.extend(names.into_iter().map(|name| Variable { name, ..variable.clone() }));
            variable.name = last;
            variables.push(variable);
        }
        Ok(variables)
    }

    fn clauses(&mut self) -> Parse<Clauses> {
        let mut clauses = Clauses::default();
        loop {
            let start = self.token.span.start;
            if self.take(Kind::Colon) {
                let ty = self.type_reference()?;
                self.clause(&mut clauses.ty, ty, start, "type");
            } else if self.take(Kind::Assign) {
                let initial = self.initial_value()?;
                self.clause(&mut clauses.initial, initial, start, "initial value");
            } else if self.at_word("retain") {
                self.advance();
                self.clause(&mut clauses.retain, (), start, "`retain`");
            } else if self.at_word("at") {
                self.advance();
                if self.token.kind != Kind::Address {
                    let problem = self.unexpected("an address such as %IX0.3");
                    return self.give_up(problem);
                }
                let address = self.address();
                self.clause(&mut clauses.address, address, start, "address");
            } else {
                return self.no_clause().map(|()| clauses);
            }
        }
    }

    /// Helps with what is often meant for a clause.
    fn no_clause(&mut self) -> Parse<()> {
        let problem = self.unexpected("a clause, another declaration or a rung");
        match self.token.kind {
            Kind::Equal => self.give_up(problem.hint("an initial value is given with :=")),
            Kind::Address => self.give_up(problem.hint("an address stands behind `at`")),
            kind if kind.is_name() => self.give_up(problem.hint("names are parted by commas, and a type follows `:`")),
            Kind::LeftParenthesis | Kind::LeftBracket | Kind::LeftBrace => {
                self.give_up(problem.hint("circuits stand in rungs: start them with `rung`"))
            }
            _ => Ok(()),
        }
    }

    fn clause<T>(&mut self, place: &mut Option<(T, Span)>, value: T, start: u32, what: &str) {
        let span = self.since(start);
        match place {
            None => *place = Some((value, span)),
            Some((_, first)) => {
                let problem = Diagnostic::new(Code::DuplicateClause, span, format!("the {what} was given before"));
                self.report(problem.related(*first, "here"));
            }
        }
    }
}
