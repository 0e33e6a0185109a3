//! The branches over a range of a parameter, drawn: solid where they are stable, dashed elsewhere.

use lie_equilibria::{Branch, Equations, Point, Stability};
use lie_plot::chart::{Axis, Chart, Panel, Series, Stroke};

use super::Range;

/// Panels beside that of the energy.
const MOST: usize = 8;

/// The picture: the energy, and each coordinate.
pub fn svg(name: &str, equations: &Equations, range: &Range) -> String {
    let coordinates = &equations.system.coordinates;
    let mut panels = vec![panel("energy", range, &|point| point.energy)];
    for (place, coordinate) in coordinates.iter().enumerate().take(MOST) {
        panels.push(panel(coordinate, range, &|point| point.y[place]));
    }
    let families = range.traced.branches.iter().any(|branch| branch.family > 0);
    let mut subtitle = "solid: stable or spectrally stable; dashed: unstable; dots: changes of stability, folds, branches that meet".to_owned();
    if families {
        subtitle.push_str("; of a family one member is drawn");
    }
    if coordinates.len() > MOST {
        subtitle.push_str(&format!("; the first {MOST} coordinates"));
    }
    Chart {
        title: format!("{name}: relative equilibria over {}", range.name),
        subtitle,
        across: panels.len().min(3),
        panels,
    }
    .to_svg()
}

fn panel(title: &str, range: &Range, of: &dyn Fn(&Point) -> f64) -> Panel {
    let mut series = Vec::new();
    let branches = &range.traced.branches;
    for (number, branch) in branches.iter().enumerate() {
        series.extend(pieces(number, branch, of));
    }
    let mut dots = Vec::new();
    for found in branches.iter().flat_map(|branch| &branch.changes) {
        // a point with what the function reads
        let point = Point {
            parameter: found.parameter,
            y: found.y.clone(),
            energy: found.energy,
            growth: 0.0,
            stability: found.stability[0],
            threshold: None,
            grid: None,
        };
        dots.push((found.parameter, of(&point)));
    }
    series.push(Series {
        name: if dots.is_empty() {
            String::new()
        } else {
            "change".to_owned()
        },
        colour: branches.len(),
        stroke: Stroke::Dots,
        points: dots,
    });
    Panel {
        title: title.to_owned(),
        x: Axis::linear(range.name.clone()),
        y: Axis::linear(title),
        series,
    }
}

/// A branch in pieces of one stroke each, which meet at the changes.
fn pieces(number: usize, branch: &Branch, of: &dyn Fn(&Point) -> f64) -> Vec<Series> {
    let stroke = |point: &Point| match point.stability {
        Stability::Unstable => Stroke::Over,
        Stability::Stable | Stability::Spectral | Stability::Undecided => Stroke::Curve,
    };
    let mut series: Vec<Series> = Vec::new();
    for point in &branch.points {
        let place = (point.parameter, of(point));
        match series.last_mut() {
            Some(last) if last.stroke == stroke(point) => last.points.push(place),
            last => {
                // the next piece begins where this one ends
                let joint = last.and_then(|last| last.points.last().copied());
                series.push(Series {
                    name: format!("branch {}", number + 1),
                    colour: number,
                    stroke: stroke(point),
                    points: joint.into_iter().chain([place]).collect(),
                });
            }
        }
    }
    series
}
