//! Angles: `exp(i a)`, in which sine and cosine are written.
//!
//! Of inverse functions `exp(i n asin u) = (sqrt(1 - u^2) + i u)^n` and its kin are known for integers n, of
//! pi the powers `exp(i pi k/12)` by square roots.

use super::atoms::Atom;
use super::{NormalForm, Stop};
use crate::exact::{Fraction, Polynomial, Rational};
use crate::symbolic::{Elementary, ExprId, Function, Node};

impl NormalForm<'_> {
    /// The imaginary unit.
    pub(super) fn unit(&mut self) -> Fraction {
        Fraction::variable(self.atom(Atom::Imaginary))
    }

    /// `exp(i angle)` of an expression; multiples of pi among its terms are taken apart.
    pub(super) fn rotation_of(&mut self, id: ExprId) -> Result<Fraction, Stop> {
        let value = self.values[&id].clone();
        let Node::Sum { terms, .. } = self.graph.node(id) else {
            return self.rotation(&value);
        };
        let is_pi = |id: ExprId| matches!(self.graph.node(id), Node::Pi);
        let Some((pi, factor)) = terms.iter().find(|(term, _)| is_pi(*term)) else {
            return self.rotation(&value);
        };
        let pi = self.values[pi].scale(factor);
        let rest = self.rotation(&value.sub(&pi, self.budget)?)?;
        Ok(rest.mul(&self.rotation(&pi)?, self.budget)?)
    }

    /// `exp(i angle)`
    fn rotation(&mut self, angle: &Fraction) -> Result<Fraction, Stop> {
        let mut product = Fraction::from(Rational::ONE);
        let mut rest = angle.clone();
        if angle.denominator().next().is_none() {
            let mut other = Polynomial::default();
            for (monomial, coefficient) in angle.numerator().terms() {
                let mut powers = monomial.powers();
                let single = match (powers.next(), powers.next()) {
                    (Some((v, 1)), None) => Some(v),
                    _ => None,
                };
                let factor = match single {
                    Some(v) => self.known_rotation(v, coefficient)?,
                    None => None,
                };
                match factor {
                    Some(factor) => product = product.mul(&factor, self.budget)?,
                    None => other.accumulate(monomial.clone(), coefficient),
                }
            }
            rest = other.into();
        }
        let exponent = self.unit().mul(&rest, self.budget)?;
        let exponent = self.reduce(&exponent)?;
        let factor = self.in_basis(&exponent, true)?;
        Ok(product.mul(&factor, self.budget)?)
    }

    /// `exp(i factor v)` of a variable, where it has a simpler form.
    fn known_rotation(&mut self, v: usize, factor: &Rational) -> Result<Option<Fraction>, Stop> {
        let (function, arguments) = match self.atoms[v].clone() {
            Atom::Pi => {
                return match (factor * &Rational::from(12)).to_integer() {
                    Some(k) => self.twelfths(k),
                    None => self.half_turns(factor),
                }
                .map(Some);
            }
            Atom::Opaque(function, arguments) => (function, arguments),
            _ => return Ok(None),
        };
        let Some(times) = factor.to_integer() else {
            return Ok(None);
        };
        let one = Fraction::from(Rational::ONE);
        let half = &Rational::ONE / &Rational::from(2);
        let u = &arguments[0];
        let square = u.mul(u, self.budget)?;
        let unit = self.unit();
        let value = match function {
            Function::Elementary(Elementary::Asin | Elementary::Acos) => {
                let other = self.absolute_power(&one.sub(&square, self.budget)?, &half)?;
                let (real, imaginary) = match function {
                    Function::Elementary(Elementary::Asin) => (&other, u),
                    _ => (u, &other),
                };
                real.add(&unit.mul(imaginary, self.budget)?, self.budget)?
            }
            Function::Elementary(Elementary::Atan) | Function::Atan2 => {
                let x = arguments.get(1).unwrap_or(&one);
                let radius = x.mul(x, self.budget)?.add(&square, self.budget)?;
                // not negative, whatever the normal form knows of it
                let sign = self.sign(&radius)?;
                self.relations.insert(&sign);
                let radius = self.absolute_power(&radius, &-&half)?;
                let point = x.add(&unit.mul(u, self.budget)?, self.budget)?;
                point.mul(&radius, self.budget)?
            }
            _ => return Ok(None),
        };
        // the inverse of a number of modulus one is its conjugate
        let value = if times < 0 {
            self.reduce(&value.pow(-1, self.budget)?.ok_or(Stop::Undefined)?)?
        } else {
            value
        };
        let times = i64::try_from(times.unsigned_abs()).map_err(|_| Stop::Exhausted)?;
        self.integer_power(&value, times).map(Some)
    }

    /// `exp(i pi factor)`, a power of a root of -1.
    fn half_turns(&mut self, factor: &Rational) -> Result<Fraction, Stop> {
        let known = self.atoms.iter().enumerate();
        let mut known = known.filter_map(|(v, atom)| match atom {
            Atom::Exponential { exponent, slot, .. } if self.is_half_turn(exponent) => {
                Some((v, *slot))
            }
            _ => None,
        });
        let found = known.next();
        let (v, slot) = match found {
            Some(found) => found,
            None => {
                let pi = Fraction::variable(self.atom(Atom::Pi));
                let exponent = self.unit().mul(&pi, self.budget)?;
                let slot = self.next_slot();
                let v = self.push(Atom::Exponential {
                    exponent,
                    slot,
                    complex: true,
                });
                (v, slot)
            }
        };
        self.scaled_power(v, slot, factor)
    }

    /// `exp(i pi k/12)`
    fn twelfths(&mut self, k: i64) -> Result<Fraction, Stop> {
        let sine = self.twelfths_cosine((6 - k.rem_euclid(24)).rem_euclid(24))?;
        let cosine = self.twelfths_cosine(k.rem_euclid(24))?;
        let unit = self.unit();
        Ok(cosine.add(&unit.mul(&sine, self.budget)?, self.budget)?)
    }

    /// `cos(pi k/12)` for k from 0 to 23.
    fn twelfths_cosine(&mut self, k: i64) -> Result<Fraction, Stop> {
        let k = k.min(24 - k);
        if k > 6 {
            return Ok(self.twelfths_cosine(12 - k)?.neg());
        }
        // sums of c sqrt(n)/4
        let parts: &[(i64, i64)] = match k {
            0 => &[(4, 1)],
            1 => &[(1, 6), (1, 2)],
            2 => &[(2, 3)],
            3 => &[(2, 2)],
            4 => &[(2, 1)],
            5 => &[(1, 6), (-1, 2)],
            _ => &[],
        };
        let half = &Rational::ONE / &Rational::from(2);
        let mut sum = Fraction::default();
        for (factor, radicand) in parts {
            let root = self.absolute_power(&Rational::from(*radicand).into(), &half)?;
            let factor = &Rational::from(*factor) / &Rational::from(4);
            sum = sum.add(&root.scale(&factor), self.budget)?;
        }
        Ok(sum)
    }

    /// The angles that are rational multiples of pi: `asin 1 = pi/2`, `acos(1/2) = pi/3`, `atan 1 = pi/4`.
    pub(super) fn known_angle(
        &mut self,
        function: Elementary,
        value: &Rational,
    ) -> Option<Fraction> {
        let (p, q) = match (function, value.to_words()?) {
            (Elementary::Asin | Elementary::Atan, (0, 1)) | (Elementary::Acos, (1, 1)) => (0, 1),
            (Elementary::Asin, (1, 1)) | (Elementary::Acos, (0, 1)) => (1, 2),
            (Elementary::Asin, (1, 2)) => (1, 6),
            (Elementary::Acos, (1, 2)) => (1, 3),
            (Elementary::Acos, (-1, 2)) => (2, 3),
            (Elementary::Acos, (-1, 1)) => (1, 1),
            (Elementary::Atan, (1, 1)) => (1, 4),
            _ => return None,
        };
        let pi = Fraction::variable(self.atom(Atom::Pi));
        Some(pi.scale(&Rational::new(p, q)?))
    }

    /// The real g with `value = g^2`, or `value = -g^2` (`true`), where there is one.
    pub(super) fn real_root(&mut self, value: &Fraction) -> Result<Option<(Fraction, bool)>, Stop> {
        let Some(root) = value.numerator().square_root(self.budget)? else {
            return Ok(None);
        };
        let mut root = Fraction::from(root);
        for (factor, exponent) in value.denominator() {
            let Some(half) = i32::try_from(exponent / 2)
                .ok()
                .filter(|_| exponent % 2 == 0)
            else {
                return Ok(None);
            };
            let power = Fraction::from(factor.clone()).pow(-half, self.budget)?;
            root = root.mul(&power.ok_or(Stop::Undefined)?, self.budget)?;
        }
        let conjugate = self.conjugate(&root)?;
        if self.vanishes(&conjugate.sub(&root, self.budget)?)? {
            return Ok(Some((root, false)));
        }
        if self.vanishes(&conjugate.add(&root, self.budget)?)? {
            let real = self.unit().mul(&root, self.budget)?;
            return Ok(Some((real, true)));
        }
        Ok(None)
    }

    /// The complex conjugate.
    fn conjugate(&self, value: &Fraction) -> Result<Fraction, Stop> {
        let mut result = self.conjugate_polynomial(value.numerator())?;
        for (factor, exponent) in value.denominator() {
            let exponent = i32::try_from(exponent).map_err(|_| Stop::Exhausted)?;
            let factor = self.conjugate_polynomial(factor)?;
            let power = factor.pow(-exponent, self.budget)?.ok_or(Stop::Undefined)?;
            result = result.mul(&power, self.budget)?;
        }
        Ok(result)
    }

    fn conjugate_polynomial(&self, polynomial: &Polynomial) -> Result<Fraction, Stop> {
        let mut sum = Fraction::default();
        for (monomial, coefficient) in polynomial.terms() {
            let mut term = Fraction::from(coefficient.clone());
            for (v, exponent) in monomial.powers() {
                let mut power = i32::try_from(exponent).map_err(|_| Stop::Exhausted)?;
                match &self.atoms[v] {
                    Atom::Imaginary if power % 2 == 1 => term = term.neg(),
                    Atom::Exponential { complex: true, .. } => power = -power,
                    _ => {}
                }
                let factor = Fraction::variable(v).pow(power, self.budget)?;
                term = term.mul(&factor.ok_or(Stop::Undefined)?, self.budget)?;
            }
            sum = sum.add(&term, self.budget)?;
        }
        Ok(sum)
    }

    /// Whether an exponent is `i pi`.
    pub(super) fn is_half_turn(&self, exponent: &Fraction) -> bool {
        let mut terms = exponent.numerator().terms();
        let (Some((monomial, coefficient)), None) = (terms.next(), terms.next()) else {
            return false;
        };
        let linear =
            |(v, e): (usize, u32)| e == 1 && matches!(self.atoms[v], Atom::Imaginary | Atom::Pi);
        coefficient.is_one()
            && exponent.denominator().next().is_none()
            && monomial.degree() == 2
            && monomial.powers().all(linear)
    }
}
