//! XML as a compact tree: names without prefix, attributes, text, and the place of every start tag.
//!
//! It must stay within bounded memory and time whatever the text: nesting, elements and attributes are limited, there
//! are no entities but XML's own five, and a document type is refused. What no reader of PLCopen files looks at
//! (corners of wires, sizes, most of tools' own data) is not kept. What a tool keeps in `<addData>` that the standard has a place
//! for elsewhere (CODESYS keeps whole applications there) stands in the tree as if it were in the element itself.

use std::borrow::Cow;

use quick_xml::escape::resolve_predefined_entity;
use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};

use crate::diagnostic::{Code, Diagnostic};
use crate::source::Span;

/// How deep elements may nest. TC6 itself needs about 20, with structures in structures some more.
const MOST_DEPTH: usize = 200;
/// How many elements are kept: some fifty thousand rungs.
const MOST_ELEMENTS: usize = 1 << 21;
/// How many attributes are kept.
const MOST_ATTRIBUTES: usize = 1 << 22;
/// How many attributes one element may have; TC6 needs ten.
const MOST_OF_ONE: usize = 64;

/// No element, no text.
const NONE: u32 = u32::MAX;

/// The data of tools, by the last part of their names, whose content is read as if it were outside of `<addData>`.
const READ_DATA: &[&str] = &[
    "action",
    "application",
    "datatype",
    "device",
    "fbdelementtype",
    "globalvars",
    "method",
    "mixedattrsvarlist",
    "plclogic",
    "pou",
    "property",
    "resource",
    "stcode",
];

/// The tree.
#[derive(Default)]
pub(super) struct Document<'a> {
    elements: Vec<Data<'a>>,
    attributes: Vec<(&'a str, Cow<'a, str>)>,
    texts: Vec<Text<'a>>,
}

/// An element; there are many, so that it is kept small.
struct Data<'a> {
    /// Empty for a comment.
    name: &'a str,
    span: Span,
    attributes: (u32, u32),
    first_child: u32,
    last_child: u32,
    next: u32,
    /// Its place among the texts.
    text: u32,
}

struct Text<'a> {
    text: Cow<'a, str>,
    span: Span,
    /// Where it stands in the file as it is, without anything escaped.
    verbatim: Option<usize>,
}

/// One element of a tree.
#[derive(Clone, Copy)]
pub(super) struct Node<'d, 'a> {
    document: &'d Document<'a>,
    index: u32,
}

impl<'d, 'a> Node<'d, 'a> {
    fn data(self) -> &'d Data<'a> {
        &self.document.elements[self.index as usize]
    }

    fn at(self, index: u32) -> Option<Self> {
        (index != NONE).then_some(Self { document: self.document, index })
    }

    /// Its name without a prefix.
    pub(super) fn name(self) -> &'a str {
        self.data().name
    }

    /// Its start tag.
    pub(super) fn span(self) -> Span {
        self.data().span
    }

    /// The value of an attribute, where it is there and not blank.
    pub(super) fn attribute(self, name: &str) -> Option<&'d str> {
        let (first, last) = self.data().attributes;
        let attributes = &self.document.attributes[first as usize..last as usize];
        let (_, value) = attributes.iter().find(|(known, _)| *known == name)?;
        Some(value.trim()).filter(|value| !value.is_empty())
    }

    /// Whether an attribute says yes.
    pub(super) fn flag(self, name: &str) -> bool {
        self.attribute(name).is_some_and(|value| ["true", "1", name].iter().any(|yes| value.eq_ignore_ascii_case(yes)))
    }

    /// The elements in it, in order; not the comments.
    pub(super) fn children(self) -> impl Iterator<Item = Self> + use<'d, 'a> {
        self.children_and_comments().filter(|node| !node.name().is_empty())
    }

    /// The elements and comments in it, in order. A comment has an empty name.
    pub(super) fn children_and_comments(self) -> impl Iterator<Item = Self> + use<'d, 'a> {
        std::iter::successors(self.at(self.data().first_child), |node| node.at(node.data().next))
    }

    /// The elements of that name in it, in order.
    pub(super) fn all<'n>(self, name: &'n str) -> impl Iterator<Item = Self> + use<'d, 'a, 'n> {
        self.children().filter(move |node| node.name() == name)
    }

    /// The first element of that name in it.
    pub(super) fn child(self, name: &str) -> Option<Self> {
        self.all(name).next()
    }

    /// Its own text without blanks around it.
    pub(super) fn text(self) -> &'d str {
        self.text_data().map_or("", |data| data.text.trim())
    }

    fn text_data(self) -> Option<&'d Text<'a>> {
        self.document.texts.get(self.data().text as usize)
    }

    /// Where in the file what a span of its [`Node::text`] shows stands; all of the text where parts of it are escaped.
    pub(super) fn place(self, span: Span) -> Span {
        let Some(data) = self.text_data() else { return self.span() };
        let blanks = data.text.len() - data.text.trim_start().len();
        data.verbatim.map_or(data.span, |start| {
            let at = |place: u32| start + blanks + place as usize;
            Span::new(at(span.start), at(span.end))
        })
    }

    /// The text of it and all in it (documentation is XHTML), without blanks around it.
    pub(super) fn whole_text(self) -> String {
        let mut text = self.text().to_owned();
        for child in self.children() {
            let more = child.whole_text();
            if !more.is_empty() {
                if !text.is_empty() {
                    text.push('\n');
                }
                text.push_str(&more);
            }
        }
        text
    }

    /// The innermost element that has text: that of a body in `<ST><xhtml:p>…`.
    pub(super) fn text_node(self) -> Self {
        let inner = self.children().find(|child| !child.whole_text().is_empty());
        match inner {
            Some(child) if self.text().is_empty() => child.text_node(),
            _ => self,
        }
    }
}

impl<'a> Document<'a> {
    /// The outermost element.
    pub(super) fn root(&self) -> Option<Node<'_, 'a>> {
        let index = self.elements.iter().position(|data| !data.name.is_empty())?;
        Some(Node { document: self, index: u32::try_from(index).ok()? })
    }

    /// Reads XML.
    ///
    /// # Errors
    /// At the first place where it is not well formed or beyond a limit.
    pub(super) fn read(text: &'a str) -> Result<Self, Diagnostic> {
        let mut document = Self::default();
        // About as many as drawings have; memory stays a small multiple of the file.
        document.elements.reserve((text.len() / 128).min(MOST_ELEMENTS));
        document.attributes.reserve((text.len() / 128).min(MOST_ATTRIBUTES));
        document.texts.reserve((text.len() / 512).min(MOST_ELEMENTS));
        Reading { document, open: Vec::new(), skipped: 0, rooted: false, text }.read()
    }
}

struct Reading<'a> {
    text: &'a str,
    document: Document<'a>,
    /// The elements around this place, with the spans of their names.
    open: Vec<u32>,
    /// How many elements around this place are not kept.
    skipped: usize,
    rooted: bool,
}

impl<'a> Reading<'a> {
    fn read(mut self) -> Result<Document<'a>, Diagnostic> {
        let mut reader = Reader::from_str(self.text);
        loop {
            let start = usize::try_from(reader.buffer_position()).unwrap_or(usize::MAX);
            let event = reader.read_event();
            let span = Span::new(start, usize::try_from(reader.buffer_position()).unwrap_or(usize::MAX));
            match event {
                Err(error) => {
                    let at = usize::try_from(reader.error_position()).unwrap_or(start);
                    return Err(malformed(Span::new(at, at + 1), error.to_string()));
                }
                Ok(Event::Start(tag)) => self.start(&tag, span)?,
                Ok(Event::Empty(tag)) => {
                    self.start(&tag, span)?;
                    self.end();
                }
                Ok(Event::End(_)) => self.end(),
                Ok(Event::Text(text)) => self.add_text(text.into_inner(), span, Some(start))?,
                Ok(Event::CData(text)) => self.add_text(text.into_inner(), span, Some(start + "<![CDATA[".len()))?,
                Ok(Event::GeneralRef(reference)) => {
                    let character = reference.resolve_char_ref().map_err(|error| malformed(span, error.to_string()))?;
                    let text = match character {
                        Some(character) => Cow::Owned(character.to_string()),
                        None => match resolve_predefined_entity(&reference.into_inner()) {
                            Some(text) => Cow::Borrowed(text),
                            None => {
                                let problem = malformed(span, "this entity is not defined".to_owned());
                                return Err(problem
                                    .hint("only &lt; &gt; &amp; &quot; &apos; and character references are read"));
                            }
                        },
                    };
                    self.add_text(text, span, None)?;
                }
                Ok(Event::Comment(text)) if self.skipped == 0 => {
                    let text = text.into_inner();
                    self.add("", span, (0, 0))?;
                    let last = self.document.elements.len() - 1;
                    self.set_text(last, Text { text, span, verbatim: None });
                }
                Ok(Event::DocType(_)) => {
                    let problem = malformed(span, "a document type is not read".to_owned());
                    return Err(problem.hint("PLCopen files have none; take it out"));
                }
                Ok(Event::Comment(_) | Event::Decl(_) | Event::PI(_)) => {}
                Ok(Event::Eof) => break,
            }
        }
        if let Some(open) = self.open.last() {
            let data = &self.document.elements[*open as usize];
            let problem = Diagnostic::new(Code::Unclosed, data.span, format!("`<{}>` is never closed", data.name));
            return Err(problem.hint("the file may have been cut off"));
        }
        if !self.rooted {
            return Err(malformed(Span::default(), "there is no element".to_owned()));
        }
        Ok(self.document)
    }

    fn start(&mut self, tag: &BytesStart<'a>, span: Span) -> Result<(), Diagnostic> {
        if self.open.len() + self.skipped >= MOST_DEPTH {
            let message = format!("elements nest deeper than {MOST_DEPTH} here");
            return Err(Diagnostic::new(Code::TooDeep, span, message));
        }
        // The name is the tag's text from its second byte on.
        let name_start = span.range().start + 1;
        let name = self.text.get(name_start..name_start + tag.name().as_ref().len()).unwrap_or("");
        let name = local(name);
        let in_connection =
            self.open.last().is_some_and(|open| self.document.elements[*open as usize].name == "connection");
        if self.skipped > 0 || name == "relPosition" || in_connection && name == "position" {
            self.skipped += 1;
            return Ok(());
        }
        if let (true, Some(around)) = (name == "addData" || name == "data", self.open.last().copied()) {
            // Both are open, but what is in them belongs to the element around them.
            if name == "addData" || is_read_data(tag) {
                self.open.push(around);
            } else {
                self.skipped += 1;
            }
            return Ok(());
        }
        if self.open.is_empty() && self.rooted {
            return Err(malformed(span, "there is a second outermost element".to_owned()));
        }
        self.rooted = true;
        let attributes = self.attributes(tag, span)?;
        self.add(name, span, attributes)?;
        let index = self.document.elements.len() - 1;
        self.open.push(u32::try_from(index).unwrap_or(NONE));
        Ok(())
    }

    fn end(&mut self) {
        if self.skipped > 0 {
            self.skipped -= 1;
        } else {
            self.open.pop();
        }
    }

    fn attributes(&mut self, tag: &BytesStart<'a>, span: Span) -> Result<(u32, u32), Diagnostic> {
        let first = self.document.attributes.len();
        let base = span.range().start + 1;
        let tag_text = tag.as_ref();
        // Names are compared pairwise as they come, so that the limit is one of time too.
        for (count, attribute) in tag.attributes().enumerate() {
            if count >= MOST_OF_ONE {
                return Err(too_large(span, format!("this element has more than {MOST_OF_ONE} attributes")));
            }
            let attribute = attribute.map_err(|error| malformed(span, error.to_string()))?;
            let key = attribute.key.as_ref();
            // The reader lends from the tag; the tree borrows the same bytes from the text.
            let offset = (key.as_ptr() as usize).wrapping_sub(tag_text.as_ptr() as usize);
            let key = local(self.text.get(base + offset..base + offset + key.len()).unwrap_or(""));
            if matches!(key, "height" | "width") {
                continue;
            }
            let raw = attribute.value.as_ref();
            let offset = (raw.as_ptr() as usize).wrapping_sub(tag_text.as_ptr() as usize);
            let plain = self.text.get(base + offset..base + offset + raw.len());
            let is_plain = raw.bytes().all(|byte| !matches!(byte, b'&' | b'\n' | b'\t' | b'\r'));
            let value = match plain.filter(|_| is_plain) {
                Some(plain) => Cow::Borrowed(plain),
                None => Cow::Owned(
                    attribute
                        .normalized_value(XmlVersion::Implicit1_0)
                        .map_err(|error| malformed(span, error.to_string()))?
                        .into_owned(),
                ),
            };
            self.document.attributes.push((key, value));
        }
        let last = self.document.attributes.len();
        if last > MOST_ATTRIBUTES {
            return Err(too_large(span, format!("this file has more than {MOST_ATTRIBUTES} attributes")));
        }
        let clamp = |index: usize| u32::try_from(index).unwrap_or(u32::MAX);
        Ok((clamp(first), clamp(last)))
    }

    fn add(&mut self, name: &'a str, span: Span, attributes: (u32, u32)) -> Result<(), Diagnostic> {
        let index = self.document.elements.len();
        if index >= MOST_ELEMENTS {
            return Err(too_large(span, format!("this file has more than {MOST_ELEMENTS} elements")));
        }
        let index = u32::try_from(index).unwrap_or(NONE);
        let data = Data { name, span, attributes, first_child: NONE, last_child: NONE, next: NONE, text: NONE };
        self.document.elements.push(data);
        if let Some(parent) = self.open.last().copied() {
            let elements = &mut self.document.elements;
            let before = std::mem::replace(&mut elements[parent as usize].last_child, index);
            if before == NONE {
                elements[parent as usize].first_child = index;
            } else {
                elements[before as usize].next = index;
            }
        }
        Ok(())
    }

    /// Adds to the text of the open element; `verbatim` is where it starts in the file if nothing in it is escaped.
    fn add_text(&mut self, text: Cow<'a, str>, span: Span, verbatim: Option<usize>) -> Result<(), Diagnostic> {
        if self.skipped > 0 {
            return Ok(());
        }
        let blank = is_blank(&text);
        let Some(open) = self.open.last() else {
            return if blank { Ok(()) } else { Err(malformed(span, "text stands outside of the elements".to_owned())) };
        };
        let open = *open as usize;
        let place = self.document.elements[open].text;
        match self.document.texts.get_mut(place as usize) {
            Some(before) => {
                before.verbatim = None;
                before.text.to_mut().push_str(&text);
                before.span = before.span.to(span);
            }
            None if blank => {}
            None => {
                let verbatim = verbatim.filter(|_| matches!(text, Cow::Borrowed(_)));
                self.set_text(open, Text { text, span, verbatim });
            }
        }
        Ok(())
    }

    fn set_text(&mut self, element: usize, text: Text<'a>) {
        // There are no more texts than elements.
        self.document.elements[element].text = u32::try_from(self.document.texts.len()).unwrap_or(NONE);
        self.document.texts.push(text);
    }
}

/// Whether a `<data>` of a tool holds what the standard has elsewhere.
fn is_read_data(tag: &BytesStart<'_>) -> bool {
    let name = tag.try_get_attribute("name").ok().flatten();
    name.is_some_and(|name| {
        let name = name.value.as_ref();
        let last = name.rsplit('/').next().unwrap_or(name);
        READ_DATA.iter().any(|known| last.eq_ignore_ascii_case(known))
    })
}

/// Whether nothing but blanks is there: between most elements, with the indentation of the next.
fn is_blank(text: &str) -> bool {
    // A whole block at a time, which a loop that may end at each byte is not.
    let ascii =
        |block: &[u8]| block.iter().fold(true, |blank, byte| blank & matches!(byte, b' ' | b'\t' | b'\n' | b'\r'));
    text.as_bytes().chunks(16).all(ascii) || text.trim_start().is_empty()
}

/// A name without its prefix. Names are short, so that a search made for long texts would take longer.
fn local(name: &str) -> &str {
    name.bytes().rposition(|byte| byte == b':').map_or(name, |colon| &name[colon + 1..])
}

fn malformed(span: Span, message: String) -> Diagnostic {
    Diagnostic::new(Code::BadXml, span, message)
}

fn too_large(span: Span, message: String) -> Diagnostic {
    Diagnostic::new(Code::FileTooLarge, span, message)
}
