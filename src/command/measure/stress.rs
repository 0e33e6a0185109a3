//! `lie stress`: methods at the limits of steps, parameters and states, and through a long run.

use std::borrow::Cow;

use lie_codegen::program::Purpose;
use lie_in_process::list;
use lie_in_process::request::OptionValue;
use lie_in_process::stress::{self, Results, cell_text, methods};
use lie_in_process::table;
use lie_in_process::words::{counted, short};
use lie_measure::stress::{Cell, Experiment, Growth, Moved, Options, Outcome};
use lie_plot::map::{self, Cell as Square, Column, Map};
use lie_syntax::diagnostic::Kind;

use super::{Bed, Ended, bed, files, interrupted};
use crate::command::files::Inputs;
use crate::command::fold::folded;
use crate::command::{args, print};
use crate::interrupt::Interrupt;
use crate::message::{Failure, Message};
use crate::render;

/// What is said of an experiment.
fn title(experiment: Experiment) -> &'static str {
    match experiment {
        Experiment::Step => "step over h0",
        Experiment::Parameter => "parameter times",
        Experiment::Scale => "state times",
        Experiment::Component => "component times",
        Experiment::Casimir => "Casimir times",
        Experiment::Long => "long run",
    }
}

/// The colour of a cell.
fn outcome(cell: &Cell) -> map::Outcome {
    let Moved { drift, growth } = cell.energy;
    // in a run that is short beside the system's own times, growth says nothing
    let long = cell.experiment != Experiment::Step || cell.value >= 0.5;
    match cell.outcome {
        Outcome::Lost => map::Outcome::Lost,
        Outcome::Stopped => map::Outcome::Stopped,
        Outcome::Domain => map::Outcome::Domain,
        Outcome::Kept if long && growth > 3.0 && drift > 1e-13 => {
            map::Outcome::Growing(drift.log10())
        }
        Outcome::Kept => map::Outcome::Drift(drift.log10()),
    }
}

/// Stresses methods on a spec.
///
/// # Errors
/// Invalid input, or surroundings that fail.
pub fn run(arguments: &args::Stress) -> Result<u8, Failure> {
    let flags = &arguments.measured;
    let help = "give the number of steps of the long run, such as 1000000";
    let steps = OptionValue::flag("--steps", &arguments.steps).count();
    let steps = steps.map_err(|message| message.help(help))?;
    let bed = bed(flags, Purpose::Stress, |spec| list::fewer(&spec.model))?;
    let inputs = Inputs::of_spec(&flags.spec, &bed.spec);
    let files = (arguments.out.as_deref(), arguments.plot.as_deref());
    let [out, plot] = files::open(files.0, files.1, &inputs)?;
    let interrupt = Interrupt::install();
    let program = bed.program(flags, Purpose::Stress, &interrupt)?;
    let mut results = Results::default();
    let options = Options { steps };
    let ended = bed.measure(flags, &program, options, &interrupt, &mut |found| {
        results.record(found)
    })?;
    if let Ended::Refused(_, why) = &ended {
        files::write(out, None, None)?;
        files::write(plot, None, None)?;
        let text = format!("nothing can be stressed on {}: {why}", bed.spec.model.name);
        let message = Message::new(Kind::Domain, text).at_option("--initial");
        return Err(message
            .help("give another initial state with `--initial`")
            .into());
    }
    let labels: Vec<String> = bed.choices.iter().map(|choice| choice.label()).collect();
    let parameters = bed.spec.model.parameters.iter();
    let parameters = parameters.map(|parameter| parameter.name.clone());
    let columns = bed.layout().columns;
    let columns = columns.iter().map(Cow::into_owned);
    let names: Vec<String> = parameters.chain(columns).collect();
    results.sort(&labels, &names);
    let wanted = !results.cells.is_empty();
    let table = || csv(&results);
    let picture = || picture(&bed, &results.cells, results.step);
    // a file that cannot be written does not take the table with it, nor the other way round
    let printed = print(&report(&bed, &results, steps));
    let written = files::write(out, files.0, wanted.then(table));
    files::write(plot, files.1, wanted.then(picture))?;
    written.and(printed)?;
    if let Ended::Interrupted(code) = ended {
        return Ok(interrupted(flags, code));
    }
    let losses = results.losses();
    for loss in &losses {
        render::say(&format!("lost: {loss}"));
    }
    Ok(u8::from(!losses.is_empty()))
}

fn csv(results: &Results) -> String {
    let mut text = "method,experiment,name,value,step,outcome,steps,newton_per_step,energy_drift,energy_growth,\
                    casimir_drift,casimir_growth,claimed_over_bound,what\n"
        .to_owned();
    for cell in &results.cells {
        text.push_str(&format!(
            "{},{},{},{:?},{:?},{},{},{:?},{:?},{:?},{:?},{:?},{:?},{}\n",
            cell.method,
            cell.experiment.word(),
            cell.name,
            cell.value,
            cell.step,
            cell.outcome.word(),
            cell.steps,
            cell.newton,
            cell.energy.drift,
            cell.energy.growth,
            cell.casimirs.drift,
            cell.casimirs.growth,
            cell.claimed,
            cell.what.replace(',', ";")
        ));
    }
    let growths = results.growths.iter().map(growth_csv);
    growths.for_each(|line| text.push_str(&line));
    text
}

/// A line of the table of experiments: the exponent stands as the value.
fn growth_csv(growth: &Growth) -> String {
    let outcome = if stress::is_lost(growth) {
        "lost"
    } else {
        "kept"
    };
    let (energy, casimir) = match growth.invariant.as_str() {
        "energy" => (growth.end, f64::NAN),
        _ => (f64::NAN, growth.end),
    };
    format!(
        "{},growth,{},{:?},{:?},{outcome},{},NaN,{energy:?},NaN,{casimir:?},NaN,{:?},standard error {:?} from {} steps on; \
         {} states; largest {:?}; bias {:?} with standard error {:?}\n",
        growth.method,
        growth.invariant,
        growth.exponent,
        growth.step,
        growth.to,
        growth.ratio,
        growth.error,
        growth.from,
        growth.states,
        growth.largest,
        growth.bias,
        growth.bias_error
    )
}

fn report(bed: &Bed, results: &Results, steps: u64) -> String {
    let mut text = format!(
        "{}: {}, h0 = {}, {} of the long run at h0\n\n{}\n",
        bed.spec.model.name,
        counted(results.cells.len() as u64, "experiment"),
        short(results.step),
        counted(steps, "step"),
        table::text(&results.table()),
    );
    text.push_str(&folded(&format!(
        "m of n: m of the n experiments were kept, with no claimed invariant beyond its round-off bound and no step refused; \
         drifts are relative to the size of the terms\n\
         grows: the last tenth of the run over the first\n{}",
        results.legend()
    )));
    let model = &bed.spec.model;
    let independent = model.casimirs_to_find();
    if model.casimirs.len() < independent {
        text.push_str(&format!(
            "{} of {independent} Casimirs known: the others are not looked at, declare them in the spec\n",
            model.casimirs.len()
        ));
    }
    let stopped = results.with_outcome(Outcome::Stopped);
    if !stopped.is_empty() {
        text.push_str(&format!("\n{} stopped with a message:\n", stopped.len()));
        for cell in stopped {
            text.push_str(&format!("  {}\n", cell_text(cell)));
        }
    }
    text
}

fn picture(bed: &Bed, cells: &[Cell], step: f64) -> String {
    let mut keys: Vec<(Experiment, &str, f64)> = Vec::new();
    for cell in cells {
        if !keys.contains(&key(cell)) {
            keys.push(key(cell));
        }
    }
    let rows = methods(cells).into_iter().map(|method| {
        let squares = keys.iter().map(|wanted| {
            let mut of_method = cells.iter().filter(|cell| cell.method == method);
            let cell = of_method.find(|cell| key(cell) == *wanted)?;
            Some(Square {
                outcome: outcome(cell),
                text: cell_text(cell),
            })
        });
        let choice = bed.choices.iter().find(|choice| choice.label() == method);
        let title = choice.map_or(method.to_owned(), |choice| choice.title());
        (title, squares.collect())
    });
    Map {
        title: format!("{}: what methods do at their limits", bed.spec.model.name),
        subtitle: format!(
            "h0 = {}; 400 steps each; parameters multiplied, components and Casimirs made small, each by itself",
            short(step)
        ),
        columns: keys.iter().map(column).collect(),
        rows: rows.collect(),
    }
    .to_svg()
}

/// What tells the experiments of a method apart.
fn key(cell: &Cell) -> (Experiment, &str, f64) {
    (cell.experiment, &cell.name, cell.value)
}

fn column((experiment, name, value): &(Experiment, &str, f64)) -> Column {
    Column {
        group: match experiment {
            Experiment::Step | Experiment::Scale | Experiment::Long => {
                title(*experiment).to_owned()
            }
            Experiment::Parameter | Experiment::Component | Experiment::Casimir => {
                format!("{name} times")
            }
        },
        label: if *value == 0.0 || (1.0..1e4).contains(value) {
            value.to_string()
        } else {
            format!("{value:.0e}")
        },
    }
}
