//! Generated code runs with the runtime of another crate, which this one knows under no name of its own.

use re_export::lie_runtime::prelude::*;
use re_export::{RigidBody, top};

re_export::pendulum!(Pendulum);
re_export::pendulum!(Other, re_export::lie_runtime);

#[test]
fn systems_run_where_the_runtime_has_another_name() {
    let system = RigidBody::new().system().expect("finite constants");
    let problem = Problem::new(system, [1.0, 0.0, 0.5], (0.0, 1.0));
    let solution = solve(&problem, LieMidpoint::cayley(), &Options::new(0.1)).expect("a solution");
    let drift = solution.drift();
    assert!(drift.casimirs[0].max < 1e-13, "{drift:?}");
    let top = top::HeavyTop::new();
    let mut field = top.system().expect("finite constants").zero_state();
    top.system()
        .expect("finite constants")
        .vector_field(&top.initial_state(), &mut field);
    assert!(field.iter().any(|component| *component != 0.0));
}

#[test]
fn a_macro_declares_with_its_own_runtime() {
    let (system, other) = (Pendulum::new().system(), Other::new().system());
    let (system, other) = (
        system.expect("finite constants"),
        other.expect("finite constants"),
    );
    let state = [1.0, 2.0].into();
    let [mut field, mut same] = [system.zero_state(), other.zero_state()];
    system.vector_field(&state, &mut field);
    other.vector_field(&state, &mut same);
    assert_eq!(field, same);
    assert_eq!(field[0], 2.0);
}
