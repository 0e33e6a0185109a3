//! Functions of Rust that are not there: the errors are those of rustc, at the paths.

use lie_runtime::prelude::*;

lie_poisson! {
    pub system Body;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state x, y, z;
    parameters { I1 = 2; I2 = 1; I3 = 2/3; }
    functions { well(r) = crate::well_of_depth; pull(u) = pull, derivatives (slope); }
    hamiltonian = x^2/(2*I1) + well(y) + pull(z);
    casimir C = x^2 + y^2 + z^2;
    methods = [lie-midpoint];
}

fn pull<S: Scalar>(u: S) -> S {
    u * u
}

include!("../uses/three.rs");
