//! Structured text in braces: assignments, calls, choices and loops with constant bounds. A loop must end, and its turns are
//! written out, so that how often it turns is known here.

use super::Checker;
use super::function_box::Boxed;
use super::model::{Place, Statement, Step, Type};
use super::network::Walk;
use super::types;
use crate::diagnostic::{Code, Diagnostic};
use crate::elementary::{Elementary, Value};
use crate::ladder::{self, CaseLabel, Expression, ExpressionKind, Reference, StatementKind, UnitKind, VariableClass};
use crate::source::Span;

/// The most turns of one loop.
const MOST_TURNS: i128 = 1 << 16;

impl Checker<'_> {
    /// Statements; what is faulty was reported and is left out.
    pub(super) fn statements(&mut self, statements: &[ladder::Statement], walk: &mut Walk) -> Vec<Statement> {
        statements.iter().filter_map(|statement| self.statement(statement, walk)).collect()
    }

    fn statement(&mut self, statement: &ladder::Statement, walk: &mut Walk) -> Option<Statement> {
        self.weigh(1);
        match &statement.kind {
            StatementKind::Assignment { target, value } => self.assign(target, value),
            StatementKind::Call(call) => self.call(call, statement.span, false, walk).map(Boxed::statement),
            StatementKind::If { branches, otherwise } => {
                let around = std::mem::replace(&mut walk.conditional, true);
                let mut checked = Vec::with_capacity(branches.len());
                for branch in branches {
                    let condition = self.value(&branch.condition, Elementary::Bool);
                    let body = self.statements(&branch.body, walk);
                    checked.extend(condition.map(|condition| (condition, body)));
                }
                let otherwise = self.statements(otherwise, walk);
                walk.conditional = around;
                Some(Statement::If { branches: checked, otherwise })
            }
            StatementKind::Case { selector, branches, otherwise } => self.case(selector, branches, otherwise, walk),
            StatementKind::For { variable, first, last, step, body } => {
                let bounds = [Some(first), Some(last), step.as_ref()];
                self.repeat(variable, bounds, body, statement.span, walk)
            }
            StatementKind::Exit if self.loops == 0 => {
                let problem =
                    Diagnostic::new(Code::MisplacedJump, statement.span, "EXIT leaves a FOR, and there is none here");
                self.report.push(problem);
                None
            }
            StatementKind::Exit => Some(Statement::Exit),
            StatementKind::Return if walk.in_pin => {
                self.jump_in_pin(statement.span);
                None
            }
            StatementKind::Return => Some(Statement::Return),
        }
    }

    /// An assignment of a value, or of a whole array or structure.
    pub(super) fn assign(&mut self, target: &Reference, value: &Expression) -> Option<Statement> {
        let written = self.written(target);
        let Some((place, ty)) = written else {
            // Only for what is wrong in it.
            self.operand(value);
            return None;
        };
        match ty {
            Type::Elementary(ty) => {
                let value = self.value(value, ty)?;
                Some(Statement::Assignment { target: place, value })
            }
            Type::Array(_) | Type::Structure(_) if !self.types.holds_instance(ty) => {
                let source = self.source(value, ty)?;
                self.weigh_copy(ty, [&source, &place], value.span);
                Some(Statement::Copy { target: place, source, done: None })
            }
            _ => {
                let message = format!("{} cannot be assigned to", types::with_article(&self.type_name(ty)));
                self.report.push(Diagnostic::new(Code::NotWritable, target.span, message));
                None
            }
        }
    }

    /// Notes what copying something of a type comes to: where a run of values is copied as a whole it is one step, else each of
    /// them is one.
    pub(super) fn weigh_copy(&mut self, ty: Type, places: [&Place; 2], span: Span) {
        let before = self.weight();
        let whole = places.iter().all(|place| self.is_whole(place));
        self.weigh(if whole { self.types.runs(ty) } else { self.types.values(ty) });
        self.note_large(before, span);
    }

    /// Whether a place is no part of an array, whatever its unit is called with and wherever the unit's instances are.
    fn is_whole(&self, place: &Place) -> bool {
        let entry = self.scope.entry(place.variable);
        let is_of_block =
            entry.unit.is_some_and(|unit| self.program.units[unit.index()].kind == UnitKind::FunctionBlock);
        let is_element = place.path.iter().any(|step| matches!(step, Step::Element(_)));
        !is_of_block && !is_element && entry.variable.class != VariableClass::InOut
    }

    /// What a whole array or structure gets: another of its type.
    fn source(&mut self, value: &Expression, ty: Type) -> Option<Place> {
        let found = match &value.kind {
            ExpressionKind::Read(reference) => {
                let (place, found) = self.place(reference)?;
                if found == ty && place.bit.is_none() {
                    return Some(place);
                }
                self.type_name(found)
            }
            _ => "a value".to_owned(),
        };
        let [wants, found] = [self.type_name(ty), found].map(|name| types::with_article(&name));
        let message = format!("{wants} is expected here, and this is {found}");
        self.report.push(Diagnostic::new(Code::TypeMismatch, value.span, message));
        None
    }

    fn case(
        &mut self,
        selector: &Expression,
        branches: &[ladder::CaseBranch],
        otherwise: &[ladder::Statement],
        walk: &mut Walk,
    ) -> Option<Statement> {
        let operand = self.operand(selector);
        let ty = operand.as_ref().and_then(|operand| operand.other_than_bool());
        let ty = ty.filter(|ty| ty.is_integer() || ty.is_bit_string());
        if operand.is_some() && ty.is_none() {
            let problem = Diagnostic::new(Code::TypeMismatch, selector.span, "CASE compares integers");
            self.report.push(problem.hint("use IF for other conditions"));
        }
        let around = std::mem::replace(&mut walk.conditional, true);
        let mut checked = Vec::with_capacity(branches.len());
        for branch in branches {
            let labels: Vec<(Value, Value)> = branch.labels.iter().filter_map(|label| self.label(label, ty?)).collect();
            checked.push((labels, self.statements(&branch.body, walk)));
        }
        let otherwise = self.statements(otherwise, walk);
        walk.conditional = around;
        let selector = self.coerce(operand?, ty?, selector.span)?;
        Some(Statement::Case { selector, branches: checked, otherwise })
    }

    fn label(&mut self, label: &CaseLabel, ty: Elementary) -> Option<(Value, Value)> {
        let first = self.constant_of(&label.first, ty);
        let last = match &label.last {
            Some(last) => self.constant_of(last, ty),
            None => first,
        };
        Some((first?, last?))
    }

    fn constant_of(&mut self, expression: &Expression, ty: Elementary) -> Option<Value> {
        let value = self.value(expression, ty)?.constant();
        if value.is_none() {
            self.report.push(Diagnostic::new(Code::NotConstant, expression.span, "this must be a constant"));
        }
        value
    }

    fn repeat(
        &mut self,
        variable: &Reference,
        bounds: [Option<&Expression>; 3],
        body: &[ladder::Statement],
        span: Span,
        walk: &mut Walk,
    ) -> Option<Statement> {
        let written = self.write(variable).filter(|(place, ty)| {
            let fits = ty.is_integer() && place.path.is_empty();
            if !fits {
                let message = "a FOR counts with an integer variable";
                self.report.push(Diagnostic::new(Code::TypeMismatch, variable.span, message));
            }
            fits
        });
        let ty = written.as_ref().map_or(Elementary::Lint, |(_, ty)| *ty);
        let turns = self.turns_of(bounds, ty, span);
        let (before, around) = (self.weight(), self.turns);
        let count = turns.as_ref().map_or(1, |(.., count)| u64::from(*count));
        self.turns = around.map(|around| around.saturating_mul(count));
        self.loops += 1;
        let body = self.statements(body, walk);
        self.loops -= 1;
        self.turns = around;
        self.note_large(before, span);
        let (first, step, count) = turns?;
        let first = Value::integer(ty, first)?;
        Some(Statement::For { variable: written?.0, first, step, count, body })
    }

    /// The first value of a FOR, its step, and how often it turns.
    fn turns_of(&mut self, bounds: [Option<&Expression>; 3], ty: Elementary, span: Span) -> Option<(i128, i128, u32)> {
        // The step of a variable without a sign may have one.
        let types = [ty, ty, Elementary::Lint];
        let mut values = [Some(1); 3];
        for ((value, bound), ty) in values.iter_mut().zip(bounds).zip(types) {
            let Some(bound) = bound else { continue };
            let checked = self.value(bound, ty);
            *value = checked.as_ref().and_then(|checked| checked.constant()?.as_integer());
            if checked.is_some_and(|checked| checked.constant().is_none()) {
                let problem = "how often a FOR turns must be known before the program runs: this must be a constant";
                let problem = Diagnostic::new(Code::NotConstant, bound.span, problem);
                self.report.push(problem.hint("turn a constant number of times, and leave with EXIT"));
            }
        }
        let [first, last, step] = values;
        let (first, last, step) = (first?, last?, step?);
        if step == 0 {
            self.report.push(Diagnostic::new(Code::OutOfRange, span, "a FOR with steps of 0 never ends"));
            return None;
        }
        let turns = if (last - first).signum() * step.signum() < 0 { 0 } else { (last - first) / step + 1 };
        let Some(count) = u32::try_from(turns).ok().filter(|_| turns <= MOST_TURNS) else {
            let problem = Diagnostic::new(Code::TooLargeInlined, span, format!("this FOR turns {turns} times"));
            self.report.push(problem.hint(format!("its turns are written out, at most {MOST_TURNS}")));
            return None;
        };
        Some((first, step, count))
    }
}
