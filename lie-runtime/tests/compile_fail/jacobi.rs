//! A coefficient with which the Jacobi identity fails.

use lie_runtime::prelude::*;

lie_poisson! {
    pub system Body;
    algebra {
        basis a, b, c, d;
        [a, b] = a + b; [a, c] = d; [b, d] = c;
    }
    state x, y, z, w;
    parameters { I1 = 2; I2 = 1; I3 = 2/3; }
    hamiltonian = x^2/(2*I1) + y^2/(2*I2) + z^2/(2*I3);
    methods = [lie-midpoint];
}

include!("uses/four.rs");
