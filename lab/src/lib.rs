//! What methods keep over 10^5 and 10^6 steps. The tests of this package are compiled with optimisation,
//! those of the others without: generated code is long and optimising all of it takes longer than
//! running it.

pub mod drawn;
pub mod lifted;
pub mod measured;
pub mod page;

use lie_runtime::Poisson;
use lie_runtime::diagnostics::{Drift, DriftMonitor};
use lie_runtime::driver::integrate;
use lie_runtime::methods::Method;
use lie_runtime::prelude::{Options, Problem, Save};

/// The drift of energy and Casimirs over every step of size `h`.
///
/// # Panics
/// If a step fails.
pub fn drift<P: Poisson<f64>>(
    system: P,
    start: P::State,
    method: impl Method<f64, P>,
    h: f64,
    steps: u32,
) -> Drift {
    let mut monitor = DriftMonitor::<f64>::new();
    let problem = Problem {
        system,
        mu0: start,
        span: (0.0, h * f64::from(steps)),
    };
    let options = Options::new(h).save(Save::Ends);
    integrate(&problem, method, &options, &mut monitor).expect("every step converges");
    monitor.drift().clone()
}
