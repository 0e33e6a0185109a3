//! Signs: what is known of them, and the relations between those that are not.
//!
//! The sign of a real factor f is an atom s with `s^2 = 1` and `|f| = s f`. Where an expression contains
//! `log g` or a fractional power of g, g is positive on the domain, which is a relation between the signs of
//! its factors: `log(x*y)` says `s_x s_y = 1`, and nothing about x. Such relations are linear over the field
//! with two elements, and are kept in echelon form. An identity is one that holds wherever everything in it
//! is real and defined, hence it may use them.

use std::collections::{BTreeMap, BTreeSet};

use super::atoms::Atom;
use super::{NormalForm, Stop};
use crate::exact::{Fraction, Polynomial, Rational};
use crate::symbolic::{Elementary, ExprId, Function, Graph, Node};

/// `-1` if negative, times the signs that are atoms.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Sign {
    pub negative: bool,
    pub atoms: BTreeSet<usize>,
}

impl Sign {
    /// The product.
    pub fn times(&mut self, other: &Self) {
        self.negative ^= other.negative;
        for atom in &other.atoms {
            if !self.atoms.remove(atom) {
                self.atoms.insert(*atom);
            }
        }
    }

    /// The sign as a function.
    pub fn value(&self) -> Fraction {
        let mut monomial = crate::exact::Monomial::default();
        for atom in &self.atoms {
            // a product of distinct variables is within every bound
            monomial = monomial
                .mul(&crate::exact::Monomial::power(*atom, 1))
                .unwrap_or_default();
        }
        let one = if self.negative {
            Rational::MINUS_ONE
        } else {
            Rational::ONE
        };
        Polynomial::term(monomial, one).into()
    }
}

/// Signs that are products of earlier ones.
#[derive(Clone, Debug, Default)]
pub(super) struct Relations(BTreeMap<usize, Sign>);

impl Relations {
    /// What a sign is equal to.
    pub fn get(&self, atom: usize) -> Option<&Sign> {
        self.0.get(&atom)
    }

    /// Replaces signs by what they are equal to.
    pub fn resolve(&self, sign: &Sign) -> Sign {
        let mut result = Sign {
            negative: sign.negative,
            atoms: BTreeSet::new(),
        };
        let mut rest = sign.atoms.clone();
        while let Some(atom) = rest.pop_last() {
            let Some(equal) = self.0.get(&atom) else {
                result.atoms.insert(atom);
                continue;
            };
            result.negative ^= equal.negative;
            for earlier in &equal.atoms {
                if !rest.remove(earlier) {
                    rest.insert(*earlier);
                }
            }
        }
        result
    }

    /// Adds that a sign is 1; false where that cannot be.
    pub fn insert(&mut self, sign: &Sign) -> bool {
        let mut sign = self.resolve(sign);
        match sign.atoms.pop_last() {
            Some(pivot) => {
                self.0.insert(pivot, sign);
                true
            }
            None => !sign.negative,
        }
    }

    /// Forgets everything.
    pub fn clear(&mut self) {
        self.0.clear();
    }
}

/// What is known of an expression where another, which contains it, is real and defined.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Fact {
    /// It is positive: the argument of a logarithm.
    Positive,
    /// It is not negative: the base of a fractional power.
    NotNegative,
    /// Its square is at most 1: the argument of an inverse sine.
    WithinOne,
}

/// The facts of some expressions.
pub(super) fn facts(graph: &Graph, roots: &[ExprId]) -> BTreeSet<(ExprId, Fact)> {
    let mut found = BTreeSet::new();
    // of a branch nothing follows: it need not be taken
    for id in graph.certain(roots) {
        match graph.node(id) {
            Node::Call(Function::Elementary(Elementary::Log), arguments) => {
                found.insert((arguments[0], Fact::Positive));
            }
            Node::Call(Function::Elementary(Elementary::Asin | Elementary::Acos), arguments) => {
                found.insert((arguments[0], Fact::WithinOne));
            }
            Node::Product(factors) => {
                for (base, exponent) in factors.iter().filter(|(_, e)| !e.is_integer()) {
                    let negative = exponent.is_negative();
                    let fact = if negative {
                        Fact::Positive
                    } else {
                        Fact::NotNegative
                    };
                    found.insert((*base, fact));
                }
            }
            _ => {}
        }
    }
    // a positive number says nothing
    found.retain(|(id, _)| graph.as_number(*id).is_none_or(Rational::is_negative));
    found
}

impl NormalForm<'_> {
    /// Takes what is known of the domain into account.
    pub(super) fn establish(&mut self) -> Result<(), Stop> {
        if self.established {
            return Ok(());
        }
        for (id, fact) in self.facts.clone() {
            let mut value = self.convert(id)?;
            if fact == Fact::WithinOne {
                let square = value.mul(&value, self.budget)?;
                value = Fraction::from(Rational::ONE).sub(&square, self.budget)?;
            }
            if self.vanishes(&value)? {
                continue;
            }
            let sign = match fact {
                Fact::WithinOne => self.sign(&value)?,
                _ => self.sign_of(id)?,
            };
            // Of `f g >= 0` nothing follows where f is zero, and it may be that on an open set where the normal
            // form does not see it; a polynomial is not.
            let plain = |v: &usize| match &self.atoms[*v] {
                Atom::Sign(argument) => self.is_plain(argument),
                _ => false,
            };
            let strict = fact == Fact::Positive;
            let usable = strict || sign.atoms.len() < 2 || sign.atoms.iter().all(plain);
            if usable && !self.relations.insert(&sign) {
                return Err(Stop::Undefined);
            }
        }
        if self.signs_of_sums()? {
            self.values.clear();
        }
        self.established = true;
        Ok(())
    }

    /// Finds the signs of sums that follow from those of their terms; whether there are signs at all.
    fn signs_of_sums(&mut self) -> Result<bool, Stop> {
        let (mut news, mut signs) = (true, false);
        while news {
            news = false;
            for v in 0..self.atoms.len() {
                let Atom::Sign(argument) = self.atoms[v].clone() else {
                    continue;
                };
                signs = true;
                let own = Sign {
                    negative: false,
                    atoms: BTreeSet::from([v]),
                };
                if self.relations.resolve(&own).atoms.is_empty() {
                    continue;
                }
                if let Some(negative) = self.known_sign(&argument) {
                    let relation = Sign { negative, ..own };
                    if !self.relations.insert(&relation) {
                        return Err(Stop::Undefined);
                    }
                    news = true;
                }
            }
        }
        Ok(signs)
    }

    /// The sign of an expression, by its factors as they are written.
    fn sign_of(&mut self, id: ExprId) -> Result<Sign, Stop> {
        let mut sign = Sign::default();
        for (base, exponent) in self.written_factors(id) {
            if exponent.to_integer().is_some_and(|e| e % 2 != 0) {
                sign.times(&self.sign(&base)?);
            }
        }
        Ok(sign)
    }

    /// The sign of a real function.
    pub(super) fn sign(&mut self, value: &Fraction) -> Result<Sign, Stop> {
        let factors = self.factors(value)?;
        let mut sign = Sign {
            negative: factors.content.is_negative(),
            atoms: BTreeSet::new(),
        };
        for (factor, exponent) in factors.parts {
            if exponent % 2 != 0 {
                sign.times(&self.factor_sign(&factor)?);
            }
        }
        Ok(sign)
    }

    /// The sign of a factor.
    pub(super) fn factor_sign(&mut self, factor: &Fraction) -> Result<Sign, Stop> {
        if let Some(negative) = self.known_sign(factor) {
            return Ok(Sign {
                negative,
                atoms: BTreeSet::new(),
            });
        }
        let variable = self.as_variable(factor);
        let atom = match variable.map(|v| &self.atoms[v]) {
            Some(Atom::Sign(_)) => variable.unwrap_or_default(),
            _ => self.atom(Atom::Sign(factor.clone())),
        };
        Ok(Sign {
            negative: false,
            atoms: BTreeSet::from([atom]),
        })
    }

    /// Whether a function is negative, where its sign is known: all its terms have one sign. Zero counts as
    /// either.
    pub(super) fn known_sign(&self, value: &Fraction) -> Option<bool> {
        let mut negative = self.known_polynomial(value.numerator())?;
        for (factor, exponent) in value.denominator() {
            if exponent % 2 == 1 {
                negative ^= self.known_polynomial(factor)?;
            }
        }
        Some(negative)
    }

    fn known_polynomial(&self, polynomial: &Polynomial) -> Option<bool> {
        let mut all = None;
        for (monomial, coefficient) in polynomial.terms() {
            let mut negative = coefficient.is_negative();
            for (v, exponent) in monomial.powers() {
                if exponent % 2 == 1 {
                    negative ^= self.known_variable(v)?;
                } else if self.is_complex_atom(v) {
                    return None;
                }
            }
            if *all.get_or_insert(negative) != negative {
                return None;
            }
        }
        all
    }

    fn known_variable(&self, v: usize) -> Option<bool> {
        match &self.atoms[v] {
            Atom::Pi | Atom::Root { .. } | Atom::Exponential { complex: false, .. } => Some(false),
            Atom::Symbol(symbol) if self.graph.is_positive(*symbol) => Some(false),
            Atom::Logarithm(argument) if argument.as_constant().is_some() => Some(false),
            Atom::Imaginary | Atom::Exponential { .. } => None,
            Atom::Sign(_) => self.resolved(v),
            _ => {
                let own = Fraction::variable(v);
                let sign = |atom: &Atom| matches!(atom, Atom::Sign(argument) if *argument == own);
                self.resolved(self.atoms.iter().position(sign)?)
            }
        }
    }

    fn resolved(&self, atom: usize) -> Option<bool> {
        let sign = self.relations.resolve(&Sign {
            negative: false,
            atoms: BTreeSet::from([atom]),
        });
        sign.atoms.is_empty().then_some(sign.negative)
    }
}
