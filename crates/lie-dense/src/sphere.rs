//! The Euler equations on the sphere, truncated to matrices.
//!
//! ```text
//! W' = [P, W]/hbar,   Delta_N P = W,   hbar = 2/sqrt(N^2 - 1)
//! ```
//!
//! W = i F is a vorticity: the matrices `T_lm` of Hoppe and Yau, one for each spherical harmonic with l < N, take its place. They
//! are eigenmatrices of a Laplacian `Delta_N` with the eigenvalues `-l(l+1)` of the sphere, which acts on each diagonal by
//! itself as a tridiagonal matrix: the stream function costs `O(N^2)`. As N grows, `[A, B]/hbar` becomes the Poisson bracket of
//! the sphere. The N - 1 Casimirs `tr W^k` stand for the integrals of powers of the vorticity.
//!
//! References: V. Zeitlin, "Self-consistent finite-mode approximations for the hydrodynamics of an incompressible fluid on
//! nonrotating and rotating spheres", Physical Review Letters 93 (2004) 264501,
//! [doi:10.1103/PhysRevLett.93.264501](https://doi.org/10.1103/PhysRevLett.93.264501); J. Hoppe, S.-T. Yau, "Some properties of
//! matrix harmonics on S^2", Communications in Mathematical Physics 195 (1998) 67–77,
//! [doi:10.1007/s002200050379](https://doi.org/10.1007/s002200050379); K. Modin, M. Viviani, "A Casimir preserving scheme for
//! long-time simulation of spherical ideal hydrodynamics", Journal of Fluid Mechanics 884 (2020) A22,
//! [doi:10.1017/jfm.2019.944](https://doi.org/10.1017/jfm.2019.944).

use crate::product::widest;
use crate::skew::{ShapeError, SkewHermitian, imaginary_start};
use crate::stream::StreamMap;
use pulp::NullaryFnOnce;

/// The stream map `P = Delta_N^-1 W / hbar` of the Euler equations on the sphere.
///
/// The energy is `H = -<W, P>/2`, with P as it is here; `hbar H / N` is the mean over the sphere of half the squared
/// velocity.
#[derive(Clone, Debug)]
pub struct SphereEuler {
    size: usize,
    hbar: f64,
    /// By columns like the imaginary parts of a state: what is subtracted of the place before on the diagonal, the inverse
    /// pivots over hbar, and what is subtracted of the place after.
    forward: Vec<f64>,
    inverse: Vec<f64>,
    backward: Vec<f64>,
}

impl SphereEuler {
    /// For matrices of size N.
    ///
    /// # Errors
    /// [`ShapeError::TooSmall`] for N below 2.
    pub fn new(size: usize) -> Result<Self, ShapeError> {
        if size < 2 {
            return Err(ShapeError::TooSmall { least: 2, size });
        }
        let hbar = 2.0 / ((size * size - 1) as f64).sqrt();
        let places = size * (size + 1) / 2;
        let mut map = Self {
            size,
            hbar,
            forward: vec![0.0; places],
            inverse: vec![0.0; places],
            backward: vec![0.0; places],
        };
        for order in 0..size {
            let mut pivot = 0.0;
            for k in 0..size - order {
                let place = imaginary_start(size, k) + order;
                let off = off_diagonal(size, order, k);
                let factor = if k == 0 { 0.0 } else { off / pivot };
                pivot = diagonal(size, order, k) - factor * off;
                if order == 0 && k == 0 {
                    // the unit matrix is in the kernel: it is taken out before and after
                    pivot -= 0.5;
                }
                map.forward[place] = factor;
                map.inverse[place] = 1.0 / (hbar * pivot);
                if k + 1 < size - order {
                    map.backward[place] = off_diagonal(size, order, k + 1) / pivot;
                }
            }
        }
        Ok(map)
    }

    /// `hbar = 2/sqrt(N^2 - 1)`
    pub fn hbar(&self) -> f64 {
        self.hbar
    }

    /// The matrix of a vorticity with these coefficients: degree l, order m >= 0, and the complex coefficient `c_lm` of
    ///
    /// ```text
    /// omega = sum_l c_l0 Y_l0 + sum_(l, m > 0) 2 Re(c_lm Y_lm)
    /// ```
    ///
    /// with harmonics of mean square 1 over the sphere, positive at their first maximum from the north pole (on the
    /// meridian 0). Of order 0 the real part counts.
    ///
    /// # Errors
    /// [`ShapeError::Harmonic`] unless m <= l < N.
    ///
    /// ```
    /// use lie_dense::SphereEuler;
    /// let sphere = SphereEuler::new(16)?;
    /// let w = sphere.vorticity(&[(1, 0, (0.5, 0.0)), (3, 2, (0.1, 0.2))])?;
    /// let (re, im) = sphere.coefficient(&w, 3, 2)?;
    /// assert!((re - 0.1).abs() < 1e-14 && (im - 0.2).abs() < 1e-14);
    /// # Ok::<(), lie_dense::ShapeError>(())
    /// ```
    pub fn vorticity(
        &self,
        coefficients: &[(usize, usize, (f64, f64))],
    ) -> Result<SkewHermitian, ShapeError> {
        let mut w = SkewHermitian::zeros(self.size);
        for &(degree, order, (re, im)) in coefficients {
            // below the diagonal stands i conj(c) v
            let im = if order == 0 { 0.0 } else { im };
            for (k, v) in self.harmonic(degree, order)?.into_iter().enumerate() {
                let (x, y) = w.entry(k + order, k);
                w.set_lower(k + order, k, (x + im * v, y + re * v));
            }
        }
        Ok(w)
    }

    /// The coefficient `c_lm` of a vorticity, as in [`SphereEuler::vorticity`].
    ///
    /// # Errors
    /// [`ShapeError::Harmonic`] unless m <= l < N; [`ShapeError::Size`] for a matrix of another size.
    pub fn coefficient(
        &self,
        w: &SkewHermitian,
        degree: usize,
        order: usize,
    ) -> Result<(f64, f64), ShapeError> {
        if w.size() != self.size {
            let (system, state) = (self.size, w.size());
            return Err(ShapeError::Size { system, state });
        }
        let (mut re, mut im) = (0.0, 0.0);
        for (k, v) in self.harmonic(degree, order)?.into_iter().enumerate() {
            let (x, y) = w.entry(k + order, k);
            im += v * x;
            re += v * y;
        }
        Ok((re / self.size as f64, im / self.size as f64))
    }

    /// A smooth vorticity: random coefficients of the degrees 1 to `degree`, uniform in [-1, 1] over l^2, by a seed.
    ///
    /// # Errors
    /// [`ShapeError::Harmonic`] unless degree < N.
    pub fn random(&self, degree: usize, seed: u64) -> Result<SkewHermitian, ShapeError> {
        let mut state = seed;
        let mut draw = || {
            // SplitMix64
            state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
            let mut z = state;
            z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
            z ^= z >> 31;
            (z >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        let mut coefficients = Vec::new();
        for l in 1..=degree {
            let damping = 1.0 / (l * l) as f64;
            for m in 0..=l {
                coefficients.push((l, m, (draw() * damping, draw() * damping)));
            }
        }
        self.vorticity(&coefficients)
    }

    /// The upper diagonal of `T_lm`, of squared norm N for m = 0 and N for each of two diagonals otherwise.
    fn harmonic(&self, degree: usize, order: usize) -> Result<Vec<f64>, ShapeError> {
        let size = self.size;
        if order > degree || degree >= size {
            return Err(ShapeError::Harmonic {
                degree,
                order,
                size,
            });
        }
        let count = size - order;
        // inverse iteration: eigenvalues are known, and at least 2 apart
        let shift = -((degree * (degree + 1)) as f64) + 1e-3;
        let mut vector: Vec<f64> = (0..count).map(|k| 1.0 + 0.1 * (k as f64).sin()).collect();
        for _ in 0..10 {
            solve_tridiagonal(
                (0..count)
                    .map(|k| diagonal(size, order, k) - shift)
                    .collect(),
                &(1..count)
                    .map(|k| off_diagonal(size, order, k))
                    .collect::<Vec<_>>(),
                &mut vector,
            );
            let norm = vector.iter().map(|v| v * v).sum::<f64>().sqrt();
            vector.iter_mut().for_each(|v| *v /= norm);
        }
        let visible = vector
            .iter()
            .find(|v| v.abs() > 1e-3)
            .copied()
            .unwrap_or(1.0);
        let scale = (size as f64).sqrt() * visible.signum();
        vector.iter_mut().for_each(|v| *v *= scale);
        Ok(vector)
    }
}

/// The diagonal of `Delta_N` on diagonal m, at place k.
fn diagonal(size: usize, order: usize, k: usize) -> f64 {
    2.0 * (k * (k + order)) as f64 - ((size - 1) * (2 * k + 1 + order)) as f64
}

/// What stands beside it, between the places k - 1 and k.
fn off_diagonal(size: usize, order: usize, k: usize) -> f64 {
    let one = ((k + order) * (size - k - order)) as f64;
    (one * (k * (size - k)) as f64).sqrt()
}

/// Solves with a symmetric tridiagonal matrix in place of the right side, by elimination with row exchanges.
fn solve_tridiagonal(mut diagonal: Vec<f64>, off: &[f64], right: &mut [f64]) {
    let count = diagonal.len();
    let mut upper = off.to_vec();
    upper.push(0.0);
    let mut second = vec![0.0; count];
    for k in 0..count - 1 {
        let lower = off[k];
        if lower.abs() > diagonal[k].abs() {
            // row k + 1 becomes the pivot
            let factor = diagonal[k] / lower;
            let (next, beside) = (diagonal[k + 1], upper[k + 1]);
            diagonal[k] = lower;
            diagonal[k + 1] = upper[k] - factor * next;
            upper[k] = next;
            second[k] = beside;
            upper[k + 1] = -factor * beside;
            right.swap(k, k + 1);
            right[k + 1] -= factor * right[k];
        } else {
            let factor = lower / diagonal[k];
            diagonal[k + 1] -= factor * upper[k];
            right[k + 1] -= factor * right[k];
        }
    }
    for k in (0..count).rev() {
        let mut sum = right[k];
        if k + 1 < count {
            sum -= upper[k] * right[k + 1];
        }
        if k + 2 < count {
            sum -= second[k] * right[k + 2];
        }
        right[k] = sum / diagonal[k];
    }
}

impl StreamMap for SphereEuler {
    fn name(&self) -> &str {
        "SphereEuler"
    }

    fn size(&self) -> usize {
        self.size
    }

    fn stream(&self, w: &SkewHermitian, p: &mut SkewHermitian) {
        widest(Solve(self, w, p));
    }
}

struct Solve<'a>(&'a SphereEuler, &'a SkewHermitian, &'a mut SkewHermitian);

impl NullaryFnOnce for Solve<'_> {
    type Output = ();
    #[inline(always)]
    fn call(self) {
        self.0.solve(self.1, self.2);
    }
}

impl SphereEuler {
    /// `p = Delta_N^-1 w / hbar`, all diagonals together, place after place.
    #[inline(always)]
    fn solve(&self, w: &SkewHermitian, p: &mut SkewHermitian) {
        let size = self.size;
        let mean = w.trace() / size as f64;
        for first in 0..2 {
            // imaginary parts have the diagonal of order 0, real parts start at order 1
            let real = first == 1;
            for k in 0..size - first {
                let start = imaginary_start(size, k) + first;
                let factors = &self.forward[start..start + size - k - first];
                let (im, re) = w.column(k);
                let column = if real { re } else { im };
                let before = if k == 0 { 0 } else { k - 1 };
                let (head, tail) = p.split_at(k, real);
                let width = size - before - first;
                let previous = if k == 0 {
                    &[]
                } else {
                    &head[head.len() - width..]
                };
                let out = &mut tail[..size - k - first];
                if k == 0 {
                    out.copy_from_slice(column);
                } else {
                    let parts = column.iter().zip(factors).zip(previous);
                    for (out, ((&w, &factor), &previous)) in out.iter_mut().zip(parts) {
                        *out = w - factor * previous;
                    }
                }
                if !real {
                    out[0] -= mean;
                }
            }
            for k in (0..size - first).rev() {
                let start = imaginary_start(size, k) + first;
                let width = size - k - first;
                let (_, tail) = p.split_at(k, real);
                let (out, next) = tail.split_at_mut(width);
                for (out, &inverse) in out.iter_mut().zip(&self.inverse[start..start + width]) {
                    *out *= inverse;
                }
                let next = &next[..width - 1];
                let factors = &self.backward[start..start + width - 1];
                for (out, (&next, &factor)) in out.iter_mut().zip(next.iter().zip(factors)) {
                    *out -= factor * next;
                }
            }
        }
        p.add_to_diagonal(-p.trace() / size as f64);
    }
}
