//! A group element in its chart.

use super::group_matrix::GroupMatrix;
use crate::generic::quaternion_product as product;
use crate::scalar::Scalar;
use crate::structure::rotation::{quaternion, unit};
use crate::structure::{Chart, Group};
use core::array;

/// A group element, as far as its chart needs it.
#[derive(Clone, Debug)]
pub(super) struct Element<S> {
    chart: Chart,
    orthogonal: bool,
    matrix: GroupMatrix<S>,
    quaternion: [S; 4],
    angles: [S; 3],
}

impl<S: Scalar> Element<S> {
    pub(super) fn identity(group: &Group<'_>, chart: Chart) -> Self {
        let mut quaternion = [S::zero(); 4];
        quaternion[0] = S::one();
        Self {
            chart,
            orthogonal: group.orthogonal,
            matrix: GroupMatrix::identity(group.size),
            quaternion,
            angles: [S::zero(); 3],
        }
    }

    /// Goes to the element with these entries in the chart.
    pub(super) fn set(&mut self, entries: &[S]) -> Option<()> {
        match self.chart {
            Chart::Matrix => return self.set_matrix(entries),
            Chart::Quaternion => self.quaternion = unit(entries.try_into().ok()?),
            Chart::Euler(sequence) => {
                self.angles = entries.try_into().ok()?;
                self.quaternion = sequence.quaternion(self.angles);
            }
        }
        Some(())
    }

    /// Goes to the element with this matrix, by rows.
    pub(super) fn set_matrix(&mut self, rows: &[S]) -> Option<()> {
        let entries = self.matrix.entries_mut();
        if entries.len() != rows.len() {
            return None;
        }
        entries.copy_from_slice(rows);
        if self.orthogonal {
            self.matrix.orthogonalize();
            self.matrix.orthogonalize();
        }
        if self.chart != Chart::Matrix {
            self.quaternion = quaternion_of(&self.matrix);
        }
        if let Chart::Euler(sequence) = self.chart {
            self.angles = sequence.angles(self.quaternion);
        }
        Some(())
    }

    /// Goes where another one was, bit by bit.
    pub(super) fn recall(&mut self, memory: &[S]) -> Option<()> {
        let of_rotation = self.quaternion.iter_mut();
        let entries: Vec<&mut S> = match self.chart {
            Chart::Matrix => self.matrix.entries_mut().iter_mut().collect(),
            Chart::Quaternion => of_rotation.collect(),
            Chart::Euler(_) => of_rotation.chain(&mut self.angles).collect(),
        };
        if entries.len() != memory.len() {
            return None;
        }
        for (entry, value) in entries.into_iter().zip(memory) {
            *entry = *value;
        }
        Some(())
    }

    pub(super) fn memory(&self) -> Vec<S> {
        let before: &[S] = match self.chart {
            Chart::Euler(_) => &self.quaternion,
            Chart::Matrix | Chart::Quaternion => &[],
        };
        [before, self.entries()].concat()
    }

    /// The entries in the chart.
    pub(super) fn entries(&self) -> &[S] {
        match self.chart {
            Chart::Matrix => self.matrix.entries(),
            Chart::Quaternion => &self.quaternion,
            Chart::Euler(_) => &self.angles,
        }
    }

    /// `g F` in place of g, or `F^-1 g` of a right-invariant system.
    pub(super) fn advance(&mut self, group: &Group<'_>, factor: &GroupMatrix<S>) {
        if self.chart == Chart::Matrix {
            self.matrix = if group.right {
                factor.inverse().times(&self.matrix)
            } else {
                self.matrix.times(factor)
            };
            if group.orthogonal {
                // else the round-off of a steady rotation would add up
                self.matrix.orthogonalize();
            }
            return;
        }
        self.quaternion = moved(group, self.quaternion, factor);
        if let Chart::Euler(sequence) = self.chart {
            self.angles = sequence.angles_near(self.quaternion, self.angles);
        }
    }

    /// Whether angles are followed.
    pub(super) fn has_angles(&self) -> bool {
        matches!(self.chart, Chart::Euler(_))
    }

    /// Takes the angles along a way of small parts, at whose end an [`Element::advance`] will come; the element stays.
    pub(super) fn follow(&mut self, group: &Group<'_>, parts: &[GroupMatrix<S>]) {
        let Chart::Euler(sequence) = self.chart else {
            return;
        };
        let mut quaternion = self.quaternion;
        for part in parts {
            quaternion = moved(group, quaternion, part);
            self.angles = sequence.angles_near(quaternion, self.angles);
        }
    }
}

/// The rotation of `g F`, of a right-invariant system that of `F^-1 g`.
fn moved<S: Scalar>(group: &Group<'_>, quaternion: [S; 4], factor: &GroupMatrix<S>) -> [S; 4] {
    let [real, x, y, z] = quaternion_of(factor);
    unit(if group.right {
        product([real, -x, -y, -z], quaternion)
    } else {
        product(quaternion, [real, x, y, z])
    })
}

/// The unit quaternion of a rotation.
fn quaternion_of<S: Scalar>(rotation: &GroupMatrix<S>) -> [S; 4] {
    let row = |row| array::from_fn(|column| rotation.at(row, column));
    quaternion(&array::from_fn(row))
}
