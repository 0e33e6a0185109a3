//! Whether steps of h and -h undo each other.

use crate::systems;

use lie_runtime::diagnostics::symmetry_defect;
use lie_runtime::methods::{LieMidpoint, Rk4};
use lie_runtime::newton::NewtonOptions;
use systems::rigid_body::RigidBody;

#[test]
fn symmetric_or_not() {
    let body = RigidBody::<f64>::default();
    let mu = [0.9, 0.3, 0.4].into();
    let newton = NewtonOptions::default();
    let defect = symmetry_defect(&body, &LieMidpoint::exp(), 0.2, &mu, &newton);
    assert!(defect.expect("a step") < 1e-15);
    let defect = symmetry_defect(&body, &Rk4, 0.2, &mu, &newton);
    assert!(defect.expect("a step") > 1e-9);
}
