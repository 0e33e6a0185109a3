//! What the explicit methods of coadjoint form share.

use super::stepper::{FactorSink, Retraction, StepFailure, StepReport, not_finite};
pub(super) use crate::generic::direction;
use crate::scalar::{Mask, Scalar};
use crate::state::State;

/// Takes over the new state in the lanes in which it is finite, and gives away the factors
/// `exp(xi)` that led there, in their order.
pub(super) fn accept<S: Scalar, V: State<S>, K: FactorSink<V>>(
    mu: &mut V,
    next: &V,
    factors: &mut [V],
    evaluations: u32,
    sink: &mut K,
) -> Result<StepReport, StepFailure> {
    let finite = next.finite();
    mu.assign_where(finite, next);
    if sink.is_active() && finite.any() {
        for factor in factors {
            for entry in factor.as_mut_slice() {
                *entry = S::select(finite, *entry, S::zero());
            }
            sink.push(Retraction::Exp, factor);
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

/// `out = sum of weight * k`, the weights as numerators over denominators; those that are 0 are
/// left out.
pub(super) fn combine<S: Scalar, V: State<S>>(weights: &[(f64, f64)], slopes: &[V], out: &mut V) {
    out.fill(S::zero());
    for (&(numerator, denominator), slope) in weights.iter().zip(slopes) {
        if numerator != 0.0 {
            out.axpy(S::ratio(numerator, denominator), slope);
        }
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
        }
    };
}
pub(super) use coadjoint_facts;
