//! The sums and the Hamiltonian of a family in the arena of the model of its site.

use super::sites::SiteSums;
use super::sums;
use crate::check::environment::{Allowed, Environment};
use crate::check::has_errors;
use crate::check::lets;
use crate::check::lower::Lowering;
use crate::model::{Family, Model, SiteSum, Size};
use lie_symbolic::prove::degree;
use lie_symbolic::symbolic::{ExprId, Symbol};
use lie_syntax::ast::{self, Declaration, Name};
use lie_syntax::diagnostic::{Diagnostic, Kind};

/// Makes the model of a site that of the family; `None` if there are mistakes.
pub fn couple(
    declaration: &Declaration,
    family: &ast::Family,
    acting: &SiteSums,
    mut model: Model,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<Model> {
    let collected = &acting.collected;
    let known = Family {
        sizes: sizes(declaration, family, &model, mistakes)?,
        slots: collected.slots.clone(),
        own: collected.slot([0, 0]),
        names: collected.names.clone(),
        sums: Vec::new(),
        energy: model.hamiltonian(),
        degree: None,
        start: family.start.clone(),
    };
    model.family = Some(summed(declaration, &mut model, acting, known, mistakes)?);
    model.methods.clone_from(&declaration.methods);
    model.run.clone_from(&declaration.run);
    (!has_errors(mistakes)).then_some(model)
}

/// The sizes, which parameters or numbers give.
fn sizes(
    declaration: &Declaration,
    family: &ast::Family,
    model: &Model,
    mistakes: &mut Vec<Diagnostic>,
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
                    mistakes.push(
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
            mistakes.push(Diagnostic::new(Kind::Number, size.origin(), message).help(help));
            return None;
        }
        Some(found)
    };
    let found: Vec<Option<Size>> = family.sizes.iter().map(&mut size).collect();
    found.into_iter().collect()
}

/// The sums and H in the arena of the model.
fn summed(
    declaration: &Declaration,
    model: &mut Model,
    acting: &SiteSums,
    known: Family,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<Family> {
    let collected = &acting.collected;
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
        lets: acting.lets.clone(),
        ..declaration.clone()
    };
    let mut environment = Environment::new(&widened);
    let graph = &mut model.graph;
    lets::abbreviations(&widened, graph, &mut environment, mistakes);
    let mut lower = |expr| Lowering::new(graph, &environment, mistakes, Allowed::State).lower(expr);
    let summands: Vec<Option<ExprId>> = collected.sums.iter().map(|s| lower(&s.body)).collect();
    let energy = lower(&acting.energy);
    let first = names.len();
    let of_a_sum = |symbol: &Symbol| matches!(symbol, Symbol::Coordinate(k) if *k >= first);
    let mut sums = Vec::new();
    for (summand, sum) in summands.into_iter().zip(&collected.sums) {
        let summand = summand?;
        if graph.symbols(summand).iter().any(of_a_sum) {
            mistakes.push(sums::within(sum.origin));
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
