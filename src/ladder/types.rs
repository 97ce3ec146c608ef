//! Types as written: at declarations, and in declarations of their own.

use thin_vec::ThinVec;

use super::{Expression, Name};
use crate::source::Span;

/// A type where a declaration names it.
#[derive(Clone, PartialEq, Debug)]
pub struct TypeReference {
    /// `array [0..9, 1..3] of`: the dimensions; none where it is no array.
    pub dimensions: ThinVec<Dimension>,
    /// The type, or that of the elements.
    pub name: Name,
    /// All of it.
    pub span: Span,
}

impl TypeReference {
    /// A type that is a name and nothing more.
    pub fn of_name(name: Name) -> Self {
        let span = name.span;
        Self { dimensions: ThinVec::new(), name, span }
    }
}

/// The bounds of one dimension, both included. Each is constant.
#[derive(Clone, PartialEq, Debug)]
pub struct Dimension {
    /// The index of the first element.
    pub first: Expression,
    /// The index of the last.
    pub last: Expression,
}

/// The declaration of a type.
#[derive(Clone, PartialEq, Debug)]
pub struct TypeDeclaration {
    /// Its name.
    pub name: Name,
    /// What it is.
    pub kind: TypeKind,
    /// The whole declaration.
    pub span: Span,
}

/// What a declared type is.
#[derive(Clone, PartialEq, Debug)]
pub enum TypeKind {
    /// Another type under a new name.
    Alias {
        /// That type.
        ty: TypeReference,
        /// What a variable of it starts with.
        initial: Option<Expression>,
    },
    /// Members side by side.
    Structure(Vec<Field>),
    /// Names for the numbers of an INT, or of the type given.
    Enumeration {
        /// The integer type that holds it, where that is written.
        base: Option<Name>,
        /// The names, each with its number where that is written; else one more than the one before, from 0.
        values: Vec<(Name, Option<Expression>)>,
        /// What a variable of it starts with; else the first.
        initial: Option<Name>,
    },
}

/// A member of a structure.
#[derive(Clone, PartialEq, Debug)]
pub struct Field {
    /// Its name.
    pub name: Name,
    /// Its type.
    pub ty: TypeReference,
    /// What it starts with.
    pub initial: Option<Expression>,
}
