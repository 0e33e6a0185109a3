//! so(n) and so(p, q): `X^T eta + eta X = 0` for the diagonal `eta` with p ones and q times minus one.
//!
//! The basis is `E_ij = e_ji - eta_i eta_j e_ij` for `i < j`: rotations from the axis i towards the axis j, boosts where
//! the signs differ. so(3) has `e1, e2, e3`, the rotations about the axes, with `[e1, e2] = e3`.

use super::family::{Argument, Constructor, Family, Wrong, size};
use super::matrix::{Entries, integer_matrix};
use super::names::indexed;
use super::{Element, NamedAlgebra};

pub const FAMILY: Family = Family {
    names: &["so"],
    form: "so(n)` or `so(p, q)",
    arguments: (1, 2),
    read,
};

struct Orthogonal {
    plus: usize,
    minus: usize,
}

fn read(arguments: &[Argument]) -> Result<Box<dyn Constructor>, Wrong> {
    if arguments.len() == 1 {
        let plus = size(arguments, 0, 2, "`so(n)`")?;
        return Ok(Box::new(Orthogonal { plus, minus: 0 }));
    }
    let plus = size(arguments, 0, 0, "`so(p, q)`")?;
    let minus = size(arguments, 1, 0, "`so(p, q)`")?;
    if plus.saturating_add(minus) < 2 {
        return Err(Wrong {
            argument: 1,
            message: "so(p, q) has no element for p + q < 2".into(),
            help: "write `so(p, q)` with p + q of at least 2".into(),
        });
    }
    Ok(Box::new(Orthogonal { plus, minus }))
}

impl Constructor for Orthogonal {
    fn dimension(&self) -> usize {
        triangle(self.plus.saturating_add(self.minus))
    }

    fn build(&self) -> NamedAlgebra {
        let n = self.plus + self.minus;
        if n == 3 && self.plus.min(self.minus) == 0 {
            return NamedAlgebra::from_matrices(rotations(3), 3);
        }
        let element = |(i, j)| {
            let same = (i < self.plus) == (j < self.plus);
            let matrix = integer_matrix(&[(j, i, 1), (i, j, if same { -1 } else { 1 })]);
            Element::new(indexed("E", &[i, j], n), indexed("m", &[i, j], n), matrix)
        };
        NamedAlgebra::from_matrices(pairs(n).map(element).collect(), n)
    }
}

/// `n (n - 1)/2`.
pub fn triangle(n: usize) -> usize {
    n.saturating_mul(n.saturating_sub(1)) / 2
}

/// All `i < j < n`.
pub fn pairs(n: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..n).flat_map(move |i| (i + 1..n).map(move |j| (i, j)))
}

/// The rotation from the axis i towards the axis j.
pub fn rotation(i: usize, j: usize) -> Entries {
    integer_matrix(&[(j, i, 1), (i, j, -1)])
}

/// The basis of so(n): in three dimensions the rotations about the axes.
fn rotations(n: usize) -> Vec<Element> {
    turned(n, ("E", "m"), |k| {
        (format!("e{}", k + 1), ["x", "y", "z"][k].to_owned())
    })
}

/// The rotations of n dimensions with their names: `axis` names those about the three axes, `plane` is the stem
/// of the others.
pub fn turned(
    n: usize,
    plane: (&str, &str),
    axis: impl Fn(usize) -> (String, String),
) -> Vec<Element> {
    if n == 3 {
        let about = |k: usize| {
            let (basis, state) = axis(k);
            Element::new(basis, state, rotation((k + 1) % 3, (k + 2) % 3))
        };
        return (0..3).map(about).collect();
    }
    let names = |(i, j)| {
        let (basis, state) = (indexed(plane.0, &[i, j], n), indexed(plane.1, &[i, j], n));
        Element::new(basis, state, rotation(i, j))
    };
    pairs(n).map(names).collect()
}
