//! A declaration without an algebra.

use lie_runtime::prelude::*;

lie_poisson! {
    pub system Body;
    state x, y, z;
    parameters { I1 = 2; I2 = 1; I3 = 2/3; }
    hamiltonian = x^2/(2*I1) + y^2/(2*I2) + z^2/(2*I3);
    casimir C = x^2 + y^2 + z^2;
    methods = [lie-midpoint];
}

include!("uses/three.rs");
