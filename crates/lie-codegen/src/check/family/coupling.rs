//! The sums and the Hamiltonian of a family in the arena of the model of its site.

use super::acting;
use super::shared;
use super::sites::SiteSums;
use super::sums::{self, Collected};
use crate::check::configuration::uses_time;
use crate::check::driving::{self, held};
use crate::check::environment::{Allowed, Environment};
use crate::check::has_errors;
use crate::check::lets;
use crate::check::lower::Lowering;
use crate::model::{
    self, Driving, Family, Model, Quantity, QuantityKind, SiteData, SiteSum, Size, data_symbol,
    shared_symbol,
};
use lie_core::family::STATISTICS;
use lie_core::lattice::{self, AXES, last_axes};
use lie_symbolic::prove::{branches, degree};
use lie_symbolic::symbolic::{Graph, Symbol};
use lie_syntax::ast::{self, BONDS, Declaration, Expr, Name, SiteValues};
use lie_syntax::diagnostic::{Diagnostic, Kind};

/// Makes the model of a site that of the family; `None` if there are mistakes.
pub fn couple(
    declaration: &Declaration,
    family: &ast::Family,
    of_site: &SiteSums,
    mut model: Model,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<Model> {
    let collected = &of_site.collected;
    let mut data = data(family, collected, &model, mistakes)?;
    let mut data_names = collected.data.clone();
    if let Some(given) = &family.bonds {
        let count = sizes(declaration, family, &model, mistakes)?;
        let count = count.first().and_then(|size| size.value(&model.defaults()));
        data.push(bonds(given, count.unwrap_or(1), mistakes)?);
        let names = declaration.state.iter();
        data_names.extend(names.map(|name| format!("{}[j]", name.text)));
        data_names.push("value".to_owned());
    }
    let known = Family {
        sizes: sizes(declaration, family, &model, mistakes)?,
        slots: collected.slots.clone(),
        own: collected.slot([0; AXES]),
        names: collected.names.clone(),
        data,
        has_bonds: family.bonds.is_some(),
        timed: uses_time(declaration) || declaration.is_driven(),
        shared: shared::names(declaration, mistakes),
        data_places: collected.data_places.clone(),
        data_names,
        sums: Vec::new(),
        energy: model.hamiltonian(),
        time_slope: None,
        degree: None,
        start: family.start.clone(),
    };
    let (coupled, driving, observables) =
        summed(declaration, &mut model, of_site, known, mistakes)?;
    // what is carried beside the sites has no symbol in their functions
    let none = model.graph.integer(0);
    let work = driving
        .as_ref()
        .map(|_| Quantity::work(declaration.name.origin, none));
    let inputs = shared::recorded(declaration, &mut model.graph);
    let recorded = observables.into_iter().chain(inputs);
    model.quantities = work.into_iter().chain(recorded).collect();
    model.inputs = held::inputs(declaration);
    for quantity in &model.quantities {
        // a Casimir of a site has columns of its own
        let of_casimir = STATISTICS
            .iter()
            .find_map(|what| quantity.name.strip_suffix(what)?.strip_suffix('_'));
        let Some(casimir) = of_casimir else { continue };
        if model
            .declared_casimirs
            .iter()
            .any(|known| known.name == casimir)
        {
            let message = format!("`{}` is a column of the Casimir {casimir}", quantity.name);
            let mistake = Diagnostic::new(Kind::DuplicateName, quantity.origin, message);
            mistakes.push(mistake.help("choose another name"));
        }
        model.taken.insert(casimir.to_owned());
    }
    (model.family, model.driving) = (Some(coupled), driving);
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
                    let mut data = family.data.iter();
                    let message = match data.any(|data| data.name.text == name.text) {
                        true => format!("the number of sites `{}` is a list", name.text),
                        false => format!("the number of sites `{}` is not declared", name.text),
                    };
                    let help = format!(
                        "declare it as a number: `\"parameters\": {{\"{}\": 1000}}`",
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

/// The numbers of a list, or of a file.
fn numbers(data: &ast::SiteData, mistakes: &mut Vec<Diagnostic>) -> Option<Vec<f64>> {
    let name = &data.name.text;
    let values: Vec<f64> = match &data.values {
        SiteValues::Read(values) => values.clone(),
        SiteValues::Written(entries) => {
            let mut graph = Graph::default();
            let environment = Environment::default();
            let lowered = entries.iter().map(|entry| {
                let value = Lowering::new(&mut graph, &environment, mistakes, Allowed::Constants)
                    .lower(entry)?;
                Some(graph.evaluate(value, &|_| f64::NAN))
            });
            lowered
                .collect::<Vec<_>>()
                .into_iter()
                .collect::<Option<_>>()?
        }
    };
    if let Some(at) = values.iter().position(|value| !value.is_finite()) {
        let message = format!("value {at} of `{name}` is not finite in double precision");
        let help = "give each site a finite number";
        mistakes.push(Diagnostic::new(Kind::Number, data.origin, message).help(help));
        return None;
    }
    Some(values)
}

/// The bonds, between sites that there are at the default size.
fn bonds(data: &ast::SiteData, count: usize, mistakes: &mut Vec<Diagnostic>) -> Option<SiteData> {
    let values = numbers(data, mistakes)?;
    if let Some(fault) = model::wrong_bond(&values, count) {
        let mistake = Diagnostic::new(Kind::Domain, data.origin, fault);
        mistakes.push(mistake.help("sites count from 0 to N-1; give a bond two of them"));
        return None;
    }
    Some(SiteData {
        name: BONDS.to_owned(),
        values: values.into(),
        sizes: None,
        unused: 0,
        unit: None,
        description: Some("The bonds: two sites and a value of each".to_owned()),
    })
}

/// The most values, with those that are left out.
const MOST_VALUES: usize = 1 << 31;

/// The values of what differs from site to site, as many as there are sites at the default sizes.
fn data(
    family: &ast::Family,
    collected: &Collected,
    model: &Model,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<Vec<SiteData>> {
    let defaults = model.defaults();
    let along = |size: &ast::Size| match size {
        ast::Size::Number(count, _) => Some(*count),
        ast::Size::Parameter(name) => {
            let mut parameters = model.parameters.iter();
            let p = parameters.position(|p| p.name == name.text)?;
            Size::Parameter(p).value(&defaults)
        }
    };
    let sizes: Vec<usize> = family.sizes.iter().filter_map(along).collect();
    let all = family.data.iter().zip(&collected.unused);
    let all = all.map(|(data, unused)| {
        let name = &data.name.text;
        let values = numbers(data, mistakes)?;
        let unused_along = &unused[AXES - sizes.len()..];
        // a column or a row of numbers is a list
        let mut shape: Vec<usize> = match data.shape.as_slice() {
            [] => vec![values.len()],
            [1, _] | [_, 1] if sizes.len() == 1 => vec![values.len()],
            shape => shape.to_vec(),
        };
        let all = last_axes(&sizes, 1).map_or(usize::MAX, lattice::count);
        match (shape.as_slice(), sizes.as_slice()) {
            ([_], [_, _, ..]) if values.len() == all => shape.clone_from(&sizes),
            // the rows of one layer after those of another
            ([lines, width], [_, rows, _]) if lines.is_multiple_of(*rows) => {
                shape = vec![lines / rows, *rows, *width];
            }
            _ => {}
        }
        let fits = |(given, (size, unused)): (&usize, (&usize, &usize))| {
            given <= size && size - given <= *unused
        };
        let fits = (shape.len() == sizes.len() && all <= MOST_VALUES)
            && shape.iter().zip(sizes.iter().zip(unused_along)).all(fits);
        if !fits {
            let shown = |sizes: &[usize]| {
                let sizes: Vec<String> = sizes.iter().map(usize::to_string).collect();
                sizes.join(" x ")
            };
            let (given, wanted) = (shown(&shape), shown(&sizes));
            let message = format!("`{name}` has {given} values, and there are {wanted} sites");
            let help = match unused_along.iter().any(|unused| *unused > 0) {
                true => "give a value for each site; those at the end that no sum asks for may be left out",
                false => "give a value for each site, or another number of sites",
            };
            mistakes.push(Diagnostic::new(Kind::StateLength, data.origin, message).help(help));
            return None;
        }
        // of a lattice the values that are left out are filled in while it is known where they are
        let along_axes = last_axes(&sizes, 1).filter(|_| sizes.len() > 1);
        let values = match (along_axes, last_axes(&shape, 1)) {
            (Some(sizes), Some(shape)) => {
                let value = |at: usize| {
                    let site = lattice::site(at, sizes);
                    match (0..AXES).all(|axis| site[axis] < shape[axis]) {
                        true => values[lattice::place(site, [0; AXES], shape)],
                        false => 0.0,
                    }
                };
                (0..all).map(value).collect()
            }
            _ => values,
        };
        Some(SiteData {
            name: name.clone(),
            values: values.into(),
            sizes: along_axes,
            unused: unused[AXES - 1],
            unit: data.unit.clone(),
            description: data.description.clone(),
        })
    });
    all.collect::<Vec<_>>().into_iter().collect()
}

/// The sums and H in the arena of the model.
fn summed(
    declaration: &Declaration,
    model: &mut Model,
    of_site: &SiteSums,
    known: Family,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<(Family, Option<Driving>, Vec<Quantity>)> {
    let collected = &of_site.collected;
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
        lets: of_site.lets.clone(),
        forces: of_site.acting.forces.clone(),
        dissipation: of_site.acting.dissipation.clone(),
        noise: of_site.acting.noise.clone(),
        ..declaration.clone()
    };
    let mut environment = Environment::new(&widened);
    for (number, name) in collected.data.iter().enumerate() {
        environment.bind_symbol(name, data_symbol(number));
    }
    for (number, name) in known.shared.iter().enumerate() {
        environment.bind_symbol(name, shared_symbol(number));
    }
    if known.has_bonds {
        for (place, name) in collected.other.iter().enumerate() {
            environment.bind_symbol(name, known.bond_symbol(place));
        }
    }
    let graph = &mut model.graph;
    lets::abbreviations(&widened, graph, &mut environment, mistakes);
    let mut lower =
        |expr: &Expr, allowed| Lowering::new(graph, &environment, mistakes, allowed).lower(expr);
    let summands = collected.sums.iter();
    let summands: Vec<_> = summands.map(|s| lower(&s.body, Allowed::Site)).collect();
    let energy = lower(&of_site.energy, Allowed::State);
    let observables: Vec<_> = (of_site.observables.iter())
        .map(|observable| Some((observable, lower(&observable.value, Allowed::State)?)))
        .collect();
    let beside = driving::acting(&widened, Allowed::Site, &mut lower);
    let first = names.len();
    let of_a_sum = |symbol: &Symbol| matches!(symbol, Symbol::Coordinate(k) if *k >= first);
    let energy = energy?;
    let in_energy = graph.symbols(energy);
    let mut sums = Vec::new();
    for (k, (summand, sum)) in summands.into_iter().zip(&collected.sums).enumerate() {
        let (summand, moves) = (summand?, in_energy.contains(&Symbol::Coordinate(first + k)));
        if graph.symbols(summand).iter().any(of_a_sum) {
            mistakes.push(sums::within(sum.origin));
            return None;
        }
        sums.push(SiteSum {
            summand,
            slots: match moves {
                true => sum.moving.iter().map(|o| collected.slot(*o)).collect(),
                false => Vec::new(),
            },
            spans: sum.spans,
            over_bonds: sum.over_bonds,
            moves,
        });
    }
    let observables: Option<Vec<_>> = observables.into_iter().collect();
    let observables = observables?.into_iter().map(|(observable, expr)| Quantity {
        name: observable.name.text.clone(),
        origin: observable.value.origin,
        expr,
        kind: QuantityKind::Observable,
        unwrap: observable.unwrap,
        multivalued: branches::jumps(graph, expr),
    });
    let observables = observables.collect();
    let driving = match widened.is_driven() {
        true => Some(acting::motion(&widened, model, &known, beside?, mistakes)?),
        false => None,
    };
    let graph = &mut model.graph;
    let time_slope = shared::time_slope(graph, energy, first, &mut sums);
    let moving = sums.iter().filter(|sum| sum.moves);
    let mut of_summands = moving.map(|s| degree::degree(graph, s.summand));
    let inner = of_summands.try_fold(0, |most: u32, degree| Some(most.max(degree?)));
    let outer = degree::degree(graph, energy);
    let degree = outer.zip(inner).map(|(outer, inner)| outer * inner);
    let family = Family {
        sums,
        energy,
        time_slope,
        // with the time among the coordinates it is no polynomial of a degree that somebody asks for
        degree: degree.filter(|_| time_slope.is_none()),
        ..known
    };
    Some((family, driving, observables))
}
