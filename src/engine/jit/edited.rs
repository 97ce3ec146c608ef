//! A program that is edited while it runs: only the chunks that an edit changed are compiled again.
//!
//! Code depends on nothing but its chunk, where the chunk's slots lie and which of them the rungs before stored lately; what
//! is the same in all of that is kept, where it is. For slots to stay in place, the edited program must be lowered with the
//! layout of the one before as its earlier layout. Nothing is kept by a hash: what is called the same was compared.

use std::collections::HashMap;
use std::ops::Range;

use rung_runtime::Scan;

use super::memory::Call;
use super::{CompileError, Jit, host};
use crate::engine::clif::{self, Chunk, Comparison};
use crate::logic::Program;

/// A compiled program that remembers what it was compiled from.
#[derive(Debug)]
pub struct Edited {
    program: Program,
    jit: Jit,
}

/// What an edit took.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Update {
    /// Chunks that were compiled.
    pub compiled: usize,
    /// Chunks whose code was kept.
    pub kept: usize,
}

impl Edited {
    /// Compiles a verified program, all of it.
    ///
    /// # Errors
    /// As of [`Jit::compile`].
    pub fn compile(program: Program) -> Result<Self, CompileError> {
        let jit = Jit::compile(&program)?;
        Ok(Self { program, jit })
    }

    /// Puts another verified program in its place. The code is the same as if all of it had been compiled.
    ///
    /// # Errors
    /// As of [`Jit::compile`]; the program before then stays.
    pub fn update(&mut self, program: Program) -> Result<Update, CompileError> {
        let sections = program.chunks();
        let kept = self.kept(&program, &sections);
        let fresh: Vec<Range<usize>> = sections
            .iter()
            .zip(&kept)
            .filter(|(_, kept)| kept.is_none())
            .map(|(sections, _)| sections.clone())
            .collect();
        let compiled = clif::compile_some(&program, &fresh, &host()?)?;
        let calls = Call::install(&compiled).map_err(CompileError::Memory)?;
        let mut fresh = compiled.into_iter().zip(calls);
        let mut old: Vec<Option<Chunk>> = std::mem::take(&mut self.jit.chunks).into_iter().map(Some).collect();
        let mut update = Update { compiled: 0, kept: 0 };
        let installed = sections.into_iter().zip(kept).filter_map(|(sections, kept)| match kept {
            Some(kept) => {
                update.kept += 1;
                Some((moved(old[kept].take()?, sections), self.jit.code.calls()[kept].clone()))
            }
            None => {
                update.compiled += 1;
                fresh.next()
            }
        });
        let (chunks, calls): (Vec<Chunk>, Vec<Call>) = installed.unzip();
        self.jit = Jit::of(&program, chunks, calls);
        self.program = program;
        Ok(update)
    }

    /// The program.
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// Its code.
    pub fn jit(&self) -> &Jit {
        &self.jit
    }

    /// For each chunk of another program the one of this that becomes the same code, each once. What stands before the first edit and
    /// behind the last one is found by its place, what moved in between by its length.
    fn kept(&self, program: &Program, sections: &[Range<usize>]) -> Vec<Option<usize>> {
        let old: Vec<Range<usize>> = self.program.chunks();
        let comparison = Comparison::new(&self.program, program);
        let same = |new: usize, of: usize| comparison.is_same(old[of].clone(), sections[new].clone());
        let shorter = old.len().min(sections.len());
        let mut kept = vec![None; sections.len()];
        let mut first = 0;
        while first < shorter && same(first, first) {
            kept[first] = Some(first);
            first += 1;
        }
        let (mut last, mut old_last) = (sections.len(), old.len());
        while last > first && old_last > first && same(last - 1, old_last - 1) {
            (last, old_last) = (last - 1, old_last - 1);
            kept[last] = Some(old_last);
        }
        let mut by_length: HashMap<usize, Vec<usize>> = HashMap::new();
        for (of, sections) in old.iter().enumerate().take(old_last).skip(first) {
            by_length.entry(self.program.instruction_range(sections.clone()).len()).or_default().push(of);
        }
        for new in first..last {
            kept[new] =
                by_length.get_mut(&program.instruction_range(sections[new].clone()).len()).and_then(|candidates| {
                    let found = candidates.iter().position(|of| same(new, *of))?;
                    Some(candidates.remove(found))
                });
        }
        kept
    }
}

/// The chunk, of sections that have other numbers.
fn moved(mut chunk: Chunk, sections: Range<usize>) -> Chunk {
    for (_, section) in &mut chunk.marks {
        *section = *section + sections.start - chunk.sections.start;
    }
    Chunk { sections, ..chunk }
}

impl Scan for Edited {
    fn scan(&mut self, image: &mut [u8], now: i64) {
        self.jit.scan(image, now);
    }
}

#[cfg(test)]
mod tests {
    use std::fmt::Write as _;

    use super::*;
    use crate::engine::interp::Interpreter;
    use crate::logic::image::EarlierLayout;
    use crate::logic::random;
    use crate::source::Source;
    use crate::{check, frontend, lower, opt};

    /// A ladder of rungs that read one another, with one of them written otherwise and perhaps one more behind it.
    fn ladder(edited: Option<(usize, &str)>, earlier: Option<&EarlierLayout>) -> Program {
        let count = 1800;
        let mut text = "program edited\ninput a, b\noutput y\nvar ".to_owned();
        text.push_str(&(0..count).map(|rung| format!("m{rung}")).collect::<Vec<_>>().join(", "));
        text.push('\n');
        for rung in 0..count {
            let body = match edited {
                Some((at, body)) if at == rung => body.to_owned(),
                _ => format!("[ a m{} /m{} | b /m{} ] (m{rung})", rung / 2, (rung * 7) % count, (rung * 13) % count),
            };
            let _ = write!(text, "rung r{rung}\n  {body}\n");
        }
        let source = Source::new("edited", text);
        let parsed = frontend::parse(&source);
        assert!(parsed.diagnostics.is_empty(), "{:?}", parsed.diagnostics);
        let (checked, found) = check::check(&parsed.program);
        let checked = checked.unwrap_or_else(|| panic!("{found:?}"));
        opt::optimise(lower::lower(&checked, &source, earlier).expect("a small image"))
    }

    /// Edits a program; gives what it took. The code must be that of a compilation from nothing.
    fn edit(edited: &mut Edited, to: Program) -> Update {
        let fresh = Jit::compile(&to).expect("code for this machine");
        let update = edited.update(to.clone()).expect("code for this machine");
        assert_eq!(edited.jit().chunks(), fresh.chunks(), "what is kept is what would have been made");
        let (mut interpreter, mut expected) = (Interpreter::new(&to), random::image(&to.layout, 3));
        let mut actual = expected.clone();
        for now in 0..4 {
            interpreter.scan(&mut expected, now);
            edited.scan(&mut actual, now);
            assert_eq!(expected, actual);
        }
        update
    }

    #[test]
    fn an_edit_compiles_the_chunk_that_it_changed_and_perhaps_the_next() {
        let before = ladder(None, None);
        let earlier = EarlierLayout::from(&before.layout);
        let chunks = before.chunks().len();
        assert!(chunks > 6, "only {chunks} chunks, which shows little");
        let mut edited = Edited::compile(before.clone()).expect("code for this machine");
        assert_eq!(edit(&mut edited, before), Update { compiled: 0, kept: chunks });
        for body in ["a b (m900)", "[ a | /b ] m7 (m900)", "a (m900)\nrung more\n  b m900 (y)"] {
            let update = edit(&mut edited, ladder(Some((900, body)), Some(&earlier)));
            assert!((1..=3).contains(&update.compiled), "{body}: {update:?}");
            assert!(update.kept + 3 >= chunks, "{body}: {update:?}");
        }
    }

    #[test]
    fn a_program_of_which_nothing_is_the_same_is_compiled_as_a_whole() {
        for seed in 0..60 {
            let mut edited = Edited::compile(random::program(seed)).expect("code for this machine");
            edit(&mut edited, random::program(seed + 1));
            edit(&mut edited, opt::optimise(random::program(seed)));
        }
    }
}
