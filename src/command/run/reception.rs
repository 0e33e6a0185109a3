//! What becomes of the rows of a run: they are written, drawn, and their errors noted.

use std::io;

use lie_in_process::request::Plan;
use lie_program::protocol::{Event, Found, Times, Work};
use lie_runtime::driver::Pace;

use super::checkpoint::Place;
use super::keeper::Keeper;
use super::layout::{Layout, Places};
use super::picture::Picture;
use super::summary::Drift;
use crate::compiler::Spec;
use lie_output::{Rows, Run};

/// Takes what the program of a run finds.
pub struct Reception<'a, 'p> {
    rows: &'a mut Rows,
    /// Where one is wanted.
    picture: Option<&'a mut Picture<'p>>,
    /// Keeps a checkpoint, where one is wanted.
    keeper: Option<&'a mut Keeper>,
    /// What the output needs to begin, until there are rows: of a run that is refused, nothing is written.
    waiting: Option<Run>,
    received: Received,
    layout: Layout,
    /// Where the columns that are shown stand in a row of the program, and how wide that is.
    places: Places,
    width: usize,
    /// Whether the first row is only there for the others to be compared with.
    hidden: bool,
}

/// What is left of the rows.
pub struct Received {
    /// The errors of the invariants.
    pub drift: Drift,
    /// What was counted.
    pub work: Work,
    /// The step, given or chosen.
    pub step: f64,
    /// Whether round-off forbids the tolerance.
    pub at_round_off: bool,
    /// The smallest step, and from when on it was made, where steps became shorter on the way.
    pub shortened: Option<(f64, f64)>,
    /// From when on the tolerance is not kept.
    pub lost: Option<f64>,
    /// By which factor the steps differ that the tolerance allows, where it is large.
    pub uneven: Option<f64>,
    /// The events, in order of time.
    pub events: Vec<Event>,
    /// The error at the end, and whether it is much larger than the tolerance.
    pub assessed: Option<(f64, bool)>,
}

impl Received {
    /// The smallest step that was made.
    pub fn smallest(&self) -> f64 {
        self.shortened.map_or(self.step, |(step, _)| step)
    }

    /// Whether the error at the end may be larger than the tolerance.
    pub fn missed(&self) -> bool {
        self.lost.is_some() || self.assessed.is_some_and(|(_, missed)| missed)
    }
}

impl<'a, 'p> Reception<'a, 'p> {
    /// Before the rows of a run.
    pub fn new(
        spec: &Spec,
        plan: &Plan,
        layout: Layout,
        run: Run,
        rows: &'a mut Rows,
        (picture, keeper): (Option<&'a mut Picture<'p>>, Option<&'a mut Keeper>),
    ) -> Self {
        let model = &spec.model;
        let step = match plan.pace.0 {
            Pace::Step(step) => step,
            Pace::Tolerance(_) => f64::NAN,
        };
        let mut drift = Drift::new(&layout.watched_names()[layout.invariants.clone()]);
        for casimir in model.casimirs.iter().filter(|c| c.multivalued || !c.kept) {
            drift.leave_out(&casimir.name);
        }
        for quantity in model.quantities.iter().filter(|q| !q.is_conserved()) {
            drift.leave_out(&quantity.name);
        }
        Self {
            rows,
            waiting: Some(run),
            picture,
            keeper,
            received: Received {
                drift,
                work: Work::default(),
                step,
                at_round_off: false,
                shortened: None,
                lost: None,
                uneven: None,
                events: Vec::new(),
                assessed: None,
            },
            layout,
            places: Places::All(0),
            width: 0,
            hidden: !shows_start(plan),
        }
    }

    /// Goes on from a place of the run: errors are taken against its start, and rows go behind those that are there.
    ///
    /// # Errors
    /// The destination cannot be written.
    pub fn take_up(&mut self, place: &Place) -> io::Result<()> {
        self.hidden = false;
        self.received.shortened = place.shortened;
        self.received.drift.restore(&place.drift);
        self.received.events.clone_from(&place.events);
        if let Some(written) = &place.written
            && let Some(run) = self.waiting.take()
        {
            self.rows.take_up(&run, written)?;
        }
        Ok(())
    }

    /// The output, begun with the step, which is known now.
    fn begin(&mut self) -> io::Result<&mut Rows> {
        if let Some(mut run) = self.waiting.take() {
            run.step = self.received.step;
            self.rows.open(&run)?;
        }
        Ok(self.rows)
    }

    /// The times at which rows are asked for: errors are taken against the initial state, also where it is not shown.
    pub fn times(&self, plan: &Plan) -> Times {
        let with_start = |times: &[f64]| [&[plan.from], times].concat();
        match &plan.times {
            Times::At(times) if self.hidden => Times::At(with_start(times)),
            Times::Within { end, times } if self.hidden => Times::Within {
                end: *end,
                times: with_start(times),
            },
            times => times.clone(),
        }
    }

    /// Takes what the program has found.
    ///
    /// # Errors
    /// `InvalidData` for rows that are not those of the system; what the destination says.
    pub fn record(&mut self, found: Found) -> io::Result<()> {
        match found {
            Found::Chosen(chosen) => {
                self.received.step = chosen.step;
                self.received.at_round_off = chosen.at_round_off;
            }
            Found::Shortened { step, time } => self.received.shortened = Some((step, time)),
            Found::Lost { time } => self.received.lost = Some(time),
            Found::Uneven { factor } => self.received.uneven = Some(factor),
            Found::Assessed { error, missed } => self.received.assessed = Some((error, missed)),
            Found::Columns(columns) => {
                let places = self.layout.places(&columns).ok_or_else(|| {
                    let text = format!("these are not the columns of the system: {columns:?}");
                    io::Error::new(io::ErrorKind::InvalidData, text)
                })?;
                (self.places, self.width) = (places, columns.width());
            }
            Found::Rows(rows) | Found::Between(rows)
                if self.width == 0 || rows.width != self.width =>
            {
                let text = "rows come before their columns, or with others";
                return Err(io::Error::new(io::ErrorKind::InvalidData, text));
            }
            Found::Rows(rows) => self.push(rows.numbers)?,
            Found::Between(rows) => self.between(rows.numbers),
            Found::Milestone(milestone) => {
                if let Some(keeper) = &mut self.keeper {
                    keeper.keep(*milestone, self.rows, &self.received)?;
                }
            }
            Found::Event(event) => self.received.events.push(event),
            Found::Work(work) => self.received.work = work,
        }
        Ok(())
    }

    /// Draws states between rows, of which nothing else is wanted.
    fn between(&mut self, numbers: Vec<f64>) {
        let shown = self.places.shown(numbers, self.width);
        if let Some(picture) = &mut self.picture {
            let rows = shown.chunks_exact(self.places.len());
            rows.for_each(|row| picture.between(row));
        }
    }

    fn push(&mut self, numbers: Vec<f64>) -> io::Result<()> {
        let shown = self.places.shown(numbers, self.width);
        let columns = self.places.len();
        for row in shown.chunks_exact(columns) {
            let invariants = &self.layout.invariants;
            let watched = self.layout.watched(row);
            self.received
                .drift
                .push(&watched[..invariants.end], invariants.start);
            if let Some(picture) = &mut self.picture {
                picture.push(row);
            }
        }
        let from = if self.hidden { columns } else { 0 };
        self.hidden = false;
        self.begin()?.push(&shown[from..])
    }

    /// Writes what stands behind the rows: how the run ended. Of one that ended before its first row nothing is written.
    ///
    /// # Errors
    /// The destination cannot be written.
    pub fn finish(mut self, word: &'static str) -> io::Result<Received> {
        if matches!(word, "done" | "stopped") || self.waiting.is_none() {
            let events = std::mem::take(&mut self.received.events);
            self.begin()?.close(word, &events)?;
            self.received.events = events;
        }
        Ok(self.received)
    }
}

fn shows_start(plan: &Plan) -> bool {
    match &plan.times {
        Times::Until { .. } => true,
        Times::At(times) | Times::Within { times, .. } => times.first() == Some(&plan.from),
    }
}
