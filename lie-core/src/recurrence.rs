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

/// The Taylor coefficients of a vector field along its solution. It keeps those found so far, and allocates nothing.
pub trait Recurrence<S: Scalar> {
    /// The state of the system.
    type State: State<S>;

    /// Begins anew at a state: `field = f_0`, the field there.
    fn begin(&mut self, mu: &Self::State, field: &mut Self::State);
    /// `field = f_k` for the next k, from the coefficient `mu_k`; k is 1 after [`Recurrence::begin`], and below
    /// [`MOST_ORDERS`].
    fn advance(&mut self, coefficient: &Self::State, field: &mut Self::State);
}

/// The Taylor coefficients of the gradient of H beside those of the field.
pub trait GradientRecurrence<S: Scalar>: Recurrence<S> {
    /// The coefficient of `grad H(mu(t))` of the order that was computed last.
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
    rest: [S; PAIRS],
    /// The order of the coefficients that come next.
    order: usize,
}

impl<S: Scalar, const PAIRS: usize, const GROUPS: usize> Default for Sums<S, PAIRS, GROUPS> {
    fn default() -> Self {
        let zeros = [[S::zero().widen(); GROUPS]; MOST_ORDERS];
        let none = [S::zero(); PAIRS];
        Self {
            left: zeros,
            right: zeros,
            first: (none, none),
            rest: none,
            order: 1,
        }
    }
}

impl<S: Scalar, const PAIRS: usize, const GROUPS: usize> Sums<S, PAIRS, GROUPS> {
    /// Begins anew, at order 1.
    #[inline(always)]
    pub fn begin(&mut self) {
        self.order = 1;
        self.rest = [S::zero(); PAIRS];
    }

    /// The order of the coefficients that come next.
    #[inline(always)]
    pub fn order(&self) -> usize {
        self.order
    }

    /// The sums of the order that comes next without their first and last terms: `sum_(0<j<k) u_j v_(k-j)`.
    #[inline(always)]
    pub fn rest(&self) -> [S; PAIRS] {
        self.rest
    }

    /// Takes the coefficients u_k and v_k of the next order, and prepares the sums of the one after it.
    #[inline(always)]
    pub fn push(&mut self, left: [S; PAIRS], right: [S; PAIRS]) {
        let k = self.order;
        for group in 0..GROUPS {
            self.left[k][group] = gathered(&left, group);
            self.right[k][group] = gathered(&right, group);
        }
        self.order = k + 1;
        if k == 1 {
            self.first = (left, right);
            self.rest = core::array::from_fn(|m| left[m] * right[m]);
            return;
        }
        // the terms with the newest coefficients one by one: the others do not wait for them
        let (first_left, first_right) = &self.first;
        let newest: [S; PAIRS] =
            core::array::from_fn(|m| first_left[m] * right[m] + left[m] * first_right[m]);
        for group in 0..GROUPS {
            let inner = S::scatter(self.inner(k + 1, group));
            for (m, &sum) in inner.iter().enumerate() {
                if let Some(rest) = self.rest.get_mut(8 * group + m) {
                    *rest = newest[8 * group + m] + sum;
                }
            }
        }
    }

    /// `sum_(2 <= j <= k-2) u_j v_(k-j)` in two chains.
    #[inline(always)]
    fn inner(&self, k: usize, group: usize) -> S::Wide {
        let zero = S::zero().widen();
        let (mut even, mut odd) = (zero, zero);
        let mut j = 2;
        while j + 3 <= k {
            even += self.left[j][group] * self.right[k - j][group];
            odd += self.left[j + 1][group] * self.right[k - j - 1][group];
            j += 2;
        }
        if j + 2 <= k {
            even += self.left[j][group] * self.right[k - j][group];
        }
        even + odd
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
