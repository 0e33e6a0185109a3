//! The initial group element.

use super::Expr;
use crate::diagnostic::Origin;
use lie_core::structure::EulerSequence;

/// The group element at the start, expressions in constants and parameters.
#[derive(Clone, Debug)]
pub struct Attitude {
    /// Its entries.
    pub form: AttitudeForm,
    /// Where it stands.
    pub origin: Origin,
}

/// How a group element is written.
#[derive(Clone, Debug)]
pub enum AttitudeForm {
    /// A quaternion, the real part first.
    Quaternion([Expr; 4]),
    /// A matrix by rows.
    Matrix(Vec<Vec<Expr>>),
    /// Euler angles.
    Euler(EulerSequence, [Expr; 3]),
}

impl Attitude {
    /// Every expression in it, in its order.
    pub fn entries(&self) -> Vec<&Expr> {
        match &self.form {
            AttitudeForm::Quaternion(entries) => entries.iter().collect(),
            AttitudeForm::Matrix(rows) => rows.iter().flatten().collect(),
            AttitudeForm::Euler(_, angles) => angles.iter().collect(),
        }
    }
}
