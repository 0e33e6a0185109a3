//! Names that the language keeps for itself.

use lie_runtime::prelude::*;

lie_poisson! {
    pub system Body;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state x, y, t;
    parameters { I1 = 2; I2 = 1; sin = 2/3; }
    hamiltonian = x^2/(2*I1) + y^2/(2*I2);
    methods = [lie-midpoint];
}

include!("uses/three.rs");
