//! The declared matrices as they were read: numbers, or rational functions of exact parameters.

use super::representation::{Parametric, Representation};
use super::sparse::SparseMatrix;
use super::{StructureConstants, representation};
use lie_symbolic::exact::{Budget, Fraction, Rational};
use lie_syntax::ast::{Algebra, Expr, Matrix};
use lie_syntax::diagnostic::{Diagnostic, Kind};
use lie_syntax::linear::{Scope, entry_value};

/// Entries of all matrices together that are still looked at.
const MAX_ENTRIES: usize = 4_000_000;

/// The matrices of an algebra, one for each basis element.
pub enum Matrices<'a> {
    /// Of numbers.
    Numbers(representation::Matrices<'a, Rational>),
    /// Of rational functions of exact parameters, at least one of them none of a number.
    Functions(representation::Matrices<'a, Fraction>),
}

/// What the matrices of an algebra represent it by.
pub enum Represented {
    /// Matrices of numbers.
    Numbers(Representation),
    /// Matrices of rational functions.
    Functions(Parametric),
}

impl Matrices<'_> {
    /// The structure constants of the matrices themselves.
    ///
    /// # Errors
    /// Dependent matrices and a span that is not closed under the commutator: there is no algebra to compute.
    pub fn constants(
        &self,
        scope: &Scope<'_>,
        budget: &Budget,
    ) -> Result<StructureConstants<Fraction>, Diagnostic> {
        match self {
            Self::Numbers(matrices) => matrices.constants(scope, budget),
            Self::Functions(matrices) => matrices.constants(scope, budget),
        }
    }

    /// Checks the matrices against the brackets, identically in the parameters.
    ///
    /// # Errors
    /// A representation that is none: every method that uses it would leave the orbit.
    pub fn represent(
        &self,
        constants: &StructureConstants<Fraction>,
        scope: &Scope<'_>,
        budget: &Budget,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<Represented, Diagnostic> {
        Ok(match self {
            Self::Numbers(matrices) => {
                matrices.check(constants, scope, budget)?;
                Represented::Numbers(matrices.representation(budget, warnings))
            }
            Self::Functions(matrices) => {
                matrices.check(constants, scope, budget)?;
                Represented::Functions(matrices.parametric(budget, warnings))
            }
        })
    }
}

/// Reads the declared matrices: one square matrix for each basis element, of one size.
///
/// # Errors
/// Every mistake in them.
pub fn declared_matrices<'a>(
    algebra: &'a Algebra,
    scope: &Scope<'_>,
    budget: &Budget,
) -> Result<Matrices<'a>, Vec<Diagnostic>> {
    let mut mistakes = Vec::new();
    let slots = slots(algebra, scope, &mut mistakes);
    let dimension = algebra.matrices.first().map_or(0, |m| m.rows.len());
    if dimension * dimension * algebra.matrices.len() > MAX_ENTRIES {
        mistakes.push(
            Diagnostic::new(
                Kind::Limit,
                algebra.matrices[0].origin,
                "the matrices have too many entries",
            )
            .help("choose a smaller representation"),
        );
        return Err(mistakes);
    }
    let mut entries = Vec::new();
    for matrix in &algebra.matrices {
        let rows = rows(matrix, dimension, scope, budget, &mut mistakes);
        entries.push((scope.basis_index(&matrix.name.text), rows));
    }
    if !mistakes.is_empty() {
        return Err(mistakes);
    }
    entries.sort_by_key(|(index, _)| *index);
    let entries = entries.into_iter().filter_map(|(_, rows)| rows);
    let entries: Vec<Vec<Vec<Fraction>>> = entries.collect();
    let declared = slots.into_iter().flatten().collect();
    let numbers = entries.iter().map(|rows| {
        let row = |row: &Vec<Fraction>| row.iter().map(Fraction::as_constant).collect();
        rows.iter().map(row).collect()
    });
    let numbers: Option<Vec<Vec<Vec<Rational>>>> = numbers.collect();
    Ok(match numbers {
        Some(numbers) => Matrices::Numbers(representation::Matrices {
            declared,
            sparse: numbers.iter().map(|m| SparseMatrix::from_rows(m)).collect(),
            dimension,
        }),
        None => Matrices::Functions(representation::Matrices {
            declared,
            sparse: entries.iter().map(|m| SparseMatrix::from_rows(m)).collect(),
            dimension,
        }),
    })
}

/// The matrix of each basis element; that one has none is reported.
fn slots<'a>(
    algebra: &'a Algebra,
    scope: &Scope<'_>,
    mistakes: &mut Vec<Diagnostic>,
) -> Vec<Option<&'a Matrix>> {
    let mut slots: Vec<Option<&Matrix>> = vec![None; scope.basis().len()];
    for matrix in &algebra.matrices {
        match scope.basis_index(&matrix.name.text) {
            None => {
                mistakes.push(scope.unknown_basis(Kind::Basis, &matrix.name));
            }
            Some(index) if slots[index].is_some() => {
                mistakes.push(
                    Diagnostic::new(
                        Kind::Basis,
                        matrix.name.origin,
                        format!("a second matrix for `{}`", matrix.name.text),
                    )
                    .help("keep one of the two"),
                );
            }
            Some(index) => slots[index] = Some(matrix),
        }
    }
    let missing: Vec<_> = slots
        .iter()
        .zip(&algebra.basis)
        .filter(|(m, _)| m.is_none())
        .map(|(_, name)| name)
        .collect();
    if let Some(first) = missing.first().filter(|_| mistakes.is_empty()) {
        let names: Vec<&str> = missing.iter().map(|name| name.text.as_str()).collect();
        mistakes.push(
            Diagnostic::new(
                Kind::Representation,
                first.origin,
                format!("no matrix for {}", names.join(", ")),
            )
            .help("a representation has one matrix for every basis element"),
        );
    }
    slots
}

/// The entries of a square matrix; all mistakes in them are reported.
fn rows(
    matrix: &Matrix,
    dimension: usize,
    scope: &Scope<'_>,
    budget: &Budget,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<Vec<Vec<Fraction>>> {
    let square = matrix.rows.len() == dimension
        && matrix.rows.iter().all(|row| row.len() == dimension)
        && dimension > 0;
    if !square {
        let message = format!(
            "the matrix of `{}` is not square, or not of the size of the others",
            matrix.name.text
        );
        mistakes.push(
            Diagnostic::new(Kind::Representation, matrix.origin, message)
                .help("all matrices of a representation are square and of one size"),
        );
    }
    let row = |row: &Vec<Expr>| {
        let entries = row.iter().map(|entry| entry_value(entry, scope, budget));
        let entries = entries.map(|entry| entry.map_err(|found| mistakes.extend(found)).ok());
        entries.collect::<Vec<_>>()
    };
    let rows: Vec<Vec<Option<Fraction>>> = matrix.rows.iter().map(row).collect();
    let rows = rows.into_iter().map(|row| row.into_iter().collect());
    let rows: Option<Vec<Vec<Fraction>>> = rows.collect();
    rows.filter(|_| square)
}
