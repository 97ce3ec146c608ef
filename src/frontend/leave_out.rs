//! Takes out of a program of another tool what Rung has not: blocks and functions that nothing declares, and variables of
//! types that there are not. The rest can be checked and, where someone asks for it, run.
//!
//! Nothing is left out unsaid: each kind is one diagnostic, with how often it is used and where first. Where an element was,
//! no power passes, and the variables that it would write keep their values.

use std::collections::HashSet;

use super::missing::Missing;
use super::uses::{self, Use};
use crate::diagnostic::Diagnostic;
use crate::elementary::Elementary;
use crate::ladder::functions::Function;
use crate::ladder::library::StandardBlock;
use crate::ladder::{
    Circuit, ContactKind, Element, ElementKind, Expression, ExpressionKind, Literal, Name, Origin, Program,
    TypeReference, UnitKind, key,
};

/// Takes it out, and says what it was. A program in native text stays as it is: there a name that is not known is a mistake.
pub fn leave_out(program: &mut Program) -> Vec<Diagnostic> {
    if program.origin == Origin::Native {
        return Vec::new();
    }
    let known = Known::of(program);
    let mut missing = Missing::default();
    let globals = take_variables(&mut program.globals, &known, &mut missing);
    for unit in &mut program.units {
        let mut gone = take_variables(&mut unit.variables, &known, &mut missing);
        gone.extend(globals.iter().filter(|name| !unit.variables.iter().any(|one| one.name.key() == **name)).cloned());
        let declared: HashSet<String> = unit.variables.iter().map(|variable| variable.name.key()).collect();
        let mut leaver = Leaver { known: &known, gone, declared: &declared, missing: &mut missing };
        unit.rungs.iter_mut().for_each(|rung| leaver.circuit(&mut rung.circuit));
    }
    missing.into_diagnostics().collect()
}

/// The names of types and functions.
struct Known {
    types: HashSet<String>,
    functions: HashSet<String>,
}

impl Known {
    fn of(program: &Program) -> Self {
        let of = |is_function: bool| {
            let units = program.units.iter();
            units
                .filter(move |unit| matches!(unit.kind, UnitKind::Function { .. }) == is_function)
                .map(|unit| unit.name.key())
        };
        let types = program.types.iter().map(|ty| ty.name.key()).chain(of(false)).collect();
        Self { types, functions: of(true).collect() }
    }

    fn has_type(&self, name: &str) -> bool {
        Elementary::from_name(name).is_some()
            || StandardBlock::from_name(name).is_some()
            || self.types.contains(&key(name))
    }

    fn has_function(&self, name: &str) -> bool {
        Function::from_name(name).is_some() || self.functions.contains(&key(name))
    }
}

/// Takes out the variables whose types are not known, and gives their names.
fn take_variables(
    variables: &mut Vec<crate::ladder::Variable>,
    known: &Known,
    missing: &mut Missing,
) -> HashSet<String> {
    let mut gone = HashSet::new();
    variables.retain(|variable| {
        let unknown = |ty: &&TypeReference| !known.has_type(&ty.name.text);
        let Some(ty) = variable.ty.as_ref().filter(unknown) else { return true };
        missing.note(&format!("the type {}", ty.name.text), variable.span);
        gone.insert(variable.name.key());
        false
    });
    gone
}

struct Leaver<'k> {
    known: &'k Known,
    /// The names of variables that were taken out.
    gone: HashSet<String>,
    declared: &'k HashSet<String>,
    missing: &'k mut Missing,
}

impl Leaver<'_> {
    fn circuit(&mut self, circuit: &mut Circuit) {
        for element in circuit.branches.iter_mut().flat_map(|branch| &mut branch.elements) {
            if let ElementKind::Parallel(inner) = &mut element.kind {
                self.circuit(inner);
            } else if self.lacks_something(element) {
                let operand = Expression { kind: ExpressionKind::Literal(Literal::Bool(false)), span: element.span };
                element.kind = ElementKind::Contact { kind: ContactKind::Open, operand };
            }
        }
    }

    /// Whether an element uses something that there is not, which is noted.
    fn lacks_something(&mut self, element: &Element) -> bool {
        let mut lacks = false;
        if let ElementKind::Block(call) = &element.kind
            && call.type_name.is_none()
            && let Some(name) = call.instance.as_name()
            && !self.declared.contains(&name.key())
            && !self.gone.contains(&name.key())
            && !self.known.has_function(&name.text)
            && !call.arguments.is_empty()
        {
            self.missing.note(&format!("the function {}", name.text), element.span);
            lacks = true;
        }
        let Self { known, gone, missing, .. } = self;
        uses::element(element, &mut |mentioned| match mentioned {
            Use::Function(Name { text, .. }) if !known.has_function(text) => {
                missing.note(&format!("the function {text}"), element.span);
                lacks = true;
            }
            // Where the instance is declared, its declaration was counted.
            Use::Block(Name { text, .. }, instance) if !known.has_type(text) => {
                if !instance.as_name().is_some_and(|name| gone.contains(&name.key())) {
                    missing.note(&format!("the type {text}"), element.span);
                }
                lacks = true;
            }
            mentioned => lacks |= uses::root_key(mentioned).is_some_and(|root| gone.contains(&root)),
        });
        lacks
    }
}
