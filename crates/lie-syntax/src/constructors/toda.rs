//! toda(n), the solvable algebra of the open Toda lattice in Flaschka's variables: `[h_i, e_i] = e_i`,
//! `[h_i+1, e_i] = -e_i`, all other brackets zero.
//!
//! `h_1 + … + h_n` is central, so the algebra is aff(1)^(n-1) + R: blocks `[[w, e], [0, 0]]` with the weights
//! `w = h_i - h_i+1`, and the trace.

use super::family::{Constructor, Family, size};
use super::matrix::{integer_matrix, unit};
use super::{Element, NamedAlgebra};

pub const FAMILY: Family = Family {
    names: &["toda"],
    form: "toda(n)",
    arguments: (1, 1),
    read: |arguments| {
        let n = size(arguments, 0, 2, "`toda(n)`, n particles,")?;
        Ok(Box::new(Toda { n }))
    },
};

struct Toda {
    n: usize,
}

impl Constructor for Toda {
    fn dimension(&self) -> usize {
        self.n.saturating_mul(2) - 1
    }

    fn build(&self) -> NamedAlgebra {
        let (n, last) = (self.n, 2 * (self.n - 1));
        let mut elements = Vec::new();
        for i in 0..n {
            let mut entries = vec![(last, last, 1)];
            if i + 1 < n {
                entries.push((2 * i, 2 * i, 1));
            }
            if let Some(before) = i.checked_sub(1) {
                entries.push((2 * before, 2 * before, -1));
            }
            elements.push(Element::new(
                format!("h{}", i + 1),
                format!("b{}", i + 1),
                integer_matrix(&entries),
            ));
        }
        for i in 0..n - 1 {
            let matrix = unit(2 * i, 2 * i + 1);
            elements.push(Element::new(
                format!("e{}", i + 1),
                format!("a{}", i + 1),
                matrix,
            ));
        }
        NamedAlgebra::from_matrices(elements, last + 1)
    }
}
