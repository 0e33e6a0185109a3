//! The group of the declared matrices, on which the motion beside that of mu goes.

use crate::ast::Invariance;
use crate::exact::Rational;
use crate::model::{Bracket, Model};

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
    // beside the time the blocks of its algebra come last
    let size = representation.dimension - if configuration.is_some() { 3 } else { 0 };
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
pub fn refusal(model: &Model, quaternion: bool) -> Option<(String, String)> {
    let Some(group) = group(model) else {
        return Some(match &model.bracket {
            _ if model.family.is_some() => (
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
