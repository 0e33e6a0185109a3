//! A coadjoint orbit of a three-dimensional algebra in space: the level surface of a Casimir, with level curves of the energy.

use super::surface::{Field, Point, Surface, dot, onto};

/// Level curves of the energy.
const LEVELS: usize = 11;
/// Cells along a side of the box of an orbit: while its size is looked for, and in the end.
const COARSE: usize = 16;
const FINE: usize = 44;
/// Energies that differ by no more than this part of what they are made of differ by round-off.
const ROUND_OFF: f64 = 1e-11;

/// An orbit in space.
#[derive(Clone, Debug)]
pub struct Contours {
    /// The orbit.
    pub surface: Surface,
    /// Whether that is all of it; else it is cut off around the curve.
    pub closed: bool,
    /// Level curves of the energy on it.
    pub levels: Vec<Vec<Point>>,
    /// Whether the energy is the same everywhere on it, up to round-off: there are no level curves then.
    pub constant: bool,
}

/// The orbit of a point, with level curves of the energy; `bounds` are the least and the largest coordinates of a curve on it.
/// None where the point is an orbit by itself.
pub fn contours(
    casimir: &Field<'_>,
    energy: &Field<'_>,
    first: &Point,
    bounds: (Point, Point),
) -> Option<Contours> {
    let level = casimir(first).0;
    let centred = |point: &Point| {
        let (value, gradient) = casimir(point);
        (value - level, gradient)
    };
    let (surface, closed) = whole(&centred, first, bounds);
    if surface.triangles.is_empty() {
        return None;
    }
    let found: Vec<(f64, Point)> = surface.points.iter().map(energy).collect();
    let values: Vec<f64> = found.iter().map(|found| found.0).collect();
    let finite = || values.iter().copied().filter(|value| value.is_finite());
    let (low, high) = (
        finite().fold(f64::INFINITY, f64::min),
        finite().fold(f64::NEG_INFINITY, f64::max),
    );
    // along the gradient the energy changes even where it is constant on the orbit
    let size = surface.bounds().map_or(0.0, |(low, high)| {
        (0..3).map(|i| high[i] - low[i]).fold(0.0, f64::max)
    });
    let slope = found.iter().map(|(_, slope)| dot(slope, slope).sqrt());
    let slope = slope.filter(|x| x.is_finite()).fold(0.0, f64::max);
    let scale = low.abs().max(high.abs()).max(slope * size);
    let constant = high - low <= ROUND_OFF * scale;
    if constant {
        return Some(Contours {
            surface,
            closed,
            levels: Vec::new(),
            constant,
        });
    }
    let mut levels = Vec::new();
    for k in 1..=LEVELS {
        let level = low + (high - low) * k as f64 / (LEVELS + 1) as f64;
        for chain in surface.curves(&values, level) {
            let on = |point: &Point| {
                let wanted: [(&Field<'_>, f64); 2] = [(&centred, 0.0), (energy, level)];
                (0..3).fold(*point, |point, _| onto(&point, &wanted))
            };
            levels.push(chain.iter().map(on).collect());
        }
    }
    Some(Contours {
        surface,
        closed,
        levels,
        constant,
    })
}

/// The part of a level surface on which a point lies: all of it where it is bounded, else the part around a curve; and which
/// of both.
fn whole(function: &Field<'_>, near: &Point, (low, high): (Point, Point)) -> (Surface, bool) {
    let extent = (0..3).map(|i| high[i] - low[i]).fold(0.0, f64::max);
    let size = [0, 1, 2].map(|i| low[i].abs().max(high[i].abs()));
    let scale = size.iter().copied().fold(extent, f64::max);
    if scale == 0.0 {
        return (Surface::default(), true);
    }
    let middle = [0, 1, 2].map(|i| 0.5 * (low[i] + high[i]));
    let around = |reach: f64| {
        (
            // a little to one side, so that no corner lies on the surface by symmetry
            middle.map(|x| x - 1.013 * reach),
            middle.map(|x| x + reach),
        )
    };
    let mut reach = 0.75 * scale;
    for _ in 0..4 {
        let (from, to) = around(reach);
        let part = Surface::new(function, &from, &to, COARSE).part_at(near);
        if let Some((low, high)) = part.bounds() {
            let cell = 2.0 * reach / COARSE as f64;
            let inside =
                (0..3).all(|i| low[i] > from[i] + 0.5 * cell && high[i] < to[i] - 0.5 * cell);
            if inside {
                let from = low.map(|x| x - 0.53 * cell);
                let to = high.map(|x| x + 0.5 * cell);
                return (Surface::new(function, &from, &to, FINE).part_at(near), true);
            }
        }
        reach *= 1.7;
    }
    let (from, to) = around(0.7 * extent.max(0.2 * scale));
    (
        Surface::new(function, &from, &to, FINE).part_at(near),
        false,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(point: &Point) -> (f64, Point) {
        (dot(point, point), point.map(|x| 2.0 * x))
    }

    #[test]
    fn where_the_energy_is_constant_there_are_no_level_curves() {
        let start = [0.6, 0.0, 0.8];
        let bounds = ([-0.6, -0.6, 0.8], [0.6, 0.6, 0.8]);
        let energies: [&Field<'_>; 3] = [
            &|p| (0.5 * square(p).0, *p),
            // nothing is left of it on the sphere but round-off
            &|p| (square(p).0 - 1.0, p.map(|x| 2.0 * x)),
            &|_| (3.0, [0.0; 3]),
        ];
        for energy in energies {
            let found = contours(&square, energy, &start, bounds).unwrap();
            assert!(found.closed && found.constant && found.levels.is_empty());
        }
        // the control: a little energy along one axis is no round-off
        let little = |p: &Point| (0.5 * square(p).0 + 1e-6 * p[2], [p[0], p[1], p[2] + 1e-6]);
        let found = contours(&square, &little, &start, bounds).unwrap();
        assert!(!found.constant && found.levels.len() >= LEVELS);
    }
}
