//! Power series in `ad*_x` applied to a momentum: the coadjoint action of `exp(x)` and the dual of
//! `dexp_x`, for any algebra.

use crate::poisson::LiePoisson;
use crate::scalar::{Mask, Scalar};
use crate::state::{State, Unknown};

/// More terms than any series with a usable sum needs: `|ad_x|` around 15 before rounding wins.
const MAX_TERMS: usize = 60;
/// Cancellation beyond this ratio of the largest term to the sum calls for a smaller argument.
const MAX_LOSS: f64 = 4.0;
/// The smallest scale of the argument is 2^-MAX_HALVINGS.
const MAX_HALVINGS: usize = 12;

/// Space for the sums; made once so that a step allocates nothing.
#[derive(Clone, Debug)]
pub(crate) struct Scratch<V> {
    terms: Terms<V>,
    argument: V,
}

#[derive(Clone, Debug)]
struct Terms<V> {
    term: V,
    next: V,
    sum: V,
}

impl<V: Clone> Scratch<V> {
    pub(crate) fn new(zero: &V) -> Self {
        let terms = Terms {
            term: zero.clone(),
            next: zero.clone(),
            sum: zero.clone(),
        };
        Self {
            terms,
            argument: zero.clone(),
        }
    }
}

/// What a sum has found, per lane.
struct Outcome<S: Scalar> {
    /// The sum is converged and lost no digits to cancellation, or is not finite at all.
    settled: S::Mask,
    /// The index of the last term that was added.
    last: S,
}

/// `sum_k shift!/(k + shift)! (ad*_x)^k mu`: the exponential for shift 0, `phi1` for shift 1.
/// Leaves the sum in `scratch` and shows every term to `keep`.
///
/// A lane ends after two terms in a row that no longer change its sum; lanes that have ended are
/// frozen, so that they keep the digits of a run of their own.
fn sum<S: Scalar, P: LiePoisson<S>>(
    system: &P,
    x: &P::State,
    mu: &P::State,
    shift: usize,
    scratch: &mut Terms<P::State>,
    mut keep: impl FnMut(usize, &P::State),
) -> Outcome<S> {
    scratch.term.copy_from(mu);
    scratch.sum.fill(S::zero());
    keep(0, &scratch.term);
    let mut peak = system.norm(mu);
    let unchanging = S::epsilon() * S::ratio(1.0, 8.0) * peak;
    let mut last = S::zero();
    let mut active = S::Mask::splat(true);
    let mut small_before = S::Mask::splat(false);
    for index in 1..=MAX_TERMS {
        system.ad_star(x, &scratch.term, &mut scratch.next);
        let weight = S::ratio(1.0, (index + shift) as f64);
        let pairs = scratch
            .term
            .as_mut_slice()
            .iter_mut()
            .zip(scratch.next.as_slice());
        for ((term, &next), sum) in pairs.zip(scratch.sum.as_mut_slice()) {
            *term = next * weight;
            *sum = S::select(active, *sum + *term, *sum);
        }
        keep(index, &scratch.term);
        let size = system.norm(&scratch.term);
        last = S::select(active, S::from_f64(index as f64), last);
        peak = S::select(active, peak.max(size), peak);
        let small = size.less_equal(unchanging);
        active = active & size.finite() & !(small & small_before);
        small_before = small;
        if !active.any() {
            break;
        }
    }
    // mu comes last: its addition is the only one that rounds in units of mu
    for (sum, &mu) in scratch.sum.as_mut_slice().iter_mut().zip(mu.as_slice()) {
        *sum += mu;
    }
    let norm = system.norm(&scratch.sum);
    let accurate = !active & peak.less_equal(S::from_f64(MAX_LOSS) * norm);
    Outcome {
        settled: accurate | !norm.finite(),
        last,
    }
}

/// The coadjoint action `out = Ad*_(exp x) mu = exp(ad*_x) mu`.
///
/// The series is applied to mu itself, so the result lies on the coadjoint orbit of mu to round-off
/// whatever x is. Where the series cancels, x is halved and the series applied repeatedly; where
/// x is so large (some thousand in the norm of `ad_x`) that even this does not help, the result is
/// not a number.
pub fn coadjoint_action<S: Scalar, P: LiePoisson<S>>(
    system: &P,
    x: &P::State,
    mu: &P::State,
    out: &mut P::State,
) {
    by_series(system, x, mu, out, &mut Scratch::new(&system.zero_state()));
}

/// The closed form where the system has one, else [`coadjoint_action`] in space of the caller's.
pub(crate) fn coadjoint_action_in<S: Scalar, P: LiePoisson<S>>(
    system: &P,
    x: &P::State,
    mu: &P::State,
    out: &mut P::State,
    scratch: &mut Scratch<P::State>,
) {
    if system.has_closed_exponential() {
        system.coadjoint_action(x, mu, out);
        return;
    }
    by_series(system, x, mu, out, scratch);
}

/// `out = phi1(ad*_x) mu` alike.
pub(crate) fn phi1_in<S: Scalar, P: LiePoisson<S>>(
    system: &P,
    x: &P::State,
    mu: &P::State,
    out: &mut P::State,
    scratch: &mut Scratch<P::State>,
) {
    if system.has_closed_exponential() {
        system.dexp_dual(x, mu, out);
        return;
    }
    dexp_dual_in(system, x, mu, out, scratch, |_, _| ());
}

fn by_series<S: Scalar, P: LiePoisson<S>>(
    system: &P,
    x: &P::State,
    mu: &P::State,
    out: &mut P::State,
    scratch: &mut Scratch<P::State>,
) {
    let half = S::ratio(1.0, 2.0);
    let Scratch { terms, argument } = scratch;
    argument.copy_from(x);
    let mut remaining = S::one();
    let mut settled = S::Mask::splat(false);
    for round in 0..=MAX_HALVINGS {
        settled = sum(system, argument, mu, 0, terms, |_, _| ()).settled;
        if settled.all() || round == MAX_HALVINGS {
            break;
        }
        for entry in argument.as_mut_slice() {
            *entry = S::select(settled, *entry, *entry * half);
        }
        remaining = S::select(settled, remaining, remaining + remaining);
    }
    out.copy_from(&terms.sum);
    if !settled.all() {
        let not_a_number = S::zero() / S::zero();
        for entry in out.as_mut_slice() {
            *entry = S::select(settled, *entry, not_a_number);
        }
        remaining = S::select(settled, remaining, S::zero());
    }
    remaining -= S::one();
    loop {
        let open = S::zero().less(remaining);
        if !open.any() {
            break;
        }
        sum(system, argument, &*out, 0, terms, |_, _| ());
        out.assign_where(open, &terms.sum);
        remaining -= S::one();
    }
}

/// The dual of the right-trivialised tangent of exp: `out = phi1(ad*_x) mu`, with
/// `phi1(z) = (e^z - 1)/z`. It inverts `(dexp_x^-1)*` and is entire in x.
pub fn dexp_dual<S: Scalar, P: LiePoisson<S>>(
    system: &P,
    x: &P::State,
    mu: &P::State,
    out: &mut P::State,
) {
    let mut scratch = Scratch::new(&system.zero_state());
    dexp_dual_in(system, x, mu, out, &mut scratch, |_, _| ());
}

/// `phi1(ad*_x) mu` along x in parts: with `y(0) = 0` and `y' = ad*_x y + mu` it is y(1), and a step of length s is
/// `y -> exp(s ad*_x) y + s phi1(s ad*_x) mu`. Only where the series at x itself cancels.
#[cold]
fn dexp_dual_in_parts<S: Scalar, P: LiePoisson<S>>(
    system: &P,
    x: &P::State,
    mu: &P::State,
    out: &mut P::State,
    scratch: &mut Scratch<P::State>,
    settled: S::Mask,
) {
    let (mut settled, mut parts) = (settled, S::one());
    let mut argument = x.clone();
    let mut increment = out.clone();
    for _ in 0..MAX_HALVINGS {
        for entry in argument.as_mut_slice() {
            *entry = S::select(settled, *entry, *entry * S::ratio(1.0, 2.0));
        }
        parts = S::select(settled, parts, parts + parts);
        settled = sum(system, &argument, mu, 1, &mut scratch.terms, |_, _| ()).settled;
        increment.assign_where(S::Mask::splat(true), &scratch.terms.sum);
        if settled.all() {
            break;
        }
    }
    let not_a_number = S::zero() / S::zero();
    for entry in increment.as_mut_slice() {
        *entry = S::select(settled, *entry / parts, not_a_number);
    }
    // the first step is the increment itself
    out.copy_from(&increment);
    let mut remaining = S::select(settled, parts - S::one(), S::zero());
    let mut moved = out.clone();
    loop {
        let open = S::zero().less(remaining);
        if !open.any() {
            return;
        }
        by_series(system, &argument, &*out, &mut moved, scratch);
        moved.axpy(S::one(), &increment);
        out.assign_where(open, &moved);
        remaining -= S::one();
    }
}

/// [`dexp_dual`] in space of the caller's, with every term shown to `keep`; returns the index of
/// the last term added in each lane.
pub(crate) fn dexp_dual_in<S: Scalar, P: LiePoisson<S>>(
    system: &P,
    x: &P::State,
    mu: &P::State,
    out: &mut P::State,
    scratch: &mut Scratch<P::State>,
    keep: impl FnMut(usize, &P::State),
) -> S {
    let outcome = sum(system, x, mu, 1, &mut scratch.terms, keep);
    out.copy_from(&scratch.terms.sum);
    if !outcome.settled.all() {
        dexp_dual_in_parts(system, x, mu, out, scratch, outcome.settled);
    }
    outcome.last
}
