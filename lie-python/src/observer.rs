//! Looks for Ctrl-C while a run goes on.

use lie_runtime::Poisson;
use lie_runtime::driver::{Chosen, Observer, Progress};
use pyo3::prelude::*;
use std::cell::RefCell;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// Between two looks.
const PAUSE: Duration = Duration::from_millis(50);
/// Steps between two looks at the clock.
const STRIDE: u32 = 256;

/// What was seen.
pub struct Watch(RefCell<Seen>);

struct Seen {
    left: u32,
    looked: Instant,
    interrupted: Option<PyErr>,
    chosen: Option<f64>,
}

impl Default for Watch {
    fn default() -> Self {
        Self(RefCell::new(Seen {
            left: STRIDE,
            looked: Instant::now(),
            interrupted: None,
            chosen: None,
        }))
    }
}

impl Watch {
    /// The exception that ended the run, if there was one.
    pub fn outcome(&self) -> PyResult<()> {
        match self.0.borrow_mut().interrupted.take() {
            Some(error) => Err(error),
            None => Ok(()),
        }
    }

    /// The step that was chosen.
    pub fn chosen(&self) -> Option<f64> {
        self.0.borrow().chosen
    }
}

impl<P: Poisson<f64>> Observer<f64, P> for &Watch {
    fn chosen(&mut self, chosen: &Chosen) {
        self.0.borrow_mut().chosen = Some(chosen.step);
    }

    fn step(&mut self, _system: &P, _progress: Progress, _mu: &P::State) -> ControlFlow<()> {
        let mut seen = self.0.borrow_mut();
        seen.left -= 1;
        if seen.left > 0 {
            return ControlFlow::Continue(());
        }
        seen.left = STRIDE;
        if seen.looked.elapsed() < PAUSE {
            return ControlFlow::Continue(());
        }
        seen.looked = Instant::now();
        match Python::attach(|py| py.check_signals()) {
            Ok(()) => ControlFlow::Continue(()),
            Err(error) => {
                seen.interrupted = Some(error);
                ControlFlow::Break(())
            }
        }
    }
}
