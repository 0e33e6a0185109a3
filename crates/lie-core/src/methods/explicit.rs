//! What the explicit methods of coadjoint form share.

use super::stepper::{FactorSink, Retraction, StepFailure, StepReport, not_finite};
pub(super) use crate::generic::direction;
use crate::generic::{Scratch, coadjoint_action_in, phi1_in};
use crate::poisson::LiePoisson;
use crate::scalar::{Mask, Scalar};
use crate::state::State;

/// A field frozen at a state, times the step size: `x = h xi(mu)` in the algebra, and `K = h F(mu)` in its dual where forces act.
///
/// Its flow over the unit of time is affine, `mu -> exp(ad*_x) mu + phi1(ad*_x) K`: an action of the semidirect product of the group
/// with g*, whose algebra is that of the pairs (x, K). So methods in the algebra have their order under forces, with pairs in
/// place of elements. Where nothing forces there is no K, and the flow is the coadjoint action.
#[derive(Clone, Debug)]
pub(super) struct Frozen<V> {
    x: V,
    force: Option<V>,
}

/// Space for the flows of frozen fields.
#[derive(Clone, Debug)]
pub(super) struct Flow<V> {
    scratch: Scratch<V>,
    forced: Option<V>,
}

impl<V: Clone> Flow<V> {
    /// The space of a system; `zero` is any state of the right size.
    pub(super) fn new<S: Scalar, P: LiePoisson<S, State = V>>(system: &P, zero: &V) -> Self {
        Self {
            scratch: Scratch::new(zero),
            forced: system.is_forced().then(|| zero.clone()),
        }
    }
}

impl<V> Frozen<V> {
    /// A field that is not there; `zero` is the state 0.
    pub(super) fn new<S: Scalar, P: LiePoisson<S, State = V>>(system: &P, zero: &V) -> Self
    where
        V: Clone,
    {
        Self {
            x: zero.clone(),
            force: system.is_forced().then(|| zero.clone()),
        }
    }

    /// The field at a state, times h.
    pub(super) fn freeze<S, P>(&mut self, system: &P, h: S, mu: &V)
    where
        S: Scalar,
        V: State<S>,
        P: LiePoisson<S, State = V>,
    {
        direction(system, h, mu, &mut self.x);
        if let Some(force) = &mut self.force {
            system.force(mu, force);
            for entry in force.as_mut_slice() {
                *entry *= h;
            }
        }
    }

    /// Sets it to a sum of weights times fields, the weights as numerators over denominators; those that are 0 are left out.
    pub(super) fn combine<S: Scalar>(&mut self, weights: &[(f64, f64)], fields: &[Self])
    where
        V: State<S>,
    {
        self.x.fill(S::zero());
        if let Some(force) = &mut self.force {
            force.fill(S::zero());
        }
        for (&weight, field) in weights.iter().zip(fields) {
            if weight.0 != 0.0 {
                self.add(weight, field);
            }
        }
    }

    /// Takes over another one.
    pub(super) fn copy_from<S: Scalar>(&mut self, other: &Self)
    where
        V: State<S>,
    {
        self.x.copy_from(&other.x);
        if let (Some(force), Some(other)) = (&mut self.force, &other.force) {
            force.copy_from(other);
        }
    }

    /// Adds a field times a weight.
    pub(super) fn add<S: Scalar>(&mut self, (numerator, denominator): (f64, f64), field: &Self)
    where
        V: State<S>,
    {
        let weight = S::ratio(numerator, denominator);
        self.x.axpy(weight, &field.x);
        if let (Some(force), Some(other)) = (&mut self.force, &field.force) {
            force.axpy(weight, other);
        }
    }

    /// The flow over the unit of time: `out = exp(ad*_x) mu + phi1(ad*_x) K`.
    pub(super) fn flow<S, P>(&self, system: &P, mu: &V, out: &mut V, flow: &mut Flow<V>)
    where
        S: Scalar,
        V: State<S>,
        P: LiePoisson<S, State = V>,
    {
        coadjoint_action_in(system, &self.x, mu, out, &mut flow.scratch);
        if system.is_forced()
            && let (Some(force), Some(forced)) = (&self.force, &mut flow.forced)
        {
            phi1_in(system, &self.x, force, forced, &mut flow.scratch);
            out.axpy(S::one(), forced);
        }
    }

    /// The bracket of pairs: `out = ([x, y], ad*_y K - ad*_x L)` of (x, K) and (y, L). The field of a pair is
    /// `m -> ad*_x m + K`, and the bracket of two such fields belongs to that of their pairs.
    pub(super) fn bracket<S, P>(&self, system: &P, other: &Self, out: &mut Self, flow: &mut Flow<V>)
    where
        S: Scalar,
        V: State<S>,
        P: LiePoisson<S, State = V>,
    {
        system.ad(&self.x, &other.x, &mut out.x);
        let forces = (&self.force, &other.force, &mut out.force, &mut flow.forced);
        if let (Some(first), Some(second), Some(out), Some(turned)) = forces {
            system.ad_star(&other.x, first, out);
            system.ad_star(&self.x, second, turned);
            out.axpy(-S::one(), turned);
        }
    }
}

/// Takes over the new state in the lanes in which it is finite, and gives away the factors
/// `exp(x)` that led there, in their order.
pub(super) fn accept<S: Scalar, V: State<S>, K: FactorSink<V>>(
    mu: &mut V,
    next: &V,
    factors: &mut [Frozen<V>],
    evaluations: u32,
    sink: &mut K,
) -> Result<StepReport, StepFailure> {
    let finite = next.finite();
    mu.assign_where(finite, next);
    if sink.is_active() && finite.any() {
        for Frozen { x, .. } in factors {
            for entry in x.as_mut_slice() {
                *entry = S::select(finite, *entry, S::zero());
            }
            sink.push(Retraction::Exp, x);
        }
    }
    let report = StepReport {
        evaluations,
        substeps: 1,
        ..StepReport::default()
    };
    if finite.all() {
        Ok(report)
    } else {
        Err(not_finite((!finite).bits(), report))
    }
}

/// The facts of an explicit method of coadjoint form: it keeps the orbit and every Casimir.
macro_rules! coadjoint_facts {
    ($name:ty, $id:literal, $order:literal) => {
        impl Facts for $name {
            const ID: &'static str = $id;
            const ORDER: u32 = $order;
            const SYMMETRIC: bool = false;
            const EXPLICIT: bool = true;
            const PRESERVES: Preserves = Preserves::ORBIT;
            const FORCES: bool = true;
            const DAMPING: bool = true;
        }
    };
}
pub(super) use coadjoint_facts;
