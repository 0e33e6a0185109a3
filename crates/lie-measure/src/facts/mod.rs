//! Every fact that a method claims, measured on a system.
//!
//! Bounds follow from round-off: `epsilon` times the number of operations that can have added to it, relative
//! to the size of the terms. The measurements are made at steps of about a third of the system's own time,
//! where a fact that does not hold misses its bound by orders of magnitude.

mod controls;
mod failing;
mod findings;
mod ground;
mod group;
mod invariants;
mod noise;
mod order;
mod plain;
mod solver;

pub(crate) use controls::spoiled;
pub use controls::{broken_comparison, broken_measurements, unsound_iterations};
pub use findings::{Finding, Verdict};
pub(crate) use ground::rate;
pub use ground::{Exact, Ground, OrbitDistance};
pub use group::GroupCheck;
pub use noise::{Noise, Thermal};
pub(crate) use order::relative_error;
pub use plain::{PlainEnd, PlainSteps};

use crate::newton_order::{order_of_iteration, residual_floor, residuals};
use lie_runtime::diagnostics::AnyMethod;
use lie_runtime::diagnostics::symmetry_defect;
use lie_runtime::diagnostics::tangent_map;
use lie_runtime::methods::StepFailure;
use lie_runtime::newton::NewtonOptions;
use lie_runtime::poisson::Lift;
use lie_runtime::poisson::Poisson;
use lie_runtime::scalar::Dual;
use lie_runtime::state::{State, Unknown};

type Made<S, P> = Box<dyn AnyMethod<S, P>>;

/// Makes a method of a tolerance.
type ByTolerance<P> = Box<dyn Fn(f64) -> Made<f64, P>>;

/// A method under examination, over numbers and over dual numbers.
pub struct Subject<P: Lift<f64>> {
    /// The method.
    pub method: Made<f64, P>,
    /// The same over dual numbers.
    pub lifted: Made<Dual<f64>, P::Lifted>,
    /// Whether a step consists of steps of another method: how the iteration converges is then a fact of that one.
    pub composed: bool,
    /// Of an adaptive method: the same with both tolerances of this size.
    pub with_tolerance: Option<ByTolerance<P>>,
    /// Of a method with a fused equation: the same method on the generic one.
    pub plain: Option<Box<PlainSteps>>,
    /// Whether the group element only goes along with the steps, to their order, although these are of coadjoint form: that of
    /// a realization acts on points, not in the declared matrices.
    pub beside: bool,
}

/// Round-off of one step, in units of epsilon times the size of what is measured: the state after a step is
/// exact to a few units per component, whatever the method does inside.
const PER_STEP: f64 = 16.0;
/// The least order of a Newton iteration: between 1, of a wrong Jacobian, and 2.
const NEWTON: f64 = 1.25;

/// The part of all steps that may need row exchanges.
const EXCHANGES: f64 = 0.1;

/// Measures everything that `subject` claims; says what comes next, which in many dimensions may take long.
///
/// # Errors
/// What `next` answers: nothing more is measured then.
pub fn verify<P: Lift<f64>, E>(
    system: &P,
    lifted: &P::Lifted,
    ground: &Ground<P>,
    subject: &Subject<P>,
    next: &mut dyn FnMut(&'static str) -> Result<(), E>,
) -> Result<Vec<Finding>, E> {
    let method = &*subject.method;
    next("order")?;
    let mut findings = vec![order::finding(system, ground, subject)];
    next("symmetric")?;
    findings.push(symmetry(system, ground, method));
    next("iterations")?;
    findings.extend(iterations(system, ground, method, subject.composed));
    findings.push(failing::finding(system, ground, subject));
    next("invariants")?;
    findings.extend(invariants::findings(system, ground, method));
    next("orbit")?;
    findings.push(orbit(system, ground, method));
    next("Poisson")?;
    findings.push(poisson::<P>(lifted, ground, &*subject.lifted));
    if let Some(plain) = &subject.plain {
        next("generic form")?;
        findings.push(plain::finding(system, ground, method, plain));
    }
    if let Some(check) = ground.group {
        next("group")?;
        findings.push(check(system, ground, method, subject.beside));
    }
    if let Some(noise) = &ground.noise {
        next("strong order")?;
        findings.push(noise.strong_order(system, method));
        next("weak order")?;
        findings.push(noise.weak_order(system, method, None));
        next("means")?;
        findings.extend(noise.means(system, method));
    }
    Ok(findings)
}

/// Runs a measurement at h, and where a step fails at half of it, and so on; returns the step that worked.
fn smaller_steps<T>(
    h: f64,
    mut measure: impl FnMut(f64) -> Result<T, StepFailure>,
) -> Result<(T, f64), StepFailure> {
    let mut h = h;
    let mut halvings = 0;
    loop {
        match measure(h) {
            Ok(value) => return Ok((value, h)),
            Err(failure) if halvings == 6 => return Err(failure),
            Err(_) => {
                h *= 0.5;
                halvings += 1;
            }
        }
    }
}

/// The largest of a measurement over the states and over steps forwards and backwards.
fn worst<P: Lift<f64>>(
    ground: &Ground<P>,
    fact: &'static str,
    claimed: bool,
    bound: f64,
    measure: impl Fn(f64, &P::State) -> Result<f64, StepFailure>,
) -> Finding {
    let all = |h: f64| {
        let mut largest = 0.0_f64;
        for mu in &ground.states {
            for h in [h, -h, 0.3 * h] {
                let value = measure(h, mu)?;
                largest = if value.is_nan() {
                    value
                } else {
                    f64::max(largest, value)
                };
            }
        }
        Ok(largest)
    };
    match smaller_steps(ground.step, all) {
        Ok((value, step)) => Finding::zero(fact, claimed, value, bound).at_step(step),
        Err(failure) => Finding::unmeasured(fact, claimed, &failure),
    }
}

fn symmetry<P: Lift<f64>>(
    system: &P,
    ground: &Ground<P>,
    method: &dyn AnyMethod<f64, P>,
) -> Finding {
    let claims = method.claims();
    let newton = NewtonOptions::default();
    worst(
        ground,
        "symmetric",
        claims.symmetric,
        4.0 * PER_STEP * f64::EPSILON,
        |h, mu| {
            let defect = symmetry_defect(system, method, h, mu, &newton)?;
            Ok(defect / mu.max_norm())
        },
    )
}

fn orbit<P: Lift<f64>>(system: &P, ground: &Ground<P>, method: &dyn AnyMethod<f64, P>) -> Finding {
    if system.is_forced() {
        return Finding::absent("orbit", "forces act");
    }
    if system.is_almost_poisson() {
        return Finding::absent("orbit", "no leaves: the bracket is almost Poisson");
    }
    let claimed = method.claims().preserves.on(system).orbit;
    let Some(orbit_distance) = ground.orbit else {
        return match claimed {
            true => invariants::leaf(system, ground, method),
            false => Finding::absent("orbit", "no algebra"),
        };
    };
    let newton = NewtonOptions::default();
    worst(
        ground,
        "orbit",
        claimed,
        4.0 * PER_STEP * f64::EPSILON,
        |h, mu| {
            let mut end = mu.clone();
            method.any_stepper(system, h, &newton).step(&mut end)?;
            let scale = mu.max_norm().max(end.max_norm());
            Ok(orbit_distance(system, mu, &end) / scale)
        },
    )
}

fn poisson<P: Lift<f64>>(
    lifted: &P::Lifted,
    ground: &Ground<P>,
    method: &dyn AnyMethod<Dual<f64>, P::Lifted>,
) -> Finding {
    if lifted.is_forced() || lifted.is_damped() {
        return Finding::absent("Poisson", "the flow is no Poisson map");
    }
    if lifted.is_almost_poisson() {
        return Finding::absent("Poisson", "the bracket is almost Poisson");
    }
    let kept = method.claims().preserves;
    let constant = lifted.poisson_degree() == Some(0);
    let claimed = kept.poisson || (kept.constant_poisson && constant);
    let newton = NewtonOptions::default();
    let operations = PER_STEP * lifted.dimension() as f64;
    worst(
        ground,
        "Poisson",
        claimed,
        operations * f64::EPSILON,
        |h, mu| {
            let map = tangent_map(lifted, method, h, mu.as_slice(), &newton)?;
            let defect = map.poisson_defect(lifted, mu.as_slice());
            let norm = map.norm().max(1.0);
            let size = ground.structure * mu.max_norm().max(largest(&map.end));
            Ok(defect / (norm * norm * size))
        },
    )
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, x| f64::max(m, x.abs()))
}

/// Whether explicit methods iterate, and how fast the iteration of implicit ones converges.
fn iterations<P: Lift<f64>>(
    system: &P,
    ground: &Ground<P>,
    method: &dyn AnyMethod<f64, P>,
    composed: bool,
) -> Vec<Finding> {
    let claims = method.claims();
    let mut most = 0;
    let mut slowest = f64::INFINITY;
    // far from the solution no iteration has its order yet: never beyond the system's own step
    let step = ground.step.abs().min(ground.natural_step);
    let measured = smaller_steps(3.0 * step, |h| {
        (most, slowest) = (0, f64::INFINITY);
        for mu in &ground.states {
            for h in [h, -h] {
                let (residuals, iterations) = residuals(system, method, h, mu)?;
                most = most.max(iterations);
                if let Some(order) = order_of_iteration(&residuals, residual_floor(mu)) {
                    slowest = slowest.min(order);
                }
            }
        }
        Ok(())
    });
    let step = match measured {
        Ok(((), step)) => step,
        Err(failure) => return vec![Finding::unmeasured("explicit", claims.explicit, &failure)],
    };
    let explicit = Finding::zero("explicit", claims.explicit, f64::from(most), 0.0)
        .at_step(step)
        .note(format!("{most} iterations"));
    if most == 0 {
        return vec![explicit];
    }
    if composed {
        return vec![explicit, Finding::absent("Newton", "that of the base")];
    }
    if claims.fixed_point {
        let newton = Finding::absent("Newton", "a fixed-point iteration");
        return vec![explicit, newton, residual(system, ground, method)];
    }
    // damping along the orbit takes the mean of a curve whose derivative is left out
    if system.is_damped() && claims.preserves.energy && claims.preserves.orbit {
        let newton = Finding::absent("Newton", "an approximate Jacobian beside damping");
        return vec![explicit, newton, residual(system, ground, method)];
    }
    let note = if slowest.is_finite() {
        format!("order of the iteration, at most {most} iterations")
    } else {
        format!("at round-off at once, at most {most} iterations")
    };
    let newton = Finding::at_least("Newton", true, slowest, 2.0, NEWTON)
        .at_step(step)
        .note(note);
    let exchanges = exchanges(system, ground, method);
    vec![
        explicit,
        newton,
        residual(system, ground, method),
        exchanges,
    ]
}

/// How many steps, as a part of all, fall back to row exchanges: the elimination in fixed order is made for steps of the
/// system's own size, where it needs none.
fn exchanges<P: Lift<f64>>(
    system: &P,
    ground: &Ground<P>,
    method: &dyn AnyMethod<f64, P>,
) -> Finding {
    let newton = NewtonOptions::newton();
    let own = ground.step.abs().min(ground.natural_step);
    let measured = smaller_steps(own, |h| {
        let (mut fallen, mut steps) = (0, 0);
        for mu in &ground.states {
            for h in [h, -h, 0.3 * h] {
                let mut state = mu.clone();
                let mut stepper = method.any_stepper(system, h, &newton);
                for _ in 0..4 {
                    fallen += u32::from(stepper.step(&mut state)?.pivoted != 0);
                    steps += 1;
                }
            }
        }
        Ok(f64::from(fallen) / f64::from(steps))
    });
    match measured {
        Ok((part, _)) => Finding::zero("row exchanges", true, part, EXCHANGES),
        Err(failure) => Finding::unmeasured("row exchanges", true, &failure),
    }
}

/// Whether iterations that evaluate residuals alone, after one Jacobian or without any, come to the same state: the
/// residual and the one that comes with the Jacobian are separate code.
fn residual<P: Lift<f64>>(
    system: &P,
    ground: &Ground<P>,
    method: &dyn AnyMethod<f64, P>,
) -> Finding {
    let bound = 4.0 * PER_STEP * f64::EPSILON;
    worst(ground, "residual", true, bound, |h, mu| {
        let step = |newton: &NewtonOptions| {
            let mut end = mu.clone();
            let mut stepper = method.any_stepper(system, h, newton);
            stepper.step(&mut end).map(|_| end)
        };
        let end = step(&NewtonOptions::newton())?;
        let simplified = relative_error(&step(&NewtonOptions::simplified())?, &end);
        let automatic = relative_error(&step(&NewtonOptions::default())?, &end);
        Ok(f64::max(simplified, automatic))
    })
}
