//! The brackets of declared first integrals with each other: which of them are in involution.

use crate::model::{Model, Quantity, QuantityKind, bracket_of};
use lie_symbolic::exact::Budget;
use lie_symbolic::prove::proof::{Proof, Prover};
use lie_symbolic::symbolic::Symbol;

/// Work allowed for one bracket.
const WORK: u64 = 2_000_000;

/// The bracket of two first integrals.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bracket {
    /// Their names.
    pub of: [String; 2],
    /// Its value as text; none where it is zero.
    pub value: Option<String>,
}

/// The first integrals of a system.
pub fn integrals(model: &Model) -> impl Iterator<Item = &Quantity> {
    let quantities = model.quantities.iter();
    quantities.filter(|quantity| quantity.kind == QuantityKind::Integral)
}

/// The brackets of each with those behind it.
pub fn brackets(model: &Model) -> Vec<Bracket> {
    let integrals: Vec<&Quantity> = integrals(model).collect();
    if integrals.len() < 2 {
        return Vec::new();
    }
    let mut graph = model.graph.clone();
    let entries = model.bracket.entries(&mut graph);
    let clock = model.configuration.as_ref().and_then(|c| c.clock());
    let unit = clock.map(|clock| (clock.time + 1, graph.integer(1)));
    let name = |symbol: Symbol| model.symbol_name(symbol);
    let mut found = Vec::new();
    for (place, first) in integrals.iter().enumerate() {
        for second in &integrals[place + 1..] {
            let bracket = bracket_of(&mut graph, &entries, first.expr, second.expr);
            let bracket = graph.substitute(&[bracket], &|symbol| {
                let (place, one) = unit?;
                (symbol == Symbol::Coordinate(place)).then_some(one)
            })[0];
            let budget = Budget::new(WORK);
            let value = match Prover::new(&graph, &budget, &[], &name).examine(bracket) {
                Proof::Zero => None,
                Proof::Nonzero(text) => Some(text),
                Proof::Unproven { .. } => Some(unproven(&graph.display(bracket, &name))),
            };
            found.push(Bracket {
                of: [first, second].map(|integral| integral.name.clone()),
                value,
            });
        }
    }
    found
}

/// What is not shown to be zero.
fn unproven(text: &str) -> String {
    format!("{text}, which is not shown to be zero")
}
