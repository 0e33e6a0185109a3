//! Case C: many free rigid bodies, eight at a time in the lanes of a register.

use crate::cases::systems::so3_free_rigid_body::FreeRigidBody;
use crate::ours::PEER;
use crate::trial::{Outcome, Trials};
use lie_runtime::driver::{Observer, Options, Problem, Save, integrate};
use lie_runtime::methods::{Exact, Gauss16, Method, Rk4, Taylor};
use lie_runtime::newton::{Convergence, NewtonOptions};
use lie_runtime::scalar::F64x8;
use lie_runtime::{Poisson, Scalar};
use std::ops::ControlFlow;

type System = crate::cases::systems::so3_free_rigid_body::FreeRigidBodySystem<F64x8>;
type Group = Problem<F64x8, System>;

/// How many bodies a register holds.
const LANES: usize = 8;

/// The largest distance of a body, of which three numbers after another are the momentum.
pub fn distance(one: &[f64], other: &[f64]) -> f64 {
    let pairs = one.chunks_exact(3).zip(other.chunks_exact(3));
    // not a number if any is not
    let largest = |most: f64, next: f64| if most.is_nan() || next <= most { most } else { next };
    pairs
        .map(|(a, b)| crate::trial::euclidean(a, b))
        .fold(0.0, largest)
}

/// The bodies in groups of eight; their number is a multiple of that.
pub fn groups(parameters: [f64; 3], states: &[f64], until: f64) -> Vec<Group> {
    let values = parameters.map(F64x8::from_f64);
    let group = |states: &[f64]| {
        let system = FreeRigidBody::from_values(&values).system();
        let system = system.expect("a sound system");
        let component = |k: usize| F64x8::new(std::array::from_fn(|lane| states[3 * lane + k]));
        let start: [F64x8; 3] = std::array::from_fn(component);
        Problem::new(system, start, (0.0, until))
    };
    states.chunks_exact(3 * LANES).map(group).collect()
}

/// Where the states go at the end of a run.
struct End<'e>(&'e mut [f64]);

impl Observer<F64x8, System> for End<'_> {
    fn row(
        &mut self,
        _system: &System,
        _time: f64,
        mu: &<System as Poisson<F64x8>>::State,
    ) -> ControlFlow<()> {
        for (k, lanes) in mu.as_slice().iter().enumerate() {
            for lane in 0..LANES {
                self.0[3 * lane + k] = lanes.lane(lane);
            }
        }
        ControlFlow::Continue(())
    }
}

/// The trials of an ensemble.
pub struct Ensemble<'t, 'a> {
    pub groups: &'a [Group],
    pub trials: &'t mut Trials<'a>,
}

impl<'a> Ensemble<'_, 'a> {
    fn add<M: Method<F64x8, System> + Copy + 'a>(
        &mut self,
        label: &str,
        method: M,
        setting: String,
        options: Options,
    ) -> ControlFlow<()> {
        let (groups, options) = (self.groups, options.save(Save::Ends));
        let run = move |end: &mut [f64]| {
            let mut steps = 0;
            for (group, end) in groups.iter().zip(end.chunks_exact_mut(3 * LANES)) {
                let (stats, _) = integrate(group, method, &options, &mut End(end)).ok()?;
                steps += stats.steps;
            }
            Some(Outcome { steps })
        };
        let label = format!("{label}, 8 lanes");
        let run = Box::new(run);
        match self.trials.add(PEER, &label, "setting", setting, run, None) {
            Some(tried) if tried.seconds > self.trials.budget => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        }
    }

    /// Everything.
    pub fn measure(&mut self, until: f64, quick: bool) {
        let every = if quick { 4 } else { 1 };
        let exact = Options::new(until);
        let _ = self.add("exact, the end alone", Exact, "1 step".to_owned(), exact);
        for k in (8..64).step_by(every) {
            let tolerance = 10_f64.powf(-0.25 * f64::from(k));
            let (method, setting) = (
                Taylor::with_tolerance(tolerance),
                format!("rtol {tolerance:.1e}"),
            );
            let _ = self.add("taylor", method, setting, Options::new(until));
        }
        for steps in (20..80).step_by(4 * every) {
            for solver in [1e1, 1e3, 1e5, 1e7, 1e9] {
                let newton = NewtonOptions {
                    tolerance: solver,
                    convergence: Convergence::State,
                    ..NewtonOptions::default()
                };
                let options = Options::new(until / f64::from(steps as u32)).newton(newton);
                let setting = format!("{steps} steps, solver {solver:.0e} eps");
                if self.add("gauss16", Gauss16, setting, options).is_break() {
                    break;
                }
            }
        }
        for power in (0..24).step_by(every) {
            let steps = (200.0 * 1.25_f64.powi(power)).round();
            let options = Options::new(until / steps);
            if self
                .add("rk4", Rk4, format!("{steps} steps"), options)
                .is_break()
            {
                break;
            }
        }
    }
}
