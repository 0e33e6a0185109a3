//! Every generated kernel equals its generic reference, on random states of every system.
//!
//! References: the derivatives of H and of the Casimirs by dual numbers, the vector field as Poisson
//! matrix times gradient and the other forms of [`lie_runtime::generic`], the triple product by
//! matrices, and the generic equation of each implicit method.

use crate::equations::{cayley_equation, equations};
use crate::errors::{Errors, nudged};
use crate::kernels::kernels;
use crate::representation::Representation;
use crate::systems::{
    CotangentBody, CotangentEulerArnold, Declared, DiscreteBody, FreeRigidBody, Gyrostat, HeavyTop,
    Heisenberg, KirchhoffBody, KirchhoffFull, ManakovTop, NonpolynomialSpin, Pendulum, QuarticBody,
    Random, Satellite, Sl2Quadratic, Su3Quadratic, TodaLattice, state,
};
use lie_runtime::methods::{Cayley, LieMidpoint};
use lie_runtime::{CayleyPoisson, Dual, Implicit, Poisson, State};

/// Random states per system.
const STATES: usize = 20;

/// A state near the initial one.
fn near<D: Declared>(random: &mut Random) -> Vec<f64> {
    let initial = D::initial::<f64>();
    initial
        .as_slice()
        .iter()
        .map(|x| x + 0.5 * random.number())
        .collect()
}

/// All that every system has, on random states.
fn all<D: Declared>(fused: &D::System<f64>, nudge: f64) -> Errors {
    let mut random = Random(2018);
    let mut errors = Errors::new(nudge);
    let (reference, dual) = (D::declared::<f64>(), D::declared::<Dual<f64>>());
    for _ in 0..STATES {
        let mu = near::<D>(&mut random);
        kernels(fused, &reference, &dual, &mu, &mut random, &mut errors);
        let mu = state(fused, &mu);
        let h = 0.1 * random.number();
        equations(fused, &reference, &mu, h, &mut random, &mut errors);
    }
    errors
}

/// The Cayley equation on random states.
fn cayley<D: Declared>(fused: &D::System<f64>, nudge: f64) -> Errors
where
    D::System<f64>: CayleyPoisson<f64> + Implicit<f64, LieMidpoint<Cayley>>,
{
    let mut random = Random(2018);
    let mut errors = Errors::new(nudge);
    let reference = D::declared::<f64>();
    for _ in 0..STATES {
        let mu = state(fused, &near::<D>(&mut random));
        let h = 0.1 * random.number();
        cayley_equation(fused, &reference, &mu, h, &mut random, &mut errors);
    }
    errors
}

/// The triple product `out_b = <mu, (x e_b z + z e_b x)/2>` by products of matrices.
fn triple<D: Declared>(nudge: f64) -> Errors
where
    D::System<f64>: CayleyPoisson<f64>,
{
    let mut random = Random(2018);
    let mut errors = Errors::new(nudge);
    let system = D::declared::<f64>();
    let representation = Representation::of(D::FILE);
    let dimension = representation.basis.len();
    for _ in 0..STATES {
        let [x, z, mu] = [(); 3].map(|()| random.numbers(dimension));
        let mut out = system.zero_state();
        let [a, b, c] = [&x, &z, &mu].map(|coordinates| state(&system, coordinates));
        system.triple(&a, &b, &c, &mut out);
        let [x, z] =
            [&nudged(&x, &errors), &z].map(|coordinates| representation.element(coordinates));
        let mut expected = Vec::new();
        for e in &representation.basis {
            let product =
                |a: &[f64], b: &[f64]| representation.product(&representation.product(a, e), b);
            let (xez, zex) = (product(&x, &z), product(&z, &x));
            let half_sum: Vec<f64> = xez.iter().zip(&zex).map(|(a, b)| (a + b) / 2.0).collect();
            let coordinates = representation.coordinates(&half_sum);
            expected.push(coordinates.iter().zip(&mu).map(|(a, b)| a * b).sum::<f64>());
        }
        errors.compare("triple", out.as_slice(), &expected);
    }
    errors
}

fn check<D: Declared>(errors: &Errors) {
    let (largest, name) = errors.largest();
    println!("{}: largest error {largest:.1e} ({name})", D::FILE);
    assert_eq!(
        errors.beyond_round_off(),
        [""; 0],
        "{}: {largest:e} ({name})",
        D::FILE
    );
}

macro_rules! cayley_test {
    ($system:ident, cayley) => {
        #[test]
        fn cayley() {
            use super::*;
            super::check::<$system>(&super::cayley::<$system>(&$system::declared::<f64>(), 0.0));
            super::check::<$system>(&super::triple::<$system>(0.0));
        }
    };
    ($system:ident, exp) => {};
}

macro_rules! tests {
    ($file:ident, $system:ident, $cayley:ident) => {
        mod $file {
            #[test]
            fn fused_equals_generic() {
                use super::*;
                check::<$system>(&all::<$system>(&$system::declared::<f64>(), 0.0));
            }
            cayley_test!($system, $cayley);
        }
    };
}

each_system!(tests);
each_further_system!(tests);

/// States that differ by 1e-9 are noticed by every comparison.
#[test]
fn every_comparison_notices_another_state() {
    let system = NonpolynomialSpin::declared::<f64>();
    for errors in [
        all::<NonpolynomialSpin>(&system, 1e-9),
        cayley::<NonpolynomialSpin>(&system, 1e-9),
        triple::<NonpolynomialSpin>(1e-9),
    ] {
        let mut noticed = errors.beyond_round_off();
        noticed.sort_unstable();
        assert_eq!(noticed, errors.names());
    }
}

/// A kernel with one coefficient changed by 1e-9 is noticed.
#[test]
fn a_changed_coefficient_is_noticed() {
    let changed = HeavyTop {
        I1: 2.0 * (1.0 + 1e-9),
        ..HeavyTop::<f64>::default()
    };
    let changed = changed.system().expect("valid parameters");
    let errors = all::<HeavyTop>(&changed, 0.0);
    let noticed = errors.beyond_round_off();
    let of_the_algebra = [
        "ad",
        "ad_star",
        "ad_star_matrix",
        "coadjoint_action",
        "dexp_dual",
        "dexp_dual_slope",
        "poisson_matrix",
        "poisson_slope",
        "casimir_gradient",
        "bracket of a Casimir",
    ];
    for name in errors.names() {
        // the results of these are sums of the unknown
        let of_the_unknown = name.ends_with(", result")
            && (name.starts_with("gauss") || name.starts_with("midpoint"));
        let expected = !of_the_algebra.contains(&name) && !of_the_unknown;
        assert_eq!(noticed.contains(&name), expected, "{name}");
    }
    let errors = cayley::<HeavyTop>(&changed, 0.0);
    assert_eq!(errors.beyond_round_off().len(), errors.names().len());
}
