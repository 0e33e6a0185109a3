//! The atoms of the normal form.

use super::{NormalForm, Stop};
use crate::exact::{Fraction, Polynomial, Rational};
use crate::symbolic::{Function, Symbol};

/// What a variable of the rational functions stands for.
#[derive(Clone, Debug)]
pub(super) enum Atom {
    /// A coordinate or a parameter.
    Symbol(Symbol),
    /// Pi, which is transcendental.
    Pi,
    /// `i^2 = -1`.
    Imaginary,
    /// `exp(exponent/scale)`; the exponents are linearly independent over the rationals.
    Exponential {
        /// The exponent.
        exponent: Fraction,
        /// Position of the scale.
        slot: usize,
        /// Whether the exponent is imaginary, not real.
        complex: bool,
    },
    /// `|base|^(1/scale)`, where the base is a factor, or a prime number.
    Root {
        /// The base.
        base: Fraction,
        /// `|base|`, as the base times its sign.
        absolute: Fraction,
        /// Position of the scale.
        slot: usize,
    },
    /// `log |argument|` of a factor, or a prime number.
    Logarithm(Fraction),
    /// 1 where a factor is positive, -1 where it is negative.
    Sign(Fraction),
    /// A function without a simpler form.
    Opaque(Function, Vec<Fraction>),
}

impl Atom {
    /// The factor that it is a function of.
    pub fn base(&self) -> Option<&Fraction> {
        match self {
            Atom::Root { base, .. } | Atom::Logarithm(base) | Atom::Sign(base) => Some(base),
            _ => None,
        }
    }
}

impl NormalForm<'_> {
    /// The variable of an atom that is known by what it contains.
    pub(super) fn atom(&mut self, atom: Atom) -> usize {
        let found = self.atoms.iter().position(|known| match (known, &atom) {
            (Atom::Symbol(a), Atom::Symbol(b)) => a == b,
            (Atom::Logarithm(a), Atom::Logarithm(b)) | (Atom::Sign(a), Atom::Sign(b)) => a == b,
            (Atom::Pi, Atom::Pi) | (Atom::Imaginary, Atom::Imaginary) => true,
            _ => false,
        });
        found.unwrap_or_else(|| self.push(atom))
    }

    /// Adds an atom that is not there yet.
    pub(super) fn push(&mut self, atom: Atom) -> usize {
        self.atoms.push(atom);
        self.atoms.len() - 1
    }

    /// The slot of the next exponential or root, and its scale.
    pub(super) fn next_slot(&mut self) -> usize {
        let slot = self
            .atoms
            .iter()
            .filter(|a| matches!(a, Atom::Exponential { .. } | Atom::Root { .. }))
            .count();
        if slot == self.scales.len() {
            self.scales.push(1);
        }
        slot
    }

    /// `variable^(exponent * scale)`, where that exponent is an integer; otherwise the scale is
    /// made finer and everything starts again.
    pub(super) fn scaled_power(
        &mut self,
        variable: usize,
        slot: usize,
        exponent: &Rational,
    ) -> Result<Fraction, Stop> {
        let scaled = exponent * &Rational::from(self.scales[slot]);
        if let Some(integer) = scaled.to_integer() {
            return self.integer_power(&Fraction::variable(variable), integer);
        }
        let (_, denominator) = scaled.to_words().ok_or(Stop::Exhausted)?;
        self.scales[slot] = self.scales[slot]
            .checked_mul(denominator)
            .ok_or(Stop::Exhausted)?;
        Err(Stop::Refine)
    }

    /// A function of arguments that are equal to no arguments seen before, or the same atom again.
    pub(super) fn opaque(
        &mut self,
        function: Function,
        arguments: &[Fraction],
    ) -> Result<Fraction, Stop> {
        for v in 0..self.atoms.len() {
            if let Atom::Opaque(known, others) = &self.atoms[v]
                && *known == function
                && self.all_same(others, arguments)?
            {
                return Ok(Fraction::variable(v));
            }
        }
        Ok(Fraction::variable(
            self.push(Atom::Opaque(function, arguments.to_vec())),
        ))
    }

    fn all_same(&self, a: &[Fraction], b: &[Fraction]) -> Result<bool, Stop> {
        for (a, b) in a.iter().zip(b) {
            if !self.vanishes(&a.sub(b, self.budget)?)? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// The variables of a function.
    pub(super) fn variables<'f>(
        &self,
        value: &'f Fraction,
    ) -> impl Iterator<Item = usize> + use<'f> {
        let polynomials = value
            .denominator()
            .map(|(f, _)| f)
            .chain([value.numerator()]);
        polynomials.flat_map(|p| p.terms().flat_map(|(m, _)| m.powers().map(|(v, _)| v)))
    }

    /// Whether the imaginary unit or an imaginary exponent occurs.
    pub(super) fn is_complex(&self, value: &Fraction) -> bool {
        self.variables(value).any(|v| self.is_complex_atom(v))
    }

    /// Whether a variable is not real.
    pub(super) fn is_complex_atom(&self, v: usize) -> bool {
        match &self.atoms[v] {
            Atom::Imaginary => true,
            Atom::Exponential { complex, .. } => *complex,
            _ => false,
        }
    }

    /// Whether a function is a rational function of symbols and pi, which are algebraically independent.
    pub(super) fn is_plain(&self, value: &Fraction) -> bool {
        self.variables(value)
            .all(|v| matches!(self.atoms[v], Atom::Symbol(_) | Atom::Pi))
    }

    /// Whether a polynomial does not depend on the coordinates.
    pub(super) fn is_constant(&self, value: &Polynomial) -> bool {
        let constant = |f: &Fraction| {
            let mut below = f.denominator().map(|(factor, _)| factor);
            self.is_constant(f.numerator()) && below.all(|factor| self.is_constant(factor))
        };
        let mut variables = value.terms().flat_map(|(m, _)| m.powers().map(|(v, _)| v));
        variables.all(|v| match &self.atoms[v] {
            Atom::Symbol(symbol) => !matches!(symbol, Symbol::Coordinate(_)),
            Atom::Pi | Atom::Imaginary => true,
            Atom::Exponential { exponent, .. } => constant(exponent),
            Atom::Root { base, .. } | Atom::Logarithm(base) | Atom::Sign(base) => constant(base),
            Atom::Opaque(_, arguments) => arguments.iter().all(constant),
        })
    }
}
