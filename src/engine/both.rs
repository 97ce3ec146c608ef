//! Two engines side by side on every scan, as safety systems run diverse implementations: what they disagree on
//! must never reach the field.
//!
//! Each has an image of its own, and only the inputs and `now` are shared; so an error that one of them makes is
//! not handed to the other.

use std::ops::Range;

use rung_runtime::Scan;

use crate::elementary::Value;
use crate::logic::image::{Area, Slot};
use crate::logic::{Layout, Op, Program, SlotId};

/// A scan by two engines, compared.
#[derive(Debug)]
pub struct Both<A, B> {
    first: A,
    second: B,
    /// The second engine's image.
    image: Vec<u8>,
    inputs: Vec<Range<usize>>,
    /// Where the images were first seen to differ, with the first engine's image of that scan.
    differing: Option<Vec<u8>>,
    started: bool,
}

/// What two engines disagree on after a scan.
#[derive(Clone, PartialEq, Debug)]
pub struct Difference {
    /// The slot of which the rung that writes it runs first; `None` where only bytes between slots differ.
    pub slot: Option<SlotId>,
    /// The variable's name, or what there is in place of one.
    pub name: String,
    /// The value in the first engine's image and in the second's; `None` without a slot.
    pub values: Option<(Value, Value)>,
    /// The bytes there, in the first engine's image and in the second's.
    pub bytes: (Vec<u8>, Vec<u8>),
    /// The last rung that writes the slot: its label and its line in the source, from 1, or 0.
    pub rung: Option<(String, u32)>,
    /// How many other slots differ.
    pub others: usize,
}

impl<A: Scan, B: Scan> Both<A, B> {
    /// Runs both engines on images of this layout. The first one's image is the one that is scanned; the second's
    /// starts as a copy of it.
    pub fn new(first: A, second: B, layout: &Layout) -> Self {
        let inputs = layout.inputs().iter().map(|run| run.bytes.start as usize..run.bytes.end as usize).collect();
        let image = layout.initial_image();
        Self { first, second, image, inputs, differing: None, started: false }
    }

    /// The second engine.
    pub fn second(&self) -> &B {
        &self.second
    }

    /// What they disagree on, since the first scan after which they did. No scan runs after that one.
    pub fn difference(&self, program: &Program) -> Option<Difference> {
        self.differing.as_ref().and_then(|first| Difference::between(program, first, &self.image))
    }
}

impl<A: Scan, B: Scan> Scan for Both<A, B> {
    fn scan(&mut self, image: &mut [u8], now: i64) {
        if self.differing.is_some() {
            return;
        }
        if !self.started {
            self.image.copy_from_slice(image);
            self.started = true;
        }
        for run in &self.inputs {
            self.image[run.clone()].copy_from_slice(&image[run.clone()]);
        }
        self.first.scan(image, now);
        self.second.scan(&mut self.image, now);
        if *image != *self.image {
            self.differing = Some(image.to_vec());
        }
    }

    fn trusted(&self) -> bool {
        self.differing.is_none()
    }
}

impl Difference {
    /// Compares two images of a program's layout; `None` when they are the same, byte for byte.
    ///
    /// # Panics
    /// When an image is not of that layout's size.
    pub fn between(program: &Program, first: &[u8], second: &[u8]) -> Option<Self> {
        let at = (0..first.len()).find(|at| first[*at] != second[*at])?;
        let layout = &program.layout;
        let bytes = |slot: &Slot| slot.offset as usize..(slot.offset + slot.ty.size()) as usize;
        let differs = |slot: &Slot| first[bytes(slot)] != second[bytes(slot)];
        let writers = last_writers(program);
        let differing = || layout.slots().iter().enumerate().filter(|(_, slot)| differs(slot));
        // What was written first is the cause more likely than what was computed from it.
        let Some((index, slot)) = differing().min_by_key(|(index, _)| writers[*index].unwrap_or(0)) else {
            let bytes = (vec![first[at]], vec![second[at]]);
            let name = format!("byte {at}, which belongs to no variable");
            return Some(Self { slot: None, name, values: None, bytes, rung: None, others: 0 });
        };
        let rung = writers[index].map(|section| {
            let origin = &program.origins[program.sections[section].origin as usize];
            (origin.label.to_string(), origin.line)
        });
        let id = SlotId(u32::try_from(index).unwrap_or(u32::MAX));
        let observed = layout.observed().iter().find(|observed| observed.slot == id);
        let name = match (observed, slot.area) {
            (Some(observed), _) => observed.name.to_string(),
            (None, Area::State) => format!("{} (a state of a block or an edge)", slot.name),
            (None, _) => slot.name.to_string(),
        };
        Some(Self {
            slot: Some(id),
            name,
            values: Some((slot.read(first), slot.read(second))),
            bytes: (first[bytes(slot)].to_vec(), second[bytes(slot)].to_vec()),
            rung,
            others: differing().count() - 1,
        })
    }
}

/// The last section that stores to each slot.
fn last_writers(program: &Program) -> Vec<Option<usize>> {
    let mut writers = vec![None; program.layout.slots().len()];
    for section in 0..program.sections.len() {
        for instruction in &program.instructions[program.section_range(section)] {
            match instruction.op {
                Op::Store(slot, _) => writers[slot.index()] = Some(section),
                Op::StoreIndexed(array, ..) | Op::CopyArray(array, ..) => {
                    writers[program.layout.array(array).indices()].fill(Some(section));
                }
                _ => {}
            }
        }
    }
    writers
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::Elementary;
    use crate::logic::{Builder, LayoutBuilder, Origin};

    /// `a` is an input; rung r1 sets the state `s` and rung r2 the output `q`, which lies before it.
    fn program() -> Program {
        let mut layout = LayoutBuilder::new();
        let mut slot = |name: &str, ty, area| {
            let (name, initial) = (name.to_owned(), Value::from_bits(ty, 0));
            layout.slot(Slot { name: name.into(), ty, offset: 0, area, retain: false, initial, line: 0 })
        };
        let a = slot("a", Elementary::Bool, Area::Input);
        let q = slot("q", Elementary::Int, Area::Output);
        let s = slot("s", Elementary::Bool, Area::State);
        layout.observe("a", a);
        layout.observe("Motor", q);
        let mut builder = Builder::new("p", layout.finish(None).expect("a small image"));
        let power = builder.load(a);
        builder.store(s, power);
        builder.end_section(Origin { label: "r1".into(), line: 7 });
        let power = builder.load(s);
        let number = builder.convert(power, Elementary::Int);
        builder.store(q, number);
        builder.end_section(Origin { label: "r2".into(), line: 9 });
        builder.finish()
    }

    /// What the program does, written by hand, with errors from a time on.
    struct Engine {
        program: Program,
        wrong: fn(&Program, &mut [u8]),
        from: i64,
    }

    fn set(program: &Program, image: &mut [u8], slot: usize, value: u64) {
        let slot = &program.layout.slots()[slot];
        slot.write(image, Value::from_bits(slot.ty, value));
    }

    impl Scan for Engine {
        fn scan(&mut self, image: &mut [u8], now: i64) {
            let power = self.program.layout.slots()[0].read(image).bits();
            set(&self.program, image, 2, power);
            set(&self.program, image, 1, power);
            if now >= self.from {
                (self.wrong)(&self.program, image);
            }
        }
    }

    fn right() -> Engine {
        Engine { program: program(), wrong: |_, _| (), from: i64::MAX }
    }

    /// Scans both engines ten times with the input on, the second being wrong from scan 5 on.
    fn run(wrong: fn(&Program, &mut [u8])) -> (Both<Engine, Engine>, Vec<u8>) {
        let program = program();
        let mut both = Both::new(right(), Engine { program: program.clone(), wrong, from: 5 }, &program.layout);
        let mut image = program.layout.initial_image();
        image[0] = 1;
        for now in 0..10 {
            both.scan(&mut image, now);
            assert_eq!(both.trusted(), now < 5 || both.difference(&program).is_none());
        }
        (both, image)
    }

    #[test]
    fn engines_that_agree_are_trusted() {
        let (both, image) = run(|_, _| ());
        assert_eq!(both.difference(&program()), None);
        assert!(both.trusted());
        assert_eq!(image[..4], [1, 0, 1, 0]);
    }

    #[test]
    fn the_first_difference_names_variable_values_and_rung() {
        let (both, _) = run(|program, image| set(program, image, 1, 0xFFFF));
        let int = |bits| Value::from_bits(Elementary::Int, bits);
        let expected = Difference {
            slot: Some(SlotId(1)),
            name: "Motor".to_owned(),
            values: Some((int(1), int(u64::MAX))),
            bytes: (1u16.to_ne_bytes().to_vec(), vec![0xFF, 0xFF]),
            rung: Some(("r2".to_owned(), 9)),
            others: 0,
        };
        assert_eq!(both.difference(&program()), Some(expected));
    }

    #[test]
    fn of_several_differences_the_one_written_first_is_named() {
        let (both, _) = run(|program, image| {
            set(program, image, 1, 0);
            set(program, image, 2, 0);
        });
        let found = both.difference(&program()).expect("a difference");
        assert_eq!((found.slot, found.others), (Some(SlotId(2)), 1));
        assert_eq!(found.name, "s (a state of a block or an edge)");
        assert_eq!(found.rung, Some(("r1".to_owned(), 7)));
    }

    #[test]
    fn a_bool_that_is_neither_0_nor_1_is_a_difference() {
        let (both, _) = run(|program, image| image[program.layout.slots()[2].offset as usize] = 3);
        let found = both.difference(&program()).expect("a difference");
        assert_eq!((found.slot, found.bytes), (Some(SlotId(2)), (vec![1], vec![3])));
    }

    #[test]
    fn a_byte_that_belongs_to_no_variable_is_a_difference() {
        let (both, _) = run(|_, image| *image.last_mut().expect("an image") = 1);
        let found = both.difference(&program()).expect("a difference");
        assert_eq!((found.slot, found.values, found.rung), (None, None, None));
        assert!(found.name.contains(&format!("byte {}", program().layout.size() - 1)));
    }

    #[test]
    fn an_error_that_is_gone_in_the_next_scan_is_still_known() {
        let program = program();
        let mut wrong = right();
        wrong.wrong = |program, image| set(program, image, 1, 9);
        wrong.from = 0;
        let mut both = Both::new(right(), wrong, &program.layout);
        let mut image = program.layout.initial_image();
        both.scan(&mut image, 0);
        image[0] = 1;
        both.scan(&mut image, 1);
        assert!(!both.trusted());
        assert_eq!(both.difference(&program).and_then(|found| found.values.map(|values| values.1.bits())), Some(9));
    }
}
