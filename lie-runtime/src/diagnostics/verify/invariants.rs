//! Energy, Casimirs and first integrals over some tens of steps.

use super::findings::Finding;
use super::ground::Ground;
use super::{PER_STEP, smaller_steps};
use crate::diagnostics::any::AnyMethod;
use crate::diagnostics::integrals::Integral;
use crate::methods::StepFailure;
use crate::newton::NewtonOptions;
use crate::poisson::{Lift, Poisson};
use crate::state::State;

const STEPS: u32 = 32;

type Function<'a, P> = Box<dyn Fn(&<P as Poisson<f64>>::State) -> f64 + 'a>;

/// A function of the state, with the size of the round-off in it.
struct Watched<'a, P: Poisson<f64>> {
    value: Function<'a, P>,
    size: Function<'a, P>,
    /// By how much it is no integral, relative to the size and per unit of time over the rate.
    defect: f64,
}

/// What stands together in one line of the report.
struct Group<'a, P: Poisson<f64>> {
    fact: &'static str,
    claimed: bool,
    members: Vec<Watched<'a, P>>,
}

pub(super) fn findings<P: Lift<f64>>(
    system: &P,
    ground: &Ground<P>,
    method: &dyn AnyMethod<f64, P>,
) -> Vec<Finding> {
    groups(system, ground, method)
        .iter()
        .map(|group| {
            if group.members.is_empty() {
                return Finding::absent(group.fact, "none");
            }
            let all = |h: f64| measure(system, ground, method, group, h);
            match smaller_steps(ground.step, all) {
                Ok(((drift, excess), h)) => {
                    // the bound differs between members: the largest excess decides
                    let bound = if excess > 0.0 {
                        drift / excess
                    } else {
                        bound(0.0)
                    };
                    Finding::zero(group.fact, group.claimed, drift, bound).at(h)
                }
                Err(failure) => Finding::unmeasured(group.fact, group.claimed, &failure),
            }
        })
        .collect()
}

fn bound(defect: f64) -> f64 {
    f64::from(STEPS) * (PER_STEP * f64::EPSILON + defect)
}

fn groups<'a, P: Lift<f64>>(
    system: &'a P,
    ground: &'a Ground<P>,
    method: &dyn AnyMethod<f64, P>,
) -> Vec<Group<'a, P>> {
    let kept = method.claims().preserves;
    let quadratic_energy = system
        .hamiltonian_degree()
        .is_some_and(|degree| degree <= 2);
    let energy = Watched {
        value: Box::new(|mu| system.hamiltonian(mu)),
        size: Box::new(|mu| {
            let mut gradient = system.zero_state();
            system.gradient(mu, &mut gradient);
            system.hamiltonian(mu).abs() + size(&gradient, mu)
        }),
        defect: 0.0,
    };
    let casimirs = |quadratic: bool| {
        let of_kind =
            move |index: &usize| system.casimir_degree(*index).is_some_and(|d| d <= 2) == quadratic;
        (0..system.casimir_count())
            .filter(of_kind)
            .filter(|index| !system.casimir_is_multivalued(*index))
            .map(|index| casimir(system, index))
            .collect()
    };
    let integrals = |integrals: &'a [Integral]| integrals.iter().map(integral).collect();
    vec![
        Group {
            fact: "energy",
            claimed: kept.energy || (kept.quadratic_invariants && quadratic_energy),
            members: vec![energy],
        },
        Group {
            fact: "quadratic Casimirs",
            claimed: kept.casimirs || kept.quadratic_casimirs,
            members: casimirs(true),
        },
        Group {
            fact: "other Casimirs",
            claimed: kept.casimirs,
            members: casimirs(false),
        },
        Group {
            fact: "linear integrals",
            claimed: kept.linear_invariants,
            members: integrals(&ground.linear),
        },
        Group {
            fact: "quadratic integrals",
            claimed: kept.quadratic_invariants,
            members: integrals(&ground.quadratic),
        },
    ]
}

/// `sum |g_i| max|mu|`: every coordinate carries the round-off of the largest.
fn size<V: State<f64>>(gradient: &V, mu: &V) -> f64 {
    gradient.as_slice().iter().map(|g| g.abs()).sum::<f64>() * mu.max_norm()
}

fn casimir<P: Poisson<f64>>(system: &P, index: usize) -> Watched<'_, P> {
    let value = move |mu: &P::State| {
        let mut all = vec![0.0; system.casimir_count()];
        system.casimirs(mu, &mut all);
        all[index]
    };
    Watched {
        value: Box::new(value),
        size: Box::new(move |mu| {
            let mut gradient = system.zero_state();
            system.casimir_gradient(index, mu, &mut gradient);
            value(mu).abs() + size(&gradient, mu)
        }),
        defect: 0.0,
    }
}

fn integral<P: Poisson<f64>>(integral: &Integral) -> Watched<'_, P> {
    Watched {
        value: Box::new(|mu| integral.value(mu.as_slice())),
        size: Box::new(|mu| integral.size(mu.as_slice())),
        defect: 4.0 * integral.defect,
    }
}

/// The largest change over the size, and its largest ratio to the bound.
fn measure<P: Lift<f64>>(
    system: &P,
    ground: &Ground<P>,
    method: &dyn AnyMethod<f64, P>,
    group: &Group<'_, P>,
    h: f64,
) -> Result<(f64, f64), StepFailure> {
    let newton = NewtonOptions::default();
    let mut worst = (0.0_f64, 0.0_f64);
    for start in &ground.states {
        for h in [h, -h, 0.3 * h] {
            let first: Vec<f64> = group.members.iter().map(|m| (m.value)(start)).collect();
            let mut sizes: Vec<f64> = group.members.iter().map(|m| (m.size)(start)).collect();
            let mut mu = start.clone();
            let mut stepper = method.any_stepper(system, h, &newton);
            for _ in 0..STEPS {
                stepper.step(&mut mu)?;
                for ((member, first), size) in group.members.iter().zip(&first).zip(&mut sizes) {
                    *size = size.max((member.size)(&mu));
                    let change = ((member.value)(&mu) - first).abs();
                    let drift = if change == 0.0 { 0.0 } else { change / *size };
                    let excess = drift / bound(member.defect);
                    if excess > worst.1 || drift.is_nan() {
                        worst = (drift, excess);
                    }
                }
            }
        }
    }
    Ok(worst)
}
