//! A page's run: the rows of the steps that are asked for, with what happened on them.

use core::ops::ControlFlow;
use lie_dynamic::{Dynamic, Method};
use lie_runtime::Poisson as _;
use lie_runtime::diagnostics::Forgotten;
use lie_runtime::driver::{
    Event, Held, IntegrateError, Observer, Options, Problem, Progress, Quantities, Save, Source,
    Status, integrate,
};
use serde_json::{Value, json};

/// A run from its initial state on.
pub struct Run {
    system: Dynamic<f64>,
    method: Method<f64>,
    step: f64,
    mu: Vec<f64>,
    done: u64,
    held: Option<Held>,
    quantities: Quantities<f64>,
    stopped: Option<String>,
}

/// What a page has beside the coordinates that move: functions of the state that the run keeps, or that only its method changes.
#[derive(Clone, Copy)]
enum Invariant {
    /// H.
    Energy,
    /// `H - work` of what acts, the quantity of this place.
    Balance(usize),
    Casimir(usize),
    /// A declared first integral, the quantity of this place.
    Integral(usize),
}

/// The places of the coordinates that are shown: not those that carry the time and what is held.
fn shown(system: &Dynamic<f64>) -> Vec<usize> {
    match system.clock() {
        None => (0..system.dimension()).collect(),
        Some(clock) => (0..clock.momentum)
            .chain(clock.momentum + 1..clock.time)
            .collect(),
    }
}

fn invariants(system: &Dynamic<f64>) -> Vec<Invariant> {
    let mut all = Vec::new();
    let quantities = || 0..system.quantity_count();
    // no other quantity has this name
    let work = quantities().find(|place| system.quantity_name(*place) == "work");
    match (system.noise_count(), system.clock(), work) {
        (0, _, Some(work)) => all.push(Invariant::Balance(work)),
        (0, None, _) => all.push(Invariant::Energy),
        _ => {}
    }
    let casimirs = (0..system.casimir_count()).filter(|index| system.casimir_is_kept(*index));
    all.extend(casimirs.map(Invariant::Casimir));
    let integrals = quantities().filter(|place| system.quantity_is_conserved(*place));
    all.extend(integrals.map(Invariant::Integral));
    all
}

impl Run {
    /// Before its first step; `seed` is that of the noise.
    pub fn new(
        system: Dynamic<f64>,
        method: Method<f64>,
        (step, seed): (f64, u64),
        mu: Vec<f64>,
    ) -> Self {
        let held = Held::of(&system, 0.0, (seed, &[0]));
        Self {
            held: held.map(|held| held.bounded(!method.claims().explicit)),
            quantities: Quantities::new(&system),
            system,
            method,
            step,
            mu,
            done: 0,
            stopped: None,
        }
    }

    /// The names of what rows hold, of the inputs with their values, and of the events.
    pub fn about(&self) -> Value {
        let system = &self.system;
        let invariant = |invariant: &Invariant| match invariant {
            Invariant::Energy => "energy",
            Invariant::Balance(_) => "energy - work",
            Invariant::Casimir(index) => system.casimir_name(*index),
            Invariant::Integral(place) => system.quantity_name(*place),
        };
        let coordinates = shown(system).into_iter();
        let coordinates: Vec<&str> = coordinates.map(|place| system.coordinate(place)).collect();
        let invariants = invariants(system);
        let invariants: Vec<&str> = invariants.iter().map(invariant).collect();
        let quantities: Vec<&str> = (0..system.quantity_count())
            .map(|place| system.quantity_name(place))
            .collect();
        let events: Vec<&str> = (0..system.event_count())
            .map(|index| system.event_name(index))
            .collect();
        let inputs: Vec<Value> = self
            .inputs()
            .map(|(name, place)| json!({ "name": name, "value": self.mu[place] }))
            .collect();
        json!({
            "coordinates": coordinates,
            "invariants": invariants,
            "quantities": quantities,
            "events": events,
            "inputs": inputs,
            // a coin is no noise
            "noises": system.noise_count() - usize::from(system.tosses_coin()),
        })
    }

    /// The inputs by name, with their places in the state.
    fn inputs(&self) -> impl Iterator<Item = (&str, usize)> {
        let first = self.system.clock().map_or(0, |clock| clock.time + 2);
        let places = first..first + self.system.input_count();
        places.map(|place| (self.system.coordinate(place), place))
    }

    fn time(&self) -> f64 {
        self.done as f64 * self.step
    }

    /// Holds an input at a value from here on.
    ///
    /// # Errors
    /// There is no such input.
    pub fn set_input(&mut self, name: &str, value: f64) -> Result<(), String> {
        let index = self.inputs().position(|(known, _)| known == name);
        let index = index.ok_or_else(|| format!("there is no input `{name}`"))?;
        let source = Source::Table {
            times: [self.time()].into(),
            values: [value].into(),
        };
        self.held = self.held.take().map(|held| held.with(index, source));
        Ok(())
    }

    /// Makes steps: a row behind each `every`-th one, the first state before them, the events on them, and why they ended early.
    pub fn advance(&mut self, steps: u64, every: u64) -> Value {
        let mut rows = Vec::new();
        if self.done == 0 {
            rows.push(row(&self.system, 0.0, &self.mu, &mut self.quantities));
        }
        let start = self.time();
        let mut seen = Seen {
            first: self.done,
            step: self.step,
            every,
            // one that has set no noise yet: the state has the rates of the step before
            held: self.held.clone(),
            quantities: &mut self.quantities,
            last: (self.done, self.mu.clone()),
            rows,
            events: Vec::new(),
        };
        if self.stopped.is_none() && steps > 0 {
            let problem = Problem {
                system: self.system.clone(),
                mu0: self.mu.clone(),
                span: (start, start + steps as f64 * self.step),
            };
            let options = Options::new(self.step).save(Save::Ends);
            let ended = integrate(&problem, Forgotten(&*self.method), &options, &mut seen);
            self.stopped = match ended {
                Ok((_, Status::Event(index))) => {
                    let name = self.system.event_name(index);
                    Some(format!("the event {name} ended the run"))
                }
                Ok(_) => None,
                Err(IntegrateError::Option(error)) => Some(error.to_string()),
                Err(IntegrateError::Step(error)) => Some(format!(
                    "the step from t = {} failed: {}; {}",
                    seen.last.0 as f64 * self.step,
                    error.failure.reason,
                    error.failure.reason.remedy()
                )),
            };
        }
        let Seen {
            last, rows, events, ..
        } = seen;
        (self.done, self.mu) = last;
        json!({ "rows": rows, "events": events, "stopped": self.stopped })
    }
}

/// Time, coordinates, energy, invariants, quantities, and the generator of the motion on the coordinates.
fn row(
    system: &Dynamic<f64>,
    time: f64,
    mu: &Vec<f64>,
    quantities: &mut Quantities<f64>,
) -> Vec<f64> {
    let mut casimirs = vec![0.0; system.casimir_count()];
    system.casimirs(mu, &mut casimirs);
    let mut generator = system.zero_state();
    system.generator(mu, &mut generator);
    let quantities = quantities.at(system, time, mu);
    let energy = system.energy(mu);
    let invariant = |invariant: Invariant| match invariant {
        Invariant::Energy => energy,
        Invariant::Balance(work) => energy - quantities[work],
        Invariant::Casimir(index) => casimirs[index],
        Invariant::Integral(place) => quantities[place],
    };
    let shown = shown(system);
    let mut row = vec![time];
    row.extend(shown.iter().map(|place| mu[*place]));
    row.push(energy);
    row.extend(invariants(system).into_iter().map(invariant));
    row.extend(quantities);
    row.extend(shown.iter().map(|place| generator[*place]));
    row
}

/// What is seen of the steps of a request.
struct Seen<'a> {
    /// The steps before the request.
    first: u64,
    step: f64,
    every: u64,
    held: Option<Held>,
    quantities: &'a mut Quantities<f64>,
    /// The last step with its state.
    last: (u64, Vec<f64>),
    rows: Vec<Vec<f64>>,
    events: Vec<Value>,
}

impl Observer<f64, Dynamic<f64>> for Seen<'_> {
    fn hold(
        &mut self,
        system: &Dynamic<f64>,
        (index, time, step): (u64, f64, f64),
        mu: &mut Vec<f64>,
        element: &[f64],
    ) {
        if let Some(held) = &mut self.held {
            held.set(system, (self.first + index, time, step), mu, element);
        }
    }

    fn held(&self) -> Option<&Held> {
        self.held.as_ref()
    }

    fn step(
        &mut self,
        system: &Dynamic<f64>,
        progress: Progress,
        mu: &Vec<f64>,
    ) -> ControlFlow<()> {
        let done = self.first + progress.step;
        self.last = (done, mu.clone());
        let time = done as f64 * self.step;
        if done.is_multiple_of(self.every) {
            self.rows.push(row(system, time, mu, self.quantities));
        } else if self.quantities.has_angles() {
            self.quantities.at(system, time, mu);
        }
        ControlFlow::Continue(())
    }

    fn awaits_events(&self) -> bool {
        true
    }

    fn event(&mut self, system: &Dynamic<f64>, event: &Event<Vec<f64>>) {
        self.events.push(json!({
            "event": system.event_name(event.index),
            "t": event.time,
            "stops": event.stops,
        }));
        if event.stops {
            let row = row(system, event.time, &event.mu, self.quantities);
            self.rows.push(row);
        }
    }
}
