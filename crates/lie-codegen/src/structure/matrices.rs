//! Representations that carry collective and isospectral methods.

use super::Structure;

/// Why a collective or isospectral method in the declared representation does not apply, with the
/// nearest one that does.
pub fn refusal(structure: &Structure, order: u32) -> Option<(String, String)> {
    let nearest = |also: &str| {
        let remedy = match order {
            2 => "use `lie-midpoint`, which works for every Lie algebra".to_owned(),
            8.. => super::lifts::nearest(structure, order),
            order => {
                format!("use `compose{order}(lie-midpoint)`, which works for every Lie algebra")
            }
        };
        format!("{remedy}{also}")
    };
    let hopf = match structure.spins.is_some() && order < 8 {
        true => format!(", or `collective{order} --lift hopf`"),
        false => String::new(),
    };
    let algebra = structure.bracket.algebra();
    if algebra.is_some_and(|algebra| algebra.extension.is_some()) {
        let reason = structure.why_not_declared_algebra();
        return reason.map(|reason| (reason, nearest("")));
    }
    if let Some((reason, remedy)) = refusal_of_functions(structure) {
        return Some((reason, nearest(&format!("{hopf}, or {remedy}"))));
    }
    match structure.bracket.representation() {
        None => {
            let reason = structure.why_not_declared_algebra().unwrap_or_else(|| {
                "it needs a matrix representation, and the algebra declares no `matrices`".into()
            });
            Some((reason, nearest(&hopf)))
        }
        Some(representation) if representation.dual.is_none() => Some((
            "it needs a representation whose closure under (abc + cba)/2 adds only matrices that \
             commute with it; the closure of the declared `matrices` adds others, and the step would \
             leave the coadjoint orbit"
                .into(),
            nearest(", or declare other matrices, such as those that define the algebra"),
        )),
        Some(_) => None,
    }
}

/// Why matrices with parameters carry no such method, and what to do with them.
pub(super) fn refusal_of_functions(structure: &Structure) -> Option<(String, String)> {
    structure.parametric_matrices("the space over which it goes")
}
