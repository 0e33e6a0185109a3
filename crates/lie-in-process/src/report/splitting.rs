//! The pieces of H whose flows are exact.

use lie_codegen::methods::{Choice, Pieces, Scheme, refusal};
use lie_codegen::model::configuration::TIME_MOMENTUM;
use lie_codegen::plan::chosen;
use lie_codegen::structure::Structure;
use lie_codegen::structure::found::{self, Terms};
use serde_json::{Value, json};

/// The pieces of H, in the order of a step.
pub struct Splitting {
    /// Their terms.
    pub terms: Terms,
    /// The operations of a step of order 2, and those of other ways with as many pieces.
    pub costs: Option<(usize, Vec<usize>)>,
}

/// The pieces of H.
///
/// # Errors
/// Why there are none.
pub(super) fn find(model: &Structure) -> Result<Splitting, String> {
    if let Some(found) = &model.family_pieces {
        let found = found.as_ref().map_err(String::clone)?;
        let terms = Terms {
            pieces: found
                .pieces
                .iter()
                .map(|piece| vec![piece.describe(model)])
                .collect(),
            shifted: false,
        };
        return Ok(Splitting { terms, costs: None });
    }
    let searched = &model.splitting;
    let Some(chosen) = chosen(model) else {
        let choice = Choice::Splitting(2, Scheme::Strang, Pieces::Found);
        let why = refusal(model, &choice).map(|(why, _)| why);
        return Err(why.unwrap_or_else(|| "H is too long to be taken apart".to_owned()));
    };
    let found = &searched.ways[chosen.way];
    let mut terms = found::terms(model, searched, found);
    let order = chosen.order.iter();
    terms.pieces = order.map(|place| terms.pieces[*place].clone()).collect();
    if model.configuration.as_ref().is_some_and(|c| c.idle) {
        let own = |term: &String| term != TIME_MOMENTUM;
        terms.pieces.iter_mut().for_each(|terms| terms.retain(own));
    }
    let mut others = chosen.costs.clone();
    let own = others.remove(chosen.way);
    Ok(Splitting {
        terms,
        costs: (!found.declared).then_some((own, others)),
    })
}

/// The terms of each piece.
pub(super) fn json(splitting: &Result<Splitting, String>) -> Value {
    splitting.as_ref().map_or(Value::Null, |splitting| {
        splitting.terms.pieces.clone().into()
    })
}

/// What a step costs, beside other ways.
pub(super) fn cost(splitting: &Result<Splitting, String>) -> Value {
    let costs = splitting.as_ref().ok().and_then(|s| s.costs.as_ref());
    costs.map_or(
        Value::Null,
        |(own, others)| json!({ "weight": own, "others": others }),
    )
}
