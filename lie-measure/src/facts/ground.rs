//! What all measurements on one system share.

use super::group::{self, GroupCheck};
use crate::integrals::{Integral, integrals};
use crate::orbit::orbit_distance;
use crate::random::Random;
use lie_runtime::diagnostics::reference;
use lie_runtime::matrix::SquareMatrix;
use lie_runtime::poisson::{LiePoisson, Lift, Poisson};
use lie_runtime::state::{State, Unknown};
use lie_runtime::structure::MatrixGroup;

/// States near the initial one, on which nothing vanishes by accident, and with it.
const GENERIC: usize = 3;
/// The spans of the measurements of order, in steps.
const SPANS: [f64; 3] = [8.0, 32.0, 128.0];
/// The relative error up to which a reference solution is one.
const RELIABLE: f64 = 1e-9;

/// States, steps, reference solutions and first integrals of a system.
pub struct Ground<P: Lift<f64>> {
    /// The states at which everything is measured: the initial one, then seeded ones near it.
    pub states: Vec<P::State>,
    /// The step of the measurements.
    pub step: f64,
    /// About a third of the shortest time in which the system changes: the step where none is given.
    pub natural_step: f64,
    /// Exact solutions, over a short span and over longer ones: a method of high order is at round-off
    /// after a short one.
    pub exact: Vec<Exact<P::State>>,
    /// Linear first integrals.
    pub linear: Vec<Integral>,
    /// First integrals of degree one and two.
    pub quadratic: Vec<Integral>,
    /// The largest structure constant, about: the size of the Poisson matrix over that of the state.
    pub structure: f64,
    /// The distance of a state from the coadjoint orbit of another, where there are orbits.
    pub orbit: Option<OrbitDistance<P>>,
    /// The check of the group element, where there are matrices.
    pub group: Option<GroupCheck<P>>,
    /// The largest order that is left where the motion crosses a joint of H; absent where H has none.
    pub reach: Option<u32>,
}

/// The distance of the second state from the orbit of the first.
pub type OrbitDistance<P> = fn(&P, &<P as Poisson<f64>>::State, &<P as Poisson<f64>>::State) -> f64;

/// The solutions over one span.
pub struct Exact<V> {
    /// The span.
    pub span: f64,
    /// The states at its end, from each state of the ground.
    pub ends: Vec<V>,
    /// Their error, relative to the state.
    pub error: f64,
}

impl<V: State<f64>> Exact<V> {
    fn new<P: Poisson<f64, State = V>>(system: &P, states: &[V], span: f64) -> Option<Self> {
        let mut ends = Vec::new();
        let mut error = 0.0_f64;
        for mu in states {
            let solution = reference(system, mu, span)?;
            error = error.max(solution.error / solution.mu.max_norm());
            ends.push(solution.mu);
        }
        Some(Self { span, ends, error })
    }
}

impl<P: Lift<f64>> Ground<P> {
    /// Prepares the measurements around an initial state. `step` replaces the step that is found.
    ///
    /// # Errors
    /// Why there is nothing to measure.
    pub fn new(
        system: &P,
        initial: &P::State,
        seed: u64,
        step: Option<f64>,
    ) -> Result<Self, String> {
        let states = states(system, initial, seed)?;
        let rate = states.iter().map(|mu| rate(system, mu)).fold(0.0, f64::max);
        if rate <= 0.0 || !rate.is_finite() {
            return Err(
                "the vector field does not change with the state (its Jacobian is zero or not \
                 finite), and every method makes the same step"
                    .to_owned(),
            );
        }
        let moves = |mu: &P::State| {
            let mut field = system.zero_state();
            system.vector_field(mu, &mut field);
            field.max_norm() > f64::MIN_POSITIVE
        };
        if !states.iter().any(moves) {
            return Err(
                "the vector field is zero, or below the smallest number, near the initial state"
                    .to_owned(),
            );
        }
        let natural_step = 0.3 / rate;
        let step = step.unwrap_or(natural_step);
        let first = Exact::new(system, &states, SPANS[0] * step)
            .ok_or("no reference solution: a number becomes infinite or the steps too small")?;
        if first.error > RELIABLE {
            let error = first.error;
            return Err(format!(
                "the reference solution is not reliable, its error is about {error:.0e}"
            ));
        }
        let mut exact = vec![first];
        for span in &SPANS[1..] {
            let longer = Exact::new(system, &states, span * step);
            exact.extend(longer.filter(|longer| longer.error <= RELIABLE));
        }
        let kept = |integral: &Integral| holds(integral, &states, &exact);
        let mut linear = integrals(system, &states, false);
        linear.retain(kept);
        let mut quadratic = integrals(system, &states, true);
        quadratic.retain(kept);
        let structure = structure(system, &states[states.len() - 1]);
        Ok(Self {
            states,
            step,
            natural_step,
            exact,
            linear,
            quadratic,
            structure,
            orbit: None,
            group: None,
            reach: None,
        })
    }

    /// The same for a system whose states lie on coadjoint orbits.
    #[must_use]
    pub fn with_orbits(self) -> Self
    where
        P: LiePoisson<f64>,
    {
        Self {
            orbit: Some(orbit_distance::<P>),
            ..self
        }
    }

    /// The same for a system whose algebra has matrices.
    #[must_use]
    pub fn with_group(self) -> Self
    where
        P: Lift<f64> + MatrixGroup<f64> + Clone,
    {
        Self {
            group: Some(group::finding::<P>),
            ..self
        }
    }
}

/// Whether a first integral that was found near the states holds along the solutions, which may lead
/// far away: round-off in its coefficients counts there.
fn holds<V: State<f64>>(integral: &Integral, states: &[V], exact: &[Exact<V>]) -> bool {
    exact.iter().all(|exact| {
        states.iter().zip(&exact.ends).all(|(mu, end)| {
            let (mu, end) = (mu.as_slice(), end.as_slice());
            let change = (integral.value(end) - integral.value(mu)).abs();
            change <= (100.0 * exact.error).max(1e-13) * integral.size(mu)
        })
    })
}

fn states<P: Poisson<f64>>(
    system: &P,
    initial: &P::State,
    seed: u64,
) -> Result<Vec<P::State>, String> {
    // nothing moves at the origin of g*, and nothing is relative to it
    let mut other = initial.clone();
    other.fill(1.0);
    let at_origin = initial.max_norm() <= 0.0;
    let initial = if at_origin { &other } else { initial };
    if !usable(system, initial) {
        return Err("H or the vector field is not finite at the initial state".to_owned());
    }
    let mut random = Random::new(seed);
    let mut states = vec![initial.clone()];
    // where the domain of H is narrow the states stay nearer
    let mut part = 0.3;
    for _ in 0..60 {
        if states.len() > GENERIC {
            break;
        }
        let near = random.near(initial, part);
        if usable(system, &near) {
            states.push(near);
        } else {
            part *= 0.8;
        }
    }
    Ok(states)
}

fn usable<P: Poisson<f64>>(system: &P, mu: &P::State) -> bool {
    let mut field = system.zero_state();
    system.vector_field(mu, &mut field);
    field.finite() && system.hamiltonian(mu).is_finite() && rate(system, mu).is_finite()
}

/// The largest absolute sum of a row of the field's Jacobian: an upper bound of all rates of change.
pub(crate) fn rate<P: Poisson<f64>>(system: &P, mu: &P::State) -> f64 {
    let mut jacobian = system.zero_jacobian();
    system.jacobian(mu, &mut jacobian);
    let row = |i| {
        (0..system.dimension())
            .map(|j| jacobian.get(i, j).abs())
            .sum::<f64>()
    };
    (0..system.dimension())
        .map(row)
        .fold(0.0, |m, x| if x.is_nan() { x } else { f64::max(m, x) })
}

fn structure<P: Poisson<f64>>(system: &P, mu: &P::State) -> f64 {
    let mut matrix = system.zero_jacobian();
    system.poisson_matrix(mu, &mut matrix);
    let entries =
        (0..system.dimension()).flat_map(|i| (0..system.dimension()).map(move |j| (i, j)));
    let largest = entries
        .map(|(i, j)| matrix.get(i, j).abs())
        .fold(0.0, f64::max);
    let size = mu.as_slice().iter().fold(0.0, |m, x| f64::max(m, x.abs()));
    if largest > 0.0 { largest / size } else { 1.0 }
}
