//! Wiener processes of a fine grid, and steps of a method along them: the increment of a coarse step is the sum of those of the fine ones
//! within it.

use lie_runtime::Clock;
use lie_runtime::diagnostics::AnyMethod;
use lie_runtime::driver::Wiener;
use lie_runtime::newton::NewtonOptions;
use lie_runtime::poisson::Poisson;
use lie_runtime::state::State;

/// Where the rates of a system are among its coordinates, and which coordinates move.
#[derive(Clone, Copy, Debug)]
pub(super) struct Places {
    clock: Clock,
    /// The first rate.
    pub(super) first: usize,
    /// The number of rates.
    pub(super) count: usize,
}

impl Places {
    /// Those of a system; none without noise.
    pub(super) fn of<P: Poisson<f64>>(system: &P) -> Option<Self> {
        let (count, clock) = (system.noise_count(), system.clock()?);
        (count > 0).then(|| Self {
            clock,
            first: clock.time + 2 + system.input_count(),
            count,
        })
    }

    /// The momenta, in front of all other coordinates.
    pub(super) fn momenta(&self) -> usize {
        self.clock.momentum
    }

    /// The coordinates that move: momenta, and entries of a group element. What carries the time and what is held are none of these.
    pub(super) fn own(self) -> impl Iterator<Item = usize> + Clone {
        let Clock { momentum, time } = self.clock;
        (0..momentum).chain(momentum + 1..time)
    }

    /// Whether all that moves are momenta.
    pub(super) fn has_momenta_alone(&self) -> bool {
        self.clock.momentum + 1 == self.clock.time
    }

    /// The values of the coordinates that move.
    pub(super) fn values(self, mu: &[f64]) -> impl Iterator<Item = f64> + Clone {
        self.own().map(move |place| mu[place])
    }

    /// The largest of them.
    pub(super) fn size(&self, mu: &[f64]) -> f64 {
        self.values(mu).fold(0.0, |m, x| f64::max(m, x.abs()))
    }

    /// The rates of a state.
    pub(super) fn rates<'a, V: State<f64>>(&self, mu: &'a mut V) -> &'a mut [f64] {
        &mut mu.as_mut_slice()[self.first..self.first + self.count]
    }
}

/// The increments of one path, those of a step together.
#[derive(Clone, Debug)]
pub(super) struct Increments {
    values: Vec<f64>,
    count: usize,
}

impl Increments {
    /// So many steps over a span, of a path by its number.
    pub(super) fn draw(places: Places, seed: u64, path: u64, steps: usize, span: f64) -> Self {
        let count = places.count;
        let (wiener, size) = (Wiener::new(seed, &[path], count), span / steps as f64);
        let mut values = vec![0.0; steps * count];
        for (step, rates) in values.chunks_mut(count).enumerate() {
            wiener.rates(step as u64, size, rates);
            rates.iter_mut().for_each(|rate| *rate *= size);
        }
        Self { values, count }
    }

    /// The number of steps.
    pub(super) fn steps(&self) -> usize {
        self.values.len() / self.count
    }

    /// Those of a step.
    pub(super) fn step(&self, step: usize) -> &[f64] {
        &self.values[step * self.count..][..self.count]
    }

    /// The same path in fewer steps, a divisor of their number.
    pub(super) fn in_steps(&self, steps: usize) -> Self {
        let within = self.steps() / steps * self.count;
        let mut values = vec![0.0; steps * self.count];
        for (sums, fine) in values
            .chunks_mut(self.count)
            .zip(self.values.chunks(within))
        {
            for increments in fine.chunks(self.count) {
                sums.iter_mut().zip(increments).for_each(|(s, x)| *s += x);
            }
        }
        Self {
            values,
            count: self.count,
        }
    }

    /// The path of the opposite sign, which is as likely.
    pub(super) fn negated(&self) -> Self {
        Self {
            values: self.values.iter().map(|x| -x).collect(),
            count: self.count,
        }
    }

    /// The path whose steps change places in pairs, which is as likely: the same one in half as many steps, but the areas between its processes
    /// within these have the opposite sign (M. B. Giles, L. Szpruch, 2014, doi:10.1214/13-AAP957).
    pub(super) fn in_turned_pairs(&self) -> Self {
        let mut values = self.values.clone();
        for pair in values.chunks_exact_mut(2 * self.count) {
            let (first, second) = pair.split_at_mut(self.count);
            first.swap_with_slice(second);
        }
        Self {
            values,
            count: self.count,
        }
    }
}

/// The largest increment of a step, which a run bounds where a method solves for its steps.
pub(super) fn bound<P: Poisson<f64>>(method: &dyn AnyMethod<f64, P>, h: f64) -> f64 {
    match method.claims().explicit {
        true => f64::INFINITY,
        false => Wiener::bound(h) * h.sqrt(),
    }
}

/// The end of a path by steps of a method, which holds rates and bounds their increments as a run does; none where a step fails, or ends where
/// nothing is a number.
pub(super) fn end<P: Poisson<f64>>(
    system: &P,
    method: &dyn AnyMethod<f64, P>,
    places: Places,
    (start, span): (&P::State, f64),
    increments: &Increments,
) -> Option<P::State> {
    let h = span / increments.steps() as f64;
    let mut stepper = method.any_stepper(system, h, &NewtonOptions::default());
    let bound = bound(method, h);
    let mut mu = start.clone();
    for step in 0..increments.steps() {
        let rates = places.rates(&mut mu).iter_mut().zip(increments.step(step));
        rates.for_each(|(rate, x)| *rate = x.clamp(-bound, bound) / h);
        stepper.step(&mut mu).ok()?;
    }
    places.rates(&mut mu).fill(0.0);
    mu.as_slice().iter().all(|x| x.is_finite()).then_some(mu)
}
