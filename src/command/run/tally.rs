//! What is said of many runs together.

use std::fmt::Write as _;
use std::time::Duration;

use lie_in_process::words::counted;
use lie_program::protocol::Work;

use super::plan::Several;
use super::summary::{Drift, short};

/// So many runs are reported one by one.
pub const MOST_LINES: usize = 24;
/// So many runs that stop early are reported one by one.
const MOST_STOPS: usize = 5;

/// The work and the worst errors of the runs of each method.
pub struct Tally {
    methods: Vec<OfMethod>,
    /// Whether there are too many for a line each.
    many: bool,
    stops: usize,
}

struct OfMethod {
    title: String,
    runs: usize,
    stopped: usize,
    steps: u64,
    /// The largest error of each invariant by name, the run that has it, and whether it is relative.
    worst: Vec<Worst>,
}

struct Worst {
    name: String,
    error: f64,
    relative: bool,
    run: usize,
}

impl Tally {
    /// Nothing yet.
    pub fn new(several: &Several) -> Self {
        let methods = several.plans.iter().map(|plan| OfMethod {
            title: plan.method.title(),
            runs: 0,
            stopped: 0,
            steps: 0,
            worst: Vec::new(),
        });
        Self {
            methods: methods.collect(),
            many: several.members.len() > MOST_LINES,
            stops: 0,
        }
    }

    /// Takes a run that reached its end.
    pub fn take(&mut self, method: usize, run: usize, work: &Work, drift: &Drift) {
        let method = &mut self.methods[method];
        method.runs += 1;
        method.steps += work.steps;
        for (name, error, relative) in drift.errors() {
            let known = method.worst.iter_mut();
            let found = known
                .into_iter()
                .find(|w| w.name == name && w.relative == relative);
            match found {
                // NaN is the worst of all, and stays
                Some(worst) if worst.error >= error || worst.error.is_nan() => {}
                Some(worst) => (worst.error, worst.run) = (error, run),
                None => method.worst.push(Worst {
                    name: name.to_owned(),
                    error,
                    relative,
                    run,
                }),
            }
        }
    }

    /// Counts a run that stopped early; whether to say more about it.
    pub fn stopped(&mut self, method: usize) -> bool {
        self.methods[method].stopped += 1;
        self.stops += 1;
        self.stops <= MOST_STOPS
    }

    /// What is left to say at the end.
    pub fn text(&self, time: Duration) -> String {
        let mut text = String::new();
        if self.stops > MOST_STOPS {
            let more = self.stops - MOST_STOPS;
            let _ = writeln!(text, "{more} more runs stopped early");
        }
        if !self.many {
            return text;
        }
        for method in &self.methods {
            let OfMethod {
                title,
                runs,
                stopped,
                steps,
                worst,
            } = method;
            let _ = write!(
                text,
                "{title}: {} of {} in all",
                counted(*runs as u64, "run"),
                counted(*steps, "step")
            );
            if *stopped > 0 {
                let _ = write!(text, ", {stopped} more that stopped early");
            }
            if !worst.is_empty() {
                let one = |w: &Worst| {
                    let absolute = if w.relative { "" } else { ", absolute" };
                    format!("{} {} (run {}{absolute})", w.name, short(w.error), w.run)
                };
                let worst: Vec<String> = worst.iter().map(one).collect();
                let _ = write!(
                    text,
                    "\nlargest relative error in the rows: {}",
                    worst.join(", ")
                );
            }
            text.push('\n');
        }
        let _ = writeln!(text, "{:.3} s", time.as_secs_f64());
        text
    }
}
