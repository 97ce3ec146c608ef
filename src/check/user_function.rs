//! Calls of the program's own functions in expressions. What such a call computes is the function's result alone, so that
//! it takes no outputs.

use super::Checker;
use super::model::{Expression, ExpressionKind, Place, Type, UnitId, VariableId};
use super::report::clipped;
use crate::diagnostic::{Code, Diagnostic};
use crate::ladder::{FunctionArgument, Name, VariableClass, key};

impl Checker<'_> {
    /// A call of a function of the program's own.
    pub(super) fn user_function(
        &mut self,
        unit: UnitId,
        name: &Name,
        arguments: &[FunctionArgument],
    ) -> Option<Expression> {
        if self.units.len() < self.program.units.len() {
            // A size or a number that a declaration needs before there are units.
            let problem = Diagnostic::new(Code::NotConstant, name.span, "this must be a constant");
            self.report.push(problem.hint("a function of the program is computed when it runs"));
            return None;
        }
        self.note_unit_call(unit, name.span);
        let parameters = self.parameters(unit);
        let order = self.arrange_user(name, &parameters, arguments);
        let signature = &self.units[unit.index()];
        let (inputs, references) = (signature.inputs.clone(), signature.references.clone());
        let result = signature.outputs.first().copied().filter(|_| self.has_result(unit));
        let mut given: Vec<Option<Expression>> = vec![None; inputs.len()];
        let mut places: Vec<Option<Place>> = vec![None; references.len()];
        let mut whole = order.is_some();
        for (index, argument) in arguments.iter().enumerate() {
            let parameter = order.as_ref().and_then(|order| order[index]);
            let Some(parameter) = parameter else {
                // Only for what is wrong in it.
                self.operand(&argument.value);
                continue;
            };
            let variable = &self.scope.entry(parameter).variable;
            let (ty, text) = (variable.ty, variable.name.clone());
            if let Some(place) = references.iter().position(|reference| *reference == parameter) {
                places[place] = self.by_reference(&text, ty, &argument.value);
                whole &= places[place].is_some();
            } else if let Some(place) = inputs.iter().position(|input| *input == parameter) {
                given[place] = match ty {
                    Type::Elementary(ty) => self.value(&argument.value, ty),
                    _ => {
                        self.by_reference_only(ty, argument.value.span);
                        None
                    }
                };
                whole &= given[place].is_some();
            }
        }
        let missing = references.iter().zip(&places).find(|(_, place)| place.is_none()).map(|(id, _)| *id);
        if let Some(missing) = missing.filter(|_| whole) {
            let message = format!("`{}` has to be given a variable", self.scope.entry(missing).variable.name);
            let problem = Diagnostic::new(Code::WrongArguments, name.span, message);
            self.report.push(problem.hint(format!("its parameters are {}", self.user_signature(name, &parameters))));
        }
        let Some(result) = result else {
            let message = format!("`{}` has no result, and so is no value", clipped(&name.text));
            let problem = Diagnostic::new(Code::TypeMismatch, name.span, message);
            self.report.push(problem.hint("call it in a box of its own or as a statement"));
            return None;
        };
        let ty = match self.scope.entry(result).variable.ty {
            Type::Elementary(ty) => ty,
            // That was reported where it is declared.
            _ => return None,
        };
        let references = places.into_iter().collect::<Option<_>>()?;
        whole.then_some(Expression { ty, kind: ExpressionKind::UserCall { unit, arguments: given.into(), references } })
    }

    /// What a call without names gives, in the order of the declarations.
    fn parameters(&self, unit: UnitId) -> Vec<VariableId> {
        let signature = &self.units[unit.index()];
        let mut parameters = [signature.inputs.as_slice(), &signature.references].concat();
        parameters.sort_unstable();
        parameters
    }

    fn user_signature(&self, name: &Name, parameters: &[VariableId]) -> String {
        let names: Vec<&str> = parameters.iter().map(|id| self.scope.entry(*id).variable.name.as_str()).collect();
        format!("{}({})", name.text, names.join(", "))
    }

    /// For each argument the parameter that it is for; none for one that is faulty in itself, which was reported.
    fn arrange_user(
        &mut self,
        name: &Name,
        parameters: &[VariableId],
        arguments: &[FunctionArgument],
    ) -> Option<Vec<Option<VariableId>>> {
        let named = arguments.iter().filter(|argument| argument.parameter.is_some()).count();
        if named == 0 && !arguments.is_empty() && arguments.len() != parameters.len() {
            let message =
                format!("{} takes {} arguments, and this is {}", name.text, parameters.len(), arguments.len());
            let problem = Diagnostic::new(Code::WrongArguments, name.span, message);
            self.report.push(problem.hint(format!("its parameters are {}", self.user_signature(name, parameters))));
            return None;
        } else if named == 0 {
            return Some(parameters.iter().copied().map(Some).take(arguments.len()).collect());
        } else if named < arguments.len() {
            let message = "either all arguments name their parameters or none does";
            self.report.push(Diagnostic::new(Code::WrongArguments, name.span, message));
            return None;
        }
        let mut order = Vec::with_capacity(arguments.len());
        let mut whole = true;
        for parameter in arguments.iter().filter_map(|argument| argument.parameter.as_ref()) {
            let wanted = parameter.key();
            let found = parameters.iter().find(|id| key(&self.scope.entry(**id).variable.name) == wanted).copied();
            if found.is_none() {
                let message = format!("{} has no parameter `{}`", name.text, clipped(&parameter.text));
                let hint = if matches!(wanted.as_str(), "en" | "eno") {
                    format!("call the box, `{}(EN := …)`, outside braces", name.text)
                } else {
                    format!("its parameters are {}", self.user_signature(name, parameters))
                };
                self.report.push(Diagnostic::new(Code::UnknownPin, parameter.span, message).hint(hint));
            } else if order.contains(&found) {
                let message = "this parameter has an argument already";
                self.report.push(Diagnostic::new(Code::DuplicatePin, parameter.span, message));
                whole = false;
            }
            whole &= found.is_some();
            order.push(found);
        }
        whole.then_some(order)
    }

    /// Whether a unit is a function with a result.
    pub(super) fn has_result(&self, unit: UnitId) -> bool {
        let signature = &self.units[unit.index()];
        let first = signature.outputs.first().map(|id| self.scope.entry(*id));
        let unit = &self.program.units[unit.index()];
        matches!(unit.kind, crate::ladder::UnitKind::Function { result: Some(_) })
            && first.is_some_and(|entry| entry.variable.class == VariableClass::Output)
    }
}
