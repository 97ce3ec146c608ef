//! How much goes on in a program, for the coverage table of random tests.

use std::collections::HashMap;

use rung::elementary::Value;

use super::storage::FrameId;

/// How often the power on the right of one element changed; for a block any of its BOOL outputs, or any output if it has
/// no BOOL; for a function box its result. For a statement without a choice how often it was executed.
#[derive(Clone, Debug)]
pub(crate) struct Activity {
    /// What the element is, as a coverage table names it.
    pub kind: String,
    /// How often it changed from one scan to the next.
    pub toggles: u64,
    last: Vec<Value>,
}

/// The activities of everything that a scan came to. Each thing is known by its instance and by where it lies in the
/// program, which is not moved meanwhile.
#[derive(Default)]
pub(super) struct Activities {
    all: Vec<Activity>,
    places: HashMap<(FrameId, *const (), &'static str), usize>,
}

impl Activities {
    pub(super) fn all(&self) -> &[Activity] {
        &self.all
    }

    /// Something showed these values.
    pub(super) fn saw<T: ?Sized>(&mut self, frame: FrameId, thing: &T, kind: &str, seen: Vec<Value>) {
        let activity = self.of(frame, thing, kind);
        if !activity.last.is_empty() && activity.last != seen {
            activity.toggles += 1;
        }
        activity.last = seen;
    }

    /// Something was executed.
    pub(super) fn executed<T: ?Sized>(&mut self, frame: FrameId, thing: &T, kind: &str) {
        self.of(frame, thing, kind).toggles += 1;
    }

    fn of<T: ?Sized>(&mut self, frame: FrameId, thing: &T, kind: &str) -> &mut Activity {
        let next = self.all.len();
        // What is in a thing may lie where it does.
        let key = (frame, std::ptr::from_ref(thing).cast(), std::any::type_name::<T>());
        let place = *self.places.entry(key).or_insert(next);
        if place == next {
            self.all.push(Activity { kind: kind.to_owned(), toggles: 0, last: Vec::new() });
        }
        &mut self.all[place]
    }
}
