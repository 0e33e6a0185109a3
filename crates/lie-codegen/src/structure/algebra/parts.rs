//! An algebra taken apart into ideals whose sum is direct.
//!
//! Linear maps that commute with every `ad_x` (the centroid) have generalized eigenspaces that are ideals, and the algebra
//! is their direct sum. Of a semisimple algebra the centroid is `B K`, K the Killing form and B the quadratic invariants of
//! its dual; of others it is found from its equations.

use super::roots::rational_roots;
use super::subspace::{Subspace, Vector};
use super::table::Table;
use crate::structure::casimirs;
use lie_symbolic::exact::{Budget, Exhausted, Fraction, Polynomial, Rational};

/// A linear map by its columns: the image of every basis element.
pub type Map = Vec<Vector>;

/// An abelian direct summand, split off: the rest and its dimension.
pub fn without_centre(table: &Table, budget: &Budget) -> Result<(Table, usize), Exhausted> {
    let n = table.dimension();
    let whole = table.as_subspace(budget)?;
    let derived = table.product(&whole, &whole, budget)?;
    let centre = table.centralizer(&whole, budget)?;
    let mut all = derived.clone();
    let mut count = 0;
    for vector in centre.basis() {
        count += usize::from(all.insert(vector.clone(), budget)?);
    }
    if count == 0 {
        return Ok((table.clone(), 0));
    }
    let mut rest = derived;
    for i in 0..n {
        if all.insert(table.unit(i), budget)? {
            rest.insert(table.unit(i), budget)?;
        }
    }
    Ok((table.subalgebra(&rest, budget)?, count))
}

/// The centroid of a semisimple algebra.
pub fn semisimple_centroid(table: &Table, budget: &Budget) -> Result<Vec<Map>, Exhausted> {
    let n = table.dimension();
    let killing = table.killing_form(budget)?;
    let constants = table.constants().map(|c| Fraction::from(c.clone()));
    let mut maps = Vec::new();
    for form in casimirs::invariants(&constants, 2, budget)? {
        let mut map = vec![vec![Rational::ZERO; n]; n];
        for (i, k, value) in entries(&form) {
            for (column, row) in map.iter_mut().zip(&killing) {
                if !row[k].is_zero() {
                    budget.spend(8)?;
                    column[i] = &column[i] + &(&value * &row[k]);
                }
            }
        }
        maps.push(map);
    }
    Ok(maps)
}

/// The entries of the symmetric matrix of a quadratic form.
fn entries(form: &Polynomial) -> Vec<(usize, usize, Rational)> {
    let half = Rational::new(1, 2).unwrap_or(Rational::ONE);
    let mut entries = Vec::new();
    for (monomial, c) in form.terms() {
        let powers: Vec<_> = monomial.powers().collect();
        match powers.as_slice() {
            [(i, 2)] => entries.push((*i, *i, c.clone())),
            [(i, 1), (j, 1)] => {
                entries.push((*i, *j, c * &half));
                entries.push((*j, *i, c * &half));
            }
            _ => {}
        }
    }
    entries
}

/// The centroid of any algebra, from `phi [e_i, e_j] = [phi e_i, e_j]`.
pub fn centroid(table: &Table, budget: &Budget) -> Result<Vec<Map>, Exhausted> {
    let n = table.dimension();
    let mut equations = Subspace::zero(n * n);
    // unknown phi_kl is number k n + l, phi e_l = sum_k phi_kl e_k
    for i in 0..n {
        for j in 0..n {
            let bracket = table.bracket(&table.unit(i), &table.unit(j), budget)?;
            let mut rows = vec![vec![Rational::ZERO; n * n]; n];
            for (l, c) in bracket.iter().enumerate().filter(|(_, c)| !c.is_zero()) {
                rows.iter_mut()
                    .enumerate()
                    .for_each(|(k, row)| row[k * n + l] = c.clone());
            }
            for m in 0..n {
                let image = table.bracket(&table.unit(m), &table.unit(j), budget)?;
                for (row, c) in rows.iter_mut().zip(&image).filter(|(_, c)| !c.is_zero()) {
                    row[m * n + i] = &row[m * n + i] - c;
                }
            }
            for row in rows
                .into_iter()
                .filter(|row| row.iter().any(|v| !v.is_zero()))
            {
                equations.insert(row, budget)?;
            }
        }
    }
    let map = |vector: Vector| {
        let column = |l: usize| (0..n).map(|k| vector[k * n + l].clone()).collect();
        (0..n).map(column).collect()
    };
    Ok(equations.annihilated().into_iter().map(map).collect())
}

/// The generalized eigenspaces of a general combination of commuting maps that belong to rational eigenvalues, and the
/// monic factor of the minimal polynomial without rational roots, with its space.
pub struct Eigenspaces {
    /// The spaces.
    pub rational: Vec<Subspace>,
    /// What is left.
    pub rest: Subspace,
    /// The combination.
    pub map: Map,
}

/// Takes the space apart by a general combination of maps.
pub fn eigenspaces(table: &Table, maps: &[Map], budget: &Budget) -> Result<Eigenspaces, Exhausted> {
    let n = table.dimension();
    let mut map = vec![vec![Rational::ZERO; n]; n];
    for (weight, other) in [1, 3, 7, 12, 20, 30, 44, 65, 80, 96]
        .into_iter()
        .cycle()
        .zip(maps)
    {
        for (column, from) in map.iter_mut().zip(other) {
            for (entry, value) in column.iter_mut().zip(from) {
                *entry = &*entry + &(value * &Rational::from(weight));
            }
        }
    }
    let mut roots: Vec<Rational> = Vec::new();
    for i in 0..n {
        let polynomial = minimal_polynomial(&map, table.unit(i), budget)?;
        roots.extend(rational_roots(&polynomial));
    }
    let mut distinct: Vec<Rational> = Vec::new();
    for root in roots {
        if !distinct.contains(&root) {
            distinct.push(root);
        }
    }
    let mut rational = Vec::new();
    let mut rest = table.as_subspace(budget)?;
    for root in distinct {
        let mut shifted = map.clone();
        for (i, column) in shifted.iter_mut().enumerate() {
            column[i] = &column[i] - &root;
        }
        // the kernel and the image of the n-th power
        let mut image = table.as_subspace(budget)?;
        let mut power: Map = (0..n).map(|i| table.unit(i)).collect();
        loop {
            let before = image.dimension();
            power = power
                .iter()
                .map(|v| applied(&shifted, v, budget))
                .collect::<Result<_, _>>()?;
            image = Subspace::span(n, power.iter().cloned(), budget)?;
            if image.dimension() == before {
                break;
            }
        }
        rational.push(kernel(&power, budget)?);
        rest = rest.intersection(&image, budget)?;
    }
    Ok(Eigenspaces {
        rational,
        rest,
        map,
    })
}

/// The rational eigenvalues of a map on an invariant subspace, each with a basis of its eigenvectors.
///
/// # Errors
/// [`Exhausted`] where the budget is too small.
pub fn eigenvalues(
    map: &[Vector],
    space: &Subspace,
    budget: &Budget,
) -> Result<Vec<(Rational, Vec<Vector>)>, Exhausted> {
    let map = map.to_vec();
    let mut values: Vec<Rational> = Vec::new();
    for vector in space.basis() {
        for root in rational_roots(&minimal_polynomial(&map, vector.clone(), budget)?) {
            if !values.contains(&root) {
                values.push(root);
            }
        }
    }
    let mut found = Vec::new();
    for value in values {
        let mut shifted = map.clone();
        for (i, column) in shifted.iter_mut().enumerate() {
            column[i] = &column[i] - &value;
        }
        let eigenspace = kernel(&shifted, budget)?.intersection(space, budget)?;
        found.push((value, eigenspace.basis().to_vec()));
    }
    Ok(found)
}

/// The kernel of a map.
fn kernel(map: &Map, budget: &Budget) -> Result<Subspace, Exhausted> {
    let n = map.len();
    let rows = (0..n).map(|k| map.iter().map(|column| column[k].clone()).collect());
    let equations = Subspace::span(n, rows, budget)?;
    Subspace::span(n, equations.annihilated(), budget)
}

/// The image of a vector.
pub fn applied(map: &Map, vector: &Vector, budget: &Budget) -> Result<Vector, Exhausted> {
    let mut image = vec![Rational::ZERO; vector.len()];
    for (column, factor) in map.iter().zip(vector).filter(|(_, f)| !f.is_zero()) {
        for (entry, value) in image.iter_mut().zip(column).filter(|(_, v)| !v.is_zero()) {
            let product = factor * value;
            budget.spend_on(&product)?;
            *entry = &*entry + &product;
        }
    }
    Ok(image)
}

/// The polynomial p of least degree with `p(map) v = 0`, coefficients from the constant one on.
pub fn minimal_polynomial(
    map: &Map,
    vector: Vector,
    budget: &Budget,
) -> Result<Vec<Rational>, Exhausted> {
    let n = vector.len();
    // rows [map^k v | e_k]: one whose first part vanishes is the relation
    let width = 2 * n + 1;
    let mut space = Subspace::zero(width);
    let mut power = vector;
    for k in 0..=n {
        let mut row = power.clone();
        row.resize(width, Rational::ZERO);
        row[n + k] = Rational::ONE;
        let row = space.reduced(row, budget)?;
        if row[..n].iter().all(Rational::is_zero) {
            return Ok(row[n..=n + k].to_vec());
        }
        space.insert(row, budget)?;
        power = applied(map, &power, budget)?;
    }
    Ok(Vec::new())
}
