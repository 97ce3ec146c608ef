//! Lists of global variables with names of their own, as CODESYS and its kin have them: `GVL.x` is the global variable `x`.

use std::collections::{HashMap, HashSet};

use super::rewrite;
use crate::ladder::{Program, Reference, Root, Step, Variable, key};

/// The lists, by name.
#[derive(Default)]
pub(super) struct GlobalLists {
    lists: HashMap<String, HashSet<String>>,
}

impl GlobalLists {
    /// Notes what a list declares; parts of one list may come one by one.
    pub(super) fn add(&mut self, list: &str, variables: &[Variable]) {
        let names = self.lists.entry(key(list)).or_default();
        names.extend(variables.iter().map(|variable| variable.name.key()));
    }

    /// Makes variables of what goes by the name of its list. A name that a unit declares itself stands for that.
    pub(super) fn resolve(&self, program: &mut Program) {
        if self.lists.is_empty() {
            return;
        }
        let globals: HashSet<String> = program.globals.iter().map(|variable| variable.name.key()).collect();
        for unit in &mut program.units {
            let own: HashSet<String> = unit.variables.iter().map(|variable| variable.name.key()).collect();
            let mut resolve = |reference: &mut Reference| {
                let Root::Name(list) = &reference.root else { return };
                let list = list.key();
                let Some(Step::Member(member)) = reference.steps.first() else { return };
                let is_list = !own.contains(&list) && !globals.contains(&list);
                // What hides the global under its own name would be meant instead.
                let is_seen = !own.contains(&member.key());
                if is_list && is_seen && self.lists.get(&list).is_some_and(|names| names.contains(&member.key())) {
                    reference.root = Root::Name(member.clone());
                    reference.steps.remove(0);
                }
            };
            for rung in &mut unit.rungs {
                rewrite::references(&mut rung.circuit, &mut resolve);
            }
        }
    }
}
