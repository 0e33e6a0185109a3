//! How smooth a function is that consists of branches (`abs`, `min`, `max`, `piecewise`), and which order methods reach
//! across their joints.
//!
//! At a joint `g = 0` two functions f- and f+ meet. Where `f- - f+` and its derivatives across the joint below order k vanish
//! on it, and the one of order k does not, the function is k - 1 times continuously differentiable there. Of a Hamiltonian like
//! that the vector field has k - 2 continuous derivatives, a step that crosses the joint errs by `h^k` whatever the order of
//! the method is, and there is one such step for each crossing: the order is at most k (Hairer, Nørsett, Wanner, "Solving
//! Ordinary Differential Equations I", 1993, section II.6).

use crate::exact::{Budget, Rational};
use crate::prove::confirmation::Finding;
use crate::prove::normal::{NormalForm, Verdict};
use crate::symbolic::{Declared, ExprId, Function, Graph, Node, Symbol};

/// Derivatives that are looked at: as many as the highest order of a method asks for.
const MOST_DERIVATIVES: u32 = 16;
/// Work allowed for all decisions of the normal form about one function.
const WORK: u64 = 1_000_000;
/// The largest arena that derivatives may fill.
const MOST: usize = 200_000;

/// A set on which two branches meet.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Joint {
    /// Where it is, as text: an equation, or one for each of several values.
    pub place: String,
    /// The order of the first derivative that jumps there, 0 of the function itself; `None` where it could not be decided.
    pub jump: Option<u32>,
    /// Whether it is at times that are known beforehand, where a run ends its steps: no order is lost there.
    pub is_known: bool,
}

impl Joint {
    /// The order that a method of an order reaches where the motion crosses the joint; `None` where nothing is known.
    pub fn order(&self, order: u32) -> Option<u32> {
        self.jump.map(|jump| jump.min(order))
    }
}

/// The order that a method of an order reaches where the motion crosses all joints; `None` where nothing is known.
pub fn reached(joints: &[Joint], order: u32) -> Option<u32> {
    let crossed = joints.iter().filter(|joint| !joint.is_known);
    crossed
        .into_iter()
        .try_fold(order, |least, joint| joint.order(least))
}

/// The joints of a function of the coordinates, with names of symbols, and which symbols are known beforehand.
pub fn find_joints(
    graph: &Graph,
    function: ExprId,
    name: &dyn Fn(Symbol) -> String,
    known: &dyn Fn(Symbol) -> bool,
) -> Vec<Joint> {
    let mut joints = in_own_functions(graph, function);
    joints.extend(in_branches(graph, function, name, known));
    joints
}

/// The functions, each once, on whose zeros branches meet, of those that depend on some symbols alone.
pub fn joints_in(
    graph: &mut Graph,
    function: ExprId,
    known: &dyn Fn(Symbol) -> bool,
) -> Vec<ExprId> {
    let mut places: Vec<ExprId> = Vec::new();
    for condition in conditions(graph, function) {
        let (_, place) = oriented(graph, condition);
        let all_known = graph.symbols(place).into_iter().all(known);
        if all_known && !places.contains(&place) {
            places.push(place);
        }
    }
    places
}

/// What functions of the user are said to have, wherever it is.
fn in_own_functions(graph: &Graph, function: ExprId) -> Vec<Joint> {
    let mut all: Vec<Joint> = Vec::new();
    for own in graph.own_functions(function) {
        let Declared { name, smooth, .. } = own.declared();
        let Some(smooth) = smooth else { continue };
        let joint = Joint {
            place: format!("somewhere in {name}"),
            jump: Some(smooth + 1),
            is_known: false,
        };
        if !all.contains(&joint) {
            all.push(joint);
        }
    }
    all
}

/// Where branches meet.
fn in_branches(
    graph: &Graph,
    function: ExprId,
    name: &dyn Fn(Symbol) -> String,
    known: &dyn Fn(Symbol) -> bool,
) -> Vec<Joint> {
    let conditions = conditions(graph, function);
    if conditions.is_empty() {
        return Vec::new();
    }
    let budget = Budget::new(WORK);
    let mut scratch = graph.clone();
    let mut places: Vec<ExprId> = Vec::new();
    for condition in conditions {
        let (_, place) = oriented(&mut scratch, condition);
        if !places.contains(&place) {
            places.push(place);
        }
    }
    // joints of one expression and one kind stand together
    let mut found: Vec<(ExprId, Option<u32>, Vec<Rational>)> = Vec::new();
    for place in places {
        if let Some(jump) = first_jump(&mut scratch, function, place, &budget) {
            let (expression, value) = equation(&mut scratch, place);
            let known = found
                .iter_mut()
                .find(|(e, j, _)| (*e, *j) == (expression, jump));
            match known {
                Some((.., values)) => values.push(value),
                None => found.push((expression, jump, vec![value])),
            }
        }
    }
    let joints = found.into_iter().map(|(expression, jump, mut values)| {
        values.sort();
        let values: Vec<String> = values.iter().map(Rational::to_string).collect();
        let is_known = scratch.symbols(expression).into_iter().all(known);
        let expression = scratch.display(expression, name);
        Joint {
            place: format!("{expression} = {}", values.join(", ")),
            jump,
            is_known,
        }
    });
    joints.collect()
}

/// `g = 0` as an expression without a constant and its value.
fn equation(graph: &mut Graph, place: ExprId) -> (ExprId, Rational) {
    let Node::Sum { constant, terms } = graph.node(place).clone() else {
        return (place, Rational::ZERO);
    };
    (graph.linear(&terms), -&constant)
}

/// The conditions that depend on the state, in the order of the arena.
fn conditions(graph: &Graph, function: ExprId) -> Vec<ExprId> {
    let parts = graph.dependencies(&[function]).into_iter();
    let mut found: Vec<ExprId> = Vec::new();
    for part in parts {
        if let Node::Call(Function::Below, arguments) = graph.node(part)
            && !variables(graph, arguments[0]).is_empty()
            && !is_edge(graph, arguments)
            && !found.contains(&arguments[0])
        {
            found.push(arguments[0]);
        }
    }
    found
}

/// Whether a choice is the edge of the domain: a branch with a root of the condition is real nowhere on its side.
fn is_edge(graph: &Graph, arguments: &[ExprId]) -> bool {
    let condition = arguments[0];
    graph.certain(&arguments[1..2]).into_iter().any(|id| {
        let Node::Product(factors) = graph.node(id) else {
            return false;
        };
        let mut factors = factors.iter();
        factors.any(|(base, exponent)| *base == condition && !exponent.is_integer())
    })
}

fn variables(graph: &Graph, id: ExprId) -> Vec<Symbol> {
    let symbols = graph.symbols(id).into_iter();
    let varies = |s: &Symbol| matches!(s, Symbol::Coordinate(_) | Symbol::Input(_) | Symbol::Time);
    symbols.filter(varies).collect()
}

/// A condition as a positive or negative multiple of a form that it shares with its negative: whether it is negated.
fn oriented(graph: &mut Graph, condition: ExprId) -> (bool, ExprId) {
    let (coefficient, rest) = graph.coefficient(condition);
    let mut factor = coefficient;
    if let Node::Sum { terms, .. } = graph.node(rest) {
        factor = &factor * &terms[0].1;
    }
    let place = graph.scale(condition, &(&Rational::ONE / &factor));
    (factor.is_negative(), place)
}

/// The first derivative that jumps at a joint, `Some(None)` where it could not be decided; `None` if none does.
fn first_jump(
    graph: &mut Graph,
    function: ExprId,
    place: ExprId,
    budget: &Budget,
) -> Option<Option<u32>> {
    let conditions = conditions(graph, function).into_iter();
    let sides: Vec<(ExprId, bool)> = conditions
        .filter_map(|condition| {
            let (negated, own) = oriented(graph, condition);
            (own == place).then_some((condition, negated))
        })
        .collect();
    let [below, above] = [true, false].map(|below| {
        let side = |condition| {
            let found = sides.iter().find(|(known, _)| *known == condition);
            found.map(|(_, negated)| below != *negated)
        };
        graph.on_side(&[function], &side)[0]
    });
    let difference = graph.sub(below, above);
    let difference = graph.normal(difference);
    // the whole difference is costly, and decided only where its derivatives on the joint do not tell
    let jump = across(graph, difference, place, budget);
    let smooth = jump.is_none() && vanishes(graph, difference, budget) == Some(true);
    (!smooth).then_some(jump)
}

/// The order of the first derivative of the difference of two branches that is not zero at their joint.
fn across(graph: &mut Graph, difference: ExprId, place: ExprId, budget: &Budget) -> Option<u32> {
    let (variable, roots) = solved(graph, place)?;
    let mut derivative = difference;
    for order in 0..=MOST_DERIVATIVES {
        for root in &roots {
            let at = |symbol| (symbol == variable).then_some(*root);
            let value = graph.substitute(&[derivative], &at)[0];
            let value = graph.normal(value);
            if !vanishes(graph, value, budget)? {
                return Some(order);
            }
        }
        derivative = graph.derivative_within(derivative, variable, MOST)?;
    }
    None
}

/// A variable by which an equation `g = 0` can be solved, and its values there.
fn solved(graph: &mut Graph, place: ExprId) -> Option<(Symbol, Vec<ExprId>)> {
    let place = without_root(graph, place);
    let zero = graph.integer(0);
    for variable in variables(graph, place) {
        let at_zero = |symbol| (symbol == variable).then_some(zero);
        let rest = graph.substitute(&[place], &at_zero)[0];
        let slope = graph.derivative(place, variable);
        if is_constant(graph, slope, variable) {
            let quotient = graph.div(rest, slope);
            return Some((variable, vec![graph.neg(quotient)]));
        }
        let start = graph.substitute(&[slope], &at_zero)[0];
        let twice = graph.derivative(slope, variable);
        if graph.is_zero(start) && is_constant(graph, twice, variable) {
            let quotient = graph.div(rest, twice);
            let square = graph.scale(quotient, &Rational::from(-2));
            let half = &Rational::ONE / &Rational::from(2);
            let root = graph.pow(square, &half);
            return Some((variable, vec![root, graph.neg(root)]));
        }
    }
    None
}

/// Whether an expression is not zero and does not depend on a variable.
fn is_constant(graph: &Graph, id: ExprId, variable: Symbol) -> bool {
    !graph.is_zero(id) && !graph.symbols(id).contains(&variable)
}

/// For `c b^e + d` with a fractional exponent e of what varies, `b - (-d/c)^(1/e)`, which is zero where that is.
fn without_root(graph: &mut Graph, place: ExprId) -> ExprId {
    let (constant, terms) = match graph.node(place).clone() {
        Node::Sum { constant, terms } => (constant, terms),
        _ => return place,
    };
    let (varying, fixed): (Vec<_>, Vec<_>) = terms
        .iter()
        .cloned()
        .partition(|(term, _)| !variables(graph, *term).is_empty());
    let [(term, coefficient)] = varying.as_slice() else {
        return place;
    };
    let Node::Product(factors) = graph.node(*term).clone() else {
        return place;
    };
    let [(base, exponent)] = &*factors else {
        return place;
    };
    if exponent.is_integer() {
        return place;
    }
    let constant = graph.number(constant);
    let mut rest: Vec<(ExprId, Rational)> = fixed;
    rest.push((constant, Rational::ONE));
    let rest = graph.linear(&rest);
    let value = graph.scale(rest, &(&Rational::MINUS_ONE / coefficient));
    let value = graph.pow(value, &(&Rational::ONE / exponent));
    graph.sub(*base, value)
}

/// Whether an expression is identically zero; `None` where it is not decided.
fn vanishes(graph: &Graph, id: ExprId, budget: &Budget) -> Option<bool> {
    let mut normal = NormalForm::new(graph, budget);
    match normal.verdict(id) {
        Verdict::Zero => Some(true),
        // another function of the user may vanish there
        _ if !graph.own_functions(id).is_empty() => None,
        Verdict::Nonzero(_) => Some(false),
        Verdict::Undecided | Verdict::Contradicted => {
            (normal.finding(id) == Finding::Nonzero).then_some(false)
        }
    }
}
