//! What is an interface and what is none, and the runs of an image that it names.

use super::*;
use crate::elementary::Value;
use crate::logic::{Area, LayoutBuilder, Slot};

#[test]
fn identifiers_of_c_are_prefixes_and_nothing_else_is() {
    for prefix in ["ladder", "p", "Pump_2", "a__b", &"x".repeat(LONGEST_PREFIX)] {
        assert_eq!(Interface::new(prefix, 1).map(|interface| interface.prefix), Ok(prefix.to_owned()));
    }
    let too_long = "x".repeat(LONGEST_PREFIX + 1);
    for prefix in ["", "_p", "2p", "a-b", "a b", "pümpe", "a.b", "a\0", "a\n", &too_long] {
        let refused = Interface::new(prefix, 1).expect_err("no prefix");
        assert_eq!(refused, BadInterface::Prefix(prefix.to_owned()));
        assert_eq!(refused.code(), Code::BadSymbol);
        assert!(!refused.to_string().contains(['\n', '\0']) && !refused.hint().is_empty());
    }
}

#[test]
fn a_tick_takes_time() {
    for tick in [0, -1, i64::MIN] {
        assert_eq!(Interface::new("p", tick).map_err(|refused| refused.code()), Err(Code::BadTiming));
    }
    assert_eq!(Interface::new("p", i64::MAX).map(|interface| interface.tick()), Ok(i64::MAX));
}

#[test]
fn every_symbol_has_a_name_of_its_own() {
    let interface = Interface::default();
    let names: std::collections::HashSet<String> = Symbol::ALL.iter().map(|s| interface.symbol(*s)).collect();
    assert_eq!(names.len(), Symbol::ALL.len());
    assert!(names.contains("ladder_init") && names.iter().all(|name| name.len() <= 63 - LONGEST_PREFIX + 6));
}

#[test]
fn retained_and_input_bools_are_named_as_runs() {
    let mut layout = LayoutBuilder::new();
    let mut slot = |name: &str, ty, area, retain| {
        let (name, initial) = (name.to_owned(), Value::default_of(ty));
        layout.slot(Slot { name: name.into(), ty, offset: 0, area, retain, initial, line: 0 });
    };
    slot("a", Elementary::Bool, Area::Input, false);
    slot("b", Elementary::Bool, Area::Input, false);
    slot("speed", Elementary::Int, Area::Input, false);
    slot("q", Elementary::Bool, Area::Output, true);
    slot("m", Elementary::Bool, Area::Memory, true);
    slot("total", Elementary::Lint, Area::Memory, true);
    slot("n", Elementary::Bool, Area::Memory, false);
    let layout = layout.finish(None).expect("a small image");
    assert_eq!(input_bools(&layout), vec![0..2]);
    // q and m lie side by side, then 8 bytes, aligned.
    assert_eq!(retain_offset(&layout), 4);
    assert_eq!(retained_bools(&layout), vec![4..6]);
    assert_eq!(retain_size(&layout), 12);
    assert_eq!(image_size(&layout), layout.size() + 16);
}

#[test]
fn without_retained_variables_there_is_no_retained_byte() {
    let layout = LayoutBuilder::new().finish(None).expect("a small image");
    assert_eq!((retain_offset(&layout), retain_size(&layout)), (0, 0));
    assert!(retained_bools(&layout).is_empty() && input_bools(&layout).is_empty());
}
