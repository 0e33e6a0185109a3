//! The free rigid body as 2 x 2 and 3 x 3 matrices: the steps are those of the methods with structure constants.

use lie_dense::{MatrixFlow, SkewHermitian, StreamMap};
use lie_runtime::Scalar;
use lie_runtime::driver::{Options, Problem, Save, solve};
use lie_runtime::methods::{Collective2, Isospectral2, Method};
use lie_runtime::newton::NewtonOptions;

#[allow(dead_code, reason = "what other tests use of it")]
mod system {
    include!("../../../../lie-runtime/tests/systems/rigid_body.rs");
}
use system::RigidBody;

type Vector = [f64; 3];

/// `-i sum_k mu_k sigma_k / 2`
fn spin(mu: Vector) -> SkewHermitian {
    let mut w = SkewHermitian::zeros(2);
    w.set_lower(0, 0, (0.0, -0.5 * mu[2]));
    w.set_lower(1, 1, (0.0, 0.5 * mu[2]));
    w.set_lower(1, 0, (0.5 * mu[1], -0.5 * mu[0]));
    w
}

fn from_spin(w: &SkewHermitian) -> Vector {
    let (re, im) = w.entry(1, 0);
    [-2.0 * im, 2.0 * re, 2.0 * w.entry(1, 1).1]
}

/// The matrix of `x -> mu x x`.
fn rotation(mu: Vector) -> SkewHermitian {
    let mut w = SkewHermitian::zeros(3);
    w.set_lower(1, 0, (mu[2], 0.0));
    w.set_lower(2, 0, (-mu[1], 0.0));
    w.set_lower(2, 1, (mu[0], 0.0));
    w
}

fn from_rotation(w: &SkewHermitian) -> Vector {
    [w.entry(2, 1).0, -w.entry(2, 0).0, w.entry(1, 0).0]
}

/// A rigid body in matrices of 2 or 3 rows.
struct Body {
    size: usize,
    inertia: Vector,
}

impl StreamMap for Body {
    fn name(&self) -> &str {
        "Body"
    }
    fn size(&self) -> usize {
        self.size
    }
    fn stream(&self, w: &SkewHermitian, p: &mut SkewHermitian) {
        let spins = self.size == 2;
        let mu = if spins {
            from_spin(w)
        } else {
            from_rotation(w)
        };
        let [x, y, z] = core::array::from_fn(|k| -mu[k] / self.inertia[k]);
        *p = if spins {
            spin([x, y, z])
        } else {
            rotation([x, y, z])
        };
    }
}

const START: Vector = [0.8, 0.1, 0.6];

/// The largest distance of saved states from those of the body with structure constants.
fn distance<M>(size: usize, method: M) -> f64
where
    M: Method<f64, RigidBody<f64>>,
{
    let options = Options::new(0.1)
        .save(Save::Every(10))
        .newton(NewtonOptions::fixed_point());
    let body = RigidBody::<f64>::default();
    let inertia = body.inertia;
    let known = solve(&Problem::new(body, START, (0.0, 20.0)), method, &options).unwrap();
    let start = if size == 2 {
        spin(START)
    } else {
        rotation(START)
    };
    let flow = MatrixFlow::new(Body { size, inertia });
    let problem = flow.problem(start, (0.0, 20.0)).unwrap();
    let found = solve(&problem, Isospectral2::new(), &options).unwrap();
    let mut worst = 0.0_f64;
    for (found, known) in found.mu.iter().zip(&known.mu) {
        let found = if size == 2 {
            from_spin(found)
        } else {
            from_rotation(found)
        };
        for k in 0..3 {
            worst = Scalar::max(worst, (found[k] - known[k]).abs());
        }
    }
    worst
}

#[test]
fn two_rows_are_the_method_over_the_hopf_map() {
    let off = distance(2, Collective2::hopf());
    assert!(off < 1e-13, "{off:e}");
    // the control: the representation by rotations is another method
    assert!(distance(2, Isospectral2::new()) > 1e-5);
}

#[test]
fn three_rows_are_the_isospectral_method() {
    let off = distance(3, Isospectral2::new());
    assert!(off < 1e-13, "{off:e}");
    assert!(distance(3, Collective2::hopf()) > 1e-5);
}
