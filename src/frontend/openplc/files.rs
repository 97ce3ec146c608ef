//! Which part of a file is text and which is JSON. What is text is read as structured text, with blanks where JSON stands, so
//! that every place is one of the file.

use std::ops::Range;

use super::json::Document;
use crate::diagnostic::{Code, Diagnostic};
use crate::frontend::graph::report::Report;
use crate::source::{Source, Span};

/// Endings of files of a project whose bodies are in languages that Rung does not read.
const OTHERS: [(&str, &str); 3] = [(".py", "Python"), (".cpp", "C++"), (".il", "instruction list")];

/// The files, taken apart.
pub(super) struct Files<'s> {
    /// The text, with blanks for all else; every line break stands where it stood.
    pub(super) masked: String,
    /// Files that are JSON alone: `project.json`, or a POU of an early project.
    pub(super) documents: Vec<Document<'s>>,
    /// The JSON in units.
    pub(super) bodies: Vec<Body<'s>>,
}

/// A body in JSON.
pub(super) struct Body<'s> {
    /// The bytes of the file that it is in.
    pub(super) file: Range<usize>,
    pub(super) start: usize,
    pub(super) document: Document<'s>,
}

/// Where a JSON object starts, in a text that is nothing else.
pub(super) fn is_json(text: &str) -> bool {
    let rest = text.trim_start().strip_prefix('{').map(str::trim_start);
    rest.is_some_and(|rest| rest.starts_with('"') || rest.starts_with('}'))
}

/// Where the JSON of a unit starts: at a line that begins with a brace, with a name in quotes behind it.
pub(super) fn body(text: &str) -> Option<usize> {
    let mut from = 0;
    while let Some(found) = text[from..].find("\n{") {
        let at = from + found + 1;
        if is_json(&text[at..]) {
            return Some(at);
        }
        from = at;
    }
    None
}

/// Takes the files of a source apart.
pub(super) fn split<'s>(source: &'s Source, report: &mut Report) -> Files<'s> {
    let text = source.text();
    let mut masked = text.as_bytes().to_vec();
    let mut blank = |range: Range<usize>| {
        if let Some(part) = masked.get_mut(range) {
            part.iter_mut().filter(|byte| **byte != b'\n').for_each(|byte| *byte = b' ');
        }
    };
    let (mut documents, mut bodies) = (Vec::new(), Vec::new());
    for (name, file) in source.files() {
        let content = text.get(file.clone()).unwrap_or("");
        if let Some((_, language)) = OTHERS.iter().find(|(ending, _)| name.ends_with(ending)) {
            let place = Span::new(file.start, file.start + content.lines().next().map_or(0, str::len));
            let message = format!("{language}, which `{name}` is written in, is not supported");
            report.push(Diagnostic::new(Code::NotSupported, place, message).hint("write it in structured text"));
            blank(file);
            continue;
        }
        let whole = is_json(content);
        let start = if whole { Some(content.len() - content.trim_start().len()) } else { body(content) };
        let Some(start) = start.map(|start| file.start + start) else { continue };
        match Document::read(text.get(..file.end).unwrap_or(text), start) {
            Err(problem) => {
                report.push(problem);
                // The end of the unit, where it is there, still says that it is one.
                let end = content.rfind("\nEND_").map_or(file.end, |end| file.start + end);
                blank(if whole || end < start { file } else { start..end });
            }
            Ok(document) if whole => {
                let rest = text.get(document.end..file.end).unwrap_or("");
                if let Some(more) = rest.find(|c: char| !c.is_whitespace()) {
                    let at = document.end + more;
                    report.error(Code::BadJson, Span::new(at, at + 1), "nothing should stand behind the JSON");
                }
                blank(file);
                documents.push(document);
            }
            Ok(document) => {
                blank(start..document.end);
                bodies.push(Body { file, start, document });
            }
        }
    }
    // Blanks stand for whole values, so that no character is cut.
    Files { masked: String::from_utf8(masked).unwrap_or_default(), documents, bodies }
}
