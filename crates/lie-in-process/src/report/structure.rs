//! The algebra.

use lie_codegen::structure::algebra::{Class, Report, Series};
use serde_json::{Value, json};

/// The key `class`.
pub(super) fn class(class: &Class) -> Value {
    json!({
        "abelian": class.abelian,
        "nilpotent": class.nilpotent,
        "solvable": class.solvable,
        "semisimple": class.semisimple,
        "reductive": class.reductive,
        "unimodular": class.unimodular,
    })
}

/// The key `series`.
pub(super) fn series(series: &Series) -> Value {
    json!({
        "derived": series.derived,
        "lower_central": series.lower_central,
        "centre": series.centre,
        "radical": series.radical,
    })
}

/// The key `killing`: the signature at the default parameters.
pub(super) fn killing(report: &Report) -> Value {
    let at_defaults = report.at_defaults.as_ref().map(|(_, series)| series);
    let killing = at_defaults.unwrap_or(&report.series).killing;
    json!({ "positive": killing.positive, "negative": killing.negative, "zero": killing.zero })
}
