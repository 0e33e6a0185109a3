//! Several runs side by side: two coordinates of each, and the errors of their invariants over time.

use super::bins::Bins;
use super::chart::{Axis, Chart, Panel, Series, Stroke};
use super::reference;
use super::rows::Rows;
use super::trace::Trace;

/// Panels in a row.
const ACROSS: usize = 3;
/// Points of an error's curve.
const COLUMNS: usize = 240;
/// An exact zero is drawn here.
const ROUND_OFF: f64 = f64::EPSILON / 2.0;

/// A picture of several runs.
#[derive(Clone, Debug)]
pub struct Compare {
    title: String,
    subtitle: String,
    /// `t`, the coordinates, the invariants.
    columns: Vec<String>,
    states: usize,
    runs: Vec<Run>,
}

#[derive(Clone, Debug)]
struct Run {
    name: String,
    phase: Trace,
    rows: Rows,
    errors: Vec<Bins>,
    first: Vec<f64>,
    scale: f64,
}

impl Compare {
    /// A picture of rows with these columns: `t`, then so many coordinates, then invariants.
    pub fn new(title: &str, subtitle: &str, columns: &[String], states: usize) -> Self {
        Self {
            title: title.to_owned(),
            subtitle: subtitle.to_owned(),
            columns: columns.to_vec(),
            states,
            runs: Vec::new(),
        }
    }

    /// Changes the second line of the picture.
    pub fn subtitle(&mut self, subtitle: &str) {
        subtitle.clone_into(&mut self.subtitle);
    }

    /// Begins a further run from the first time to the second.
    pub fn begin(&mut self, name: impl Into<String>, range: (f64, f64)) {
        let invariants = self.columns.len() - 1 - self.states;
        self.runs.push(Run {
            name: name.into(),
            phase: Trace::stretched(),
            rows: Rows::default(),
            errors: vec![Bins::new(range, COLUMNS); invariants],
            first: Vec::new(),
            scale: 0.0,
        });
    }

    /// Takes a row of the run.
    pub fn push(&mut self, row: &[f64]) {
        let (states, width) = (self.states, self.columns.len());
        let Some(run) = self.runs.last_mut() else {
            return;
        };
        let (t, state) = (row[0], &row[1..=states]);
        let invariants = &row[1 + states..width];
        let point = (state[0], state[1.min(states - 1)]);
        run.phase.push(point);
        run.rows.push(point);
        run.scale = state.iter().fold(run.scale, |scale, x| scale.max(x.abs()));
        if run.first.is_empty() {
            run.first = invariants.to_vec();
            return;
        }
        for ((bins, first), value) in run.errors.iter_mut().zip(&run.first).zip(invariants) {
            bins.push(t, (value - first).abs());
        }
    }

    /// Takes a point between rows, with the columns of a row: the curve goes through it. The errors are those of the rows.
    pub fn between(&mut self, row: &[f64]) {
        let other = 1 + 1.min(self.states - 1);
        if let Some(run) = self.runs.last_mut() {
            run.phase.push((row[1], row[other]));
            run.rows.add_between();
        }
    }

    /// The picture.
    pub fn to_svg(&self) -> String {
        let gap = (f64::NAN, f64::NAN);
        let mut panels = Vec::new();
        for (colour, run) in self.runs.iter().enumerate() {
            let pieces = run.phase.pieces().iter();
            let points = pieces.flat_map(|piece| piece.iter().copied().chain([gap]));
            let mut series = vec![Series {
                name: run.name.clone(),
                colour,
                stroke: Stroke::Curve,
                points: points.collect(),
            }];
            series.extend(run.rows.series(&run.name, colour));
            panels.push(Panel {
                title: run.name.clone(),
                x: Axis::linear(&self.columns[1]),
                y: Axis::linear(&self.columns[2.min(self.states)]),
                series,
            });
        }
        for (place, name) in self.columns[1 + self.states..].iter().enumerate() {
            let absolute = |run: &Run| reference(run.first[place], run.scale).is_none();
            let runs = || self.runs.iter().filter(|run| !run.first.is_empty());
            let all = runs().any(absolute);
            let curves = self.runs.iter().enumerate().filter_map(|(colour, run)| {
                let first = *run.first.get(place)?;
                let divisor = if all { 1.0 } else { first.abs() };
                let error = |&(t, error): &(f64, f64)| (t, (error / divisor).max(ROUND_OFF));
                let pieces = run.errors[place].upper_envelope();
                let points = pieces
                    .iter()
                    .flat_map(|piece| piece.iter().map(error).chain([gap]));
                Some((&run.name, colour, points.collect::<Vec<_>>()))
            });
            let mut series: Vec<Series> = Vec::new();
            for (name, colour, points) in curves {
                let drawn = series.iter().any(|other| same(&other.points, &points));
                let stroke = if drawn { Stroke::Over } else { Stroke::Curve };
                series.push(Series {
                    name: name.clone(),
                    colour,
                    stroke,
                    points,
                });
            }
            panels.push(Panel {
                title: format!(
                    "{} error of {name}",
                    if all { "absolute" } else { "relative" }
                ),
                x: Axis::linear("t"),
                y: Axis::logarithmic(""),
                series,
            });
        }
        let chart = Chart {
            title: self.title.clone(),
            subtitle: self.subtitle.clone(),
            panels,
            across: ACROSS,
        };
        chart.to_svg()
    }
}

/// Whether one curve would hide the other; gaps are alike.
fn same(a: &[(f64, f64)], b: &[(f64, f64)]) -> bool {
    let alike = |x: f64, y: f64| x == y || (x.is_nan() && y.is_nan());
    a.len() == b.len()
        && a.iter()
            .zip(b)
            .all(|(a, b)| alike(a.0, b.0) && alike(a.1, b.1))
}
