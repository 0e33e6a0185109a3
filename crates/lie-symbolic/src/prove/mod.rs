//! What is proven about expressions, and what their values say about it.
//!
//! The normal form decides identities, wherever everything in an expression is real; values with rigorous bounds and values
//! modulo primes confirm it. It knows expressions alone, nothing of what they are about.

pub mod branches;
pub mod confirmation;
pub mod contradiction;
pub mod degree;
pub mod digits;
pub mod independence;
pub mod joints;
pub mod normal;
pub mod proof;
pub mod ranks;
pub mod residues;
pub mod sample;
pub mod sign;
