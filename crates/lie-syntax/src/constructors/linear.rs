//! gl(n), sl(n) and aff(n).
//!
//! gl(n) has the basis `E_ij` in the order of rows. sl(n) has `H_k = e_kk - e_k+1,k+1`, then the `E_ij` above the
//! diagonal and those below; sl(2) has `h, e, f`. aff(n) has that of gl(n), then the translations `P_i`, the last column of
//! matrices of size n + 1.

use super::family::{Argument, Constructor, Family, Wrong, real, size};
use super::matrix::{integer_matrix, unit};
use super::names::{indexed, numbered};
use super::orthogonal::pairs;
use super::{Element, NamedAlgebra};

pub const SPECIAL: Family = Family {
    names: &["sl"],
    form: "sl(n)",
    arguments: (1, 2),
    read: |arguments| {
        let n = size(arguments, 0, 2, "`sl(n)`")?;
        real(arguments, "`sl(n)`")?;
        Ok(Box::new(Special { n }))
    },
};

pub const GENERAL: Family = Family {
    names: &["gl"],
    form: "gl(n)",
    arguments: (1, 1),
    read: |arguments| general(arguments, "`gl(n)`", false),
};

pub const AFFINE: Family = Family {
    names: &["aff"],
    form: "aff(n)",
    arguments: (1, 1),
    read: |arguments| general(arguments, "`aff(n)`", true),
};

struct Special {
    n: usize,
}

impl Constructor for Special {
    fn dimension(&self) -> usize {
        self.n.saturating_mul(self.n) - 1
    }

    fn build(&self) -> NamedAlgebra {
        let n = self.n;
        let h = |k| integer_matrix(&[(k, k, 1), (k + 1, k + 1, -1)]);
        if n == 2 {
            let matrices = [("h", h(0)), ("e", unit(0, 1)), ("f", unit(1, 0))];
            let elements = matrices.map(|(name, matrix)| Element::new(name, name, matrix));
            return NamedAlgebra::from_matrices(elements.into(), n);
        }
        let entry = |(i, j): (usize, usize)| {
            Element::new(
                indexed("E", &[i, j], n),
                indexed("m", &[i, j], n),
                unit(i, j),
            )
        };
        let diagonal =
            (0..n - 1).map(|k| Element::new(numbered("H", k, n), numbered("h", k, n), h(k)));
        let upper = pairs(n).map(entry);
        let lower = pairs(n).map(|(i, j)| entry((j, i)));
        NamedAlgebra::from_matrices(diagonal.chain(upper).chain(lower).collect(), n)
    }
}

struct General {
    n: usize,
    translations: bool,
}

fn general(
    arguments: &[Argument],
    what: &str,
    translations: bool,
) -> Result<Box<dyn Constructor>, Wrong> {
    let n = size(arguments, 0, 1, what)?;
    Ok(Box::new(General { n, translations }))
}

impl Constructor for General {
    fn dimension(&self) -> usize {
        let rows = self.n.saturating_add(usize::from(self.translations));
        self.n.saturating_mul(rows)
    }

    fn build(&self) -> NamedAlgebra {
        let n = self.n;
        let name = |stem: &str, i, j| match n {
            1 => stem.to_owned(),
            _ => indexed(stem, &[i, j], n),
        };
        let all = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
        let entry = |(i, j)| Element::new(name("E", i, j), name("m", i, j), unit(i, j));
        let mut elements: Vec<Element> = all.map(entry).collect();
        if self.translations {
            elements.extend(translations(n));
        }
        NamedAlgebra::from_matrices(elements, n + usize::from(self.translations))
    }
}

/// The translations of n dimensions in matrices of size n + 1.
pub fn translations(n: usize) -> impl Iterator<Item = Element> {
    (0..n).map(move |i| Element::new(numbered("P", i, n), numbered("p", i, n), unit(i, n)))
}
