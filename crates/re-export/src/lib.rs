//! Systems of a crate that has the runtime under another name and re-exports it. Nothing here is called `lie_runtime`
//! but the re-export, so that a path which does not begin there does not compile.

pub use runtime as lie_runtime;

runtime::lie_poisson! {
    crate = crate::lie_runtime;
    /// Free rigid body, with fused code, flows and all.
    pub system RigidBody;
    algebra = so(3);
    state x, y, z;
    parameters { I1 = 2.0, positive; I2 = 1.0; I3 = 2/3; }
    hamiltonian = x^2/(2*I1) + y^2/(2*I2) + z^2/(2*I3);
    casimir C = x^2 + y^2 + z^2;
    methods = [midpoint, lie-midpoint, gauss4, splitting2, spherical-midpoint, mean-value, generating4];
}

/// A spec, with the path of the dependency itself.
pub mod top {
    runtime::lie_poisson! {
        crate = ::runtime;
        pub spec = "../../specs/se3_heavy_top.json";
    }
}

/// A pendulum in the crate of whoever calls this.
#[macro_export]
macro_rules! pendulum {
    ($name:ident) => {
        $crate::pendulum!($name, $crate::lie_runtime);
    };
    ($name:ident, $runtime:path) => {
        $crate::lie_runtime::lie_poisson! {
            crate = $runtime;
            pub system $name;
            poisson { {q, p} = 1; }
            state q, p;
            hamiltonian = p^2/2 - cos(q);
            methods = [midpoint];
        }
    };
}
