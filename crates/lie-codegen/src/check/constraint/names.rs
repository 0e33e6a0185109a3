//! The names of what a constraint leaves.

use super::forms::Distribution;
use crate::check::casimirs;
use lie_symbolic::exact::{Fraction, Rational};
use lie_syntax::ast::{Declaration, Name};

/// The names of the reduced coordinates: that of the declared coordinate where the element of D is one of the basis, and else that
/// name with `_D`, for the momentum of the same velocity on D.
pub fn reduced(declaration: &Declaration, distribution: &Distribution) -> Vec<Name> {
    let mut taken = casimirs::taken(declaration);
    taken.extend(declaration.energy.velocity().iter().map(|n| n.text.clone()));
    let name = |(place, index): (usize, &usize)| {
        let declared = &declaration.state[*index];
        let mut ratios = distribution.ratios.iter();
        if ratios.all(|row| row[place].is_zero()) {
            return declared.clone();
        }
        let mut text = format!("{}_D", declared.text);
        while taken.contains(&text) {
            text.push('_');
        }
        Name {
            text,
            origin: declared.origin,
        }
    };
    distribution.free.iter().enumerate().map(name).collect()
}

/// The reduced equations as text: `e3 = 0`, `e1 + 2*e2 = 0`.
pub fn forms(declaration: &Declaration, distribution: &Distribution) -> Vec<String> {
    let components = components(declaration);
    let equations = distribution.pivots.iter().zip(&distribution.ratios);
    let text = |(pivot, row): (&usize, &Vec<Fraction>)| {
        let free = distribution.free.iter().zip(row);
        let free = free.map(|(index, ratio)| (&components[*index], ratio));
        let one = Fraction::from(Rational::ONE);
        let all: Vec<_> = std::iter::once((&components[*pivot], &one))
            .chain(free)
            .collect();
        equation(declaration, &all)
    };
    equations.map(text).collect()
}

/// The equations as they were declared, as text.
pub fn declared(declaration: &Declaration, distribution: &Distribution) -> Vec<String> {
    let components = components(declaration);
    let text = |row: &Vec<Fraction>| {
        let terms: Vec<_> = components.iter().zip(row).collect();
        equation(declaration, &terms)
    };
    distribution.declared.iter().map(text).collect()
}

/// `a*e1 + b*e2 = 0` of the terms that are not zero.
fn equation(declaration: &Declaration, terms: &[(&String, &Fraction)]) -> String {
    let parameter = |p: usize| declaration.parameters[p].name.text.clone();
    let mut text = String::new();
    for (name, factor) in terms.iter().filter(|(_, factor)| !factor.is_zero()) {
        let constant = factor.as_constant();
        let negative = constant.as_ref().is_some_and(|c| c.is_negative());
        let size = if negative {
            factor.neg()
        } else {
            (*factor).clone()
        };
        let shown = size.display(&parameter);
        let product = match size.as_constant() {
            Some(one) if one.is_one() => (*name).clone(),
            Some(_) => format!("{shown}*{name}"),
            None if shown.contains([' ', '+', '-', '/']) => format!("({shown})*{name}"),
            None => format!("{shown}*{name}"),
        };
        text = match (text.is_empty(), negative) {
            (true, false) => product,
            (true, true) => format!("-{product}"),
            (false, false) => format!("{text} + {product}"),
            (false, true) => format!("{text} - {product}"),
        };
    }
    text + " = 0"
}

/// The names of the components of the velocity: its own, or those of the basis.
pub fn components(declaration: &Declaration) -> Vec<String> {
    let names = match declaration.energy.velocity() {
        [] => declaration.basis(),
        velocity => velocity,
    };
    names.iter().map(|name| name.text.clone()).collect()
}
