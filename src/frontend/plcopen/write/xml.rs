//! XML with an element a line. What is written is well formed whatever the names and texts are.

/// A text that grows element by element.
#[derive(Default)]
pub(super) struct Xml {
    text: String,
    depth: usize,
}

/// The attributes of an element.
type Attributes<'a> = &'a [(&'a str, &'a str)];

impl Xml {
    /// The declaration and nothing more.
    pub(super) fn document() -> Self {
        Self { text: "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n".to_owned(), depth: 0 }
    }

    fn tag(&mut self, name: &str, attributes: Attributes<'_>) {
        self.text.push_str(&"  ".repeat(self.depth));
        self.text.push('<');
        self.text.push_str(name);
        for (attribute, value) in attributes {
            self.text.push_str(&format!(" {attribute}=\""));
            self.escaped(value);
            self.text.push('"');
        }
    }

    /// An element with what `inside` writes in it.
    pub(super) fn element<T>(
        &mut self,
        name: &str,
        attributes: Attributes<'_>,
        inside: impl FnOnce(&mut Self) -> T,
    ) -> T {
        self.tag(name, attributes);
        self.text.push_str(">\n");
        self.depth += 1;
        let result = inside(self);
        self.depth -= 1;
        self.text.push_str(&format!("{}</{name}>\n", "  ".repeat(self.depth)));
        result
    }

    /// An element with nothing in it.
    pub(super) fn empty(&mut self, name: &str, attributes: Attributes<'_>) {
        self.tag(name, attributes);
        self.text.push_str("/>\n");
    }

    /// An element with a text.
    pub(super) fn text(&mut self, name: &str, text: &str) {
        self.tag(name, &[]);
        self.text.push('>');
        self.escaped(text);
        self.text.push_str(&format!("</{name}>\n"));
    }

    /// An element with a text of several lines, as XHTML in which nothing is escaped.
    pub(super) fn formatted(&mut self, name: &str, text: &str) {
        self.element(name, &[], |xml| {
            let text = text.replace("]]>", "]] >");
            let text: String = text.chars().filter(|one| is_allowed(*one)).collect();
            xml.text.push_str(&format!("{}<xhtml:p><![CDATA[{text}]]></xhtml:p>\n", "  ".repeat(xml.depth)));
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
