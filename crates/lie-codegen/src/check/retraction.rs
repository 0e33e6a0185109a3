//! Retractions: a map from the algebra to the group, by its matrix.

use super::coordinates::Whole;
use super::environment::{Allowed, Environment};
use super::lower::Lowering;
use crate::algebra::moving::{Coordinates, Moving, Tangents, constant, product};
use crate::model::{Model, Retraction};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use lie_syntax::ast::{self, Expr, Invariance};
use lie_syntax::diagnostic::{Diagnostic, Kind};

/// What differs by less is equal, beside numbers of size 1.
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
            "a retraction is for H on an algebra alone: without a cocycle, a group element, the time, what acts beside H, and a constraint",
            "remove `retraction`, or what the declaration has of these",
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
    let wrong = |(message, help): Wrong| {
        Diagnostic::new(Kind::Representation, retraction.origin, message).help(help)
    };
    if let Some((message, help)) = model.parametric_matrices("a retraction of one's own") {
        let wrong = Diagnostic::new(Kind::Representation, retraction.origin, message);
        return Some(wrong.help(help));
    }
    let Some(identities) = Identities::of(model) else {
        let message = "there is no retraction: the algebra has no independent matrices, or the bracket is not that of an algebra alone";
        return Some(wrong((message.into(), "remove `retraction`")));
    };
    let defaults = model.defaults();
    let others = defaults.iter().enumerate();
    let others = others.map(|(p, value)| value + 0.3 * scattered(p) * (1.0 + value.abs()));
    let others: Vec<f64> = others.collect();
    let mut sets = [defaults, others].into_iter();
    let found = sets.find_map(|parameters| identities.wrong(&parameters));
    found.map(wrong)
}

/// A number between -1 and 1.
fn scattered(k: usize) -> f64 {
    (1.0 + 0.618_033_988_75 * k as f64)
        .fract()
        .mul_add(2.0, -1.0)
}

/// What is wrong, and what to do.
pub type Wrong = (String, &'static str);
type Values<'a> = &'a dyn Fn(&[ExprId]) -> Vec<f64>;

/// What must hold of a retraction, as matrices that must vanish.
pub struct Identities {
    graph: Graph,
    /// The names of the basis.
    basis: Vec<String>,
    /// The number of coordinates, and of rows.
    count: usize,
    size: usize,
    /// The largest entry of the matrices of the algebra.
    scale: f64,
    /// `map - 1` and `second - 1`,
    ends: Vec<Vec<ExprId>>,
    /// `B_a - e_a`,
    slopes: Vec<Vec<ExprId>>,
    /// `M M^-1 - 1` and the same of S,
    inverses: Vec<Vec<ExprId>>,
    /// `(dM/dx_a) M^-1` less what its coordinates give, and the same of S,
    outside: Vec<Vec<ExprId>>,
    /// `tau(x) tau(-x) - 1`.
    symmetric: Vec<ExprId>,
}

impl Identities {
    /// Of a model with a retraction; none where its algebra has no independent matrices.
    pub fn of(model: &Model) -> Option<Self> {
        let retraction = model.retraction.as_ref()?;
        let (_, matrices) = model.group_matrices()?;
        let coordinates = Coordinates::new(&matrices)?;
        let mut graph = model.graph.clone();
        let size = retraction.size;
        let moving = retraction.moving(&matrices, model.invariance == Invariance::Right);
        let tangents = moving.tangents(&mut graph);
        let basis: Vec<Vec<ExprId>> = matrices.iter().map(|e| constant(&mut graph, e)).collect();
        let ends = [Some(&retraction.map), retraction.second.as_ref()];
        let ends = ends.into_iter().flatten();
        let ends = ends.map(|end| less_identity(&mut graph, end, size));
        let ends = ends.collect();
        let slopes = tangents.directions.iter().zip(&basis);
        let slopes = slopes
            .map(|(direction, e)| difference(&mut graph, direction, e))
            .collect();
        let mut outside = Vec::new();
        for alone in moving.each_end() {
            for direction in alone.tangents(&mut graph).directions {
                let parts = coordinates.of(&mut graph, &direction);
                let combined = (0..size * size).map(|k| {
                    let terms = parts.iter().zip(&basis);
                    let terms: Vec<ExprId> = terms.map(|(c, e)| graph.mul(*c, e[k])).collect();
                    graph.sum(&terms)
                });
                let combined: Vec<ExprId> = combined.collect();
                outside.push(difference(&mut graph, &direction, &combined));
            }
        }
        let pairs = moving.ends.iter().zip(&tangents.inverses);
        let pairs = pairs.filter_map(|(end, inverse)| Some((*end.as_ref()?, inverse.as_ref()?)));
        let inverses = pairs
            .map(|(end, inverse)| {
                let whole = product(&mut graph, end, inverse, size);
                less_identity(&mut graph, &whole, size)
            })
            .collect();
        let symmetric = symmetric(&mut graph, &moving, &tangents);
        let entries = matrices.iter().flatten().flatten();
        let names = model.bracket.algebra()?.basis.iter();
        Some(Self {
            graph,
            basis: names.map(|name| name.text.clone()).collect(),
            count: matrices.len(),
            size,
            scale: entries
                .map(|entry| entry.to_f64().abs())
                .fold(0.0, f64::max),
            ends,
            slopes,
            inverses,
            outside,
            symmetric,
        })
    }

    /// What is wrong at values of the parameters.
    pub fn wrong(&self, parameters: &[f64]) -> Option<Wrong> {
        let at = |x: &[f64], entries: &[ExprId]| {
            let value = |symbol| match symbol {
                Symbol::Input(a) => x[a],
                Symbol::Parameter(p) => parameters[p],
                _ => f64::NAN,
            };
            self.graph.evaluate_all(entries, &value)
        };
        let zero = vec![0.0; self.count];
        let wrong = self.at_zero(&|entries| at(&zero, entries));
        wrong.or_else(|| {
            (0..POINTS).find_map(|k| {
                let x = (0..self.count).map(|a| 0.6 * scattered(3 + k * self.count + a));
                let x: Vec<f64> = x.collect();
                self.elsewhere(&|entries| at(&x, entries))
            })
        })
    }

    /// What is wrong where x is 0.
    fn at_zero(&self, values: Values<'_>) -> Option<Wrong> {
        for (end, name) in self.ends.iter().zip(["map", "second"]) {
            let Some((place, value)) = self.off(values, end, 1.0) else {
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
        let mut off =
            slopes.filter_map(|(a, slope)| Some((a, self.off(values, slope, self.scale)?)));
        off.next().map(|(a, (place, value))| {
            let message = format!(
                "the derivative of the retraction at 0 along `{}` is not its matrix: {place} is off by {value}",
                self.basis[a],
            );
            (message, "the derivative at 0 of `map`, less that of `second`, is the element itself")
        })
    }

    /// What is wrong at an element.
    fn elsewhere(&self, values: Values<'_>) -> Option<Wrong> {
        let inverses = self.inverses.iter().map(|matrix| (matrix, 1.0));
        let outside = self.outside.iter().map(|matrix| (matrix, self.scale));
        let mut group = inverses.chain(outside);
        if group.any(|(matrix, scale)| self.off(values, matrix, scale).is_some()) {
            return Some((
                "a matrix of the retraction leaves the group of the algebra, or is not finite near 0".into(),
                "give matrices of the group for every x, such as products of exponentials of elements",
            ));
        }
        self.off(values, &self.symmetric, 1.0).map(|_| {
            (
                "tau(x) tau(-x) is not the identity: steps along the retraction would not be symmetric, and have order 1".into(),
                "give it two ends: as `map` its matrix at x/2, as `second` that at -x/2",
            )
        })
    }

    /// The first entry that does not vanish beside numbers of this size, as text, and its value.
    fn off(&self, values: Values<'_>, matrix: &[ExprId], scale: f64) -> Option<(String, f64)> {
        let values = values(matrix);
        let mut entries = values.iter();
        let place = entries.position(|value| value.is_nan() || value.abs() > EQUAL * scale)?;
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
