//! What `lie check` says of the pieces of H whose flows are exact.

use std::fmt::Write as _;

use lie_codegen::methods::{Choice, Pieces, Scheme, refusal};
use lie_codegen::model::Model;
use lie_codegen::structure::family;
use lie_codegen::structure::found::{self, Terms};
use serde_json::Value;

/// The pieces of H, or why there are none.
pub(super) fn of(model: &Model) -> Result<Terms, String> {
    if let Some(own) = &model.family {
        let pieces = family::pieces(model, own, &mut model.graph.clone())?;
        return Ok(Terms {
            pieces: pieces
                .iter()
                .map(|piece| vec![piece.describe(model)])
                .collect(),
            shifted: false,
        });
    }
    found::terms(model).ok_or_else(|| {
        let choice = Choice::Splitting(2, Scheme::default(), Pieces::Found);
        let why = refusal(model, &choice).map(|(why, _)| why);
        why.unwrap_or_else(|| "H is too long to be taken apart".to_owned())
    })
}

/// The terms of each piece.
pub(super) fn json(splitting: &Result<Terms, String>) -> Value {
    splitting
        .as_ref()
        .map_or(Value::Null, |terms| terms.pieces.clone().into())
}

/// One line for each piece.
pub(super) fn write(
    model: &Model,
    splitting: &Result<Terms, String>,
    text: &mut String,
) -> std::fmt::Result {
    let terms = match splitting {
        Ok(terms) => terms,
        Err(why) => return writeln!(text, "  splitting: none: {why}"),
    };
    let count = match terms.pieces.len() {
        1 => "1 piece with an exact flow".to_owned(),
        count => format!("{count} pieces with exact flows"),
    };
    let rest = if terms.shifted {
        ", and a combination of Casimirs"
    } else {
        ""
    };
    let option = match model.family {
        Some(_) => " at each site",
        None => " (--pieces found)",
    };
    writeln!(text, "  splitting: H is {count}{rest}{option}")?;
    for piece in &terms.pieces {
        writeln!(text, "    {}", piece.join(", "))?;
    }
    Ok(())
}
