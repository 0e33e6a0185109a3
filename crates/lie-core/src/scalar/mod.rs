//! The scalar of all numeric code: `f64`, `f32`, SIMD lanes and dual numbers behind one trait.
//!
//! Exponential, logarithm, sine, cosine and tangent are programs of ours, which all lanes do at once; other elementary functions come
//! from the `libm` crate, lane by lane. Nothing is contracted to a fused multiply-add: the same input gives the same bits on every
//! machine, and a lane gives the bits of the scalar run.

mod branch;
mod dual;
pub(crate) mod elementary;
mod float;
#[cfg(feature = "lanes")]
mod lanes;
mod mask;
mod pack;
mod partial;
mod primitive;
#[cfg(feature = "lanes")]
mod registers;
mod truncated;

pub use branch::nearest_branch;
pub use dual::Dual;
#[cfg(feature = "lanes")]
pub use lanes::{F32x8, F64x4, F64x8, Mask32x8, Mask64x4, Mask64x8};
pub use mask::Mask;
pub use pack::{Pack, PackMask};
pub use partial::{declared_derivative, partial};
pub use primitive::Primitive;
pub use truncated::Truncated;

use core::fmt::Debug;
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// The methods of the elementary functions.
macro_rules! methods {
    ($($variant:ident $name:ident $single:ident $from:ident $what:literal $facts:tt)+) => {
        $(#[doc = concat!("`", stringify!($name), "(x)`: ", $what, ".")]
        fn $name(self) -> Self;)+
    };
}

/// A real number, or several independent ones in lanes.
///
/// Comparisons return a [`Mask`] with one truth value per lane and [`Scalar::select`] chooses by
/// it, so that code without branches serves one lane and eight.
///
/// ```
/// use lie_core::Scalar;
/// fn relu<S: Scalar>(x: S) -> S {
///     S::select(x.less(S::zero()), S::zero(), x)
/// }
/// assert_eq!(relu(-2.0_f64), 0.0);
/// assert_eq!(relu(2.0_f32), 2.0);
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a scalar",
    note = "scalars are f64, f32, the lanes F64x4, F64x8, F32x8, and Dual of any of these"
)]
pub trait Scalar:
    Copy
    + Debug
    + Default
    + PartialEq
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + DivAssign
{
    /// One lane; the type itself where there is only one.
    type Lane: Scalar<Lane = Self::Lane, Mask = bool>;
    /// One truth value per lane.
    type Mask: Mask;
    /// Eight of these numbers at once, in a register where there is one for them: the stages of a step side by side.
    type Wide: Scalar;
    /// The number of lanes.
    const LANES: usize;
    /// How many derivatives along directions the number carries: 0 of plain numbers, one more with
    /// each [`Dual`].
    const DERIVATIVES: u32 = 0;
    /// Whether a kernel of a system may be a loop over it: an iteration that a value ends, or one over sites. Not over a scalar that
    /// writes straight programs down; what only such systems need is not compiled for it.
    const LOOPS: bool = true;

    /// 0 in every lane.
    fn zero() -> Self;
    /// 1 in every lane.
    fn one() -> Self;
    /// The number nearest to `numerator / denominator`, both of which must be integers that f64
    /// holds exactly.
    fn ratio(numerator: f64, denominator: f64) -> Self;
    /// The number nearest to `high + low`, for constants beyond 53 bits; `high` must be the f64
    /// nearest to the sum.
    fn constant(high: f64, low: f64) -> Self;
    /// The number nearest to an f64.
    fn from_f64(value: f64) -> Self;
    /// The distance from 1 to the next larger number.
    fn epsilon() -> Self;

    /// The number as a quantity of its own. A symbolic scalar does not mix its parts with the expressions that use it;
    /// for plain numbers this changes nothing.
    #[must_use]
    #[inline(always)]
    fn quantity(self) -> Self {
        self
    }

    /// Numbers that are found by comparisons. A symbolic scalar takes them as arguments, numbered from the given index
    /// on.
    #[inline(always)]
    fn given<const K: usize>(_first: usize, compute: impl FnOnce() -> [Self; K]) -> [Self; K] {
        compute()
    }

    /// The same number in every lane.
    fn splat(lane: Self::Lane) -> Self;
    /// The number in one lane; `index` must be below [`Scalar::LANES`].
    fn lane(self, index: usize) -> Self::Lane;
    /// A copy with another number in one lane; `index` must be below [`Scalar::LANES`].
    #[must_use]
    fn with_lane(self, index: usize, lane: Self::Lane) -> Self;
    /// The number of each lane by its place.
    fn from_lanes(mut number: impl FnMut(usize) -> Self::Lane) -> Self {
        let lanes = 0..Self::LANES;
        lanes.fold(Self::zero(), |all, lane| all.with_lane(lane, number(lane)))
    }
    /// The number in lane 0 (of a dual number its value).
    fn to_f64(self) -> f64;

    /// The largest lane as f64, for reports; not a number if any lane is.
    fn reported(self) -> f64 {
        (1..Self::LANES).fold(self.lane(0).to_f64(), |largest, index| {
            Scalar::max(largest, self.lane(index).to_f64())
        })
    }
    /// How much of something the lane took that took most, where each lane took so much, and `all` was made.
    fn counted(self, all: u32, _what: Counted) -> u32 {
        match Self::LANES {
            1 => all,
            _ => self.reported() as u32,
        }
    }
    /// The larger of two numbers that [`Scalar::reported`] gave.
    fn larger(one: f64, other: f64) -> f64 {
        Scalar::max(one, other)
    }

    /// Eight numbers as one.
    fn gather(numbers: [Self; 8]) -> Self::Wide;
    /// The eight numbers, in the order of [`Scalar::gather`].
    fn scatter(wide: Self::Wide) -> [Self; 8];
    /// The eight numbers with places i and i xor D exchanged.
    #[inline(always)]
    fn exchange<const D: usize>(wide: Self::Wide) -> Self::Wide {
        let numbers = Self::scatter(wide);
        Self::gather(core::array::from_fn(|i| numbers[i ^ D]))
    }
    /// This number eight times.
    #[inline(always)]
    fn widen(self) -> Self::Wide {
        Self::gather([self; 8])
    }

    /// Absolute value.
    fn abs(self) -> Self;
    /// The size that counts in a norm: [`Scalar::abs`], and of a dual number the larger of value
    /// and derivative, so that an iteration over dual numbers ends only when both have converged.
    fn magnitude(self) -> Self {
        self.abs()
    }
    /// The largest [`Scalar::magnitude`] of some numbers, 0 of none; not a number if one of them is not.
    #[inline(always)]
    fn largest_magnitude(numbers: &[Self]) -> Self {
        numbers.iter().fold(Self::zero(), |largest, number| {
            largest.max(number.magnitude())
        })
    }
    /// Square root, correctly rounded.
    fn sqrt(self) -> Self;
    crate::elementary_functions!(methods);
    /// Sine and cosine of an angle in radians.
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        (self.sin(), self.cos())
    }
    /// The angle of the point (`x`, `self`) in radians.
    fn atan2(self, x: Self) -> Self;
    /// `self` to a real power.
    fn powf(self, exponent: Self) -> Self;

    /// The larger of two numbers; not a number if either is not.
    fn max(self, other: Self) -> Self;
    /// `self < other`, false where either is not a number.
    fn less(self, other: Self) -> Self::Mask;
    /// `self <= other`, false where either is not a number.
    fn less_equal(self, other: Self) -> Self::Mask;
    /// Whether the number is finite (for a dual number: value and derivative).
    fn finite(self) -> Self::Mask;
    /// `yes` in the lanes where the mask is true, `no` in the others.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
}

/// What a solver counts in each lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Counted {
    /// Iterations of all kinds.
    Iterations,
    /// Those among them without a Jacobian.
    WithoutJacobian,
    /// Jacobians that were factored.
    Factorizations,
}

/// The largest lane as f64, for reports; not a number if any lane is.
pub fn largest<S: Scalar>(value: S) -> f64 {
    value.reported()
}

/// A number without its derivatives.
#[inline]
pub fn frozen<S: Scalar>(number: S) -> S {
    if S::DERIVATIVES == 0 {
        return number;
    }
    S::from_lanes(|lane| S::Lane::from_f64(number.lane(lane).to_f64()))
}

/// The power of two at or below a positive number, lane by lane; of zero 1.
pub fn power_of_two<S: Scalar>(number: S) -> S {
    const EXPONENT: u64 = 0x7ff << 52;
    let mut power = S::one();
    for lane in 0..S::LANES {
        let bits = number.lane(lane).to_f64().to_bits() & EXPONENT;
        if bits != 0 {
            power = power.with_lane(lane, S::Lane::from_f64(f64::from_bits(bits)));
        }
    }
    power
}
