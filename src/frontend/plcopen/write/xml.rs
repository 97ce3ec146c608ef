//! XML with an element a line, and small parts of drawings on one. What is written is well formed whatever the names and texts are.

use std::fmt::Write as _;

/// A text that grows element by element.
#[derive(Default)]
pub(super) struct Xml {
    text: String,
    depth: usize,
    /// How many elements around this place are written on one line.
    in_line: usize,
}

/// The attributes of an element.
type Attributes<'a> = &'a [(&'a str, &'a str)];

impl Xml {
    /// The declaration and nothing more.
    pub(super) fn document() -> Self {
        Self { text: "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n".to_owned(), ..Self::default() }
    }

    fn indent(&mut self) {
        if self.in_line == 0 {
            self.text.extend(std::iter::repeat_n("  ", self.depth));
        }
    }

    fn end_line(&mut self) {
        if self.in_line == 0 {
            self.text.push('\n');
        }
    }

    fn tag(&mut self, name: &str, attributes: Attributes<'_>) {
        self.indent();
        self.text.push('<');
        self.text.push_str(name);
        for (attribute, value) in attributes {
            self.text.push(' ');
            self.text.push_str(attribute);
            self.text.push_str("=\"");
            self.escaped(value);
            self.text.push('"');
        }
    }

    fn end(&mut self, name: &str) {
        self.text.push_str("</");
        self.text.push_str(name);
        self.text.push('>');
        self.end_line();
    }

    /// An element with what `inside` writes in it.
    pub(super) fn element<T>(
        &mut self,
        name: &str,
        attributes: Attributes<'_>,
        inside: impl FnOnce(&mut Self) -> T,
    ) -> T {
        self.tag(name, attributes);
        self.text.push('>');
        self.end_line();
        self.depth += 1;
        let result = inside(self);
        self.depth -= 1;
        self.indent();
        self.end(name);
        result
    }

    /// As [`Xml::element`], with all of it on one line.
    pub(super) fn on_one_line<T>(
        &mut self,
        name: &str,
        attributes: Attributes<'_>,
        inside: impl FnOnce(&mut Self) -> T,
    ) -> T {
        self.tag(name, attributes);
        self.text.push('>');
        self.in_line += 1;
        let result = inside(self);
        self.in_line -= 1;
        self.end(name);
        result
    }

    /// An element with nothing in it.
    pub(super) fn empty(&mut self, name: &str, attributes: Attributes<'_>) {
        self.tag(name, attributes);
        self.text.push_str("/>");
        self.end_line();
    }

    /// An element that is a place.
    pub(super) fn position(&mut self, name: &str, x: i32, y: i32) {
        self.indent();
        // A string takes any text.
        let _ = write!(self.text, "<{name} x=\"{x}\" y=\"{y}\"/>");
        self.end_line();
    }

    /// An element with a text.
    pub(super) fn text(&mut self, name: &str, text: &str) {
        self.tag(name, &[]);
        self.text.push('>');
        self.escaped(text);
        self.end(name);
    }

    /// An element with a text of several lines, as XHTML in which nothing is escaped.
    pub(super) fn formatted(&mut self, name: &str, text: &str) {
        self.element(name, &[], |xml| {
            let text = text.replace("]]>", "]] >");
            let text: String = text.chars().filter(|one| is_allowed(*one)).collect();
            xml.indent();
            xml.text.push_str("<xhtml:p><![CDATA[");
            xml.text.push_str(&text);
            xml.text.push_str("]]></xhtml:p>");
            xml.end_line();
        });
    }

    fn escaped(&mut self, text: &str) {
        for character in text.chars().filter(|one| is_allowed(*one)) {
            match character {
                '<' => self.text.push_str("&lt;"),
                '>' => self.text.push_str("&gt;"),
                '&' => self.text.push_str("&amp;"),
                '"' => self.text.push_str("&quot;"),
                other => self.text.push(other),
            }
        }
    }

    /// All of it.
    pub(super) fn finish(self) -> String {
        self.text
    }
}

/// Whether XML has a character at all.
fn is_allowed(character: char) -> bool {
    matches!(character, '\t' | '\n' | '\r' | ' '..='\u{D7FF}' | '\u{E000}'..='\u{FFFD}' | '\u{10000}'..)
}
