//! heisenberg(n), oscillator(n), strictly upper triangular matrices, and R^n.
//!
//! - heisenberg(n): `[Q_i, P_i] = Z`, in the first row and the last column of matrices of size n + 2.
//! - oscillator(n), for n = 1 also called diamond: `[N, Q_i] = P_i`, `[N, P_i] = -Q_i`, `[Q_i, P_i] = Z`. The matrices of size
//!   2n + 2 turn the vector in the last column, and have half of its symplectic partner in the first row.
//! - upper(n): the `E_ij` with `i < j`.
//! - R^n: the `P_i` as translations.

use super::family::{Argument, Constructor, Family, Wrong, size};
use super::linear::translations;
use super::matrix::{Entries, integer_matrix, unit};
use super::names::{indexed, numbered};
use super::orthogonal::{pairs, triangle};
use super::{Element, NamedAlgebra};
use lie_symbolic::exact::Rational;

pub const HEISENBERG: Family = Family {
    names: &["heisenberg"],
    form: "heisenberg(n)",
    arguments: (1, 1),
    read: |arguments| {
        let n = size(arguments, 0, 1, "`heisenberg(n)`")?;
        Ok(Box::new(Heisenberg { n }))
    },
};

pub const OSCILLATOR: Family = Family {
    names: &["oscillator", "diamond"],
    form: "oscillator(n)` or `diamond",
    arguments: (0, 1),
    read: |arguments| {
        let n = match arguments {
            [] => 1,
            _ => size(arguments, 0, 1, "`oscillator(n)`")?,
        };
        Ok(Box::new(Oscillator { n }))
    },
};

pub const UPPER: Family = Family {
    names: &["upper", "strictly_upper"],
    form: "upper(n)",
    arguments: (1, 1),
    read: |arguments| {
        let n = size(
            arguments,
            0,
            2,
            "`upper(n)`, strictly upper triangular matrices of size n,",
        )?;
        Ok(Box::new(Upper { n }))
    },
};

pub const ABELIAN: Family = Family {
    names: &["R", "abelian"],
    form: "R^n",
    arguments: (0, 1),
    read: abelian,
};

struct Heisenberg {
    n: usize,
}

impl Constructor for Heisenberg {
    fn dimension(&self) -> usize {
        self.n.saturating_mul(2).saturating_add(1)
    }

    fn build(&self) -> NamedAlgebra {
        let (n, last) = (self.n, self.n + 1);
        let q =
            (0..n).map(|i| Element::new(numbered("Q", i, n), numbered("q", i, n), unit(0, i + 1)));
        let p = (0..n)
            .map(|i| Element::new(numbered("P", i, n), numbered("p", i, n), unit(i + 1, last)));
        let centre = Element::new("Z", "z", unit(0, last));
        NamedAlgebra::from_matrices(q.chain(p).chain([centre]).collect(), n + 2)
    }
}

struct Oscillator {
    n: usize,
}

impl Constructor for Oscillator {
    fn dimension(&self) -> usize {
        self.n.saturating_mul(2).saturating_add(2)
    }

    fn build(&self) -> NamedAlgebra {
        let (n, last) = (self.n, 2 * self.n + 1);
        let (q, p) = (|i| i + 1, |i| n + i + 1);
        let turns: Vec<_> = (0..n)
            .flat_map(|i| [(p(i), q(i), 1), (q(i), p(i), -1)])
            .collect();
        // the row is half of the vector's symplectic partner, so that [Q, P] = Z
        let vector = |at: usize, partner: usize, sign: i64| -> Entries {
            let half = Rational::new(sign, 2).unwrap_or(Rational::ZERO);
            [((at, last), Rational::ONE), ((0, partner), half)].into()
        };
        let mut elements = vec![Element::new("N", "n", integer_matrix(&turns))];
        elements.extend((0..n).map(|i| {
            Element::new(
                numbered("Q", i, n),
                numbered("q", i, n),
                vector(q(i), p(i), 1),
            )
        }));
        elements.extend((0..n).map(|i| {
            Element::new(
                numbered("P", i, n),
                numbered("p", i, n),
                vector(p(i), q(i), -1),
            )
        }));
        elements.push(Element::new("Z", "z", unit(0, last)));
        NamedAlgebra::from_matrices(elements, 2 * n + 2)
    }
}

struct Upper {
    n: usize,
}

impl Constructor for Upper {
    fn dimension(&self) -> usize {
        triangle(self.n)
    }

    fn build(&self) -> NamedAlgebra {
        let n = self.n;
        let element = |(i, j)| {
            Element::new(
                indexed("E", &[i, j], n),
                indexed("m", &[i, j], n),
                unit(i, j),
            )
        };
        NamedAlgebra::from_matrices(pairs(n).map(element).collect(), n)
    }
}

struct Abelian {
    n: usize,
}

fn abelian(arguments: &[Argument]) -> Result<Box<dyn Constructor>, Wrong> {
    let n = match arguments {
        [] => 1,
        _ => size(arguments, 0, 1, "`R^n`")?,
    };
    Ok(Box::new(Abelian { n }))
}

impl Constructor for Abelian {
    fn dimension(&self) -> usize {
        self.n
    }

    fn build(&self) -> NamedAlgebra {
        NamedAlgebra::from_matrices(translations(self.n).collect(), self.n + 1)
    }
}
