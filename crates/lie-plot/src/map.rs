//! A map of experiments: a row for each method, a column for each experiment, a colour for what happened.
//!
//! ```
//! use lie_plot::map::{Cell, Column, Map, Outcome};
//! let map = Map {
//!     title: "Top".into(),
//!     subtitle: String::new(),
//!     columns: vec![Column { group: "step".into(), label: "1".into() }],
//!     rows: vec![("rk4".into(), vec![Some(Cell { outcome: Outcome::Drift(-6.0), text: "fine".into() })])],
//! };
//! assert!(map.to_svg().contains("rk4"));
//! ```

use super::svg::{INK, Svg, text_width};

const CELL: f64 = 17.0;
const ROW: f64 = 17.0;
/// Height of the labels of columns, and of the title with its second line.
const LABELS: f64 = 66.0;
const TITLE: f64 = 68.0;
/// Size of the names of groups, and the degrees by which they rise.
const HEAD: f64 = 12.5;
const RISE: f64 = 30.0;
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
        let (right, rise) = self.room(&places);
        let top = TITLE + LABELS + rise + HEAD;
        let width = f64::max(x.max(right) + 20.0, 1010.0);
        let below = top + ROW * self.rows.len() as f64;
        let mut svg = Svg::default();
        self.heads(&mut svg, &places, top);
        let name_style = format!("text-anchor=\"end\" fill=\"{INK}\"");
        for (row, (name, cells)) in self.rows.iter().enumerate() {
            let y = top + ROW * row as f64;
            svg.text((left - 8.0, y + 12.5), 12.5, &name_style, name);
            for (cell, x) in cells.iter().zip(&places) {
                let Some(cell) = cell else { continue };
                let fill = format!("fill=\"{}\"", colour(cell.outcome));
                svg.rectangle((*x, y), (CELL - 1.0, ROW - 1.0), &fill, &cell.text);
            }
        }
        legend(&mut svg, below + 26.0);
        svg.page((width, below + 92.0), &self.title, &self.subtitle)
    }

    /// Where the names of groups end at the right, and how high the longest rises.
    fn room(&self, places: &[f64]) -> (f64, f64) {
        let (sine, cosine) = RISE.to_radians().sin_cos();
        let columns = self.columns.iter().zip(places);
        columns.fold((0.0, 0.0), |(right, rise), (column, x)| {
            let length = text_width(&column.group, HEAD, true);
            let end = x + 6.0 + cosine * length;
            (f64::max(right, end), f64::max(rise, sine * length))
        })
    }

    fn heads(&self, svg: &mut Svg, places: &[f64], top: f64) {
        let bold = format!("font-weight=\"bold\" fill=\"{INK}\"");
        for (index, (column, x)) in self.columns.iter().zip(places).enumerate() {
            let place = (x + 12.0, top - 6.0);
            svg.turned_text(place, -90.0, 11.0, "fill=\"#444\"", &column.label);
            let first = index == 0 || self.columns[index - 1].group != column.group;
            if first {
                svg.turned_text((x + 6.0, top - LABELS), -RISE, HEAD, &bold, &column.group);
            }
        }
    }
}

/// The two scales of colour with their ends and middle, and below them what has one colour.
fn legend(svg: &mut Svg, y: f64) {
    let ink = format!("fill=\"{INK}\"");
    let mut x = 20.0;
    for (kind, text) in [
        (Outcome::Drift as fn(f64) -> Outcome, "largest energy error"),
        (Outcome::Growing, "energy error that grows"),
    ] {
        svg.text((x, y + 11.5), 11.5, &ink, text);
        x += text_width(text, 11.5, false) + 8.0;
        for step in 0..=16 {
            let at = x + 10.0 * f64::from(step);
            let fill = format!("fill=\"{}\"", colour(kind(f64::from(step) - 16.0)));
            svg.rectangle((at, y), (10.5, 14.0), &fill, "");
            if step % 8 == 0 {
                let middle = format!("text-anchor=\"middle\" {ink}");
                svg.power_of_ten((at + 5.0, y + 28.0), 10.0, &middle, step - 16);
            }
        }
        x += 17.0 * 10.0 + 40.0;
    }
    let entries = [
        (Outcome::Stopped, "stopped with a message"),
        (Outcome::Lost, "claim lost in silence"),
        (Outcome::Domain, "outside the domain"),
    ];
    let (mut x, y) = (20.0, y + 40.0);
    for (outcome, text) in entries {
        let fill = format!("fill=\"{}\" stroke=\"#ccc\"", colour(outcome));
        svg.rectangle((x, y), (14.0, 14.0), &fill, "");
        svg.text((x + 20.0, y + 11.5), 11.5, &ink, text);
        x += 44.0 + text_width(text, 11.5, false);
    }
}
