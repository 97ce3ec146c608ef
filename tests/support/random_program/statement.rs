//! Random structured text.

use rung::elementary::Elementary;
use rung::ladder::{
    CaseBranch, CaseLabel, ConditionalBranch, Expression, ExpressionKind, Literal, Reference, Root, Statement,
    StatementKind,
};

use super::{Generator, Purpose};
use crate::support::drawing::{self, NOWHERE};

/// How deep statements nest.
const DEPTH: usize = 2;

impl Generator {
    /// What stands in braces; never nothing.
    pub(super) fn statements(&mut self, depth: usize, in_loop: bool) -> Vec<Statement> {
        (0..self.dice.between(1, 3)).map(|_| self.statement(depth, in_loop)).collect()
    }

    fn statement(&mut self, depth: usize, in_loop: bool) -> Statement {
        let nests = depth < DEPTH;
        let kind = match self.dice.below(100) {
            0..18 if nests => self.choice(depth, in_loop),
            18..28 if nests => self.case(depth, in_loop),
            28..40 if nests && (!in_loop || self.dice.percent(25)) => self.repetition(depth),
            40..58 => self.call_statement().map(StatementKind::Call),
            58..66 => self.copied().map(|(target, source)| StatementKind::Assignment {
                target,
                value: drawing::expression(ExpressionKind::Read(source)),
            }),
            66..74 if in_loop && depth > 0 => Some(self.leave(StatementKind::Exit)),
            66..69 if !self.in_pin => Some(self.leave(StatementKind::Return)),
            _ => None,
        };
        let kind = kind.unwrap_or_else(|| self.assign());
        statement(kind)
    }

    fn assign(&mut self) -> StatementKind {
        let ty = self.some_type();
        let (ty, target) = match self.target(ty) {
            Some(target) => (ty, target),
            None => (Elementary::Bool, self.target(Elementary::Bool).expect("every unit has a BOOL to write")),
        };
        StatementKind::Assignment { target, value: self.expression(ty, 2) }
    }

    fn choice(&mut self, depth: usize, in_loop: bool) -> Option<StatementKind> {
        let branches = (0..self.dice.between(1, 3)).map(|_| ConditionalBranch {
            condition: self.expression(Elementary::Bool, 2),
            body: self.statements(depth + 1, in_loop),
        });
        let branches = branches.collect();
        let otherwise = if self.dice.percent(40) { self.statements(depth + 1, in_loop) } else { Vec::new() };
        Some(StatementKind::If { branches, otherwise })
    }

    fn case(&mut self, depth: usize, in_loop: bool) -> Option<StatementKind> {
        use Elementary::{Dint, Int, Sint, Uint};
        let ty = *self.dice.pick(&[Int, Int, Dint, Sint, Uint]);
        self.place(ty, Purpose::ReadVariable)?;
        let selector = self.anchored(ty, 1);
        let branches = (0..self.dice.between(1, 3)).map(|_| CaseBranch {
            labels: (0..self.dice.between(1, 2)).map(|_| self.label(ty)).collect(),
            body: self.statements(depth + 1, in_loop),
        });
        let branches = branches.collect();
        let otherwise = if self.dice.percent(50) { self.statements(depth + 1, in_loop) } else { Vec::new() };
        Some(StatementKind::Case { selector, branches, otherwise })
    }

    fn label(&mut self, ty: Elementary) -> CaseLabel {
        let first = self.dice.below(5) as i128;
        let last = self.dice.percent(30).then(|| drawing::integer(first + self.dice.below(3) as i128));
        if ty != Elementary::Int || !self.has_colours() || last.is_some() || self.dice.percent(50) {
            return CaseLabel { first: drawing::integer(first), last };
        }
        CaseLabel { first: self.colour(), last: None }
    }

    /// Whether there is an enumeration.
    pub(super) fn has_colours(&self) -> bool {
        self.value_types.iter().any(|(_, name)| name == "colour")
    }

    /// A value of the enumeration.
    pub(super) fn colour(&mut self) -> Expression {
        let value = drawing::name(self.dice.pick::<&str>(&["red", "green", "blue"]));
        if self.dice.percent(50) {
            return drawing::expression(ExpressionKind::Read(Reference::of_name(value)));
        }
        drawing::expression(ExpressionKind::Literal(Literal::Enumerated {
            ty: Box::new(drawing::name("colour")),
            value: Box::new(value),
        }))
    }

    fn repetition(&mut self, depth: usize) -> Option<StatementKind> {
        let counts = self.scope.iter().filter(|entry| {
            let is_name = matches!(entry.root, Root::Name(_)) && entry.way.is_empty();
            is_name && entry.ty.is_integer() && Purpose::Write.allows(entry.class)
        });
        let counts: Vec<Root> = counts.map(|entry| entry.root.clone()).collect();
        if counts.is_empty() {
            return None;
        }
        let root = self.dice.pick(&counts).clone();
        let variable = Reference { root, steps: Vec::new().into(), span: NOWHERE };
        let first = self.dice.below(3);
        let last = self.dice.below(4);
        let down = last < first;
        let step = match self.dice.below(3) {
            0 => Some(drawing::integer(if down { -1 } else { 2 })),
            1 if down => Some(drawing::integer(-2)),
            _ => None,
        };
        let around = self.turns;
        self.turns *= 3;
        let body = self.statements(depth + 1, true);
        self.turns = around;
        let (first, last) = (drawing::integer(first as i128), drawing::integer(last as i128));
        Some(StatementKind::For { variable, first, last, step, body })
    }

    /// A statement that leaves what it is in, on a condition that seldom holds.
    fn leave(&mut self, kind: StatementKind) -> StatementKind {
        let condition = self.expression(Elementary::Bool, 2);
        let branches = vec![ConditionalBranch { condition, body: vec![statement(kind)] }];
        StatementKind::If { branches, otherwise: Vec::new() }
    }
}

fn statement(kind: StatementKind) -> Statement {
    Statement { kind, span: NOWHERE }
}
