//! Statements as the lines of a box, cut to a width and a number of lines.
//!
//! It must not work longer on statements than the lines that it gives ask for, nor recurse deeper than those are many.

use super::label;
use crate::ladder::{BlockCall, CaseLabel, Statement, StatementKind, Wire};

/// How many lines a box has at most; the last says that there are more.
const MOST_LINES: usize = 24;
/// How many lines an expression may fill.
const LINES_OF_EXPRESSION: usize = 4;
/// Columns by which what is in a statement is indented.
const INDENT: usize = 2;

/// The lines of a box for statements, each of at most so many columns; at least one.
pub(super) fn lines(statements: &[Statement], columns: usize) -> Vec<String> {
    let mut writer = Writer { lines: Vec::new(), columns, limit: columns * LINES_OF_EXPRESSION };
    writer.statements(statements, 0);
    if writer.lines.is_empty() {
        writer.lines.push(";".to_owned());
    }
    if writer.is_full() {
        writer.lines.truncate(MOST_LINES - 1);
        writer.lines.push("…".to_owned());
    }
    writer.lines
}

struct Writer {
    lines: Vec<String>,
    columns: usize,
    /// Columns of one expression, on as many lines as it takes.
    limit: usize,
}

impl Writer {
    fn is_full(&self) -> bool {
        self.lines.len() > MOST_LINES
    }

    /// A line, or several where it has no room on one.
    fn line(&mut self, text: &str, depth: usize) {
        let indent = (depth * INDENT).min(self.columns / 4);
        let lines = label::wrap(text, self.columns - indent);
        self.lines.extend(lines.into_iter().map(|line| format!("{}{line}", " ".repeat(indent))));
    }

    fn statements(&mut self, statements: &[Statement], depth: usize) {
        for statement in statements {
            if self.is_full() {
                return;
            }
            self.statement(&statement.kind, depth);
        }
    }

    fn statement(&mut self, statement: &StatementKind, depth: usize) {
        let expression = |value| label::expression(value, self.limit);
        match statement {
            StatementKind::Assignment { target, value } => {
                let text = format!("{} := {};", label::reference(target, self.limit), expression(value));
                self.line(&text, depth);
            }
            StatementKind::Call(call) => {
                let text = self.call(call);
                self.line(&text, depth);
            }
            StatementKind::Exit => self.line("EXIT;", depth),
            StatementKind::Return => self.line("RETURN;", depth),
            StatementKind::If { branches, otherwise } => {
                for (index, branch) in branches.iter().enumerate() {
                    if self.is_full() {
                        return;
                    }
                    let word = if index == 0 { "IF" } else { "ELSIF" };
                    self.line(&format!("{word} {} THEN", label::expression(&branch.condition, self.limit)), depth);
                    self.statements(&branch.body, depth + 1);
                }
                self.otherwise(otherwise, depth);
                self.line("END_IF;", depth);
            }
            StatementKind::Case { selector, branches, otherwise } => {
                let head = format!("CASE {} OF", expression(selector));
                self.line(&head, depth);
                for branch in branches {
                    if self.is_full() {
                        return;
                    }
                    let labels: Vec<String> =
                        branch.labels.iter().take(self.limit).map(|label| case_label(label, self.limit)).collect();
                    self.line(&format!("{}:", labels.join(", ")), depth + 1);
                    self.statements(&branch.body, depth + 2);
                }
                self.otherwise(otherwise, depth);
                self.line("END_CASE;", depth);
            }
            StatementKind::For { variable, first, last, step, body } => {
                let step = step.as_ref().map_or(String::new(), |step| format!(" BY {}", expression(step)));
                let variable = label::reference(variable, self.limit);
                let head = format!("FOR {variable} := {} TO {}{step} DO", expression(first), expression(last));
                self.line(&head, depth);
                self.statements(body, depth + 1);
                self.line("END_FOR;", depth);
            }
        }
    }

    fn otherwise(&mut self, otherwise: &[Statement], depth: usize) {
        if !otherwise.is_empty() && !self.is_full() {
            self.line("ELSE", depth);
            self.statements(otherwise, depth + 1);
        }
    }

    fn call(&self, call: &BlockCall) -> String {
        let mut text = format!("{}(", label::reference(&call.instance, self.limit));
        for (index, argument) in call.arguments.iter().enumerate() {
            // What lies behind the limit is cut.
            if text.len() > 4 * self.limit {
                break;
            }
            text.push_str(if index == 0 { "" } else { ", " });
            let named = !argument.pin.text.is_empty();
            let wired = match &argument.wire {
                Wire::Value(value) => label::expression(value, self.limit),
                Wire::Circuit(circuit) => label::circuit(circuit, self.limit).unwrap_or_else(|| "…".to_owned()),
                Wire::Output(target) => label::reference(target, self.limit),
            };
            let sign = if matches!(argument.wire, Wire::Output(_)) { "=>" } else { ":=" };
            let pin = label::cut_name(&argument.pin.text, self.limit);
            text.push_str(&if named { format!("{pin} {sign} {wired}") } else { wired });
        }
        text.push_str(");");
        text
    }
}

fn case_label(label: &CaseLabel, limit: usize) -> String {
    let first = label::expression(&label.first, limit);
    match &label.last {
        Some(last) => format!("{first}..{}", label::expression(last, limit)),
        None => first,
    }
}
