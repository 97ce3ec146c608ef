//! Units, tasks, jumps and boxes, written and read again.

use rung::check::check;
use rung::diagnostic::{any_error, render};
use rung::frontend::structured_text;
use rung::source::Source;

#[test]
fn units_tasks_jumps_and_boxes_are_written_and_check_again() {
    let source = Source::new("units.rung", include_str!("fixtures/units.rung"));
    let parsed = rung::frontend::parse(&source);
    assert_eq!(parsed.diagnostics, []);
    let (first, problems) = check(&parsed.program);
    assert!(first.is_some(), "{}", render(&source, &problems));
    let text = structured_text::print(&parsed.program).expect("all of it is in IEC 61131-3");
    let again = Source::new("units.st", text.as_str());
    let parsed = rung::frontend::parse(&again);
    assert!(!any_error(&parsed.diagnostics), "{}\n{text}", render(&again, &parsed.diagnostics));
    let (second, problems) = check(&parsed.program);
    assert!(second.is_some(), "{}\n{text}", render(&again, &problems));
    for part in [
        "IF NOT skip1 THEN",
        "TASK fast(INTERVAL := T#10ms, PRIORITY := 1);",
        "VAR_EXTERNAL\n    total : DINT;",
        "row[runs] := MOVE(IN := 3, ENO => power2);",
        "c := DIV(IN1 := c, IN2 := runs, ENO => power2);",
    ] {
        assert!(text.contains(part), "{part}\n{text}");
    }
}
