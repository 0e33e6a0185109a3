//! Splittings of the systems whose Hamiltonian is a sum of functions of one coordinate each: single
//! steps against reference values, generated against generic flows, what is kept, lanes.

use crate::common;

use crate::systems::{
    Declared, FreeRigidBody, HeavyTop, ManakovTop, Pendulum, Random, TodaLattice, distance, state,
};
use crate::vectors::steps;
use lie_runtime::diagnostics::{order_of_convergence, poisson_defect};
use lie_runtime::generic::CoordinateFlows;
use lie_runtime::methods::{
    Gauss6, Method, Scheme, Splitting1, Splitting2, Splitting4, Splitting6, Splitting8, Stepper,
};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::scalar::F64x8;
use lie_runtime::{Dual, PieceFlows, Poisson, Scalar, SeparablePoisson, State};

/// Round-off of a step of numbers near 1.
const STEP: f64 = 1e-15;

fn advance<S: Scalar, P: Poisson<S>>(
    system: &P,
    method: &impl Method<S, P>,
    h: S,
    count: u32,
    mu: &mut P::State,
) {
    let mut stepper = method.stepper(system, h, &NewtonOptions::default());
    for _ in 0..count {
        stepper.step(mu, &mut ()).expect("a step");
    }
}

fn reference_steps<D: Declared>()
where
    D::System<f64>: SeparablePoisson<f64>,
{
    fn error<D: Declared>(name: &str, method: &impl Method<f64, D::System<f64>>) -> f64 {
        let expected = steps(D::FILE, name);
        assert_eq!(expected.len(), 2, "{name} of {}", D::FILE);
        let system = D::declared::<f64>();
        let errors = expected.into_iter().map(|(h, expected)| {
            let mut mu = D::initial::<f64>();
            advance(&system, method, h, 1, &mut mu);
            distance(mu.as_slice(), &expected)
        });
        let error = errors.fold(0.0, f64::max);
        println!("{}: {name}: {error:.1e}", D::FILE);
        error
    }
    let suzuki = Splitting4::new().scheme(Scheme::Suzuki).coordinate();
    assert!(error::<D>("lie_trotter_coordinate", &Splitting1::new().coordinate()) < STEP);
    assert!(error::<D>("strang_coordinate", &Splitting2::new().coordinate()) < STEP);
    assert!(error::<D>("suzuki4_strang_coordinate", &suzuki) < STEP);
    // the bound is no formality: another splitting misses it
    assert!(error::<D>("strang_coordinate", &suzuki) > 1e-7);
}

/// Each flow over random times, and from random states, against the series; the generic form has a
/// piece for every coordinate. Returns the coordinates of the pieces.
fn fused_equals_generic<P: SeparablePoisson<f64>>(system: &P) -> Vec<usize> {
    let (mut fused, mut generic) = (system.flows(), CoordinateFlows::new(system));
    let coordinates = coordinates(system, &fused);
    let mut random = Random(2018);
    let mut largest = 0.0_f64;
    for _ in 0..50 {
        let mu = state(system, &random.numbers(system.dimension()));
        let t = 3.0 * random.number();
        for (piece, &coordinate) in coordinates.iter().enumerate() {
            let (mut one, mut other) = (mu.clone(), mu.clone());
            fused.flow(piece, t, &mut one);
            generic.flow(coordinate, t, &mut other);
            let size = other
                .as_slice()
                .iter()
                .fold(1.0, |size: f64, x| size.max(x.abs()));
            largest = largest.max(distance(one.as_slice(), other.as_slice()) / size);
            let [mut xi, mut eta] = [(); 2].map(|()| system.zero_state());
            fused.direction(piece, t, &mu, &mut xi);
            generic.direction(coordinate, t, &mu, &mut eta);
            assert_eq!(xi.as_slice(), eta.as_slice());
        }
        let last = coordinates.len().saturating_sub(1);
        if last > 0 {
            // sweeps: the flows one after the other
            let (mut one, mut other) = (mu.clone(), mu.clone());
            fused.ascend(t, 0.5 * t, &mut one);
            fused.descend(-t, 0.25 * t, &mut one);
            fused.flow(0, t, &mut other);
            (1..last).for_each(|piece| fused.flow(piece, 0.5 * t, &mut other));
            fused.flow(last, -t, &mut other);
            (1..last)
                .rev()
                .for_each(|piece| fused.flow(piece, 0.25 * t, &mut other));
            assert_eq!(one.as_slice(), other.as_slice());
        }
        // a step: pieces that do nothing only move the places where sweeps turn
        let (mut one, mut other) = (mu.clone(), mu.clone());
        advance(system, &Splitting2::new().coordinate(), 0.2, 1, &mut one);
        for (piece, h) in (0..system.dimension())
            .map(|piece| (piece, 0.1))
            .chain((0..system.dimension()).rev().map(|piece| (piece, 0.1)))
        {
            generic.flow(piece, h, &mut other);
        }
        largest = largest.max(distance(one.as_slice(), other.as_slice()));
    }
    println!("{}: flows differ by {largest:.1e}", system.name());
    assert!(largest < 3e-15, "{}: {largest:e}", system.name());
    coordinates
}

/// The coordinates of the pieces: those that a direction points along.
fn coordinates<P: Poisson<f64>>(
    system: &P,
    flows: &impl PieceFlows<f64, State = P::State>,
) -> Vec<usize> {
    let mu = state(system, &Random(7).numbers(system.dimension()));
    let pieces = (0..flows.pieces()).map(|piece| {
        let mut xi = system.zero_state();
        flows.direction(piece, 1.0, &mu, &mut xi);
        let along: Vec<usize> = (0..system.dimension())
            .filter(|&i| xi.as_slice()[i] != 0.0)
            .collect();
        assert_eq!(along.len(), 1, "{} {piece}", system.name());
        along[0]
    });
    pieces.collect()
}

fn order<D: Declared>(method: &impl Method<f64, D::System<f64>>, span: f64, counts: &[u32]) -> f64 {
    let system = D::declared::<f64>();
    let mut reference = D::initial::<f64>();
    advance(&system, &Gauss6, span / 1000.0, 1000, &mut reference);
    let points: Vec<(f64, f64)> = counts
        .iter()
        .map(|&count| {
            let h = span / f64::from(count);
            let mut mu = D::initial::<f64>();
            advance(&system, method, h, count, &mut mu);
            (h, distance(mu.as_slice(), reference.as_slice()))
        })
        .collect();
    let order = order_of_convergence(&points, 1e-13);
    order.unwrap_or_else(|| panic!("{points:?}")).slope
}

/// Casimirs over a long run, the Poisson structure of one step, and the lanes.
fn kept<D: Declared>()
where
    D::System<f64>: SeparablePoisson<f64>,
    D::System<Dual<f64>>: SeparablePoisson<Dual<f64>>,
    D::System<F64x8>: SeparablePoisson<F64x8>,
{
    let system = D::declared::<f64>();
    let casimirs = system.casimir_count();
    let mut mu = D::initial::<f64>();
    let (mut first, mut last) = (vec![0.0; casimirs], vec![0.0; casimirs]);
    system.casimirs(&mu, &mut first);
    advance(
        &system,
        &Splitting4::new().coordinate(),
        0.05,
        100_000,
        &mut mu,
    );
    system.casimirs(&mu, &mut last);
    let drift = distance(&last, &first);
    println!("{}: Casimirs move by {drift:.1e} in 10^5 steps", D::FILE);
    assert!(drift < 1e-12, "{}: {drift:e}", D::FILE);

    let dual = D::declared::<Dual<f64>>();
    let start: Vec<f64> = D::initial::<f64>().as_slice().to_vec();
    let newton = NewtonOptions::default();
    let defects = [
        poisson_defect(&dual, &Splitting1::new().coordinate(), 0.3, &start, &newton),
        poisson_defect(&dual, &Splitting2::new().coordinate(), 0.3, &start, &newton),
        poisson_defect(
            &dual,
            &Splitting4::new().coordinate(),
            -0.3,
            &start,
            &newton,
        ),
        poisson_defect(&dual, &Splitting6::new().coordinate(), 0.3, &start, &newton),
        poisson_defect(&dual, &Splitting8::new().coordinate(), 0.3, &start, &newton),
    ];
    let defects = defects.map(|defect| defect.expect("a step"));
    println!("{}: Poisson defects {defects:?}", D::FILE);
    assert!(defects.iter().all(|defect| *defect < 1e-14), "{defects:?}");

    let h = [0.1, -0.2, 0.5, 1e-9, 1.0, 0.25, -0.7, 0.01];
    let mut together = D::initial::<F64x8>();
    advance(
        &D::declared::<F64x8>(),
        &Splitting6::new().coordinate(),
        F64x8::new(h),
        5,
        &mut together,
    );
    for (lane, h) in h.into_iter().enumerate() {
        let mut alone = D::initial::<f64>();
        advance(&system, &Splitting6::new().coordinate(), h, 5, &mut alone);
        for (many, one) in together.as_slice().iter().zip(alone.as_slice()) {
            assert_eq!(many.lane(lane).to_bits(), one.to_bits(), "lane {lane}");
        }
    }
}

macro_rules! tests {
    ($($file:ident $system:ident),+) => {$(
        mod $file {
            #[test]
            fn reference_steps() {
                super::reference_steps::<super::$system>();
            }
            #[test]
            fn fused_equals_generic() {
                let system = <super::$system as super::Declared>::declared::<f64>();
                assert!(super::fused_equals_generic(&system).len() > 1);
            }
            #[test]
            fn kept() {
                super::kept::<super::$system>();
            }
        }
    )+};
}

tests!(
    e2_pendulum Pendulum,
    se3_heavy_top HeavyTop,
    so3_free_rigid_body FreeRigidBody,
    so4_manakov ManakovTop,
    toda3_solvable TodaLattice
);

/// What the systems of `specs/` do not have.
mod forms {
    use super::fused_equals_generic;
    use lie_runtime::prelude::*;

    lie_poisson! {
        system Scaled;
        algebra { basis e1, e2, e3; [e1, e2] = k*e3; [e2, e3] = k*e1; [e3, e1] = k*e2; }
        state x, y, z;
        parameters { exact k = 3/7; }
        hamiltonian = x^2/2 + sin(y) + z^4/4;
        methods = [splitting2];
    }

    // rotations, boosts or shears, as k is positive, negative or zero
    lie_poisson! {
        system Indefinite;
        algebra { basis J, P, Q; [J, P] = Q; [J, Q] = -k*P; }
        state j, p, q;
        parameters { exact k = 1/2; }
        hamiltonian = j^2/2 + p^3/3 - q;
        methods = [splitting4];
    }

    // a boost of which the frequency is no rational number
    lie_poisson! {
        system Boost;
        algebra { basis B, P, Q; [B, P] = Q; [B, Q] = 2*P; }
        state b, p, q;
        hamiltonian = b^2/2 + b + cos(q);
        methods = [splitting2];
    }

    // d acts with an eigenvalue and a shear, with a projection, and by stretches
    lie_poisson! {
        system Solvable;
        algebra {
            basis d, a, b, p, q, r, s, f;
            [d, a] = a + b; [d, b] = b; [f, p] = 2*p + q; [f, r] = r; [f, s] = -3*s;
        }
        state D, A, B, P, Q, R, S, F;
        hamiltonian = D^2/4 + A^3/3 + exp(P) - R*2 + F^2/2 + S;
        methods = [splitting2];
    }

    // three powers before the shear vanishes
    lie_poisson! {
        system Filiform;
        algebra { basis a, b, c, d, e; [a, b] = 2*c; [a, c] = d/3; [a, d] = 5*e; }
        state A, B, C, D, E;
        hamiltonian = A^2/2 + B^2/2 + sqrt(2 + D^2) + E;
        methods = [splitting8];
    }

    // mixed terms that cancel
    lie_poisson! {
        system Expanded;
        algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
        state x, y, z;
        hamiltonian = (x + y)^3 - 3*x*y*(x + y) + log(exp(x)*exp(2*z));
        methods = [splitting2];
    }

    lie_poisson! {
        system OnePiece;
        algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
        state x, y, z;
        hamiltonian = tan(y);
        methods = [splitting6];
    }

    lie_poisson! {
        system NoPiece;
        algebra { basis e1, e2, e3; [e1, e2] = e3; }
        state x, y, z;
        hamiltonian = z^2;
        methods = [splitting1];
    }

    #[test]
    fn every_closed_form_is_the_series() {
        macro_rules! check {
            ($system:ident, $pieces:expr) => {
                let system = $system::new().system().expect("valid");
                assert_eq!(fused_equals_generic(&system), $pieces);
            };
        }
        check!(Scaled, [0, 1, 2]);
        check!(Indefinite, [0, 1, 2]);
        check!(Boost, [0, 2]);
        check!(Solvable, [0, 1, 3, 5, 6, 7]);
        check!(Filiform, [0, 1, 3]);
        check!(Expanded, [0, 1, 2]);
        check!(OnePiece, [1]);
        check!(NoPiece, [0; 0]);
    }

    /// Where the form depends on a parameter, the series serves every value of it.
    #[test]
    fn any_value_of_an_exact_parameter() {
        for k in [-2.0, -1e-9, 0.0, 1e-9, 3.0] {
            let mut indefinite = Indefinite::new();
            indefinite.k = k;
            fused_equals_generic(&indefinite.system().expect("valid"));
            let mut scaled = Scaled::new();
            scaled.k = k;
            fused_equals_generic(&scaled.system().expect("valid"));
        }
    }
}

#[test]
fn orders_up_to_eight() {
    let check = |measured: f64, order: f64| {
        println!("order {order}: {measured:.2}");
        assert!((measured - order).abs() < 0.06 * order, "{measured}");
    };
    check(
        order::<HeavyTop>(&Splitting1::new().coordinate(), 1.0, &[256, 512, 1024]),
        1.0,
    );
    check(
        order::<HeavyTop>(&Splitting2::new().coordinate(), 2.0, &[32, 64, 128]),
        2.0,
    );
    check(
        order::<HeavyTop>(&Splitting4::new().coordinate(), 2.0, &[16, 24, 32, 48]),
        4.0,
    );
    check(
        order::<HeavyTop>(&Splitting6::new().coordinate(), 4.0, &[20, 24, 32, 40]),
        6.0,
    );
    check(
        order::<HeavyTop>(&Splitting8::new().coordinate(), 8.0, &[28, 32, 36, 40]),
        8.0,
    );
    check(
        order::<ManakovTop>(&Splitting8::new().coordinate(), 8.0, &[14, 16, 18, 20]),
        8.0,
    );
}

/// The refusal names what H mixes, and a Poisson map that applies, at the place of the method.
#[test]
fn other_hamiltonians_are_refused() {
    for (method, nearest) in [
        ("splitting2", "`lie-midpoint`"),
        ("splitting6", "`compose6(lie-midpoint)`"),
    ] {
        let run = common::lie(&format!(
            "run specs/sl2_quadratic.json --method {method} --pieces coordinate"
        ));
        let run = run.error("splitting", "command line: --method");
        assert!(
            run.stderr.contains("it mixes `h` and `e`"),
            "{}",
            run.stderr
        );
        assert!(run.stderr.contains(nearest), "{}", run.stderr);
    }
    let run = common::lie("run specs/se3_heavy_top.json --method splitting4 --pieces other");
    let run = run.error("option", "command line: --pieces");
    assert!(
        run.stderr.contains("`found`, `coordinate`"),
        "{}",
        run.stderr
    );
}
