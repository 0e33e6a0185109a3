//! What a system has beyond the algebra and H: structure that some methods need.

pub mod algebra;
pub mod casimirs;
pub mod exponential;
pub mod family;
pub mod found;
pub mod group;
pub mod inertia;
pub mod integrable;
pub mod lifts;
pub mod matrices;
pub mod one_parameter;
pub mod separable;
pub mod smoothness;
pub mod spectrum;
pub mod spins;
pub mod vectors;
