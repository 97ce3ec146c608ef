//! Assertions: boolean expressions over what can be watched of a program, which are to hold after every scan.
//!
//! One is checked and lowered as the program of a single rung that reads its variables as inputs; then its logic is put
//! behind the program's own, as a task that runs in every round, over the slots of the variables themselves. So an
//! assertion means what the same expression means in a rung, on every engine. Nothing here may change what the program
//! computes.

use std::collections::HashMap;
use std::sync::Arc;

use crate::check::check;
use crate::diagnostic::{Code, Diagnostic, any_error};
use crate::elementary::{Elementary, Value};
use crate::frontend::native;
use crate::ladder::{
    Element, ElementKind, Expression, ExpressionKind, Literal, Name, Origin, Program as Drawn, Reference, Root, Step,
    TypeReference, UnaryOperator, Variable, VariableClass,
};
use crate::logic::image::{EarlierLayout, Observed};
use crate::logic::{Area, Instruction, Layout, LayoutBuilder, Op, Program, Section, Slot, SlotId, Task, ValueId};
use crate::lower::lower;
use crate::source::{Source, Span};

/// The variable of the small program that is TRUE while the assertion holds.
const HOLDS: &str = "holds";

/// Adds an assertion to a program; gives the slot, a BOOL that belongs to no variable, which is TRUE after each scan
/// after which the assertion holds.
///
/// # Errors
/// What is wrong with it, with the text that the places are in.
pub fn assert(program: &mut Program, expression: &str) -> Result<SlotId, Box<(Source, Vec<Diagnostic>)>> {
    let text = format!("program assertion\noutput {HOLDS}\nrung\n  {{{expression}}} ({HOLDS})\n");
    let source = Source::new("--assert", text);
    let result = small_program(&source, &program.layout);
    result.and_then(|small| splice(program, &small)).map_err(|diagnostics| Box::new((source, diagnostics)))
}

/// The program of a single rung.
fn small_program(source: &Source, layout: &Layout) -> Result<Program, Vec<Diagnostic>> {
    let mut parsed = native::parse(source);
    if any_error(&parsed.diagnostics) {
        return Err(parsed.diagnostics);
    }
    let mut inputs = Inputs { layout, variables: Vec::new(), problems: Vec::new() };
    let Some(condition) = the_condition(&mut parsed.program) else {
        let end = source.text().len();
        return Err(vec![bad(Span::new(0, end), "this is not one boolean expression")]);
    };
    inputs.expression(condition);
    if !inputs.problems.is_empty() {
        return Err(inputs.problems);
    }
    let variables = inputs.variables;
    parsed.program.units.iter_mut().for_each(|unit| unit.variables.extend(variables.iter().cloned()));
    let (checked, diagnostics) = check(&parsed.program);
    let Some(checked) = checked else { return Err(diagnostics) };
    lower(&checked, source, None).map_err(|_| vec![bad(Span::default(), "the process image is too large")])
}

fn bad(span: Span, message: impl Into<String>) -> Diagnostic {
    Diagnostic::new(Code::BadAssertion, span, message)
}

/// The expression of a program that is one rung with one condition before its coil, and nothing else.
fn the_condition(program: &mut Drawn) -> Option<&mut Expression> {
    debug_assert_eq!(program.origin, Origin::Native, "it is native text");
    let [unit] = &mut program.units[..] else { return None };
    let ([rung], [_]) = (&mut unit.rungs[..], &unit.variables[..]) else { return None };
    let [branch] = &mut rung.circuit.branches[..] else { return None };
    match &mut branch.elements[..] {
        [Element { kind: ElementKind::Condition(condition), .. }, Element { kind: ElementKind::Coil { .. }, .. }] => {
            Some(condition)
        }
        _ => None,
    }
}

/// The variables that an expression reads, each made an input of the small program with the whole name as its own.
struct Inputs<'a> {
    layout: &'a Layout,
    variables: Vec<Variable>,
    problems: Vec<Diagnostic>,
}

impl Inputs<'_> {
    fn expression(&mut self, expression: &mut Expression) {
        match &mut expression.kind {
            ExpressionKind::Literal(_) | ExpressionKind::Array(_) | ExpressionKind::Structure(_) => {}
            ExpressionKind::Read(reference) => self.reference(reference),
            ExpressionKind::Unary(_, a) => self.expression(a),
            ExpressionKind::Binary(_, a, b) => {
                self.expression(a);
                self.expression(b);
            }
            ExpressionKind::Call { arguments, .. } => {
                arguments.iter_mut().for_each(|argument| self.expression(&mut argument.value));
            }
        }
    }

    fn reference(&mut self, reference: &mut Reference) {
        let span = reference.span;
        let Some((name, bit)) = whole_name(reference) else {
            let problem = bad(span, "an assertion names variables, with constant indices, and no addresses");
            return self.problems.push(problem.hint("the header of `rung sim`'s trace lists what can be named"));
        };
        let observed = self.layout.observed().iter().find(|observed| same(observed, &name));
        let Some(Observed { name: exact, slot }) = observed else {
            let problem = bad(span, format!("the program has no variable `{name}`"));
            return self.problems.push(problem.hint("the header of `rung sim`'s trace lists what can be named"));
        };
        let ty = self.layout.slot(*slot).ty;
        let name = Name::new(exact.clone(), span);
        if self.variables.iter().all(|variable| variable.name.key() != name.key()) {
            self.variables.push(Variable {
                class: VariableClass::Input,
                name: name.clone(),
                ty: Some(TypeReference::of_name(Name::new(ty.name(), span))),
                address: None,
                initial: None,
                retain: false,
                span,
            });
        }
        *reference = Reference { root: Root::Name(name), steps: bit.into_iter().collect(), span };
    }
}

fn same(observed: &Observed, name: &str) -> bool {
    observed.name.to_lowercase() == name.to_lowercase()
}

/// A reference's name as a trace has it, and the bit that it reads of that, if it does.
fn whole_name(reference: &Reference) -> Option<(String, Option<Step>)> {
    let Root::Name(name) = &reference.root else { return None };
    let mut text = name.text.to_string();
    let (mut steps, mut bit) = (&reference.steps[..], None);
    if let [before @ .., last @ Step::Bit(..)] = steps {
        (steps, bit) = (before, Some(last.clone()));
    }
    for step in steps {
        match step {
            Step::Member(member) => text.push_str(&format!(".{}", member.text)),
            Step::Index(indices, _) => {
                let indices: Option<Vec<String>> = indices.iter().map(number).collect();
                text.push_str(&format!("[{}]", indices?.join(",")));
            }
            Step::Bit(..) => return None,
        }
    }
    Some((text, bit))
}

/// A constant index as a name has it.
fn number(index: &Expression) -> Option<String> {
    match &index.kind {
        ExpressionKind::Literal(Literal::Integer { value, .. }) => Some(value.get().to_string()),
        ExpressionKind::Unary(UnaryOperator::Negate, inner) => Some(format!("-{}", number(inner)?)),
        _ => None,
    }
}

/// Puts the small program's logic behind a program's own, over that one's slots.
fn splice(program: &mut Program, small: &Program) -> Result<SlotId, Vec<Diagnostic>> {
    let old = &program.layout;
    let mut layout = LayoutBuilder::new();
    for slot in old.slots() {
        layout.slot(slot.clone());
    }
    for array in old.arrays() {
        layout.array(array.first, array.count);
    }
    for observed in old.observed() {
        layout.observe(observed.name.clone(), observed.slot);
    }
    let number = old.slots().iter().filter(|slot| slot.name.starts_with("#assertion")).count();
    let names: HashMap<SlotId, &str> =
        small.layout.observed().iter().map(|observed| (observed.slot, observed.name.as_str())).collect();
    let mut holds = None;
    let mut slots = Vec::new();
    for (id, slot) in (0..).map(SlotId).zip(small.layout.slots()) {
        let named = names.get(&id).and_then(|name| old.observed().iter().find(|observed| same(observed, name)));
        slots.push(match named {
            Some(observed) if slot.area == Area::Input => observed.slot,
            _ => {
                let name = format!("#assertion {number} {}", slot.name).into();
                let added = Slot { name, area: Area::State, retain: false, ..slot.clone() };
                // It holds until it is known not to.
                let is_result = slot.area == Area::Output && slot.ty == Elementary::Bool;
                let initial = if is_result { Value::bool(true) } else { slot.initial };
                let added = layout.slot(Slot { initial, ..added });
                if is_result {
                    holds = Some(added);
                }
                added
            }
        });
    }
    let too_large = || vec![bad(Span::default(), "the process image is too large")];
    program.layout = Arc::new(layout.finish(Some(&EarlierLayout::from(&**old))).map_err(|_| too_large())?);

    let count = |length: usize| u32::try_from(length).unwrap_or(u32::MAX);
    let first = count(program.instructions.len());
    let origins = count(program.origins.len());
    program.origins.extend(small.origins.iter().cloned());
    program.sections.extend(small.sections.iter().map(|section| Section {
        origin: section.origin + origins,
        end: section.end + first,
        starts_chunk: section.starts_chunk,
    }));
    program.tasks.push(Task { name: format!("assertion {number}"), ..Task::always(count(program.sections.len())) });
    program.instructions.extend(small.instructions.iter().map(|instruction| {
        let op = instruction.op.map_operands(|operand| ValueId(operand.0 + first));
        let op = match op {
            Op::Load(slot) => Op::Load(slots[slot.index()]),
            Op::Store(slot, value) => Op::Store(slots[slot.index()], value),
            other => other,
        };
        Instruction { op, ..*instruction }
    }));
    holds.ok_or_else(too_large)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnostic;
    use crate::engine::interp::Interpreter;
    use crate::frontend;
    use crate::logic::verify;
    use rung_runtime::Scan;

    const TEXT: &str = "program p\ninput a, b\noutput q\nvar n : INT\nvar list : array [0..2] of INT\nvar w : WORD\n\
        rung\n  a t:TON(PT := T#20ms) (q)\nrung\n  ^b {n := n + 1; list[1] := n; w := INT_TO_WORD(n)}\n";

    fn program() -> Program {
        let source = Source::new("p.rung", TEXT);
        let parsed = frontend::parse(&source);
        let (checked, problems) = check(&parsed.program);
        let checked = checked.unwrap_or_else(|| panic!("{}", diagnostic::render(&source, &problems)));
        lower(&checked, &source, None).expect("a small image")
    }

    /// In which of some scans, 10 ms apart, an assertion holds; `a` is on, and `b` in every other scan.
    fn holds(expression: &str) -> Vec<bool> {
        let mut program = program();
        let plain = program.layout.size();
        let slot = assert(&mut program, expression).unwrap_or_else(|refused| {
            let (source, problems) = *refused;
            panic!("{}", diagnostic::render(&source, &problems));
        });
        assert_eq!(verify(&program), Ok(()));
        assert!(program.layout.size() > plain);
        let mut interpreter = Interpreter::new(&program);
        let mut image = program.layout.initial_image();
        image[0] = 1;
        let slot = program.layout.slot(slot);
        (0..5)
            .map(|scan| {
                image[1] = u8::from(scan % 2 == 1);
                interpreter.scan(&mut image, scan * 10_000_000);
                slot.read(&image).is_true()
            })
            .collect()
    }

    #[test]
    fn an_assertion_means_what_the_expression_means_in_a_rung() {
        assert_eq!(holds("NOT q"), [true, true, false, false, false]);
        assert_eq!(holds("t.ET < T#20ms OR T.q"), [true; 5]);
        assert_eq!(holds("n < 2"), [true, true, true, false, false]);
        assert_eq!(holds("List[1] = n AND NOT w.1"), [true, true, true, false, false]);
        assert_eq!(holds("MAX(n, 1) = 1 AND a"), [true, true, true, false, false]);
    }

    #[test]
    fn several_assertions_are_told_apart() {
        let mut program = program();
        let first = assert(&mut program, "a").expect("an assertion");
        let second = assert(&mut program, "b").expect("an assertion");
        assert_ne!(first, second);
        assert_eq!(verify(&program), Ok(()));
    }

    #[test]
    fn what_is_no_assertion_is_refused() {
        for (expression, problem) in [
            ("nowhere", "no variable `nowhere`"),
            ("n + 1", "error[R0401]"),
            ("list[n] = 1", "constant indices"),
            ("%IX0.0", "no addresses"),
            ("a} (holds)\nrung\n  {b", "not one boolean expression"),
            ("n := 3", "error[R"),
            ("", "error[R"),
            ("a AND", "error[R"),
        ] {
            let (source, problems) = *assert(&mut program(), expression).expect_err(expression);
            let text = diagnostic::render(&source, &problems);
            assert!(text.contains(problem), "{expression}: {text}");
        }
    }
}
