//! The flows of the pieces of H, and behind them those of what acts beside it.

use super::acting::Acting;
use super::friction::Friction;
use super::noise::Noise;
use crate::pieces::PieceFlows;
use crate::poisson::LiePoisson;
use crate::scalar::Scalar;
use crate::state::State;

/// The flows of the pieces of H; where forces act, that of [`Friction`] behind them, and that of all [`Noise`] as the last.
///
/// With friction that is the same for all coordinates, `$F = -k \mu$`, a step is conformally Poisson and Casimirs C of degree d decay exactly,
///
/// ```math
/// D\Phi\, \Pi\, D\Phi^T = e^{-k h}\, \Pi \circ \Phi, \qquad C \circ \Phi = e^{-d k h}\, C,
/// ```
///
/// whatever the scheme: the factors of its substeps, forwards and backwards, multiply to that of the whole step.
///
/// Noise is the last piece, which stands once in the middle of a step of order 2, half of the motion before it and half behind: means are right to
/// order 2 (the weak order), of several processes by the coin. Schemes of other orders divide the increments among their substeps, as if the path
/// were a line between them, and have weak order 1.
///
/// R. I. McLachlan, M. Perlmutter, "Conformal Hamiltonian systems", Journal of Geometry and Physics 39 (2001) 276–300,
/// [doi:10.1016/S0393-0440(01)00020-1](https://doi.org/10.1016/S0393-0440(01)00020-1); S. Ninomiya, N. Victoir, Applied Mathematical
/// Finance 15 (2008) 107–121, [doi:10.1080/13504860701413958](https://doi.org/10.1080/13504860701413958).
pub struct DrivenFlows<'a, P, F, V> {
    system: &'a P,
    flows: F,
    friction: Acting<Friction<V>>,
    noise: Acting<Noise<V>>,
}

impl<'a, P, F, V> DrivenFlows<'a, P, F, V> {
    /// The flows of the pieces of a system and of what acts on it.
    pub fn new<S>(system: &'a P, flows: F) -> Self
    where
        S: Scalar,
        V: State<S>,
        P: LiePoisson<S, State = V>,
        F: PieceFlows<S, State = V>,
    {
        let beside = !flows.has_acting();
        Self {
            system,
            flows,
            friction: Acting::where_both(system, beside, || Friction::new(system)),
            noise: Acting::where_both(system, beside, || Noise::new(system)),
        }
    }

    /// How many pieces there are of H, and whether there is friction and noise behind them.
    #[inline(always)]
    fn counts<S>(&self) -> (usize, bool, bool)
    where
        S: Scalar,
        V: State<S>,
        P: LiePoisson<S, State = V>,
        F: PieceFlows<S, State = V>,
    {
        let (system, beside) = (self.system, !self.flows.has_acting());
        let noisy = beside && system.noise_count() > 0;
        (self.flows.pieces(), beside && system.is_forced(), noisy)
    }
}

impl<S, P, F, V> PieceFlows<S> for DrivenFlows<'_, P, F, V>
where
    S: Scalar,
    V: State<S>,
    P: LiePoisson<S, State = V>,
    F: PieceFlows<S, State = V>,
{
    type State = V;

    #[inline]
    fn pieces(&self) -> usize {
        let (of_h, friction, noise) = self.counts();
        of_h + usize::from(friction) + usize::from(noise)
    }
    #[inline]
    fn gather(&mut self, mu: &V, next: &mut V) {
        self.flows.gather(mu, next);
    }
    #[inline]
    fn scatter(&self, lanes: S::Mask, next: &V, mu: &mut V) {
        self.flows.scatter(lanes, next, mu);
    }

    /// That of a piece of H; what acts beside H has none.
    fn direction(&self, piece: usize, t: S, mu: &V, xi: &mut V) {
        match piece < self.flows.pieces() {
            true => self.flows.direction(piece, t, mu, xi),
            false => xi.fill(S::zero()),
        }
    }

    #[inline]
    fn flow(&mut self, piece: usize, t: S, mu: &mut V) {
        let (of_h, friction, _) = self.counts();
        if piece < of_h {
            return self.flows.flow(piece, t, mu);
        }
        let system = self.system;
        if friction && piece == of_h {
            if let Some(friction) = self.friction.get_mut(system) {
                friction.flow(system, t, mu);
            }
        } else if let Some(noise) = self.noise.get_mut(system) {
            noise.flow(system, t, mu, &mut |_| {});
        }
    }

    fn follow(
        &mut self,
        piece: usize,
        t: S,
        mu: &mut V,
        factor: &mut V,
        give: &mut dyn FnMut(&mut V),
    ) {
        let (of_h, friction, _) = self.counts();
        if piece < of_h {
            return self.flows.follow(piece, t, mu, factor, give);
        }
        let system = self.system;
        match self.noise.get_mut(system) {
            Some(noise) if piece > of_h || !friction => noise.flow(system, t, mu, give),
            _ => self.flow(piece, t, mu),
        }
    }

    #[inline]
    fn rest(&self, t: S, mu: &V, xi: &mut V) -> bool {
        self.flows.rest(t, mu, xi)
    }

    #[inline]
    fn ascend(&mut self, first: S, t: S, mu: &mut V) {
        let (of_h, pieces) = (self.flows.pieces(), self.pieces());
        if pieces == of_h {
            return self.flows.ascend(first, t, mu);
        }
        self.flow(0, first, mu);
        for piece in 1..pieces - 1 {
            self.flow(piece, t, mu);
        }
    }
    #[inline]
    fn descend(&mut self, last: S, t: S, mu: &mut V) {
        let (of_h, pieces) = (self.flows.pieces(), self.pieces());
        if pieces == of_h {
            return self.flows.descend(last, t, mu);
        }
        self.flow(pieces - 1, last, mu);
        for piece in (1..pieces - 1).rev() {
            self.flow(piece, t, mu);
        }
    }
}
