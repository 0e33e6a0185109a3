//! The systems.

// Generated code is laid out by its own printer.
#![allow(missing_docs)]

use lie_runtime::prelude::lie_poisson;

lie_poisson! {
    /// Free rigid body: Euler's equations, as in `specs/so3_free_rigid_body.json`.
    pub system Body;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state x, y, z;
    parameters { I1 = 2.0; I2 = 1.0; I3 = 2/3; }
    hamiltonian = x^2/(2*I1) + y^2/(2*I2) + z^2/(2*I3);
    casimir norm2 = x^2 + y^2 + z^2;
    methods = [midpoint, lie-midpoint, spherical-midpoint, splitting2, splitting4, splitting6, cohen-hairer6, gauss16, collective16,
        taylor, lie-taylor, exact, rk4];
}

lie_poisson! {
    /// Heavy top, as in `specs/se3_heavy_top.json`.
    pub system Top;
    algebra {
        basis J1, J2, J3, P1, P2, P3;
        [J1, J2] = J3; [J2, J3] = J1; [J3, J1] = J2;
        [J1, P2] = P3; [J2, P3] = P1; [J3, P1] = P2;
        [P1, J2] = P3; [P2, J3] = P1; [P3, J1] = P2;
    }
    state m1, m2, m3, g1, g2, g3;
    parameters { I1 = 2.0; I2 = 1.5; I3 = 1.0; mgl = 1.0; c1 = 1/3; c2 = 1/7; c3 = 1.0; }
    hamiltonian = m1^2/(2*I1) + m2^2/(2*I2) + m3^2/(2*I3) + mgl*(c1*g1 + c2*g2 + c3*g3);
    casimir length2 = g1^2 + g2^2 + g3^2;
    casimir vertical_momentum = m1*g1 + m2*g2 + m3*g3;
    methods = [midpoint, lie-midpoint, splitting2, splitting4, splitting6, cohen-hairer6, gauss16, collective16, taylor, lie-taylor, rk4];
}

lie_poisson! { pub spec = "chain.json"; }
