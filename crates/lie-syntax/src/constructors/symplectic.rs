//! sp(2n), of real matrices of size 2n with `X^T J + J X = 0`: `[[a, b], [c, -a^T]]` with symmetric b and c.
//!
//! The basis is `A_ij` in the order of rows, `B_ij` and `C_ij` for `i <= j`.

use super::family::{Argument, Constructor, Family, Wrong, real, size};
use super::matrix::{integer_matrix, unit};
use super::names::indexed;
use super::{Element, NamedAlgebra};

pub const FAMILY: Family = Family {
    names: &["sp"],
    form: "sp(2n)",
    arguments: (1, 2),
    read,
};

struct Symplectic {
    /// Half of the size of the matrices.
    n: usize,
}

fn read(arguments: &[Argument]) -> Result<Box<dyn Constructor>, Wrong> {
    let size = size(arguments, 0, 2, "`sp(2n)`, the size of its matrices,")?;
    real(arguments, "`sp(2n)`")?;
    if size % 2 == 1 {
        return Err(Wrong {
            argument: 0,
            message: format!("the size {size} is odd"),
            help: format!(
                "`sp(2n)` has matrices of even size: write sp({}) or sp({})",
                size - 1,
                size.saturating_add(1)
            ),
        });
    }
    Ok(Box::new(Symplectic { n: size / 2 }))
}

impl Constructor for Symplectic {
    fn dimension(&self) -> usize {
        self.n
            .saturating_mul(self.n.saturating_mul(2).saturating_add(1))
    }

    fn build(&self) -> NamedAlgebra {
        let n = self.n;
        let element = |basis: &str, state: &str, (i, j): (usize, usize), matrix| {
            Element::new(
                indexed(basis, &[i, j], n),
                indexed(state, &[i, j], n),
                matrix,
            )
        };
        let mut elements = Vec::new();
        for i in 0..n {
            for j in 0..n {
                let matrix = integer_matrix(&[(i, j, 1), (n + j, n + i, -1)]);
                elements.push(element("A", "a", (i, j), matrix));
            }
        }
        for (basis, state, row, column) in [("B", "b", 0, n), ("C", "c", n, 0)] {
            for i in 0..n {
                elements.push(element(basis, state, (i, i), unit(row + i, column + i)));
                for j in i + 1..n {
                    let matrix =
                        integer_matrix(&[(row + i, column + j, 1), (row + j, column + i, 1)]);
                    elements.push(element(basis, state, (i, j), matrix));
                }
            }
        }
        NamedAlgebra::from_matrices(elements, 2 * n)
    }
}
