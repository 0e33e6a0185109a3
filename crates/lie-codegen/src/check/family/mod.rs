//! Families `A^N`: the algebra, its Casimirs and its rank are those of one site and checked as such; the Hamiltonian is a
//! function of sums over the sites, whose summands depend on a site and on neighbours at fixed distances.

mod bounds;
mod sums;

use super::environment::{Allowed, Environment};
use super::lower::Lowering;
use super::{lets, names, size, system};
use crate::model::{Family, Model, SiteSum, Size};
use lie_symbolic::exact::Rational;
use lie_symbolic::prove::degree;
use lie_symbolic::symbolic::{ExprId, Symbol};
use lie_syntax::ast::{self, Casimir, Declaration, Energy, Expr, ExprKind, Name, Structure};
use lie_syntax::diagnostic::{Diagnostic, Kind, Report};
use sums::{Collected, Sums};

/// Checks a family; `None` if any error was reported.
pub fn check(
    declaration: &Declaration,
    family: &ast::Family,
    report: &mut Report,
) -> Option<Model> {
    let before = report.has_errors();
    possible(declaration, family, report);
    names::check(declaration, report);
    if report.has_errors() != before || !size::check(declaration, report) {
        return None;
    }
    let mut sums = Sums::of(declaration, family);
    let lets: Vec<(Name, Expr)> = declaration
        .lets
        .iter()
        .filter_map(|(name, value)| Some((name.clone(), sums.outside(value, report)?)))
        .collect();
    let energy = sums.outside(declaration.energy.expression(), report);
    let collected = sums.collected();
    let site = site(declaration, family, report);
    if report.has_errors() {
        return None;
    }
    let mut model = system::check(&site, None, report)?;
    let sizes = sizes(declaration, family, &model, report);
    let known = Family {
        sizes: sizes?,
        slots: collected.slots.clone(),
        own: collected.slot([0, 0]),
        names: collected.names(declaration),
        sums: Vec::new(),
        energy: model.hamiltonian(),
        degree: None,
        start: family.start.clone(),
    };
    let family = lowered(
        declaration,
        &mut model,
        (&lets, &energy?),
        &collected,
        known,
        report,
    )?;
    model.methods.clone_from(&declaration.methods);
    model.run.clone_from(&declaration.run);
    model.family = Some(family);
    (!report.has_errors()).then_some(model)
}

/// Reports what a family cannot have.
fn possible(declaration: &Declaration, family: &ast::Family, report: &mut Report) {
    let mut refuse = |place, message: &str, help: &str| {
        report.push(Diagnostic::new(Kind::Schema, place, message).help(help));
    };
    match &declaration.structure {
        Structure::Lie { cocycle, .. } if cocycle.is_empty() => {}
        Structure::Lie { .. } | Structure::General { .. } => refuse(
            declaration.place(),
            "a family consists of copies of a Lie algebra, without other brackets",
            "write `algebra` alone, such as `so(3)^N`",
        ),
    }
    if !matches!(declaration.energy, Energy::Hamiltonian(_)) {
        let place = declaration.energy.expression().origin;
        let help = "write `hamiltonian`, a function of sums such as `sum(i in 0..N: x[i]*x[i+1])`";
        refuse(place, "a family is given by its Hamiltonian", help);
    }
    if let Some(name) = &declaration.group {
        let message = "the group element of a family is not followed";
        refuse(name.origin, message, "remove `group`");
    }
    if let Some(realization) = &declaration.realization {
        let message = "a family takes no realization";
        refuse(realization.origin, message, "remove `realization`");
    }
    if family.sizes.len() != family.indices.len() {
        let (sizes, indices) = (family.sizes.len(), family.indices.len());
        let message = format!("{indices} in the names of the state, and {sizes} in the algebra");
        let message = format!("the numbers of indices differ: {message}");
        let help = "write `so(3)^N` with `x[i]`, or `so(3)^(N, M)` with `x[i, j]`";
        refuse(declaration.place(), &message, help);
    }
}

/// The declaration of one site, on which nothing acts.
fn site(declaration: &Declaration, family: &ast::Family, report: &mut Report) -> Declaration {
    let zero = Expr {
        kind: ExprKind::Number(Rational::ZERO),
        origin: declaration.energy.expression().origin,
    };
    let casimirs = declaration.casimirs.iter().filter_map(|casimir| {
        Some(Casimir {
            name: casimir.name.clone(),
            value: sums::on_site(&casimir.value, family, report)?,
        })
    });
    Declaration {
        casimirs: casimirs.collect(),
        energy: Energy::Hamiltonian(zero),
        family: None,
        lets: Vec::new(),
        methods: Vec::new(),
        run: Vec::new(),
        initial: None,
        ..declaration.clone()
    }
}

/// The sizes, which parameters or numbers give.
fn sizes(
    declaration: &Declaration,
    family: &ast::Family,
    model: &Model,
    report: &mut Report,
) -> Option<Vec<Size>> {
    let mut size = |size: &ast::Size| {
        let found = match size {
            ast::Size::Number(count, _) => Size::Number(*count),
            ast::Size::Parameter(name) => {
                let mut parameters = declaration.parameters.iter();
                let Some(p) = parameters.position(|p| p.name.text == name.text) else {
                    let message = format!("the number of sites `{}` is not declared", name.text);
                    let help = format!(
                        "declare it as a parameter: `\"parameters\": {{\"{}\": 1000}}`",
                        name.text
                    );
                    report.push(
                        Diagnostic::new(Kind::UnknownSymbol, name.origin, message).help(help),
                    );
                    return None;
                };
                Size::Parameter(p)
            }
        };
        if found.value(&model.defaults()).is_none() {
            let message = "the number of sites is a whole number from 1 to 2147483648";
            let help = "write such a number, or give the parameter one";
            report.push(Diagnostic::new(Kind::Number, size.origin(), message).help(help));
            return None;
        }
        Some(found)
    };
    let found: Vec<Option<Size>> = family.sizes.iter().map(&mut size).collect();
    found.into_iter().collect()
}

/// The sums and H in the arena of the model.
fn lowered(
    declaration: &Declaration,
    model: &mut Model,
    (lets, energy): (&[(Name, Expr)], &Expr),
    collected: &Collected,
    known: Family,
    report: &mut Report,
) -> Option<Family> {
    let names = &known.names;
    let totals = (0..collected.sums.len()).map(sums::total);
    let place = declaration.name.origin;
    let all = names.iter().cloned().chain(totals);
    let widened = Declaration {
        state: all
            .map(|text| Name {
                text,
                origin: place,
            })
            .collect(),
        lets: lets.to_vec(),
        ..declaration.clone()
    };
    let mut environment = Environment::new(&widened);
    let graph = &mut model.graph;
    lets::check(&widened, graph, &mut environment, report);
    let mut lower = |expr| Lowering::new(graph, &environment, report, Allowed::State).lower(expr);
    let summands: Vec<Option<ExprId>> = collected.sums.iter().map(|s| lower(&s.body)).collect();
    let energy = lower(energy);
    let first = names.len();
    let of_a_sum = |symbol: &Symbol| matches!(symbol, Symbol::Coordinate(k) if *k >= first);
    let mut sums = Vec::new();
    for (summand, sum) in summands.into_iter().zip(&collected.sums) {
        let summand = summand?;
        if graph.symbols(summand).iter().any(of_a_sum) {
            report.push(sums::within(sum.origin));
            return None;
        }
        sums.push(SiteSum {
            summand,
            slots: sum.sites.iter().map(|o| collected.slot(*o)).collect(),
            spans: sum.spans,
        });
    }
    let energy = energy?;
    let mut of_summands = sums.iter().map(|s| degree::degree(graph, s.summand));
    let inner = of_summands.try_fold(0, |most: u32, degree| Some(most.max(degree?)));
    let outer = degree::degree(graph, energy);
    Some(Family {
        sums,
        energy,
        degree: outer.zip(inner).map(|(outer, inner)| outer * inner),
        ..known
    })
}
