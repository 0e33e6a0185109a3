//! What acts on a site of a family: functions of its coordinates, of those of sites near by, and of dH/dmu at the site, which other sites
//! have their part in.

use super::sums;
use crate::check::driving::held;
use crate::check::driving::motion::{Written, motion as composed};
use crate::check::driving::work::Work;
use crate::model::{Acting, Driving, Family, Model, PoissonMatrix, slope_symbol};
use lie_symbolic::symbolic::{ExprId, Symbol};
use lie_syntax::ast::{Declaration, Noise};
use lie_syntax::diagnostic::{Diagnostic, Kind};

/// The force and the generator at a site, in the coordinates of its slot and in `dH/dmu` there ([`slope_symbol`]); the last component of
/// the generator is the power.
pub fn motion(
    declaration: &Declaration,
    model: &mut Model,
    family: &Family,
    mut declared: Vec<Acting>,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<Driving> {
    let n = model.dimension();
    let own = family.own * n..(family.own + 1) * n;
    let defaults = model.defaults();
    let inputs = held::inputs(declaration);
    let mut graph = model.graph.clone();
    if let Some(mistake) = far(declaration, &graph, family, &declared, n) {
        mistakes.push(mistake);
        return None;
    }
    // places count from the first coordinate of the site
    for acting in &mut declared {
        match acting {
            Acting::Force(place, _) => *place -= own.start,
            Acting::ForceNoise(parts) => parts.iter_mut().for_each(|part| part.0 -= own.start),
            _ => {}
        }
    }
    let brackets = model.bracket.entries(&mut graph);
    let values: Vec<ExprId> = brackets.iter().map(|(.., value)| *value).collect();
    let values = family.at_own(&mut graph, &values, n);
    let places = brackets.iter().map(|(i, j, _)| (*i, *j)).zip(values);
    let slopes = (0..n).map(|k| graph.symbol(slope_symbol(k)));
    let mut slopes: Vec<ExprId> = slopes.collect();
    slopes.push(graph.integer(0));
    let name = |symbol| match symbol {
        Symbol::Coordinate(place) if place < family.names.len() => family.names[place].clone(),
        symbol => model.symbol_name(symbol),
    };
    let mut work = Work {
        own: n,
        first: own.start,
        time: n,
        slopes,
        matrix: PoissonMatrix {
            dimension: n,
            entries: places.map(|((i, j), value)| (i, j, value)).collect(),
            degree: None,
        },
        rate: &|process| family.rate_symbol(process),
        graph: &mut graph,
    };
    let written = Written {
        declaration,
        defaults: &defaults,
        sites: Some((family, &inputs)),
        name: &name,
    };
    let driving = composed(&mut work, &written, declared, mistakes);
    model.graph = graph;
    driving
}

/// What depends on sums over all sites, and the noise of a site along a function of others.
fn far(
    declaration: &Declaration,
    graph: &lie_symbolic::symbolic::Graph,
    family: &Family,
    declared: &[Acting],
    n: usize,
) -> Option<Diagnostic> {
    let own = family.own * n..(family.own + 1) * n;
    let outside = |value: &ExprId, within: std::ops::Range<usize>| {
        let symbols = graph.symbols(*value).into_iter();
        let mut coordinates = symbols.filter_map(|symbol| match symbol {
            Symbol::Coordinate(place) => Some(place),
            _ => None,
        });
        coordinates.any(|place| !within.contains(&place))
    };
    let near = 0..family.names.len();
    let place = declaration.place_of_driving();
    let place = place.unwrap_or(declaration.name.origin);
    declared.iter().find_map(|acting| match acting {
        Acting::Force(_, value) => outside(value, near.clone()).then(|| sums::far(place)),
        Acting::ForceNoise(parts) => {
            let mut parts = parts.iter();
            parts
                .any(|(_, value)| outside(value, near.clone()))
                .then(|| sums::far(place))
        }
        Acting::HamiltonianNoise(function) if outside(function, own.clone()) => {
            let noise = declaration.noise.iter().find_map(|noise| match noise {
                Noise::Hamiltonian(value) => Some(value.origin),
                Noise::Force(_) => None,
            });
            let message = "the Hamiltonian of a noise depends on other sites, and each site has a Wiener process of its own";
            let help = "write a function of the coordinates of the site, such as `sigma*z[i]`";
            let mistake = Diagnostic::new(Kind::Dissipation, noise.unwrap_or(place), message);
            Some(mistake.help(help))
        }
        _ => None,
    })
}
