//! Direct sums of algebras so(3) in bases with `[e_i, e_j] = c e_k` and its cyclic permutations.

use super::Structure;
use crate::model::Model;
use lie_symbolic::exact::Budget;
use lie_symbolic::symbolic::ExprId;

/// Work allowed to compare the constants.
const WORK: u64 = 100_000;

/// A summand so(3).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Spin {
    /// Its coordinates, ascending.
    pub coordinates: [usize; 3],
    /// The constant c.
    pub scale: ExprId,
}

/// The summands in the order of their coordinates; `None` where the declared algebra is no such sum. Coordinates that carry the time or
/// are held may be beside them.
pub fn spins(model: &Model) -> Option<Vec<Spin>> {
    let n = match &model.configuration {
        _ if model.family.is_some() => model.dimension(),
        Some(configuration) if configuration.group.is_some() || configuration.idle => return None,
        Some(configuration) => configuration.own_momenta(),
        None => model.dimension(),
    };
    if n == 0 || !n.is_multiple_of(3) {
        return None;
    }
    let budget = Budget::new(WORK);
    let algebra = model.bracket.algebra()?;
    let entries = algebra.exact.entries();
    let expressions = algebra.constants.entries();
    if entries.len() != expressions.len() {
        return None;
    }
    let both = entries.iter().zip(expressions);
    let both: Vec<_> = both.filter(|((i, ..), _)| *i < n).collect();
    if both.len() != n || both.iter().any(|((_, j, k, _), _)| *j.max(k) >= n) {
        return None;
    }
    let mut spins = Vec::new();
    for (entry, expression) in both {
        let &(i, j, k, ref c) = entry;
        if j > k || i > j {
            continue;
        }
        // i < j < k: [e_i, e_j] = c e_k, [e_j, e_k] = c e_i, [e_i, e_k] = -c e_j
        let find = |a: usize, b: usize, to: usize| match algebra.exact.upper(a, b) {
            [(_, _, found, value)] if *found == to => Some(value),
            _ => None,
        };
        let alone = algebra.exact.upper(i, j).len() == 1;
        let (second, third) = (find(j, k, i)?, find(i, k, j)?);
        if !alone || !c.equals(second, &budget).ok()? || !c.neg().equals(third, &budget).ok()? {
            return None;
        }
        spins.push(Spin {
            coordinates: [i, j, k],
            scale: expression.3,
        });
    }
    let mut covered: Vec<usize> = spins.iter().flat_map(|spin| spin.coordinates).collect();
    covered.sort_unstable();
    (covered == (0..n).collect::<Vec<_>>()).then_some(spins)
}

/// Why a method for spins does not apply, with the nearest one that does: the spherical midpoint rule, or a method over the Hopf map of
/// some order.
pub fn refusal(structure: &Structure, hopf: Option<u32>) -> Option<(String, String)> {
    let found = match hopf {
        Some(_) => structure.spins.is_some(),
        None => structure.spheres().is_some(),
    };
    if found {
        return None;
    }
    let reason = structure.why_not_declared_algebra().unwrap_or_else(|| {
        "it needs so(3), or a direct sum of algebras so(3), in a basis with [e1, e2] = c e3 and its \
         cyclic permutations"
            .into()
    });
    let remedy = match hopf {
        Some(order) if order <= 6 && super::matrices::refusal(structure, order).is_none() => {
            format!("use `collective{order}` with `--lift representation`")
        }
        Some(order) if order >= 8 => super::lifts::nearest(structure, order),
        Some(order) if order > 2 => {
            format!("use `compose{order}(lie-midpoint)`, which works for every Lie algebra")
        }
        _ => "use `lie-midpoint`, which works for every Lie algebra".into(),
    };
    Some((reason, remedy))
}
