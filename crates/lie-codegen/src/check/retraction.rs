//! Retractions: a map from the algebra to the group, by its matrix.

use super::coordinates::Whole;
use super::environment::{Allowed, Environment};
use super::lower::Lowering;
use crate::algebra::moving::{Coordinates, Moving, Tangents, constant, product};
use crate::model::{Model, Retraction};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use lie_syntax::ast::{self, Expr};
use lie_syntax::diagnostic::{Diagnostic, Kind};

/// What differs by less is equal: entries are of size 1.
const EQUAL: f64 = 1e-10;
/// Elements at which identities are checked.
const POINTS: usize = 6;

/// Lowers a retraction; `Some(None)` where none is declared.
pub fn lowered_map(
    whole: &Whole<'_>,
    graph: &mut Graph,
    environment: &Environment<'_>,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<Option<Retraction>> {
    let declaration = &*whole.declaration;
    let Some(declared) = &declaration.retraction else {
        return Some(None);
    };
    let wrong = |message: &str, help: &str| {
        Diagnostic::new(Kind::Representation, declared.origin, message).help(help)
    };
    if whole.configuration.is_some() || declaration.is_constrained() {
        mistakes.push(wrong(
            "a retraction is for H alone: without a group element, the time, what acts beside H, and a constraint",
            "remove it, or these",
        ));
        return None;
    }
    let algebra = declaration.algebra();
    let Some(size) = algebra.and_then(|algebra| Some(algebra.matrices.first()?.rows.len())) else {
        mistakes.push(wrong(
            "a retraction needs the matrices of the algebra, and none are declared",
            "declare `matrices`: the retraction is a matrix of their size",
        ));
        return None;
    };
    let names = environment.of_velocity(declaration, declaration.state.len());
    let mut matrix = |rows: &[Vec<Expr>]| square(rows, size, declared, graph, &names, mistakes);
    let map = matrix(&declared.map);
    let second = declared.second.as_ref().map(|rows| matrix(rows));
    Some(Some(Retraction {
        size,
        map: map?,
        second: match second {
            None => None,
            Some(second) => Some(second?),
        },
        origin: declared.origin,
    }))
}

/// The entries of a matrix of this size by rows.
fn square(
    rows: &[Vec<Expr>],
    size: usize,
    declared: &ast::Retraction,
    graph: &mut Graph,
    names: &Environment<'_>,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<Vec<ExprId>> {
    if rows.len() != size || rows.iter().any(|row| row.len() != size) {
        let place = rows.iter().flatten().next();
        let place = place.map_or(declared.origin, |entry| entry.origin);
        let message = format!("the matrices of the algebra have {size} rows and columns");
        let help = "give a matrix of their size";
        mistakes.push(Diagnostic::new(Kind::Representation, place, message).help(help));
        return None;
    }
    let entries = rows.iter().flatten();
    let entries: Vec<Option<ExprId>> = entries
        .map(|entry| Lowering::new(graph, names, mistakes, Allowed::Retraction).lower(entry))
        .collect();
    entries.into_iter().collect()
}

/// What is wrong with the declared retraction. It is looked at where x is 0 and at a few elements, at the default parameters and at others.
pub fn mistake(model: &Model) -> Option<Diagnostic> {
    let retraction = model.retraction.as_ref()?;
    let wrong = |(message, help): (String, &str)| {
        Diagnostic::new(Kind::Representation, retraction.origin, message).help(help)
    };
    let independent = model.group_matrices().and_then(|(_, matrices)| {
        let coordinates = Coordinates::new(&matrices)?;
        Some((matrices, coordinates))
    });
    let Some((matrices, coordinates)) = independent else {
        let message = "there is no retraction: the algebra has no independent matrices, or the bracket is not that of an algebra alone";
        return Some(wrong((message.into(), "remove `retraction`")));
    };
    let defaults = model.defaults();
    let others = defaults.iter().enumerate();
    let others = others.map(|(p, value)| value * (1.0 + 0.3 * scattered(p)));
    let others: Vec<f64> = others.collect();
    let mut graph = model.graph.clone();
    let moving = retraction.moving(&matrices, model.invariance);
    let identities = Identities::new(&mut graph, retraction, &moving, &coordinates);
    let mut sets = [defaults, others].into_iter();
    let found = sets.find_map(|parameters| {
        let at = |x: &[f64], entries: &[ExprId]| {
            let value = |symbol| match symbol {
                Symbol::Input(a) => x[a],
                Symbol::Parameter(p) => parameters[p],
                _ => f64::NAN,
            };
            graph.evaluate_all(entries, &value)
        };
        let count = matrices.len();
        let wrong = identities.at_zero(&|entries| at(&vec![0.0; count], entries));
        wrong.or_else(|| {
            (0..POINTS).find_map(|k| {
                let x = (0..count).map(|a| 0.6 * scattered(3 + k * count + a));
                let x: Vec<f64> = x.collect();
                identities.elsewhere(&|entries| at(&x, entries))
            })
        })
    });
    found.map(wrong)
}

/// A number between -1 and 1.
fn scattered(k: usize) -> f64 {
    (1.0 + 0.618_033_988_75 * k as f64)
        .fract()
        .mul_add(2.0, -1.0)
}

type Wrong = (String, &'static str);
type Values<'a> = &'a dyn Fn(&[ExprId]) -> Vec<f64>;

/// What must hold of a retraction, as matrices that must vanish.
struct Identities {
    size: usize,
    /// `map - 1` and `second - 1`,
    ends: Vec<Vec<ExprId>>,
    /// `B_a - e_a`,
    slopes: Vec<Vec<ExprId>>,
    /// `M M^-1 - 1` and the same of S,
    inverses: Vec<Vec<ExprId>>,
    /// `B_a` less what its coordinates give,
    outside: Vec<Vec<ExprId>>,
    /// `tau(x) tau(-x) - 1`.
    symmetric: Vec<ExprId>,
}

impl Identities {
    fn new(
        graph: &mut Graph,
        retraction: &Retraction,
        moving: &Moving<'_>,
        coordinates: &Coordinates,
    ) -> Self {
        let size = retraction.size;
        let tangents = moving.tangents(graph);
        let basis: Vec<Vec<ExprId>> = moving.basis.iter().map(|e| constant(graph, e)).collect();
        let ends = [Some(&retraction.map), retraction.second.as_ref()]
            .into_iter()
            .flatten();
        let ends: Vec<_> = ends.map(|end| less_identity(graph, end, size)).collect();
        let directions = tangents.directions.iter();
        let slopes = directions.clone().zip(&basis);
        let slopes = slopes
            .map(|(direction, e)| difference(graph, direction, e))
            .collect();
        let outside = directions
            .map(|direction| {
                let parts = coordinates.of(graph, direction);
                let combined = (0..size * size).map(|k| {
                    let terms = parts.iter().zip(&basis);
                    let terms: Vec<ExprId> = terms.map(|(c, e)| graph.mul(*c, e[k])).collect();
                    graph.sum(&terms)
                });
                let combined: Vec<ExprId> = combined.collect();
                difference(graph, direction, &combined)
            })
            .collect();
        let pairs = moving.ends.iter().zip(&tangents.inverses);
        let pairs = pairs.filter_map(|(end, inverse)| Some((*end.as_ref()?, inverse.as_ref()?)));
        let inverses = pairs
            .map(|(end, inverse)| {
                let whole = product(graph, end, inverse, size);
                less_identity(graph, &whole, size)
            })
            .collect();
        Self {
            size,
            ends,
            slopes,
            inverses,
            outside,
            symmetric: symmetric(graph, moving, &tangents),
        }
    }

    /// What is wrong where x is 0.
    fn at_zero(&self, values: Values<'_>) -> Option<Wrong> {
        for (end, name) in self.ends.iter().zip(["map", "second"]) {
            let Some((place, value)) = self.off(values, end) else {
                continue;
            };
            return Some(match value.is_finite() {
                true => (
                    format!("`{name}` is not the identity where x is 0: {place} is off by {value}"),
                    "a retraction maps 0 to the identity",
                ),
                false => (
                    format!("`{name}` has no value where x is 0, where a body at rest is: {place}"),
                    "write it so that it has one there, without a division by the length of x",
                ),
            });
        }
        let slopes = self.slopes.iter().enumerate();
        let mut off = slopes.filter_map(|(a, slope)| Some((a, self.off(values, slope)?)));
        off.next().map(|(a, (place, value))| {
            let message = format!(
                "the derivative of the retraction at 0 along basis element {} is not its matrix: {place} is off by {value}",
                a + 1,
            );
            (message, "the derivative at 0 of `map`, less that of `second`, is the element itself")
        })
    }

    /// What is wrong at an element.
    fn elsewhere(&self, values: Values<'_>) -> Option<Wrong> {
        let mut group = self.inverses.iter().chain(&self.outside);
        if group.any(|matrix| self.off(values, matrix).is_some()) {
            return Some((
                "the retraction leaves the group of the matrices, or is not finite near 0".into(),
                "give a matrix of the group for every x, such as a product of exponentials of elements",
            ));
        }
        self.off(values, &self.symmetric).map(|_| {
            (
                "tau(x) tau(-x) is not the identity: steps along the retraction would not be symmetric, and have order 1".into(),
                "give it two ends: as `map` its matrix at x/2, as `second` that at -x/2",
            )
        })
    }

    /// The first entry that does not vanish, as text, and its value.
    fn off(&self, values: Values<'_>, matrix: &[ExprId]) -> Option<(String, f64)> {
        let values = values(matrix);
        let place = values.iter().position(|value| !(value.abs() <= EQUAL))?;
        let (i, j) = (place / self.size + 1, place % self.size + 1);
        Some((format!("entry {i}, {j}"), values[place]))
    }
}

/// `tau(x) tau(-x) - 1`.
fn symmetric(graph: &mut Graph, moving: &Moving<'_>, tangents: &Tangents) -> Vec<ExprId> {
    let [forth, _] = moving.elements(graph, tangents);
    let count = moving.basis.len();
    let opposite: Vec<ExprId> = (0..count)
        .map(|a| {
            let x = graph.symbol(Symbol::Input(a));
            graph.neg(x)
        })
        .collect();
    let back = graph.substitute(&forth, &|symbol| match symbol {
        Symbol::Input(a) => opposite.get(a).copied(),
        _ => None,
    });
    let whole = product(graph, &forth, &back, moving.size);
    less_identity(graph, &whole, moving.size)
}

fn less_identity(graph: &mut Graph, matrix: &[ExprId], size: usize) -> Vec<ExprId> {
    let entries = matrix.iter().enumerate();
    let entries = entries.map(|(k, entry)| {
        let one = graph.integer(i64::from(k / size == k % size));
        graph.sub(*entry, one)
    });
    entries.collect()
}

fn difference(graph: &mut Graph, a: &[ExprId], b: &[ExprId]) -> Vec<ExprId> {
    let pairs = a.iter().zip(b);
    pairs.map(|(a, b)| graph.sub(*a, *b)).collect()
}
