//! The rows of a run as they come, with progress, and the wish to stop.

use crate::protocol::{Columns, Coordinates, End, Event, Found, Milestone, Milestones, Rows};
use crate::session::Session;
use core::ops::ControlFlow;
use lie_runtime::driver::{
    self, Assessed, Chosen, Motion, Observer, Progress, Quantities, Reconstruction,
};
use lie_runtime::{MatrixGroup, Poisson, State};
use std::time::{Duration, Instant};

const FLUSH: Duration = Duration::from_millis(150);
/// The clock is looked at about this often, whatever a step costs.
const LOOK: Duration = Duration::from_millis(10);
/// From one milestone that is said to the next, where that is not asked for by their steps.
const BETWEEN: Duration = Duration::from_secs(1);
/// Numbers of rows that are said together, about.
const BLOCK: usize = 1 << 12;

/// Writes rows and progress.
pub struct RowWriter<'s, 'o> {
    session: &'s mut Session<'o, Found>,
    announced: bool,
    casimirs: Vec<f64>,
    quantities: Quantities<f64>,
    /// Rows that are not yet said, or states between rows.
    block: Rows,
    between: bool,
    /// Whether states between rows are said.
    curve: bool,
    /// Whether events are said.
    events: bool,
    /// Steps between two looks at the clock, and left until the next.
    stride: u32,
    left: u32,
    looked: Instant,
    flushed: Instant,
    /// Which milestones are said, the last one, and when that was.
    milestones: Milestones,
    last: u64,
    said: Instant,
    /// What is held from step to step.
    held: Option<driver::Held>,
}

impl<'s, 'o> RowWriter<'s, 'o> {
    /// A writer of the rows of a system.
    pub fn new<P: Poisson<f64>>(system: &P, session: &'s mut Session<'o, Found>) -> Self {
        let now = Instant::now();
        Self {
            session,
            announced: false,
            casimirs: vec![0.0; system.casimir_count()],
            quantities: Quantities::new(system),
            block: Rows::default(),
            between: false,
            curve: false,
            events: true,
            stride: 1,
            left: 1,
            looked: now,
            flushed: now,
            milestones: Milestones::None,
            last: 0,
            said: now,
            held: None,
        }
    }

    /// Says milestones after one of so many steps.
    pub(crate) fn saying(mut self, milestones: Milestones, last: u64) -> Self {
        (self.milestones, self.last) = (milestones, last);
        self
    }

    /// Goes on with the angles of a milestone.
    pub(crate) fn take_up(&mut self, milestone: &Milestone) {
        self.quantities.take_up(&milestone.angles());
    }

    /// Holds inputs and noise.
    pub(crate) fn holding(self, held: Option<driver::Held>) -> Self {
        Self { held, ..self }
    }

    /// Says states between rows too, where that is wanted.
    pub(crate) fn curve(self, curve: bool) -> Self {
        Self { curve, ..self }
    }

    /// Has no events, which end no run then.
    #[must_use]
    pub fn without_events(self) -> Self {
        Self {
            events: false,
            ..self
        }
    }

    /// Writes what is left.
    pub fn finish(mut self) {
        self.write_block();
        self.session.flush();
    }

    fn write_block(&mut self) {
        if self.block.count > 0 {
            let width = self.block.width;
            let block = core::mem::take(&mut self.block);
            self.session.mentions(match self.between {
                true => Found::Between(block),
                false => Found::Rows(block),
            });
            self.block.width = width;
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
        if now - self.flushed >= FLUSH {
            self.flushed = now;
            self.write_block();
            self.session.flush();
        }
        on(self.session.progress(progress.step, progress.steps))
    }

    /// Says a milestone, if it is one of those that are asked for.
    fn milestone<V: State<f64>>(&mut self, milestone: &driver::Milestone<V>, element: &[f64]) {
        let due = match self.milestones {
            Milestones::None => false,
            Milestones::Timed => self.said.elapsed() >= BETWEEN,
            Milestones::Every(steps) => milestone.index / steps.max(1) > self.last / steps.max(1),
        };
        if due {
            (self.last, self.said) = (milestone.index, Instant::now());
            self.write_block();
            let milestone = Milestone::new(milestone, element, &self.quantities.angles());
            self.session.found(Found::Milestone(Box::new(milestone)));
        }
    }

    /// One row, or a state between rows, with the group element at its end if there is one.
    fn write<P: Poisson<f64>>(
        &mut self,
        system: &P,
        (time, between): (f64, bool),
        mu: &P::State,
        element: &[f64],
    ) {
        if !self.announced {
            self.announced = true;
            self.announce(system, element.len());
        }
        if self.between != between {
            self.write_block();
            self.between = between;
        }
        system.casimirs(mu, &mut self.casimirs);
        let energy = system.energy(mu);
        self.block.numbers.reserve(self.block.width);
        let quantities = self.quantities.at(system, time, mu);
        for numbers in [
            &[time],
            &mu.as_slice()[..shown(system)],
            &[energy],
            &self.casimirs,
            quantities,
            element,
        ] {
            self.block.numbers.extend_from_slice(numbers);
        }
        self.block.count += 1;
        if self.block.numbers.len() >= BLOCK {
            self.write_block();
        }
    }

    fn announce<P: Poisson<f64>>(&mut self, system: &P, element: usize) {
        let dimension = shown(system);
        let names = || (0..dimension).map(|k| system.coordinate(k).to_owned());
        let coordinates = match system.sites() {
            Some(_) => Coordinates::OfSites(dimension),
            None => Coordinates::Named(names().collect()),
        };
        let casimirs = (0..system.casimir_count()).map(|k| system.casimir_name(k).to_owned());
        let quantities = (0..system.quantity_count()).map(|k| system.quantity_name(k).to_owned());
        let columns = Columns {
            coordinates,
            casimirs: casimirs.collect(),
            quantities: quantities.collect(),
            element,
        };
        self.block.width = columns.width();
        self.session.mentions(Found::Columns(columns));
    }
}

/// How many coordinates stand in a row: of a family those of its sites.
pub fn shown<P: Poisson<f64>>(system: &P) -> usize {
    let carried = system.sites().and(system.clock());
    carried.map_or(system.dimension(), |clock| clock.momentum)
}

/// Whether to go on; why not, the session knows.
fn on(state: Result<(), End>) -> ControlFlow<()> {
    match state {
        Ok(()) => ControlFlow::Continue(()),
        Err(_) => ControlFlow::Break(()),
    }
}

impl<P: Poisson<f64>> Observer<f64, P> for RowWriter<'_, '_> {
    fn hold(&mut self, system: &P, step: (u64, f64, f64), mu: &mut P::State, element: &[f64]) {
        self.held.hold(system, step, mu, element);
    }

    fn held(&self) -> Option<&driver::Held> {
        self.held.as_ref()
    }

    fn chosen(&mut self, chosen: &Chosen) {
        self.session.mentions(Found::Chosen(chosen.into()));
    }

    fn shortened(&mut self, progress: Progress, step: f64) {
        let time = progress.time;
        self.session.mentions(Found::Shortened { step, time });
    }

    fn lost(&mut self, progress: Progress) {
        let time = progress.time;
        self.session.mentions(Found::Lost { time });
    }

    fn uneven(&mut self, factor: f64) {
        self.session.mentions(Found::Uneven { factor });
    }

    fn compared(&mut self, _progress: Progress) -> ControlFlow<()> {
        match self.session.is_interrupted() {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }

    fn assessed(&mut self, assessed: &Assessed) {
        let (error, missed) = (assessed.error.unwrap_or(f64::NAN), assessed.missed());
        self.session.mentions(Found::Assessed { error, missed });
    }

    fn step(&mut self, system: &P, progress: Progress, mu: &P::State) -> ControlFlow<()> {
        if self.quantities.has_angles() {
            self.quantities.at(system, progress.time, mu);
        }
        if self.session.is_interrupted() {
            return ControlFlow::Break(());
        }
        self.left -= 1;
        if self.left == 0 {
            self.look(progress)
        } else {
            ControlFlow::Continue(())
        }
    }

    fn milestone(&mut self, _system: &P, milestone: &driver::Milestone<P::State>) {
        RowWriter::milestone(self, milestone, &[]);
    }

    fn row(&mut self, system: &P, time: f64, mu: &P::State) -> ControlFlow<()> {
        self.write(system, (time, false), mu, &[]);
        on(self.session.intact())
    }

    fn awaits_events(&self) -> bool {
        self.events
    }

    fn event(&mut self, system: &P, event: &driver::Event<P::State>) {
        self.session.mentions(Found::Event(Event {
            name: system.event_name(event.index).to_owned(),
            time: event.time,
            state: event.mu.as_slice().to_vec(),
            stops: event.stops,
        }));
    }

    fn draws(&self) -> bool {
        self.curve
    }

    fn between(&mut self, system: &P, time: f64, mu: &P::State) {
        self.write(system, (time, true), mu, &[]);
    }
}

/// Writes rows that end with the group element.
pub(crate) struct OnGroup<'r, 's, 'o, V> {
    pub(crate) reconstruction: Reconstruction<f64, V>,
    pub(crate) rows: &'r mut RowWriter<'s, 'o>,
}

impl<P: MatrixGroup<f64>> Observer<f64, P> for OnGroup<'_, '_, '_, P::State> {
    fn follows_motion(&self) -> bool {
        true
    }

    fn hold(&mut self, system: &P, step: (u64, f64, f64), mu: &mut P::State, _element: &[f64]) {
        Observer::<f64, P>::hold(self.rows, system, step, mu, self.reconstruction.element());
    }

    fn held(&self) -> Option<&driver::Held> {
        self.rows.held.as_ref()
    }

    fn chosen(&mut self, chosen: &Chosen) {
        Observer::<f64, P>::chosen(self.rows, chosen);
    }

    fn shortened(&mut self, progress: Progress, step: f64) {
        Observer::<f64, P>::shortened(self.rows, progress, step);
    }

    fn lost(&mut self, progress: Progress) {
        Observer::<f64, P>::lost(self.rows, progress);
    }

    fn uneven(&mut self, factor: f64) {
        Observer::<f64, P>::uneven(self.rows, factor);
    }

    fn compared(&mut self, progress: Progress) -> ControlFlow<()> {
        Observer::<f64, P>::compared(self.rows, progress)
    }

    fn assessed(&mut self, assessed: &Assessed) {
        Observer::<f64, P>::assessed(self.rows, assessed);
    }

    fn step(&mut self, system: &P, progress: Progress, mu: &P::State) -> ControlFlow<()> {
        self.rows.step(system, progress, mu)
    }

    fn milestone(&mut self, _system: &P, milestone: &driver::Milestone<P::State>) {
        let memory = self.reconstruction.memory();
        self.rows.milestone(milestone, &memory);
    }

    fn row(&mut self, system: &P, time: f64, mu: &P::State) -> ControlFlow<()> {
        let element = self.reconstruction.element();
        self.rows.write(system, (time, false), mu, element);
        on(self.rows.session.intact())
    }

    fn awaits_events(&self) -> bool {
        self.rows.events
    }

    fn event(&mut self, system: &P, event: &driver::Event<P::State>) {
        self.rows.event(system, event);
    }

    fn draws(&self) -> bool {
        self.rows.curve
    }

    fn between(&mut self, system: &P, time: f64, mu: &P::State) {
        let element = self.reconstruction.element();
        self.rows.write(system, (time, true), mu, element);
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
