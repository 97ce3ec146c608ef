//! The one canonical form of the native text.
//!
//! Any program can be printed, from whatever it was read. Comments go back beside what they stood beside, by their
//! spans; a program without comments may have no true spans at all.

mod declarations;
mod rungs;
mod statements;
mod types;
pub(in crate::frontend) mod words;

use crate::ladder::{Comment, Origin, Program, Unit, UnitKind};
use crate::source::Span;
use unicode_width::UnicodeWidthStr;

/// Columns that a line should not go beyond.
const LINE_WIDTH: usize = 100;

/// Prints a program as native text. A name with a back quote or a line break in it, which no native text can
/// spell, is printed with a quote or a blank there.
pub fn print(program: &Program) -> String {
    let mut page = Page { comments: &program.comments, ..Page::default() };
    if program.origin == Origin::Imported {
        page.line(0);
        page.push("imported");
    }
    types::print(&mut page, &program.types);
    if let Some(registers) = &program.registers {
        page.item(registers.span.start, true);
        page.push(&format!("registers({})", words::settings(&registers.settings)));
    }
    let first_instance = program.instances.first().map_or(u32::MAX, |instance| instance.name.span.start);
    let first_unit = program.units.first().map_or(first_instance, start);
    let first_task = program.tasks.first().map_or(first_unit, |task| task.name.span.start);
    declarations::print(&mut page, &program.globals, Some("global "), first_task);
    for (index, task) in program.tasks.iter().enumerate() {
        page.item(task.name.span.start, index == 0);
        page.push(&words::task(task));
    }
    let next_starts = program.units.iter().skip(1).map(start).chain([first_instance]);
    for (unit, next) in program.units.iter().zip(next_starts) {
        print_unit(&mut page, unit, next);
    }
    for (index, instance) in program.instances.iter().enumerate() {
        page.item(instance.name.span.start, index == 0);
        let head = format!("program {} : {}", words::name(&instance.name.text), words::name(&instance.program.text));
        page.push(&head);
        page.push(&words::with_task(instance.task.as_ref()));
    }
    page.flush_trailing(u32::MAX);
    if !page.comments.is_empty() {
        page.blank_line();
        page.flush_all();
    }
    page.line(0);
    page.text
}

/// Where a unit starts: one without a header with what is first in it.
fn start(unit: &Unit) -> u32 {
    if unit.name.span != Span::default() {
        return unit.name.span.start;
    }
    let first_rung = unit.rungs.first().map_or(0, |rung| rung.span.start);
    unit.variables.first().map_or(first_rung, |variable| variable.name.span.start)
}

/// Prints a unit; `next` is where the next one starts.
fn print_unit(page: &mut Page<'_>, unit: &Unit, next: u32) {
    page.item(unit.name.span.start, true);
    let name = words::name(&unit.name.text);
    page.push(&match &unit.kind {
        UnitKind::Program { task } => format!("program {name}{}", words::with_task(task.as_ref())),
        UnitKind::FunctionBlock => format!("function_block {name}"),
        UnitKind::Function { result: None } => format!("function {name}"),
        UnitKind::Function { result: Some(ty) } => format!("function {name} : {}", words::type_reference(ty)),
    });
    let first_rung = unit.rungs.first().map_or(next, |rung| rung.span.start);
    declarations::print(page, &unit.variables, None, first_rung);
    for rung in &unit.rungs {
        page.flush_trailing(rung.span.start);
        page.blank_line();
        rungs::print(page, rung);
    }
}

/// The text so far, and the comments that are still to be put into it.
#[derive(Default)]
struct Page<'a> {
    text: String,
    /// Columns of the current line.
    width: usize,
    /// The current line has nothing but blanks.
    blank: bool,
    /// The next word stands here, however long it is: at the start of a line or of a branch.
    at_start: bool,
    /// The next word stands on a new line.
    ended: bool,
    /// A comment ended the line, so that no other has room on it.
    commented: bool,
    comments: &'a [Comment],
}

impl<'a> Page<'a> {
    /// Starts a new line.
    fn line(&mut self, indent: usize) {
        if !self.text.is_empty() {
            self.text.truncate(self.text.trim_end_matches(' ').len());
            self.text.push('\n');
        }
        self.text.extend(std::iter::repeat_n(' ', indent));
        self.width = indent;
        self.blank = true;
        self.at_start = true;
        self.ended = false;
        self.commented = false;
    }

    /// Leaves a line free before the next.
    fn blank_line(&mut self) {
        self.line(0);
        self.ended = true;
    }

    /// Starts the line of a declaration with the comments before it, and with an empty line before those.
    fn item(&mut self, place: u32, apart: bool) {
        self.flush_trailing(place);
        if apart || self.has_comment_before(place) {
            self.blank_line();
        }
        self.flush(place, 0);
        self.line(0);
    }

    /// Puts text at the end of the line, whatever its width.
    fn push(&mut self, text: &str) {
        self.text.push_str(text);
        self.width += text.width();
        self.blank = false;
        self.at_start = false;
    }

    /// Puts what opens a line of a circuit; the next word follows it on the line.
    fn gutter(&mut self, sign: &str) {
        self.push(sign);
        self.push(" ");
        self.at_start = true;
    }

    /// Puts a word behind the others: on this line, or if it has no room on the next.
    fn word(&mut self, word: &str, indent: usize) {
        if self.ended || (!self.at_start && self.width + 1 + word.width() > LINE_WIDTH) {
            self.line(indent);
        } else if !self.at_start {
            self.push(" ");
        }
        self.push(word);
    }

    /// Makes sure that what comes stands at the start of a line or branch.
    fn start(&mut self, indent: usize) {
        if self.ended || !self.at_start {
            self.line(indent);
        }
    }

    /// Whether a comment stood before this place that is not printed yet.
    fn has_comment_before(&self, place: u32) -> bool {
        self.comments.first().is_some_and(|comment| comment.span.start < place)
    }

    fn next_comment(&mut self, place: u32) -> Option<&'a Comment> {
        let (first, rest) = self.comments.split_first()?;
        if first.span.start >= place {
            return None;
        }
        self.comments = rest;
        Some(first)
    }

    /// Prints the comments that stood before a place.
    fn flush(&mut self, place: u32, indent: usize) {
        while let Some(comment) = self.next_comment(place) {
            self.comment(comment, indent);
        }
    }

    /// Prints all comments.
    fn flush_all(&mut self) {
        for comment in std::mem::take(&mut self.comments) {
            self.comment(comment, 0);
        }
    }

    /// Prints the comment that stood behind what was printed last, if there is one.
    fn flush_trailing(&mut self, place: u32) {
        if self.comments.first().is_some_and(|comment| !comment.own_line)
            && let Some(comment) = self.next_comment(place)
        {
            self.comment(comment, 0);
        }
    }

    fn comment(&mut self, comment: &Comment, indent: usize) {
        let lines = comment_lines(&comment.text);
        if comment.own_line || self.blank || self.commented || self.text.is_empty() || lines.len() > 1 {
            for line in lines {
                self.line(indent);
                self.push(&line);
            }
        } else {
            self.text.truncate(self.text.trim_end_matches(' ').len());
            self.push("  ");
            self.push(&lines.concat());
        }
        self.ended = true;
        self.commented = true;
    }
}

/// A comment with its marks. One that another front end read may have several lines.
fn comment_lines(text: &str) -> Vec<String> {
    let marked = |line: &str| match line.trim() {
        "" => "--".to_owned(),
        // A ruler stays as long as it was.
        line if line.bytes().all(|byte| byte == b'-') => format!("--{line}"),
        line => format!("-- {line}"),
    };
    text.trim().split('\n').map(marked).collect()
}
