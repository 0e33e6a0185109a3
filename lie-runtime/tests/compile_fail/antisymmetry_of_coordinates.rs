//! A pair of coordinates that disagrees with itself, and a coordinate that does not exist.

use lie_runtime::prelude::*;

lie_poisson! {
    pub system Body;
    poisson { {x, y} = z^2; {x, v} = z; {y, x} = z^2; {w, w} = x; }
    state x, y, z, w;
    parameters { I1 = 2; I2 = 1; I3 = 2/3; }
    hamiltonian = x^2/(2*I1) + y^2/(2*I2) + z^2/(2*I3);
    methods = [midpoint];
}

include!("uses/four.rs");
