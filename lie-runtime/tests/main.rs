//! Tests of the runtime that are soon done without optimisation, as one program: they share what they compile of the systems.

mod allocations;
mod charts;
mod coadjoint_orbit;
mod collective;
mod cotangent;
mod density;
mod driver;
mod families;
mod families_acting;
mod families_bonds;
mod family_splittings;
mod functions;
mod generating;
mod joints;
mod kernels;
mod lanes;
mod orders;
mod own_step;
mod passive;
mod quantities;
mod reconstruction;
mod sites;
mod steps;
mod symmetry;
mod systems;
mod tensors;
