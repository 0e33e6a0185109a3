//! The catalogue of methods in words.

use lie_codegen::methods::Method;

/// What a method of the catalogue preserves, in the words of the README.
pub fn words(method: &Method) -> String {
    if method.id.starts_with("compose") {
        return "as ID".to_owned();
    }
    let kept = method.preserves;
    let words = [
        (kept.poisson, "Poisson"),
        (
            kept.constant_poisson && !kept.poisson,
            "Poisson if constant",
        ),
        (kept.orbit, "orbit"),
        (kept.energy, "energy"),
        (kept.quadratic_invariants, "quadratic invariants"),
        (
            kept.quadratic_casimirs && !kept.casimirs && !kept.quadratic_invariants,
            "quadratic Casimirs",
        ),
        (
            kept.linear_invariants && !kept.quadratic_invariants,
            "linear invariants",
        ),
    ];
    let words: Vec<&str> = words
        .into_iter()
        .filter(|(kept, _)| *kept)
        .map(|(_, word)| word)
        .collect();
    words.join(", ")
}
