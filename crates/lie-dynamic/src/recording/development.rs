//! All orders of a Taylor series as one program: the recurrence of the plan, its sums and what is between. What is asked of a series
//! that is there, its sum at a time, is another.

use super::record::{Written, written};
use super::{Countdown, PATIENCE, Ready, Recorded, recording, source_numbers};
use crate::code::{Code, Source};
use crate::compiled::Compiled;
use crate::system::Dynamic;
use crate::system::series::ByCodes;
use lie_runtime::recurrence::{Ends, KeptSeries, Reach, sum_of_series};
use lie_runtime::{Poisson, Scalar};
use std::sync::Arc;

/// Where programs are made quickly, so many series are made before, and one for so many instructions.
const QUICK: u32 = 64;
const INSTRUCTIONS: u32 = 16;

/// Orders that are 0 behind the last one of a series that is kept.
const BEYOND: usize = 4;

/// How many numbers are told of both [ends](Ends), and of how far it is [used](Reach).
const TOLD: usize = 7;

/// What tells the programs of a system apart: the order of the series, and whether others are developed beside it.
pub(crate) type SeriesKind = (usize, bool);

/// The programs of a series up to an order.
#[derive(Debug)]
pub(crate) struct SeriesCodes {
    /// Its coefficients; as a matrix the conditions that choose branches, then what is told of it.
    develop: Arc<[Code]>,
    /// Its sum.
    sum: Arc<[Code]>,
}

impl SeriesCodes {
    fn new(compiled: &Arc<Compiled>, kind: SeriesKind) -> Option<Self> {
        Some(Self {
            develop: develop(compiled, kind)?,
            sum: sum(compiled.plan.dimension(), kind.0)?,
        })
    }

    fn length(&self) -> usize {
        self.develop[1].instructions.len()
    }
}

fn codes_of(run: impl FnOnce() -> Option<[Vec<Recorded>; 2]>) -> Option<Arc<[Code]>> {
    let ([vector, matrix], written): (_, Written) = written(run)?;
    Some(Arc::from(written.codes(&vector, &matrix)))
}

fn develop(compiled: &Arc<Compiled>, (last, beside): SeriesKind) -> Option<Arc<[Code]>> {
    let codes = compiled.taylor.as_ref()?;
    let size = compiled.plan.dimension();
    codes_of(|| {
        let system = recording(compiled);
        let mut recurrence = ByCodes::new(&system, codes);
        let mu = source_numbers(size, |place| Source::Argument(0, place));
        let unit = Recorded::from_source(Source::Argument(1, 0));
        let mut field = vec![Recorded::zero(); size];
        recurrence.begin(&mu, &mut field);
        let mut rows = vec![mu];
        for k in 1..=last {
            let factor = Recorded::ratio(1.0, k as f64) * unit;
            let coefficient: Vec<_> = field.iter().map(|entry| *entry * factor).collect();
            if k < last {
                recurrence.advance(k, &coefficient, &mut field);
            }
            rows.push(coefficient);
        }
        let at_ends = [0, last, last - 1].map(|k| &rows[k][..]);
        let ends = Ends::of(at_ends, system.clock());
        let part = Recorded::from_source(Source::Argument(1, 1));
        let reach = Reach::of(&ends, last, part);
        let mut told = recurrence.conditions(0..last).to_vec();
        told.extend(ends.sizes);
        told.extend([ends.lanes.number(), reach.length, reach.shift]);
        told.push(reach.lanes.number());
        let mut rows = rows.concat();
        if beside {
            // the others keep theirs
            let developed = Recorded::<1>::from_source(Source::Argument(1, 2)).mask();
            let before = source_numbers(rows.len(), |place| Source::Argument(2, place));
            for (entry, before) in rows.iter_mut().zip(before) {
                *entry = Scalar::select(developed, *entry, before);
            }
        }
        Some([rows, told])
    })
}

fn sum(size: usize, last: usize) -> Option<Arc<[Code]>> {
    codes_of(|| {
        let rows = source_numbers((last + 1 + BEYOND) * size, |place| {
            Source::Argument(0, place)
        });
        let time = Recorded::from_source(Source::Argument(1, 0));
        let mut out = vec![Recorded::zero(); size];
        sum_of_series(|k| &rows[k * size..][..size], last, time, &mut out);
        Some([out, Vec::new()])
    })
}

/// The series of a system by programs, once so many were made that it pays.
pub(crate) struct Development<'a, S: Scalar> {
    system: &'a Dynamic<S>,
    wait: Countdown,
    /// The order that the programs are for.
    last: usize,
    ready: Option<[Ready<S>; 2]>,
    /// The series, and the one before.
    coefficients: Vec<S>,
    before: Vec<S>,
    /// Conditions, and what is told.
    told: Vec<S>,
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
            before: Vec::new(),
            told: Vec::new(),
        })
    }

    fn size(&self) -> usize {
        self.system.values.compiled.plan.dimension()
    }

    fn codes(&self, last: usize) -> Option<Arc<SeriesCodes>> {
        let compiled = &self.system.values.compiled;
        let kind = (last, S::LANES > 1);
        compiled
            .series
            .get(&kind, || SeriesCodes::new(compiled, kind))
    }

    /// Develops in some lanes; false where it is not run as a program. `rows` have the series before the first one by a program.
    pub fn run(
        &mut self,
        mu: &[S],
        [unit, part]: [S; 2],
        last: usize,
        rows: &[Vec<S>],
        lanes: S::Mask,
    ) -> bool {
        if last != self.last {
            self.last = last;
            self.ready = None;
            let kind = (last, S::LANES > 1);
            let known = self.system.values.compiled.series.cached(&kind);
            let machine = &self.system.values.machine;
            let there = known.is_some_and(|codes| machine.has_compiled(&codes.develop));
            if self.wait.left == 0 || there {
                self.compile(rows);
            }
        }
        if self.wait.left > 0 && self.ready.is_none() {
            let mut wait = std::mem::replace(&mut self.wait, Countdown::new(0, 1));
            let over = wait.is_over(|| self.codes(last).map_or(0, |codes| codes.length()));
            self.wait = wait;
            if over {
                self.compile(rows);
            }
        }
        let Some([Ready { machine, of_step }, _]) = &self.ready else {
            return false;
        };
        std::mem::swap(&mut self.coefficients, &mut self.before);
        let given = [unit, part, S::select(lanes, S::one(), S::zero())];
        let arguments = [mu, &given, &self.before, &[]];
        let frame = self.system.values.frame(arguments, of_step, &[]);
        machine.run(1, &frame, [&mut self.coefficients, &mut self.told]);
        true
    }

    /// The series that is kept.
    pub fn series(&self) -> Option<KeptSeries<'_, S>> {
        let [.., state, last, before, lanes, length, shift, known] = self.told[..] else {
            return None;
        };
        let holds = |number| S::ratio(1.0, 2.0).less(number);
        Some(KeptSeries {
            coefficients: &self.coefficients,
            size: self.size(),
            ends: Ends {
                sizes: [state, last, before],
                lanes: holds(lanes),
            },
            reach: Reach {
                length,
                shift,
                lanes: holds(known),
            },
        })
    }

    /// The conditions along it, one order after the other.
    pub fn conditions(&self) -> &[S] {
        &self.told[..self.told.len().saturating_sub(TOLD)]
    }

    /// Its sum at a time.
    pub fn sum(&self, time: S, out: &mut [S]) {
        if let Some([_, Ready { machine, of_step }]) = &self.ready {
            let arguments = [&self.coefficients, &[time][..], &[], &[]];
            let frame = self.system.values.frame(arguments, of_step, &[]);
            machine.run(1, &frame, [out, &mut []]);
        }
    }

    /// From the rows of the series before.
    #[cold]
    fn compile(&mut self, rows: &[Vec<S>]) {
        let Some(codes) = self.codes(self.last) else {
            return;
        };
        let ready = |codes| Ready::new(self.system, codes, S::zero(), false);
        self.ready = ready(&codes.develop).and_then(|one| Some([one, ready(&codes.sum)?]));
        let orders = self.last + 1;
        self.coefficients = rows[..orders].concat();
        let all = (orders + BEYOND) * self.size();
        self.coefficients.resize(all, S::zero());
        self.before = self.coefficients.clone();
        let codes = self.system.values.compiled.taylor.as_ref();
        let conditions = codes.map_or(0, |codes| codes.conditions());
        self.told = vec![S::zero(); self.last * conditions + TOLD];
    }
}
