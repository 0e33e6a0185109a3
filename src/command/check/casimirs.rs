//! What `lie check` says of Casimirs.

use std::fmt::Write as _;

use lie_codegen::model::CasimirKind;
use lie_codegen::structure::casimirs::{MAX_DEGREE, MAX_EXPONENT, MAX_FACTOR_DEGREE};
use lie_codegen::structure::{Search, Structure};

/// The Casimirs, and how the search for those that were not declared ended.
pub(super) fn write(model: &Structure, text: &mut String) -> std::fmt::Result {
    let independent = model.casimirs_to_find();
    let declared = model
        .casimirs
        .iter()
        .filter(|c| c.kind == CasimirKind::Declared)
        .count();
    let found = model.casimirs.len() - declared;
    let counts = match (declared, found) {
        (0, 1..) => format!("found {found}"),
        (_, 1..) => format!("{declared} declared and {found} found"),
        _ => format!("{declared} declared"),
    };
    writeln!(text, "  Casimirs: {counts} of {independent} independent")?;
    if model.casimirs.len() < independent {
        let why = match model.search {
            Search::Complete => format!(
                "no other is a polynomial of degree up to {MAX_DEGREE}, or a product of powers, up to {MAX_EXPONENT}, of semi-invariants of degree up to {MAX_FACTOR_DEGREE}"
            ),
            Search::Polynomials => format!(
                "no other is a polynomial of degree up to {MAX_DEGREE}; rational ones are not looked for where brackets contain parameters or constant terms"
            ),
            Search::Spent => {
                "the search ended with its budget: `lie check --deep` goes on".to_owned()
            }
            Search::Singular => {
                "one that was found is not defined at the initial state, and neither is its reciprocal".to_owned()
            }
            Search::Long => "what was found is too long to be followed".to_owned(),
            Search::None(reason) => format!("no others are looked for: {reason}"),
        };
        writeln!(text, "    {why}")?;
    }
    for casimir in &model.casimirs {
        let changed = match casimir.kept {
            true => "",
            false => ", which is not kept: what acts changes it",
        };
        writeln!(
            text,
            "    {} = {}{changed}",
            casimir.name,
            model.display(casimir.expr)
        )?;
    }
    Ok(())
}
