//! Random programs, most of them faulty: checking gives an answer, and leaves nothing out of a program that runs.

use proptest::collection::vec;
use proptest::prelude::*;

use super::build::*;
use super::*;
use crate::check;
use crate::elementary::Elementary;
use crate::ladder::library::StandardBlock;
use crate::ladder::{
    self, Argument, BinaryOperator, Branch, CaseBranch, CaseLabel, CoilKind, ConditionalBranch, ContactKind, Element,
    ElementKind, Expression, Rung, Statement, StatementKind, Variable, Wire,
};

const TYPES: [&str; 9] = ["BOOL", "INT", "DINT", "WORD", "REAL", "TIME", "TON", "NONE", "BYTE"];
const COILS: [CoilKind; 3] = [CoilKind::Plain, CoilKind::Set, CoilKind::Rising];
const CONTACTS: [ContactKind; 4] = [ContactKind::Open, ContactKind::Closed, ContactKind::Rising, ContactKind::Falling];

/// The types of most expressions.
#[derive(Clone, Copy)]
enum Wanted {
    Bool,
    Int,
    Word,
    Time,
}

const WANTED: [Wanted; 4] = [Wanted::Bool, Wanted::Int, Wanted::Word, Wanted::Time];

impl Wanted {
    /// What of this type is always there, to be written.
    fn targets(self) -> &'static [&'static str] {
        match self {
            Self::Bool => &["b", "C", "w.3", "%QX8.1", "t.IN"],
            Self::Int => &["n", "N"],
            Self::Word => &["w", "%MW1"],
            Self::Time => &["e", "t.PT"],
        }
    }

    /// What of this type is always there, and cannot be written.
    fn sources(self) -> &'static [&'static str] {
        match self {
            Self::Bool => &["a", "%IX0.0", "t.Q"],
            Self::Int => &["k"],
            Self::Word => &["%IW9"],
            Self::Time => &["t.ET"],
        }
    }
}

/// Choices, one a byte; when they run out, always the first. The first choices are those without a fault.
struct Choices(std::vec::IntoIter<u8>);

impl Choices {
    fn below(&mut self, bound: usize) -> usize {
        usize::from(self.0.next().unwrap_or(0)) % bound
    }

    fn rarely(&mut self) -> bool {
        self.0.next().is_some_and(|byte| byte > 252)
    }

    fn of<T: Copy>(&mut self, all: &[T]) -> T {
        all[self.below(all.len())]
    }

    fn list<T>(&mut self, most: usize, mut one: impl FnMut(&mut Self) -> T) -> Vec<T> {
        (0..self.below(most + 1)).map(|_| one(self)).collect()
    }

    fn wanted(&mut self) -> Wanted {
        self.of(&WANTED)
    }

    fn literal(&mut self, wanted: Wanted) -> Expression {
        if self.rarely() {
            let ty = self.of(&Elementary::ALL);
            return [int(u128::MAX), real(1.5), typed(ty, 70_000)][self.below(3)].clone();
        }
        match wanted {
            Wanted::Bool => truth(self.below(2) == 1),
            Wanted::Int => typed(Elementary::Int, [1, 0, 300][self.below(3)]),
            Wanted::Word => int([1, 0, 0xFFFF][self.below(3)]),
            Wanted::Time => seconds(3),
        }
    }

    fn source(&mut self, wanted: Wanted) -> &'static str {
        let wanted = if self.rarely() { self.wanted() } else { wanted };
        let all = [wanted.targets(), wanted.sources()].concat();
        self.of(&all)
    }

    fn target(&mut self, wanted: Wanted) -> &'static str {
        if self.rarely() { self.source(wanted) } else { self.of(wanted.targets()) }
    }

    fn expression(&mut self, wanted: Wanted, depth: usize) -> Expression {
        use BinaryOperator::{Add, And, Equal, Less, Modulo, Or, Subtract, Xor};
        let deeper = |choices: &mut Self, wanted| choices.expression(wanted, depth - 1);
        match (self.below(if depth == 0 { 2 } else { 5 }), wanted) {
            (0, _) => read(self.source(wanted)),
            (1, _) => self.literal(wanted),
            (2, Wanted::Bool | Wanted::Word) => not(deeper(self, wanted)),
            (2, _) => negate(deeper(self, wanted)),
            (3, Wanted::Bool) => {
                let of = self.wanted();
                let (left, op) = (deeper(self, of), self.of(&[Equal, Less]));
                binary(left, op, deeper(self, of))
            }
            _ => {
                let usual: &[BinaryOperator] = match wanted {
                    Wanted::Bool | Wanted::Word => &[And, Or, Xor],
                    Wanted::Int => &[Subtract, Modulo],
                    Wanted::Time => &[Add, Subtract],
                };
                let op = if self.rarely() { self.of(&BinaryOperator::ALL) } else { self.of(usual) };
                let left = deeper(self, wanted);
                binary(left, op, deeper(self, wanted))
            }
        }
    }

    /// A declaration, probably with a fault.
    fn variable(&mut self) -> Variable {
        let (name, ty, wanted) = (["x", "y", "n", "t1"][self.below(4)], self.of(&TYPES), self.wanted());
        let variable = match self.below(4) {
            0 => memory(name, ty),
            1 => input(name).typed(ty),
            2 => output(name).typed(ty),
            _ => constant(name, ty, self.expression(wanted, 2)),
        };
        let variable = if self.below(3) == 0 { variable.retained() } else { variable };
        let variable = if self.below(3) == 0 { variable.starting(self.expression(wanted, 2)) } else { variable };
        let addresses = ["%IX0.0", "%QW1", "%QX2.1", "%MW0", "%MX0.9"];
        if self.below(3) == 0 { variable.at(self.of(&addresses)) } else { variable }
    }

    fn call(&mut self, depth: usize) -> Element {
        let bool_input = |choices: &mut Self, pin| match choices.below(2) {
            0 => value(pin, choices.expression(Wanted::Bool, 2)),
            _ => wired(pin, choices.list(2, |choices| choices.element(depth - 1))),
        };
        if self.below(2) == 0 {
            let preset = value("PT", self.expression(Wanted::Time, 1));
            let power = if self.rarely() { Some("ET") } else { self.of(&[None, Some("Q")]) };
            let arguments = [self.list(1, |choices| bool_input(choices, "IN")), vec![preset]].concat();
            call_through("t:TON", arguments, power)
        } else {
            let block = if self.rarely() { self.of(StandardBlock::ALL).name() } else { "CTU" };
            let pin = if self.rarely() { "Q" } else { "R" };
            let reset = self.list(2, |choices| bool_input(choices, pin));
            let count = to("CV", self.target(Wanted::Int));
            call(&format!("c:{block}"), [reset, vec![count]].concat())
        }
    }

    fn function_box(&mut self) -> Element {
        let function =
            if self.rarely() { "TRUNC" } else { self.of(&["SUB", "LIMIT", "GT", "twice", "MOVE", "INT_TO_TIME"]) };
        let pins: &[&str] = match function {
            "LIMIT" => &["MN", "IN", "MX"],
            "SUB" | "GT" => &["IN1", "IN2"],
            _ => &["IN"],
        };
        let mut arguments: Vec<Argument> = pins.iter().map(|pin| value(pin, self.expression(Wanted::Int, 1))).collect();
        let target = match function {
            "GT" => Wanted::Bool,
            "INT_TO_TIME" => Wanted::Time,
            _ => Wanted::Int,
        };
        arguments.push(to("OUT", self.target(target)));
        if self.rarely() {
            arguments.pop();
        }
        call(function, arguments)
    }

    fn statements(&mut self, depth: usize) -> Vec<Statement> {
        self.list(3, |choices| choices.statement(depth))
    }

    fn statement(&mut self, depth: usize) -> Statement {
        let kind = match self.below(if depth == 0 { 1 } else { 5 }) {
            0 | 4 => {
                let wanted = self.wanted();
                let target = reference(self.target(wanted));
                StatementKind::Assignment { target, value: self.expression(wanted, 2) }
            }
            1 => {
                let branch =
                    ConditionalBranch { condition: self.expression(Wanted::Bool, 2), body: self.statements(depth - 1) };
                StatementKind::If { branches: vec![branch], otherwise: self.statements(depth - 1) }
            }
            2 => {
                let label = CaseLabel { first: int(self.below(9) as u128), last: None };
                let branch = CaseBranch { labels: vec![label], body: self.statements(depth - 1) };
                let selector = self.expression(Wanted::Int, 1);
                StatementKind::Case { selector, branches: vec![branch], otherwise: self.statements(depth - 1) }
            }
            _ => {
                let last = self.of(&[3, 0, 300, 32_767, 70_000]);
                StatementKind::For {
                    variable: reference("n"),
                    first: int(0),
                    last: if self.rarely() { read("n") } else { int(last) },
                    step: self.rarely().then(|| int(0)),
                    body: self.statements(depth - 1),
                }
            }
        };
        Statement { kind, span: span("statement") }
    }

    fn element(&mut self, depth: usize) -> Element {
        match self.below(if depth == 0 { 6 } else { 9 }) {
            0 => contact(self.of(&CONTACTS), read(self.source(Wanted::Bool))),
            1 => coil_of(self.of(&COILS), self.target(Wanted::Bool)),
            2 => when(self.expression(Wanted::Bool, 3)),
            3 => {
                let wanted = self.wanted();
                assign(self.target(wanted), self.expression(wanted, 3))
            }
            4 => self.function_box(),
            5 => statements(self.statements(2)),
            6 | 7 => {
                let first = self.branch(depth - 1);
                parallel([vec![first], self.list(2, |choices| choices.branch(depth - 1))].concat())
            }
            _ => self.call(depth),
        }
    }

    fn branch(&mut self, depth: usize) -> Branch {
        branch(self.list(4, |choices| choices.element(depth)))
    }

    fn rung(&mut self) -> Rung {
        let mut branches = vec![self.branch(3)];
        if self.below(3) == 1 {
            let nodes = [["", "w1"], ["", "W1"], ["w1", "w2"], ["w1", ""], ["w2", ""]];
            let mut pieces: Vec<_> =
                nodes.map(|[from, to]| between(from, self.list(2, |choices| choices.element(1)), to)).to_vec();
            if self.rarely() {
                pieces.swap(0, self.below(5));
            }
            branches.extend(pieces);
        }
        let rung = network(branches);
        if self.below(6) == 1 { off(rung) } else { rung }
    }

    fn program(&mut self) -> Program {
        let usual = vec![
            input("a"),
            output("b"),
            memory("c", "BOOL"),
            memory("n", "INT"),
            memory("w", "WORD"),
            memory("e", "TIME"),
            memory("t", "TON"),
            constant("k", "INT", int(5)),
        ];
        let more = if self.below(3) == 2 { self.list(4, Self::variable) } else { vec![] };
        let program = program([usual, more].concat(), self.list(4, Self::rung));
        let program = with_function(program);
        if self.below(4) == 1 { imported(program) } else { program }
    }
}

fn statements(statements: Vec<Statement>) -> Element {
    Element { kind: ElementKind::Statements(statements), span: span("statements") }
}

/// The program with a function `twice` of its own.
fn with_function(mut program: Program) -> Program {
    let result = Some(ladder::TypeReference::of_name(name("INT")));
    let value = binary(read("IN"), BinaryOperator::Add, read("IN"));
    let unit = ladder::Unit {
        kind: ladder::UnitKind::Function { result },
        name: name("twice"),
        variables: vec![input("IN").typed("INT")],
        rungs: vec![rung(vec![assign("twice", value)])],
        span: span("twice"),
    };
    program.units.insert(0, unit);
    program
}

/// Elements and wires of a circuit as drawn.
fn drawn(circuit: &ladder::Circuit) -> usize {
    let elements = circuit.branches.iter().flat_map(|branch| &branch.elements);
    let within = |argument: &Argument| match &argument.wire {
        Wire::Circuit(circuit) => drawn(circuit),
        Wire::Value(_) | Wire::Output(_) => 0,
    };
    elements
        .map(|element| match &element.kind {
            ElementKind::Parallel(circuit) => 1 + drawn(circuit),
            ElementKind::Block(call) => 1 + call.arguments.iter().map(|argument| 1 + within(argument)).sum::<usize>(),
            _ => 1,
        })
        .sum()
}

/// Elements and wires of a circuit as checked.
fn kept(circuit: &check::Circuit) -> usize {
    let elements = circuit.branches.iter().flat_map(|branch| &branch.elements);
    let within = |input: &check::Input| match &input.wire {
        check::Wire::Circuit(circuit) => kept(circuit),
        check::Wire::Value(_) => 0,
    };
    elements
        .map(|element| match element {
            check::Element::Parallel(circuit) => 1 + kept(circuit),
            check::Element::Call(call) => {
                1 + call.outputs.len() + call.inputs.iter().map(|input| 1 + within(input)).sum::<usize>()
            }
            _ => 1,
        })
        .sum()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2_000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_program_runs_exactly_when_it_has_no_error_and_then_all_of_it_does(bytes in vec(any::<u8>(), 0..400)) {
        let program = Choices(bytes.into_iter()).program();
        let (checked, diagnostics) = check(&program);
        prop_assert_eq!(checked.is_none(), diagnostics.iter().any(Diagnostic::is_error), "{:?}", diagnostics);
        if let Some(checked) = checked {
            let drawn: Vec<_> =
                program.units[1].rungs.iter().filter(|rung| rung.enabled).map(|rung| drawn(&rung.circuit)).collect();
            let kept: Vec<_> = checked.units()[1].rungs.iter().map(|rung| kept(&rung.circuit)).collect();
            prop_assert_eq!(drawn, kept);
        }
    }
}
