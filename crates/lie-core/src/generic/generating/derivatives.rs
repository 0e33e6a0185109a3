//! Derivatives of H beyond the gradient along given directions, by running the gradient over nested
//! dual numbers: `H''(p)(v, .)`, `H'''(p)(u, v, .)` and so on, as covectors, each times a step h.

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

/// `out = h H''(p)(v, .)`.
pub(super) fn second<S: Scalar, P: Lift<S>>(
    (system, h): (&P, S),
    p: &P::State,
    v: &P::State,
    out: &mut P::State,
) {
    let lifted = system.lift();
    let q = seeded(&lifted, p.as_slice(), Some(v.as_slice()));
    let mut gradient = lifted.zero_state();
    lifted.gradient(&q, &mut gradient);
    slope(&gradient, out);
    scale(h, out);
}

/// Multiplies by h.
pub(super) fn scale<S: Scalar>(h: S, out: &mut impl State<S>) {
    for entry in out.as_mut_slice() {
        *entry *= h;
    }
}

macro_rules! next {
    ($(#[$doc:meta])* $name:ident from $lower:ident: $first:ident, $($rest:ident),+) => {
        $(#[$doc])*
        pub(super) fn $name<S: Scalar, P: Lift<S>>(
            (system, h): (&P, S),
            p: &P::State,
            $first: &P::State,
            $($rest: &P::State,)+
            out: &mut P::State,
        ) {
            let lifted = system.lift();
            let q = seeded(&lifted, p.as_slice(), Some($first.as_slice()));
            $(let $rest = seeded(&lifted, $rest.as_slice(), None);)+
            let mut lower = lifted.zero_state();
            $lower((&lifted, Dual::constant_of(h)), &q, $(&$rest,)+ &mut lower);
            slope(&lower, out);
        }
    };
}

next!(
    /// `out = h H'''(p)(u, v, .)`.
    third from second: u, v
);
next!(
    /// `out = h H''''(p)(t, u, v, .)`.
    fourth from third: t, u, v
);
next!(
    /// `out = h H^(5)(p)(s, t, u, v, .)`.
    fifth from fourth: s, t, u, v
);
