//! The group of the declared matrices, on which the motion beside that of mu goes.

use super::Structure;
use crate::algebra::rotating;
use crate::model::{Bracket, Model};
use lie_core::structure::Chart;
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
    /// Whether the leading block of three rows and columns of every group element is a rotation, and not of all of them the
    /// identity.
    pub fn turns_space(&self) -> bool {
        rotating::turn_space(self.size, &self.matrices)
    }
}

/// The group of a system, if its algebra has matrices and the group element is no part of the state; none of a family.
pub fn group(model: &Model) -> Option<Group> {
    if model.family.is_some() {
        return None;
    }
    let configuration = model.configuration.as_ref();
    if configuration.is_some_and(|c| c.group.is_some()) {
        return None;
    }
    let (size, matrices) = model.group_matrices()?;
    Some(Group {
        size,
        matrices,
        closed: model
            .bracket
            .algebra()?
            .group_representation()?
            .dual
            .is_some(),
        right: model.invariance == Invariance::Right,
    })
}

/// Why matrices with parameters have no group element beside the motion; none where it is part of the state.
fn followed(structure: &Structure) -> Option<(String, String)> {
    let configuration = structure.configuration.as_ref();
    let in_state = configuration.is_some_and(|c| c.group.is_some());
    let alone = structure.family.is_none() && !in_state;
    let refused = || structure.parametric_matrices("a group element beside the motion");
    alone.then(refused).flatten()
}

/// Why a chart of the group cannot be had, with a remedy.
pub fn refusal(structure: &Structure, chart: Chart) -> Option<(String, String)> {
    let Some(group) = &structure.group else {
        if let Some(refused) = followed(structure) {
            return Some(refused);
        }
        return Some(match &structure.bracket {
            _ if structure.family.is_some() => (
                "the group elements of the sites of a family are not followed".into(),
                "leave the option out".into(),
            ),
            _ if structure.is_almost_poisson() => (
                "steps on the bracket that a constraint leaves have no group element beside them".into(),
                "declare `group`, which makes the group element part of the state".into(),
            ),
            Bracket::Lie(algebra) if algebra.group_representation().is_none() => (
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
    let what = match chart {
        Chart::Matrix => return None,
        Chart::Quaternion => "quaternions",
        Chart::Euler(_) => "Euler angles",
    };
    let reason = format!(
        "{what} are for groups that turn space: rotations in three dimensions are the first rows and columns of their matrices"
    );
    (!group.turns_space()).then(|| (reason, "write `matrix`".into()))
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
