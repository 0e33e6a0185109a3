//! Splittings for two pieces of which one is small: their errors in the step and in the small parameter, as the
//! publications have them, and where they are refused.

use crate::common;

use crate::advance::advance;
use crate::systems::{distance, state};
use lie_runtime::methods::{Method, Scheme};
use lie_runtime::prelude::*;

// the first piece is the main one
lie_poisson! {
    system First;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state x, y, z;
    parameters { epsilon = 1; }
    hamiltonian = x^2/2 + x/3 + epsilon*(z + z^3/2);
    methods = [splitting8];
}

// the second one is
lie_poisson! {
    system Second;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state x, y, z;
    parameters { epsilon = 1; }
    hamiltonian = epsilon*(x + x^3/2) + z^2/2 + z/3;
    methods = [splitting8];
}

const START: [f64; 3] = [0.7, -0.4, 0.9];
const SPAN: f64 = 4.0;

/// The error at the end of the span.
fn error<P: Poisson<f64>>(system: &P, method: &impl Method<f64, P>, steps: u32) -> f64
where
    lie_runtime::methods::Splitting<8, lie_runtime::methods::Coordinate>: Method<f64, P>,
{
    let [mut one, mut exact] = [(); 2].map(|()| state(system, &START));
    advance(system, method, SPAN / f64::from(steps), steps, &mut one);
    let fine = Splitting8::new().coordinate();
    advance(system, &fine, SPAN / 160.0, 160, &mut exact);
    distance(one.as_slice(), exact.as_slice())
}

/// The slopes of the error in the step, at a parameter and with these numbers of steps, and in the parameter.
macro_rules! slopes {
    ($system:ident, $method:expr, $in_step:expr, $in_epsilon:expr) => {{
        let at = |epsilon: f64, steps: u32| {
            let mut system = $system::new();
            system.epsilon = epsilon;
            error(&system.system().expect("valid"), &$method, steps)
        };
        let (epsilon, [few, many]): (f64, [u32; 2]) = $in_step;
        let coarse = at(epsilon, few);
        let fine = at(epsilon, many);
        let in_step = (coarse / fine).ln() / (f64::from(many) / f64::from(few)).ln();
        let (steps, [large, small]): (u32, [f64; 2]) = $in_epsilon;
        let (above, below) = (at(large, steps), at(small, steps));
        let in_epsilon = (above / below).ln() / (large / small).ln();
        println!(
            "{}: step {in_step:.2} ({coarse:.1e}, {fine:.1e}), parameter {in_epsilon:.2} ({above:.1e}, {below:.1e})",
            stringify!($method)
        );
        (in_step, in_epsilon)
    }};
}

fn close((in_step, in_epsilon): (f64, f64), step: f64, epsilon: f64) {
    assert!((in_step - step).abs() < 0.12 * step, "{in_step} for {step}");
    assert!(
        (in_epsilon - epsilon).abs() < 0.15,
        "{in_epsilon} for {epsilon}"
    );
}

/// The same for order 8 in the step: above round-off the steps are so long that the slope is still larger. That the terms of the
/// first order in the parameter vanish up to degree 7 and no further, a test beside the coefficients proves.
fn eighth((in_step, in_epsilon): (f64, f64)) {
    assert!((7.2..12.0).contains(&in_step), "{in_step} for 8");
    assert!((in_epsilon - 2.0).abs() < 0.15, "{in_epsilon} for 2");
}

fn scheme(scheme: Scheme) -> lie_runtime::methods::Splitting<2, lie_runtime::methods::Coordinate> {
    Splitting2::new().scheme(scheme).coordinate()
}

#[test]
fn errors_in_the_step_and_in_the_small_parameter() {
    // small parameters: the term of the first order in it; short steps: that of the second
    let small = |steps| (1e-7, steps);
    let short = (200, [1e-2, 2.5e-3]);
    // of order 8 the errors of shorter steps are round-off
    let long = (3e-7, [3, 5]);
    close(
        slopes!(First, scheme(Scheme::Saba2), small([10, 20]), short),
        4.0,
        2.0,
    );
    close(
        slopes!(Second, scheme(Scheme::Sbab2), small([10, 20]), short),
        4.0,
        2.0,
    );
    eighth(slopes!(First, scheme(Scheme::Saba4), long, short));
    eighth(slopes!(Second, scheme(Scheme::Sbab4), long, short));
    let mclachlan = Splitting4::new().scheme(Scheme::McLachlan84).coordinate();
    let short = (40, [2e-2, 5e-3]);
    eighth(slopes!(First, mclachlan, long, short));
}

/// Strang's splitting has an error of the first order in the parameter, whatever the step, and the schemes of
/// one side do not have theirs on the other.
#[test]
fn controls() {
    let short = (200, [1e-2, 2.5e-3]);
    close(
        slopes!(First, scheme(Scheme::Strang), (1e-7, [10, 20]), short),
        2.0,
        1.0,
    );
    let (_, in_epsilon) = slopes!(Second, scheme(Scheme::Saba4), (3e-7, [3, 5]), short);
    assert!(in_epsilon < 1.3, "{in_epsilon}");
}

/// The orders where nothing is small.
#[test]
fn orders() {
    let whole = (1.0, [80, 160]);
    let (two, _) = slopes!(First, scheme(Scheme::Saba4), whole, (10, [1.0, 0.5]));
    assert!((two - 2.0).abs() < 0.1, "{two}");
    let mclachlan = Splitting4::new().scheme(Scheme::McLachlan84).coordinate();
    let (four, _) = slopes!(First, mclachlan, (1.0, [40, 80]), (10, [1.0, 0.5]));
    assert!((four - 4.0).abs() < 0.3, "{four}");
}

#[test]
fn the_command_takes_them_for_two_pieces() {
    let run =
        "run specs/so3_free_rigid_body.json --method splitting2 --step 0.1 --until 1 --composition";
    let saba = common::lie(&format!("{run} saba2")).ok();
    let strang = common::lie(&format!("{run} strang")).ok();
    assert_eq!(saba.stdout.lines().count(), 12);
    assert_ne!(saba.stdout, strang.stdout);
    let run = format!("{run} saba2 --pieces coordinate");
    let run = common::lie(&run).error("splitting", "command line: --method");
    let why = "`saba2` are for two pieces of which one is small, and there are 3";
    assert!(run.stderr.contains(why), "{}", run.stderr);
}
