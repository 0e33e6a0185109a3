//! Monomials with sparse exponents, in graded lexicographic order.

use std::cmp::Ordering;

use super::budget::Exhausted;

/// The highest total degree; above it a computation counts as exhausted.
const MAX_DEGREE: u32 = 1 << 20;

/// A product of powers of variables; the variables are numbers, their names belong to the caller.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Default)]
pub struct Monomial {
    /// The total degree, which the order asks for first.
    degree: u32,
    powers: Box<[(u32, u32)]>,
}

impl Monomial {
    fn new(powers: Box<[(u32, u32)]>) -> Self {
        Self {
            degree: powers.iter().map(|p| p.1).sum(),
            powers,
        }
    }

    /// `variable^exponent`.
    pub fn power(variable: usize, exponent: u32) -> Self {
        if exponent == 0 {
            Self::default()
        } else {
            Self::new(Box::new([(variable as u32, exponent)]))
        }
    }

    /// Pairs of variable and exponent, ascending, no exponent zero.
    pub fn powers(&self) -> impl Iterator<Item = (usize, u32)> + '_ {
        self.powers.iter().map(|&(v, e)| (v as usize, e))
    }

    /// The same with other variables, whose order must be that of the old ones.
    pub fn renamed(&self, variable: &dyn Fn(usize) -> usize) -> Self {
        let powers = self.powers().map(|(v, e)| (variable(v) as u32, e));
        let powers: Box<[(u32, u32)]> = powers.collect();
        debug_assert!(powers.is_sorted_by(|a, b| a.0 < b.0));
        Self::new(powers)
    }

    /// Whether it is the empty product.
    pub fn is_one(&self) -> bool {
        self.powers.is_empty()
    }

    /// The sum of the exponents.
    pub fn degree(&self) -> u32 {
        self.degree
    }

    /// The exponent of a variable.
    pub fn exponent(&self, variable: usize) -> u32 {
        self.powers
            .iter()
            .find(|p| p.0 as usize == variable)
            .map_or(0, |p| p.1)
    }

    /// The product.
    ///
    /// # Errors
    /// [`Exhausted`] where the degree passes every reasonable size.
    pub fn mul(&self, other: &Self) -> Result<Self, Exhausted> {
        let mut powers = Vec::with_capacity(self.powers.len() + other.powers.len());
        let (mut a, mut b) = (
            self.powers.iter().peekable(),
            other.powers.iter().peekable(),
        );
        let mut degree = 0u32;
        loop {
            let power = match (a.peek(), b.peek()) {
                (Some(&&(v, e)), Some(&&(w, f))) if v == w => {
                    a.next();
                    b.next();
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
            Ok(Self {
                degree,
                powers: powers.into(),
            })
        }
    }

    /// The quotient where it is a monomial.
    pub fn divide(&self, other: &Self) -> Option<Self> {
        let mut powers = Vec::with_capacity(self.powers.len());
        let mut divisor = other.powers.iter().peekable();
        for &(v, e) in &self.powers {
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
        divisor.next().is_none().then(|| Self::new(powers.into()))
    }

    /// The square root where it is a monomial.
    pub fn square_root(&self) -> Option<Self> {
        let even = self.powers.iter().all(|(_, e)| e % 2 == 0);
        let halves = self.powers.iter().map(|&(v, e)| (v, e / 2));
        even.then(|| Self::new(halves.collect()))
    }

    /// The greatest common divisor.
    pub fn gcd(&self, other: &Self) -> Self {
        let common = self.powers.iter().filter_map(|&(v, e)| {
            let f = other.exponent(v as usize);
            (f > 0).then(|| (v, e.min(f)))
        });
        Self::new(common.collect())
    }

    /// Splits off the power of one variable.
    pub fn split(&self, variable: usize) -> (u32, Self) {
        let rest = self
            .powers
            .iter()
            .copied()
            .filter(|p| p.0 as usize != variable)
            .collect();
        (self.exponent(variable), Self::new(rest))
    }
}

impl Ord for Monomial {
    fn cmp(&self, other: &Self) -> Ordering {
        self.degree.cmp(&other.degree).then_with(|| {
            for (&(v, e), &(w, f)) in self.powers.iter().zip(&other.powers) {
                // The smaller variable is the greater one: where it is missing, the exponent is 0.
                match w.cmp(&v).then(e.cmp(&f)) {
                    Ordering::Equal => {}
                    unequal => return unequal,
                }
            }
            self.powers.len().cmp(&other.powers.len())
        })
    }
}
impl PartialOrd for Monomial {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
