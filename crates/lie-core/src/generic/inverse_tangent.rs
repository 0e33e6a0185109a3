//! The inverse tangents of the retractions, dual: what takes the derivative of a function of coordinates
//! to the unit of the group.

use super::series::{Scratch, dexp_dual_in};
use crate::matrix::SquareMatrix;
use crate::newton::exchanging;
use crate::poisson::{CayleyPoisson, LiePoisson};
use crate::scalar::Scalar;
use crate::state::State;

/// The inverse dual of the right-trivialised tangent of exp: `out = (dexp_x^-1)* m`, the solution of
/// `phi1(ad*_x) out = m`; not finite where `ad_x` has an eigenvalue `2 pi i k`, k not 0.
pub fn dexp_inverse_dual<S: Scalar, P: LiePoisson<S>>(
    system: &P,
    x: &P::State,
    m: &P::State,
    out: &mut P::State,
) {
    let mut matrix = system.zero_jacobian();
    let (mut unit, mut column) = (system.zero_state(), system.zero_state());
    let mut scratch = Scratch::new(&unit);
    for k in 0..system.dimension() {
        unit.fill(S::zero());
        unit.as_mut_slice()[k] = S::one();
        match system.has_closed_exponential() {
            true => system.dexp_dual(x, &unit, &mut column),
            false => {
                dexp_dual_in(system, x, &unit, &mut column, &mut scratch, |_, _| ());
            }
        }
        for (row, &entry) in column.as_slice().iter().enumerate() {
            matrix.set(row, k, entry);
        }
    }
    out.copy_from(m);
    exchanging::solve(&mut matrix, out);
}

/// The inverse dual of the right-trivialised tangent of the Cayley map:
/// `out = (dcay_x^-1)* m = m - ad*_x m/2 - Q_x m/4`, `(Q_x m)_b = T_abc^d x^a x^c m_d`.
pub fn dcay_inverse_dual<S: Scalar, P: CayleyPoisson<S>>(
    system: &P,
    x: &P::State,
    m: &P::State,
    out: &mut P::State,
) {
    let (mut action, mut triple) = (system.zero_state(), system.zero_state());
    system.ad_star(x, m, &mut action);
    system.triple(x, x, m, &mut triple);
    out.copy_from(m);
    out.axpy(S::ratio(-1.0, 2.0), &action);
    out.axpy(S::ratio(-1.0, 4.0), &triple);
}
