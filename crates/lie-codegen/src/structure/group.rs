//! The group of the declared matrices, on which the motion beside that of mu goes.

use std::ops::Range;

use super::Structure;
use crate::model::configuration::{HELD_BLOCK, TIME_BLOCK};
use crate::model::{Bracket, Model};
use lie_symbolic::exact::Rational;
use lie_syntax::ast::Invariance;

/// Matrices of the algebra, and what is known of their group.
#[derive(Clone, Debug)]
pub struct Group {
    /// The size of the matrices.
    pub size: usize,
    /// The matrix of each basis element; of those that carry the time it is zero.
    pub matrices: Vec<Vec<Vec<Rational>>>,
    /// Whether Gauss methods in the entries stay in the group.
    pub closed: bool,
    /// Whether the system is right-invariant.
    pub right: bool,
}

impl Group {
    /// Whether the matrices are antisymmetric of size 3: the group is that of rotations.
    pub fn is_rotations(&self) -> bool {
        self.size == 3
            && self.matrices.iter().all(|matrix| {
                let pairs = (0..3).flat_map(|i| (0..=i).map(move |j| (i, j)));
                let mut sums = pairs.map(|(i, j)| &matrix[i][j] + &matrix[j][i]);
                sums.all(|sum| sum.is_zero())
            })
    }

    /// Whether the leading block of three rows and columns of every group element is a rotation, and not of all of them the
    /// identity: the blocks of the algebra are antisymmetric, and nothing of the other rows and columns comes into them.
    pub fn turns_space(&self) -> bool {
        let zero = |rows: Range<usize>, columns: Range<usize>| {
            self.matrices.iter().all(|matrix| {
                let mut rows = matrix[rows.clone()].iter();
                rows.all(|row| row[columns.clone()].iter().all(Rational::is_zero))
            })
        };
        let antisymmetric = |matrix: &Vec<Vec<Rational>>| {
            let mut pairs = (0..3).flat_map(|i| (0..=i).map(move |j| (i, j)));
            pairs.all(|(i, j)| (&matrix[i][j] + &matrix[j][i]).is_zero())
        };
        self.size >= 3
            && self.matrices.iter().all(antisymmetric)
            && !zero(0..3, 0..3)
            // the block of a product is the product of the blocks where one of the corners beside it is empty
            && (zero(3..self.size, 0..3) || zero(0..3, 3..self.size))
    }
}

/// The group of a system, if its algebra has matrices and the group element is no part of the state; none of a family.
pub fn group(model: &Model) -> Option<Group> {
    if model.family.is_some() {
        return None;
    }
    let Bracket::Lie(algebra) = &model.bracket else {
        return None;
    };
    let representation = algebra.representation.as_ref()?;
    let configuration = model.configuration.as_ref();
    if configuration.is_some_and(|c| c.group.is_some()) {
        return None;
    }
    // the blocks of the time and of what is held come last
    let behind = configuration.map_or(0, |c| TIME_BLOCK + HELD_BLOCK * c.held.len());
    let size = representation.dimension - behind;
    let block = |matrix: &Vec<Vec<Rational>>| {
        let rows = matrix.iter().take(size);
        rows.map(|row| row[..size].to_vec()).collect()
    };
    Some(Group {
        size,
        matrices: representation.matrices.iter().map(block).collect(),
        closed: representation.dual.is_some(),
        right: model.invariance == Invariance::Right,
    })
}

/// Why a chart of the group cannot be had, with a remedy.
pub fn refusal(structure: &Structure, quaternion: bool) -> Option<(String, String)> {
    let Some(group) = &structure.group else {
        return Some(match &structure.bracket {
            _ if structure.family.is_some() => (
                "the group elements of the sites of a family are not followed".into(),
                "leave the option out".into(),
            ),
            Bracket::Lie(algebra) if algebra.representation.is_none() => (
                "the algebra declares no `matrices`".into(),
                "declare the matrix of each basis element: the group element is a matrix of their size".into(),
            ),
            Bracket::Lie(_) => (
                "the group element is part of the state already".into(),
                "leave the option out: its entries are columns of the output".into(),
            ),
            _ => (
                "the bracket is not that of an algebra alone".into(),
                "leave the option out".into(),
            ),
        });
    };
    (quaternion && !group.is_rotations()).then(|| {
        (
            "quaternions are for matrices of rotations in three dimensions, antisymmetric of size 3".into(),
            "write `matrix`".into(),
        )
    })
}

#[cfg(test)]
mod tests {
    use crate::compile::compile_spec;

    #[test]
    fn which_groups_turn_space() {
        let turns = |name: &str| {
            let path = format!("{}/../../specs/{name}.json", env!("CARGO_MANIFEST_DIR"));
            let model = compile_spec(&std::fs::read_to_string(path).unwrap()).unwrap();
            model.group.unwrap().turns_space()
        };
        // the last has translations in a fourth column
        for name in ["so3_free_rigid_body", "se3_heavy_top"] {
            assert!(turns(name), "{name}");
        }
        let others = [
            // rotations of a plane, and shears, of size 3
            "e2_pendulum",
            "heisenberg_h3",
            // antisymmetric, but other rows come into the first three
            "so4_manakov",
            "su3_quadratic",
            "sl2_quadratic",
        ];
        for name in others {
            assert!(!turns(name), "{name}");
        }
    }
}
