//! Calls: the wired inputs are computed and kept, what is called runs, the wired outputs are written.

use rung::check::{Call, Callee, Output, Type, UnitId, VariableId, Wire};
use rung::elementary::{Elementary, Value};
use rung::ladder::functions::{Function, StandardFunction};

use super::expression::number;
use super::place::Attempt;
use super::storage::{Frame, FrameId, Register, Storage};
use super::walk::{Leave, Walk};
use super::{Oracle, function};

/// What became of a call.
pub(super) struct Called {
    /// The power on its right.
    pub(super) right: bool,
    /// Whether it was enabled and an index at a pin of it out of range.
    pub(super) failed: bool,
}

/// Where the inputs of what is called go to, and its outputs come from: those of an instance, or of one call of a function.
struct Pins {
    inputs: Vec<Storage>,
    outputs: Vec<(Storage, Type)>,
    /// Of a function of the program's own all of its variables.
    frame: Frame,
}

impl Pins {
    fn values(&self) -> impl Iterator<Item = Value> {
        self.outputs.iter().filter_map(|(storage, ty)| match ty {
            Type::Elementary(ty) => Some(storage.read(*ty)),
            _ => None,
        })
    }

    /// What a coverage table looks at.
    fn seen(&self) -> Vec<Value> {
        let bools: Vec<Value> = self.values().filter(|value| value.ty() == Elementary::Bool).collect();
        if bools.is_empty() { self.values().collect() } else { bools }
    }
}

impl Oracle<'_> {
    /// A call with power on its left. A statement has power wherever it is executed.
    pub(super) fn call(&mut self, walk: &mut Walk, call: &Call, left: bool) -> Result<Called, Leave> {
        let left_counts = call.power_input.is_none();
        let mut attempt = Attempt::new(left || !left_counts);
        let enable = match &call.enable {
            None => true,
            Some(wire) => self.wire(walk, wire, &mut attempt)?.is_true(),
        };
        let enabled = enable && (left || !left_counts);
        attempt.executed = enabled;
        let pins = self.pins(walk, call, &mut attempt);
        if let Some(input) = call.power_input {
            pins.inputs[input].write(Value::bool(left));
        }
        for input in &call.inputs {
            let value = self.wire(walk, &input.wire, &mut attempt)?;
            pins.inputs[input.pin].write(value);
        }
        let mut failed = false;
        if enabled {
            self.execute(walk, call, &pins, &mut attempt);
            let targets: Vec<Storage> =
                call.outputs.iter().map(|(_, place)| self.locate(&walk.frame, place, &mut attempt)).collect();
            failed = attempt.failed || divides_by_zero(call, &pins);
            for ((output, _), target) in call.outputs.iter().zip(targets) {
                match output {
                    Output::Eno => self.put(&target, Value::bool(!failed)),
                    Output::Pin(pin) => match &pins.outputs[*pin] {
                        (storage, Type::Elementary(ty)) => self.put(&target, storage.read(*ty)),
                        (storage, _) => self.put_copy(&target, storage),
                    },
                }
            }
        }
        self.activities.saw(walk.frame.id, call, &kind(self, call), pins.seen());
        let is_function = matches!(call.callee, Callee::Function(..) | Callee::UserFunction(_));
        let right = match call.power_output {
            Output::Eno => enabled && !failed,
            Output::Pin(pin) => (enabled || !is_function) && pins.outputs[pin].0.read(Elementary::Bool).is_true(),
        };
        Ok(Called { right, failed: enabled && attempt.failed })
    }

    fn wire(&mut self, walk: &mut Walk, wire: &Wire, attempt: &mut Attempt) -> Result<Value, Leave> {
        match wire {
            Wire::Value(expression) => Ok(self.value(&walk.frame, expression, attempt)),
            Wire::Circuit(circuit) => Ok(Value::bool(self.circuit(walk, circuit, true)?)),
        }
    }

    fn pins(&mut self, walk: &Walk, call: &Call, attempt: &mut Attempt) -> Pins {
        match &call.callee {
            Callee::Standard(block, place) => {
                let storage = self.locate(&walk.frame, place, attempt);
                let instance = storage.block().borrow();
                let outputs = instance.outputs.iter().zip(block.outputs());
                Pins {
                    inputs: instance.inputs.iter().cloned().map(Storage::Value).collect(),
                    outputs: outputs
                        .map(|(register, pin)| (Storage::Value(register.clone()), Type::Elementary(pin.ty)))
                        .collect(),
                    frame: Frame::default(),
                }
            }
            Callee::Unit(unit, place) => {
                let storage = self.locate(&walk.frame, place, attempt);
                self.pins_of(*unit, storage.unit().clone())
            }
            Callee::Function(_, ty) => {
                let mut inputs = vec![Storage::Nowhere; call.inputs.len()];
                for input in &call.inputs {
                    let ty = match &input.wire {
                        Wire::Value(expression) => expression.ty,
                        Wire::Circuit(_) => Elementary::Bool,
                    };
                    inputs[input.pin] = Storage::Value(Register::new(Value::default_of(ty)));
                }
                let output = Storage::Value(Register::new(Value::default_of(*ty)));
                Pins { inputs, outputs: vec![(output, Type::Elementary(*ty))], frame: Frame::default() }
            }
            Callee::UserFunction(unit) => {
                let frame = self.fresh(*unit);
                self.pins_of(*unit, frame)
            }
        }
    }

    fn pins_of(&self, unit: UnitId, frame: Frame) -> Pins {
        let unit = self.checked.unit(unit);
        let of = |id: &VariableId| frame.get(*id).expect("a pin is one of the unit's variables").clone();
        let inputs = unit.inputs.iter().map(of).collect();
        let outputs = unit.outputs.iter().map(|id| (of(id), self.checked.variable(*id).ty)).collect();
        Pins { inputs, outputs, frame }
    }

    /// Runs what is called.
    fn execute(&mut self, walk: &Walk, call: &Call, pins: &Pins, attempt: &mut Attempt) {
        let frame = &walk.frame;
        match &call.callee {
            Callee::Standard(_, place) => {
                let storage = self.locate(frame, place, attempt);
                for (pin, place) in &call.references {
                    let registers = self.behind(frame, place, attempt);
                    storage.block().borrow_mut().references[*pin] = registers;
                }
                storage.block().borrow_mut().execute(self.now);
            }
            Callee::Unit(unit, _) => {
                let references = self.references(frame, *unit, call, attempt);
                self.run(*unit, &pins.frame.with(&references));
            }
            Callee::Function(function, ty) => {
                let inputs = pins.inputs.iter().map(|input| input.values()[0].get());
                let result = function::call(*function, *ty, &inputs.collect::<Vec<Value>>());
                pins.outputs[0].0.write(result);
            }
            Callee::UserFunction(unit) => {
                let references = self.references(frame, *unit, call, attempt);
                self.run(*unit, &pins.frame.with(&references));
            }
        }
    }

    /// What the references of a unit stand for in a call.
    fn references(
        &mut self,
        frame: &Frame,
        unit: UnitId,
        call: &Call,
        attempt: &mut Attempt,
    ) -> Vec<(VariableId, Storage)> {
        let references = &self.checked.unit(unit).references;
        let located = call.references.iter().map(|(pin, place)| (references[*pin], self.locate(frame, place, attempt)));
        located.collect()
    }

    /// The variables of a function for one call. No two calls can be told apart, for there are no memories in functions.
    fn fresh(&mut self, unit: UnitId) -> Frame {
        self.frame(self.checked.unit(unit).variables(), &[]).numbered(FrameId::default())
    }

    /// What a function gives for its inputs. If it is not executed, it writes nothing elsewhere.
    pub(super) fn result(
        &mut self,
        unit: UnitId,
        inputs: &[Option<Value>],
        references: Vec<Storage>,
        executed: bool,
    ) -> Value {
        let frame = self.fresh(unit);
        let pins = self.pins_of(unit, frame);
        for (input, value) in pins.inputs.iter().zip(inputs) {
            if let Some(value) = value {
                input.write(*value);
            }
        }
        let references: Vec<_> = self.checked.unit(unit).references.iter().copied().zip(references).collect();
        let muted = self.muted;
        self.muted |= !executed;
        self.run(unit, &pins.frame.with(&references));
        self.muted = muted;
        pins.values().next().expect("only a function with a result, which is a value, is an operand")
    }
}

/// Whether it is a box that divides integers, and divided by zero.
fn divides_by_zero(call: &Call, pins: &Pins) -> bool {
    use StandardFunction::{Divide, Modulo};
    match &call.callee {
        Callee::Function(Function::Standard(Divide | Modulo), ty) => {
            ty.is_integer() && number(pins.inputs[1].read(*ty)) == 0
        }
        _ => false,
    }
}

/// What a coverage table calls a call.
fn kind(oracle: &Oracle, call: &Call) -> String {
    match &call.callee {
        Callee::Standard(block, _) if call.power_input.is_none() => format!("{} with EN", block.name()),
        Callee::Standard(block, _) => block.name().to_owned(),
        Callee::Unit(unit, _) if oracle.checked.unit(*unit).references.is_empty() => "own block".to_owned(),
        Callee::Unit(..) => "own block with references".to_owned(),
        Callee::Function(Function::Standard(function), _) => format!("box {}", function.name()),
        Callee::Function(..) => "box that converts".to_owned(),
        Callee::UserFunction(_) => "box of an own function".to_owned(),
    }
}
