//! The process image: one flat block of bytes with a slot for every variable and every state of a block.
//!
//! The layout is computed before any pass and is the same for every engine and target, in the target's byte
//! order. In order: inputs, outputs, retained memory, other memory, block state. Outputs that are retained come
//! last among the outputs, so that inputs, outputs and the retained are each one contiguous run. Within a run,
//! BOOLs come first and wider types after them in order of width, so that padding is small and near; of one width, long
//! arrays come last, and before them what is used first comes first (see [`Layout::by_use`]).
//!
//! With an earlier layout given, every slot of it keeps its offset, new ones are appended as a second group of
//! the same order, and each run gets one more [`Extent`].

mod check;

#[cfg(test)]
mod tests;

use std::collections::{HashMap, HashSet};
use std::fmt;
use std::ops::Range;

use lean_string::LeanString;

use crate::elementary::{Elementary, Value};

/// Bytes behind the last slot: an engine may read a BOOL as the low byte of 4.
pub const TAIL_PADDING: u32 = 3;

/// The alignment of an image's first byte and, in multiples, its size.
pub const ALIGNMENT: u32 = 8;

/// The name of the slot that tells of an index out of range, where a program has one: a BOOL that stays TRUE.
pub const FAULT: &str = "#fault";

/// The largest image, in bytes: 1 GiB.
pub const MAXIMUM_SIZE: u32 = 1 << 30;

/// A slot, by its place in [`Layout::slots`].
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct SlotId(pub u32);

impl SlotId {
    /// The place as an index.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

impl fmt::Display for SlotId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "s{}", self.0)
    }
}

/// An array, by its place in [`Layout::arrays`].
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct ArrayId(pub u32);

impl ArrayId {
    /// The place as an index.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

impl fmt::Display for ArrayId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a{}", self.0)
    }
}

/// Slots of one type, each right behind the one before, of which one can be chosen while the program runs. Two arrays
/// may share slots.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Array {
    /// The slot of the element 0.
    pub first: SlotId,
    /// How many there are, at least 1; the slots of the others follow the first in [`Layout::slots`].
    pub count: u32,
}

impl Array {
    /// The slots of its elements, in order.
    pub fn slots(self) -> Range<SlotId> {
        self.first..SlotId(self.first.0.saturating_add(self.count))
    }

    /// The same, as indices.
    pub fn indices(self) -> Range<usize> {
        self.first.index()..self.slots().end.index()
    }
}

/// Which part of the image a slot belongs to.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum Area {
    /// Copied in before a scan.
    Input,
    /// Copied out after a scan.
    Output,
    /// Variables.
    Memory,
    /// What blocks and edges remember.
    State,
}

/// One value in the image.
#[derive(Clone, PartialEq, Debug)]
pub struct Slot {
    /// A name that is unique in the layout and stable over edits elsewhere in the program.
    pub name: LeanString,
    /// Its type.
    pub ty: Elementary,
    /// Where it lies, in bytes from the start of the image, aligned to its size.
    pub offset: u32,
    /// Which part it belongs to.
    pub area: Area,
    /// Whether it is kept while the power is off.
    pub retain: bool,
    /// What it holds before the first scan.
    pub initial: Value,
    /// The line of the source that declares it, from 1; 0 where there is none.
    pub line: u32,
}

/// A variable or block output that a person may watch and, by name, set.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Observed {
    /// `name`, or `instance.member`.
    pub name: LeanString,
    /// Where its value is. Two variables at one address share a slot.
    pub slot: SlotId,
}

/// A run of the image, in bytes from its start.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Extent {
    /// All of it.
    pub bytes: Range<u32>,
    /// The part that holds BOOLs, each of which must be 0 or 1.
    pub bools: Range<u32>,
}

/// The layout of an image.
#[derive(Clone, PartialEq, Debug)]
pub struct Layout {
    slots: Vec<Slot>,
    arrays: Vec<Array>,
    observed: Vec<Observed>,
    inputs: Vec<Extent>,
    outputs: Vec<Range<u32>>,
    retained: Vec<Range<u32>>,
    size: u32,
}

/// The image would be larger than [`MAXIMUM_SIZE`].
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct ImageTooLarge;

impl Layout {
    /// A layout of given parts, as a text tells them.
    ///
    /// # Errors
    /// What is wrong with them: see [`EarlierLayout::problems`].
    pub fn from_parts(
        slots: Vec<Slot>,
        arrays: Vec<Array>,
        observed: Vec<Observed>,
        inputs: Vec<Extent>,
        outputs: Vec<Range<u32>>,
        retained: Vec<Range<u32>>,
        size: u32,
    ) -> Result<Self, Vec<String>> {
        let layout = Self { slots, arrays, observed, inputs, outputs, retained, size };
        let problems = layout.problems();
        if problems.is_empty() { Ok(layout) } else { Err(problems) }
    }

    /// What is wrong with it, which of one that a [`LayoutBuilder`] made is nothing: all that
    /// [`EarlierLayout::problems`] names; an initial value of another type; what is observed twice or is no slot; an
    /// array of what are no slots of one type side by side.
    pub fn problems(&self) -> Vec<String> {
        let mut problems = EarlierLayout::from(self).problems();
        for slot in self.slots.iter().filter(|slot| slot.initial.ty() != slot.ty) {
            problems.push(format!("`{}` starts with {:?}, which is no {}", slot.name, slot.initial, slot.ty));
        }
        for (index, array) in self.arrays.iter().enumerate() {
            let slots = self.slots.get(array.indices()).unwrap_or_default();
            let behind = |pair: &[Slot]| {
                pair[0].ty == pair[1].ty && pair[0].offset.checked_add(pair[0].ty.size()) == Some(pair[1].offset)
            };
            if slots.is_empty() || !slots.windows(2).all(behind) {
                problems.push(format!("a{index} is no array: its elements are not side by side"));
            }
        }
        let mut names = HashSet::new();
        for Observed { name, slot } in &self.observed {
            if slot.index() >= self.slots.len() {
                problems.push(format!("`{name}` shows {slot}, which is no slot"));
            }
            if !names.insert(name) {
                problems.push(format!("`{name}` is observed twice"));
            }
        }
        problems
    }

    /// The slots, in the order in which they were asked for.
    pub fn slots(&self) -> &[Slot] {
        &self.slots
    }

    /// One slot.
    pub fn slot(&self, id: SlotId) -> &Slot {
        &self.slots[id.index()]
    }

    /// The arrays, in the order in which they were asked for.
    pub fn arrays(&self) -> &[Array] {
        &self.arrays
    }

    /// One array.
    pub fn array(&self, id: ArrayId) -> Array {
        self.arrays[id.index()]
    }

    /// The slot that is TRUE once an index was out of range; `None` where no index can be.
    pub fn fault(&self) -> Option<SlotId> {
        let place = self.slots.iter().position(|slot| slot.ty == Elementary::Bool && slot.name == FAULT)?;
        u32::try_from(place).ok().map(SlotId)
    }

    /// What can be watched, in declaration order: the columns of a trace.
    pub fn observed(&self) -> &[Observed] {
        &self.observed
    }

    /// The runs that are copied in before a scan: one, and one more for each earlier layout that was extended.
    pub fn inputs(&self) -> &[Extent] {
        &self.inputs
    }

    /// The runs that are copied out after a scan.
    pub fn outputs(&self) -> &[Range<u32>] {
        &self.outputs
    }

    /// The runs that are kept while the power is off.
    pub fn retained(&self) -> &[Range<u32>] {
        &self.retained
    }

    /// Bytes in all, [`TAIL_PADDING`] included: a multiple of [`ALIGNMENT`].
    pub fn size(&self) -> u32 {
        self.size
    }

    /// The same slots, but that of one run and width those of a lower rank come first; `ranks` has one entry a slot, no two
    /// of them the same but for [`u32::MAX`]. What the earlier layout has stays where it was. All ids stay.
    ///
    /// # Errors
    /// [`ImageTooLarge`] when there is no room.
    pub fn by_use(self, earlier: Option<&EarlierLayout>, ranks: &[u32]) -> Result<Self, ImageTooLarge> {
        let Self { slots, arrays, observed, .. } = self;
        LayoutBuilder { slots, arrays, observed }.finish_ranked(earlier, ranks)
    }

    /// What names this layout: two with one hash have the same slots (name, type, part, retain) at the same offsets.
    /// Initial values and source lines do not count. FNV-1a, 64 bits.
    pub fn hash(&self) -> u64 {
        let mut hash = Fnv::default();
        hash.write(&self.size.to_le_bytes());
        for slot in &self.slots {
            hash.write(slot.name.as_bytes());
            hash.write(&[0, slot.ty as u8, slot.area as u8, u8::from(slot.retain)]);
            hash.write(&slot.offset.to_le_bytes());
        }
        hash.0
    }

    /// The bytes before the first scan: every slot at its initial value, padding zero.
    pub fn initial_image(&self) -> Vec<u8> {
        let mut image = vec![0; self.size as usize];
        for slot in &self.slots {
            slot.write(&mut image, slot.initial);
        }
        image
    }
}

impl Slot {
    /// The value in an image of this slot's layout. A BOOL is whether its byte is other than 0.
    ///
    /// # Panics
    /// When the image is shorter than the layout.
    pub fn read(&self, image: &[u8]) -> Value {
        read(image, self.offset, self.ty)
    }

    /// Puts a value into an image of this slot's layout; bits outside this slot's type are dropped.
    ///
    /// # Panics
    /// When the image is shorter than the layout.
    pub fn write(&self, image: &mut [u8], value: Value) {
        write(image, self.offset, Value::from_bits(self.ty, value.bits()));
    }
}

/// The value of type `ty` that lies at `offset`. A BOOL is whether its byte is other than 0.
///
/// # Panics
/// When it lies outside the image.
pub fn read(image: &[u8], offset: u32, ty: Elementary) -> Value {
    fn bytes<const N: usize>(image: &[u8], offset: u32) -> [u8; N] {
        let (mut bytes, at) = ([0; N], offset as usize);
        bytes.copy_from_slice(&image[at..at + N]);
        bytes
    }
    let bits = match ty.size() {
        1 => u64::from(image[offset as usize]),
        2 => u64::from(u16::from_ne_bytes(bytes(image, offset))),
        4 => u64::from(u32::from_ne_bytes(bytes(image, offset))),
        _ => u64::from_ne_bytes(bytes(image, offset)),
    };
    if ty == Elementary::Bool { Value::bool(bits != 0) } else { Value::from_bits(ty, bits) }
}

/// Puts a value at `offset`, as [`read`] reads it.
///
/// # Panics
/// When it does not fit into the image.
pub fn write(image: &mut [u8], offset: u32, value: Value) {
    let mut put = |bytes: &[u8]| image[offset as usize..][..bytes.len()].copy_from_slice(bytes);
    let bits = value.bits();
    #[expect(clippy::cast_possible_truncation, reason = "the low bits are the value")]
    match value.ty().size() {
        1 => put(&[bits as u8]),
        2 => put(&(bits as u16).to_ne_bytes()),
        4 => put(&(bits as u32).to_ne_bytes()),
        _ => put(&bits.to_ne_bytes()),
    }
}

#[derive(Debug)]
struct Fnv(u64);

impl Default for Fnv {
    fn default() -> Self {
        Self(0xCBF2_9CE4_8422_2325)
    }
}

impl Fnv {
    fn write(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01B3);
        }
    }
}

/// A slot of an earlier layout, as a map file tells it.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct KeptSlot {
    /// The name that a slot must have again.
    pub name: String,
    /// The type that it must have again.
    pub ty: Elementary,
    /// The part that it must belong to again.
    pub area: Area,
    /// Whether it must be retained again.
    pub retain: bool,
    /// Where it lies, aligned to its size.
    pub offset: u32,
}

/// An earlier layout.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct EarlierLayout {
    /// Its slots.
    pub slots: Vec<KeptSlot>,
    /// The runs that were copied in.
    pub inputs: Vec<Extent>,
    /// The runs that were copied out.
    pub outputs: Vec<Range<u32>>,
    /// The runs that were kept.
    pub retained: Vec<Range<u32>>,
    /// Its size in bytes.
    pub size: u32,
}

impl From<&Layout> for EarlierLayout {
    fn from(layout: &Layout) -> Self {
        let kept = |slot: &Slot| KeptSlot {
            name: slot.name.to_string(),
            ty: slot.ty,
            area: slot.area,
            retain: slot.retain,
            offset: slot.offset,
        };
        Self {
            slots: layout.slots.iter().map(kept).collect(),
            inputs: layout.inputs.clone(),
            outputs: layout.outputs.clone(),
            retained: layout.retained.clone(),
            size: layout.size,
        }
    }
}

/// Collects slots and then gives each its place.
#[derive(Debug, Default)]
pub struct LayoutBuilder {
    slots: Vec<Slot>,
    arrays: Vec<Array>,
    observed: Vec<Observed>,
}

impl LayoutBuilder {
    /// An empty layout.
    pub fn new() -> Self {
        Self::default()
    }

    /// Asks for a slot. Its offset is given by [`LayoutBuilder::finish`]; the one passed in does not count.
    pub fn slot(&mut self, slot: Slot) -> SlotId {
        let id = SlotId(u32::try_from(self.slots.len()).unwrap_or(u32::MAX));
        self.slots.push(slot);
        id
    }

    /// Makes an array of `count` slots, which were asked for one right after another and are alike in type, part and
    /// retain.
    ///
    /// # Panics
    /// When there are no such slots.
    pub fn array(&mut self, first: SlotId, count: u32) -> ArrayId {
        let array = Array { first, count };
        let same = |slot: &Slot| (slot.ty, slot.area, slot.retain);
        let slots = self.slots.get(array.indices()).unwrap_or_default();
        assert!(!slots.is_empty() && slots.iter().all(|slot| same(slot) == same(&slots[0])), "the slots are alike");
        let id = ArrayId(u32::try_from(self.arrays.len()).unwrap_or(u32::MAX));
        self.arrays.push(array);
        id
    }

    /// Adds a name under which a slot can be watched and set.
    pub fn observe(&mut self, name: impl Into<LeanString>, slot: SlotId) {
        self.observed.push(Observed { name: name.into(), slot });
    }

    /// Places every slot: where the earlier layout has it, else behind. An array that was not whole there, side by side,
    /// goes behind with all its elements.
    ///
    /// # Errors
    /// [`ImageTooLarge`] when there is no room.
    pub fn finish(self, earlier: Option<&EarlierLayout>) -> Result<Layout, ImageTooLarge> {
        self.finish_ranked(earlier, &[])
    }

    /// The same, with what comes first among slots of one run and width: those of a lower rank. Slots beyond the ranks
    /// have the highest.
    fn finish_ranked(self, earlier: Option<&EarlierLayout>, ranks: &[u32]) -> Result<Layout, ImageTooLarge> {
        let none = EarlierLayout::default();
        let earlier = earlier.unwrap_or(&none);
        let kept: HashMap<&str, &KeptSlot> = earlier.slots.iter().map(|slot| (slot.name.as_str(), slot)).collect();
        let mut layout = Layout {
            slots: self.slots,
            arrays: self.arrays,
            observed: self.observed,
            inputs: earlier.inputs.clone(),
            outputs: earlier.outputs.clone(),
            retained: earlier.retained.clone(),
            size: 0,
        };
        let place = |slot: &Slot| {
            let same = |kept: &&&KeptSlot| (kept.ty, kept.area, kept.retain) == (slot.ty, slot.area, slot.retain);
            kept.get(slot.name.as_str()).filter(same).map(|kept| kept.offset)
        };
        let mut places: Vec<Option<u32>> = layout.slots.iter().map(place).collect();
        move_broken(&layout, &mut places);
        let mut fresh = Vec::new();
        for (index, slot) in layout.slots.iter_mut().enumerate() {
            match places[index] {
                Some(offset) => slot.offset = offset,
                None => fresh.push(index),
            }
        }
        let groups = groups(&layout, ranks);
        // A stable sort: slots of one run, width and rank keep the order of their declaration.
        fresh.sort_by_key(|index| (order(&layout.slots[*index]), groups[*index]));
        let mut end = u64::from(earlier.size);
        let runs: Vec<u8> = fresh.iter().map(|index| run_of(&layout.slots[*index])).collect();
        let mut start = 0;
        for run in runs.chunk_by(|a, b| a == b) {
            end = layout.place(&fresh[start..start + run.len()], end)?;
            start += run.len();
        }
        // With nothing new the size stays, too, and by that the hash: the same program has the same layout.
        let last = layout.slots.iter().map(|slot| u64::from(slot.offset) + u64::from(slot.ty.size())).max();
        let needed = last.unwrap_or(0) + u64::from(TAIL_PADDING);
        let size = needed.max(u64::from(earlier.size)).next_multiple_of(u64::from(ALIGNMENT));
        layout.size = u32::try_from(size).ok().filter(|size| *size <= MAXIMUM_SIZE).ok_or(ImageTooLarge)?;
        join(&mut layout.outputs, earlier.outputs.len());
        join(&mut layout.retained, earlier.retained.len());
        Ok(layout)
    }
}

/// Takes their places from all elements of the arrays that are not whole and side by side; where arrays share slots, of
/// all that do.
fn move_broken(layout: &Layout, places: &mut [Option<u32>]) {
    loop {
        let mut moved = false;
        for array in &layout.arrays {
            let step = layout.slots[array.first.index()].ty.size();
            let places = &mut places[array.indices()];
            let whole = places.windows(2).all(|pair| pair[0].is_some() && pair[0].map(|at| at + step) == pair[1]);
            if !whole && places.iter().any(Option::is_some) {
                places.fill(None);
                moved = true;
            }
        }
        if !moved {
            return;
        }
    }
}

/// The place of a slot's run in the image; the retained outputs and the retained memory lie side by side.
fn run_of(slot: &Slot) -> u8 {
    match (slot.area, slot.retain) {
        (Area::Input, _) => 0,
        (Area::Output, false) => 1,
        (Area::Output, true) => 2,
        (Area::Memory | Area::State, true) => 3,
        (Area::Memory, false) => 4,
        (Area::State, false) => 5,
    }
}

/// Bytes from which on an array is long: it lies behind all that is short, which it would push apart.
const LONG: u32 = 32;

/// By slot: whether it is part of a long array, and its rank; all elements of arrays that share slots have the lowest of
/// theirs, so that they stay side by side.
fn groups(layout: &Layout, ranks: &[u32]) -> Vec<(bool, u32)> {
    let rank = |index: usize| ranks.get(index).copied().unwrap_or(u32::MAX);
    let mut groups: Vec<(bool, u32)> = (0..layout.slots.len()).map(|index| (false, rank(index))).collect();
    let mut arrays: Vec<Range<usize>> = layout.arrays.iter().map(|array| array.indices()).collect();
    arrays.sort_unstable_by_key(|slots| slots.start);
    let mut joined: Vec<Range<usize>> = Vec::new();
    for slots in arrays {
        match joined.last_mut() {
            Some(last) if slots.start < last.end => last.end = last.end.max(slots.end),
            _ => joined.push(slots),
        }
    }
    for slots in joined {
        let bytes: u32 = layout.slots[slots.clone()].iter().map(|slot| slot.ty.size()).sum();
        let least = slots.clone().map(rank).min().unwrap_or(u32::MAX);
        groups[slots].fill((bytes >= LONG, least));
    }
    groups
}

fn order(slot: &Slot) -> (u8, bool, u32) {
    (run_of(slot), slot.ty != Elementary::Bool, slot.ty.size())
}

impl Layout {
    /// Places one run of slots behind `end` and notes what it is copied or kept for; gives the new end.
    fn place(&mut self, run: &[usize], end: u64) -> Result<u64, ImageTooLarge> {
        let mut at = end;
        let (mut bools_end, mut start) = (None, None);
        for index in run {
            let slot = &mut self.slots[*index];
            at = at.next_multiple_of(u64::from(slot.ty.size()));
            start.get_or_insert(at);
            slot.offset = u32::try_from(at).map_err(|_| ImageTooLarge)?;
            at += u64::from(slot.ty.size());
            if slot.ty == Elementary::Bool {
                bools_end = Some(at);
            }
        }
        let (Some(first), Some(start)) = (run.first(), start) else { return Ok(end) };
        let offset = |at: u64| u32::try_from(at).map_err(|_| ImageTooLarge);
        let bytes = offset(start)?..offset(at)?;
        let bools = bytes.start..offset(bools_end.unwrap_or(start))?;
        match (self.slots[*first].area, self.slots[*first].retain) {
            (Area::Input, _) => self.inputs.push(Extent { bytes, bools }),
            (Area::Output, retain) => {
                if retain {
                    self.retained.push(bytes.clone());
                }
                self.outputs.push(bytes);
            }
            (Area::Memory | Area::State, true) => self.retained.push(bytes),
            (Area::Memory | Area::State, false) => {}
        }
        Ok(at)
    }
}

/// Makes one run of those from `first` on: they were placed one behind the other, with only padding between.
fn join(runs: &mut Vec<Range<u32>>, first: usize) {
    if let (Some(start), Some(end)) = (runs.get(first).map(|run| run.start), runs.last().map(|run| run.end)) {
        runs.truncate(first);
        runs.push(start..end);
    }
}
