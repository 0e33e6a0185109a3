//! A named algebra as it would have been written.

use super::NamedAlgebra;
use crate::ast::{Algebra, Bracket, Expr, ExprKind, Matrix, Name};
use crate::diagnostic::Origin;
use lie_symbolic::exact::Rational;

impl NamedAlgebra {
    /// The algebra with every name at one place.
    pub fn declared(&self, origin: Origin) -> Algebra {
        let basis: Vec<Name> = self.basis.iter().map(|text| name(text, origin)).collect();
        let bracket = |((i, j), terms): (&(usize, usize), &_)| Bracket {
            left: basis[*i].clone(),
            right: basis[*j].clone(),
            value: self.form(terms, origin),
            origin,
        };
        let brackets = self.constants.iter().map(bracket).collect();
        let matrices = self.representation.iter().flat_map(|representation| {
            let size = representation.size;
            let matrices = basis.iter().zip(&representation.entries);
            matrices.map(move |(name, entries)| {
                let entry = |r, c| entries.get(&(r, c)).cloned().unwrap_or(Rational::ZERO);
                let row = |r| (0..size).map(|c| number(entry(r, c), origin)).collect();
                Matrix {
                    name: name.clone(),
                    rows: (0..size).map(row).collect(),
                    origin,
                }
            })
        });
        Algebra {
            matrices: matrices.collect(),
            brackets: Some(brackets),
            basis: basis.clone(),
            origin,
        }
    }

    /// The names of the coordinates, at one place.
    pub fn coordinates(&self, origin: Origin) -> Vec<Name> {
        self.state.iter().map(|text| name(text, origin)).collect()
    }

    fn form(&self, terms: &std::collections::BTreeMap<usize, Rational>, origin: Origin) -> Expr {
        let term = |(k, value): (&usize, &Rational)| {
            let kind = ExprKind::Name {
                name: self.basis[*k].clone(),
                index: None,
            };
            let element = Expr { kind, origin };
            let factors = vec![(false, number(value.clone(), origin)), (false, element)];
            let kind = ExprKind::Product(factors);
            (false, Expr { kind, origin })
        };
        let kind = ExprKind::Sum(terms.iter().map(term).collect());
        Expr { kind, origin }
    }
}

fn name(text: &str, origin: Origin) -> Name {
    Name {
        text: text.to_owned(),
        origin,
    }
}

fn number(value: Rational, origin: Origin) -> Expr {
    let kind = ExprKind::Number(value);
    Expr { kind, origin }
}
