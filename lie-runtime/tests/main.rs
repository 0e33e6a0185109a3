//! Tests of the runtime that are soon done without optimisation, as one program: they share what they compile of the systems.

mod allocations;
mod branches;
mod charts;
mod coadjoint_orbit;
mod collective;
mod cotangent;
mod curve;
mod driver;
mod families;
mod family_splittings;
mod functions;
mod generating;
mod kernels;
mod lanes;
mod orders;
mod own_step;
mod passive;
mod quantities;
mod reconstruction;
mod sites;
mod solver;
mod steps;
mod symmetry;
mod systems;
mod tensors;
mod variational;
