//! What each kernel of a system should give, from the declaration as it was written.

use std::cell::RefCell;
use std::rc::Rc;

use crate::derivatives::{derivatives, gradient, vary};
use crate::linear::{self, Rows, add_to, dot, times};
use crate::number::Number;
use crate::system::Declared;

/// Entries of second derivatives are looked at in so many columns that their work stays below this.
const WORK: usize = 4_000_000;

/// A determinant that is below 1 by so much is not one by round-off.
const EIGENVALUES: f64 = 1e-9;

/// Energy, brackets and their derivatives at one state.
#[derive(Debug)]
pub(super) struct Derivatives {
    mu: Vec<f64>,
    velocity: Vec<f64>,
    pub(super) hamiltonian: Number,
    pub(super) energy: Number,
    pub(super) gradient: Vec<Number>,
    /// Columns of the Hessian, of those that are looked at.
    pub(super) hessian: Vec<Option<Vec<Number>>>,
    pub(super) poisson: Rows,
    /// The derivative of the Poisson matrix by each coordinate.
    slopes: Vec<Rows>,
    /// What forces and dissipation add to the field, and its derivative by each coordinate; empty where nothing is declared.
    driven: Vec<Number>,
    driven_slopes: Rows,
}

/// A column that is not looked at is `None` for each of its entries.
pub(super) type Expected = Vec<Option<Number>>;

/// The kernels of a declared system.
#[derive(Debug)]
pub(super) struct Kernels {
    pub(super) declared: Declared,
    known: RefCell<Option<Rc<Derivatives>>>,
}

pub(super) fn inputs(values: &[f64]) -> Vec<Number> {
    values.iter().map(|&value| Number::input(value)).collect()
}

/// Numbers of which one varies in the first direction.
fn once(values: &[f64], varied: usize) -> Vec<Number> {
    vary(&inputs(values), varied, 1)
}

/// The derivatives in the first direction.
fn slopes_of(numbers: &[Number]) -> Vec<Number> {
    numbers.iter().map(|number| number.slope(1)).collect()
}

/// All of them.
pub(super) fn known(values: Vec<Number>) -> Expected {
    values.into_iter().map(Some).collect()
}

/// A matrix of columns row by row.
pub(super) fn by_rows(columns: &[Option<Vec<Number>>]) -> Expected {
    let n = columns.len();
    let entry = |place: usize| Some(columns[place % n].as_ref()?[place / n].clone());
    (0..n * n).map(entry).collect()
}

impl Kernels {
    pub(super) fn new(declared: Declared) -> Self {
        Self {
            declared,
            known: RefCell::new(None),
        }
    }

    /// The derivatives at a state; `velocity` is near that of a Lagrangian.
    pub(super) fn at(&self, mu: &[f64], velocity: &[f64]) -> Rc<Derivatives> {
        let known = self.known.borrow().clone();
        if let Some(known) = known
            && known.mu == mu
            && known.velocity == velocity
        {
            return known;
        }
        let made = Rc::new(self.derivatives(mu, velocity));
        *self.known.borrow_mut() = Some(made.clone());
        made
    }

    /// Every column, or as many as the work allows, evenly spread.
    fn looked_at(&self, n: usize) -> impl Fn(usize) -> bool {
        let each = n * (self.declared.size() + n);
        let stride = (n * each).div_ceil(WORK).max(1);
        move |column| column % stride == 0
    }

    fn derivatives(&self, mu: &[f64], velocity: &[f64]) -> Derivatives {
        let n = mu.len();
        let declared = &self.declared;
        let looked_at = self.looked_at(n);
        let slope = |mu: &[Number]| gradient(mu, |mu| declared.hamiltonian(mu, velocity));
        let column = |j: usize| looked_at(j).then(|| slopes_of(&slope(&once(mu, j))));
        let slopes = |j: usize| -> Rows {
            let rows = declared.poisson(&once(mu, j));
            rows.iter().map(|row| slopes_of(row)).collect()
        };
        let driven = declared.driven(&inputs(mu), velocity);
        let driven_slope = |j: usize| -> Option<Vec<Number>> {
            let extra = declared.driven(&once(mu, j), velocity)?;
            Some(slopes_of(&extra))
        };
        Derivatives {
            driven: driven.unwrap_or_default(),
            driven_slopes: (0..n).filter_map(driven_slope).collect(),
            mu: mu.to_vec(),
            velocity: velocity.to_vec(),
            hamiltonian: declared.hamiltonian(&inputs(mu), velocity),
            energy: declared.energy(&inputs(mu), velocity),
            gradient: slope(&inputs(mu)),
            hessian: (0..n).map(column).collect(),
            poisson: declared.poisson(&inputs(mu)),
            slopes: (0..n).map(slopes).collect(),
        }
    }

    /// Value, gradient and the matrix of second derivatives of a function of n variables.
    pub(super) fn function(
        &self,
        at: &[f64],
        function: impl Fn(&[Number]) -> Number,
    ) -> (Number, Vec<Number>, Vec<Number>) {
        let at = inputs(at);
        let (slope, second) = derivatives(&at, 0, &function);
        (function(&at), slope, second.concat())
    }

    /// The gradient of a declared function of the state.
    pub(super) fn slope_of(&self, expr: &lie_syntax::ast::Expr, mu: &[f64]) -> Vec<Number> {
        gradient(&inputs(mu), |mu| self.declared.function(expr, mu))
    }

    /// `Pi(mu) xi`, linear in both.
    pub(super) fn ad_star(&self, xi: &[f64], mu: &[f64]) -> Vec<Number> {
        times(&self.declared.poisson(&inputs(mu)), &inputs(xi))
    }

    /// Columns `Pi(e_k) xi`.
    fn ad_star_columns(&self, xi: &[f64]) -> Rows {
        let n = xi.len();
        let column = |k: usize| {
            let mut unit = vec![0.0; n];
            unit[k] = 1.0;
            self.ad_star(xi, &unit)
        };
        (0..n).map(column).collect()
    }

    /// The matrix of `ad*_xi`, by rows.
    pub(super) fn ad_star_matrix(&self, xi: &[f64]) -> Vec<Number> {
        let columns = self.ad_star_columns(xi);
        let n = columns.len();
        (0..n * n).map(|p| columns[p % n][p / n].clone()).collect()
    }

    /// `<e_k, [xi, eta]> = <ad*_xi e_k, eta>`
    pub(super) fn ad(&self, xi: &[f64], eta: &[f64]) -> Vec<Number> {
        times(&self.ad_star_columns(xi), &inputs(eta))
    }

    /// Whether the matrix A of an element shows an eigenvalue that is not imaginary: with imaginary ones alone, which come in
    /// pairs, `det (1 - s A)` is at least 1 for every s.
    pub(super) fn has_real_eigenvalue(&self, xi: &[f64]) -> Option<bool> {
        let matrices = self.declared.matrices()?;
        let matrix = element(&matrices, xi);
        let entries = matrix.iter().flatten().map(|entry| entry.value().abs());
        let largest = entries.fold(f64::MIN_POSITIVE, f64::max);
        let shows = |s: f64| {
            let row = |(r, row): (usize, &Vec<Number>)| -> Vec<f64> {
                let entry = |(c, a): (usize, &Number)| {
                    f64::from(u8::from(r == c)) - s / largest * a.value()
                };
                row.iter().enumerate().map(entry).collect()
            };
            let shifted = matrix.iter().enumerate().map(row).collect();
            linear::determinant(shifted) < 1.0 - EIGENVALUES
        };
        Some([0.5, -0.5, 1.0, 2.0].into_iter().any(shows))
    }

    /// `<mu, (x e_b z + z e_b x)/2>` by products of the declared matrices.
    pub(super) fn triple(&self, x: &[f64], z: &[f64], mu: &[f64]) -> Option<Vec<Number>> {
        let matrices = self.declared.matrices()?;
        let (x, z, mu) = (element(&matrices, x), element(&matrices, z), inputs(mu));
        let product = |a: &Rows, e: &Rows, b: &Rows| linear::product(&linear::product(a, e), b);
        let half = Number::rounded(0.5, 0.0);
        let component = |e: &Rows| {
            let (xez, zex) = (product(&x, e, &z), product(&z, e, &x));
            let rows = xez.iter().zip(&zex);
            let sum =
                rows.map(|(a, b)| a.iter().zip(b).map(|(a, b)| half.mul(&a.add(b))).collect());
            let coordinates = linear::coordinates(&matrices, &sum.collect());
            dot(&coordinates, &mu)
        };
        Some(matrices.iter().map(component).collect())
    }
}

/// The matrix of an element of the algebra.
fn element(matrices: &[Rows], coordinates: &[f64]) -> Rows {
    let coordinates = inputs(coordinates);
    let size = matrices.first().map_or(0, Vec::len);
    let entry = |r: usize, c: usize| {
        let terms = matrices.iter().zip(&coordinates);
        Number::sum(terms.map(|(m, x)| m[r][c].mul(x)))
    };
    let row = |r| (0..size).map(|c| entry(r, c)).collect();
    (0..size).map(row).collect()
}

impl Derivatives {
    /// `d(Pi xi)_i/dmu_j`
    pub(super) fn poisson_slope(&self, xi: &[f64]) -> Expected {
        let xi = inputs(xi);
        let columns = self.slopes.iter().map(|slope| Some(times(slope, &xi)));
        by_rows(&columns.collect::<Vec<_>>())
    }

    pub(super) fn field(&self) -> Expected {
        let mut field = times(&self.poisson, &self.gradient);
        add_to(&mut field, &self.driven);
        known(field)
    }

    /// `dPi/dmu_j grad H + Pi H''_j`
    pub(super) fn jacobian(&self) -> Expected {
        let column = |j: usize| -> Option<Vec<Number>> {
            let mut column = times(&self.poisson, self.hessian[j].as_ref()?);
            add_to(&mut column, &times(&self.slopes[j], &self.gradient));
            let extra = self.driven_slopes.get(j);
            add_to(&mut column, extra.map_or(&[], Vec::as_slice));
            Some(column)
        };
        by_rows(&(0..self.mu.len()).map(column).collect::<Vec<_>>())
    }
}
