//! Types: where a declaration names one, and declarations of their own.

use thin_vec::ThinVec;

use super::reader::{GivenUp, Parse, Reader};
use super::token::{Dialect, Keyword, Kind};
use crate::ladder::{Dimension, Expression, Field, Name, TypeDeclaration, TypeKind, TypeReference};
use crate::source::Span;

impl Reader<'_> {
    /// The name of a type, or `array [0..9, 1..3] of` one.
    pub(crate) fn type_reference(&mut self) -> Parse<TypeReference> {
        let start = self.token.span.start;
        let dimensions = if self.take(Kind::Keyword(Keyword::Array)) { self.dimensions()? } else { ThinVec::new() };
        let name = if self.dialect == Dialect::StructuredText {
            self.refuse_type()?;
            self.written_out(&dimensions)?
        } else {
            None
        };
        let name = match name {
            Some(name) => name,
            None => self.name("the name of a type")?,
        };
        Ok(TypeReference { dimensions, name, span: self.since(start) })
    }

    /// The name of a type that is written out where another one's name could stand: the elements of an array of arrays, a
    /// structure, an enumeration.
    fn written_out(&mut self, dimensions: &[Dimension]) -> Parse<Option<Name>> {
        let start = self.token.span;
        let kind = match self.token.kind {
            Kind::Keyword(Keyword::Array) if !dimensions.is_empty() => {
                // Each nests in the one before.
                if !self.enter_statement(start) {
                    return Err(GivenUp);
                }
                let ty = self.type_reference()?;
                self.leave();
                TypeKind::Alias { ty, initial: None }
            }
            Kind::Keyword(Keyword::Struct) => {
                if !self.enter_statement(start) {
                    return Err(GivenUp);
                }
                let kind = self.structure()?;
                self.leave();
                kind
            }
            Kind::LeftParenthesis => {
                let open = start;
                self.advance();
                self.values(None, open)?
            }
            _ => return Ok(None),
        };
        let span = self.since(start.start);
        let name = Name::new(format!("_TYPE{}", self.hidden.len() + 1), span);
        self.hidden.push(TypeDeclaration { name: name.clone(), kind, span });
        Ok(Some(name))
    }

    /// Gives up a declaration of a type that only structured text has.
    fn refuse_type(&mut self) -> Parse<()> {
        const UNKNOWN: [&str; 18] = [
            "STRING",
            "WSTRING",
            "CHAR",
            "WCHAR",
            "DATE",
            "LDATE",
            "TIME_OF_DAY",
            "TOD",
            "LTOD",
            "DATE_AND_TIME",
            "DT",
            "LDT",
            "LTIME",
            "POINTER",
            "REFERENCE",
            "REF_TO",
            "ANY",
            "UNION",
        ];
        let span = self.token.span;
        let Some(name) = UNKNOWN.into_iter().find(|name| self.at_word(name)) else { return Ok(()) };
        let what = format!("the type {name}");
        self.missing.note(&what, span);
        Err(GivenUp)
    }

    /// `(0..100)` behind the name of a type, in structured text: the type is taken without its bounds. Gives the lower one, which a
    /// variable starts with.
    pub(crate) fn subrange(&mut self) -> Parse<Option<Expression>> {
        let open = self.token.span;
        if self.dialect != Dialect::StructuredText || !self.take(Kind::LeftParenthesis) {
            return Ok(None);
        }
        Ok(Some(self.bounds(open)?))
    }

    /// The bounds of a subrange, behind the parenthesis; gives the lower.
    fn bounds(&mut self, open: Span) -> Parse<Expression> {
        let first = self.expression()?;
        if !self.take(Kind::Range) {
            let problem = self.unexpected("`..`");
            return self.give_up(problem.hint("a subrange looks like this: INT (0..100)"));
        }
        self.expression()?;
        self.close(Kind::RightParenthesis, open, "")?;
        Ok(first)
    }

    /// `[0..9, 1..3] of`
    fn dimensions(&mut self) -> Parse<ThinVec<Dimension>> {
        const HINT: &str = "an array looks like this: array [0..9, 1..3] of INT";
        let open = self.token.span;
        let mut dimensions = ThinVec::new();
        if !self.take(Kind::LeftBracket) {
            let problem = self.unexpected("`[`").hint(HINT);
            return self.give_up(problem);
        }
        loop {
            let first = self.expression()?;
            if !self.take(Kind::Range) {
                let problem = self.unexpected("`..`").hint(HINT);
                return self.give_up(problem);
            }
            dimensions.push(Dimension { first, last: self.expression()? });
            if !self.take(Kind::Comma) {
                break;
            }
        }
        self.close(Kind::RightBracket, open, HINT)?;
        if !self.take(Kind::Keyword(Keyword::Of)) {
            let problem = self.unexpected("`of`").hint(HINT);
            return self.give_up(problem);
        }
        Ok(dimensions)
    }

    /// `name : type`, from the name on.
    pub(crate) fn type_declaration(&mut self) -> Parse<TypeDeclaration> {
        let start = self.token.span.start;
        let name = self.name("the name of a type")?;
        self.anchor(start);
        if !self.take(Kind::Colon) {
            let problem = self.unexpected("`:`");
            return self.give_up(problem.hint("a type is declared so: type colour : (red, green)"));
        }
        let kind = match self.token.kind {
            Kind::LeftParenthesis => self.enumeration(None)?,
            Kind::Keyword(Keyword::Struct) => self.structure()?,
            _ => {
                let ty = self.type_reference()?;
                if ty.dimensions.is_empty() && self.token.kind == Kind::LeftParenthesis {
                    self.enumeration_or_subrange(ty)?
                } else {
                    let initial = if self.take(Kind::Assign) { Some(self.initial_value()?) } else { None };
                    TypeKind::Alias { ty, initial }
                }
            }
        };
        Ok(TypeDeclaration { name, kind, span: self.since(start) })
    }

    /// `(red, green := 4) := red`
    fn enumeration(&mut self, base: Option<Name>) -> Parse<TypeKind> {
        let open = self.token.span;
        self.advance();
        self.enumeration_from(base, open)
    }

    /// What stands behind a type in parentheses: numbers are bounds, names are values.
    fn enumeration_or_subrange(&mut self, ty: TypeReference) -> Parse<TypeKind> {
        if self.dialect == Dialect::Native {
            return self.enumeration(Some(ty.name));
        }
        let open = self.token.span;
        self.advance();
        if self.token.kind.is_name() {
            return self.enumeration_from(Some(ty.name), open);
        }
        let lower = self.bounds(open)?;
        let initial = if self.take(Kind::Assign) { self.initial_value()? } else { lower };
        Ok(TypeKind::Alias { ty, initial: Some(initial) })
    }

    fn enumeration_from(&mut self, base: Option<Name>, open: Span) -> Parse<TypeKind> {
        let kind = self.values(base, open)?;
        let TypeKind::Enumeration { base, values, .. } = kind else { return Ok(kind) };
        let initial = if self.take(Kind::Assign) { Some(self.name("the name of a value")?) } else { None };
        Ok(TypeKind::Enumeration { base, values, initial })
    }

    /// `red, green := 4)`
    fn values(&mut self, base: Option<Name>, open: Span) -> Parse<TypeKind> {
        let mut values = Vec::new();
        loop {
            self.anchor_here();
            let name = self.name("the name of a value")?;
            let number = if self.take(Kind::Assign) { Some(self.expression()?) } else { None };
            values.push((name, number));
            if !self.take(Kind::Comma) {
                break;
            }
        }
        self.close(Kind::RightParenthesis, open, "the values of an enumeration are parted by commas")?;
        Ok(TypeKind::Enumeration { base, values, initial: None })
    }

    /// `struct x, y : REAL := 1.5  name : INT end_struct`
    fn structure(&mut self) -> Parse<TypeKind> {
        const HINT: &str = "a structure looks like this: struct x : REAL  y : REAL end_struct";
        let open = self.token.span;
        self.advance();
        let mut fields = Vec::new();
        while self.token.kind.is_name() {
            self.fields(&mut fields)?;
            self.take(Kind::Semicolon);
        }
        self.anchor_here();
        if !self.take(Kind::Keyword(Keyword::EndStruct)) {
            let problem = self.unexpected("a member or `end_struct`").related(open, "the structure starts here");
            return self.give_up(problem.hint(HINT));
        }
        Ok(TypeKind::Structure(fields))
    }

    /// Members that share their type.
    fn fields(&mut self, fields: &mut Vec<Field>) -> Parse<()> {
        let start = self.token.span.start;
        let mut names = Vec::new();
        loop {
            let at = self.token.span.start;
            names.push(self.name("the name of a member")?);
            self.anchor(at);
            if !self.take(Kind::Comma) {
                break;
            }
        }
        let from = self.copied_from();
        if !self.take(Kind::Colon) {
            let problem = self.unexpected("`:`");
            return self.give_up(problem.hint("each member of a structure has a type: x : REAL"));
        }
        let ty = self.type_reference()?;
        let lower = self.subrange()?;
        let initial = if self.take(Kind::Assign) { Some(self.initial_value()?) } else { lower };
        self.count_copies(&from, names.len(), self.since(start))?;
        if let Some(last) = names.pop() {
            fields.extend(names.into_iter().map(|name| Field { name, ty: ty.clone(), initial: initial.clone() }));
            fields.push(Field { name: last, ty, initial });
        }
        Ok(())
    }
}
