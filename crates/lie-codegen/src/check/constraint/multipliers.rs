//! The multipliers: `nu(m)` with `<a_j, grad H(mu_0(m) + sum_i nu_i a_i)> = 0`.

use super::tidy::{collected, constant};
use lie_symbolic::exact::{Budget, Exhausted, Fraction, Rational};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin};

/// Work allowed for the elimination.
const WORK: u64 = 2_000_000;
/// A pivot below that part of the largest entry at the default parameters is none.
const SINGULAR: f64 = 1e-13;

/// H in the coordinates of D and the multipliers, which are [`Symbol::Coordinate`] at the places of the pivots.
pub struct Stationary<'a> {
    /// The function.
    pub energy: ExprId,
    /// Its multipliers.
    pub multipliers: &'a [usize],
    /// Where the function stands.
    pub origin: Origin,
    /// The equations as they are shown, one for each multiplier.
    pub forms: &'a [String],
    /// The values of the parameters.
    pub defaults: &'a [f64],
}

/// The point at which a function is stationary.
pub struct Solution {
    /// The multipliers, functions of the other coordinates.
    pub multipliers: Vec<ExprId>,
    /// The value there.
    pub energy: ExprId,
    /// The coordinates on which the multipliers depend.
    pub mixed: Vec<usize>,
}

impl Stationary<'_> {
    /// Solves for the multipliers: `H = H_0 + <b, nu> + <G nu, nu>/2` is stationary at `nu = -G^-1 b`, with the value `H_0 + <b, nu>/2`.
    ///
    /// # Errors
    /// H has several branches, is not quadratic in them, or its quadratic part is singular.
    pub fn solve(&self, graph: &mut Graph) -> Result<Solution, Diagnostic> {
        if graph.chooses(self.energy) {
            return Err(self.branches());
        }
        let slopes: Vec<ExprId> = self
            .multipliers
            .iter()
            .map(|p| graph.derivative(self.energy, Symbol::Coordinate(*p)))
            .collect();
        let mut matrix = Vec::new();
        for (slope, form) in slopes.iter().zip(self.forms) {
            let mut row = Vec::new();
            for p in self.multipliers {
                let second = graph.derivative(*slope, Symbol::Coordinate(*p));
                row.push(constant(graph, second).ok_or_else(|| self.not_quadratic(form))?);
            }
            matrix.push(row);
        }
        let zero = graph.integer(0);
        let at_zero = |symbol| match symbol {
            Symbol::Coordinate(i) if self.multipliers.contains(&i) => Some(zero),
            _ => None,
        };
        let mut roots = slopes;
        roots.push(self.energy);
        let mut linear = graph.substitute(&roots, &at_zero);
        let rest = linear.pop().unwrap_or(zero);
        let linear: Vec<ExprId> = linear.into_iter().map(|b| collected(graph, b)).collect();
        let inverse = self.inverse(matrix, graph)?;
        let mut multipliers = Vec::new();
        for row in &inverse {
            let mut terms = Vec::new();
            for (entry, b) in row.iter().zip(&linear) {
                let entry = graph.rational_function(&entry.neg());
                terms.push(graph.mul(entry, *b));
            }
            let sum = graph.sum(&terms);
            multipliers.push(collected(graph, sum));
        }
        let half = Rational::new(1, 2).unwrap_or(Rational::ONE);
        let mut terms = vec![rest];
        for (b, nu) in linear.iter().zip(&multipliers) {
            let product = graph.mul(*b, *nu);
            terms.push(graph.scale(product, &half));
        }
        let energy = graph.sum(&terms);
        let mut mixed: Vec<usize> = linear.iter().flat_map(|b| graph.coordinates(*b)).collect();
        mixed.sort_unstable();
        mixed.dedup();
        Ok(Solution {
            multipliers,
            energy,
            mixed,
        })
    }

    /// The inverse of the quadratic part, by elimination with pivots that are not zero at the default parameters.
    fn inverse(
        &self,
        mut matrix: Vec<Vec<Fraction>>,
        graph: &mut Graph,
    ) -> Result<Vec<Vec<Fraction>>, Diagnostic> {
        let count = matrix.len();
        let budget = Budget::new(WORK);
        let size = matrix.iter().flatten();
        let size = size.fold(0.0_f64, |m, entry| m.max(self.value(entry, graph).abs()));
        let mut inverse: Vec<Vec<Fraction>> = (0..count)
            .map(|i| {
                let entry = |j| Fraction::from(Rational::from(i64::from(i == j)));
                (0..count).map(entry).collect()
            })
            .collect();
        for k in 0..count {
            let magnitude = |i: usize, graph: &mut Graph| match matrix[i][k].is_zero() {
                true => 0.0,
                false => self.value(&matrix[i][k], graph).abs(),
            };
            let found = (k..count).map(|i| (magnitude(i, graph), i));
            let (largest, pivot) = found.fold((0.0, k), |a, b| if b.0 > a.0 { b } else { a });
            // written so that a value that is no number is no pivot
            let usable = largest > SINGULAR * size;
            if !usable {
                return Err(self.singular());
            }
            matrix.swap(k, pivot);
            inverse.swap(k, pivot);
            let eliminate = |matrix: &mut Vec<Vec<Fraction>>,
                             inverse: &mut Vec<Vec<Fraction>>|
             -> Result<(), Exhausted> {
                let scale = matrix[k][k].recip(&budget)?.unwrap_or_default();
                for entry in matrix[k].iter_mut().chain(&mut inverse[k]) {
                    *entry = entry.mul(&scale, &budget)?;
                }
                for row in (0..count).filter(|row| *row != k) {
                    let factor = matrix[row][k].clone();
                    for rows in [&mut *matrix, &mut *inverse] {
                        let pivot = rows[k].clone();
                        for (entry, pivot) in rows[row].iter_mut().zip(&pivot) {
                            let product = pivot.mul(&factor, &budget)?;
                            *entry = entry.sub(&product, &budget)?;
                        }
                    }
                }
                Ok(())
            };
            eliminate(&mut matrix, &mut inverse).map_err(|Exhausted| self.too_large())?;
        }
        Ok(inverse)
    }

    fn value(&self, entry: &Fraction, graph: &mut Graph) -> f64 {
        let value = graph.rational_function(entry);
        graph.evaluate(value, &|symbol| match symbol {
            Symbol::Parameter(p) => self.defaults[p],
            _ => f64::NAN,
        })
    }

    fn branches(&self) -> Diagnostic {
        let message = "H has several branches, and beside a constraint its second derivatives do not tell whether it is quadratic";
        Diagnostic::new(Kind::Constraint, self.origin, message)
            .help("write H without `abs`, `min`, `max` and `piecewise`")
    }

    fn not_quadratic(&self, form: &str) -> Diagnostic {
        let message = format!(
            "H is not quadratic in the momenta that the constraint {form} determines, with rational functions of parameters as coefficients"
        );
        Diagnostic::new(Kind::Constraint, self.origin, message).help(
            "write the kinetic energy as a quadratic form, such as `m3^2/(2*I3)`; a coefficient that is not rational is a parameter",
        )
    }

    fn singular(&self) -> Diagnostic {
        let message = format!(
            "the constraint {} leaves the momenta open: H has no kinetic energy along it",
            self.forms.join(", ")
        );
        Diagnostic::new(Kind::Constraint, self.origin, message).help(
            "give H the inertia of each constrained direction too, such as `m3^2/(2*I3)`; the motion depends on it only where it is coupled to others",
        )
    }

    fn too_large(&self) -> Diagnostic {
        let message = "the constraints are too large to be solved exactly";
        Diagnostic::new(Kind::Limit, self.origin, message)
            .help("write the kinetic energy with fewer parameters, or with numbers")
    }
}
