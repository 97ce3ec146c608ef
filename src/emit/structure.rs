//! The structure of the image in C, shared by the header and the emitted code: one named member for each variable, with
//! padding written out so that no compiler adds any of its own.

use std::fmt::Write;

use super::names::{Names, is_hidden};
use super::notes::{Notes, comment};
use crate::elementary::Elementary;
use crate::interface::{Interface, LAST_TICKS, TOTAL_TICKS, image_size};
use crate::logic::{Area, Program, Slot, SlotId, literal as literal_of};

/// The type of C that holds a type in the image and in variables.
pub(super) const fn c_type(ty: Elementary) -> &'static str {
    match ty {
        Elementary::Bool | Elementary::Usint | Elementary::Byte => "uint8_t",
        Elementary::Sint => "int8_t",
        Elementary::Int => "int16_t",
        Elementary::Uint | Elementary::Word => "uint16_t",
        Elementary::Dint => "int32_t",
        Elementary::Udint | Elementary::Dword => "uint32_t",
        Elementary::Lint | Elementary::Time => "int64_t",
        Elementary::Ulint | Elementary::Lword => "uint64_t",
        Elementary::Real => "float",
        Elementary::Lreal => "double",
    }
}

/// One member: a slot, or those of an array.
struct Member {
    name: String,
    first: usize,
    /// `None` for what is no array.
    count: Option<usize>,
}

/// The members of a program's image, in the order of their offsets.
pub(super) struct Structure<'a> {
    program: &'a Program,
    members: Vec<Member>,
    /// For each slot its member, as an index, and its place in there.
    places: Vec<(usize, usize)>,
    /// The names of padding and of the clock behind the layout.
    names: Names,
}

impl<'a> Structure<'a> {
    /// That of a verified program.
    pub(super) fn new(program: &'a Program) -> Self {
        let slots = program.layout.slots();
        // Arrays that share slots are one member.
        let mut arrays: Vec<(usize, usize)> =
            program.layout.arrays().iter().map(|array| array.indices()).map(|range| (range.start, range.end)).collect();
        arrays.sort_unstable();
        let mut joined: Vec<(usize, usize)> = Vec::new();
        for (start, end) in arrays {
            match joined.last_mut() {
                Some(last) if start < last.1 => last.1 = last.1.max(end),
                _ => joined.push((start, end)),
            }
        }
        let mut members = Vec::new();
        let mut at = 0;
        for (start, end) in joined.into_iter().chain([(slots.len(), slots.len())]) {
            members.extend((at..start).map(|first| Member { name: String::new(), first, count: None }));
            if start < end {
                members.push(Member { name: String::new(), first: start, count: Some(end - start) });
            }
            at = end;
        }
        let declared: Vec<String> = members
            .iter()
            .map(|member| {
                let name = &slots[member.first].name;
                if member.count.is_some() { without_indices(name) } else { name.to_string() }
            })
            .collect();
        let mut names = Names::default();
        for (member, name) in members.iter_mut().zip(names.of(declared.iter().map(String::as_str))) {
            member.name = name;
        }
        members.sort_by_key(|member| slots[member.first].offset);
        let mut places = vec![(0, 0); slots.len()];
        for (index, member) in members.iter().enumerate() {
            for place in 0..member.count.unwrap_or(1) {
                places[member.first + place] = (index, place);
            }
        }
        Self { program, members, places, names }
    }

    /// How a slot is written behind `image->`.
    pub(super) fn access(&self, slot: SlotId) -> String {
        let (member, place) = self.places[slot.index()];
        let member = &self.members[member];
        match member.count {
            None => member.name.clone(),
            Some(_) => format!("{}[{place}]", member.name),
        }
    }

    /// How a pointer to a slot, one of an array's, is written, where `image` points to the structure.
    pub(super) fn pointer(&self, slot: SlotId) -> String {
        let (member, place) = self.places[slot.index()];
        let name = &self.members[member].name;
        if place == 0 { format!("image->{name}") } else { format!("&image->{name}[{place}]") }
    }

    /// The definition of the structure, the assertions of its offsets, and the names in it of the clock's two parts.
    pub(super) fn text(&mut self, interface: &Interface, notes: &Notes) -> (String, Clock) {
        let prefix = interface.prefix();
        let layout = &self.program.layout;
        let mut text = format!("typedef struct {prefix}_image_t\n{{\n");
        let mut assertions = String::new();
        let mut number = 0;
        let mut assert = |what: String| {
            number += 1;
            let _ = writeln!(assertions, "typedef char {prefix}_layout_{number}[({what}) ? 1 : -1];");
        };
        let (mut at, mut heading) = (0, "");
        for member in &self.members {
            let slot = &layout.slots()[member.first];
            pad(&mut text, &mut self.names, at, slot.offset);
            let of = section(slot);
            if of != heading {
                let line = if heading.is_empty() { "" } else { "\n" };
                let _ = writeln!(text, "{line}    /* {of} */");
                heading = of;
            }
            let dimension = member.count.map(|count| format!("[{count}]")).unwrap_or_default();
            let last = member.first + member.count.unwrap_or(1) - 1;
            let about = about(slot, &layout.slots()[last], notes);
            let _ = writeln!(text, "    {} {}{dimension}; /* {about} */", c_type(slot.ty), member.name);
            assert(format!("offsetof({prefix}_image_t, {}) == {}u", member.name, slot.offset));
            at = layout.slots()[last].offset + slot.ty.size();
        }
        pad(&mut text, &mut self.names, at, layout.size());
        let [last_ticks, reserved, total_ticks] =
            ["last_ticks", "reserved", "total_ticks"].map(|name| self.names.unique(name.to_owned()));
        let line = if heading.is_empty() { "" } else { "\n" };
        let _ = write!(
            text,
            "{line}    /* The clock: not for firmware */\n    uint32_t {last_ticks}; /* the counter when it was last \
             latched */\n    uint32_t {reserved};\n    uint64_t {total_ticks}; /* ticks since {prefix}_init */\n}} \
             {prefix}_image_t;\n"
        );
        assert(format!("offsetof({prefix}_image_t, {last_ticks}) == {}u", layout.size() + LAST_TICKS));
        assert(format!("offsetof({prefix}_image_t, {total_ticks}) == {}u", layout.size() + TOTAL_TICKS));
        assert(format!("sizeof({prefix}_image_t) == {}u", image_size(layout)));
        let reals = self.members.iter().any(|member| layout.slots()[member.first].ty.is_real());
        if reals {
            assert("(sizeof(float) == 4u) && (sizeof(double) == 8u)".to_owned());
        }
        (format!("{text}\n/* The offsets are the map's. */\n{assertions}"), Clock { last_ticks, total_ticks })
    }
}

/// A duration in the largest unit that leaves no rest, as people write it.
pub(super) fn nanoseconds(number: i64) -> String {
    let units = [("s", 1_000_000_000), ("ms", 1_000_000), ("us", 1_000), ("ns", 1)];
    let (unit, size) = units.into_iter().find(|(_, size)| number % size == 0).unwrap_or(("ns", 1));
    format!("{} {unit}", number / size)
}

/// The names of the members of the clock.
pub(super) struct Clock {
    pub(super) last_ticks: String,
    pub(super) total_ticks: String,
}

fn pad(text: &mut String, names: &mut Names, from: u32, to: u32) {
    if from < to {
        let name = names.unique(format!("padding_{from}"));
        let _ = writeln!(text, "    uint8_t {name}[{}];", to - from);
    }
}

fn section(slot: &Slot) -> &'static str {
    match (slot.area, slot.retain) {
        (Area::Input, _) => "Inputs: set them before a scan",
        (Area::Output, false) => "Outputs: read them after a scan",
        (Area::Output, true) => "Outputs that are retained",
        (Area::Memory | Area::State, true) => "Retained memory",
        (Area::Memory, false) => "Memory",
        (Area::State, false) => "State of blocks and edges",
    }
}

/// What stands behind a member.
fn about(first: &Slot, last: &Slot, notes: &Notes) -> String {
    let mut about = comment(&first.name);
    if first.name != last.name {
        let _ = write!(about, " to {}", comment(&last.name));
    }
    let _ = write!(about, ": {}", first.ty);
    if is_hidden(first) {
        about.push_str(", hidden");
    }
    if first.initial.bits() != 0 {
        let _ = write!(about, ", starts as {}", literal_of(first.initial));
        about.push_str(if first.name == last.name { "" } else { " ..." });
    }
    let declaration = notes.declaration(&without_indices(&first.name));
    if let Some(declaration) = declaration.filter(|declaration| !declaration.address.is_empty()) {
        let _ = write!(about, ", at {}", comment(&declaration.address));
    }
    if first.line > 0 {
        let _ = write!(about, ", line {}", first.line);
    }
    if let Some(declaration) = declaration.filter(|declaration| !declaration.comment.is_empty()) {
        let _ = write!(about, ". {}", comment(&declaration.comment));
    }
    about
}

/// `tank[2].level` without what is in brackets.
fn without_indices(name: &str) -> String {
    let mut depth = 0u32;
    name.chars()
        .filter(|character| match character {
            '[' => {
                depth += 1;
                false
            }
            ']' => {
                depth = depth.saturating_sub(1);
                false
            }
            _ => depth == 0,
        })
        .collect()
}
