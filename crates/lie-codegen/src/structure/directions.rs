//! The directions that follow from the signs of brackets: pairs of coordinates that are canonical up to a constant of every
//! motion, in which mechanics runs forwards or backwards in time, and triples that turn as vectors do.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use crate::model::Model;
use lie_symbolic::exact::{Budget, Rational};
use lie_symbolic::prove::normal::{NormalForm, Verdict};
use lie_symbolic::symbolic::{ExprId, Graph, Node, Symbol};

/// Work allowed to show that brackets are Casimirs.
const WORK: u64 = 200_000;

/// By what the position of a pair is told from its momentum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Roles {
    /// By the names, such as q and p.
    Names,
    /// By the order of the state, since the names do not say it.
    Order,
    /// By nothing: the names are those of two positions, or of two momenta.
    Alike,
}

/// Two coordinates whose bracket is a Casimir or a constant, not zero.
#[derive(Clone, Debug)]
pub struct Pair {
    /// The position q.
    pub position: usize,
    /// The momentum p.
    pub momentum: usize,
    /// `{q, p}`, in the arena of the [`Directions`].
    pub value: ExprId,
    /// By what they are told apart.
    pub roles: Roles,
}

/// Three coordinates with `{x, y} = s z` and its cyclic permutations, which are in no other such triple.
#[derive(Clone, Debug, PartialEq)]
pub struct Turn {
    /// The coordinates x, y, z, ascending.
    pub coordinates: [usize; 3],
    /// The number s.
    pub scale: Rational,
}

/// What the signs of brackets say of a system.
#[derive(Clone, Debug)]
pub struct Directions {
    graph: Graph,
    /// The canonical pairs, ascending.
    pub pairs: Vec<Pair>,
    /// The vectors that turn, ascending.
    pub turns: Vec<Turn>,
}

/// The bracket of a pair as a multiple of one coordinate, or without coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// A number times this coordinate; whether the number is negative.
    Multiple(usize, bool),
    /// A number; whether it is negative.
    Number(bool),
    /// A function of parameters.
    Parameters,
    /// Something else.
    Other,
}

impl Directions {
    /// What the bracket of a pair is made of.
    pub fn form(&self, pair: &Pair) -> Form {
        let (factor, base) = self.graph.coefficient(pair.value);
        match self.graph.node(base) {
            Node::Symbol(Symbol::Coordinate(k)) => Form::Multiple(*k, factor.is_negative()),
            _ if !self.graph.coordinates(pair.value).is_empty() => Form::Other,
            _ => match self.graph.as_number(pair.value) {
                Some(number) => Form::Number(number.is_negative()),
                None => Form::Parameters,
            },
        }
    }

    /// The bracket of a pair as text.
    pub fn display(&self, pair: &Pair, model: &Model) -> String {
        self.graph
            .display(pair.value, &|symbol| name(model, symbol))
    }

    /// Its value, where coordinates and parameters have these.
    pub fn value(&self, pair: &Pair, parameters: &[f64], coordinate: &dyn Fn(usize) -> f64) -> f64 {
        self.graph.evaluate(pair.value, &|symbol| match symbol {
            Symbol::Coordinate(k) => coordinate(k),
            Symbol::Parameter(p) => parameters[p],
            _ => f64::NAN,
        })
    }
}

/// The name of a symbol; of a coordinate of a family that at its own site.
pub fn name(model: &Model, symbol: Symbol) -> String {
    match (&model.family, symbol) {
        (Some(family), Symbol::Coordinate(a)) => {
            family.names[family.own * model.dimension() + a].clone()
        }
        _ => model.symbol_name(symbol),
    }
}

/// The Poisson brackets of the coordinates that are shown, as they are written in a declaration: `{q, p} = -z`.
pub fn brackets(model: &Model) -> Vec<String> {
    let mut graph = model.graph.clone();
    let (entries, shown) = (model.bracket.entries(&mut graph), model.shown_coordinates());
    let of = |k: usize| name(model, Symbol::Coordinate(k));
    let line = |(i, j, value): &(usize, usize, ExprId)| {
        let value = graph.display(*value, &|symbol| name(model, symbol));
        format!("{{{}, {}}} = {value}", of(*i), of(*j))
    };
    let between = |(i, j, _): &&(usize, usize, ExprId)| shown.contains(i) && shown.contains(j);
    entries.iter().filter(between).map(line).collect()
}

/// Finds the pairs and the triples.
pub fn directions(model: &Model) -> Directions {
    let mut scratch = model.graph.clone();
    let shown = model.shown_coordinates();
    let entries = model.bracket.entries(&mut scratch);
    let mut rows: Vec<BTreeMap<usize, ExprId>> = vec![BTreeMap::new(); model.dimension()];
    for (i, j, value) in &entries {
        rows[*i].insert(*j, *value);
        rows[*j].insert(*i, scratch.neg(*value));
    }
    let budget = Budget::new(WORK);
    let mut found = Vec::new();
    for (i, j, value) in &entries {
        let is_shown = shown.contains(i) && shown.contains(j);
        if is_shown && is_casimir(*value, &rows, &mut scratch, &budget) {
            found.push((*i, *j, *value));
        }
    }
    let turns = turns(&rows, &shown, &scratch);
    let pairs = found
        .into_iter()
        .map(|(i, j, value)| pair(model, (i, j), value, &mut scratch));
    let mut pairs: Vec<Pair> = pairs.collect();
    // what is found stands in an arena of its own: the model's is that of the code
    let mut graph = Graph::new();
    let roots: Vec<ExprId> = pairs.iter().map(|pair| pair.value).collect();
    let values = graph.import(&scratch, &roots);
    for (pair, value) in pairs.iter_mut().zip(values) {
        pair.value = value;
    }
    Directions {
        graph,
        pairs,
        turns,
    }
}

/// Whether all brackets with a function are shown to vanish.
fn is_casimir(
    value: ExprId,
    rows: &[BTreeMap<usize, ExprId>],
    graph: &mut Graph,
    budget: &Budget,
) -> bool {
    let coordinates = graph.coordinates(value);
    let slopes: Vec<(usize, ExprId)> = coordinates
        .into_iter()
        .map(|k| (k, graph.derivative(value, Symbol::Coordinate(k))))
        .collect();
    let others = slopes.iter().flat_map(|(k, _)| rows[*k].keys().copied());
    let others: BTreeSet<usize> = others.collect();
    others.into_iter().all(|other| {
        let mut terms = Vec::new();
        for (k, slope) in &slopes {
            if let Some(entry) = rows[*k].get(&other) {
                terms.push(graph.mul(*slope, *entry));
            }
        }
        let sum = graph.sum(&terms);
        let shown = |graph: &Graph| NormalForm::new(graph, budget).verdict(sum);
        graph.is_zero(sum) || (terms.len() > 1 && matches!(shown(graph), Verdict::Zero))
    })
}

/// The pair of two coordinates i < j with this bracket.
fn pair(model: &Model, (i, j): (usize, usize), value: ExprId, graph: &mut Graph) -> Pair {
    let [first, second] = [i, j].map(|k| leaning(&model.coordinates[k].text));
    let roles = match first == second {
        false => Roles::Names,
        true if first.abs() == STRONG => Roles::Alike,
        true => Roles::Order,
    };
    match first >= second {
        true => Pair {
            position: i,
            momentum: j,
            value,
            roles,
        },
        false => Pair {
            position: j,
            momentum: i,
            value: graph.neg(value),
            roles,
        },
    }
}

/// A name that says that it is a position.
const STRONG: i8 = 2;

/// How far a name is that of a position, or where negative, of a momentum.
fn leaning(name: &str) -> i8 {
    let letters = name.chars().take_while(|c| c.is_alphabetic());
    let letters: String = letters.collect::<String>().to_lowercase();
    let angle = |word: &str| {
        let angles = ["theta", "phi", "psi", "angle", "θ", "φ", "ϕ", "ψ"];
        angles.contains(&word)
    };
    match letters.as_str() {
        "x" | "y" | "z" | "r" => 1,
        word if word.starts_with('q') || word.starts_with("pos") || angle(word) => STRONG,
        "p" | "π" | "pi" => -STRONG,
        word if word.starts_with("mom") => -STRONG,
        // px, pphi
        word if word
            .strip_prefix('p')
            .is_some_and(|of| of.chars().count() == 1 || angle(of)) =>
        {
            -STRONG
        }
        _ => 0,
    }
}

/// The triples that turn, of which no two share a coordinate.
fn turns(rows: &[BTreeMap<usize, ExprId>], shown: &[usize], graph: &Graph) -> Vec<Turn> {
    // {x_i, x_j} = s x_k
    let multiple = |i: usize, j: usize| {
        let (scale, base) = graph.coefficient(*rows[i].get(&j)?);
        match graph.node(base) {
            Node::Symbol(Symbol::Coordinate(k)) => Some((*k, scale)),
            _ => None,
        }
    };
    let mut found = Vec::new();
    for &i in shown {
        for &j in rows[i].keys().filter(|j| **j > i) {
            let Some((k, scale)) = multiple(i, j).filter(|(k, _)| *k > j) else {
                continue;
            };
            let rest = [multiple(j, k), multiple(k, i)];
            if rest == [Some((i, scale.clone())), Some((j, scale.clone()))] {
                let coordinates = [i, j, k];
                found.push(Turn { coordinates, scale });
            }
        }
    }
    let mut uses: HashMap<usize, usize> = HashMap::new();
    for k in found.iter().flat_map(|turn| turn.coordinates) {
        *uses.entry(k).or_default() += 1;
    }
    found.retain(|turn| turn.coordinates.iter().all(|k| uses[k] == 1));
    found
}

#[cfg(test)]
mod tests;
