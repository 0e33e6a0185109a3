//! What `--plot` draws of runs, as `--picture` says.

pub mod choice;
mod file;
mod quaternions;
#[cfg(feature = "raster")]
mod raster;
mod section;
mod tip;

use lie_dynamic::Dynamic;
use lie_in_process::request::{Plan, Several};
use lie_plot::compare::Compare;
use lie_plot::phase::Phase;
use lie_plot::surface::{Field, Point};
use lie_plot::view::{OnSurface, View};
use lie_plot::{Plot, are_dots};
use lie_program::protocol::{Event, Start};
use lie_runtime::Poisson as _;
use lie_runtime::driver::{Chart, Pace};

pub use choice::{Kind, kind};
pub use file::{Form, form};
use quaternions::Quaternions;
use section::Section;
use tip::tip;

use super::layout::Layout;
use crate::build;
use crate::compiler::Spec;

/// So many runs that stopped early are named in a picture.
const SHOWN: usize = 3;
/// What is said where steps are so long that a curve between them is drawn.
const DOTS: &str = "; dots: the rows";
/// What is said where each run has an energy of its own.
const NO_LEVELS: &str = "; no level curves of H: parameters differ between runs";

/// A number with six digits at most.
pub fn rounded(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

/// A picture in the making.
pub struct Picture<'a> {
    spec: &'a Spec,
    layout: Layout,
    several: &'a Several,
    subtitle: String,
    /// The names of runs that ended early, how and when.
    stopped: Vec<(String, String)>,
    drawn: Drawn,
    chart: Option<Chart>,
    quaternions: Quaternions,
    /// Rows that were drawn.
    rows: u64,
    /// Those of the run that is being drawn, and the states between them.
    of_run: usize,
    between: usize,
    /// Whether rows of some run are dots.
    dotted: bool,
}

enum Drawn {
    /// Nothing before the first run.
    Nothing(Kind),
    Components(Box<Plot>),
    Compare(Compare),
    Phase(Phase, [usize; 2], Option<Box<Dynamic<f64>>>),
    Section(Phase, Box<Section>),
    Orbit(Vec<OnSurface>, Box<Dynamic<f64>>),
    Attitude(Vec<OnSurface>),
}

/// The system of a run, where the command has it.
fn system(spec: &Spec, start: &Start) -> Option<Dynamic<f64>> {
    let values = spec.model.parameters.iter();
    let values = values.map(|p| start.parameters.get(&p.name).copied());
    let values: Option<Vec<f64>> = values.collect();
    build::declared(&spec.model)?.system(&values?).ok()
}

impl<'a> Picture<'a> {
    /// A picture of runs, the rows of which have this layout.
    pub fn new(spec: &'a Spec, layout: Layout, kind: Kind, several: &'a Several) -> Self {
        Self {
            spec,
            layout,
            several,
            subtitle: String::new(),
            stopped: Vec::new(),
            drawn: Drawn::Nothing(kind),
            chart: None,
            quaternions: Quaternions::default(),
            rows: 0,
            of_run: 0,
            between: 0,
            dotted: false,
        }
    }

    /// Begins a further run.
    pub fn begin(&mut self, name: &str, plan: &Plan, start: &Start) {
        self.end_run();
        self.chart = plan.chart;
        self.quaternions = Quaternions::of(plan.chart, self.layout.element);
        if let Drawn::Nothing(kind) = self.drawn {
            self.subtitle = self.second_line(plan);
            self.drawn = self.first(kind, plan, start);
        }
        match &mut self.drawn {
            Drawn::Nothing(_) | Drawn::Components(_) => {}
            Drawn::Compare(compare) => compare.begin(name, (plan.from, plan.end())),
            Drawn::Phase(phase, ..) => phase.begin(name),
            Drawn::Section(phase, section) => {
                phase.begin(name);
                section.begin(system(self.spec, start));
            }
            Drawn::Orbit(curves, _) | Drawn::Attitude(curves) => {
                curves.push(OnSurface::new(name));
            }
        }
    }

    /// Takes note of whether its rows are dots.
    fn end_run(&mut self) {
        let section = matches!(self.drawn, Drawn::Section(..));
        self.dotted |= are_dots(self.of_run, self.between) && !section;
        (self.of_run, self.between) = (0, 0);
    }

    /// Whether nothing was drawn.
    pub fn is_empty(&self) -> bool {
        self.rows == 0
    }

    /// Takes note that a run stopped early.
    pub fn stopped(&mut self, name: &str, time: f64) {
        let how = format!("stopped at t = {}", rounded(time));
        self.stopped.push((name.to_owned(), how));
    }

    /// Takes note that an event ended a run.
    pub fn ended(&mut self, name: &str, event: &Event) {
        let how = format!("`{}` at t = {}", event.name, rounded(event.time));
        self.stopped.push((name.to_owned(), how));
    }

    /// The second line at the end: which runs stopped early, too.
    fn whole_line(&self) -> String {
        let mut line = self.subtitle.clone();
        for (name, how) in self.stopped.iter().take(SHOWN) {
            let who = match self.several.members.len() {
                1 => String::new(),
                _ => format!("{name} "),
            };
            line.push_str(&format!("; {who}{how}"));
        }
        if let Some(more @ 1..) = self.stopped.len().checked_sub(SHOWN) {
            line.push_str(&format!("; and {more} more"));
        }
        if self.dotted {
            line.push_str(DOTS);
        }
        let would = match self.drawn {
            Drawn::Orbit(..) => true,
            Drawn::Phase(_, axes, _) => {
                self.spec.model.counts().0 == 2 && axes.iter().all(|axis| *axis < 2)
            }
            _ => false,
        };
        if would && !self.has_levels() {
            line.push_str(NO_LEVELS);
        }
        line
    }

    fn second_line(&self, plan: &Plan) -> String {
        let written = plan.pace.1.trim();
        let who = match (self.several.members.len(), self.several.method()) {
            (1, _) => plan.method.title(),
            (runs, Some(method)) => format!("{runs} runs of {method}"),
            (runs, None) => format!("{runs} runs"),
        };
        match plan.pace.0 {
            Pace::Step(_) => format!("{who}, h = {written}"),
            Pace::Tolerance(_) => format!("{who}, tolerance {written}"),
        }
    }

    /// Whether one energy is that of all runs, so that its level curves say something of each.
    fn has_levels(&self) -> bool {
        !self.several.parameters_differ()
    }

    fn first(&self, kind: Kind, plan: &Plan, start: &Start) -> Drawn {
        let names = &self.layout.columns;
        let (name, columns) = (&*self.spec.model.name, names.made(0..names.len()));
        let watched = self.layout.watched_names();
        let entries = names.len() - self.layout.element;
        let (known, element) = watched.split_at(watched.len() - entries);
        let (own, recorded) = known.split_at(self.layout.invariants.end);
        let phase = |[x, y]: [usize; 2]| {
            let names = [columns[1 + x].clone(), columns[1 + y].clone()];
            Phase::new(name, "", names)
        };
        match kind {
            Kind::Components => {
                let plot = Plot::new(name, own, self.layout.states, (plan.from, plan.end()));
                let plot = plot.recorded(recorded).element(element);
                Drawn::Components(Box::new(plot))
            }
            Kind::Compare => {
                let compare = Compare::new(name, "", own, self.layout.states);
                Drawn::Compare(compare)
            }
            Kind::Phase(axes) => {
                let plane = self.spec.model.counts().0 == 2 && axes.iter().all(|axis| *axis < 2);
                let system = system(self.spec, start).filter(|_| plane && self.has_levels());
                Drawn::Phase(phase(axes), axes, system.map(Box::new))
            }
            Kind::Section(section) => {
                Drawn::Section(phase(section.axes), Box::new(Section::new(section)))
            }
            Kind::Orbit => match system(self.spec, start) {
                Some(system) => Drawn::Orbit(Vec::new(), Box::new(system)),
                None => Drawn::Nothing(kind),
            },
            Kind::Attitude => Drawn::Attitude(Vec::new()),
        }
    }

    /// Takes a row of the run.
    pub fn push(&mut self, row: &[f64]) {
        self.rows += 1;
        self.of_run += 1;
        let states = self.layout.states;
        match &mut self.drawn {
            Drawn::Nothing(_) => {}
            Drawn::Components(plot) => {
                plot.push(&self.layout.watched(&self.quaternions.continued(row)));
            }
            Drawn::Compare(compare) => {
                compare.push(&self.layout.watched(row)[..self.layout.invariants.end]);
            }
            Drawn::Phase(phase, [x, y], _) => phase.push((row[1 + *x], row[1 + *y])),
            Drawn::Section(phase, section) => pass(phase, section, row, states),
            Drawn::Orbit(curves, system) => {
                let point: Point = [row[1], row[2], row[3]];
                if let Some(curve) = curves.last_mut() {
                    curve.push(&point, &casimir(system, &point).1);
                }
            }
            Drawn::Attitude(curves) => {
                let tip = tip(self.chart, &row[self.layout.element..]);
                if let Some(curve) = curves.last_mut() {
                    curve.push(&tip, &tip);
                }
            }
        }
    }

    /// Takes a state of the run between two rows, with the same columns.
    pub fn between(&mut self, row: &[f64]) {
        self.between += 1;
        let states = self.layout.states;
        match &mut self.drawn {
            Drawn::Nothing(_) => {}
            Drawn::Components(plot) => {
                plot.between(&self.layout.watched(&self.quaternions.continued(row)));
            }
            Drawn::Compare(compare) => compare.between(row),
            Drawn::Phase(phase, [x, y], _) => phase.between((row[1 + *x], row[1 + *y])),
            Drawn::Section(phase, section) => pass(phase, section, row, states),
            Drawn::Orbit(curves, system) => {
                let point: Point = [row[1], row[2], row[3]];
                if let Some(curve) = curves.last_mut() {
                    curve.between(&point, &casimir(system, &point).1);
                }
            }
            Drawn::Attitude(curves) => {
                let tip = tip(self.chart, &row[self.layout.element..]);
                if let Some(curve) = curves.last_mut() {
                    curve.between(&tip, &tip);
                }
            }
        }
    }

    /// The picture as SVG, and what there is to say about it.
    pub fn finish(mut self) -> (String, Option<String>) {
        self.end_run();
        let name = &*self.spec.model.name;
        let line = self.whole_line();
        let levels = self.has_levels();
        let several = self.several.members.len() > 1;
        match self.drawn {
            Drawn::Nothing(_) => (
                View::new(name, &line, [(); 3].map(|()| String::new()), Vec::new()).to_svg(),
                None,
            ),
            Drawn::Components(plot) => (plot.subtitle(line).to_svg(), None),
            Drawn::Compare(mut compare) => {
                compare.subtitle(&line);
                (compare.to_svg(), None)
            }
            Drawn::Phase(mut phase, axes, system) => {
                phase.subtitle(&line);
                if let Some(system) = system {
                    phase.levels(&|(x, y)| {
                        let mut point = [0.0; 2];
                        (point[axes[0]], point[axes[1]]) = (x, y);
                        system.hamiltonian(&state_at(&system, &point))
                    });
                }
                (phase.to_svg(), None)
            }
            Drawn::Section(mut phase, section) => {
                let coordinate = self.layout.columns.get(1 + section.coordinate());
                phase.subtitle(&format!("{}; {line}", section.words(&coordinate)));
                let note = section.note(phase.dots());
                (phase.to_svg(), note)
            }
            Drawn::Orbit(curves, system) => {
                let names = [1, 2, 3].map(|k| self.layout.columns.get(k).into_owned());
                let mut view = View::new(name, &line, names, curves);
                let energy = |point: &Point| energy(&system, point);
                let surface = |point: &Point| casimir(&system, point);
                let of = system.casimir_name(0);
                let whose = if several { " of the first run" } else { "" };
                let note = format!("surface: {of} as at the start{whose}");
                let energy: &Field<'_> = &energy;
                let found = view.orbit(&surface, levels.then_some(energy), &note);
                let none = "there is no surface through the initial state: it is a point orbit";
                (view.to_svg(), (!found).then(|| none.to_owned()))
            }
            Drawn::Attitude(curves) => {
                let axes = ["e1", "e2", "e3"].map(str::to_owned);
                let mut view = View::new(name, &line, axes, curves);
                view.sphere(
                    "where the third axis of the group element points to: its third column",
                );
                (view.to_svg(), None)
            }
        }
    }
}

/// Draws the passage of a section since the last state, if there is one.
fn pass(phase: &mut Phase, section: &mut Section, row: &[f64], states: usize) {
    if let Some(point) = section.push(row[0], &row[1..=states]) {
        phase.dot(point);
    }
}

/// The state at a point of the coordinates that are shown; those of the time are there for a cocycle alone.
fn state_at(system: &Dynamic<f64>, point: &[f64]) -> Vec<f64> {
    let mut state = system.zero_state();
    state[..point.len()].copy_from_slice(point);
    if let Some(clock) = system.clock() {
        state[clock.time + 1] = 1.0;
    }
    state
}

/// The first Casimir of a three-dimensional system, and its gradient.
pub fn casimir(system: &Dynamic<f64>, point: &Point) -> (f64, Point) {
    let state = state_at(system, point);
    let mut gradient = system.zero_state();
    let mut values = vec![0.0; system.casimir_count()];
    system.casimirs(&state, &mut values);
    system.casimir_gradient(0, &state, &mut gradient);
    (values[0], [gradient[0], gradient[1], gradient[2]])
}

/// The energy of a three-dimensional system, and its gradient.
pub fn energy(system: &Dynamic<f64>, point: &Point) -> (f64, Point) {
    let state = state_at(system, point);
    let mut gradient = system.zero_state();
    system.gradient(&state, &mut gradient);
    let energy = system.hamiltonian(&state);
    (energy, [gradient[0], gradient[1], gradient[2]])
}
