//! Names as IEC 61131-3 has them: letters, digits and single underscores, and no keyword. Others get a name of their own, the same
//! wherever they stand.

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};

use crate::elementary::Elementary;
use crate::ladder::functions::Function;
use crate::ladder::{Name, Program, TypeKind, key};

/// Words that no compiler takes for names.
const KEYWORDS: &[&str] = &[
    "action",
    "and",
    "any",
    "array",
    "at",
    "bool",
    "by",
    "byte",
    "case",
    "configuration",
    "constant",
    "date",
    "date_and_time",
    "dint",
    "do",
    "dt",
    "dword",
    "else",
    "elsif",
    "en",
    "end_action",
    "end_case",
    "end_configuration",
    "end_for",
    "end_function",
    "end_function_block",
    "end_if",
    "end_program",
    "end_repeat",
    "end_resource",
    "end_step",
    "end_struct",
    "end_transition",
    "end_type",
    "end_var",
    "end_while",
    "eno",
    "exit",
    "f_edge",
    "false",
    "for",
    "from",
    "function",
    "function_block",
    "if",
    "initial_step",
    "int",
    "lint",
    "lreal",
    "lword",
    "mod",
    "non_retain",
    "not",
    "of",
    "on",
    "or",
    "program",
    "r_edge",
    "read_only",
    "read_write",
    "real",
    "repeat",
    "resource",
    "retain",
    "return",
    "sint",
    "step",
    "string",
    "struct",
    "task",
    "then",
    "time",
    "time_of_day",
    "to",
    "tod",
    "transition",
    "true",
    "type",
    "udint",
    "uint",
    "ulint",
    "until",
    "usint",
    "var",
    "var_access",
    "var_config",
    "var_external",
    "var_global",
    "var_in_out",
    "var_input",
    "var_output",
    "var_temp",
    "while",
    "with",
    "word",
    "wstring",
    "xor",
];

/// The names of a program as they are written.
pub(in crate::frontend) struct Names {
    /// Those that are written otherwise, by their keys.
    renamed: HashMap<String, String>,
    /// The keys of all names that are taken.
    taken: HashSet<String>,
    /// The last number that each stem of fresh names was given.
    numbers: HashMap<String, usize>,
}

impl Names {
    /// The names of a program.
    pub(in crate::frontend) fn of(program: &Program) -> Self {
        let mut declared: Vec<&Name> = Vec::new();
        for ty in &program.types {
            declared.push(&ty.name);
            match &ty.kind {
                TypeKind::Alias { .. } => {}
                TypeKind::Structure(fields) => declared.extend(fields.iter().map(|field| &field.name)),
                TypeKind::Enumeration { values, .. } => declared.extend(values.iter().map(|(name, _)| name)),
            }
        }
        declared.extend(program.globals.iter().map(|variable| &variable.name));
        declared.extend(program.tasks.iter().map(|task| &task.name));
        declared.extend(program.instances.iter().map(|instance| &instance.name));
        for unit in &program.units {
            declared.push(&unit.name);
            declared.extend(unit.variables.iter().map(|variable| &variable.name));
        }
        crate::frontend::uses::blocks_declared_by_use(program, &mut |name| declared.push(name));
        let taken = declared.iter().map(|name| name.key()).collect();
        let mut names = Self { renamed: HashMap::new(), taken, numbers: HashMap::new() };
        for name in declared {
            if !is_identifier(&name.text) && !names.renamed.contains_key(&name.key()) {
                let fresh = names.fresh(&identifier(&name.text));
                names.renamed.insert(name.key(), fresh);
            }
        }
        names
    }

    /// A name as it is written.
    pub(in crate::frontend) fn spell<'a>(&'a self, name: &'a str) -> Cow<'a, str> {
        if is_identifier(name) {
            return Cow::Borrowed(name);
        }
        match self.renamed.get(&key(name)) {
            Some(spelling) => Cow::Borrowed(spelling),
            // A name that nothing declares; checking says so.
            None => Cow::Owned(identifier(name)),
        }
    }

    /// The name of a function: some are keywords too.
    pub(in crate::frontend) fn spell_function<'a>(&'a self, name: &'a str) -> Cow<'a, str> {
        if Function::from_name(name).is_some() { Cow::Borrowed(name) } else { self.spell(name) }
    }

    /// The name of a type: the elementary ones are keywords.
    pub(in crate::frontend) fn spell_type<'a>(&'a self, name: &'a str) -> Cow<'a, str> {
        if Elementary::from_name(name).is_some() { Cow::Borrowed(name) } else { self.spell(name) }
    }

    /// Whether a name is written otherwise.
    pub(in crate::frontend) fn is_renamed(&self, name: &str) -> bool {
        self.renamed.contains_key(&key(name))
    }

    /// A name that nothing else has.
    pub(in crate::frontend) fn fresh(&mut self, stem: &str) -> String {
        let number = self.numbers.entry(key(stem)).or_default();
        loop {
            *number += 1;
            let name = format!("{stem}{number}");
            if self.taken.insert(key(&name)) {
                return name;
            }
        }
    }
}

fn is_identifier(name: &str) -> bool {
    !name.is_empty()
        && !name.starts_with(|first: char| first.is_ascii_digit())
        && name.chars().all(|character| character.is_ascii_alphanumeric() || character == '_')
        && !name.contains("__")
        && !name.ends_with('_')
        && KEYWORDS.binary_search(&key(name).as_str()).is_err()
}

/// What comes nearest to a name.
fn identifier(name: &str) -> String {
    let mut text = String::new();
    for character in name.chars() {
        if character.is_ascii_alphanumeric() {
            text.push(character);
        } else if !text.ends_with('_') {
            text.push('_');
        }
    }
    let text = text.trim_end_matches('_');
    let first = text.chars().next();
    if first.is_none_or(|first| !(first.is_ascii_alphabetic() || first == '_')) {
        format!("n{text}_n")
    } else {
        format!("{text}_n")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_identifier_gets_the_nearest_name() {
        assert!(KEYWORDS.is_sorted());
        assert!(["a", "_TMP_1", "x9", "Input"].into_iter().all(is_identifier));
        assert!(["", "9a", "a__b", "a_", "größe", "a b", "Type", "EN"].iter().all(|name| !is_identifier(name)));
        assert_eq!(["größe", "9 to 5", "", "type"].map(identifier), ["gr_e_n", "n9_to_5_n", "n_n", "type_n"]);
        assert!(["größe", "9 to 5", "", "type"].iter().all(|name| is_identifier(&identifier(name))));
    }
}
