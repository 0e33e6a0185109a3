//! A dot that Unicode takes for a letter.

use lie_runtime::prelude::*;

lie_poisson! {
    pub system Body;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state ω, Π, z;
    parameters { I1 = 2; I2 = 1; I3 = 2/3; }
    hamiltonian = ω^2/(2*I1) + ω·Π;
    methods = [lie-midpoint];
}

include!("uses/three.rs");
