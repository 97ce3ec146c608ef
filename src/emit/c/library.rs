//! The static functions that emitted code is given when it uses them: operations that no operator of C computes as
//! logic wants them, for each type of C that they are used on.
//!
//! All are total and take the same way whatever the data: masks instead of branches, loops of a constant number of
//! turns. A comparison of 64 bits is written out for machines of 32, where compilers make branches of it.

mod integer;
mod real;

use std::collections::BTreeSet;

/// One function, or one for each of several types.
struct Routine {
    stem: &'static str,
    /// The short names of the types that it is for; empty where it is for one alone, whose name it has not.
    types: &'static [&'static str],
    /// What it calls; `@N` is the type that it is made for itself.
    needs: &'static [&'static str],
    /// The definition. `@N` is the short name of the type, `@T` the type, `@U` the unsigned type that it is computed in,
    /// `@W` its width in bits, `@0` its zero.
    text: &'static str,
}

/// A type of C.
struct Type {
    short: &'static str,
    name: &'static str,
    unsigned: &'static str,
    width: &'static str,
    zero: &'static str,
}

const fn ty(
    short: &'static str,
    name: &'static str,
    unsigned: &'static str,
    width: &'static str,
    zero: &'static str,
) -> Type {
    Type { short, name, unsigned, width, zero }
}

const TYPES: [Type; 11] = [
    ty("", "", "", "", ""),
    ty("u8", "uint8_t", "uint32_t", "8", "0u"),
    ty("i8", "int8_t", "uint32_t", "8", "0"),
    ty("u16", "uint16_t", "uint32_t", "16", "0u"),
    ty("i16", "int16_t", "uint32_t", "16", "0"),
    ty("u32", "uint32_t", "uint32_t", "32", "0u"),
    ty("i32", "int32_t", "uint32_t", "32", "0"),
    ty("u64", "uint64_t", "uint64_t", "64", "0u"),
    ty("i64", "int64_t", "uint64_t", "64", "0"),
    ty("f32", "float", "uint32_t", "32", "0.0f"),
    ty("f64", "double", "uint64_t", "64", "0.0"),
];

/// The short name of a type of C.
pub(super) fn short(c_type: &str) -> &'static str {
    TYPES.iter().find(|ty| ty.name == c_type).map_or("", |ty| ty.short)
}

fn routines() -> impl Iterator<Item = &'static Routine> {
    integer::ROUTINES.iter().chain(real::ROUTINES)
}

/// What emitted code uses.
#[derive(Debug, Default)]
pub(super) struct Library {
    /// Places in the tables of functions and types.
    used: BTreeSet<(usize, usize)>,
}

/// The name of a function for a type, by its short name; empty for one that is for no type.
pub(super) fn function(stem: &str, short: &str) -> String {
    debug_assert!(find(stem, short).is_some(), "no table has {stem} of {short}");
    if short.is_empty() { stem.to_owned() } else { format!("{stem}_{short}") }
}

/// The names that a text calls, functions and macros alike.
pub(super) fn called(text: &str) -> impl Iterator<Item = &str> {
    let is_part = |character: char| character.is_ascii_alphanumeric() || character == '_';
    text.match_indices('(').map(move |(open, _)| {
        let before = &text[..open];
        &before[before.rfind(|character| !is_part(character)).map_or(0, |end| end + 1)..]
    })
}

/// A function's places in the tables of functions and types.
fn find(stem: &str, short: &str) -> Option<(usize, usize)> {
    let routine = routines().position(|routine| {
        routine.stem == stem && (routine.types.contains(&short) || (routine.types.is_empty() && short.is_empty()))
    });
    routine.zip(TYPES.iter().position(|ty| ty.short == short))
}

impl Library {
    /// Takes all that a text calls.
    pub(super) fn take_calls(&mut self, text: &str) {
        for name in called(text) {
            let (stem, short) = name.split_once('_').unwrap_or((name, ""));
            self.take(stem, short);
        }
    }

    /// Takes a function, if there is one, and what it calls.
    fn take(&mut self, stem: &str, short: &str) {
        let Some((routine, ty)) = find(stem, short) else { return };
        if self.used.insert((routine, ty))
            && let Some(routine) = routines().nth(routine)
        {
            for need in routine.needs {
                let (stem, of) = need.split_once('_').unwrap_or((need, ""));
                self.take(stem, if of == "@N" { short } else { of });
            }
        }
    }

    /// The definitions, each behind what it calls.
    pub(super) fn text(&self) -> String {
        let all: Vec<&Routine> = routines().collect();
        let definition = |(routine, ty): &(usize, usize)| {
            let (routine, ty) = (all[*routine], &TYPES[*ty]);
            let text = routine.text.replace("@N", ty.short).replace("@T", ty.name).replace("@U", ty.unsigned);
            text.replace("@W", ty.width).replace("@0", ty.zero)
        };
        self.used.iter().map(definition).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whatever_is_used_all_that_it_calls_stands_before_it() {
        for routine in routines() {
            for short in if routine.types.is_empty() { &[""] } else { routine.types } {
                let mut library = Library::default();
                let name = function(routine.stem, short);
                library.take_calls(&format!("{name}("));
                let text = library.text();
                let definition = text.find(&format!(" {name}(")).expect("it is defined");
                for used in &library.used {
                    let other = routines().nth(used.0).expect("a routine");
                    let ty = TYPES[used.1].short;
                    let other = if ty.is_empty() { other.stem.to_owned() } else { format!("{}_{ty}", other.stem) };
                    let first = text.find(&format!("{other}(")).expect("it is defined");
                    assert!(text[..first].ends_with(' '), "{other} is called before it is defined");
                    assert!(other == name || first < definition, "{other} stands behind {name}");
                }
                assert!(!text.contains('@'), "{text}");
            }
        }
    }
}
