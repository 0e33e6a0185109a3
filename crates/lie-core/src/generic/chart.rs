//! How far the Cayley map and the rational functions of Gauss methods reach.
//!
//! `cay(s xi) = (1 - s rho(xi)/2)^-1 (1 + s rho(xi)/2)` is a path in the group from the identity as long as no real
//! eigenvalue of `s rho(xi)` comes to 2 or -2. Beyond such a pole the group element can lie in another component of
//! the group, and `Ad*` of it takes a state off its coadjoint orbit. Complex eigenvalues do not meet the poles.

use super::kernels::direction;
use crate::matrix::SquareMatrix;
use crate::newton::exchanging;
use crate::poisson::CayleyPoisson;
use crate::scalar::{Mask, Scalar};
use crate::state::State;
use crate::structure::Spectrum;

/// The absolute value of an eigenvalue at which the Cayley map has a pole.
pub const CAYLEY_POLE: f64 = 2.0;
/// The largest part of a step that is surely invertible that is made.
const PART: f64 = 0.9;
/// A step along the path below which it has come to a singular matrix.
const SMALLEST: f64 = 1e-6;
/// More steps than a path needs that no singular matrix is near.
const STEPS: usize = 80;

/// The lanes in which the Cayley map is joined to the identity along xi.
///
/// The matrix that is inverted for it is not needed: `(dcay_x^-1)* = 1 - ad*_x/2 - Q_x/4` is that of
/// `y -> (1 - x/2) y (1 + x/2)` on the algebra, which is singular exactly where x has the eigenvalue 2 or -2: if it
/// does, `y = x g(x^2)` is in its kernel, with `(t - 4) g(t)` the minimal polynomial of `x^2`, and y is in the
/// algebra because that is closed under triple products.
#[inline]
pub fn cayley_chart<S: Scalar, P: CayleyPoisson<S>>(system: &P, xi: &P::State) -> S::Mask {
    let near = match system.spectrum() {
        Spectrum::Imaginary => return S::Mask::splat(true),
        Spectrum::Bounded(weights) => {
            let mut bound = S::zero();
            for (&weight, entry) in weights.iter().zip(xi.as_slice()) {
                bound += S::from_f64(weight) * entry.abs();
            }
            bound.less(S::from_f64(CAYLEY_POLE))
        }
        Spectrum::Unknown => S::Mask::splat(false),
    };
    if near.all() {
        return near;
    }
    near | far_chart(system, xi)
}

/// The same along `xi = h grad H(m)`, m the momentum at the midpoint.
#[inline]
pub fn cayley_chart_of_step<S: Scalar, P: CayleyPoisson<S>>(
    system: &P,
    h: S,
    m: &P::State,
) -> S::Mask {
    if matches!(system.spectrum(), Spectrum::Imaginary) {
        return S::Mask::splat(true);
    }
    let mut xi = system.zero_state();
    direction(system, h, m, &mut xi);
    cayley_chart(system, &xi)
}

#[cold]
fn far_chart<S: Scalar, P: CayleyPoisson<S>>(system: &P, xi: &P::State) -> S::Mask {
    let (mut first, mut second) = (system.zero_jacobian(), system.zero_jacobian());
    system.ad_star_matrix(xi, &mut first);
    let (mut unit, mut column) = (system.zero_state(), system.zero_state());
    let (half, quarter) = (S::ratio(-1.0, 2.0), S::ratio(-1.0, 4.0));
    for j in 0..system.dimension() {
        unit.fill(S::zero());
        unit.as_mut_slice()[j] = S::one();
        system.triple(xi, xi, &unit, &mut column);
        for (i, &entry) in column.as_slice().iter().enumerate() {
            second.set(i, j, quarter * entry);
            first.set(i, j, half * first.get(i, j));
        }
    }
    invertible_along(&first, Some(&second))
}

/// The lanes in which `1 + s F + s^2 G` has an inverse for every s from 0 to 1.
///
/// At each s the matrix is inverted, and by the norms of the inverse times the derivatives it is
/// invertible up to some larger s, where the next step begins. Towards a singular matrix the steps get shorter for
/// ever; past one with a complex s, however near, they do not.
#[cold]
pub(crate) fn invertible_along<S: Scalar, M: SquareMatrix<S>>(
    first: &M,
    second: Option<&M>,
) -> S::Mask {
    let size = first.dimension();
    let two = S::from_f64(2.0);
    let (mut matrix, mut inverse) = (first.clone(), first.clone());
    let quadratic = |i, j| second.map_or(S::zero(), |second| second.get(i, j));
    let mut s = S::zero();
    let mut open = S::Mask::splat(true);
    let mut refused = S::Mask::splat(false);
    for _ in 0..STEPS {
        for i in 0..size {
            for j in 0..size {
                let identity = if i == j { S::one() } else { S::zero() };
                let entry = identity + s * (first.get(i, j) + s * quadratic(i, j));
                matrix.set(i, j, entry);
            }
        }
        exchanging::invert(&mut matrix, &mut inverse);
        let slope = norm_of_product(&inverse, |i, j| first.get(i, j) + two * s * quadratic(i, j));
        let curvature = norm_of_product(&inverse, quadratic);
        // invertible where slope d + curvature d^2 < 1
        let part = S::from_f64(PART);
        let root = (slope * slope + two * two * part * curvature).sqrt();
        let step = two * part / (slope + root);
        let moves = S::from_f64(SMALLEST).less(step);
        refused = refused | (open & !moves);
        open = open & moves;
        s = S::select(open, s + step, s);
        open = open & s.less(S::one());
        if !open.any() {
            break;
        }
    }
    !(refused | open)
}

/// The largest absolute sum of a row of `A B`.
fn norm_of_product<S: Scalar, M: SquareMatrix<S>>(
    left: &M,
    right: impl Fn(usize, usize) -> S,
) -> S {
    let size = left.dimension();
    let mut largest = S::zero();
    for i in 0..size {
        let mut sum = S::zero();
        for j in 0..size {
            let mut entry = S::zero();
            for k in 0..size {
                entry += left.get(i, k) * right(k, j);
            }
            sum += entry.abs();
        }
        largest = largest.max(sum);
    }
    largest
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::SMatrix;

    /// Blocks with the eigenvalues a +- i b.
    fn block(a: f64, b: f64) -> SMatrix<f64, 2, 2> {
        SMatrix::<f64, 2, 2>::new(a, 10.0 * b, -0.1 * b, a)
    }

    #[test]
    fn real_eigenvalues_are_told_from_complex_ones() {
        let reaches = |matrix: &SMatrix<f64, 2, 2>| invertible_along(matrix, None);
        for a in [0.0, 0.5, 3.0, -0.9, -0.999, 40.0] {
            assert!(reaches(&block(a, 0.0)), "{a}");
        }
        // a pair of equal eigenvalues crosses: the sign of the determinant is the same on both sides
        for a in [-1.0, -1.001, -3.0, -400.0] {
            assert!(!reaches(&block(a, 0.0)), "{a}");
        }
        for (a, b) in [
            (-1.0, 0.01),
            (-3.0, 0.1),
            (-1.5, 1.0),
            (-50.0, 1.0),
            (0.0, 30.0),
        ] {
            assert!(reaches(&block(a, b)), "{a} {b}");
        }
        let infinite = SMatrix::<f64, 2, 2>::new(f64::NAN, 0.0, 0.0, 0.0);
        assert!(!reaches(&infinite));
    }

    /// `1 - s^2 c` is singular at `s = c^(-1/2)`.
    #[test]
    fn a_quadratic_path() {
        let zero = SMatrix::<f64, 2, 2>::zeros();
        for (c, reaches) in [(0.9, true), (1.1, false), (-30.0, true), (9.0, false)] {
            let second = SMatrix::<f64, 2, 2>::new(-c, 1.0, 0.0, 0.3);
            assert_eq!(invertible_along(&zero, Some(&second)), reaches, "{c}");
        }
    }
}
