//! Phase portraits and sections: one coordinate against another.

use super::chart::{Axis, Chart, Panel, Series, Stroke, shade_and_naming};
use super::rows::Rows;
use super::surface::Surface;
use super::svg::Place;
use super::trace::Trace;

const SIZE: Place = (680.0, 520.0);
/// Cells along a side at least and at most, and level curves.
const CELLS: usize = 60;
const MOST_CELLS: usize = 480;
const LEVELS: usize = 14;
/// How far a function may be from straight lines through the corners of cells, as a part of what lies between two levels.
const BENT: f64 = 0.05;
/// Energies that differ by no more than this part of their size differ by round-off.
const ROUND_OFF: f64 = 1e-11;

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
    rows: Rows,
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
            rows: Rows::default(),
        });
    }

    /// Takes the next point of the run, which a line joins to the one before.
    pub fn push(&mut self, point: Place) {
        if let Some(run) = self.runs.last_mut() {
            run.trace.push(point);
            run.rows.push(point);
        }
    }

    /// Takes a point between rows, through which the line goes.
    pub fn between(&mut self, point: Place) {
        if let Some(run) = self.runs.last_mut() {
            run.trace.push(point);
            run.rows.add_between();
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
        let (across, up) = cells(function, low, high);
        let mut plane = Surface::default();
        for i in 0..=across {
            for j in 0..=up {
                let x = along(low.0, high.0, i, across);
                plane.points.push([x, along(low.1, high.1, j, up), 0.0]);
                if i < across && j < up {
                    let at = i * (up + 1) + j;
                    let (right, both) = (at + up + 1, at + up + 2);
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
        let sorted = sorted(values.iter().copied());
        let (Some(least), Some(most)) = (sorted.first(), sorted.last()) else {
            return;
        };
        if most - least <= ROUND_OFF * least.abs().max(most.abs()) {
            return;
        }
        let last = sorted.len() - 1;
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
            let (colour, named) = shade_and_naming(place, many);
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
            series.extend(run.rows.series(name, colour));
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

/// A number between two, so many parts of a whole away from the first.
fn along(a: f64, b: f64, part: usize, whole: usize) -> f64 {
    a + (b - a) * part as f64 / whole as f64
}

/// Those that are finite, in their order.
fn sorted(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut finite: Vec<f64> = values.filter(|value| value.is_finite()).collect();
    finite.sort_by(f64::total_cmp);
    finite
}

/// How many cells along each axis show the level curves of a function as smooth as they are, within a bound.
fn cells(function: &dyn Fn(Place) -> f64, low: Place, high: Place) -> (usize, usize) {
    let grid = (0..=CELLS).flat_map(|i| (0..=CELLS).map(move |j| (i, j)));
    let place = |(i, j)| {
        (
            along(low.0, high.0, i, CELLS),
            along(low.1, high.1, j, CELLS),
        )
    };
    let sample = sorted(grid.map(|at| function(place(at))));
    let Some(last) = sample.len().checked_sub(1) else {
        return (CELLS, CELLS);
    };
    let between = (sample[last * 9 / 10] - sample[last / 10]) / LEVELS as f64;
    // lines along an axis, at places that have nothing to do with the cells
    let bent = |count: usize, at: &dyn Fn(usize, usize) -> f64| {
        let errors = (0..12).flat_map(|line| {
            (0..count).map(move |k| {
                let middle = at(line, 2 * k + 1);
                (middle - 0.5 * (at(line, 2 * k) + at(line, 2 * k + 2))).abs()
            })
        });
        let errors = sorted(errors);
        errors.get(errors.len() * 19 / 20).copied().unwrap_or(0.0)
    };
    let enough = |of: &dyn Fn(usize, usize, usize) -> f64| {
        let mut count = CELLS;
        while count < MOST_CELLS && bent(count, &|line, k| of(line, k, count)) > BENT * between {
            count *= 2;
        }
        count
    };
    let x = |part: usize, whole: usize| along(low.0, high.0, part, whole);
    let y = |part: usize, whole: usize| along(low.1, high.1, part, whole);
    (
        enough(&|line, k, count| function((x(k, 2 * count), y(3 * line + 1, 37)))),
        enough(&|line, k, count| function((x(3 * line + 1, 37), y(k, 2 * count)))),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_as_fine_as_the_function_asks_for() {
        let pendulum = |(q, p): Place| 0.5 * p * p - q.cos();
        let near = cells(&pendulum, (-3.0, -2.5), (3.0, 2.5));
        assert_eq!(near, (CELLS, CELLS));
        let (across, up) = cells(&pendulum, (-12.0, 2.1), (90.0, 3.2));
        assert_eq!(up, CELLS);
        assert!((240..=MOST_CELLS).contains(&across), "{across}");
        // the bound
        let wild = cells(&|(q, _)| (1e4 * q).sin(), (0.0, 0.0), (1.0, 1.0));
        assert_eq!(wild, (MOST_CELLS, CELLS));
        let nowhere = cells(&|_| f64::NAN, (0.0, 0.0), (1.0, 1.0));
        assert_eq!(nowhere, (CELLS, CELLS));
    }

    #[test]
    fn level_curves_over_many_periods_are_smooth() {
        let mut phase = Phase::new("", "", ["q", "p"].map(str::to_owned));
        phase.begin("a run");
        let energy = |(q, p): Place| 0.5 * p * p - q.cos();
        for k in 0..1000 {
            let q = 0.09 * f64::from(k);
            phase.push((q, (2.0 * (3.5 + q.cos())).sqrt()));
        }
        phase.levels(&energy);
        assert!(!phase.behind.is_empty());
        for curve in &phase.behind {
            let level = energy(curve[0]);
            let middle = |pair: &[Place]| {
                energy((0.5 * (pair[0].0 + pair[1].0), 0.5 * (pair[0].1 + pair[1].1)))
            };
            for pair in curve.windows(2) {
                assert!((middle(pair) - level).abs() < 0.04);
            }
        }
    }

    #[test]
    fn a_function_that_is_constant_has_no_level_curves() {
        let drawn = |height: f64| {
            let mut phase = Phase::new("", "", ["q", "p"].map(str::to_owned));
            phase.begin("a run");
            phase.push((0.0, 0.0));
            phase.push((1.0, 1.0));
            phase.levels(&|(x, y)| 1.0 + height * (7.0 * x).sin() * y);
            phase.behind.len()
        };
        assert_eq!(drawn(1e-15), 0);
        assert!(drawn(1e-6) > 0);
    }
}
