//! Rungs as statements, in the order in which their elements run. Power is a pending expression for as long as nothing that it reads
//! changes; what would change it first computes it into a temporary variable.

use std::collections::{BTreeMap, HashMap, HashSet};

use super::calls::{ENO_OF_INDEX, is_computed};
use super::names::Names;
use super::power::{Change, HIGHEST, Power, depends, read};
use super::words::{Words, pin};
use crate::diagnostic::{Code, Diagnostic};
use crate::elementary::Elementary;
use crate::frontend::uses;
use crate::ladder::Step;
use crate::ladder::{
    Branch, Circuit, CoilKind, ContactKind, Element, ElementKind, Expression, ExpressionKind, Name, Program, Reference,
    Root, Rung, Statement, Unit, UnitKind, Variable, VariableClass, key,
};
use crate::source::Span;

/// Writes the rungs of one unit.
pub(super) struct Rungs<'a> {
    pub(super) program: &'a Program,
    pub(super) unit: &'a Unit,
    pub(super) names: &'a mut Names,
    /// The statements so far.
    text: String,
    indent: usize,
    /// Variables that the statements need beside the declared ones: name and type.
    pub(super) variables: Vec<(String, String)>,
    /// The temporary variables, used again in each rung.
    temporaries: Vec<String>,
    used: usize,
    /// Names that this writer made, by key: nothing else changes them.
    own: HashMap<String, ()>,
    /// Power that is needed later: at the left of circuits around, and of branches before.
    live: Vec<Power>,
    /// Power at nodes.
    nodes: HashMap<String, Power>,
    /// For the place of a rung, the flag that a jump to it sets.
    skips: BTreeMap<usize, String>,
    /// Whether the rung before has a jump.
    jumped: bool,
    /// Flags that have to be off for what comes next, none of which is written as a condition yet.
    guards: Vec<String>,
    /// The keys of variables, with those that are global.
    declared: HashMap<String, &'a Variable>,
    rungs: HashMap<String, usize>,
    /// How each variable is mentioned, by key.
    pub(super) mentions: HashMap<String, Mentions>,
    /// The place of the rung that is written.
    place: usize,
    pub(super) problems: &'a mut Vec<Diagnostic>,
}

impl<'a> Rungs<'a> {
    pub(super) fn new(
        program: &'a Program,
        unit: &'a Unit,
        names: &'a mut Names,
        problems: &'a mut Vec<Diagnostic>,
    ) -> Self {
        let declared = program.globals.iter().chain(&unit.variables).map(|one| (one.name.key(), one)).collect();
        let name_of = |(place, rung): (usize, &Rung)| rung.name.as_ref().map(|name| (name.key(), place));
        let rungs = unit.rungs.iter().enumerate().filter_map(name_of).collect();
        Self {
            program,
            unit,
            names,
            text: String::new(),
            indent: 1,
            variables: Vec::new(),
            temporaries: Vec::new(),
            used: 0,
            own: HashMap::new(),
            live: Vec::new(),
            nodes: HashMap::new(),
            skips: BTreeMap::new(),
            jumped: false,
            guards: Vec::new(),
            declared,
            rungs,
            mentions: mentions(unit),
            place: 0,
            problems,
        }
    }

    /// The statements of all rungs; `before` gives what to write before each.
    pub(super) fn all(&mut self, mut before: impl FnMut(&Rung) -> String) -> String {
        let mut open: Vec<String> = Vec::new();
        for (place, rung) in self.unit.rungs.iter().enumerate() {
            let active: Vec<String> =
                self.skips.iter().filter(|(target, _)| **target > place).map(|(_, flag)| flag.clone()).collect();
            // Behind one more jump under a condition, its flag has to be looked at again.
            let jumped = std::mem::take(&mut self.jumped);
            if jumped || active != open {
                if !open.is_empty() {
                    self.close();
                }
                if !active.is_empty() {
                    let condition = off(&active);
                    self.open(&condition);
                    // A branch of IF is never empty, even if its rungs do nothing.
                    self.line(";");
                }
                open = active;
            }
            self.text.push_str(&before(rung));
            if rung.enabled {
                self.rung(place, rung);
            } else {
                // Not run, but there for whoever reads it.
                self.open("FALSE");
                let start = self.text.len();
                self.rung(place, rung);
                if self.text.len() == start {
                    self.line(";");
                }
                self.close();
            }
        }
        if !open.is_empty() {
            self.close();
        }
        let flags: String = self.skips.values().map(|flag| format!("  {flag} := FALSE;\n")).collect();
        flags + &std::mem::take(&mut self.text)
    }

    fn rung(&mut self, place: usize, rung: &Rung) {
        let indent = self.indent;
        self.used = 0;
        self.nodes.clear();
        self.live.clear();
        self.place = place;
        self.circuit(&rung.circuit, Power::Always, false);
        self.guards.clear();
        while self.indent > indent {
            self.close();
        }
    }

    fn open(&mut self, condition: &str) {
        self.text.push_str(&format!("{}IF {condition} THEN\n", "  ".repeat(self.indent)));
        self.indent += 1;
    }

    fn close(&mut self) {
        self.indent -= 1;
        self.text.push_str(&format!("{}END_IF;\n", "  ".repeat(self.indent)));
    }

    fn open_guards(&mut self) {
        if !self.guards.is_empty() {
            let condition = off(&std::mem::take(&mut self.guards));
            self.open(&condition);
        }
    }

    pub(super) fn line(&mut self, text: &str) {
        self.open_guards();
        self.text.push_str(&format!("{}{text}\n", "  ".repeat(self.indent)));
    }

    /// A statement that executes while there is power.
    pub(super) fn line_while(&mut self, power: &Power, text: &str) {
        self.line_either(power, text, None);
    }

    /// A statement that executes while there is power, and one that executes while there is none.
    pub(super) fn line_either(&mut self, power: &Power, text: &str, otherwise: Option<&str>) {
        match power {
            Power::Never => otherwise.into_iter().for_each(|otherwise| self.line(otherwise)),
            Power::Always => self.line(text),
            Power::While(condition) => {
                self.open_guards();
                let condition = self.words().expression(condition);
                self.open(&condition);
                self.line(text);
                if let Some(otherwise) = otherwise {
                    self.text.push_str(&format!("{}ELSE\n", "  ".repeat(self.indent - 1)));
                    self.line(otherwise);
                }
                self.close();
            }
        }
    }

    pub(super) fn words(&self) -> Words<'_> {
        Words { names: self.names }
    }

    pub(super) fn problem(&mut self, span: Span, message: &str) {
        self.problems.push(Diagnostic::new(Code::CannotConvert, span, message));
    }

    /// A variable of a type that nothing else uses.
    pub(super) fn fresh(&mut self, stem: &str, ty: &str) -> String {
        let name = self.names.fresh(stem);
        self.variables.push((name.clone(), ty.to_owned()));
        self.own.insert(key(&name), ());
        name
    }

    /// A BOOL that is free in this rung.
    pub(super) fn temporary(&mut self) -> String {
        if self.used == self.temporaries.len() {
            let name = self.fresh("power", "BOOL");
            self.temporaries.push(name);
        }
        self.used += 1;
        self.temporaries[self.used - 1].clone()
    }

    /// Computes power now.
    pub(super) fn computed(&mut self, power: Power) -> Power {
        let Power::While(expression) = &power else { return power };
        let value = self.words().expression(expression);
        let name = self.temporary();
        self.line(&format!("{name} := {value};"));
        Power::of_variable(&name)
    }

    fn low(&mut self, power: Power) -> Power {
        if power.height() >= HIGHEST { self.computed(power) } else { power }
    }

    pub(super) fn and(&mut self, left: Power, right: Power) -> Power {
        let (left, right) = (self.low(left), self.low(right));
        left.and(right)
    }

    pub(super) fn or(&mut self, left: Power, right: Power) -> Power {
        let (left, right) = (self.low(left), self.low(right));
        left.or(right)
    }

    fn negated(&mut self, power: Power) -> Power {
        self.low(power).negated()
    }

    /// Whether a variable shares its storage with no other.
    fn is_simple(&self, key: &str) -> bool {
        self.declared.get(key).is_some_and(|one| one.address.is_none() && one.class != VariableClass::InOut)
    }

    /// Whether power has to be computed before a change, to be used behind it.
    pub(super) fn depends(&self, power: &Power, change: &Change<'_>) -> bool {
        depends(power, change, &|key| self.is_simple(key), &|key| self.own.contains_key(key))
    }

    /// Computes what is needed later and would be changed.
    pub(super) fn spill(&mut self, change: &Change<'_>) {
        for index in 0..self.live.len() {
            if self.depends(&self.live[index], change) {
                let power = std::mem::replace(&mut self.live[index], Power::Never);
                self.live[index] = self.computed(power);
            }
        }
        let mut changed: Vec<String> =
            self.nodes.iter().filter(|(_, power)| self.depends(power, change)).map(|(node, _)| node.clone()).collect();
        changed.sort_unstable();
        for node in changed {
            let power = self.nodes.insert(node.clone(), Power::Never).unwrap_or(Power::Never);
            let power = self.computed(power);
            self.nodes.insert(node, power);
        }
    }

    /// Power that is used now and again behind the change.
    pub(super) fn held(&mut self, power: Power, change: &Change<'_>) -> Power {
        if power.is_name() && !self.depends(&power, change) { power } else { self.computed(power) }
    }

    /// The change that writing to a place makes.
    fn change(&self, target: &Reference) -> Option<String> {
        match &target.root {
            Root::Name(name) if self.is_simple(&name.key()) => Some(name.key()),
            _ => None,
        }
    }

    /// Runs `then` with power kept for later.
    pub(super) fn keeping<T>(&mut self, power: Power, then: impl FnOnce(&mut Self) -> T) -> (Power, T) {
        self.live.push(power);
        let result = then(self);
        (self.live.pop().unwrap_or(Power::Never), result)
    }

    /// Keeps power for later, until it is taken.
    pub(super) fn live_push(&mut self, power: Power) {
        self.live.push(power);
    }

    /// Takes what was kept last.
    pub(super) fn live_take(&mut self, count: usize) -> Vec<Power> {
        self.live.split_off(self.live.len().saturating_sub(count))
    }

    /// The power on the right of a circuit, if it is needed.
    pub(super) fn circuit(&mut self, circuit: &Circuit, left: Power, needed: bool) -> Power {
        if needed && conducts(circuit) {
            let (left, right) = self.keeping(left, |rungs| rungs.conducting(circuit));
            return self.and(left, right);
        }
        if let [branch] = circuit.branches.as_slice() {
            let (right, feeds) = self.branch(branch, left, needed);
            return if feeds { Power::Never } else { right };
        }
        let users = circuit.branches.iter().filter(|branch| branch.from.is_none()).count();
        let left = if users > 1 && left.height() > 2 { self.computed(left) } else { left };
        let at = self.live.len();
        self.live.push(left);
        self.live.push(Power::Never);
        for branch in &circuit.branches {
            let left = self.live[at].clone();
            let (right, feeds) = self.branch(branch, left, needed);
            if !feeds && needed {
                let before = std::mem::replace(&mut self.live[at + 1], Power::Never);
                let joined = self.or(before, right);
                self.live[at + 1] = joined;
            }
        }
        let right = self.live.pop().unwrap_or(Power::Never);
        self.live.pop();
        right
    }

    /// The power on the right of contacts and conditions alone, with power on the left.
    fn conducting(&mut self, circuit: &Circuit) -> Power {
        let mut joined = Power::Never;
        for branch in &circuit.branches {
            let mut power = Power::Always;
            for element in &branch.elements {
                let next = match &element.kind {
                    ElementKind::Parallel(inner) => self.conducting(inner),
                    _ => self.contact(element),
                };
                power = self.and(power, next);
            }
            joined = self.or(joined, power);
        }
        joined
    }

    /// What a contact or a condition lets through.
    fn contact(&mut self, element: &Element) -> Power {
        match &element.kind {
            ElementKind::Condition(condition)
                if !matches!(condition.kind, ExpressionKind::Read(_)) && {
                    let mut found = false;
                    uses::expression(condition, &mut |mentioned| found |= uses::has_computed_index(mentioned));
                    found
                } =>
            {
                // An index that is out of range takes the power away, whatever the condition comes to then.
                let (holds, in_range) = (self.temporary(), self.temporary());
                let condition = self.words().expression(condition);
                self.line(&format!("{holds} := MOVE(IN := {condition}, ENO => {in_range});"));
                Power::of_variable(&holds).and(Power::of_variable(&in_range))
            }
            ElementKind::Contact { kind: ContactKind::Open, operand } | ElementKind::Condition(operand) => {
                Power::of(operand.clone())
            }
            ElementKind::Contact { kind: ContactKind::Closed, operand } => self.negated(Power::of(operand.clone())),
            ElementKind::Contact { kind, operand } => {
                self.edge(*kind == ContactKind::Rising, &Power::of(operand.clone()))
            }
            _ => Power::Always,
        }
    }

    /// Whether something comes or goes, seen by a block of its own.
    fn edge(&mut self, rising: bool, power: &Power) -> Power {
        let (stem, ty) = if rising { ("rise", "R_TRIG") } else { ("fall", "F_TRIG") };
        let name = self.fresh(stem, ty);
        let value = self.words().expression(&power.expression());
        self.line(&format!("{name}(CLK := {value});"));
        Power::While(read(&name, &["Q"]))
    }

    /// The power at the end of a branch, and whether it goes to a node.
    fn branch(&mut self, branch: &Branch, left: Power, right_needed: bool) -> (Power, bool) {
        let mut power = match &branch.from {
            Some(node) => self.nodes.get(&node.key()).cloned().unwrap_or(Power::Never),
            None => left,
        };
        let last = branch.elements.len().saturating_sub(1);
        for (index, element) in branch.elements.iter().enumerate() {
            let needed = index < last || branch.to.is_some() || right_needed;
            power = self.element(element, power, needed);
        }
        let Some(node) = &branch.to else { return (power, false) };
        let before = self.nodes.remove(&node.key()).unwrap_or(Power::Never);
        let joined = self.or(before, power);
        self.nodes.insert(node.key(), joined);
        (Power::Never, true)
    }

    fn element(&mut self, element: &Element, power: Power, needed: bool) -> Power {
        match &element.kind {
            ElementKind::Contact { .. } | ElementKind::Condition(_) => {
                let (power, contact) = self.keeping(power, |rungs| rungs.contact(element));
                self.and(power, contact)
            }
            ElementKind::Coil { kind, target } => self.coil(*kind, target, power, needed),
            ElementKind::Block(call) => self.block(call, power, needed, element.span),
            ElementKind::Assignment { target, value } => self.assignment(target, value, power, needed),
            ElementKind::Statements(list) => self.statements(list, power, needed, element.span),
            ElementKind::Parallel(inner) => self.circuit(inner, power, needed),
            ElementKind::Jump { target } => {
                self.jump(target, &power);
                Power::Never
            }
            ElementKind::Return => {
                self.line_while(&power, "RETURN;");
                Power::Never
            }
        }
    }

    fn coil(&mut self, kind: CoilKind, target: &Reference, power: Power, needed: bool) -> Power {
        let changed = self.change(target);
        let change = changed.as_deref().map_or(Change::All, Change::Name);
        let power = if needed { self.held(power, &change) } else { power };
        self.spill(&change);
        let place = self.words().reference(target);
        match kind {
            CoilKind::Plain | CoilKind::Negated => {
                let value = if kind == CoilKind::Plain { power.clone() } else { self.negated(power.clone()) };
                let value = self.words().expression(&value.expression());
                self.line(&format!("{place} := {value};"));
            }
            CoilKind::Set => self.line_while(&power, &format!("{place} := TRUE;")),
            CoilKind::Reset => self.line_while(&power, &format!("{place} := FALSE;")),
            CoilKind::Rising | CoilKind::Falling => {
                let edge = self.edge(kind == CoilKind::Rising, &power);
                let value = self.words().expression(&edge.expression());
                self.line(&format!("{place} := {value};"));
            }
        }
        power
    }

    fn assignment(&mut self, target: &Reference, value: &Expression, power: Power, needed: bool) -> Power {
        let changed = self.change(target);
        let change = changed.as_deref().map_or(Change::All, Change::Name);
        let mut computed_index = false;
        uses::reference(target, &mut |mentioned| computed_index |= uses::has_computed_index(mentioned));
        uses::expression(value, &mut |mentioned| computed_index |= uses::has_computed_index(mentioned));
        let place = self.words().reference(target);
        let drawn = value;
        let value = self.words().expression(value);
        if needed && computed_index {
            // An index that is out of range takes the power away.
            if !self.moves_one_value(target, drawn) {
                self.problem(target.span, ENO_OF_INDEX);
            }
            self.spill(&change);
            let right = self.temporary();
            let statement = format!("{place} := MOVE(IN := {value}, ENO => {right});");
            self.line(&format!("{right} := FALSE;"));
            self.line_while(&power, &statement);
            return Power::of_variable(&right);
        }
        let power = if needed { self.held(power, &change) } else { power };
        self.spill(&change);
        self.line_while(&power, &format!("{place} := {value};"));
        power
    }

    /// Whether what is moved is elementary, as far as can be seen here; MOVE of a whole array or structure has no ENO in a statement
    /// that would tell of an index.
    pub(super) fn moves_one_value(&self, target: &Reference, value: &Expression) -> bool {
        let ExpressionKind::Read(value) = &value.kind else { return true };
        [target, value].into_iter().any(|place| match (&place.root, place.steps.last()) {
            (Root::Address(_), _) | (_, Some(Step::Bit(..))) => true,
            (Root::Name(name), last) => {
                let ty = self.declared.get(&name.key()).map(|declared| declared.ty.as_ref());
                let is_elementary = |ty: &crate::ladder::TypeReference| {
                    Elementary::from_name(&ty.name.text).is_some() && (ty.dimensions.is_empty() || last.is_some())
                };
                ty.is_some_and(|ty| ty.is_none_or(is_elementary))
            }
        })
    }

    fn statements(&mut self, list: &[Statement], power: Power, needed: bool, span: Span) -> Power {
        let mut computed_index = false;
        uses::statements(list, &mut |mentioned| computed_index |= uses::has_computed_index(mentioned));
        if needed && computed_index {
            let message = "the power behind these statements depends on whether an index is out of range";
            self.problem(span, message);
        }
        uses::calls(list, &mut |call| {
            let is_not = call.instance.as_name().is_some_and(|name| name.key() == "not");
            if is_not && self.is_function(call) && pin(call, "OUT").is_none() && pin(call, "NOT").is_none() {
                self.problem(call.instance.span, "a NOT whose result goes nowhere is no statement there");
            }
            if self.writes_beside_eno(call) {
                self.problem(call.instance.span, "ENO and another output of this box go to one variable");
            }
            if self.is_function(call)
                && let (Some(enable), Some(eno)) = (pin(call, "EN"), pin(call, "ENO"))
                && (is_computed(enable) || is_computed(eno))
            {
                self.problem(eno.span, ENO_OF_INDEX);
            }
        });
        let power = if needed { self.held(power, &Change::All) } else { power };
        self.spill(&Change::All);
        if let Power::Never = power {
            return power;
        }
        self.open_guards();
        let condition = match &power {
            Power::While(condition) => Some(self.words().expression(condition)),
            _ => None,
        };
        if let Some(condition) = &condition {
            self.open(condition);
        }
        let mut text = String::new();
        self.words().statements(list, self.indent, &mut text, &|call| self.is_function(call));
        if text.is_empty() {
            self.line(";");
        }
        self.text.push_str(&text);
        if condition.is_some() {
            self.close();
        }
        power
    }

    fn jump(&mut self, target: &Name, power: &Power) {
        let Some(to) = self.rungs.get(&target.key()).copied() else {
            return self.problem(target.span, "this jump leads to no rung");
        };
        if to <= self.place {
            return self.problem(target.span, "a jump leads forward");
        }
        let flag = match self.skips.get(&to) {
            Some(flag) => flag.clone(),
            None => {
                let flag = self.fresh("skip", "BOOL");
                self.skips.insert(to, flag.clone());
                flag
            }
        };
        self.line_while(power, &format!("{flag} := TRUE;"));
        self.jumped = true;
        self.guards.push(flag);
    }

    /// Whether nothing is declared under the name of a call but a function.
    pub(super) fn is_function(&self, call: &crate::ladder::BlockCall) -> bool {
        let Some(name) = call.instance.as_name() else { return false };
        call.type_name.is_none()
            && !self.declared.contains_key(&name.key())
            && (crate::ladder::functions::Function::from_name(&name.text).is_some() || self.function(name).is_some())
    }

    /// The program's own function of a name.
    pub(super) fn function(&self, name: &Name) -> Option<&'a Unit> {
        let wanted = name.key();
        let is_it = |unit: &&Unit| matches!(unit.kind, UnitKind::Function { .. }) && unit.name.key() == wanted;
        self.program.units.iter().find(is_it)
    }

    /// The name of the type of a block.
    pub(super) fn block_type(&self, call: &crate::ladder::BlockCall) -> Option<String> {
        if let Some(name) = &call.type_name {
            return Some(name.text.to_string());
        }
        let Root::Name(name) = &call.instance.root else { return None };
        let declared = self.declared.get(&name.key())?;
        let mut ty = declared.ty.as_ref()?;
        for step in &call.instance.steps {
            match step {
                Step::Index(..) => {}
                Step::Member(member) => {
                    let unit = self.program.units.iter().find(|unit| unit.name.key() == key(&ty.name.text))?;
                    ty = unit.variables.iter().find(|one| one.name.key() == member.key())?.ty.as_ref()?;
                }
                Step::Bit(..) => return None,
            }
        }
        Some(ty.name.text.to_string())
    }
}

/// The condition that flags are off.
fn off(flags: &[String]) -> String {
    flags.iter().map(|flag| format!("NOT {flag}")).collect::<Vec<_>>().join(" AND ")
}

/// How the rungs of a unit mention a variable.
#[derive(Default)]
pub(super) struct Mentions {
    /// How often all of it, or an element of it.
    pub(super) count: usize,
    /// The keys of members.
    pub(super) members: HashSet<String>,
}

fn mentions(unit: &Unit) -> HashMap<String, Mentions> {
    let mut all: HashMap<String, Mentions> = HashMap::new();
    for rung in &unit.rungs {
        uses::circuit(&rung.circuit, &mut |mentioned| {
            let uses::Use::Reference(reference) = mentioned else { return };
            let Some(root) = uses::root_key(mentioned) else { return };
            let mentions = all.entry(root).or_default();
            let members = reference.steps.iter().filter_map(|step| match step {
                Step::Member(member) => Some(member.key()),
                _ => None,
            });
            mentions.members.extend(members);
            mentions.count += usize::from(!reference.steps.iter().any(|step| matches!(step, Step::Member(_))));
        });
    }
    all
}

/// Whether a circuit is of contacts and conditions alone, without nodes.
pub(super) fn conducts(circuit: &Circuit) -> bool {
    circuit.branches.iter().all(|branch| {
        branch.from.is_none()
            && branch.to.is_none()
            && branch.elements.iter().all(|element| match &element.kind {
                ElementKind::Contact { .. } | ElementKind::Condition(_) => true,
                ElementKind::Parallel(inner) => conducts(inner),
                _ => false,
            })
    })
}
