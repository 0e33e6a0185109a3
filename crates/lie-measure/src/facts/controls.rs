//! Negative controls: what every measurement says of a map that is spoiled on purpose.
//!
//! A measurement that lets the spoiled map pass measures nothing, and what it says of methods is worth nothing.

use super::findings::{Finding, Verdict};
use super::ground::Ground;
use super::{
    Subject, exchanges, invariants, iterations, orbit, order, plain, poisson, residual, solver,
    symmetry,
};
use crate::basis::Basis;
use crate::newton_order::order_of_iteration;
use lie_runtime::diagnostics::{AnyMethod, AnyStepper, Claims, Motions};
use lie_runtime::matrix::SquareMatrix;
use lie_runtime::methods::{FactorSink, Preserves, StepFailure, StepReport, Stepper};
use lie_runtime::newton::{Iteration, NewtonOptions};
use lie_runtime::poisson::{Lift, Poisson};
use lie_runtime::scalar::Scalar;
use lie_runtime::state::State;
use std::borrow::Cow;

/// How far a step of the size of the measurements is spoiled, relative to the state, others in proportion: far above
/// round-off, far below what a step does. A measurement with steps that show nothing says nothing.
const SLIGHTLY: f64 = 1e-9;
/// For the order, where the errors of the method itself must not hide it.
const PLAINLY: f64 = 1e-3;

/// A method behind whose steps a linear map that is nearly 1 is applied, which keeps nothing; a simplified iteration
/// gives another than Newton's. It says that it iterates and exchanges rows.
pub(crate) struct Spoiled<'m, S: Scalar, P: Poisson<S>> {
    method: &'m dyn AnyMethod<S, P>,
    /// Per unit of time.
    part: f64,
}

struct SpoiledStepper<'a, S, V> {
    stepper: Box<dyn AnyStepper<S, V> + 'a>,
    part: S,
}

fn spoil<S: Scalar, V: State<S>>(mu: &mut V, part: S) {
    let before: Vec<S> = mu.as_slice().to_vec();
    for (i, entry) in mu.as_mut_slice().iter_mut().enumerate() {
        for (j, &other) in before.iter().enumerate() {
            let weight = (1.7 + 7.3 * i as f64 + 3.1 * j as f64).sin();
            *entry += other * (part * S::from_f64(weight));
        }
    }
}

impl<S: Scalar, V: State<S>> Stepper<S> for SpoiledStepper<'_, S, V> {
    type State = V;

    fn step<K: FactorSink<V>>(
        &mut self,
        mu: &mut V,
        sink: &mut K,
    ) -> Result<StepReport, StepFailure> {
        let report = if sink.is_active() {
            let mut motions = Motions::new();
            let report = self.stepper.step_with_motions(mu, &mut motions)?;
            motions.show(sink);
            report
        } else {
            self.stepper.step(mu)?
        };
        spoil(mu, self.part);
        Ok(StepReport {
            iterations: report.iterations.max(1),
            pivoted: 1,
            ..report
        })
    }
}

impl<S: Scalar, P: Poisson<S>> AnyMethod<S, P> for Spoiled<'_, S, P> {
    /// Everything, of an order that the spoiled map cannot have.
    fn claims(&self) -> Claims {
        Claims {
            order: 2,
            symmetric: true,
            explicit: true,
            fixed_point: false,
            own_steps: false,
            preserves: Preserves {
                energy: true,
                casimirs: true,
                quadratic_casimirs: true,
                orbit: true,
                poisson: true,
                constant_poisson: true,
                quadratic_invariants: true,
                linear_invariants: true,
            },
        }
    }

    fn any_stepper<'a>(
        &self,
        system: &'a P,
        h: S,
        newton: &NewtonOptions,
    ) -> Box<dyn AnyStepper<S, P::State> + 'a> {
        let twice = newton.iteration == Iteration::Simplified;
        let part = if twice { 2.0 * self.part } else { self.part };
        Box::new(SpoiledStepper {
            stepper: self.method.any_stepper(system, h, newton),
            part: S::from_f64(part) * h.abs(),
        })
    }
}

/// A method whose steps are slightly spoiled.
pub(crate) fn spoiled<'m, S: Scalar, P: Lift<f64> + Poisson<S>>(
    ground: &Ground<P>,
    method: &'m dyn AnyMethod<S, P>,
) -> Spoiled<'m, S, P> {
    let part = SLIGHTLY / ground.step.abs();
    Spoiled { method, part }
}

/// Whether the comparison with the generic form lets a spoiled map pass.
pub fn broken_comparison<P: Lift<f64>>(
    system: &P,
    ground: &Ground<P>,
    subject: &Subject<P>,
) -> bool {
    subject.plain.as_ref().is_some_and(|plain| {
        let spoiled = spoiled(ground, &*subject.method);
        passes(&plain::finding(system, ground, &spoiled, plain))
    })
}

/// What of the iteration behind implicit steps does not solve an equation whose solution is known.
pub fn unsound_iterations() -> Vec<&'static str> {
    solver::unsound()
}

fn passes(finding: &Finding) -> bool {
    !matches!(finding.verdict, Verdict::Fails | Verdict::Absent)
}

/// The measurements that let a spoiled map pass, by the names of their facts. `subject` is any method of the system.
pub fn broken_measurements<P: Lift<f64>>(
    system: &P,
    lifted: &P::Lifted,
    ground: &Ground<P>,
    subject: &Subject<P>,
) -> Vec<Cow<'static, str>> {
    let slightly = spoiled(ground, &*subject.method);
    let lifted_method = Spoiled {
        method: &*subject.lifted,
        part: slightly.part,
    };
    let plainly = Spoiled {
        method: &*subject.method,
        part: PLAINLY / ground.step.abs(),
    };
    let mut findings = vec![order::finding_of(system, ground, &plainly)];
    findings.push(symmetry(system, ground, &slightly));
    findings.extend(invariants::findings(system, ground, &slightly));
    if !open_orbit(system, ground) {
        findings.push(orbit(system, ground, &slightly));
    }
    findings.push(poisson::<P>(lifted, ground, &lifted_method));
    findings.push(residual(system, ground, &slightly));
    findings.push(exchanges(system, ground, &slightly));
    findings.extend(
        iterations(system, ground, &slightly, true)
            .into_iter()
            .next(),
    );
    if let Some(check) = ground.group {
        findings.push(check(system, ground, &slightly, false));
    }
    let passing = findings.into_iter().filter(passes);
    let mut broken: Vec<Cow<'static, str>> = passing.map(|finding| finding.fact).collect();
    for fact in invariants::mistaken(system, ground, &slightly) {
        if !broken.iter().any(|known| known == fact) {
            broken.push(fact.into());
        }
    }
    if invariants::integrals_are_missing(system, ground) {
        broken.push("quadratic integrals".into());
    }
    if !iterations_are_told_apart() {
        broken.push("Newton".into());
    }
    broken
}

/// Whether the orbit is open: no state near it has a distance then.
fn open_orbit<P: Lift<f64>>(system: &P, ground: &Ground<P>) -> bool {
    ground.states.iter().all(|mu| {
        let mut matrix = system.zero_jacobian();
        system.poisson_matrix(mu, &mut matrix);
        let column = |j| (0..system.dimension()).map(|i| matrix.get(i, j)).collect();
        let columns: Vec<Vec<f64>> = (0..system.dimension()).map(column).collect();
        Basis::from_span(&columns).rank() == system.dimension()
    })
}

/// A linear iteration has the order 1, a quadratic one 2.
fn iterations_are_told_apart() -> bool {
    let linear: Vec<f64> = (0..14).map(|k| 0.1_f64.powi(k)).collect();
    let quadratic = [1e-1, 1e-2, 1e-4, 1e-8, 1e-16];
    let order = |residuals: &[f64]| order_of_iteration(residuals, 1e-15).unwrap_or(f64::NAN);
    (order(&linear) - 1.0).abs() < 0.1 && order(&quadratic) > 1.7
}
