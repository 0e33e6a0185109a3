//! What a run says at its end.

use std::time::Duration;

use lie_in_process::checkpoint::KeptDrift;
use lie_in_process::words::counted;
use lie_plot::reference;
use lie_program::protocol::Work;
use lie_runtime::diagnostics::InvariantDrift;

/// The largest errors of the invariants over the rows, against the first row.
pub struct Drift {
    names: Vec<String>,
    left_out: Vec<String>,
    /// Empty before the first row.
    invariants: Vec<InvariantDrift>,
    /// Largest absolute value of a component of the state.
    scale: f64,
    time: f64,
}

impl Drift {
    /// What a run that is taken up again has to know.
    pub fn kept(&self) -> KeptDrift {
        let invariants = self.invariants.iter();
        let bits = |drift: &InvariantDrift| (drift.initial.to_bits(), drift.max.to_bits());
        KeptDrift {
            invariants: invariants.map(bits).collect(),
            scale: self.scale.to_bits(),
            time: self.time.to_bits(),
        }
    }

    /// Goes on from there.
    pub fn restore(&mut self, kept: &KeptDrift) {
        let pairs = self.names.iter().zip(&kept.invariants);
        let one = |(name, &(initial, max)): (&String, &(u64, u64))| {
            let mut drift = InvariantDrift::new(name, Some(f64::from_bits(initial)));
            drift.record(f64::from_bits(max), 0, 0);
            drift
        };
        self.invariants = pairs.map(one).collect();
        self.scale = f64::from_bits(kept.scale);
        self.time = f64::from_bits(kept.time);
    }

    /// Invariants by name.
    pub fn new(names: &[String]) -> Self {
        Self {
            names: names.to_vec(),
            left_out: Vec::new(),
            invariants: Vec::new(),
            scale: 0.0,
            time: 0.0,
        }
    }

    /// Takes a row: time, state, and the invariants from a column on.
    pub fn push(&mut self, row: &[f64], invariants: usize) {
        let (state, invariants) = row.split_at(invariants);
        if self.invariants.is_empty() {
            let pairs = self.names.iter().zip(invariants);
            let first = pairs.map(|(name, &first)| InvariantDrift::new(name, Some(first)));
            self.invariants = first.collect();
        }
        self.time = state[0];
        self.scale = state[1..]
            .iter()
            .fold(self.scale, |scale, x| scale.max(x.abs()));
        for (drift, value) in self.invariants.iter_mut().zip(invariants) {
            drift.record((value - drift.initial).abs(), 0, 0);
        }
    }

    /// Time of the last row.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Leaves an invariant with several branches out of the summary.
    pub fn leave_out(&mut self, name: &str) {
        self.left_out.push(name.to_owned());
    }

    /// The error of each invariant by its name: relative wherever the invariant is not zero, which is said behind it.
    pub fn errors(&self) -> impl Iterator<Item = (&str, f64, bool)> {
        let shown = self.invariants.iter();
        let shown = shown.filter(|drift| !self.left_out.contains(&drift.name));
        shown.map(|drift| match reference(drift.initial, self.scale) {
            Some(first) => (drift.name.as_str(), drift.max / first, true),
            None => (drift.name.as_str(), drift.max, false),
        })
    }

    /// `energy 1.2e-6, C 3e-16 (absolute)`.
    fn text(&self) -> String {
        let one = |(name, error, relative): (&str, f64, bool)| match relative {
            true => format!("{name} {}", short(error)),
            false => format!("{name} {} (absolute)", short(error)),
        };
        self.errors().map(one).collect::<Vec<_>>().join(", ")
    }
}

/// Two digits.
pub fn short(error: f64) -> String {
    if error == 0.0 {
        "0".to_owned()
    } else {
        format!("{error:.1e}")
    }
}

/// The iterations of a step, of each kind of which there were more than a few.
fn iterations(work: &Work) -> String {
    let per_step = |count: u64| count as f64 / work.steps as f64;
    let fixed = per_step(work.fixed_point);
    let newton = per_step(work.newton - work.fixed_point);
    match (fixed >= 0.005, newton >= 0.005) {
        (false, _) => format!(", {newton:.2} Newton iterations per step"),
        (_, false) => format!(", {fixed:.2} fixed-point iterations per step"),
        _ => format!(", {fixed:.2} fixed-point and {newton:.2} Newton iterations per step"),
    }
}

/// Whose steps a method makes.
#[derive(Clone, Copy, PartialEq)]
pub enum Steps {
    /// Those of the grid.
    Constant,
    /// Its own, within a grid that was given.
    Own,
    /// Its own, within a grid that follows from a tolerance.
    OwnByTolerance,
}

/// What was done, and how well the invariants were kept; for a method that chooses its own steps, how many those
/// were, and whether it had a choice.
pub fn text(title: &str, work: &Work, whose: Steps, drift: &Drift, time: Duration) -> String {
    let mut text = steps(title, work, drift, time);
    let steps = work.steps;
    if work.newton > 0 && steps > 0 {
        text.push_str(&iterations(work));
    }
    if whose != Steps::Constant {
        let own = counted(work.accepted, "adaptive step");
        text.push_str(&format!(", {own} within these, {} refused", work.rejected));
    }
    if whose == Steps::Own && work.accepted == steps && work.rejected == 0 {
        text.push_str(
            "\n--step decided the size of every step, and the tolerances of none; give a larger --step to \
             let them decide",
        );
    }
    if !drift.invariants.is_empty() {
        text.push_str(&format!(
            "\nlargest relative error in the rows: {}",
            drift.text()
        ));
    }
    text.push('\n');
    text
}

/// The same of one of several runs, in a line.
pub fn line(title: &str, work: &Work, drift: &Drift, time: Duration) -> String {
    let mut text = steps(title, work, drift, time);
    if !drift.invariants.is_empty() {
        text.push_str("; ");
        text.push_str(&drift.text());
    }
    text.push('\n');
    text
}

fn steps(title: &str, work: &Work, drift: &Drift, time: Duration) -> String {
    let (steps, end, seconds) = (work.steps, drift.time, time.as_secs_f64());
    format!(
        "{title}: {} to t = {end:?} in {seconds:.3} s",
        counted(steps, "step")
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_relative_unless_the_invariant_is_zero() {
        let mut drift = Drift::new(&["energy".to_owned(), "C".to_owned()]);
        drift.push(&[0.0, 1.0, -3.0, 2.0, 0.0], 3);
        drift.push(&[0.5, 1.0, -3.0, 2.5, 1e-9], 3);
        drift.push(&[1.0, 1.0, -3.0, 2.1, -2e-9], 3);
        let work = Work {
            steps: 2,
            newton: 5,
            ..Work::default()
        };
        let text = text(
            "T",
            &work,
            Steps::Constant,
            &drift,
            Duration::from_millis(1500),
        );
        assert_eq!(
            text,
            "T: 2 steps to t = 1.0 in 1.500 s, 2.50 Newton iterations per step\n\
             largest relative error in the rows: energy 2.5e-1, C 2.0e-9 (absolute)\n"
        );
        drift.push(&[1.5, 1.0, 1.0, f64::NAN, 0.0], 3);
        assert!(drift.text().contains("energy NaN"));
        drift.push(&[2.0, 1.0, 1.0, 2.0, 0.0], 3);
        assert!(drift.text().contains("energy NaN"), "it stays");
    }

    #[test]
    fn iterations_are_counted_by_their_kind() {
        let of = |newton, fixed_point| {
            iterations(&Work {
                steps: 4,
                newton,
                fixed_point,
                ..Work::default()
            })
        };
        assert_eq!(of(10, 10), ", 2.50 fixed-point iterations per step");
        assert_eq!(
            of(11, 10),
            ", 2.50 fixed-point and 0.25 Newton iterations per step"
        );
        let many = Work {
            steps: 10_000,
            newton: 10_200,
            fixed_point: 6,
            ..Work::default()
        };
        assert_eq!(iterations(&many), ", 1.02 Newton iterations per step");
    }

    #[test]
    fn adaptive_methods_say_how_many_steps_were_their_own() {
        let drift = Drift::new(&[]);
        let of_steps = |whose, accepted, rejected| {
            let work = Work {
                steps: 10,
                accepted,
                rejected,
                ..Work::default()
            };
            text("T", &work, whose, &drift, Duration::ZERO)
        };
        let of = |accepted, rejected| of_steps(Steps::Own, accepted, rejected);
        assert!(of(25, 2).contains(", 25 adaptive steps within these, 2 refused\n"));
        assert!(!of(25, 2).contains("larger --step") && !of(10, 1).contains("larger --step"));
        assert!(of(10, 0).contains("give a larger --step"));
        // no --step was given
        assert!(!of_steps(Steps::OwnByTolerance, 10, 0).contains("--step"));
        assert!(of(1, 2).contains(", 1 adaptive step within these, 2 refused\n"));
    }
}
