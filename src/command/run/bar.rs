//! How far long work is: a bar on a terminal, now and then a line elsewhere.

use std::io::{self, IsTerminal as _};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use indicatif::{HumanCount, ProgressBar, ProgressState, ProgressStyle};

use crate::render;

/// A run of this length shows how far it is.
const LONG: Duration = Duration::from_millis(700);
/// The bar moves also where no news come.
const TICK: Duration = Duration::from_millis(250);
/// Without a terminal, a line comes not more often than this.
const RARE: Duration = Duration::from_secs(10);

/// Shows how far a long run is.
pub struct Bar {
    bar: ProgressBar,
    start: Instant,
    /// When the last line was printed, where lines are wanted.
    line: Option<Mutex<Instant>>,
}

impl Bar {
    /// A bar that counts steps; none without a terminal.
    pub fn new(wanted: bool) -> Self {
        let template = "{wide_bar} {percent}% of {len} steps, {rate} per second, {eta} left";
        Self {
            line: None,
            ..Self::of(wanted, template)
        }
    }

    /// A bar that counts members; none without a terminal.
    pub fn for_members(wanted: bool) -> Self {
        let template = "{wide_bar} {percent}% of {len} members, {rate} per second, {eta} left";
        Self {
            line: None,
            ..Self::of(wanted, template)
        }
    }

    /// A bar that counts parts of the work and names the one that it is at; without a terminal, lines.
    pub fn for_stages(wanted: bool) -> Self {
        Self::of(wanted, "{bar:30} {percent}%, {elapsed}: {wide_msg}")
    }

    fn of(wanted: bool, template: &str) -> Self {
        let terminal = io::stderr().is_terminal();
        let bar = if wanted && terminal {
            ProgressBar::new(0)
        } else {
            ProgressBar::hidden()
        };
        let style = ProgressStyle::with_template(template)
            .unwrap_or_else(|_| ProgressStyle::default_bar())
            .with_key(
                "rate",
                |state: &ProgressState, out: &mut dyn std::fmt::Write| {
                    // Nobody needs its last digits; a bar that cannot be written is not drawn.
                    let _ = write!(out, "{}", HumanCount(state.per_sec() as u64));
                },
            );
        bar.set_style(style);
        let start = Instant::now();
        Self {
            bar,
            start,
            line: (wanted && !terminal).then(|| Mutex::new(start)),
        }
    }

    pub fn show(&self, done: u64, all: u64) {
        if self.start.elapsed() > LONG {
            self.bar.set_length(all);
            self.bar.set_position(done);
        }
    }

    /// The same, and what comes next.
    pub fn stage(&self, done: u64, all: u64, what: &str) {
        // what comes next may take long by itself
        self.bar.set_length(all);
        self.bar.set_position(done);
        self.bar.set_message(what.to_owned());
        self.bar.enable_steady_tick(TICK);
        let Some(line) = &self.line else { return };
        let mut last = line.lock().unwrap_or_else(PoisonError::into_inner);
        if last.elapsed() > RARE {
            *last = Instant::now();
            let seconds = self.start.elapsed().as_secs();
            let percent = 100.0 * done as f64 / all.max(1) as f64;
            render::say(&format!(
                "{percent:.0} % done after {seconds} s; next: {what}"
            ));
        }
    }

    /// Says something above the bar, on a terminal alone.
    pub fn say(&self, line: &str) {
        self.bar.println(line);
    }

    /// Does what writes to the terminal while the bar is away.
    pub fn aside<T>(&self, write: impl FnOnce() -> T) -> T {
        self.bar.suspend(write)
    }

    pub fn clear(&self) {
        self.bar.finish_and_clear();
    }
}
