//! What the agreement tests do not see: names, order and place of slots, and which operations come out.

use crate::check::check;
use crate::diagnostic::Diagnostic;
use crate::elementary::Elementary;
use crate::frontend;
use crate::logic::image::EarlierLayout;
use crate::logic::{Area, Op, Program, verify};
use crate::lower::lower;
use crate::source::Source;

/// A program in native text, lowered.
fn lowered(text: &str) -> Program {
    let source = Source::new("test", text.to_owned());
    let parsed = frontend::parse(&source);
    let (checked, mut diagnostics) = check(&parsed.program);
    diagnostics.extend(parsed.diagnostics);
    let errors: Vec<&Diagnostic> = diagnostics.iter().filter(|diagnostic| diagnostic.is_error()).collect();
    assert_eq!(errors, Vec::<&Diagnostic>::new());
    let program = lower(&checked.unwrap(), &source, None).unwrap();
    assert_eq!(verify(&program), Ok(()));
    program
}

fn slots(program: &Program) -> Vec<&str> {
    program.layout.slots().iter().map(|slot| slot.name.as_str()).collect()
}

fn observed(program: &Program) -> Vec<&str> {
    program.layout.observed().iter().map(|observed| observed.name.as_str()).collect()
}

fn count(program: &Program, which: impl Fn(Op) -> bool) -> usize {
    program.instructions.iter().filter(|instruction| which(instruction.op)).count()
}

fn indexed(op: Op) -> bool {
    matches!(op, Op::LoadIndexed(..) | Op::StoreIndexed(..))
}

#[test]
fn an_array_of_structures_is_a_run_for_each_member_and_is_watched_element_by_element() {
    let program = lowered(
        "type point : struct x : INT := 3  on : BOOL  row : array [1..2] of INT end_struct
        program p
        var pts : array [0..1] of point := [(x := 1, row := [5, 6]), (on := TRUE)]
        rung {pts[1].row[2] := 1}",
    );
    assert_eq!(
        slots(&program),
        [
            "pts[0].x",
            "pts[1].x",
            "pts[0].on",
            "pts[1].on",
            "pts[0].row[1]",
            "pts[0].row[2]",
            "pts[1].row[1]",
            "pts[1].row[2]"
        ]
    );
    assert_eq!(
        observed(&program),
        [
            "pts[0].x",
            "pts[0].on",
            "pts[0].row[1]",
            "pts[0].row[2]",
            "pts[1].x",
            "pts[1].on",
            "pts[1].row[1]",
            "pts[1].row[2]"
        ]
    );
    let initial: Vec<i128> = program.layout.slots().iter().filter_map(|slot| slot.initial.as_integer()).collect();
    assert_eq!(initial, [1, 3, 0, 1, 5, 6, 0, 0]);
    let runs: Vec<(u32, u32)> = program.layout.arrays().iter().map(|array| (array.first.0, array.count)).collect();
    assert_eq!(runs, [(0, 2), (2, 2), (4, 4)]);
}

#[test]
fn indices_are_named_as_they_are_declared() {
    let program = lowered(
        "program p
        var m : array [-1..0, 5..6] of INT
        rung {m[-1, 5] := 1}",
    );
    assert_eq!(slots(&program), ["m[-1,5]", "m[-1,6]", "m[0,5]", "m[0,6]"]);
}

const BLOCK: &str = "function_block latch
    input set : BOOL
    output q : BOOL
    output total : INT
    var t : TON
    rung r1
      ^set t(PT := T#1s) (q)
    ";

#[test]
fn an_instance_shows_its_outputs_and_hides_the_rest_among_the_states() {
    let program = lowered(&format!("{BLOCK} program p\n var fb : latch retain\n rung\n fb(set := TRUE)"));
    assert_eq!(
        slots(&program),
        ["fb.set", "fb.q", "fb.total", "fb.t.Q", "fb.t.ET", "fb.t#previous", "fb.t#start", "fb.r1#1"]
    );
    assert_eq!(observed(&program), ["fb.q", "fb.total"]);
    assert!(program.layout.slots().iter().all(|slot| slot.area == Area::State && slot.retain));
}

#[test]
fn with_several_programs_each_name_says_whose_it_is() {
    let program = lowered(
        "global all : WORD
        program pump
        var n : INT
        rung start
          {n := n + 1} ^all.0 (%QX0.0)
        program pump1 : pump
        program pump2 : pump",
    );
    assert_eq!(slots(&program), ["all", "%QX0.0", "pump1.n", "pump1.start#1", "pump2.n", "pump2.start#1"]);
    assert_eq!(observed(&program), ["all", "%QX0.0", "pump1.n", "pump2.n"]);
}

#[test]
fn variables_at_one_address_share_a_slot_in_all_units() {
    let program = lowered(
        "global lamp at %QX0.0 : BOOL
        program a
        output light at %QX0.0 : BOOL
        rung
          TRUE (light)
        program b
        var x : BOOL
        rung
          lamp (x)",
    );
    assert_eq!(slots(&program), ["lamp", "b.x"]);
    assert_eq!(observed(&program), ["lamp", "a.light", "b.x"]);
}

const SCALE: &str = "function scale : REAL
    input x : INT
    var factor : REAL := 0.5
    rung {scale := INT_TO_REAL(x) * factor}
    ";

#[test]
fn a_function_has_one_frame_that_each_call_initialises() {
    let program = lowered(&format!("{SCALE} program p  var r : REAL  rung {{r := scale(1) + scale(2)}}"));
    assert_eq!(slots(&program), ["r", "#scale.scale", "#scale.x", "#scale.factor"]);
    assert_eq!(observed(&program), ["r"]);
    let factor = program.layout.slots().iter().position(|slot| slot.name == "#scale.factor").unwrap();
    assert_eq!(count(&program, |op| matches!(op, Op::Store(slot, _) if slot.index() == factor)), 2);
    // The same without a call.
    assert_eq!(slots(&lowered(&format!("{SCALE} program p  var r : REAL  rung {{r := 1.0}}"))), ["r"]);
}

#[test]
fn a_body_with_a_return_is_inlined_into_one_section_without_a_jump_slot() {
    let program = lowered(
        "function_block stop
        input on : BOOL
        output n : INT
        rung
          on >> return
        rung
          {n := n + 1}
        program p
        var fb : stop
        rung here
          fb(on := TRUE)
        rung there
          fb(on := FALSE)",
    );
    assert_eq!(slots(&program), ["fb.on", "fb.n"]);
    let labels: Vec<&str> = program.origins.iter().map(|origin| origin.label.as_str()).collect();
    assert_eq!(labels, ["here", "there"]);
}

#[test]
fn only_a_program_that_jumps_has_a_jump_slot_and_only_one_that_computes_indices_a_fault_bit() {
    let program = |rung: &str| {
        let text =
            format!("program p\n var x : array [0..1] of BOOL\n var i : INT\n rung\n x[1] {rung}\n rung\n x[0] (x[1])");
        slots(&lowered(&text)).into_iter().filter(|name| name.starts_with('#')).map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(program("(x[0])"), Vec::<String>::new());
    assert_eq!(program(">> return"), ["#jump"]);
    assert_eq!(program("{IF TRUE THEN RETURN; END_IF;}"), ["#jump"]);
    assert_eq!(program("x[i] (x[0])"), ["#fault"]);
}

#[test]
fn a_loop_over_an_array_has_constant_indices_unless_its_variable_is_written() {
    let program = |body: &str| {
        lowered(&format!(
            "program p
            var x : array [0..3] of INT
            var i, j : INT
            rung
              {{FOR i := 0 TO 2 DO {body} END_FOR;}}"
        ))
    };
    assert_eq!(count(&program("x[i + 1] := x[i];"), indexed), 0);
    assert_eq!(count(&program("x[j] := x[i];"), indexed), 3);
    assert_eq!(count(&program("x[i] := 1; i := i + 1; x[i] := 2;"), indexed), 3);
}

#[test]
fn a_whole_array_is_copied_by_one_operation_and_a_part_of_one_element_by_element() {
    let program = |statement: &str| {
        lowered(&format!(
            "type row : array [0..2] of INT
            program p
            var a, b : array [0..99] of INT
            var m : array [0..1] of row
            var i : INT
            rung
              {{{statement}}}"
        ))
    };
    let copied = program("a := b;");
    assert_eq!(count(&copied, |op| matches!(op, Op::CopyArray(..))), 1);
    assert_eq!(count(&copied, |op| matches!(op, Op::Store(..))), 0);
    let row = program("m[0] := m[1];");
    assert_eq!(count(&row, |op| matches!(op, Op::CopyArray(..))), 0);
    assert_eq!(count(&row, |op| matches!(op, Op::Store(..))), 3);
    // The one slot is the fault bit.
    let computed = program("m[i] := m[0];");
    assert_eq!(count(&computed, |op| matches!(op, Op::StoreIndexed(..))), 3);
    assert_eq!(count(&computed, |op| matches!(op, Op::Store(..))), 1);
}

#[test]
fn tasks_keep_their_order_and_their_times() {
    let program = lowered(
        "task slow(interval := 100ms, priority := 2)
        task fast(interval := 10ms, priority := 1)
        program a with slow
        var x1, y1 : BOOL
        rung one
          x1 (y1)
        program b
        var x2, y2 : BOOL
        rung two
          x2 (y2)
        program c with fast
        var x3, y3 : BOOL
        rung three
          x3 (y3)",
    );
    let labels: Vec<&str> = program.origins.iter().map(|origin| origin.label.as_str()).collect();
    assert_eq!(labels, ["three", "one", "two"]);
    let due: Vec<Option<&str>> =
        program.tasks.iter().map(|task| task.due.map(|slot| program.layout.slot(slot).name.as_str())).collect();
    assert_eq!(due, [Some("#task fast"), Some("#task slow"), None]);
    let hidden = program.layout.slots().iter().filter(|slot| slot.name.starts_with("#task"));
    assert!(hidden.clone().count() == 2 && hidden.clone().all(|slot| slot.ty == Elementary::Time));
}

#[test]
fn an_edit_elsewhere_moves_no_slot() {
    let text = format!("{BLOCK} program p\n var fb : latch\n rung\n fb(set := TRUE)");
    let before = lowered(&text);
    let source = Source::new("test", text.replace("var fb", "var n : INT\n var more : array [0..2] of latch\n var fb"));
    let (checked, _) = check(&frontend::parse(&source).program);
    let after = lower(&checked.unwrap(), &source, Some(&EarlierLayout::from(&*before.layout))).unwrap();
    for slot in before.layout.slots() {
        let same = after.layout.slots().iter().find(|other| other.name == slot.name).unwrap();
        assert_eq!(same.offset, slot.offset, "{}", slot.name);
    }
}
