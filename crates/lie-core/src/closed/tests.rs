use super::*;
use crate::generic::Words;
use crate::scalar::Dual;

const VALUES: &str = include_str!("values.txt");
/// Functions of each line.
const COUNT: usize = 9;

/// The name, the argument and the values of a line.
fn lines() -> impl Iterator<Item = (&'static str, f64, [f64; COUNT])> {
    VALUES.lines().map(|line| {
        let mut words = line.split(' ');
        let name = words.next().expect("a name");
        let mut number = || words.next().and_then(|w| w.parse().ok()).expect("a number");
        (name, number(), core::array::from_fn(|_| number()))
    })
}

/// The error in units of the change of the value under relative changes by epsilon of argument and value; a Stumpff
/// function that passes through 0 takes its size from its neighbours: that of an angle's sine.
fn condition(name: &str, x: f64, values: &[f64; COUNT], k: usize) -> f64 {
    let slope = match name {
        "stumpff" if k + 2 < COUNT => 0.5 * (k as f64 * values[k + 2] - values[k + 1]),
        "phi" if k + 1 < COUNT => values[k] - k as f64 * values[k + 1],
        _ => 0.0,
    };
    values[k].abs() + (x * slope).abs()
}

/// The largest error over conditions, of all functions that this gives.
fn worst<const N: usize>(of: &str, first: usize, compute: impl Fn(f64) -> [f64; N]) -> f64 {
    let mut worst: f64 = 0.0;
    for (name, x, values) in lines().filter(|(name, ..)| *name == of) {
        for (k, value) in compute(x).into_iter().enumerate() {
            let k = first + k;
            let error = (value - values[k]).abs() / condition(name, x, &values, k);
            worst = worst.max(error / f64::EPSILON);
            assert!(!error.is_nan(), "{name} {x} {k}");
        }
    }
    worst
}

#[test]
fn all_digits_for_every_argument() {
    let errors = [
        worst("stumpff", 0, stumpff::<f64, 0, 7>),
        worst("stumpff", 1, stumpff::<f64, 1, 2>),
        worst("stumpff", 2, stumpff::<f64, 2, 4>),
        worst("stumpff", 3, stumpff::<f64, 3, 1>),
        worst("phi", 0, phi::<f64, 0, 8>),
        worst("phi", 1, phi::<f64, 1, 1>),
        worst("phi", 2, phi::<f64, 2, 3>),
    ];
    assert!(errors.iter().all(|error| *error < 16.0), "{errors:?}");
}

/// The mean of what lengths and what moves with them change by in a rotation by an angle near one, relative to themselves.
fn bias(angle: f64, functions: impl Fn(f64) -> [f64; 4]) -> [f64; 2] {
    const COUNT: u32 = 100_000;
    let mut sums = [0.0; 2];
    for k in 0..COUNT {
        // a sequence that fills an interval evenly
        let angle = angle * (1.0 + 0.02 * (f64::from(k) * 0.618_033_988_749_894_9).fract());
        let w = angle * angle;
        let [first, second, third, fourth] = functions(w);
        let zero = Words::sum(0.0, 0.0);
        let length = Words::product(first, first)
            .plus(Words::product(second, second).times(w))
            .minus(Words::sum(2.0 * second, 0.0));
        let slope = Words::sum(third, -second)
            .times(first)
            .plus(Words::product(second, second))
            .plus(
                Words::product(w, second)
                    .plus(Words::sum(-1.0, 0.0))
                    .times(2.0 * fourth),
            )
            .plus(
                Words::product(w, second)
                    .plus(Words::sum(-1.0, 0.0))
                    .times(-third),
            )
            .minus(zero);
        sums[0] += w * length / f64::from(COUNT);
        sums[1] += w * slope / f64::from(COUNT);
    }
    sums
}

#[test]
fn rotations_keep_lengths_on_average() {
    // the control: the recurrence with one word
    let plain = |w: f64| {
        let sum = |k: usize| {
            let terms = (0..12).rev();
            terms.fold(0.0, |sum, n| inverse_factorial::<f64>(k + 2 * n) - w * sum)
        };
        let [third, fourth] = [3, 4].map(sum);
        [1.0 - w * third, 0.5 - w * fourth, third, fourth]
    };
    for angle in [0.3, 0.9, 1.4, 1.9] {
        let [length, slope] = bias(angle, stumpff::<f64, 1, 4>);
        let control = bias(angle, plain);
        println!("{angle}: {length:e} {slope:e}, control {control:?}");
        let most = 5e-19 * f64::max(1.0, angle * angle);
        assert!(length.abs() < most, "{angle}: {length:e}");
        assert!(slope.abs() < 4.0 * most, "{angle}: {slope:e}");
        if angle == 0.9 {
            assert!(control[0] > 5e-18 && control[1] < -5e-18, "{control:?}");
        }
    }
}

/// Without the series the removable singularities show.
#[test]
fn the_series_are_needed() {
    let elementary = |w: f64| {
        let angle = w.abs().sqrt();
        let first = match w < 0.0 {
            true => [libm::cosh(angle), libm::sinh(angle) / angle],
            false => [libm::cos(angle), libm::sin(angle) / angle],
        };
        upwards::<f64, 0, 4>(-w, &first)
    };
    let mut worst: f64 = 0.0;
    for (_, x, values) in lines().filter(|(name, x, _)| *name == "stumpff" && *x != 0.0) {
        let [.., value] = elementary(x);
        worst = worst.max((value - values[3]).abs() / values[3].abs());
    }
    assert!(worst > 1e-3, "{worst}");
}

#[test]
fn derivatives_are_those_of_the_family() {
    for (name, x, _) in lines().filter(|(_, x, _)| x.abs() <= 400.0) {
        let dual = Dual {
            value: x,
            derivative: 1.0,
        };
        let (slopes, expected): ([f64; 4], [f64; 4]) = match name {
            "stumpff" => {
                let s = stumpff::<f64, 1, 6>(x);
                let formula = |k: usize| 0.5 * (k as f64 * s[k + 1] - s[k]);
                (
                    stumpff::<Dual<f64>, 1, 4>(dual).map(|value| value.derivative),
                    core::array::from_fn(|k| formula(k + 1)),
                )
            }
            _ => {
                let s = phi::<f64, 1, 6>(x);
                let formula = |k: usize| s[k - 1] - k as f64 * s[k];
                (
                    phi::<Dual<f64>, 1, 4>(dual).map(|value| value.derivative),
                    core::array::from_fn(|k| formula(k + 1)),
                )
            }
        };
        for (k, (a, b)) in slopes.iter().zip(expected).enumerate() {
            let scale = b.abs() + INVERSE_FACTORIALS[k + 4] / (1.0 + x.abs());
            assert!((a - b).abs() < 1e-13 * scale, "{name} {x} {k} {a} {b}");
        }
    }
}

#[cfg(feature = "lanes")]
#[test]
fn a_lane_gives_the_bits_of_a_run_alone() {
    use crate::scalar::F64x8;
    let arguments: Vec<f64> = lines().map(|(_, x, _)| x).collect();
    for chunk in arguments.windows(8).step_by(3) {
        let together = F64x8::from_lanes(|lane| chunk[lane]);
        let (s, p) = (
            stumpff::<F64x8, 1, 5>(together),
            phi::<F64x8, 1, 4>(together),
        );
        for (lane, &x) in chunk.iter().enumerate() {
            let alone = stumpff::<f64, 1, 5>(x);
            assert!(
                s.iter()
                    .zip(alone)
                    .all(|(s, a)| s.lane(lane).to_bits() == a.to_bits())
            );
            let alone = phi::<f64, 1, 4>(x);
            assert!(
                p.iter()
                    .zip(alone)
                    .all(|(s, a)| s.lane(lane).to_bits() == a.to_bits())
            );
        }
    }
}

#[test]
fn single_precision_too() {
    for (name, x, values) in lines().filter(|(_, x, _)| x.abs() < 60.0) {
        let computed: [f32; 4] = match name {
            "stumpff" => stumpff::<f32, 2, 4>(x as f32),
            _ => phi::<f32, 2, 4>(x as f32),
        };
        for (k, value) in computed.into_iter().enumerate() {
            let error = (f64::from(value) - values[k + 2]).abs();
            let scale = condition(name, x, &values, k + 2);
            assert!(
                error < 16.0 * f64::from(f32::EPSILON) * scale,
                "{name} {x} {k}"
            );
        }
    }
}

/// A count as a value gives the bits of a count as a type.
fn compare<const COUNT: usize>(x: f64) -> usize {
    let dual = Dual::new(x, 1.0);
    let pairs = [
        (stumpff::<_, 0, COUNT>(dual), counted::stumpff(COUNT, dual)),
        (phi::<_, 0, COUNT>(dual), counted::phi(COUNT, dual)),
    ];
    let bits = |dual: &Dual<f64>| (dual.value.to_bits(), dual.derivative.to_bits());
    for (array, all) in pairs {
        let known = all[..COUNT].iter().map(bits);
        assert!(array.iter().map(bits).eq(known), "{COUNT} {x}");
    }
    2 * COUNT
}

/// In every range of the argument, and on both sides of every bound.
#[test]
fn counts_as_values() {
    let bounds = [1.0 / 16.0, 1.0, 4.0, 16.0, 1e3];
    let beside = bounds.map(|bound: f64| [bound, bound.next_down(), bound.next_up(), 0.7 * bound]);
    let arguments = beside.into_iter().flatten().chain([0.0]);
    let mut compared = 0;
    for x in arguments.flat_map(|x| [x, -x]) {
        macro_rules! each {
            ($($count:literal)+) => { $(compared += compare::<$count>(x);)+ };
        }
        each!(1 2 3 4 5 6 7 8 9 10 11 12 13 14);
    }
    assert_eq!(compared, 42 * 2 * 105);
}
