//! How far a step is from a Poisson map.

use crate::matrix::SquareMatrix;
use crate::methods::{Method, StepFailure, Stepper};
use crate::newton::NewtonOptions;
use crate::poisson::Poisson;
use crate::scalar::{Dual, Scalar};
use crate::state::{State, Unknown};

/// The largest entry of `D Pi(mu) D^T - Pi(Phi(mu))`, with Phi one step of size h and D its
/// derivative at mu, by dual numbers through the step and its solver: zero to round-off for a
/// Poisson map, O(h^(p+1)) otherwise.
///
/// The solver goes on until the derivatives have converged too.
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
    let mut start = system.zero_state();
    let mut end = system.zero_state();
    let mut tangent = vec![vec![S::zero(); P::DIM]; P::DIM];
    // norms see derivatives too: seeds of the size of the state keep the two in proportion
    let size = mu
        .iter()
        .fold(S::zero(), |size, entry| size.max(entry.abs()));
    let size = S::select(size.less_equal(S::zero()), S::one(), size);
    for direction in 0..P::DIM {
        for (index, (entry, &value)) in start.as_mut_slice().iter_mut().zip(mu).enumerate() {
            let seed = if index == direction { size } else { S::zero() };
            *entry = Dual::new(value, seed);
        }
        end.copy_from(&start);
        stepper.step(&mut end, &mut ())?;
        for (row, tangent) in tangent.iter_mut().enumerate() {
            tangent[direction] = end.entry(row).derivative / size;
        }
    }
    let mut before = system.zero_jacobian();
    system.poisson_matrix(&start, &mut before);
    let mut after = system.zero_jacobian();
    system.poisson_matrix(&end, &mut after);
    let mut defect = S::zero();
    for row in 0..P::DIM {
        for column in 0..P::DIM {
            let mut sum = -after.get(row, column).value;
            for i in 0..P::DIM {
                for j in 0..P::DIM {
                    sum += tangent[row][i] * before.get(i, j).value * tangent[column][j];
                }
            }
            defect = defect.max(sum.abs());
        }
    }
    Ok(defect)
}
