//! The rows of a run as they come, with progress, and the wish to stop.

use crate::driver::{Motion, Observer, Progress, Reconstruction};
use crate::poisson::Poisson;
use crate::state::State;
use crate::structure::MatrixGroup;
use core::ops::ControlFlow;
use std::io::{self, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

const FLUSH: Duration = Duration::from_millis(150);
const PROGRESS: Duration = Duration::from_millis(120);
/// The clock is looked at about this often, whatever a step costs.
const LOOK: Duration = Duration::from_millis(10);

/// Writes rows and progress.
pub(super) struct RowWriter<'a> {
    output: &'a mut dyn Write,
    messages: &'a mut dyn Write,
    interrupted: &'a AtomicBool,
    error: Option<io::Error>,
    casimirs: Vec<f64>,
    /// Steps between two looks at the clock, and left until the next.
    stride: u32,
    left: u32,
    looked: Instant,
    flushed: Instant,
    reported: Instant,
}

impl<'a> RowWriter<'a> {
    pub(super) fn new<P: Poisson<f64>>(
        system: &P,
        output: &'a mut dyn Write,
        messages: &'a mut dyn Write,
        interrupted: &'a AtomicBool,
    ) -> Self {
        let now = Instant::now();
        Self {
            output,
            messages,
            interrupted,
            error: None,
            casimirs: vec![0.0; system.casimir_count()],
            stride: 1,
            left: 1,
            looked: now,
            flushed: now,
            reported: now,
        }
    }

    /// Writes what is left and returns the first error there was.
    pub(super) fn finish(self) -> io::Result<()> {
        match self.error {
            Some(error) => Err(error),
            None => self.output.flush(),
        }
    }

    /// Keeps an error for the end of the run, and ends it.
    fn check(&mut self, result: io::Result<()>) -> ControlFlow<()> {
        match result {
            Ok(()) => ControlFlow::Continue(()),
            Err(error) => {
                self.error = Some(error);
                ControlFlow::Break(())
            }
        }
    }

    /// Looks at the clock: flushes and reports if it is time to, and sets the next look.
    fn look(&mut self, progress: Progress) -> ControlFlow<()> {
        let now = Instant::now();
        let since = now - self.looked;
        if since < LOOK / 2 {
            self.stride = self.stride.saturating_mul(2).min(1 << 20);
        } else if since > LOOK * 2 {
            self.stride = (self.stride / 4).max(1);
        }
        self.left = self.stride;
        self.looked = now;
        if now - self.reported >= PROGRESS {
            self.reported = now;
            // nobody may be reading progress: that is no reason to stop
            let _ = writeln!(
                self.messages,
                "progress {} {}",
                progress.step, progress.steps
            );
        }
        if now - self.flushed >= FLUSH {
            self.flushed = now;
            let result = self.output.flush();
            return self.check(result);
        }
        ControlFlow::Continue(())
    }
}

impl<P: Poisson<f64>> Observer<f64, P> for RowWriter<'_> {
    fn step(&mut self, _system: &P, progress: Progress, _mu: &P::State) -> ControlFlow<()> {
        if self.interrupted.load(Ordering::Relaxed) {
            return ControlFlow::Break(());
        }
        self.left -= 1;
        if self.left == 0 {
            self.look(progress)
        } else {
            ControlFlow::Continue(())
        }
    }

    fn row(&mut self, system: &P, time: f64, mu: &P::State) -> ControlFlow<()> {
        self.write(system, time, mu, &[])
    }
}

/// Writes rows that end with the group element.
pub(super) struct OnGroup<'r, 'a, V> {
    pub(super) reconstruction: Reconstruction<f64, V>,
    pub(super) rows: &'r mut RowWriter<'a>,
}

impl<P: MatrixGroup<f64>> Observer<f64, P> for OnGroup<'_, '_, P::State> {
    const MOTION: bool = true;

    fn step(&mut self, system: &P, progress: Progress, mu: &P::State) -> ControlFlow<()> {
        self.rows.step(system, progress, mu)
    }

    fn row(&mut self, system: &P, time: f64, mu: &P::State) -> ControlFlow<()> {
        let element = self.reconstruction.element();
        self.rows.write(system, time, mu, element)
    }

    fn motion(&mut self, system: &P, motion: &Motion<'_, P::State>) {
        self.reconstruction.motion(system, motion);
    }

    fn leave_grid(&mut self) {
        Observer::<f64, P>::leave_grid(&mut self.reconstruction);
    }

    fn return_to_grid(&mut self) {
        Observer::<f64, P>::return_to_grid(&mut self.reconstruction);
    }
}

impl RowWriter<'_> {
    /// One row, `more` at its end.
    fn write<P: Poisson<f64>>(
        &mut self,
        system: &P,
        time: f64,
        mu: &P::State,
        more: &[f64],
    ) -> ControlFlow<()> {
        let mut casimirs = core::mem::take(&mut self.casimirs);
        system.casimirs(mu, &mut casimirs);
        let energy = system.energy(mu);
        let numbers = [time].into_iter().chain(mu.as_slice().iter().copied());
        let mut result = Ok(());
        for number in numbers
            .chain([energy])
            .chain(casimirs.iter().chain(more).copied())
        {
            result = result.and_then(|()| self.output.write_all(&number.to_le_bytes()));
        }
        self.casimirs = casimirs;
        self.check(result)
    }
}
