//! Small dense linear algebra.

/// Rounds of rotations; six or seven are enough.
const SWEEPS: usize = 40;

/// Solves `A x = b` by elimination with row exchanges; `None` where a pivot is 0.
pub fn solve<T>(mut a: Vec<T>, mut b: Vec<T>, size: impl Fn(&T) -> f64) -> Option<Vec<T>>
where
    T: Copy + std::ops::Sub<Output = T> + std::ops::Mul<Output = T> + std::ops::Div<Output = T>,
{
    let n = b.len();
    for k in 0..n {
        let best = (k..n).max_by(|i, j| size(&a[i * n + k]).total_cmp(&size(&a[j * n + k])))?;
        if size(&a[best * n + k]) == 0.0 {
            return None;
        }
        if best != k {
            (0..n).for_each(|j| a.swap(k * n + j, best * n + j));
            b.swap(k, best);
        }
        for i in k + 1..n {
            let factor = a[i * n + k] / a[k * n + k];
            for j in k + 1..n {
                a[i * n + j] = a[i * n + j] - factor * a[k * n + j];
            }
            b[i] = b[i] - factor * b[k];
        }
    }
    for k in (0..n).rev() {
        for j in k + 1..n {
            b[k] = b[k] - a[k * n + j] * b[j];
        }
        b[k] = b[k] / a[k * n + k];
    }
    Some(b)
}

/// The singular value decomposition of a matrix by rows, values from the largest down.
pub struct Singular {
    /// The values.
    pub values: Vec<f64>,
    /// The left vectors.
    left: Vec<Vec<f64>>,
    /// The right vectors, all of them.
    pub right: Vec<Vec<f64>>,
}

impl Singular {
    /// Decomposes by rotations of columns until all are orthogonal (Hestenes 1958, doi:10.1137/0106005), for matrices as small as
    /// these the fastest way; `None` where something is not finite.
    pub fn new(a: &[f64], rows: usize, columns: usize) -> Option<Self> {
        let column = |j: usize| (0..rows).map(|i| a[i * columns + j]).collect();
        let mut images: Vec<Vec<f64>> = (0..columns).map(column).collect();
        let mut right = unit_vectors(columns);
        if !a.iter().all(|x| x.is_finite()) {
            return None;
        }
        let whole = norm(a);
        for _ in 0..SWEEPS {
            let mut turned = false;
            for p in 0..columns {
                for q in p + 1..columns {
                    let (u, v) = (dot(&images[p], &images[p]), dot(&images[q], &images[q]));
                    let w = dot(&images[p], &images[q]);
                    // columns of round-off alone have no directions
                    let least = (f64::EPSILON * whole).powi(2);
                    if w.abs() <= f64::EPSILON * (u * v).sqrt() || w.abs() <= least {
                        continue;
                    }
                    turned = true;
                    let rotation = rotation(u, v, w);
                    turn(&mut images, p, q, rotation);
                    turn(&mut right, p, q, rotation);
                }
            }
            if !turned {
                break;
            }
        }
        let mut order: Vec<(f64, usize)> = images.iter().map(|u| norm(u)).zip(0..).collect();
        order.sort_by(|a, b| b.0.total_cmp(&a.0));
        let left = order.iter().map(|(value, k)| {
            let image = images[*k].iter();
            image.map(|x| x / value.max(f64::MIN_POSITIVE)).collect()
        });
        Some(Self {
            left: left.collect(),
            right: order.iter().map(|(_, k)| right[*k].clone()).collect(),
            values: order.iter().map(|(value, _)| *value).collect(),
        })
    }

    /// How many values are above a part of the largest.
    pub fn rank(&self, part: f64) -> usize {
        let bound = part * self.values.first().copied().unwrap_or(0.0);
        self.values.iter().filter(|value| **value > bound).count()
    }

    /// The shortest solution of least squares, in which values beyond the rank do not take part.
    pub fn shortest(&self, b: &[f64], rank: usize) -> Vec<f64> {
        let columns = self.right.first().map_or(0, Vec::len);
        let mut x = vec![0.0; columns];
        for k in 0..rank {
            let part = dot(&self.left[k], b) / self.values[k];
            add(&mut x, part, &self.right[k]);
        }
        x
    }

    /// An orthonormal basis of the kernel.
    pub fn kernel(&self, rank: usize) -> &[Vec<f64>] {
        &self.right[rank..]
    }
}

/// Cosine and sine of the rotation that makes two vectors with squares u, v and product w orthogonal.
fn rotation(u: f64, v: f64, w: f64) -> (f64, f64) {
    let ratio = 0.5 * (v - u) / w;
    let tangent = ratio.signum() / (ratio.abs() + ratio.hypot(1.0));
    let cosine = 1.0 / tangent.hypot(1.0);
    (cosine, cosine * tangent)
}

fn turn(vectors: &mut [Vec<f64>], p: usize, q: usize, (cosine, sine): (f64, f64)) {
    let (head, tail) = vectors.split_at_mut(q);
    for (x, y) in head[p].iter_mut().zip(&mut tail[0]) {
        (*x, *y) = (cosine * *x - sine * *y, sine * *x + cosine * *y);
    }
}

/// The vectors along the axes.
pub fn unit_vectors(n: usize) -> Vec<Vec<f64>> {
    let unit = |i: usize| (0..n).map(|j| f64::from(u8::from(i == j))).collect();
    (0..n).map(unit).collect()
}

/// The eigenvalues of a symmetric matrix by rows, ascending, with eigenvectors of length 1, by rotations (Jacobi 1846).
pub fn symmetric_eigen(a: &[f64], n: usize) -> (Vec<f64>, Vec<Vec<f64>>) {
    let mut rows: Vec<Vec<f64>> = a.chunks(n.max(1)).map(<[f64]>::to_vec).collect();
    let mut vectors = unit_vectors(n);
    let least = f64::EPSILON * norm(a);
    for _ in 0..SWEEPS {
        let mut turned = false;
        for p in 0..n {
            for q in p + 1..n {
                let w = rows[p][q];
                if w.abs() <= 0.1 * least {
                    continue;
                }
                turned = true;
                let rotation = rotation(rows[p][p], rows[q][q], w);
                turn(&mut rows, p, q, rotation);
                let (cosine, sine) = rotation;
                for row in &mut rows {
                    (row[p], row[q]) = (
                        cosine * row[p] - sine * row[q],
                        sine * row[p] + cosine * row[q],
                    );
                }
                turn(&mut vectors, p, q, rotation);
            }
        }
        if !turned {
            break;
        }
    }
    let mut order: Vec<(f64, usize)> = (0..n).map(|k| (rows[k][k], k)).collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    let vectors = order.iter().map(|(_, k)| vectors[*k].clone()).collect();
    (order.into_iter().map(|(value, _)| value).collect(), vectors)
}

/// `B^T A B` for vectors that are the columns of B.
pub fn restricted(a: &[f64], n: usize, basis: &[Vec<f64>]) -> Vec<f64> {
    let images: Vec<Vec<f64>> = basis.iter().map(|v| times(a, n, v)).collect();
    let rows = basis
        .iter()
        .flat_map(|u| images.iter().map(move |image| dot(u, image)));
    rows.collect()
}

/// `A x`, A by rows of length n.
pub fn times(a: &[f64], n: usize, x: &[f64]) -> Vec<f64> {
    a.chunks(n).map(|row| dot(row, x)).collect()
}

/// A product of square matrices by rows.
pub fn product(a: &[f64], b: &[f64], n: usize) -> Vec<f64> {
    let mut c = vec![0.0; n * n];
    for i in 0..n {
        for k in 0..n {
            let factor = a[i * n + k];
            (0..n).for_each(|j| c[i * n + j] += factor * b[k * n + j]);
        }
    }
    c
}

/// The scalar product.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// The Euclidean norm.
pub fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

/// `a += factor b`.
pub fn add(a: &mut [f64], factor: f64, b: &[f64]) {
    a.iter_mut().zip(b).for_each(|(x, y)| *x += factor * y);
}

/// `a - b`.
pub fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(x, y)| x - y).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn decompositions_of_small_matrices() {
        let mut random = Random::new(5);
        for (rows, columns) in [(5, 5), (4, 5), (2, 6), (6, 3)] {
            // of rank 2 at most
            let part = |random: &mut Random, n: usize| -> Vec<f64> {
                (0..n).map(|_| random.unit()).collect()
            };
            let (u, v) = (part(&mut random, 2 * rows), part(&mut random, 2 * columns));
            let entry = |i: usize, j: usize| u[2 * i] * v[2 * j] + u[2 * i + 1] * v[2 * j + 1];
            let a: Vec<f64> = (0..rows * columns)
                .map(|k| entry(k / columns, k % columns))
                .collect();
            let found = Singular::new(&a, rows, columns).expect("finite");
            assert_eq!((found.rank(1e-10), found.right.len()), (2, columns));
            for kernel in found.kernel(2) {
                assert!(norm(&times(&a, columns, kernel)) < 1e-14);
            }
            let b = times(&a, columns, &part(&mut random, columns));
            let x = found.shortest(&b, 2);
            assert!(norm(&difference(&times(&a, columns, &x), &b)) < 1e-13);
        }
        let a = [2.0, 1.0, 0.0, 1.0, 2.0, 1.0, 0.0, 1.0, 2.0];
        let (values, vectors) = symmetric_eigen(&a, 3);
        let root = 2.0_f64.sqrt();
        assert!(norm(&difference(&values, &[2.0 - root, 2.0, 2.0 + root])) < 1e-14);
        let image = times(&a, 3, &vectors[0]);
        let expected: Vec<f64> = vectors[0].iter().map(|x| values[0] * x).collect();
        assert!(norm(&difference(&image, &expected)) < 1e-14);
    }
}
