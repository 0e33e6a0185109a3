//! What all measurements on one system share.

use super::group::{self, GroupCheck};
use super::noise::{Noise, Thermal};
use crate::integrals::{Integral, integrals};
use crate::orbit::orbit_distance;
use crate::random::Random;
use lie_runtime::diagnostics::reference;
use lie_runtime::matrix::SquareMatrix;
use lie_runtime::poisson::{LiePoisson, Lift, Poisson};
use lie_runtime::scalar::Scalar;
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
    /// Paths of noise, where there is some.
    pub noise: Option<Noise<P::State>>,
}

/// The distance of the second state from the orbit of the first.
pub type OrbitDistance<P> = fn(&P, &<P as Poisson<f64>>::State, &<P as Poisson<f64>>::State) -> f64;

/// The solutions over one span.
pub struct Exact<V> {
    /// The span.
    pub span: f64,
    /// Where they start: the states of the ground. Where several processes of noise act, without their rates: methods that take one process
    /// after the other have the order that they claim for the motion alone, and a weak one for noise.
    pub starts: Vec<V>,
    /// The states at its end, from each of these.
    pub ends: Vec<V>,
    /// Their error, relative to the state.
    pub error: f64,
}

impl<V: State<f64>> Exact<V> {
    fn new<P: Poisson<f64, State = V>>(system: &P, states: &[V], span: f64) -> Option<Self> {
        let mut starts = states.to_vec();
        if system.tosses_coin() {
            let rates = system.dimension() - system.noise_count()..;
            let all = starts.iter_mut();
            all.for_each(|mu| mu.as_mut_slice()[rates.clone()].fill(0.0));
        }
        let mut ends = Vec::new();
        let mut error = 0.0_f64;
        for mu in &starts {
            let solution = reference(system, mu, span)?;
            error = error.max(solution.error / solution.mu.max_norm());
            ends.push(solution.mu);
        }
        Some(Self {
            span,
            starts,
            ends,
            error,
        })
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
        let rate = states
            .iter()
            .map(|mu| rate(system, mu))
            .fold(0.0, Scalar::max);
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
        let kept = |integral: &Integral| holds(integral, &exact);
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
            noise: None,
        })
    }

    /// The same with paths of a seed where the system has noise, and with what is known of the density that it leaves invariant.
    #[must_use]
    pub fn with_noise(
        self,
        system: &P,
        lifted: &P::Lifted,
        noise: (u64, Option<&Thermal>),
    ) -> Self {
        let noise = Noise::new(system, lifted, &self, noise);
        Self { noise, ..self }
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
fn holds<V: State<f64>>(integral: &Integral, exact: &[Exact<V>]) -> bool {
    exact.iter().all(|exact| {
        exact.starts.iter().zip(&exact.ends).all(|(mu, end)| {
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
        let near = random.near_state(system, initial, part);
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

/// The most rows of a matrix that is made for a system that keeps none.
const MOST_ROWS: usize = 64;

/// The largest absolute sum of a row of the field's Jacobian: an upper bound of all rates of change. Of a large system that
/// keeps no matrix it is estimated.
pub(crate) fn rate<P: Poisson<f64>>(system: &P, mu: &P::State) -> f64 {
    if !system.has_jacobian() && system.dimension() > MOST_ROWS {
        return estimated_rate(system, mu);
    }
    let mut jacobian = system.zero_jacobian();
    system.jacobian(mu, &mut jacobian);
    let row = |i| {
        (0..system.dimension())
            .map(|j| jacobian.get(i, j).abs())
            .sum::<f64>()
    };
    (0..system.dimension()).map(row).fold(0.0, Scalar::max)
}

/// The same from differences of the field along random signs: where they are those of a row, its entry of the derivative is
/// the row's absolute sum. A row has few entries, and many rows are alike.
fn estimated_rate<P: Poisson<f64>>(system: &P, mu: &P::State) -> f64 {
    const DIRECTIONS: usize = 32;
    let length = f64::EPSILON.sqrt() * mu.max_norm();
    let (mut field, mut moved) = (system.zero_state(), system.zero_state());
    system.vector_field(mu, &mut field);
    let mut random = Random::new(1);
    let mut largest = 0.0;
    for _ in 0..DIRECTIONS {
        let mut near = mu.clone();
        for entry in near.as_mut_slice() {
            *entry += length.copysign(random.unit());
        }
        system.vector_field(&near, &mut moved);
        let pairs = moved.as_slice().iter().zip(field.as_slice());
        largest = pairs.fold(largest, |m, (a, b)| Scalar::max(m, (a - b).abs() / length));
    }
    largest
}

fn structure<P: Poisson<f64>>(system: &P, mu: &P::State) -> f64 {
    let mut matrix = system.zero_jacobian();
    system.poisson_matrix(mu, &mut matrix);
    let entries =
        (0..system.dimension()).flat_map(|i| (0..system.dimension()).map(move |j| (i, j)));
    let largest = entries
        .map(|(i, j)| matrix.get(i, j).abs())
        .fold(0.0, Scalar::max);
    let size = mu.as_slice().iter().fold(0.0, |m, x| f64::max(m, x.abs()));
    if largest > 0.0 { largest / size } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lie_runtime::family::LateMatrix;

    /// Masses on a ring with springs of constant k: `x_i' = p_i`, `p_i' = k (x_(i-1) - 2 x_i + x_(i+1))`, without a matrix.
    /// The constant of the first equation is another.
    struct Ring {
        sites: usize,
        first: f64,
    }

    impl Ring {
        fn constant(&self, i: usize) -> f64 {
            if i == 0 { self.first } else { 2.0 }
        }
    }

    impl Poisson<f64> for Ring {
        type State = Vec<f64>;
        type Jacobian = LateMatrix<f64>;

        fn dimension(&self) -> usize {
            2 * self.sites
        }
        fn name(&self) -> &'static str {
            "Ring"
        }
        fn coordinate(&self, _: usize) -> &'static str {
            "x"
        }
        fn casimir_count(&self) -> usize {
            0
        }
        fn casimir_name(&self, _: usize) -> &'static str {
            "none"
        }
        fn has_jacobian(&self) -> bool {
            false
        }
        fn zero_state(&self) -> Vec<f64> {
            vec![0.0; 2 * self.sites]
        }
        fn zero_jacobian(&self) -> LateMatrix<f64> {
            LateMatrix::new(2 * self.sites)
        }
        fn vector_field(&self, mu: &Vec<f64>, out: &mut Vec<f64>) {
            let n = self.sites;
            for i in 0..n {
                out[i] = mu[n + i];
                let around = mu[(i + n - 1) % n] - 2.0 * mu[i] + mu[(i + 1) % n];
                out[n + i] = self.constant(i) * around;
            }
        }
        fn jacobian(&self, _: &Vec<f64>, out: &mut LateMatrix<f64>) {
            let n = self.sites;
            for i in 0..n {
                out.set(i, n + i, 1.0);
                let k = self.constant(i);
                out.set(n + i, (i + n - 1) % n, k);
                out.set(n + i, i, -2.0 * k);
                out.set(n + i, (i + 1) % n, k);
            }
        }
        fn hamiltonian(&self, _: &Vec<f64>) -> f64 {
            0.0
        }
        fn gradient(&self, _: &Vec<f64>, _: &mut Vec<f64>) {}
        fn hessian(&self, _: &Vec<f64>, _: &mut LateMatrix<f64>) {}
        fn poisson_matrix(&self, _: &Vec<f64>, _: &mut LateMatrix<f64>) {}
        fn casimirs(&self, _: &Vec<f64>, _: &mut [f64]) {}
        fn casimir_gradient(&self, _: usize, _: &Vec<f64>, _: &mut Vec<f64>) {}
    }

    #[test]
    fn a_rate_without_a_matrix_is_that_of_the_matrix() {
        let mut random = Random::new(5);
        for sites in [4, 32, 33, 200] {
            let ring = Ring { sites, first: 2.0 };
            let mu = random.near(&ring.zero_state(), 0.7);
            // 2 + 4 + 2; from 65 coordinates on by differences
            assert!((rate(&ring, &mu) - 8.0).abs() < 1e-5, "{sites}");
            assert!((estimated_rate(&ring, &mu) - 8.0).abs() < 1e-5, "{sites}");
        }
    }

    #[test]
    fn a_row_that_is_not_a_number_is_not_lost_behind_the_others() {
        for sites in [4, 200] {
            let ring = Ring {
                sites,
                first: f64::NAN,
            };
            let mu = Random::new(5).near(&ring.zero_state(), 0.7);
            assert!(rate(&ring, &mu).is_nan(), "{sites}");
        }
    }
}
