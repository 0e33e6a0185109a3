//! Tests of the runtime that compute for long, or have lanes of a solver on the stack, which is shallow with optimisation alone.

mod balances;
mod branches;
mod choices;
mod compositions;
mod conservation;
mod curve;
mod energy;
mod events;
mod forces;
mod lagrange_alembert;
mod lifts;
mod own_functions;
mod projection;
mod series;
mod solver;
mod systems;
mod variational;
