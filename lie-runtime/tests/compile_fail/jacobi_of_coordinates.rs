//! Quadratic brackets of four coordinates that are no Poisson brackets.

use lie_runtime::prelude::*;

lie_poisson! {
    pub system Body;
    poisson { {x, y} = z*w; {y, z} = x*w; {z, x} = y*w; {x, w} = y*z; }
    state x, y, z, w;
    parameters { I1 = 2; I2 = 1; I3 = 2/3; }
    hamiltonian = x^2/(2*I1) + y^2/(2*I2) + z^2/(2*I3);
    methods = [midpoint];
}

include!("uses/four.rs");
