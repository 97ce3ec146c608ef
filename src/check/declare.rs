//! Declarations: names, types, classes and addresses first, so that initial values may name what stands anywhere; then
//! the initial values in order, so that a constant can use only those before it and never itself.

use super::address::class_of;
use super::model::{Type, Variable, VariableId};
use super::scope::State;
use super::spelling::{self, Budget};
use super::{Checker, types};
use crate::diagnostic::{Code, Diagnostic};
use crate::elementary::{Elementary, Value};
use crate::ladder::library::StandardBlock;
use crate::ladder::{self, Address, Area, Name, VariableClass};
use crate::source::Span;

fn class_name(class: VariableClass) -> &'static str {
    match class {
        VariableClass::Input => "input",
        VariableClass::Output => "output",
        VariableClass::Memory => "variable",
        VariableClass::Constant => "constant",
    }
}

impl Checker<'_> {
    /// Declares what the program declares.
    pub(super) fn declare_variables(&mut self) {
        let program = self.program;
        let ids: Vec<Option<VariableId>> = program.variables.iter().map(|variable| self.register(variable)).collect();
        for (variable, id) in program.variables.iter().zip(ids) {
            self.initialise(variable, id);
        }
        self.reconcile_initial_values();
    }

    /// Declares all of a variable but its initial value.
    fn register(&mut self, declared: &ladder::Variable) -> Option<VariableId> {
        let ty = match &declared.type_name {
            Some(name) => self.type_named(name),
            None => Some(Type::Elementary(Elementary::Bool)),
        };
        let class = self.effective_class(declared);
        if let Some(Type::Block(block)) = ty {
            self.check_instance(declared, block);
        } else if declared.retain && matches!(class, VariableClass::Input | VariableClass::Constant) {
            let message = format!("the {} `{}` cannot be retained", class_name(class), declared.name.text);
            let problem = Diagnostic::new(Code::RetainedInput, declared.name.span, message);
            self.report.push(problem.hint("only what the program writes is worth keeping; leave `retain` out"));
        }
        let elementary = match ty {
            Some(Type::Elementary(ty)) => Some(ty),
            _ => None,
        };
        let variable = Variable {
            name: declared.name.text.clone(),
            class,
            ty: ty.unwrap_or(Type::Elementary(Elementary::Bool)),
            initial: Value::default_of(elementary.unwrap_or(Elementary::Bool)),
            retain: declared.retain,
            address: declared.address.clone(),
            shares: None,
            span: declared.name.span,
        };
        let state = match (ty, class) {
            (None, _) => State::Broken,
            (Some(Type::Block(_)), class) if class != VariableClass::Memory => State::Broken,
            (_, VariableClass::Constant) => State::Pending,
            _ => State::Known,
        };
        match self.scope.add(variable, state) {
            Ok(id) => {
                if let (Some(address), Some(ty)) = (&declared.address, elementary) {
                    self.place_at(id, address, ty);
                }
                Some(id)
            }
            Err(first) => {
                let message = format!("`{}` is declared twice", declared.name.text);
                let first = self.scope.entry(first).variable.span;
                let problem = Diagnostic::new(Code::DuplicateName, declared.name.span, message);
                self.report.push(problem.related(first, "declared first here"));
                None
            }
        }
    }

    /// The type of that name.
    pub(super) fn type_named(&mut self, name: &Name) -> Option<Type> {
        let found = Elementary::from_name(&name.text)
            .map(Type::Elementary)
            .or_else(|| StandardBlock::from_name(&name.text).map(Type::Block));
        if found.is_none() {
            let names = Elementary::ALL.iter().map(|ty| ty.name()).chain(StandardBlock::ALL.iter().map(|ty| ty.name()));
            let near = spelling::nearest(&name.text, names, &mut Budget::default());
            let hint = near.map(|near| format!("did you mean `{near}`?"));
            let problem = Diagnostic::new(Code::UnknownType, name.span, format!("there is no type `{}`", name.text));
            self.report.push(Diagnostic { hint, ..problem });
        }
        found
    }

    /// What a declaration declares, of which its address may be the part that says so.
    fn effective_class(&mut self, declared: &ladder::Variable) -> VariableClass {
        let Some(address) = &declared.address else { return declared.class };
        let hint = match (declared.class, address.area) {
            (VariableClass::Memory, area) => return class_of(area),
            (VariableClass::Input, Area::Input) | (VariableClass::Output, Area::Output) => return declared.class,
            (VariableClass::Input, _) => "inputs stand at `%I…`",
            (VariableClass::Output, _) => "outputs stand at `%Q…`",
            (VariableClass::Constant, _) => "a constant takes no storage; leave the address out",
        };
        let what = types::with_article(class_name(declared.class));
        let message = format!("{what} cannot stand at `{}`", address);
        self.report.push(Diagnostic::new(Code::AddressConflict, address.span, message).hint(hint));
        declared.class
    }

    /// What a declaration of a block instance cannot say.
    fn check_instance(&mut self, declared: &ladder::Variable, block: StandardBlock) {
        let instance = format!("an instance of {}", block.name());
        if declared.class != VariableClass::Memory {
            let message = format!("{} cannot be {instance}", types::with_article(class_name(declared.class)));
            let problem = Diagnostic::new(Code::TypeMismatch, declared.name.span, message);
            self.report.push(problem.hint("declare it with `var`"));
        }
        if let Some(address) = &declared.address {
            let problem = Diagnostic::new(Code::TypeMismatch, address.span, format!("{instance} has no address"));
            self.report.push(problem.hint("wire one of its outputs to a variable at that address"));
        }
        if let Some(initial) = &declared.initial {
            let problem = Diagnostic::new(Code::TypeMismatch, initial.span, format!("{instance} has no initial value"));
            self.report.push(problem.hint("wire its inputs where it is called"));
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
            let what = format!("{} and {}", first.ty.name(), second.ty.name());
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
            (Some(initial), Some(Type::Elementary(ty))) => {
                let value = self.initial_value(declared, initial, ty);
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

    fn initial_value(
        &mut self,
        declared: &ladder::Variable,
        initial: &ladder::Expression,
        ty: Elementary,
    ) -> Option<Value> {
        let (name, operand) = (&declared.name.text, self.operand(initial)?);
        if let (None, Some(other)) = (&declared.type_name, operand.other_than_bool()) {
            let message = format!("without a type `{name}` is a BOOL, and this is not");
            let problem = Diagnostic::new(Code::TypeMismatch, initial.span, message);
            self.report.push(problem.hint(format!("write its type, as in `{name} : {other}`")));
            return None;
        }
        let value = self.coerce(operand, ty, initial.span)?.constant();
        if value.is_none() {
            let message = format!("the initial value of `{name}` must be a constant");
            let problem = Diagnostic::new(Code::NotConstant, initial.span, message);
            self.report.push(problem.hint("write a literal, or name what `const` declares"));
        }
        value
    }

    /// Notes a variable's written initial value; `None` if it has a fault that was reported.
    fn settle(&mut self, id: Option<VariableId>, value: Option<Value>) {
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
            let (written, value) = (sharing.explicit_initial, sharing.variable.initial);
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
                self.scope.entry_mut(id).variable.initial = self.scope.entry(first).variable.initial;
            }
        }
    }
}

fn bits(count: u32) -> String {
    if count == 1 { "1 bit".to_owned() } else { format!("{count} bits") }
}
