//! A map of experiments: a row for each method, a column for each experiment, a colour for what happened.
//!
//! ```
//! use lie_poisson::plot::map::{Cell, Column, Map, Outcome};
//! let map = Map {
//!     title: "Top".into(),
//!     subtitle: String::new(),
//!     columns: vec![Column { group: "step".into(), label: "1".into() }],
//!     rows: vec![("rk4".into(), vec![Some(Cell { outcome: Outcome::Drift(-6.0), text: "fine".into() })])],
//! };
//! assert!(map.to_svg().contains("rk4"));
//! ```

use super::svg::{INK, Svg};

const CELL: f64 = 17.0;
const ROW: f64 = 17.0;
const TOP: f64 = 176.0;
const GAP: f64 = 8.0;

/// What happened.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// Everything that is claimed was kept; the power of ten of the energy's drift.
    Drift(f64),
    /// The same, and the energy's drift grew to more than three times that of the first tenth of the run.
    Growing(f64),
    /// It stopped, with a message.
    Stopped,
    /// A claimed invariant was lost without a message.
    Lost,
    /// Nothing to integrate there.
    Domain,
}

/// One experiment with one method.
#[derive(Clone, Debug)]
pub struct Cell {
    /// What happened.
    pub outcome: Outcome,
    /// The same in words.
    pub text: String,
}

/// One experiment.
#[derive(Clone, Debug)]
pub struct Column {
    /// What it stands with.
    pub group: String,
    /// Its own name.
    pub label: String,
}

/// The map.
#[derive(Clone, Debug)]
pub struct Map {
    /// Its title.
    pub title: String,
    /// A second line.
    pub subtitle: String,
    /// The experiments.
    pub columns: Vec<Column>,
    /// The methods with one cell per column.
    pub rows: Vec<(String, Vec<Option<Cell>>)>,
}

/// From round-off (dark) to drifts of the size of the energy (pale).
fn shade(exponent: f64, from: [f64; 3], to: [f64; 3]) -> String {
    let part = ((exponent + 16.0) / 16.0).clamp(0.0, 1.0);
    let mixed = [0, 1, 2].map(|k| (from[k] + part * (to[k] - from[k])).round() as u8);
    format!("#{:02x}{:02x}{:02x}", mixed[0], mixed[1], mixed[2])
}

fn colour(outcome: Outcome) -> String {
    match outcome {
        Outcome::Drift(exponent) => shade(exponent, [0.0, 72.0, 130.0], [226.0, 240.0, 248.0]),
        Outcome::Growing(exponent) => shade(exponent, [190.0, 110.0, 0.0], [253.0, 226.0, 160.0]),
        Outcome::Stopped => "#9a9a9a".to_owned(),
        Outcome::Lost => "#d4002a".to_owned(),
        Outcome::Domain => "#f1f1f1".to_owned(),
    }
}

impl Map {
    /// The picture as SVG.
    pub fn to_svg(&self) -> String {
        let widest = self.rows.iter().map(|(name, _)| name.chars().count()).max();
        let left = 24.0 + 7.0 * widest.unwrap_or(0) as f64;
        let mut places = Vec::new();
        let mut x = left;
        for (index, column) in self.columns.iter().enumerate() {
            if index > 0 && self.columns[index - 1].group != column.group {
                x += GAP;
            }
            places.push(x);
            x += CELL;
        }
        let width = f64::max(x + 60.0, 1010.0);
        let height = TOP + ROW * self.rows.len() as f64 + 64.0;
        let mut svg = Svg::default();
        self.heads(&mut svg, &places);
        let name_style = format!("text-anchor=\"end\" fill=\"{INK}\"");
        for (row, (name, cells)) in self.rows.iter().enumerate() {
            let y = TOP + ROW * row as f64;
            svg.text((left - 8.0, y + 12.5), 12.5, &name_style, name);
            for (cell, x) in cells.iter().zip(&places) {
                let Some(cell) = cell else { continue };
                let fill = format!("fill=\"{}\"", colour(cell.outcome));
                svg.rectangle((*x, y), (CELL - 1.0, ROW - 1.0), &fill, &cell.text);
            }
        }
        legend(&mut svg, TOP + ROW * self.rows.len() as f64 + 26.0);
        svg.page((width, height), &self.title, &self.subtitle)
    }

    fn heads(&self, svg: &mut Svg, places: &[f64]) {
        let bold = format!("font-weight=\"bold\" fill=\"{INK}\"");
        for (index, (column, x)) in self.columns.iter().zip(places).enumerate() {
            let place = (x + 12.0, TOP - 6.0);
            svg.turned_text(place, -90.0, 11.0, "fill=\"#444\"", &column.label);
            let first = index == 0 || self.columns[index - 1].group != column.group;
            if first {
                svg.turned_text((x + 6.0, TOP - 66.0), -30.0, 12.5, &bold, &column.group);
            }
        }
    }
}

fn legend(svg: &mut Svg, y: f64) {
    let entries = [
        (Outcome::Drift(-16.0), "energy to round-off"),
        (Outcome::Drift(-8.0), "energy to 1e-8"),
        (Outcome::Drift(-1.0), "energy to 1e-1"),
        (Outcome::Growing(-8.0), "energy error grows"),
        (Outcome::Stopped, "stopped with a message"),
        (Outcome::Lost, "claim lost in silence"),
        (Outcome::Domain, "outside the domain"),
    ];
    let mut x = 20.0;
    for (outcome, text) in entries {
        let fill = format!("fill=\"{}\" stroke=\"#ccc\"", colour(outcome));
        svg.rectangle((x, y), (14.0, 14.0), &fill, "");
        svg.text((x + 18.0, y + 11.5), 11.5, &format!("fill=\"{INK}\""), text);
        x += 28.0 + 6.0 * text.chars().count() as f64;
    }
}
