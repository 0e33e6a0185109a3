//! The exact flow of the exchange of two spins, `s_1' = (s_1 + s_2) x s_1` and the opposite of that for the other: both turn about
//! their sum S, by the angle `|S| t`.

use crate::scalar::{Mask, Scalar, largest};

/// So many terms of the series are enough up to this square of the angle: the first one left out moves a spin by less than an eighth
/// of the last bit of its length.
const LEVELS: [(usize, f64); 7] = [
    (4, 3.08e-3),
    (5, 0.0207),
    (6, 0.0819),
    (7, 0.233),
    (8, 0.534),
    (10, 1.86),
    (MOST, 4.0),
];
const MOST: usize = 12;

/// The components of the spins of bonds, the first ones and the second ones.
pub(super) type Pairs<'a, S> = [[&'a mut [S]; 3]; 2];

/// The flow over a time t. With `x = |S|^2 t^2`, `t sin(|S| t)/(|S| t)` and `(1 - cos(|S| t))/|S|^2` are series in x.
///
/// Spins keep their lengths, so that a bound of x for all bonds is known before the step; each lane takes as many terms as it
/// needs by itself.
pub(super) struct Exchange<S: Scalar> {
    t: S,
    /// `(-1)^k t / (2k + 1)!`
    sines: [S; MOST],
    /// `(-1)^k t^2 / (2k + 2)!`
    cosines: [S; MOST],
    /// The largest bound of x of all lanes.
    most: f64,
    /// The lanes for which a series is enough.
    near: S::Mask,
}

impl<S: Scalar> Exchange<S> {
    /// The flow over a time t of spins whose squares are at most `square`.
    pub(super) fn new(t: S, square: S) -> Self {
        let x = S::from_f64(4.0) * square * (t * t);
        let (mut sine, mut cosine) = (t, S::ratio(1.0, 2.0) * t * t);
        let (mut sines, mut cosines) = ([S::zero(); MOST], [S::zero(); MOST]);
        for k in 0..MOST {
            if k > 0 {
                let n = 2.0 * k as f64;
                sine = -sine * S::ratio(1.0, n * (n + 1.0));
                cosine = -cosine * S::ratio(1.0, (n + 1.0) * (n + 2.0));
            }
            // lanes in which fewer terms are enough have zeros in the others, which change no bit
            let enough = LEVELS.iter().rfind(|(terms, _)| *terms <= k);
            (sines[k], cosines[k]) = match enough {
                None => (sine, cosine),
                Some((_, limit)) => {
                    let fewer = x.less(S::from_f64(*limit));
                    (
                        S::select(fewer, S::zero(), sine),
                        S::select(fewer, S::zero(), cosine),
                    )
                }
            };
        }
        Self {
            t,
            sines,
            cosines,
            most: largest(x),
            near: x.less(S::from_f64(LEVELS[LEVELS.len() - 1].1)),
        }
    }

    /// The flow over times t of which each bond has a multiple of its own, `most` in size at most.
    pub(super) fn of_each(t: S, most: S, square: S) -> Self {
        let longest = most * t;
        let unit = Self::new(S::one(), square * (longest * longest));
        // the terms are those of unit time, which each bond multiplies by its own
        Self { t, ..unit }
    }

    /// The flow of bonds of which each has a rate.
    pub(super) fn flow_of_each(&self, pairs: Pairs<'_, S>, rates: &[S]) {
        turn(pairs, |bond, square| {
            let t = self.t * rates[bond];
            let x = square * (t * t);
            let near = (
                t * series(&self.sines, x),
                (t * t) * series(&self.cosines, x),
            );
            if self.near.all() {
                return near;
            }
            let far = by_angles(square, t);
            (
                S::select(self.near, near.0, far.0),
                S::select(self.near, near.1, far.1),
            )
        });
    }

    /// The flow of bonds, each of which has its spins at the same place in the slices.
    #[inline(always)]
    pub(super) fn flow(&self, pairs: Pairs<'_, S>) {
        match self.most {
            x if x < LEVELS[0].1 => self.by_series::<{ LEVELS[0].0 }>(pairs),
            x if x < LEVELS[1].1 => self.by_series::<{ LEVELS[1].0 }>(pairs),
            x if x < LEVELS[2].1 => self.by_series::<{ LEVELS[2].0 }>(pairs),
            x if x < LEVELS[3].1 => self.by_series::<{ LEVELS[3].0 }>(pairs),
            x if x < LEVELS[4].1 => self.by_series::<{ LEVELS[4].0 }>(pairs),
            x if x < LEVELS[5].1 => self.by_series::<{ LEVELS[5].0 }>(pairs),
            x if x < LEVELS[6].1 => self.by_series::<{ LEVELS[6].0 }>(pairs),
            _ => turn(pairs, |_, square| self.far(square)),
        }
    }

    fn by_series<const TERMS: usize>(&self, pairs: Pairs<'_, S>) {
        let (sines, cosines) = (&self.sines[..TERMS], &self.cosines[..TERMS]);
        let squared = self.t * self.t;
        turn(pairs, |_, square| {
            let x = square * squared;
            (series(sines, x), series(cosines, x))
        });
    }

    /// The two functions by sine and cosine, and by their series in the lanes for which that is enough.
    fn far(&self, square: S) -> (S, S) {
        let x = square * (self.t * self.t);
        let (sine, cosine) = by_angles(square, self.t);
        if !self.near.any() {
            return (sine, cosine);
        }
        (
            S::select(self.near, series(&self.sines, x), sine),
            S::select(self.near, series(&self.cosines, x), cosine),
        )
    }
}

/// The two functions by sine and cosine.
fn by_angles<S: Scalar>(square: S, t: S) -> (S, S) {
    // opposite spins do not turn, whatever the functions are
    let square = S::select(S::zero().less(square), square, S::one());
    let size = square.sqrt();
    let (sin, cos) = (S::ratio(1.0, 2.0) * size * t).sin_cos();
    let two = S::from_f64(2.0);
    (two * sin * cos / size, two * sin * sin / square)
}

/// The series at x, as a polynomial in its square over pairs of terms: half as many operations wait for each other as in
/// Horner's rule. Terms of zero at its end change no bit.
#[inline(always)]
fn series<S: Scalar>(terms: &[S], x: S) -> S {
    let square = x * x;
    let (pairs, rest) = terms.as_chunks::<2>();
    let mut pairs = pairs.iter().rev().map(|[even, odd]| *even + *odd * x);
    let last = match rest {
        [single] => *single,
        _ => pairs.next().unwrap_or(S::zero()),
    };
    pairs.fold(last, |sum, pair| sum * square + pair)
}

/// Turns the two spins of each bond about their sum: of the number of the bond and of the square of the sum the two functions are
/// given.
#[inline(always)]
fn turn<S: Scalar>(pairs: Pairs<'_, S>, functions: impl Fn(usize, S) -> (S, S)) {
    let [[x1, y1, z1], [x2, y2, z2]] = pairs;
    let count = x1.len();
    let [y1, z1, x2, y2, z2] = [y1, z1, x2, y2, z2].map(|part| &mut part[..count]);
    for i in 0..count {
        let (a, b) = ([x1[i], y1[i], z1[i]], [x2[i], y2[i], z2[i]]);
        let s = [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
        // S x a = b x a
        let w = cross(b, a);
        let v = cross(s, w);
        let (sine, cosine) = functions(i, s[0] * s[0] + s[1] * s[1] + s[2] * s[2]);
        let d = [
            sine * w[0] + cosine * v[0],
            sine * w[1] + cosine * v[1],
            sine * w[2] + cosine * v[2],
        ];
        (x1[i], y1[i], z1[i]) = (a[0] + d[0], a[1] + d[1], a[2] + d[2]);
        (x2[i], y2[i], z2[i]) = (b[0] - d[0], b[1] - d[1], b[2] - d[2]);
    }
}

#[inline(always)]
fn cross<S: Scalar>(u: [S; 3], v: [S; 3]) -> [S; 3] {
    [
        u[1] * v[2] - u[2] * v[1],
        u[2] * v[0] - u[0] * v[2],
        u[0] * v[1] - u[1] * v[0],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the first terms left out move a unit vector by: `x^(T + 1/2)/(2T + 1)!` of the sine, `x^(T + 1)/(2T + 2)!` of the cosine.
    fn left_out(terms: usize, x: f64) -> f64 {
        let mut move_by = x.sqrt();
        for k in 1..=terms {
            move_by *= x / (2.0 * k as f64) / (2.0 * k as f64 + 1.0);
        }
        move_by.max(move_by * x.sqrt() / (2.0 * terms as f64 + 2.0))
    }

    #[test]
    fn terms_are_as_many_as_round_off_asks_for() {
        let eighth = f64::EPSILON / 16.0;
        for (terms, limit) in LEVELS {
            assert!(left_out(terms, limit) < eighth, "{terms}");
            assert!(
                left_out(terms - 1, limit) > eighth,
                "{terms}: one less would do"
            );
        }
    }

    #[test]
    fn series_and_sine_are_one_flow() {
        let limits = LEVELS.map(|(_, limit)| limit);
        for x in limits.iter().flat_map(|limit| [0.999 * limit, 0.5 * limit]) {
            for square in [1e-6, 1.0, 4.0] {
                // 4 square t^2 is the bound of all bonds
                let t = (x / square).sqrt();
                let bound = square / 4.0;
                let exchange = Exchange::<f64>::new(t, bound);
                let whole = Exchange {
                    near: false,
                    ..Exchange::new(t, bound)
                };
                let (sine, cosine) = whole.far(square);
                let x = square * t * t;
                let enough = LEVELS.iter().find(|(_, limit)| x < *limit);
                let terms = enough.expect("below the last limit").0;
                let error = |terms: usize| {
                    let near = series(&exchange.sines[..terms], x) - sine;
                    let far = series(&exchange.cosines[..terms], x) - cosine;
                    (near * square.sqrt()).abs().max((far * square).abs())
                };
                assert!(error(terms) < 4e-16, "{x} {square}: {:e}", error(terms));
                assert!(error(2) > 1e-15 || x < 1e-3, "two terms are too few at {x}");
                // lanes that need fewer terms have zeros in the others
                assert_eq!(
                    series(&exchange.sines, x),
                    series(&exchange.sines[..terms], x)
                );
            }
        }
    }
}
