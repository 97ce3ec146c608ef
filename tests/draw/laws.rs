//! What holds for the picture of any program.

use ::svg::node::element::tag::Type;
use ::svg::parser::Event;
use proptest::prelude::*;
use rung::draw::{TextOptions, svg, text};
use rung::ladder::{
    BinaryOperator, Circuit, CoilKind, ContactKind, Element, ElementKind, ExpressionKind, Program, Rung, Statement,
    StatementKind, UnaryOperator, Wire,
};
use unicode_width::UnicodeWidthStr;

use crate::build::*;

/// Below this width a block may be wider than the page.
const BLOCKS_FIT: usize = 40;

/// A name that every limit leaves whole.
fn any_name() -> impl Strategy<Value = String> {
    (0..1000u32).prop_map(|number| format!("n{number}"))
}

fn any_simple_element() -> impl Strategy<Value = Element> {
    let contacts = [ContactKind::Open, ContactKind::Closed, ContactKind::Rising, ContactKind::Falling];
    let coils = [CoilKind::Plain, CoilKind::Negated, CoilKind::Set, CoilKind::Reset, CoilKind::Rising];
    prop_oneof![
        4 => (any_name(), prop::sample::select(contacts.to_vec())).prop_map(|(name, kind)| contact(kind, &name)),
        2 => (any_name(), prop::sample::select(coils.to_vec())).prop_map(|(name, kind)| coil(kind, &name)),
        1 => any_name().prop_map(|name| condition(binary(BinaryOperator::Less, read(&name), number(7)))),
        1 => any_name().prop_map(|name| assignment(&name, number(12_345))),
        1 => any_name().prop_map(|name| jump(&name)),
        1 => (any_name(), any_name()).prop_map(|(one, other)| {
            let inner = vec![assign(&one, number(1)), assign(&other, number(2))];
            statements(vec![assign(&other, number(3)), when(read(&one), inner)])
        }),
    ]
}

fn any_circuit(elements: BoxedStrategy<Element>) -> impl Strategy<Value = Circuit> {
    let node = prop_oneof![4 => Just(String::new()), 1 => any_name()];
    let branch = (node.clone(), prop::collection::vec(elements, 0..5), node)
        .prop_map(|(from, elements, to)| node_branch(&from, elements, &to));
    prop::collection::vec(branch, 1..4).prop_map(circuit)
}

fn any_block(elements: BoxedStrategy<Element>) -> impl Strategy<Value = Element> {
    let types = ["TON", "ctud", "SR", "R_TRIG", "", "OTHER"];
    let pins = ["IN", "PT", "CU", "CD", "R", "PV", "Q", "X"];
    let wire = prop_oneof![
        any_name().prop_map(|name| value(read(&name))),
        any_name().prop_map(|name| to(&name)),
        any_circuit(elements).prop_map(Wire::Circuit),
    ];
    let argument = (prop::sample::select(pins.to_vec()), wire);
    let chosen_output = prop::sample::select(vec!["", "", "Q", "QD", "nothing"]);
    (any_name(), prop::sample::select(types.to_vec()), prop::collection::vec(argument, 0..5), chosen_output)
        .prop_map(|(name, ty, arguments, output)| chosen(&name, ty, arguments, output))
}

fn any_element(with_blocks: bool) -> BoxedStrategy<Element> {
    any_simple_element()
        .prop_recursive(4, 40, 6, move |inner| {
            let parallel =
                any_circuit(inner.clone()).prop_map(|circuit| element(ElementKind::Parallel(circuit))).boxed();
            let block = any_block(inner.clone()).boxed();
            let blocks = u32::from(with_blocks);
            prop_oneof![3 => inner, 3 => parallel, blocks => block]
        })
        .boxed()
}

fn any_program(with_blocks: bool) -> impl Strategy<Value = Program> {
    let rung = any_circuit(any_element(with_blocks)).prop_map(|circuit| Rung { circuit, ..rung("r", "title", vec![]) });
    prop::collection::vec(rung, 0..4).prop_map(|rungs| program("random", vec![], rungs))
}

/// The names that a circuit's elements show.
fn names(circuit: &Circuit, found: &mut Vec<String>) {
    for branch in &circuit.branches {
        found.extend(branch.from.iter().chain(&branch.to).map(|node| format!(">{}>", node.text)));
        for element in &branch.elements {
            match &element.kind {
                ElementKind::Contact { operand, .. } => read_name(&operand.kind, found),
                ElementKind::Coil { target, .. } | ElementKind::Assignment { target, .. } => {
                    read_name(&ExpressionKind::Read(target.clone()), found);
                }
                ElementKind::Condition(condition) => {
                    if let ExpressionKind::Binary(_, left, _) = &condition.kind {
                        read_name(&left.kind, found);
                    }
                }
                ElementKind::Parallel(inner) => names(inner, found),
                ElementKind::Jump { target } => found.push(target.text.to_string()),
                ElementKind::Return => {}
                ElementKind::Statements(statements) => statement_names(statements, found),
                ElementKind::Block(call) => {
                    read_name(&ExpressionKind::Read(call.instance.clone()), found);
                    for argument in &call.arguments {
                        match &argument.wire {
                            Wire::Value(value) => read_name(&value.kind, found),
                            Wire::Output(target) => read_name(&ExpressionKind::Read(target.clone()), found),
                            Wire::Circuit(inner) => names(inner, found),
                        }
                    }
                }
            }
        }
    }
}

fn statement_names(statements: &[Statement], found: &mut Vec<String>) {
    for statement in statements {
        match &statement.kind {
            StatementKind::Assignment { target, .. } => read_name(&ExpressionKind::Read(target.clone()), found),
            StatementKind::If { branches, .. } => {
                branches.iter().for_each(|branch| statement_names(&branch.body, found));
            }
            _ => {}
        }
    }
}

fn read_name(kind: &ExpressionKind, found: &mut Vec<String>) {
    if let ExpressionKind::Read(reference) = kind
        && let rung::ladder::Root::Name(name) = &reference.root
    {
        found.push(name.text.to_string());
    }
}

fn assert_complete(program: &Program, picture: &str) {
    let mut found = Vec::new();
    program.rungs().for_each(|rung| names(&rung.circuit, &mut found));
    for name in found {
        assert!(picture.contains(&name), "{name} is missing in\n{picture}");
    }
}

fn assert_fits(picture: &str, width: usize) {
    for line in picture.lines() {
        assert!(line.width() <= width, "{} columns instead of {width}:\n{picture}", line.width());
    }
}

/// Every rung's lines begin and end with a rail, so that nothing was drawn over a rail or beyond it.
fn assert_rails(picture: &str) {
    for line in picture.lines().filter(|line| line.starts_with(['┃', '┠'])) {
        assert!(line.ends_with(['┃', '┨']), "no right rail in {line:?} of\n{picture}");
        let crossed = line.chars().skip(1).filter(|c| matches!(c, '┃' | '┠' | '┨')).count();
        assert_eq!(crossed, 1, "rails in {line:?} of\n{picture}");
    }
}

/// Every wire goes on at each of its ends: into another wire, a symbol, a text or a rail.
fn assert_wired(picture: &str) {
    let mut drawn = picture.replace("─ =>", "───>");
    for frame in ["┤ ├", "┤/├", "┤P├", "┤N├"] {
        drawn = drawn.replace(frame, "(x)");
    }
    let rows: Vec<Vec<char>> = drawn.lines().map(|line| line.chars().collect()).collect();
    let at = |row: usize, column: usize| rows.get(row).and_then(|row| row.get(column)).copied().unwrap_or(' ');
    let is_wire = |c: char| ('─'..='╿').contains(&c);
    let meets = |c: char, sides: &str| sides.contains(c);
    let (to_left, to_right) = ("─┐┘┬┴┤┼┨", "─┌└┬┴├┼┠");
    let (up, down) = ("│└┘┴├┤┼", "│┌┐┬├┤┼");
    for (row, characters) in rows.iter().enumerate() {
        for column in 0..characters.len() {
            let (here, right, below) = (at(row, column), at(row, column + 1), at(row + 1, column));
            assert!(!meets(here, to_right) || right != ' ', "a loose end at {row}:{column} of\n{picture}");
            assert!(!meets(right, to_left) || here != ' ', "a loose end right of {row}:{column} of\n{picture}");
            if is_wire(here) && is_wire(right) {
                assert_eq!(
                    meets(here, to_right),
                    meets(right, to_left),
                    "between {row}:{column} and its right in\n{picture}"
                );
            }
            assert_eq!(meets(here, down), meets(below, up), "between {row}:{column} and below in\n{picture}");
        }
    }
}

/// The circuit with all nodes taken away, and the jumps, at which wires end too.
fn without_nodes(circuit: &mut Circuit) {
    for branch in &mut circuit.branches {
        (branch.from, branch.to) = (None, None);
        branch.elements.retain(|element| !matches!(element.kind, ElementKind::Jump { .. }));
        for element in &mut branch.elements {
            match &mut element.kind {
                ElementKind::Parallel(inner) => without_nodes(inner),
                ElementKind::Block(call) => call.arguments.iter_mut().for_each(|argument| {
                    if let Wire::Circuit(inner) = &mut argument.wire {
                        without_nodes(inner);
                    }
                }),
                _ => {}
            }
        }
    }
}

/// Every tag is closed in its order, and nothing in the document is not XML as far as the parser knows.
fn assert_well_formed(document: &str) {
    let mut open = Vec::new();
    for event in ::svg::read(document).expect("a document is read from memory") {
        match event {
            Event::Tag(name, Type::Start, _) => open.push(name),
            Event::Tag(name, Type::End, _) => assert_eq!(open.pop(), Some(name)),
            Event::Error(error) => panic!("{error} in\n{document}"),
            _ => {}
        }
    }
    assert!(open.is_empty(), "{open:?} is not closed");
    let bare = document
        .split('&')
        .skip(1)
        .find(|rest| !["lt;", "gt;", "amp;", "quot;", "apos;"].iter().any(|entity| rest.starts_with(entity)));
    assert_eq!(bare, None, "an ampersand stands for itself");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_random_program_is_drawn_whole_within_the_width(program in any_program(true), width in BLOCKS_FIT..160) {
        let picture = text(&program, &TextOptions { width });
        assert_fits(&picture, width);
        assert_rails(&picture);
        assert_complete(&program, &picture);
    }

    #[test]
    fn without_nodes_and_jumps_no_wire_has_a_loose_end(mut program in any_program(true), width in 20usize..160) {
        program.units[0].rungs.iter_mut().for_each(|rung| without_nodes(&mut rung.circuit));
        assert_wired(&text(&program, &TextOptions { width }));
    }

    #[test]
    fn without_blocks_it_fits_into_any_width(program in any_program(false), width in 20usize..60) {
        let picture = text(&program, &TextOptions { width });
        assert_fits(&picture, width);
        assert_rails(&picture);
        assert_complete(&program, &picture);
    }

    #[test]
    fn with_blocks_every_width_draws_everything(program in any_program(true), width in 0usize..BLOCKS_FIT) {
        assert_complete(&program, &text(&program, &TextOptions { width }));
    }

    #[test]
    fn the_svg_of_a_random_program_is_well_formed_and_always_the_same(program in any_program(true)) {
        let document = svg(&program);
        assert_well_formed(&document);
        prop_assert_eq!(svg(&program.clone()), document);
    }

    #[test]
    fn any_characters_make_a_picture(name in any::<String>(), title in any::<String>(), width in 20usize..60) {
        let rungs = vec![rung(&name, &title, vec![open(&name), condition(read(&title)), out(&title)])];
        let program = program(&name, vec![variable(rung::ladder::VariableClass::Input, &name)], rungs);
        let picture = text(&program, &TextOptions { width });
        assert_fits(&picture, width);
        assert_rails(&picture);
        assert_well_formed(&svg(&program));
    }
}

fn nested(depth: usize, inside: fn(Element) -> Element) -> Program {
    let element = (0..depth).fold(open("core"), |element, _| inside(element));
    program("deep", vec![], vec![rung("r", "", vec![element])])
}

#[test]
fn circuits_nested_128_deep_are_drawn_whole() {
    let beside = |inner| parallel(vec![vec![inner], vec![open("beside")]]);
    let picture = text(&nested(128, beside), &TextOptions { width: 80 });
    assert_eq!(picture.matches("core").count(), 1);
    assert_eq!(picture.matches("beside").count(), 128);

    let around = |inner| parallel(vec![vec![open("before"), inner], vec![]]);
    let picture = text(&nested(128, around), &TextOptions { width: 80 });
    assert_eq!((picture.matches("before").count(), picture.matches("core").count()), (128, 1));

    let at_a_pin = |inner| block("long_instance_name", "SR", vec![("R", wired(vec![vec![inner]]))]);
    let picture = text(&nested(127, at_a_pin), &TextOptions { width: 80 });
    assert_eq!(picture.matches(" SR ").count(), 127);
}

#[test]
fn what_is_nested_deeper_than_any_front_end_allows_ends_in_a_box() {
    let beside = |inner| parallel(vec![vec![inner], vec![open("beside")]]);
    let program = nested(600, beside);
    let picture = text(&program, &TextOptions { width: 80 });
    assert!(picture.contains("┤ … ├"));
    assert_well_formed(&svg(&program));

    let negated = |inner| {
        element(ElementKind::Condition(match inner {
            Element { kind: ElementKind::Condition(value), .. } => {
                expression(ExpressionKind::Unary(UnaryOperator::Not, Box::new(value)))
            }
            _ => read("a"),
        }))
    };
    assert!(text(&nested(600, negated), &TextOptions { width: 40 }).contains("NOT NOT NOT"));
}

#[test]
fn many_and_deep_statements_end_in_a_line_that_says_so() {
    let deep = (0..600).fold(assign("core", number(1)), |inner, _| when(read("a"), vec![inner]));
    let many = (0..100_000).map(|index| assign(&format!("b{index}"), number(1))).collect();
    for list in [vec![deep], many] {
        let program = program("p", vec![], vec![rung("r", "", vec![statements(list)])]);
        let picture = text(&program, &TextOptions { width: 40 });
        assert!(picture.lines().count() < 40, "{picture}");
        assert!(picture.contains("│ … "), "{picture}");
        assert_fits(&picture, 40);
        assert_well_formed(&svg(&program));
    }
}

#[test]
fn a_rung_whose_wires_would_fill_pages_says_so() {
    let long = (0..5000).map(|index| open(&format!("a{index}"))).collect();
    let mut branches = vec![long];
    branches.extend((0..5000).map(|index| vec![open(&format!("b{index}"))]));
    let program = program("big", vec![], vec![rung("r", "", vec![parallel(branches)])]);
    assert_eq!(text(&program, &TextOptions { width: 60 }), "program big\n\nr\n(too large to draw)\n");
}

#[test]
fn no_width_is_too_small_or_too_large() {
    let program = program("p", vec![], vec![rung("r", "", vec![open("a"), out("b")])]);
    let at = |width| text(&program, &TextOptions { width });
    assert_eq!(at(0), at(rung::draw::MINIMUM_WIDTH));
    assert_eq!(at(usize::MAX), at(rung::draw::MAXIMUM_WIDTH));
}

#[test]
fn long_rungs_and_many_branches_are_drawn_whole() {
    let many = || (0..20_000).map(|index| open(&format!("a{index}")));
    let in_series = rung("series", "", many().collect());
    let in_parallel = rung("parallel", "", vec![parallel(many().map(|contact| vec![contact]).collect())]);
    let program = program("big", vec![], vec![in_series, in_parallel]);
    assert_complete_by_count(&text(&program, &TextOptions { width: 80 }), 40_000);
}

fn assert_complete_by_count(picture: &str, contacts: usize) {
    assert_eq!(picture.matches("┤ ├").count(), contacts);
}
