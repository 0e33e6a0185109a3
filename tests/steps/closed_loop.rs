//! A closed loop in Rust and in Python: the same controllers, the same bits. `lie-python/tests/test_closed_loop.py` has them in Python.

use std::fmt::Write as _;
use std::path::Path;
use std::sync::Arc;

use lie_runtime::driver::{Chart, Controller, Reconstruction};
use lie_runtime::prelude::*;

lie_poisson! {
    /// `tests/data/closed_loop.json`
    system PointingBody;
    algebra = so(3);
    state x, y, z;
    inputs { a = 0, sampling = 1/8; b = 0, sampling = 1/8; c = 0, sampling = 1/4; }
    hamiltonian = x^2/4 + y^2/3 + z^2/2;
    forces { x = a - x/50; y = b - y/50; z = c + cos(t)/20; }
    initial = [4/5, 1/10, 3/5];
    methods = [gauss6, gauss16, lie-midpoint, rk4];
}

/// Proportional and differential: the skew part of the attitude, and the momenta. Sums and products alone, which Python rounds alike.
fn controller(first: usize, second: usize, momentum: usize) -> Controller {
    Arc::new(move |t, mu, g| {
        let skew = g[3 * second + first] - g[3 * first + second];
        0.3 * skew - 0.8 * mu[momentum] + 0.01 * t
    })
}

/// A run with closed loops: every tenth row, as bits.
fn run<M>(name: &str, method: M, h: f64) -> String
where
    M: Method<f64, PointingBodySystem>,
{
    let body = PointingBody::new();
    let system = body.system().expect("finite constants");
    let held = Held::of(&system, 0.0, (1, &[0])).expect("inputs");
    let held = held.with(0, Source::Controller(controller(1, 2, 0)));
    let held = held.with(1, Source::Controller(controller(2, 0, 1)));
    let held = held.with(2, Source::Controller(controller(0, 1, 2)));
    let mut group = Reconstruction::new(&system, Chart::Matrix);
    let problem = Problem::new(system, body.initial_state(), (0.0, 20.0));
    let run = solve_observed(&problem, method, &Options::new(h), (held, &mut group));
    let run = run.expect("the steps converge");
    let mut text = String::new();
    for (t, mu) in run.t.iter().zip(&run.mu).step_by(10) {
        let numbers = mu.as_slice()[..3].iter().chain(&mu.as_slice()[6..9]);
        let bits: Vec<String> = numbers.map(|x| format!("{:016x}", x.to_bits())).collect();
        writeln!(text, "{name} {t} {}", bits.join(" ")).expect("a string takes all");
    }
    text
}

#[test]
fn the_bits_are_those_of_python() {
    let text = run("gauss6", Gauss6, 0.05)
        + &run("gauss16", Gauss16, 0.1)
        + &run("lie-midpoint", LieMidpoint::exp(), 0.025)
        + &run("rk4", Rk4, 0.0625);
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/closed_loop.txt");
    if std::env::var_os("LIE_UPDATE_GOLDEN").is_some() {
        std::fs::write(&path, &text).expect("the file is written");
    }
    let expected = std::fs::read_to_string(&path).expect("the file is there");
    assert!(
        text == expected,
        "LIE_UPDATE_GOLDEN=1 writes {} anew:\n{text}",
        path.display()
    );
}
