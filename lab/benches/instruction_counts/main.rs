//! Kernels of the heavy top over f64, generated and written by hand, `linearize` of su(3), and steps of the main
//! methods, in a loop for a profiler to count. `tests/instruction_counts.rs` builds and runs this under callgrind; by
//! hand: `cargo bench --bench instruction_counts -- generated vector_field 1000`, or `se3_heavy_top gauss6 1000`.

mod plain;
mod steps;

use lie_runtime::{Poisson, generic};
use spec_systems::se3_heavy_top::{HeavyTop, HeavyTopSystem};
use spec_systems::su3_quadratic;
use std::hint::black_box;
use std::process::ExitCode;

type State = <HeavyTopSystem as Poisson<f64>>::State;
type Jacobian = <HeavyTopSystem as Poisson<f64>>::Jacobian;

#[inline(never)]
fn vector_field(system: &HeavyTopSystem, mu: &State, out: &mut State) {
    system.vector_field(mu, out);
}

#[inline(never)]
fn linearize(system: &HeavyTopSystem, mu: &State, field: &mut State, jacobian: &mut Jacobian) {
    system.linearize(mu, field, jacobian);
}

#[inline(never)]
fn generic_vector_field(system: &HeavyTopSystem, mu: &State, out: &mut State) {
    generic::vector_field(system, mu, out);
}

/// A Jacobian of 64 entries, some of which vanish.
#[inline(never)]
fn su3_linearize(repetitions: u32) -> ExitCode {
    let parameters = su3_quadratic::Su3Quadratic::new();
    let Ok(system) = parameters.system() else {
        return ExitCode::FAILURE;
    };
    let mu = parameters.initial_state();
    let (mut field, mut jacobian) = (system.zero_state(), system.zero_jacobian());
    repeat(repetitions, || {
        black_box(&system).linearize(black_box(&mu), &mut field, &mut jacobian);
    });
    println!("{:?} {:?}", field.data.0[0], jacobian.data.0);
    ExitCode::SUCCESS
}

fn repeat(repetitions: u32, mut kernel: impl FnMut()) {
    for _ in 0..repetitions {
        kernel();
    }
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args()
        .skip(1)
        .filter(|argument| argument != "--bench")
        .collect();
    let [form, kernel, repetitions] = arguments.as_slice() else {
        println!("usage: generated|generic|plain vector_field|linearize|su3_linearize REPETITIONS");
        println!("or a system, a method, and the number of steps");
        return ExitCode::SUCCESS;
    };
    let repetitions: u32 = repetitions.parse().unwrap_or(1);
    if steps::make(form, kernel, repetitions) {
        return ExitCode::SUCCESS;
    }
    if kernel == "su3_linearize" {
        return su3_linearize(repetitions);
    }
    let parameters = HeavyTop::new();
    let Ok(system) = parameters.system() else {
        return ExitCode::FAILURE;
    };
    let plain = plain::HeavyTop::new([2.0, 1.5, 1.0], 1.0, [1.0 / 3.0, 1.0 / 7.0, 1.0]);
    let mu = parameters.initial_state();
    let (mut field, mut jacobian) = (system.zero_state(), system.zero_jacobian());
    let [plain_mu] = mu.data.0;
    let (mut plain_field, mut plain_jacobian) = ([0.0; 6], [[0.0; 6]; 6]);
    let (system, mu, field, jacobian) = (&system, &mu, &mut field, &mut jacobian);
    let (plain, plain_mu) = (&plain, &plain_mu);
    let (plain_field, plain_jacobian) = (&mut plain_field, &mut plain_jacobian);
    match (form.as_str(), kernel.as_str()) {
        ("generated", "vector_field") => {
            repeat(repetitions, || {
                vector_field(black_box(system), black_box(mu), field)
            });
        }
        ("plain", "vector_field") => {
            repeat(repetitions, || {
                plain::vector_field(black_box(plain), black_box(plain_mu), plain_field)
            });
        }
        ("generic", "vector_field") => {
            repeat(repetitions, || {
                generic_vector_field(black_box(system), black_box(mu), field)
            });
        }
        ("generated", "linearize") => {
            repeat(repetitions, || {
                linearize(black_box(system), black_box(mu), field, jacobian)
            });
        }
        ("plain", "linearize") => repeat(repetitions, || {
            plain::linearize(
                black_box(plain),
                black_box(plain_mu),
                plain_field,
                plain_jacobian,
            );
        }),
        _ => return ExitCode::FAILURE,
    }
    // both forms compute the same numbers
    match form.as_str() {
        "plain" => println!("{plain_field:?} {plain_jacobian:?}"),
        _ => println!("{:?} {:?}", field.data.0[0], jacobian.data.0),
    }
    ExitCode::SUCCESS
}
