//! The command: `lie`, called as a user would.

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/process.rs"]
mod process;
#[path = "../common/random.rs"]
mod random;
#[path = "../common/resuming.rs"]
mod resuming;
#[path = "../common/rotation.rs"]
mod rotation;
#[path = "../common/vectors.rs"]
mod vectors;

mod acting;
mod acting_ends;
mod attitude;
mod attitude_in_space;
mod backwards;
mod bounds;
mod brackets;
mod build;
mod canonical;
mod check;
mod cocycles;
mod conjugate;
mod constraint_parameters;
mod constraints;
mod declarations;
mod density;
mod driven_spins;
mod ensemble;
#[cfg(unix)]
mod ensemble_events;
mod equilibria;
mod equilibria_of_constraints;
mod equilibria_scales;
mod events;
mod exponents;
mod families;
mod families_acting;
mod families_cubic;
mod families_driven;
mod found_on_brackets;
mod frequencies;
mod hostile_text;
mod joints;
mod keep;
mod line;
mod lost;
mod many_runs;
mod named_algebras;
mod new;
mod orbits;
mod parametric_matrices;
mod pictures;
mod quantities;
mod random_systems;
mod report;
mod resume;
mod resume_refused;
mod retractions;
mod run;
mod signs;
#[cfg(unix)]
mod stop;
mod stress;
mod time;
mod units;
mod verify;
