//! Logic from text: the reverse of [`print`](super::print), which describes the form.
//!
//! Any text whatever gives a verified program or diagnostics.

use std::sync::Arc;

use super::image::{Extent, Observed};
use super::print::{UNITS, area_of};
use super::{
    Array, ArrayId, Binary, Compare, Helper, Instruction, Layout, Op, Origin, Program, Section, Slot, SlotId, Task,
    Unary, ValueId, verify,
};
use crate::diagnostic::{Code, Diagnostic};
use crate::elementary::{Elementary, Value};
use crate::source::{Source, Span};
use std::ops::Range;

/// Faults after which the rest is not read.
const MOST_FAULTS: usize = 50;

/// Reads a program.
///
/// # Errors
/// [`Code::BadLogic`] for each line that cannot be read, or else for all that the verifier finds.
pub fn parse(source: &Source) -> Result<Program, Vec<Diagnostic>> {
    let mut reader = Reader::default();
    let mut faults = Vec::new();
    let mut start = 0;
    for text in source.text().split_inclusive('\n') {
        let mut line = Line { text: text.trim_end_matches(['\n', '\r']), start, at: 0 };
        start += text.len();
        if let Err(fault) = reader.line(&mut line) {
            faults.push(fault);
        }
        if faults.len() == MOST_FAULTS {
            break;
        }
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    let fault = |message: String| Diagnostic::new(Code::BadLogic, Span::default(), message);
    let all = |messages: Vec<String>| messages.into_iter().take(MOST_FAULTS).map(fault).collect::<Vec<_>>();
    let program = reader.finish().map_err(all)?;
    match verify(&program) {
        Ok(()) => Ok(program),
        Err(problems) => Err(all(problems.iter().map(ToString::to_string).collect())),
    }
}

#[derive(Default)]
struct Reader {
    name: Option<String>,
    size: u32,
    slots: Vec<Slot>,
    arrays: Vec<Array>,
    inputs: Vec<Extent>,
    outputs: Vec<Range<u32>>,
    retained: Vec<Range<u32>>,
    observed: Vec<Observed>,
    /// Each with its index and where it stands.
    origins: Vec<(u32, Origin)>,
    chunk: bool,
    sections: Vec<Section>,
    tasks: Vec<Task>,
    instructions: Vec<Instruction>,
}

impl Reader {
    fn finish(mut self) -> Result<Program, Vec<String>> {
        let layout = Layout::from_parts(
            self.slots,
            self.arrays,
            self.observed,
            self.inputs,
            self.outputs,
            self.retained,
            self.size,
        )?;
        self.origins.sort_by(|a, b| (a.0, a.1.line, &a.1.label).cmp(&(b.0, b.1.line, &b.1.label)));
        self.origins.dedup();
        let mut origins = Vec::with_capacity(self.origins.len());
        for (index, origin) in self.origins {
            if index as usize != origins.len() {
                return Err(vec![format!("the origin {index} is missing or there twice")]);
            }
            origins.push(origin);
        }
        let name = self.name.ok_or_else(|| vec!["there is no program line".to_owned()])?;
        if self.tasks.is_empty() {
            self.tasks.push(Task::always(0));
        }
        let Self { sections, tasks, instructions, .. } = self;
        Ok(Program { name, layout: Arc::new(layout), origins, sections, tasks, instructions })
    }

    fn line(&mut self, line: &mut Line<'_>) -> Result<(), Diagnostic> {
        let Some(word) = line.peek() else { return Ok(()) };
        match word {
            "program" => {
                line.word()?;
                self.name = Some(line.quoted()?);
            }
            "image" => {
                line.word()?;
                self.size = line.number("")?;
            }
            "inputs" => {
                line.word()?;
                let bytes = line.range()?;
                line.keyword("bools")?;
                self.inputs.push(Extent { bytes, bools: line.range()? });
            }
            "outputs" => {
                line.word()?;
                self.outputs.push(line.range()?);
            }
            "retained" => {
                line.word()?;
                self.retained.push(line.range()?);
            }
            "observe" => {
                line.word()?;
                let slot = SlotId(line.number("s")?);
                self.observed.push(Observed { name: line.quoted()?.into(), slot });
            }
            "array" => {
                line.word()?;
                if line.number("a")? as usize != self.arrays.len() {
                    return Err(line.fault(format!("the next array is a{}", self.arrays.len())));
                }
                let first = SlotId(line.number("s")?);
                line.keyword("count")?;
                self.arrays.push(Array { first, count: line.number("")? });
            }
            "task" => {
                line.word()?;
                let task = self.task(line)?;
                self.tasks.push(task);
            }
            "chunk" => {
                line.word()?;
                self.chunk = true;
            }
            "origin" => {
                line.word()?;
                let origin = line.origin()?;
                self.origins.push(origin);
            }
            "section" => {
                line.word()?;
                let origin = line.origin()?;
                let (index, end) = (origin.0, length(&self.instructions));
                self.origins.push(origin);
                self.sections.push(Section { origin: index, end, starts_chunk: std::mem::take(&mut self.chunk) });
                let end = length(&self.sections);
                match self.tasks.last_mut() {
                    Some(task) => task.end = end,
                    None => self.tasks.push(Task::always(end)),
                }
            }
            _ if word.starts_with('s') && !matches!(word, "store" | "store_indexed") => {
                let slot = self.slot(line)?;
                self.slots.push(slot);
            }
            _ => {
                let instruction = self.instruction(line);
                // A wrong line counts, too, so that those after it keep their numbers.
                let ty = Elementary::Bool;
                self.instructions.push(*instruction.as_ref().unwrap_or(&Instruction { ty, op: Op::Constant(0) }));
                instruction?;
                match self.sections.last_mut() {
                    Some(section) => section.end = length(&self.instructions),
                    None => return Err(line.fault("an instruction before the first section")),
                }
            }
        }
        line.end()
    }

    fn slot(&self, line: &mut Line<'_>) -> Result<Slot, Diagnostic> {
        if line.number("s")? as usize != self.slots.len() {
            return Err(line.fault(format!("the next slot is s{}", self.slots.len())));
        }
        let ty = line.ty()?;
        line.keyword("at")?;
        let offset = line.number("")?;
        let area = line.word().ok().and_then(area_of).ok_or_else(|| line.fault("input, output, memory or state"))?;
        let retain = line.peek() == Some("retain");
        if retain {
            line.word()?;
        }
        line.keyword("line")?;
        let number = line.number("")?;
        line.keyword("=")?;
        let initial = line.literal(ty)?;
        Ok(Slot { name: line.quoted()?.into(), ty, offset, area, retain, initial, line: number })
    }

    fn task(&self, line: &mut Line<'_>) -> Result<Task, Diagnostic> {
        let mut task = Task { name: line.quoted()?, ..Task::always(length(&self.sections)) };
        if line.peek() == Some("every") {
            line.word()?;
            task.interval = Some(line.literal(Elementary::Time)?.bits().cast_signed());
        }
        if line.peek() == Some("due") {
            line.word()?;
            task.due = Some(SlotId(line.number("s")?));
        }
        Ok(task)
    }

    fn instruction(&self, line: &mut Line<'_>) -> Result<Instruction, Diagnostic> {
        if line.peek() == Some("store") {
            line.word()?;
            let (slot, ty) = self.slot_type(line)?;
            line.keyword(",")?;
            return Ok(Instruction { ty, op: Op::Store(slot, line.value()?) });
        }
        if line.peek() == Some("store_indexed") {
            line.word()?;
            let (array, ty) = self.array_type(line)?;
            line.keyword(",")?;
            let index = line.value()?;
            line.keyword(",")?;
            return Ok(Instruction { ty, op: Op::StoreIndexed(array, index, line.value()?) });
        }
        if line.peek() == Some("copy_array") {
            line.word()?;
            let (to, ty) = self.array_type(line)?;
            line.keyword(",")?;
            let (from, _) = self.array_type(line)?;
            line.keyword(",")?;
            return Ok(Instruction { ty, op: Op::CopyArray(to, from, line.value()?) });
        }
        if line.number("v")? as usize != self.instructions.len() {
            return Err(line.fault(format!("the next value is v{}", self.instructions.len())));
        }
        line.keyword("=")?;
        let mnemonic = line.word()?;
        match mnemonic {
            "now" => return Ok(Instruction { ty: Elementary::Time, op: Op::Now }),
            "load" => {
                let (slot, ty) = self.slot_type(line)?;
                return Ok(Instruction { ty, op: Op::Load(slot) });
            }
            "load_indexed" => {
                let (array, ty) = self.array_type(line)?;
                line.keyword(",")?;
                return Ok(Instruction { ty, op: Op::LoadIndexed(array, line.value()?) });
            }
            _ => {}
        }
        let (unary, binary) = (Unary::from_mnemonic(mnemonic), Binary::from_mnemonic(mnemonic));
        let (compare, helper) = (Compare::from_mnemonic(mnemonic), Helper::from_mnemonic(mnemonic));
        if !matches!(mnemonic, "const" | "select" | "convert" | "reinterpret")
            && unary.is_none()
            && binary.is_none()
            && compare.is_none()
            && helper.is_none()
        {
            return Err(line.fault("the name of an operation"));
        }
        let ty = line.ty()?;
        if mnemonic == "const" {
            return Ok(Instruction { ty, op: Op::Constant(line.literal(ty)?.bits()) });
        }
        let first = line.value()?;
        let mut next = || line.keyword(",").and_then(|()| line.value());
        let op = if let Some(op) = unary {
            Op::Unary(op, first)
        } else if let Some(op) = binary {
            Op::Binary(op, first, next()?)
        } else if let Some(op) = compare {
            let second = next()?;
            // The type that is written is the operands'; the result's is known.
            if self.instructions.get(first.index()).is_none_or(|instruction| instruction.ty != ty) {
                return Err(line.fault(format!("{first} to be of type {ty}")));
            }
            return Ok(Instruction { ty: Elementary::Bool, op: Op::Compare(op, first, second) });
        } else if let Some(helper) = helper {
            Op::Call(helper, first, if helper.takes_two() { Some(next()?) } else { None })
        } else if mnemonic == "select" {
            Op::Select(first, next()?, next()?)
        } else if mnemonic == "convert" {
            Op::Convert(first)
        } else {
            Op::Reinterpret(first)
        };
        Ok(Instruction { ty, op })
    }

    fn slot_type(&self, line: &mut Line<'_>) -> Result<(SlotId, Elementary), Diagnostic> {
        let slot = SlotId(line.number("s")?);
        match self.slots.get(slot.index()) {
            Some(found) => Ok((slot, found.ty)),
            None => Err(line.fault("a slot of the image")),
        }
    }

    fn array_type(&self, line: &mut Line<'_>) -> Result<(ArrayId, Elementary), Diagnostic> {
        let array = ArrayId(line.number("a")?);
        let first = self.arrays.get(array.index()).and_then(|array| self.slots.get(array.first.index()));
        match first {
            Some(found) => Ok((array, found.ty)),
            None => Err(line.fault("an array of the image")),
        }
    }
}

fn length<T>(list: &[T]) -> u32 {
    u32::try_from(list.len()).unwrap_or(u32::MAX)
}

/// A line that is read word by word.
struct Line<'a> {
    text: &'a str,
    /// Where it starts in the source, in bytes.
    start: usize,
    /// Where reading it has come to, in bytes.
    at: usize,
}

impl<'a> Line<'a> {
    /// What was expected where reading stands, as a diagnostic.
    fn fault(&self, expected: impl std::fmt::Display) -> Diagnostic {
        let span = Span::new(self.start + self.at, self.start + self.at);
        Diagnostic::new(Code::BadLogic, span, format!("this cannot be read; expected: {expected}"))
    }

    fn rest(&self) -> &'a str {
        let rest = self.text[self.at..].trim_start_matches([' ', '\t']);
        if rest.starts_with(';') { "" } else { rest }
    }

    /// The next word, comma, equals sign or opening quote; `None` at the end or before a comment.
    fn peek(&self) -> Option<&'a str> {
        let rest = self.rest();
        let first = rest.chars().next()?;
        let end = if matches!(first, ',' | '=' | '"') {
            1
        } else {
            rest.find([' ', '\t', ',', '=', '"', ';']).unwrap_or(rest.len())
        };
        Some(&rest[..end])
    }

    fn word(&mut self) -> Result<&'a str, Diagnostic> {
        let word = self.peek().ok_or_else(|| self.fault("more"))?;
        self.at = self.text.len() - self.rest().len() + word.len();
        Ok(word)
    }

    fn keyword(&mut self, expected: &str) -> Result<(), Diagnostic> {
        if self.peek() == Some(expected) { self.word().map(|_| ()) } else { Err(self.fault(expected)) }
    }

    fn end(&self) -> Result<(), Diagnostic> {
        if self.peek().is_none() { Ok(()) } else { Err(self.fault("the end of the line")) }
    }

    /// A word that `of` understands.
    fn parsed<T>(&mut self, expected: &str, of: impl Fn(&str) -> Option<T>) -> Result<T, Diagnostic> {
        let found = self.peek().and_then(of).ok_or_else(|| self.fault(expected))?;
        self.word()?;
        Ok(found)
    }

    /// A number behind a prefix.
    fn number(&mut self, prefix: &str) -> Result<u32, Diagnostic> {
        let expected = if prefix.is_empty() { "a number".to_owned() } else { format!("{prefix} and a number") };
        self.parsed(&expected, |word| word.strip_prefix(prefix)?.parse().ok())
    }

    fn value(&mut self) -> Result<ValueId, Diagnostic> {
        self.number("v").map(ValueId)
    }

    fn range(&mut self) -> Result<Range<u32>, Diagnostic> {
        self.parsed("a range", |word| {
            let (start, end) = word.split_once("..")?;
            Some(start.parse().ok()?..end.parse().ok()?)
        })
    }

    fn ty(&mut self) -> Result<Elementary, Diagnostic> {
        self.parsed("a type", Elementary::from_name)
    }

    fn origin(&mut self) -> Result<(u32, Origin), Diagnostic> {
        let index = self.number("")?;
        self.keyword("line")?;
        let line = self.number("")?;
        Ok((index, Origin { label: self.quoted()?.into(), line }))
    }

    fn literal(&mut self, ty: Elementary) -> Result<Value, Diagnostic> {
        self.parsed(&format!("a value of type {ty}"), |word| literal(ty, word))
    }

    fn quoted(&mut self) -> Result<String, Diagnostic> {
        self.keyword("\"")?;
        let mut text = String::new();
        let mut characters = self.text[self.at..].char_indices();
        while let Some((at, character)) = characters.next() {
            text.push(match character {
                '"' => {
                    self.at += at + 1;
                    return Ok(text);
                }
                '\\' => match characters.next() {
                    Some((_, character @ ('"' | '\\'))) => character,
                    Some((_, 'u')) => {
                        let code: String =
                            characters.by_ref().map(|(_, character)| character).take_while(|it| *it != '}').collect();
                        let code = code.strip_prefix('{').and_then(|code| u32::from_str_radix(code, 16).ok());
                        code.and_then(char::from_u32).ok_or_else(|| self.fault("a character"))?
                    }
                    _ => return Err(self.fault("an escaped character")),
                },
                _ => character,
            });
        }
        Err(self.fault("the closing quote"))
    }
}

/// A value as [`print`](super::print) writes it.
fn literal(ty: Elementary, word: &str) -> Option<Value> {
    if let Some(digits) = word.strip_prefix("16#") {
        let bits = u64::from_str_radix(digits, 16).ok()?;
        let value = Value::from_bits(ty, bits);
        return (value.bits() == bits).then_some(value);
    }
    match ty {
        Elementary::Bool => match word {
            "FALSE" => Some(Value::bool(false)),
            "TRUE" => Some(Value::bool(true)),
            _ => None,
        },
        Elementary::Time => {
            let text = word.strip_prefix("T#")?;
            let (number, unit) = text.split_at(text.find(|it: char| it.is_ascii_alphabetic())?);
            let (_, size) = UNITS.iter().find(|(name, _)| *name == unit)?;
            Value::integer(ty, i128::from(number.parse::<i64>().ok()?) * size)
        }
        // By way of LREAL a REAL would be rounded twice.
        Elementary::Real => Some(Value::from_bits(ty, u64::from(word.parse::<f32>().ok()?.to_bits()))),
        Elementary::Lreal => Value::real(ty, word.parse().ok()?),
        _ => Value::integer(ty, word.parse().ok()?),
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::logic::{Area, Builder, image::LayoutBuilder, print, random};

    fn read(text: &str) -> Result<Program, Vec<Diagnostic>> {
        parse(&Source::new("logic", text))
    }

    #[test]
    fn a_printed_program_reads_back_the_same() {
        for seed in 0..300 {
            let program = random::program(seed);
            let text = print(&program);
            assert_eq!(read(&text).as_ref(), Ok(&program), "{text}");
        }
    }

    fn small() -> Program {
        let mut layout = LayoutBuilder::new();
        let names = [("start \"x\"\n\\", Elementary::Bool, Area::Input), ("lamp", Elementary::Bool, Area::Output)];
        let slots = names.map(|(name, ty, area)| {
            let initial = Value::default_of(ty);
            layout.slot(Slot { name: name.into(), ty, offset: 0, area, retain: area == Area::Output, initial, line: 3 })
        });
        layout.observe("lamp", slots[1]);
        let mut builder = Builder::new("größe; \u{7f}", layout.finish(None).unwrap());
        let a = builder.load(slots[0]);
        let limit = builder.constant(Value::time(-1_500_000_000));
        let now = builder.now();
        let late = builder.compare(Compare::Greater, now, limit);
        let both = builder.and(a, late);
        builder.store(slots[1], both);
        builder.end_section(Origin { label: "r10".into(), line: 12 });
        builder.end_section(Origin { label: "r20".into(), line: 15 });
        builder.finish()
    }

    #[test]
    fn the_text_is_this() {
        let expected = r#"program "größe; \u{7f}"
image 8
  s0 BOOL at 0 input line 3 = FALSE "start \"x\"\u{a}\\"
  s1 BOOL at 1 output retain line 3 = FALSE "lamp"
  inputs 0..1 bools 0..1
  outputs 1..2
  retained 1..2
  observe s1 "lamp"
chunk
section 0 line 12 "r10"
  v0 = load s0 ; start \"x\"\u{a}\\
  v1 = const TIME T#-1500ms
  v2 = now
  v3 = gt TIME v2, v1
  v4 = and BOOL v0, v3
  store s1, v4 ; lamp
section 1 line 15 "r20"
"#;
        assert_eq!(print(&small()), expected);
        assert_eq!(read(expected), Ok(small()));
        assert_eq!(read(&expected.replace('\n', "\r\n")), Ok(small()));
    }

    #[test]
    fn tasks_stand_before_their_sections_also_those_without_any() {
        let mut layout = LayoutBuilder::new();
        let (ty, initial) = (Elementary::Time, Value::time(0));
        let name = "#task fast".to_owned();
        let due =
            layout.slot(Slot { name: name.into(), ty, offset: 0, area: Area::State, retain: false, initial, line: 0 });
        let mut builder = Builder::new("p", layout.finish(None).unwrap());
        builder.end_task("none", None, None);
        builder.end_section(Origin { label: "r1".into(), line: 1 });
        builder.end_task("fast", Some(10_000_000), Some(due));
        builder.end_section(Origin { label: "r2".into(), line: 2 });
        builder.end_task("", None, None);
        builder.end_task("last", None, None);
        let program = builder.finish();
        let text = print(&program);
        let from = text.find("\ntask").unwrap() + 1;
        let expected = r#"task "none"
task "fast" every T#10ms due s0
chunk
section 0 line 1 "r1"
task ""
chunk
section 1 line 2 "r2"
task "last"
"#;
        assert_eq!(&text[from..], expected);
        assert_eq!(read(&text), Ok(program));
    }

    #[test]
    fn origins_that_no_section_has_or_several_share_are_kept() {
        let mut program = small();
        program.origins.push(Origin { label: "gone".into(), line: 0 });
        program.sections[1].origin = 0;
        assert_eq!(read(&print(&program)), Ok(program));
    }

    #[test]
    fn constants_are_exact() {
        for ty in Elementary::ALL {
            for bits in [
                0,
                1,
                1 << 63,
                0x7FC0_0000,
                0x7F80_0001,
                0xFF80_0000,
                0x7FF0_0000_0000_0001,
                0x3FB9_9999_9999_999A,
                u64::MAX,
                u64::MAX >> 1,
                0x3DCC_CCCD,
                1_000_000_000,
            ] {
                let mut builder = Builder::new("c", LayoutBuilder::new().finish(None).unwrap());
                builder.constant(Value::from_bits(ty, bits));
                builder.end_section(Origin { label: "".into(), line: 0 });
                let program = builder.finish();
                assert_eq!(read(&print(&program)).as_ref(), Ok(&program), "{}", print(&program));
            }
        }
    }

    #[test]
    fn faults_are_coded_and_stand_where_they_are() {
        let good = print(&small());
        let cases = [
            ("gt TIME v2", "gt INT v2", "this cannot be read; expected: v2 to be of type INT"),
            ("v3 =", "v4 =", "this cannot be read; expected: the next value is v3"),
            ("and BOOL", "nand BOOL", "this cannot be read; expected: the name of an operation"),
            ("T#-1500ms", "T#-1500000000000d", "this cannot be read; expected: a value of type TIME"),
            ("store s1", "store s9", "this cannot be read; expected: a slot of the image"),
            ("v0, v3", "v0, v9", "v4: v9 is used before it is defined"),
            ("s1 BOOL at 1", "s1 BOOL at 0", "`lamp` at 0 is not an input, unlike the run that it lies in"),
            ("store s1, v4", "store_indexed a0, v1, v4", "this cannot be read; expected: an array of the image"),
            ("  inputs", "  array a1 s0 count 2\n  inputs", "this cannot be read; expected: the next array is a0"),
            ("  inputs", "  array a0 s1 count 2\n  inputs", "a0 is no array: its elements are not side by side"),
            ("section 1", "section 2", "the origin 2 is missing or there twice"),
            ("image 8", "image 99999999999", "this cannot be read; expected: a number"),
            ("program", "programm", "this cannot be read; expected: v and a number"),
        ];
        for (from, to, expected) in cases {
            let text = good.replacen(from, to, 1);
            let faults = read(&text).unwrap_err();
            assert!(faults.iter().any(|fault| fault.message == expected), "{faults:?} lacks {expected}");
            assert!(faults.iter().all(|fault| fault.code == Code::BadLogic));
        }
    }

    proptest! {
        #[test]
        fn any_text_gives_a_verified_program_or_diagnostics(bytes in proptest::collection::vec(any::<u8>(), 0..300)) {
            let text = String::from_utf8_lossy(&bytes);
            prop_assert!(read(&text).is_err());
        }

        #[test]
        fn a_damaged_text_gives_a_verified_program_or_diagnostics(
            seed in 0u64..20, at in any::<prop::sample::Index>(), cut in 0usize..30, paste in "[ -~]{0,6}"
        ) {
            let mut text = print(&random::program(seed));
            let at = at.index(text.len());
            let end = (at + cut).min(text.len());
            text.replace_range(at..end, &paste);
            match read(&text) {
                Ok(program) => prop_assert_eq!(verify(&program), Ok(())),
                Err(faults) => prop_assert!(!faults.is_empty()),
            }
        }
    }
}
