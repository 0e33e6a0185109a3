//! Names of algebras whose radical is not abelian: affine, Galilei and oscillator algebras.

use super::name::{invariant_forms, name};
use super::subspace::{Subspace, Vector, signature};
use super::table::Table;
use lie_symbolic::exact::{Budget, Exhausted, Rational};

/// The name of an algebra with this derived algebra and this radical.
pub fn extension(
    table: &Table,
    (derived, radical): (&Subspace, &Subspace),
    budget: &Budget,
) -> Result<Option<String>, Exhausted> {
    if let Some(name) = affine(table, radical, budget)? {
        return Ok(Some(name));
    }
    if let Some(name) = galilei(table, radical, budget)? {
        return Ok(Some(name));
    }
    oscillator(table, derived, budget)
}

/// `aff(k)`: matrices on an abelian ideal N of dimension k, all of gl(N), so that one acts as the identity and the extension
/// splits (its cohomology with values in N vanishes).
fn affine(table: &Table, radical: &Subspace, budget: &Budget) -> Result<Option<String>, Exhausted> {
    let ideal = table.product(radical, radical, budget)?;
    let k = ideal.dimension();
    let dimensions = k >= 2 && radical.dimension() == k + 1 && table.dimension() == k * k + k;
    // faithful, and N abelian
    let holds = dimensions && table.centralizer(&ideal, budget)? == ideal;
    Ok(holds.then(|| format!("aff({k})")))
}

/// `galilei(k)`, k at least 3: rotations, of which the radical modulo `N = [g, radical]` has none, on an abelian N of two vectors
/// that the rest of the radical takes to its second one.
///
/// A Levi factor s acts on N as on V + V, and the radical is N and a line h on which s does nothing. What h does on N
/// commutes with s, which leaves a matrix with two rows, here nilpotent.
fn galilei(
    table: &Table,
    radical: &Subspace,
    budget: &Budget,
) -> Result<Option<String>, Exhausted> {
    let n = table.dimension();
    if radical.dimension().is_multiple_of(2) || radical.dimension() < 7 {
        return Ok(None);
    }
    let k = (radical.dimension() - 1) / 2;
    if n != radical.dimension() + k * (k - 1) / 2 {
        return Ok(None);
    }
    let whole = table.as_subspace(budget)?;
    let vectors = table.product(&whole, radical, budget)?;
    if vectors.dimension() != 2 * k || table.product(&vectors, &vectors, budget)?.dimension() > 0 {
        return Ok(None);
    }
    let second = table.product(radical, &vectors, budget)?;
    if second.dimension() != k || table.product(radical, &second, budget)?.dimension() > 0 {
        return Ok(None);
    }
    if name(&table.quotient(radical, budget)?, budget)? != Some(format!("so({k})")) {
        return Ok(None);
    }
    // the radical does nothing on the second vectors, so any elements beside it do what s does
    let matrices = radical.complement_places().into_iter();
    let matrices = matrices.map(|i| table.action(&table.unit(i), &second, budget));
    let matrices: Vec<Vec<Vector>> = matrices.collect::<Result<_, _>>()?;
    let flat = matrices.iter().map(|m| m.concat());
    if Subspace::span(k * k, flat, budget)?.dimension() < matrices.len() {
        return Ok(None);
    }
    let [form] = &mut invariant_forms(&matrices, k, budget)?[..] else {
        return Ok(None);
    };
    let found = signature(std::mem::take(form), budget)?;
    let definite = found.positive == k || found.negative == k;
    Ok(definite.then(|| format!("galilei({k})")))
}

/// `oscillator(k)`: one more element on `heisenberg(k)`, whose centre Z it does not move, and on the rest of which it is a multiple M
/// of a complex structure with `omega(x, M x)` definite, omega the bracket with values in Z.
///
/// Whatever else it does takes the rest to Z, and an element of the Heisenberg algebra does that too.
fn oscillator(
    table: &Table,
    derived: &Subspace,
    budget: &Budget,
) -> Result<Option<String>, Exhausted> {
    let n = table.dimension();
    if n < 4 || n % 2 == 1 || derived.dimension() + 1 != n {
        return Ok(None);
    }
    let centre = table.centralizer(&table.as_subspace(budget)?, budget)?;
    if centre.dimension() != 1 || table.product(derived, derived, budget)? != centre {
        return Ok(None);
    }
    let places = centre.complement_places();
    let quotient = table.quotient(&centre, budget)?;
    let mut rest = Subspace::zero(n - 1);
    for vector in derived.basis() {
        let vector = centre.reduced(vector.clone(), budget)?;
        rest.insert(places.iter().map(|&p| vector[p].clone()).collect(), budget)?;
    }
    let [outside] = rest.complement_places()[..] else {
        return Ok(None);
    };
    let m = quotient.action(&quotient.unit(outside), &rest, budget)?;
    if !is_complex_structure(&product(&m, &m, budget)?) {
        return Ok(None);
    }
    let lifted = rest.basis().iter().map(|vector| {
        let mut lift = vec![Rational::ZERO; n];
        for (&place, value) in places.iter().zip(vector) {
            lift[place] = value.clone();
        }
        lift
    });
    let lifted: Vec<Vector> = lifted.collect();
    let pivot = centre.pivots()[0];
    let mut omega = Vec::new();
    for x in &lifted {
        let brackets = lifted.iter().map(|y| table.bracket(x, y, budget));
        let brackets: Vec<Vector> = brackets.collect::<Result<_, _>>()?;
        omega.push(brackets.iter().map(|value| value[pivot].clone()).collect());
    }
    let size = rest.dimension();
    let found = signature(product(&omega, &m, budget)?, budget)?;
    let definite = found.positive == size || found.negative == size;
    Ok(definite.then(|| format!("oscillator({})", size / 2)))
}

/// Whether the square of a matrix is a negative multiple of the identity.
fn is_complex_structure(square: &[Vector]) -> bool {
    let scalar = &square[0][0];
    let entry = |i: usize, j: usize| match i == j {
        true => square[i][j] == *scalar,
        false => square[i][j].is_zero(),
    };
    let n = square.len();
    scalar.is_negative() && (0..n).all(|i| (0..n).all(|j| entry(i, j)))
}

/// The product of two square matrices.
fn product(a: &[Vector], b: &[Vector], budget: &Budget) -> Result<Vec<Vector>, Exhausted> {
    let size = a.len();
    let mut product = vec![vec![Rational::ZERO; size]; size];
    for (row, of_a) in product.iter_mut().zip(a) {
        for (x, of_b) in of_a.iter().zip(b).filter(|(x, _)| !x.is_zero()) {
            for (entry, y) in row.iter_mut().zip(of_b) {
                let term = x * y;
                budget.spend_on(&term)?;
                *entry = &*entry + &term;
            }
        }
    }
    Ok(product)
}
