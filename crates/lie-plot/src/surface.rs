//! A level surface of a function of three variables as triangles, and level curves of other functions on it.

use std::collections::HashMap;

/// A point of space.
pub type Point = [f64; 3];

/// A function that is constant on the surface or on its curves: its value and its gradient.
pub type Field<'a> = dyn Fn(&Point) -> (f64, Point) + 'a;

/// Triangles on a level surface.
#[derive(Clone, Debug, Default)]
pub struct Surface {
    /// Their corners.
    pub points: Vec<Point>,
    /// Three corners each.
    pub triangles: Vec<[usize; 3]>,
}

/// The corners of a cell, and the six tetrahedra around its diagonal.
const CORNERS: [[usize; 3]; 8] = [
    [0, 0, 0],
    [1, 0, 0],
    [0, 1, 0],
    [1, 1, 0],
    [0, 0, 1],
    [1, 0, 1],
    [0, 1, 1],
    [1, 1, 1],
];
const TETRAHEDRA: [[usize; 4]; 6] = [
    [0, 1, 3, 7],
    [0, 3, 2, 7],
    [0, 2, 6, 7],
    [0, 6, 4, 7],
    [0, 4, 5, 7],
    [0, 5, 1, 7],
];

/// Steps that bring corners onto the surface.
const SETTLED: usize = 5;

pub(crate) fn dot(a: &Point, b: &Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

impl Surface {
    /// The surface on which a function vanishes, in a box that is divided into so many cells along each side.
    pub fn new(function: &Field<'_>, low: &Point, high: &Point, cells: usize) -> Self {
        let side = cells + 1;
        let place = |[i, j, k]: [usize; 3]| -> Point {
            let along = |axis: usize, at: usize| {
                low[axis] + (high[axis] - low[axis]) * at as f64 / cells as f64
            };
            [along(0, i), along(1, j), along(2, k)]
        };
        let number = |[i, j, k]: [usize; 3]| (i * side + j) * side + k;
        let mut values = Vec::with_capacity(side * side * side);
        for i in 0..side {
            for j in 0..side {
                for k in 0..side {
                    values.push(function(&place([i, j, k])).0);
                }
            }
        }
        let mut surface = Self::default();
        let mut edges: HashMap<(usize, usize), usize> = HashMap::new();
        for i in 0..cells {
            for j in 0..cells {
                for k in 0..cells {
                    let corners = CORNERS.map(|[a, b, c]| [i + a, j + b, k + c]);
                    for tetrahedron in TETRAHEDRA {
                        let four = tetrahedron.map(|c| corners[c]);
                        surface.cut(function, &four, &values, &number, &place, &mut edges);
                    }
                }
            }
        }
        for point in &mut surface.points {
            for _ in 0..SETTLED {
                *point = nearer(function, point);
            }
        }
        surface
    }

    /// The triangles of the surface in a tetrahedron.
    fn cut(
        &mut self,
        function: &Field<'_>,
        four: &[[usize; 3]; 4],
        values: &[f64],
        number: &impl Fn([usize; 3]) -> usize,
        place: &impl Fn([usize; 3]) -> Point,
        edges: &mut HashMap<(usize, usize), usize>,
    ) {
        let value = |c: usize| values[number(four[c])];
        if (0..4).any(|c| !value(c).is_finite()) {
            return;
        }
        let (inside, outside): (Vec<usize>, Vec<usize>) = (0..4).partition(|&c| value(c) < 0.0);
        let mut crossing = |a: usize, b: usize| {
            let key = (number(four[a]), number(four[b]));
            let key = (key.0.min(key.1), key.0.max(key.1));
            *edges.entry(key).or_insert_with(|| {
                let (p, q) = (place(four[a]), place(four[b]));
                let found = between(function, (p, value(a)), (q, value(b)));
                self.points.push(found);
                self.points.len() - 1
            })
        };
        match (inside.as_slice(), outside.as_slice()) {
            ([a], [b, c, d]) | ([b, c, d], [a]) => {
                let triangle = [crossing(*a, *b), crossing(*a, *c), crossing(*a, *d)];
                self.triangles.push(triangle);
            }
            ([a, b], [c, d]) => {
                let four = [
                    crossing(*a, *c),
                    crossing(*a, *d),
                    crossing(*b, *d),
                    crossing(*b, *c),
                ];
                self.triangles.push([four[0], four[1], four[2]]);
                self.triangles.push([four[0], four[2], four[3]]);
            }
            _ => {}
        }
    }

    /// The part that hangs together with the point next to a given one.
    #[must_use]
    pub fn part_at(&self, near: &Point) -> Self {
        let mut root: Vec<usize> = (0..self.points.len()).collect();
        fn find(root: &mut [usize], mut at: usize) -> usize {
            while root[at] != at {
                root[at] = root[root[at]];
                at = root[at];
            }
            at
        }
        for [a, b, c] in &self.triangles {
            let first = find(&mut root, *a);
            for other in [*b, *c] {
                let other = find(&mut root, other);
                root[other] = first;
            }
        }
        let far = |point: &Point| {
            let apart = [0, 1, 2].map(|i| point[i] - near[i]);
            dot(&apart, &apart)
        };
        let nearest = (0..self.points.len())
            .min_by(|&a, &b| far(&self.points[a]).total_cmp(&far(&self.points[b])));
        let Some(nearest) = nearest else {
            return Self::default();
        };
        let wanted = find(&mut root, nearest);
        let mut part = Self::default();
        let mut numbers: HashMap<usize, usize> = HashMap::new();
        for triangle in &self.triangles {
            if find(&mut root, triangle[0]) == wanted {
                let triangle = triangle.map(|at| {
                    *numbers.entry(at).or_insert_with(|| {
                        part.points.push(self.points[at]);
                        part.points.len() - 1
                    })
                });
                part.triangles.push(triangle);
            }
        }
        part
    }

    /// The least and the largest coordinates.
    pub fn bounds(&self) -> Option<(Point, Point)> {
        let first = *self.points.first()?;
        let grow = |(low, high): (Point, Point), point: &Point| {
            (
                [0, 1, 2].map(|i| low[i].min(point[i])),
                [0, 1, 2].map(|i| high[i].max(point[i])),
            )
        };
        Some(self.points.iter().fold((first, first), grow))
    }

    /// Where the surface ends: edges of one triangle alone, in chains.
    pub fn border(&self) -> Vec<Vec<Point>> {
        let mut edges: HashMap<(usize, usize), usize> = HashMap::new();
        for [a, b, c] in &self.triangles {
            for (p, q) in [(*a, *b), (*b, *c), (*c, *a)] {
                *edges.entry((p.min(q), p.max(q))).or_default() += 1;
            }
        }
        let mut single: Vec<(usize, usize)> = edges
            .into_iter()
            .filter_map(|(edge, count)| (count == 1).then_some(edge))
            .collect();
        single.sort_unstable();
        let mut neighbours: HashMap<usize, Vec<usize>> = HashMap::new();
        for &(p, q) in &single {
            neighbours.entry(p).or_default().push(q);
            neighbours.entry(q).or_default().push(p);
        }
        let mut chains = Vec::new();
        for (start, _) in single {
            let (mut chain, mut at) = (vec![self.points[start]], start);
            while let Some(next) = neighbours.get_mut(&at).and_then(Vec::pop) {
                if let Some(back) = neighbours.get_mut(&next) {
                    back.retain(|corner| *corner != at);
                }
                chain.push(self.points[next]);
                at = next;
            }
            if chain.len() > 1 {
                chains.push(chain);
            }
        }
        chains
    }

    /// The curves on which a coordinate has one of so many values between its extremes.
    pub fn net(&self, count: usize) -> Vec<Vec<Point>> {
        let Some((low, high)) = self.bounds() else {
            return Vec::new();
        };
        let lines = (0..3).flat_map(|axis| {
            let values: Vec<f64> = self.points.iter().map(|point| point[axis]).collect();
            (1..=count).flat_map(move |k| {
                let part = k as f64 / (count + 1) as f64;
                self.curves(&values, low[axis] + part * (high[axis] - low[axis]))
            })
        });
        lines.collect()
    }

    /// The curves on which a function of the corners has a value, each a chain of points on edges of triangles.
    pub fn curves(&self, values: &[f64], level: f64) -> Vec<Vec<Point>> {
        let above = |at: usize| values[at] >= level;
        let mut neighbours: HashMap<(usize, usize), Vec<(usize, usize)>> = HashMap::new();
        let mut order = Vec::new();
        for triangle in &self.triangles {
            if triangle.iter().any(|&at| !values[at].is_finite()) {
                continue;
            }
            let [a, b, c] = *triangle;
            let crossed: Vec<(usize, usize)> = [(a, b), (b, c), (c, a)]
                .into_iter()
                .filter(|&(p, q)| above(p) != above(q))
                .map(|(p, q)| (p.min(q), p.max(q)))
                .collect();
            if let [p, q] = crossed[..] {
                for (from, to) in [(p, q), (q, p)] {
                    let known = neighbours.entry(from).or_default();
                    if known.is_empty() {
                        order.push(from);
                    }
                    known.push(to);
                }
            }
        }
        // open chains from their ends first, then closed ones
        order.sort_by_key(|edge| neighbours[edge].len());
        let mut curves = Vec::new();
        for start in order {
            let mut chain = vec![start];
            let mut at = start;
            while let Some(next) = neighbours.get_mut(&at).and_then(Vec::pop) {
                if let Some(back) = neighbours.get_mut(&next) {
                    back.retain(|edge| *edge != at);
                }
                chain.push(next);
                at = next;
            }
            if chain.len() > 1 {
                let point = |&(p, q): &(usize, usize)| {
                    let part = (level - values[p]) / (values[q] - values[p]);
                    let (p, q) = (&self.points[p], &self.points[q]);
                    [0, 1, 2].map(|i| p[i] + part * (q[i] - p[i]))
                };
                curves.push(chain.iter().map(point).collect());
            }
        }
        curves
    }
}

/// Where a function vanishes on an edge, about: on the straight line between its values, or in smaller parts where the function
/// is steep at one end, as a logarithm.
fn between(function: &Field<'_>, mut p: (Point, f64), mut q: (Point, f64)) -> Point {
    let near = 0.05 * (p.1 - q.1).abs();
    let along = |p: &Point, q: &Point, part: f64| [0, 1, 2].map(|i| p[i] + part * (q[i] - p[i]));
    for round in 0..24 {
        // by halves in every second round: an end that stays holds the line up
        let part = match round % 2 {
            0 => p.1 / (p.1 - q.1),
            _ => 0.5,
        };
        let point = along(&p.0, &q.0, part);
        let value = function(&point).0;
        if !value.is_finite() || value.abs() <= near {
            return point;
        }
        match (value < 0.0) == (p.1 < 0.0) {
            true => p = (point, value),
            false => q = (point, value),
        }
    }
    along(&p.0, &q.0, 0.5)
}

/// A step of Newton's method to where a function vanishes, shorter where a whole one does not come nearer, as at the border
/// of its domain.
fn nearer(function: &Field<'_>, point: &Point) -> Point {
    let (off, wanted) = (function(point).0.abs(), onto(point, &[(function, 0.0)]));
    let steps = [1.0, 0.5, 0.25, 0.1, 0.03];
    let mut tried = steps.map(|part| [0, 1, 2].map(|i| point[i] + part * (wanted[i] - point[i])));
    tried[0] = wanted;
    let found = tried
        .into_iter()
        .find(|point| function(point).0.abs() < off);
    found.unwrap_or(*point)
}

/// A step of Newton's method, the shortest, from a point to where one or two functions have given values.
pub fn onto(point: &Point, wanted: &[(&Field<'_>, f64)]) -> Point {
    let rows: Vec<(f64, Point)> = wanted
        .iter()
        .map(|(function, level)| {
            let (value, gradient) = function(point);
            (value - level, gradient)
        })
        .collect();
    let shift = match rows.as_slice() {
        [(f, u)] => u.map(|x| x * f / dot(u, u)),
        [(f, u), (g, v)] => {
            let (uu, uv, vv) = (dot(u, u), dot(u, v), dot(v, v));
            let determinant = uu * vv - uv * uv;
            // where the gradients are parallel, as at an equilibrium, only the first counts
            if determinant <= 1e-8 * uu * vv {
                return onto(point, &wanted[..1]);
            }
            let (a, b) = (
                (f * vv - g * uv) / determinant,
                (g * uu - f * uv) / determinant,
            );
            [0, 1, 2].map(|i| a * u[i] + b * v[i])
        }
        _ => [0.0; 3],
    };
    let moved = [0, 1, 2].map(|i| point[i] - shift[i]);
    match moved.iter().all(|x| x.is_finite()) {
        true => moved,
        false => *point,
    }
}

#[cfg(test)]
mod tests;
