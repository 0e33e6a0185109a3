//! What each kernel of a system should give, from the declaration as it was written.

use std::cell::RefCell;
use std::rc::Rc;

use crate::linear;
use crate::number::{Jet, Number, Rounded};
use crate::system::Declared;

/// Entries of second derivatives are looked at in so many columns that their work stays below this.
const WORK: usize = 4_000_000;

/// A determinant that is below 1 by so much is not one by round-off.
const EIGENVALUES: f64 = 1e-9;

type Once = Jet<Rounded>;
type Twice = Jet<Jet<Rounded>>;

/// Energy, brackets and their derivatives at one state.
#[derive(Debug)]
pub(super) struct Derivatives {
    mu: Vec<f64>,
    velocity: Vec<f64>,
    hamiltonian: Rounded,
    energy: Rounded,
    gradient: Vec<Rounded>,
    /// Columns of the Hessian, of those that are looked at.
    hessian: Vec<Option<Vec<Rounded>>>,
    poisson: Vec<Vec<Rounded>>,
    /// The derivative of the Poisson matrix by each coordinate.
    slopes: Vec<Vec<Vec<Rounded>>>,
    /// What forces and dissipation add to the field, and its derivative by each coordinate; empty where nothing is declared.
    driven: Vec<Rounded>,
    driven_slopes: Vec<Vec<Rounded>>,
}

/// A column that is not looked at is `None` for each of its entries.
pub(super) type Expected = Vec<Option<Rounded>>;

/// The kernels of a declared system.
#[derive(Debug)]
pub(super) struct Kernels {
    pub(super) declared: Declared,
    known: RefCell<Option<Rc<Derivatives>>>,
}

pub(super) fn inputs(values: &[f64]) -> Vec<Rounded> {
    values.iter().map(|&value| Rounded::input(value)).collect()
}

fn once(values: &[f64], varied: usize) -> Vec<Once> {
    let variable = |(k, &value): (usize, &f64)| Jet::variable(Rounded::input(value), k == varied);
    values.iter().enumerate().map(variable).collect()
}

fn twice(values: &[f64], first: usize, second: usize) -> Vec<Twice> {
    let variable = |(k, &value): (usize, &f64)| {
        let change = Rounded::integer(i32::from(k == second));
        Jet {
            at: Jet::variable(Rounded::input(value), k == first),
            slope: Jet::variable(change, false),
        }
    };
    values.iter().enumerate().map(variable).collect()
}

fn times(rows: &[Vec<Rounded>], vector: &[Rounded]) -> Vec<Rounded> {
    let row = |row: &Vec<Rounded>| Rounded::sum(row.iter().zip(vector).map(|(a, b)| a.mul(b)));
    rows.iter().map(row).collect()
}

/// All of them.
pub(super) fn known(values: Vec<Rounded>) -> Expected {
    values.into_iter().map(Some).collect()
}

/// A matrix of columns row by row.
fn by_rows(columns: &[Option<Vec<Rounded>>]) -> Expected {
    let n = columns.len();
    let entry = |place: usize| columns[place % n].as_ref().map(|column| column[place / n]);
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
        let slope = |i: usize| declared.hamiltonian(&once(mu, i), velocity).slope;
        let column = |j: usize| -> Option<Vec<Rounded>> {
            let second = |i| declared.hamiltonian(&twice(mu, i, j), velocity).slope.slope;
            looked_at(j).then(|| (0..n).map(second).collect())
        };
        let slopes = |j: usize| -> Vec<Vec<Rounded>> {
            let rows = declared.poisson(&once(mu, j));
            let slope = |row: Vec<Once>| row.into_iter().map(|entry| entry.slope).collect();
            rows.into_iter().map(slope).collect()
        };
        let driven = declared.driven(&inputs(mu), velocity);
        let driven_slope = |j: usize| -> Option<Vec<Rounded>> {
            let extra = declared.driven(&once(mu, j), velocity)?;
            Some(extra.into_iter().map(|entry| entry.slope).collect())
        };
        Derivatives {
            driven: driven.unwrap_or_default(),
            driven_slopes: (0..n).filter_map(driven_slope).collect(),
            mu: mu.to_vec(),
            velocity: velocity.to_vec(),
            hamiltonian: declared.hamiltonian(&inputs(mu), velocity),
            energy: declared.energy(&inputs(mu), velocity),
            gradient: (0..n).map(slope).collect(),
            hessian: (0..n).map(column).collect(),
            poisson: declared.poisson(&inputs(mu)),
            slopes: (0..n).map(slopes).collect(),
        }
    }

    /// Value, gradient and the matrix of second derivatives of a function of n variables.
    pub(super) fn function(
        &self,
        at: &[f64],
        function: impl Fn(&[Twice]) -> Twice,
    ) -> (Rounded, Vec<Rounded>, Vec<Rounded>) {
        let n = at.len();
        let value = function(&twice(at, n, n)).at.at;
        let gradient = (0..n).map(|i| function(&twice(at, i, n)).at.slope);
        let places = (0..n * n).map(|place| (place / n, place % n));
        let second = places.map(|(i, j)| function(&twice(at, i, j)).slope.slope);
        (value, gradient.collect(), second.collect())
    }

    /// The gradient of a declared function of the state.
    pub(super) fn slope_of(&self, expr: &lie_syntax::ast::Expr, mu: &[f64]) -> Vec<Rounded> {
        let n = mu.len();
        let slope = |i| self.declared.function(expr, &once(mu, i)).slope;
        (0..n).map(slope).collect()
    }

    /// `Pi(mu) xi`, linear in both.
    pub(super) fn ad_star(&self, xi: &[f64], mu: &[f64]) -> Vec<Rounded> {
        times(&self.declared.poisson(&inputs(mu)), &inputs(xi))
    }

    /// Columns `Pi(e_k) xi`.
    fn ad_star_columns(&self, xi: &[f64]) -> Vec<Vec<Rounded>> {
        let n = xi.len();
        let column = |k: usize| {
            let mut unit = vec![0.0; n];
            unit[k] = 1.0;
            self.ad_star(xi, &unit)
        };
        (0..n).map(column).collect()
    }

    /// The matrix of `ad*_xi`, by rows.
    pub(super) fn ad_star_matrix(&self, xi: &[f64]) -> Vec<Rounded> {
        let columns = self.ad_star_columns(xi);
        let n = columns.len();
        (0..n * n).map(|p| columns[p % n][p / n]).collect()
    }

    /// `<e_k, [xi, eta]> = <ad*_xi e_k, eta>`
    pub(super) fn ad(&self, xi: &[f64], eta: &[f64]) -> Vec<Rounded> {
        let eta = inputs(eta);
        let pair =
            |column: Vec<Rounded>| Rounded::sum(column.iter().zip(&eta).map(|(a, b)| a.mul(b)));
        self.ad_star_columns(xi).into_iter().map(pair).collect()
    }

    /// Whether the matrix A of an element shows an eigenvalue that is not imaginary: with imaginary ones alone, which come in
    /// pairs, `det (1 - s A)` is at least 1 for every s.
    pub(super) fn has_real_eigenvalue(&self, xi: &[f64]) -> Option<bool> {
        let matrices = self.declared.matrices::<Rounded>()?;
        let matrix = element(&matrices, xi);
        let entries = matrix.iter().flatten().map(|entry| entry.value.abs());
        let largest = entries.fold(f64::MIN_POSITIVE, f64::max);
        let shows = |s: f64| {
            let row = |(r, row): (usize, &Vec<Rounded>)| -> Vec<f64> {
                let entry =
                    |(c, a): (usize, &Rounded)| f64::from(u8::from(r == c)) - s / largest * a.value;
                row.iter().enumerate().map(entry).collect()
            };
            let shifted = matrix.iter().enumerate().map(row).collect();
            linear::determinant(shifted) < 1.0 - EIGENVALUES
        };
        Some([0.5, -0.5, 1.0, 2.0].into_iter().any(shows))
    }

    /// `<mu, (x e_b z + z e_b x)/2>` by products of the declared matrices.
    pub(super) fn triple(&self, x: &[f64], z: &[f64], mu: &[f64]) -> Option<Vec<Rounded>> {
        let matrices = self.declared.matrices::<Rounded>()?;
        let (x, z, mu) = (element(&matrices, x), element(&matrices, z), inputs(mu));
        let product =
            |a: &linear::Rows<Rounded>, e: &linear::Rows<Rounded>, b: &linear::Rows<Rounded>| {
                linear::product(&linear::product(a, e), b)
            };
        let half = Rounded::rounded(0.5, 0.0);
        let component = |e: &linear::Rows<Rounded>| {
            let (xez, zex) = (product(&x, e, &z), product(&z, e, &x));
            let rows = xez.iter().zip(&zex);
            let sum =
                rows.map(|(a, b)| a.iter().zip(b).map(|(a, b)| half.mul(&a.add(b))).collect());
            let coordinates = linear::coordinates(&matrices, &sum.collect());
            Rounded::sum(coordinates.iter().zip(&mu).map(|(c, mu)| c.mul(mu)))
        };
        Some(matrices.iter().map(component).collect())
    }
}

/// The matrix of an element of the algebra.
fn element(matrices: &[linear::Rows<Rounded>], coordinates: &[f64]) -> linear::Rows<Rounded> {
    let coordinates = inputs(coordinates);
    let size = matrices.first().map_or(0, Vec::len);
    let entry = |r: usize, c: usize| {
        let terms = matrices.iter().zip(&coordinates);
        Rounded::sum(terms.map(|(m, x)| m[r][c].mul(x)))
    };
    let row = |r| (0..size).map(|c| entry(r, c)).collect();
    (0..size).map(row).collect()
}

impl Derivatives {
    pub(super) fn hamiltonian(&self) -> Expected {
        vec![Some(self.hamiltonian)]
    }

    pub(super) fn energy(&self) -> Expected {
        vec![Some(self.energy)]
    }

    pub(super) fn gradient(&self) -> Expected {
        known(self.gradient.clone())
    }

    pub(super) fn hessian(&self) -> Expected {
        by_rows(&self.hessian)
    }

    pub(super) fn poisson(&self) -> Expected {
        known(self.poisson.concat())
    }

    /// `d(Pi xi)_i/dmu_j`
    pub(super) fn poisson_slope(&self, xi: &[f64]) -> Expected {
        let xi = inputs(xi);
        let columns = self.slopes.iter().map(|slope| Some(times(slope, &xi)));
        by_rows(&columns.collect::<Vec<_>>())
    }

    pub(super) fn field(&self) -> Expected {
        let mut field = times(&self.poisson, &self.gradient);
        for (slot, extra) in field.iter_mut().zip(&self.driven) {
            *slot = slot.add(extra);
        }
        known(field)
    }

    /// `dPi/dmu_j grad H + Pi H''_j`
    pub(super) fn jacobian(&self) -> Expected {
        let columns = self
            .hessian
            .iter()
            .zip(&self.slopes)
            .map(|(second, slope)| {
                let bent = times(&self.poisson, second.as_ref()?);
                let turned = times(slope, &self.gradient);
                Some(bent.iter().zip(&turned).map(|(a, b)| a.add(b)).collect())
            });
        let mut columns: Vec<Option<Vec<Rounded>>> = columns.collect();
        for (column, extra) in columns.iter_mut().zip(&self.driven_slopes) {
            let entries = column.iter_mut().flatten().zip(extra);
            entries.for_each(|(entry, extra)| *entry = entry.add(extra));
        }
        by_rows(&columns)
    }
}
