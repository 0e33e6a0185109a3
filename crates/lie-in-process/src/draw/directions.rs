//! Random elements of an algebra whose distribution depends neither on the basis nor on the size of the structure constants.

use lie_dynamic::Dynamic;
use lie_runtime::lattice::count;
use lie_runtime::{LiePoisson, Poisson};

use lie_runtime::family::SplitMix;

/// A direction that is this near to a sum of those before it, up to the center, is left out.
const NEAR: f64 = 1e-10;

/// Normally distributed elements of the algebra of a compact group.
///
/// ```math
/// \xi \sim \mathcal{N}(0, K^{-1}), \qquad K_{ij} = \tfrac12 \mathrm{tr}(\mathrm{ad}_i^T \mathrm{ad}_j)
/// ```
///
/// On so(3) with unit structure constants `K` is the unit matrix. Each simple factor has a scale of its own, since `-2 K` is the
/// Killing form where ad is skew. On the center, which moves nothing, `K` is 0: directions that differ by elements of it from
/// others are not drawn. Two factors that no element of the basis tells apart, with scales further apart than 1e5, are one to
/// round-off, and the smaller one is left out.
pub struct Directions {
    /// Coordinates of a site, and how many sites there are: those of a coordinate lie side by side.
    size: usize,
    sites: usize,
    /// The largest structure constant of each direction.
    scales: Vec<f64>,
    /// The Cholesky factor of `K` in directions that are divided by the scales: rows up to the diagonal, 0 there where one is left
    /// out.
    factor: Vec<Vec<f64>>,
}

impl Directions {
    /// Those of a system. A family has the same at each site. What carries the time has none.
    pub fn of(system: &Dynamic<f64>) -> Self {
        let all = Poisson::<f64>::dimension(system);
        let sites = system.sizes().map_or(1, count);
        let size = all / sites;
        let mut scales = vec![0.0; size];
        let mut rows: Vec<Vec<(usize, f64)>> = vec![Vec::new(); size];
        let (mut xi, mut mu, mut image) = (vec![0.0; all], vec![0.0; all], vec![0.0; all]);
        let clock = Poisson::<f64>::clock(system);
        for k in (0..size).filter(|k| !clock.is_some_and(|clock| clock.holds(*k))) {
            xi[k * sites] = 1.0;
            for j in 0..size {
                mu[j * sites] = 1.0;
                system.ad_star(&xi, &mu, &mut image);
                mu[j * sites] = 0.0;
                let entries = image.iter().step_by(sites).enumerate();
                let entries = entries.filter(|(_, entry)| **entry != 0.0);
                rows[k].extend(entries.map(|(i, entry)| (j * size + i, *entry)));
            }
            xi[k * sites] = 0.0;
            let sizes = rows[k].iter().map(|(_, entry)| entry.abs());
            scales[k] = sizes.fold(0.0, f64::max);
            rows[k]
                .iter_mut()
                .for_each(|(_, entry)| *entry /= scales[k]);
        }
        Self {
            size,
            sites,
            scales,
            factor: cholesky(&products(&rows)),
        }
    }

    /// Draws an element.
    pub fn draw(&self, source: &mut SplitMix, xi: &mut [f64]) {
        let mut element = vec![0.0; self.size];
        for site in 0..self.sites {
            for (k, entry) in element.iter_mut().enumerate() {
                *entry = match self.factor[k][k] > 0.0 {
                    true => source.normal(),
                    false => 0.0,
                };
            }
            // the transposed factor takes it to independent numbers
            for k in (0..self.size).rev() {
                let row = &self.factor[k];
                if row[k] > 0.0 {
                    element[k] /= row[k];
                    for j in 0..k {
                        element[j] -= row[j] * element[k];
                    }
                    xi[k * self.sites + site] = element[k] / self.scales[k];
                }
            }
        }
    }
}

/// Half the scalar products of sparse rows, up to the diagonal.
fn products(rows: &[Vec<(usize, f64)>]) -> Vec<Vec<f64>> {
    let mut full = vec![0.0; rows.len() * rows.len()];
    let products = rows.iter().enumerate().map(|(k, row)| {
        row.iter().for_each(|(place, entry)| full[*place] = *entry);
        let with = |other: &Vec<(usize, f64)>| {
            let parts = other.iter().map(|(place, entry)| full[*place] * entry);
            parts.sum::<f64>() / 2.0
        };
        let found = rows[..=k].iter().map(with).collect();
        row.iter().for_each(|(place, _)| full[*place] = 0.0);
        found
    });
    products.collect()
}

/// The Cholesky factor of a semidefinite matrix; rows and columns that depend on those before them are 0.
fn cholesky(matrix: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let mut factor: Vec<Vec<f64>> = Vec::with_capacity(matrix.len());
    for (k, given) in matrix.iter().enumerate() {
        let mut row = vec![0.0; k + 1];
        for j in 0..k {
            let before = row[..j].iter().zip(&factor[j]);
            let rest = given[j] - before.map(|(a, b)| a * b).sum::<f64>();
            row[j] = if factor[j][j] > 0.0 {
                rest / factor[j][j]
            } else {
                0.0
            };
        }
        let rest = given[k] - row.iter().map(|x| x * x).sum::<f64>();
        match rest > NEAR * given[k] {
            true => row[k] = rest.sqrt(),
            false => row.fill(0.0),
        }
        factor.push(row);
    }
    factor
}
