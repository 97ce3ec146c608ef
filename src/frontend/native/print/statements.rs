//! Statements: each on a line of its own, and what is in them indented.

use unicode_width::UnicodeWidthStr;

use super::rungs::deeper;
use super::{LINE_WIDTH, Page, words};
use crate::ladder::{BlockCall, CaseBranch, Statement, StatementKind};

/// Prints statements and the comments before and behind them; `end` is where what follows them starts.
pub(super) fn print(page: &mut Page<'_>, statements: &[Statement], end: u32, indent: usize) {
    let next_starts = statements.iter().skip(1).map(|statement| statement.span.start).chain([end]);
    for (statement, next) in statements.iter().zip(next_starts) {
        page.flush(statement.span.start, indent);
        page.start(indent);
        print_statement(page, statement, indent);
        page.flush_trailing(next);
    }
}

fn print_statement(page: &mut Page<'_>, statement: &Statement, indent: usize) {
    let closing = statement.span.end.saturating_sub(1);
    if let Some(word) = words::simple_statement(statement) {
        // A comment between the arguments needs a line there to end.
        let commented = |call: &BlockCall| !call.arguments.is_empty() && page.has_comment_before(closing);
        return match &statement.kind {
            StatementKind::Call(call) if indent + word.width() > LINE_WIDTH || commented(call) => {
                print_call(page, call, closing, indent);
            }
            _ => page.push(&word),
        };
    }
    let end = match &statement.kind {
        StatementKind::If { branches, otherwise } => {
            let bodies = branches.iter().map(|branch| branch.body.as_slice());
            let bodies: Vec<_> = bodies.chain([otherwise.as_slice()]).collect();
            for (index, branch) in branches.iter().enumerate() {
                let word = if index == 0 { "IF" } else { "ELSIF" };
                open(page, &format!("{word} {} THEN", words::expression(&branch.condition)), index > 0, indent);
                print(page, &branch.body, first_of(&bodies[index + 1..], closing), deeper(indent));
            }
            print_else(page, otherwise, closing, indent);
            "END_IF;"
        }
        StatementKind::Case { selector, branches, otherwise } => {
            page.push(&format!("CASE {} OF", words::expression(selector)));
            let after = first_of(&[otherwise.as_slice()], closing);
            let next_starts = branches.iter().skip(1).map(start).chain([after]);
            for (branch, next) in branches.iter().zip(next_starts) {
                page.flush(start(branch), deeper(indent));
                page.line(deeper(indent));
                let labels: Vec<String> = branch.labels.iter().map(words::label).collect();
                page.push(&format!("{}:", labels.join(", ")));
                print(page, &branch.body, next, deeper(deeper(indent)));
            }
            print_else(page, otherwise, closing, indent);
            "END_CASE;"
        }
        StatementKind::For { variable, first, last, step, body } => {
            let (variable, first, last) =
                (words::reference(variable), words::expression(first), words::expression(last));
            let step = step.as_ref().map_or(String::new(), |step| format!(" BY {}", words::expression(step)));
            page.push(&format!("FOR {variable} := {first} TO {last}{step} DO"));
            print(page, body, closing, deeper(indent));
            "END_FOR;"
        }
        _ => return,
    };
    page.flush(closing, deeper(indent));
    page.line(indent);
    page.push(end);
}

/// A line before a body; the first of a statement stands where the statement does.
fn open(page: &mut Page<'_>, text: &str, on_new_line: bool, indent: usize) {
    if on_new_line {
        page.line(indent);
    }
    page.push(text);
}

fn print_else(page: &mut Page<'_>, otherwise: &[Statement], closing: u32, indent: usize) {
    if !otherwise.is_empty() {
        page.line(indent);
        page.push("ELSE");
        print(page, otherwise, closing, deeper(indent));
    }
}

/// Where the first statement of some bodies starts.
fn first_of(bodies: &[&[Statement]], end: u32) -> u32 {
    bodies.iter().find_map(|body| body.first()).map_or(end, |statement| statement.span.start)
}

fn start(branch: &CaseBranch) -> u32 {
    branch.labels.first().map_or(0, |label| label.first.span.start)
}

/// ```text
/// t1(
///   IN := a,
///   PT := b
/// );
/// ```
fn print_call(page: &mut Page<'_>, call: &BlockCall, end: u32, indent: usize) {
    page.push(&words::statement_head(call));
    for (index, argument) in call.arguments.iter().enumerate() {
        page.flush(argument.span.start, deeper(indent));
        page.line(deeper(indent));
        page.push(&words::argument(argument));
        if index + 1 < call.arguments.len() {
            page.push(",");
        }
    }
    page.flush(end, deeper(indent));
    page.line(indent);
    page.push(&words::block_tail(call));
    page.push(";");
}
