//! Brackets and matrices of the larger algebra.

use crate::model::configuration::{
    Configuration, HELD_BLOCK, TIME, TIME_BLOCK, TIME_MOMENTUM, UNIT, entry,
};
use lie_symbolic::exact::Rational;
use lie_syntax::ast::{Algebra, Bracket, Expr, ExprKind, Invariance, Matrix, Name};
use lie_syntax::diagnostic::Origin;

/// What the additions are made from.
pub(super) struct Builder<'a> {
    pub(super) algebra: &'a Algebra,
    pub(super) invariance: Invariance,
    pub(super) configuration: &'a Configuration,
    pub(super) origin: Origin,
}

impl Builder<'_> {
    fn expr(&self, kind: ExprKind) -> Expr {
        Expr {
            kind,
            origin: self.origin,
        }
    }

    fn number(&self, value: Rational) -> Expr {
        self.expr(ExprKind::Number(value))
    }

    fn name(&self, text: String) -> Name {
        Name {
            text,
            origin: self.origin,
        }
    }

    fn basis(&self, text: String) -> Expr {
        self.expr(ExprKind::Name {
            name: text,
            index: None,
        })
    }

    /// `[e_i, E_ab] = sum_c rho(e_i)_cb E_ac`. For a right-invariant system, whose constants change their
    /// sign later, `g' = rho(xi) g`: `[e_i, E_ab] = -sum_c rho(e_i)_ac E_cb`.
    pub(super) fn add_brackets(&self, brackets: &mut Vec<Bracket>) {
        let mut add = |left: &Name, right: String, terms: Vec<(bool, Expr)>| {
            if !terms.is_empty() {
                brackets.push(Bracket {
                    left: left.clone(),
                    right: self.name(right),
                    value: self.expr(ExprKind::Sum(terms)),
                    origin: self.origin,
                });
            }
        };
        if let Some((group, size)) = &self.configuration.group {
            let entry = |row, column| entry(group, *size, row, column);
            for matrix in &self.algebra.matrices {
                for (a, b) in (0..*size).flat_map(|a| (0..*size).map(move |b| (a, b))) {
                    let left = self.invariance == Invariance::Left;
                    let terms = (0..*size).filter_map(|c| {
                        let (row, column) = if left { (c, b) } else { (a, c) };
                        let value = matrix.rows.get(row)?.get(column)?;
                        if matches!(&value.kind, ExprKind::Number(zero) if zero.is_zero()) {
                            return None;
                        }
                        let target = if left {
                            entry(a + 1, c + 1)
                        } else {
                            entry(c + 1, b + 1)
                        };
                        let factors = vec![(false, value.clone()), (false, self.basis(target))];
                        Some((!left, self.expr(ExprKind::Product(factors))))
                    });
                    add(&matrix.name, entry(a + 1, b + 1), terms.collect());
                }
            }
        }
        if self.configuration.time {
            let unit = (
                self.invariance == Invariance::Right,
                self.basis(UNIT.into()),
            );
            add(&self.name(TIME_MOMENTUM.into()), TIME.into(), vec![unit]);
        }
    }

    /// The matrices of the larger algebra: blocks `(-rho^T, 0; A, 0)` of the semidirect product, those of
    /// the opposite order for a right-invariant system, and the Heisenberg algebra beside them.
    pub(super) fn matrices(&self) -> Vec<Matrix> {
        let declared = &self.algebra.matrices;
        let size = declared.first().map_or(0, |m| m.rows.len());
        let blocks = match self.configuration.group {
            Some(_) => 2 * size,
            None => size,
        };
        let held = self.configuration.held.len();
        let time = TIME_BLOCK * usize::from(self.configuration.time);
        let whole = blocks + time + HELD_BLOCK * held;
        let left = self.invariance == Invariance::Left;
        let mut matrices: Vec<Matrix> = declared
            .iter()
            .map(|matrix| Matrix {
                rows: self.enlarged(&matrix.rows, size, whole),
                ..matrix.clone()
            })
            .collect();
        let mut unit = |name: String, row: usize, column: usize| {
            let mut rows = self.zero(whole);
            rows[row][column] = self.number(Rational::ONE);
            matrices.push(Matrix {
                name: self.name(name),
                rows,
                origin: self.origin,
            });
        };
        if let Some((group, _)) = &self.configuration.group {
            for (a, b) in (0..size).flat_map(|a| (0..size).map(move |b| (a, b))) {
                let (row, column) = if left { (size + a, b) } else { (a, size + b) };
                unit(entry(group, size, a + 1, b + 1), row, column);
            }
        }
        if self.configuration.time {
            let [first, second] = if left { [0, 1] } else { [1, 0] };
            unit(TIME_MOMENTUM.into(), blocks + first, blocks + first + 1);
            unit(TIME.into(), blocks + second, blocks + second + 1);
            unit(UNIT.into(), blocks, blocks + 2);
        }
        for (k, (name, _)) in self.configuration.held.iter().enumerate() {
            let place = blocks + time + HELD_BLOCK * k;
            unit(name.clone(), place, place + 1);
        }
        matrices
    }

    fn zero(&self, size: usize) -> Vec<Vec<Expr>> {
        vec![vec![self.number(Rational::ZERO); size]; size]
    }

    /// The matrix of a declared element: its block, beside a group element `-rho^T`. One of another shape than the
    /// first is reported as it was written.
    fn enlarged(&self, declared: &[Vec<Expr>], size: usize, whole: usize) -> Vec<Vec<Expr>> {
        if declared.len() != size || declared.iter().any(|row| row.len() != size) {
            return declared.to_vec();
        }
        let mut rows = self.zero(whole);
        for (i, row) in declared.iter().enumerate() {
            for (j, value) in row.iter().enumerate() {
                if self.configuration.group.is_some() {
                    rows[j][i] = Expr {
                        kind: ExprKind::Negative(Box::new(value.clone())),
                        origin: value.origin,
                    };
                } else {
                    rows[i][j] = value.clone();
                }
            }
        }
        rows
    }
}
