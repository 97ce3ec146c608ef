//! JSON as a compact tree with the place of every value.
//!
//! It must stay within bounded memory and time whatever the text: nesting and values are limited, and of what no reader of
//! drawings looks at (handles, styles, sizes) nothing is kept.

use std::borrow::Cow;

use crate::diagnostic::{Code, Diagnostic};
use crate::source::Span;

/// How deep values may nest; a project needs about 15.
const MOST_DEPTH: usize = 100;
/// How many values are kept: some hundred thousand elements.
const MOST_VALUES: usize = 1 << 22;

/// Members of objects that only say how something looks.
const LOOKS: [&str; 7] =
    ["handles", "inputHandles", "outputHandles", "measured", "style", "documentation", "defaultBounds"];

/// A text read as JSON.
#[derive(Debug)]
pub(super) struct Document<'a> {
    text: &'a str,
    values: Vec<Stored>,
    /// Where the text goes on behind it.
    pub(super) end: usize,
}

#[derive(Clone, Copy, Debug)]
struct Stored {
    kind: Kind,
    /// The name of a member, with its quotes; empty in a list.
    name: Span,
    span: Span,
    /// One past its last descendant: where the next value of the same list stands.
    next: u32,
}

/// What a value is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Kind {
    Object,
    Array,
    Text,
    Number,
    True,
    False,
    Null,
}

/// A value of a document.
#[derive(Clone, Copy, Debug)]
pub(super) struct Value<'d> {
    document: &'d Document<'d>,
    at: usize,
}

impl<'a> Document<'a> {
    /// Reads the value that starts at a byte of the text.
    ///
    /// # Errors
    /// What is wrong with the first place that is no JSON, or that there is too much of it.
    pub(super) fn read(text: &'a str, start: usize) -> Result<Self, Diagnostic> {
        let mut reader = Reader { text, at: start, values: Vec::new() };
        reader.read()?;
        Ok(Self { text, values: reader.values, end: reader.at })
    }

    /// The outermost value.
    pub(super) fn root(&self) -> Value<'_> {
        Value { document: self, at: 0 }
    }
}

impl<'d> Value<'d> {
    fn stored(self) -> Stored {
        self.document.values[self.at]
    }

    pub(super) fn kind(self) -> Kind {
        self.stored().kind
    }

    /// Where it stands; of an object or list only its first line.
    pub(super) fn span(self) -> Span {
        let span = self.stored().span;
        let text = self.document.text.get(span.range()).unwrap_or("");
        let line = text.find('\n').unwrap_or(text.len());
        Span::new(span.range().start, span.range().start + line)
    }

    /// All bytes of it.
    pub(super) fn whole(self) -> Span {
        self.stored().span
    }

    /// The values of a list, or of the members of an object.
    pub(super) fn items(self) -> impl Iterator<Item = Value<'d>> {
        let document = self.document;
        let end = match self.kind() {
            Kind::Object | Kind::Array => self.stored().next as usize,
            _ => self.at,
        };
        let mut at = self.at + 1;
        std::iter::from_fn(move || {
            let item = (at < end).then_some(Value { document, at })?;
            at = item.stored().next as usize;
            Some(item)
        })
    }

    /// The member of an object that has a name; the last of several, as JavaScript has it.
    pub(super) fn member(self, name: &str) -> Option<Value<'d>> {
        if self.kind() != Kind::Object {
            return None;
        }
        let named = |item: &Value<'d>| {
            let written = item.document.text.get(item.stored().name.range()).unwrap_or("");
            unquote(written) == name
        };
        self.items().filter(named).last()
    }

    /// A member of a member and so on.
    pub(super) fn at(self, path: &[&str]) -> Option<Value<'d>> {
        path.iter().try_fold(self, |value, name| value.member(name))
    }

    /// What a text says.
    pub(super) fn text(self) -> Option<Cow<'d, str>> {
        (self.kind() == Kind::Text).then(|| unquote(self.written()))
    }

    /// What the text says that a member holds; `None` for none or an empty one.
    pub(super) fn text_of(self, name: &str) -> Option<Cow<'d, str>> {
        let text = self.member(name)?.text()?;
        (!text.trim().is_empty()).then_some(text)
    }

    /// A number, or a text that is one, without its fraction.
    pub(super) fn number(self) -> Option<i64> {
        let text = match self.kind() {
            Kind::Number => Cow::Borrowed(self.written()),
            _ => self.text()?,
        };
        text.trim().split('.').next()?.parse().ok()
    }

    pub(super) fn is_true(self) -> bool {
        self.kind() == Kind::True
    }

    /// As it stands in the text.
    fn written(self) -> &'d str {
        self.document.text.get(self.stored().span.range()).unwrap_or("")
    }
}

/// What a text in quotes says.
fn unquote(written: &str) -> Cow<'_, str> {
    let inner = written.get(1..written.len().saturating_sub(1)).unwrap_or("");
    if inner.contains('\\') {
        // It was read before, so that only halves of surrogate pairs are left to fail.
        serde_json::from_str::<String>(written).map_or(Cow::Borrowed(inner), Cow::Owned)
    } else {
        Cow::Borrowed(inner)
    }
}

struct Reader<'a> {
    text: &'a str,
    at: usize,
    values: Vec<Stored>,
}

/// A list or object that is being read.
struct Open {
    value: usize,
    object: bool,
    /// Whether what is in it is kept.
    kept: bool,
    first: bool,
}

impl Reader<'_> {
    fn peek(&self) -> Option<u8> {
        self.text.as_bytes().get(self.at).copied()
    }

    fn blanks(&mut self) {
        while let Some(b' ' | b'\t' | b'\n' | b'\r') = self.peek() {
            self.at += 1;
        }
    }

    fn wrong(&self, expected: &str) -> Diagnostic {
        let rest = self.text.get(self.at..).unwrap_or("");
        let Some(found) = rest.chars().next() else {
            let end = Span::new(self.text.len(), self.text.len());
            return Diagnostic::new(Code::BadJson, end, format!("the file ends where {expected} should stand"))
                .hint("the file was cut off; take it from where it was saved");
        };
        let span = Span::new(self.at, self.at + found.len_utf8());
        Diagnostic::new(Code::BadJson, span, format!("this is no JSON: {expected} should stand here"))
    }

    fn limit(&self, message: &str) -> Diagnostic {
        Diagnostic::new(Code::BadJson, Span::new(self.at, self.at), message)
    }

    /// Reads one value. Open lists are in a list of their own, for they may nest.
    fn read(&mut self) -> Result<(), Diagnostic> {
        let mut open: Vec<Open> = Vec::new();
        loop {
            // A value, with its name in an object.
            let kept = open.last().is_none_or(|list| list.kept);
            let mut name = Span::default();
            let mut looks = false;
            self.blanks();
            if open.last().is_some_and(|list| list.object) {
                name = self.quoted()?;
                looks = LOOKS.contains(&self.text[name.range()].trim_matches('"'));
                self.blanks();
                self.take(b':', "a colon")?;
                self.blanks();
            }
            let start = self.at;
            let kind = self.kind()?;
            let kept = kept && !looks;
            let value = self.values.len();
            if kept {
                if value >= MOST_VALUES {
                    return Err(self.limit("this JSON has too many values"));
                }
                let span = Span::new(start, self.at);
                self.values.push(Stored { kind, name, span, next: u32::try_from(value + 1).unwrap_or(u32::MAX) });
            }
            if matches!(kind, Kind::Object | Kind::Array) {
                if open.len() >= MOST_DEPTH {
                    return Err(self.limit("this JSON nests too deeply"));
                }
                open.push(Open { value, object: kind == Kind::Object, kept, first: true });
            }
            // What stands behind it: the next value, or ends of lists.
            loop {
                let Some(list) = open.last_mut() else { return Ok(()) };
                let (object, first) = (list.object, std::mem::replace(&mut list.first, false));
                let end = if object { b'}' } else { b']' };
                self.blanks();
                if self.peek() == Some(end) {
                    self.at += 1;
                    if let Some(closed) = open.pop().filter(|list| list.kept) {
                        let next = u32::try_from(self.values.len()).unwrap_or(u32::MAX);
                        let stored = &mut self.values[closed.value];
                        stored.next = next;
                        stored.span = Span::new(stored.span.range().start, self.at);
                    }
                    continue;
                }
                if !first {
                    self.take(b',', if object { "a comma or `}`" } else { "a comma or `]`" })?;
                }
                break;
            }
        }
    }

    fn take(&mut self, sign: u8, expected: &str) -> Result<(), Diagnostic> {
        if self.peek() != Some(sign) {
            return Err(self.wrong(expected));
        }
        self.at += 1;
        Ok(())
    }

    /// What a value is, and past it; past the first sign of a list or object.
    fn kind(&mut self) -> Result<Kind, Diagnostic> {
        let words = [("true", Kind::True), ("false", Kind::False), ("null", Kind::Null)];
        match self.peek() {
            Some(b'{') => {
                self.at += 1;
                Ok(Kind::Object)
            }
            Some(b'[') => {
                self.at += 1;
                Ok(Kind::Array)
            }
            Some(b'"') => self.quoted().map(|_| Kind::Text),
            Some(b'-' | b'0'..=b'9') => {
                while let Some(b'-' | b'+' | b'.' | b'e' | b'E' | b'0'..=b'9') = self.peek() {
                    self.at += 1;
                }
                Ok(Kind::Number)
            }
            _ => {
                let rest = &self.text[self.at..];
                let Some((word, kind)) = words.into_iter().find(|(word, _)| rest.starts_with(word)) else {
                    return Err(self.wrong("a value"));
                };
                self.at += word.len();
                Ok(kind)
            }
        }
    }

    /// A text in quotes, with them.
    fn quoted(&mut self) -> Result<Span, Diagnostic> {
        let start = self.at;
        self.take(b'"', "a name in quotes")?;
        loop {
            match self.peek() {
                Some(b'"') => {
                    self.at += 1;
                    return Ok(Span::new(start, self.at));
                }
                Some(b'\\') => self.at += 2,
                Some(b'\n') | None => {
                    let problem =
                        Diagnostic::new(Code::BadJson, Span::new(start, start + 1), "this quote is not closed");
                    return Err(problem);
                }
                Some(_) => self.at += 1,
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(text: &str) -> (u32, String) {
        let problem = Document::read(text, 0).expect_err("it is no JSON");
        (problem.span.start, problem.message)
    }

    #[test]
    fn members_and_items_are_found_with_their_places() {
        let text = r#"xx{"a": [1, {"b": "c\"d\u0041"}, []], "handles": [1, [2]], "a2": true, "n": -25.75} rest"#;
        let document = Document::read(text, 2).expect("it is JSON");
        let root = document.root();
        let list = root.member("a").expect("it is there");
        assert_eq!(list.items().map(Value::kind).collect::<Vec<_>>(), [Kind::Number, Kind::Object, Kind::Array]);
        let inner = list.items().nth(1).and_then(|item| item.text_of("b"));
        assert_eq!(inner.as_deref(), Some("c\"dA"));
        assert_eq!(root.member("a2").map(Value::is_true), Some(true));
        assert_eq!(root.member("n").and_then(Value::number), Some(-25));
        assert!(root.member("handles").is_none(), "what only shows is left out");
        assert_eq!(&text[document.end..], " rest");
        assert_eq!(&text[list.span().range()], r#"[1, {"b": "c\"d\u0041"}, []]"#);
    }

    #[test]
    fn what_is_no_json_is_said_with_its_place() {
        assert_eq!(message("{\"a\": 1,, }"), (8, "this is no JSON: a name in quotes should stand here".to_owned()));
        assert_eq!(message("{\"a\": [1, 2"), (11, "the file ends where a comma or `]` should stand".to_owned()));
        assert_eq!(message("{\"a\": \"b\n\"}"), (6, "this quote is not closed".to_owned()));
        assert_eq!(message("{\"a\": \"b\\"), (6, "this quote is not closed".to_owned()));
        assert_eq!(message("[nul]"), (1, "this is no JSON: a value should stand here".to_owned()));
    }

    #[test]
    fn nesting_is_bounded() {
        assert!(message(&"[".repeat(1_000_000)).1.contains("nests too deeply"));
    }
}
