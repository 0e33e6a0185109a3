//! Systems with one kernel that lies: the judge names that kernel and no other.

use lie_codegen::compile::compile_spec;
use lie_judge::{Judge, Sample};
use lie_measure::verify::{Found, Options};
use lie_measure::{Request, Verify};
use lie_program::listen::listen;
use lie_program::protocol::{Message, Start};
use lie_runtime::methods::Rk4;
use lie_runtime::prelude::*;
use lie_runtime::scalar::Dual;
use lie_runtime::{LiePoisson, Lift, Poisson, SquareMatrix};
use spec_systems::so3_nonpolynomial::{NonpolynomialSpin, NonpolynomialSpinSystem};
use std::io::Write as _;

type Vector<S> = <NonpolynomialSpinSystem<S> as Poisson<S>>::State;
type Matrix<S> = <NonpolynomialSpinSystem<S> as Poisson<S>>::Jacobian;

/// What lies; the first says the truth.
const LIES: [&str; 14] = [
    "nothing",
    "hamiltonian",
    "energy",
    "gradient",
    "hessian",
    "poisson_matrix",
    "poisson_slope",
    "vector_field",
    "jacobian",
    "linearize",
    "casimirs",
    "casimir_gradient 0",
    "ad_star",
    "ad_star_matrix",
];

/// A spin that lies in one kernel. Which one is a value, so that all that verifies it is compiled once.
#[derive(Clone)]
struct Lying<S: Scalar> {
    system: NonpolynomialSpinSystem<S>,
    what: &'static str,
}

impl<S: Scalar> Lying<S> {
    fn lies(&self, kernel: &str) -> bool {
        self.what == kernel
    }
}

/// A value a little off, if it is that of the lie.
fn bent<S: Scalar>(lies: bool, value: S) -> S {
    if lies {
        value * S::from_f64(1.0 + 1e-9)
    } else {
        value
    }
}

/// An entry with the wrong sign.
fn turned<S: Scalar>(lies: bool, vector: &mut Vector<S>, entry: usize) {
    if lies {
        vector.as_mut_slice()[entry] = -vector.as_slice()[entry];
    }
}

/// Two entries exchanged, as in a transposed matrix.
fn transposed<S: Scalar>(lies: bool, matrix: &mut Matrix<S>) {
    if lies {
        let entry = |row, column| SquareMatrix::<S>::get(matrix, row, column);
        let (a, b) = (entry(0, 1), entry(1, 0));
        matrix.set(0, 1, b);
        matrix.set(1, 0, a);
    }
}

impl<S: Scalar> Poisson<S> for Lying<S> {
    type State = Vector<S>;
    type Jacobian = Matrix<S>;
    fn dimension(&self) -> usize {
        3
    }
    fn casimir_count(&self) -> usize {
        1
    }
    fn name(&self) -> &str {
        "Lying"
    }
    fn coordinate(&self, index: usize) -> &str {
        ["x", "y", "z"][index]
    }
    fn casimir_name(&self, index: usize) -> &str {
        ["C"][index]
    }

    fn zero_state(&self) -> Vector<S> {
        self.system.zero_state()
    }
    fn zero_jacobian(&self) -> Matrix<S> {
        self.system.zero_jacobian()
    }
    fn hamiltonian(&self, mu: &Vector<S>) -> S {
        bent(self.lies("hamiltonian"), self.system.hamiltonian(mu))
    }
    fn energy(&self, mu: &Vector<S>) -> S {
        bent(self.lies("energy"), self.system.energy(mu))
    }
    fn gradient(&self, mu: &Vector<S>, out: &mut Vector<S>) {
        self.system.gradient(mu, out);
        turned(self.lies("gradient"), out, 2);
    }
    fn hessian(&self, mu: &Vector<S>, out: &mut Matrix<S>) {
        self.system.hessian(mu, out);
        if self.lies("hessian") {
            out.set(1, 2, S::zero());
        }
    }
    fn poisson_matrix(&self, mu: &Vector<S>, out: &mut Matrix<S>) {
        self.system.poisson_matrix(mu, out);
        transposed(self.lies("poisson_matrix"), out);
    }
    fn poisson_slope(&self, mu: &Vector<S>, xi: &Vector<S>, out: &mut Matrix<S>) {
        self.system.poisson_slope(mu, xi, out);
        transposed(self.lies("poisson_slope"), out);
    }
    fn vector_field(&self, mu: &Vector<S>, out: &mut Vector<S>) {
        self.system.vector_field(mu, out);
        let first = out.as_slice()[0];
        out.as_mut_slice()[0] = bent(self.lies("vector_field"), first);
    }
    fn jacobian(&self, mu: &Vector<S>, out: &mut Matrix<S>) {
        self.system.jacobian(mu, out);
        if self.lies("jacobian") {
            out.set(0, 1, S::zero());
        }
    }
    fn linearize(&self, mu: &Vector<S>, field: &mut Vector<S>, out: &mut Matrix<S>) {
        self.system.linearize(mu, field, out);
        transposed(self.lies("linearize"), out);
    }
    fn casimirs(&self, mu: &Vector<S>, out: &mut [S]) {
        self.system.casimirs(mu, out);
        out[0] = bent(self.lies("casimirs"), out[0]);
    }
    fn casimir_gradient(&self, index: usize, mu: &Vector<S>, out: &mut Vector<S>) {
        self.system.casimir_gradient(index, mu, out);
        turned(self.lies("casimir_gradient 0"), out, 1);
    }
}

impl<S: Scalar> LiePoisson<S> for Lying<S> {
    fn ad(&self, xi: &Vector<S>, eta: &Vector<S>, out: &mut Vector<S>) {
        self.system.ad(xi, eta, out);
    }
    fn ad_star(&self, xi: &Vector<S>, mu: &Vector<S>, out: &mut Vector<S>) {
        self.system.ad_star(xi, mu, out);
        turned(self.lies("ad_star"), out, 0);
    }
    fn ad_star_matrix(&self, xi: &Vector<S>, out: &mut Matrix<S>) {
        self.system.ad_star_matrix(xi, out);
        transposed(self.lies("ad_star_matrix"), out);
    }
}

impl<S: Scalar> Lift<S> for Lying<S> {
    type Lifted = Lying<Dual<S>>;
    fn lift(&self) -> Self::Lifted {
        Lying {
            system: self.system.lift(),
            what: self.what,
        }
    }
}

/// The kernels of a system that the judge refuses.
fn refused(judge: &Judge, what: &'static str) -> Vec<String> {
    let system = move |_: &[f64]| {
        let system = NonpolynomialSpin::new().system();
        system.map(|system| Lying { system, what })
    };
    let program = Verify::new(&[], system)
        .with_orbits()
        .method("rk4", |_| Rk4);
    let request = Request {
        methods: Vec::new(),
        start: Start {
            initial: vec![0.6, -0.5, 0.7],
            ..Start::default()
        },
        options: Options {
            seed: 3,
            ..Options::default()
        },
    };
    let line = serde_json::to_string(&request).expect("text");
    // the input must not end before the program does
    let (input, mut writer) = std::io::pipe().expect("a pipe");
    writeln!(writer, "{line}").expect("a request");
    let mut output = Vec::new();
    let code = program.serve(std::io::BufReader::new(input), &mut output);
    drop(writer);
    assert_eq!(code, 0, "{}", String::from_utf8_lossy(&output));
    let mut refused = Vec::new();
    listen(&mut output.as_slice(), &mut |message| {
        if let Message::Found(Found::Kernel(kernel)) = message {
            let sample = Sample {
                kernel: kernel.name,
                arguments: kernel.arguments,
                values: kernel.values,
                velocity: kernel.gradient,
            };
            let verdict = judge.judge(&sample).expect("a known kernel");
            if verdict.excess > 1.0 && !refused.contains(&sample.kernel) {
                refused.push(sample.kernel);
            }
        }
        Ok(())
    })
    .expect("messages");
    refused
}

#[test]
fn the_kernel_that_lies_is_named() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/specs/so3_nonpolynomial.json");
    let text = std::fs::read_to_string(path).expect("the spec");
    let model = compile_spec(&text).expect("a spec without mistakes");
    let judge = Judge::of_spec(&text, &model, &model.defaults()).expect("a declaration");
    for what in LIES {
        let expected: &[&str] = if what == "nothing" { &[] } else { &[what] };
        assert_eq!(refused(&judge, what), expected);
    }
}
