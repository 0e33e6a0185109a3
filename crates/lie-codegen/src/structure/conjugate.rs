//! Brackets of pairs `{x, y} = 1/B(x, y)`, beside others that a change of each coordinate alone makes constant.
//!
//! With `Y = int B dy` it is `{x, Y} = 1`, whatever B depends on beside coordinates that are in no bracket. Such is that of the guiding centre of
//! a charged particle, B the strength of the field (R. G. Littlejohn, Journal of Plasma Physics 29 (1983) 111–125,
//! doi:10.1017/S002237780000060X). Where the integral over y has no closed form, that over x may.

pub(super) mod integral;
pub(super) mod inverse;

use super::Structure;
use super::elementwise::{Elementwise, Side, Speed, elementwise, factors, logarithm, vanish};
use crate::model::{Bracket, Model, PoissonMatrix};
use lie_symbolic::exact::{Budget, Fraction, Rational};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};

/// Work allowed for the proof that an integral is one.
const WORK: u64 = 500_000;

/// Coordinates in which a bracket is constant; those that stay have no change.
#[derive(Clone, Debug)]
pub struct Conjugate {
    /// The changes, by their coordinates.
    pub changes: Vec<Change>,
    /// The brackets `(i, j, {w_i, w_j})`, `i < j`, that do not vanish, free of coordinates.
    pub brackets: Vec<(usize, usize, ExprId)>,
}

/// A coordinate w of these in the place of a declared one.
#[derive(Clone, Debug)]
pub struct Change {
    /// The declared one.
    pub coordinate: usize,
    /// What w is.
    pub form: Form,
    /// `w(x)`
    pub value: ExprId,
    /// `dw/dx_i` by the declared one, which is not 0.
    pub slope: ExprId,
    /// The slopes by others, which stay.
    pub beside: Vec<(usize, ExprId)>,
    /// What states between which w has an inverse have in common.
    pub sides: Vec<Side>,
}

/// What takes the place of a coordinate.
#[derive(Clone, Debug)]
pub enum Form {
    /// `log |a(x)|` in an elementwise block, with this speed `a = a_0 + a_1 x`.
    Logarithm([Fraction; 2]),
    /// `int dx/a(x)` in an elementwise block, with another a.
    Elementwise,
    /// `int B dy` beside this coordinate.
    Integral(usize),
}

/// The coordinates for a bracket that is declared by its entries and not constant; none where no such are known.
pub fn conjugate(model: &Model, graph: &mut Graph) -> Option<Conjugate> {
    let Bracket::General(_) = &model.bracket else {
        return None;
    };
    let others = model.family.is_some() || model.realization.is_some();
    if others || model.is_almost_poisson() {
        return None;
    }
    of_matrix(model, &model.own_matrix()?, graph)
}

/// The same for these entries.
fn of_matrix(model: &Model, matrix: &PoissonMatrix, graph: &mut Graph) -> Option<Conjugate> {
    let mut own = graph.clone();
    let (mut changes, mut brackets) = (Vec::new(), Vec::new());
    for block in &blocks(matrix) {
        let form = elementwise(model, block, &mut own);
        if !form.as_ref().is_some_and(Elementwise::is_affine)
            && let Some((mut change, bracket)) = single_pair(model, matrix, block, &mut own)
        {
            for speed in form.iter().flat_map(Elementwise::closed) {
                change.sides.extend(speed.sides.iter().cloned());
            }
            changes.push(change);
            brackets.push(bracket);
            continue;
        }
        let form = form?;
        changes.extend(integrals(&form, &mut own));
        for (i, j, _) in &block.entries {
            let constant = own.rational_function(&form.constants[*i][*j]);
            brackets.push((*i, *j, constant));
        }
    }
    changes.sort_by_key(|change| change.coordinate);
    if changes.is_empty() {
        return None;
    }
    *graph = own;
    brackets.sort_unstable();
    Some(Conjugate { changes, brackets })
}

/// The entries by sets of coordinates that have no brackets with others.
fn blocks(matrix: &PoissonMatrix) -> Vec<PoissonMatrix> {
    let mut owners: Vec<usize> = (0..matrix.dimension).collect();
    for (i, j, _) in &matrix.entries {
        let (kept, gone) = (owners[*i], owners[*j]);
        for owner in &mut owners {
            if *owner == gone {
                *owner = kept;
            }
        }
    }
    let of = |owner: usize| {
        let entries = matrix.entries.iter();
        let entries = entries.filter(|(i, ..)| owners[*i] == owner).copied();
        PoissonMatrix {
            entries: entries.collect(),
            ..matrix.clone()
        }
    };
    let blocks = (0..matrix.dimension).map(of);
    blocks.filter(|block| !block.entries.is_empty()).collect()
}

/// That of a block which is a pair, and its bracket.
fn single_pair(
    model: &Model,
    matrix: &PoissonMatrix,
    block: &PoissonMatrix,
    graph: &mut Graph,
) -> Option<(Change, (usize, usize, ExprId))> {
    let [(i, j, entry)] = block.entries[..] else {
        return None;
    };
    let stays = |k: &usize| {
        let mut pairs = matrix.entries.iter();
        [i, j].contains(k) || !pairs.any(|(a, b, _)| a == k || b == k)
    };
    if !graph.coordinates(entry).iter().all(stays) {
        return None;
    }
    let [constant, density] = apart(graph, entry);
    let change = pair(model, graph, [i, j], density);
    let mut change = change.or_else(|| pair(model, graph, [j, i], density))?;
    change.sides.extend(borders(graph, entry));
    Some((change, (i, j, constant)))
}

/// The integrals `int dx_i/a_i` of an elementwise block, where they are not the coordinates.
fn integrals(form: &Elementwise, graph: &mut Graph) -> Vec<Change> {
    let moved = form.speeds.iter().enumerate();
    let moved = moved.filter(|(i, speed)| !speed.is_constant() && form.moves(*i));
    let change = |(i, speed): (usize, &Speed)| {
        let along = speed.at(i, graph);
        let (form, value, sides) = match speed {
            Speed::Affine(coefficients) => {
                let form = Form::Logarithm(coefficients.clone());
                let value = logarithm(graph, along);
                (form, value, vec![Side::Sign(along)])
            }
            Speed::Other(closed) => (Form::Elementwise, closed.integral, closed.sides.clone()),
        };
        Change {
            coordinate: i,
            form,
            value,
            slope: graph.pow(along, &Rational::from(-1)),
            beside: Vec::new(),
            sides,
        }
    };
    moved.map(change).collect()
}

/// `Y = int B dy` of a pair with this B.
fn pair(model: &Model, graph: &mut Graph, [x, y]: [usize; 2], density: ExprId) -> Option<Change> {
    let value = integral::integral(graph, density, y)?;
    let slope = graph.derivative(value, Symbol::Coordinate(y));
    let difference = graph.sub(slope, density);
    let budget = Budget::new(WORK);
    if !vanish(model, graph, &[density], &[difference], &budget) {
        return None;
    }
    let mut beside = Vec::new();
    for k in graph.coordinates(value).into_iter().filter(|k| *k != y) {
        beside.push((k, graph.derivative(value, Symbol::Coordinate(k))));
    }
    Some(Change {
        coordinate: y,
        form: Form::Integral(x),
        value,
        slope,
        beside,
        sides: vec![Side::Sign(slope)],
    })
}

/// What keeps its sign where no factor of an entry vanishes, or is infinite, whatever the power.
fn borders(graph: &mut Graph, entry: ExprId) -> Vec<Side> {
    let normal = graph.normal(entry);
    let (_, product) = graph.coefficient(normal);
    let mut all = factors(graph, product);
    all.retain(|(base, _)| !graph.coordinates(*base).is_empty());
    all.into_iter().map(|(base, _)| Side::Sign(base)).collect()
}

impl Change {
    /// The integral over the other coordinate of the pair, which may take the place of that one instead; none where it is not closed.
    pub(super) fn turned(
        &self,
        model: &Model,
        matrix: &PoissonMatrix,
        graph: &mut Graph,
    ) -> Option<Self> {
        let Form::Integral(other) = self.form else {
            return None;
        };
        let pair_of = [self.coordinate.min(other), self.coordinate.max(other)];
        let mut entries = matrix.entries.iter();
        let (.., entry) = entries.find(|(i, j, _)| [*i, *j] == pair_of)?;
        let [_, density] = apart(graph, *entry);
        pair(model, graph, [self.coordinate, other], density)
    }
}

/// c and B of an entry `c/B`, c the factors that are free of coordinates, but for numbers: nothing is divided by a parameter, which may be 0.
fn apart(graph: &mut Graph, entry: ExprId) -> [ExprId; 2] {
    let normal = graph.normal(entry);
    let (number, product) = graph.coefficient(normal);
    let varies = |(base, _): &(ExprId, Rational)| !graph.coordinates(*base).is_empty();
    let (mut varying, fixed): (Vec<_>, Vec<_>) =
        factors(graph, product).into_iter().partition(varies);
    for (_, exponent) in &mut varying {
        *exponent = &*exponent * &Rational::from(-1);
    }
    let constant = graph.power_product(&fixed);
    let density = graph.power_product(&varying);
    let density = match number.recip() {
        Some(number) => graph.scale(density, &number),
        None => density,
    };
    [constant, graph.normal(density)]
}

impl Conjugate {
    /// The coordinates that are integrals, as text `Y = int B dy`; none where all are logarithms.
    pub fn integrals(&self, graph: &Graph, model: &Model) -> Vec<String> {
        let name = |symbol| model.symbol_name(symbol);
        let pairs = self.changes.iter().filter_map(|change| {
            let Form::Integral(partner) = change.form else {
                return None;
            };
            let own = &model.coordinates[change.coordinate].text;
            let partner = &model.coordinates[partner].text;
            let value = graph.display(change.value, &name);
            Some(format!("{value} in the place of {own} beside {partner}"))
        });
        pairs.collect()
    }
}

/// Why a system has no such coordinates, with the nearest method.
pub fn refusal(structure: &Structure, order: u32) -> Option<(String, String)> {
    if structure.conjugate.is_some() && structure.energy.expression().is_some() {
        return None;
    }
    let model = &structure.model;
    let constant = model.bracket.matrix().is_some_and(|m| m.degree == Some(0));
    if constant {
        let gauss = if order == 2 {
            "midpoint".to_owned()
        } else {
            format!("gauss{order}")
        };
        return Some((
            "the bracket is constant in the coordinates that are declared".into(),
            format!("use `{gauss}`, which is the same method and a Poisson map there"),
        ));
    }
    let help = match model.bracket {
        _ if model.driving.is_some() => {
            "use `midpoint` or `gauss16`, which take the whole field".to_owned()
        }
        _ if model.is_almost_poisson() => {
            "use `orbit-energy`, which keeps the energy and kernel functions of the bracket"
                .to_owned()
        }
        Bracket::Lie(_) => format!("use `generating{order}`, a Poisson map of the same order"),
        Bracket::General(_) => {
            format!("use `k-hj{order}`, a Poisson map of the same order for every bracket")
        }
    };
    Some((
        "no coordinates are known in which the bracket is constant: it is not made of pairs {x, y} = 1/B(x, y) with a closed integral of B, brackets {x_i, x_j} = c_ij a_i(x_i) a_j(x_j) with closed integrals of 1/a_i, and constant ones".into(),
        help,
    ))
}

#[cfg(test)]
mod tests;
