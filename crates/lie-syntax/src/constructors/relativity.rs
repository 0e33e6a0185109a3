//! galilei(n) and poincare(n), of n dimensions of space and one of time: rotations, boosts `K_i`, translations `P_i`, and `H`
//! of the time.
//!
//! They act on `(x, t, 1)`: `[K_i, H] = P_i` in both, `[K_i, P_i] = H` and `[K_i, K_j]` a rotation in poincare(n) alone.

use super::euclidean::rotations;
use super::family::{Constructor, Family, size};
use super::matrix::{integer_matrix, unit};
use super::names::numbered;
use super::orthogonal::triangle;
use super::{Element, NamedAlgebra};

pub const GALILEI: Family = Family {
    names: &["galilei"],
    form: "galilei(n)",
    arguments: (1, 1),
    read: |arguments| {
        let n = size(arguments, 0, 1, "`galilei(n)`, n dimensions of space,")?;
        let limit = true;
        Ok(Box::new(SpaceTime { n, limit }))
    },
};

pub const POINCARE: Family = Family {
    names: &["poincare"],
    form: "poincare(n)",
    arguments: (1, 1),
    read: |arguments| {
        let n = size(arguments, 0, 1, "`poincare(n)`, n dimensions of space,")?;
        let limit = false;
        Ok(Box::new(SpaceTime { n, limit }))
    },
};

struct SpaceTime {
    /// Dimensions of space.
    n: usize,
    /// Whether light is infinitely fast.
    limit: bool,
}

impl Constructor for SpaceTime {
    fn dimension(&self) -> usize {
        triangle(self.n.saturating_add(2))
    }

    fn build(&self) -> NamedAlgebra {
        let (n, time, last) = (self.n, self.n, self.n + 1);
        let boost = |i| match self.limit {
            true => unit(i, time),
            false => integer_matrix(&[(i, time, 1), (time, i, 1)]),
        };
        let mut elements = rotations(n);
        for i in 0..n {
            elements.push(Element::new(
                numbered("K", i, n),
                numbered("k", i, n),
                boost(i),
            ));
        }
        for i in 0..n {
            let matrix = unit(i, last);
            elements.push(Element::new(
                numbered("P", i, n),
                numbered("p", i, n),
                matrix,
            ));
        }
        elements.push(Element::new("H", "E", unit(time, last)));
        NamedAlgebra::from_matrices(elements, n + 2)
    }
}
