//! Taylor series across joints: `abs`, `min`, `max`, `piecewise`, tables. Their steps end where the branch changes.
//!
//! The right values are those of an extrapolation method in 32 digits, on equations written by hand for each branch, whose steps
//! end at roots of the conditions that are found by bisection.

use lie_runtime::methods::{Method, Stepper};
use lie_runtime::newton::{FailureReason, NewtonOptions};
use lie_runtime::prelude::*;
use lie_runtime::scalar::Dual;
use lie_runtime::{Recurrence, Scalar, Series};

macro_rules! body {
    ($name:ident, [$($initial:tt)*], { $($functions:tt)* }, $($energy:tt)*) => {
        lie_poisson! {
            /// A body with branches.
            pub system $name;
            algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
            state x, y, z;
            $($functions)*
            hamiltonian = x^2/2 + y^2/3 + z^2/5 + $($energy)*;
            initial = [$($initial)*];
            methods = [taylor, lie-taylor];
        }
    };
}

body!(Inertia, [3/10, 1/10, 9/10], {}, piecewise(x < 0: 3*x^2, x^2/7));
body!(Ramp, [3/5, 12/25, 16/25], {}, piecewise(t < 1: 0, t < 5/2: (t - 1)*x, 3*x/2));
body!(
    Extremes,
    [3 / 5, 12 / 25, 16 / 25],
    {},
    max(x * y, z) / 2 + min(x, y / 2)
);
body!(Table, [3/5, 12/25, 16/25], {
    functions { v = table [(-1, 1/5), (-1/2, 1/10), (0, 0), (1/2, 1/5), (1, 1/2)], degree 1; }
}, v(y));
body!(Corner, [3 / 10, 1 / 10, 9 / 10], {}, abs(x) / 4);
body!(Trap, [1/10, 3/5, -4/5], {}, piecewise(x < 0: 3*y, -3*y));

/// The state after steps of a grid.
fn run<S: Scalar, P: Poisson<S>>(
    system: &P,
    method: &impl Method<S, P>,
    start: P::State,
    h: S,
    steps: u32,
) -> P::State {
    let mut mu = start;
    let mut stepper = method.stepper(system, h, &NewtonOptions::default());
    for _ in 0..steps {
        stepper.step(&mut mu, &mut ()).expect("the step is made");
    }
    mu
}

/// The largest difference of a coordinate.
fn error(end: &[f64], exact: [f64; 3]) -> f64 {
    let pairs = end.iter().zip(&exact);
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Each system, the end of its run, and what it is there.
macro_rules! each_system {
    ($check:ident) => {
        $check!(
            Inertia,
            20.0,
            [
                0.297_047_742_076_674_67,
                -0.125_914_571_411_517_4,
                0.897_723_877_165_692_5
            ]
        );
        $check!(
            Ramp,
            6.0,
            [
                0.456_075_108_735_522_2,
                0.794_666_050_435_544_1,
                -0.400_626_214_166_091_45
            ]
        );
        $check!(
            Extremes,
            10.0,
            [
                0.792_830_900_505_648,
                0.527_679_119_221_579_8,
                -0.304_916_234_957_965_4
            ]
        );
        $check!(
            Table,
            10.0,
            [
                0.877_191_026_996_842_9,
                0.231_792_649_208_185_1,
                -0.420_485_516_907_866
            ]
        );
        $check!(
            Corner,
            30.0,
            [
                0.048_123_942_433_043_42,
                0.824_352_352_946_615_4,
                0.477_626_720_730_823_46
            ]
        );
    };
}

#[test]
fn steps_end_where_the_branch_changes() {
    macro_rules! check {
        ($system:ident, $end:literal, $exact:expr) => {
            let system = $system::new().system().expect("sound");
            let start = $system::new().initial_state();
            for steps in [1, 7, 500] {
                let h = $end / f64::from(steps);
                let taylor = run(&system, &Taylor::default(), start, h, steps);
                let lie = run(&system, &LieTaylor::default(), start, h, steps);
                let loose = run(&system, &Taylor::with_tolerance(1e-8), start, h, steps);
                let errors = [taylor, lie, loose].map(|end| error(end.as_slice(), $exact));
                println!("{} in {steps}: {errors:.1?}", stringify!($system));
                assert!(
                    errors[0] < 3e-13,
                    "{} {steps}: {errors:?}",
                    stringify!($system)
                );
                assert!(
                    errors[1] < 1e-12,
                    "{} {steps}: {errors:?}",
                    stringify!($system)
                );
                assert!(
                    errors[2] < 1e-5,
                    "{} {steps}: {errors:?}",
                    stringify!($system)
                );
                // and back
                let back = run(&system, &Taylor::default(), taylor, -h, steps);
                let home = [start[0], start[1], start[2]];
                assert!(
                    error(back.as_slice(), home) < 1e-12,
                    "{}",
                    stringify!($system)
                );
            }
        };
    }
    each_system!(check);
}

/// Steps by series of order 30 on the branch on which each begins.
fn blind<P>(system: &P, start: P::State, end: f64) -> P::State
where
    P: Series<f64>,
{
    let steps = (end / 0.4).round();
    let h = end / steps;
    let mut mu = start;
    for _ in 0..steps as u32 {
        let mut recurrence = system.series();
        let (mut row, mut field) = (mu.clone(), mu.clone());
        let mut carry = recurrence.begin(&mu, &mut field);
        let mut power = 1.0;
        for k in 1..=30 {
            power *= h;
            for (row, field) in row.as_mut_slice().iter_mut().zip(field.as_slice()) {
                *row = field / k as f64;
            }
            for (entry, row) in mu.as_mut_slice().iter_mut().zip(row.as_slice()) {
                *entry += row * power;
            }
            carry = recurrence.advance(k, carry, &row, &mut field);
        }
    }
    mu
}

/// The control: without the joints the motion is another one.
#[test]
fn series_that_do_not_end_at_joints_are_wrong() {
    macro_rules! check {
        ($system:ident, $end:literal, $exact:expr) => {
            let system = $system::new().system().expect("sound");
            let end = blind(&system, $system::new().initial_state(), $end);
            let found = error(end.as_slice(), $exact);
            println!("{}: {found:.1e}", stringify!($system));
            assert!(found > 1e-3, "{}: {found:e}", stringify!($system));
        };
    }
    each_system!(check);
}

/// Lanes come to joints at times of their own.
#[test]
fn lanes_have_the_digits_of_scalar_runs() {
    let one = Inertia::new().system().expect("sound");
    let many = Inertia::<F64x8>::default().system().expect("sound");
    let starts: [[f64; 3]; 8] =
        core::array::from_fn(|lane| [0.3 - 0.1 * lane as f64, 0.1 + 0.05 * lane as f64, 0.9]);
    let wide: [F64x8; 3] =
        core::array::from_fn(|i| F64x8::new(core::array::from_fn(|lane| starts[lane][i])));
    let end = run(&many, &Taylor::default(), wide.into(), F64x8::splat(1.7), 6);
    let lie = run(
        &many,
        &LieTaylor::default(),
        wide.into(),
        F64x8::splat(1.7),
        6,
    );
    for (lane, start) in starts.into_iter().enumerate() {
        let alone = run(&one, &Taylor::default(), start.into(), 1.7, 6);
        let lie_alone = run(&one, &LieTaylor::default(), start.into(), 1.7, 6);
        for i in 0..3 {
            assert_eq!(end[i].lane(lane).to_bits(), alone[i].to_bits(), "{lane}");
            assert_eq!(
                lie[i].lane(lane).to_bits(),
                lie_alone[i].to_bits(),
                "{lane}"
            );
        }
    }
}

/// The time at which a joint is met moves with the state.
#[test]
fn derivatives_go_through_joints() {
    let system = Inertia::new().system().expect("sound");
    let dual = Inertia::<Dual<f64>>::default().system().expect("sound");
    let start = [0.3, 0.1, 0.9];
    for i in 0..3 {
        let mut along = start.map(|value| Dual {
            value,
            derivative: 0.0,
        });
        along[i].derivative = 1.0;
        let h = Dual {
            value: 2.5,
            derivative: 0.0,
        };
        let end = run(&dual, &Taylor::default(), along.into(), h, 8);
        let at = |shift: f64| {
            let mut moved = start;
            moved[i] += shift;
            run(&system, &Taylor::default(), moved.into(), 2.5, 8)
        };
        let slope = (at(1e-5) - at(-1e-5)) / 2e-5;
        for (entry, slope) in end.iter().zip(&slope) {
            let found = (entry.derivative - slope).abs();
            assert!(found < 1e-6 * (1.0 + slope.abs()), "{i}: {found:e}");
        }
    }
}

/// A Hamiltonian that jumps may drive the motion to the joint from both sides: there is no solution.
#[test]
fn a_motion_that_does_not_leave_a_joint_is_refused() {
    let system = Trap::new().system().expect("sound");
    let mut mu = Trap::new().initial_state();
    let mut stepper = Taylor::default().stepper(&system, 1.0, &NewtonOptions::default());
    let failure = stepper.step(&mut mu, &mut ()).expect_err("it is trapped");
    assert_eq!(failure.reason, FailureReason::OnJoint);
    assert_eq!(mu, Trap::new().initial_state(), "the state is as it was");
    // the control: with the signs exchanged it leaves
    let mut mu = Trap::new().initial_state();
    mu[2] = 0.8;
    let mut stepper = Taylor::default().stepper(&system, 0.1, &NewtonOptions::default());
    assert!(stepper.step(&mut mu, &mut ()).is_ok());
}

/// Initial states on a joint, and a joint on a time of the grid.
#[test]
fn a_run_may_begin_and_a_step_may_end_on_a_joint() {
    let system = Corner::new().system().expect("sound");
    for (z, side) in [(0.9, 1.0), (-0.9, -1.0)] {
        // x' = y z (2/5 - 2/3)
        let start = [0.0, -0.4, z];
        let end = run(&system, &Taylor::default(), start.into(), 0.25, 1);
        assert!(end[0] * side > 0.01, "{end}");
        let near = run(
            &system,
            &Taylor::default(),
            [1e-9 * side, -0.4, z].into(),
            0.25,
            1,
        );
        assert!((end - near).abs().max() < 1e-8, "{end} {near}");
    }
}
