//! Matrix representations: `rho(e_i) rho(e_j) - rho(e_j) rho(e_i) = sum_k C_ij^k rho(e_k)`.

use std::collections::BTreeSet;

use super::envelope::Columns;
use super::field::{Coordinates, Field, NoSpan};
use super::sparse::SparseMatrix;
use super::{StructureConstants, envelope, triple};
use lie_symbolic::exact::{Budget, Exhausted, Fraction, Rational};
use lie_syntax::ast::Matrix;
use lie_syntax::diagnostic::{Diagnostic, Kind};
use lie_syntax::linear::{Scope, WORK};

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

/// A representation by matrices whose entries are rational functions of exact parameters. What is known of them holds for all values
/// of the parameters at which it is finite.
#[derive(Clone, Debug)]
pub struct Parametric {
    /// Size of the matrices.
    pub dimension: usize,
    /// The matrix of each basis element, by rows.
    pub matrices: Vec<Vec<Vec<Fraction>>>,
    /// The triple product, as that of a [`Representation`].
    pub triple: Option<Vec<TripleEntry>>,
    /// Whether the brackets are computed from them.
    pub gives_brackets: bool,
}

impl Parametric {
    /// The parameters that occur, ascending.
    pub fn parameters(&self) -> BTreeSet<usize> {
        let entries = self.matrices.iter().flatten().flatten();
        let polynomials = entries.flat_map(|entry| {
            let below = entry.denominator().map(|(factor, _)| factor);
            below.chain([entry.numerator()])
        });
        let monomials = polynomials.flat_map(|polynomial| polynomial.terms());
        let powers = monomials.flat_map(|(monomial, _)| monomial.powers());
        powers.map(|(parameter, _)| parameter).collect()
    }

    /// Whether the leading blocks of so many rows of the first matrices, of so many, are antisymmetric.
    pub fn is_antisymmetric(&self, count: usize, size: usize) -> bool {
        let pairs = || (0..size).flat_map(|i| (0..=i).map(move |j| (i, j)));
        let opposite = |matrix: &Vec<Vec<Fraction>>, (i, j): (usize, usize)| {
            let negative: Fraction = matrix[j][i].neg();
            let equal = matrix[i][j].equals(&negative, &Budget::new(WORK));
            equal.unwrap_or(false)
        };
        let mut matrices = self.matrices.iter().take(count);
        matrices.all(|matrix| pairs().all(|pair| opposite(matrix, pair)))
    }

    /// That something needs matrices of numbers, with the remedy, by the names of the parameters.
    pub fn refusal<'n>(&self, what: &str, name: impl Fn(usize) -> &'n str) -> (String, String) {
        let names = self.parameters().into_iter();
        let names = names.map(|parameter| format!("`{}`", name(parameter)));
        let names: Vec<String> = names.collect();
        let (those, values) = match names.len() {
            1 => ("the parameter", "the value"),
            _ => ("the parameters", "the values"),
        };
        let names = names.join(", ");
        let reason = format!(
            "{what} needs `matrices` of numbers, and the declared ones depend on {those} {names}"
        );
        (
            reason,
            format!("write {values} of {names} into the matrices"),
        )
    }

    /// A linear relation between the matrices at values of the parameters, if there is one.
    ///
    /// # Errors
    /// The index of one that is not finite there.
    pub fn relation(
        &self,
        value: &dyn Fn(usize) -> Rational,
    ) -> Result<Option<Vec<Rational>>, usize> {
        let matrices = self.matrices.iter().enumerate();
        let flat = matrices.map(|(index, matrix)| {
            let entries = matrix.iter().flatten();
            let entries = entries.map(|entry| entry.evaluate(value));
            entries.collect::<Option<_>>().ok_or(index)
        });
        let flat: Vec<Vec<Rational>> = flat.collect::<Result<_, _>>()?;
        Ok(match Rational::span(&flat, &Budget::new(WORK)) {
            Err(NoSpan::Dependent(relation)) => Some(relation),
            _ => None,
        })
    }
}

/// The matrices of an algebra, one for each basis element.
pub struct Matrices<'a, T> {
    pub(super) declared: Vec<&'a Matrix>,
    pub(super) sparse: Vec<SparseMatrix<T>>,
    pub(super) dimension: usize,
}

impl<T: Field> Matrices<'_, T> {
    fn flat(&self) -> Vec<Vec<T>> {
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
        let span = T::span(&self.flat(), budget).map_err(|none| match none {
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
                let entry = |(k, value): (usize, T)| (i, j, k, value.to_fraction());
                entries.extend(nonzero(coordinates).map(entry));
            }
        }
        Ok(StructureConstants::new(self.sparse.len(), entries))
    }

    /// A linear relation between the matrices.
    fn dependent(&self, relation: Vec<T>, scope: &Scope<'_>) -> Diagnostic {
        let form = nonzero(relation).map(|(k, c)| (k, c.to_fraction()));
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

    /// Checks the matrices against the brackets.
    ///
    /// # Errors
    /// A representation that is none.
    pub fn check(
        &self,
        constants: &StructureConstants<Fraction>,
        scope: &Scope<'_>,
        budget: &Budget,
    ) -> Result<(), Diagnostic> {
        for i in 0..self.sparse.len() {
            for j in i + 1..self.sparse.len() {
                let wrong = self.first_wrong_entry(i, j, constants, budget);
                if let Some(wrong) = wrong.map_err(|Exhausted| self.limit())? {
                    return Err(self.not_represented((i, j), wrong, constants, scope));
                }
            }
        }
        Ok(())
    }

    fn rows(&self) -> Vec<Vec<Vec<T>>> {
        self.sparse.iter().map(SparseMatrix::rows).collect()
    }

    /// That what depends on triple products is not decided.
    fn undecided(&self) -> Diagnostic {
        let message = "the matrices are too large to decide how their span is closed under triple products; \
                       the Cayley retraction, collective and isospectral methods are not available";
        let warning = Diagnostic::new(Kind::Limit, self.declared[0].origin, message);
        warning.help("choose a smaller representation").warning()
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

    /// The first entry of `[rho_i, rho_j] - C_ij^k rho_k` that is not zero.
    fn first_wrong_entry(
        &self,
        i: usize,
        j: usize,
        constants: &StructureConstants<Fraction>,
        budget: &Budget,
    ) -> Result<Option<(usize, usize, Fraction)>, Exhausted> {
        let mut rest = SparseMatrix::commutator(&self.sparse[i], &self.sparse[j], budget)?.flat();
        let mut beyond: Vec<(&Fraction, usize)> = Vec::new();
        for (_, _, k, value) in constants.upper(i, j) {
            match T::from_fraction(&value.neg()) {
                Some(value) => {
                    for (position, entry) in self.sparse[*k].entries() {
                        rest[position].add_product(&value, entry, budget)?;
                    }
                }
                None => beyond.push((value, *k)),
            }
        }
        let rest = rest.into_iter().map(|value| value.to_fraction());
        let mut rest: Vec<(usize, Fraction)> = rest.enumerate().collect();
        for (value, k) in beyond {
            for (position, entry) in self.sparse[k].entries() {
                let product = value.mul(&entry.to_fraction(), budget)?;
                rest[position].1 = rest[position].1.sub(&product, budget)?;
            }
        }
        let wrong = rest.into_iter().find(|(_, value)| !value.is_zero());
        Ok(wrong
            .map(|(position, value)| (position / self.dimension, position % self.dimension, value)))
    }
}

impl Matrices<'_, Rational> {
    /// The representation, with a warning where its closures take too long.
    pub fn representation(
        &self,
        budget: &Budget,
        warnings: &mut Vec<Diagnostic>,
    ) -> Representation {
        let (triple, dual) = self.closures(budget).unwrap_or_else(|Exhausted| {
            warnings.push(self.undecided());
            (None, None)
        });
        Representation {
            dimension: self.dimension,
            matrices: self.rows(),
            triple,
            columns: dual.as_ref().map(|dual| dual.columns.clone()),
            dual: dual.map(|dual| dual.matrices),
        }
    }

    /// The triple product and the dual matrices, for independent matrices.
    fn closures(&self, budget: &Budget) -> Result<Closures, Exhausted> {
        let span = match Rational::span(&self.flat(), budget) {
            Ok(span) => span,
            Err(NoSpan::Dependent(_)) => return Ok((None, None)),
            Err(NoSpan::Exhausted) => return Err(Exhausted),
        };
        let triple = triple::closure(&self.sparse, &span, budget)?;
        let dual = envelope::dual(&self.sparse, triple.is_some(), budget)?;
        Ok((triple, dual))
    }
}

impl Matrices<'_, Fraction> {
    /// The representation, with a warning where its triple product takes too long.
    pub fn parametric(&self, budget: &Budget, warnings: &mut Vec<Diagnostic>) -> Parametric {
        let triple = self.triple(budget).unwrap_or_else(|Exhausted| {
            warnings.push(self.undecided());
            None
        });
        Parametric {
            dimension: self.dimension,
            matrices: self.rows(),
            triple,
            gives_brackets: false,
        }
    }

    /// The triple product of independent matrices.
    fn triple(&self, budget: &Budget) -> Result<Option<Vec<TripleEntry>>, Exhausted> {
        match Fraction::span(&self.flat(), budget) {
            Ok(span) => triple::closure(&self.sparse, &span, budget),
            Err(NoSpan::Dependent(_)) => Ok(None),
            Err(NoSpan::Exhausted) => Err(Exhausted),
        }
    }
}

fn nonzero<T: Field>(values: Vec<T>) -> impl Iterator<Item = (usize, T)> {
    let values = values.into_iter().enumerate();
    values.filter(|(_, value)| !value.is_zero())
}
