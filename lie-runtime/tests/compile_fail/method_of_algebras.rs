//! A method of coadjoint form for a bracket without an algebra.

use lie_runtime::prelude::*;

lie_poisson! {
    pub system Body;
    poisson { {x, y} = x*y; {z, w} = 1; }
    state x, y, z, w;
    parameters { I1 = 2; I2 = 1; I3 = 2/3; }
    hamiltonian = x^2/(2*I1) + y^2/(2*I2) + z^2/(2*I3);
    methods = [midpoint, lie-midpoint];
}

include!("uses/four.rs");
