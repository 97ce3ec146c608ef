//! The names of a program and what they stand for. Names are looked up without regard to case; nothing outside of
//! this module may compare spellings.

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};

use lean_string::LeanString;

use super::address::Extent;
use super::model::{UnitId, Variable, VariableId};
use super::spelling::{self, Budget};
use crate::ladder::{Name, key};

/// One variable or instance.
pub(super) struct Entry {
    pub(super) variable: Variable,
    pub(super) state: State,
    /// The unit that it belongs to; none for a global one.
    pub(super) unit: Option<UnitId>,
    /// Whether its initial value was written down.
    pub(super) explicit_initial: bool,
    /// Whether anything names it.
    pub(super) mentioned: bool,
}

/// How much of a variable is known.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum State {
    /// All of it.
    Known,
    /// All but the initial value, which is computed later.
    Pending,
    /// Its type, or a constant's value, could not be made out; that was reported, and its uses are not.
    Broken,
}

/// [`key`], without a copy where the name is its own key, as most are.
pub(super) fn folded(name: &str) -> Cow<'_, str> {
    let is_key = |byte: u8| byte.is_ascii() && !byte.is_ascii_uppercase();
    if name.bytes().all(is_key) { Cow::Borrowed(name) } else { Cow::Owned(key(name)) }
}

/// Every name, address and variable.
#[derive(Default)]
pub(super) struct Scope {
    entries: Vec<Entry>,
    globals: HashMap<LeanString, VariableId>,
    /// The names of each unit.
    units: Vec<HashMap<LeanString, VariableId>>,
    /// The unit whose names count now.
    unit: Option<UnitId>,
    /// The first variable at each address, whose storage later ones share.
    pub(super) addresses: HashMap<Extent, VariableId>,
    /// The undeclared names that were reported; each is once.
    unknown: HashSet<String>,
    budget: Budget,
}

impl Scope {
    /// From here on names are those of a unit, before the global ones; without a unit the global ones only.
    pub(super) fn enter(&mut self, unit: Option<UnitId>) {
        self.unit = unit;
        if let Some(unit) = unit
            && self.units.len() <= unit.index()
        {
            self.units.resize_with(unit.index() + 1, HashMap::new);
        }
    }

    /// The unit whose names count now.
    pub(super) fn unit(&self) -> Option<UnitId> {
        self.unit
    }

    /// The variable of that name: of the unit, else the global one.
    pub(super) fn find(&self, name: &Name) -> Option<VariableId> {
        let key = folded(&name.text);
        let own = self.unit.and_then(|unit| self.units[unit.index()].get(key.as_ref()));
        own.or_else(|| self.globals.get(key.as_ref())).copied()
    }

    /// A global variable, by its name.
    pub(super) fn find_global(&self, name: &str) -> Option<VariableId> {
        self.globals.get(folded(name).as_ref()).copied()
    }

    /// A variable of a unit, by its name.
    pub(super) fn find_in(&self, unit: UnitId, name: &str) -> Option<VariableId> {
        self.units.get(unit.index())?.get(folded(name).as_ref()).copied()
    }

    /// Adds a variable under its name. Where there is one of that name already, `Err` is that one.
    pub(super) fn add(&mut self, variable: Variable, state: State) -> Result<VariableId, VariableId> {
        let next = self.next_id();
        let names = match self.unit {
            Some(unit) => &mut self.units[unit.index()],
            None => &mut self.globals,
        };
        let first = *names.entry(folded(&variable.name).into()).or_insert(next);
        if first == next { Ok(self.add_nameless(variable, state)) } else { Err(first) }
    }

    /// Adds a variable that is found by its address only.
    pub(super) fn add_nameless(&mut self, variable: Variable, state: State) -> VariableId {
        let id = self.next_id();
        let unit = self.unit;
        self.entries.push(Entry { variable, state, unit, explicit_initial: false, mentioned: false });
        id
    }

    pub(super) fn next_id(&self) -> VariableId {
        // A declaration takes more than a byte of a source, so that 32 bits are enough.
        VariableId(u32::try_from(self.entries.len()).unwrap_or(u32::MAX))
    }

    pub(super) fn entry(&self, id: VariableId) -> &Entry {
        &self.entries[id.index()]
    }

    pub(super) fn entry_mut(&mut self, id: VariableId) -> &mut Entry {
        &mut self.entries[id.index()]
    }

    pub(super) fn ids(&self) -> impl Iterator<Item = VariableId> + use<> {
        (0..self.next_id().0).map(VariableId)
    }

    /// The variable whose storage a variable uses: the first at its address, or itself.
    pub(super) fn storage(&self, id: VariableId) -> VariableId {
        self.entry(id).variable.shares.unwrap_or(id)
    }

    /// Whether this is the first time that an undeclared name is met.
    pub(super) fn first_unknown(&mut self, name: &Name) -> bool {
        self.unknown.insert(name.key())
    }

    /// The declared name nearest to one that is not declared.
    pub(super) fn suggest(&mut self, name: &str) -> Option<&str> {
        let unit = self.unit;
        let visible = self.entries.iter().filter(|entry| entry.unit.is_none() || entry.unit == unit);
        let candidates = visible.map(|entry| entry.variable.name.as_str());
        spelling::nearest(name, candidates, &mut self.budget)
    }

    /// The nearest of other names, at the same budget.
    pub(super) fn suggest_among<'a>(&mut self, name: &str, names: impl Iterator<Item = &'a str>) -> Option<&'a str> {
        spelling::nearest(name, names, &mut self.budget)
    }

    /// All variables, and which of them are global.
    pub(super) fn into_variables(self) -> (Vec<Variable>, Vec<VariableId>) {
        let globals = self.ids().filter(|id| self.entry(*id).unit.is_none()).collect();
        (self.entries.into_iter().map(|entry| entry.variable).collect(), globals)
    }
}
