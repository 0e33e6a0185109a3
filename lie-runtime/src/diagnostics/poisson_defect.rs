//! The derivative of a step, and how far a step is from a Poisson map.

use super::{AnyMethod, AnyStepper};
use crate::matrix::SquareMatrix;
use crate::methods::{Method, StepFailure};
use crate::newton::NewtonOptions;
use crate::poisson::Poisson;
use crate::scalar::{Dual, Scalar};
use crate::state::{State, Unknown};

/// A step and its derivative.
#[derive(Clone, Debug)]
pub struct TangentMap<S> {
    /// The derivative: row i, column j is `dPhi_i/dmu_j`.
    pub derivative: Vec<Vec<S>>,
    /// The state at the end of the step.
    pub end: Vec<S>,
}

/// The derivative at mu of one step of size h, column by column by dual numbers through the step and
/// its solver, which goes on until the derivatives have converged too.
///
/// # Errors
/// The [`StepFailure`] of the step.
pub fn tangent_map<S, P>(
    system: &P,
    method: &dyn AnyMethod<Dual<S>, P>,
    h: S,
    mu: &[S],
    newton: &NewtonOptions,
) -> Result<TangentMap<S>, StepFailure>
where
    S: Scalar,
    P: Poisson<Dual<S>>,
{
    let mut stepper = method.any_stepper(system, Dual::constant_of(h), newton);
    through(system, &mut *stepper, mu)
}

fn through<S: Scalar, P: Poisson<Dual<S>>>(
    system: &P,
    stepper: &mut dyn AnyStepper<Dual<S>, P::State>,
    mu: &[S],
) -> Result<TangentMap<S>, StepFailure> {
    let mut state = system.zero_state();
    let mut map = TangentMap {
        derivative: vec![vec![S::zero(); system.dimension()]; system.dimension()],
        end: vec![S::zero(); system.dimension()],
    };
    // norms see derivatives too: seeds of the size of the state keep the two in proportion
    let size = mu
        .iter()
        .fold(S::zero(), |size, entry| size.max(entry.abs()));
    let size = S::select(size.less_equal(S::zero()), S::one(), size);
    for direction in 0..system.dimension() {
        for (index, (entry, &value)) in state.as_mut_slice().iter_mut().zip(mu).enumerate() {
            let seed = if index == direction { size } else { S::zero() };
            *entry = Dual::new(value, seed);
        }
        stepper.step(&mut state)?;
        for (row, tangent) in map.derivative.iter_mut().enumerate() {
            tangent[direction] = state.entry(row).derivative / size;
            map.end[row] = state.entry(row).value;
        }
    }
    Ok(map)
}

impl<S: Scalar> TangentMap<S> {
    /// The largest entry of `D Pi(mu) D^T - Pi(Phi(mu))`.
    pub fn poisson_defect<P: Poisson<Dual<S>>>(&self, system: &P, mu: &[S]) -> S {
        let before = poisson_matrix(system, mu);
        let after = poisson_matrix(system, &self.end);
        let mut defect = S::zero();
        let n = system.dimension();
        let mut half = vec![vec![S::zero(); n]; n];
        for (row, half) in half.iter_mut().enumerate() {
            for (j, entry) in half.iter_mut().enumerate() {
                for (i, before) in before.iter().enumerate() {
                    *entry += self.derivative[row][i] * before[j];
                }
            }
        }
        for (half, after) in half.iter().zip(&after) {
            for (derivative, &after) in self.derivative.iter().zip(after) {
                let pairs = half.iter().zip(derivative);
                let sum = pairs.fold(-after, |sum, (&a, &b)| sum + a * b);
                defect = defect.max(sum.abs());
            }
        }
        defect
    }

    /// The largest absolute sum of a row of the derivative.
    pub fn norm(&self) -> S {
        self.derivative.iter().fold(S::zero(), |norm, row| {
            norm.max(row.iter().fold(S::zero(), |sum, entry| sum + entry.abs()))
        })
    }
}

fn poisson_matrix<S: Scalar, P: Poisson<Dual<S>>>(system: &P, mu: &[S]) -> Vec<Vec<S>> {
    let mut state = system.zero_state();
    for (entry, &value) in state.as_mut_slice().iter_mut().zip(mu) {
        *entry = Dual::constant_of(value);
    }
    let mut matrix = system.zero_jacobian();
    system.poisson_matrix(&state, &mut matrix);
    let row = |i| {
        (0..system.dimension())
            .map(|j| matrix.get(i, j).value)
            .collect()
    };
    (0..system.dimension()).map(row).collect()
}

/// The largest entry of `D Pi(mu) D^T - Pi(Phi(mu))`, with Phi one step of size h and D its
/// derivative at mu, by dual numbers through the step and its solver: zero to round-off for a
/// Poisson map, O(h^(p+1)) otherwise.
///
/// # Errors
/// The [`StepFailure`] of the step.
pub fn poisson_defect<S, P, M>(
    system: &P,
    method: &M,
    h: S,
    mu: &[S],
    newton: &NewtonOptions,
) -> Result<S, StepFailure>
where
    S: Scalar,
    P: Poisson<Dual<S>>,
    M: Method<Dual<S>, P>,
{
    let mut stepper = method.stepper(system, Dual::constant_of(h), newton);
    let map = through(system, &mut stepper, mu)?;
    Ok(map.poisson_defect(system, mu))
}
