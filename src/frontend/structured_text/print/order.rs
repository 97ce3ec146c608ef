//! The order of the units: what a unit uses stands before it, since many compilers read a file but once.

use std::collections::HashMap;

use crate::frontend::uses::{self, Use};
use crate::ladder::{Program, Unit, UnitKind};

/// The places of functions and function blocks, each behind those that it uses, and then of the programs as they stand.
pub(in crate::frontend) fn of_units(program: &Program) -> Vec<usize> {
    let is_program = |place: usize| matches!(program.units[place].kind, UnitKind::Program { .. });
    let places: HashMap<String, usize> =
        program.units.iter().enumerate().map(|(place, unit)| (unit.name.key(), place)).collect();
    let mut order = Vec::new();
    let mut seen = vec![false; program.units.len()];
    // A stack of its own: units can use each other as deep as there are units.
    for first in (0..program.units.len()).filter(|place| !is_program(*place)) {
        if std::mem::replace(&mut seen[first], true) {
            continue;
        }
        let mut stack = vec![(first, used_by(&program.units[first], &places))];
        while let Some((place, used)) = stack.last_mut() {
            match used.pop() {
                Some(next) if is_program(next) || seen[next] => {}
                Some(next) => {
                    seen[next] = true;
                    stack.push((next, used_by(&program.units[next], &places)));
                }
                None => {
                    order.push(*place);
                    stack.pop();
                }
            }
        }
    }
    order.extend((0..program.units.len()).filter(|place| is_program(*place)));
    order
}

fn used_by(unit: &Unit, places: &HashMap<String, usize>) -> Vec<usize> {
    let mut used: Vec<usize> =
        unit.variables.iter().filter_map(|variable| places.get(&variable.ty.as_ref()?.name.key()).copied()).collect();
    for rung in &unit.rungs {
        uses::circuit(&rung.circuit, &mut |mentioned| {
            let name = match mentioned {
                Use::Function(name) | Use::Block(name, _) => Some(name),
                Use::Reference(reference) => reference.as_name(),
            };
            used.extend(name.and_then(|name| places.get(&name.key()).copied()));
        });
    }
    used
}
