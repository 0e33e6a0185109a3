//! Methods of lie-poisson: what `lie run` does, through the same driver.

use crate::trial::{Outcome, Trials};
use lie_runtime::diagnostics::DriftMonitor;
use lie_runtime::driver::{Observer, Options, Problem, Save, integrate};
use lie_runtime::methods::{LieTaylor, Method, Taylor};
use lie_runtime::newton::{Convergence, NewtonOptions};
use lie_runtime::{GradientSeries, LiePoisson, Poisson, Series, State, Unknown, Widen};
use std::ops::ControlFlow;

/// Whether this program was compiled as `lie run --fma` compiles: `run` sets the variable beside the flags of the compiler.
pub const FUSED: bool = option_env!("LIE_PEERS_FUSED").is_some();

pub const PEER: &str = if FUSED {
    "lie-poisson, --fma"
} else {
    "lie-poisson"
};

/// The part of `--tol` that is the tolerance of a Taylor series, as in `lie run`.
const PER_STEP: f64 = 0.01;

/// A larger error says that the steps are too large for anything.
const HOPELESS: f64 = 0.1;

/// Where the state goes at the end of a run.
struct End<'e>(&'e mut [f64]);

impl<P: Poisson<f64>> Observer<f64, P> for End<'_> {
    fn row(&mut self, _system: &P, _time: f64, mu: &P::State) -> ControlFlow<()> {
        self.0.copy_from_slice(mu.as_slice());
        ControlFlow::Continue(())
    }
}

/// What is measured of a system.
pub struct Ours<'t, 'a, P: Poisson<f64>> {
    pub problem: &'a Problem<f64, P>,
    pub trials: &'t mut Trials<'a>,
    /// Steps per decade, and other things that a quick run has less of.
    pub quick: bool,
}

impl<'a, P: Poisson<f64>> Ours<'_, 'a, P> {
    /// One run with these options.
    fn add<M: Method<f64, P> + Copy + 'a>(
        &mut self,
        label: &str,
        method: M,
        by: &'static str,
        setting: String,
        options: Options,
    ) -> Option<crate::trial::Tried> {
        let problem = self.problem;
        let options = options.save(Save::Ends);
        let again = options.clone();
        let run = move |end: &mut [f64]| {
            let (stats, _) = integrate(problem, method, &options, &mut End(end)).ok()?;
            Some(Outcome { steps: stats.steps })
        };
        let drifts = move || {
            let mut monitor = DriftMonitor::new();
            integrate(problem, method, &again, &mut monitor).ok()?;
            let drift = monitor.drift();
            let casimirs = drift.casimirs.iter().map(|casimir| casimir.max);
            Some([drift.energy.max, casimirs.fold(0.0, f64::max)])
        };
        self.trials.add(
            PEER,
            label,
            by,
            setting,
            Box::new(run),
            Some(Box::new(drifts)),
        )
    }

    /// Half decades, the first ones too loose for every target.
    fn tolerances(&self) -> impl Iterator<Item = f64> + use<P> {
        let every = if self.quick { 4 } else { 1 };
        (4..30)
            .step_by(every)
            .map(|k| 10_f64.powf(-0.5 * f64::from(k)))
            .filter(|t| *t > 1.8e-15)
    }

    /// `--tol` alone: the step from the tolerance, everything else by default.
    pub fn by_tolerance<M: Method<f64, P> + Copy + 'a>(
        &mut self,
        label: &str,
        method: M,
        newton: NewtonOptions,
    ) {
        for tolerance in self.tolerances() {
            let options = Options::tolerance(tolerance).newton(newton);
            let setting = format!("tol {tolerance:.1e}");
            let tried = self.add(label, method, "tolerance", setting, options);
            if tried.is_some_and(|tried| tried.seconds > self.trials.budget) {
                break;
            }
        }
    }

    /// So many steps.
    pub fn with_steps<M: Method<f64, P> + Copy + 'a>(
        &mut self,
        label: &str,
        method: M,
        steps: u64,
    ) {
        let span = self.problem.span.1 - self.problem.span.0;
        let options = Options::new(span / steps as f64);
        self.add(label, method, "setting", format!("{steps} steps"), options);
    }

    /// The number of steps of a ladder.
    fn ladder(&self, ratio: f64) -> impl Iterator<Item = u64> + use<P> {
        let problem = self.problem;
        let mut field = problem.system.zero_state();
        problem.system.vector_field(&problem.mu0, &mut field);
        let span = problem.span.1 - problem.span.0;
        let first = (0.2 * span * field.max_norm() / problem.mu0.max_norm()).max(4.0);
        let mut last = 0;
        (0..400)
            .map(move |k| (first * ratio.powi(k)).round() as u64)
            .filter(move |&steps| steps != std::mem::replace(&mut last, steps))
            .take_while(|&steps| steps < 10_000_000)
    }

    /// Every step of a ladder, and every tolerance of the solver.
    pub fn by_steps<M: Method<f64, P> + Copy + 'a>(
        &mut self,
        label: &str,
        method: M,
        ratio: f64,
        solvers: &[NewtonOptions],
    ) {
        let span = self.problem.span.1 - self.problem.span.0;
        let ratio = if self.quick { ratio.powi(3) } else { ratio };
        // where the first solver came to something: larger steps are hopeless for the others too
        let mut begin = 0_u64;
        for solver in solvers {
            let (mut floor, mut best, mut before) = (0, f64::INFINITY, f64::INFINITY);
            let from = begin;
            for steps in self.ladder(ratio).filter(|&steps| steps >= from) {
                let options = Options::new(span / steps as f64).newton(*solver);
                let mut setting = format!("{steps} steps");
                if solver.convergence == Convergence::State && solver.tolerance >= 1.0 {
                    setting += &format!(", solver {:.0e} eps", solver.tolerance);
                }
                let tried = self.add(label, method, "setting", setting, options);
                let Some(tried) = tried.filter(|tried| tried.error < HOPELESS) else {
                    continue;
                };
                if begin == 0 {
                    begin = steps;
                }
                floor = if tried.error > 0.7 * best {
                    floor + 1
                } else {
                    0
                };
                best = best.min(tried.error);
                // large steps may take longer than smaller ones, where they are hard to solve
                let long = tried.seconds > self.trials.budget && tried.seconds > before;
                before = tried.seconds;
                if floor >= 6 || long || tried.error < 1e-14 {
                    break;
                }
            }
        }
    }
}

/// Solvers of methods whose stages are evaluated together, from loose ones to the default.
pub fn solvers(quick: bool) -> Vec<NewtonOptions> {
    let every = if quick { 4 } else { 1 };
    let loose = (0..27)
        .step_by(every)
        .map(|k| 10_f64.powf(0.5 * f64::from(k)));
    let loose = loose.map(|tolerance| NewtonOptions {
        tolerance,
        convergence: Convergence::State,
        ..NewtonOptions::default()
    });
    std::iter::once(NewtonOptions::default())
        .chain(loose)
        .collect()
}

/// What `--converge map` says.
pub fn to_round_off() -> NewtonOptions {
    NewtonOptions {
        convergence: Convergence::Map,
        ..NewtonOptions::default()
    }
}

/// What `--converge tolerance` says.
pub fn to_the_tolerance() -> NewtonOptions {
    NewtonOptions {
        convergence: Convergence::Tolerance,
        ..NewtonOptions::default()
    }
}

impl<'a, P: Series<f64>> Ours<'_, 'a, P> {
    /// Taylor series by their own tolerance, and by `--tol`.
    pub fn taylor(&mut self) {
        let until = self.problem.span.1;
        for k in 8..64 {
            let tolerance = 10_f64.powf(-0.25 * f64::from(k));
            let method = Taylor::with_tolerance(tolerance);
            let setting = format!("rtol {tolerance:.1e}");
            self.add("taylor", method, "setting", setting, Options::new(until));
        }
        for tolerance in self.tolerances() {
            let method = Taylor::with_tolerance((PER_STEP * tolerance).max(1e-15));
            let setting = format!("tol {tolerance:.1e}");
            self.add(
                "taylor",
                method,
                "tolerance",
                setting,
                Options::tolerance(tolerance),
            );
        }
    }
}

impl<'a, P> Ours<'_, 'a, P>
where
    P: GradientSeries<f64> + LiePoisson<f64> + Widen<f64>,
    P::Widened: LiePoisson<<f64 as lie_runtime::Scalar>::Wide>,
{
    /// Taylor series along the orbit.
    pub fn lie_taylor(&mut self) {
        let until = self.problem.span.1;
        for k in 8..64 {
            let tolerance = 10_f64.powf(-0.25 * f64::from(k));
            let method = LieTaylor::with_tolerance(tolerance);
            let setting = format!("rtol {tolerance:.1e}");
            self.add(
                "lie-taylor",
                method,
                "setting",
                setting,
                Options::new(until),
            );
        }
        for tolerance in self.tolerances() {
            let method = LieTaylor::with_tolerance((PER_STEP * tolerance).max(1e-15));
            let setting = format!("tol {tolerance:.1e}");
            self.add(
                "lie-taylor",
                method,
                "tolerance",
                setting,
                Options::tolerance(tolerance),
            );
        }
    }
}
