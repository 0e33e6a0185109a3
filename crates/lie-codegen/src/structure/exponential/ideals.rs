//! Ideals that share their coordinates, as the two factors of so(4) in the basis of planes.
//!
//! Matrices that commute with every `ad*_x` (the centroid) have invariant eigenspaces. One of them, with weights that are
//! all different, has the finest ones; where its eigenvalues are rational and belong to as many eigenvectors as they should,
//! the dual is the sum of the eigenspaces, and functions of `ad*_x` are the sums of those on each.

use super::operator::{Form, Operator};
use lie_symbolic::exact::matrix::reduce;
use lie_symbolic::exact::{Budget, Exhausted, Rational};

/// Larger components are left whole: the equations have the square of this many unknowns.
const LARGEST: usize = 8;
/// Eigenvalues are looked for among the fractions with numerators up to this.
const LARGEST_NUMERATOR: i64 = 48;
/// And these denominators.
const DENOMINATORS: [i64; 4] = [1, 2, 3, 4];

/// The operator on an ideal, `A P`, and the projection P.
pub(super) struct Ideal {
    pub operator: Operator,
    pub projection: Vec<(usize, usize, Rational)>,
}

type Matrix = Vec<Vec<Rational>>;

/// The ideals of a component, if there are several and everything is rational.
pub(super) fn ideals(
    operator: &Operator,
    budget: &Budget,
) -> Result<Option<Vec<Ideal>>, Exhausted> {
    let places = operator.coordinates();
    let size = places.len();
    if size > LARGEST {
        return Ok(None);
    }
    let Some(basis) = basis_matrices(operator, &places) else {
        return Ok(None);
    };
    let centroid = commuting(&basis, size, budget)?;
    if centroid.len() < 2 {
        return Ok(None);
    }
    let mut general = vec![vec![Rational::ZERO; size]; size];
    for (weight, matrix) in (1..).zip(&centroid) {
        for (row, from) in general.iter_mut().zip(matrix) {
            for (entry, value) in row.iter_mut().zip(from) {
                *entry = &*entry + &(value * &Rational::from(weight));
            }
        }
    }
    let Some(projections) = eigenprojections(&general, budget)? else {
        return Ok(None);
    };
    let ideals = projections.into_iter().map(|projection| {
        let mut sparse = Vec::new();
        for (j, row) in projection.iter().enumerate() {
            let row = row.iter().enumerate().filter(|(_, value)| !value.is_zero());
            sparse.extend(row.map(|(k, value)| (places[j], places[k], value.clone())));
        }
        Ok(Ideal {
            operator: composed(operator, &sparse, budget)?,
            projection: sparse,
        })
    });
    Ok(Some(ideals.collect::<Result<_, _>>()?))
}

/// `A P`
fn composed(
    operator: &Operator,
    projection: &[(usize, usize, Rational)],
    budget: &Budget,
) -> Result<Operator, Exhausted> {
    let mut sums = std::collections::BTreeMap::<(usize, usize), Form>::new();
    for (j, l, form) in &operator.entries {
        for (_, k, value) in projection.iter().filter(|(row, ..)| row == l) {
            let sum = sums.entry((*j, *k)).or_default();
            for (i, coefficient) in form {
                let term = coefficient.scale(value);
                match sum.iter_mut().find(|(known, _)| known == i) {
                    Some((_, known)) => *known = known.add(&term, budget)?,
                    None => sum.push((*i, term)),
                }
            }
        }
    }
    let entries = sums.into_iter().map(|((j, k), mut form)| {
        form.retain(|(_, value)| !value.is_zero());
        (j, k, form)
    });
    Ok(Operator {
        entries: entries.filter(|(.., form)| !form.is_empty()).collect(),
    })
}

/// The matrices `ad*_(e_i)`, without parameters.
fn basis_matrices(operator: &Operator, places: &[usize]) -> Option<Vec<Matrix>> {
    let size = places.len();
    let mut all = vec![vec![vec![Rational::ZERO; size]; size]; size];
    for (j, k, form) in &operator.entries {
        let place = |i: &usize| places.binary_search(i).ok();
        for (i, value) in form {
            all[place(i)?][place(j)?][place(k)?] = value.as_constant()?;
        }
    }
    Some(all)
}

/// A basis of the matrices that commute with all of these.
fn commuting(basis: &[Matrix], size: usize, budget: &Budget) -> Result<Vec<Matrix>, Exhausted> {
    // M B - B M = 0, unknown M by rows
    let mut equations = Vec::new();
    for matrix in basis {
        for i in 0..size {
            for j in 0..size {
                let mut equation = vec![Rational::ZERO; size * size];
                for l in 0..size {
                    let (right, left) = (&matrix[l][j], &matrix[i][l]);
                    equation[i * size + l] = &equation[i * size + l] + right;
                    equation[l * size + j] = &equation[l * size + j] - left;
                }
                if equation.iter().any(|entry| !entry.is_zero()) {
                    equations.push(equation);
                }
            }
        }
    }
    let pivots = reduce(&mut equations, budget)?;
    let free = (0..size * size).filter(|column| !pivots.contains(column));
    let solutions = free.map(|column| {
        let mut matrix = vec![vec![Rational::ZERO; size]; size];
        matrix[column / size][column % size] = Rational::ONE;
        for (row, pivot) in equations.iter().zip(&pivots) {
            matrix[pivot / size][pivot % size] = -&row[column];
        }
        matrix
    });
    Ok(solutions.collect())
}

/// The projections onto the eigenspaces of a matrix, where there are several and they span everything.
fn eigenprojections(matrix: &Matrix, budget: &Budget) -> Result<Option<Vec<Matrix>>, Exhausted> {
    let size = matrix.len();
    let shifted = |root: &Rational| {
        let mut shifted = matrix.clone();
        for (i, row) in shifted.iter_mut().enumerate() {
            row[i] = &row[i] - root;
        }
        shifted
    };
    let (mut roots, mut dimensions) = (Vec::new(), 0);
    for denominator in DENOMINATORS {
        for numerator in -LARGEST_NUMERATOR..=LARGEST_NUMERATOR {
            let root = Rational::new(numerator, denominator).unwrap_or(Rational::ZERO);
            if dimensions == size || roots.contains(&root) {
                continue;
            }
            let defect = size - lie_symbolic::exact::matrix::rank(&shifted(&root), size);
            if defect > 0 {
                dimensions += defect;
                roots.push(root);
            }
        }
    }
    if dimensions < size || roots.len() < 2 {
        return Ok(None);
    }
    let mut projections = Vec::new();
    for root in &roots {
        let mut projection = identity(size);
        for other in roots.iter().filter(|other| *other != root) {
            let weight = &Rational::ONE / &(root - other);
            projection = product(&projection, &shifted(other), &weight, budget)?;
        }
        projections.push(projection);
    }
    Ok(Some(projections))
}

fn identity(size: usize) -> Matrix {
    let entry = |i, j| {
        if i == j {
            Rational::ONE
        } else {
            Rational::ZERO
        }
    };
    (0..size)
        .map(|i| (0..size).map(|j| entry(i, j)).collect())
        .collect()
}

/// `weight A B`
fn product(
    a: &Matrix,
    b: &Matrix,
    weight: &Rational,
    budget: &Budget,
) -> Result<Matrix, Exhausted> {
    let size = a.len();
    let mut out = vec![vec![Rational::ZERO; size]; size];
    for (row, from) in out.iter_mut().zip(a) {
        for (value, other) in from.iter().zip(b).filter(|(value, _)| !value.is_zero()) {
            for (entry, factor) in row.iter_mut().zip(other) {
                let term = &(value * factor) * weight;
                budget.spend_on(&term)?;
                *entry = &*entry + &term;
            }
        }
    }
    Ok(out)
}
