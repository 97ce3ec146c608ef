//! Names for C: of each member of the image one that is unique, plain ASCII and free of words with a meaning.
//!
//! A person who wrote `start` finds `start`. What cannot stay as it is gets a name that depends only on the names of the
//! program, so that the same program gives the same names on every machine. A name that is refused is never mangled
//! instead: whoever links firmware by it must hear of it.

use std::collections::{BTreeSet, HashSet};

use crate::diagnostic::{Code, Diagnostic};
use crate::interface::Interface;
use crate::logic::{Program, Slot};
use crate::source::Span;

/// The keywords of C99, which no member can be named.
const KEYWORDS: [&str; 37] = [
    "_Bool",
    "_Complex",
    "_Imaginary",
    "auto",
    "break",
    "case",
    "char",
    "const",
    "continue",
    "default",
    "do",
    "double",
    "else",
    "enum",
    "extern",
    "float",
    "for",
    "goto",
    "if",
    "inline",
    "int",
    "long",
    "register",
    "restrict",
    "return",
    "short",
    "signed",
    "sizeof",
    "static",
    "struct",
    "switch",
    "typedef",
    "union",
    "unsigned",
    "void",
    "volatile",
    "while",
];

/// Words of later C, of C++ and of their headers, which a member would better not be named: with them the header could
/// not be read everywhere.
const AVOIDED: &[&str] = &[
    "NULL",
    "alignas",
    "alignof",
    "and",
    "and_eq",
    "asm",
    "bitand",
    "bitor",
    "bool",
    "catch",
    "char16_t",
    "char32_t",
    "char8_t",
    "class",
    "co_await",
    "co_return",
    "co_yield",
    "compl",
    "complex",
    "concept",
    "const_cast",
    "consteval",
    "constexpr",
    "constinit",
    "decltype",
    "delete",
    "dynamic_cast",
    "errno",
    "explicit",
    "export",
    "false",
    "friend",
    "i386",
    "imaginary",
    "linux",
    "mutable",
    "namespace",
    "new",
    "noexcept",
    "not",
    "not_eq",
    "nullptr",
    "offsetof",
    "operator",
    "or",
    "or_eq",
    "private",
    "protected",
    "public",
    "reinterpret_cast",
    "requires",
    "static_assert",
    "static_cast",
    "template",
    "this",
    "thread_local",
    "throw",
    "true",
    "try",
    "typeid",
    "typename",
    "typeof",
    "typeof_unqual",
    "unix",
    "using",
    "virtual",
    "wchar_t",
    "xor",
    "xor_eq",
];

/// Whether a header of C may have made a macro or a type of a name: `INT8_MAX`, `UINT64_C`, `SIZE_MAX`, `uint8_t`, …
fn is_of_header(name: &str) -> bool {
    let starts = |prefixes: &[&str]| prefixes.iter().any(|prefix| name.starts_with(prefix));
    let ends = |suffixes: &[&str]| suffixes.iter().any(|suffix| name.ends_with(suffix));
    let limits = starts(&["INT", "UINT", "PTRDIFF_", "SIZE_", "SIG_ATOMIC_", "WCHAR_", "WINT_"])
        && ends(&["_MIN", "_MAX", "_C", "_WIDTH"]);
    limits || ((starts(&["int", "uint"]) || ["size_t", "ptrdiff_t", "max_align_t"].contains(&name)) && ends(&["_t"]))
}

/// The part of a name by which it was declared: up to a member, an index or what is hidden.
fn root(name: &str) -> &str {
    name.split(['.', '[', '#']).next().unwrap_or(name)
}

/// Whether a slot is of what no one declared: what a block or an edge remembers.
pub(super) fn is_hidden(slot: &Slot) -> bool {
    slot.name.contains('#')
}

/// Says of every name that C cannot spell that it cannot: keywords, and what is not ASCII. `place` finds a name in a line
/// of the source, counted from 1.
///
/// # Errors
/// [`Code::NotACName`], one for each declaration and one for the prefix.
pub fn validate(
    program: &Program,
    interface: &Interface,
    place: &dyn Fn(u32, &str) -> Span,
) -> Result<(), Vec<Diagnostic>> {
    let mut problems = Vec::new();
    let problem = |span: Span, message: String, hint: &str| Diagnostic::new(Code::NotACName, span, message).hint(hint);
    let prefix = interface.prefix();
    if KEYWORDS.contains(&prefix) || AVOIDED.contains(&prefix) {
        let message = format!("the prefix `{prefix}` is a word of C");
        problems.push(problem(Span::default(), message, "give another one with `--prefix`"));
    }
    let mut said = HashSet::new();
    for slot in program.layout.slots().iter().filter(|slot| !is_hidden(slot)) {
        let name = slot.name.as_str();
        let root = root(name);
        let what = if !name.is_ascii() {
            "is not ASCII, as names of C are"
        } else if KEYWORDS.contains(&name.split('[').next().unwrap_or(name)) {
            "is a keyword of C"
        } else {
            continue;
        };
        // Of a variable with many members or elements once.
        if said.insert((root, slot.line)) {
            let shown = if root.is_ascii() && !KEYWORDS.contains(&root) { name } else { root };
            let message = format!("`{shown}` {what}");
            problems.push(problem(place(slot.line, root), message, "rename it: firmware is linked by these names"));
        }
    }
    if problems.is_empty() { Ok(()) } else { Err(problems) }
}

/// The names of one structure.
#[derive(Debug, Default)]
pub(super) struct Names {
    taken: BTreeSet<String>,
}

impl Names {
    /// A name for each of some, in their order. One that is fit as it is stays so, whatever stands before it.
    pub(super) fn of<'a>(&mut self, names: impl Iterator<Item = &'a str>) -> Vec<String> {
        let fit: Vec<(String, bool)> = names.map(|name| (fit(name), fit(name) == name)).collect();
        let mut chosen: Vec<Option<String>> =
            fit.iter().map(|(name, stays)| (*stays && self.taken.insert(name.clone())).then(|| name.clone())).collect();
        for (chosen, (name, _)) in chosen.iter_mut().zip(fit) {
            if chosen.is_none() {
                *chosen = Some(self.unique(name));
            }
        }
        chosen.into_iter().flatten().collect()
    }

    /// The name itself, or with a number behind it.
    pub(super) fn unique(&mut self, name: String) -> String {
        let mut unique = name.clone();
        let mut number = 1u32;
        while !self.taken.insert(unique.clone()) {
            number += 1;
            unique = format!("{name}_{number}");
        }
        unique
    }
}

/// The name with what C has no letters for replaced, and moved off the words that it should not be.
fn fit(name: &str) -> String {
    let letter = |character: char| if character.is_ascii_alphanumeric() { character } else { '_' };
    let is_part = |character: char| character.is_ascii_alphanumeric() || character == '_';
    let mut fit = String::new();
    for character in name.trim_start_matches(|character| !is_part(character)).chars().map(letter) {
        // C++ keeps names with two underscores in a row to itself.
        if !(character == '_' && fit.ends_with('_')) {
            fit.push(character);
        }
    }
    if fit != name && fit.len() > 1 && fit.ends_with('_') && !name.ends_with('_') {
        fit.pop();
    }
    if fit.starts_with(|first: char| first.is_ascii_digit() || first == '_') || fit.is_empty() {
        fit.insert(0, 'x');
    }
    if KEYWORDS.contains(&fit.as_str()) || AVOIDED.contains(&fit.as_str()) || is_of_header(&fit) {
        fit.push('_');
    }
    fit
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(of: &[&str]) -> Vec<String> {
        Names::default().of(of.iter().copied())
    }

    #[test]
    fn a_name_that_c_can_spell_stays_as_it_is_whatever_stands_before_it() {
        assert_eq!(names(&["a.b", "a_b", "a[1]", "Start", "t5#start"]), ["a_b_2", "a_b", "a_1", "Start", "t5_start"]);
        assert_eq!(names(&["x", "x'", "x''", "x_2"]), ["x", "x_3", "x_4", "x_2"].map(str::to_owned).to_vec());
    }

    #[test]
    fn words_with_a_meaning_are_avoided() {
        assert_eq!(
            names(&["class", "INT8_MAX", "uint8_t", "_Foo", "__x", "1st", "", "#", "NULL", "INTERN", "#fault"]),
            ["class_", "INT8_MAX_", "uint8_t_", "x_Foo", "x_x", "x1st", "x", "x_2", "NULL_", "INTERN", "fault"]
        );
    }
}
