//! What variables are made of: values that stand where they are for as long as the program runs, so that two names can
//! stand for one.

use std::cell::{Cell, RefCell};
use std::hash::{Hash, Hasher};
use std::rc::Rc;

use rung::check::{Initial, PinId, Step, Type, VariableId};
use rung::elementary::{Elementary, Value};
use rung::ladder::VariableClass;

use super::Oracle;
use super::block::Instance;

/// One value. A clone is the same one.
#[derive(Clone, Debug)]
pub(crate) struct Register(Rc<Cell<Value>>);

/// Two that hold the same are not therefore one.
impl PartialEq for Register {
    fn eq(&self, other: &Self) -> bool {
        Rc::ptr_eq(&self.0, &other.0)
    }
}

impl Eq for Register {}

impl Hash for Register {
    fn hash<H: Hasher>(&self, state: &mut H) {
        Rc::as_ptr(&self.0).hash(state);
    }
}

impl Register {
    /// One that starts with a value, and stays of its type.
    pub(crate) fn new(value: Value) -> Self {
        Self(Rc::new(Cell::new(value)))
    }

    /// What it holds.
    pub(crate) fn get(&self) -> Value {
        self.0.get()
    }

    /// Gives it the bits of a value. Two types at one address are two views of the same bits.
    pub(crate) fn set(&self, value: Value) {
        self.0.set(Value::from_bits(self.get().ty(), value.bits()));
    }
}

/// The storage of a variable, or of a part of one. A clone is the same one.
#[derive(Clone, Debug)]
pub(super) enum Storage {
    Value(Register),
    /// One bit of a value.
    Bit(Register, u8),
    /// The elements of an array, or the members of a structure.
    Parts(Rc<[Storage]>),
    Block(Rc<RefCell<Instance>>),
    Unit(Frame),
    /// Where an index out of range leads.
    Nowhere,
}

/// Which frame, among those that remember something.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Default, Debug)]
pub(super) struct FrameId(pub(super) u32);

/// The variables of a program or an instance, of one call of a function, or the global ones.
#[derive(Clone, Debug, Default)]
pub(super) struct Frame {
    pub(super) id: FrameId,
    /// In order of the variables.
    variables: Rc<[(VariableId, Storage)]>,
}

impl Frame {
    /// The storage of a variable, if it is one of these.
    pub(super) fn get(&self, id: VariableId) -> Option<&Storage> {
        let place = self.variables.binary_search_by_key(&id, |(variable, _)| *variable).ok()?;
        Some(&self.variables[place].1)
    }

    /// The same under another number.
    pub(super) fn numbered(self, id: FrameId) -> Self {
        Self { id, ..self }
    }

    /// The same, where some variables stand for what the caller says.
    pub(super) fn with(&self, references: &[(VariableId, Storage)]) -> Self {
        let given = |id| references.iter().find(|(variable, _)| *variable == id).map(|(_, storage)| storage.clone());
        let variables = self.variables.iter().map(|(id, own)| (*id, given(*id).unwrap_or_else(|| own.clone())));
        Self { id: self.id, variables: variables.collect() }
    }

    /// Every value in it.
    pub(super) fn values(&self) -> Vec<Register> {
        self.variables.iter().flat_map(|(_, storage)| storage.values()).collect()
    }
}

impl Storage {
    /// The value here, seen as one of a type.
    pub(super) fn read(&self, ty: Elementary) -> Value {
        match self {
            Self::Value(register) => Value::from_bits(ty, register.get().bits()),
            Self::Bit(register, bit) => Value::bool(register.get().bits() >> bit & 1 == 1),
            Self::Nowhere => Value::default_of(ty),
            Self::Parts(_) | Self::Block(_) | Self::Unit(_) => panic!("{self:?} has no value"),
        }
    }

    /// Puts a value here.
    pub(super) fn write(&self, value: Value) {
        match self {
            Self::Value(register) => register.set(value),
            Self::Bit(register, bit) => {
                let old = register.get();
                let others = old.bits() & !(1 << bit);
                register.set(Value::from_bits(old.ty(), others | u64::from(value.is_true()) << bit));
            }
            Self::Nowhere => {}
            Self::Parts(_) | Self::Block(_) | Self::Unit(_) => panic!("{self:?} holds no value"),
        }
    }

    /// Gives every value here that of another storage of the same type; what is nowhere is all zeros.
    pub(super) fn copy(&self, source: &Self) {
        let targets = self.values();
        let sources: Vec<u64> = match source {
            Self::Nowhere => vec![0; targets.len()],
            _ => source.values().iter().map(|register| register.get().bits()).collect(),
        };
        for (target, bits) in targets.iter().zip(sources) {
            target.set(Value::from_bits(target.get().ty(), bits));
        }
    }

    /// Every value in it, in order; of a bit the value that it is in.
    pub(super) fn values(&self) -> Vec<Register> {
        match self {
            Self::Value(register) | Self::Bit(register, _) => vec![register.clone()],
            Self::Parts(parts) => parts.iter().flat_map(Self::values).collect(),
            Self::Block(instance) => {
                let instance = instance.borrow();
                instance.inputs.iter().chain(&instance.outputs).cloned().collect()
            }
            Self::Unit(frame) => frame.values(),
            Self::Nowhere => Vec::new(),
        }
    }

    /// An element or member, by its place.
    pub(super) fn part(&self, place: usize) -> Self {
        match self {
            Self::Parts(parts) => parts[place].clone(),
            Self::Nowhere => Self::Nowhere,
            _ => panic!("{self:?} has no parts"),
        }
    }

    /// A pin of a standard block.
    pub(super) fn pin(&self, pin: PinId) -> Self {
        let instance = self.block().borrow();
        Self::Value(match pin {
            PinId::Input(place) => instance.inputs[place].clone(),
            PinId::Output(place) => instance.outputs[place].clone(),
        })
    }

    pub(super) fn block(&self) -> &Rc<RefCell<Instance>> {
        let Self::Block(instance) = self else { panic!("{self:?} is no instance of a standard block") };
        instance
    }

    pub(super) fn unit(&self) -> &Frame {
        let Self::Unit(frame) = self else { panic!("{self:?} is no instance of a function block") };
        frame
    }
}

impl Oracle<'_> {
    /// Storage for variables side by side, each with what it starts with; `given` says that of some.
    pub(super) fn frame(&mut self, variables: impl Iterator<Item = VariableId>, given: &[(Step, Initial)]) -> Frame {
        self.frames += 1;
        let id = FrameId(self.frames);
        let storage = |id: VariableId| {
            let initial = starts_with(given, &Step::Variable(id)).unwrap_or(&self.checked.variable(id).initial);
            (id, self.variable(id, initial))
        };
        let mut variables: Vec<(VariableId, Storage)> = variables.map(storage).collect();
        variables.sort_by_key(|(id, _)| *id);
        Frame { id, variables: variables.into() }
    }

    /// The storage of a new variable; of one at an address that of the first variable there.
    fn variable(&mut self, id: VariableId, initial: &Initial) -> Storage {
        let mut first = id;
        while let Some(earlier) = self.checked.variable(first).shares {
            first = earlier;
        }
        let variable = self.checked.variable(first);
        if variable.class == VariableClass::InOut {
            return Storage::Nowhere;
        }
        if variable.address.is_none() {
            return self.storage(variable.ty, initial);
        }
        if let Some(storage) = self.located.get(&first) {
            return storage.clone();
        }
        let storage = self.storage(variable.ty, &variable.initial);
        self.located.insert(first, storage.clone());
        storage
    }

    /// New storage of a type.
    pub(super) fn storage(&mut self, ty: Type, initial: &Initial) -> Storage {
        let members = match initial {
            Initial::Members(members) => members.as_slice(),
            _ => &[],
        };
        let checked = self.checked;
        match ty {
            Type::Elementary(ty) => Storage::Value(Register::new(initial.value(ty))),
            Type::Array(array) => {
                let array = checked.array(array);
                let element = |place: usize| match initial {
                    Initial::Elements(elements) => &elements[place],
                    _ => &Initial::Default,
                };
                Storage::Parts(
                    (0..array.count() as usize).map(|place| self.storage(array.element, element(place))).collect(),
                )
            }
            Type::Structure(structure) => {
                let fields = checked.structure(structure).fields.iter().enumerate();
                let storage = fields.map(|(place, field)| {
                    let initial = starts_with(members, &Step::Field(place)).unwrap_or(&field.initial);
                    self.storage(field.ty, initial)
                });
                Storage::Parts(storage.collect())
            }
            Type::Block(block) => {
                let instance = Instance::new(block);
                for (step, initial) in members {
                    match step {
                        Step::Pin(PinId::Input(place)) => {
                            instance.inputs[*place].set(initial.value(block.inputs()[*place].ty));
                        }
                        Step::Pin(PinId::Output(place)) => {
                            instance.outputs[*place].set(initial.value(block.outputs()[*place].ty));
                        }
                        _ => panic!("{step:?} is no pin"),
                    }
                }
                Storage::Block(Rc::new(RefCell::new(instance)))
            }
            Type::Unit(unit) => Storage::Unit(self.frame(checked.unit(unit).variables(), members)),
        }
    }
}

fn starts_with<'i>(members: &'i [(Step, Initial)], step: &Step) -> Option<&'i Initial> {
    members.iter().find(|(member, _)| member == step).map(|(_, initial)| initial)
}
