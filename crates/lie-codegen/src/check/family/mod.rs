//! Families `A^N`: the algebra, its Casimirs and its rank are those of one site and checked as such; the Hamiltonian is a
//! function of sums over the sites, whose summands depend on a site and on neighbours at fixed distances.

mod acting;
mod bounds;
pub mod coupling;
pub mod limits;
mod parts;
mod shared;
pub mod sites;
mod sums;
