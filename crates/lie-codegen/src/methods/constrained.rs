//! Which methods a system with a constraint can carry.

use super::Choice;
use crate::model::Model;

/// Why a method does not apply to the almost-Poisson bracket that a constraint leaves.
///
/// Runge–Kutta methods, Taylor series, discrete gradients and the flow of a held gradient take any antisymmetric matrix. All others are
/// made of Poisson maps, of coadjoint orbits or of symplectic spaces over the state, which presuppose the Jacobi identity.
pub(super) fn almost_poisson(model: &Model, choice: &Choice) -> Option<(String, String)> {
    model.constraint.as_ref()?;
    let applies = matches!(
        choice,
        Choice::Midpoint
            | Choice::Gauss(_)
            | Choice::DiscreteGradient(..)
            | Choice::OrbitEnergy(_)
            | Choice::CohenHairer(_)
            | Choice::Taylor
            | Choice::Rk4
            | Choice::Dopri5
    );
    let reason = match choice {
        _ if applies => return None,
        Choice::Variational(..) | Choice::DiscreteEulerPoincare(_) => {
            "the discrete principle of Lagrange and d'Alembert with a constraint does not keep the energy, and is not built"
        }
        _ => {
            "it presupposes the Jacobi identity, and the bracket that the constraint leaves is almost Poisson"
        }
    };
    let help = "use `gonzalez` or `orbit-energy`, which keep the energy, the constraint and the kernel functions of the bracket, or `gauss4`";
    Some((reason.into(), help.into()))
}
