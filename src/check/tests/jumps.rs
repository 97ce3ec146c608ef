//! Jumps: the rungs that they lead to, and where they may stand.

use super::build::*;
use super::*;
use crate::check::{Element, RungIndex};
use crate::ladder::{self, CoilKind, Rung};

/// The rungs r10, of which the elements are given, and r20, r30 and r40, of which some are off.
fn rungs(first: Vec<ladder::Element>, resting: [bool; 3]) -> Program {
    let mut rungs = vec![named("r10", first)];
    for (name, resting) in ["r20", "r30", "r40"].into_iter().zip(resting) {
        let rung = named(name, vec![open("_a"), coil_of(CoilKind::Set, "_b")]);
        rungs.push(if resting { off(rung) } else { rung });
    }
    program(["_a", "_b"].map(|name| memory(name, "BOOL")).to_vec(), rungs)
}

#[test]
fn a_jump_is_resolved_to_a_rung_that_runs_or_else_the_next_that_does() {
    let cases = [
        (jump("R30"), [false, false, false], Element::Jump(RungIndex(2))),
        (jump("r30"), [true, false, false], Element::Jump(RungIndex(1))),
        (jump("r20"), [true, true, false], Element::Jump(RungIndex(1))),
        (jump("r30"), [false, true, true], Element::Return),
        (leave(), [false, false, false], Element::Return),
    ];
    for (jump, resting, expected) in cases {
        let checked = clean(&rungs(vec![open("_a"), jump], resting));
        assert_eq!(checked.units()[0].rungs[0].circuit.branches[0].elements[1], expected, "{resting:?}");
    }
}

#[test]
fn a_jump_backward_or_to_its_own_rung_says_why_it_cannot_be() {
    let jumping = |target: &str| {
        let mut program = rungs(vec![open("_a"), coil_of(CoilKind::Set, "_b")], [true, false, false]);
        program.units[0].rungs[2] = named("r30", vec![open("_a"), jump(target)]);
        program
    };
    for target in ["r10", "R20", "r30"] {
        assert_eq!(findings(&jumping(target)), [(Code::BackwardJump, target.to_owned())]);
    }
    let backward = only(&jumping("r10"));
    let message = "`r10` stands before this jump: a scan goes through the rungs once, from first to last";
    assert_eq!(backward.message, message);
    let hint = "the next scan comes to that rung by itself; keep in a variable what it must know until then";
    assert_eq!(backward.hint.as_deref(), Some(hint));
    let related: Vec<_> = backward.related.iter().map(|(span, note)| (text_at(*span), note.as_str())).collect();
    assert_eq!(related, [("r10".to_owned(), "the rung is here")]);
    assert_eq!(only(&jumping("r30")).message, "`r30` is the rung of this jump itself: a scan runs each rung once");
}

#[test]
fn a_jump_to_no_rung_is_told_the_nearest_one() {
    let hint = |target: &str| {
        let problem = only(&rungs(vec![open("_a"), jump(target)], [false; 3]));
        assert_eq!((problem.code, text_at(problem.span).as_str()), (Code::UndeclaredName, target));
        problem.hint
    };
    assert_eq!(hint("r35").as_deref(), Some("did you mean `r30`?"));
    assert_eq!(hint("retrun").as_deref(), Some("did you mean `return`?"));
    assert_eq!(hint("somewhere"), None);
}

#[test]
fn a_jump_ends_its_branch_and_stands_in_no_circuit_at_a_pin() {
    let fed = |first: Vec<ladder::Element>| -> Rung {
        network(vec![between("", first, "w1"), between("w1", vec![coil_of(CoilKind::Set, "_b")], "")])
    };
    let mut to_node = rungs(vec![], [false; 3]);
    to_node.units[0].rungs[0] = fed(vec![open("_a"), jump("r20")]);
    let circuit = wired("IN", vec![open("_a"), leave()]);
    let at_pin = rungs(vec![open("_a"), call("_t:TON", vec![circuit])], [false; 3]);
    let behind = vec![open("_a"), jump("r20"), coil_of(CoilKind::Set, "_b")];
    let found = |program: &Program| findings(program).into_iter().filter(|(code, _)| *code == Code::MisplacedJump);
    for (program, text) in [(rungs(behind, [false; 3]), ">> r20"), (to_node, ">> r20"), (at_pin, ">> return")] {
        assert_eq!(found(&program).collect::<Vec<_>>(), [(Code::MisplacedJump, text.to_owned())]);
    }
}

#[test]
fn a_jump_is_an_effect_and_lets_no_power_pass() {
    clean(&rungs(vec![jump("r40")], [false; 3]));
    let inner = parallel(vec![branch(vec![open("_a"), jump("r40")])]);
    clean(&rungs(vec![inner, coil_of(CoilKind::Set, "_b")], [false; 3]));
    let dead = rungs(vec![fixed(false), jump("r40")], [false; 3]);
    assert_eq!(findings(&dead), [(Code::NeverConducts, "FALSE".to_owned())]);
}
