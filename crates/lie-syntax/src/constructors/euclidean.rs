//! se(n), also called e(n): rotations, then translations `P_i`, in matrices of size n + 1.
//!
//! se(2) has `J, P1, P2` and se(3) `J1, J2, J3, P1, P2, P3`, rotations about the axes; above that the rotations are the
//! `J_ij` of so(n).

use super::family::{Constructor, Family, size};
use super::linear::translations;
use super::orthogonal::{triangle, turned};
use super::{Element, NamedAlgebra};

pub const FAMILY: Family = Family {
    names: &["se", "e"],
    form: "se(n)",
    arguments: (1, 1),
    read: |arguments| {
        let n = size(arguments, 0, 2, "`se(n)`")?;
        Ok(Box::new(Euclidean { n }))
    },
};

struct Euclidean {
    n: usize,
}

impl Constructor for Euclidean {
    fn dimension(&self) -> usize {
        triangle(self.n.saturating_add(1))
    }

    fn build(&self) -> NamedAlgebra {
        let elements = rotations(self.n).into_iter().chain(translations(self.n));
        NamedAlgebra::from_matrices(elements.collect(), self.n + 1)
    }
}

/// The rotations as they are called beside translations: `J` in the plane, `J1, J2, J3` in space.
pub fn rotations(n: usize) -> Vec<Element> {
    let mut elements = turned(n, ("J", "m"), |k| {
        (format!("J{}", k + 1), format!("m{}", k + 1))
    });
    if let [only] = elements.as_mut_slice() {
        (only.basis, only.state) = ("J".into(), "L".into());
    }
    elements
}
