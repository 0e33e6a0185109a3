//! Units in which the parts of a state differ by decades: iterations end where every part has come to rest.

use lie_runtime::methods::{
    CohenHairer, Gauss4, Gauss6, Generating4, ImplicitMidpoint, LieMidpoint, Method, Stepper,
};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;
use spec_systems::se3_heavy_top::{HeavyTop, HeavyTopSystem};

type Top = HeavyTopSystem<f64>;

/// The state after some steps, with the directions in units of `2^-power` and brought back.
fn run(method: &impl Method<f64, Top>, options: &NewtonOptions, power: i32) -> [f64; 6] {
    let unit = 2.0_f64.powi(power);
    let top = HeavyTop {
        mgl: 1.0 / unit,
        ..HeavyTop::default()
    };
    let system = top.system().expect("a top");
    let scaled = |[a, b, c, d, e, f]: [f64; 6], unit: f64| [a, b, c, d * unit, e * unit, f * unit];
    let mut mu = system.zero_state();
    let start = scaled([0.4, 0.3, 0.9, 0.36, 0.48, 0.8], unit);
    mu.as_mut_slice().copy_from_slice(&start);
    let mut stepper = method.stepper(&system, 0.1, options);
    for _ in 0..60 {
        stepper.step(&mut mu, &mut ()).expect("the step is made");
    }
    let end = core::array::from_fn(|i| mu.as_slice()[i]);
    scaled(end, 1.0 / unit)
}

/// The largest difference that units make.
fn difference(method: &impl Method<f64, Top>, options: &NewtonOptions) -> f64 {
    let expected = run(method, options, 0);
    let mut largest: f64 = 0.0;
    for power in [-300, -100, -50, -20, 20, 50, 100, 300] {
        for (a, b) in run(method, options, power).iter().zip(expected) {
            largest = largest.max((a - b).abs());
        }
    }
    largest
}

#[test]
fn parts_in_other_units_are_solved_as_well() {
    let automatic = NewtonOptions::default();
    let newton = NewtonOptions::newton();
    let fixed = NewtonOptions::fixed_point();
    let mut missed = Vec::new();
    for options in [automatic, newton, fixed] {
        macro_rules! each {
            ($($method:expr),+ $(,)?) => {$(
                let off = difference(&$method, &options);
                println!("{} {:?}: {off:e}", stringify!($method), options.iteration);
                if off.is_nan() || off >= 1e-13 {
                    missed.push((stringify!($method), options.iteration, off));
                }
            )+};
        }
        each!(
            LieMidpoint::exp(),
            LieMidpoint::cayley(),
            ImplicitMidpoint,
            Gauss4,
            Gauss6,
            CohenHairer::<2>,
            Generating4::exp(),
        );
    }
    assert!(missed.is_empty(), "{missed:?}");
}
