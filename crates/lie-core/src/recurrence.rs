//! Taylor coefficients of solutions, one order after the other.
//!
//! With `mu(t) = sum_k mu_k t^k` and `f(mu(t)) = sum_k f_k t^k`, the equation `mu' = f(mu)` gives
//! `(k + 1) mu_(k+1) = f_k`, and `f_k` follows from `mu_0, …, mu_k`: each operation of the field has a rule for the
//! coefficients of its result, that of a product being the sum `(u v)_k = sum_j u_j v_(k-j)`.

use crate::clock::{Clock, holds};
use crate::methods::rough_log::whole;
use crate::poisson::Poisson;
use crate::scalar::{Mask, Primitive, Scalar};
use crate::state::State;

/// The largest order that is computed.
pub const MOST_ORDERS: usize = 40;

/// Groups of sums that go along the orders together: as many as there are registers for.
const TOGETHER: usize = 4;

/// The Taylor coefficients of a vector field along its solution. It keeps those found so far, and allocates nothing.
pub trait Recurrence<S: Scalar> {
    /// The state of the system.
    type State: State<S>;
    /// What one order hands to the next; it is passed on by value, so that it stays in registers.
    type Carry;

    /// Begins anew at a state: `field = f_0`, the field there.
    fn begin(&mut self, mu: &Self::State, field: &mut Self::State) -> Self::Carry;
    /// `field = f_k` from the coefficient `mu_k`, for k = 1, 2, … in turn, below [`MOST_ORDERS`].
    fn advance(
        &mut self,
        k: usize,
        carry: Self::Carry,
        coefficient: &Self::State,
        field: &mut Self::State,
    ) -> Self::Carry;
    /// Develops a solution from a state in some lanes, in a unit of time, up to an order, by a program of all orders, and keeps the
    /// series with its conditions; false where the system has no such program, and nothing is done. `part` is that of the [`Reach`]. `rows` have
    /// the series that were developed otherwise before, order after order.
    fn develop(
        &mut self,
        _mu: &Self::State,
        _unit: S,
        _part: S,
        _last: usize,
        _rows: &[Self::State],
        _lanes: S::Mask,
    ) -> bool {
        false
    }
    /// The series of the last [`Recurrence::develop`], if it was true.
    fn kept(&self) -> Option<KeptSeries<'_, S>> {
        None
    }
    /// The [sum](sum_of_series) of the series that is kept, at a time in its unit; false where none is, and nothing is done.
    fn sum(&mut self, _time: S, _out: &mut Self::State) -> bool {
        false
    }
    /// The coefficients of an order of the conditions that choose branches, each with its first branch where it is negative,
    /// of the orders since [`Recurrence::begin`].
    fn conditions(&self, _k: usize) -> &[S] {
        &[]
    }
}

/// A series that is kept.
#[derive(Clone, Copy, Debug)]
pub struct KeptSeries<'a, S: Scalar> {
    /// The coefficients, one order after the other from 0 on, each times the power of a unit of time. Beyond the last order they are 0,
    /// for four orders at least.
    pub coefficients: &'a [S],
    /// How many an order has.
    pub size: usize,
    /// What its radius of convergence follows from, in the lanes that were developed last.
    pub ends: Ends<S>,
    /// How far it is used, in these lanes.
    pub reach: Reach<S>,
}

impl<'a, S: Scalar> KeptSeries<'a, S> {
    /// The coefficients of an order.
    #[inline(always)]
    pub fn row(&self, order: usize) -> &'a [S] {
        &self.coefficients[order * self.size..][..self.size]
    }
}

/// The coefficients at both ends of a series, in the maximum norm over the coordinates that do not carry the time.
#[derive(Clone, Copy, Debug)]
pub struct Ends<S: Scalar> {
    /// Those of order 0, of the last order and of the one before.
    pub sizes: [S; 3],
    /// The lanes in which the latter two are finite, and one of both is not 0 in every coordinate that does not carry the time.
    pub lanes: S::Mask,
}

impl<S: Scalar> Ends<S> {
    /// By the coefficients of order 0, of the last order and of the one before.
    #[inline(always)]
    pub fn of(rows: [&[S]; 3], clock: Option<Clock>) -> Self {
        let (mut sizes, mut lanes) = ([S::zero(); 3], S::Mask::splat(true));
        for i in 0..rows[0].len() {
            let entries = rows.map(|row| row[i]);
            // what is not finite is no number here
            for last in &entries[1..] {
                lanes = lanes & (*last * S::zero()).less_equal(S::zero());
            }
            if holds(clock, i) {
                continue;
            }
            let entries = entries.map(S::abs);
            let [_, last, before] = entries;
            lanes = lanes & (S::zero().less(last) | S::zero().less(before));
            for (size, entry) in sizes.iter_mut().zip(entries) {
                *size = size.max(entry);
            }
        }
        Self { sizes, lanes }
    }
}

/// How far a series is used, where nothing is special.
#[derive(Clone, Copy, Debug)]
pub struct Reach<S: Scalar> {
    /// In its unit of time.
    pub length: S,
    /// The power of two by which the unit is smaller than the radius of convergence, to the nearest whole number.
    pub shift: S,
    /// The lanes in which these are known.
    pub lanes: S::Mask,
}

impl<S: Scalar + Primitive> Reach<S> {
    /// By the ends of a series up to an order of 2 or more, and the part of its radius of convergence that is used: the logarithm of that
    /// part to base 2 in units of 2^-40.
    pub fn of(ends: &Ends<S>, order: usize, part: S) -> Self {
        let number = <S as Primitive>::number;
        let [scale, last, before] = ends.sizes.map(whole::binary_log);
        let by_last = whole::quotient(scale - last, order);
        let by_before = whole::quotient(scale - before, order.max(2) - 1);
        let log = S::blend(by_last - by_before, by_last, by_before);
        let [length, below] = whole::exp2(log + part);
        let mut lanes = ends.lanes & below.abs().less_equal(number(1022.0));
        for size in ends.sizes {
            let is_normal = number(f64::MIN_POSITIVE).less_equal(size);
            lanes = lanes & is_normal & size.less_equal(number(f64::MAX));
        }
        Self {
            length,
            shift: whole::rounded(log),
            lanes,
        }
    }
}

/// `out = sum_k row(k) t^k` up to an order, the terms of every fourth order in a chain of their own; rows beyond the order are 0, three of
/// them at least.
#[inline(always)]
pub fn sum_of_series<'a, S: Scalar>(
    row: impl Fn(usize) -> &'a [S],
    order: usize,
    t: S,
    out: &mut [S],
) {
    let square = t * t;
    let fourth = square * square;
    let last = (order.max(1) - 1) / 4;
    for (i, out) in out.iter_mut().enumerate() {
        let mut sums = [S::zero(); 4];
        for block in (0..=last).rev() {
            for (r, sum) in sums.iter_mut().enumerate() {
                *sum = *sum * fourth + row(4 * block + 1 + r)[i];
            }
        }
        let [a, b, c, d] = sums;
        let terms = (a + t * b) + square * (c + t * d);
        *out = row(0)[i] + t * terms;
    }
}

/// The Taylor coefficients of the gradient of H beside those of the field.
pub trait GradientRecurrence<S: Scalar>: Recurrence<S> {
    /// The coefficient of `grad H(mu(t))` of the order that was computed last; of the generator where something damps.
    fn gradient(&self) -> &Self::State;
}

/// A system whose solutions can be developed into Taylor series.
///
/// Generated for every system: by recurrences of its own where the declaration asks for `taylor`, else by
/// [`PowerSeries`](crate::generic::PowerSeries). By hand, implement [`Expand`] and return the latter.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no Taylor series over the scalar `{S}`",
    note = "implement `Series<{S}>`, with `generic::PowerSeries` as its recurrence if the system implements `Expand<{S}>`"
)]
pub trait Series<S: Scalar>: Poisson<S> {
    /// The recurrence; it may borrow the system.
    type Recurrence<'a>: Recurrence<S, State = Self::State>
    where
        Self: 'a;
    /// The recurrence of the field.
    fn series(&self) -> Self::Recurrence<'_>;
}

/// [`Series`] with the gradient of H.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no Taylor series of its gradient over the scalar `{S}`",
    note = "implement `GradientSeries<{S}>`, with `generic::PowerSeries` as its recurrence if the system implements `Expand<{S}>`"
)]
pub trait GradientSeries<S: Scalar>: Poisson<S> {
    /// The recurrence; it may borrow the system.
    type Recurrence<'a>: GradientRecurrence<S, State = Self::State>
    where
        Self: 'a;
    /// The recurrence of field and gradient.
    fn gradient_series(&self) -> Self::Recurrence<'_>;
}

/// A system that also exists over truncated power series, so that running its field there develops it.
///
/// Generated for every system; by hand, convert the constants with [`PowerSeries::constant`](crate::scalar::Truncated::constant_of).
pub trait Expand<S: Scalar>: Poisson<S> {
    /// The same system over truncated power series.
    type Expanded: Poisson<crate::scalar::Truncated<S>>;
    /// The system with all its constants as series of one term.
    fn expand(&self) -> Self::Expanded;
}

/// The sums of products of Taylor coefficients `sum_j u_j v_(k-j)` of many pairs (u, v) side by side.
///
/// Of each sum the terms with j = 0 and j = k are left to the caller, since they hold the coefficients that are being
/// computed; what remains of them is ready when the order begins. `PAIRS` pairs are summed eight at a time, in
/// `GROUPS` registers.
#[derive(Clone, Debug)]
pub struct Sums<S: Scalar, const PAIRS: usize, const GROUPS: usize> {
    /// The coefficients u_k and v_k, order after order.
    left: [[S::Wide; GROUPS]; MOST_ORDERS],
    right: [[S::Wide; GROUPS]; MOST_ORDERS],
    /// u_1 and v_1.
    first: ([S; PAIRS], [S; PAIRS]),
}

impl<S: Scalar, const PAIRS: usize, const GROUPS: usize> Default for Sums<S, PAIRS, GROUPS> {
    fn default() -> Self {
        let zeros = [[S::zero().widen(); GROUPS]; MOST_ORDERS];
        let none = [S::zero(); PAIRS];
        Self {
            left: zeros,
            right: zeros,
            first: (none, none),
        }
    }
}

impl<S: Scalar, const PAIRS: usize, const GROUPS: usize> Sums<S, PAIRS, GROUPS> {
    /// What the sums of order 1 have beside the terms with coefficients of order 1: nothing.
    #[inline(always)]
    pub fn begin(&self) -> [S; PAIRS] {
        [S::zero(); PAIRS]
    }

    /// Takes the coefficients u_k and v_k, and returns the sums of the next order without their first and last terms:
    /// `sum_(0<j<=k) u_j v_(k+1-j)`.
    #[inline(always)]
    pub fn push(&mut self, k: usize, left: [S; PAIRS], right: [S; PAIRS]) -> [S; PAIRS] {
        for group in 0..GROUPS {
            self.left[k][group] = gathered(&left, group);
            self.right[k][group] = gathered(&right, group);
        }
        if k == 1 {
            self.first = (left, right);
            return core::array::from_fn(|m| left[m] * right[m]);
        }
        let sums: [S::Wide; GROUPS] = if GROUPS <= TOGETHER {
            self.inner::<GROUPS>(k + 1, 0)
        } else {
            core::array::from_fn(|group| self.inner::<1>(k + 1, group)[0])
        };
        let sums = sums.map(S::scatter);
        // the terms with the newest coefficients one by one: the others do not wait for them
        let (first_left, first_right) = &self.first;
        core::array::from_fn(|m| {
            let newest = first_left[m] * right[m] + left[m] * first_right[m];
            newest + sums[m / 8][m % 8]
        })
    }

    /// `sum_(2 <= j <= k-2) u_j v_(k-j)` of a block of groups, the even and the odd j in chains of their own.
    #[inline(always)]
    fn inner<const BLOCK: usize>(&self, k: usize, first: usize) -> [S::Wide; BLOCK] {
        let last = k.saturating_sub(1).max(2);
        let (left, right) = (&self.left[2..last], &self.right[2..last]);
        let mut even = [S::zero().widen(); BLOCK];
        let mut odd = even;
        let add = |sums: &mut [S::Wide; BLOCK], u: &[S::Wide; GROUPS], v: &[S::Wide; GROUPS]| {
            for (g, sum) in sums.iter_mut().enumerate() {
                *sum += u[first + g] * v[first + g];
            }
        };
        let (lefts, rights) = (left.chunks_exact(2), right.rchunks_exact(2));
        if let ([u], [v]) = (lefts.remainder(), rights.remainder()) {
            add(&mut even, u, v);
        }
        for (u, v) in lefts.zip(rights) {
            add(&mut even, &u[0], &v[1]);
            add(&mut odd, &u[1], &v[0]);
        }
        core::array::from_fn(|g| even[g] + odd[g])
    }
}

/// Eight numbers of a list from a multiple of eight on, zeros beyond its end.
#[inline(always)]
fn gathered<S: Scalar, const PAIRS: usize>(numbers: &[S; PAIRS], group: usize) -> S::Wide {
    S::gather(core::array::from_fn(|m| {
        let place = 8 * group + m;
        if place < PAIRS {
            numbers[place]
        } else {
            S::zero()
        }
    }))
}
