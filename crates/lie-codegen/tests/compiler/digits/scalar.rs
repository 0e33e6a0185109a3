//! Numbers for measuring digits: single and double precision, and double-double as the exact ones
//! (Dekker 1971; Hida, Li, Bailey 2001).

use std::fmt::Debug;

/// What the formulas of the test need.
pub trait Number: Copy + Debug {
    fn of(value: f64) -> Self;
    fn to_f64(self) -> f64;
    fn add(self, other: Self) -> Self;
    fn sub(self, other: Self) -> Self;
    fn mul(self, other: Self) -> Self;
    fn div(self, other: Self) -> Self;
    fn sqrt(self) -> Self;
    fn exp(self) -> Self;

    fn powi(self, n: u32) -> Self {
        (0..n).fold(Self::of(1.0), |power, _| power.mul(self))
    }
}

macro_rules! float {
    ($float:ty) => {
        impl Number for $float {
            fn of(value: f64) -> Self {
                value as $float
            }
            fn to_f64(self) -> f64 {
                self.into()
            }
            fn add(self, other: Self) -> Self {
                self + other
            }
            fn sub(self, other: Self) -> Self {
                self - other
            }
            fn mul(self, other: Self) -> Self {
                self * other
            }
            fn div(self, other: Self) -> Self {
                self / other
            }
            fn sqrt(self) -> Self {
                <$float>::sqrt(self)
            }
            fn exp(self) -> Self {
                <$float>::exp(self)
            }
        }
    };
}

float!(f32);
float!(f64);

/// The unevaluated sum of two doubles.
#[derive(Clone, Copy, Debug)]
pub struct Pair(pub f64, pub f64);

fn two_sum(a: f64, b: f64) -> Pair {
    let s = a + b;
    let v = s - a;
    Pair(s, (a - (s - v)) + (b - v))
}

fn two_product(a: f64, b: f64) -> Pair {
    let p = a * b;
    Pair(p, a.mul_add(b, -p))
}

impl Number for Pair {
    fn of(value: f64) -> Self {
        Pair(value, 0.0)
    }
    fn to_f64(self) -> f64 {
        self.0
    }
    fn add(self, other: Self) -> Self {
        let (s, t) = (two_sum(self.0, other.0), two_sum(self.1, other.1));
        let v = two_sum(s.0, s.1 + t.0);
        two_sum(v.0, v.1 + t.1)
    }
    fn sub(self, other: Self) -> Self {
        self.add(Pair(-other.0, -other.1))
    }
    fn mul(self, other: Self) -> Self {
        let p = two_product(self.0, other.0);
        two_sum(p.0, p.1 + self.0 * other.1 + self.1 * other.0)
    }
    fn div(self, other: Self) -> Self {
        let mut quotient = Pair::of(self.0 / other.0);
        for _ in 0..2 {
            let rest = self.sub(quotient.mul(other));
            quotient = quotient.add(Pair::of(rest.0 / other.0));
        }
        quotient
    }
    fn sqrt(self) -> Self {
        let mut root = Pair::of(self.0.sqrt());
        for _ in 0..2 {
            let rest = self.sub(root.mul(root));
            root = root.add(Pair::of(rest.0 / (2.0 * root.0)));
        }
        root
    }
    fn exp(self) -> Self {
        // exp(x) = exp(x/256)^256, the small one by its series
        let small = self.mul(Pair::of(1.0 / 256.0));
        let (mut sum, mut term) = (Pair::of(1.0), Pair::of(1.0));
        for k in 1..24 {
            term = term.mul(small).div(Pair::of(f64::from(k)));
            sum = sum.add(term);
        }
        (0..8).fold(sum, |power, _| power.mul(power))
    }
}

/// A value with its first and second derivatives.
#[derive(Clone, Debug)]
pub struct Jet<T> {
    pub value: T,
    pub first: Vec<T>,
    pub second: Vec<Vec<T>>,
}

impl<T: Number> Jet<T> {
    pub fn constant(value: T, n: usize) -> Self {
        let zero = T::of(0.0);
        Self {
            value,
            first: vec![zero; n],
            second: vec![vec![zero; n]; n],
        }
    }

    pub fn variable(value: T, i: usize, n: usize) -> Self {
        let mut jet = Self::constant(value, n);
        jet.first[i] = T::of(1.0);
        jet
    }

    fn combine(&self, other: &Self, f: impl Fn(T, T) -> T) -> Self {
        let n = self.first.len();
        Self {
            value: f(self.value, other.value),
            first: (0..n).map(|i| f(self.first[i], other.first[i])).collect(),
            second: (0..n)
                .map(|i| {
                    (0..n)
                        .map(|j| f(self.second[i][j], other.second[i][j]))
                        .collect()
                })
                .collect(),
        }
    }

    pub fn add(&self, other: &Self) -> Self {
        self.combine(other, T::add)
    }

    pub fn sub(&self, other: &Self) -> Self {
        self.combine(other, T::sub)
    }

    pub fn mul(&self, other: &Self) -> Self {
        let n = self.first.len();
        let (a, b) = (self, other);
        Self {
            value: a.value.mul(b.value),
            first: (0..n)
                .map(|i| a.first[i].mul(b.value).add(a.value.mul(b.first[i])))
                .collect(),
            second: (0..n)
                .map(|i| {
                    (0..n)
                        .map(|j| {
                            let mixed = a.first[i].mul(b.first[j]).add(a.first[j].mul(b.first[i]));
                            let outer =
                                a.second[i][j].mul(b.value).add(a.value.mul(b.second[i][j]));
                            outer.add(mixed)
                        })
                        .collect()
                })
                .collect(),
        }
    }

    /// `f(self)` from `f` and its derivatives.
    fn chain(&self, f: T, slope: T, bend: T) -> Self {
        let n = self.first.len();
        Self {
            value: f,
            first: (0..n).map(|i| slope.mul(self.first[i])).collect(),
            second: (0..n)
                .map(|i| {
                    (0..n)
                        .map(|j| {
                            let square = self.first[i].mul(self.first[j]);
                            slope.mul(self.second[i][j]).add(bend.mul(square))
                        })
                        .collect()
                })
                .collect(),
        }
    }

    pub fn recip(&self) -> Self {
        let one = T::of(1.0);
        let inverse = one.div(self.value);
        let slope = T::of(-1.0).mul(inverse.powi(2));
        self.chain(inverse, slope, T::of(2.0).mul(inverse.powi(3)))
    }

    pub fn powi(&self, n: u32) -> Self {
        let (k, x) = (f64::from(n), self.value);
        let slope = T::of(k).mul(x.powi(n - 1));
        let bend = if n > 1 { x.powi(n - 2) } else { T::of(0.0) };
        self.chain(x.powi(n), slope, T::of(k * (k - 1.0)).mul(bend))
    }

    pub fn exp(&self) -> Self {
        let value = self.value.exp();
        self.chain(value, value, value)
    }

    pub fn sqrt(&self) -> Self {
        let root = self.value.sqrt();
        let slope = T::of(0.5).div(root);
        self.chain(root, slope, T::of(-0.25).div(root.powi(3)))
    }
}
