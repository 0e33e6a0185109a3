//! The flow of forces that have one in closed form.

use super::noise::quieten;
use crate::poisson::Poisson;
use crate::scalar::{Mask as _, Scalar};
use crate::state::State;

/// Terms of the series of one part, at the most: where the part of a matrix has norm 1, the last is below round-off.
const MAX_TERMS: u32 = 24;

/// How often a time is halved, at the most.
const MAX_HALVINGS: u32 = 14;

/// The exact flow of linear friction and constant forces alone:
///
/// ```math
/// \dot\mu = F(\mu) = a - K \mu, \qquad \mu(t) = \mu + t\, \varphi_1(-t K)\, F(\mu), \qquad
/// \varphi_1(z) = \frac{e^z - 1}{z}
/// ```
///
/// `$a$` and `$K$` may depend on the time and on inputs, which stand still meanwhile. Where K is diagonal it is
/// `$\mu_i(t) = e^{-k_i t} \mu_i + a_i (1 - e^{-k_i t})/k_i$`, coordinate by coordinate, from the force at two states. Where the force on a
/// coordinate depends on others ([`Poisson::force_mixes`]) the series of `$\varphi_1$` is summed, over parts of t in which `$t K$` has at most
/// norm 1; of a time so long that it would take more than 16,384 parts the result is not a number.
///
/// A force that is not of this form gives another flow: whoever asks for this one has proven it. The momentum of the time moves by
/// what H loses.
#[derive(Clone, Debug)]
pub struct Friction<V> {
    probe: V,
    once: V,
    twice: V,
    mixing: Option<Mixing<V>>,
}

/// Space for forces that mix coordinates.
#[derive(Clone, Debug)]
struct Mixing<V> {
    /// How far the flow has come from the state.
    change: V,
    term: V,
    sum: V,
}

impl<V> Friction<V> {
    /// The space of a system.
    pub fn new<S, P>(system: &P) -> Self
    where
        S: Scalar,
        V: State<S>,
        P: Poisson<S, State = V>,
    {
        let zero = system.zero_state();
        let mixing = || Mixing {
            change: zero.clone(),
            term: zero.clone(),
            sum: zero.clone(),
        };
        Self {
            mixing: system.force_mixes().then(mixing),
            probe: zero.clone(),
            once: zero.clone(),
            twice: zero,
        }
    }

    /// The flow over a time t, which may be negative.
    pub fn flow<S, P>(&mut self, system: &P, t: S, mu: &mut V)
    where
        S: Scalar,
        V: State<S>,
        P: Poisson<S, State = V>,
    {
        let clock = system.clock();
        let own = clock.map_or(system.dimension(), |clock| clock.momentum);
        let before = system.energy(mu);
        self.probe.copy_from(mu);
        // noise is a piece of its own
        quieten(system, &mut self.probe);
        match self.mixing.is_some() {
            true => self.mixed(system, t, own, mu),
            false => self.apart(system, t, own, mu),
        }
        if let Some(clock) = clock {
            let change = system.energy(mu) - before;
            mu.as_mut_slice()[clock.momentum] -= change;
        }
    }

    /// Coordinate by coordinate.
    fn apart<S, P>(&mut self, system: &P, t: S, own: usize, mu: &mut V)
    where
        S: Scalar,
        V: State<S>,
        P: Poisson<S, State = V>,
    {
        let two = S::ratio(2.0, 1.0);
        for (value, out) in [(S::one(), &mut self.once), (two, &mut self.twice)] {
            self.probe.as_mut_slice()[..own].fill(value);
            system.force(&self.probe, out);
        }
        let forces = self.once.as_slice().iter().zip(self.twice.as_slice());
        for (entry, (&once, &twice)) in mu.as_mut_slice()[..own].iter_mut().zip(forces) {
            let rate = once - twice;
            let push = once + rate;
            let change = (-(rate * t)).expm1();
            let idle = rate.abs().less_equal(S::zero());
            let divisor = S::select(idle, S::one(), rate);
            let weight = S::select(idle, t, -(change / divisor));
            *entry += change * *entry + weight * push;
        }
    }

    /// The change by the series, part by part; lanes whose time is over stand still.
    fn mixed<S, P>(&mut self, system: &P, t: S, own: usize, mu: &mut V)
    where
        S: Scalar,
        V: State<S>,
        P: Poisson<S, State = V>,
    {
        let parts = self.parts(system, t, own);
        let part = t / parts;
        let Some(Mixing { change, term, sum }) = &mut self.mixing else {
            return;
        };
        // of too many parts nothing is computed
        change.fill(S::select(parts.finite(), S::zero(), parts));
        let mut left = parts;
        loop {
            let open = S::zero().less(left);
            if !open.any() {
                break;
            }
            for (probe, (&mu, &change)) in places(&mut self.probe, mu, change).take(own) {
                *probe = mu + change;
            }
            system.force(&self.probe, term);
            scale(term, own, part);
            sum.copy_from(term);
            let (mut active, mut small_before) = (open, S::Mask::splat(false));
            for index in 2..=MAX_TERMS {
                self.probe.as_mut_slice()[..own].copy_from_slice(&term.as_slice()[..own]);
                system.force(&self.probe, &mut self.twice);
                for (term, (&force, &constant)) in places(term, &self.twice, &self.once).take(own) {
                    *term = force - constant;
                }
                scale(term, own, part * S::ratio(1.0, f64::from(index)));
                let bound = S::epsilon() * S::ratio(1.0, 8.0) * largest(sum, own);
                for (sum, &term) in sum.as_mut_slice().iter_mut().zip(term.as_slice()).take(own) {
                    *sum = S::select(active, *sum + term, *sum);
                }
                let small = largest(term, own).less_equal(bound);
                active = active & !(small & small_before);
                small_before = small;
                if !active.any() {
                    break;
                }
            }
            for (change, &sum) in change
                .as_mut_slice()
                .iter_mut()
                .zip(sum.as_slice())
                .take(own)
            {
                *change = S::select(open, *change + sum, *change);
            }
            left -= S::one();
        }
        for (mu, &change) in mu
            .as_mut_slice()
            .iter_mut()
            .zip(change.as_slice())
            .take(own)
        {
            *mu += change;
        }
    }

    /// Into how many parts a time is divided, a power of two, so that `$t K$` has at most norm 1 in each; not a number where that is too many.
    /// Leaves the force at 0 in `once`.
    fn parts<S, P>(&mut self, system: &P, t: S, own: usize) -> S
    where
        S: Scalar,
        V: State<S>,
        P: Poisson<S, State = V>,
    {
        self.probe.as_mut_slice()[..own].fill(S::zero());
        system.force(&self.probe, &mut self.once);
        let mut norm = S::zero();
        for column in 0..own {
            self.probe.as_mut_slice()[column] = S::one();
            system.force(&self.probe, &mut self.twice);
            self.probe.as_mut_slice()[column] = S::zero();
            let forces = self.twice.as_slice().iter().zip(self.once.as_slice());
            let sizes = forces
                .take(own)
                .map(|(&force, &constant)| (force - constant).abs());
            norm = norm.max(sizes.fold(S::zero(), |sum, size| sum + size));
        }
        let reach = t.abs() * norm;
        let mut parts = S::one();
        for _ in 0..MAX_HALVINGS {
            let short = parts.less(reach);
            if !short.any() {
                return parts;
            }
            parts = S::select(short, parts + parts, parts);
        }
        S::select(reach.less_equal(parts), parts, S::zero() / S::zero())
    }
}

/// The entries of one state to be set, with those of two others.
fn places<'a, S: Scalar, V: State<S>>(
    to: &'a mut V,
    one: &'a V,
    other: &'a V,
) -> impl Iterator<Item = (&'a mut S, (&'a S, &'a S))> {
    let from = one.as_slice().iter().zip(other.as_slice());
    to.as_mut_slice().iter_mut().zip(from)
}

fn scale<S: Scalar, V: State<S>>(state: &mut V, own: usize, factor: S) {
    for entry in &mut state.as_mut_slice()[..own] {
        *entry *= factor;
    }
}

fn largest<S: Scalar, V: State<S>>(state: &V, own: usize) -> S {
    let entries = state.as_slice()[..own].iter();
    entries.fold(S::zero(), |most, entry| most.max(entry.magnitude()))
}
