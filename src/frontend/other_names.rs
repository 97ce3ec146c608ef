//! Pins of standard blocks under the names that some tools have for them: `RESET` of a counter is its `R`.

use std::collections::HashMap;

use super::rewrite::{self, Change};
use crate::ladder::library::StandardBlock;
use crate::ladder::{BlockCall, Name, Origin, Program, Reference, Root, Step, Variable};

/// Spells the pins of standard blocks in calls and members as the standard does. In native text a pin that there is not is a
/// mistake.
pub(super) fn settle(program: &mut Program) {
    if program.origin == Origin::Native {
        return;
    }
    let own: Vec<String> = program.units.iter().map(|unit| unit.name.key()).collect();
    let block = |ty: &Name| {
        let is_own = || own.contains(&ty.key());
        StandardBlock::from_name(&ty.text).filter(|_| !is_own())
    };
    let instances = |variables: &[Variable]| -> HashMap<String, StandardBlock> {
        let types = variables.iter().filter_map(|variable| Some((variable.name.key(), variable.ty.as_ref()?)));
        types.filter_map(|(name, ty)| Some((name, block(&ty.name)?))).collect()
    };
    let globals = instances(&program.globals);
    for unit in &mut program.units {
        let mut speller = Speller { globals: &globals, own: instances(&unit.variables), of_type: &block };
        unit.rungs.iter_mut().for_each(|rung| rewrite::references(&mut rung.circuit, &mut speller));
    }
}

struct Speller<'g> {
    globals: &'g HashMap<String, StandardBlock>,
    own: HashMap<String, StandardBlock>,
    /// The standard block of a name of a type.
    of_type: &'g dyn Fn(&Name) -> Option<StandardBlock>,
}

impl Speller<'_> {
    fn block(&self, root: &Root) -> Option<StandardBlock> {
        let Root::Name(name) = root else { return None };
        let name = name.key();
        self.own.get(&name).or_else(|| self.globals.get(&name)).copied()
    }
}

impl Change for Speller<'_> {
    fn reference(&mut self, reference: &mut Reference) {
        let Some(Step::Member(_)) = reference.steps.first() else { return };
        let Some(block) = self.block(&reference.root) else { return };
        for step in &mut reference.steps {
            if let Step::Member(member) = step
                && let Some(pin) = block.input_called(&member.text)
            {
                member.text = pin.into();
            }
        }
    }

    fn call(&mut self, call: &mut BlockCall) {
        // A call may declare its instance.
        let named = call.type_name.as_ref().map(|ty| (self.of_type)(ty));
        let Some(block) = named.unwrap_or_else(|| self.block(&call.instance.root)) else { return };
        for argument in &mut call.arguments {
            if let Some(pin) = block.input_called(&argument.pin.text) {
                argument.pin.text = pin.into();
            }
        }
    }
}
