//! The lines of a source that one report shows: of a long line only what stands near the marked places, of a long span
//! only its first and last lines. It must never hold more than a few kilobytes, however large the source is, and no
//! character that a terminal would obey.

use std::collections::BTreeSet;
use std::ops::Range;

use codespan_reporting::files::{Error as FilesError, Files};

use crate::source::{Source, Span};

/// Lines that a report shows of a span's start, behind the first, and of its end, before the last.
pub(super) const CONTEXT: (usize, usize) = (3, 1);

/// The longest line that is shown whole, in bytes.
const LONGEST_LINE: usize = 240;

/// Bytes of a longer line that are shown on either side of a marked place.
const AROUND: usize = 60;

/// Characters of a message that are shown.
const LONGEST_MESSAGE: usize = 400;

/// A text as it may be printed: no longer than some lines, and on one.
pub(super) fn tidy(text: &str) -> String {
    let mut shown: String = text.chars().take(LONGEST_MESSAGE).map(harmless).collect();
    if text.chars().nth(LONGEST_MESSAGE).is_some() {
        shown.push('…');
    }
    shown
}

/// The character, or the sign for one that a terminal would obey instead of showing it.
fn harmless(character: char) -> char {
    let obeyed = character.is_control() || matches!(character, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    if obeyed && character != '\t' { char::REPLACEMENT_CHARACTER } else { character }
}

/// What a report shows of a source.
pub(super) struct Excerpt<'a> {
    source: &'a Source,
    text: String,
    /// In order; where lines are left out two empty ones stand, which makes the renderer draw a break.
    lines: Vec<Line>,
    /// Places of the source and their places in `text`: what follows is the same in both up to the next mark.
    marks: Vec<(usize, usize)>,
}

struct Line {
    /// Its place among the source's lines, from 0.
    index: usize,
    /// Its place in the excerpt's text.
    range: Range<usize>,
}

impl<'a> Excerpt<'a> {
    /// What is to be seen of the source to see these places in it. They must lie inside the source.
    pub(super) fn new(source: &'a Source, places: &[Range<usize>]) -> Self {
        let line = |byte: usize| source.line(Span::new(byte, byte).start) - 1;
        let mut shown = BTreeSet::new();
        for place in places {
            let (first, last) = (line(place.start), line(place.end));
            shown.extend(first..=last.min(first + CONTEXT.0));
            shown.extend(first.max(last.saturating_sub(CONTEXT.1))..=last);
        }
        let mut excerpt = Self { source, text: String::new(), lines: Vec::new(), marks: Vec::new() };
        let points: BTreeSet<usize> = places.iter().flat_map(|place| [place.start, place.end]).collect();
        for index in shown {
            match excerpt.lines.last().map_or(0, |last| index - last.index - 1) {
                0 => {}
                // A break would take the line that this one takes.
                1 => excerpt.push(index - 1, &points),
                _ => {
                    let end = excerpt.text.len();
                    excerpt.lines.extend([index - 2, index - 1].map(|index| Line { index, range: end..end }));
                }
            }
            excerpt.push(index, &points);
        }
        excerpt
    }

    fn push(&mut self, index: usize, points: &BTreeSet<usize>) {
        let Some(whole) = self.source.line_range(index) else { return };
        let start = self.text.len();
        let line = &self.source.text()[whole.clone()];
        let content = whole.start..whole.start + line.trim_end_matches(['\n', '\r']).len();
        let mut at = content.start;
        for kept in self.kept(&content, points) {
            if kept.start > at {
                self.text.push('…');
            }
            self.copy(kept.clone());
            at = kept.end;
        }
        if at < content.end {
            self.text.push('…');
        }
        self.marks.push((content.end, self.text.len()));
        self.text.push_str(&self.source.text()[content.end..whole.end]);
        self.lines.push(Line { index, range: start..self.text.len() });
    }

    /// The parts of a line that are shown, in order, each apart from the next.
    fn kept(&self, line: &Range<usize>, points: &BTreeSet<usize>) -> Vec<Range<usize>> {
        if line.len() <= LONGEST_LINE {
            return vec![line.clone()];
        }
        let text = self.source.text();
        let mut parts: Vec<Range<usize>> = Vec::new();
        let mut marked = points.range(line.start..=line.end).copied().peekable();
        let unmarked = marked.peek().is_none().then_some(line.start);
        for point in marked.chain(unmarked) {
            let mut start = point.saturating_sub(AROUND).max(line.start);
            let mut end = (point + AROUND).min(line.end);
            while !text.is_char_boundary(start) {
                start -= 1;
            }
            while !text.is_char_boundary(end) {
                end += 1;
            }
            match parts.last_mut() {
                // One that would leave out no more than its sign takes is not worth its sign.
                Some(last) if start <= last.end + 4 => last.end = end,
                _ => parts.push(start..end),
            }
        }
        parts
    }

    fn copy(&mut self, part: Range<usize>) {
        self.marks.push((part.start, self.text.len()));
        for (at, character) in self.source.text()[part.clone()].char_indices() {
            let shown = harmless(character);
            self.text.push(shown);
            if shown != character {
                self.marks.push((part.start + at + character.len_utf8(), self.text.len()));
            }
        }
    }

    /// Where a place of the source is in the excerpt.
    pub(super) fn place(&self, place: &Range<usize>) -> Range<usize> {
        let within = |byte: usize| {
            let next = self.marks.partition_point(|(source, _)| *source <= byte);
            let (source, excerpt) = next.checked_sub(1).map_or((byte, 0), |mark| self.marks[mark]);
            (excerpt + byte - source).min(self.text.len())
        };
        within(place.start)..within(place.end)
    }

    /// Where a place of the excerpt is in the source.
    fn source_byte(&self, byte: usize) -> usize {
        let next = self.marks.partition_point(|(_, excerpt)| *excerpt <= byte);
        let (source, excerpt) = next.checked_sub(1).map_or((0, byte), |mark| self.marks[mark]);
        source + byte - excerpt
    }
}

impl<'a> Files<'a> for Excerpt<'_> {
    /// The place of the file among those of the source.
    type FileId = usize;
    type Name = &'a str;
    type Source = &'a str;

    fn name(&'a self, id: usize) -> Result<&'a str, FilesError> {
        Ok(self.source.file(id).0)
    }

    fn source(&'a self, _id: usize) -> Result<&'a str, FilesError> {
        Ok(&self.text)
    }

    fn line_index(&'a self, _id: usize, byte: usize) -> Result<usize, FilesError> {
        // Of the lines that start at one place all but the last are empty ones of a break.
        Ok(self.lines.partition_point(|line| line.range.start <= byte).saturating_sub(1))
    }

    fn line_number(&'a self, id: usize, line: usize) -> Result<usize, FilesError> {
        Ok((self.line(line)?.index + 1).saturating_sub(self.source.file(id).1))
    }

    fn column_number(&'a self, _id: usize, line: usize, byte: usize) -> Result<usize, FilesError> {
        let start = self.source.line_range(self.line(line)?.index).map_or(0, |whole| whole.start);
        let before = self.source.text().get(start..self.source_byte(byte)).unwrap_or("");
        Ok(before.chars().count() + 1)
    }

    fn line_range(&'a self, _id: usize, line: usize) -> Result<Range<usize>, FilesError> {
        Ok(self.line(line)?.range.clone())
    }
}

impl Excerpt<'_> {
    fn line(&self, line: usize) -> Result<&Line, FilesError> {
        self.lines.get(line).ok_or(FilesError::LineTooLarge { given: line, max: self.lines.len() })
    }
}
