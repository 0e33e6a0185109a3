//! An exponent beyond every use.

use lie_runtime::prelude::*;

lie_poisson! {
    pub system Body;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state x, y, z;
    parameters { I1 = 2; I2 = 1; I3 = 2/3; }
    hamiltonian = x^2/(2*I1) + y^(10^9);
    casimir C = x^2 + y^2 + z^2;
    methods = [lie-midpoint];
}

include!("uses/three.rs");
