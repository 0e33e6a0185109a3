//! The names of the Casimirs, and which of them are kept.

use std::collections::HashSet;

use super::casimirs::Candidate;
use crate::model::{Casimir, CasimirKind};
use lie_symbolic::prove::branches;
use lie_symbolic::prove::independence::{self, Standing};
use lie_symbolic::symbolic::{ExprId, Graph};
use lie_syntax::ast::Declaration;
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin, Report};

/// The Casimirs with names: unnamed ones are C1, C2, …, skipping what is taken.
pub fn named(declaration: &Declaration, lowered: &[ExprId]) -> Vec<Candidate> {
    let mut free = free_names(declaration);
    let casimirs = declaration.casimirs.iter().zip(lowered);
    casimirs
        .map(|(casimir, expr)| {
            let name = casimir
                .name
                .as_ref()
                .map(|n| n.text.clone())
                .or_else(|| free.next())
                .unwrap_or_default();
            Candidate {
                name,
                origin: casimir.value.origin,
                expr: *expr,
            }
        })
        .collect()
}

/// C1, C2, … without the names that a declaration uses.
fn free_names(declaration: &Declaration) -> impl Iterator<Item = String> + use<> {
    let taken = taken(declaration);
    (1..)
        .map(|i| format!("C{i}"))
        .filter(move |name| !taken.contains(name))
}

/// The names that a declaration uses.
pub fn taken(declaration: &Declaration) -> HashSet<String> {
    let names = declaration
        .state
        .iter()
        .chain(declaration.basis())
        .chain(declaration.lets.iter().map(|(n, _)| n));
    let names = names.chain(declaration.parameters.iter().map(|p| &p.name));
    let names = names.chain(declaration.casimirs.iter().filter_map(|c| c.name.as_ref()));
    names.map(|n| n.text.clone()).collect()
}

/// Leaves out, with a warning, what depends on earlier Casimirs; the unnamed rest is numbered anew.
pub fn independent(
    declaration: &Declaration,
    graph: &Graph,
    candidates: Vec<Candidate>,
    degrees: &[Option<u32>],
    report: &mut Report,
) -> Vec<Casimir> {
    let functions: Vec<ExprId> = candidates.iter().map(|c| c.expr).collect();
    let standings = independence::standings(graph, &functions, declaration.dimension());
    let mut free = free_names(declaration);
    let mut kept = Vec::new();
    for (((candidate, standing), degree), declared) in candidates
        .into_iter()
        .zip(standings)
        .zip(degrees)
        .zip(&declaration.casimirs)
    {
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
                    report.push(multivalued_casimir(&name, candidate.origin));
                }
                kept.push(Casimir {
                    name,
                    origin: candidate.origin,
                    expr: candidate.expr,
                    degree: *degree,
                    multivalued,
                    kind: CasimirKind::Declared,
                    written: None,
                });
                continue;
            }
            Standing::Dependent => "depends on the Casimirs before it",
            Standing::Constant => "does not depend on the state",
        };
        report.push(
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
