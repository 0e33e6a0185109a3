//! What forces, dissipation and noise add to the motion.

use super::metric::Checks;
use super::work::{Loud, Work};
use crate::model::{Acting, Driving, Family, Input};
use lie_symbolic::symbolic::Symbol;
use lie_syntax::ast::{Declaration, DissipationKind, Metric};
use lie_syntax::diagnostic::{Diagnostic, Kind};

/// What was written of a driven system.
pub struct Written<'a> {
    /// The declaration.
    pub declaration: &'a Declaration,
    /// The defaults of the parameters.
    pub defaults: &'a [f64],
    /// The family, and its inputs.
    pub sites: Option<(&'a Family, &'a [Input])>,
    /// The names of symbols.
    pub name: &'a dyn Fn(Symbol) -> String,
}

/// The force and the generator of what was declared, which is checked; `None` where something is wrong, which is reported.
pub fn motion(
    work: &mut Work<'_>,
    written: &Written<'_>,
    mut declared: Vec<Acting>,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<Driving> {
    let zero = work.graph.integer(0);
    let nothing = vec![zero; work.slopes.len()];
    let (mut force, mut damping) = (nothing.clone(), nothing.clone());
    // what noise adds to both, which is no work
    let mut noise = Loud {
        force: nothing.clone(),
        damping: nothing,
        count: 0,
    };
    let declaration = written.declaration;
    let mut dissipations = declaration.dissipation.iter();
    let (mut dissipation, mut before) = (None, None);
    let count = mistakes.len();
    for acting in &mut declared {
        let own_entry = matches!(
            acting,
            Acting::DoubleBracket(..) | Acting::Metriplectic(..) | Acting::Rayleigh(_)
        );
        if own_entry {
            dissipation = dissipations.next();
        }
        let checks = Checks {
            origin: dissipation.map_or(declaration.name.origin, |d| d.origin),
            own: work.own,
            defaults: written.defaults,
            sites: written.sites,
            name: written.name,
        };
        match acting {
            Acting::Force(place, value) => force[*place] = work.graph.add(force[*place], *value),
            Acting::Rayleigh(rows) => {
                mistakes.extend(checks.damps(work.graph, "the matrix R", rows));
                work.add_rayleigh(rows, &mut force);
            }
            Acting::DoubleBracket(strength, metric) => {
                mistakes.extend(checks.strength(work.graph, *strength));
                if let Some(rows) = metric {
                    let symmetric = checks.symmetric(work.graph, "the metric G", rows);
                    let wrong =
                        symmetric.or_else(|| checks.damps(work.graph, "the metric G", rows));
                    mistakes.extend(wrong);
                }
                work.add_double_bracket(*strength, metric.as_ref(), &mut damping);
            }
            Acting::Metriplectic(entropy, rows) => {
                let held = work.time..work.slopes.len();
                let symbols = work.graph.symbols(*entropy).into_iter();
                let mut outside = symbols.filter(
                    |symbol| matches!(symbol, Symbol::Coordinate(place) if held.contains(place)),
                );
                if outside.next().is_some() {
                    let message = "the entropy depends on the time or on an input, and would change without the motion";
                    let help = "write a function of the state and of parameters";
                    let mistake = Diagnostic::new(Kind::Dissipation, checks.origin, message);
                    mistakes.push(mistake.help(help));
                }
                let factor = matches!(
                    dissipation.map(|d| &d.kind),
                    Some(DissipationKind::Metriplectic {
                        metric: Metric::Factor(_),
                        ..
                    })
                );
                let found = work.metriplectic(*entropy, rows, factor, &checks);
                mistakes.extend(found.map(|k| *rows = k).err());
                work.add_metriplectic(*entropy, rows, &mut force);
            }
            Acting::HamiltonianNoise(function) => work.add_hamiltonian_noise(*function, &mut noise),
            Acting::ForceNoise(parts) => {
                let rate = noise.rate(work);
                for (place, value) in parts {
                    let part = work.graph.mul(*value, rate);
                    noise.force[*place] = work.graph.add(noise.force[*place], part);
                }
            }
            Acting::Temperature(temperature) => {
                mistakes.extend(checks.temperature(work.graph, *temperature));
                let wrong = match &before {
                    Some(Acting::DoubleBracket(strength, metric)) => work.warm(
                        &checks,
                        (*temperature, Some(*strength)),
                        metric.as_ref(),
                        &mut noise,
                    ),
                    Some(Acting::Rayleigh(rows)) => {
                        work.warm(&checks, (*temperature, None), Some(rows), &mut noise)
                    }
                    _ => None,
                };
                mistakes.extend(wrong);
            }
        }
        before = Some(acting.clone());
    }
    if mistakes.len() > count {
        return None;
    }
    let power = work.power(&force);
    damping[work.time] = work.graph.add(damping[work.time], power);
    for (sum, part) in force.iter_mut().zip(&noise.force) {
        *sum = work.graph.add(*sum, *part);
    }
    for (sum, part) in damping.iter_mut().zip(&noise.damping) {
        *sum = work.graph.add(*sum, *part);
    }
    Some(Driving {
        force,
        damping,
        declared,
        noises: noise.count,
    })
}
