//! The flows of noise alone.

use crate::poisson::{LiePoisson, Poisson};
use crate::scalar::Scalar;
use crate::state::State;

/// The exact flows of noise along constant directions, one process after the other:
///
/// ```math
/// \mathrm{d}\mu = \mathrm{ad}^*_{v_k} \mu \circ \mathrm{d}W_k + f_k\, \mathrm{d}W_k, \qquad
/// \mu \mapsto \mathrm{Ad}^*_{\exp(v_k \Delta W_k)}\, \mu + f_k\, \Delta W_k
/// ```
///
/// of which each process has one term. `$v_k$` and `$f_k$` may depend on the time and on inputs, which stand still meanwhile; they are the part of
/// [`Poisson::generator`](crate::Poisson::generator) and [`Poisson::force`](crate::Poisson::force) that the rate of the process makes. `$\Delta W_k$` is t times that rate.
///
/// Several processes follow each other in their order or against it, as a coin says ([`Poisson::tosses_coin`](crate::Poisson::tosses_coin)); over a negative t in the
/// opposite order, so that it undoes what t did.
#[derive(Clone, Debug)]
pub struct Noise<V> {
    quiet: V,
    probe: V,
    still: [V; 2],
    moved: [V; 2],
    next: V,
}

impl<V> Noise<V> {
    /// The space of a system.
    pub fn new<S, P>(system: &P) -> Self
    where
        S: Scalar,
        V: State<S>,
        P: LiePoisson<S, State = V>,
    {
        let zero = || system.zero_state();
        Self {
            quiet: zero(),
            probe: zero(),
            still: [zero(), zero()],
            moved: [zero(), zero()],
            next: zero(),
        }
    }

    /// The flow over a time t. Before each process along the orbit acts, `give` gets its element, which may be changed.
    pub fn flow<S, P>(&mut self, system: &P, t: S, mu: &mut V, give: &mut dyn FnMut(&mut V))
    where
        S: Scalar,
        V: State<S>,
        P: LiePoisson<S, State = V>,
    {
        let all = system.noise_count();
        let first = mu.as_slice().len() - all;
        let coin = system.tosses_coin();
        let processes = all - usize::from(coin);
        self.quiet.copy_from(mu);
        quieten(system, &mut self.quiet);
        act(system, &self.quiet, &mut self.still);
        let zero = S::zero();
        for process in 0..processes {
            self.probe.copy_from(&self.quiet);
            let rates = &mu.as_slice()[first..];
            let other = processes - 1 - process;
            let probe = &mut self.probe.as_mut_slice()[first..];
            if coin {
                // the process of this turn, from the one end or from the other
                let backwards = (rates[processes] * t).less(zero);
                probe[process] = S::select(backwards, zero, rates[process]);
                let second = S::select(backwards, rates[other], zero);
                probe[other] = match process == other {
                    true => rates[other],
                    false => second,
                };
            } else {
                probe[process] = rates[process];
            }
            act(system, &self.probe, &mut self.moved);
            for (moved, still) in self.moved.iter_mut().zip(&self.still) {
                let pairs = moved.as_mut_slice().iter_mut().zip(still.as_slice());
                pairs.for_each(|(moved, &still)| *moved = t * (*moved - still));
            }
            let [element, push] = &mut self.moved;
            if system.is_damped() {
                // `give` may change its copy
                self.probe.copy_from(element);
                give(&mut self.probe);
                system.coadjoint_action(element, mu, &mut self.next);
                mu.copy_from(&self.next);
            }
            if system.is_forced() {
                let own = system.clock().map_or(first, |clock| clock.momentum);
                let pairs = mu.as_mut_slice()[..own].iter_mut().zip(push.as_slice());
                pairs.for_each(|(entry, &push)| *entry += push);
            }
        }
    }
}

/// Sets the rates of Wiener processes of a state to zero: the last coordinates.
pub(crate) fn quieten<S: Scalar, P: Poisson<S>>(system: &P, mu: &mut P::State) {
    let first = mu.as_slice().len() - system.noise_count();
    mu.as_mut_slice()[first..].fill(S::zero());
}

/// Gives a state the rates of another.
pub(crate) fn excite<S: Scalar, P: Poisson<S>>(system: &P, from: &P::State, mu: &mut P::State) {
    let first = mu.as_slice().len() - system.noise_count();
    mu.as_mut_slice()[first..].copy_from_slice(&from.as_slice()[first..]);
}

/// The generator and the force, where there are any.
fn act<S, P>(system: &P, mu: &P::State, [generator, force]: &mut [P::State; 2])
where
    S: Scalar,
    P: LiePoisson<S>,
{
    if system.is_damped() {
        system.generator(mu, generator);
    }
    if system.is_forced() {
        system.force(mu, force);
    }
}
