//! Bodies of units: a rung for each statement, with the comment on the line before as its title.

use super::enable;
use super::place;
use crate::diagnostic::Diagnostic;
use crate::frontend::text::token::{Dialect, Kind};
use crate::frontend::text::{MOST_TOKENS, Reader};
use crate::ladder::{
    Branch, Circuit, Comment, Element, ElementKind, Name, Rung, Statement, StatementKind, TypeDeclaration,
    TypeReference, Unit, Variable,
};
use crate::source::{Source, Span};

/// The longest comment that becomes a title, in bytes.
const LONGEST_TITLE: usize = 200;

/// The declarations around a body.
#[derive(Clone, Copy)]
pub struct Scope<'a> {
    /// The types of the program.
    pub types: &'a [TypeDeclaration],
    /// Its global variables.
    pub globals: &'a [Variable],
    /// The variables of the unit.
    pub variables: &'a [Variable],
    /// Of a function: its name and the type of its result.
    pub result: Option<(&'a Name, &'a TypeReference)>,
}

/// What a body holds.
pub struct Body {
    /// A rung for each statement.
    pub rungs: Vec<Rung>,
    /// The comments that became no titles.
    pub comments: Vec<Comment>,
    /// What is to be said about it.
    pub diagnostics: Vec<Diagnostic>,
}

/// Reads the body of a unit from a file of another format. `text` is the body alone, without what its format escapes;
/// `place` says where a span of it lies in the file: a shift by an offset where the text stands there as it is, and else the span
/// of the whole body. After an error it goes on at the next statement.
pub fn body(text: &str, scope: &Scope<'_>, place: &dyn Fn(Span) -> Span) -> Body {
    let source = Source::new("", text);
    let mut reader = Reader::new(&source, Dialect::StructuredText, MOST_TOKENS);
    let mut statements = Vec::new();
    loop {
        reader.start_item();
        statements.extend(reader.statements().unwrap_or_default());
        if reader.token.kind == Kind::End {
            break;
        }
        let problem = reader.unexpected("a statement");
        reader.report(problem);
        reader.advance();
    }
    reader.anchor(u32::MAX);
    let mut rungs = rungs(statements, scope, &mut reader);
    let Reader { comments, mut diagnostics, missing, .. } = reader;
    let mut comments = title(text, &mut rungs, comments);
    diagnostics.extend(missing.into_diagnostics());
    rungs.iter_mut().for_each(|rung| place::rung(rung, place));
    for comment in &mut comments {
        comment.span = place(comment.span);
    }
    for problem in &mut diagnostics {
        problem.span = place(problem.span);
        problem.related.iter_mut().for_each(|(span, _)| *span = place(*span));
    }
    Body { rungs, comments, diagnostics }
}

/// A rung for each statement.
pub(super) fn rungs(statements: Vec<Statement>, scope: &Scope<'_>, reader: &mut Reader<'_>) -> Vec<Rung> {
    statements.into_iter().map(|statement| rung(enable::statement(statement, scope, reader))).collect()
}

fn rung(statement: Statement) -> Rung {
    let span = statement.span;
    let kind = match statement.kind {
        StatementKind::Assignment { target, value } => ElementKind::Assignment { target, value: Box::new(value) },
        kind => ElementKind::Statements(vec![Statement { kind, span }]),
    };
    let branch = Branch { from: None, elements: vec![Element { kind, span }], to: None, span };
    Rung { name: None, title: None, enabled: true, circuit: Circuit { branches: vec![branch], span }, span }
}

/// Makes comments titles in all units, which stand in the order of the text, and gives those that are left.
pub(super) fn titles(text: &str, units: &mut [Unit], mut comments: Vec<Comment>) -> Vec<Comment> {
    for unit in units {
        comments = title(text, &mut unit.rungs, comments);
    }
    comments
}

/// Makes the comment on the line before a rung its title, and gives the comments that are left.
fn title(text: &str, rungs: &mut [Rung], comments: Vec<Comment>) -> Vec<Comment> {
    let mut left = Vec::with_capacity(comments.len());
    let mut rungs = rungs.iter_mut().peekable();
    let mut before = 0;
    let mut comments = comments.into_iter().peekable();
    while let Some(comment) = comments.next() {
        while let Some(rung) = rungs.next_if(|rung| rung.span.start < comment.span.end) {
            before = rung.span.end;
        }
        let next_starts = comments.peek().map_or(u32::MAX, |next| next.span.start);
        let fits = comment.own_line
            && comment.span.start >= before
            && comment.text.len() <= LONGEST_TITLE
            && !comment.text.is_empty()
            && !comment.text.starts_with('{')
            && !comment.text.contains(['\n', '\r']);
        match rungs.peek_mut() {
            Some(rung) if fits && next_starts >= rung.span.start && is_line_before(text, comment.span, rung.span) => {
                rung.title = Some(comment.text.into());
            }
            _ => left.push(comment),
        }
    }
    left
}

/// Whether nothing but one line break stands between the two.
fn is_line_before(text: &str, comment: Span, rung: Span) -> bool {
    let between = text.get(comment.range().end..rung.range().start);
    between.is_some_and(|between| {
        between.len() < LONGEST_TITLE && between.trim().is_empty() && between.matches('\n').count() == 1
    })
}
