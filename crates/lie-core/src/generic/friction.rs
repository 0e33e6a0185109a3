//! The flow of forces that have one in closed form.

use super::noise::quieten;
use crate::poisson::Poisson;
use crate::scalar::Scalar;
use crate::state::State;

/// The exact flow of linear friction and constant forces alone, coordinate by coordinate:
///
/// ```math
/// \dot\mu_i = a_i - k_i\, \mu_i, \qquad
/// \mu_i(t) = e^{-k_i t} \mu_i + \frac{1 - e^{-k_i t}}{k_i}\, a_i
/// ```
///
/// `$a_i$` and `$k_i$` may depend on the time and on inputs, which stand still meanwhile. They are found from the force at two states,
/// so that a force that is not of this form gives another flow: whoever asks for this one has proven it. The momentum of the time moves by
/// what H loses.
#[derive(Clone, Debug)]
pub struct Friction<V> {
    probe: V,
    once: V,
    twice: V,
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
        Self {
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
        if let Some(clock) = clock {
            let change = system.energy(mu) - before;
            mu.as_mut_slice()[clock.momentum] -= change;
        }
    }
}
