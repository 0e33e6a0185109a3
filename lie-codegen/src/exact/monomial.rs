//! Monomials with sparse exponents, in graded lexicographic order.

use std::cmp::Ordering;

use super::budget::Exhausted;

/// The highest total degree; above it a computation counts as exhausted.
const MAX_DEGREE: u32 = 1 << 20;

/// A product of powers of variables; the variables are numbers, their names belong to the caller.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Default)]
pub struct Monomial(Box<[(u32, u32)]>);

impl Monomial {
    /// `variable^exponent`.
    pub fn power(variable: usize, exponent: u32) -> Self {
        if exponent == 0 {
            Self::default()
        } else {
            Self(Box::new([(variable as u32, exponent)]))
        }
    }

    /// Pairs of variable and exponent, ascending, no exponent zero.
    pub fn powers(&self) -> impl Iterator<Item = (usize, u32)> + '_ {
        self.0.iter().map(|&(v, e)| (v as usize, e))
    }

    /// Whether it is the empty product.
    pub fn is_one(&self) -> bool {
        self.0.is_empty()
    }

    /// The sum of the exponents.
    pub fn degree(&self) -> u32 {
        self.0.iter().map(|&(_, e)| e).sum()
    }

    /// The exponent of a variable.
    pub fn exponent(&self, variable: usize) -> u32 {
        self.0
            .iter()
            .find(|p| p.0 as usize == variable)
            .map_or(0, |p| p.1)
    }

    /// The product.
    ///
    /// # Errors
    /// [`Exhausted`] where the degree passes every reasonable size.
    pub fn mul(&self, other: &Self) -> Result<Self, Exhausted> {
        let mut powers = Vec::with_capacity(self.0.len() + other.0.len());
        let (mut a, mut b) = (self.0.iter().peekable(), other.0.iter().peekable());
        let mut degree = 0u32;
        loop {
            let power = match (a.peek(), b.peek()) {
                (Some(&&(v, e)), Some(&&(w, f))) if v == w => {
                    (a.next(), b.next());
                    (v, e.saturating_add(f))
                }
                (Some(&&(v, e)), Some(&&(w, _))) if v < w => {
                    a.next();
                    (v, e)
                }
                (_, Some(&&power)) => {
                    b.next();
                    power
                }
                (Some(&&power), None) => {
                    a.next();
                    power
                }
                (None, None) => break,
            };
            degree = degree.saturating_add(power.1);
            powers.push(power);
        }
        if degree > MAX_DEGREE {
            Err(Exhausted)
        } else {
            Ok(Self(powers.into()))
        }
    }

    /// The quotient where it is a monomial.
    pub fn divide(&self, other: &Self) -> Option<Self> {
        let mut powers = Vec::with_capacity(self.0.len());
        let mut divisor = other.0.iter().peekable();
        for &(v, e) in &self.0 {
            match divisor.peek() {
                Some(&&(w, f)) if w == v => {
                    divisor.next();
                    match e.cmp(&f) {
                        Ordering::Less => return None,
                        Ordering::Equal => {}
                        Ordering::Greater => powers.push((v, e - f)),
                    }
                }
                Some(&&(w, _)) if w < v => return None,
                _ => powers.push((v, e)),
            }
        }
        divisor.next().is_none().then(|| Self(powers.into()))
    }

    /// The greatest common divisor.
    pub fn gcd(&self, other: &Self) -> Self {
        let common = self.0.iter().filter_map(|&(v, e)| {
            let f = other.exponent(v as usize);
            (f > 0).then(|| (v, e.min(f)))
        });
        Self(common.collect())
    }

    /// Splits off the power of one variable.
    pub fn split(&self, variable: usize) -> (u32, Self) {
        let rest = self
            .0
            .iter()
            .copied()
            .filter(|p| p.0 as usize != variable)
            .collect();
        (self.exponent(variable), Self(rest))
    }
}

impl Ord for Monomial {
    fn cmp(&self, other: &Self) -> Ordering {
        self.degree().cmp(&other.degree()).then_with(|| {
            for (&(v, e), &(w, f)) in self.0.iter().zip(&other.0) {
                // The smaller variable is the greater one: where it is missing, the exponent is 0.
                match w.cmp(&v).then(e.cmp(&f)) {
                    Ordering::Equal => {}
                    unequal => return unequal,
                }
            }
            self.0.len().cmp(&other.0.len())
        })
    }
}
impl PartialOrd for Monomial {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
