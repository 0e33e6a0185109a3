//! Phase portraits and sections: one coordinate against another.

use super::chart::{Axis, Chart, Panel, Series, Stroke, one_of};
use super::surface::Surface;
use super::svg::Place;
use super::trace::Trace;

const SIZE: Place = (680.0, 520.0);
/// Cells along a side, and level curves.
const CELLS: usize = 60;
const LEVELS: usize = 14;

/// A picture of two coordinates.
#[derive(Clone, Debug)]
pub struct Phase {
    title: String,
    subtitle: String,
    names: [String; 2],
    runs: Vec<Run>,
    behind: Vec<Vec<Place>>,
}

#[derive(Clone, Debug)]
struct Run {
    name: String,
    trace: Trace,
    dots: Vec<Place>,
}

impl Phase {
    /// A picture of two coordinates by their names.
    pub fn new(title: &str, subtitle: &str, names: [String; 2]) -> Self {
        Self {
            title: title.to_owned(),
            subtitle: subtitle.to_owned(),
            names,
            runs: Vec::new(),
            behind: Vec::new(),
        }
    }

    /// Changes the second line of the picture.
    pub fn subtitle(&mut self, subtitle: &str) {
        subtitle.clone_into(&mut self.subtitle);
    }

    /// Begins a further run.
    pub fn begin(&mut self, name: impl Into<String>) {
        self.runs.push(Run {
            name: name.into(),
            trace: Trace::stretched(),
            dots: Vec::new(),
        });
    }

    /// Takes the next point of the run, which a line joins to the one before.
    pub fn push(&mut self, point: Place) {
        if let Some(run) = self.runs.last_mut() {
            run.trace.push(point);
        }
    }

    /// Takes a point by itself.
    pub fn dot(&mut self, point: Place) {
        if let Some(run) = self.runs.last_mut() {
            run.dots.push(point);
        }
    }

    /// Level curves of a function around what there is.
    pub fn levels(&mut self, function: &dyn Fn(Place) -> f64) {
        let bounds = self.runs.iter().filter_map(|run| run.trace.bounds());
        let bounds = bounds
            .reduce(|(a, b), (c, d)| ((a.0.min(c.0), a.1.min(c.1)), (b.0.max(d.0), b.1.max(d.1))));
        let Some((low, high)) = bounds else { return };
        let margin = |a: f64, b: f64| 0.15 * if b > a { b - a } else { a.abs().max(1.0) };
        let (dx, dy) = (margin(low.0, high.0), margin(low.1, high.1));
        let (low, high) = ((low.0 - dx, low.1 - dy), (high.0 + dx, high.1 + dy));
        let along = |a: f64, b: f64, k: usize| a + (b - a) * k as f64 / CELLS as f64;
        let mut plane = Surface::default();
        for i in 0..=CELLS {
            for j in 0..=CELLS {
                let point = [along(low.0, high.0, i), along(low.1, high.1, j), 0.0];
                plane.points.push(point);
                if i < CELLS && j < CELLS {
                    let at = i * (CELLS + 1) + j;
                    let (right, both) = (at + CELLS + 1, at + CELLS + 2);
                    plane.triangles.push([at, right, both]);
                    plane.triangles.push([at, both, at + 1]);
                }
            }
        }
        let values: Vec<f64> = plane
            .points
            .iter()
            .map(|p| function((p[0], p[1])))
            .collect();
        let mut sorted: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
        sorted.sort_by(f64::total_cmp);
        let Some(last) = sorted.len().checked_sub(1) else {
            return;
        };
        // as many points between two levels everywhere
        for k in 1..=LEVELS {
            let level = sorted[last * k / (LEVELS + 1)];
            for chain in plane.curves(&values, level) {
                self.behind
                    .push(chain.iter().map(|p| (p[0], p[1])).collect());
            }
        }
    }

    /// How many points stand by themselves.
    pub fn dots(&self) -> usize {
        self.runs.iter().map(|run| run.dots.len()).sum()
    }

    /// The picture.
    pub fn to_svg(&self) -> String {
        let curve = |name: &str, colour, stroke, pieces: &[Vec<Place>]| {
            let gap = (f64::NAN, f64::NAN);
            let points = pieces
                .iter()
                .flat_map(|piece| piece.iter().copied().chain([gap]));
            Series {
                name: name.to_owned(),
                colour,
                stroke,
                points: points.collect(),
            }
        };
        let mut series = Vec::new();
        if !self.behind.is_empty() {
            series.push(curve("level curves of H", 0, Stroke::Level, &self.behind));
        }
        let many = self.runs.len();
        for (place, run) in self.runs.iter().enumerate() {
            let (colour, named) = one_of(place, many);
            let name = if named && many > 1 { &run.name } else { "" };
            if !run.dots.is_empty() {
                series.push(Series {
                    name: name.to_owned(),
                    colour,
                    stroke: Stroke::Dots,
                    points: run.dots.clone(),
                });
            }
            series.push(curve(name, colour, Stroke::Curve, run.trace.pieces()));
        }
        let [x, y] = &self.names;
        let panel = Panel {
            title: String::new(),
            x: Axis::linear(x),
            y: Axis::linear(y),
            series,
        };
        let chart = Chart {
            title: self.title.clone(),
            subtitle: self.subtitle.clone(),
            panels: vec![panel],
            across: 1,
        };
        chart.with_panels_of(SIZE)
    }
}
