//! Gaussian elimination of a sparse matrix in a fixed order, with its fill-in known beforehand.

use std::collections::{BTreeMap, BTreeSet};

use lie_symbolic::schedule::Counts;

/// One step of the factorisation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Step {
    /// `a_kk <- 1/a_kk`
    Pivot(usize),
    /// `a_ik <- a_ik a_kk` (the inverse pivot)
    Multiplier(usize, usize),
    /// `a_ij <- a_ij - a_ik a_kj`
    Update(usize, usize, usize),
}

/// The elimination of a pattern.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Elimination {
    /// Order of the pivots.
    pub order: Vec<usize>,
    /// The steps of the factorisation.
    pub steps: Vec<Step>,
    /// Entries that are zero before and not after.
    pub fill: Vec<(usize, usize)>,
    /// All entries of the factors, by row.
    pub rows: BTreeMap<usize, BTreeSet<usize>>,
    /// Pivots that are one, and stay it.
    pub unit: BTreeSet<usize>,
}

/// More multiplications than this are run from a table instead of being written out.
pub const UNROLLED: usize = 300;

impl Elimination {
    /// Multiplications of a full matrix, about.
    pub fn multiplications_of_full(size: usize) -> usize {
        size * size * size / 3 + size * size
    }

    /// Whether it is written out.
    pub fn is_unrolled(&self) -> bool {
        self.multiplications() <= UNROLLED
    }

    /// The elimination of an n x n pattern whose diagonal is full; `unit` lists the rows whose
    /// diagonal entry is one. The pivot that makes the least fill-in comes first (Markowitz 1957).
    pub fn new(n: usize, pattern: &[(usize, usize)], unit: &BTreeSet<usize>) -> Self {
        let mut rows: BTreeMap<usize, BTreeSet<usize>> =
            (0..n).map(|i| (i, BTreeSet::from([i]))).collect();
        for &(i, j) in pattern {
            rows.entry(i).or_default().insert(j);
        }
        let mut result = Self {
            unit: unit.clone(),
            ..Self::default()
        };
        let mut active: BTreeSet<usize> = (0..n).collect();
        while let Some(pivot) = cheapest(&rows, &active) {
            active.remove(&pivot);
            result.order.push(pivot);
            if !result.unit.contains(&pivot) {
                result.steps.push(Step::Pivot(pivot));
            }
            let across: Vec<usize> = rows[&pivot]
                .iter()
                .copied()
                .filter(|j| active.contains(j))
                .collect();
            for &row in &active {
                if !rows[&row].contains(&pivot) {
                    continue;
                }
                if !result.unit.contains(&pivot) {
                    result.steps.push(Step::Multiplier(row, pivot));
                }
                for &column in &across {
                    result.steps.push(Step::Update(row, pivot, column));
                    if column == row {
                        result.unit.remove(&row);
                    }
                    if rows
                        .get_mut(&row)
                        .is_some_and(|entries| entries.insert(column))
                    {
                        result.fill.push((row, column));
                    }
                }
            }
        }
        result.rows = rows;
        result
    }

    /// Entries of row `i` left (multipliers) and right of the pivot, in elimination order.
    pub fn split(&self, i: usize) -> (Vec<usize>, Vec<usize>) {
        let place = self.places();
        let mut entries: Vec<usize> = self.rows[&i].iter().copied().filter(|j| *j != i).collect();
        entries.sort_by_key(|j| place[j]);
        entries.into_iter().partition(|j| place[j] < place[&i])
    }

    /// Operations of factorisation and solution together.
    pub fn counts(&self) -> Counts {
        let updates = self
            .steps
            .iter()
            .filter(|s| matches!(s, Step::Update(..)))
            .count();
        let pivots = self
            .steps
            .iter()
            .filter(|s| matches!(s, Step::Pivot(_)))
            .count();
        let solve: usize = self.rows.values().map(|row| row.len() - 1).sum();
        Counts {
            add: updates + solve,
            mul: self.multiplications(),
            div: pivots,
            call: 0,
        }
    }

    /// Multiplications of factorisation and solution together.
    pub fn multiplications(&self) -> usize {
        let solve: usize = self.rows.values().map(|row| row.len() - 1).sum();
        let scaling = self.order.len() - self.unit.len();
        self.steps
            .iter()
            .filter(|s| !matches!(s, Step::Pivot(_)))
            .count()
            + solve
            + scaling
    }

    /// The pivots that do something, in order: a row of the identity that no other row has an entry of stays what it is, and
    /// nothing is written there.
    pub fn acting(&self) -> impl DoubleEndedIterator<Item = usize> {
        let alone = |index: usize| {
            let in_its_column = |(row, entries): (&usize, &BTreeSet<usize>)| {
                *row == index || !entries.contains(&index)
            };
            self.unit.contains(&index)
                && self.rows[&index].len() == 1
                && self.rows.iter().all(in_its_column)
        };
        self.order
            .iter()
            .copied()
            .filter(move |index| !alone(*index))
    }

    /// The place of each pivot in the order.
    pub fn places(&self) -> BTreeMap<usize, usize> {
        let order = self.order.iter().enumerate();
        order.map(|(place, pivot)| (*pivot, place)).collect()
    }
}

fn cheapest(rows: &BTreeMap<usize, BTreeSet<usize>>, active: &BTreeSet<usize>) -> Option<usize> {
    active.iter().copied().min_by_key(|&k| {
        let across = rows[&k].iter().filter(|j| active.contains(j)).count() - 1;
        let down = active
            .iter()
            .filter(|i| **i != k && rows[i].contains(&k))
            .count();
        (across * down, down, k)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Runs the steps on numbers and solves; a wrong order, a missing fill-in or sign fails.
    fn solve(elimination: &Elimination, matrix: &[Vec<f64>], right: &[f64]) -> Vec<f64> {
        let mut a = matrix.to_vec();
        for step in &elimination.steps {
            match *step {
                Step::Pivot(k) => a[k][k] = 1.0 / a[k][k],
                Step::Multiplier(i, k) => a[i][k] *= a[k][k],
                Step::Update(i, k, j) => a[i][j] -= a[i][k] * a[k][j],
            }
        }
        let mut b = right.to_vec();
        for &i in &elimination.order {
            b[i] -= elimination
                .split(i)
                .0
                .iter()
                .map(|&k| a[i][k] * b[k])
                .sum::<f64>();
        }
        for &i in elimination.order.iter().rev() {
            b[i] -= elimination
                .split(i)
                .1
                .iter()
                .map(|&j| a[i][j] * b[j])
                .sum::<f64>();
            b[i] *= a[i][i];
        }
        b
    }

    #[test]
    fn sparse_systems_are_solved_without_zero_arithmetic() {
        let n = 6;
        let mut state = 7u64;
        let mut next = move || {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (state >> 40) as f64 / (1 << 24) as f64
        };
        for _ in 0..50 {
            let mut matrix = vec![vec![0.0; n]; n];
            let mut pattern = Vec::new();
            let mut unit = BTreeSet::new();
            for (i, row) in matrix.iter_mut().enumerate() {
                row[i] = 1.0;
                if next() < 0.4 {
                    unit.insert(i);
                } else {
                    row[i] += 0.2 * next();
                }
                for (j, entry) in row.iter_mut().enumerate() {
                    if i != j && next() < 0.3 {
                        *entry = 0.3 * next() - 0.1;
                        pattern.push((i, j));
                    }
                }
            }
            let right: Vec<f64> = (0..n).map(|_| next()).collect();
            let elimination = Elimination::new(n, &pattern, &unit);
            let x = solve(&elimination, &matrix, &right);
            for (row, right) in matrix.iter().zip(&right) {
                let product: f64 = row.iter().zip(&x).map(|(a, x)| a * x).sum();
                assert!((product - right).abs() < 1e-12, "{product} {right}");
            }
            assert!(
                elimination
                    .fill
                    .iter()
                    .all(|place| !pattern.contains(place))
            );
        }
        assert_eq!(
            Elimination::new(3, &[], &BTreeSet::from([0, 1, 2])).multiplications(),
            0
        );
    }

    /// A row of the identity that is alone has no part in an elimination; one in whose column another row has an entry does.
    #[test]
    fn rows_that_are_alone_do_nothing() {
        let unit = BTreeSet::from([0, 1]);
        let elimination = Elimination::new(4, &[(2, 1), (2, 3), (3, 2)], &unit);
        let mut acting: Vec<usize> = elimination.acting().collect();
        acting.sort_unstable();
        assert_eq!(acting, [1, 2, 3]);
    }

    /// A full matrix costs what Gauss's elimination does.
    #[test]
    fn operations_of_a_full_matrix() {
        for n in 1..7 {
            let all = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
            let pattern: Vec<(usize, usize)> = all.filter(|(i, j)| i != j).collect();
            let counts = Elimination::new(n, &pattern, &BTreeSet::new()).counts();
            let updates = n * (n - 1) * (2 * n - 1) / 6 + n * (n - 1);
            assert_eq!((counts.add, counts.div, counts.call), (updates, n, 0));
            assert_eq!(counts.mul, updates + n * (n - 1) / 2 + n);
        }
    }
}
