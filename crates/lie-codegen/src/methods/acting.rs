//! Which methods a system can carry beside whose Hamiltonian something acts.

use super::Choice;
use crate::model::{Acting, Driving, Model};
use crate::structure::flows;

/// Why a method does not apply where something acts beside the Hamiltonian.
pub(super) fn driven(model: &Model, choice: &Choice) -> Option<(String, String)> {
    let (driving, method) = (model.driving.as_ref()?, choice.entry()?);
    if matches!(choice, Choice::Splitting(..)) {
        return match model.family {
            // its pieces are found, or are not, with those of H
            Some(_) => None,
            None if !model.is_lie_poisson() => Some((
                "something acts beside the Hamiltonian, and the pieces on a bracket that is declared by its entries are those of H".into(),
                "use `gauss16` or `taylor`, which take the whole field".into(),
            )),
            None => flows::unsplittable(model),
        };
    }
    let along = |acting: &Acting| {
        matches!(
            acting,
            Acting::DoubleBracket(..) | Acting::HamiltonianNoise(_)
        )
    };
    let gradients = matches!(
        choice,
        Choice::DiscreteGradient(..) | Choice::OrbitEnergy(_) | Choice::CohenHairer(_)
    );
    if gradients && driving.has_noise_along_orbits() {
        let what = "noise moves along the orbit, and the discrete gradient is that of H alone";
        return Some((what.into(), "use `lie-midpoint` or `gauss16`".into()));
    }
    // the power of forces alone does not bend what moves along the orbit
    let bends = driving.declared.iter().find(|acting| along(acting));
    if model.holds() && matches!(choice, Choice::Collective(..) | Choice::Isospectral(_)) {
        let what = "inputs and noise are not carried to the space over the state";
        return Some((what.into(), "use `lie-midpoint` or `gauss16`".into()));
    }
    let what = match (
        driving.is_forced(&model.graph) && !method.forces,
        bends.filter(|_| !method.damping),
    ) {
        (false, None) => return None,
        (true, _) => {
            let acts = match driving.pushes() {
                true => "forces act beside the Hamiltonian",
                false => "dissipation or noise acts beside the Hamiltonian",
            };
            format!("{acts}, and {}", without_forces(choice))
        }
        (false, Some(bends)) => {
            let what = match bends {
                Acting::HamiltonianNoise(_) => "noise moves along the orbit",
                _ => "a double bracket damps",
            };
            format!("{what}, and the step is made of a gradient of H, which its generator is not")
        }
    };
    let others = match model.family {
        Some(_) => "`gauss16` or `rk4`",
        None => "`gauss16` or `taylor`",
    };
    let help = format!(
        "use {others}, which take the whole field, or leave {} out",
        keys(driving)
    );
    Some((what, help))
}

/// The keys under which things are declared that act.
fn keys(driving: &Driving) -> String {
    let key = |acting: &Acting| match acting {
        Acting::Force(..) => "`forces`",
        Acting::HamiltonianNoise(_) | Acting::ForceNoise(_) => "`noise`",
        _ => "`dissipation`",
    };
    let mut keys: Vec<&str> = driving.declared.iter().map(key).collect();
    keys.dedup();
    keys.join(" and ")
}

/// What leaves no place for a force in the step of a method.
fn without_forces(choice: &Choice) -> &'static str {
    match choice {
        Choice::Exact => "the closed solution is that of H alone",
        Choice::Generating(..) | Choice::GeneratingSecondKind2 | Choice::HamiltonJacobi(_) => {
            "the generating function is one of H alone"
        }
        Choice::LieTaylor => "the step moves along the coadjoint orbit, which what acts leaves",
        Choice::Collective(..) | Choice::Isospectral(_) | Choice::SphericalMidpoint => {
            "the space over the momenta has no force that moves them off their orbit"
        }
        Choice::MoserVeselov => "the discrete body is a free one",
        Choice::DiscreteEulerPoincare(_) => "a discrete Lagrangian has the motion without it",
        _ => "the step has no form with it",
    }
}
