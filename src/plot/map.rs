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

use std::fmt::Write as _;

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

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
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
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" \
             viewBox=\"0 0 {width:.0} {height:.0}\" font-family=\"sans-serif\">\n<title>{title}</title>\n\
             <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n\
             <text x=\"20\" y=\"32\" font-size=\"22\" fill=\"#222\">{title}</text>\n\
             <text x=\"20\" y=\"54\" font-size=\"14\" fill=\"#666\">{}</text>\n",
            escaped(&self.subtitle),
            title = escaped(&self.title),
        );
        self.heads(&mut svg, &places);
        for (row, (name, cells)) in self.rows.iter().enumerate() {
            let y = TOP + ROW * row as f64;
            let _ = writeln!(
                svg,
                "<text x=\"{:.1}\" y=\"{:.1}\" font-size=\"12.5\" text-anchor=\"end\" fill=\"#222\">{}</text>",
                left - 8.0,
                y + 12.5,
                escaped(name)
            );
            for (cell, x) in cells.iter().zip(&places) {
                let Some(cell) = cell else { continue };
                let _ = writeln!(
                    svg,
                    "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"{}\"><title>{}</title></rect>",
                    CELL - 1.0,
                    ROW - 1.0,
                    colour(cell.outcome),
                    escaped(&cell.text)
                );
            }
        }
        legend(&mut svg, TOP + ROW * self.rows.len() as f64 + 26.0);
        svg.push_str("</svg>\n");
        svg
    }

    fn heads(&self, svg: &mut String, places: &[f64]) {
        for (index, (column, x)) in self.columns.iter().zip(places).enumerate() {
            let _ = writeln!(
                svg,
                "<text transform=\"translate({:.1} {:.1}) rotate(-90)\" font-size=\"11\" fill=\"#444\">{}</text>",
                x + 12.0,
                TOP - 6.0,
                escaped(&column.label)
            );
            let first = index == 0 || self.columns[index - 1].group != column.group;
            if first {
                let _ = writeln!(
                    svg,
                    "<text transform=\"translate({:.1} {:.1}) rotate(-30)\" font-size=\"12.5\" font-weight=\"bold\" fill=\"#222\">{}</text>",
                    x + 6.0,
                    TOP - 66.0,
                    escaped(&column.group)
                );
            }
        }
    }
}

fn legend(svg: &mut String, y: f64) {
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
        let _ = writeln!(
            svg,
            "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"14\" height=\"14\" fill=\"{}\" stroke=\"#ccc\"/>\n\
             <text x=\"{:.1}\" y=\"{:.1}\" font-size=\"11.5\" fill=\"#222\">{text}</text>",
            colour(outcome),
            x + 18.0,
            y + 11.5
        );
        x += 28.0 + 6.0 * text.chars().count() as f64;
    }
}
