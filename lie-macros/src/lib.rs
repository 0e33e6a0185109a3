//! The `lie_poisson!` macro: a shell over [`lie_codegen`], re-exported by `lie-runtime`.

use std::path::PathBuf;

use proc_macro::TokenStream;

/// Declares a Lie–Poisson system, or another Poisson system, and generates its specialized code.
///
/// The structure constants are checked exactly at compile time, the equations of motion
/// `mu' = ad*_{grad H(mu)} mu` (of other brackets `mu' = Pi(mu) grad H(mu)`) are derived symbolically. Every
/// mistake is an error at its token.
///
/// ```ignore
/// use lie_runtime::prelude::*;
///
/// lie_poisson! {
///     /// Free rigid body in the body frame.
///     pub system RigidBody;
///     algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
///     state x, y, z;
///     parameters { I1 = 2.0; I2 = 1.0; I3 = 2/3; }
///     hamiltonian = x^2/(2*I1) + y^2/(2*I2) + z^2/(2*I3);
///     casimir C = x^2 + y^2 + z^2;
///     methods = [lie-midpoint];
/// }
///
/// lie_poisson! {
///     /// The same by its reduced Lagrangian: the Legendre transform is found at compile time.
///     pub system ByLagrangian;
///     algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
///     state x, y, z;
///     velocity w1, w2, w3;
///     parameters { I1 = 2.0; I2 = 1.0; I3 = 2/3; }
///     lagrangian = (I1*w1^2 + I2*w2^2 + I3*w3^2)/2;
/// }
///
/// lie_poisson! {
///     /// A pendulum in canonical coordinates: brackets of coordinates instead of an algebra, any functions of
///     /// the state that satisfy the Jacobi identity.
///     pub system Canonical;
///     poisson { {q, p} = 1; }
///     state q, p;
///     hamiltonian = p^2/2 - cos(q);
/// }
///
/// lie_poisson! {
///     /// A body with circulation around it: constants are added to the bracket of se(2)*, a cocycle.
///     pub system Foil;
///     algebra { basis J, P1, P2; [J, P1] = P2; [J, P2] = -P1; }
///     cocycle { {p1, p2} = 1/2; }
///     state L, p1, p2;
///     hamiltonian = L^2/4 + p1^2/2 + p2^2/6;
/// }
///
/// lie_poisson! {
///     /// The same by the discrete Lagrangian of a step of size h; x1/h is a velocity.
///     pub system ByDiscreteLagrangian;
///     algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
///     state x, y, z;
///     velocity x1, x2, x3;
///     parameters { I1 = 2.0; I2 = 1.0; I3 = 2/3; }
///     discrete_lagrangian = (I1*x1^2 + I2*x2^2 + I3*x3^2)/(2*h);
///     methods = [discrete-euler-poincare];
/// }
///
/// lie_poisson! {
///     /// A body in a potential that turns with the time: a system on T*SO(3). The entries of R are
///     /// coordinates beside x, y, z.
///     pub system InPotential;
///     algebra {
///         basis e1, e2, e3;
///         matrix e1 = [[0, 0, 0], [0, 0, -1], [0, 1, 0]];
///         matrix e2 = [[0, 0, 1], [0, 0, 0], [-1, 0, 0]];
///         matrix e3 = [[0, -1, 0], [1, 0, 0], [0, 0, 0]];
///     }
///     group R;
///     state x, y, z;
///     hamiltonian = x^2/4 + y^2/2 + 3*z^2/4 + R33*cos(t);
/// }
///
/// lie_poisson! { pub spec = "specs/se3_heavy_top.json"; }
///
/// lie_poisson! {
///     // Where another crate re-exports the runtime: generated paths begin here, and not at `::lie_runtime`.
///     crate = my_crate::lie_runtime;
///     pub spec = "specs/so3_free_rigid_body.json";
/// }
/// ```
///
/// A Lagrangian that is not quadratic in the velocity must be regular at rest, where the iteration for the velocity
/// of a momentum begins; methods then run on their generic forms. With `group R;` and matrices, a discrete
/// Lagrangian may contain the entries `R11`, `R12`, … of the step's group element; they are functions of
/// Cayley coordinates.
#[proc_macro]
pub fn lie_poisson(input: TokenStream) -> TokenStream {
    let manifest = std::env::var_os("CARGO_MANIFEST_DIR")
        .map(PathBuf::from)
        .unwrap_or_default();
    lie_codegen::expand::expand_macro(input.into(), &manifest).into()
}
