//! Means over a space of few coordinates.

use super::quadrature::{Functions, MOST_VALUES, Means, Sums, converged};
use lie_runtime::poisson::Poisson;
use lie_runtime::state::State;

/// The most coordinates of a space.
pub(super) const MOST_COORDINATES: usize = 3;
/// A density below this part of the largest counts as nothing.
const NOTHING: f64 = 1e-15;
/// The most doublings of the box of a space.
const DOUBLINGS: usize = 40;

/// A box with the values of a density on a grid in it.
struct Grid {
    low: Vec<f64>,
    high: Vec<f64>,
}

impl Grid {
    /// Visits the points with so many intervals along each axis.
    fn visit(&self, intervals: usize, mut visit: impl FnMut(&[usize], &[f64])) {
        let axes = self.low.len();
        let mut index = vec![0; axes];
        loop {
            let point: Vec<f64> = (0..axes)
                .map(|k| {
                    let part = index[k] as f64 / intervals as f64;
                    self.low[k] + part * (self.high[k] - self.low[k])
                })
                .collect();
            visit(&index, &point);
            let Some(axis) = (0..axes).find(|axis| index[*axis] < intervals) else {
                return;
            };
            index[axis] += 1;
            index[..axis].fill(0);
        }
    }
}

/// The means over the space of the first coordinates, at most [`MOST_COORDINATES`]: equal distances in a box outside of which the density is
/// nothing, which for a smooth density is exact to all powers of the distance.
pub(super) fn on_space<P: Poisson<f64>>(
    own: usize,
    mu: &P::State,
    temperature: f64,
    functions: Functions<'_, P::State>,
) -> Result<Means, String> {
    const INTERVALS: usize = 16;
    let at = |point: &[f64]| {
        let mut mu = mu.clone();
        mu.as_mut_slice()[..own].copy_from_slice(point);
        functions(&mu)
    };
    let centre = &mu.as_slice()[..own];
    let mut width = centre.iter().fold(1e-3, |m, x| f64::max(m, x.abs()));
    let mut grid = Grid {
        low: centre.iter().map(|x| x - width).collect(),
        high: centre.iter().map(|x| x + width).collect(),
    };
    // the values of H inside, and which points count
    let look = |grid: &Grid| {
        let mut all: Vec<(Vec<usize>, f64)> = Vec::new();
        grid.visit(INTERVALS, |index, point| {
            all.push((index.to_vec(), at(point)[0]))
        });
        let finite = all.iter().map(|(_, h)| *h).filter(|h| h.is_finite());
        let least = finite.fold(f64::INFINITY, f64::min);
        all.retain(|(_, h)| (least - h) / temperature >= NOTHING.ln());
        all
    };
    let at_border = |all: &[(Vec<usize>, f64)]| {
        let mut indices = all.iter().flat_map(|(index, _)| index);
        indices.any(|k| *k == 0 || *k == INTERVALS)
    };
    let mut doublings = 0;
    while at_border(&look(&grid)) {
        if doublings == DOUBLINGS {
            return Err("exp(-H/T) has no finite integral over the space".to_owned());
        }
        doublings += 1;
        width *= 2.0;
        grid.low = centre.iter().map(|x| x - width).collect();
        grid.high = centre.iter().map(|x| x + width).collect();
    }
    // a box about what counts, several times: at first it may be a point
    for _ in 0..DOUBLINGS {
        let counting = look(&grid);
        let (mut low, mut high) = (grid.low.clone(), grid.high.clone());
        for axis in 0..own {
            let cell = (grid.high[axis] - grid.low[axis]) / INTERVALS as f64;
            let places = counting.iter().map(|(index, _)| index[axis]);
            let (first, last) = places.fold((INTERVALS, 0), |(a, b), k| (a.min(k), b.max(k)));
            low[axis] = grid.low[axis] + (first as f64 - 1.0) * cell;
            high[axis] = grid.low[axis] + (last as f64 + 1.0) * cell;
        }
        let before: f64 = (0..own).map(|k| grid.high[k] - grid.low[k]).product();
        let after: f64 = (0..own).map(|k| high[k] - low[k]).product();
        grid = Grid { low, high };
        if after > 0.9 * before {
            break;
        }
    }
    converged(|count| {
        if (count + 1).checked_pow(own as u32)? > MOST_VALUES {
            return None;
        }
        let mut sums = Sums::new();
        grid.visit(count, |_, point| sums.add(&at(point), 1.0, temperature));
        Some(sums.means())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A density whose means are known, far from the start of the search.

    #[test]
    fn means_of_a_gaussian_density() {
        let (centre, width) = ([3.0, -2.0], [0.2, 0.01]);
        let functions = |mu: &[f64; 2]| {
            let parts = (0..2).map(|k| ((mu[k] - centre[k]) / width[k]).powi(2) / 2.0);
            vec![parts.sum(), mu[0], mu[1]]
        };
        let mut sums = Sums::new();
        let grid = Grid {
            low: vec![1.0, -2.1],
            high: vec![5.0, -1.9],
        };
        grid.visit(200, |_, point| {
            sums.add(&functions(&[point[0], point[1]]), 1.0, 1.0)
        });
        let means = sums.means();
        for (found, exact) in means.mean.iter().zip([1.0, 3.0, -2.0]) {
            assert!((found - exact).abs() < 1e-10, "{means:?}");
        }
        for (found, exact) in means.deviation.iter().zip([1.0, 0.2, 0.01]) {
            assert!((found - exact).abs() < 1e-8, "{means:?}");
        }
    }
}
