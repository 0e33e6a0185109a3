//! Names that nobody declared, or that cannot stand here.

use lie_runtime::prelude::*;

lie_poisson! {
    pub system Body;
    algebra { basis e1, e2, e3; [e1, e2] = I1*e3; [e2, e3] = e4; [e3, e1] = z; }
    state x, y, z;
    parameters { I1 = 2; I2 = 1; I3 = 2/3; }
    let a = b; let b = x;
    hamiltonian = x^2/(2*I1) + Y^2/(2*I2) + e3;
    casimir C = x^2 + y^2 + z^2;
    methods = [lie-midpoint];
}

include!("uses/three.rs");
