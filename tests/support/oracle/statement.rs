//! Structured text: each statement is executed where it stands.

use rung::check::Statement;
use rung::elementary::Value;

use super::Oracle;
use super::expression::{number, wrapped};
use super::place::Attempt;
use super::walk::{Leave, Walk};

impl Oracle<'_> {
    /// Executes statements, one after the other.
    pub(super) fn statements(
        &mut self,
        walk: &mut Walk,
        statements: &[Statement],
        attempt: &mut Attempt,
    ) -> Result<(), Leave> {
        statements.iter().try_for_each(|statement| self.statement(walk, statement, attempt))
    }

    fn statement(&mut self, walk: &mut Walk, statement: &Statement, attempt: &mut Attempt) -> Result<(), Leave> {
        match statement {
            Statement::Assignment { target, value } => {
                let value = self.value(&walk.frame, value, attempt);
                let target = self.locate(&walk.frame, target, attempt);
                self.put(&target, value);
                self.did(walk, statement, "statement a := b");
            }
            Statement::Copy { target, source, done } => {
                let failed = std::mem::replace(&mut attempt.failed, false);
                let source = self.locate(&walk.frame, source, attempt);
                let target = self.locate(&walk.frame, target, attempt);
                let done = done.as_ref().map(|done| self.locate(&walk.frame, done, attempt));
                self.put_copy(&target, &source);
                if let Some(done) = done {
                    self.put(&done, Value::bool(!attempt.failed));
                }
                attempt.failed |= failed;
                self.did(walk, statement, "statement a := b of many");
            }
            Statement::Call(call) => {
                attempt.failed |= self.call(walk, call, true)?.failed;
                self.did(walk, statement, "statement call");
            }
            Statement::If { branches, otherwise } => {
                let mut chosen = branches.len();
                for (place, (condition, _)) in branches.iter().enumerate() {
                    if self.value(&walk.frame, condition, attempt).is_true() {
                        chosen = place;
                        break;
                    }
                }
                self.chose(walk, statement, "statement IF", chosen);
                let body = branches.get(chosen).map_or(otherwise, |(_, body)| body);
                self.statements(walk, body, attempt)?;
            }
            Statement::Case { selector, branches, otherwise } => {
                let selector = number(self.value(&walk.frame, selector, attempt));
                let matches = |(first, last): &(Value, Value)| (number(*first)..=number(*last)).contains(&selector);
                let chosen = branches.iter().position(|(labels, _)| labels.iter().any(matches));
                let chosen = chosen.unwrap_or(branches.len());
                self.chose(walk, statement, "statement CASE", chosen);
                let body = branches.get(chosen).map_or(otherwise, |(_, body)| body);
                self.statements(walk, body, attempt)?;
            }
            Statement::For { variable, first, step, count, body } => {
                let after = |times: u32| wrapped(first.ty(), number(*first) + i128::from(times) * step);
                self.did(walk, statement, "statement FOR");
                for time in 0..*count {
                    let variable = self.locate(&walk.frame, variable, attempt);
                    self.put(&variable, after(time));
                    match self.statements(walk, body, attempt) {
                        Ok(()) => {}
                        Err(Leave::Loop) => return Ok(()),
                        Err(leave) => return Err(leave),
                    }
                }
                let variable = self.locate(&walk.frame, variable, attempt);
                self.put(&variable, after(*count));
            }
            Statement::Exit => {
                self.did(walk, statement, "statement EXIT");
                return Err(Leave::Loop);
            }
            Statement::Return => {
                self.did(walk, statement, "statement RETURN");
                return Err(Leave::UNIT);
            }
        }
        Ok(())
    }

    fn did(&mut self, walk: &Walk, statement: &Statement, kind: &str) {
        self.activities.executed(walk.frame.id, statement, kind);
    }

    fn chose(&mut self, walk: &Walk, statement: &Statement, kind: &str, branch: usize) {
        let branch = i64::try_from(branch).expect("a program of the tests is small");
        self.activities.saw(walk.frame.id, statement, kind, vec![Value::time(branch)]);
    }
}
