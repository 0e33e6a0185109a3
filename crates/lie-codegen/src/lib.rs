//! The compiler of lie-poisson: declarations in, checked systems and Rust out.
//!
//! ```text
//! macro tokens, JSON spec -> declaration -> check -> model -> structure -> plan (derive, schedule) -> print
//!                            lie_syntax                                          lie_symbolic
//! ```
//!
//! Declarations are read by [`lie_syntax`]; expressions, proofs and schedules are those of [`lie_symbolic`].
//! [`compile`] drives the stages and is the module to read first. A spec from end to end:
//!
//! ```
//! let spec = r#"{
//!     "format": 1, "name": "RigidBody",
//!     "algebra": {
//!         "basis": ["a", "b", "c"],
//!         "brackets": ["[a, b] = c", "[b, c] = a", "[c, a] = b"]
//!     },
//!     "state": ["x", "y", "z"],
//!     "parameters": { "I1": 2, "I2": 1, "I3": "2/3" },
//!     "hamiltonian": "x^2/(2*I1) + y^2/(2*I2) + z^2/(2*I3)",
//!     "casimirs": ["C = x^2 + y^2 + z^2"]
//! }"#;
//! let model = lie_codegen::compile::compile_spec(spec).unwrap();
//! assert_eq!(model.generic_rank, 2);
//! let code = lie_codegen::compile::expand(&model, &[]);
//! assert!(code.contains(" 6 multiplications."), "each component is a constant times two coordinates");
//! ```
//!
//! # Convention
//!
//! Left-invariant: with `$[e_i, e_j] = \sum_k C_{ij}^k e_k$` the generated field is
//!
//! ```math
//! \dot\mu_j = f_j(\mu) = \sum_{i,k} C_{ij}^k\, \frac{\partial H}{\partial \mu_i}\, \mu_k,
//! \qquad\text{that is}\qquad
//! \dot\mu = \mathrm{ad}^*_{\nabla H(\mu)}\mu = \Pi(\mu)\, \nabla H(\mu)
//! ```
//!
//! for so(3) `$\dot\mu = \mu \times \nabla H$`. A right-invariant system has `$-C$` for `$C$` from the model on.
//!
//! # What is checked, exactly
//!
//! ```math
//! \sum_l \left( C_{ij}^l C_{lk}^m + C_{jk}^l C_{li}^m + C_{ki}^l C_{lj}^m \right) = 0, \qquad
//! \sum_j \frac{\partial C}{\partial \mu_j}\, \Pi_{ji}(\mu) = 0, \qquad
//! [\rho(e_i), \rho(e_j)] = \sum_k C_{ij}^k\, \rho(e_k)
//! ```
//!
//! the Jacobi identity, each declared Casimir, each declared representation; over the rationals, or over
//! rational functions of the parameters that are declared exact.
#![cfg_attr(doc, doc = include_str!("../docs/katex.html"))]

pub mod algebra;
pub mod check;
pub mod compile;
pub mod derive;
pub mod expand;
pub mod golden;
pub mod methods;
pub mod model;
pub mod plan;
pub mod print;
pub mod program;
pub mod structure;
