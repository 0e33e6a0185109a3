//! Products and rational powers in normal form.

use std::collections::BTreeMap;

use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::Signed;

use super::graph::{ExprId, Graph, Node};
use crate::exact::Rational;

/// Powers of numbers are folded while numerator and denominator stay below this size together.
const FOLDED_BITS: u64 = 4096;

impl Graph {
    /// The product of the factors.
    pub fn product(&mut self, factors: &[ExprId]) -> ExprId {
        let factors: Vec<_> = factors.iter().map(|&id| (id, Rational::ONE)).collect();
        self.power_product(&factors)
    }

    /// `base^exponent`. `(b^a)^e` is `b^(a e)` only for integer `e`: the square root of `x^2` is not `x`.
    pub fn pow(&mut self, base: ExprId, exponent: &Rational) -> ExprId {
        self.power_product(&[(base, exponent.clone())])
    }

    /// The product of `base^exponent`.
    pub fn power_product(&mut self, factors: &[(ExprId, Rational)]) -> ExprId {
        let mut coefficient = Rational::ONE;
        let mut bases: BTreeMap<ExprId, Rational> = BTreeMap::new();
        for (base, exponent) in factors {
            self.collect_factor(*base, exponent, &mut coefficient, &mut bases);
        }
        // Powers of numbers whose exponents have added up are folded once more.
        let numbers: Vec<ExprId> = bases
            .keys()
            .copied()
            .filter(|&b| self.as_number(b).is_some())
            .collect();
        for base in numbers {
            let exponent = bases.remove(&base).unwrap_or(Rational::ZERO);
            let value = self.as_number(base).cloned().unwrap_or(Rational::ONE);
            let (folded, rest) = fold_power(&value, &exponent);
            coefficient = &coefficient * &folded;
            if let Some((rest_base, rest_exponent)) = rest {
                let id = self.number(rest_base);
                bases.insert(id, rest_exponent);
            }
        }
        if coefficient.is_zero()
            && !bases
                .iter()
                .any(|(&b, e)| self.is_zero(b) && e.is_negative())
        {
            return self.number(Rational::ZERO);
        }
        let factors: Vec<_> = bases.into_iter().filter(|(_, e)| !e.is_zero()).collect();
        let product = match factors.as_slice() {
            [] => return self.number(coefficient),
            [(base, exponent)] if exponent.is_one() => *base,
            _ => self.intern(Node::Product(factors.into())),
        };
        self.scale(product, &coefficient)
    }

    fn collect_factor(
        &mut self,
        base: ExprId,
        exponent: &Rational,
        coefficient: &mut Rational,
        bases: &mut BTreeMap<ExprId, Rational>,
    ) {
        let mut insert = |base: ExprId, exponent: &Rational| {
            let entry = bases.entry(base).or_insert(Rational::ZERO);
            *entry = &*entry + exponent;
        };
        match self.node(base).clone() {
            Node::Number(value) => match integer_power(&value, exponent) {
                Some(power) => *coefficient = &*coefficient * &power,
                None => insert(base, exponent),
            },
            Node::Product(factors) if exponent.is_integer() => {
                for (inner, power) in factors.iter() {
                    insert(*inner, &(power * exponent));
                }
            }
            Node::Sum { constant, terms } if exponent.is_integer() => {
                // `(2*x + 4*y)^2` is `4*(x + 2*y)^2`: proportional sums are one base.
                let scale = content(&constant, &terms);
                match integer_power(&scale, exponent).zip(scale.recip()) {
                    Some((power, inverse)) if !scale.is_one() => {
                        *coefficient = &*coefficient * &power;
                        let rest = self.scale(base, &inverse);
                        self.collect_factor(rest, exponent, coefficient, bases);
                    }
                    _ => insert(base, exponent),
                }
            }
            _ => insert(base, exponent),
        }
    }
}

/// The rational factor that all coefficients of a sum share, with the sign of the first.
fn content(constant: &Rational, terms: &[(ExprId, Rational)]) -> Rational {
    // in wide integers, because the absolute value of the least word is no word
    let mut content: Option<(i128, i128)> = None;
    for coefficient in terms
        .iter()
        .map(|(_, c)| c)
        .chain((!constant.is_zero()).then_some(constant))
    {
        let Some((n, d)) = coefficient.to_words() else {
            return Rational::ONE;
        };
        let (n, d) = (i128::from(n), i128::from(d));
        let (p, q) = content.unwrap_or((0, 1));
        let lcm = q / q.gcd(&d) * d;
        if i64::try_from(lcm).is_err() {
            return Rational::ONE;
        }
        content = Some((p.gcd(&n), lcm));
    }
    let sign = if terms.first().is_some_and(|(_, c)| c.is_negative()) {
        -1
    } else {
        1
    };
    content
        .and_then(|(n, d)| Rational::new(i64::try_from(n * sign).ok()?, i64::try_from(d).ok()?))
        .filter(|content| !content.is_zero())
        .unwrap_or(Rational::ONE)
}

/// `value^exponent` for an integer exponent, while the result is of reasonable size.
fn integer_power(value: &Rational, exponent: &Rational) -> Option<Rational> {
    let power = i32::try_from(exponent.to_integer()?).ok()?;
    if value.bits().saturating_mul(u64::from(power.unsigned_abs())) > FOLDED_BITS
        && !value.abs().is_one()
    {
        return None;
    }
    value.pow(power)
}

/// Splits `value^exponent` into a rational factor and what stays a power.
fn fold_power(value: &Rational, exponent: &Rational) -> (Rational, Option<(Rational, Rational)>) {
    if exponent.is_zero() || value.is_one() {
        return (Rational::ONE, None);
    }
    if let Some(power) = integer_power(value, exponent) {
        return (power, None);
    }
    if value.is_zero() {
        let rest = exponent
            .is_negative()
            .then_some((Rational::ZERO, Rational::MINUS_ONE));
        return (
            if rest.is_some() {
                Rational::ONE
            } else {
                Rational::ZERO
            },
            rest,
        );
    }
    let Some((p, q)) = exponent.to_words() else {
        return (Rational::ONE, Some((value.clone(), exponent.clone())));
    };
    if let Some(root) = exact_root(value, q)
        && let Some(power) = integer_power(&root, &Rational::from(p))
    {
        return (power, None);
    }
    // 2^(3/2) = 2 * 2^(1/2)
    let whole = Rational::from(p.div_euclid(q));
    match (
        integer_power(value, &whole),
        Rational::new(p.rem_euclid(q), q),
    ) {
        (Some(power), Some(rest)) => (power, Some((value.clone(), rest))),
        _ => (Rational::ONE, Some((value.clone(), exponent.clone()))),
    }
}

/// The rational `q`-th root of a positive number, where there is one.
fn exact_root(value: &Rational, q: i64) -> Option<Rational> {
    let q = u32::try_from(q).ok().filter(|q| (2..=16).contains(q))?;
    let big = value.to_big();
    if big.is_negative() {
        return None;
    }
    let root = |n: &BigInt| {
        let root = n.nth_root(q);
        (root.pow(q) == *n).then_some(root)
    };
    Rational::from_big(root(big.numer())?, root(big.denom())?)
}
