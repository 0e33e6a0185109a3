//! A coadjoint orbit of a three-dimensional algebra in space: the level surface of a Casimir, with level curves of the energy.

use super::surface::{Field, Point, Surface, dot, onto};

/// Level curves of the energy.
const LEVELS: usize = 11;
/// Cells along a side of the box of an orbit: while its size is looked for, and in the end.
const COARSE: usize = 16;
const FINE: usize = 44;
/// Energies that differ by no more than this part of what they are made of differ by round-off.
const ROUND_OFF: f64 = 1e-11;

/// Where the range of all energies is so many times that of nine tenths of them, there is a pole.
const POLE: f64 = 8.0;

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

/// The orbit of a point, with level curves of the energy if one is given; `bounds` are the least and the largest coordinates of
/// a curve on it. None where the point is an orbit by itself.
pub fn contours(
    casimir: &Field<'_>,
    energy: Option<&Field<'_>>,
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
    let Some(energy) = energy else {
        return Some(Contours {
            surface,
            closed,
            levels: Vec::new(),
            constant: false,
        });
    };
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
    let (low, high) = without_poles(finite().collect(), (low, high));
    let spacing = (high - low) / (LEVELS + 1) as f64;
    let mut levels = Vec::new();
    for k in 1..=LEVELS {
        let level = low + spacing * k as f64;
        for chain in surface.curves(&values, level) {
            // a pole between two corners looks like a passage through every level, and leads out of the picture
            let on = |point: &Point| {
                let wanted: [(&Field<'_>, f64); 2] = [(&centred, 0.0), (energy, level)];
                let found = (0..3).fold(*point, |point, _| onto(&point, &wanted));
                let here = |at: &Point| {
                    let way = (0..3)
                        .map(|i| (at[i] - point[i]).powi(2))
                        .sum::<f64>()
                        .sqrt();
                    let off = (energy(at).0 - level).abs();
                    casimir(at).0.is_finite() && off <= spacing && way <= size / COARSE as f64
                };
                [found, *point].into_iter().find(here)
            };
            let points: Vec<Option<Point>> = chain.iter().map(on).collect();
            let pieces = points.split(Option::is_none);
            let pieces = pieces.filter(|piece| piece.len() > 1);
            levels.extend(pieces.map(|piece| piece.iter().flatten().copied().collect()));
        }
    }
    Some(Contours {
        surface,
        closed,
        levels,
        constant,
    })
}

/// The range of energies that level curves divide: all of it, unless a pole stretches it far beyond where nearly all energies are.
fn without_poles(mut energies: Vec<f64>, all: (f64, f64)) -> (f64, f64) {
    energies.sort_by(f64::total_cmp);
    let part = |of: usize| energies[(energies.len() - 1) * of / 20];
    let (low, high) = (part(1), part(19));
    match all.1 - all.0 > POLE * (high - low) && high > low {
        true => (low, high),
        false => all,
    }
}

/// The part of a level surface on which a point lies: all of it where it is bounded, else the part around a curve; and which
/// of both. A curve that has left the surface is much larger than it: then what is around the point alone is looked at too.
fn whole(function: &Field<'_>, near: &Point, (low, high): (Point, Point)) -> (Surface, bool) {
    let curve = Surroundings::new((low, high));
    let point = Surroundings::new((*near, *near));
    let found = curve.bounded(function, near);
    if let Some(surface) = found.or_else(|| point.bounded(function, near)) {
        return (surface, true);
    }
    let around = |surroundings: &Surroundings| {
        let reach = 0.7 * surroundings.extent.max(0.2 * surroundings.scale);
        surroundings.part(function, near, reach, FINE).0
    };
    let surface = around(&curve);
    match surface.triangles.is_empty() {
        true => (around(&point), false),
        false => (surface, false),
    }
}

/// Where a surface is looked for.
struct Surroundings {
    middle: Point,
    /// The longest side.
    extent: f64,
    /// The size of the coordinates.
    scale: f64,
}

impl Surroundings {
    fn new((low, high): (Point, Point)) -> Self {
        let extent = (0..3).map(|i| high[i] - low[i]).fold(0.0, f64::max);
        let size = [0, 1, 2].map(|i| low[i].abs().max(high[i].abs()));
        Self {
            middle: [0, 1, 2].map(|i| 0.5 * (low[i] + high[i])),
            extent,
            scale: size.iter().copied().fold(extent, f64::max),
        }
    }

    /// The part of a surface on which a point lies within a reach, and the box in which it was looked for.
    fn part(
        &self,
        function: &Field<'_>,
        near: &Point,
        reach: f64,
        cells: usize,
    ) -> (Surface, (Point, Point)) {
        // a little to one side, so that no corner lies on the surface by symmetry
        let from = self.middle.map(|x| x - 1.013 * reach);
        let (from, to) = within(function, (from, self.middle.map(|x| x + reach)));
        let surface = Surface::new(function, &from, &to, cells).part_at(near);
        (surface, (from, to))
    }

    /// All of a surface, if it does not reach beyond the surroundings.
    fn bounded(&self, function: &Field<'_>, near: &Point) -> Option<Surface> {
        if self.scale == 0.0 || !self.scale.is_finite() {
            return None;
        }
        let mut reach = 0.75 * self.scale;
        for _ in 0..4 {
            let (part, (from, to)) = self.part(function, near, reach, COARSE);
            if let Some((low, high)) = part.bounds() {
                let cell = [0, 1, 2].map(|i| (to[i] - from[i]) / COARSE as f64);
                let inside = (0..3)
                    .all(|i| low[i] > from[i] + 0.5 * cell[i] && high[i] < to[i] - 0.5 * cell[i]);
                if inside {
                    let from = [0, 1, 2].map(|i| low[i] - 0.53 * cell[i]);
                    let to = [0, 1, 2].map(|i| high[i] + 0.5 * cell[i]);
                    let surface = Surface::new(function, &from, &to, FINE).part_at(near);
                    return (!surface.triangles.is_empty()).then_some(surface);
                }
            }
            reach *= 1.7;
        }
        None
    }
}

/// A box without what lies outside of the domain of a function along its sides: a logarithm of a coordinate ends where that
/// is zero, and cells that reach beyond have no surface.
fn within(function: &Field<'_>, (low, high): (Point, Point)) -> (Point, Point) {
    let at = |number: [usize; 3]| {
        [0, 1, 2].map(|i| low[i] + (high[i] - low[i]) * number[i] as f64 / COARSE as f64)
    };
    let side = COARSE + 1;
    let numbers =
        || (0..side * side * side).map(|k| [k / (side * side), k / side % side, k % side]);
    let inside: Vec<[usize; 3]> = numbers()
        .filter(|number| function(&at(*number)).0.is_finite())
        .collect();
    if inside.is_empty() || inside.len() == side * side * side {
        return (low, high);
    }
    // between the outermost layer with values and the next one, along the lines that have one
    let border = |axis: usize, up: bool| {
        let layer = inside.iter().map(|number| number[axis]);
        let (layer, outermost) = match up {
            true => (layer.max().unwrap_or(0), COARSE),
            false => (layer.min().unwrap_or(0), 0),
        };
        if layer == outermost {
            return if up { high[axis] } else { low[axis] };
        }
        let ends = inside.iter().filter(|number| number[axis] == layer);
        let ends = ends.map(|number| {
            let mut next = *number;
            next[axis] = if up { layer + 1 } else { layer - 1 };
            let (mut good, mut bad) = (at(*number), at(next)[axis]);
            for _ in 0..40 {
                let mut tried = good;
                tried[axis] = 0.5 * (good[axis] + bad);
                match function(&tried).0.is_finite() {
                    true => good = tried,
                    false => bad = tried[axis],
                }
            }
            good[axis]
        });
        let outer = if up { f64::max } else { f64::min };
        ends.reduce(outer).unwrap_or(low[axis])
    };
    (
        [0, 1, 2].map(|axis| border(axis, false)),
        [0, 1, 2].map(|axis| border(axis, true)),
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
            let found = contours(&square, Some(energy), &start, bounds).unwrap();
            assert!(found.closed && found.constant && found.levels.is_empty());
        }
        // the control: a little energy along one axis is no round-off
        let little = |p: &Point| (0.5 * square(p).0 + 1e-6 * p[2], [p[0], p[1], p[2] + 1e-6]);
        let found = contours(&square, Some(&little), &start, bounds).unwrap();
        assert!(!found.constant && found.levels.len() >= LEVELS);
    }

    #[test]
    fn level_curves_near_a_pole_stay_on_the_surface_and_show_the_rest_of_it() {
        let start = [0.6, 0.0, 0.8];
        let bounds = ([-0.6, -0.6, 0.8], [0.6, 0.6, 0.8]);
        // poles along a circle, with both signs, and at two points
        let circle = |p: &Point| {
            let d = p[2] - 0.5;
            (0.5 * p[0] * p[0] + 1.0 / d, [p[0], 0.0, -1.0 / (d * d)])
        };
        let points = |p: &Point| {
            let d = p[0] * p[0] + p[1] * p[1];
            (
                p[0] + 1.0 / d,
                [1.0 - 2.0 * p[0] / (d * d), -2.0 * p[1] / (d * d), 0.0],
            )
        };
        let energies: [&Field<'_>; 2] = [&circle, &points];
        for energy in energies {
            let found = contours(&square, Some(energy), &start, bounds).unwrap();
            let all = || found.levels.iter().flatten();
            assert!(found.levels.len() >= LEVELS);
            assert!(all().all(|p| (square(p).0 - 1.0).abs() < 1e-2));
            let low = all().filter(|p| p[2].abs() < 0.3).count();
            assert!(30 * low > all().count(), "{low} of {}", all().count());
            let steps = found.levels.iter().flat_map(|level| level.windows(2));
            let longest =
                steps.map(|two| (0..3).map(|i| (two[1][i] - two[0][i]).powi(2)).sum::<f64>());
            assert!(longest.fold(0.0, f64::max).sqrt() < 0.3);
        }
    }

    /// The Casimir of Lotka and Volterra's equations with three species, up to its sign.
    fn species(&[x, y, z]: &Point) -> (f64, Point) {
        (2.0 * x.ln() + y.ln() + z.ln(), [2.0 / x, 1.0 / y, 1.0 / z])
    }

    /// The largest distance from points to the nearest corner of a surface.
    fn farthest(points: &[Point], surface: &Surface) -> f64 {
        let far = |p: &Point| {
            let apart = |q: &Point| (0..3).map(|i| (p[i] - q[i]).powi(2)).sum::<f64>();
            surface
                .points
                .iter()
                .map(apart)
                .fold(f64::INFINITY, f64::min)
                .sqrt()
        };
        points.iter().map(far).fold(0.0, f64::max)
    }

    #[test]
    fn a_surface_reaches_to_the_border_of_the_domain() {
        // a curve on x^2 y z = 1 that comes near the planes of coordinates
        let curve: Vec<Point> = (0..100)
            .map(|k| {
                let angle = std::f64::consts::TAU * f64::from(k) / 100.0;
                let (x, y) = ((1.2 * angle.sin()).exp(), (2.0 * angle.cos()).exp());
                [x, y, 1.0 / (x * x * y)]
            })
            .collect();
        let bounds = |of: fn(f64, f64) -> f64| {
            let all = |i: usize| curve.iter().map(move |p| p[i]);
            [0, 1, 2].map(|i| all(i).reduce(of).unwrap())
        };
        let box_of = (bounds(f64::min), bounds(f64::max));
        let found = contours(&species, None, &curve[0], box_of).unwrap();
        assert!(!found.closed && !found.constant && found.levels.is_empty());
        assert!(
            found
                .surface
                .points
                .iter()
                .all(|p| species(p).0.abs() < 1e-6)
        );
        let extent = (0..3)
            .map(|i| box_of.1[i] - box_of.0[i])
            .fold(0.0, f64::max);
        let cell = 1.5 * extent / FINE as f64;
        let far = farthest(&curve, &found.surface);
        assert!(far < cell, "{far} {cell}");
        // the control: in a box that reaches beyond the domain there is none at its border
        let (low, high) = box_of;
        let (low, high) = (
            low.map(|x| x - 0.2 * extent),
            high.map(|x| x + 0.2 * extent),
        );
        let far = farthest(&curve, &Surface::new(&species, &low, &high, FINE));
        assert!(far > 1.5 * cell, "{far} {cell}");
    }

    #[test]
    fn a_curve_that_has_left_its_surface_does_not_hide_it() {
        let start = [0.6, 0.0, 0.8];
        let energy: &Field<'_> = &|p| (p[2], [0.0, 0.0, 1.0]);
        for size in [3.0, 30.0, 1e3, 1e6, 1e200, f64::INFINITY] {
            let bounds = ([-size; 3], [size; 3]);
            let found = contours(&square, Some(energy), &start, bounds).unwrap();
            assert!(found.closed && found.levels.len() >= LEVELS, "{size}");
            let (low, high) = found.surface.bounds().unwrap();
            assert!((0..3).all(|i| low[i] < -0.97 && high[i] > 0.97), "{size}");
        }
        // the control: the origin is an orbit by itself
        assert!(contours(&square, Some(energy), &[0.0; 3], ([-3.0; 3], [3.0; 3])).is_none());
    }
}
