//! Expressions: exact numbers, an interned arena with exact calculus, proofs of identities, straight-line programs.
//!
//! ```text
//! exact -> symbolic -> prove, schedule
//! ```
//!
//! Nothing here knows what an expression is about. [`exact`] has rational numbers and functions, rigorous bounds and residues
//! modulo primes; [`symbolic`] has the arena and its derivatives; [`prove`] decides identities and says what confirms them;
//! [`schedule`] makes a program of few operations.
//!
//! ```
//! use lie_symbolic::symbolic::{Graph, Symbol};
//!
//! let mut graph = Graph::new();
//! let x = graph.symbol(Symbol::Coordinate(0));
//! let square = graph.mul(x, x);
//! let slope = graph.derivative(square, Symbol::Coordinate(0));
//! let two = graph.integer(2);
//! assert_eq!(slope, graph.mul(two, x), "equal expressions are one node");
//! ```

pub mod exact;
pub mod prove;
pub mod schedule;
pub mod symbolic;
