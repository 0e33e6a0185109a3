//! Derivatives of H beyond the gradient along given directions, by running the gradient over nested
//! dual numbers: `H''(p)(v, .)`, `H'''(p)(u, v, .)` and so on, as covectors.

use crate::poisson::{Lift, Poisson};
use crate::scalar::{Dual, Scalar};
use crate::state::State;

/// `p + eps v`, or p alone.
pub(super) fn seeded<S, P>(system: &P, p: &[S], v: Option<&[S]>) -> P::State
where
    S: Scalar,
    P: Poisson<Dual<S>>,
{
    let mut state = system.zero_state();
    for (index, (entry, &value)) in state.as_mut_slice().iter_mut().zip(p).enumerate() {
        *entry = Dual::new(value, v.map_or(S::zero(), |v| v[index]));
    }
    state
}

/// The coefficients of eps.
pub(super) fn slope<S: Scalar>(dual: &impl State<Dual<S>>, out: &mut impl State<S>) {
    for (out, dual) in out.as_mut_slice().iter_mut().zip(dual.as_slice()) {
        *out = dual.derivative;
    }
}

/// `out = H''(p)(v, .)`.
pub(super) fn second<S: Scalar, P: Lift<S>>(
    system: &P,
    p: &P::State,
    v: &P::State,
    out: &mut P::State,
) {
    let lifted = system.lift();
    let q = seeded(&lifted, p.as_slice(), Some(v.as_slice()));
    let mut gradient = lifted.zero_state();
    lifted.gradient(&q, &mut gradient);
    slope(&gradient, out);
}

macro_rules! next {
    ($(#[$doc:meta])* $name:ident from $lower:ident: $first:ident, $($rest:ident),+) => {
        $(#[$doc])*
        pub(super) fn $name<S: Scalar, P: Lift<S>>(
            system: &P,
            p: &P::State,
            $first: &P::State,
            $($rest: &P::State,)+
            out: &mut P::State,
        ) {
            let lifted = system.lift();
            let q = seeded(&lifted, p.as_slice(), Some($first.as_slice()));
            $(let $rest = seeded(&lifted, $rest.as_slice(), None);)+
            let mut lower = lifted.zero_state();
            $lower(&lifted, &q, $(&$rest,)+ &mut lower);
            slope(&lower, out);
        }
    };
}

next!(
    /// `out = H'''(p)(u, v, .)`.
    third from second: u, v
);
next!(
    /// `out = H''''(p)(t, u, v, .)`.
    fourth from third: t, u, v
);
next!(
    /// `out = H^(5)(p)(s, t, u, v, .)`.
    fifth from fourth: s, t, u, v
);
