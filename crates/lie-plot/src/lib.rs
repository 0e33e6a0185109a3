//! Draws a trajectory and the errors of its invariants as an SVG that a person can read.
//!
//! Rows are taken one by one and thinned out on the way, so that a run of a billion steps needs
//! no more memory, and gives no larger a file, than one of a thousand. Per pixel column the
//! first, the smallest, the largest and the last value are kept, which draws the same picture
//! (Jugel, Jerzak, Hackenbroich and Markl, *M4: a visualization-oriented time series data
//! aggregation*, VLDB 2014, <https://doi.org/10.14778/2732951.2732953>).
//!
//! ```
//! use lie_plot::Plot;
//!
//! let mut plot = Plot::new("Circle, exact", &["t", "x", "y", "energy"], 2, (0.0, 10.0));
//! for k in 0..=1000 {
//!     let t = 0.01 * f64::from(k);
//!     plot.push(&[t, t.cos(), t.sin(), 0.5 + 1e-15 * t.sin()]);
//! }
//! assert!(plot.to_svg().starts_with("<svg"));
//! ```

mod bins;
pub mod chart;
mod clip;
pub mod compare;
pub mod contours;
mod draw;
pub mod frontier;
pub mod map;
pub mod phase;
mod rows;
pub mod surface;
mod svg;
mod ticks;
pub mod trace;
pub mod view;

use std::io;
use std::path::Path;

use bins::Bins;

/// Points of all curves of a panel together, about; each takes twelve bytes of the file.
const POINTS: usize = 20_000;
/// Curves that have points between their rows show so many rows as dots.
const FEW_ROWS: usize = 200;
/// A run that comes less far than this part of its way has a shorter axis.
const NEARLY: f64 = 0.98;
/// Columns of a curve at most: about as many as the panel has pixels.
const COLUMNS: usize = 640;

/// A picture in the making.
#[derive(Clone, Debug)]
pub struct Plot {
    title: String,
    subtitle: String,
    states: Vec<Curve>,
    invariants: Vec<Curve>,
    /// Functions that are recorded beside them, if there are any.
    recorded: Vec<Curve>,
    /// Entries of the group element, if there are any.
    element: Vec<Curve>,
    range: (f64, f64),
    /// The time of the last row.
    last: f64,
    rows: u64,
    /// Points between the rows.
    between: usize,
    /// Largest absolute value of a state component.
    scale: f64,
}

/// One column of the rows.
#[derive(Clone, Debug)]
struct Curve {
    name: String,
    bins: Bins,
    /// The value in the first row.
    first: f64,
    /// The rows, as long as they are few.
    dots: Vec<(f64, f64)>,
}

impl Plot {
    /// A picture of rows with these `columns`: `t`, then `states` components, then invariants
    /// (the energy, Casimirs). `range` is the time of the first and of the last row.
    pub fn new(
        title: impl Into<String>,
        columns: &[impl AsRef<str>],
        states: usize,
        range: (f64, f64),
    ) -> Self {
        let names: Vec<&str> = columns.iter().skip(1).map(AsRef::as_ref).collect();
        let (states, invariants) = names.split_at(states.min(names.len()));
        Self {
            title: title.into(),
            subtitle: String::new(),
            states: curves(states, 4, range),
            invariants: curves(invariants, 1, range),
            recorded: Vec::new(),
            element: Vec::new(),
            range,
            last: range.1,
            rows: 0,
            between: 0,
            scale: 0.0,
        }
    }

    /// A panel for functions that are recorded beside state and invariants, the columns behind those.
    #[must_use]
    pub fn recorded(mut self, columns: &[impl AsRef<str>]) -> Self {
        let names: Vec<&str> = columns.iter().map(AsRef::as_ref).collect();
        self.recorded = curves(&names, 4, self.range);
        self
    }

    /// A panel for the entries of the group element, the last columns of a row.
    #[must_use]
    pub fn element(mut self, columns: &[impl AsRef<str>]) -> Self {
        let names: Vec<&str> = columns.iter().map(AsRef::as_ref).collect();
        self.element = curves(&names, 4, self.range);
        self
    }

    /// A second line under the title, such as the method and the step.
    #[must_use]
    pub fn subtitle(mut self, subtitle: impl Into<String>) -> Self {
        self.subtitle = subtitle.into();
        self
    }

    /// Takes one row; columns that are missing are skipped, values that are not finite leave a
    /// gap. The errors of the invariants are taken against the first row.
    pub fn push(&mut self, row: &[f64]) {
        let Some((&t, values)) = row.split_first() else {
            return;
        };
        let (states, rest) = values.split_at(self.states.len().min(values.len()));
        let (invariants, behind) = rest.split_at(self.invariants.len().min(rest.len()));
        let further = self.recorded.iter_mut().chain(&mut self.element);
        for (curve, &value) in further.zip(behind) {
            curve.row(t, value);
        }
        for (curve, &value) in self.states.iter_mut().zip(states) {
            if self.rows == 0 {
                curve.first = value;
            }
            if value.is_finite() {
                self.scale = self.scale.max(value.abs());
            }
            curve.row(t, value);
        }
        for (curve, &value) in self.invariants.iter_mut().zip(invariants) {
            if self.rows == 0 {
                // Its error is zero by definition and tells nothing.
                curve.first = value;
                continue;
            }
            curve.bins.push(t, (value - curve.first).abs());
        }
        self.last = t;
        self.rows += 1;
    }

    /// The times that are shown: those of the rows, where a run ended early.
    fn shown(&self) -> (f64, f64) {
        let (from, to) = self.range;
        let early = (self.last - from) / (to - from) < NEARLY;
        (from, if early { self.last } else { to })
    }

    /// Takes a point between rows, with the columns of a row: the curves go through it, and few rows are dots on them. The errors
    /// are those of the rows.
    pub fn between(&mut self, row: &[f64]) {
        let Some((&t, values)) = row.split_first() else {
            return;
        };
        self.between += 1;
        let (states, rest) = values.split_at(self.states.len().min(values.len()));
        let behind = &rest[self.invariants.len().min(rest.len())..];
        let curves = self.states.iter_mut().zip(states);
        let further = self.recorded.iter_mut().chain(&mut self.element);
        for (curve, &value) in curves.chain(further.zip(behind)) {
            curve.bins.push(t, value);
        }
    }

    /// The picture.
    pub fn to_svg(&self) -> String {
        draw::svg(self)
    }

    /// Writes the picture to a file.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_svg(&self, path: impl AsRef<Path>) -> io::Result<()> {
        std::fs::write(path, self.to_svg())
    }
}

impl Curve {
    /// Takes the value in a row.
    fn row(&mut self, t: f64, value: f64) {
        self.bins.push(t, value);
        if self.dots.len() <= FEW_ROWS {
            self.dots.push((t, value));
        }
    }
}

/// Whether so many rows are dots on a curve with so many points between them: where they are few, and far apart.
pub fn are_dots(rows: usize, between: usize) -> bool {
    (1..=FEW_ROWS).contains(&rows) && between >= rows
}

/// Rows as dots, where they are.
fn few(dots: &[(f64, f64)], between: usize) -> &[(f64, f64)] {
    match are_dots(dots.len(), between) {
        true => dots,
        false => &[],
    }
}

/// Curves without points, `per_column` of them for each pixel column.
fn curves(names: &[&str], per_column: usize, range: (f64, f64)) -> Vec<Curve> {
    let columns = (POINTS / (per_column * names.len().max(1))).clamp(50, COLUMNS);
    let curve = |name: &&str| Curve {
        name: (*name).to_owned(),
        bins: Bins::new(range, columns),
        first: f64::NAN,
        dots: Vec::new(),
    };
    names.iter().map(curve).collect()
}

/// What the error of an invariant is divided by: |I₀|, or nothing where I₀ is only round-off
/// beside a state whose largest component is `scale`. Relative to that, an error would say nothing.
pub fn reference(first: f64, scale: f64) -> Option<f64> {
    let negligible = 1e-12 * scale.min(scale * scale);
    (first.abs() > negligible).then_some(first.abs())
}

#[cfg(test)]
mod tests;
