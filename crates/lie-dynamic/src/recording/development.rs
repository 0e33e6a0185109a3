//! All orders of a Taylor series as one program: the recurrence of the plan, its sums and what is between.

use super::record::{Written, written};
use super::{Countdown, PATIENCE, Ready, Recorded, recording, source_numbers};
use crate::code::{Code, Source};
use crate::compiled::Compiled;
use crate::system::Dynamic;
use crate::system::series::ByCodes;
use lie_runtime::Scalar;
use std::sync::Arc;

/// Where programs are made quickly, so many series are made before, and one for so many instructions.
const QUICK: u32 = 64;
const INSTRUCTIONS: u32 = 16;

/// The program of all orders up to one.
#[derive(Debug)]
pub(crate) struct SeriesCodes(Arc<[Code]>);

impl SeriesCodes {
    fn new(compiled: &Arc<Compiled>, last: usize) -> Option<Self> {
        let codes = compiled.taylor.as_ref()?;
        let ([rows, conditions], written): ([Vec<Recorded>; 2], Written) = written(|| {
            let system = recording(compiled);
            let mut recurrence = ByCodes::new(&system, codes);
            let size = compiled.plan.dimension();
            let mu = source_numbers(size, |place| Source::Argument(0, place));
            let unit = Recorded::from_source(Source::Argument(1, 0));
            let mut field = vec![Recorded::zero(); size];
            let mut rows: Vec<Vec<Recorded>> = Vec::with_capacity(last);
            recurrence.begin(&mu, &mut field);
            for k in 1..=last {
                let factor = Recorded::ratio(1.0, k as f64) * unit;
                let coefficient: Vec<_> = field.iter().map(|entry| *entry * factor).collect();
                if k < last {
                    recurrence.advance(k, &coefficient, &mut field);
                }
                rows.push(coefficient);
            }
            Some([rows.concat(), recurrence.conditions(0..last).to_vec()])
        })?;
        Some(Self(Arc::from(written.codes(&rows, &conditions))))
    }

    fn length(&self) -> usize {
        self.0[1].instructions.len()
    }
}

/// The series of a system by one program, once so many were made that it pays.
pub(crate) struct Development<'a, S: Scalar> {
    system: &'a Dynamic<S>,
    wait: Countdown,
    /// The order that the program is for.
    last: usize,
    ready: Option<Ready<S>>,
    coefficients: Vec<S>,
}

impl<'a, S: Scalar> Development<'a, S> {
    /// None where nothing is recorded, or nothing would compile it.
    pub fn new(system: &'a Dynamic<S>) -> Option<Self> {
        let compiles = system.values.machine.compiles();
        if cfg!(target_arch = "wasm32") || !system.is_recordable() || !compiles {
            return None;
        }
        Some(Self {
            system,
            wait: match (
                system.values.hurry,
                system.values.machine.compiles_quickly(),
            ) {
                (true, _) => Countdown::new(0, 1),
                (_, true) => Countdown::new(QUICK, INSTRUCTIONS),
                (_, false) => Countdown::new(PATIENCE, 1),
            },
            last: 0,
            ready: None,
            coefficients: Vec::new(),
        })
    }

    fn codes(&self, last: usize) -> Option<Arc<SeriesCodes>> {
        let compiled = &self.system.values.compiled;
        compiled
            .series
            .get(&last, || SeriesCodes::new(compiled, last))
    }

    /// The coefficients of the orders from 1 on, one order after the other; none where it is not run as a program.
    pub fn run(&mut self, mu: &[S], unit: S, last: usize, conditions: &mut [S]) -> Option<&[S]> {
        if last != self.last {
            self.last = last;
            self.ready = None;
            let known = self.system.values.compiled.series.cached(&last);
            let there =
                known.is_some_and(|codes| self.system.values.machine.has_compiled(&codes.0));
            if self.wait.left == 0 || there {
                self.compile();
            }
        }
        if self.wait.left > 0 && self.ready.is_none() {
            let mut wait = std::mem::replace(&mut self.wait, Countdown::new(0, 1));
            let over = wait.is_over(|| self.codes(last).map_or(0, |codes| codes.length()));
            self.wait = wait;
            if over {
                self.compile();
            }
        }
        let ready = self.ready.as_ref()?;
        let unit = [unit];
        let frame = [mu, &unit, &[], &[]];
        let frame = self.system.values.frame(frame, &ready.of_step, &[]);
        let targets = [&mut self.coefficients[..], conditions];
        ready.machine.run(1, &frame, targets);
        Some(&self.coefficients)
    }

    #[cold]
    fn compile(&mut self) {
        let Some(codes) = self.codes(self.last) else {
            return;
        };
        self.ready = Ready::new(self.system, &codes.0, S::zero(), false);
        let size = self.system.values.compiled.plan.dimension();
        self.coefficients = vec![S::zero(); size * self.last];
    }
}
