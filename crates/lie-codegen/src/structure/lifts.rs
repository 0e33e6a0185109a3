//! Which linear symplectic space collective methods go over, where none is asked for, and what they take from H.

use crate::model::Model;
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};

use super::spins::Spin;
use super::unitary::{Unitary, forms};
use super::vectors::{Component, Vectors};
use super::{Structure, matrices};

/// The smallest space over a system that carries collective methods.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Smallest {
    /// `T*R^2` for each spin.
    Hopf,
    /// `T*H` for a rotation group with vectors.
    Quaternion,
    /// `C^(N x (N-1))` over a unitary representation on `C^N`.
    Unitary,
    /// `T*V^r` of the representation.
    Representation,
}

impl Smallest {
    /// The space in words.
    pub fn description(self) -> &'static str {
        match self {
            Self::Hopf => "T*R^2 for each spin",
            Self::Quaternion => "T*H, H the quaternions",
            Self::Unitary => "factors of a Hermitian matrix",
            Self::Representation => "columns of the representation",
        }
    }
}

/// The smallest space, if there is one; what is held from step to step is carried to none.
pub fn smallest(
    model: &Model,
    spins: Option<&[Spin]>,
    vectors: Option<&Vectors>,
    unitary: Option<Unitary>,
) -> Option<Smallest> {
    if model.holds() {
        return None;
    }
    if spins.is_some() {
        Some(Smallest::Hopf)
    } else if vectors.is_some() {
        Some(Smallest::Quaternion)
    } else {
        let representation = model.bracket.representation()?;
        let columns = representation.columns.as_ref()?;
        let count = 2 * representation.dimension * columns.indices.len();
        Some(match unitary {
            Some(unitary) if unitary.point() < count => Smallest::Unitary,
            _ => Smallest::Representation,
        })
    }
}

/// Why collective methods of an order have no space to go over, with the nearest method that does without.
pub fn refusal(structure: &Structure, order: u32) -> Option<(String, String)> {
    if structure.smallest.is_some() {
        return None;
    }
    let reason = match (structure.why_not_declared_algebra(), structure.bracket.representation()) {
        (Some(reason), _) => reason,
        (None, None) if structure.bracket.parametric().is_some() => return matrices::refusal(structure, order),
        (None, None) => "it needs a direct sum of algebras so(3), or so(3) with vectors that commute, in a basis with \
             [e1, e2] = c e3 and its cyclic permutations, or a matrix representation, and the algebra declares no `matrices`"
            .into(),
        (None, Some(_)) => return matrices::refusal(structure, order),
    };
    Some((reason, nearest(structure, order)))
}

/// What to use instead of a collective method of an order whose space there is not.
pub(super) fn nearest(structure: &Structure, order: u32) -> String {
    match structure.smallest {
        Some(_) => format!("use `collective{order}` without `--lift`: it takes the smallest space that there is"),
        None if order > 8 => {
            "use `compose8(lie-midpoint)`, or `gauss16`, which is not a Poisson map but keeps quadratic Casimirs".into()
        }
        None => format!("use `compose{order}(lie-midpoint)`, which works for every Lie algebra"),
    }
}

/// A quadratic Casimir `sum_i a_i b_i`, by its factors in the arena, multiples of coordinates.
struct Pairing {
    pairs: Vec<(ExprId, ExprId)>,
    /// Whether each product is a square, or is there in both orders.
    symmetric: bool,
}

/// What quadratic Casimirs are known from: spins, vectors, or a unitary representation.
type Parts<'a> = (Option<&'a [Spin]>, Option<&'a Vectors>, Option<Unitary>);

/// H without a function of Casimirs, as short as that makes its gradient: `None` where nothing is to be removed.
///
/// It moves the same states, but another point over them: the field on the space is shorter, and its motion slower. The
/// multiple of each quadratic Casimir is the coefficient of one of its terms in H. Of those that remove most, it is that
/// which leaves the others smallest at the default parameters.
pub fn gauge(model: &Model, parts: Parts<'_>, graph: &mut Graph) -> Option<ExprId> {
    let hamiltonian = model.energy.expression()?.value;
    let n = model.dimension();
    let start = graph.normal(hamiltonian);
    let mut value = start;
    for pairing in pairings(model, parts, graph) {
        let slopes: Vec<ExprId> = pairing
            .pairs
            .iter()
            .map(|pair| coefficient(graph, value, *pair))
            .collect();
        let mut best = (terms_of(graph, value, n), f64::INFINITY, value);
        for &slope in &slopes {
            let Some(at_default) = model.at_defaults(graph, slope) else {
                continue;
            };
            let terms: Vec<ExprId> = pairing
                .pairs
                .iter()
                .map(|(a, b)| graph.product(&[slope, *a, *b]))
                .collect();
            let casimir = graph.sum(&terms);
            let factor = if pairing.symmetric { 2 } else { 1 };
            let casimir = graph.scale(casimir, &Rational::new(1, factor)?);
            let candidate = graph.sub(value, casimir);
            let candidate = graph.normal(candidate);
            let spread = slopes
                .iter()
                .filter_map(|other| model.at_defaults(graph, *other));
            let spread = spread
                .map(|other| (other - at_default).abs())
                .fold(0.0, f64::max);
            let size = terms_of(graph, candidate, n);
            if size < best.0 || (size == best.0 && best.2 != value && spread < best.1) {
                best = (size, spread, candidate);
            }
        }
        value = best.2;
    }
    (value != start).then_some(value)
}

/// The quadratic Casimirs that are known: squares of spins, products of vectors, and the momentum along a single one; sums of
/// squares of eigenvalues.
fn pairings(
    model: &Model,
    (spins, vectors, unitary): Parts<'_>,
    graph: &mut Graph,
) -> Vec<Pairing> {
    let symbol = |graph: &mut Graph, k: usize| graph.symbol(Symbol::Coordinate(k));
    if let Some(spins) = spins {
        let pairs = spins.iter().map(|spin| {
            let pair = |k: &usize| {
                let x = symbol(graph, *k);
                (x, x)
            };
            Pairing {
                pairs: spin.coordinates.iter().map(pair).collect(),
                symmetric: true,
            }
        });
        return pairs.collect();
    }
    let Some(found) = vectors else {
        let representation = unitary.and_then(|_| model.bracket.representation());
        let forms = representation.map(forms).unwrap_or_default();
        return forms.iter().map(|form| products(form, graph)).collect();
    };
    let mut rows: Vec<Vec<ExprId>> = Vec::new();
    for vector in &found.vectors {
        let component = |(k, factor): &Component| {
            let x = graph.symbol(Symbol::Coordinate(*k));
            graph.scale(x, &(Rational::ONE / factor.clone()))
        };
        rows.push(vector.iter().map(component).collect());
    }
    let mut all = Vec::new();
    for (a, first) in rows.iter().enumerate() {
        for (b, second) in rows.iter().enumerate().skip(a) {
            all.push(Pairing {
                pairs: first.iter().copied().zip(second.iter().copied()).collect(),
                symmetric: a == b,
            });
        }
    }
    if let [vector] = rows.as_slice() {
        let rotation = found.rotation.map(|k| symbol(graph, k));
        all.push(Pairing {
            pairs: rotation.into_iter().zip(vector.iter().copied()).collect(),
            symmetric: false,
        });
    }
    all
}

/// The terms of a quadratic form.
fn products(form: &[Vec<Rational>], graph: &mut Graph) -> Pairing {
    let mut pairs = Vec::new();
    for (k, row) in form.iter().enumerate() {
        for (l, value) in row.iter().enumerate().filter(|(_, v)| !v.is_zero()) {
            let [x, y] = [k, l].map(|k| graph.symbol(Symbol::Coordinate(k)));
            pairs.push((x, graph.scale(y, value)));
        }
    }
    Pairing {
        pairs,
        symmetric: true,
    }
}

/// The second derivative of a function by two coordinates or multiples of them, each 1 in these.
fn coefficient(graph: &mut Graph, value: ExprId, (a, b): (ExprId, ExprId)) -> ExprId {
    let mut slope = value;
    for factor in [a, b] {
        let (scale, base) = graph.coefficient(factor);
        let found = graph.symbols(base).into_iter().next();
        let Some(symbol) = found else {
            return graph.integer(0);
        };
        slope = graph.derivative(slope, symbol);
        slope = graph.scale(slope, &(Rational::ONE / scale));
    }
    slope
}

/// How many second derivatives of a function do not vanish.
fn terms_of(graph: &mut Graph, value: ExprId, dimension: usize) -> usize {
    let mut count = 0;
    for i in 0..dimension {
        let slope = graph.derivative(value, Symbol::Coordinate(i));
        for j in 0..=i {
            let second = graph.derivative(slope, Symbol::Coordinate(j));
            let second = graph.normal(second);
            count += usize::from(!graph.is_zero(second));
        }
    }
    count
}
