//! The Casimirs of a model, and how the search for them ended.

use crate::ast::Expr;
use crate::diagnostic::Origin;
use crate::symbolic::ExprId;

/// Where a Casimir comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CasimirKind {
    /// It was declared, and verified.
    Declared,
    /// A polynomial that was found.
    Polynomial,
    /// A rational function that was found.
    Rational,
}

/// How the search for the Casimirs that a declaration lacks ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Search {
    /// There was nothing to look for, or everything was looked for that is.
    Complete,
    /// Polynomials were looked for, and rational functions not: structure constants contain parameters, or brackets constant
    /// terms.
    Polynomials,
    /// Its budget was spent.
    Spent,
    /// What it found is too long to be part of a system.
    Long,
    /// A rational function that was found is not defined at the initial state, and neither is its reciprocal.
    Singular,
    /// It was not made, for a reason.
    None(&'static str),
}

/// A Casimir, declared and verified or found; those of a model are functionally independent.
#[derive(Clone, Debug)]
pub struct Casimir {
    /// Whether it has several branches, between which its value jumps.
    pub multivalued: bool,
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
