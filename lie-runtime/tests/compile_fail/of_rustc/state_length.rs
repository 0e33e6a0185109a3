//! An initial state of the wrong length.

use lie_runtime::prelude::*;

lie_poisson! {
    pub system Body;
    algebra = so(3);
    state x, y, z;
    hamiltonian = x^2/2 + y^2/3 + z^2/4;
    methods = [rk4];
}

fn main() {
    let system = Body::new().system().expect("no parameters");
    let _ = Problem::new(system, [1.0, 0.0], (0.0, 1.0));
}
