//! Declarations: names, types, classes and addresses first, so that initial values may name what stands anywhere; then
//! the initial values in order, so that a constant can use only those before it and never itself.

use super::address::class_of;
use super::model::{Initial, Type, UnitId, Variable, VariableId};
use super::scope::State;
use super::type_table::Typed;
use super::unit::Signature;
use super::{Checker, types};
use crate::diagnostic::{Code, Diagnostic};
use crate::elementary::Elementary;
use crate::ladder::{self, Address, Area, Name, UnitKind, VariableClass};
use crate::source::Span;

fn class_name(class: VariableClass) -> &'static str {
    match class {
        VariableClass::Input => "input",
        VariableClass::Output => "output",
        VariableClass::Memory => "variable",
        VariableClass::Constant => "constant",
        VariableClass::InOut => "in-out variable",
        VariableClass::Temporary => "temporary variable",
    }
}

impl Checker<'_> {
    /// Declares the variables of all units and the global ones, and with them all types.
    pub(super) fn declare_variables(&mut self) {
        let program = self.program;
        self.declare_types();
        self.check_function_names();
        let globals = self.register(&program.globals);
        self.resolve_types();
        self.resolve_pending(&program.globals, &globals);
        let mut units = Vec::with_capacity(program.units.len());
        for (index, unit) in (0..).zip(&program.units) {
            self.scope.enter(Some(UnitId(index)));
            let start = self.scope.next_id();
            let ids = self.declare_unit(unit);
            let depth = self.collect_instances(index as usize);
            self.units.push(Signature::new(start.0..self.scope.next_id().0, depth));
            units.push(ids);
        }
        for (index, unit) in (0..).zip(&program.units) {
            self.sign(UnitId(index), unit);
        }
        self.scope.enter(None);
        self.check_registers();
        self.declare_direct();
        self.initialise_all(&program.globals, &globals);
        for ((index, unit), ids) in (0..).zip(&program.units).zip(&units) {
            self.scope.enter(Some(UnitId(index)));
            self.initialise_all(&unit.variables, ids);
        }
        self.scope.enter(None);
        self.reconcile_initial_values();
    }

    /// Declares the variables of a unit, and of a function its result under its own name.
    fn declare_unit(&mut self, unit: &ladder::Unit) -> Vec<Option<VariableId>> {
        if let UnitKind::Function { result: Some(result) } = &unit.kind {
            let typed = self.resolve(result);
            if let Some((ty, _)) = typed
                && !matches!(ty, Type::Elementary(_))
            {
                let message = format!(
                    "the result of a function is a single value, and this is {}",
                    types::with_article(&self.type_name(ty))
                );
                let problem = Diagnostic::new(Code::TypeMismatch, result.span, message);
                self.report.push(problem.hint("hand it over by an `inout` variable"));
            }
            let typed = typed.filter(|(ty, _)| matches!(ty, Type::Elementary(_)));
            let (ty, initial) = typed.clone().unwrap_or((Type::Elementary(Elementary::Bool), Initial::Default));
            let name = unit.name.text.clone();
            let variable = Variable {
                name,
                class: VariableClass::Output,
                ty,
                initial,
                retain: false,
                address: None,
                shares: None,
                span: unit.name.span,
            };
            if let Ok(id) = self.scope.add(variable, if typed.is_some() { State::Known } else { State::Broken }) {
                self.scope.entry_mut(id).mentioned = true;
            }
        }
        let ids = self.register(&unit.variables);
        self.resolve_pending(&unit.variables, &ids);
        ids
    }

    /// Declares names with what can be said at once: constants of elementary types get their values, since the bounds of
    /// arrays may need them; types that are not elementary are resolved after.
    fn register(&mut self, declared: &[ladder::Variable]) -> Vec<Option<VariableId>> {
        let ids: Vec<Option<VariableId>> = declared.iter().map(|variable| self.register_one(variable)).collect();
        for (variable, id) in declared.iter().zip(&ids) {
            if variable.class == VariableClass::Constant && is_elementary(variable) {
                self.initialise(variable, *id);
            }
        }
        ids
    }

    /// The types that were left for later.
    fn resolve_pending(&mut self, declared: &[ladder::Variable], ids: &[Option<VariableId>]) {
        for (variable, id) in declared.iter().zip(ids) {
            if let (Some(reference), false) = (&variable.ty, is_elementary(variable)) {
                let typed = self.resolve(reference);
                self.settle_type(variable, *id, typed);
            }
        }
    }

    /// The initial values but for those that are known already.
    fn initialise_all(&mut self, declared: &[ladder::Variable], ids: &[Option<VariableId>]) {
        for (variable, id) in declared.iter().zip(ids) {
            if variable.class != VariableClass::Constant || !is_elementary(variable) {
                self.initialise(variable, *id);
            }
        }
    }

    /// Declares all of a variable but its initial value and, if it is not elementary, its type.
    fn register_one(&mut self, declared: &ladder::Variable) -> Option<VariableId> {
        let ty = match &declared.ty {
            Some(reference) if is_elementary(declared) => Elementary::from_name(&reference.name.text),
            _ => None,
        };
        let class = self.effective_class(declared);
        self.check_class(declared);
        let variable = Variable {
            name: declared.name.text.clone(),
            class,
            ty: Type::Elementary(ty.unwrap_or(Elementary::Bool)),
            initial: Initial::Default,
            retain: declared.retain,
            address: declared.address.clone(),
            shares: None,
            span: declared.name.span,
        };
        let state = match class {
            VariableClass::Constant => State::Pending,
            _ => State::Known,
        };
        match self.scope.add(variable, state) {
            Ok(id) => {
                self.check_shadowing(&declared.name);
                if is_elementary(declared) {
                    self.check_placement(declared, Some(id), Type::Elementary(ty.unwrap_or(Elementary::Bool)));
                }
                Some(id)
            }
            Err(first) => {
                let message = format!("`{}` is declared twice", declared.name.text);
                let first = self.scope.entry(first).variable.span;
                let problem = Diagnostic::new(Code::DuplicateName, declared.name.span, message);
                self.report.push(problem.related(first, "declared first here"));
                if is_elementary(declared) {
                    self.check_placement(declared, None, Type::Elementary(ty.unwrap_or(Elementary::Bool)));
                }
                None
            }
        }
    }

    /// Reports a program's variable that has the name of a global one: both would be called so in traces and maps.
    fn check_shadowing(&mut self, name: &Name) {
        let in_program = self.scope.unit().is_some() && self.is_program();
        if let Some(global) = self.scope.find_global(&name.text).filter(|_| in_program) {
            let message = format!("`{}` is global already", name.text);
            let problem = Diagnostic::new(Code::DuplicateName, name.span, message);
            let declared = self.scope.entry(global).variable.span;
            self.report.push(problem.related(declared, "declared here").hint("leave this out to use that one"));
        }
    }

    /// Notes the type of a variable that was left for later; none where it is broken, which was reported.
    fn settle_type(&mut self, declared: &ladder::Variable, id: Option<VariableId>, typed: Option<Typed>) {
        let Some((ty, initial)) = typed else {
            if let Some(id) = id {
                self.scope.entry_mut(id).state = State::Broken;
            }
            return;
        };
        if let Some(id) = id {
            let is_instance = self.types.holds_instance(ty);
            let in_function = self.in_function();
            let entry = self.scope.entry_mut(id);
            (entry.variable.ty, entry.variable.initial) = (ty, initial);
            // What is wrong with an instance that is no memory is said, and not at its uses again.
            let stands = match declared.class {
                VariableClass::Memory => !in_function,
                VariableClass::InOut => true,
                _ => false,
            };
            if is_instance && !stands {
                entry.state = State::Broken;
            }
        }
        self.check_placement(declared, id, ty);
    }

    /// What a declaration of this type cannot say, and its storage.
    fn check_placement(&mut self, declared: &ladder::Variable, id: Option<VariableId>, ty: Type) {
        let class = id.map_or(declared.class, |id| self.scope.entry(id).variable.class);
        if self.types.holds_instance(ty) {
            self.check_instance(declared, ty);
        } else if declared.retain
            && matches!(class, VariableClass::Input | VariableClass::Constant)
            && self.is_program()
        {
            let message = format!("the {} `{}` cannot be retained", class_name(class), declared.name.text);
            let problem = Diagnostic::new(Code::RetainedInput, declared.name.span, message);
            self.report.push(problem.hint("only what the program writes is worth keeping; leave `retain` out"));
        }
        let (Some(address), Some(id)) = (&declared.address, id) else { return };
        match ty {
            Type::Elementary(ty) => self.place_at(id, address, ty),
            Type::Array(_) | Type::Structure(_) => {
                let message = format!("an array or structure cannot stand at `{address}`");
                let problem = Diagnostic::new(Code::TypeMismatch, address.span, message);
                self.report.push(problem.hint("give each value that the field has an address of its own"));
            }
            // That was said of the instance.
            Type::Block(_) | Type::Unit(_) => {}
        }
    }

    /// Whether names are now those of a program, or global.
    pub(super) fn is_program(&self) -> bool {
        let unit = self.scope.unit().map(|unit| &self.program.units[unit.index()].kind);
        matches!(unit, None | Some(UnitKind::Program { .. }))
    }

    /// Whether names are now those of a function, which remembers nothing.
    pub(super) fn in_function(&self) -> bool {
        let unit = self.scope.unit().map(|unit| &self.program.units[unit.index()].kind);
        matches!(unit, Some(UnitKind::Function { .. }))
    }

    /// What a declaration declares, of which its address may be the part that says so.
    fn effective_class(&mut self, declared: &ladder::Variable) -> VariableClass {
        let Some(address) = &declared.address else { return declared.class };
        if !self.is_program() {
            let message =
                format!("`{}` cannot stand at an address: each instance has storage of its own", declared.name.text);
            let problem = Diagnostic::new(Code::AddressConflict, address.span, message);
            self.report.push(problem.hint("declare it in the program, and wire it where the block is called"));
            return declared.class;
        }
        let hint = match (declared.class, address.area) {
            (VariableClass::Memory, area) => return class_of(area),
            (VariableClass::Input, Area::Input) | (VariableClass::Output, Area::Output) => return declared.class,
            (VariableClass::Input, _) => "inputs stand at `%I…`",
            (VariableClass::Output, _) => "outputs stand at `%Q…`",
            (VariableClass::Constant, _) => "a constant takes no storage; leave the address out",
            (VariableClass::InOut | VariableClass::Temporary, _) => {
                "only `input`, `output` and `var` stand at addresses"
            }
        };
        let what = types::with_article(class_name(declared.class));
        let message = format!("{what} cannot stand at `{}`", address);
        self.report.push(Diagnostic::new(Code::AddressConflict, address.span, message).hint(hint));
        declared.class
    }

    /// Whether what is declared can stand where it does.
    fn check_class(&mut self, declared: &ladder::Variable) {
        let what = types::with_article(class_name(declared.class));
        let unit = self.scope.unit().map(|unit| &self.program.units[unit.index()].kind);
        let (message, hint) = match (unit, declared.class) {
            (None, VariableClass::Input | VariableClass::Output) if declared.address.is_none() => {
                (format!("{what} cannot be global"), "declare it in the program, or `global` at an address")
            }
            (None, VariableClass::InOut | VariableClass::Temporary) => {
                (format!("{what} cannot be global"), "declare it in the unit that uses it")
            }
            (Some(UnitKind::Program { .. }), VariableClass::InOut) => {
                ("a program has no in-out variables, for nothing calls it".to_owned(), "declare it with `var`")
            }
            (Some(_), VariableClass::InOut) if declared.initial.is_some() || declared.retain => {
                (format!("{what} is the caller's, and holds nothing of its own"), "leave `:=` and `retain` out")
            }
            (Some(UnitKind::Function { .. }), _) if declared.retain => (
                format!("a function remembers nothing, and so does not retain `{}`", declared.name.text),
                "leave `retain` out",
            ),
            (_, VariableClass::Temporary) if declared.retain => (
                format!("{what} starts afresh each time, and is not retained"),
                "leave `retain` out, or declare it with `var`",
            ),
            _ => return,
        };
        self.report.push(Diagnostic::new(Code::MisplacedDeclaration, declared.name.span, message).hint(hint));
    }

    /// What a declaration of a block instance, or of what holds one, cannot say.
    fn check_instance(&mut self, declared: &ladder::Variable, ty: Type) {
        let instance = format!("an instance of {}", self.type_name(ty));
        if !matches!(declared.class, VariableClass::Memory | VariableClass::InOut) {
            let message = format!("{} cannot be {instance}", types::with_article(class_name(declared.class)));
            let problem = Diagnostic::new(Code::TypeMismatch, declared.name.span, message);
            self.report.push(problem.hint("declare it with `var`"));
        } else if let Some(unit) = self.scope.unit()
            && matches!(self.program.units[unit.index()].kind, UnitKind::Function { .. })
            && declared.class == VariableClass::Memory
        {
            let message = format!("a function remembers nothing, and `{}` is {instance}", declared.name.text);
            self.report.push(Diagnostic::new(Code::NoMemoryHere, declared.name.span, message));
        }
        if let Some(address) = &declared.address {
            let problem = Diagnostic::new(Code::TypeMismatch, address.span, format!("{instance} has no address"));
            self.report.push(problem.hint("wire one of its outputs to a variable at that address"));
        }
    }

    fn place_at(&mut self, id: VariableId, address: &Address, ty: Elementary) {
        if address.width.bits() != ty.bits() {
            let message = format!("`{}` is {} wide, and {ty} {}", address, bits(address.width.bits()), bits(ty.bits()));
            self.report.push(Diagnostic::new(Code::TypeMismatch, address.span, message));
        }
        let Some(extent) = self.extent(address) else { return };
        let first = *self.scope.addresses.entry(extent).or_insert(id);
        if first == id {
            return;
        }
        self.scope.entry_mut(id).variable.shares = Some(first);
        let [first, second] = [first, id].map(|id| &self.scope.entry(id).variable);
        if first.ty != second.ty {
            let what = format!("{} and {}", self.type_name(first.ty), self.type_name(second.ty));
            self.sharing_conflict(first.span, address.span, &second.name.clone(), &what);
        } else if first.retain != second.retain {
            self.sharing_conflict(first.span, address.span, &second.name.clone(), "only one of them with `retain`");
        }
    }

    fn sharing_conflict(&mut self, first: Span, second: Span, name: &str, what: &str) {
        let message = format!("`{name}` shares its address with another variable, but they differ: {what}");
        let problem = Diagnostic::new(Code::AddressConflict, second, message).related(first, "the other variable");
        self.report.push(problem.hint("variables at one address share storage; declare them alike"));
    }

    fn initialise(&mut self, declared: &ladder::Variable, id: Option<VariableId>) {
        if let Some(initial) = &declared.initial
            && !self.collect_initial(initial)
        {
            self.settle(id, None);
            return;
        }
        let known = id.filter(|id| self.scope.entry(*id).state != State::Broken);
        let ty = known.map(|id| self.scope.entry(id).variable.ty);
        match (&declared.initial, ty) {
            (Some(initial), Some(ty)) => {
                let value = self.declared_initial(declared, initial, ty);
                self.settle(id, value);
            }
            // Only for the names in it.
            (Some(initial), _) => {
                self.operand(initial);
            }
            (None, Some(_)) if declared.class == VariableClass::Constant => {
                let message = format!("the constant `{}` has no value", declared.name.text);
                let problem = Diagnostic::new(Code::NotConstant, declared.name.span, message);
                self.report.push(problem.hint("write one behind `:=`"));
                self.settle(id, None);
            }
            (None, _) => {}
        }
    }

    /// Notes a variable's written initial value; `None` if it has a fault that was reported.
    fn settle(&mut self, id: Option<VariableId>, value: Option<Initial>) {
        let Some(id) = id else { return };
        let entry = self.scope.entry_mut(id);
        match value {
            Some(value) => {
                entry.variable.initial = value;
                entry.explicit_initial = true;
                entry.state = State::Known;
            }
            None if entry.state == State::Pending => entry.state = State::Broken,
            None => {}
        }
    }

    /// Variables that share storage start with one value: the one that is written at any of them.
    fn reconcile_initial_values(&mut self) {
        for id in self.scope.ids() {
            let Some(first) = self.scope.entry(id).variable.shares else { continue };
            let [root, sharing] = [first, id].map(|id| self.scope.entry(id));
            let (written, value) = (sharing.explicit_initial, sharing.variable.initial.clone());
            if !written {
                continue;
            } else if !root.explicit_initial {
                let root = self.scope.entry_mut(first);
                root.variable.initial = value;
                root.explicit_initial = true;
            } else if root.variable.initial != value {
                let (name, span) = (sharing.variable.name.clone(), sharing.variable.span);
                self.sharing_conflict(root.variable.span, span, &name, "two initial values");
            }
        }
        for id in self.scope.ids() {
            if let Some(first) = self.scope.entry(id).variable.shares {
                let initial = self.scope.entry(first).variable.initial.clone();
                self.scope.entry_mut(id).variable.initial = initial;
            }
        }
    }
}

/// Whether a variable's type is plainly an elementary one, whatever the program declares.
fn is_elementary(declared: &ladder::Variable) -> bool {
    declared.ty.as_ref().is_none_or(|ty| ty.dimensions.is_empty() && Elementary::from_name(&ty.name.text).is_some())
}

fn bits(count: u32) -> String {
    if count == 1 { "1 bit".to_owned() } else { format!("{count} bits") }
}
