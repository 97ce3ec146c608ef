//! Files that nobody would write: they end in a diagnostic, without a panic, and soon.

use proptest::prelude::*;

use crate::drawing::{block, coil, contact, element, ladder, locals, program, rail, value, variable, wires};
use crate::{codes, parse};
use rung::check::check;
use rung::frontend::native;
use rung::source::Source;

#[test]
fn deep_nesting_is_refused() {
    let text = "<project>".repeat(100_000);
    assert_eq!(codes(&parse(&text).diagnostics), ["R0204"]);
    let skipped = format!("<project><addData>{}", "<a>".repeat(100_000));
    assert_eq!(codes(&parse(&skipped).diagnostics), ["R0204"]);
}

#[test]
fn many_attributes_and_elements_are_refused() {
    let attributes: String = (0..200_000).map(|n| format!(" a{n}=''")).collect();
    assert_eq!(codes(&parse(&format!("<project{attributes}/>")).diagnostics), ["R0102"]);
    let text = format!("<project>{}</project>", "<a/>".repeat(3_000_000));
    assert_eq!(codes(&parse(&text).diagnostics), ["R0102"]);
}

#[test]
fn a_hundred_megabytes_are_refused_or_read_to_their_end() {
    let blanks = format!("<project>{}</project>", " ".repeat(100 << 20));
    assert_eq!(codes(&parse(&blanks).diagnostics), ["R0222"]);
    let deep = "<addData><data name='x'>".repeat(5 << 20);
    assert_eq!(codes(&parse(&format!("<project>{deep}")).diagnostics), ["R0204"]);
    let texts = format!("<project><p>{}", "<![CDATA[a]]>b".repeat(8 << 20));
    assert_eq!(codes(&parse(&texts).diagnostics), ["R0203"]);
}

#[test]
fn bytes_that_are_not_of_the_declared_encoding_are_refused() {
    let text = ladder("a", &[rail(), coil(2, "a", "1")]).replace("'a'", "'ma\u{df}'");
    let mut wrong = text.into_bytes();
    let at = wrong.iter().position(|byte| *byte == 0xC3).expect("the sharp s");
    wrong.remove(at);
    assert!(Source::decode("test.xml", wrong).is_err());
}

#[test]
fn other_encodings_are_read() {
    let text = ladder("maß", &[rail(), contact(2, "maß", "1"), coil(3, "maß", "2")]);
    let expected = native::print(&parse(&text).program);
    let wide: Vec<u8> = std::iter::once(0xFEFFu16).chain(text.encode_utf16()).flat_map(u16::to_le_bytes).collect();
    let declared = text.replace("utf-8", "ISO-8859-1");
    let narrow: Vec<u8> = declared.chars().map(|c| u8::try_from(u32::from(c)).expect("it is Latin-1")).collect();
    for bytes in [wide, narrow] {
        let source = Source::decode("test.xml", bytes).expect("it is text");
        assert_eq!(native::print(&rung::frontend::parse(&source).program), expected);
    }
}

#[test]
fn a_chain_of_any_length_is_read() {
    let mut elements = vec![rail()];
    elements.extend((2..20_000).map(|id| contact(id, "a", &(id - 1).to_string())));
    elements.push(coil(20_000, "a", "19999"));
    let parsed = parse(&ladder("a", &elements));
    assert!(parsed.diagnostics.is_empty());
    assert_eq!(parsed.program.rungs().next().map(|rung| rung.circuit.branches[0].elements.len()), Some(19_999));
}

#[test]
fn deep_forks_and_formulas_are_read() {
    let mut forks = vec![rail()];
    for id in 1..150 {
        forks.push(contact(id * 2, "a", &(id * 2 - 2).max(1).to_string()));
        forks.push(coil(id * 2 + 1, "b", &(id * 2).to_string()));
    }
    let parsed = parse(&ladder("a b", &forks));
    assert!(parsed.diagnostics.is_empty(), "{:?}", parsed.diagnostics.first());
    assert!(check(&parsed.program).0.is_some());
    let mut sums = vec![value(2, "1")];
    sums.extend((3..200).map(|id| {
        block(
            id,
            "ADD",
            "",
            &format!("IN1={} IN2=2", if id == 3 { "2".to_owned() } else { format!("{}.OUT", id - 1) }),
            "OUT",
        )
    }));
    sums.push(variable(200, "x", "199.OUT"));
    let parsed = parse(&program(&locals("x", "INT"), "FBD", &sums));
    assert!(parsed.diagnostics.is_empty(), "{:?}", parsed.diagnostics.first());
    native::print(&parsed.program);
}

#[test]
fn connectors_in_a_circle_end() {
    let text = ladder(
        "a",
        &[
            rail(),
            element("connector", 2, "name='x'", &wires("3")),
            element("continuation", 3, "name='y'", ""),
            element("connector", 4, "name='y'", &wires("5")),
            element("continuation", 5, "name='x'", ""),
            coil(6, "a", "5"),
        ],
    );
    assert_eq!(codes(&parse(&text).diagnostics), ["R0524"]);
}

/// A drawing with something of everything.
fn everything() -> String {
    let declarations = locals("a b q", "BOOL") + &locals("t", "TON") + &locals("c", "CTU") + &locals("x y", "INT");
    program(
        &declarations,
        "LD",
        &[
            rail(),
            contact(2, "a", "1"),
            contact(3, "b", "1 2"),
            value(4, "T#1s"),
            block(5, "TON", "t", "EN=2 IN/negated=3 PT=4", "ENO Q ET"),
            coil(6, "q", "5.Q 3"),
            value(7, "x + 2"),
            block(8, "ADD", "", "EN=5.ENO IN1=7 IN2=9.CV", "ENO OUT"),
            block(9, "CTU", "c", "CU/rising=2 R=3 PV=8.OUT", "Q CV"),
            variable(10, "y", "8.OUT"),
            element("jump", 11, "label='end'", &wires("9.Q")),
            element("label", 12, "label='end'", ""),
            element("comment", 13, "", "<content><p>what &amp; why</p></content>"),
            coil(14, "q", "6"),
        ],
    )
}

#[test]
fn the_drawing_with_everything_is_sound() {
    let parsed = parse(&everything());
    assert_eq!(codes(&parsed.diagnostics), Vec::<String>::new());
    let printed = native::print(&parsed.program);
    let again = rung::frontend::parse(&Source::new("test.rung", printed.clone()));
    assert_eq!(codes(&again.diagnostics), Vec::<String>::new(), "{printed}");
    assert_eq!(native::print(&again.program), printed);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, ..ProptestConfig::default() })]

    #[test]
    fn no_change_of_a_file_makes_it_panic(
        changes in prop::collection::vec((any::<prop::sample::Index>(), 0usize..6, any::<prop::sample::Index>()), 1..8)
    ) {
        let mut text = everything();
        for (place, change, other) in changes {
            let at = |index: prop::sample::Index, text: &str| {
                let mut at = index.index(text.len());
                while !text.is_char_boundary(at) {
                    at -= 1;
                }
                at
            };
            let (place, other) = (at(place, &text), at(other, &text));
            let (first, last) = (place.min(other), place.max(other));
            match change {
                0 => text.truncate(place.max(40)),
                1 => text.replace_range(first..last.min(first + 30), ""),
                2 => {
                    let copied = text[first..last].chars().take(60).collect::<String>();
                    text.insert_str(place, &copied);
                }
                // Another number, most often that of another element.
                _ => {
                    if let Some(digit) = text[first..].find(|c: char| c.is_ascii_digit()) {
                        text.replace_range(first + digit..=first + digit, &(other % 15).to_string());
                    }
                }
            }
        }
        let parsed = parse(&text);
        native::print(&parsed.program);
        check(&parsed.program);
    }
}
