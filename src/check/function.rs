//! Functions: which function, which argument goes to which parameter, and the one type that a call chooses.
//!
//! A function that is an operator of two operands becomes that operator. It must never compute a type otherwise than
//! operators do: the one to which all operands widen.

use super::Checker;
use super::constant::Untyped;
use super::expression::{Operand, constant};
use super::function_box::signature;
use super::model::{Expression, ExpressionKind};
use super::report::clipped;
use super::{fold, types};
use crate::diagnostic::{Code, Diagnostic};
use crate::elementary::{Elementary, Value};
use crate::ladder::functions::{Class, Function, ParameterType, ResultType, StandardFunction};
use crate::ladder::library::StandardBlock;
use crate::ladder::{BinaryOperator, FunctionArgument, Name, UnaryOperator};
use crate::source::Span;

/// An argument in its place.
pub(super) struct Actual {
    /// None for the input of a box that nothing is wired to: the zero of its type.
    pub(super) operand: Option<Operand>,
    pub(super) span: Span,
}

/// A function, its operands with their places, and the type of its result.
type TypedCall = (Function, Vec<(Expression, Span)>, Elementary);

impl Checker<'_> {
    /// A call. Its type is `expected`, if its operands leave that open.
    pub(super) fn function(
        &mut self,
        name: &Name,
        arguments: &[FunctionArgument],
        span: Span,
        expected: Option<Elementary>,
    ) -> Option<Operand> {
        if let Some(unit) = self.function_unit(name) {
            return self.user_function(unit, name, arguments).map(Operand::Typed);
        }
        // All first, so that errors in all are found.
        let operands: Vec<Option<Operand>> = arguments.iter().map(|argument| self.operand(&argument.value)).collect();
        let Some(function) = Function::from_name(&name.text) else {
            self.unknown_function(name);
            return None;
        };
        let order = self.arrange(name, function, arguments)?;
        let mut operands = operands.into_iter().collect::<Option<Vec<_>>>()?.into_iter().map(Some).collect::<Vec<_>>();
        let mut actuals = Vec::with_capacity(order.len());
        for index in order {
            actuals.push((operands[index].take()?, arguments[index].value.span));
        }
        let actuals = match function {
            Function::Standard(function) => match self.operator(function, actuals, span) {
                Ok(value) => return value,
                Err(actuals) => actuals,
            },
            _ => actuals,
        };
        let actuals = actuals.into_iter().map(|(operand, span)| Actual { operand: Some(operand), span }).collect();
        let (function, operands, ty) = self.typed_call(function, name, actuals, expected)?;
        self.called(function, operands.into_iter().map(|(operand, _)| operand).collect(), ty, span)
    }

    /// A function that is an operator, or nothing at all; else its operands again.
    fn operator(
        &mut self,
        function: StandardFunction,
        mut actuals: Vec<(Operand, Span)>,
        span: Span,
    ) -> Result<Option<Operand>, Vec<(Operand, Span)>> {
        match (function, actuals.as_slice()) {
            (StandardFunction::Move, _) => Ok(actuals.pop().map(|(operand, _)| operand)),
            (StandardFunction::Not, _) => {
                let unary = |(operand, inner)| self.unary_of(UnaryOperator::Not, operand, inner, span);
                Ok(actuals.pop().and_then(unary))
            }
            (_, [(first, _), _]) => {
                let of_time = function.of_time().is_some() && first.ty() == Some(Elementary::Time);
                let op = operator(function).filter(|_| !of_time);
                match op.and_then(|op| Some((op, actuals.pop()?, actuals.pop()?))) {
                    Some((op, right, left)) => Ok(self.binary_of(op, left, right, span)),
                    None => Err(actuals),
                }
            }
            _ => Err(actuals),
        }
    }

    fn unknown_function(&mut self, name: &Name) {
        let text = clipped(&name.text);
        let problem = Diagnostic::new(Code::UnknownFunction, name.span, format!("there is no function `{text}`"));
        let names = Function::names().iter().map(String::as_str);
        let block = StandardBlock::from_name(&name.text).is_some();
        let hint = if block || self.scope.find(name).is_some() {
            Some("a block is called in the rung, outside braces and formulas".to_owned())
        } else {
            self.scope.suggest_among(&name.text, names).map(|near| format!("did you mean `{near}`?"))
        };
        self.report.push(Diagnostic { hint, ..problem });
    }

    /// For each parameter in order the argument that it gets.
    fn arrange(&mut self, name: &Name, function: Function, arguments: &[FunctionArgument]) -> Option<Vec<usize>> {
        let least = match function {
            Function::Standard(function) => function.parameters().len(),
            Function::Convert { .. } | Function::Truncate { .. } => 1,
        };
        let extensible = matches!(function, Function::Standard(function) if function.is_extensible());
        let signature = signature(name, function);
        let wrong = |span, message| {
            Diagnostic::new(Code::WrongArguments, span, message).hint(format!("its parameters are {signature}"))
        };
        let named = arguments.iter().filter(|argument| argument.parameter.is_some()).count();
        if named == 0 {
            let fits = arguments.len() == least || extensible && arguments.len() > least;
            if !fits {
                let at_least = if extensible { "at least " } else { "" };
                let message =
                    format!("{} takes {at_least}{} arguments, and this is {}", name.text, least, arguments.len());
                self.report.push(wrong(name.span, message));
            }
            return fits.then(|| (0..arguments.len()).collect());
        }
        if named < arguments.len() {
            self.report.push(wrong(name.span, "either all arguments name their parameters or none does".to_owned()));
            return None;
        }
        let mut places = Vec::with_capacity(arguments.len());
        for (index, parameter) in arguments
            .iter()
            .enumerate()
            .filter_map(|(index, argument)| argument.parameter.as_ref().map(|parameter| (index, parameter)))
        {
            let place = match function {
                Function::Standard(function) => function.place(&parameter.text),
                _ => parameter.text.eq_ignore_ascii_case("IN").then_some(0),
            };
            let Some(place) = place else {
                let text = clipped(&parameter.text);
                let message = format!("{} has no parameter `{text}`", name.text);
                let problem = Diagnostic::new(Code::UnknownPin, parameter.span, message);
                self.report.push(problem.hint(if parameter.text.eq_ignore_ascii_case("EN") {
                    format!(
                        "the power before the braces is its EN; or call the box, `{}(EN := …)`, outside braces",
                        name.text
                    )
                } else {
                    format!("its parameters are {signature}")
                }));
                return None;
            };
            places.push((place, index));
        }
        places.sort_unstable();
        if let Some(twice) = places.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            let span = arguments[twice[1].1].parameter.as_ref().map_or(name.span, |parameter| parameter.span);
            self.report.push(Diagnostic::new(Code::DuplicatePin, span, "this parameter has an argument already"));
            return None;
        }
        if places.len() < least || places.iter().enumerate().any(|(index, (place, _))| *place != index) {
            self.report.push(wrong(name.span, "a parameter has no argument".to_owned()));
            return None;
        }
        Some(places.into_iter().map(|(_, index)| index).collect())
    }

    /// The operands of a call in the types that its function takes, each with its place, and the type of the result.
    pub(super) fn typed_call(
        &mut self,
        function: Function,
        name: &Name,
        actuals: Vec<Actual>,
        expected: Option<Elementary>,
    ) -> Option<TypedCall> {
        let standard = match function {
            Function::Standard(function) => function,
            Function::Convert { from, to } => {
                let operand = self.only_operand(name, actuals, from, Class::Any)?;
                return Some((function, vec![operand], to));
            }
            Function::Truncate { from, to } => {
                let operand = self.only_operand(name, actuals, from, Class::Real)?;
                let expected = expected.filter(|ty| ty.is_integer());
                return Some((function, vec![operand], to.or(expected).unwrap_or(Elementary::Dint)));
            }
        };
        let of_time = standard.of_time().filter(|_| {
            actuals.len() == 2 && actuals[0].operand.as_ref().and_then(Operand::ty) == Some(Elementary::Time)
        });
        let function = of_time.unwrap_or(standard);
        let generic = self.choose(function, name, &actuals, expected);
        let mut operands = Vec::with_capacity(actuals.len());
        for (place, Actual { operand, span }) in actuals.into_iter().enumerate() {
            let ty = match function.parameter(place)?.ty {
                ParameterType::Generic => generic?,
                ParameterType::Exactly(ty) => ty,
                ParameterType::Own(class) => {
                    let ty = operand.as_ref().map_or(Elementary::Int, |operand| own_type(operand, class));
                    if !class.contains(ty) {
                        self.not_taken(&name.text, class.describe(), ty.name(), span);
                        return None;
                    }
                    ty
                }
                ParameterType::Scale => operand.as_ref().map_or(Elementary::Lint, scale_type),
            };
            operands.push(match operand {
                Some(operand) => (self.coerce(operand, ty, span)?, span),
                None => (constant(Value::default_of(ty)), span),
            });
        }
        let ty = match function.result() {
            ResultType::Generic => generic?,
            ResultType::Exactly(ty) => ty,
        };
        Some((Function::Standard(function), operands, ty))
    }

    /// The operand of a function that takes only one, out of a class.
    fn only_operand(
        &mut self,
        name: &Name,
        mut actuals: Vec<Actual>,
        from: Option<Elementary>,
        class: Class,
    ) -> Option<(Expression, Span)> {
        let Actual { operand, span } = actuals.pop()?;
        let operand = operand.unwrap_or(Operand::Untyped(Untyped::Integer(0)));
        let ty = from.unwrap_or_else(|| own_type(&operand, class));
        let operand = self.coerce(operand, ty, span)?;
        if !class.contains(ty) {
            self.not_taken(&name.text, class.describe(), ty.name(), span);
            return None;
        }
        Some((operand, span))
    }

    /// The type of a function's generic operands. `None`: there is no such, and where there are such operands that was
    /// reported.
    fn choose(
        &mut self,
        function: StandardFunction,
        name: &Name,
        actuals: &[Actual],
        expected: Option<Elementary>,
    ) -> Option<Elementary> {
        let is_generic = |place| function.parameter(place).is_some_and(|found| found.ty == ParameterType::Generic);
        let generic = || actuals.iter().enumerate().filter(|(place, _)| is_generic(*place)).map(|(_, actual)| actual);
        let span = generic().map(|actual| actual.span).reduce(Span::to)?;
        // What a comparison goes to says nothing of what it compares.
        let expected = expected.filter(|_| function.result() == ResultType::Generic);
        let mut typed: Vec<Elementary> = Vec::new();
        let mut untyped: Vec<Untyped> = Vec::new();
        for actual in generic() {
            match &actual.operand {
                Some(Operand::Typed(Expression { ty, .. })) if !typed.contains(ty) => typed.push(*ty),
                Some(Operand::Typed(_)) | None => {}
                Some(Operand::Untyped(number)) => untyped.push(*number),
            }
        }
        let holds_all = |to: &Elementary| typed.iter().all(|from| from == to || types::widens(*from, *to));
        let class = function.class();
        let ty = match typed.iter().copied().find(holds_all) {
            Some(ty) if untyped.iter().any(|number| matches!(number, Untyped::Real(_))) => {
                types::real_beside(ty).unwrap_or(ty)
            }
            Some(ty) => ty,
            None if typed.is_empty() => {
                let takes = |ty: &Elementary| class.contains(*ty) && untyped.iter().all(|number| number.suits(*ty));
                expected.filter(takes).unwrap_or_else(|| default_type(&untyped, class))
            }
            None => {
                let names: Vec<&str> = typed.iter().map(|ty| ty.name()).collect();
                let message = format!("{} takes operands of one type, and these are {}", name.text, names.join(", "));
                let hint = "only widening without loss is implied, and none of them holds every value of the others";
                self.report.push(Diagnostic::new(Code::TypeMismatch, span, message).hint(hint));
                return None;
            }
        };
        if !class.contains(ty) {
            self.not_taken(&name.text, class.describe(), ty.name(), span);
            return None;
        }
        Some(ty)
    }

    /// The call, or its value where all its operands are constants.
    pub(super) fn called(
        &mut self,
        function: Function,
        arguments: Vec<Expression>,
        ty: Elementary,
        span: Span,
    ) -> Option<Operand> {
        let constants: Option<Vec<_>> = arguments.iter().map(Expression::constant).collect();
        if let Some(constants) = constants {
            let value = fold::function(function, ty, &constants);
            if value.is_none() {
                self.overflow(Some(ty), span);
            }
            return value.map(constant).map(Operand::Typed);
        }
        Some(Operand::Typed(Expression { ty, kind: ExpressionKind::Call { function, arguments: arguments.into() } }))
    }
}

/// The operator that a function of two operands is.
fn operator(function: StandardFunction) -> Option<BinaryOperator> {
    use StandardFunction as F;
    Some(match function {
        F::Add | F::AddTime => BinaryOperator::Add,
        F::Subtract | F::SubtractTime => BinaryOperator::Subtract,
        F::Multiply => BinaryOperator::Multiply,
        F::Divide => BinaryOperator::Divide,
        F::Modulo => BinaryOperator::Modulo,
        F::And => BinaryOperator::And,
        F::Or => BinaryOperator::Or,
        F::Xor => BinaryOperator::Xor,
        F::Greater => BinaryOperator::Greater,
        F::GreaterOrEqual => BinaryOperator::GreaterOrEqual,
        F::Equal => BinaryOperator::Equal,
        F::LessOrEqual => BinaryOperator::LessOrEqual,
        F::Less => BinaryOperator::Less,
        F::NotEqual => BinaryOperator::NotEqual,
        _ => return None,
    })
}

/// The type of an operand that stands for itself.
fn own_type(operand: &Operand, class: Class) -> Elementary {
    match operand {
        Operand::Typed(expression) => expression.ty,
        Operand::Untyped(number) => default_type(&[*number], class),
    }
}

/// LINT or LREAL: what the factor of a duration becomes.
fn scale_type(operand: &Operand) -> Elementary {
    let real = match operand {
        Operand::Typed(expression) => expression.ty.is_real(),
        Operand::Untyped(number) => matches!(number, Untyped::Real(_)),
    };
    if real { Elementary::Lreal } else { Elementary::Lint }
}

/// The type of numbers where nothing says which: the first of the usual ones that holds them all.
fn default_type(numbers: &[Untyped], class: Class) -> Elementary {
    use Elementary::{Dint, Dword, Int, Lint, Lword, Real, Ulint, Word};
    let real = class == Class::Real || numbers.iter().any(|number| matches!(number, Untyped::Real(_)));
    let bits = matches!(class, Class::Bits | Class::WideBits)
        || numbers.iter().any(|number| matches!(number, Untyped::Bits(_)));
    let candidates: &[Elementary] = if real {
        &[Real]
    } else if bits {
        &[Word, Dword, Lword]
    } else {
        &[Int, Dint, Lint, Ulint]
    };
    let holds_all = |ty: &&Elementary| numbers.iter().all(|number| number.typed(**ty).is_some());
    *candidates.iter().find(holds_all).unwrap_or(&candidates[0])
}
