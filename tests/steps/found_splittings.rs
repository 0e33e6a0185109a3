//! Splittings into the fewest pieces that were found: coordinates that commute, squares of linear forms, Casimirs of the
//! algebra and of subalgebras as arguments. Each flow is that
//! of its piece, the pieces are all of H, and the methods over them do what they claim.

use crate::common;

use crate::advance::{advance, order};
use crate::systems::{
    Declared, HeavyTop, KirchhoffBody, ManakovTop, Random, Satellite, Sl2Quadratic, distance, state,
};
use lie_runtime::diagnostics::poisson_defect;
use lie_runtime::generic;
use lie_runtime::methods::{Method, Splitting1};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;
use lie_runtime::{Dual, FoundPoisson, LiePoisson, PieceFlows, Poisson, Scalar};

// a rigid body whose inertia is given in other axes
lie_poisson! {
    system Tilted;
    algebra = so(3);
    state x, y, z;
    hamiltonian = x^2 + 3*y^2/4 + 5*z^2/8 + x*y/3 - y*z/5 + x*z/2 + z/7;
    methods = [splitting2];
}

// the same with an inverse inertia matrix of parameters
lie_poisson! {
    system Loaded;
    algebra = so(3);
    state x, y, z;
    parameters { a11 = 1.1; a22 = 0.8; a33 = 0.6; a12 = 0.2; a13 = -0.1; a23 = 0.15; }
    hamiltonian = (a11*x^2 + a22*y^2 + a33*z^2)/2 + a12*x*y + a13*x*z + a23*y*z;
    methods = [splitting2];
}

// only products of coordinates that do not commute: no square to begin with
lie_poisson! {
    system Mixed;
    algebra = so(3);
    state x, y, z;
    hamiltonian = x*y + y*z/2 - x*z/3;
    methods = [splitting2];
}

// an anisotropic ring of four spins in a field
lie_poisson! {
    system Ring;
    algebra = so(3) + so(3) + so(3) + so(3);
    state x1, y1, z1, x2, y2, z2, x3, y3, z3, x4, y4, z4;
    parameters { Jx = 1; Jy = 0.7; Jz = 0.4; field = 0.3; }
    hamiltonian = Jx*(x1*x2 + x2*x3 + x3*x4 + x4*x1) + Jy*(y1*y2 + y2*y3 + y3*y4 + y4*y1)
        + Jz*(z1*z2 + z2*z3 + z3*z4 + z4*z1) + field*(z1 + z2 + z3 + z4) + z1^2/5;
    methods = [splitting2];
}

// a body in a fluid with full matrices, and a constant spin that the coordinates do not commute with
lie_poisson! {
    system Swimmer;
    algebra = se(3);
    state a, b, c, p, q, r;
    hamiltonian = a^2/2 + b^2/3 + c^2/4 + a*b/5 - b*c/7 + a*p/4 + b*r/6 - c*q/8
        + p^2/5 + q^2/2 + 2*r^2/3 + p*q/9 + sin(p - r) + b/3;
    methods = [splitting2];
}

// H is linear, in elements that do not commute
lie_poisson! {
    system Uniform;
    algebra = so(3);
    state x, y, z;
    parameters { w1 = 0.3; w2 = -0.4; w3 = 1.2; }
    hamiltonian = w1*x + w2*y + w3*z;
    methods = [splitting2];
}

// Casimirs as factors and in functions
lie_poisson! {
    system Factors;
    algebra = so(3);
    state x, y, z;
    parameters { k = 0.4; }
    hamiltonian = k*(x^2 + y^2 + z^2)*z + cos(x^2 + y^2 + z^2)*x^2/3 + sin(y);
    casimir size = x^2 + y^2 + z^2;
    methods = [splitting2];
}

// a coordinate times the length of the other vector, and a Casimir that is found
lie_poisson! {
    system Length;
    algebra = se(3);
    state a, b, c, p, q, r;
    hamiltonian = sqrt(1 + p^2 + q^2 + r^2)*c + exp(a*p + b*q + c*r)*r/4 + a^2/2;
    methods = [splitting2];
}

// the tops of Lagrange and of Kovalevskaya, and one with a function of the size of m
lie_poisson! {
    system Lagrange;
    algebra = se(3);
    state a, b, c, p, q, r;
    parameters { I = 0.8; K = 1.3; g = 0.7; }
    hamiltonian = (a^2 + b^2)/(2*I) + c^2/(2*K) + g*r;
    methods = [splitting2];
}
lie_poisson! {
    system Kovalevskaya;
    algebra = se(3);
    state a, b, c, p, q, r;
    hamiltonian = (a^2 + b^2)/2 + c^2 + p;
    methods = [splitting2];
}
lie_poisson! {
    system Relativistic;
    algebra = se(3);
    state a, b, c, p, q, r;
    hamiltonian = sqrt(1 + a^2 + b^2 + c^2) + cos(q + r/2);
    methods = [splitting2];
}
lie_poisson! {
    system Declared3;
    algebra = so(3);
    state x, y, z;
    hamiltonian = cos(x) + y^4 + z^3/3;
    methods = [splitting2];
}
// that of Lagrange without code of its own for splittings
lie_poisson! {
    system Plain;
    algebra = se(3);
    state a, b, c, p, q, r;
    parameters { I = 0.8; K = 1.3; g = 0.7; }
    hamiltonian = (a^2 + b^2)/(2*I) + c^2/(2*K) + g*r;
}

/// The largest entry; not a number if one is not.
fn size(numbers: &[f64]) -> f64 {
    numbers
        .iter()
        .fold(0.0, |size, x| Scalar::max(size, x.abs()))
}

/// The motion in the field `ad*_(xi(mu)) mu` over a time t, by the classical Runge–Kutta method.
fn reference<P: LiePoisson<f64>>(
    system: &P,
    xi: &dyn Fn(&P::State, &mut P::State),
    t: f64,
    mu: &P::State,
) -> P::State {
    const STEPS: u32 = 2000;
    let h = t / f64::from(STEPS);
    let field = |mu: &P::State| {
        let [mut direction, mut out] = [(); 2].map(|()| system.zero_state());
        xi(mu, &mut direction);
        system.ad_star(&direction, mu, &mut out);
        out
    };
    let moved = |mu: &P::State, field: &P::State, t: f64| {
        let mut out = mu.clone();
        for (x, v) in out.as_mut_slice().iter_mut().zip(field.as_slice()) {
            *x += t * v;
        }
        out
    };
    let mut mu = mu.clone();
    for _ in 0..STEPS {
        let one = field(&mu);
        let two = field(&moved(&mu, &one, h / 2.0));
        let three = field(&moved(&mu, &two, h / 2.0));
        let four = field(&moved(&mu, &three, h));
        for (v, weight) in [(one, 1.0), (two, 2.0), (three, 2.0), (four, 1.0)] {
            mu = moved(&mu, &v, h * weight / 6.0);
        }
    }
    mu
}

/// Each flow is that of its piece, and the pieces are all of H but what generates no flow. Returns how many there are.
fn flows_are_exact<P: FoundPoisson<f64> + LiePoisson<f64>>(system: &P) -> usize {
    let mut flows = system.found();
    let mut random = Random(2018);
    let mut worst = [0.0_f64; 3];
    let mut control = f64::INFINITY;
    for _ in 0..3 {
        let mu = state(system, &random.numbers(system.dimension()));
        let [mut xi, mut sum, mut gradient, mut out] = [(); 4].map(|()| system.zero_state());
        for piece in 0..flows.pieces() {
            let t = 0.4 + random.number().abs();
            let mut flowed = mu.clone();
            flows.flow(piece, t, &mut flowed);
            // the same part by part, and the exponentials of the elements of the parts
            let mut elements = Vec::new();
            let mut followed = mu.clone();
            flows.follow(piece, t, &mut followed, &mut xi, &mut |xi| {
                elements.push(xi.clone());
            });
            assert_eq!(followed.as_slice(), flowed.as_slice());
            let mut product = mu.clone();
            for xi in &elements {
                let before = product.clone();
                generic::coadjoint_action(system, xi, &before, &mut product);
            }
            worst[0] = Scalar::max(worst[0], distance(flowed.as_slice(), product.as_slice()));
            // a fine reference of the field of the piece, in which the direction moves as it may
            let direction = |mu: &P::State, xi: &mut P::State| flows.direction(piece, 1.0, mu, xi);
            let exact = reference(system, &direction, t, &mu);
            worst[1] = Scalar::max(worst[1], distance(flowed.as_slice(), exact.as_slice()));
            // the control: 1% more of the direction is seen
            let more = |mu: &P::State, xi: &mut P::State| flows.direction(piece, 1.01, mu, xi);
            let other = reference(system, &more, t, &mu);
            control = control.min(distance(flowed.as_slice(), other.as_slice()));
            flows.direction(piece, 1.0, &mu, &mut xi);
            for (sum, entry) in sum.as_mut_slice().iter_mut().zip(xi.as_slice()) {
                *sum += entry;
            }
        }
        system.gradient(&mu, &mut gradient);
        let all: Vec<f64> = gradient
            .as_slice()
            .iter()
            .zip(sum.as_slice())
            .map(|(g, s)| g - s)
            .collect();
        if flows.rest(1.0, &mu, &mut xi) {
            worst[2] = Scalar::max(worst[2], distance(&all, xi.as_slice()));
            system.ad_star(&xi, &mu, &mut out);
            worst[2] = Scalar::max(worst[2], size(out.as_slice()));
        } else {
            worst[2] = Scalar::max(worst[2], size(&all));
        }
    }
    let name = system.name();
    println!(
        "{name}: exponential {:.1e}, reference {:.1e}, rest {:.1e}, control {control:.1e}",
        worst[0], worst[1], worst[2]
    );
    assert!(worst[0] < 3e-14, "{name}: exponential {:e}", worst[0]);
    assert!(
        worst[1] < 1e-11 && control > 1e-5,
        "{name}: {:e}, control {control:e}",
        worst[1]
    );
    assert!(worst[2] < 1e-14, "{name}: rest {:e}", worst[2]);
    flows.pieces()
}

/// Orders, Casimirs and the energy.
fn methods_keep_what_they_claim<P: FoundPoisson<f64> + LiePoisson<f64>>(system: &P)
where
    Gauss6: Method<f64, P>,
{
    let mut random = Random(7);
    let start = random.numbers(system.dimension());
    let name = system.name();
    let over = (1.0, [16, 32, 64]);
    let first = order(system, &Splitting1::new(), &start, over);
    let second = order(system, &Splitting2::new(), &start, over);
    let fourth = order(system, &Splitting4::new(), &start, over);
    println!("{name}: orders {first:.2}, {second:.2}, {fourth:.2}");
    for (measured, order) in [(first, 1.0), (second, 2.0), (fourth, 4.0)] {
        assert!(
            (measured - order).abs() < 0.25,
            "{name}: {measured} for {order}"
        );
    }
    let mut mu = state(system, &start);
    let mut before = vec![0.0; system.casimir_count()];
    let mut after = before.clone();
    system.casimirs(&mu, &mut before);
    let energy = system.hamiltonian(&mu);
    let mut worst = [0.0_f64; 2];
    for half in &mut worst {
        for _ in 0..2000 {
            advance(system, &Splitting2::new(), 0.05, 1, &mut mu);
            *half = Scalar::max(*half, (system.hamiltonian(&mu) - energy).abs());
        }
    }
    system.casimirs(&mu, &mut after);
    let drift = distance(&before, &after);
    println!(
        "{name}: Casimirs {drift:.1e}, energy {:.1e} {:.1e}",
        worst[0], worst[1]
    );
    assert!(drift < 1e-12, "{name}: Casimirs {drift:e}");
    assert!(worst[1] < 1.5 * worst[0], "{name}: {worst:?}");
}

/// The Poisson defect of a step, beside that of a method that is no Poisson map.
macro_rules! defect {
    ($system:expr, $dual:expr) => {{
        let (system, newton) = ($system, NewtonOptions::default());
        let start = Random(3).numbers(system.dimension());
        let dual = $dual;
        let splitting = Splitting2::new();
        let kept = poisson_defect(&dual, &splitting, 0.3, &start, &newton).expect("a step");
        let lost = poisson_defect(&dual, &Rk4, 0.3, &start, &newton).expect("a step");
        println!(
            "{}: Poisson defect {kept:.1e}, of rk4 {lost:.1e}",
            system.name()
        );
        assert!(kept < 1e-14 && lost > 1e-9, "{kept:e} {lost:e}");
    }};
}

macro_rules! system_holds {
    ($name:ident, $pieces:literal) => {{
        let system = $name::new().system().expect("valid");
        assert_eq!(flows_are_exact(&system), $pieces);
        methods_keep_what_they_claim(&system);
        defect!(
            &system,
            $name::<Dual<f64>>::default().system().expect("valid")
        );
    }};
}

macro_rules! spec_holds {
    ($name:ident, $pieces:literal) => {{
        let system = $name::declared::<f64>();
        assert_eq!(flows_are_exact(&system), $pieces);
        methods_keep_what_they_claim(&system);
        defect!(&system, $name::declared::<Dual<f64>>());
    }};
}

#[test]
fn a_rigid_body_with_any_inertia_matrix() {
    system_holds!(Tilted, 3);
    system_holds!(Loaded, 3);
    system_holds!(Mixed, 3);
}

/// The multiples and forms are functions of the parameters.
#[test]
fn other_parameters() {
    let mut body = Loaded::new();
    (body.a11, body.a22, body.a12, body.a13, body.a23) = (0.9, 1.3, -0.3, 0.25, 0.4);
    let body = body.system().expect("valid");
    assert_eq!(flows_are_exact(&body), 3);
    let mut ring = Ring::new();
    (ring.Jx, ring.Jy, ring.field) = (0.4, -0.7, 0.0);
    assert_eq!(flows_are_exact(&ring.system().expect("valid")), 3);
}

#[test]
fn a_heavy_top() {
    spec_holds!(HeavyTop, 3);
}

#[test]
fn a_body_in_a_fluid() {
    spec_holds!(KirchhoffBody, 3);
    system_holds!(Swimmer, 4);
}

#[test]
fn a_ring_of_spins() {
    system_holds!(Ring, 3);
}

#[test]
fn a_body_in_four_dimensions() {
    spec_holds!(ManakovTop, 3);
}

#[test]
fn a_satellite_and_a_noncompact_body() {
    spec_holds!(Satellite, 3);
    spec_holds!(Sl2Quadratic, 3);
}

#[test]
fn a_linear_hamiltonian_is_one_piece() {
    let system = Uniform::new().system().expect("valid");
    assert_eq!(flows_are_exact(&system), 1);
    // its flow is exact: a step of any length
    let start = [0.3, -1.1, 0.7];
    let [mut one, mut many] = [(); 2].map(|()| state(&system, &start));
    advance(&system, &Splitting2::new(), 20.0, 1, &mut one);
    advance(&system, &Gauss6, 0.01, 2000, &mut many);
    let error = distance(one.as_slice(), many.as_slice());
    assert!(error < 1e-11, "{error:e}");
}

#[test]
fn casimirs_are_factors() {
    system_holds!(Factors, 3);
    system_holds!(Length, 2);
}

#[test]
fn casimirs_of_subalgebras_have_flows() {
    system_holds!(Lagrange, 2);
    system_holds!(Kovalevskaya, 2);
    system_holds!(Relativistic, 2);
}

/// Whether a declaration asks for code of its own changes no piece and no order of them.
#[test]
fn without_code_of_their_own_the_steps_are_the_same() {
    let (fused, plain) = (
        Lagrange::new().system().expect("valid"),
        Plain::new().system().expect("valid"),
    );
    let start = Random(11).numbers(6);
    let [mut one, mut other] = [(); 2].map(|()| state(&fused, &start));
    let mut control = one;
    advance(&fused, &Splitting4::new(), 0.1, 20, &mut one);
    advance(&plain, &Splitting4::new(), 0.1, 20, &mut other);
    advance(
        &fused,
        &Splitting4::new().coordinate(),
        0.1,
        20,
        &mut control,
    );
    let difference = distance(one.as_slice(), other.as_slice());
    assert!(difference < 1e-13, "{difference:e}");
    assert!(distance(one.as_slice(), control.as_slice()) > 1e-8);
}

/// Where what is declared has the fewest pieces, the default is that, bit for bit.
#[test]
fn declared_pieces_are_the_default_where_nothing_is_gained() {
    let system = Declared3::new().system().expect("valid");
    let start = Random(5).numbers(3);
    let [mut one, mut other] = [(); 2].map(|()| state(&system, &start));
    advance(&system, &Splitting4::new(), 0.1, 50, &mut one);
    advance(
        &system,
        &Splitting4::new().coordinate(),
        0.1,
        50,
        &mut other,
    );
    assert_eq!(one.as_slice(), other.as_slice());
    assert_ne!(one.as_slice(), &start[..]);
}

fn splitting(path: &str) -> serde_json::Value {
    let run = common::lie(&format!("check {path} --json")).ok();
    let report: serde_json::Value = serde_json::from_str(&run.stdout).expect("JSON");
    report["splitting"].clone()
}

#[test]
fn pieces_are_reported_and_taken() {
    for (name, pieces) in [
        ("so3_free_rigid_body", 2),
        ("se3_heavy_top", 3),
        ("se3_kirchhoff", 3),
        ("so4_manakov", 3),
    ] {
        let found = splitting(&format!("specs/{name}.json"));
        println!("{name}: {found}");
        assert_eq!(found.as_array().map(Vec::len), Some(pieces), "{name}");
    }
    let run = "run specs/se3_kirchhoff.json --method splitting4 --step 0.1 --until 1";
    let run = common::lie(run).ok();
    assert_eq!(run.stdout.lines().count(), 12, "{}", run.stdout);
}
