//! What a step that somebody wrote keeps, measured on a declared system beside what is claimed of it.

mod measurements;

use core::convert::Infallible;
use core::fmt;

use super::any::Claims;
use crate::poisson::Poisson;
use measurements::{STEPS, drift, order, poisson, runge_kutta, symmetry, worse};

/// Round-off of one step with its solver, relative to the state.
const PER_STEP: f64 = 256.0 * f64::EPSILON;
/// What central differences leave of a derivative, relative.
const DIFFERENCES: f64 = 1e-8;
/// A bound decides only where the classical Runge–Kutta method, which keeps nothing, misses it by this factor.
const CONTRAST: f64 = 10.0;

/// What follows from a measurement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It is claimed, and holds.
    Confirmed,
    /// It is claimed, and does not hold.
    Violated,
    /// It is not claimed, and holds.
    Unclaimed,
    /// It is not claimed, and does not hold.
    Absent,
    /// A method that keeps nothing passes too, or errors are at round-off before an order shows: a longer step is needed,
    /// or another state.
    Undecided,
}

/// One measurement.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// What was measured.
    pub fact: &'static str,
    /// Whether it is claimed.
    pub claimed: bool,
    /// The value: a slope for the order, a relative error for all else.
    pub value: f64,
    /// What the value must not pass: from above for the order, from below for all else.
    pub bound: f64,
    /// The same of the classical Runge–Kutta method at the same step, which keeps nothing; none for the order.
    pub control: Option<f64>,
}

impl Measured {
    /// What follows.
    pub fn verdict(&self) -> Verdict {
        let Some(control) = self.control else {
            return match self.value.partial_cmp(&self.bound) {
                Some(core::cmp::Ordering::Less) => Verdict::Violated,
                Some(_) => Verdict::Confirmed,
                None => Verdict::Undecided,
            };
        };
        let holds = self.value <= self.bound;
        // NaN is no contrast
        let contrast = control >= CONTRAST * self.bound || control.is_nan();
        match (holds, self.claimed) {
            (true, _) if !contrast => Verdict::Undecided,
            (true, true) => Verdict::Confirmed,
            (true, false) => Verdict::Unclaimed,
            (false, true) => Verdict::Violated,
            (false, false) => Verdict::Absent,
        }
    }
}

/// All measurements of a step; `{}` shows them as a table.
#[derive(Clone, Debug, PartialEq)]
pub struct StepVerification {
    /// The order, the symmetry, then what is kept.
    pub facts: Vec<Measured>,
}

impl StepVerification {
    /// Whether every claim is confirmed.
    pub fn is_confirmed(&self) -> bool {
        let mut claimed = self.facts.iter().filter(|fact| fact.claimed);
        claimed.all(|fact| fact.verdict() == Verdict::Confirmed)
    }

    /// A measurement by its name.
    pub fn of(&self, fact: &str) -> Option<&Measured> {
        self.facts.iter().find(|measured| measured.fact == fact)
    }
}

impl fmt::Display for StepVerification {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{:<18} {:<9} {:>9} {:>9} {:>9}  verdict",
            "fact", "claimed", "value", "bound", "control"
        )?;
        for fact in &self.facts {
            let verdict = match fact.verdict() {
                Verdict::Confirmed => "confirmed",
                Verdict::Violated => "VIOLATED",
                Verdict::Unclaimed => "holds, not claimed",
                Verdict::Absent => "does not hold",
                Verdict::Undecided => "undecided: take a longer step",
            };
            let claimed = if fact.claimed { "yes" } else { "no" };
            let (name, value, bound) = (fact.fact, fact.value, fact.bound);
            match fact.control {
                None => writeln!(
                    f,
                    "{name:<18} {claimed:<9} {value:>9.2} {bound:>9.2} {:>9}  {verdict}",
                    ""
                )?,
                Some(control) => writeln!(
                    f,
                    "{name:<18} {claimed:<9} {value:>9.1e} {bound:>9.1e} {control:>9.1e}  {verdict}"
                )?,
            }
        }
        Ok(())
    }
}

/// Measures a step `step(mu, h)` that somebody wrote for the field of `system`, from the state `mu` with steps of size h and
/// fractions of it, beside what is claimed: the order by the slope of the error against a reference solution, the symmetry as
/// `|Phi_-h(Phi_h(mu)) - mu|`, the drift of energy and Casimirs over 100 steps, and the Poisson property as the largest entry
/// of `D Pi(mu) D^T - Pi(Phi_h(mu))` with D by central differences. All but the order are relative.
///
/// Take for h about a tenth of the time in which the state changes: beside each value stands that of the classical
/// Runge–Kutta method, and where that passes as well nothing is decided.
///
/// # Errors
/// The first error of a step.
///
/// ```
/// use lie_runtime::diagnostics::{Claims, Verdict, verify_step};
/// use lie_runtime::nalgebra::Vector3;
/// use lie_runtime::prelude::*;
///
/// lie_poisson! {
///     system Body;
///     algebra = so(3);
///     state x, y, z;
///     parameters { a = 1; b = 1/2; c = 1/3; }
///     hamiltonian = (a*x^2 + b*y^2 + c*z^2)/2;
///     casimir C = x^2 + y^2 + z^2;
/// }
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let body = Body::new().system()?;
/// // Heun's method, with a claim too many
/// let heun = |mu: &mut Vector3<f64>, h: f64| -> Result<(), std::convert::Infallible> {
///     let (mut first, mut second) = (*mu, *mu);
///     body.vector_field(mu, &mut first);
///     body.vector_field(&(*mu + h * first), &mut second);
///     *mu += (h / 2.0) * (first + second);
///     Ok(())
/// };
/// let claims = Claims { order: 2, symmetric: true, ..Claims::NONE };
/// let found = verify_step(&body, &[1.0, 0.4, 0.2].into(), 0.3, &claims, heun)?;
/// assert_eq!(found.of("order").map(|fact| fact.verdict()), Some(Verdict::Confirmed));
/// assert!(!found.is_confirmed(), "it is not symmetric:\n{found}");
/// # Ok(()) }
/// ```
pub fn verify_step<P: Poisson<f64>, E>(
    system: &P,
    mu: &P::State,
    h: f64,
    claims: &Claims,
    mut step: impl FnMut(&mut P::State, f64) -> Result<(), E>,
) -> Result<StepVerification, E> {
    let kept = claims.preserves.on(system);
    let quadratic = |degree: Option<u32>| degree.is_some_and(|degree| degree <= 2);
    let constant = system.poisson_degree() == Some(0);
    let mut facts = vec![order(system, mu, h, claims.order, &mut step)?];
    let mut control = |mu: &mut P::State, h: f64| -> Result<(), Infallible> {
        runge_kutta(system, mu, h);
        Ok(())
    };
    let mut fact = |fact, claimed, bound, value: f64, control: Result<f64, Infallible>| {
        let control = Some(control.unwrap_or_else(|never| match never {}));
        facts.push(Measured {
            fact,
            claimed,
            value,
            bound,
            control,
        });
    };
    let symmetric = symmetry(mu, h, &mut step)?;
    fact(
        "symmetric",
        claims.symmetric,
        PER_STEP,
        symmetric,
        symmetry(mu, h, &mut control),
    );
    let energy = |mu: &P::State| system.hamiltonian(mu);
    let claimed = kept.keeps_energy(system);
    let bound = f64::from(STEPS) * PER_STEP;
    let value = drift(mu, h, &energy, &mut step)?;
    fact(
        "energy",
        claimed,
        bound,
        value,
        drift(mu, h, &energy, &mut control),
    );
    for (name, of_degree_two) in [("quadratic Casimirs", true), ("other Casimirs", false)] {
        let members = (0..system.casimir_count()).filter(|&index| {
            !system.casimir_is_multivalued(index) && system.casimir_is_kept(index)
        });
        let members =
            members.filter(|index| quadratic(system.casimir_degree(*index)) == of_degree_two);
        let claimed = kept.casimirs || (of_degree_two && kept.quadratic_casimirs);
        let mut largest: Option<[f64; 2]> = None;
        for index in members {
            let casimir = |mu: &P::State| {
                let mut all = vec![0.0; system.casimir_count()];
                system.casimirs(mu, &mut all);
                all[index]
            };
            let value = drift(mu, h, &casimir, &mut step)?;
            let other = drift(mu, h, &casimir, &mut control).unwrap_or_else(|never| match never {});
            let before = largest.unwrap_or([0.0; 2]);
            largest = Some([worse(before[0], value), worse(before[1], other)]);
        }
        if let Some([value, control]) = largest {
            fact(name, claimed, bound, value, Ok(control));
        }
    }
    let claimed = kept.poisson || (constant && kept.constant_poisson);
    let value = poisson(system, mu, h, &mut step)?;
    fact(
        "Poisson",
        claimed,
        DIFFERENCES,
        value,
        poisson(system, mu, h, &mut control),
    );
    Ok(StepVerification { facts })
}
