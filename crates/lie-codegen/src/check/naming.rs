//! Which of the Casimirs are kept, and their names.

use super::casimirs::Candidate;
use crate::model::{Casimir, CasimirKind};
use lie_symbolic::prove::branches;
use lie_symbolic::prove::independence::{self, Standing};
use lie_symbolic::symbolic::{ExprId, Graph};
use lie_syntax::ast::Declaration;
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin};

/// Leaves out, with a warning, what depends on earlier Casimirs; the unnamed rest is numbered anew.
pub fn independent(
    declaration: &Declaration,
    graph: &Graph,
    candidates: Vec<Candidate>,
    mut free: impl Iterator<Item = String>,
    warnings: &mut Vec<Diagnostic>,
) -> Vec<Casimir> {
    let functions: Vec<ExprId> = candidates.iter().map(|c| c.expr).collect();
    let standings = independence::standings(graph, &functions, declaration.dimension());
    let mut kept = Vec::new();
    let all = candidates.into_iter().zip(standings);
    for ((candidate, standing), declared) in all.zip(&declaration.casimirs) {
        let why = match standing {
            Standing::Independent => {
                let name = declared
                    .name
                    .as_ref()
                    .map(|n| n.text.clone())
                    .or_else(|| free.next())
                    .unwrap_or(candidate.name);
                let multivalued = branches::jumps(graph, candidate.expr);
                if multivalued {
                    warnings.push(multivalued_casimir(&name, candidate.origin));
                }
                kept.push(Casimir {
                    name,
                    origin: candidate.origin,
                    expr: candidate.expr,
                    degree: None,
                    multivalued,
                    kept: true,
                    kind: CasimirKind::Declared,
                    written: None,
                });
                continue;
            }
            Standing::Dependent => "depends on the Casimirs before it",
            Standing::Constant => "does not depend on the state",
        };
        warnings.push(
            Diagnostic::new(
                Kind::Casimir,
                candidate.origin,
                format!("the Casimir `{}` {why} and is left out", candidate.name),
            )
            .help("remove it")
            .warning(),
        );
    }
    kept
}

fn multivalued_casimir(name: &str, origin: Origin) -> Diagnostic {
    let message = format!(
        "the Casimir `{name}` is multi-valued: it may jump, with an angle or between branches, although it is constant between the jumps"
    );
    Diagnostic::new(Kind::Casimir, origin, message)
        .help("its column is written, but no drift is measured; declare a function of it without jumps, such as its sine, to follow the drift")
        .warning()
}
