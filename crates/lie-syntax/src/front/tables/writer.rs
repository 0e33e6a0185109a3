//! A table at an argument, written out.

use super::spline::Piece;
use super::{Outside, Table};
use crate::ast::{Expr, ExprKind, Name};
use crate::diagnostic::Origin;
use crate::front::names::PIECEWISE;
use lie_symbolic::exact::Rational;

/// Writes a table at an argument.
pub(super) struct Writer {
    /// The argument.
    pub argument: Expr,
    /// Where the call stands.
    pub origin: Origin,
}

impl Writer {
    fn number(&self, value: &Rational) -> Expr {
        self.expression(ExprKind::Number(value.clone()))
    }

    fn expression(&self, kind: ExprKind) -> Expr {
        Expr {
            kind,
            origin: self.origin,
        }
    }

    fn sum(&self, a: Expr, b: Expr) -> Expr {
        self.expression(ExprKind::Sum(vec![(false, a), (false, b)]))
    }

    fn difference(&self, a: Expr, b: Expr) -> Expr {
        self.expression(ExprKind::Sum(vec![(false, a), (true, b)]))
    }

    fn product(&self, a: Expr, b: Expr) -> Expr {
        self.expression(ExprKind::Product(vec![(false, a), (false, b)]))
    }

    fn call(&self, function: &str, arguments: Vec<Expr>) -> Expr {
        let function = Name {
            text: function.to_owned(),
            origin: self.origin,
        };
        self.expression(ExprKind::Call {
            function: Box::new(function),
            arguments,
        })
    }

    /// One of numbers, by the piece in which the argument lies.
    fn choice(&self, pieces: &[Piece], of: &dyn Fn(&Piece) -> Rational) -> Expr {
        if let [only] = pieces {
            return self.number(&of(only));
        }
        let (left, right) = pieces.split_at(pieces.len() / 2);
        let knot = self.number(&right[0].center);
        let parts = vec![
            self.argument.clone(),
            knot,
            self.choice(left, of),
            self.choice(right, of),
        ];
        self.call(PIECEWISE, parts)
    }

    /// The spline, by Horner's rule.
    fn spline(&self, pieces: &[Piece]) -> Expr {
        let center = self.choice(pieces, &|piece| piece.center.clone());
        let distance = self.difference(self.argument.clone(), center);
        let degree = pieces[0].coefficients.len() - 1;
        let coefficient = |k: usize| self.choice(pieces, &|piece| piece.coefficients[k].clone());
        let orders = (0..degree).rev();
        orders.fold(coefficient(degree), |sum, k| {
            self.sum(coefficient(k), self.product(distance.clone(), sum))
        })
    }

    /// The table as choices of its coefficients.
    pub fn table(&self, table: &Table) -> Expr {
        let [first, last] = [0, table.pieces.len() - 1].map(|k| &table.pieces[k]);
        let [below, above] = [(0, first), (1, last)].map(|(end, piece)| {
            let place = &table.ends[end];
            let [value, slope] = piece.value_and_slope(place);
            let place = self.number(place);
            match table.outside {
                // not a number beyond the end, with all its derivatives
                Outside::Refuse if end == 0 => {
                    let inside = self.difference(self.argument.clone(), place);
                    self.call("sqrt", vec![inside])
                }
                Outside::Refuse => {
                    let inside = self.difference(place, self.argument.clone());
                    self.call("sqrt", vec![inside])
                }
                Outside::Constant => self.number(&value),
                Outside::Linear => {
                    let distance = self.difference(self.argument.clone(), place);
                    let rise = self.product(self.number(&slope), distance);
                    self.sum(self.number(&value), rise)
                }
            }
        });
        let [from, to] = [0, 1].map(|end| self.number(&table.ends[end]));
        let argument = || self.argument.clone();
        let inside = self.spline(&table.pieces);
        let inside = self.call(PIECEWISE, vec![to, argument(), above, inside]);
        self.call(PIECEWISE, vec![argument(), from, below, inside])
    }
}
