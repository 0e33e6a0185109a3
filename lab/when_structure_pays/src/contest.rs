//! Methods with their accuracies, from wherever they come, as entrants of one contest.

use lie_runtime::diagnostics::AnyMethod;
use lie_runtime::newton::NewtonOptions;
use lie_runtime::{Poisson, State};

/// A system, where it starts, and the time between two looks at it.
pub struct Problem<P: Poisson<f64>> {
    /// The system.
    pub system: P,
    /// The state at time 0.
    pub start: P::State,
    /// The time between looks.
    pub delta: f64,
    /// What the script for heyoka calls it, with its parameters.
    pub outside: String,
}

/// What a method's accuracy is chosen by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Setting {
    /// So many steps between two looks; a half is one look after every second step.
    Steps(f64),
    /// A tolerance.
    Tolerance(f64),
}

impl Setting {
    /// In words, for looks at this distance.
    pub fn text(self, delta: f64) -> String {
        match self {
            Self::Steps(steps) => format!("h = {:.4}", delta / steps),
            Self::Tolerance(tolerance) => format!("tol {tolerance:.0e}"),
        }
    }
}

/// Takes the time and the state at every look.
pub type See<'a> = &'a mut dyn FnMut(f64, &[f64]);

/// A run to a time that is a multiple of the distance of looks.
pub type Run<P> = Box<dyn Fn(&Problem<P>, Setting, f64, See<'_>) -> Result<(), String>>;

/// The seconds of the processor for one unit of time.
pub type Cost<P> = Box<dyn Fn(&Problem<P>, Setting) -> Result<f64, String>>;

/// A method.
pub struct Entrant<P: Poisson<f64>> {
    /// Its name.
    pub name: String,
    /// Whether it is there to compare with.
    pub control: bool,
    /// From coarse to fine.
    pub settings: Vec<Setting>,
    /// A run.
    pub run: Run<P>,
    /// Its cost.
    pub cost: Cost<P>,
}

/// Coarse to fine by about the square root of two.
fn steps() -> Vec<Setting> {
    let coarse = [8.0, 6.0, 4.0, 3.0, 2.0].map(|skipped| Setting::Steps(1.0 / skipped));
    let fine = (0..40).map(|k| match k % 2 {
        0 => 2_f64.powi(k / 2),
        _ => 1.5 * 2_f64.powi(k / 2),
    });
    let fine = fine
        .filter(|steps| steps.fract() == 0.0)
        .map(Setting::Steps);
    coarse.into_iter().chain(fine).collect()
}

/// Half decades.
pub fn tolerances() -> Vec<Setting> {
    (2..=31)
        .map(|k| Setting::Tolerance(10_f64.powf(-0.5 * f64::from(k))))
        .collect()
}

/// Seconds that this thread has used.
pub fn clock() -> f64 {
    let now = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    now.tv_sec as f64 + now.tv_nsec as f64 * 1e-9
}

/// The least of some runs that last long enough for the clock.
fn timed<P: Poisson<f64>>(
    problem: &Problem<P>,
    run: &Run<P>,
    setting: Setting,
) -> Result<f64, String> {
    const ENOUGH: f64 = 0.02;
    let mut looks = 64.0;
    let once = |looks: f64| {
        let before = clock();
        run(problem, setting, looks * problem.delta, &mut |_, mu| {
            std::hint::black_box(mu);
        })?;
        Ok::<f64, String>(clock() - before)
    };
    let mut spent = once(looks)?;
    while spent < ENOUGH {
        looks *= f64::max(2.0, (1.2 * ENOUGH / spent.max(1e-6)).min(64.0)).round();
        spent = once(looks)?;
    }
    for _ in 0..4 {
        spent = spent.min(once(looks)?);
    }
    Ok(spent / (looks * problem.delta))
}

/// A method of the catalogue, or a control in it; `make` takes the tolerance where it has one.
pub fn ours<P: Poisson<f64> + 'static>(
    name: &str,
    control: bool,
    adaptive: bool,
    make: impl Fn(f64) -> Box<dyn AnyMethod<f64, P>> + Clone + 'static,
) -> Entrant<P> {
    let run = move |problem: &Problem<P>, setting: Setting, until: f64, see: See<'_>| {
        let (tolerance, steps) = match setting {
            Setting::Steps(steps) => (1e-6, steps),
            Setting::Tolerance(tolerance) => (tolerance, 1.0),
        };
        let h = problem.delta / steps;
        let each = steps.max(1.0);
        let looks = (until / (h * each)).round() as u64;
        let method = make(tolerance);
        let mut stepper = method.any_stepper(&problem.system, h, &NewtonOptions::default());
        let mut mu = problem.start.clone();
        for look in 1..=looks {
            let went = stepper.advance(&mut mu, each as u64);
            went.map_err(|(_, failure)| failure.to_string())?;
            finite(mu.as_slice())?;
            see(h * each * look as f64, mu.as_slice());
        }
        Ok(())
    };
    let again: Run<P> = Box::new(run.clone());
    Entrant {
        name: name.to_owned(),
        control,
        settings: if adaptive { tolerances() } else { steps() },
        run: Box::new(run),
        cost: Box::new(move |problem, setting| timed(problem, &again, setting)),
    }
}

fn finite(mu: &[f64]) -> Result<(), String> {
    match mu.iter().all(|x| x.abs() < 1e6) {
        true => Ok(()),
        false => Err("the state runs away".to_owned()),
    }
}

/// An entrant by a run of its own.
pub fn outside<P: Poisson<f64> + 'static>(
    name: &str,
    run: impl Fn(&Problem<P>, Setting, f64, See<'_>) -> Result<(), String> + Clone + 'static,
) -> Entrant<P> {
    let again: Run<P> = Box::new(run.clone());
    Entrant {
        name: name.to_owned(),
        control: true,
        settings: tolerances(),
        run: Box::new(run),
        cost: Box::new(move |problem, setting| timed(problem, &again, setting)),
    }
}
