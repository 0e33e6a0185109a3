//! Equations of methods that need a structure: a representation, spins, inertia.

use super::elimination::Elimination;
use super::equation::{Guess, Item, Motion, Partner, Solver, Unknown};
use super::planner::Planner;
use super::steps::{Form, of_stages};
use crate::methods::{Choice, Lift};
use crate::structure::inertia::Body;

impl Planner<'_> {
    /// The fused equations that are asked for; the others go to the list of generic ones.
    pub(super) fn collective(&mut self, generic: &mut Vec<String>) {
        if self.source.matrices().is_some() {
            self.isospectral(generic);
        }
        if self.source.spins().is_some() {
            // with one stage an elimination of its own saves 2% of a step
            generic.push("hopf2".to_owned());
            for stages in 2..=3 {
                let choice = Choice::Collective(2 * stages as u32, Lift::Hopf);
                let key = format!("hopf{}", 2 * stages);
                self.method(generic, choice, &key, |p| p.stages(stages, Lift::Hopf));
            }
            self.method(
                generic,
                Choice::SphericalMidpoint,
                "spherical",
                Self::spherical,
            );
        }
        let body = match self.source.body() {
            Some(Body::Three) => Some(("moser_veselov", Partner::DiscreteTop)),
            Some(Body::Many { .. }) => Some(("moser_veselov_n", Partner::DiscreteBody)),
            None => None,
        };
        if let Some((key, partner)) = body {
            self.method(generic, Choice::MoserVeselov, key, |p| p.body(partner));
        }
    }

    fn isospectral(&mut self, generic: &mut Vec<String>) {
        // with one stage over a closed representation it is the retraction method
        let closed = self.source.triple().is_some();
        let stages = if closed { 2..=3 } else { 1..=3 };
        if closed {
            generic.push("isospectral2_cayley".to_owned());
        }
        for stages in stages {
            let order = 2 * stages as u32;
            let choice = Choice::Isospectral(order);
            let asked =
                self.asked(&choice) || self.asked(&Choice::Collective(order, Lift::Representation));
            let solver = asked.then(|| self.stages(stages, Lift::Representation));
            match solver.flatten() {
                Some(solver) => self.items.extend([
                    Item::Method(choice.into(), solver),
                    Item::Collective(stages),
                ]),
                None => generic.push(format!("isospectral{order}")),
            }
        }
    }

    /// A collective method: the generic equation with elimination specialised to the pattern, where that
    /// pays: a long one of a full pattern is cheaper without index lists.
    fn stages(&mut self, stages: usize, lift: Lift) -> Option<Solver> {
        let pattern = self.momenta_pattern(lift);
        let n = self.source.dimension;
        let full = Elimination::multiplications_of_full(stages * n);
        let elimination = of_stages(stages, n, &pattern);
        if !elimination.is_unrolled() && 2 * elimination.multiplications() > full {
            return None;
        }
        let (suffix, label) = match lift {
            Lift::Representation => ("Isospectral", "isospectral"),
            Lift::Hopf => ("Hopf", "collective --lift hopf"),
            // its equation is that of the canonical system, without a fused form
            Lift::Spec | Lift::Quaternion | Lift::Smallest => return None,
        };
        let order = 2 * stages;
        let (suffix, label) = (format!("{suffix}{order}"), format!("{label}{order}"));
        let partner = Partner::Stages(lift, stages);
        Some(self.eliminated(partner, &suffix, &label, Unknown::Stages(stages), pattern))
    }

    fn spherical(&mut self) -> Option<Solver> {
        let kernels = self.source.spherical_kernels()?;
        let spins = self.source.spins().map_or(0, <[_]>::len);
        let form = Form {
            docs: &[
                "The spherical midpoint method, unknown `u = mu1`: `u - mu - h f(w) = 0`,",
                "`w = |mu| s/|s|` with `s = mu + u` for each spin.",
            ],
            motion: Motion::Factor,
            ..Form::new(
                "SphericalMidpoint",
                "spherical-midpoint",
                Partner::Spherical(spins),
            )
        };
        Some(self.fused(form, &kernels))
    }

    fn body(&mut self, partner: Partner) -> Option<Solver> {
        let kernels = self.source.discrete_body_kernels()?;
        let form = Form {
            docs: &[
                "The discrete rigid body of Moser and Veselov; state and branch of the solution by the generic",
                "equation.",
            ],
            guess: Guess::HalfStep,
            motion: Motion::Factor,
            ..Form::new("MoserVeselov", "moser-veselov", partner)
        };
        Some(self.fused(form, &kernels))
    }
}
