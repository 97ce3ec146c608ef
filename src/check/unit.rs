//! Units: what a call gives them and takes from them, what they call, and how large they are once every call is written
//! out. What calls itself is an error, and so is what would not end in time.

use std::collections::HashMap;
use std::ops::Range;

use super::Checker;
use super::model::{Rung, Unit, UnitId, VariableId};
use crate::diagnostic::{Code, Diagnostic};
use crate::ladder::{self, Name, UnitKind, VariableClass};
use crate::source::Span;

/// The most elements, statements and operators that all calls together may write out.
pub const MOST_INLINED: u64 = 1 << 20;

/// A unit as its callers see it.
pub(super) struct Signature {
    /// Its variables.
    pub(super) variables: Range<u32>,
    pub(super) inputs: Vec<VariableId>,
    pub(super) outputs: Vec<VariableId>,
    pub(super) references: Vec<VariableId>,
    /// The units that it calls, or has instances of, each with the first place.
    pub(super) uses: Vec<(UnitId, Span)>,
    /// The calls that it makes, and what of its own is written out with each call of it.
    pub(super) calls: Vec<(UnitId, Span)>,
    pub(super) weight: u64,
}

impl Signature {
    pub(super) fn new(variables: Range<u32>) -> Self {
        Self {
            variables,
            inputs: Vec::new(),
            outputs: Vec::new(),
            references: Vec::new(),
            uses: Vec::new(),
            calls: Vec::new(),
            weight: 0,
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

    /// The function of that name that the program declares.
    pub(super) fn function_unit(&self, name: &Name) -> Option<UnitId> {
        if self.functions.is_empty() { None } else { self.functions.get(&name.key()).copied() }
    }

    /// Notes that the unit that is being checked calls another.
    pub(super) fn note_unit_call(&mut self, callee: UnitId, span: Span) {
        if let Some(caller) = self.scope.unit() {
            self.units[caller.index()].calls.push((callee, span));
        }
    }

    /// Reports units that call themselves, and programs whose calls written out are too large.
    pub(super) fn check_calls_end(&mut self) {
        let mut sizes: Vec<Option<u64>> = vec![None; self.units.len()];
        let mut open = vec![false; self.units.len()];
        for unit in 0..self.units.len() {
            self.size_of(unit, &mut sizes, &mut open);
        }
        for (index, unit) in self.program.units.iter().enumerate() {
            let is_program = matches!(unit.kind, UnitKind::Program { .. });
            let size = sizes[index].unwrap_or(0).saturating_sub(if is_program { self.units[index].weight } else { 0 });
            if is_program && size > MOST_INLINED {
                let largest = self.units[index].calls.iter().max_by_key(|(callee, _)| sizes[callee.index()]);
                let Some((callee, span)) = largest.copied() else { continue };
                let message = format!(
                    "the calls of `{}` come to {size} elements, {} of them by each call of `{}`",
                    unit.name.text,
                    sizes[callee.index()].unwrap_or(0),
                    self.program.units[callee.index()].name.text,
                );
                let problem = Diagnostic::new(Code::TooLargeInlined, span, message);
                self.report.push(
                    problem
                        .hint(format!("what is called is written out where it is called, to at most {MOST_INLINED}")),
                );
            }
        }
    }

    /// The size of a unit with all calls written out. The walk keeps its own stack, since calls may nest as deep as there are units.
    fn size_of(&mut self, unit: usize, sizes: &mut [Option<u64>], open: &mut [bool]) {
        let mut stack = vec![(unit, 0usize)];
        while let Some((unit, next)) = stack.last_mut() {
            let unit = *unit;
            if sizes[unit].is_some() {
                stack.pop();
                continue;
            }
            open[unit] = true;
            let callees = self.units[unit].calls.len() + self.units[unit].uses.len();
            if *next < callees {
                let calls = &self.units[unit].calls;
                let (callee, span) =
                    calls.get(*next).copied().unwrap_or_else(|| self.units[unit].uses[*next - calls.len()]);
                *next += 1;
                if open[callee.index()] && sizes[callee.index()].is_none() {
                    self.report_recursion(unit, callee, span);
                } else if sizes[callee.index()].is_none() {
                    stack.push((callee.index(), 0));
                }
                continue;
            }
            let calls = &self.units[unit].calls;
            let inner = calls.iter().map(|(callee, _)| sizes[callee.index()].unwrap_or(0));
            sizes[unit] = Some(inner.fold(self.units[unit].weight, u64::saturating_add));
            stack.pop();
        }
    }

    fn report_recursion(&mut self, caller: usize, callee: UnitId, span: Span) {
        let [caller, callee] = [caller, callee.index()].map(|unit| &self.program.units[unit].name);
        let message = if caller.key() == callee.key() {
            format!("`{}` calls or holds itself", caller.text)
        } else {
            format!("`{}` calls or holds `{}`, which in turn needs `{}`", caller.text, callee.text, caller.text)
        };
        let problem = Diagnostic::new(Code::RecursiveUnit, span, message).related(callee.span, "declared here");
        self.report.push(problem.hint("a scan is a straight line: what is called is written out where it is called"));
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
