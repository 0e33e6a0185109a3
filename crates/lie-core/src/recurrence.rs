//! Taylor coefficients of solutions, one order after the other.
//!
//! With `mu(t) = sum_k mu_k t^k` and `f(mu(t)) = sum_k f_k t^k`, the equation `mu' = f(mu)` gives
//! `(k + 1) mu_(k+1) = f_k`, and `f_k` follows from `mu_0, …, mu_k`: each operation of the field has a rule for the
//! coefficients of its result, that of a product being the sum `(u v)_k = sum_j u_j v_(k-j)`.

use crate::poisson::Poisson;
use crate::scalar::Scalar;
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
    /// Writes the coefficients of the orders 1 to `last` of a solution from a state in one, each times the power of a unit of time, in
    /// some lanes, and keeps those of the conditions; false where the system has no program of all orders, and nothing is done.
    fn develop(
        &mut self,
        _mu: &Self::State,
        _unit: S,
        _last: usize,
        _rows: &mut [Self::State],
        _lanes: S::Mask,
    ) -> bool {
        false
    }
    /// The coefficients of an order of the conditions that choose branches, each with its first branch where it is negative,
    /// of the orders since [`Recurrence::begin`].
    fn conditions(&self, _k: usize) -> &[S] {
        &[]
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
