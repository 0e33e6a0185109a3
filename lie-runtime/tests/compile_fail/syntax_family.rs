//! A family of systems, whose algebra has no name, and which starts at a list.

use lie_runtime::prelude::*;

lie_poisson! {
    pub system Body;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state x[i], y[i], z[i];
    parameters { I1 = 2; I2 = 1; I3 = 2/3; }
    hamiltonian = sum(i in 0..3: x[i]^2);
    methods = [lie-midpoint];
    initial = [1, 0, 0];
}

include!("uses/three.rs");
