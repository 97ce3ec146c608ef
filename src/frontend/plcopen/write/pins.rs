//! The pins of the boxes that a unit calls: their names in order, and which take and give power.

use std::collections::HashMap;

use crate::frontend::graph::types::Signatures;
use crate::frontend::structured_text::print::is_iec;
use crate::ladder::functions::{Function, StandardFunction};
use crate::ladder::library::StandardBlock;
use crate::ladder::{BlockCall, Program, Root, Step, Unit, UnitKind, Variable, VariableClass, key};

/// What is called.
pub(super) struct Callee {
    /// The type of the block, or the name of the function.
    pub(super) name: String,
    pub(super) is_function: bool,
    /// Its inputs without EN, in order.
    pub(super) inputs: Vec<String>,
    /// Its in-out parameters.
    pub(super) in_outs: Vec<String>,
    /// Its outputs without ENO, in order.
    pub(super) outputs: Vec<String>,
    /// The input that takes the power on the left, and the output that gives that on the right, where they are not EN and ENO.
    pub(super) power_input: Option<String>,
    pub(super) power_output: Option<String>,
    /// Whether a call may touch anything global.
    pub(super) is_own: bool,
}

/// What a unit sees.
pub(super) struct Scope<'p> {
    pub(super) signatures: &'p Signatures,
    units: HashMap<String, &'p Unit>,
    /// Its own variables and the global ones.
    own: HashMap<String, &'p Variable>,
    globals: HashMap<String, &'p Variable>,
}

impl<'p> Scope<'p> {
    pub(super) fn new(program: &'p Program, unit: &'p Unit, signatures: &'p Signatures) -> Self {
        let by_name = |variables: &'p [Variable]| variables.iter().map(|one| (one.name.key(), one)).collect();
        Self {
            signatures,
            units: program.units.iter().map(|unit| (unit.name.key(), unit)).collect(),
            own: by_name(&unit.variables),
            globals: by_name(&program.globals),
        }
    }

    fn variable(&self, name: &str) -> Option<&'p Variable> {
        let name = key(name);
        self.own.get(&name).or_else(|| self.globals.get(&name)).copied()
    }

    /// The program's own unit of a name.
    pub(super) fn unit(&self, name: &str) -> Option<&'p Unit> {
        self.units.get(&key(name)).copied()
    }

    /// The name of a variable that shares its storage with no other; `None` for the others.
    pub(super) fn storage(&self, name: &str) -> Option<String> {
        let name = key(name);
        match self.own.get(&name) {
            Some(variable) if variable.address.is_some() || variable.class == VariableClass::InOut => None,
            None if self.globals.contains_key(&name) => None,
            _ => Some(name),
        }
    }
}

/// What a call calls, where that is known.
pub(super) fn callee(scope: &Scope<'_>, call: &BlockCall) -> Option<Callee> {
    let name = match &call.instance.root {
        Root::Name(name) => name,
        Root::Address(_) => return None,
    };
    let declared = scope.variable(&name.text);
    if declared.is_none() && call.type_name.is_none() {
        return function(scope, call.instance.as_name()?.text.as_str());
    }
    let ty = match &call.type_name {
        Some(ty) => ty.text.clone(),
        None => {
            let mut ty = declared?.ty.as_ref()?.name.text.clone();
            for step in &call.instance.steps {
                match step {
                    Step::Index(..) => {}
                    Step::Member(member) => {
                        let inner = scope.unit(&ty)?;
                        let variable = inner.variables.iter().find(|variable| variable.name.key() == member.key())?;
                        ty = variable.ty.as_ref()?.name.text.clone();
                    }
                    Step::Bit(..) => return None,
                }
            }
            ty
        }
    };
    let mut callee = match scope.unit(&ty) {
        Some(unit) => of_unit(unit, false),
        None => {
            // Other tools have no register machine; writing statements says so.
            let block = StandardBlock::from_name(&ty).filter(|block| is_iec(*block))?;
            let names = |pins: &[crate::ladder::library::Pin]| pins.iter().map(|pin| pin.name.to_owned()).collect();
            Callee {
                name: block.name().to_owned(),
                is_function: false,
                inputs: names(block.inputs()),
                in_outs: Vec::new(),
                outputs: names(block.outputs()),
                power_input: None,
                power_output: None,
                is_own: false,
            }
        }
    };
    callee.power_input = scope.signatures.power_input(&ty);
    callee.power_output = scope.signatures.power_output(&ty);
    Some(callee)
}

fn of_unit(unit: &Unit, is_function: bool) -> Callee {
    let of = |class: VariableClass| -> Vec<String> {
        let is_it = |variable: &&Variable| variable.class == class && variable.address.is_none();
        unit.variables.iter().filter(is_it).map(|variable| variable.name.text.to_string()).collect()
    };
    let mut outputs = of(VariableClass::Output);
    if matches!(unit.kind, UnitKind::Function { result: Some(_) }) {
        outputs.insert(0, "OUT".to_owned());
    }
    Callee {
        name: unit.name.text.to_string(),
        is_function,
        inputs: of(VariableClass::Input),
        in_outs: of(VariableClass::InOut),
        outputs,
        power_input: None,
        power_output: None,
        is_own: true,
    }
}

fn function(scope: &Scope<'_>, name: &str) -> Option<Callee> {
    if let Some(unit) = scope.unit(name) {
        return matches!(unit.kind, UnitKind::Function { .. }).then(|| of_unit(unit, true));
    }
    let inputs = match Function::from_name(name)? {
        Function::Standard(function) => function.parameters().iter().map(|one| one.name.to_owned()).collect(),
        _ => vec!["IN".to_owned()],
    };
    Some(Callee {
        name: name.to_owned(),
        is_function: true,
        inputs,
        in_outs: Vec::new(),
        outputs: vec!["OUT".to_owned()],
        power_input: None,
        power_output: None,
        is_own: false,
    })
}

/// The name of the parameter at a place of a function.
pub(super) fn parameter(name: &str, place: usize) -> String {
    let known = match Function::from_name(name) {
        Some(Function::Standard(function)) => parameter_of(function, place),
        _ => None,
    };
    known.unwrap_or_else(|| if place == 0 { "IN".to_owned() } else { format!("IN{}", place + 1) })
}

fn parameter_of(function: StandardFunction, place: usize) -> Option<String> {
    let listed = function.parameters().get(place).map(|parameter| parameter.name.to_owned());
    listed.or_else(|| function.is_extensible().then(|| format!("IN{}", place + 1)))
}
