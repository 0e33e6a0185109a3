//! Casimirs.

use lie_symbolic::symbolic::ExprId;
use lie_syntax::ast::Expr;
use lie_syntax::diagnostic::Origin;

/// Where a Casimir comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CasimirKind {
    /// It was declared, and verified.
    Declared,
    /// A polynomial that was found.
    Polynomial,
    /// A rational function that was found.
    Rational,
    /// Another function that was found.
    Function,
}

/// A Casimir, declared and verified or found; those of a model are functionally independent.
#[derive(Clone, Debug)]
pub struct Casimir {
    /// Whether it has several branches, between which its value jumps.
    pub multivalued: bool,
    /// Whether the motion keeps it, as is proven where forces act.
    pub kept: bool,
    /// Its name, declared or given.
    pub name: String,
    /// Where it is declared.
    pub origin: Origin,
    /// The function.
    pub expr: ExprId,
    /// Its total degree in the coordinates, where it is a polynomial in them.
    pub degree: Option<u32>,
    /// Where it comes from.
    pub kind: CasimirKind,
    /// A found one as it would have been declared.
    pub written: Option<Expr>,
}
