//! Units: what a call gives them and takes from them, what they call, and how much they do.

use std::collections::HashMap;
use std::ops::Range;

use super::Checker;
use super::model::{Rung, Unit, UnitId, VariableId};
use crate::diagnostic::{Code, Diagnostic};
use crate::ladder::functions::Function;
use crate::ladder::{self, Name, Origin, UnitKind, VariableClass};
use crate::source::Span;

/// The most elements, statements and operators that all calls and loops together may write out.
pub const MOST_INLINED: u64 = 1 << 20;

/// A unit as its callers see it.
pub(super) struct Signature {
    /// Its variables.
    pub(super) variables: Range<u32>,
    pub(super) inputs: Vec<VariableId>,
    pub(super) outputs: Vec<VariableId>,
    pub(super) references: Vec<VariableId>,
    /// How deep its rungs nest.
    pub(super) depth: usize,
    /// The calls of units that its rungs make that run.
    pub(super) calls: Vec<UnitCall>,
    /// Elements, statements and operators of those rungs, as often as FORs repeat them.
    pub(super) weight: u64,
    /// The same as drawn.
    pub(super) drawn: u64,
    /// The statement that comes to most when it is written out, and to how much.
    pub(super) loops: Option<(u64, Span)>,
    /// Whether anything calls it, in a rung that runs or not, or declares an instance.
    pub(super) used: bool,
}

/// A call of a unit.
pub(super) struct UnitCall {
    pub(super) callee: UnitId,
    pub(super) span: Span,
    /// How often the FORs around it repeat it.
    pub(super) times: u64,
}

impl Signature {
    pub(super) fn new(variables: Range<u32>, depth: usize) -> Self {
        Self {
            variables,
            inputs: Vec::new(),
            outputs: Vec::new(),
            references: Vec::new(),
            depth,
            calls: Vec::new(),
            weight: 0,
            drawn: 0,
            loops: None,
            used: false,
        }
    }
}

impl Checker<'_> {
    /// Notes what calls of a unit give it and take from it, in the order of its declarations.
    pub(super) fn sign(&mut self, id: UnitId, unit: &ladder::Unit) {
        if matches!(unit.kind, UnitKind::Program { .. }) {
            return;
        }
        for variable in self.units[id.index()].variables.clone().map(VariableId) {
            let signature = &mut self.units[id.index()];
            let entry = self.scope.entry_mut(variable);
            match entry.variable.class {
                VariableClass::Input => signature.inputs.push(variable),
                VariableClass::Output => signature.outputs.push(variable),
                VariableClass::InOut => signature.references.push(variable),
                _ => continue,
            }
        }
    }

    /// Reports functions of the program that hide standard ones; another tool may have meant that.
    pub(super) fn check_function_names(&mut self) {
        for unit in &self.program.units {
            let hides =
                matches!(unit.kind, UnitKind::Function { .. }) && Function::from_name(&unit.name.text).is_some();
            if hides && self.program.origin == Origin::Native {
                let message = format!("there is a standard function `{}` already", unit.name.text);
                self.report.push(Diagnostic::new(Code::DuplicateName, unit.name.span, message));
            }
        }
    }

    /// Reports blocks and functions that nothing calls.
    pub(super) fn check_unused_units(&mut self) {
        for (index, (unit, signature)) in (0..).zip(self.program.units.iter().zip(&self.units)) {
            let is_used = matches!(unit.kind, UnitKind::Program { .. })
                || signature.used
                || self.types.named_units.contains(&UnitId(index));
            if !is_used && !unit.name.text.starts_with('_') {
                let message = format!("nothing calls `{}`", unit.name.text);
                let problem = Diagnostic::new(Code::UnusedName, unit.name.span, message);
                self.report.push(problem.hint("a name that starts with `_` may stay unused"));
            }
        }
    }

    /// The function of that name that the program declares.
    pub(super) fn function_unit(&self, name: &Name) -> Option<UnitId> {
        if self.functions.is_empty() { None } else { self.functions.get(&name.key()).copied() }
    }

    /// Notes that the unit that is being checked calls another.
    pub(super) fn note_unit_call(&mut self, callee: UnitId, span: Span) {
        self.units[callee.index()].used = true;
        if let (Some(caller), Some(times)) = (self.scope.unit(), self.turns) {
            self.units[caller.index()].calls.push(UnitCall { callee, span, times });
        }
    }

    /// Notes an element, statement or operator of the unit that is being checked, or what one comes to.
    pub(super) fn weigh(&mut self, weight: u64) {
        if let (Some(unit), Some(turns)) = (self.scope.unit(), self.turns) {
            // A number that a declaration needs before there are units weighs nothing.
            let Some(unit) = self.units.get_mut(unit.index()) else { return };
            unit.weight = unit.weight.saturating_add(turns.saturating_mul(weight));
            unit.drawn = unit.drawn.saturating_add(1);
        }
    }

    /// Notes a statement that comes to more than is drawn, with the weight that its unit had before.
    pub(super) fn note_large(&mut self, before: u64, span: Span) {
        let Some(unit) = self.scope.unit().and_then(|unit| self.units.get_mut(unit.index())) else { return };
        let weight = unit.weight.saturating_sub(before);
        if unit.loops.is_none_or(|(most, _)| most < weight) {
            unit.loops = Some((weight, span));
        }
    }

    /// The weight so far of the unit that is being checked.
    pub(super) fn weight(&self) -> u64 {
        self.scope.unit().and_then(|unit| self.units.get(unit.index())).map_or(0, |unit| unit.weight)
    }
}

/// The unit as it runs.
pub(super) fn checked(drawn: &ladder::Unit, signature: Signature, rungs: Vec<Rung>) -> Unit {
    let kind = match &drawn.kind {
        UnitKind::Program { .. } => super::UnitKind::Program,
        UnitKind::FunctionBlock => super::UnitKind::FunctionBlock,
        UnitKind::Function { result } => super::UnitKind::Function { has_result: result.is_some() },
    };
    let Signature { variables, inputs, outputs, references, .. } = signature;
    Unit { name: drawn.name.text.clone(), kind, variables, inputs, outputs, references, rungs, span: drawn.span }
}

/// The functions that a program declares, by their names.
pub(super) fn functions(program: &ladder::Program) -> HashMap<String, UnitId> {
    let mut functions = HashMap::new();
    for (index, unit) in (0..).zip(&program.units) {
        if matches!(unit.kind, UnitKind::Function { .. }) {
            functions.entry(unit.name.key()).or_insert(UnitId(index));
        }
    }
    functions
}

/// How many rungs stand before those of each unit.
pub(super) fn first_rungs(program: &ladder::Program) -> Vec<usize> {
    let before = |so_far: &mut usize, unit: &ladder::Unit| {
        let first = *so_far;
        *so_far += unit.rungs.len();
        Some(first)
    };
    program.units.iter().scan(0, before).collect()
}
