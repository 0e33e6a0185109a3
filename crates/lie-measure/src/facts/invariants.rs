//! Energy, Casimirs and first integrals over some tens of steps.

use super::findings::Finding;
use super::ground::Ground;
use super::{PER_STEP, smaller_steps};
use crate::basis::Basis;
use crate::integrals::{Integral, MOST_COORDINATES};
use lie_runtime::SquareMatrix as _;
use lie_runtime::diagnostics::AnyMethod;
use lie_runtime::methods::StepFailure;
use lie_runtime::newton::NewtonOptions;
use lie_runtime::poisson::{Lift, Poisson};
use lie_runtime::state::{State, Unknown};

const STEPS: u32 = 32;

type Function<'a, P> = Box<dyn Fn(&<P as Poisson<f64>>::State) -> f64 + 'a>;

type Slope<'a, P> = Box<dyn Fn(&<P as Poisson<f64>>::State) -> <P as Poisson<f64>>::State + 'a>;

/// A function of the state, with the size of the round-off in it.
struct Watched<'a, P: Poisson<f64>> {
    value: Function<'a, P>,
    size: Function<'a, P>,
    /// Its gradient, where that is known apart from the value.
    gradient: Option<Slope<'a, P>>,
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
    let groups = groups(system, ground, method);
    let finding = |group: &Group<'_, P>| match group.members.is_empty() {
        true => Finding::absent(group.fact, "none"),
        false => finding(system, ground, method, group),
    };
    groups.iter().map(finding).collect()
}

fn finding<P: Lift<f64>>(
    system: &P,
    ground: &Ground<P>,
    method: &dyn AnyMethod<f64, P>,
    group: &Group<'_, P>,
) -> Finding {
    let all = |h: f64| measure(system, ground, method, group, h);
    match smaller_steps(ground.step, all) {
        Ok(((drift, excess), h)) => {
            // the bound differs between members: the largest excess decides
            let bound = if excess > 0.0 {
                drift / excess
            } else {
                bound(0.0)
            };
            Finding::zero(group.fact, group.claimed, drift, bound).at_step(h)
        }
        Err(failure) => Finding::unmeasured(group.fact, group.claimed, &failure),
    }
}

/// Whether steps stay on symplectic leaves, where these are not orbits of an algebra: the level sets of all Casimirs, where enough of them
/// are known; else nothing is measured.
pub(super) fn leaf<P: Lift<f64>>(
    system: &P,
    ground: &Ground<P>,
    method: &dyn AnyMethod<f64, P>,
) -> Finding {
    let (fact, n) = ("orbit", system.dimension());
    let mu = &ground.states[ground.states.len() - 1];
    let mut matrix = system.zero_jacobian();
    system.poisson_matrix(mu, &mut matrix);
    let row = |row| (0..n).map(|column| matrix.get(row, column)).collect();
    let rows: Vec<Vec<f64>> = (0..n).map(row).collect();
    let members = casimirs(system, |_| true);
    let gradients = members.iter().filter_map(|member| member.gradient.as_ref());
    let gradients: Vec<Vec<f64>> = gradients.map(|g| g(mu).as_slice().to_vec()).collect();
    let known = Basis::from_span(&gradients).rank();
    let across = n - Basis::from_span(&rows).rank();
    if known < across {
        // those that are known are measured as Casimirs
        let note = format!("not measured: {known} of the {across} Casimirs of a leaf are known");
        return Finding::absent(fact, &note);
    }
    let group = Group {
        fact,
        claimed: true,
        members,
    };
    finding(system, ground, method, &group)
}

fn bound(defect: f64) -> f64 {
    f64::from(STEPS) * (PER_STEP * f64::EPSILON + defect)
}

fn groups<'a, P: Lift<f64>>(
    system: &'a P,
    ground: &'a Ground<P>,
    method: &dyn AnyMethod<f64, P>,
) -> Vec<Group<'a, P>> {
    let whole = method.claims().preserves;
    let kept = whole.on(system);
    let slope = |mu: &P::State| {
        let mut gradient = system.zero_state();
        system.gradient(mu, &mut gradient);
        gradient
    };
    let energy = Watched {
        value: Box::new(|mu| system.hamiltonian(mu)),
        size: Box::new(move |mu| system.hamiltonian(mu).abs() + size(&slope(mu), mu)),
        gradient: Some(Box::new(slope)),
        defect: 0.0,
    };
    let casimirs = |quadratic: bool| {
        let of_kind =
            |index: usize| system.casimir_degree(index).is_some_and(|d| d <= 2) == quadratic;
        casimirs(system, of_kind)
    };
    let integrals = |integrals: &'a [Integral]| integrals.iter().map(integral).collect();
    let mut groups = vec![
        Group {
            fact: "energy",
            claimed: kept.keeps_energy(system),
            // what noise does to it is in no balance
            members: match system.noise_count() {
                0 => vec![energy],
                _ => Vec::new(),
            },
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
    ];
    let declared = 0..system.quantity_count();
    let declared = declared.filter(|index| system.quantity_is_conserved(*index));
    let members: Vec<_> = declared.map(|index| quantity(system, index)).collect();
    if !members.is_empty() {
        // a Poisson map that keeps energy and orbit is the flow; those of degree two at most are measured above too
        groups.push(Group {
            fact: "declared integrals",
            claimed: whole.energy && whole.orbit && whole.poisson && whole.quadratic_invariants,
            members,
        });
    }
    groups
}

/// `sum |g_i| max|mu|`: every coordinate carries the round-off of the largest.
fn size<V: State<f64>>(gradient: &V, mu: &V) -> f64 {
    gradient.as_slice().iter().map(|g| g.abs()).sum::<f64>() * mu.max_norm()
}

/// The Casimirs of a kind that have one value and that nothing which acts changes.
fn casimirs<P: Poisson<f64>>(system: &P, of_kind: impl Fn(usize) -> bool) -> Vec<Watched<'_, P>> {
    let all = (0..system.casimir_count()).filter(|index| of_kind(*index));
    all.filter(|index| !system.casimir_is_multivalued(*index) && system.casimir_is_kept(*index))
        .map(|index| casimir(system, index))
        .collect()
}

fn casimir<P: Poisson<f64>>(system: &P, index: usize) -> Watched<'_, P> {
    let value = move |mu: &P::State| {
        let mut all = vec![0.0; system.casimir_count()];
        system.casimirs(mu, &mut all);
        all[index]
    };
    let slope = move |mu: &P::State| {
        let mut gradient = system.zero_state();
        system.casimir_gradient(index, mu, &mut gradient);
        gradient
    };
    Watched {
        value: Box::new(value),
        size: Box::new(move |mu| value(mu).abs() + size(&slope(mu), mu)),
        gradient: Some(Box::new(slope)),
        defect: 0.0,
    }
}

/// A declared first integral; how it bends is found by differences.
fn quantity<P: Poisson<f64>>(system: &P, index: usize) -> Watched<'_, P> {
    let value = move |mu: &P::State| {
        let mut all = vec![0.0; system.quantity_count()];
        system.quantities(mu, &mut all);
        all[index]
    };
    let size = move |mu: &P::State| {
        let part = DIFFERENCE * mu.max_norm();
        let mut moved = mu.clone();
        let slopes = (0..system.dimension()).map(|entry| {
            let at = mu.as_slice()[entry];
            let mut to = |offset: f64| {
                moved.as_mut_slice()[entry] = at + offset;
                value(&moved)
            };
            let change = to(part) - to(-part);
            moved.as_mut_slice()[entry] = at;
            (change / (2.0 * part)).abs()
        });
        value(mu).abs() + slopes.sum::<f64>() * mu.max_norm()
    };
    Watched {
        value: Box::new(value),
        size: Box::new(size),
        gradient: None,
        defect: 0.0,
    }
}

fn integral<P: Poisson<f64>>(integral: &Integral) -> Watched<'_, P> {
    Watched {
        value: Box::new(|mu| integral.value(mu.as_slice())),
        size: Box::new(|mu| integral.size(mu.as_slice())),
        gradient: None,
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

/// A step of differences, and how far they may be from a gradient, relative to the size of the function.
const DIFFERENCE: f64 = 1e-4;
const FAR: f64 = 1e-3;

/// The facts of which something else is watched than they name: a value does not change by its gradient.
pub(super) fn mistaken<P: Lift<f64>>(
    system: &P,
    ground: &Ground<P>,
    method: &dyn AnyMethod<f64, P>,
) -> Vec<&'static str> {
    let direction = |index: usize| (0.7 + 2.3 * index as f64).sin();
    let mistaken = |member: &Watched<'_, P>| {
        let Some(gradient) = &member.gradient else {
            return false;
        };
        // at most states: the function may bend sharply near one
        let far = ground.states.iter().filter(|mu| {
            let part = DIFFERENCE * mu.max_norm();
            let moved = |sign: f64| {
                let mut moved = (*mu).clone();
                for (index, entry) in moved.as_mut_slice().iter_mut().enumerate() {
                    *entry += sign * part * direction(index);
                }
                (member.value)(&moved)
            };
            let slope = gradient(mu);
            let terms = slope.as_slice().iter().enumerate();
            let along: f64 = terms.map(|(index, g)| g * direction(index)).sum();
            let change = (moved(1.0) - moved(-1.0)) / (2.0 * part);
            let size = (member.size)(mu) / mu.max_norm();
            // where one is no number nothing is known
            (change - along).abs() > FAR * size
        });
        2 * far.count() > ground.states.len()
    };
    let groups = groups(system, ground, method);
    let facts = groups
        .iter()
        .filter(|group| group.members.iter().any(mistaken));
    facts.map(|group| group.fact).collect()
}

/// Whether no first integral was found, although some are known: H and Casimirs of degree two at most. That all of them are
/// found is not asked for: where they are many, round-off leaves some out, and each is measured by itself besides.
pub(super) fn integrals_are_missing<P: Lift<f64>>(system: &P, ground: &Ground<P>) -> bool {
    if system.dimension() > MOST_COORDINATES {
        return false;
    }
    let quadratic = |degree: Option<u32>| degree.is_some_and(|degree| degree <= 2);
    let mu = &ground.states[ground.states.len() - 1];
    let mut gradients = Vec::new();
    let mut gradient = system.zero_state();
    if quadratic(system.hamiltonian_degree()) {
        system.gradient(mu, &mut gradient);
        gradients.push(gradient.as_slice().to_vec());
    }
    for index in 0..system.casimir_count() {
        if quadratic(system.casimir_degree(index)) && system.casimir_is_kept(index) {
            system.casimir_gradient(index, mu, &mut gradient);
            gradients.push(gradient.as_slice().to_vec());
        }
    }
    ground.quadratic.is_empty() && Basis::from_span(&gradients).rank() > 0
}
