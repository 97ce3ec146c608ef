//! Rungs, circuits and branches: `rung r10 "title"`, `[ a | b ]`, `>node> a >other>`.

use super::parser::{Parser, Place};
use crate::diagnostic::{Code, Diagnostic};
use crate::frontend::text::token::Kind;
use crate::frontend::text::{Parse, literals};
use crate::ladder::{Branch, Circuit, Name, Rung};
use crate::source::Span;

impl Parser<'_> {
    pub(super) fn rung(&mut self) -> Parse<()> {
        let first = self.token.span;
        let start = first.start;
        self.come_to(Place::Units, first);
        self.anchor(start);
        self.advance();
        let enabled = !self.at_word("off") || self.token.first_on_line;
        if !enabled {
            self.advance();
        }
        let name = if self.token.kind.is_name() && !self.token.first_on_line {
            Some(self.name("the rung's name")?)
        } else {
            None
        };
        let title = if self.token.kind == Kind::Text { Some(self.title().into()) } else { None };
        if let Some(name) = &name
            && title.is_none()
            && !self.token.first_on_line
            && !self.token.kind.starts_item()
        {
            // Taking the first contact of a one-line rung for its name would leave the contact out.
            let problem = Diagnostic::new(Code::UnexpectedToken, self.token.span, "expected a title or a new line")
                .related(name.span, "this is the rung's name")
                .hint("begin the circuit on the line after `rung`");
            return self.give_up(problem);
        }
        let circuit = self.circuit()?;
        if self.token.kind.closes() {
            let problem = self.unexpected("an element or another rung").hint("nothing is open that this could close");
            return self.give_up(problem);
        }
        self.item_end("an element, a `|` or another rung")?;
        let rung = Rung { name, title, enabled, circuit, span: self.since(start) };
        self.unit().rungs.push(rung);
        Ok(())
    }

    fn title(&mut self) -> String {
        let span = self.token.span;
        let text = self.source.slice(span);
        let inner = text.strip_prefix('"').unwrap_or(text);
        let title = literals::title(inner.strip_suffix('"').unwrap_or(inner)).unwrap_or_else(|problem| {
            self.report_literal(Code::BadLiteral, span, problem);
            String::new()
        });
        self.advance();
        title
    }

    /// Branches in parallel, up to something that is neither a `|` nor an element.
    pub(super) fn circuit(&mut self) -> Parse<Circuit> {
        let start = self.token.span.start;
        let mut branches = vec![self.branch()?];
        while self.take(Kind::Bar) {
            branches.push(self.branch()?);
        }
        Ok(Circuit { branches, span: self.since(start) })
    }

    /// A circuit in brackets, its span with them; `None` if it is too deep and was skipped.
    pub(super) fn bracketed_circuit(&mut self) -> Parse<Option<Circuit>> {
        let open = self.token.span;
        if !self.enter()? {
            return Ok(None);
        }
        let mut circuit = self.circuit()?;
        self.anchor_here();
        self.close(Kind::RightBracket, open, "")?;
        self.leave();
        circuit.span = self.since(open.start);
        Ok(Some(circuit))
    }

    fn branch(&mut self) -> Parse<Branch> {
        let start = self.token.span.start;
        let mut branch = Branch { from: None, elements: Vec::new(), to: None, span: Span::default() };
        if self.token.kind == Kind::Greater {
            branch.from = Some(Box::new(self.node()?));
        }
        if self.token.kind == Kind::Minus {
            self.advance();
            if !self.at_branch_end() && self.token.kind != Kind::Greater {
                let problem = self.unexpected("the end of the branch or a node");
                return self.give_up(problem.hint("`-` is a plain wire, alone in its branch"));
            }
        }
        while !self.at_branch_end() {
            if self.token.kind == Kind::Greater {
                branch.to = Some(Box::new(self.node()?));
                if !self.at_branch_end() {
                    let problem = self.unexpected("the end of the branch");
                    return self.give_up(problem.hint("a node ends its branch: go on from it behind a `|`, >node> …"));
                }
                break;
            }
            if let Some(element) = self.element()? {
                branch.elements.push(element);
            }
        }
        // Of many branches with one element each, the room for more would take most of the memory.
        branch.elements.shrink_to_fit();
        branch.span = self.since(start);
        Ok(branch)
    }

    fn at_branch_end(&self) -> bool {
        self.token.kind.starts_item() || matches!(self.token.kind, Kind::Bar) || self.token.kind.closes()
    }

    /// `>name>`
    fn node(&mut self) -> Parse<Name> {
        self.advance();
        self.anchor_here();
        let name = self.name("the name of a node")?;
        if !self.take(Kind::Greater) {
            let problem = self.unexpected("`>`").hint("a node is written >name>, and a comparison stands in braces");
            return self.give_up(problem);
        }
        Ok(name)
    }
}
