//! Discrete Lagrangians in the entries of the group element.
//!
//! The entries are abbreviations in Cayley coordinates x: with the matrix X of x in the declared representation,
//! `g = (1 - X/2)^-1 (1 + X/2) = 2 (1 - X/2)^-1 - 1`, a rational function by the adjugate matrix.

use super::configuration;
use lie_symbolic::exact::Rational;
use lie_syntax::ast::{Declaration, Expr, ExprKind, Invariance, Name};
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin};

/// The largest matrix whose inverse is written out.
const MAX_SIZE: usize = 4;

/// The declaration with the entries of the group element as abbreviations.
///
/// # Errors
/// A group element without matrices, of many rows or of a right-invariant system, and names that its entries take,
/// are reported.
pub fn written_out(
    declaration: &Declaration,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<Declaration> {
    let origin = declaration.group.as_ref()?.origin;
    let configuration = configuration::configuration(declaration, mistakes)?;
    let size = configuration.group.as_ref()?.1;
    let mut fails = |message: String, help: &str| {
        mistakes.push(Diagnostic::new(Kind::Limit, origin, message).help(help));
    };
    if size > MAX_SIZE {
        fails(
            format!("a discrete Lagrangian in the entries of a {size} x {size} matrix"),
            "the inverse in its Cayley map is written out up to 4 rows; give it in coordinates of a retraction",
        );
        return None;
    }
    if declaration.invariance == Invariance::Right {
        fails(
            "a right-invariant discrete Lagrangian in the entries of the group element".into(),
            "give it in coordinates of a retraction, or the left-invariant one of the inverse",
        );
        return None;
    }
    let entries = configuration.entries();
    mistakes.extend(configuration::clashes(declaration, &entries, origin));
    let values = Build { origin }.cayley(declaration, size);
    let lets = entries.into_iter().zip(values).map(|(text, value)| {
        let name = Name { text, origin };
        (name, value)
    });
    let mut whole = declaration.clone();
    whole.lets = lets.chain(whole.lets).collect();
    Some(whole)
}

/// Expressions at one place.
struct Build {
    origin: Origin,
}

impl Build {
    fn expr(&self, kind: ExprKind) -> Expr {
        Expr {
            kind,
            origin: self.origin,
        }
    }

    fn number(&self, value: i64) -> Expr {
        self.expr(ExprKind::Number(Rational::from(value)))
    }

    /// The entries of g, row by row. What is wrong with the matrices or the velocity is reported elsewhere.
    fn cayley(&self, declaration: &Declaration, size: usize) -> Vec<Expr> {
        let basis = declaration.basis();
        let all_matrices = declaration.algebra().map_or(&[][..], |a| &a.matrices[..]);
        let half = |row: usize, column: usize| -> Expr {
            let mut terms = vec![(false, self.number(i64::from(row == column)))];
            for (element, x) in basis.iter().zip(declaration.energy.velocity()) {
                let matrix = all_matrices.iter().find(|m| m.name.text == element.text);
                let entry = matrix.and_then(|m| m.rows.get(row)?.get(column));
                if let Some(entry) = entry {
                    let x = self.expr(ExprKind::Name {
                        name: x.text.clone(),
                        index: None,
                    });
                    let factors = vec![(false, entry.clone()), (false, x), (true, self.number(2))];
                    terms.push((true, self.expr(ExprKind::Product(factors))));
                }
            }
            self.expr(ExprKind::Sum(terms))
        };
        let matrix: Vec<Vec<Expr>> = (0..size)
            .map(|row| (0..size).map(|column| half(row, column)).collect())
            .collect();
        let all: Vec<usize> = (0..size).collect();
        let determinant = self.minor(&matrix, &all, &all);
        let without = |left_out: usize| -> Vec<usize> {
            all.iter().copied().filter(|&k| k != left_out).collect()
        };
        let mut entries = Vec::new();
        for row in 0..size {
            for column in 0..size {
                let cofactor = self.minor(&matrix, &without(column), &without(row));
                let factors = vec![
                    (false, self.number(2)),
                    (false, cofactor),
                    (true, determinant.clone()),
                ];
                let quotient = self.expr(ExprKind::Product(factors));
                let terms = vec![
                    ((row + column) % 2 == 1, quotient),
                    (true, self.number(i64::from(row == column))),
                ];
                entries.push(self.expr(ExprKind::Sum(terms)));
            }
        }
        entries
    }

    /// The determinant of some rows and columns, expanded along the first row.
    fn minor(&self, matrix: &[Vec<Expr>], rows: &[usize], columns: &[usize]) -> Expr {
        let Some((&first, rest)) = rows.split_first() else {
            return self.number(1);
        };
        let terms = columns.iter().enumerate().map(|(place, &column)| {
            let others: Vec<usize> = columns.iter().copied().filter(|&c| c != column).collect();
            let factors = vec![
                (false, matrix[first][column].clone()),
                (false, self.minor(matrix, rest, &others)),
            ];
            (place % 2 == 1, self.expr(ExprKind::Product(factors)))
        });
        self.expr(ExprKind::Sum(terms.collect()))
    }
}
