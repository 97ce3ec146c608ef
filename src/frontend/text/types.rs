//! Types: where a declaration names one, and declarations of their own.

use super::reader::{Parse, Reader};
use super::token::{Keyword, Kind};
use crate::ladder::{Dimension, Expression, Field, Name, TypeDeclaration, TypeKind, TypeReference};

impl Reader<'_> {
    /// The name of a type, or `array [0..9, 1..3] of` one.
    pub(crate) fn type_reference(&mut self) -> Parse<TypeReference> {
        let start = self.token.span.start;
        let dimensions = if self.take(Kind::Keyword(Keyword::Array)) { self.dimensions()? } else { Vec::new() };
        let name = self.name("the name of a type")?;
        Ok(TypeReference { dimensions, name, span: self.since(start) })
    }

    /// `[0..9, 1..3] of`
    fn dimensions(&mut self) -> Parse<Vec<Dimension>> {
        const HINT: &str = "an array looks like this: array [0..9, 1..3] of INT";
        let open = self.token.span;
        let mut dimensions = Vec::new();
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
                    self.enumeration(Some(ty.name))?
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
        let initial = if self.take(Kind::Assign) { Some(self.name("the name of a value")?) } else { None };
        Ok(TypeKind::Enumeration { base, values, initial })
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
        let initial: Option<Expression> = if self.take(Kind::Assign) { Some(self.initial_value()?) } else { None };
        self.count_copies(&from, names.len(), self.since(start))?;
        if let Some(last) = names.pop() {
            fields.extend(names.into_iter().map(|name| Field { name, ty: ty.clone(), initial: initial.clone() }));
            fields.push(Field { name: last, ty, initial });
        }
        Ok(())
    }
}
