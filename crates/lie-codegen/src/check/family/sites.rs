//! A family as one site, on which nothing acts, and the sums that act on it.

use super::parts::on_site;
use super::sums::{Collected, Sums};
use lie_symbolic::exact::Rational;
use lie_syntax::ast::{Casimir, Declaration, Energy, Expr, ExprKind, Family, Name};
use lie_syntax::diagnostic::Diagnostic;

/// What acts on the sites of a family.
pub struct SiteSums {
    /// The abbreviations, with names for sums.
    pub lets: Vec<(Name, Expr)>,
    /// The Hamiltonian, with names for sums.
    pub energy: Expr,
    /// The sums.
    pub collected: Collected,
}

/// Takes a family apart into the declaration of one site and sums; `None` if there are mistakes.
pub fn sites(
    declaration: &Declaration,
    family: &Family,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<(Declaration, SiteSums)> {
    let mut sums = Sums::new(declaration, family);
    let lets = declaration
        .lets
        .iter()
        .filter_map(|(name, value)| Some((name.clone(), sums.outside(value, mistakes)?)))
        .collect();
    let energy = sums.outside(declaration.energy.expression(), mistakes);
    let collected = sums.collected();
    let zero = Expr {
        kind: ExprKind::Number(Rational::ZERO),
        origin: declaration.energy.expression().origin,
    };
    let casimirs = declaration.casimirs.iter().filter_map(|casimir| {
        Some(Casimir {
            name: casimir.name.clone(),
            value: on_site(&casimir.value, family, mistakes)?,
        })
    });
    let site = Declaration {
        casimirs: casimirs.collect(),
        energy: Energy::Hamiltonian(zero),
        family: None,
        lets: Vec::new(),
        methods: Vec::new(),
        run: Vec::new(),
        initial: None,
        ..declaration.clone()
    };
    let sums = SiteSums {
        lets,
        energy: energy.filter(|_| mistakes.is_empty())?,
        collected,
    };
    Some((site, sums))
}
