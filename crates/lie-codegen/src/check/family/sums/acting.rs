//! What acts on a site, and depends on sites near by.

use std::collections::BTreeSet;

use super::{Reading, Sums, mapped, named};
use lie_core::lattice::AXES;
use lie_syntax::ast::{Expr, ExprKind};
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin};

/// The answer to a sum in what acts on a site.
pub fn far(origin: Origin) -> Diagnostic {
    let message =
        "what acts on a site depends on it and on sites near by, and this is a sum over sites";
    let help = "couple all sites in the Hamiltonian; a force at a site may depend on its neighbours, as in `-k*(x[i] - x[i+1])`";
    Diagnostic::new(Kind::Syntax, origin, message).help(help)
}

impl Sums<'_> {
    /// The name of a coordinate of the site on which something acts.
    pub fn own(&self, name: &str) -> String {
        named(name, &self.indices(), [0; AXES])
    }

    /// An expression of what acts on a site, its coordinates under the names of their slots.
    pub fn acting(&mut self, expr: &Expr, mistakes: &mut Vec<Diagnostic>) -> Option<Expr> {
        let mut reading = Reading {
            variables: self.family.indices.iter().collect(),
            spans: vec![None; self.family.indices.len()],
            sites: BTreeSet::new(),
            moving: BTreeSet::new(),
            data: BTreeSet::new(),
        };
        let expr = mapped(expr, &mut |part| match &part.kind {
            ExprKind::IndexedSum { .. } => {
                mistakes.push(far(part.origin));
                None
            }
            _ => self.at_site(part, &mut reading, mistakes),
        });
        self.acting.sites.extend(reading.moving);
        self.acting.data.extend(reading.data);
        expr
    }
}
