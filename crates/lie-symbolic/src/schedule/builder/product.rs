//! Products: what is known of them apart, what is divided below.

use super::Builder;
use crate::exact::Rational;
use crate::schedule::KnownSymbols;
use crate::schedule::formula::{Atom, AtomId, Signed};
use crate::schedule::program::Value;
use crate::symbolic::{ExprId, Node};

impl Builder<'_> {
    /// `coefficient * product of base^exponent`.
    pub(super) fn term(
        &mut self,
        factors: &[(ExprId, Rational)],
        coefficient: &Rational,
    ) -> Signed {
        let (negative, coefficient, rest) = self.split(factors, coefficient);
        let (sign, atom) = self.assemble(coefficient, &rest);
        (sign != negative, atom)
    }

    /// Sign, known coefficient and varying factors of a term.
    pub(super) fn split(
        &mut self,
        factors: &[(ExprId, Rational)],
        coefficient: &Rational,
    ) -> (bool, ExprId, Vec<(ExprId, Rational)>) {
        let (known, varying): (Vec<_>, Vec<_>) = factors
            .iter()
            .cloned()
            .partition(|(base, exponent)| self.goes_before(*base, exponent));
        let coefficient = match known.is_empty() {
            true => self.graph.number(coefficient.clone()),
            false => {
                let known = self.graph.power_product(&known);
                self.graph.scale(known, coefficient)
            }
        };
        let negative = self.leads_negative(coefficient);
        let canonical = if negative {
            self.graph.neg(coefficient)
        } else {
            coefficient
        };
        if self.flipped.contains(&canonical) {
            (!negative, self.graph.neg(canonical), varying)
        } else {
            (negative, canonical, varying)
        }
    }

    /// The prepared coefficient of a product.
    pub(super) fn coefficient_of(&self, atom: AtomId) -> Option<ExprId> {
        let Atom::Product(factors) = &self.formula.atoms[atom] else {
            return None;
        };
        if self.known == KnownSymbols::Nothing {
            return None;
        }
        factors
            .iter()
            .find_map(|factor| match &self.formula.atoms[*factor] {
                Atom::Leaf(Value::Prepared(id)) => Some(*id),
                _ => None,
            })
    }

    pub(super) fn assemble(
        &mut self,
        coefficient: ExprId,
        varying: &[(ExprId, Rational)],
    ) -> Signed {
        let mut negative = false;
        let mut above = Vec::new();
        let mut below = Vec::new();
        if !self
            .graph
            .as_number(coefficient)
            .is_some_and(Rational::is_one)
        {
            above.push(self.leaf(coefficient));
        }
        for (base, exponent) in varying {
            negative ^= self.power(*base, exponent, &mut above, &mut below);
        }
        let numerator = self.multiply(above);
        if below.is_empty() {
            return (negative, numerator);
        }
        let denominator = self.multiply(below);
        (
            negative,
            self.formula.intern(Atom::Quotient(numerator, denominator)),
        )
    }

    /// Whether the first rational coefficient is negative: of `c` and `-c` one is chosen.
    pub(super) fn leads_negative(&self, id: ExprId) -> bool {
        match self.graph.node(id) {
            Node::Number(value) => value.is_negative(),
            Node::Sum { terms, .. } => terms[0].1.is_negative(),
            _ => false,
        }
    }

    pub(super) fn multiply(&mut self, mut factors: Vec<AtomId>) -> AtomId {
        let mut flat = Vec::with_capacity(factors.len());
        for factor in factors.drain(..) {
            match &self.formula.atoms[factor] {
                Atom::Product(inner) => flat.extend(inner.iter().copied()),
                _ => flat.push(factor),
            }
        }
        flat.sort_unstable();
        match flat[..] {
            [] => self
                .formula
                .intern(Atom::Leaf(Value::Number(Rational::ONE))),
            [only] => only,
            _ => self.formula.intern(Atom::Product(flat)),
        }
    }
}
