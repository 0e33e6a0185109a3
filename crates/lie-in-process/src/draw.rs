//! Initial states drawn at random around others, each by its number: the same ones whoever draws them, in whatever order.

mod directions;

use directions::Directions;
use lie_dynamic::{Declared, Dynamic};
use lie_runtime::family::SplitMix;
use lie_runtime::matrix::SquareMatrix as _;
use lie_runtime::{LiePoisson, Poisson};

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

/// Of a walk over an orbit so many steps of [`Directions`]. Each leaves about a third of what distinguishes the mean from that of
/// the uniform distribution, on each simple factor: on so(3) a third, since `E cos` of the angle is 0.
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
    /// Draws in a system; `orbits` says whether its space is one of coadjoint orbits.
    pub fn within<'a>(&self, system: &'a Dynamic<f64>, orbits: bool) -> Within<'a> {
        let clock = Poisson::<f64>::clock(system).map(|clock| clock.time);
        let steps = match self.spread {
            Spread::Normal(deviation) => Steps::Normal(deviation),
            Spread::Orbit => Steps::Walk(Directions::of(system)),
        };
        Within {
            system,
            orbits,
            seed: self.seed,
            steps,
            carried: clock.map(|time| [time, time + 1]),
        }
    }
}

/// Draws states in one system.
pub struct Within<'a> {
    system: &'a Dynamic<f64>,
    orbits: bool,
    seed: u64,
    steps: Steps,
    /// The places of what carries the time.
    carried: Option<[usize; 2]>,
}

/// What takes a state to another one.
enum Steps {
    /// One element with independent coordinates.
    Normal(f64),
    /// Many, one after the other.
    Walk(Directions),
}

impl Within<'_> {
    /// The state with a number around another one: where the flow of a linear Hamiltonian takes it.
    ///
    /// ```math
    /// \mu = \mathrm{Ad}^*_{\exp \xi}\, \mu_0, \qquad \xi_i \sim \mathcal{N}(0, \sigma^2)
    /// ```
    ///
    /// On a Lie–Poisson space it is on the coadjoint orbit of the other one, to round-off. Of any other bracket the
    /// flow of `x' = Pi(x) xi` is taken in 64 steps of RK4 to the time 1: it leaves the symplectic leaf by the error of that.
    /// What carries the time stays. A uniform distribution over an orbit of a compact group is that of a long walk, whose steps
    /// have on each simple factor the size that they have on so(3), whatever the structure constants.
    pub fn state(&self, from: &[f64], number: u64) -> Vec<f64> {
        let mut source = stream(self.seed, number);
        let mut state = from.to_vec();
        let mut xi = vec![0.0; state.len()];
        match &self.steps {
            Steps::Normal(deviation) => {
                for (place, entry) in xi.iter_mut().enumerate() {
                    if !self.carries(place) {
                        *entry = deviation * source.normal();
                    }
                }
                state = self.moved(&xi, state);
            }
            Steps::Walk(directions) => {
                for _ in 0..WALK {
                    directions.draw(&mut source, &mut xi);
                    state = self.moved(&xi, state);
                }
            }
        }
        for (place, entry) in state.iter_mut().enumerate() {
            if self.carries(place) {
                *entry = from[place];
            }
        }
        state
    }

    fn carries(&self, place: usize) -> bool {
        self.carried.is_some_and(|places| places.contains(&place))
    }

    fn moved(&self, xi: &Vec<f64>, state: Vec<f64>) -> Vec<f64> {
        if !self.orbits {
            return along(self.system, xi, state);
        }
        let mut moved = state.clone();
        self.system.coadjoint_action(xi, &state, &mut moved);
        moved
    }
}

/// Whether the group keeps the Euclidean norm of the coordinates, as a compact one does in a basis that suits it: then each
/// orbit is bounded, and has a uniform distribution. Asked at random elements and states; what carries the time is none of these.
pub fn keeps_norm(system: &Dynamic<f64>) -> bool {
    let mut source = stream(0, 0);
    let size = Poisson::<f64>::dimension(system);
    let clock = Poisson::<f64>::clock(system);
    let carries = |place| clock.is_some_and(|clock| clock.holds(place));
    let mut image = vec![0.0; size];
    (0..8).all(|_| {
        let mut entry = |place| if carries(place) { 0.0 } else { source.normal() };
        let mut vector = || -> Vec<f64> { (0..size).map(&mut entry).collect() };
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

/// A stream of its own for each seed and number.
fn stream(seed: u64, number: u64) -> SplitMix {
    let begin = SplitMix::new(seed).bits();
    SplitMix::new(SplitMix::new(begin ^ number).bits())
}

#[cfg(test)]
mod tests;
