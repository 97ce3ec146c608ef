//! The one canonical form of the native text.
//!
//! Any program can be printed, from whatever it was read. Comments go back beside what they stood beside, by their
//! spans; a program without comments may have no true spans at all.

mod declarations;
mod rungs;
mod words;

use crate::ladder::{Comment, Program};
use unicode_width::UnicodeWidthStr;

/// Columns that a line should not go beyond.
const LINE_WIDTH: usize = 100;

/// Prints a program as native text. A name with a back quote or a line break in it, which no native text can
/// spell, is printed with a quote or a blank there.
pub fn print(program: &Program) -> String {
    let mut page = Page { comments: &program.comments, ..Page::default() };
    page.flush(program.name.span.start, 0);
    page.line(0);
    page.push("program ");
    page.push(&words::name(&program.name.text));
    let unit = &program.units[0];
    let first_rung = unit.rungs.first().map_or(u32::MAX, |rung| rung.span.start);
    let first = unit.variables.first().map_or(first_rung, |variable| variable.name.span.start);
    page.flush_trailing(first);
    declarations::print(&mut page, &unit.variables, first_rung);
    let next_starts = unit.rungs.iter().skip(1).map(|rung| rung.span.start).chain([u32::MAX]);
    for (rung, next) in unit.rungs.iter().zip(next_starts) {
        page.blank_line();
        rungs::print(&mut page, rung);
        page.flush_trailing(next);
    }
    if !page.comments.is_empty() {
        page.blank_line();
        page.flush_all();
    }
    page.line(0);
    page.text
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
