//! Steps of systems that the macro declares: against reference values, by their orders, by what they keep.

#[macro_use]
#[path = "../common/systems.rs"]
mod systems;
#[path = "../common/advance.rs"]
mod advance;
#[path = "../common/attitude.rs"]
mod attitude;
#[path = "../common/mod.rs"]
mod common;
#[path = "../common/equations.rs"]
mod equations;
#[path = "../common/errors.rs"]
mod errors;
#[path = "../common/five_body.rs"]
mod five_body;
#[path = "../common/kernels.rs"]
mod kernels;
#[path = "../common/representation.rs"]
mod representation;
#[path = "../common/rotation.rs"]
mod rotation;
#[path = "../common/round_off.rs"]
mod round_off;
#[path = "../common/vectors.rs"]
mod vectors;

mod canonical;
mod closed_forms;
mod closed_loop;
mod collective;
mod constants;
mod cotangent;
mod declared_attitude;
mod drift;
mod driven_splittings;
mod driving;
mod elementwise;
mod energy_methods;
mod exact;
mod explicit_declarations;
mod explicit_steps;
mod found_pieces;
mod found_splittings;
mod frozen_flow;
mod fused_equals_generic;
mod general_brackets;
mod generating;
mod hamilton_jacobi;
mod held;
mod lagrangians_on_groups;
mod lanes;
mod lying_kernels;
mod lying_methods;
mod made_alike;
mod metriplectic;
mod names;
mod near_integrable;
mod noise_orders;
mod noise_splittings;
mod orders_and_symmetry;
mod parametric_matrices;
mod published;
mod realization;
mod reconstruction;
mod reference_vectors;
mod retraction;
mod splittings;
mod stage_parallel;
mod taylor;
mod tilted_body;
mod tolerance;
mod units;
mod variational;
