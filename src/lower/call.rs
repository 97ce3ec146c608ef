//! Calls: the wired inputs are computed and kept, what is called runs where it is enabled, the wired outputs are written.
//!
//! The units of the program are inlined at each call: their rungs become part of the caller's section. A function block
//! works on the slots of its instance, a function on a frame of its own that starts afresh.

use super::blocks::{self, Run, Wired};
use super::cell::{Cell, Pick};
use super::place::{Node, Part, Spot};
use super::storage::{Frame, Storage};
use super::{Lowering, Running};
use crate::check::{
    Call, Callee, Expression, ExpressionKind, Input, Output, Place, RungIndex, UnitId, VariableId, Wire,
};
use crate::elementary::{Elementary, Value};
use crate::ladder::VariableClass;
use crate::ladder::functions::Function;
use crate::ladder::library::StandardBlock;
use crate::logic::{Compare, ValueId};

/// What became of a call.
pub(super) struct Called {
    /// The power on its right.
    pub(super) right: ValueId,
    /// Whether all indices at its pins were in range, if any was computed.
    pub(super) in_range: Option<ValueId>,
    /// Whether it was enabled; `None` where it always is.
    pub(super) enabled: Option<ValueId>,
}

/// Where the outputs of what was called are.
enum Outputs<'a> {
    /// Places.
    Parts(Vec<Part<'a>>),
    /// The result of a standard function.
    Value(ValueId),
}

impl<'a> Lowering<'a> {
    /// A call, with the power on its left; in a statement there is none.
    pub(super) fn call(&mut self, call: &Call, left: Option<ValueId>) -> Called {
        let power = if call.power_input.is_none() { left } else { None };
        let outer = self.begin(power);
        let wired = call.enable.as_ref().map(|wire| self.wire(wire));
        let enable_in_range = self.end(outer);
        let enabled = self.both(power, wired);

        let outer = self.begin(enabled);
        let fed = call.power_input.map(|pin| (pin, left.unwrap_or_else(|| self.logic.bool(true))));
        let (outputs, divides) = match &call.callee {
            Callee::Standard(block, place) => (self.standard_block(*block, place, call, fed, enabled), None),
            Callee::Unit(unit, place) => (self.instance(*unit, place, call, fed, enabled), None),
            Callee::Function(function, ty) => self.function_box(*function, *ty, call, fed),
            Callee::UserFunction(unit) => (self.user_function(*unit, call, fed, enabled), None),
        };
        // An index at an output may call the same function again, which starts its variables afresh.
        let wired: Vec<Option<ValueId>> =
            call.outputs.iter().map(|(output, _)| self.output(*output, &outputs)).collect();
        let power = self.output(call.power_output, &outputs);
        let targets: Vec<Spot> = call.outputs.iter().map(|(_, place)| self.spot(place)).collect();
        let in_range = self.end(outer);
        let in_range = self.both(enable_in_range, in_range);
        let eno = self.both(enabled, in_range);
        let eno = self.both(eno, divides);

        for (value, target) in wired.into_iter().zip(targets) {
            match value {
                Some(value) => self.store(target, value, enabled),
                None => {
                    let eno = eno.unwrap_or_else(|| self.logic.bool(true));
                    self.store(target, eno, None);
                }
            }
        }
        let is_function = matches!(call.callee, Callee::Function(..) | Callee::UserFunction(_));
        let right = match power {
            None => eno,
            Some(power) => self.both(Some(power), enabled.filter(|_| is_function)),
        };
        Called { right: right.unwrap_or_else(|| self.logic.bool(true)), in_range, enabled }
    }

    /// What an output holds behind a call; of ENO, `None`.
    fn output(&mut self, output: Output, outputs: &Outputs<'a>) -> Option<ValueId> {
        match (output, outputs) {
            (Output::Eno, _) => None,
            (Output::Pin(pin), Outputs::Parts(parts)) => Some(self.load(parts[pin].spot())),
            (Output::Pin(_), Outputs::Value(value)) => Some(*value),
        }
    }

    fn wire(&mut self, wire: &Wire) -> ValueId {
        match wire {
            Wire::Value(expression) => self.expression(expression),
            Wire::Circuit(circuit) => {
                let rail = self.logic.bool(true);
                self.circuit(circuit, rail)
            }
        }
    }

    fn standard_block(
        &mut self,
        block: StandardBlock,
        place: &Place,
        call: &Call,
        fed: Option<(usize, ValueId)>,
        enabled: Option<ValueId>,
    ) -> Outputs<'a> {
        let part = self.part(place);
        let Node::Storage(Storage::Block(cells)) = part.node else { unreachable!("checking makes calls of instances") };
        let pick = part.pick;
        let mut wired: Vec<Option<(ValueId, Option<Value>)>> = vec![None; block.inputs().len()];
        let mut keep = |lowering: &mut Self, pin: usize, value: ValueId, constant: Option<Value>| {
            wired[pin] = Some((value, constant));
            if let Some(cells) = cells.inputs[pin] {
                let executed = lowering.effective(None);
                Cell { cells, pick }.store(&mut lowering.logic, executed, value);
                lowering.forget(cells);
            }
        };
        if let Some((pin, left)) = fed {
            keep(self, pin, left, None);
        }
        for Input { pin, wire } in &call.inputs {
            let value = self.wire(wire);
            keep(self, *pin, value, constant(wire));
        }
        let mut inputs = Vec::with_capacity(wired.len());
        for (pin, (wired, cells)) in wired.into_iter().zip(&cells.inputs).enumerate() {
            let reference = call.references.iter().find(|(reference, _)| *reference == pin);
            inputs.push(match (reference, wired, cells) {
                (Some((_, place)), ..) => {
                    let cell = self.spot(place).cell;
                    self.forget(cell.cells);
                    Wired::Reference(cell)
                }
                (None, wired, Some(cells)) => {
                    let value = Cell { cells: *cells, pick }.load(&mut self.logic);
                    Wired::Value(value, wired.and_then(|(_, constant)| constant))
                }
                (None, Some((value, constant)), None) => Wired::Value(value, constant),
                (None, None, None) => unreachable!("an input that a call leaves unwired has a slot"),
            });
        }
        let runs = self.effective(enabled);
        (blocks::rule(block).run)(&mut Run::new(&mut self.logic, cells, pick, &inputs, runs));
        Outputs::Parts(cells.outputs.iter().map(|cells| part.pin(*cells)).collect())
    }

    fn instance(
        &mut self,
        unit: UnitId,
        place: &Place,
        call: &Call,
        fed: Option<(usize, ValueId)>,
        enabled: Option<ValueId>,
    ) -> Outputs<'a> {
        let part = self.part(place);
        let Node::Storage(Storage::Unit(frame)) = part.node else { unreachable!("checking makes calls of instances") };
        let declared = self.checked.unit(unit);
        if let Some((pin, left)) = fed {
            let input = self.own(frame, part.pick, declared.inputs[pin]);
            self.store(input.spot(), left, None);
        }
        for Input { pin, wire } in &call.inputs {
            let value = self.wire(wire);
            let input = self.own(frame, part.pick, declared.inputs[*pin]);
            self.store(input.spot(), value, None);
        }
        let references = self.references(unit, call);
        self.enter_instance(enabled);
        self.run(Running::new(self.checked, unit, frame, part.pick, references));
        self.leave_instance();
        Outputs::Parts(declared.outputs.iter().map(|output| self.own(frame, part.pick, *output)).collect())
    }

    fn function_box(
        &mut self,
        function: Function,
        ty: Elementary,
        call: &Call,
        fed: Option<(usize, ValueId)>,
    ) -> (Outputs<'a>, Option<ValueId>) {
        let mut values: Vec<(usize, ValueId)> = fed.into_iter().collect();
        for Input { pin, wire } in &call.inputs {
            values.push((*pin, self.wire(wire)));
        }
        values.sort_by_key(|(pin, _)| *pin);
        let values: Vec<ValueId> = values.into_iter().map(|(_, value)| value).collect();
        let divides = match function {
            Function::Standard(function) if function.divides() && !self.logic.ty(values[1]).is_real() => {
                let zero = self.logic.constant(Value::default_of(self.logic.ty(values[1])));
                Some(self.logic.compare(Compare::NotEqual, values[1], zero))
            }
            _ => None,
        };
        (Outputs::Value(self.apply(function, ty, &values)), divides)
    }

    fn user_function(
        &mut self,
        unit: UnitId,
        call: &Call,
        fed: Option<(usize, ValueId)>,
        enabled: Option<ValueId>,
    ) -> Outputs<'a> {
        let mut inputs: Vec<(usize, ValueId)> = fed.into_iter().collect();
        for Input { pin, wire } in &call.inputs {
            inputs.push((*pin, self.wire(wire)));
        }
        let references = self.references(unit, call);
        Outputs::Parts(self.inlined(unit, &inputs, references, enabled))
    }

    /// The value of one of the program's own functions in an expression.
    pub(super) fn operand(&mut self, unit: UnitId, arguments: &[Option<Expression>], references: &[Place]) -> ValueId {
        let mut inputs = Vec::with_capacity(arguments.len());
        for (pin, argument) in arguments.iter().enumerate() {
            if let Some(argument) = argument {
                inputs.push((pin, self.expression(argument)));
            }
        }
        let names = &self.checked.unit(unit).references;
        let references = names.iter().zip(references).map(|(name, place)| (*name, self.part(place))).collect();
        let outputs = self.inlined(unit, &inputs, references, self.power());
        self.load(outputs[0].spot())
    }

    /// One call of a function: its outputs.
    fn inlined(
        &mut self,
        unit: UnitId,
        inputs: &[(usize, ValueId)],
        references: Vec<(VariableId, Part<'a>)>,
        enabled: Option<ValueId>,
    ) -> Vec<Part<'a>> {
        let slots = self.slots;
        let Some(frame) = slots.functions.get(&unit) else { unreachable!("a function that is called has a frame") };
        let declared = self.checked.unit(unit);
        let own = |lowering: &Self, id: VariableId| {
            lowering.own(frame, Pick::Constant(0), id).of_function(lowering.guard.functions())
        };
        let caller = self.enter_function(enabled);
        for id in declared.variables().filter(|id| frame.get(*id).is_some()) {
            let variable = own(self, id);
            self.initialise(variable);
        }
        for (pin, value) in inputs {
            let input = own(self, declared.inputs[*pin]);
            self.store(input.spot(), *value, None);
        }
        self.run(Running::new(self.checked, unit, frame, Pick::Constant(0), references));
        self.leave_function(caller);
        declared.outputs.iter().map(|output| own(self, *output)).collect()
    }

    /// What the references of a unit stand for in a call.
    fn references(&mut self, unit: UnitId, call: &Call) -> Vec<(VariableId, Part<'a>)> {
        let names = &self.checked.unit(unit).references;
        call.references.iter().map(|(name, place)| (names[*name], self.part(place))).collect()
    }

    /// A variable of what is called.
    fn own(&self, frame: &'a Frame, pick: Pick, id: VariableId) -> Part<'a> {
        let storage = frame.get(id).or_else(|| self.elsewhere(id));
        let Some(storage) = storage else { unreachable!("an input or output has storage") };
        Part::new(storage, self.checked.variable(id).ty, pick)
    }

    /// Runs the rungs of a unit.
    pub(super) fn run(&mut self, callee: Running<'a>) {
        let unit = self.checked.unit(callee.id);
        let caller = std::mem::replace(&mut self.unit, callee);
        self.initialise_temporaries();
        for (index, rung) in (0..).zip(&unit.rungs) {
            self.land(RungIndex(index));
            self.rung(rung);
        }
        self.unit = caller;
    }

    /// Sets those variables of the unit to their initial values that have them again whenever it starts.
    pub(super) fn initialise_temporaries(&mut self) {
        // In a function all variables are such.
        if self.unit.is_function {
            return;
        }
        for id in self.checked.unit(self.unit.id).variables() {
            if self.checked.variable(id).class == VariableClass::Temporary {
                let variable = self.variable(id);
                self.initialise(variable);
            }
        }
    }
}

/// The constant at a pin.
fn constant(wire: &Wire) -> Option<Value> {
    match wire {
        Wire::Value(Expression { kind: ExpressionKind::Constant(value), .. }) => Some(*value),
        _ => None,
    }
}
