//! Splittings by the pieces that are left when H is freed of Casimirs: against the same Hamiltonian written out by
//! hand, their order, what they keep, what they refuse.

use crate::common;

use crate::advance::{advance, order};
use crate::attitude::{Q10, Y0};
use crate::systems::{distance, state};
use lie_runtime::diagnostics::poisson_defect;
use lie_runtime::driver::{Chart, Reconstruction};
use lie_runtime::methods::{Method, Splitting1};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;
use lie_runtime::{Dual, FoundPoisson, MatrixGroup, PieceFlows, Poisson, Scalar, SeparablePoisson};

lie_poisson! {
    system Body;
    algebra = so(3);
    state x, y, z;
    parameters { I1 = 1; I2 = 2; I3 = 3; }
    hamiltonian = x^2/(2*I1) + y^2/(2*I2) + z^2/(2*I3);
    casimir norm2 = x^2 + y^2 + z^2;
    methods = [splitting2];
}

// the same flow, by hand
lie_poisson! {
    system Shifted;
    algebra = so(3);
    state x, y, z;
    parameters { I1 = 1; I2 = 2; I3 = 3; }
    hamiltonian = x^2/2*(1/I1 - 1/I2) + z^2/2*(1/I3 - 1/I2);
    methods = [splitting2];
}

// a rigid body in a field whose H mixes coordinates: x p + y q + z r is a Casimir, which the compiler finds
lie_poisson! {
    system Screw;
    algebra = se(3);
    state x, y, z, p, q, r;
    parameters { k = 0.3; }
    hamiltonian = x^2/2 + y^2/3 + z^2/5 + cos(r) + k*(x*p + y*q + z*r);
    methods = [splitting2];
}

#[test]
fn a_rigid_body_has_two_pieces_and_the_flow_written_by_hand() {
    let body = Body::new().system().expect("valid");
    let shifted = Shifted::new().system().expect("valid");
    assert_eq!((body.flows().pieces(), body.found().pieces()), (3, 2));
    assert_eq!(shifted.found().pieces(), 2);
    let start = [0.8, -0.5, 1.1];
    let mut differences = [0.0_f64; 2];
    for h in [0.3, -0.2, 1.0] {
        let [mut one, mut other, mut declared] = [(); 3].map(|()| state(&body, &start));
        advance(&body, &Splitting4::new(), h, 5, &mut one);
        advance(&shifted, &Splitting4::new(), h, 5, &mut other);
        advance(&body, &Splitting4::new().coordinate(), h, 5, &mut declared);
        differences[0] = Scalar::max(differences[0], distance(one.as_slice(), other.as_slice()));
        differences[1] = Scalar::max(
            differences[1],
            distance(one.as_slice(), declared.as_slice()),
        );
    }
    println!(
        "by hand {:.1e}, other pieces {:.1e}",
        differences[0], differences[1]
    );
    assert!(differences[0] < 2e-14, "{differences:?}");
    // another map than that of the declared pieces
    assert!(differences[1] > 1e-6, "{differences:?}");
}

/// Whichever parameters: the multiple of the Casimir is a constant of the system.
#[test]
fn other_parameters_give_the_same_as_by_hand() {
    for (i1, i2, i3) in [(3.0, 1.0, 2.0), (1.0, 1.0, 4.0), (0.2, 7.0, 7.0)] {
        let (mut body, mut shifted) = (Body::new(), Shifted::new());
        (body.I1, body.I2, body.I3) = (i1, i2, i3);
        (shifted.I1, shifted.I2, shifted.I3) = (i1, i2, i3);
        let (body, shifted) = (
            body.system().expect("valid"),
            shifted.system().expect("valid"),
        );
        let [mut one, mut other] = [(); 2].map(|()| state(&body, &[0.8, -0.5, 1.1]));
        advance(&body, &Splitting2::new(), 0.1, 10, &mut one);
        advance(&shifted, &Splitting2::new(), 0.1, 10, &mut other);
        let difference = distance(one.as_slice(), other.as_slice());
        assert!(difference < 2e-14, "{difference:e}");
    }
}

#[test]
fn orders() {
    let body = Body::new().system().expect("valid");
    let screw = Screw::new().system().expect("valid");
    let start = [0.8, -0.5, 1.1, 0.3, 0.9, -0.4];
    let over = (2.0, [32, 64, 128]);
    let close = |measured: f64, order: f64| {
        assert!(
            (measured - order).abs() < 0.1 * order,
            "{measured} for {order}"
        );
    };
    close(order(&body, &Splitting2::new(), &start[..3], over), 2.0);
    close(order(&body, &Splitting1::new(), &start[..3], over), 1.0);
    close(order(&screw, &Splitting2::new(), &start, over), 2.0);
}

/// Of a Hamiltonian that mixes all six x, y, z and r are left; x^2 + y^2 + z^2 commutes with x, and z with r.
#[test]
fn terms_that_are_a_casimir_are_no_piece() {
    let screw = Screw::new().system().expect("valid");
    assert_eq!(screw.found().pieces(), 2);
}

/// All of H moves the group element: the directions of the pieces and the rest are its gradient, and the rest leaves
/// mu where it is.
#[test]
fn directions_and_rest_are_the_gradient() {
    let body = Body::new().system().expect("valid");
    let mu = state(&body, &[0.8, -0.5, 1.1]);
    let found = body.found();
    let [mut gradient, mut xi, mut sum] = [(); 3].map(|()| body.zero_state());
    body.gradient(&mu, &mut gradient);
    assert!(found.rest(0.5, &mu, &mut sum));
    let cross = sum.cross(&mu);
    assert!(cross.amax() < 1e-15 && sum.amax() > 0.1, "{cross} {sum}");
    for piece in 0..found.pieces() {
        found.direction(piece, 0.5, &mu, &mut xi);
        sum += xi;
    }
    assert!((sum - gradient * 0.5).amax() < 1e-15, "{sum} {gradient}");
}

#[test]
fn casimir_structure_and_energy_are_kept() {
    let body = Body::new().system().expect("valid");
    let mut mu = state(&body, &[0.8, -0.5, 1.1]);
    let (norm, energy) = (mu.norm_squared(), body.hamiltonian(&mu));
    let mut worst = [0.0_f64; 2];
    for half in &mut worst {
        for _ in 0..20_000 {
            advance(&body, &Splitting2::new(), 0.05, 1, &mut mu);
            *half = Scalar::max(*half, (body.hamiltonian(&mu) - energy).abs());
        }
    }
    println!("energy {worst:?}, Casimir {:.1e}", mu.norm_squared() - norm);
    assert!((mu.norm_squared() - norm).abs() < 1e-12);
    assert!(worst[1] < 1.01 * worst[0] && worst[0] < 1e-3, "{worst:?}");

    let dual = Body::<Dual<f64>>::default().system().expect("valid");
    let newton = NewtonOptions::default();
    let defect = poisson_defect(&dual, &Splitting2::new(), 0.3, &[0.8, -0.5, 1.1], &newton);
    assert!(defect.expect("a step") < 1e-14);
}

#[test]
fn what_no_casimir_splits_is_refused() {
    let run = common::lie("run specs/so3_nonpolynomial.json --method splitting2");
    let run = run.error("splitting", "command line: --method");
    assert!(
        run.stderr.contains("no combination of quadratic Casimirs"),
        "{}",
        run.stderr
    );
    assert!(run.stderr.contains("`lie-midpoint`"), "{}", run.stderr);
}

// the body of Hairer and Vilmart, whose attitude is published
lie_poisson! {
    system Published;
    algebra = so(3);
    state y1, y2, y3;
    hamiltonian = y1^2/(2*3/5) + y2^2/(2*4/5) + y3^2/2;
    methods = [splitting2];
}

// the same motion of the momentum, and another of the attitude
lie_poisson! {
    system Freed;
    algebra = so(3);
    state y1, y2, y3;
    hamiltonian = y1^2/(2*3/5) + y2^2/(2*4/5) + y3^2/2 - 5/8*(y1^2 + y2^2 + y3^2);
    methods = [splitting2];
}

/// Attitude and momentum at t = 10 from those of the publication.
fn attitude<P, M>(system: &P, method: M, h: f64, chart: Chart) -> (Vec<f64>, Vec<f64>)
where
    P: MatrixGroup<f64> + Clone,
    M: Method<f64, P>,
{
    attitude_from(&Y0, system, method, h, chart)
}

fn attitude_from<P, M>(
    start: &[f64],
    system: &P,
    method: M,
    h: f64,
    chart: Chart,
) -> (Vec<f64>, Vec<f64>)
where
    P: MatrixGroup<f64> + Clone,
    M: Method<f64, P>,
{
    let start = state(system, start);
    let mut attitude = Reconstruction::new(system, chart);
    let problem = Problem::new(system.clone(), start, (0.0, 10.0));
    let options = Options::new(h).save(Save::Ends);
    let solution = solve_observed(&problem, method, &options, &mut attitude)
        .ok()
        .expect("a run");
    let end = solution.last().expect("rows").1.as_slice().to_vec();
    (attitude.element().to_vec(), end)
}

#[test]
fn the_group_element_moves_with_all_of_h() {
    let body = Published::new().system().expect("valid");
    let freed = Freed::new().system().expect("valid");
    assert_eq!((body.found().pieces(), freed.found().pieces()), (2, 2));
    let error = |h: f64, fourth: bool| {
        let (q, _) = if fourth {
            attitude(&body, Splitting4::new(), h, Chart::Quaternion)
        } else {
            attitude(&body, Splitting2::new(), h, Chart::Quaternion)
        };
        distance(&q, &Q10)
    };
    for (order, fourth, h) in [(2.0, false, 0.05), (4.0, true, 0.1)] {
        let (coarse, fine) = (error(h, fourth), error(h / 2.0, fourth));
        let slope = (coarse / fine).log2();
        println!("order {order}: {coarse:.1e} {fine:.1e}, slope {slope:.2}");
        assert!((slope - order).abs() < 0.2, "{slope} for {order}");
    }
    assert!(error(0.01, true) < 1e-9);
    // the spatial momentum G mu does not move
    let (g, mu) = attitude(&body, Splitting2::new(), 0.1, Chart::Matrix);
    let momentum: Vec<f64> = (0..3)
        .map(|i| (0..3).map(|j| g[3 * i + j] * mu[j]).sum())
        .collect();
    assert!(distance(&momentum, &Y0) < 5e-14, "{momentum:?}");
    // without what the Casimir adds the momentum is the same and the attitude another
    let h = 0.01;
    let (q, mu) = attitude(&freed, Splitting4::new(), h, Chart::Quaternion);
    let (_, other) = attitude(&body, Splitting4::new(), h, Chart::Quaternion);
    assert!(distance(&mu, &other) < 1e-12);
    assert!(distance(&q, &Q10) > 0.1, "{q:?}");
}

// pieces with Casimirs, of the algebra and of a subalgebra, as arguments: their gradients move along their flows
lie_poisson! {
    system Weighted;
    algebra = so(3);
    state y1, y2, y3;
    hamiltonian = (y1^2 + y2^2 + y3^2)*y3/8 + sqrt(1 + y1^2 + y2^2 + y3^2)*y1^2/6;
    methods = [splitting4];
}

lie_poisson! {
    system Top;
    algebra = se(3);
    state a, b, c, p, q, r;
    hamiltonian = (a^2 + b^2)/3 + c^2/5 + r/2 + p/5;
    methods = [splitting4];
}

/// The order of the motion on the group, beside a composition of another method.
macro_rules! group_order {
    ($system:expr, $start:expr, $pieces:literal) => {{
        let system = $system.system().expect("valid");
        assert_eq!(system.found().pieces(), $pieces);
        let fine = Compose8::new(LieMidpoint::exp());
        let (exact, _) = attitude_from(&$start, &system, fine, 0.02, Chart::Matrix);
        let error = |h: f64| {
            let (g, _) = attitude_from(&$start, &system, Splitting4::new(), h, Chart::Matrix);
            distance(&g, &exact)
        };
        let (coarse, fine) = (error(0.1), error(0.05));
        let slope = (coarse / fine).log2();
        println!("{coarse:.1e} {fine:.1e}, slope {slope:.2}");
        assert!(
            (slope - 4.0).abs() < 0.3 && fine < 1e-4,
            "{slope}, {fine:e}"
        );
    }};
}

#[test]
fn the_group_element_follows_gradients_that_move() {
    group_order!(Weighted::new(), [0.9, -0.5, 0.7], 2);
    group_order!(Top::new(), [0.9, -0.5, 0.7, 0.3, 0.2, -0.8], 2);
}

#[test]
fn the_report_names_the_pieces() {
    let check = |path: &str| -> serde_json::Value {
        let run = common::lie(&format!("check {path} --json")).ok();
        serde_json::from_str(&run.stdout).expect("JSON")
    };
    let body = check("specs/so3_free_rigid_body.json");
    assert_eq!(body["splitting"].as_array().map(Vec::len), Some(2));
    println!("{}", body["splitting"]);
    let text = common::lie("check specs/so3_free_rigid_body.json")
        .ok()
        .stdout;
    let says = "  splitting: H is 2 pieces with exact flows, and a combination of Casimirs\n";
    assert!(text.contains(says), "{text}");
    assert!(check("specs/so3_nonpolynomial.json")["splitting"].is_null());
    let text = common::lie("check specs/so3_nonpolynomial.json")
        .ok()
        .stdout;
    assert!(text.contains("  splitting: none: no pieces"), "{text}");
}
