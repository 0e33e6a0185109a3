//! Isospectral flows of skew-Hermitian matrices, `W' = [P(W), W]`: Lie–Poisson systems on u(N) and its subalgebras without their
//! `N^6` structure constants.
//!
//! A [`StreamMap`] says P, minus the gradient of the Hamiltonian in the trace form; [`MatrixFlow`] makes a system of it, which
//! the driver of [`lie_runtime`] takes like any other. [`SphereEuler`] is Zeitlin's truncation of the Euler equations on the
//! sphere.
//!
//! ```
//! use lie_dense::{MatrixFlow, SpectrumMonitor, SphereEuler};
//! use lie_runtime::driver::{Options, Save, solve_observed};
//! use lie_runtime::methods::Isospectral2;
//!
//! let sphere = SphereEuler::new(24)?;
//! // a rotation with a Rossby–Haurwitz wave on it
//! let w = sphere.vorticity(&[(1, 0, (0.5, 0.0)), (4, 3, (0.2, 0.0))])?;
//! let problem = MatrixFlow::new(sphere).problem(w, (0.0, 1.0))?;
//! let mut monitor = SpectrumMonitor::new();
//! let options = Options::new(0.02).save(Save::Every(10));
//! let solution = solve_observed(&problem, Isospectral2::new(), &options, &mut monitor)?;
//! assert!(monitor.change < 1e-13 * monitor.radius());
//! assert_eq!(solution.len(), 6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Methods
//!
//! | method | what it is here |
//! |---|---|
//! | [`Isospectral2`](lie_runtime::methods::Isospectral2) | the isospectral midpoint rule, a Poisson map that keeps the spectrum: one and a half matrix products an iteration ([`IsospectralStepper`]) |
//! | [`Compose4`](lie_runtime::methods::Compose4), `Compose6`, `Compose8` of it | orders 4, 6, 8, the same structure |
//! | `ImplicitMidpoint`, `Gauss4`, `Gauss6` | on the vector field, by fixed-point iteration; keep `tr W^2` |
//! | `Rk4`, `Dopri5` | explicit; keep nothing |
//!
//! All iterations are fixed-point iterations: a Jacobian would have `N^4` entries. Where they do not contract the step fails, as a
//! value with step, time, residual and remedy ([`SolveError`](lie_runtime::driver::SolveError)).
//!
//! # Same input, same bits
//!
//! Within one build on one processor. The matrix products are those of the library matrixmultiply, which chooses its kernels by
//! the processor at run time: another processor may round differently. It packs its arguments into memory of its own; besides
//! this a step allocates nothing.
#![forbid(unsafe_code)]
#![warn(missing_docs)]

mod collocation;
mod isospectral;
mod plane;
mod predictor;
mod product;
mod skew;
mod spectrum;
mod sphere;
mod stream;
mod system;
mod triangle;

pub use isospectral::IsospectralStepper;
pub use skew::{ShapeError, SkewHermitian};
pub use spectrum::{SpectrumMonitor, spectrum};
pub use sphere::SphereEuler;
pub use stream::StreamMap;
pub use system::{FlowJacobian, MatrixFlow};
