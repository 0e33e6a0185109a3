//! A declaration that names explicit methods alone has nothing written out that these do not need. What else is asked of
//! the system is found by the provided forms, to the same digits.

use lie_runtime::methods::{Isospectral4, Method};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;
use lie_runtime::{FoundPoisson, LiePoisson, PieceFlows, State};

lie_poisson! {
    system Everything;
    algebra = so(3);
    state x, y, z;
    parameters { k = 0.7; }
    hamiltonian = x^2/2 + k*exp(y)*z + sin(x*z) + y^4/5;
    casimir C = x^2 + y^2 + z^2;
}
lie_poisson! {
    system Explicit;
    algebra = so(3);
    state x, y, z;
    parameters { k = 0.7; }
    hamiltonian = x^2/2 + k*exp(y)*z + sin(x*z) + y^4/5;
    casimir C = x^2 + y^2 + z^2;
    methods = [rk4];
}
// with pieces that have flows, one of them with a Casimir of the rotations
lie_poisson! {
    system Swimmer;
    algebra = se(3);
    state a, b, c, p, q, r;
    hamiltonian = sqrt(1 + a^2 + b^2 + c^2) + cos(q + r/2) + a*p/4 + b*q/4 + c*r/4;
    casimir length = p^2 + q^2 + r^2;
    casimir pitch = a*p + b*q + c*r;
}
lie_poisson! {
    system ExplicitSwimmer;
    algebra = se(3);
    state a, b, c, p, q, r;
    hamiltonian = sqrt(1 + a^2 + b^2 + c^2) + cos(q + r/2) + a*p/4 + b*q/4 + c*r/4;
    casimir length = p^2 + q^2 + r^2;
    casimir pitch = a*p + b*q + c*r;
    methods = [rk4, dopri5];
}

/// The systems, each with all kernels and with those of explicit methods alone.
macro_rules! pairs {
    ($check:ident $(, $more:expr)*) => {
        $check(
            &Everything::new().system().expect("sound parameters"),
            &Explicit::new().system().expect("sound parameters"),
            &[[0.9, -0.3, 0.4], [-1.2, 0.6, 2.0], [0.0, 0.0, 0.0]]
            $(, $more)*
        );
        $check(
            &Swimmer::new().system().expect("no parameters"),
            &ExplicitSwimmer::new().system().expect("no parameters"),
            &[[0.9, -0.3, 0.4, 0.7, 0.2, -0.5], [-1.2, 0.6, 2.0, 0.1, 0.3, 1.1]]
            $(, $more)*
        );
    };
}

/// Fails where numbers differ by more than round-off.
#[track_caller]
fn alike(what: &str, a: &[f64], b: &[f64]) {
    let pairs = a.iter().zip(b);
    let difference = pairs.fold(0.0, |most, (a, b)| f64::max(most, (a - b).abs()));
    let size = a.iter().fold(1.0, |most, a| f64::max(most, a.abs()));
    assert!(difference <= 3e-14 * size, "{what}: {a:?} {b:?}");
}

fn state<P: Poisson<f64>>(system: &P, numbers: &[f64]) -> P::State {
    let mut state = system.zero_state();
    state.as_mut_slice().copy_from_slice(numbers);
    state
}

fn entries<P: Poisson<f64>>(system: &P, matrix: &P::Jacobian) -> Vec<f64> {
    use lie_runtime::matrix::SquareMatrix;
    let n = system.dimension();
    let places = (0..n * n).map(|place| matrix.get(place / n, place % n));
    places.collect()
}

/// Everything that both systems have as kernels or otherwise, at a state and along an element.
fn kernels<P: LiePoisson<f64>>(system: &P, mu: &P::State) -> Vec<(&'static str, Vec<f64>)> {
    let xi = state(
        system,
        &mu.as_slice()
            .iter()
            .map(|x| x.cos() - 0.3)
            .collect::<Vec<_>>(),
    );
    let (mut vector, mut matrix) = (system.zero_state(), system.zero_jacobian());
    let mut found = Vec::new();
    system.hessian(mu, &mut matrix);
    found.push(("hessian", entries(system, &matrix)));
    system.jacobian(mu, &mut matrix);
    found.push(("jacobian", entries(system, &matrix)));
    system.linearize(mu, &mut vector, &mut matrix);
    found.push(("linearize", entries(system, &matrix)));
    found.push(("its field", vector.as_slice().to_vec()));
    for index in 0..system.casimir_count() {
        system.casimir_gradient(index, mu, &mut vector);
        found.push(("casimir_gradient", vector.as_slice().to_vec()));
    }
    system.ad(&xi, mu, &mut vector);
    found.push(("ad", vector.as_slice().to_vec()));
    system.ad_star(&xi, mu, &mut vector);
    found.push(("ad_star", vector.as_slice().to_vec()));
    system.ad_star_matrix(&xi, &mut matrix);
    found.push(("ad_star_matrix", entries(system, &matrix)));
    system.coadjoint_action(&xi, mu, &mut vector);
    found.push(("coadjoint_action", vector.as_slice().to_vec()));
    found
}

fn same_kernels<const N: usize>(
    whole: &impl LiePoisson<f64>,
    explicit: &impl LiePoisson<f64>,
    states: &[[f64; N]],
) {
    for numbers in states {
        let expected = kernels(whole, &state(whole, numbers));
        let found = kernels(explicit, &state(explicit, numbers));
        for ((what, expected), (_, found)) in expected.iter().zip(&found) {
            alike(what, expected, found);
        }
        assert_eq!(expected.len(), found.len());
    }
}

#[test]
fn kernels_are_those_that_are_written_out() {
    pairs!(same_kernels);
}

/// The end of some steps.
fn end<P: Poisson<f64>>(system: &P, method: &impl Method<f64, P>, start: &[f64]) -> Vec<f64> {
    let mut mu = state(system, start);
    let mut stepper = method.stepper(system, 0.1, &NewtonOptions::default());
    for _ in 0..10 {
        stepper.step(&mut mu, &mut ()).expect("a step");
    }
    mu.as_slice().to_vec()
}

macro_rules! same_steps {
    ($whole:ident, $explicit:ident, $start:expr; $($method:expr),*) => {{
        let (whole, explicit) = (
            $whole::new().system().expect("sound parameters"),
            $explicit::new().system().expect("sound parameters"),
        );
        let control = end(&explicit, &LieEuler, &$start);
        $(
            let [a, b] = [end(&whole, &$method, &$start), end(&explicit, &$method, &$start)];
            let what = stringify!($method);
            let difference = a.iter().zip(&b).fold(0.0, |most, (a, b)| f64::max(most, (a - b).abs()));
            assert!(difference < 1e-13, "{what}: {a:?} {b:?}");
            let moved = b.iter().zip(&control).fold(0.0, |most, (a, b)| f64::max(most, (a - b).abs()));
            assert!(moved > 1e-3, "{what}: another method is told from it");
        )*
    }};
}

#[test]
fn every_other_method_works() {
    same_steps!(Everything, Explicit, [0.9, -0.3, 0.4];
        ImplicitMidpoint, Gauss4, LieMidpoint::exp(), LieMidpoint::cayley(), Rkmk4, Generating4::exp(),
        Isospectral4::new(), OrbitEnergy::gonzalez(), CohenHairer4::new(), SphericalMidpoint, Rk4);
    same_steps!(Swimmer, ExplicitSwimmer, [0.9, -0.3, 0.4, 0.7, 0.2, -0.5];
        Gauss6, LieMidpoint::cayley(), CommutatorFree4, Splitting2::new(), Splitting4::new(), Rk4);
}

/// Pieces, their directions and what is left of H, with code of their own or without.
#[test]
fn pieces_are_the_same() {
    let explicit = ExplicitSwimmer::new().system().expect("no parameters");
    let mut flows = explicit.found();
    let mu = state(&explicit, &[0.9, -0.3, 0.4, 0.7, 0.2, -0.5]);
    let [mut xi, mut rest, mut gradient] = [(); 3].map(|()| explicit.zero_state());
    explicit.gradient(&mu, &mut gradient);
    assert!(flows.rest(0.5, &mu, &mut rest), "a Casimir is no piece");
    assert!(flows.pieces() > 1 && rest.amax() > 0.01);
    for piece in 0..flows.pieces() {
        flows.direction(piece, 0.5, &mu, &mut xi);
        rest += xi;
        let [mut flowed, mut followed] = [mu; 2];
        let mut factors = 0;
        flows.flow(piece, 0.3, &mut flowed);
        flows.follow(piece, 0.3, &mut followed, &mut xi, &mut |_| factors += 1);
        assert_eq!(flowed, followed);
        assert!(factors > 0 && (flowed - mu).amax() > 1e-3);
    }
    assert!((rest - gradient * 0.5).amax() < 1e-15, "{rest} {gradient}");
}

/// `lie expand specs/su3_quadratic.json --method rk4`: a kernel that the method does not call is not written.
#[test]
fn an_explicit_method_has_short_code() {
    use lie_codegen::compile::{compile_spec, expand};
    use lie_codegen::methods::Choice;
    let text = std::fs::read_to_string("specs/su3_quadratic.json").expect("the spec");
    let model = compile_spec(&text).expect("a valid spec");
    let lines = |choices: &[Choice]| expand(&model, choices).lines().count();
    let (short, whole) = (lines(&[Choice::Rk4]), lines(&[]));
    println!("{short} lines for rk4, {whole} for all methods");
    assert!(short <= 590 && whole > short + 150, "{short} {whole}");
}
