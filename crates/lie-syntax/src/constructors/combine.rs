//! Direct sums, semidirect products with representations, tangent algebras.

use std::collections::BTreeMap;

use super::matrix::moved;
use super::names::{numbered, tell_apart};
use super::{Constants, Entries, Matrices, NamedAlgebra};
use lie_symbolic::exact::Rational;

/// The direct sum, its matrices in blocks. Parts whose names are not different are numbered.
pub fn direct_sum(mut parts: Vec<NamedAlgebra>) -> NamedAlgebra {
    if parts.len() == 1 {
        return parts.swap_remove(0);
    }
    tell_apart(&mut parts);
    let mut sum = NamedAlgebra {
        basis: Vec::new(),
        state: Vec::new(),
        constants: Constants::new(),
        representation: None,
    };
    let size: Option<usize> = parts
        .iter()
        .map(|part| Some(part.representation.as_ref()?.size))
        .sum();
    let (mut matrices, mut corner) = (Vec::new(), 0);
    for part in parts {
        let first = sum.basis.len();
        for ((i, j), terms) in part.constants {
            sum.constants
                .insert((i + first, j + first), shifted(&terms, first));
        }
        sum.basis.extend(part.basis);
        sum.state.extend(part.state);
        if let Some(representation) = part.representation.filter(|_| size.is_some()) {
            let blocks = representation.entries.iter();
            matrices.extend(blocks.map(|block| moved(block, corner, corner)));
            corner += representation.size;
        }
    }
    sum.representation = size.and_then(|size| Matrices::moderate(size, matrices));
    sum
}

fn shifted(terms: &BTreeMap<usize, Rational>, by: usize) -> BTreeMap<usize, Rational> {
    terms
        .iter()
        .map(|(k, value)| (k + by, value.clone()))
        .collect()
}

/// A vector space with an action: its names, and the matrix of each basis element of the algebra.
#[derive(Clone, Debug)]
pub struct Acted {
    /// Names of its basis.
    pub basis: Vec<String>,
    /// Names of the coordinates.
    pub state: Vec<String>,
    /// How the algebra acts.
    pub action: Matrices,
}

impl Acted {
    /// The space with the names of R^n.
    pub fn new(action: Matrices) -> Self {
        let n = action.size;
        Self {
            basis: (0..n).map(|i| numbered("P", i, n)).collect(),
            state: (0..n).map(|i| numbered("p", i, n)).collect(),
            action,
        }
    }
}

/// The semidirect product: `[e_i, v] = rho_i v`, the vectors commute.
pub fn semidirect(algebra: NamedAlgebra, spaces: Vec<Acted>) -> NamedAlgebra {
    let representation = with_translations(&algebra, &spaces);
    let vectors = |space: &Acted| NamedAlgebra {
        basis: space.basis.clone(),
        state: space.state.clone(),
        constants: Constants::new(),
        representation: None,
    };
    let mut constants = algebra.constants.clone();
    let mut first = algebra.dimension();
    for space in &spaces {
        for (i, matrix) in space.action.entries.iter().enumerate() {
            for ((row, column), value) in matrix {
                let terms = constants.entry((i, first + column)).or_default();
                terms.insert(first + row, value.clone());
            }
        }
        first += space.action.size;
    }
    let parts = [algebra].into_iter().chain(spaces.iter().map(vectors));
    let mut product = direct_sum(parts.collect());
    product.constants = constants;
    product.representation = representation;
    product
}

/// Matrices `[[rho, v1, v2, …], [0, 0]]` for the spaces with one action, in blocks for different actions; the
/// algebra's own ones are among them, so that they are faithful.
fn with_translations(algebra: &NamedAlgebra, spaces: &[Acted]) -> Option<Matrices> {
    let own = algebra.representation.as_ref()?;
    let mut actions = vec![own];
    for space in spaces {
        if !actions.contains(&&space.action) {
            actions.push(&space.action);
        }
    }
    let n = algebra.dimension();
    let dimension = n + spaces.iter().map(|space| space.action.size).sum::<usize>();
    let mut entries = vec![Entries::new(); dimension];
    let mut corner = 0;
    for action in actions {
        for (i, matrix) in action.entries.iter().enumerate() {
            entries[i].extend(moved(matrix, corner, corner));
        }
        let mut column = corner + action.size;
        let mut first = n;
        for space in spaces {
            if space.action == *action {
                for k in 0..action.size {
                    entries[first + k].insert((corner + k, column), Rational::ONE);
                }
                column += 1;
            }
            first += space.action.size;
        }
        corner = column;
    }
    Matrices::moderate(corner, entries)
}

/// The tangent algebra: to each e a `de`, with `[e_i, de_j] = d[e_i, e_j]` and `[de_i, de_j] = 0`, in matrices
/// `[[rho, d rho], [0, rho]]`.
pub fn tangent(algebra: NamedAlgebra) -> NamedAlgebra {
    let n = algebra.dimension();
    let mut constants = algebra.constants.clone();
    for i in 0..n {
        for j in 0..n {
            let terms = algebra.bracket(i, j);
            if !terms.is_empty() {
                constants.insert((i, j + n), shifted(&terms, n));
            }
        }
    }
    let representation = algebra.representation.as_ref().and_then(|matrices| {
        let size = matrices.size;
        let twice = matrices.entries.iter().map(|matrix| {
            let mut both = matrix.clone();
            both.extend(moved(matrix, size, size));
            both
        });
        let corner = matrices.entries.iter().map(|matrix| moved(matrix, 0, size));
        Matrices::moderate(2 * size, twice.chain(corner).collect())
    });
    let with_copies = |names: Vec<String>| {
        let copies: Vec<String> = names.iter().map(|name| format!("d{name}")).collect();
        names.into_iter().chain(copies).collect()
    };
    NamedAlgebra {
        basis: with_copies(algebra.basis),
        state: with_copies(algebra.state),
        constants,
        representation,
    }
}
