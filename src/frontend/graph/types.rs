//! What pins blocks have and what types values have, as far as wires need it: which power goes into a box on its left,
//! and of what type a hidden variable is.

use std::collections::HashMap;

use lean_string::LeanString;

use crate::elementary::Elementary;
use crate::ladder::functions::{Function, ParameterType, ResultType, StandardFunction};
use crate::ladder::library::StandardBlock;
use crate::ladder::{
    Expression, ExpressionKind, Literal, Name, Program, Reference, Root, Step, TypeKind, TypeReference, UnaryOperator,
    Unit, UnitKind, Variable, VariableClass, Width, key,
};
use crate::source::Span;

/// All that the file declares, by name.
pub(in crate::frontend) struct Signatures {
    units: HashMap<String, Pins>,
    types: HashMap<String, TypeKind>,
    globals: HashMap<String, TypeReference>,
    /// The addresses of global variables.
    addresses: HashMap<String, String>,
}

/// The pins of a unit.
struct Pins {
    function: bool,
    result: Option<TypeReference>,
    inputs: Vec<(Name, TypeReference)>,
    outputs: Vec<(Name, TypeReference)>,
}

/// A type of a name.
pub(in crate::frontend) fn elementary(ty: Elementary, span: Span) -> TypeReference {
    TypeReference::of_name(Name::new(ty.name(), span))
}

fn of(variable: &Variable) -> TypeReference {
    variable.ty.clone().unwrap_or_else(|| elementary(Elementary::Bool, variable.span))
}

fn by_name(variables: &[Variable]) -> HashMap<String, TypeReference> {
    variables.iter().map(|variable| (variable.name.key(), of(variable))).collect()
}

fn addresses(variables: &[Variable]) -> HashMap<String, String> {
    variables
        .iter()
        .filter_map(|variable| Some((variable.name.key(), variable.address.as_ref()?.to_string())))
        .collect()
}

impl Signatures {
    /// Of a file with these declarations.
    pub(in crate::frontend) fn new<'u>(program: &Program, units: impl Iterator<Item = &'u Unit>) -> Self {
        let pins = |unit: &Unit| {
            let of_class = |classes: &[VariableClass]| {
                let found = unit.variables.iter().filter(|variable| classes.contains(&variable.class));
                found.map(|variable| (variable.name.clone(), of(variable))).collect()
            };
            let result = match &unit.kind {
                UnitKind::Function { result } => result.clone(),
                _ => None,
            };
            Pins {
                function: matches!(unit.kind, UnitKind::Function { .. }),
                result,
                inputs: of_class(&[VariableClass::Input, VariableClass::InOut]),
                outputs: of_class(&[VariableClass::Output]),
            }
        };
        Self {
            units: units.map(|unit| (unit.name.key(), pins(unit))).collect(),
            types: program.types.iter().map(|ty| (ty.name.key(), ty.kind.clone())).collect(),
            globals: by_name(&program.globals),
            addresses: addresses(&program.globals),
        }
    }

    /// Whether a name is that of a function.
    pub(in crate::frontend) fn is_function(&self, name: &str) -> bool {
        self.units.get(&key(name)).map_or_else(|| Function::from_name(name).is_some(), |unit| unit.function)
    }

    /// Whether what a box of that type does is nothing but what its pins show.
    pub(in crate::frontend) fn is_standard(&self, name: &str) -> bool {
        !self.units.contains_key(&key(name))
            && (StandardBlock::from_name(name).is_some() || Function::from_name(name).is_some())
    }

    /// Whether a function of the file declares an output of that name besides its result.
    pub(in crate::frontend) fn has_output(&self, function: &str, pin: &str) -> bool {
        let unit = self.units.get(&key(function));
        unit.is_some_and(|unit| unit.outputs.iter().any(|(name, _)| name.text.eq_ignore_ascii_case(pin)))
    }

    /// Whether anything declares a block of that name; an unknown one may have any pins.
    pub(in crate::frontend) fn is_known_block(&self, name: &str) -> bool {
        self.units.get(&key(name)).map_or_else(|| StandardBlock::from_name(name).is_some(), |unit| !unit.function)
    }

    /// Whether a pin of a block is one of its outputs.
    pub(in crate::frontend) fn is_output(&self, block: &str, pin: &str) -> bool {
        pin.eq_ignore_ascii_case("ENO")
            || match self.units.get(&key(block)) {
                Some(unit) => unit.outputs.iter().any(|(name, _)| name.text.eq_ignore_ascii_case(pin)),
                None => StandardBlock::from_name(block).is_some_and(|block| block.output(pin).is_some()),
            }
    }

    /// The first BOOL among the inputs of a block, which takes the power on its left.
    pub(in crate::frontend) fn power_input(&self, name: &str) -> Option<String> {
        match self.units.get(&key(name)) {
            Some(unit) => first_bool(&unit.inputs),
            None => {
                let block = StandardBlock::from_name(name)?;
                block.inputs().iter().find(|pin| pin.ty == Elementary::Bool).map(|pin| pin.name.to_owned())
            }
        }
    }

    /// The first BOOL among the outputs of a block, which gives the power on its right.
    pub(in crate::frontend) fn power_output(&self, name: &str) -> Option<String> {
        match self.units.get(&key(name)) {
            Some(unit) => first_bool(&unit.outputs),
            None => {
                let block = StandardBlock::from_name(name)?;
                block.outputs().iter().find(|pin| pin.ty == Elementary::Bool).map(|pin| pin.name.to_owned())
            }
        }
    }

    /// The type of a pin of a block.
    pub(in crate::frontend) fn pin(&self, block: &str, pin: &str, span: Span) -> Option<TypeReference> {
        match self.units.get(&key(block)) {
            Some(unit) => {
                let mut pins = unit.inputs.iter().chain(&unit.outputs);
                pins.find(|(name, _)| name.text.eq_ignore_ascii_case(pin)).map(|(_, ty)| ty.clone())
            }
            None => {
                let block = StandardBlock::from_name(block)?;
                let mut pins = block.inputs().iter().chain(block.outputs());
                pins.find(|known| known.name.eq_ignore_ascii_case(pin)).map(|known| elementary(known.ty, span))
            }
        }
    }

    /// Whether an input of an output's function takes part in the type of its result.
    fn is_generic(function: StandardFunction, pin: &str) -> bool {
        let parameter = function.place(pin).and_then(|place| function.parameter(place));
        parameter.is_some_and(|parameter| matches!(parameter.ty, ParameterType::Generic))
    }

    /// The type that a function gives at an output, from those of its operands by their pins.
    pub(in crate::frontend) fn result(
        &self,
        name: &str,
        output: &str,
        operands: &[(LeanString, Option<TypeReference>)],
        span: Span,
    ) -> Option<TypeReference> {
        if output.eq_ignore_ascii_case("ENO") {
            return Some(elementary(Elementary::Bool, span));
        }
        if let Some(unit) = self.units.get(&key(name)) {
            let output = unit.outputs.iter().find(|(name, _)| name.text.eq_ignore_ascii_case(output));
            return output.map(|(_, ty)| ty.clone()).or_else(|| unit.result.clone());
        }
        match Function::from_name(name)? {
            Function::Standard(function) => match function.result() {
                ResultType::Exactly(ty) => Some(elementary(ty, span)),
                ResultType::Generic => {
                    let generic = operands.iter().filter(|(pin, _)| Self::is_generic(function, pin));
                    generic.filter_map(|(_, ty)| ty.clone()).reduce(wider)
                }
            },
            Function::Convert { to, .. } => Some(elementary(to, span)),
            Function::Truncate { to, .. } => Some(elementary(to.unwrap_or(Elementary::Dint), span)),
        }
    }
}

fn first_bool(pins: &[(Name, TypeReference)]) -> Option<String> {
    let is_bool =
        |ty: &TypeReference| ty.dimensions.is_empty() && ty.name.text.eq_ignore_ascii_case(Elementary::Bool.name());
    pins.iter().find(|(_, ty)| is_bool(ty)).map(|(name, _)| name.text.to_string())
}

/// Of two types the one that holds the values of both, as far as there is one.
fn wider(one: TypeReference, other: TypeReference) -> TypeReference {
    // From narrow to wide; the order of types that do not widen to each other does not matter, since checking refuses them.
    use Elementary::{
        Bool, Byte, Dint, Dword, Int, Lint, Lreal, Lword, Real, Sint, Time, Udint, Uint, Ulint, Usint, Word,
    };
    const WIDTHS: [Elementary; 16] =
        [Bool, Usint, Sint, Byte, Uint, Int, Word, Udint, Dint, Dword, Ulint, Lint, Lword, Real, Lreal, Time];
    let rank = |ty: &TypeReference| {
        let ty = Elementary::from_name(&ty.name.text)?;
        WIDTHS.iter().position(|known| *known == ty)
    };
    if rank(&other) > rank(&one) { other } else { one }
}

/// The variables that a body sees.
pub(in crate::frontend) struct Scope<'s> {
    pub(in crate::frontend) signatures: &'s Signatures,
    variables: HashMap<String, TypeReference>,
    addresses: HashMap<String, String>,
}

impl<'s> Scope<'s> {
    /// Of a unit.
    pub(in crate::frontend) fn new(signatures: &'s Signatures, unit: &Unit) -> Self {
        let mut variables = by_name(&unit.variables);
        if let UnitKind::Function { result: Some(result) } = &unit.kind {
            variables.insert(unit.name.key(), result.clone());
        }
        Self { signatures, variables, addresses: addresses(&unit.variables) }
    }

    /// Whether the unit declares a name itself.
    pub(in crate::frontend) fn declares(&self, name: &str) -> bool {
        self.variables.contains_key(&key(name))
    }

    /// What a name stands for where storage is shared: the address of a located variable, else the name. A global begins
    /// with a dot.
    pub(in crate::frontend) fn storage(&self, name: &str) -> String {
        let name = key(name);
        let local = self.variables.contains_key(&name);
        let address = if local { self.addresses.get(&name) } else { self.signatures.addresses.get(&name) };
        match address {
            Some(address) => address.clone(),
            None if local => name,
            None => format!(".{name}"),
        }
    }

    /// The declared type of a variable.
    pub(in crate::frontend) fn variable(&self, name: &str) -> Option<&TypeReference> {
        let name = key(name);
        self.variables.get(&name).or_else(|| self.signatures.globals.get(&name))
    }

    fn reference(&self, reference: &Reference) -> Option<TypeReference> {
        let mut ty = match &reference.root {
            Root::Name(name) => self.variable(&name.text)?.clone(),
            Root::Address(address) => {
                return (address.width == Width::Bit).then(|| elementary(Elementary::Bool, reference.span));
            }
        };
        for step in &reference.steps {
            // A name may stand for another type some times over.
            for _ in 0..16 {
                let Some(TypeKind::Alias { ty: alias, .. }) = self.signatures.types.get(&ty.name.key()) else { break };
                if !ty.dimensions.is_empty() {
                    break;
                }
                ty = alias.clone();
            }
            ty = match step {
                Step::Bit(..) => elementary(Elementary::Bool, reference.span),
                Step::Index(..) => TypeReference::of_name(ty.name),
                Step::Member(member) => match self.signatures.types.get(&ty.name.key()) {
                    Some(TypeKind::Structure(fields)) => {
                        fields.iter().find(|field| field.name.key() == member.key())?.ty.clone()
                    }
                    _ => self.signatures.pin(&ty.name.text, &member.text, reference.span)?,
                },
            };
        }
        Some(ty)
    }

    /// The type of a value; `None` where it takes that of what is around it, or is not known.
    pub(in crate::frontend) fn value(&self, value: &Expression) -> Option<TypeReference> {
        let span = value.span;
        match &value.kind {
            ExpressionKind::Literal(literal) => match literal {
                Literal::Bool(_) => Some(elementary(Elementary::Bool, span)),
                Literal::Time(_) => Some(elementary(Elementary::Time, span)),
                Literal::Integer { ty, .. } | Literal::Real { ty, .. } => ty.map(|ty| elementary(ty, span)),
                Literal::Enumerated { ty, .. } => Some(TypeReference::of_name((**ty).clone())),
            },
            ExpressionKind::Read(reference) => self.reference(reference),
            ExpressionKind::Unary(UnaryOperator::Not | UnaryOperator::Negate, operand) => self.value(operand),
            ExpressionKind::Binary(operator, ..) if operator.is_comparison() => {
                Some(elementary(Elementary::Bool, span))
            }
            ExpressionKind::Binary(_, left, right) => match (self.value(left), self.value(right)) {
                (Some(left), Some(right)) => Some(wider(left, right)),
                (left, right) => left.or(right),
            },
            ExpressionKind::Call { function, arguments } => {
                let operand = |(place, argument): (usize, &crate::ladder::FunctionArgument)| {
                    let name = argument.parameter.as_ref().map(|name| name.text.clone());
                    let name = name.unwrap_or_else(|| positional(&function.text, place).into());
                    (name, self.value(&argument.value))
                };
                let operands: Vec<_> = arguments.iter().enumerate().map(operand).collect();
                self.signatures.result(&function.text, "OUT", &operands, span)
            }
            ExpressionKind::Array(_) | ExpressionKind::Structure(_) => None,
        }
    }
}

/// The name of an argument that is given by its place.
fn positional(function: &str, place: usize) -> String {
    let parameter = match Function::from_name(function) {
        Some(Function::Standard(function)) => {
            function.parameters().get(place).map(|parameter| parameter.name.to_owned())
        }
        _ => None,
    };
    parameter.unwrap_or_else(|| format!("IN{}", place + 1))
}
