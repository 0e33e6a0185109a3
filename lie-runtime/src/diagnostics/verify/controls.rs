//! Negative controls: what every measurement says of a map that is spoiled on purpose.
//!
//! A measurement that lets the spoiled map pass measures nothing, and what it says of methods is worth nothing.

use super::super::any::{AnyMethod, AnyStepper, Claims};
use super::super::basis::Basis;
use super::super::newton_order::order_of_iteration;
use super::findings::{Finding, Verdict};
use super::ground::Ground;
use super::{Subject, invariants, orbit, order, poisson, symmetry};
use crate::matrix::SquareMatrix;
use crate::methods::{FactorSink, Preserves, StepFailure, StepReport, Stepper};
use crate::newton::NewtonOptions;
use crate::poisson::{Lift, Poisson};
use crate::scalar::Scalar;
use crate::state::State;

/// How far a step is spoiled, relative to the state: far above round-off, far below what a step does.
const SLIGHTLY: f64 = 1e-9;
/// For the order, where the errors of the method itself must not hide it.
const PLAINLY: f64 = 1e-3;

/// A method behind whose steps a linear map that is nearly 1 is applied, which keeps nothing.
struct Spoiled<'m, S: Scalar, P: Poisson<S>> {
    method: &'m dyn AnyMethod<S, P>,
    part: f64,
}

struct SpoiledStepper<'a, S, V> {
    stepper: Box<dyn AnyStepper<S, V> + 'a>,
    part: f64,
}

fn spoil<S: Scalar, V: State<S>>(mu: &mut V, part: f64) {
    let before: Vec<S> = mu.as_slice().to_vec();
    for (i, entry) in mu.as_mut_slice().iter_mut().enumerate() {
        for (j, &other) in before.iter().enumerate() {
            let weight = (1.7 + 7.3 * i as f64 + 3.1 * j as f64).sin();
            *entry += other * S::from_f64(part * weight);
        }
    }
}

impl<S: Scalar, V: State<S>> Stepper<S> for SpoiledStepper<'_, S, V> {
    type State = V;

    fn step<K: FactorSink<V>>(
        &mut self,
        mu: &mut V,
        _sink: &mut K,
    ) -> Result<StepReport, StepFailure> {
        let report = self.stepper.step(mu)?;
        spoil(mu, self.part);
        Ok(report)
    }
}

impl<S: Scalar, P: Poisson<S>> AnyMethod<S, P> for Spoiled<'_, S, P> {
    /// Everything, of an order that the spoiled map cannot have.
    fn claims(&self) -> Claims {
        Claims {
            order: 2,
            symmetric: true,
            explicit: true,
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
        Box::new(SpoiledStepper {
            stepper: self.method.any_stepper(system, h, newton),
            part: self.part,
        })
    }
}

/// The measurements that let a spoiled map pass, by the names of their facts. `subject` is any method of the system.
pub fn broken_measurements<P: Lift<f64>>(
    system: &P,
    lifted: &P::Lifted,
    ground: &Ground<P>,
    subject: &Subject<P>,
) -> Vec<&'static str> {
    let spoiled = |part: f64| Measured {
        method: Spoiled {
            method: &*subject.method,
            part,
        },
        lifted: Spoiled {
            method: &*subject.lifted,
            part,
        },
    };
    let (slightly, plainly) = (spoiled(SLIGHTLY), spoiled(PLAINLY));
    let mut findings = vec![order::finding_of(system, ground, &plainly.method)];
    findings.push(symmetry(system, ground, &slightly.method));
    findings.extend(invariants::findings(system, ground, &slightly.method));
    if !open_orbit(system, ground) {
        findings.push(orbit(system, ground, &slightly.method));
    }
    findings.push(poisson::<P>(lifted, ground, &slightly.lifted));
    let passes = |finding: &Finding| !matches!(finding.verdict, Verdict::Fails | Verdict::Absent);
    let passing = findings.iter().filter(|finding| passes(finding));
    let mut broken: Vec<&'static str> = passing.map(|finding| finding.fact).collect();
    if !iterations_are_told_apart() {
        broken.push("Newton");
    }
    broken
}

struct Measured<'m, P: Lift<f64>> {
    method: Spoiled<'m, f64, P>,
    lifted: Spoiled<'m, crate::scalar::Dual<f64>, P::Lifted>,
}

/// Whether the orbit is open: no state near it has a distance then.
fn open_orbit<P: Lift<f64>>(system: &P, ground: &Ground<P>) -> bool {
    ground.states.iter().all(|mu| {
        let mut matrix = system.zero_jacobian();
        system.poisson_matrix(mu, &mut matrix);
        let column = |j| (0..system.dimension()).map(|i| matrix.get(i, j)).collect();
        let columns: Vec<Vec<f64>> = (0..system.dimension()).map(column).collect();
        Basis::of_span(&columns).rank() == system.dimension()
    })
}

/// A linear iteration has the order 1, a quadratic one 2.
fn iterations_are_told_apart() -> bool {
    let linear: Vec<f64> = (0..14).map(|k| 0.1_f64.powi(k)).collect();
    let quadratic = [1e-1, 1e-2, 1e-4, 1e-8, 1e-16];
    let order = |residuals: &[f64]| order_of_iteration(residuals, 1e-15).unwrap_or(f64::NAN);
    (order(&linear) - 1.0).abs() < 0.1 && order(&quadratic) > 1.7
}
