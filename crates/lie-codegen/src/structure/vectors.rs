//! so(3) with vectors: a basis `J_1, J_2, J_3` and triples `V_1, V_2, V_3` that commute, with `[J_1, J_2] = c J_3`,
//! `[J_1, V_2] = c V_3` and its cyclic permutations. Each `V_j` is a multiple of a basis element.

use super::Structure;
use crate::algebra::StructureConstants;
use crate::model::Model;
use lie_symbolic::exact::{Budget, Fraction, Rational};
use lie_symbolic::symbolic::ExprId;

/// Work allowed to compare the constants.
const WORK: u64 = 200_000;

/// A component of a vector: a coordinate, and the number that it is as a multiple of the component.
pub type Component = (usize, Rational);

/// The structure of so(3) with vectors.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Vectors {
    /// The coordinates of the rotations, ascending.
    pub rotation: [usize; 3],
    /// The components of each vector.
    pub vectors: Vec<[Component; 3]>,
    /// The constant c.
    pub scale: ExprId,
}

/// The brackets of basis elements that are multiples of basis elements.
struct Table<'a> {
    exact: &'a StructureConstants<Fraction>,
    budget: Budget,
}

impl Table<'_> {
    /// `[e_a, e_b]` as a multiple of an element; `None` where it is none.
    fn bracket(&self, a: usize, b: usize) -> Option<(usize, Fraction)> {
        match self.exact.upper(a.min(b), a.max(b)) {
            [(_, _, k, value)] if a < b => Some((*k, value.clone())),
            [(_, _, k, value)] => Some((*k, value.neg())),
            _ => None,
        }
    }

    fn commute(&self, a: usize, b: usize) -> bool {
        a == b || self.exact.upper(a.min(b), a.max(b)).is_empty()
    }

    fn equal(&self, a: &Fraction, b: &Fraction) -> bool {
        a.equals(b, &self.budget).unwrap_or(false)
    }

    /// The number q with `a = q b`, where it is one that is seen at once.
    fn ratio(&self, a: &Fraction, b: &Fraction) -> Option<Rational> {
        if self.equal(a, b) {
            return Some(Rational::ONE);
        }
        if self.equal(a, &b.neg()) {
            return Some(Rational::MINUS_ONE);
        }
        Some(a.as_constant()? / b.as_constant()?)
    }

    /// The constant c, where `[e_i, e_j] = c e_k` and cyclic permutations.
    fn spin(&self, [i, j, k]: [usize; 3]) -> Option<Fraction> {
        let (to, c) = self.bracket(i, j)?;
        let (first, a) = self.bracket(j, k)?;
        let (second, b) = self.bracket(k, i)?;
        let closed = (to, first, second) == (k, i, j);
        (closed && self.equal(&a, &c) && self.equal(&b, &c)).then_some(c)
    }

    /// The vector whose first component is that of a basis element.
    fn vector(&self, rotation: [usize; 3], first: usize, c: &Fraction) -> Option<[Component; 3]> {
        // [J3, V1] = c V2 and [J2, V1] = -c V3
        let (second, a) = self.bracket(rotation[2], first)?;
        let (third, b) = self.bracket(rotation[1], first)?;
        let (a, b) = (self.ratio(&a, c)?, self.ratio(&b.neg(), c)?);
        // V_j = a e_j has the coordinate mu_j = V_j/a
        let inverse = |factor: &Rational| Rational::ONE / factor.clone();
        let places = [first, second, third];
        let vector = [Rational::ONE, inverse(&a), inverse(&b)];
        let factors = [Rational::ONE, a, b];
        for (axis, &j) in rotation.iter().enumerate() {
            for (component, &place) in places.iter().enumerate() {
                if axis == component {
                    if !self.commute(j, place) {
                        return None;
                    }
                    continue;
                }
                // [J_axis, V_component] = +-c V_other
                let other = 3 - axis - component;
                let sign = if (axis + 1) % 3 == component {
                    c.clone()
                } else {
                    c.neg()
                };
                let (to, value) = self.bracket(j, place)?;
                let expected = &factors[other] / &factors[component];
                if to != places[other] || self.ratio(&value, &sign)? != expected {
                    return None;
                }
            }
        }
        Some(core::array::from_fn(|j| (places[j], vector[j].clone())))
    }
}

/// The vectors in the order of their first coordinates; `None` where the algebra has another form.
pub fn vectors(model: &Model) -> Option<Vectors> {
    let n = model.dimension();
    if n < 6 || !n.is_multiple_of(3) {
        return None;
    }
    let algebra = model.bracket.algebra()?;
    let table = Table {
        exact: &algebra.exact,
        budget: Budget::new(WORK),
    };
    let entries = algebra.exact.entries();
    let expressions = algebra.constants.entries();
    let (rotation, c, scale) =
        entries
            .iter()
            .zip(expressions)
            .find_map(|(entry, expression)| {
                let rotation = [entry.0, entry.1, entry.2];
                let ascending = entry.0 < entry.1 && entry.1 < entry.2;
                let c = if ascending {
                    table.spin(rotation)?
                } else {
                    return None;
                };
                Some((rotation, c, expression.3))
            })?;
    let others: Vec<usize> = (0..n).filter(|k| !rotation.contains(k)).collect();
    if !others
        .iter()
        .all(|&a| others.iter().all(|&b| table.commute(a, b)))
    {
        return None;
    }
    let mut vectors: Vec<[Component; 3]> = Vec::new();
    for &first in others.iter().filter(|&&k| table.commute(rotation[0], k)) {
        vectors.push(table.vector(rotation, first, &c)?);
    }
    let mut covered: Vec<usize> = vectors.iter().flatten().map(|(k, _)| *k).collect();
    covered.sort_unstable();
    (covered == others).then_some(Vectors {
        rotation,
        vectors,
        scale,
    })
}

/// Why the lift to quaternions does not apply, with the nearest method that does.
pub fn refusal(structure: &Structure, order: u32) -> Option<(String, String)> {
    if structure.vectors.is_some() {
        return None;
    }
    if let Some(reason) = structure.why_not_declared_algebra() {
        return Some((reason, super::lifts::nearest(structure, order)));
    }
    let reason = "the lift `quaternion` needs so(3) with vectors that commute, such as se(3), in a basis with \
                  [J1, J2] = c J3, [J1, P2] = c P3 and cyclic permutations";
    Some((reason.into(), super::lifts::nearest(structure, order)))
}
