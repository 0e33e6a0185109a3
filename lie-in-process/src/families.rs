//! What is measured of families.

use lie_codegen::model::Model;

/// The most coordinates of a family that is verified: matrices of all of them are computed.
const MOST_COORDINATES: usize = 64;

/// What stands against verifying a family of so many coordinates, and a remedy.
pub fn too_many(model: &Model, coordinates: usize) -> Option<(String, String)> {
    if model.family.is_none() || coordinates <= MOST_COORDINATES {
        return None;
    }
    let text = format!(
        "{} has {coordinates} coordinates, and matrices of all of them are computed up to {MOST_COORDINATES}",
        model.name
    );
    let sites = MOST_COORDINATES / model.dimension();
    Some((text, format!("measure fewer sites, at most {sites}")))
}

/// That a measurement does not take families.
pub fn not_measured(model: &Model, what: &str) -> String {
    format!(
        "{} is a family, which `{what}` does not measure yet",
        model.name
    )
}
