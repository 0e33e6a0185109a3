//! Initial states drawn at random around others, each by its number: the same ones whoever draws them, in whatever order.

use std::f64::consts::PI;

use lie_dynamic::{Declared, Dynamic};
use lie_runtime::matrix::SquareMatrix as _;
use lie_runtime::{LiePoisson, Poisson, Scalar};

/// How many states are drawn around each, and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Draw {
    /// So many around each.
    pub count: usize,
    /// Other seeds give other states.
    pub seed: u64,
    /// How far they go.
    pub spread: Spread,
}

/// How far from a state others are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spread {
    /// By elements of the algebra whose coordinates are independent and normal, with this standard deviation.
    Normal(f64),
    /// Over the whole orbit, uniformly.
    Orbit,
}

/// Of a walk over an orbit, so many steps of the standard deviation 1: on so(3) each takes a third of what distinguishes the
/// distribution from the uniform one.
const WALK: usize = 40;
/// Steps of a flow that has no closed form.
const STEPS: usize = 64;

/// States to be drawn in a space. What draws them knows no method: the states are the same for each.
#[derive(Clone)]
pub struct Drawn {
    /// How many, and how.
    pub draw: Draw,
    /// The system before its parameters have values.
    pub declared: Declared,
    /// Whether the space is one of coadjoint orbits.
    pub orbits: bool,
}

impl Draw {
    /// The state with a number around another one: where the flow of a linear Hamiltonian takes it.
    ///
    /// ```math
    /// \mu = \mathrm{Ad}^*_{\exp \xi}\, \mu_0, \qquad \xi_i \sim \mathcal{N}(0, \sigma^2)
    /// ```
    ///
    /// On a Lie–Poisson space it is on the coadjoint orbit of the other one, to round-off. Of any other bracket the
    /// flow of `x' = Pi(x) xi` is taken in 64 steps of RK4 to the time 1: it leaves the symplectic leaf by the error of that.
    /// What carries the time stays. A uniform distribution over an orbit of a compact group is that of a long walk of such steps.
    pub fn state(
        &self,
        system: &Dynamic<f64>,
        orbits: bool,
        from: &[f64],
        number: u64,
    ) -> Vec<f64> {
        let mut source = Source::new(self.seed, number);
        let (steps, deviation) = match self.spread {
            Spread::Normal(deviation) => (1, deviation),
            Spread::Orbit => (WALK, 1.0),
        };
        let mut state = from.to_vec();
        let mut xi = vec![0.0; state.len()];
        let clock = Poisson::<f64>::clock(system).map(|clock| clock.time);
        let carried = |place: usize| clock.is_some_and(|time| place == time || place == time + 1);
        for _ in 0..steps {
            for (place, entry) in xi.iter_mut().enumerate() {
                *entry = match carried(place) {
                    true => 0.0,
                    false => deviation * source.normal(),
                };
            }
            state = match orbits {
                true => {
                    let mut moved = state.clone();
                    system.coadjoint_action(&xi, &state, &mut moved);
                    moved
                }
                false => along(system, &xi, state),
            };
        }
        for (place, entry) in state.iter_mut().enumerate() {
            if carried(place) {
                *entry = from[place];
            }
        }
        state
    }
}

/// Whether the group keeps the Euclidean norm of the coordinates, as a compact one does in a basis that suits it: then each
/// orbit is bounded, and has a uniform distribution. Asked at random elements and states.
pub fn keeps_norm(system: &Dynamic<f64>) -> bool {
    let mut source = Source::new(0, 0);
    let size = Poisson::<f64>::dimension(system);
    let mut image = vec![0.0; size];
    (0..8).all(|_| {
        let mut vector = || -> Vec<f64> { (0..size).map(|_| source.normal()).collect() };
        let (xi, mu) = (vector(), vector());
        system.ad_star(&xi, &mu, &mut image);
        let parts = mu.iter().zip(&image).map(|(a, b)| a * b);
        let (sum, sizes) = parts.fold((0.0, 0.0), |(sum, sizes): (f64, f64), part| {
            (sum + part, sizes + part.abs())
        });
        sum.abs() <= 1e-12 * sizes
    })
}

/// The flow of the linear Hamiltonian of an element to the time 1.
fn along(system: &Dynamic<f64>, xi: &[f64], mut state: Vec<f64>) -> Vec<f64> {
    let step = 1.0 / STEPS as f64;
    let mut matrix = Poisson::<f64>::zero_jacobian(system);
    let mut field = |state: &Vec<f64>| -> Vec<f64> {
        system.poisson_matrix(state, &mut matrix);
        let row = |i| {
            xi.iter()
                .enumerate()
                .map(|(j, x)| matrix.get(i, j) * x)
                .sum()
        };
        (0..xi.len()).map(row).collect()
    };
    let moved = |state: &[f64], by: f64, field: &[f64]| -> Vec<f64> {
        state.iter().zip(field).map(|(x, f)| x + by * f).collect()
    };
    for _ in 0..STEPS {
        let first = field(&state);
        let second = field(&moved(&state, step / 2.0, &first));
        let third = field(&moved(&state, step / 2.0, &second));
        let fourth = field(&moved(&state, step, &third));
        for (i, x) in state.iter_mut().enumerate() {
            *x += step / 6.0 * (first[i] + 2.0 * (second[i] + third[i]) + fourth[i]);
        }
    }
    state
}

/// SplitMix64: G. L. Steele, D. Lea, C. H. Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014,
/// [doi:10.1145/2660193.2660195](https://doi.org/10.1145/2660193.2660195).
struct Source(u64);

impl Source {
    /// A stream of its own for each seed and number.
    fn new(seed: u64, number: u64) -> Self {
        let begin = Self(seed).next();
        Self(Self(begin ^ number).next())
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// A number above 0 and at most 1, with 53 bits.
    fn uniform(&mut self) -> f64 {
        ((self.next() >> 11) + 1) as f64 / (1_u64 << 53) as f64
    }

    /// A normally distributed number, by the method of Box and Muller.
    fn normal(&mut self) -> f64 {
        let radius = (-2.0 * Scalar::log(self.uniform())).sqrt();
        radius * Scalar::cos(2.0 * PI * self.uniform())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lie_codegen::compile::compile_spec;

    fn system(name: &str) -> (Dynamic<f64>, Vec<f64>, bool) {
        let path = format!("{}/../../specs/{name}.json", env!("CARGO_MANIFEST_DIR"));
        let model = compile_spec(&std::fs::read_to_string(path).unwrap()).unwrap();
        let declared = crate::declared(&model).unwrap();
        let system = declared.system(&model.defaults()).unwrap();
        let initial = system.initial_state().unwrap();
        (system, initial, model.is_lie_poisson())
    }

    fn casimirs(system: &Dynamic<f64>, state: &Vec<f64>) -> Vec<f64> {
        let count = Poisson::<f64>::casimir_count(system);
        let mut values = vec![0.0; count];
        system.casimirs(state, &mut values);
        values
    }

    #[test]
    fn states_are_on_the_orbit_and_not_all_near() {
        for (name, spread) in [
            ("so3_free_rigid_body", Spread::Normal(0.1)),
            ("so3_free_rigid_body", Spread::Orbit),
            ("se3_heavy_top", Spread::Normal(0.3)),
            ("lotka_volterra", Spread::Normal(0.05)),
        ] {
            let (system, initial, orbits) = system(name);
            let draw = Draw {
                count: 100,
                seed: 7,
                spread,
            };
            let expected = casimirs(&system, &initial);
            let mut far = 0.0_f64;
            for number in 0..100 {
                let state = draw.state(&system, orbits, &initial, number);
                for (found, expected) in casimirs(&system, &state).iter().zip(&expected) {
                    let error = (found - expected).abs() / (1.0 + expected.abs());
                    let most = if orbits { 1e-13 } else { 1e-8 };
                    assert!(error < most, "{name}, {spread:?}: {error:e}");
                }
                let moved = state.iter().zip(&initial).map(|(a, b)| (a - b).abs());
                far = moved.fold(far, f64::max);
                assert_eq!(state, draw.state(&system, orbits, &initial, number));
            }
            assert!(far > 0.01, "{name}, {spread:?}: {far}");
        }
    }

    #[test]
    fn an_orbit_is_covered_evenly() {
        let (system, initial, orbits) = system("so3_free_rigid_body");
        assert!(keeps_norm(&system) && !keeps_norm(&self::system("se3_heavy_top").0));
        let count = 20_000;
        let moments = |spread| {
            let draw = Draw {
                count,
                seed: 1,
                spread,
            };
            let norm = initial.iter().map(|x| x * x).sum::<f64>();
            let mut moments = [0.0; 6];
            for number in 0..count as u64 {
                let state = draw.state(&system, orbits, &initial, number);
                for i in 0..3 {
                    moments[i] += state[i] / norm.sqrt() / count as f64;
                    moments[3 + i] += state[i] * state[i] / norm / count as f64;
                }
            }
            moments
        };
        // of a uniform distribution on the sphere 0 and 1/3, to four standard deviations of the mean
        let even = |moments: [f64; 6]| {
            (0..3).all(|i| moments[i].abs() < 4.0 / (3.0 * count as f64).sqrt())
                && (3..6)
                    .all(|i| (moments[i] - 1.0 / 3.0).abs() < 4.0 * 0.3 / (count as f64).sqrt())
        };
        assert!(even(moments(Spread::Orbit)), "{:?}", moments(Spread::Orbit));
        assert!(!even(moments(Spread::Normal(1.0))), "the control");
    }
}
