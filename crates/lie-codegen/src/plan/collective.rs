//! Equations of methods that need a structure: a representation, spins, inertia.

use super::elimination::Elimination;
use super::equation::{Guess, Motion, Solver, Unknown};
use super::planner::Planner;
use super::steps::{Form, stage_elimination};
use crate::methods::{Choice, Lift};

impl Planner<'_> {
    /// A collective method: the generic equation with elimination specialised to the pattern, where that
    /// pays: a long one of a full pattern is cheaper without index lists.
    pub(super) fn momenta(&mut self, choice: &Choice) -> Option<Solver> {
        let (order, lift, suffix, label) = match choice {
            Choice::Isospectral(order) => {
                (*order, Lift::Representation, "Isospectral", "isospectral")
            }
            Choice::Collective(order, lift) => (*order, *lift, "Hopf", "collective --lift hopf"),
            _ => return None,
        };
        let stages = order as usize / 2;
        let pattern = self.momenta_pattern(lift);
        let n = self.source.dimension;
        let full = Elimination::multiplications_of_full(stages * n);
        let elimination = stage_elimination(stages, n, &pattern);
        if !elimination.is_unrolled() && 2 * elimination.multiplications() > full {
            return None;
        }
        let (suffix, label) = (format!("{suffix}{order}"), format!("{label}{order}"));
        let partner = self.partner(choice);
        Some(self.eliminated(partner, &suffix, &label, Unknown::Stages(stages), pattern))
    }

    pub(super) fn spherical(&mut self) -> Option<Solver> {
        let kernels = self.source.spherical_kernels()?;
        let form = Form {
            docs: &[
                "The spherical midpoint method, unknown `d = mu1 - mu`: `d - h f(w) = 0`,",
                "`w = |mu| s/|s|` with `s = 2 mu + d` for each spin.",
            ],
            motion: Motion::Factor,
            ..Form::new(
                "SphericalMidpoint",
                "spherical-midpoint",
                self.partner(&Choice::SphericalMidpoint),
            )
        };
        Some(self.fused(form, &kernels))
    }

    pub(super) fn body(&mut self) -> Option<Solver> {
        let kernels = self.source.discrete_body_kernels()?;
        let form = Form {
            docs: &[
                "The discrete rigid body of Moser and Veselov; state and branch of the solution by the generic",
                "equation.",
            ],
            guess: Guess::HalfStep,
            motion: Motion::Factor,
            ..Form::new(
                "MoserVeselov",
                "moser-veselov",
                self.partner(&Choice::MoserVeselov),
            )
        };
        Some(self.fused(form, &kernels))
    }
}
