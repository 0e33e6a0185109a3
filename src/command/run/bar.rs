//! The progress bar of long runs.

use std::io::{self, IsTerminal as _};
use std::time::{Duration, Instant};

use indicatif::{HumanCount, ProgressBar, ProgressState, ProgressStyle};

/// A run of this length shows how far it is.
const LONG: Duration = Duration::from_millis(700);

/// Shows on a terminal how far a long run is.
pub struct Bar {
    bar: ProgressBar,
    start: Instant,
}

impl Bar {
    pub fn new(wanted: bool) -> Self {
        Self::of(wanted, "steps")
    }

    /// A bar that counts something else.
    pub fn of(wanted: bool, what: &str) -> Self {
        let bar = if wanted && io::stderr().is_terminal() {
            ProgressBar::new(0)
        } else {
            ProgressBar::hidden()
        };
        let template =
            format!("{{bar:40}} {{percent}}% of {{len}} {what}, {{rate}} per second, {{eta}} left");
        let style = ProgressStyle::with_template(&template)
            .unwrap_or_else(|_| ProgressStyle::default_bar())
            .with_key(
                "rate",
                |state: &ProgressState, out: &mut dyn std::fmt::Write| {
                    // Nobody needs its last digits; a bar that cannot be written is not drawn.
                    let _ = write!(out, "{}", HumanCount(state.per_sec() as u64));
                },
            );
        bar.set_style(style);
        Self {
            bar,
            start: Instant::now(),
        }
    }

    pub fn show(&self, done: u64, all: u64) {
        if self.start.elapsed() > LONG {
            self.bar.set_length(all);
            self.bar.set_position(done);
        }
    }

    pub fn clear(&self) {
        self.bar.finish_and_clear();
    }
}
