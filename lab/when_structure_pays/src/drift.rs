//! The drift of energy and Casimirs over decades of time, against the cost.

use crate::contest::{Entrant, Problem, Setting};
use crate::table;
use lie_plot::chart::{Axis, Chart, Panel, Series, Stroke};
use lie_runtime::{Poisson, State};

/// What one run has lost until 10^3, 10^4, … units of time.
pub struct Drift {
    setting: Setting,
    /// Seconds for a unit of time.
    cost: f64,
    energy: Vec<f64>,
    casimirs: Vec<f64>,
}

/// The spans: powers of ten.
pub struct Span {
    /// The first.
    pub first: u32,
    /// The last.
    pub last: u32,
    /// The most that a unit of time may cost, in seconds.
    pub most: f64,
    /// The same of runs that go to the last span but one alone.
    pub wide: f64,
}

/// The largest relative distance of energy and Casimirs from their first values, at looks.
pub fn drift<P: Poisson<f64>>(
    problem: &Problem<P>,
    entrant: &Entrant<P>,
    setting: Setting,
    cost: f64,
    (first, last): (u32, u32),
) -> Result<Drift, String> {
    let system = &problem.system;
    let count = system.casimir_count();
    let value = |mu: &P::State, out: &mut Vec<f64>| {
        system.casimirs(mu, out);
        system.energy(mu)
    };
    let (mut then, mut now) = (vec![0.0; count], vec![0.0; count]);
    let start = value(&problem.start, &mut then);
    let mut mu = problem.start.clone();
    let mut found = Drift {
        setting,
        cost,
        energy: Vec::new(),
        casimirs: Vec::new(),
    };
    let (mut energy, mut casimirs) = (0.0_f64, 0.0_f64);
    let mut decade = first;
    let end = 10_f64.powi(last as i32);
    (entrant.run)(problem, setting, end, &mut |time, state| {
        mu.as_mut_slice().copy_from_slice(state);
        let h = value(&mu, &mut now);
        energy = energy.max(((h - start) / start).abs());
        for (now, then) in now.iter().zip(&then) {
            casimirs = casimirs.max(((now - then) / then).abs());
        }
        if decade < last && time >= 10_f64.powi(decade as i32) * (1.0 - 1e-9) {
            found.energy.push(energy);
            found.casimirs.push(casimirs);
            decade += 1;
        }
    })?;
    found.energy.push(energy);
    found.casimirs.push(casimirs);
    Ok(found)
}

/// Every method at every accuracy that is not too dear.
pub fn measure<P: Poisson<f64>>(
    problem: &Problem<P>,
    entrants: &[Entrant<P>],
    span: &Span,
) -> Vec<Vec<Drift>> {
    let of = |entrant: &Entrant<P>| {
        let mut all: Vec<Drift> = Vec::new();
        for &setting in &entrant.settings {
            if matches!(setting, Setting::Steps(steps) if problem.delta / steps > 4.0) {
                continue;
            }
            let Ok(cost) = (entrant.cost)(problem, setting) else {
                continue;
            };
            // implicit steps that are too long are dear too
            if cost > span.wide && (!all.is_empty() || matches!(setting, Setting::Tolerance(_))) {
                break;
            }
            if cost > span.wide {
                continue;
            }
            // what is as dear as the last one but finer takes its place
            if all.last().is_some_and(|last| cost < 1.03 * last.cost) {
                all.pop();
            }
            let last = if cost > span.most {
                span.last - 1
            } else {
                span.last
            };
            match drift(problem, entrant, setting, cost, (span.first, last)) {
                Ok(found) => all.push(found),
                Err(why) => eprintln!("{}, {}: {why}", entrant.name, setting.text(problem.delta)),
            }
        }
        eprintln!("{}: {} accuracies", entrant.name, all.len());
        all
    };
    entrants.iter().map(of).collect()
}

/// The dearest run of a method that costs at most so much.
fn dearest(found: &[Drift], cost: f64) -> Option<&Drift> {
    found.iter().rfind(|drift| drift.cost <= cost)
}

fn ratio(values: &[f64]) -> String {
    match values {
        [.., before, last] if *before > 0.0 => format!("{:.1}", last / before),
        _ => "–".to_owned(),
    }
}

/// The methods at each of some costs, and their drifts.
pub fn table<P: Poisson<f64>>(
    problem: &Problem<P>,
    entrants: &[Entrant<P>],
    found: &[Vec<Drift>],
    span: &Span,
    costs: &[f64],
) -> String {
    let mut text = String::new();
    for &cost in costs {
        let powers: Vec<u32> = (span.first..=span.last).collect();
        let mut head = vec!["method".to_owned(), "at".to_owned(), "µs".to_owned()];
        head.extend(powers.iter().map(|k| format!("H to 1e{k}")));
        head.push("growth".to_owned());
        head.extend([powers[0], span.last].map(|k| format!("C to 1e{k}")));
        head.push("growth".to_owned());
        let mut rows = vec![head];
        for (entrant, found) in entrants.iter().zip(found) {
            let Some(drift) = dearest(found, cost) else {
                continue;
            };
            let short =
                |value: Option<&f64>| value.map_or("–".to_owned(), |v| format!("{v:.1e}"));
            let mut row = vec![
                entrant.name.clone(),
                drift.setting.text(problem.delta),
                format!("{:.3}", drift.cost * 1e6),
            ];
            row.extend((0..powers.len()).map(|k| short(drift.energy.get(k))));
            row.push(ratio(&drift.energy));
            row.push(short(drift.casimirs.first()));
            row.push(short(drift.casimirs.get(powers.len() - 1)));
            row.push(ratio(&drift.casimirs));
            rows.push(row);
        }
        text.push_str(&format!(
            "at most {} µs of the processor for a unit of time:\n\n",
            table::rounded(cost * 1e6)
        ));
        text.push_str(&table::text(&rows));
        text.push('\n');
    }
    text.push_str("growth: the last span over the one before; 10 where the drift is proportional to time, 3.2 of a random walk, 1 where it is bounded\n");
    text
}

/// A panel for each span: energy above, Casimirs below.
pub fn picture<P: Poisson<f64>>(
    name: &str,
    entrants: &[Entrant<P>],
    found: &[Vec<Drift>],
    span: &Span,
) -> String {
    let mut panels = Vec::new();
    for (what, of) in [
        ("energy", (|drift| &drift.energy) as fn(&Drift) -> &Vec<f64>),
        ("Casimirs", |drift| &drift.casimirs),
    ] {
        for k in [span.first, span.last - 1, span.last] {
            let series =
                entrants
                    .iter()
                    .zip(found)
                    .enumerate()
                    .map(|(colour, (entrant, found))| {
                        let point = |drift: &Drift| {
                            let value = of(drift).get((k - span.first) as usize)?;
                            Some((drift.cost * 1e6, value.max(1e-17)))
                        };
                        Series {
                            name: entrant.name.clone(),
                            colour,
                            stroke: if entrant.control {
                                Stroke::Dashed
                            } else {
                                Stroke::Line
                            },
                            points: found.iter().filter_map(point).collect(),
                        }
                    });
            panels.push(Panel {
                title: format!("{what}, to t = 1e{k}"),
                x: Axis::logarithmic("µs for a unit of time"),
                y: Axis::logarithmic("largest relative drift"),
                series: series.collect(),
            });
        }
    }
    Chart {
        title: format!("{name}: what is lost, against run time"),
        subtitle:
            "Largest relative distance from the first value; dashed: methods without structure"
                .to_owned(),
        panels,
        across: 3,
    }
    .to_svg()
}
