//! One setting of one method, which can be run again and again, and which of them are worth timing.

use crate::clock::{Spent, spent, times};
use serde::Serialize;
use std::ops::ControlFlow;

/// What takes longer, in seconds, is tried once; else three times.
const ONCE: f64 = 5e-3;

/// What a run led to.
pub struct Outcome {
    pub steps: u64,
}

/// A run from the initial state to the end of the span, which is written into the slice; none if it fails.
pub type Run<'a> = Box<dyn Fn(&mut [f64]) -> Option<Outcome> + 'a>;

/// What the drift of the invariants of a run is, energy first; not timed.
pub type Drifts<'a> = Box<dyn Fn() -> Option<[f64; 2]> + 'a>;

/// One setting of one method.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    pub peer: &'static str,
    pub method: String,
    /// `tolerance` where a tolerance alone was given, `setting` where the best of all settings is looked for.
    pub by: &'static str,
    pub setting: String,
    pub error: f64,
    pub steps: u64,
    /// Largest change of the energy, and of a Casimir.
    pub drift: Option<[f64; 2]>,
    /// Seconds of the first runs.
    pub first: f64,
}

/// A row and how it is run again.
pub struct Trial<'a> {
    pub row: Row,
    pub run: Run<'a>,
    pub drifts: Option<Drifts<'a>>,
}

/// The distance of two states.
pub fn euclidean(one: &[f64], other: &[f64]) -> f64 {
    let pairs = one.iter().zip(other);
    pairs.map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

/// The trials of a case.
pub struct Trials<'a> {
    pub reference: &'a [f64],
    /// How far a state is from it.
    pub distance: fn(&[f64], &[f64]) -> f64,
    pub all: Vec<Trial<'a>>,
    /// Seconds that a run may take.
    pub budget: f64,
}

impl<'a> Trials<'a> {
    /// Tries a setting: its error at the end, or none if the run failed or took too long.
    pub fn add(
        &mut self,
        peer: &'static str,
        method: &str,
        by: &'static str,
        setting: String,
        run: Run<'a>,
        drifts: Option<Drifts<'a>>,
    ) -> Option<Tried> {
        let mut end = vec![0.0; self.reference.len()];
        let mut outcome = None;
        let mut seconds = f64::INFINITY;
        for _ in 0..3 {
            let first = spent(1, || outcome = run(&mut end));
            seconds = seconds.min(first.processor);
            if outcome.is_none() || seconds > ONCE {
                break;
            }
        }
        let steps = outcome?.steps;
        let error = (self.distance)(&end, self.reference);
        if error.is_finite() {
            self.all.push(Trial {
                row: Row {
                    peer,
                    method: method.to_owned(),
                    by,
                    setting,
                    error,
                    steps,
                    drift: None,
                    first: seconds,
                },
                run,
                drifts,
            });
        }
        Some(Tried { error, seconds })
    }

    /// The same of a peer, which takes a tolerance; whether a smaller one is out of the question.
    pub fn add_peer(
        &mut self,
        peer: &'static str,
        method: &str,
        setting: String,
        run: Run<'a>,
    ) -> ControlFlow<()> {
        match self.add(peer, method, "tolerance", setting, run, None) {
            Some(tried) if tried.seconds > self.budget => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        }
    }

    /// Keeps of every method the settings that were fastest to an error.
    pub fn prune(&mut self, targets: &[f64], keep: usize) {
        let mut kept = vec![false; self.all.len()];
        let rows: Vec<&Row> = self.all.iter().map(|trial| &trial.row).collect();
        let mut names: Vec<_> = rows.iter().map(|r| (r.peer, &r.method, r.by)).collect();
        names.sort_unstable();
        names.dedup();
        for name in names {
            for &target in targets {
                let of = |r: &Row| (r.peer, &r.method, r.by) == name && r.error <= target;
                let mut good: Vec<usize> = (0..rows.len()).filter(|&i| of(rows[i])).collect();
                good.sort_by(|&i, &j| rows[i].first.total_cmp(&rows[j].first));
                good.iter().take(keep).for_each(|&i| kept[i] = true);
            }
        }
        let mut kept = kept.iter();
        self.all.retain(|_| kept.next().is_some_and(|&k| k));
        for trial in &mut self.all {
            trial.row.drift = trial.drifts.as_ref().and_then(|drifts| drifts());
        }
    }

    /// Times every trial once.
    pub fn round(&self) -> Vec<Spent> {
        let mut end = vec![0.0; self.reference.len()];
        let time = |trial: &Trial<'_>| {
            spent(times(trial.row.first), || {
                let _ = std::hint::black_box((trial.run)(std::hint::black_box(&mut end)));
            })
        };
        let mut time = time;
        self.all.iter().map(&mut time).collect()
    }
}

/// What a setting came to.
#[derive(Clone, Copy, Debug)]
pub struct Tried {
    pub error: f64,
    pub seconds: f64,
}
