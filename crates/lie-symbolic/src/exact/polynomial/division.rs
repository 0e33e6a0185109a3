//! Quotients, roots and common factors of polynomials.

use num_integer::Integer;

use super::{Budget, Exhausted, Monomial, Polynomial, Rational};

impl Polynomial {
    /// The quotient where the division leaves no remainder; `None` otherwise and for a zero divisor.
    ///
    /// # Errors
    /// [`Exhausted`] where the budget is too small for it.
    pub fn divide_exactly(
        &self,
        divisor: &Self,
        budget: &Budget,
    ) -> Result<Option<Self>, Exhausted> {
        let Some((lead, inverse)) = divisor.leading().and_then(|(m, c)| Some((m, c.recip()?)))
        else {
            return Ok(None);
        };
        let (mut rest, mut quotient) = (self.clone(), Self::default());
        while let Some((monomial, coefficient)) = rest.leading() {
            // With a single divisor and a monomial order the leading terms must divide at each step.
            let Some(shift) = monomial.divide(lead) else {
                return Ok(None);
            };
            let factor = coefficient * &inverse;
            for (m, c) in &divisor.0 {
                rest.accumulate_within(m.mul(&shift)?, &-&(c * &factor), budget)?;
            }
            quotient.accumulate(shift, &factor);
        }
        Ok(Some(quotient))
    }

    /// The square root with a positive leading coefficient, where it is a polynomial.
    ///
    /// # Errors
    /// [`Exhausted`] where the budget is too small for it.
    pub fn square_root(&self, budget: &Budget) -> Result<Option<Self>, Exhausted> {
        let Some((monomial, coefficient)) = self.leading() else {
            return Ok(None);
        };
        let Some(lead) = monomial
            .square_root()
            .zip(coefficient.square_root())
            .map(|(monomial, coefficient)| Self::term(monomial, coefficient))
        else {
            return Ok(None);
        };
        let lowest = self.0.first_key_value().map(|(m, _)| m.degree());
        let twice = lead.scale(&Rational::from(2));
        let (mut root, mut rest) = (lead.clone(), self - &lead.mul(&lead, budget)?);
        // each round settles one term of the root, from the highest down
        while let Some((monomial, coefficient)) = rest.leading() {
            let (leading, factor) = match twice.leading() {
                Some(term) if Some(monomial.degree()) >= lowest => term,
                _ => return Ok(None),
            };
            let Some(shift) = monomial.divide(leading) else {
                return Ok(None);
            };
            let term = Self::term(shift, coefficient / factor);
            let change = &root.scale(&Rational::from(2)) + &term;
            rest = &rest - &change.mul(&term, budget)?;
            root = &root + &term;
        }
        Ok(Some(root))
    }

    /// The rational that leaves integer coefficients without common divisor and a positive leading
    /// one; one for zero.
    pub fn content(&self) -> Rational {
        let Some((_, lead)) = self.leading() else {
            return Rational::ONE;
        };
        let first = lead.to_big();
        let (mut n, mut d) = first.into_raw();
        for value in self.0.values() {
            let value = value.to_big();
            n = n.gcd(value.numer());
            d = d.lcm(value.denom());
        }
        let content = Rational::from_big(n, d).unwrap_or(Rational::ONE).abs();
        if lead.is_negative() {
            -content
        } else {
            content
        }
    }

    /// The greatest monomial that divides every term.
    pub fn monomial_content(&self) -> Monomial {
        let mut keys = self.0.keys();
        let first = keys.next().cloned().unwrap_or_default();
        keys.fold(first, |common, m| {
            if common.is_one() {
                common
            } else {
                common.gcd(m)
            }
        })
    }

    /// The quotient by a monomial that divides every term.
    pub fn strip(&self, monomial: &Monomial) -> Self {
        if monomial.is_one() {
            return self.clone();
        }
        Self(
            self.0
                .iter()
                .filter_map(|(m, c)| Some((m.divide(monomial)?, c.clone())))
                .collect(),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn variables() -> [Polynomial; 3] {
        [0, 1, 2].map(Polynomial::variable)
    }

    #[test]
    fn exact_division_undoes_products() {
        let b = Budget::new(100_000);
        let [x, y, z] = variables();
        let p = (&(&x + &y) + &z.scale(&Rational::new(2, 3).unwrap()))
            .pow(5, &b)
            .unwrap();
        let q = (&x.mul(&y, &b).unwrap() - &z).pow(3, &b).unwrap();
        let product = p.mul(&q, &b).unwrap();
        assert_eq!(product.divide_exactly(&p, &b).unwrap().unwrap(), q);
        assert_eq!(product.divide_exactly(&q, &b).unwrap().unwrap(), p);
        assert_eq!((&product + &x).divide_exactly(&q, &b).unwrap(), None);
        assert_eq!(p.divide_exactly(&Polynomial::default(), &b).unwrap(), None);
    }

    #[test]
    fn squares_have_roots() {
        let b = Budget::new(100_000);
        let [x, y, z] = variables();
        let root =
            &(&x.mul(&y, &b).unwrap().scale(&Rational::from(2)) - &z) + &y.pow(3, &b).unwrap();
        let square = root.mul(&root, &b).unwrap();
        assert_eq!(square.square_root(&b).unwrap(), Some(root.clone()));
        assert_eq!(
            (-&root).mul(&-&root, &b).unwrap().square_root(&b),
            Ok(Some(root))
        );
        assert_eq!((&square + &z).square_root(&b), Ok(None));
        assert_eq!(
            (&square + &Polynomial::constant(Rational::ONE)).square_root(&b),
            Ok(None)
        );
        assert_eq!((-&square).square_root(&b), Ok(None));
        assert_eq!(square.scale(&Rational::from(3)).square_root(&b), Ok(None));
    }

    #[test]
    fn content_and_monomials_are_split_off() {
        let b = Budget::new(1000);
        let [x, y, _] = variables();
        let p = &x.mul(&y, &b).unwrap().scale(&Rational::new(-4, 3).unwrap())
            + &x.mul(&x, &b).unwrap().scale(&Rational::new(-2, 5).unwrap());
        assert_eq!(p.content(), Rational::new(-2, 15).unwrap());
        assert_eq!(p.monomial_content(), Monomial::power(0, 1));
        assert_eq!(p.strip(&Monomial::power(0, 1)).degree(), 1);
        let at = |v: usize| Rational::from(v as i64 + 2);
        assert_eq!(
            p.derivative(0).evaluate(&at),
            &Rational::new(-4, 3).unwrap() * &Rational::from(3) - Rational::new(8, 5).unwrap()
        );
    }
}
