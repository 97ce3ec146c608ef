//! A slot for everything that a scan leaves behind: variables, pins, what blocks and edges remember.
//!
//! Names of slots must depend on nothing but the names in the program and the place within a rung, so that an edit
//! elsewhere moves no slot.

use std::collections::{HashMap, HashSet};

use super::blocks;
use super::observe::Observer;
use super::storage::{BlockCells, Cells, Frame, Slots, Storage};
use super::used::Used;
use crate::check::{ArrayType, Checked, Initial, PinId, Step, Type, UnitId, UnitKind, Variable, VariableId};
use crate::elementary::{Elementary, Value};
use crate::ladder::library::StandardBlock;
use crate::ladder::{self, VariableClass};
use crate::logic::image::{EarlierLayout, ImageTooLarge};
use crate::logic::{Area, Layout, LayoutBuilder, Slot, SlotId};
use crate::source::Span;

/// Gives every slot its name and place.
pub(super) fn allocate(
    checked: &Checked,
    line: impl Fn(Span) -> u32,
    earlier: Option<&EarlierLayout>,
) -> Result<(Slots, Layout), ImageTooLarge> {
    let used = Used::find(checked);
    let mut allocator = Allocator {
        checked,
        used: &used,
        line: &line,
        layout: LayoutBuilder::new(),
        names: HashSet::new(),
        located: HashMap::new(),
    };
    let none = |prefix: &str| Owner::top(prefix.to_owned());
    let globals = allocator.frame(checked.globals(), &none(""));
    allocator.observe(checked.globals(), &globals, "");
    let mut programs = Vec::new();
    for program in checked.programs() {
        let several = checked.programs().len() > 1;
        let prefix = if several { format!("{}.", program.name) } else { String::new() };
        let frame = allocator.unit(program.unit, &none(&prefix));
        allocator.observe(checked.unit(program.unit).variables(), &frame, &prefix);
        programs.push(frame);
    }
    let mut functions = HashMap::new();
    for (unit, id) in checked.units().iter().zip(0..).map(|(unit, id)| (unit, UnitId(id))) {
        if matches!(unit.kind, UnitKind::Function { .. }) && used.functions.contains(&id) {
            let owner = Owner { area: Some(Area::State), ..none(&format!("#{}.", unit.name)) };
            functions.insert(id, allocator.unit(id, &owner));
        }
    }
    let jump = used.jump.map(|span| allocator.hidden("#jump", Elementary::Udint, line(span)));
    let fault = used.computed_index.then(|| allocator.hidden("#fault", Elementary::Bool, 0));
    let due = |task: &crate::check::Task| {
        task.interval.map(|_| allocator.hidden(&format!("#task {}", task.name), Elementary::Time, line(task.span)))
    };
    let due = checked.tasks().iter().map(due).collect();
    let Allocator { layout, located, .. } = allocator;
    Ok((Slots { globals, located, programs, functions, due, jump, fault }, layout.finish(earlier)?))
}

/// What owns variables: once, or an element of an array each time.
struct Owner<'a> {
    /// What stands before each name.
    prefixes: Vec<String>,
    /// What each was given to start with.
    initials: Vec<&'a Initial>,
    /// Whether the owner is part of an array.
    array: bool,
    /// Where its variables lie; else each where its class says.
    area: Option<Area>,
    /// Whether all that it has is retained.
    retain: bool,
}

impl Owner<'_> {
    fn top(prefix: String) -> Self {
        Self { prefixes: vec![prefix], initials: vec![&Initial::Default], array: false, area: None, retain: false }
    }
}

/// A variable or part of one; or one part of each element of an array.
struct Part<'a> {
    names: Vec<String>,
    initials: Vec<&'a Initial>,
    array: bool,
    area: Area,
    retain: bool,
    line: u32,
    /// The variable, and the members on the way from there.
    declaration: (VariableId, Vec<usize>),
}

impl<'a> Part<'a> {
    /// A member of each.
    fn member(&self, name: &str, step: &Step, otherwise: &'a Initial) -> Self {
        Self {
            names: self.names.iter().map(|owner| format!("{owner}{name}")).collect(),
            initials: self.initials.iter().map(|initial| given(initial, step).unwrap_or(otherwise)).collect(),
            declaration: self.declaration.clone(),
            ..*self
        }
    }

    /// The elements of each.
    fn elements(&self, array: &ArrayType) -> Self {
        let mut part = Self {
            names: Vec::new(),
            initials: Vec::new(),
            array: true,
            declaration: self.declaration.clone(),
            ..*self
        };
        for (owner, initial) in self.names.iter().zip(&self.initials) {
            for (place, index) in (0..).zip(indices(array)) {
                part.names.push(format!("{owner}[{index}]"));
                part.initials.push(match initial {
                    Initial::Elements(elements) => elements.get(place).unwrap_or(&Initial::Default),
                    _ => &Initial::Default,
                });
            }
        }
        part
    }
}

/// What a structure's or instance's initial value says of one member.
fn given<'a>(initial: &'a Initial, step: &Step) -> Option<&'a Initial> {
    let Initial::Members(members) = initial else { return None };
    members.iter().find(|(member, _)| member == step).map(|(_, initial)| initial)
}

/// The indices of an array's elements in order, as they are written.
pub(super) fn indices(array: &ArrayType) -> impl Iterator<Item = String> {
    (0..array.count()).map(|place| {
        let mut rest = place;
        let mut numbers: Vec<String> = (array.dimensions.iter().rev())
            .map(|dimension| {
                let number = dimension.first.saturating_add(i64::from(rest % dimension.count));
                rest /= dimension.count;
                number.to_string()
            })
            .collect();
        numbers.reverse();
        numbers.join(",")
    })
}

struct Allocator<'a> {
    checked: &'a Checked,
    used: &'a Used,
    line: &'a dyn Fn(Span) -> u32,
    layout: LayoutBuilder,
    names: HashSet<String>,
    located: HashMap<VariableId, Storage>,
}

impl<'a> Allocator<'a> {
    /// The variables and edges of a unit.
    fn unit(&mut self, id: UnitId, owner: &Owner<'a>) -> Frame {
        let unit = self.checked.unit(id);
        let mut frame = self.frame(unit.variables(), owner);
        for (rung, count) in unit.rungs.iter().zip(&self.used.edges[id.index()]) {
            for number in 1..=*count {
                let part = Part {
                    names: owner.prefixes.iter().map(|prefix| format!("{prefix}{}#{number}", rung.label)).collect(),
                    initials: vec![&Initial::Default; owner.prefixes.len()],
                    array: owner.array,
                    area: Area::State,
                    retain: owner.retain,
                    line: (self.line)(rung.span),
                    declaration: (VariableId(0), Vec::new()),
                };
                let initials = vec![Value::bool(false); owner.prefixes.len()];
                frame.edges.push(self.cells(&part, Elementary::Bool, initials));
            }
        }
        frame
    }

    /// Variables side by side.
    fn frame(&mut self, variables: impl Iterator<Item = VariableId>, owner: &Owner<'a>) -> Frame {
        let variables = variables.filter_map(|id| Some((id, self.variable(id, owner)?))).collect();
        Frame { variables, edges: Vec::new() }
    }

    /// `None` for one that has no storage of its own.
    fn variable(&mut self, id: VariableId, owner: &Owner<'a>) -> Option<Storage> {
        let variable = self.checked.variable(id);
        if variable.class == VariableClass::InOut {
            return None;
        }
        let step = Step::Variable(id);
        let part = Part {
            names: owner.prefixes.iter().map(|prefix| format!("{prefix}{}", variable.name)).collect(),
            initials: owner.initials.iter().map(|initial| given(initial, &step).unwrap_or(&variable.initial)).collect(),
            array: owner.array,
            area: owner.area.unwrap_or_else(|| area_of(variable)),
            retain: (owner.retain || variable.retain) && variable.class != VariableClass::Temporary,
            line: (self.line)(variable.span),
            declaration: (id, Vec::new()),
        };
        if variable.address.is_none() {
            return Some(self.storage(variable.ty, part));
        }
        let first = first_at_address(self.checked, id);
        if !self.located.contains_key(&first) {
            let storage = self.storage(variable.ty, part);
            self.located.insert(first, storage);
        }
        None
    }

    fn storage(&mut self, ty: Type, part: Part<'a>) -> Storage {
        match ty {
            Type::Elementary(ty) => {
                let initials = part.initials.iter().map(|initial| initial.value(ty)).collect();
                Storage::Value(self.cells(&part, ty, initials))
            }
            Type::Array(array) => {
                let array = self.checked.array(array);
                Storage::Array(Box::new(self.storage(array.element, part.elements(array))))
            }
            Type::Structure(structure) => {
                let fields = &self.checked.structure(structure).fields;
                let members = fields.iter().enumerate().map(|(place, field)| {
                    let mut member = part.member(&format!(".{}", field.name), &Step::Field(place), &field.initial);
                    member.declaration.1.push(place);
                    self.storage(field.ty, member)
                });
                Storage::Structure(members.collect())
            }
            Type::Block(block) => Storage::Block(self.block(block, &Part { area: Area::State, ..part })),
            Type::Unit(unit) => {
                let prefixes = part.names.into_iter().map(|name| name + ".").collect();
                let Part { initials, array, retain, .. } = part;
                Storage::Unit(self.unit(unit, &Owner { prefixes, initials, array, area: Some(Area::State), retain }))
            }
        }
    }

    fn block(&mut self, block: StandardBlock, part: &Part<'a>) -> BlockCells {
        let pin = |allocator: &mut Self, id: PinId, pin: &ladder::library::Pin| {
            let of = part.member(&format!(".{}", pin.name), &Step::Pin(id), &Initial::Default);
            let initial = |initial: &&Initial| match initial {
                Initial::Value(value) => *value,
                _ => pin.initial_value(),
            };
            let initials = of.initials.iter().map(initial).collect();
            allocator.cells(&of, pin.ty, initials)
        };
        let outputs =
            block.outputs().iter().enumerate().map(|(place, of)| pin(self, PinId::Output(place), of)).collect();
        let inputs = block.inputs().iter().enumerate();
        let inputs = inputs
            .map(|(place, of)| {
                let kept = self.used.keeps(&part.declaration, place);
                kept.then(|| pin(self, PinId::Input(place), of))
            })
            .collect();
        let states = blocks::rule(block).states.iter().map(|(name, ty)| {
            let of = Part {
                names: part.names.iter().map(|owner| format!("{owner}#{name}")).collect(),
                initials: Vec::new(),
                declaration: part.declaration.clone(),
                ..*part
            };
            self.cells(&of, *ty, vec![Value::default_of(*ty); part.names.len()])
        });
        BlockCells { states: states.collect(), inputs, outputs }
    }

    fn cells(&mut self, part: &Part<'_>, ty: Elementary, initials: Vec<Value>) -> Cells {
        let mut first = None;
        for (name, initial) in part.names.iter().zip(initials) {
            let name = self.unique(name.clone());
            let Part { area, retain, line, .. } = *part;
            let slot = self.layout.slot(Slot { name: name.into(), ty, offset: 0, area, retain, initial, line });
            first.get_or_insert(slot);
        }
        let first = first.unwrap_or_else(|| unreachable!("an array has at least one element"));
        let count = u32::try_from(part.names.len()).unwrap_or(u32::MAX);
        Cells { first, count, array: part.array.then(|| self.layout.array(first, count)) }
    }

    fn hidden(&mut self, name: &str, ty: Elementary, line: u32) -> SlotId {
        let (name, initial) = (self.unique(name.to_owned()), Value::default_of(ty));
        self.layout.slot(Slot { name: name.into(), ty, offset: 0, area: Area::State, retain: false, initial, line })
    }

    /// The name itself, or with primes behind it: a foreign name may hold the marks that set slots of a block apart.
    fn unique(&mut self, mut name: String) -> String {
        while !self.names.insert(name.clone()) {
            name.push('\'');
        }
        name
    }

    /// Makes variables side by side watchable.
    fn observe(&mut self, variables: impl Iterator<Item = VariableId>, frame: &Frame, prefix: &str) {
        let Self { checked, located, layout, .. } = self;
        let mut observer = Observer { checked, located, layout };
        for id in variables {
            observer.variable(id, frame, 0, prefix);
        }
    }
}

/// Where a variable lies that no owner's area says it of.
fn area_of(variable: &Variable) -> Area {
    match (&variable.address, variable.class) {
        (Some(address), _) => match address.area {
            ladder::Area::Input => Area::Input,
            ladder::Area::Output => Area::Output,
            ladder::Area::Memory => Area::Memory,
        },
        (None, VariableClass::Input) => Area::Input,
        (None, VariableClass::Output) => Area::Output,
        (None, VariableClass::Memory | VariableClass::Constant | VariableClass::InOut | VariableClass::Temporary) => {
            Area::Memory
        }
    }
}

/// The first of the variables that share the storage of one at an address.
pub(super) fn first_at_address(checked: &Checked, id: VariableId) -> VariableId {
    let mut first = id;
    while let Some(earlier) = checked.variable(first).shares {
        first = earlier;
    }
    first
}
