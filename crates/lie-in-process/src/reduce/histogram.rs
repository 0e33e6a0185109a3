//! How many members are where: directions on a sphere, or values of each coordinate.

use std::f64::consts::PI;
use std::io::{self, Read};

use lie_dynamic::Dynamic;
use lie_runtime::matrix::SquareMatrix as _;
use lie_runtime::{Clock, Poisson, Scalar};
use serde::{Deserialize, Serialize};

use crate::memory;

/// Where members are counted.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
pub enum Bins {
    /// By direction. Bands have the same height, from -z to z, and so all bins the same area; sectors begin at -x and go around z.
    Sphere {
        /// How many bands.
        bands: usize,
        /// How many bins each of them has.
        sectors: usize,
    },
    /// By the value of each coordinate.
    Coordinates {
        /// How many of the same width.
        count: usize,
        /// From where to where, for each coordinate, once it is known: the least and the largest value that any member has in any row.
        ranges: Vec<[f64; 2]>,
    },
}

/// Bands of a sphere and bins of a coordinate, where nobody says how many.
const BANDS: usize = 16;
const COUNT: usize = 50;
/// Sectors of each band: bins at the equator are nearly squares.
const SECTORS: usize = 3;

/// The most bands, and the most bins of a coordinate: of a sphere there are three million then.
pub const MOST_BINS: usize = 1000;

/// So many points tell whether leaves are spheres.
const POINTS: i32 = 8;

/// Whether the leaves are spheres around zero, as the coadjoint orbits of so(3) in an orthonormal basis: `Pi(x) x = 0`, and Pi is not.
fn has_spheres(system: &Dynamic<f64>) -> bool {
    let size = Poisson::<f64>::dimension(system);
    let clock = Poisson::<f64>::clock(system);
    // behind the time are its unit and what is held over a step
    let is_own = |clock: Clock, place| place < clock.time && place != clock.momentum;
    let places = (0..size).filter(|&place| clock.is_none_or(|clock| is_own(clock, place)));
    let Ok(places) = <[usize; 3]>::try_from(places.collect::<Vec<_>>()) else {
        return false;
    };
    let mut point = vec![0.0; size];
    let mut matrix = Poisson::<f64>::zero_jacobian(system);
    let mut moves = false;
    let keeps = (1..=POINTS).map(f64::from).all(|k| {
        let numbers = [1.0 / k, 0.5 * k - 2.2, 0.3 + 0.1 * k * k];
        places
            .iter()
            .zip(numbers)
            .for_each(|(&place, x)| point[place] = x);
        system.poisson_matrix(&point, &mut matrix);
        places.iter().all(|&row| {
            let parts = places.map(|column| matrix.get(row, column) * point[column]);
            let size: f64 = parts.iter().map(|part| part.abs()).sum();
            moves |= size > 0.0;
            parts.iter().sum::<f64>().abs() <= 1e-12 * size
        })
    });
    keeps && moves
}

impl Bins {
    /// Those of a system, if there is one.
    pub fn of(system: Option<&Dynamic<f64>>, count: Option<usize>) -> Self {
        match system.is_some_and(has_spheres) {
            true => {
                let bands = count.unwrap_or(BANDS);
                Self::Sphere {
                    bands,
                    sectors: SECTORS * bands,
                }
            }
            false => Self::Coordinates {
                count: count.unwrap_or(COUNT),
                ranges: Vec::new(),
            },
        }
    }

    /// Whether members can be counted there, which of bins that were read is not sure.
    pub fn is_sound(&self) -> bool {
        match *self {
            Self::Sphere { bands, sectors } => {
                (1..=MOST_BINS).contains(&bands) && sectors == SECTORS * bands
            }
            Self::Coordinates { count, .. } => (1..=MOST_BINS).contains(&count),
        }
    }

    /// As they are before a member is counted.
    #[must_use]
    pub fn empty(&self) -> Self {
        match self {
            Self::Sphere { .. } => self.clone(),
            &Self::Coordinates { count, .. } => Self::Coordinates {
                count,
                ranges: Vec::new(),
            },
        }
    }

    /// The axes of the counts behind that of the rows, where states have so many columns.
    pub fn shape(&self, columns: usize) -> [usize; 2] {
        match *self {
            Self::Sphere { bands, sectors } => [bands, sectors],
            Self::Coordinates { count, .. } => [columns, count],
        }
    }

    /// Counts members, row by row, and finds the ranges where they are needed. States that are not numbers are left out, and those without a
    /// direction. `again` gives the numbers from the beginning, as often as there is need to read them.
    ///
    /// # Errors
    /// What cannot be read, or no memory.
    pub fn count<R: Read>(
        &mut self,
        mut again: impl FnMut() -> io::Result<R>,
        members: usize,
        [rows, columns]: [usize; 2],
    ) -> io::Result<Vec<f64>> {
        if let Self::Coordinates { ranges, .. } = self {
            *ranges = vec![[f64::INFINITY, f64::NEG_INFINITY]; columns];
            states(again()?, members * rows, columns, |_, state| {
                for ([low, high], &x) in ranges.iter_mut().zip(state) {
                    (*low, *high) = (low.min(x), high.max(x));
                }
            })?;
            ranges.iter_mut().for_each(widen);
        }
        let each = self.shape(columns).iter().product::<usize>();
        let mut counts = Vec::new();
        memory::reserve(&mut counts, rows * each)?;
        counts.resize(rows * each, 0.0);
        states(again()?, members * rows, columns, |place, state| {
            let counts = &mut counts[place % rows * each..][..each];
            match self {
                Self::Sphere { bands, sectors } => {
                    let norm = state.iter().map(|x| x * x).sum::<f64>().sqrt();
                    if let [x, y, z] = *state
                        && norm > 0.0
                    {
                        let band = bin([-1.0, 1.0], z / norm, *bands);
                        let angle = Scalar::atan2(y, x);
                        counts[band * *sectors + bin([-PI, PI], angle, *sectors)] += 1.0;
                    }
                }
                Self::Coordinates { count, ranges } => {
                    for (column, (&range, &x)) in ranges.iter().zip(state).enumerate() {
                        counts[column * *count + bin(range, x, *count)] += 1.0;
                    }
                }
            }
        })?;
        Ok(counts)
    }
}

/// Of a range without a length, or without an end, one that has both.
fn widen(range: &mut [f64; 2]) {
    let [low, high] = *range;
    *range = match low < high {
        true => [low, high],
        false if low == high => [low - 0.5, high + 0.5],
        false => [0.0, 1.0],
    };
}

/// The bin of a value; the last one has its upper end too.
fn bin([low, high]: [f64; 2], x: f64, count: usize) -> usize {
    (((x - low) / (high - low) * count as f64) as usize).min(count - 1)
}

/// Reads states that are numbers, each with its place among all.
fn states(
    mut numbers: impl Read,
    count: usize,
    columns: usize,
    mut take: impl FnMut(usize, &[f64]),
) -> io::Result<()> {
    let mut bytes = vec![0; columns * 8];
    let mut state = Vec::with_capacity(columns);
    for place in 0..count {
        numbers.read_exact(&mut bytes)?;
        let all = bytes.chunks_exact(8);
        state.clear();
        state.extend(all.map(|bytes| bytes.try_into().map_or(f64::NAN, f64::from_le_bytes)));
        if state.iter().all(|x| x.is_finite()) {
            take(place, &state);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use lie_codegen::compile::compile_spec;

    /// What carries the time and what is held over a step take no sphere away.
    #[test]
    fn a_spin_at_a_temperature_has_spheres() {
        for (hamiltonian, spheres) in [("-z", true), ("-z + t*x", true), ("-z + k*x", false)] {
            let basis = match spheres {
                true => r#""algebra": "so(3)", "state": ["x", "y", "z"]"#,
                false => r#""algebra": "so(3) + R", "state": ["x", "y", "z", "k"]"#,
            };
            let model = compile_spec(&format!(
                r#"{{"name": "Spin", {basis}, "hamiltonian": "{hamiltonian}",
                    "dissipation": [{{"kind": "double-bracket", "strength": 1, "temperature": 1}}]}}"#
            ))
            .unwrap();
            let system = crate::declared(&model).unwrap();
            let system = system.system(&model.defaults()).unwrap();
            assert_eq!(has_spheres(&system), spheres, "{hamiltonian}");
        }
    }

    fn bytes(numbers: &[f64]) -> Vec<u8> {
        numbers.iter().flat_map(|x| x.to_le_bytes()).collect()
    }

    /// Points that are uniform in height and azimuth have as many in each bin; a twice as long state has the same direction.
    #[test]
    fn bins_of_a_sphere_have_the_same_area() {
        let mut bins = Bins::Sphere {
            bands: 4,
            sectors: 6,
        };
        let mut numbers = Vec::new();
        for (i, j) in (0..40).flat_map(|i| (0..60).map(move |j| (i, j))) {
            let z = -1.0 + (f64::from(i) + 0.5) / 20.0;
            let (sin, cos) = (-PI + (f64::from(j) + 0.5) * PI / 30.0).sin_cos();
            let (length, around) = (1.0 + f64::from(j), (1.0 - z * z).sqrt());
            numbers.extend([cos * around, sin * around, z].map(|x| length * x));
        }
        numbers.extend([0.0; 3]);
        numbers.extend([1.0, f64::NAN, 1.0]);
        let bytes = bytes(&numbers);
        let counts = bins.count(|| Ok(&bytes[..]), 2402, [1, 3]).unwrap();
        assert_eq!(counts, [100.0; 24]);
        let pole = bytes_of_one([0.0, 0.0, 2.0], &mut bins);
        // atan2(0, 0) is 0: the fourth sector of the last band
        assert_eq!(pole.iter().position(|&x| x == 1.0), Some(3 * 6 + 3));
        let edge = bytes_of_one([-1.0, 0.0, -1e-300], &mut bins);
        assert_eq!(edge.iter().position(|&x| x == 1.0), Some(2 * 6 + 5));
    }

    fn bytes_of_one(state: [f64; 3], bins: &mut Bins) -> Vec<f64> {
        let bytes = bytes(&state);
        bins.count(|| Ok(&bytes[..]), 1, [1, 3]).unwrap()
    }

    /// numpy.histogram([1, 2, 2, 5], 4, (1, 5)) is [1, 2, 0, 1].
    #[test]
    fn bins_of_coordinates_go_from_the_least_to_the_largest_value() {
        let mut bins = Bins::Coordinates {
            count: 4,
            ranges: Vec::new(),
        };
        // three members of two rows and two columns, the last of which came to its first row alone
        let nan = f64::NAN;
        let bytes = bytes(&[1.0, 7.0, 2.0, 7.0, 2.0, 7.0, 5.0, 7.0, 1.0, 7.0, nan, nan]);
        let counts = bins.count(|| Ok(&bytes[..]), 3, [2, 2]).unwrap();
        let first = [[2.0, 1.0, 0.0, 0.0], [0.0, 0.0, 3.0, 0.0]];
        let second = [[0.0, 1.0, 0.0, 1.0], [0.0, 0.0, 2.0, 0.0]];
        assert_eq!(counts, [first, second].concat().concat());
        let Bins::Coordinates { ranges, .. } = &bins else {
            unreachable!("they are bins of coordinates");
        };
        assert_eq!(*ranges, [[1.0, 5.0], [6.5, 7.5]]);
    }
}
