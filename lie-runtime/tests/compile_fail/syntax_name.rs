//! A coordinate that is no name.

use lie_runtime::prelude::*;

lie_poisson! {
    pub system Body;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state x, 2y, z;
    parameters { I1 = 2; I2 = 1; I3 = 2/3; }
    hamiltonian = x^2/(2*I1);
    methods = [lie-midpoint];
}

include!("uses/three.rs");
