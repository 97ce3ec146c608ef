//! The order of slots, the runs, earlier layouts and what is refused.

use super::*;

fn slot(name: &str, ty: Elementary, area: Area, retain: bool) -> Slot {
    Slot { name: name.into(), ty, offset: 0, area, retain, initial: Value::default_of(ty), line: 0 }
}

fn laid_out(slots: &[Slot], earlier: Option<&EarlierLayout>) -> Layout {
    let mut layout = LayoutBuilder::new();
    for slot in slots {
        let id = layout.slot(slot.clone());
        layout.observe(slot.name.clone(), id);
    }
    layout.finish(earlier).unwrap()
}

/// One slot and more of every run, declared in no order.
fn mixed() -> Vec<Slot> {
    use Elementary::{Bool, Int, Lreal, Time};
    vec![
        slot("state", Time, Area::State, false),
        slot("memory", Int, Area::Memory, false),
        slot("kept_output", Int, Area::Output, true),
        slot("kept_state", Time, Area::State, true),
        slot("wide_input", Int, Area::Input, false),
        slot("output", Bool, Area::Output, false),
        slot("input", Bool, Area::Input, false),
        slot("kept", Bool, Area::Memory, true),
        slot("flag", Bool, Area::Memory, false),
        slot("last_input", Lreal, Area::Input, false),
        slot("second_input", Bool, Area::Input, false),
    ]
}

#[test]
fn runs_come_in_order_and_bools_first_in_each() {
    let layout = laid_out(&mixed(), None);
    let mut places: Vec<(u32, &str)> = layout.slots().iter().map(|slot| (slot.offset, slot.name.as_str())).collect();
    places.sort_unstable();
    let expected = [
        (0, "input"),
        (1, "second_input"),
        (2, "wide_input"),
        (8, "last_input"),
        (16, "output"),
        (18, "kept_output"),
        (20, "kept"),
        (24, "kept_state"),
        (32, "flag"),
        (34, "memory"),
        (40, "state"),
    ];
    assert_eq!(places, expected);
    assert_eq!(layout.inputs(), [Extent { bytes: 0..16, bools: 0..2 }]);
    assert_eq!(layout.outputs(), std::slice::from_ref(&(16..20)));
    assert_eq!(layout.retained(), std::slice::from_ref(&(18..32)));
    assert_eq!(layout.size(), 56, "48 bytes, 3 of padding, rounded up");
    assert_eq!(layout.problems(), Vec::<String>::new());
}

#[test]
fn an_empty_image_still_has_its_padding() {
    let layout = laid_out(&[], None);
    assert_eq!((layout.size(), layout.initial_image()), (8, vec![0; 8]));
}

#[test]
fn an_earlier_layout_keeps_its_offsets_and_new_slots_come_behind() {
    let old = laid_out(&mixed(), None);
    let mut slots = mixed();
    slots.insert(0, slot("new_input", Elementary::Bool, Area::Input, false));
    slots.insert(3, slot("new_kept_output", Elementary::Int, Area::Output, true));
    slots.insert(5, slot("new_kept", Elementary::Dint, Area::Memory, true));
    let new = laid_out(&slots, Some(&EarlierLayout::from(&old)));
    for slot in old.slots() {
        let kept = new.slots().iter().find(|kept| kept.name == slot.name).unwrap();
        assert_eq!(kept, slot);
    }
    assert_eq!(new.inputs(), [Extent { bytes: 0..16, bools: 0..2 }, Extent { bytes: 56..57, bools: 56..57 }]);
    assert_eq!(new.outputs(), [16..20, 58..60]);
    assert_eq!(new.retained(), [18..32, 58..64]);
    assert_eq!(new.size(), 72);
    assert_eq!(new.problems(), Vec::<String>::new());
}

#[test]
fn a_slot_that_changed_its_type_or_part_moves() {
    let old = laid_out(&[slot("x", Elementary::Int, Area::Memory, false)], None);
    for changed in [
        slot("x", Elementary::Uint, Area::Memory, false),
        slot("x", Elementary::Int, Area::Output, false),
        slot("x", Elementary::Int, Area::Memory, true),
    ] {
        let new = laid_out(&[changed], Some(&EarlierLayout::from(&old)));
        assert_eq!(new.slots()[0].offset, old.size());
        assert_eq!(new.problems(), Vec::<String>::new());
    }
}

#[test]
fn a_full_image_is_refused() {
    let earlier = EarlierLayout { size: MAXIMUM_SIZE, ..EarlierLayout::default() };
    let mut layout = LayoutBuilder::new();
    layout.slot(slot("x", Elementary::Bool, Area::Memory, false));
    assert_eq!(layout.finish(Some(&earlier)), Err(ImageTooLarge));
}

#[test]
fn the_hash_names_the_layout_and_nothing_else() {
    let hash = |change: fn(&mut Slot)| {
        let mut slots = mixed();
        change(&mut slots[1]);
        laid_out(&slots, None).hash()
    };
    let same = hash(|_| ());
    assert_eq!(same, hash(|slot| slot.initial = Value::from_bits(slot.ty, 7)));
    assert_eq!(same, hash(|slot| slot.line = 7));
    assert_ne!(same, hash(|slot| slot.name.push('x')));
    assert_ne!(same, hash(|slot| slot.ty = Elementary::Uint));
    assert_ne!(same, hash(|slot| slot.retain = true));
    assert_ne!(same, hash(|slot| slot.area = Area::State));
}

#[test]
fn every_type_is_read_as_it_was_written_and_nothing_beside_it_changes() {
    for ty in Elementary::ALL {
        let layout = laid_out(&[slot("x", ty, Area::Memory, false), slot("y", ty, Area::Memory, false)], None);
        for bits in [0, 1, 0x8000_0000_8000_8080, 0x1234_5678_9ABC_DEF1, u64::MAX] {
            let value = Value::from_bits(ty, bits);
            let mut image = vec![0; layout.size() as usize];
            layout.slots()[1].write(&mut image, value);
            assert_eq!(
                (layout.slots()[0].read(&image), layout.slots()[1].read(&image)),
                (Value::default_of(ty), value)
            );
            let end = 2 * ty.size() as usize;
            assert!(image[end..].iter().all(|byte| *byte == 0));
        }
    }
    assert_eq!(read(&[2], 0, Elementary::Bool), Value::bool(true));
}

#[test]
fn the_first_image_holds_the_initial_values() {
    let mut slots = mixed();
    slots[1].initial = Value::from_bits(Elementary::Int, u64::MAX);
    slots[6].initial = Value::bool(true);
    let layout = laid_out(&slots, None);
    let image = layout.initial_image();
    let expected: Vec<(usize, u8)> = vec![(0, 1), (34, 0xFF), (35, 0xFF)];
    let set: Vec<(usize, u8)> = image.iter().copied().enumerate().filter(|(_, byte)| *byte != 0).collect();
    assert_eq!(set, expected);
}

#[test]
fn unsound_layouts_are_refused() {
    type Change = fn(&mut EarlierLayout);
    let cases: [(Change, &str); 13] = [
        (|layout| layout.size = 57, "an image cannot have 57 bytes"),
        (|layout| layout.size = 2 << 30, "an image cannot have 2147483648 bytes"),
        (|layout| layout.size = 0, "an image cannot have 0 bytes"),
        (|layout| layout.slots[0].offset = 41, "`state` cannot lie at 41"),
        (|layout| layout.slots[0].offset = 48, "`state` cannot lie at 48"),
        (|layout| layout.slots[0].offset = u32::MAX - 7, "`state` cannot lie at 4294967288"),
        (|layout| layout.slots[0].offset = 32, "`state` and `flag` overlap"),
        (|layout| layout.slots[1].name = "state".to_owned(), "`state` is there twice"),
        (|layout| layout.outputs[0].end = 54, "the output run 16..54 is misplaced"),
        (|layout| layout.retained[0].start = 40, "the retained run 40..32 is misplaced"),
        (|layout| layout.inputs[0].bools.end = 18, "the BOOLs 0..18 are not inside their run"),
        (|layout| layout.outputs[0].start = 12, "the run 12..20 overlaps the inputs"),
        (
            |layout| layout.inputs[0].bools.end = 3,
            "`wide_input` at 2 is not a BOOL input, unlike the run that it lies in",
        ),
    ];
    let sound = EarlierLayout::from(&laid_out(&mixed(), None));
    for (change, expected) in cases {
        let mut layout = sound.clone();
        change(&mut layout);
        let problems = layout.problems();
        assert!(problems.iter().any(|problem| problem == expected), "{problems:?} lacks {expected}");
    }
}

/// An array of so many elements, then another slot.
fn with_array(elements: u32, earlier: Option<&EarlierLayout>) -> Layout {
    let int = |name: String| slot(&name, Elementary::Int, Area::Memory, false);
    let mut layout = LayoutBuilder::new();
    let slots: Vec<SlotId> = (0..elements).map(|element| layout.slot(int(format!("a[{element}]")))).collect();
    layout.slot(int("b".to_owned()));
    layout.array(slots[0], elements);
    layout.finish(earlier).unwrap()
}

#[test]
fn an_array_that_grew_moves_as_a_whole() {
    let old = with_array(3, None);
    let offsets = |layout: &Layout| layout.slots().iter().map(|slot| slot.offset).collect::<Vec<_>>();
    assert_eq!((offsets(&old), old.size()), (vec![0, 2, 4, 6], 16));
    let earlier = EarlierLayout::from(&old);
    assert_eq!(with_array(3, Some(&earlier)), old);
    let grown = with_array(4, Some(&earlier));
    assert_eq!(offsets(&grown), [16, 18, 20, 22, 6]);
    assert_eq!(grown.problems(), Vec::<String>::new());
    assert_eq!(offsets(&with_array(2, Some(&earlier))), [0, 2, 6]);
}

#[test]
fn an_array_of_slots_that_are_not_side_by_side_is_refused() {
    let good = with_array(3, None);
    for (first, count) in [(0, 0), (0, 5), (4, 1), (0, u32::MAX), (u32::MAX, 2)] {
        let mut layout = good.clone();
        layout.arrays[0] = Array { first: SlotId(first), count };
        assert_eq!(layout.problems(), ["a0 is no array: its elements are not side by side"], "{first} {count}");
    }
    let mut layout = good.clone();
    layout.slots[1].ty = Elementary::Word;
    layout.slots[1].initial = Value::default_of(Elementary::Word);
    assert_eq!(layout.problems(), ["a0 is no array: its elements are not side by side"]);
}
