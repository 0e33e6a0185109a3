//! Powers and quotients: one division per base, however often it is divided by.

use std::collections::BTreeMap;

use super::builder::Builder;
use super::formula::{Atom, AtomId};
use super::program::Value;
use crate::exact::Rational;
use crate::symbolic::{ExprId, Node};

/// How negative powers of a base are computed.
#[derive(Clone, Copy, PartialEq)]
pub enum Inverse {
    /// By one division where it occurs.
    Direct,
    /// Through `1/base`, computed once.
    Reciprocal,
    /// Through `1/sqrt(base)`, computed once.
    ReciprocalRoot,
}

impl Builder<'_> {
    /// Decides from the number of negative powers of each base how to divide by it.
    pub fn choose_inverses(&mut self, order: &[ExprId]) {
        let mut uses: BTreeMap<ExprId, (usize, bool)> = BTreeMap::new();
        for &id in order {
            let Node::Product(factors) = self.graph.node(id).clone() else {
                continue;
            };
            if self.is_known(id) {
                continue;
            }
            for (base, exponent) in factors.iter().filter(|(_, e)| e.is_negative()) {
                if self.is_known(*base) {
                    continue;
                }
                let halves = halves(exponent).unwrap_or(2);
                let entry = uses.entry(*base).or_insert((0, false));
                entry.0 += if halves.abs() > 2 { 2 } else { 1 };
                entry.1 |= halves % 2 != 0;
            }
        }
        for (base, (count, half)) in uses {
            let inverse = match (count, half) {
                (1, _) => Inverse::Direct,
                (_, false) => Inverse::Reciprocal,
                (_, true) => Inverse::ReciprocalRoot,
            };
            self.inverse.insert(base, inverse);
        }
    }

    /// Appends the atoms of `base^exponent`; returns whether a minus sign comes out.
    pub fn power(
        &mut self,
        base: ExprId,
        exponent: &Rational,
        above: &mut Vec<AtomId>,
        below: &mut Vec<AtomId>,
    ) -> bool {
        let (negative, atom) = self.converted[&base];
        let Some(halves) = halves(exponent) else {
            let atom = self.unsigned(base);
            let power = self.formula.intern(Atom::Power(atom, exponent.abs()));
            if exponent.is_negative() {
                below.push(power)
            } else {
                above.push(power)
            }
            return false;
        };
        let count = usize::try_from(halves.unsigned_abs() / 2).unwrap_or(0);
        let odd = halves % 2 != 0;
        let inverse = self.inverse.get(&base).copied().unwrap_or(Inverse::Direct);
        let one = self
            .formula
            .intern(Atom::Leaf(Value::Number(Rational::ONE)));
        if odd || (halves < 0 && inverse == Inverse::ReciprocalRoot) {
            let atom = self.unsigned(base);
            let root = self.formula.intern(Atom::Root(atom));
            if halves < 0 && inverse == Inverse::ReciprocalRoot {
                let reciprocal = self.formula.intern(Atom::Quotient(one, root));
                above.extend(std::iter::repeat_n(
                    reciprocal,
                    halves.unsigned_abs() as usize,
                ));
                return false;
            }
            let side = if halves < 0 { below } else { above };
            side.extend(std::iter::repeat_n(atom, count));
            side.push(root);
            return false;
        }
        let sign = negative && count % 2 == 1;
        if halves > 0 {
            above.extend(std::iter::repeat_n(atom, count));
        } else if inverse == Inverse::Reciprocal {
            let reciprocal = self.formula.intern(Atom::Quotient(one, atom));
            above.extend(std::iter::repeat_n(reciprocal, count));
        } else {
            below.extend(std::iter::repeat_n(atom, count));
        }
        sign
    }
}

/// Twice the exponent, where that is an integer of reasonable size.
fn halves(exponent: &Rational) -> Option<i64> {
    let doubled = (exponent * &Rational::from(2)).to_integer()?;
    (doubled.abs() <= 4096).then_some(doubled)
}
