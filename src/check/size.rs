//! How large a program is once every type, instance and call is written out: the values that its arrays, structures and
//! instances have, what it takes of the register machine, and the elements that its calls and loops come to. What holds or
//! calls itself would be endless and is an error. The walk must never follow a way twice, nor write anything out: a few
//! lines can stand for more than any machine holds.

use std::collections::HashSet;

use super::model::{ProgramInstance, Type, UnitId, VariableId};
use super::type_table::MOST_ELEMENTS;
use super::unit::UnitCall;
use super::{Checker, MOST_INLINED};
use crate::diagnostic::{Code, Diagnostic};
use crate::ladder::library::StandardBlock;
use crate::ladder::{UnitKind, VariableClass};
use crate::source::Span;

/// The instances of register-machine blocks that are limited together: timers and counters, drums, shift registers.
const MACHINE: [(&str, &[&str]); 3] =
    [("timers", &["TT", "TS", "UC", "DC"]), ("drums", &["DR"]), ("shifts", &["SHIFTL", "SHIFTR"])];

/// How deep units may nest, each with the circuits and expressions in it and a call with [`CALL_DEPTH`]: what is written out is
/// walked as deep as it nests.
const MOST_NESTED: usize = 512;

/// What a call counts for.
const CALL_DEPTH: usize = 4;

/// What something of a type, or a unit, has.
#[derive(Clone, Copy, Default)]
struct Size {
    /// Elementary values.
    values: u64,
    /// Instances of the blocks of [`MACHINE`].
    machine: [u64; 3],
    /// Of a unit: the elements of one call of it, with all that it calls.
    code: u64,
    /// Of a unit: how deep it nests, with all that it calls.
    depth: usize,
}

impl Size {
    fn of_block(block: StandardBlock) -> Self {
        let values = (block.inputs().len() + block.outputs().len()) as u64;
        Self {
            values,
            machine: MACHINE.map(|(_, blocks)| u64::from(blocks.contains(&block.name()))),
            ..Self::default()
        }
    }

    /// With so many of another, as far as memory goes.
    fn with(mut self, times: u64, other: Self) -> Self {
        self.values = self.values.saturating_add(times.saturating_mul(other.values));
        for (mine, others) in self.machine.iter_mut().zip(other.machine) {
            *mine = mine.saturating_add(times.saturating_mul(others));
        }
        self
    }
}

/// One that needs another: the other one, and where if it is a unit that does.
type Edge = (usize, Option<Span>);

/// A walk over units, then structures, then arrays, all numbered together.
struct Walk {
    sizes: Vec<Option<Size>>,
    open: Vec<bool>,
    reported: HashSet<(usize, usize)>,
}

impl Checker<'_> {
    /// Reports what holds or calls itself, and all that is too large.
    pub(super) fn check_sizes(&mut self, programs: &[ProgramInstance]) {
        let count = self.units.len() + self.types.structures.len() + self.types.arrays.len();
        let mut walk = Walk { sizes: vec![None; count], open: vec![false; count], reported: HashSet::new() };
        for node in 0..count {
            self.size_from(node, &mut walk);
        }
        // Where something has no end its size means nothing.
        if walk.reported.is_empty() {
            let sizes: Vec<Size> = walk.sizes.into_iter().map(Option::unwrap_or_default).collect();
            self.check_storage(programs, &sizes);
            self.check_code(programs, &sizes);
            self.check_call_depth(programs, &sizes);
        }
    }

    /// The number of what a type is made of, where it is not a single value or standard block.
    fn node_of(&self, ty: Type) -> Option<usize> {
        match ty {
            Type::Elementary(_) | Type::Block(_) => None,
            Type::Unit(unit) => Some(unit.index()),
            Type::Structure(structure) => Some(self.units.len() + structure.index()),
            Type::Array(array) => Some(self.units.len() + self.types.structures.len() + array.index()),
        }
    }

    /// The types that a node is made of, each with how many there are and of a variable its place.
    fn parts(&self, node: usize) -> Vec<(Type, u64, Option<Span>)> {
        let (units, structures) = (self.units.len(), self.types.structures.len());
        if node < units {
            let variables = self.units[node].variables.clone().map(VariableId);
            let own = variables.map(|id| &self.scope.entry(id).variable);
            own.filter(|variable| variable.class != VariableClass::InOut)
                .map(|variable| (variable.ty, 1, Some(variable.span)))
                .collect()
        } else if node < units + structures {
            self.types.structures[node - units].fields.iter().map(|field| (field.ty, 1, None)).collect()
        } else {
            let array = &self.types.arrays[node - units - structures];
            vec![(array.element, u64::from(array.count()), None)]
        }
    }

    fn edges(&self, node: usize) -> Vec<Edge> {
        let parts = self.parts(node).into_iter();
        let mut edges: Vec<Edge> = parts.filter_map(|(ty, _, span)| Some((self.node_of(ty)?, span))).collect();
        if let Some(unit) = self.units.get(node) {
            edges.extend(unit.calls.iter().map(|call| (call.callee.index(), Some(call.span))));
        }
        edges
    }

    /// The size of a node and of all that it needs. The walk keeps its own stack, since they may nest as deep as there are units.
    fn size_from(&mut self, node: usize, walk: &mut Walk) {
        let mut stack: Vec<(usize, std::vec::IntoIter<Edge>, Option<Span>)> = Vec::new();
        if walk.sizes[node].is_none() {
            walk.open[node] = true;
            stack.push((node, self.edges(node).into_iter(), None));
        }
        while let Some((node, edges, place)) = stack.last_mut() {
            let Some((to, span)) = edges.next() else {
                let node = *node;
                walk.sizes[node] = Some(self.size_of(node, &walk.sizes));
                stack.pop();
                continue;
            };
            *place = span;
            if walk.sizes[to].is_some() {
                continue;
            } else if !walk.open[to] {
                walk.open[to] = true;
                stack.push((to, self.edges(to).into_iter(), None));
                continue;
            }
            // It is open, so that it stands on the stack; of those from there on the last unit says where it is needed.
            let unit = stack.iter().rev().find(|(node, ..)| *node < self.units.len());
            if let Some((unit, _, Some(span))) = unit
                && walk.reported.insert((*unit, to))
            {
                self.report_recursion(*unit, to, *span);
            }
        }
    }

    /// The size of one of which all parts have theirs.
    fn size_of(&self, node: usize, sizes: &[Option<Size>]) -> Size {
        let mut size = Size::default();
        for (ty, times, _) in self.parts(node) {
            let of_node = |node: usize| sizes[node].unwrap_or_default();
            size = size.with(times, self.size_of_type(ty, of_node));
        }
        let Some(unit) = self.units.get(node) else { return size };
        let called = |callee: UnitId| sizes[callee.index()].map_or(0, |size| size.code);
        let calls = unit.calls.iter().map(|call| call.times.saturating_mul(called(call.callee)));
        // A function's variables start afresh at each call, of another unit the temporary ones.
        let afresh = if is_function(&self.program.units[node].kind) { size.values } else { self.temporaries(node) };
        let own = unit.weight.saturating_add(afresh);
        size.code = calls.fold(own, u64::saturating_add);
        let nested = |call: &UnitCall| sizes[call.callee.index()].map_or(0, |size| size.depth + CALL_DEPTH);
        size.depth = unit.depth + unit.calls.iter().map(nested).max().unwrap_or(0);
        size
    }

    /// How many values a unit sets whenever it starts.
    fn temporaries(&self, unit: usize) -> u64 {
        let variables = self.units[unit].variables.clone().map(|id| &self.scope.entry(VariableId(id)).variable);
        let temporary = variables.filter(|variable| variable.class == VariableClass::Temporary);
        temporary.map(|variable| self.types.values(variable.ty)).fold(0, u64::saturating_add)
    }

    fn size_of_type(&self, ty: Type, of_node: impl Fn(usize) -> Size) -> Size {
        match (ty, self.node_of(ty)) {
            (Type::Block(block), _) => Size::of_block(block),
            (_, Some(node)) => of_node(node),
            (_, None) => Size { values: 1, ..Size::default() },
        }
    }

    fn report_recursion(&mut self, caller: usize, callee: usize, span: Span) {
        let caller = &self.program.units[caller].name.text;
        let (callee, declared) = match self.program.units.get(callee) {
            Some(unit) => (unit.name.text.clone(), Some(unit.name.span)),
            None => {
                let structure = self.types.structures.get(callee - self.units.len());
                (structure.map_or_else(|| "the array".into(), |structure| structure.name.clone()), None)
            }
        };
        let message = if *caller == callee {
            format!("`{caller}` calls or holds itself")
        } else {
            format!("`{caller}` calls or holds `{callee}`, which in turn needs `{caller}`")
        };
        let mut problem = Diagnostic::new(Code::RecursiveUnit, span, message);
        problem = declared.into_iter().fold(problem, |problem, declared| problem.related(declared, "declared here"));
        self.report.push(problem.hint("a scan is a straight line: what is called is written out where it is called"));
    }

    /// Reports more values than there may be, and more blocks than the register machine has.
    fn check_storage(&mut self, programs: &[ProgramInstance], sizes: &[Size]) {
        let mut largest: Option<(u64, Span, VariableId)> = None;
        let mut all = Size::default();
        let mut add = |checker: &Self, id: VariableId, is_counted: bool| {
            let variable = &checker.scope.entry(id).variable;
            let mut size = checker.size_of_type(variable.ty, |node| sizes[node]);
            // What is written down one by one is as large as the source.
            if !is_counted && matches!(variable.ty, Type::Elementary(_) | Type::Block(_)) {
                size.values = 0;
            }
            all = all.with(1, size);
            if largest.is_none_or(|(values, ..)| values < size.values) {
                largest = Some((size.values, variable.span, id));
            }
        };
        for id in self.scope.ids().filter(|id| self.scope.entry(*id).unit.is_none()) {
            add(self, id, false);
        }
        let mut seen = HashSet::new();
        for instance in programs {
            let again = !seen.insert(instance.unit);
            for id in self.units[instance.unit.index()].variables.clone().map(VariableId) {
                add(self, id, again);
            }
        }
        for (unit, _) in self.units.iter().zip(&self.program.units).filter(|(_, drawn)| is_function(&drawn.kind)) {
            for id in unit.variables.clone().map(VariableId) {
                add(self, id, false);
            }
        }
        if let Some((values, span, id)) = largest.filter(|_| all.values > u64::from(MOST_ELEMENTS)) {
            let message = format!(
                "arrays, structures and instances come to {} values, {values} of them in `{}`",
                all.values,
                self.scope.entry(id).variable.name
            );
            let problem = Diagnostic::new(Code::TooManyElements, span, message);
            self.report.push(problem.hint(format!("all together they may have {MOST_ELEMENTS}")));
        }
        let limits = [self.registers.timers, self.registers.drums, self.registers.shifts];
        for (((name, blocks), count), limit) in MACHINE.into_iter().zip(all.machine).zip(limits) {
            if count > limit.cast_unsigned() {
                let message = format!(
                    "there are {count} instances of {}, and the register machine has {limit}",
                    blocks.join(", ")
                );
                let problem = Diagnostic::new(Code::BadResource, self.program.name.span, message);
                self.report.push(problem.hint(format!("`registers({name} := {count})` gives it more")));
            }
        }
    }

    /// Reports programs whose calls nest too deeply to be written out.
    fn check_call_depth(&mut self, programs: &[ProgramInstance], sizes: &[Size]) {
        let too_deep = |unit: &UnitId| sizes[unit.index()].depth > MOST_NESTED;
        let Some(unit) = programs.iter().map(|instance| instance.unit).find(too_deep) else { return };
        let calls = &self.units[unit.index()].calls;
        let Some(call) = calls.iter().max_by_key(|call| sizes[call.callee.index()].depth) else { return };
        let name = &self.program.units[call.callee.index()].name.text;
        let depth = sizes[unit.index()].depth;
        let message =
            format!("with what `{name}` calls in turn, this is nested {depth} deep, and the most is {MOST_NESTED}");
        let problem = Diagnostic::new(Code::TooDeep, call.span, message);
        self.report
            .push(problem.hint(format!("each call counts for {CALL_DEPTH}, beside the circuits that it stands in")));
    }

    /// Reports calls, loops and program instances that come to too much once they are written out.
    fn check_code(&mut self, programs: &[ProgramInstance], sizes: &[Size]) {
        let mut all: u64 = 0;
        // What comes to most: how much, where, and what it is.
        let mut largest: (u64, Span, String) = (0, self.program.name.span, String::new());
        let mut seen = HashSet::new();
        for instance in programs {
            let (unit, code) = (&self.units[instance.unit.index()], sizes[instance.unit.index()].code);
            if !seen.insert(instance.unit) {
                all = all.saturating_add(code);
                if code > largest.0 {
                    let span = self.program.units[instance.unit.index()].name.span;
                    largest = (
                        code,
                        span,
                        format!("each instance of `{}`", self.program.units[instance.unit.index()].name.text),
                    );
                }
                continue;
            }
            all = all.saturating_add(code.saturating_sub(unit.drawn));
            for call in &unit.calls {
                let code = call.times.saturating_mul(sizes[call.callee.index()].code);
                if code > largest.0 {
                    let name = &self.program.units[call.callee.index()].name.text;
                    largest = (code, call.span, format!("this call of `{name}`"));
                }
            }
            if let Some((weight, span)) = unit.loops.filter(|(weight, _)| *weight > largest.0) {
                largest = (weight, span, "this statement".to_owned());
            }
        }
        if all > MOST_INLINED {
            let (code, span, what) = largest;
            // What is drawn does not count, and is part of the code.
            let code = code.min(all);
            let message = format!("calls and loops written out come to {all} elements, {code} of them by {what}");
            let problem = Diagnostic::new(Code::TooLargeInlined, span, message);
            self.report.push(problem.hint(format!(
                "what is called or repeated is written out each time, to at most {MOST_INLINED} elements"
            )));
        }
    }
}

fn is_function(kind: &UnitKind) -> bool {
    matches!(kind, UnitKind::Function { .. })
}
