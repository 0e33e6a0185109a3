//! The motion of a free rigid body in closed form.
//!
//! In the axes of the inertia, Euler's equations are `y_1' = k_1 y_2 y_3` and its cyclic permutations, with
//! `k_1 + k_2 + k_3 = 0`. They are solved by Jacobi's elliptic functions, here in the form S, C, D with
//!
//! ```math
//! S' = C D, \quad C' = -a\, S D, \quad D' = -b\, S C, \qquad S(0) = 0, \quad C(0) = D(0) = 1
//! ```
//!
//! so that `$C^2 + a S^2 = D^2 + b S^2 = 1$`. The addition theorem moves any state, without its phase being known.
//!
//! Reference: E. T. Whittaker, G. N. Watson, "A Course of Modern Analysis", 4th edition, Cambridge 1927, sections 22.2
//! and 22.21, [doi:10.1017/CBO9780511608759](https://doi.org/10.1017/CBO9780511608759).
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use super::words::Words;
use crate::scalar::{Mask, Scalar, power_of_two};

/// Arguments up to this times the frequency are small: five terms of the series have all digits of f64.
const SMALL: f64 = 1.0 / 32.0;
/// Doublings after which an argument is taken for infinite.
const MOST_DOUBLINGS: u32 = 1100;

/// The constants of the motion of a body from a state, and with them its functions of the time.
///
/// They are those of the state and the rates divided by powers of two near their largest, so that nothing overflows in
/// any units; S is that of the time in such units too.
#[derive(Clone, Copy, Debug)]
pub struct FreeBody<S> {
    /// `k_1, k_2, k_3`; the second one has the sign that the others do not have.
    rates: [S; 3],
    a: S,
    b: S,
    /// a - b, which has digits where a and b agree.
    difference: S,
    /// The powers of two by which states and rates are divided.
    units: [S; 2],
}

impl<S: Scalar> FreeBody<S> {
    /// The unit in which a state is near 1.
    pub fn unit(y: [S; 3]) -> S {
        power_of_two(S::largest_magnitude(&y))
    }

    /// The body with these rates, in the state y, whose unit is given: that of any state of its orbit.
    pub fn new(rates: [S; 3], y: [S; 3], unit: S) -> Self {
        let units = [unit, Self::unit(rates)];
        let rates = rates.map(|rate| rate / units[1]);
        let [k1, k2, k3] = rates;
        let [x, y, z] = y.map(|entry| entry / units[0]).map(|entry| entry * entry);
        let both = k1 * k3 * y;
        let (first, last) = (-k2 * k1 * z, -k2 * k3 * x);
        Self {
            rates,
            a: both + first,
            b: both + last,
            difference: first - last,
            units,
        }
    }

    /// The same body eight times.
    pub fn widen(&self) -> FreeBody<S::Wide> {
        FreeBody {
            rates: self.rates.map(S::widen),
            a: self.a.widen(),
            b: self.b.widen(),
            difference: self.difference.widen(),
            units: self.units.map(S::widen),
        }
    }

    /// `-k_2 y_1^2 + k_1 y_2^2` and `k_3 y_2^2 - k_2 y_3^2`, which do not change with the time, in units of the body.
    pub fn constants(&self, y: [S; 3]) -> [Words<S>; 2] {
        let [k1, k2, k3] = self.rates;
        let [x, y, z] = y.map(|entry| {
            let entry = entry / self.units[0];
            Words::product(entry, entry)
        });
        [
            x.times(-k2).plus(y.times(k1)),
            y.times(k3).plus(z.times(-k2)),
        ]
    }

    /// Moves y along the gradients of both constants to where they are the given ones, by one iteration of Newton's method.
    pub fn restored(&self, y: [S; 3], given: [Words<S>; 2]) -> [S; 3] {
        let half = S::ratio(1.0, 2.0);
        let [p, q] = self.constants(y);
        let (p, q) = (half * p.minus(given[0]), half * q.minus(given[1]));
        let [k1, k2, k3] = self.rates;
        let [x1, x2, x3] = y.map(|entry| entry / self.units[0]);
        let (first, second) = ([-k2 * x1, k1 * x2], [k3 * x2, -k2 * x3]);
        // on the axis of the middle moment both gradients point the same way, and the shortest move is enough
        let more = S::one() + S::epsilon().sqrt();
        let pp = (first[0] * first[0] + first[1] * first[1]) * more;
        let qq = (second[0] * second[0] + second[1] * second[1]) * more;
        let pq = first[1] * second[0];
        let determinant = pp * qq - pq * pq;
        let rests = determinant.less_equal(S::zero());
        let inverse = S::one() / S::select(rests, S::one(), determinant);
        let inverse = S::select(rests, S::zero(), inverse);
        let (p, q) = ((p * qq - q * pq) * inverse, (q * pp - p * pq) * inverse);
        [
            (x1 - p * first[0]) * self.units[0],
            (x2 - (p * first[1] + q * second[0])) * self.units[0],
            (x3 - q * second[1]) * self.units[0],
        ]
    }

    /// S, C and D at a time, to round-off times `1 + t sqrt(max(a, b))`.
    ///
    /// The series at `t/2^n`, then n times
    /// `S(2t) = 2 S C D/N`, `C(2t) = (C^2 D^2 - (a - b) S^2)/N = 1 - 2 a S^2 D^2/N`,
    /// `D(2t) = (C^2 D^2 + (a - b) S^2)/N = 1 - 2 b S^2 C^2/N` with `N = C^2 + D^2 - C^2 D^2`. The usual form of the denominator, `1 - a b S^4`, has no digits left near the
    /// separatrix a = b.
    pub fn functions(&self, time: S) -> [S; 3] {
        let quarter = S::ratio(1.0, 4.0);
        let half = S::ratio(1.0, 2.0);
        let small = S::ratio(SMALL * SMALL, 1.0);
        let mut time = time * self.units[0] * self.units[1];
        let mut size = self.a.max(self.b) * time * time;
        let (mut doublings, mut most) = (S::zero(), 0);
        loop {
            let large = small.less(size);
            if !large.any() || most == MOST_DOUBLINGS {
                break;
            }
            size = S::select(large, size * quarter, size);
            time = S::select(large, time * half, time);
            doublings = S::select(large, doublings + S::one(), doublings);
            most += 1;
        }
        let mut values = self.series(time);
        for round in (1..=most).rev() {
            let active = S::from_f64(f64::from(round)).less_equal(doublings);
            let doubled = self.doubled(values);
            values = core::array::from_fn(|i| S::select(active, doubled[i], values[i]));
        }
        values
    }

    /// S, C, D at a small time.
    fn series(&self, t: S) -> [S; 3] {
        let number = |n: f64| S::ratio(n, 1.0);
        let largest = self.a.max(self.b);
        let x = largest * t * t;
        let divisor = S::select(S::zero().less(largest), largest, S::one());
        let (a, b) = (self.a / divisor, self.b / divisor);
        let (sum, product) = (a + b, a * b);
        // symmetric polynomials of a and b: a^2 + 14 a b + b^2, a^3 + 135 a^2 b + …, a^4 + 1228 a^3 b + …
        let square = sum * sum;
        let second = square + number(12.0) * product;
        let third = sum * (square + number(132.0) * product);
        let fourth = square * square
            + number(1224.0) * square * product
            + number(3024.0) * product * product;
        let tail = third / number(5040.0) - x * fourth / number(362_880.0);
        let tail = second / number(120.0) - x * tail;
        let s = t - t * x * (sum / number(6.0) - x * tail);
        let under = |rate: S| (S::one() - rate * s * s).sqrt();
        [s, under(self.a), under(self.b)]
    }

    /// S, C, D at twice the time. While C(2t) is near 1, its distance from 1 is what has digits: that grows fourfold.
    ///
    /// On the separatrix C and D vanish with time, together. Before their squares underflow nothing changes any more.
    fn doubled(&self, [s, c, d]: [S; 3]) -> [S; 3] {
        let (cc, dd, both) = (c * c, d * d, c * d);
        let apart = self.difference * s * s;
        let inverse = S::one() / (cc + (S::one() - cc) * dd);
        let near = |rest: S, other: S| {
            let off = (rest + rest) * s * s * other * inverse;
            (S::one() - off, off.less(S::ratio(1.0, 2.0)))
        };
        let [(near_c, c_is_near), (near_d, d_is_near)] = [near(self.a, dd), near(self.b, cc)];
        let product = both * (both * inverse);
        let apart = apart * inverse;
        let double = s * both;
        let doubled = [
            (double + double) * inverse,
            S::select(c_is_near, near_c, product - apart),
            S::select(d_is_near, near_d, product + apart),
        ];
        let [_, next_c, next_d] = doubled;
        let gone = (next_c * next_c + next_d * next_d).less(smallest());
        let values = [s, c, d];
        core::array::from_fn(|i| S::select(gone, values[i], doubled[i]))
    }

    /// The state that y has become after the time whose functions these are.
    pub fn moved(&self, y: [S; 3], [s, c, d]: [S; 3]) -> [S; 3] {
        let [k1, k2, k3] = self.rates;
        let [x, y, z] = y.map(|entry| entry / self.units[0]);
        let turn = k1 * z * s;
        // 1 - k1 k3 y^2 S^2, without its cancellation
        let inverse = S::one() / (c * c - k2 * z * s * turn);
        [
            (x * c + y * d * turn) * inverse,
            (y * c * d + k2 * z * x * s) * inverse,
            (z * d + k3 * x * y * s * c) * inverse,
        ]
        .map(|entry| entry * self.units[0])
    }
}

/// A sum of squares that has all digits, and an inverse.
fn smallest<S: Scalar>() -> S {
    S::from_f64(if S::epsilon().to_f64() < 1e-10 {
        1e-280
    } else {
        1e-30
    })
}

/// The eigenvectors, as rows of a rotation, and the ascending eigenvalues of a symmetric 3 x 3 matrix, by Jacobi's
/// rotations.
pub fn principal_axes<S: Scalar>(mut matrix: [[S; 3]; 3]) -> ([[S; 3]; 3], [S; 3]) {
    let (zero, one) = (S::zero(), S::one());
    let mut axes = [[one, zero, zero], [zero, one, zero], [zero, zero, one]];
    for _ in 0..10 {
        for (p, q) in [(0, 1), (1, 2), (0, 2)] {
            rotate(&mut matrix, &mut axes, p, q);
        }
    }
    let mut values = [matrix[0][0], matrix[1][1], matrix[2][2]];
    for (p, q) in [(0, 1), (1, 2), (0, 1)] {
        let wrong = values[q].less(values[p]);
        let (low, high) = (values[p], values[q]);
        values[p] = S::select(wrong, high, low);
        values[q] = S::select(wrong, low, high);
        // the sign keeps the frame right-handed
        let (low, high) = (axes[p], axes[q]);
        axes[p] = core::array::from_fn(|k| S::select(wrong, high[k], low[k]));
        axes[q] = core::array::from_fn(|k| S::select(wrong, -low[k], high[k]));
    }
    (axes, values)
}

/// Makes one entry beside the diagonal zero.
fn rotate<S: Scalar>(matrix: &mut [[S; 3]; 3], axes: &mut [[S; 3]; 3], p: usize, q: usize) {
    let (one, entry) = (S::one(), matrix[p][q]);
    let nothing = entry.magnitude().less_equal(S::zero());
    let theta = (matrix[q][q] - matrix[p][p]) / S::select(nothing, one, entry + entry);
    let root = (theta * theta + one).sqrt();
    let negative = theta.less(S::zero());
    let tangent = one / S::select(negative, theta - root, theta + root);
    let tangent = S::select(nothing, S::zero(), tangent);
    let cosine = one / (tangent * tangent + one).sqrt();
    let sine = tangent * cosine;
    let turn = |low: S, high: S| [cosine * low - sine * high, sine * low + cosine * high];
    for row in matrix.iter_mut() {
        [row[p], row[q]] = turn(row[p], row[q]);
    }
    for square in [matrix, axes] {
        let (low, high) = (square[p], square[q]);
        for k in 0..3 {
            [square[p][k], square[q][k]] = turn(low[k], high[k]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// m, u and `sn(u, m)`, `cn(u, m)`, `dn(u, m)`, computed with 50 digits; m near 1 is the separatrix.
    const VALUES: [(f64, f64, [f64; 3]); 6] = [
        (
            0.6,
            0.75,
            [0.6538587089550234, 0.7566166722480214, 0.8622536014620072],
        ),
        (
            0.25,
            5.0,
            [
                -0.9987707846716766,
                -0.049567324784816805,
                0.866379957017463,
            ],
        ),
        (
            0.9999999999990905,
            10.0,
            [
                0.9999999958779201,
                9.079735521879679e-05,
                9.08023634572506e-05,
            ],
        ),
        (
            0.9999999999990905,
            30.0,
            [0.460917723557386, -0.8874428725899358, 0.8874428725900447],
        ),
        (
            1.0,
            3.0,
            [0.9950547536867305, 0.0993279274194332, 0.0993279274194332],
        ),
        (0.0, 7.0, [0.6569865987187891, 0.7539022543433046, 1.0]),
    ];

    #[test]
    fn the_functions_are_jacobis() {
        for (m, u, expected) in VALUES {
            let body = FreeBody {
                rates: [0.0; 3],
                a: 1.0,
                b: m,
                difference: 1.0 - m,
                units: [1.0; 2],
            };
            let found = body.functions(u);
            // an error of the argument, and one of the value
            let [s, c, d] = expected;
            let slopes = [c * d, s * d, m * s * c];
            for ((found, expected), slope) in found.iter().zip(expected).zip(slopes) {
                let bound = 8e-16 * (expected.abs() + (1.0 + u) * slope.abs());
                let off = (found - expected).abs();
                assert!(off <= bound, "{m} {u}: {found:e} {expected:e}, {off:e}");
            }
        }
    }

    #[test]
    fn axes_are_principal() {
        let matrix = [[2.0, 0.3, -0.7], [0.3, 1.0, 0.25], [-0.7, 0.25, 0.5]];
        let (axes, values) = principal_axes::<f64>(matrix);
        assert!(values[0] < values[1] && values[1] < values[2]);
        for (axis, value) in axes.iter().zip(values) {
            for i in 0..3 {
                let image: f64 = (0..3).map(|j| matrix[i][j] * axis[j]).sum();
                assert!((image - value * axis[i]).abs() < 1e-15);
            }
        }
        let [x, y, z] = axes;
        let volume = x[0] * (y[1] * z[2] - y[2] * z[1])
            + x[1] * (y[2] * z[0] - y[0] * z[2])
            + x[2] * (y[0] * z[1] - y[1] * z[0]);
        assert!((volume - 1.0).abs() < 1e-15);
    }
}
