//! Functions with a discrete gradient.

use crate::poisson::Poisson;
use crate::scalar::Scalar;

/// A function of the state of a system.
pub trait Function<S: Scalar, P: Poisson<S>> {
    /// Its total degree, where it is a polynomial and that is known.
    fn degree(system: &P) -> Option<u32>;
    /// Whether its discrete gradient follows a coordinate.
    fn counts(system: &P, index: usize) -> bool;
    /// Its value.
    fn value(system: &P, mu: &P::State) -> S;
    /// Its gradient.
    fn gradient(system: &P, mu: &P::State, out: &mut P::State);
    /// Its Hessian.
    fn hessian(system: &P, mu: &P::State, out: &mut P::Jacobian);
}

/// H. The momentum of the time does not count, so that the time moves as it does; nor does the time where H does not depend on it, since
/// what the gradient had there would be work that nothing does.
#[derive(Clone, Copy, Debug)]
pub struct Energy;

impl<S: Scalar, P: Poisson<S>> Function<S, P> for Energy {
    fn degree(system: &P) -> Option<u32> {
        system.hamiltonian_degree()
    }
    #[inline(always)]
    fn counts(system: &P, index: usize) -> bool {
        let Some(clock) = system.clock() else {
            return true;
        };
        index != clock.momentum && (index != clock.time || !system.is_autonomous())
    }
    fn value(system: &P, mu: &P::State) -> S {
        system.energy(mu)
    }
    fn gradient(system: &P, mu: &P::State, out: &mut P::State) {
        system.gradient(mu, out);
    }
    fn hessian(system: &P, mu: &P::State, out: &mut P::Jacobian) {
        system.hessian(mu, out);
    }
}

/// The entropy S of a metriplectic system, which depends on the declared coordinates alone: they come first.
#[derive(Clone, Copy, Debug)]
pub struct Entropy;

/// How many coordinates were declared.
pub(in crate::generic) fn declared<S: Scalar, P: Poisson<S>>(system: &P) -> usize {
    let momentum = system.clock().map(|clock| clock.momentum);
    momentum.unwrap_or_else(|| system.dimension())
}

impl<S: Scalar, P: Poisson<S>> Function<S, P> for Entropy {
    fn degree(system: &P) -> Option<u32> {
        system.entropy_degree()
    }
    fn counts(system: &P, index: usize) -> bool {
        index < declared(system)
    }
    fn value(system: &P, mu: &P::State) -> S {
        system.entropy(mu)
    }
    fn gradient(system: &P, mu: &P::State, out: &mut P::State) {
        system.entropy_gradient(mu, out);
    }
    fn hessian(system: &P, mu: &P::State, out: &mut P::Jacobian) {
        system.entropy_hessian(mu, out);
    }
}
