//! The name of an algebra, in whatever basis it is given.
//!
//! Every name is proven: by the classification of the algebras of dimension up to three (Bianchi), by that of real simple algebras,
//! by a decomposition into ideals, or by the Levi decomposition with an abelian radical, which splits, so that the algebra is determined by
//! how its semisimple quotient acts there. What is not proven has no name, and is described.

use super::extensions::extension;
use super::parts::{self, Map};
use super::series;
use super::simple;
use super::subspace::{Subspace, Vector, signature};
use super::table::Table;
use lie_symbolic::exact::{Budget, Exhausted, Rational};

/// Larger algebras that are not semisimple are not taken apart.
const LARGEST: usize = 9;

/// The name of an algebra; `None` where it has none that can be proven.
pub fn name(table: &Table, budget: &Budget) -> Result<Option<String>, Exhausted> {
    let (mut names, mut centre) = (Vec::new(), 0);
    for (block, count) in table.blocks() {
        let (rest, abelian) = parts::without_centre(&block, budget)?;
        centre += count * abelian;
        if rest.dimension() > 0 {
            match summands(&rest, budget)? {
                Some(found) => (0..count).for_each(|_| names.extend(found.iter().cloned())),
                None => return Ok(None),
            }
        }
    }
    names.sort();
    Ok(Some(sum(&names, centre)))
}

/// A direct sum of named algebras and an abelian one, in short.
fn sum(names: &[String], centre: usize) -> String {
    let mut terms: Vec<String> = Vec::new();
    match names {
        [a, b] if a == b && a == "so(3)" => terms.push("so(4)".into()),
        [a, b] if a == b && a == "sl(2,R)" => terms.push("so(2,2)".into()),
        _ => {
            for group in names.chunk_by(|a, b| a == b) {
                terms.push(match group.len() {
                    1 => group[0].clone(),
                    count => format!("{}^{count}", group[0]),
                });
            }
        }
    }
    match centre {
        0 => {}
        1 => terms.push("R".into()),
        _ => terms.push(format!("R^{centre}")),
    }
    terms.join(" + ")
}

/// The names of ideals whose direct sum it is, of an algebra without an abelian summand.
fn summands(table: &Table, budget: &Budget) -> Result<Option<Vec<String>>, Exhausted> {
    if table.killing_signature(budget)?.zero == 0 {
        return semisimple(table, budget);
    }
    if let Some(name) = indecomposable(table, budget)? {
        return Ok(Some(vec![name]));
    }
    if table.dimension() > LARGEST {
        return Ok(None);
    }
    let centroid = parts::centroid(table, budget)?;
    let spaces = parts::eigenspaces(table, &centroid, budget)?;
    if spaces.rational.len() < 2 || spaces.rest.dimension() > 0 {
        return Ok(None);
    }
    let mut names = Vec::new();
    for ideal in &spaces.rational {
        let part = table.subalgebra(ideal, budget)?;
        match name(&part, budget)? {
            Some(name) => names.push(name),
            None => return Ok(None),
        }
    }
    Ok(Some(names))
}

/// The simple ideals of a semisimple algebra.
fn semisimple(table: &Table, budget: &Budget) -> Result<Option<Vec<String>>, Exhausted> {
    let n = table.dimension();
    let centroid = parts::semisimple_centroid(table, budget)?;
    if centroid.len() == 1 {
        let positive = table.killing_signature(budget)?.positive;
        let possible = match simple::ambiguous(n) {
            Some(rank) => series::possible(table, rank, budget)?,
            None => Vec::new(),
        };
        return Ok(simple::real_form(n, positive, &possible).map(|name| vec![name]));
    }
    let spaces = parts::eigenspaces(table, &centroid, budget)?;
    let mut names = Vec::new();
    for ideal in &spaces.rational {
        if ideal.dimension() == n {
            return Ok(None);
        }
        match semisimple(&table.subalgebra(ideal, budget)?, budget)? {
            Some(found) => names.extend(found),
            None => return Ok(None),
        }
    }
    if spaces.rest.dimension() > 0 {
        if centroid.len() != spaces.rational.len() + 2 {
            return Ok(None);
        }
        match conjugate(table, &spaces.rest, &spaces.map, budget)? {
            Some(found) => names.extend(found),
            None => return Ok(None),
        }
    }
    Ok(Some(names))
}

/// An ideal on which the centroid is a quadratic field: a complex algebra where the field is, and else two conjugate ideals.
fn conjugate(
    table: &Table,
    ideal: &Subspace,
    map: &Map,
    budget: &Budget,
) -> Result<Option<Vec<String>>, Exhausted> {
    let Some(vector) = ideal.basis().first() else {
        return Ok(None);
    };
    let polynomial = parts::minimal_polynomial(map, vector.clone(), budget)?;
    let [c, b, a] = polynomial.as_slice() else {
        return Ok(None);
    };
    let discriminant = &(b * b) - &(&(a * c) * &Rational::from(4));
    let dimension = ideal.dimension();
    if discriminant.is_negative() {
        return Ok(simple::complex(dimension).map(|name| vec![name.to_owned()]));
    }
    let part = table.subalgebra(ideal, budget)?;
    let positive = part.killing_signature(budget)?.positive;
    // two of dimension three: the sum of their squares says which
    let pair = match (dimension, positive) {
        (6, 0) => ["so(3)", "so(3)"],
        (6, 2) => ["sl(2,R)", "so(3)"],
        (6, 4) => ["sl(2,R)", "sl(2,R)"],
        _ => return Ok(None),
    };
    Ok(Some(pair.map(str::to_owned).to_vec()))
}

/// The name of an algebra that is known as a whole.
fn indecomposable(table: &Table, budget: &Budget) -> Result<Option<String>, Exhausted> {
    let n = table.dimension();
    let whole = table.as_subspace(budget)?;
    let derived = table.product(&whole, &whole, budget)?;
    if n == 2 {
        return Ok((derived.dimension() == 1).then(|| "aff(1)".to_owned()));
    }
    let centre = table.centralizer(&whole, budget)?;
    if derived.dimension() == 1 && centre == derived {
        return Ok(Some(format!("heisenberg({})", (n - 1) / 2)));
    }
    if n == 3 && derived.dimension() == 2 {
        return bianchi(table, &derived, budget).map(Some);
    }
    let radical = table.radical(&derived, budget)?;
    if radical.dimension() < n && table.subalgebra(&radical, budget)?.is_abelian() {
        return semidirect(table, &radical, budget);
    }
    extension(table, (&derived, &radical), budget)
}

/// The solvable algebras of dimension three with a derived algebra of dimension two, by trace and determinant of the third
/// basis element on it (Bianchi's types IV to VII).
fn bianchi(table: &Table, derived: &Subspace, budget: &Budget) -> Result<String, Exhausted> {
    let outside = derived.complement_places();
    let action = table.action(&table.unit(outside[0]), derived, budget)?;
    let [[a, b], [c, d]] = [
        [&action[0][0], &action[0][1]],
        [&action[1][0], &action[1][1]],
    ];
    let trace = a + d;
    let determinant = &(a * d) - &(b * c);
    let discriminant = &(&trace * &trace) - &(&determinant * &Rational::from(4));
    if trace.is_zero() {
        return Ok(if determinant.is_negative() {
            "bianchi(VI, 0)"
        } else {
            "se(2)"
        }
        .into());
    }
    if discriminant.is_zero() {
        let scalar = b.is_zero() && c.is_zero();
        return Ok(if scalar { "bianchi(V)" } else { "bianchi(IV)" }.into());
    }
    let h = -&(&(&trace * &trace) / &discriminant);
    let kind = if discriminant.is_negative() {
        "VII"
    } else {
        "VI"
    };
    Ok(format!("bianchi({kind}, {h})"))
}

/// A semisimple algebra with an abelian radical V: matrices s on V, which are the whole of so(V), of sl(V), or copies of the
/// vector representation of so(3).
fn semidirect(
    table: &Table,
    radical: &Subspace,
    budget: &Budget,
) -> Result<Option<String>, Exhausted> {
    let size = radical.dimension();
    let outside = radical.complement_places();
    let dimension = outside.len();
    // faithful: only V commutes with V
    if table.centralizer(radical, budget)?.dimension() > size {
        return Ok(None);
    }
    let matrices = outside
        .iter()
        .map(|&i| table.action(&table.unit(i), radical, budget));
    let matrices: Vec<Vec<Vector>> = matrices.collect::<Result<_, _>>()?;
    if size >= 3
        && dimension == size * (size - 1) / 2
        && let [form] = invariant_forms(&matrices, size, budget)?.as_slice()
    {
        let found = signature(form.clone(), budget)?;
        let (p, q) = (
            found.positive.max(found.negative),
            found.positive.min(found.negative),
        );
        return Ok((found.zero == 0).then(|| match q {
            0 => format!("se({p})"),
            1 => format!("poincare({p})"),
            _ => format!("semidirect(so({p},{q}), R^{})", p + q),
        }));
    }
    if size >= 2 && dimension == size * size - 1 {
        return Ok(Some(format!("semidirect(sl({size},R), R^{size})")));
    }
    let quotient = table.quotient(radical, budget)?;
    if dimension == 3
        && size.is_multiple_of(3)
        && quotient.killing_signature(budget)?.negative == 3
        && is_vectorial(&quotient, &matrices, budget)?
    {
        let vectors = ", R^3".repeat(size / 3);
        return Ok(Some(format!("semidirect(so(3){vectors})")));
    }
    Ok(None)
}

/// The symmetric B with `A^T B + B A = 0` for all of the matrices.
pub(super) fn invariant_forms(
    matrices: &[Vec<Vector>],
    size: usize,
    budget: &Budget,
) -> Result<Vec<Vec<Vector>>, Exhausted> {
    let place = |i: usize, j: usize| {
        let (i, j) = (i.min(j), i.max(j));
        j * (j + 1) / 2 + i
    };
    let count = size * (size + 1) / 2;
    let mut equations = Subspace::zero(count);
    for a in matrices {
        for i in 0..size {
            for j in i..size {
                let mut row = vec![Rational::ZERO; count];
                for k in 0..size {
                    row[place(k, j)] = &row[place(k, j)] + &a[k][i];
                    row[place(i, k)] = &row[place(i, k)] + &a[k][j];
                }
                equations.insert(row, budget)?;
            }
        }
    }
    let form = |vector: Vector| {
        let row = |i: usize| (0..size).map(|j| vector[place(i, j)].clone()).collect();
        (0..size).map(row).collect()
    };
    Ok(equations.annihilated().into_iter().map(form).collect())
}

/// Whether the Casimir element of the Killing form of so(3) acts as one: on spin j it is j (j + 1)/2, and one for vectors
/// alone.
fn is_vectorial(so3: &Table, matrices: &[Vec<Vector>], budget: &Budget) -> Result<bool, Exhausted> {
    let size = matrices[0].len();
    let inverse = inverse(so3.killing_form(budget)?, budget)?;
    let mut sum = vec![vec![Rational::ZERO; size]; size];
    for (a, row) in matrices.iter().zip(&inverse) {
        for (b, weight) in matrices.iter().zip(row).filter(|(_, w)| !w.is_zero()) {
            for (i, line) in sum.iter_mut().enumerate() {
                for k in (0..size).filter(|&k| !a[i][k].is_zero()) {
                    let factor = weight * &a[i][k];
                    budget.spend(size as u64)?;
                    for (entry, value) in line.iter_mut().zip(&b[k]) {
                        *entry = &*entry + &(&factor * value);
                    }
                }
            }
        }
    }
    let one = |i: usize, j: usize| Rational::from(i64::from(i == j));
    Ok((0..size).all(|i| (0..size).all(|j| sum[i][j] == one(i, j))))
}

/// The inverse of a matrix that has one.
fn inverse(matrix: Vec<Vector>, budget: &Budget) -> Result<Vec<Vector>, Exhausted> {
    let n = matrix.len();
    let rows = matrix.into_iter().enumerate().map(|(i, mut row)| {
        row.extend((0..n).map(|j| Rational::from(i64::from(i == j))));
        row
    });
    let space = Subspace::span(2 * n, rows, budget)?;
    Ok(space.basis().iter().map(|row| row[n..].to_vec()).collect())
}

/// What is said of an algebra without a name.
pub fn description(table: &Table, budget: &Budget) -> Result<String, Exhausted> {
    let n = table.dimension();
    let whole = table.as_subspace(budget)?;
    let derived = table.product(&whole, &whole, budget)?;
    let radical = table.radical(&derived, budget)?;
    let (class, _) = super::class::class(&table.subalgebra(&radical, budget)?, budget)?;
    let kind = match (class.abelian, class.nilpotent) {
        (true, _) => "abelian",
        (_, true) => "nilpotent",
        _ => "solvable",
    };
    if radical.dimension() == n {
        return Ok(format!("dim {n}, {kind}"));
    }
    let levi = table.quotient(&radical, budget)?;
    let levi = match name(&levi, budget)? {
        Some(name) => name,
        None => format!("of dimension {}", levi.dimension()),
    };
    match radical.dimension() {
        0 => Ok(format!("dim {n}, semisimple")),
        dimension => Ok(format!(
            "dim {n}, Levi factor {levi}, radical {kind} of dimension {dimension}"
        )),
    }
}
