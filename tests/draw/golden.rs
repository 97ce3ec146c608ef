//! Golden pictures of every element and of what a layout must get right.

use std::path::Path;

use rung::draw::{TextOptions, svg, text};
use rung::elementary::Elementary;
use rung::ladder::{Area, BinaryOperator, CoilKind, ContactKind, ElementKind, Program, Rung, VariableClass};
use rung::source::Span;

use crate::build::*;

fn compare(file: &str, picture: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/draw").join(file);
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(&path, picture).expect("a golden picture can be written");
    }
    let golden = std::fs::read_to_string(&path).unwrap_or_default();
    assert_eq!(picture, golden, "{file} differs; BLESS=1 rewrites it\n{picture}");
}

fn golden(file: &str, width: usize, rungs: Vec<Rung>) {
    golden_of(file, width, &program(file, vec![], rungs));
}

fn golden_of(file: &str, width: usize, program: &Program) {
    compare(&format!("{file}.txt"), &text(program, &TextOptions { width }));
}

fn pump_station() -> Program {
    let variables = vec![
        rung::ladder::Variable {
            address: address(Area::Input, &[0, 0]).map(Box::new),
            ..variable(VariableClass::Input, "start")
        },
        rung::ladder::Variable {
            address: address(Area::Input, &[0, 1]).map(Box::new),
            ..variable(VariableClass::Input, "stop")
        },
        variable(VariableClass::Input, "low_level"),
        rung::ladder::Variable {
            address: address(Area::Output, &[0, 0]).map(Box::new),
            ..variable(VariableClass::Output, "pump")
        },
        variable(VariableClass::Output, "alarm"),
        rung::ladder::Variable {
            initial: Some(Box::new(seconds(5))),
            ..typed(VariableClass::Constant, "warm", "TIME")
        },
        rung::ladder::Variable {
            retain: true,
            initial: Some(Box::new(integer(Elementary::Int, 0))),
            ..typed(VariableClass::Memory, "runs", "INT")
        },
    ];
    let mut program = program(
        "pump_station",
        variables,
        vec![
            rung(
                "r10",
                "seal-in: stop wins",
                vec![parallel(vec![vec![open("start")], vec![open("pump")]]), closed("stop"), out("pump")],
            ),
            rung(
                "r20",
                "alarm when the level stays low",
                vec![
                    open("pump"),
                    open("low_level"),
                    block("delay", "TON", vec![("PT", value(read("warm")))]),
                    coil(CoilKind::Set, "alarm"),
                ],
            ),
            rung(
                "r30",
                "",
                vec![
                    contact(ContactKind::Rising, "pump"),
                    block(
                        "starts",
                        "CTU",
                        vec![("PV", value(number(100))), ("R", value(read("stop"))), ("CV", to("runs"))],
                    ),
                ],
            ),
            rung(
                "r40",
                "",
                vec![
                    condition(binary(BinaryOperator::Greater, read("runs"), number(90))),
                    parallel(vec![
                        vec![out("alarm")],
                        vec![assignment("runs", binary(BinaryOperator::Subtract, read("runs"), number(1)))],
                    ]),
                ],
            ),
        ],
    );
    for (index, rung) in program.units[0].rungs.iter_mut().enumerate() {
        rung.span = Span::new(1000 * (index + 1), 1000 * (index + 1) + 500);
    }
    program.comments = vec![
        comment("a comment among the declarations belongs to them", 0, true),
        comment("The operator's panel.", 900, true),
        comment("Two lines\nin one comment.", 901, true),
        comment("behind an element: not drawn", 1200, false),
        comment(
            "A pump without water must not run for long, and the one who stands beside it ought to hear of it before it is dry.",
            1600,
            true,
        ),
    ];
    program.units[0].variables[6].span = Span::new(10, 20);
    program
}

#[test]
fn a_whole_program() {
    golden_of("pump_station", 80, &pump_station());
}

#[test]
fn a_whole_program_at_the_least_width() {
    golden_of("narrow", 20, &pump_station());
}

#[test]
fn a_whole_program_as_svg() {
    compare("pump_station.svg", &svg(&pump_station()));
}

#[test]
fn everything_as_svg() {
    let rungs = [element_rungs(), parallel_rungs(), block_rungs(), node_rungs(), wide_rungs()];
    compare("everything.svg", &svg(&program("every<thing> & \"more\"", vec![], rungs.concat())));
}

#[test]
fn each_kind_of_contact_and_coil() {
    golden("elements", 100, element_rungs());
}

fn element_rungs() -> Vec<Rung> {
    let contacts = [ContactKind::Open, ContactKind::Closed, ContactKind::Rising, ContactKind::Falling];
    let coils =
        [CoilKind::Plain, CoilKind::Negated, CoilKind::Set, CoilKind::Reset, CoilKind::Rising, CoilKind::Falling];
    vec![
        rung("contacts", "", contacts.map(|kind| contact(kind, &format!("{kind:?}"))).to_vec()),
        rung("coils", "", coils.map(|kind| coil(kind, &format!("{kind:?}"))).to_vec()),
        rung("", "a rung without a name", vec![open("a"), out("b")]),
        rung("wire", "", vec![]),
        rung_of("empty", "", vec![]),
        Rung { enabled: false, ..rung("resting", "checked, not run", vec![open("a"), out("b")]) },
        rung(
            "boxes",
            "",
            vec![
                condition(binary(
                    BinaryOperator::And,
                    binary(BinaryOperator::Less, read("speed"), number(10)),
                    read("moving"),
                )),
                assignment("speed", binary(BinaryOperator::Add, read("speed"), number(1))),
            ],
        ),
    ]
}

#[test]
fn jumps() {
    golden("jumps", 60, jump_rungs());
}

#[test]
fn jumps_as_svg() {
    compare("jumps.svg", &svg(&program("jumps", vec![], jump_rungs())));
}

fn jump_rungs() -> Vec<Rung> {
    let leave = || element(ElementKind::Return);
    vec![
        rung("r10", "", vec![open("a"), jump("r40")]),
        rung_of("r20", "", vec![branch(vec![open("a"), leave()]), branch(vec![open("b"), closed("c"), out("x")])]),
        rung("r30", "", vec![parallel(vec![vec![open("a"), jump("r40")], vec![open("b")]]), out("x")]),
        rung("r40", "", vec![block("t", "TON", vec![("IN", wired(vec![vec![open("a"), jump("nowhere")]]))])]),
        rung("r50", "a fault, drawn all the same", vec![open("a"), jump("r60"), out("x")]),
        rung("r60", "", vec![jump("the_rung_with_the_longest_name_of_this_whole_drawing")]),
    ]
}

#[test]
fn parallel_branches_inside_one_another() {
    golden("parallels", 100, parallel_rungs());
}

fn parallel_rungs() -> Vec<Rung> {
    let inner = parallel(vec![vec![open("c")], vec![open("d"), closed("e")], vec![]]);
    vec![
        rung(
            "nested",
            "",
            vec![
                open("a"),
                parallel(vec![vec![open("b"), inner.clone(), open("f")], vec![open("g")]]),
                open("h"),
                out("y"),
            ],
        ),
        rung(
            "two_in_series",
            "",
            vec![
                parallel(vec![vec![open("a")], vec![open("b")]]),
                parallel(vec![vec![open("c")], vec![open("d")], vec![open("e")]]),
                out("y"),
            ],
        ),
        rung("first_in_first", "", vec![parallel(vec![vec![inner], vec![open("z")]]), out("y")]),
        rung(
            "coils",
            "several coils, and one behind a contact of its own",
            vec![
                open("a"),
                parallel(vec![vec![out("x")], vec![open("b"), out("y")], vec![coil(CoilKind::Reset, "z")]]),
            ],
        ),
        rung_of(
            "from_rail_to_rail",
            "",
            vec![branch(vec![open("a"), out("x")]), branch(vec![open("b"), closed("c"), out("y")])],
        ),
    ]
}

#[test]
fn blocks_with_many_pins() {
    golden("blocks", 100, block_rungs());
}

fn block_rungs() -> Vec<Rung> {
    vec![
        rung(
            "up_and_down",
            "every pin wired, the second output chosen",
            vec![
                open("up"),
                chosen(
                    "pieces",
                    "CTUD",
                    vec![
                        ("CD", wired(vec![vec![closed("down"), open("b")]])),
                        ("R", value(read("clear"))),
                        ("LD", wired(vec![vec![open("load")], vec![open("reload_from_the_panel"), closed("off")]])),
                        ("PV", value(number(100))),
                        ("QU", to("full")),
                        ("CV", to("count")),
                    ],
                    "QD",
                ),
                out("empty"),
            ],
        ),
        rung(
            "enabled",
            "the first input is named, so that power goes to EN",
            vec![
                open("a"),
                block("delay", "TON", vec![("IN", value(read("x"))), ("PT", value(seconds(90))), ("Q", to("y"))]),
                out("z"),
            ],
        ),
        rung(
            "unknown",
            "a type that nobody declares, and a name longer than its box",
            vec![open("a"), block("a_block_of_an_unknown_type", "", vec![("X", value(read("b")))])],
        ),
        rung(
            "side_by_side",
            "",
            vec![parallel(vec![
                vec![block("t1", "TON", vec![("PT", value(seconds(1)))]), out("a")],
                vec![block("t2", "TOF", vec![("PT", value(seconds(2)))]), out("b")],
            ])],
        ),
    ]
}

#[test]
fn a_bridge_of_nodes() {
    golden("nodes", 80, node_rungs());
}

fn node_rungs() -> Vec<Rung> {
    vec![rung_of(
        "bridge",
        "five contacts that no tree of series and parallel holds",
        vec![
            node_branch("", vec![open("a")], "left"),
            node_branch("", vec![open("b")], "right"),
            node_branch("left", vec![open("middle")], "right"),
            node_branch("left", vec![open("c")], "end"),
            node_branch("right", vec![open("d")], "end"),
            node_branch("end", vec![out("y")], ""),
        ],
    )]
}

#[test]
fn a_rung_wider_than_the_page_goes_on_below() {
    golden("wrapped", 60, wide_rungs());
}

fn wide_rungs() -> Vec<Rung> {
    let contacts = |from: usize, to: usize| (from..to).map(|index| open(&format!("contact_{index}"))).collect();
    let mut long: Vec<_> = contacts(0, 9);
    long.push(out("lamp"));
    let mut with_branches = vec![parallel(vec![contacts(0, 8), vec![open("short")], contacts(20, 25)])];
    with_branches.push(block("delay", "TON", vec![("PT", value(seconds(3)))]));
    with_branches.push(parallel(vec![vec![out("x")], vec![out("y")]]));
    vec![rung("series", "", long), rung("parallel", "", with_branches)]
}

#[test]
fn names_too_long_for_the_page_are_cut() {
    let long = "the_third_conveyor_behind_the_second_packing_machine_motor_overload";
    let wide = "漢字漢字漢字漢字漢字";
    golden(
        "long_names",
        40,
        vec![
            rung(long, long, vec![open(long), out(wide)]),
            rung("block", "", vec![block(long, long, vec![(long, value(read(long))), ("q", to(long))])]),
            rung("bad", "a\nb\u{7}", vec![open("line\nbreak"), out("tab\tbell\u{7}")]),
        ],
    );
}

#[test]
fn units_statements_and_function_boxes() {
    let source = "\
type colour : (red, green := 4, blue)
type point : struct x, y : REAL end_struct
registers(hreg := 64)
global total : DINT
global const limit : INT := 90
task fast(interval := 10ms, priority := 1)

program control with fast
input start : BOOL at %IX0.0
var timers : array [1..3] of TON := [3()]
rung boxes
  start timers[i + 1](PT := T#5s) ADD(EN := start, IN1 := total, IN2 := 5, OUT => rows[total, 0]) SCALE(x := 3).ENO (done[2])
  start own:latch(reset := [done[1]], count := total) (done[3]) own()
rung text
  start {IF total > limit AND start AND NOT done[1] AND timers[2].Q AND timers[3].Q OR another_name_that_is_long THEN
    total := total + 1; t1(IN := TRUE, 5, Q => done[3]); ELSE RETURN; END_IF;
    CASE total OF 1, 3..5: total := 0; END_CASE; FOR n := 0 TO 9 BY 3 DO rows[n, 0] := n; END_FOR;}
function_block latch
input set, reset output q, level : INT inout count : DINT var e : BOOL
rung
  [set | q] /reset (q)
function scale : REAL
input x : INT
rung
  {scale := INT_TO_REAL(x) * 0.1;}
program other : control
";
    let parsed = rung::frontend::native::parse(&rung::source::Source::new("units.rung", source));
    assert_eq!(parsed.diagnostics, []);
    golden_of("units", 100, &parsed.program);
    compare("units.svg", &svg(&parsed.program));
}
