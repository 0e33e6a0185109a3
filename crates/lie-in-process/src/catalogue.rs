//! The rows of the catalogue of methods, in words and for programs.

use lie_codegen::methods::{Method, Preserves};
use serde_json::{Value, json};

/// What a method keeps, without what follows from it.
pub fn preserved(method: &Method) -> String {
    let Preserves {
        energy,
        casimirs,
        quadratic_casimirs,
        orbit,
        poisson,
        constant_poisson,
        quadratic_invariants,
        linear_invariants,
    } = method.preserves;
    if method.id.starts_with("compose") {
        return "what its base keeps".to_owned();
    }
    let all = [
        (poisson, "Poisson"),
        (constant_poisson && !poisson, "Poisson if constant"),
        (orbit, "orbit"),
        (casimirs && !orbit, "Casimirs"),
        (energy, "energy"),
        (quadratic_invariants, "quadratic invariants"),
        (
            quadratic_casimirs && !casimirs && !quadratic_invariants,
            "quadratic Casimirs",
        ),
        (
            linear_invariants && !quadratic_invariants,
            "linear invariants",
        ),
    ];
    let names = all.into_iter().filter(|(kept, _)| *kept);
    names.map(|(_, name)| name).collect::<Vec<_>>().join(", ")
}

/// The row for programs: the object of `lie methods --json`.
pub fn json(method: &Method) -> Value {
    let Preserves {
        energy,
        casimirs,
        quadratic_casimirs,
        orbit,
        poisson,
        constant_poisson,
        quadratic_invariants,
        linear_invariants,
    } = method.preserves;
    let options: serde_json::Map<String, Value> = method
        .options()
        .into_iter()
        .map(|(name, default)| (name.to_owned(), default.into()))
        .collect();
    json!({
        "id": method.id,
        "title": method.title,
        "order": method.order,
        "symmetric": method.symmetric,
        "explicit": method.explicit,
        "preserves": {
            "energy": energy,
            "casimirs": casimirs,
            "quadratic_casimirs": quadratic_casimirs,
            "orbit": orbit,
            "poisson": poisson,
            "constant_poisson": constant_poisson,
            "quadratic_invariants": quadratic_invariants,
            "linear_invariants": linear_invariants,
        },
        "needs": method.needs,
        "options": options,
        "reference": method.reference,
        "built": true,
    })
}
