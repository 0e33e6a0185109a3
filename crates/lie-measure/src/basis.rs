//! Orthogonal bases of spans, with the rank found on the way.

/// Vectors shorter than this part of the longest, after projection, add nothing to a span.
const DEPENDENT: f64 = 1e-11;

pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// The Euclidean norm.
pub(crate) fn norm(a: &[f64]) -> f64 {
    let largest = a.iter().fold(0.0_f64, |m, x| f64::max(m, x.abs()));
    if largest == 0.0 || !largest.is_finite() {
        return largest;
    }
    let sum: f64 = a.iter().map(|x| (x / largest) * (x / largest)).sum();
    largest * sum.sqrt()
}

/// An orthonormal basis of the span of some vectors, by the Gram–Schmidt process with pivoting,
/// each vector projected twice.
#[derive(Clone, Debug, Default)]
pub(crate) struct Basis {
    vectors: Vec<Vec<f64>>,
    /// For each basis vector the combination of the given vectors that makes it.
    combinations: Vec<Vec<f64>>,
}

impl Basis {
    /// The basis of the span of `vectors`.
    pub(crate) fn from_span(vectors: &[Vec<f64>]) -> Self {
        let mut rest: Vec<Vec<f64>> = vectors.to_vec();
        let unit = |k: usize| (0..vectors.len()).map(|i| f64::from(i == k)).collect();
        let mut made: Vec<Vec<f64>> = (0..vectors.len()).map(unit).collect();
        let longest = rest.iter().map(|v| norm(v)).fold(0.0, f64::max);
        let mut basis = Self::default();
        while let Some(pivot) =
            (0..rest.len()).max_by(|&a, &b| norm(&rest[a]).total_cmp(&norm(&rest[b])))
        {
            let mut vector = rest.swap_remove(pivot);
            let mut combination = made.swap_remove(pivot);
            basis.project_out(&mut vector, Some(&mut combination));
            let length = norm(&vector);
            if length <= DEPENDENT * longest || !length.is_finite() {
                if norm(&vector) <= DEPENDENT * longest {
                    continue;
                }
                break;
            }
            vector.iter_mut().for_each(|x| *x /= length);
            combination.iter_mut().for_each(|x| *x /= length);
            for (vector_left, made_left) in rest.iter_mut().zip(&mut made) {
                let along = dot(vector_left, &vector);
                subtract(vector_left, along, &vector);
                subtract(made_left, along, &combination);
            }
            basis.vectors.push(vector);
            basis.combinations.push(combination);
        }
        basis
    }

    /// The dimension of the span.
    pub(crate) fn rank(&self) -> usize {
        self.vectors.len()
    }

    fn project_out(&self, vector: &mut [f64], mut combination: Option<&mut Vec<f64>>) {
        for _ in 0..2 {
            for (unit, made) in self.vectors.iter().zip(&self.combinations) {
                let along = dot(vector, unit);
                subtract(vector, along, unit);
                if let Some(combination) = combination.as_deref_mut() {
                    subtract(combination, along, made);
                }
            }
        }
    }

    /// Coefficients of the given vectors whose sum is the point of the span nearest to `target`.
    pub(crate) fn solve(&self, target: &[f64], count: usize) -> Vec<f64> {
        let mut coefficients = vec![0.0; count];
        let mut left = target.to_vec();
        for (unit, made) in self.vectors.iter().zip(&self.combinations) {
            let along = dot(&left, unit);
            subtract(&mut left, along, unit);
            subtract(&mut coefficients, -along, made);
        }
        coefficients
    }

    /// An orthonormal basis of what is perpendicular to the span, in so many dimensions.
    pub(crate) fn complement(&self, dimension: usize) -> Vec<Vec<f64>> {
        let mut all = self.clone();
        let mut complement = Vec::new();
        while all.rank() < dimension {
            let left = |k: usize| {
                let mut unit: Vec<f64> = (0..dimension).map(|i| f64::from(i == k)).collect();
                all.project_out(&mut unit, None);
                unit
            };
            let longest = (0..dimension)
                .map(left)
                .max_by(|a, b| norm(a).total_cmp(&norm(b)));
            let Some(mut vector) = longest else { break };
            let length = norm(&vector);
            vector.iter_mut().for_each(|x| *x /= length);
            all.project_out(&mut vector, None);
            all.vectors.push(vector.clone());
            all.combinations.push(Vec::new());
            complement.push(vector);
        }
        complement
    }
}

fn subtract(from: &mut [f64], factor: f64, what: &[f64]) {
    for (x, y) in from.iter_mut().zip(what) {
        *x -= factor * y;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rank_solution_and_complement() {
        let vectors = [
            vec![1.0, 2.0, 0.0],
            vec![2.0, 4.0, 0.0],
            vec![0.0, 1.0, 0.0],
        ];
        let basis = Basis::from_span(&vectors);
        assert_eq!(basis.rank(), 2);
        let x = basis.solve(&[3.0, 5.0, 7.0], 3);
        let sum: Vec<f64> = (0..3)
            .map(|i| (0..3).map(|k| x[k] * vectors[k][i]).sum())
            .collect();
        assert!((sum[0] - 3.0).abs() < 1e-14 && (sum[1] - 5.0).abs() < 1e-14);
        let complement = basis.complement(3);
        assert_eq!(complement.len(), 1);
        assert!((complement[0][2].abs() - 1.0).abs() < 1e-15);
        assert_eq!(Basis::from_span(&[]).complement(2).len(), 2);
        assert_eq!(Basis::from_span(&[vec![0.0; 4]]).rank(), 0);
    }
}
