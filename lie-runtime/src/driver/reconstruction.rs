//! The motion on the group, together with the motion of mu.
//!
//! ```math
//! \dot g = g\, \xi, \quad \xi = \nabla H(\mu), \qquad g_{k+1} = g_k\, \tau(h \xi_k), \qquad
//! \mu_{k+1} = \mathrm{Ad}^*_{\tau(h \xi_k)}\, \mu_k
//! ```
//!
//! A method of coadjoint form says by which factors it went, and then the spatial momentum
//! `$\mathrm{Ad}^*_{g^{-1}} \mu$` is constant to round-off. Any other method gives its velocities `h grad H` at its
//! stages, and the same Runge–Kutta method is applied to `$\dot g = g\, \xi(t)$`: in the entries of the matrices
//! where these are closed under `(abc + cba)/2`, for then Gauss methods stay in the group; elsewhere in
//! exponential coordinates, `$\dot\theta = \mathrm{dexp}_{-\theta}^{-1} \xi$`. The order is that of the method.
//!
//! References: J. E. Marsden, S. Pekarsky, S. Shkoller, "Discrete Euler–Poincaré and Lie–Poisson equations",
//! Nonlinearity 12 (1999) 1647–1662,
//! [doi:10.1088/0951-7715/12/6/314](https://doi.org/10.1088/0951-7715/12/6/314);
//! E. Hairer, G. Vilmart, "Preprocessed discrete Moser–Veselov algorithm for the full dynamics of a rigid
//! body", Journal of Physics A 39 (2006) 13225–13235,
//! [doi:10.1088/0305-4470/39/42/006](https://doi.org/10.1088/0305-4470/39/42/006).
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

mod following;

use super::element::Element;
use super::group_matrix::{GroupMatrix, exponential, rational};
use super::observer::{Motion, Observer, Progress};
use crate::generic::{gauss_ratio, gauss_weight};
use crate::methods::{Retraction, RungeKutta};
use crate::scalar::{Scalar, largest};
use crate::state::State;
use crate::structure::MatrixGroup;
pub use crate::structure::{Chart, EulerSequence};
use core::ops::ControlFlow;

/// `B_k/k!` of the even Bernoulli numbers from `B_2` on: the series of `dexp^-1` beyond `1 - ad/2`.
const BERNOULLI: [(f64, f64); 5] = [
    (1.0, 12.0),
    (-1.0, 720.0),
    (1.0, 30_240.0),
    (-1.0, 1_209_600.0),
    (1.0, 47_900_160.0),
];
/// Sweeps of the implicit equations in exponential coordinates.
const SWEEPS: usize = 60;

/// Observes a run and keeps the group element; see the [module's text](self).
///
/// ```
/// use lie_runtime::driver::{Chart, Reconstruction};
/// use lie_runtime::prelude::*;
/// # include!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/systems/rigid_body.rs"));
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let system = RigidBody::<f64>::default();
/// let mut attitude = Reconstruction::new(&system, Chart::Quaternion);
/// let problem = Problem::new(system, [0.8, 0.1, 0.6], (0.0, 10.0));
/// solve_observed(&problem, LieMidpoint::exp(), &Options::new(0.1), &mut attitude)?;
/// let q = attitude.rows().last().unwrap();
/// assert!((q.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-15);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Reconstruction<S, V> {
    element: Element<S>,
    /// Where a shorter step to a row off the grid began.
    kept: Option<Element<S>>,
    velocities: Vec<V>,
    rows: Vec<Vec<S>>,
}

impl<S: Scalar, V: State<S>> Reconstruction<S, V> {
    /// Beginning at the identity.
    pub fn new<P: MatrixGroup<S, State = V>>(system: &P, chart: Chart) -> Self {
        Self {
            element: Element::identity(&system.group(), chart),
            kept: None,
            velocities: Vec::new(),
            rows: Vec::new(),
        }
    }

    /// The same beginning at a group element, given by its entries in the chart: a matrix by rows, a quaternion that is
    /// normalised, or Euler angles of any size; none if they are not as many.
    ///
    /// The element g0 stands on the left of the motion from the identity on, `g = g0 g_id`, of a right-invariant system on
    /// its right. A matrix that ought to be orthogonal is made so, see [`Reconstruction::at_matrix`].
    ///
    /// ```
    /// use core::f64::consts::PI;
    /// use lie_runtime::driver::{Chart, EulerSequence, Reconstruction};
    /// use lie_runtime::prelude::*;
    /// # include!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/systems/rigid_body.rs"));
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let system = RigidBody::<f64>::default();
    /// let chart = Chart::Euler(EulerSequence::Zxz);
    /// let mut angles = Reconstruction::new(&system, chart).at(&[0.1, PI / 3.0, 0.2]).unwrap();
    /// let problem = Problem::new(system, [0.8, 0.1, 0.6], (0.0, 10.0));
    /// solve_observed(&problem, LieMidpoint::exp(), &Options::new(0.1), &mut angles)?;
    /// assert_eq!(angles.rows()[0], [0.1, PI / 3.0, 0.2]);
    /// # Ok(())
    /// # }
    /// ```
    pub fn at(mut self, element: &[S]) -> Option<Self> {
        self.element.set(element)?;
        Some(self)
    }

    /// The same beginning at a group element, given by its matrix by rows in any chart, such as `initial_attitude()` of a
    /// system that declares it; none if it has another size.
    ///
    /// Two steps of Newton's iteration take the matrix of an orthogonal group to the nearest orthogonal one, from 1e-4 to
    /// round-off. Of the two quaternions of a rotation that with a positive real part is taken, and the Euler angles are those of
    /// [`EulerSequence::angles`].
    pub fn at_matrix(mut self, rows: &[S]) -> Option<Self> {
        self.element.set_matrix(rows)?;
        Some(self)
    }

    /// The same going on where another one was, by its [`memory`](Reconstruction::memory), bit by bit; none if that is one of
    /// another chart.
    pub fn beginning_at(mut self, memory: &[S]) -> Option<Self> {
        self.element.recall(memory)?;
        Some(self)
    }

    /// From what another one can go on: the group element in the chart, of Euler angles the quaternion before them.
    pub fn memory(&self) -> Vec<S> {
        self.element.memory()
    }

    /// The group element where the run is, in the chart.
    pub fn element(&self) -> &[S] {
        self.element.entries()
    }

    /// The group element at each saved state, in the chart.
    pub fn rows(&self) -> &[Vec<S>] {
        &self.rows
    }

    fn take<P: MatrixGroup<S, State = V>>(&mut self, system: &P, motion: &Motion<'_, V>) {
        match *motion {
            Motion::Factor(retraction, xi) => {
                let turn: fn(f64) -> f64 = match retraction {
                    // the Cayley map turns by less than the length of its argument
                    Retraction::Cayley => |angle| 2.0 * (angle / 2.0).atan(),
                    Retraction::Exp | Retraction::SecondKind | Retraction::Declared => {
                        |angle| angle
                    }
                };
                self.follow(system, std::slice::from_ref(xi), turn);
                let factor = match retraction {
                    Retraction::Exp => exponential(&represent(system, xi)),
                    Retraction::Cayley => rational(&represent(system, xi)),
                    Retraction::Declared => {
                        let mut factor = GroupMatrix::zero(system.group().size);
                        system.retract(xi, factor.entries_mut());
                        factor
                    }
                    Retraction::SecondKind => {
                        let mut single = xi.clone();
                        let mut factor = GroupMatrix::identity(system.group().size);
                        for index in 0..system.dimension() {
                            single.fill(S::zero());
                            single.as_mut_slice()[index] = xi.as_slice()[index];
                            factor = factor.times(&exponential(&represent(system, &single)));
                        }
                        factor
                    }
                };
                self.element.advance(&system.group(), &factor);
            }
            Motion::Velocity(method, stage, xi) => {
                if stage.index == 0 {
                    self.velocities.clear();
                }
                let mut velocity = xi.clone();
                if method == RungeKutta::Gauss {
                    let weight = gauss_weight::<S>(stage.count, stage.index);
                    for entry in velocity.as_mut_slice() {
                        *entry *= weight;
                    }
                }
                self.velocities.push(velocity);
                if self.velocities.len() == stage.count {
                    let parts = match method {
                        RungeKutta::Gauss => self.velocities.clone(),
                        _ => vec![self.total(system, method)],
                    };
                    self.follow(system, &parts, |angle| angle);
                    let factor = self.collocate(system, method);
                    self.element.advance(&system.group(), &factor);
                }
            }
        }
    }

    /// The factor of one step of a Runge–Kutta method with the velocities at its stages.
    fn collocate<P>(&self, system: &P, method: RungeKutta) -> GroupMatrix<S>
    where
        P: MatrixGroup<S, State = V>,
    {
        let count = self.velocities.len();
        let (a, b) = coefficients::<S>(method, count);
        if method == RungeKutta::Gauss
            && system.group().closed
            && let Some(factor) = self.in_entries(system, &a, &b)
        {
            return factor;
        }
        // K_i = dexp^-1_(-theta_i) xi_i, theta_i = sum_j a_ij K_j
        let mut slopes = self.velocities.clone();
        let mut theta = system.zero_state();
        let sweeps = if method == RungeKutta::Gauss {
            SWEEPS
        } else {
            1
        };
        for _ in 0..sweeps {
            let mut change = S::zero();
            let mut scale = S::zero();
            for stage in 0..count {
                combine(&a[stage], &slopes, &mut theta);
                let slope = inverse_tangent(system, &theta, &self.velocities[stage]);
                for (old, &new) in slopes[stage].as_slice().iter().zip(slope.as_slice()) {
                    change = change.max((*old - new).magnitude());
                    scale = scale.max(new.magnitude());
                }
                slopes[stage] = slope;
            }
            if largest(change) <= largest(S::epsilon() * scale) {
                break;
            }
        }
        combine(&b, &slopes, &mut theta);
        exponential(&represent(system, &theta))
    }

    /// `X_i = 1 + sum_j a_ij X_j rho(xi_j)`, then `1 + sum_i b_i X_i rho(xi_i)`; none where a pivot is small.
    fn in_entries<P>(&self, system: &P, a: &[Vec<S>], b: &[S]) -> Option<GroupMatrix<S>>
    where
        P: MatrixGroup<S, State = V>,
    {
        let (count, size) = (self.velocities.len(), system.group().size);
        let motions: Vec<GroupMatrix<S>> = self
            .velocities
            .iter()
            .map(|xi| represent(system, xi))
            .collect();
        let mut whole = GroupMatrix::<S>::identity(count * size);
        for (i, row) in a.iter().enumerate() {
            for (j, motion) in motions.iter().enumerate() {
                for r in 0..size {
                    for c in 0..size {
                        let (r, c, entry) = (i * size + r, j * size + c, motion.at(c, r));
                        whole.set_at(r, c, whole.at(r, c) - row[j] * entry);
                    }
                }
            }
        }
        let stages = whole.solve_identities(size)?;
        let mut factor = GroupMatrix::identity(size);
        for (i, motion) in motions.iter().enumerate() {
            // the solution holds the transposes
            for (r, stages) in stages.iter().enumerate() {
                for c in 0..size {
                    let mut sum = S::zero();
                    for (k, &entry) in stages[i * size..][..size].iter().enumerate() {
                        sum += entry * motion.at(k, c);
                    }
                    factor.set_at(r, c, factor.at(r, c) + b[i] * sum);
                }
            }
        }
        Some(factor)
    }
}

impl<S: Scalar, P: MatrixGroup<S>> Observer<S, P> for Reconstruction<S, P::State> {
    fn follows_motion(&self) -> bool {
        true
    }

    fn start(&mut self, _system: &P, _progress: Progress, _mu: &P::State) {
        self.rows.clear();
    }

    fn motion(&mut self, system: &P, motion: &Motion<'_, P::State>) {
        self.take(system, motion);
    }

    fn group_element(&self) -> &[S] {
        self.element.entries()
    }

    fn leave_grid(&mut self) {
        self.kept = Some(self.element.clone());
    }

    fn return_to_grid(&mut self) {
        if let Some(element) = self.kept.take() {
            self.element = element;
        }
    }

    fn row(&mut self, _system: &P, _time: f64, _mu: &P::State) -> ControlFlow<()> {
        self.rows.push(self.element().to_vec());
        ControlFlow::Continue(())
    }
}

/// `rho(xi)`
fn represent<S: Scalar, P: MatrixGroup<S>>(_system: &P, xi: &P::State) -> GroupMatrix<S> {
    let mut matrix = GroupMatrix::zero(_system.group().size);
    for (entries, &coordinate) in _system.group().matrices.iter().zip(xi.as_slice()) {
        for entry in *entries {
            let (row, column) = entry.place();
            let sum = matrix.at(row, column) + entry.value::<S>() * coordinate;
            matrix.set_at(row, column, sum);
        }
    }
    matrix
}

/// `dexp^-1_(-theta) xi = xi + [theta, xi]/2 + sum_k B_2k/(2k)! ad_theta^2k xi`
fn inverse_tangent<S, P>(system: &P, theta: &P::State, xi: &P::State) -> P::State
where
    S: Scalar,
    P: MatrixGroup<S>,
{
    let mut term = system.zero_state();
    let mut next = system.zero_state();
    let mut sum = xi.clone();
    system.ad(theta, xi, &mut term);
    sum.axpy(S::ratio(1.0, 2.0), &term);
    for (numerator, denominator) in BERNOULLI {
        system.ad(theta, &term, &mut next);
        sum.axpy(S::ratio(numerator, denominator), &next);
        system.ad(theta, &next, &mut term);
    }
    sum
}

/// The matrix and the weights; of a Gauss method those for velocities times their weights.
fn coefficients<S: Scalar>(method: RungeKutta, count: usize) -> (Vec<Vec<S>>, Vec<S>) {
    let number = |&(numerator, denominator): &(f64, f64)| S::ratio(numerator, denominator);
    match method {
        RungeKutta::Explicit { stages, weights } => {
            let mut a = vec![vec![S::zero(); count]; count];
            for (row, stage) in a.iter_mut().skip(1).zip(stages) {
                for (entry, weight) in row.iter_mut().zip(*stage) {
                    *entry = number(weight);
                }
            }
            (a, weights.iter().map(number).collect())
        }
        RungeKutta::Gauss => {
            let row = |i| (0..count).map(|j| gauss_ratio(count, i, j)).collect();
            ((0..count).map(row).collect(), vec![S::one(); count])
        }
    }
}

fn combine<S: Scalar, V: State<S>>(weights: &[S], slopes: &[V], out: &mut V) {
    out.fill(S::zero());
    for (&weight, slope) in weights.iter().zip(slopes) {
        out.axpy(weight, slope);
    }
}
