//! Looks for Ctrl-C while a run goes on, and follows the group element.

use crate::progress::Progress as Told;
use lie_dynamic::Dynamic;
use lie_runtime::Poisson;
use lie_runtime::driver::{Assessed, Chosen, Motion, Observer, Progress, Reconstruction};
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
    missed: Option<f64>,
    told: Told,
}

impl Watch {
    /// What hears how far it is.
    pub fn new(told: Told) -> Self {
        Self(RefCell::new(Seen {
            left: STRIDE,
            looked: Instant::now(),
            interrupted: None,
            chosen: None,
            missed: None,
            told,
        }))
    }

    /// The exception that ended the run, if there was one.
    pub fn outcome(&self) -> PyResult<()> {
        match self.0.borrow_mut().interrupted.take() {
            Some(error) => Err(error),
            None => Ok(()),
        }
    }

    /// Says that the run came to its end.
    pub fn ended(&self) -> PyResult<()> {
        self.0.borrow_mut().told.end()
    }

    /// The error at the end, where it may be much larger than the tolerance; not a number where it cannot be told.
    pub fn missed(&self) -> Option<f64> {
        self.0.borrow().missed
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

    fn assessed(&mut self, assessed: &Assessed) {
        let error = assessed.error.unwrap_or(f64::NAN);
        self.0.borrow_mut().missed = assessed.missed().then_some(error);
    }

    fn step(&mut self, _system: &P, progress: Progress, _mu: &P::State) -> ControlFlow<()> {
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
        let said = seen.told.tell(progress.step, progress.steps);
        match said.and_then(|()| Python::attach(|py| py.check_signals())) {
            Ok(()) => ControlFlow::Continue(()),
            Err(error) => {
                seen.interrupted = Some(error);
                ControlFlow::Break(())
            }
        }
    }
}

/// Looks, and follows the group element.
pub struct OnGroup<'a> {
    pub watch: &'a Watch,
    pub reconstruction: Reconstruction<f64, Vec<f64>>,
}

impl Observer<f64, Dynamic<f64>> for &mut OnGroup<'_> {
    const MOTION: bool = true;

    fn chosen(&mut self, chosen: &Chosen) {
        let mut watch = self.watch;
        Observer::<f64, Dynamic<f64>>::chosen(&mut watch, chosen);
    }

    fn assessed(&mut self, assessed: &Assessed) {
        let mut watch = self.watch;
        Observer::<f64, Dynamic<f64>>::assessed(&mut watch, assessed);
    }

    fn step(
        &mut self,
        system: &Dynamic<f64>,
        progress: Progress,
        mu: &Vec<f64>,
    ) -> ControlFlow<()> {
        let mut watch = self.watch;
        watch.step(system, progress, mu)
    }

    fn row(&mut self, system: &Dynamic<f64>, time: f64, mu: &Vec<f64>) -> ControlFlow<()> {
        self.reconstruction.row(system, time, mu)
    }

    fn motion(&mut self, system: &Dynamic<f64>, motion: &Motion<'_, Vec<f64>>) {
        self.reconstruction.motion(system, motion);
    }

    fn leave_grid(&mut self) {
        Observer::<f64, Dynamic<f64>>::leave_grid(&mut self.reconstruction);
    }

    fn return_to_grid(&mut self) {
        Observer::<f64, Dynamic<f64>>::return_to_grid(&mut self.reconstruction);
    }
}
