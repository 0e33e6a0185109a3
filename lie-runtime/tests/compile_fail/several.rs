//! Mistakes of one stage are reported together, each at its token.

use lie_runtime::prelude::*;

lie_poisson! {
    /// Doc comments are part of the declaration.
    pub(crate) system Body;
    algebra {
        basis e1, e2, e3;
        [e1, e2] = e3;
        [e2, e3] = q*e1;
        [e3, e3] = e2;
    }
    state x, y, energy;
    parameters {
        /// A moment of inertia.
        I1 = 2;
        I2 = 1;
        I1 = 3;
    }
    hamiltonian = x^2/(2*I1)
        + y^2/(2*I4)
        + sqrt(-1)
        + x/(2 - 1 - 1);
    casimir fn = x^2;
}

include!("uses/three.rs");
