//! What is said of many runs together.

use std::fmt::Write as _;
use std::time::Duration;

use lie_in_process::request::Several;
use lie_in_process::words::counted;
use lie_runtime::driver::Pace;

use super::reception::Received;
use super::summary::short;

/// So many runs are reported one by one.
pub const MOST_LINES: usize = 24;
/// So many runs that stop early are reported one by one.
const MOST_STOPS: usize = 5;

/// The work and the worst errors of the runs of each method.
pub struct Tally {
    methods: Vec<OfMethod>,
    /// Whether there are several, and too many for a line each.
    several: bool,
    many: bool,
    /// Whether steps are chosen by a tolerance.
    by_tolerance: bool,
    stops: usize,
    /// Runs that round-off may keep from their tolerance.
    at_round_off: u64,
    /// Runs in which steps became shorter.
    shortened: u64,
    /// Runs that may have missed their tolerance.
    missed: u64,
}

struct OfMethod {
    title: String,
    runs: usize,
    stopped: usize,
    steps: u64,
    /// The shortest and the longest step, by their sizes.
    sizes: Option<(f64, f64)>,
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
            sizes: None,
            worst: Vec::new(),
        });
        Self {
            methods: methods.collect(),
            several: several.labels.is_some(),
            many: several.members.len() > MOST_LINES,
            by_tolerance: several
                .plans
                .iter()
                .any(|plan| matches!(plan.pace.0, Pace::Tolerance(_))),
            stops: 0,
            at_round_off: 0,
            shortened: 0,
            missed: 0,
        }
    }

    /// Takes a run that reached its end.
    pub fn record(&mut self, method: usize, run: usize, received: &Received) {
        self.at_round_off += u64::from(received.at_round_off);
        self.shortened += u64::from(received.shortened.is_some());
        self.missed += u64::from(received.missed());
        let method = &mut self.methods[method];
        method.runs += 1;
        method.steps += received.work.steps;
        let size = received.step;
        let (least, most) = method.sizes.unwrap_or((size, size));
        let shorter = if size.abs() < least.abs() {
            size
        } else {
            least
        };
        let longer = if size.abs() > most.abs() { size } else { most };
        method.sizes = Some((shorter, longer));
        for (name, error, relative) in received.drift.errors() {
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
            let more = counted(more as u64, "more run");
            let _ = writeln!(text, "{more} stopped early");
        }
        if self.several {
            text.push_str(&self.of_tolerance());
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
                sizes,
                worst,
            } = method;
            let _ = write!(
                text,
                "{title}: {}, {} in total",
                counted(*runs as u64, "run"),
                counted(*steps, "step")
            );
            if let (Some((least, most)), true) = (sizes, self.by_tolerance) {
                let _ = write!(text, ", step sizes {least:?} to {most:?}");
            }
            if *stopped > 0 {
                let _ = write!(
                    text,
                    ", and {} that stopped early",
                    counted(*stopped as u64, "run")
                );
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

    /// What tolerances have led to, in how many of several runs.
    fn of_tolerance(&self) -> String {
        let mut text = String::new();
        let mut say = |runs: u64, what: &str| {
            if runs > 0 {
                let _ = writeln!(text, "{}{what}", counted(runs, "run"));
            }
        };
        let round_off = ": the round-off of so many steps may exceed the tolerance";
        say(self.at_round_off, round_off);
        let shortened =
            " with steps that became shorter: the motion becomes faster than at the start";
        say(self.shortened, shortened);
        if self.many && self.missed > 0 {
            let runs = counted(self.missed, "run");
            let _ = writeln!(text, "warning: {runs} may miss the tolerance");
        }
        text
    }
}
