//! Orders on paths of noise: what methods claim is measured, and what converges to another equation is noticed.

use lie_measure::facts::{Finding, Ground, Subject, Verdict, verify};
use lie_runtime::diagnostics::{AnyMethod, AnyStepper, Claims};
use lie_runtime::methods::{FactorSink, StepFailure, StepReport, Stepper};
use lie_runtime::prelude::*;

lie_poisson! {
    /// A body with two noises that do not commute.
    pub system Turned;
    algebra = so(3);
    state x, y, z;
    hamiltonian = x^2/4 + y^2/2 + 3*z^2/4 + x/5;
    noise { hamiltonian = 2*x/5 + y/5; hamiltonian = z/2 - y/3; }
    initial = [3/5, -1/2, 7/10];
}

lie_poisson! {
    /// A body with one noise, along a quadratic Hamiltonian.
    pub system Bent;
    algebra = so(3);
    state x, y, z;
    hamiltonian = x^2/4 + y^2/2 + 3*z^2/4 + x/5;
    noise { hamiltonian = x^2/3 - y*z/4; }
    initial = [3/5, -1/2, 7/10];
}

/// Euler's method with the claim of order 2: along paths it converges to the equation of Itô.
struct Euler;

struct EulerStepper<'a, P> {
    system: &'a P,
    h: f64,
}

impl<P: Poisson<f64>> Stepper<f64> for EulerStepper<'_, P> {
    type State = P::State;

    fn step<K: FactorSink<P::State>>(
        &mut self,
        mu: &mut P::State,
        _: &mut K,
    ) -> Result<StepReport, StepFailure> {
        let mut field = self.system.zero_state();
        self.system.vector_field(mu, &mut field);
        for (x, v) in mu.as_mut_slice().iter_mut().zip(field.as_slice()) {
            *x += self.h * v;
        }
        Ok(StepReport::default())
    }
}

impl<P: Poisson<f64>> AnyMethod<f64, P> for Euler {
    fn claims(&self) -> Claims {
        Claims {
            order: 2,
            ..Claims::NONE
        }
    }

    fn any_stepper<'a>(
        &self,
        system: &'a P,
        h: f64,
        _: &NewtonOptions,
    ) -> Box<dyn AnyStepper<f64, P::State> + 'a> {
        Box::new(EulerStepper { system, h })
    }
}

fn measured<P>(system: &P, start: &P::State, method: Box<dyn AnyMethod<f64, P>>) -> [Finding; 2]
where
    P: Lift<f64> + Clone,
    Rk4: AnyMethod<lie_runtime::Dual<f64>, P::Lifted>,
{
    let lifted = system.lift();
    let ground = Ground::new(system, start, 1, None).expect("something moves");
    let ground = ground.with_noise(system, &lifted, (1, None));
    let subject = Subject {
        method,
        lifted: Box::new(Rk4),
        composed: false,
        with_tolerance: None,
        plain: None,
        beside: false,
    };
    let found: Result<_, ()> = verify(system, &lifted, &ground, &subject, &mut |_| Ok(()));
    let found = found.expect("everything is measured");
    ["strong order", "weak order"].map(|fact| {
        let found = found.iter().find(|finding| finding.fact == fact);
        found.expect("it is measured").clone()
    })
}

/// That an order is claimed and measured within three standard errors and a tenth.
fn is(finding: &Finding, order: f64) {
    assert_eq!(finding.claim, order, "{finding:?}");
    assert_eq!(finding.verdict, Verdict::Holds, "{finding:?}");
    let far = (finding.measured - order).abs();
    assert!(far < 0.1 + 3.0 * finding.error, "{finding:?}");
    assert!(finding.error < 0.25, "{finding:?}");
}

/// The areas between two noises cost half an order in the mean square, and nothing in the mean.
#[test]
fn noises_that_do_not_commute_leave_half_an_order() {
    let system = Turned::new().system().expect("a system");
    let start = Turned::<f64>::new().initial_state();
    let [strong, weak] = measured(&system, &start, Box::new(Rk4));
    is(&strong, 0.5);
    is(&weak, 1.0);
}

#[test]
fn a_method_that_converges_to_another_equation_fails() {
    let system = Bent::new().system().expect("a system");
    let [strong, _] = measured(
        &system,
        &Bent::<f64>::new().initial_state(),
        Box::new(Euler),
    );
    assert_eq!(strong.verdict, Verdict::Fails, "{strong:?}");
    assert!(strong.measured < 0.3, "{strong:?}");
}
