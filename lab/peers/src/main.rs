//! Measures lie-poisson and other crates on the cases of `cases.json`, in one process.
//!
//! Each line of standard input is a request, each line of standard output an answer. `{"case": …, "reference": […]}`
//! tries every setting of every method once and answers with those worth timing; `{"round": true}` times each of these once.
//! Rounds of several programs can so take turns; `run` does that.

mod cases;
mod chain;
mod clock;
mod crates;
mod ensemble;
mod ours;
mod trial;

use serde::{Deserialize, Serialize};
use std::io::Write;
use trial::{Row, Trials};

/// What is asked for.
#[derive(Deserialize)]
#[serde(untagged)]
enum Request {
    Case(Case),
    Round { round: bool },
}

/// A case.
#[derive(Deserialize)]
struct Case {
    case: String,
    /// The initial state, where `cases.json` has none.
    initial: Option<Vec<f64>>,
    reference: Vec<f64>,
    /// Errors that settings are kept for.
    targets: Vec<f64>,
    /// Settings of each method that are kept for each of them.
    keep: usize,
    #[serde(default)]
    quick: bool,
    /// Seconds that one run may take.
    budget: f64,
}

#[derive(Serialize)]
struct Rows<'a> {
    rows: Vec<&'a Row>,
}

#[derive(Serialize)]
struct Samples {
    /// Seconds of the processor and seconds that passed.
    samples: Vec<[f64; 2]>,
}

fn tell(answer: &impl Serialize) {
    let text = serde_json::to_string(answer).expect("numbers and strings");
    let mut output = std::io::stdout().lock();
    // a driver that has gone wants nothing more
    let _ = writeln!(output, "{text}").and_then(|()| output.flush());
}

fn main() {
    let mut lines = std::io::stdin().lines();
    let mut next = || -> Option<Request> {
        let line = lines.by_ref().next()?.ok()?;
        Some(serde_json::from_str(&line).expect("a request"))
    };
    let mut request = next();
    while let Some(now) = request {
        match now {
            Request::Case(case) => {
                request = None;
                cases::with(&case, &mut |trials| {
                    request = serve(trials, &case, &mut next);
                });
            }
            Request::Round { .. } => request = next(),
        }
    }
}

/// Serves a case until another is asked for.
fn serve(
    trials: &mut Trials<'_>,
    case: &Case,
    next: &mut dyn FnMut() -> Option<Request>,
) -> Option<Request> {
    trials.prune(&case.targets, case.keep);
    let rows = trials.all.iter().map(|trial| &trial.row).collect();
    tell(&Rows { rows });
    loop {
        match next() {
            Some(Request::Round { round: true }) => {
                let samples = trials.round();
                let samples = samples.iter().map(|s| [s.processor, s.wall]).collect();
                tell(&Samples { samples });
            }
            other => return other,
        }
    }
}
