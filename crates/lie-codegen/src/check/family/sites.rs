//! A family as one site, on which nothing acts, and the sums that act on it.

use super::parts::on_site;
use super::sums::{Collected, Sums};
use lie_symbolic::exact::Rational;
use lie_syntax::ast::{
    Casimir, Declaration, Dissipation, Energy, Expr, ExprKind, Family, Name, Noise, Observable,
};
use lie_syntax::diagnostic::Diagnostic;

/// What acts on the sites of a family.
pub struct SiteSums {
    /// The abbreviations, with names for sums.
    pub lets: Vec<(Name, Expr)>,
    /// The Hamiltonian, with names for sums.
    pub energy: Expr,
    /// The observables, with names for sums.
    pub observables: Vec<Observable>,
    /// The sums.
    pub collected: Collected,
    /// What acts on a site beside the Hamiltonian, its coordinates under the names of their slots.
    pub acting: Beside,
}

/// Forces, dissipation and noise at a site.
pub struct Beside {
    pub forces: Vec<(Name, Expr)>,
    pub dissipation: Vec<Dissipation>,
    pub noise: Vec<Noise>,
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
    let observables = declaration.observables.iter().filter_map(|observable| {
        Some(Observable {
            value: sums.outside(&observable.value, mistakes)?,
            ..observable.clone()
        })
    });
    let observables = observables.collect();
    let acting = beside(declaration, &mut sums, mistakes);
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
        forces: Vec::new(),
        dissipation: Vec::new(),
        noise: Vec::new(),
        inputs: Vec::new(),
        observables: Vec::new(),
        lets: Vec::new(),
        methods: Vec::new(),
        run: Vec::new(),
        initial: None,
        ..declaration.clone()
    };
    let sums = SiteSums {
        lets,
        energy: energy.filter(|_| mistakes.is_empty())?,
        observables,
        collected,
        acting,
    };
    Some((site, sums))
}

/// What acts on a site.
fn beside(
    declaration: &Declaration,
    sums: &mut Sums<'_>,
    mistakes: &mut Vec<Diagnostic>,
) -> Beside {
    let forces = at_site(&declaration.forces, sums, mistakes);
    let noise = declaration.noise.iter().filter_map(|noise| match noise {
        Noise::Hamiltonian(value) => Some(Noise::Hamiltonian(sums.acting(value, mistakes)?)),
        Noise::Force(parts) => Some(Noise::Force(at_site(parts, sums, mistakes))),
    });
    let noise = noise.collect();
    let dissipation = declaration.dissipation.iter();
    let dissipation = dissipation
        .filter_map(|entry| entry.mapped(&mut |value| sums.acting(value, mistakes)))
        .collect();
    Beside {
        forces,
        dissipation,
        noise,
    }
}

/// Forces on coordinates, at a site.
fn at_site(
    parts: &[(Name, Expr)],
    sums: &mut Sums<'_>,
    mistakes: &mut Vec<Diagnostic>,
) -> Vec<(Name, Expr)> {
    let part = |(name, value): &(Name, Expr)| {
        let name = Name {
            text: sums.own(&name.text),
            origin: name.origin,
        };
        Some((name, sums.acting(value, mistakes)?))
    };
    parts.iter().filter_map(part).collect()
}
