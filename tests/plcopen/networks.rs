//! Networks: what is wired how, in which order, as what rungs.

use crate::drawing::{
    block, coil, coil_with, contact, contact_with, element, ladder, locals, pou, program, project, rail, value,
    variable, wires,
};
use crate::{native_text, parse, rungs};

#[test]
fn a_series_is_contacts_and_a_coil() {
    let text = ladder(
        "a b c",
        &[rail(), contact(2, "a", "1"), contact_with(3, "b", "2", "negated='true'"), coil(4, "c", "3")],
    );
    assert_eq!(rungs(&text), ["a /b (c)"]);
}

#[test]
fn several_connections_are_an_or() {
    let text = ladder(
        "a b c d e",
        &[
            rail(),
            contact(2, "a", "1"),
            contact(3, "b", "1"),
            contact(4, "c", "2 3"),
            contact(5, "d", "1"),
            coil(6, "e", "4 5"),
        ],
    );
    assert_eq!(rungs(&text), ["[ [ a | b ] c | d ] (e)"]);
}

#[test]
fn a_seal_in_beside_a_contact_starts_at_the_rail() {
    let text = ladder(
        "start pump stop",
        &[rail(), contact(2, "start", "1"), contact(3, "pump", "1"), contact(4, "stop", "2 3"), coil(5, "pump", "4")],
    );
    assert_eq!(rungs(&text), ["[ start | pump ] stop (pump)"]);
}

#[test]
fn what_two_coils_share_is_computed_once() {
    let text =
        ladder("a b x y", &[rail(), contact(2, "a", "1"), coil(3, "x", "2"), contact(4, "b", "2"), coil(5, "y", "4")]);
    assert_eq!(rungs(&text), ["a [ (x) | b (y) ]"]);
}

#[test]
fn a_coil_feeds_further_elements() {
    let text =
        ladder("a x b y", &[rail(), contact(2, "a", "1"), coil(3, "x", "2"), contact(4, "b", "3"), coil(5, "y", "4")]);
    assert_eq!(rungs(&text), ["a (x) b (y)"]);
}

#[test]
fn a_bridge_has_nodes() {
    // Between the middles of two chains a contact conducts from the upper to the lower.
    let text = ladder(
        "a b c d e x y",
        &[
            rail(),
            contact(2, "a", "1"),
            contact(3, "b", "1"),
            contact(4, "c", "2"),
            contact(5, "d", "2"),
            contact(6, "e", "3 4"),
            coil(7, "x", "5"),
            coil(8, "y", "6"),
        ],
    );
    assert_eq!(rungs(&text), ["a >n1> | >n1> d (x) | b >n2> | >n1> c >n2> | >n2> e (y)"]);
}

#[test]
fn the_rail_joins_no_rungs_and_rungs_come_from_top_to_bottom() {
    let text = ladder(
        "a b x y",
        &[rail(), contact(12, "b", "1"), coil(13, "y", "12"), contact(2, "a", "1"), coil(3, "x", "2")],
    );
    assert_eq!(rungs(&text), ["a (x)", "b (y)"]);
}

#[test]
fn rungs_that_take_turns_with_one_variable_are_one() {
    // x comes before y, and y before z, which the first rung's contact feeds too.
    let entangled =
        [rail(), contact(2, "a", "1"), coil(3, "x", "2"), contact(4, "x", "1"), coil(5, "y", "4"), coil(6, "x", "2")];
    assert_eq!(rungs(&ladder("a x y", &entangled)), ["a >n1> | >n1> (x) | x (y) | >n1> (x)"]);
    let apart =
        [rail(), contact(2, "a", "1"), coil(3, "x", "2"), contact(4, "b", "1"), coil(5, "y", "4"), coil(6, "z", "2")];
    assert_eq!(rungs(&ladder("a b x y z", &apart)), ["a [ (x) | (z) ]", "b (y)"]);
}

#[test]
fn contacts_and_coils_have_their_modifiers() {
    let text = ladder(
        "a b",
        &[
            rail(),
            contact_with(2, "a", "1", "edge='rising'"),
            coil_with(3, "b", "2", "storage='set'"),
            contact_with(4, "a", "1", "edge='falling' negated='false'"),
            coil_with(5, "b", "4", "storage='reset'"),
            contact_with(6, "a", "1", "edge='rising' negated='true'"),
            coil_with(7, "b", "6", "negated='true'"),
            coil_with(8, "b", "1", "edge='rising'"),
            coil_with(9, "b", "1", "edge='falling'"),
        ],
    );
    assert_eq!(rungs(&text), ["^a (S b)", "^/a (R b)", "^/a (/b)", "(P b)", "(N b)"]);
}

#[test]
fn a_negated_set_coil_inverts_its_power() {
    let text = ladder(
        "a b c",
        &[rail(), contact(2, "a", "1"), contact(3, "b", "2"), coil_with(4, "c", "3", "negated='true' storage='set'")],
    );
    assert_eq!(rungs(&text), ["NOT(IN := [ a b ]).OUT (S c)"]);
}

#[test]
fn a_timer_stands_in_the_rung_and_its_time_is_wired() {
    let declarations = locals("a b q", "BOOL") + &locals("t", "TON") + &locals("e", "TIME");
    let text = program(
        &declarations,
        "LD",
        &[
            rail(),
            contact(2, "a", "1"),
            value(3, "T#2s"),
            block(4, "TON", "t", "IN=2 PT=3", "Q ET"),
            variable(5, "e", "4.ET"),
            contact(6, "b", "1"),
            coil(7, "q", "4.Q 6"),
        ],
    );
    assert_eq!(rungs(&text), ["[ a t:TON(PT := T#2s, ET => e) | b ] (q)"]);
}

#[test]
fn a_counter_takes_power_at_its_other_pins() {
    let declarations = locals("a r s q", "BOOL") + &locals("c", "CTU") + &locals("n", "INT");
    let text = program(
        &declarations,
        "LD",
        &[
            rail(),
            contact(2, "a", "1"),
            contact(3, "r", "1"),
            contact(4, "s", "3"),
            value(5, "10"),
            block(6, "CTU", "c", "CU/rising=2 R=4 PV=5", "Q CV"),
            variable(7, "n", "6.CV"),
            coil(8, "q", "6.Q"),
        ],
    );
    assert_eq!(rungs(&text), ["a c:CTU(R := [ r s ], PV := 10, CV => n) (q)"]);
}

#[test]
fn a_pin_without_a_wire_keeps_its_value() {
    let declarations = locals("a q", "BOOL") + &locals("c", "CTU");
    let text = program(
        &declarations,
        "LD",
        &[rail(), contact(2, "a", "1"), block(3, "CTU", "c", "CU= R=2 PV=", "Q CV"), coil(4, "q", "3.Q")],
    );
    assert_eq!(rungs(&text), ["c:CTU(R := a, CU := c.CU) (q)"]);
}

#[test]
fn what_a_pin_shares_with_the_rung_is_a_node() {
    let declarations = locals("a b q", "BOOL") + &locals("c", "CTU");
    let text = program(
        &declarations,
        "LD",
        &[
            rail(),
            contact(2, "a", "1"),
            contact(3, "b", "2"),
            block(4, "CTU", "c", "CU=3 R=2 PV=", "Q CV"),
            coil(5, "q", "4.Q"),
        ],
    );
    assert_eq!(rungs(&text), ["a >n1> | >n1> b c:CTU(R := [ >n1> ]) (q)"]);
}

#[test]
fn enable_and_its_output_are_the_power_of_a_box() {
    let declarations = locals("a q", "BOOL") + &locals("x y z", "INT");
    let text = program(
        &declarations,
        "LD",
        &[
            rail(),
            contact(2, "a", "1"),
            value(3, "x"),
            value(4, "5"),
            block(5, "ADD", "", "EN=2 IN1=3 IN2=4", "ENO OUT"),
            variable(6, "y", "5.OUT"),
            block(7, "MOVE", "", "EN=5.ENO IN=3", "ENO OUT"),
            variable(8, "z", "7.OUT"),
            coil(9, "q", "7.ENO"),
        ],
    );
    assert_eq!(rungs(&text), ["a ADD(IN1 := x, IN2 := 5, OUT => y) MOVE(IN := x, OUT => z) (q)"]);
}

#[test]
fn a_box_on_the_left_rail_runs_always() {
    let declarations = locals("x y", "INT");
    let text = program(
        &declarations,
        "LD",
        &[rail(), value(2, "x"), block(3, "MOVE", "", "EN=1 IN=2", "ENO OUT"), variable(4, "y", "3.OUT")],
    );
    assert_eq!(rungs(&text), ["MOVE(IN := x, OUT => y)"]);
}

#[test]
fn a_block_with_enable_takes_its_first_input_by_name() {
    let declarations = locals("a b q", "BOOL") + &locals("t", "TON");
    let text = program(
        &declarations,
        "LD",
        &[
            rail(),
            contact(2, "a", "1"),
            contact(3, "b", "1"),
            value(4, "T#1s"),
            block(5, "TON", "t", "EN=2 IN=3 PT=4", "ENO Q ET"),
            coil(6, "q", "5.ENO"),
        ],
    );
    assert_eq!(rungs(&text), ["a t:TON(IN := b, PT := T#1s).ENO (q)"]);
}

#[test]
fn functions_without_enable_are_formulas_where_they_are_needed() {
    let declarations = locals("q", "BOOL") + &locals("x y z", "INT");
    let text = program(
        &declarations,
        "FBD",
        &[
            value(2, "x"),
            value(3, "y"),
            block(4, "ADD", "", "IN1=2 IN2=3", "OUT"),
            value(5, "3"),
            block(6, "MUL", "", "IN1=4.OUT IN2=5", "OUT"),
            variable(7, "z", "6.OUT"),
            block(8, "GT", "", "IN1=2 IN2=5", "OUT"),
            block(9, "LIMIT", "", "MN=2 IN=3 MX=5", "OUT"),
            variable(10, "q", "8.OUT"),
            variable(11, "z", "9.OUT"),
        ],
    );
    assert_eq!(rungs(&text), ["{z := (x + y) * 3}", "{q := x > 3}", "{z := LIMIT(x, y, 3)}"]);
}

#[test]
fn a_comparison_that_feeds_coils_is_a_contact() {
    let declarations = locals("a b c", "BOOL") + &locals("x", "INT");
    let text = program(
        &declarations,
        "LD",
        &[
            rail(),
            value(2, "x"),
            value(3, "5"),
            block(4, "GE", "", "IN1=2 IN2=3", "OUT"),
            contact(5, "a", "4.OUT"),
            coil(6, "b", "5"),
            coil(7, "c", "4.OUT"),
        ],
    );
    assert_eq!(rungs(&text), ["{x >= 5} [ a (b) | (c) ]"]);
}

#[test]
fn what_an_enabled_function_gives_to_others_is_kept_in_a_hidden_variable() {
    let declarations = locals("a", "BOOL") + &locals("x", "INT") + &locals("y", "DINT");
    let text = program(
        &declarations,
        "LD",
        &[
            rail(),
            contact(2, "a", "1"),
            value(3, "x"),
            value(4, "y"),
            block(5, "ADD", "", "EN=2 IN1=3 IN2=4", "ENO OUT"),
            block(6, "MUL", "", "EN=5.ENO IN1=5.OUT IN2=4", "ENO OUT"),
            variable(7, "y", "6.OUT"),
        ],
    );
    let text = native_text(&text);
    assert!(text.contains("\ntemp   _ADD5_OUT : DINT\n"), "{text}");
    assert!(
        text.contains("a ADD(IN1 := x, IN2 := y, OUT => _ADD5_OUT) MUL(IN1 := _ADD5_OUT, IN2 := y, OUT => y)"),
        "{text}"
    );
}

#[test]
fn outputs_of_an_instance_are_read_as_its_members() {
    let declarations = locals("u d q r", "BOOL") + &locals("c", "CTUD") + &locals("n m", "INT");
    let text = program(
        &declarations,
        "FBD",
        &[
            value(2, "u"),
            value(3, "d"),
            block(4, "CTUD", "c", "CU=2 CD=3 R= LD= PV=", "QU QD CV"),
            variable(5, "q", "4.QU"),
            variable(6, "r", "4.QD"),
            value(7, "1"),
            block(8, "ADD", "", "IN1=4.CV IN2=7", "OUT"),
            variable(9, "n", "8.OUT"),
            variable(10, "m", "4.CV"),
        ],
    );
    assert_eq!(rungs(&text), ["u c:CTUD(CD := d, QU => q, QD => r) | {n := c.CV + 1} | {m := c.CV}"]);
}

#[test]
fn feedback_through_a_block_reads_what_it_left() {
    let declarations = locals("a q", "BOOL") + &locals("s", "SR");
    let text = program(
        &declarations,
        "LD",
        &[rail(), contact(2, "a", "3.Q1"), block(3, "SR", "s", "S1=1 R=2", "Q1"), coil(4, "q", "3.Q1")],
    );
    assert_eq!(rungs(&text), ["s:SR(R := [ s.Q1 a ]) (q)"]);
}

#[test]
fn feedback_of_a_function_is_kept_from_scan_to_scan() {
    let text = program(
        &locals("x", "INT"),
        "FBD",
        &[value(2, "1"), block(3, "ADD", "", "IN1=3.OUT IN2=2", "OUT"), variable(4, "x", "3.OUT")],
    );
    assert!(native_text(&text).contains("\nvar    _ADD3_OUT : INT\n"));
    assert_eq!(rungs(&text), ["ADD(IN1 := _ADD3_OUT, IN2 := 1, OUT => _ADD3_OUT) | {x := _ADD3_OUT}"]);
}

#[test]
fn an_output_goes_to_several_variables() {
    let declarations = locals("a", "BOOL") + &locals("t", "TON") + &locals("e f", "TIME") + &locals("x y", "INT");
    let text = program(
        &declarations,
        "LD",
        &[
            rail(),
            contact(2, "a", "1"),
            block(3, "TON", "t", "IN=2 PT=", "Q ET"),
            variable(4, "e", "3.ET"),
            variable(5, "f", "3.ET"),
            value(6, "x"),
            block(7, "MOVE", "", "EN=2 IN=6", "ENO OUT"),
            variable(8, "x", "7.OUT"),
            variable(9, "y", "7.OUT"),
        ],
    );
    assert_eq!(
        rungs(&text),
        ["a >n1> | >n1> t:TON(ET => e) | {f := t.ET} | >n1> MOVE(IN := x, OUT => _MOVE7_OUT) \
             | >n1> {x := _MOVE7_OUT} | >n1> {y := _MOVE7_OUT}"]
    );
}

#[test]
fn pins_have_negations_and_edges() {
    let declarations = locals("a b q", "BOOL") + &locals("s", "SR") + &locals("x y", "INT");
    let text = program(
        &declarations,
        "LD",
        &[
            rail(),
            contact(2, "a", "1"),
            contact(3, "b", "2"),
            block(4, "SR", "s", "S1/negated=3 R/rising=3", "Q1"),
            coil(5, "q", "4.Q1"),
        ],
    );
    assert_eq!(rungs(&text), ["a b >n1> | NOT(IN := [ >n1> ]).OUT s:SR(R := [ >n1> _R_TRIG4_R:R_TRIG() ]) (q)"]);
    let single = [rail(), contact(2, "a", "1"), block(4, "SR", "s", "S1/negated=2", "Q1"), coil(5, "q", "4.Q1")];
    assert_eq!(rungs(&program(&declarations, "LD", &single)), ["/a s:SR() (q)"]);
}

#[test]
fn a_continuation_goes_on_where_its_connector_ends() {
    let text = ladder(
        "a b q",
        &[
            rail(),
            contact(2, "a", "1"),
            element("connector", 3, "name='here'", &wires("2")),
            element("continuation", 4, "name='HERE'", ""),
            contact(5, "b", "4"),
            coil(6, "q", "5"),
        ],
    );
    assert_eq!(rungs(&text), ["a b (q)"]);
}

#[test]
fn jumps_go_to_labelled_rungs_and_returns_leave() {
    let text = ladder(
        "a b q",
        &[
            rail(),
            contact(2, "a", "1"),
            element("jump", 3, "label='far'", &wires("2")),
            coil(4, "q", "1"),
            element("label", 5, "label='far'", ""),
            contact(6, "b", "1"),
            coil(7, "q", "6"),
            contact(8, "b", "1"),
            element("return", 9, "", &wires("8")),
            element("label", 10, "label='end'", ""),
        ],
    );
    assert_eq!(rungs(&text), ["a >> far", "(q)", "far b (q)", "b >> return", "end"]);
}

#[test]
fn an_in_out_variable_is_written_and_read_at_its_places() {
    let counter = |order: &str| {
        program(
            &(locals("n m", "INT")),
            "FBD",
            &[
                value(2, "1"),
                block(3, "ADD", "", "IN1=2 IN2=5", "OUT"),
                element("inOutVariable", 5, order, &(wires("3.OUT") + "<expression>n</expression>")),
                variable(6, "m", "5"),
            ],
        )
    };
    assert_eq!(rungs(&counter("executionOrderId='0'")), ["{n := 1 + n}", "{m := n}"]);
}

#[test]
fn given_orders_come_before_places() {
    let ordered = |id: u32, name: &str, order: u32| {
        element(
            "outVariable",
            id,
            &format!("executionOrderId='{order}'"),
            &format!("{}<expression>{name}</expression>", wires("2")),
        )
    };
    let text = program(
        &locals("a b c", "INT"),
        "FBD",
        &[value(2, "1"), ordered(3, "a", 0), ordered(4, "b", 2), ordered(5, "c", 1)],
    );
    assert_eq!(rungs(&text), ["{c := 1}", "{b := 1}", "{a := 1}"]);
}

#[test]
fn comments_are_titles_of_the_rungs_beside_them() {
    let comment = |id: u32, text: &str| {
        element("comment", id, "", &format!("<content><p xmlns='x'><![CDATA[{text}]]></p></content>"))
    };
    let long = "long ".repeat(40);
    let text = ladder(
        "a b",
        &[
            rail(),
            comment(2, "first\n rung"),
            coil(3, "a", "1"),
            comment(14, "second"),
            coil(15, "b", "1"),
            comment(16, &long),
        ],
    );
    let parsed = parse(&text);
    let titles: Vec<Option<&str>> = parsed.program.rungs().map(|rung| rung.title.as_deref()).collect();
    assert_eq!(titles, [Some("first rung"), Some("second")]);
    let comments: Vec<&str> = parsed.program.comments.iter().map(|comment| comment.text.as_str()).collect();
    assert_eq!(comments, [long.trim()]);
}

#[test]
fn rungs_may_be_written_out() {
    let body = "<LD><!-- Rung 1: seal --><rung localId='1'><contact variable='a'/><contact variable='b' negated='negated'/>\
        <coil kind='set' variable='c'/></rung><rung localId='2'><block typeName='TON' instanceName='t'>\
        <variable formalParameter='IN'>a</variable><variable formalParameter='PT'>T#1s</variable>\
        <variable formalParameter='Q'>c</variable></block></rung></LD>";
    let text = project(&pou("program", "p", &locals("a b c", "BOOL"), body), "");
    assert_eq!(rungs(&text), ["\"Rung 1: seal\" a /b (S c)", "t:TON(IN := a, PT := T#1s, Q => c)"]);
}

#[test]
fn whole_numbers_at_pins_for_durations_count_scans_in_written_out_rungs() {
    let body = "<LD><rung localId='1'><block typeName='TON' instanceName='t'>\
        <variable formalParameter='IN'>a</variable><variable formalParameter='PT'>n</variable>\
        <variable formalParameter='Q'>c</variable><variable formalParameter='ET'>m</variable></block></rung></LD>";
    let declarations = locals("a c", "BOOL") + &locals("n m", "INT");
    let task = "<configuration name='x'><resource name='r'><task name='t0' interval='T#20ms'/><pouInstance name='i' typeName='p'/></resource></configuration>";
    let read = |configuration: &str| {
        let parsed = parse(&project(&pou("program", "p", &declarations, body), configuration));
        assert_eq!(crate::codes(&parsed.diagnostics), ["R0527", "R0527"]);
        assert!(rung::check::check(&parsed.program).0.is_some());
        let printed = rung::frontend::native::print(&parsed.program);
        printed.split("\nrung").nth(1).unwrap_or("").split_whitespace().collect::<Vec<_>>().join(" ")
    };
    assert_eq!(
        read(task),
        "t:TON(IN := a, PT := T#20ms * n, Q => c) | {m := LREAL_TO_INT(TIME_TO_LREAL(t.ET) / LREAL#0.02)}"
    );
    assert_eq!(
        read(""),
        "t:TON(IN := a, PT := T#1ms * n, Q => c) | {m := LREAL_TO_INT(TIME_TO_LREAL(t.ET) / LREAL#0.001)}"
    );
}

#[test]
fn functions_in_written_out_rungs_may_have_instances_and_pins_of_their_own() {
    let pin = |name: &str, value: &str| format!("<variable formalParameter='{name}'>{value}</variable>");
    let box_of =
        |names: &str, pins: &[String]| format!("<rung localId='1'><block {names}>{}</block></rung>", pins.concat());
    let body = [
        box_of("typeName='ADD' instanceName='a1'", &[pin("IN1", "x"), pin("IN2", "y"), pin("OUT", "x")]),
        box_of("typeName='MOVE' instanceName='m1'", &[pin("IN1", "x"), pin("OUT", "y")]),
        box_of("typeName='CTD' instanceName='c1'", &[pin("CD", "a"), pin("LOAD", "b"), pin("PV", "3"), pin("CV", "x")]),
    ];
    let body = format!("<ladderDiagram>{}</ladderDiagram>", body.concat());
    let text = project(&pou("program", "p", &(locals("a b", "BOOL") + &locals("x y", "INT")), &body), "");
    assert_eq!(
        rungs(&text),
        ["ADD(IN1 := x, IN2 := y, OUT => x)", "MOVE(IN := x, OUT => y)", "c1:CTD(CD := a, LD := b, PV := 3, CV => x)"]
    );
}

#[test]
fn a_function_with_an_instance_is_still_a_function() {
    let declarations = locals("x y", "INT");
    let text = program(
        &declarations,
        "FBD",
        &[value(2, "x"), block(3, "ADD", "add1", "IN1=2 IN2=2", "OUT"), variable(4, "y", "3.OUT")],
    );
    assert_eq!(rungs(&text), ["{y := x + x}"]);
}
