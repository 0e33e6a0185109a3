//! Closed forms of functions of `ad*_x`, against values of 50 digits straight from the structure constants
//! (`lab/tools/closed_forms.py`).
//!
//! The error must stay below 16 units of round-off times the condition: what relative changes of round-off of the entries of
//! x and mu do to the result.

use lie_runtime::LiePoisson;
use lie_runtime::prelude::*;

macro_rules! algebras {
    ($($module:ident $name:ident $folder:literal;)+) => {
        $(
            mod $module {
                use lie_runtime::prelude::*;
                lie_poisson! { pub spec = $folder; }
            }
        )+
        /// The errors of each algebra, by its name.
        fn errors() -> Vec<(&'static str, bool, [f64; 2])> {
            vec![$({
                let system = $module::$name::new().system().expect("sound parameters");
                (stringify!($module), system.has_closed_exponential(), worst(stringify!($module), &system))
            }),+]
        }
    };
}

algebras! {
    so3_free_rigid_body FreeRigidBody "specs/so3_free_rigid_body.json";
    se3_heavy_top HeavyTop "specs/se3_heavy_top.json";
    so4_manakov ManakovTop "specs/so4_manakov.json";
    su3_quadratic Su3Quadratic "specs/su3_quadratic.json";
    heisenberg_h3 Heisenberg "specs/heisenberg_h3.json";
    e2_pendulum Pendulum "specs/e2_pendulum.json";
    sl2_quadratic Sl2Quadratic "specs/sl2_quadratic.json";
    toda3_solvable TodaLattice "specs/toda3_solvable.json";
    so3_cotangent_euler_arnold CotangentEulerArnold "specs/so3_cotangent_euler_arnold.json";
    affine_line AffineLine "tests/data/closed/affine_line.json";
    oblique_so3 ObliqueSo3 "tests/data/closed/oblique_so3.json";
    oblique_sl2 ObliqueSl2 "tests/data/closed/oblique_sl2.json";
    oblique_se3 ObliqueSe3 "tests/data/closed/oblique_se3.json";
}

/// The largest error over conditions, in units of round-off.
const MOST: f64 = 16.0;

/// The numbers of each line: x, mu, the two results, their conditions.
fn lines(name: &str) -> Vec<Vec<f64>> {
    let path = format!(
        "{}/tests/data/closed/{name}.txt",
        env!("CARGO_MANIFEST_DIR")
    );
    let text = std::fs::read_to_string(path).expect("reference values");
    let number = |word: &str| word.parse().expect("a number");
    text.lines()
        .map(|line| line.split(' ').map(number).collect())
        .collect()
}

/// The largest difference of two vectors, in units of round-off of a size.
fn error(computed: &[f64], expected: &[f64], size: f64) -> f64 {
    let differences = computed.iter().zip(expected).map(|(a, b)| (a - b).abs());
    let not_a_number = computed.iter().any(|entry| !entry.is_finite());
    let largest = differences.fold(0.0, f64::max);
    if not_a_number {
        f64::NAN
    } else {
        largest / (size * f64::EPSILON)
    }
}

/// The largest errors of the coadjoint action and of the dual of dexp.
fn worst<P: LiePoisson<f64>>(name: &str, system: &P) -> [f64; 2] {
    let n = system.dimension();
    let mut worst = [0.0_f64; 2];
    for line in lines(name) {
        let (mut x, mut mu) = (system.zero_state(), system.zero_state());
        x.as_mut_slice().copy_from_slice(&line[..n]);
        mu.as_mut_slice().copy_from_slice(&line[n..2 * n]);
        let mut out = [system.zero_state(), system.zero_state()];
        system.coadjoint_action(&x, &mu, &mut out[0]);
        system.dexp_dual(&x, &mu, &mut out[1]);
        for (k, out) in out.iter().enumerate() {
            let expected = &line[(2 + k) * n..(3 + k) * n];
            let error = error(out.as_slice(), expected, line[4 * n + k]);
            assert!(!error.is_nan(), "{name} {:?}", x.as_slice());
            worst[k] = worst[k].max(error);
        }
    }
    worst
}

#[test]
fn all_digits_on_every_algebra() {
    for (name, closed, errors) in errors() {
        println!("{name} {closed} {errors:.2?}");
        assert_eq!(closed, name != "su3_quadratic", "{name}");
        assert!(
            errors.iter().all(|error| *error < MOST),
            "{name} {errors:?}"
        );
    }
}

/// Without the series beside the removable singularities the same test fails.
#[test]
fn elementary_functions_alone_lose_digits() {
    let cross = |a: [f64; 3], b: [f64; 3]| {
        core::array::from_fn::<f64, 3, _>(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            a[j] * b[k] - a[k] * b[j]
        })
    };
    let mut worst: f64 = 0.0;
    for line in lines("so3_free_rigid_body") {
        let x: [f64; 3] = line[..3].try_into().expect("three numbers");
        let mu: [f64; 3] = line[3..6].try_into().expect("three numbers");
        let angle = x.iter().map(|x| x * x).sum::<f64>().sqrt();
        let (first, second) = (
            (1.0 - angle.cos()) / (angle * angle),
            (angle - angle.sin()) / (angle * angle * angle),
        );
        // ad*_x mu = mu x
        let moved = cross(mu, x);
        let again = cross(moved, x);
        let out: [f64; 3] = core::array::from_fn(|i| mu[i] + first * moved[i] + second * again[i]);
        let error = error(&out, &line[9..12], line[13]);
        worst = worst.max(error);
    }
    assert!(worst > 16.0 * MOST, "{worst}");
}
