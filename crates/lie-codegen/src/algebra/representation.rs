//! Matrix representations: `rho(e_i) rho(e_j) - rho(e_j) rho(e_i) = sum_k C_ij^k rho(e_k)`.

use super::envelope::Columns;
use super::sparse::SparseMatrix;
use super::{StructureConstants, envelope, triple};
use lie_symbolic::exact::span::{NoSpan, Span};
use lie_symbolic::exact::{Budget, Exhausted, Fraction, Rational};
use lie_syntax::ast::{Algebra, Expr, Matrix};
use lie_syntax::diagnostic::{Diagnostic, Kind};
use lie_syntax::linear::{Scope, rational};

/// Entries of all matrices together that are still looked at.
const MAX_ENTRIES: usize = 4_000_000;

/// An entry `(a, b, c, d, T_abc^d)` of the triple product.
pub type TripleEntry = (usize, usize, usize, usize, Fraction);

/// The triple product and the dual matrices of a [`Representation`].
type Closures = (Option<Vec<TripleEntry>>, Option<envelope::Duals>);

/// A matrix representation of the algebra.
#[derive(Clone, Debug, PartialEq)]
pub struct Representation {
    /// Size of the matrices.
    pub dimension: usize,
    /// The matrix of each basis element, by rows.
    pub matrices: Vec<Vec<Vec<Rational>>>,
    /// Where the span of the matrices is closed under the Jordan triple product:
    /// `(rho_a rho_b rho_c + rho_c rho_b rho_a)/2 = sum_d T_abc^d rho_d`, every nonzero entry,
    /// also both of `T_abc^d = T_cba^d`. Otherwise, and for dependent matrices, `None`.
    pub triple: Option<Vec<TripleEntry>>,
    /// Dual matrices `D^k`, `tr(D^k rho_l) = delta_kl`, by rows, where the closure of the span under
    /// `(abc + cba)/2` adds only matrices that commute with those of the representation; they pair to
    /// zero with the latter. Otherwise, and for dependent matrices, `None`.
    pub dual: Option<Vec<Vec<Vec<Rational>>>>,
    /// Columns that suffice for them, where there are dual matrices.
    pub columns: Option<Columns>,
}

/// The matrices as they were read, one for each basis element.
pub struct Matrices<'a> {
    declared: Vec<&'a Matrix>,
    sparse: Vec<SparseMatrix>,
    dimension: usize,
}

/// Reads the declared matrices: one square matrix of rationals for each basis element, of one size.
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
        let rows = rows(matrix, dimension, budget, &mut mistakes);
        entries.push((scope.basis_index(&matrix.name.text), rows));
    }
    if !mistakes.is_empty() {
        return Err(mistakes);
    }
    entries.sort_by_key(|(index, _)| *index);
    let sparse = entries
        .into_iter()
        .filter_map(|(_, rows)| rows)
        .map(|rows| SparseMatrix::from_rows(&rows))
        .collect();
    Ok(Matrices {
        declared: slots.into_iter().flatten().collect(),
        sparse,
        dimension,
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
    budget: &Budget,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<Vec<Vec<Rational>>> {
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
        let entries = row.iter().map(|entry| rational(entry, budget));
        let entries = entries.map(|entry| entry.map_err(|found| mistakes.extend(found)).ok());
        entries.collect::<Vec<_>>()
    };
    let rows: Vec<Vec<Option<Rational>>> = matrix.rows.iter().map(row).collect();
    let rows = rows.into_iter().map(|row| row.into_iter().collect());
    let rows: Option<Vec<Vec<Rational>>> = rows.collect();
    rows.filter(|_| square)
}

impl Matrices<'_> {
    fn flat(&self) -> Vec<Vec<Rational>> {
        self.sparse.iter().map(SparseMatrix::flat).collect()
    }

    fn limit(&self) -> Diagnostic {
        let message = "the matrices are too large for the exact check";
        Diagnostic::new(Kind::Limit, self.declared[0].origin, message)
            .help("choose a smaller representation")
    }

    /// The structure constants of the matrices themselves.
    ///
    /// # Errors
    /// Dependent matrices and a span that is not closed under the commutator: there is no algebra to compute.
    pub fn constants(
        &self,
        scope: &Scope<'_>,
        budget: &Budget,
    ) -> Result<StructureConstants<Fraction>, Diagnostic> {
        let span = Span::new(&self.flat(), budget).map_err(|none| match none {
            NoSpan::Exhausted => self.limit(),
            NoSpan::Dependent(relation) => self.dependent(relation, scope),
        })?;
        let mut entries = Vec::new();
        for i in 0..self.sparse.len() {
            for j in i + 1..self.sparse.len() {
                let commutator = SparseMatrix::commutator(&self.sparse[i], &self.sparse[j], budget);
                let coordinates = commutator.and_then(|c| span.coordinates(&c.flat(), budget));
                let coordinates = coordinates.map_err(|Exhausted| self.limit())?;
                let coordinates = coordinates.ok_or_else(|| self.outside(i, j, scope))?;
                let entry = |(k, value)| (i, j, k, Fraction::from(value));
                entries.extend(nonzero(coordinates).map(entry));
            }
        }
        Ok(StructureConstants::new(self.sparse.len(), entries))
    }

    /// A linear relation between the matrices.
    fn dependent(&self, relation: Vec<Rational>, scope: &Scope<'_>) -> Diagnostic {
        let form = nonzero(relation).map(|(k, c)| (k, Fraction::from(c)));
        let form: Vec<_> = form.collect();
        let last = form.last().map_or(0, |(index, _)| *index);
        let message = format!(
            "the matrices are linearly dependent: {} = 0",
            scope.display(&form)
        );
        Diagnostic::new(Kind::Representation, self.declared[last].origin, message).help(
            "brackets can only be computed from independent matrices; otherwise declare `brackets`",
        )
    }

    /// Two matrices whose commutator is no combination of the others.
    fn outside(&self, i: usize, j: usize, scope: &Scope<'_>) -> Diagnostic {
        let [a, b] = [i, j].map(|index| scope.basis()[index]);
        let message = format!(
            "the commutator of the matrices of `{a}` and `{b}` is outside the span of the matrices"
        );
        Diagnostic::new(Kind::Representation, self.declared[j].origin, message)
            .help("the matrices must span a Lie algebra; add the missing basis elements")
    }

    /// Checks the matrices against the brackets, and finds their triple product, with a warning where that takes too long.
    ///
    /// # Errors
    /// A representation that is none: every method that uses it would leave the orbit.
    pub fn representation(
        &self,
        constants: &StructureConstants<Fraction>,
        scope: &Scope<'_>,
        budget: &Budget,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<Representation, Diagnostic> {
        for i in 0..self.sparse.len() {
            for j in i + 1..self.sparse.len() {
                let wrong = self.first_wrong_entry(i, j, constants, budget);
                if let Some(wrong) = wrong.map_err(|Exhausted| self.limit())? {
                    return Err(self.not_represented((i, j), wrong, constants, scope));
                }
            }
        }
        let (triple, dual) = self.closures(budget).unwrap_or_else(|Exhausted| {
            let message = "the matrices are too large to decide how their span is closed under triple products; \
                           the Cayley retraction, collective and isospectral methods are not available";
            let warning = Diagnostic::new(Kind::Limit, self.declared[0].origin, message);
            warnings.push(warning.help("choose a smaller representation").warning());
            (None, None)
        });
        let matrices = self.sparse.iter().map(SparseMatrix::rows).collect();
        Ok(Representation {
            dimension: self.dimension,
            matrices,
            triple,
            columns: dual.as_ref().map(|dual| dual.columns.clone()),
            dual: dual.map(|dual| dual.matrices),
        })
    }

    /// A bracket that the matrices do not represent, by a wrong entry.
    fn not_represented(
        &self,
        (i, j): (usize, usize),
        (row, column, rest): (usize, usize, Fraction),
        constants: &StructureConstants<Fraction>,
        scope: &Scope<'_>,
    ) -> Diagnostic {
        let [a, b] = [i, j].map(|index| scope.basis()[index]);
        let form = constants.upper(i, j).iter();
        let form: Vec<_> = form.map(|(_, _, k, v)| (*k, v.clone())).collect();
        // The matrix on the right side is the likeliest to be wrong.
        let place = form.last().map_or(j, |(k, _)| *k);
        let message = format!(
            "the matrices do not represent [{a}, {b}] = {}: entry ({}, {}) of the commutator minus the right side is {}",
            scope.display(&form),
            row + 1,
            column + 1,
            rest.display(&|p| scope.parameter(p)),
        );
        Diagnostic::new(Kind::Representation, self.declared[place].origin, message)
            .help("correct the bracket or the matrices; without `brackets` they are computed from the matrices")
    }

    /// The triple product and the dual matrices, for independent matrices.
    fn closures(&self, budget: &Budget) -> Result<Closures, Exhausted> {
        let span = match Span::new(&self.flat(), budget) {
            Ok(span) => span,
            Err(NoSpan::Dependent(_)) => return Ok((None, None)),
            Err(NoSpan::Exhausted) => return Err(Exhausted),
        };
        let triple = triple::closure(&self.sparse, &span, budget)?;
        let dual = envelope::dual(&self.sparse, triple.is_some(), budget)?;
        Ok((triple, dual))
    }

    /// The first entry of `[rho_i, rho_j] - C_ij^k rho_k` that is not zero.
    fn first_wrong_entry(
        &self,
        i: usize,
        j: usize,
        constants: &StructureConstants<Fraction>,
        budget: &Budget,
    ) -> Result<Option<(usize, usize, Fraction)>, Exhausted> {
        let mut rest = SparseMatrix::commutator(&self.sparse[i], &self.sparse[j], budget)?.flat();
        let mut parametric: Vec<(&Fraction, usize)> = Vec::new();
        for (_, _, k, value) in constants.upper(i, j) {
            match value.as_constant() {
                Some(value) => {
                    for (position, entry) in self.sparse[*k].entries() {
                        rest[position] = &rest[position] - &(&value * entry);
                    }
                }
                None => parametric.push((value, *k)),
            }
        }
        let mut rest: Vec<(usize, Fraction)> =
            rest.into_iter().map(Fraction::from).enumerate().collect();
        for (value, k) in parametric {
            for (position, entry) in self.sparse[k].entries() {
                rest[position].1 = rest[position].1.sub(&value.scale(entry), budget)?;
            }
        }
        let wrong = rest.into_iter().find(|(_, value)| !value.is_zero());
        Ok(wrong
            .map(|(position, value)| (position / self.dimension, position % self.dimension, value)))
    }
}

fn nonzero(values: Vec<Rational>) -> impl Iterator<Item = (usize, Rational)> {
    let values = values.into_iter().enumerate();
    values.filter(|(_, value)| !value.is_zero())
}
