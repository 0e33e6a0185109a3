//! A path of the runtime that is none. Where the runtime is, is not known then, so that nothing stands in for the system.

use lie_runtime::prelude::*;

lie_poisson! {
    crate = my-crate::lie_runtime;
    pub system Body;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state x, y, z;
    hamiltonian = x^2 + z^2/2;
}

fn main() {}
