//! A function of Rust with an argument too many, and one derivative too few of another.

use lie_runtime::prelude::*;

lie_poisson! {
    pub system Body;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state x, y, z;
    parameters { I1 = 2; I2 = 1; I3 = 2/3; }
    functions { well(r) = well; pull(u, v) = well, derivatives (well); }
    hamiltonian = x^2/(2*I1) + well(y, z);
    casimir C = x^2 + y^2 + z^2;
    methods = [lie-midpoint];
}

fn well<S: Scalar>(r: S) -> S {
    r * r
}

include!("uses/three.rs");
