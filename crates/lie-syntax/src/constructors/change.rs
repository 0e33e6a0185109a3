//! Central extensions by a cocycle, and a change of basis by an exact matrix.

use std::collections::BTreeMap;

use super::frame::Frame;
use super::matrix::{Entries, add, add_multiple, commutator};
use super::{Constants, Matrices, NamedAlgebra};
use lie_symbolic::exact::Rational;

/// What a central extension adds: names of the new, central elements, and brackets with values among these.
#[derive(Clone, Debug, Default)]
pub struct Central {
    /// Names of the central elements.
    pub names: Vec<String>,
    /// The terms, by indices of the central elements, that are added to `[e_i, e_j]`, `i < j`.
    pub cocycle: Constants,
}

/// The extension of an algebra.
///
/// # Errors
/// Three elements for which the cocycle identity fails, with the residual
/// `S([a, b], c) + S([b, c], a) + S([c, a], b)`.
pub fn extended(
    named: NamedAlgebra,
    central: &Central,
) -> Result<NamedAlgebra, ([usize; 3], BTreeMap<usize, Rational>)> {
    let n = named.dimension();
    for i in 0..n {
        for j in i + 1..n {
            for k in j + 1..n {
                let mut residual = BTreeMap::new();
                for (a, b, c) in [(i, j, k), (j, k, i), (k, i, j)] {
                    for (l, factor) in named.bracket(a, b) {
                        let (pair, sign) = if l < c { ((l, c), 1) } else { ((c, l), -1) };
                        let factor = &factor * &Rational::from(sign);
                        let terms = central.cocycle.get(&pair).into_iter();
                        terms.for_each(|terms| add_multiple(&mut residual, terms, &factor));
                    }
                }
                if !residual.is_empty() {
                    return Err(([i, j, k], residual));
                }
            }
        }
    }
    let mut constants = named.constants;
    for (pair, terms) in &central.cocycle {
        let whole = constants.entry(*pair).or_default();
        for (k, value) in terms {
            add(whole, k + n, value);
        }
    }
    constants.retain(|_, terms| !terms.is_empty());
    Ok(NamedAlgebra {
        basis: named
            .basis
            .into_iter()
            .chain(central.names.clone())
            .collect(),
        state: Vec::new(),
        constants,
        representation: None,
    })
}

/// The algebra in a new basis `f_a = sum_i rows[a][i] e_i`; without names of coordinates.
///
/// `None` where the new elements are dependent, or not as many as before.
pub fn changed(
    named: &NamedAlgebra,
    names: Vec<String>,
    rows: &[BTreeMap<usize, Rational>],
) -> Option<NamedAlgebra> {
    let n = named.dimension();
    let vector = |row: &BTreeMap<usize, Rational>| -> Entries {
        row.iter()
            .map(|(k, value)| ((0, *k), value.clone()))
            .collect()
    };
    let frame = Frame::new(&rows.iter().map(vector).collect::<Vec<_>>())?;
    if rows.len() != n {
        return None;
    }
    let mut constants = Constants::new();
    for (a, left) in rows.iter().enumerate() {
        for (b, right) in rows.iter().enumerate().skip(a + 1) {
            let mut value = BTreeMap::new();
            for (i, x) in left {
                for (j, y) in right {
                    add_multiple(&mut value, &named.bracket(*i, *j), &(x * y));
                }
            }
            let terms = frame.coordinates(vector(&value))?;
            if !terms.is_empty() {
                constants.insert((a, b), terms);
            }
        }
    }
    let representation = named.representation.as_ref().map(|matrices| {
        let combined = |row: &BTreeMap<usize, Rational>| {
            let mut sum = Entries::new();
            row.iter()
                .for_each(|(k, value)| add_multiple(&mut sum, &matrices.entries[*k], value));
            sum
        };
        Matrices {
            size: matrices.size,
            entries: rows.iter().map(combined).collect(),
        }
    });
    Some(NamedAlgebra {
        basis: names,
        state: Vec::new(),
        constants,
        representation,
    })
}

impl NamedAlgebra {
    /// The first pair whose bracket matrices do not represent.
    pub fn not_represented(&self, matrices: &Matrices) -> Option<(usize, usize)> {
        let n = self.dimension();
        let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
        let fails = |&(i, j): &(usize, usize)| {
            let mut rest = commutator(&matrices.entries[i], &matrices.entries[j]);
            for (k, value) in self.bracket(i, j) {
                add_multiple(&mut rest, &matrices.entries[k], &-value);
            }
            !rest.is_empty()
        };
        pairs.into_iter().find(fails)
    }
}
