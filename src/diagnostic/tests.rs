use super::*;
use crate::source::Source;

fn rendered(text: &str, diagnostic: Diagnostic) -> String {
    render(&Source::new("x.rung", text), &[diagnostic])
}

fn finding(at: Range<usize>) -> Diagnostic {
    Diagnostic::new(Code::UnexpectedToken, Span::new(at.start, at.end), "here")
}

#[test]
fn of_a_long_line_only_what_is_near_the_marked_places_is_shown() {
    let text = format!("first\n{}bad{}other{}\n", "a ".repeat(500_000), " b".repeat(500_000), " ü".repeat(500_000));
    let (bad, other) = (6 + 1_000_000, 6 + 2_000_003);
    let shown = rendered(&text, finding(bad..bad + 3).related(Span::new(other, other + 5), "and here"));
    let expected = format!(
        "error[R0201]: here\n  ┌─ x.rung:2:1000001\n  │\n2 │ …{a}bad{b}…{b}other{u}…\n  │  {blank}^^^{gap}----- and here\n\n",
        a = "a ".repeat(30),
        b = " b".repeat(30),
        u = " ü".repeat(20),
        blank = " ".repeat(60),
        gap = " ".repeat(121),
    );
    assert_eq!(shown, expected);
}

#[test]
fn a_long_span_shows_its_ends_however_many_lines_lie_between() {
    let text = "line\n".repeat(1_000_000);
    let expected = "\
error[R0201]: here
       ┌─ x.rung:2:1
       │  \n     2 │ ╭ line
     3 │ │ line
     4 │ │ line
     5 │ │ line
       · │
999998 │ │ line
999999 │ │ line
       │ ╰────^

";
    let shown = rendered(&text, finding(5..5 * 999_999 - 1));
    assert_eq!(shown, expected);
}

#[test]
fn control_characters_are_shown_and_not_obeyed() {
    let shown =
        rendered("\ta \u{1b}[2J b\rc\r\n", Diagnostic::new(Code::UnexpectedToken, Span::new(8, 9), "x\u{7}\ny"));
    let expected = "\
error[R0201]: x\u{fffd}\u{fffd}y
  ┌─ x.rung:1:9
  │
1 │     a \u{fffd}[2J b\u{fffd}c
  │            ^

";
    assert_eq!(shown, expected);
}

#[test]
fn a_long_message_is_cut() {
    let shown = rendered("a", Diagnostic::new(Code::UnexpectedToken, Span::new(0, 1), "n".repeat(1_000_000)));
    assert_eq!(shown.lines().next(), Some(format!("error[R0201]: {}…", "n".repeat(400)).as_str()));
}

#[test]
fn a_place_at_or_past_the_end_is_shown_at_the_end() {
    for text in ["", "a", "a\n", "a\r\n", "\n\n", "ü"] {
        for at in 0..6 {
            let shown = rendered(text, finding(at..at + 1).related(Span::new(at, 1000), "there"));
            assert!(shown.starts_with("error[R0201]: here\n"), "{text:?} {at}\n{shown}");
        }
    }
}
