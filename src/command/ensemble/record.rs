//! What the file of members is to say of itself, before there are members.

use std::path::Path;

use lie_in_process::ensemble;
use lie_in_process::memory;
use lie_in_process::request::{Asked, Value};
use lie_in_process::share::{Record, Share, Stops, Table};
use lie_runtime::driver::Pace;
use lie_syntax::front::spec::files;
use serde_json::Map;

use super::reductions::QUANTILES;
use super::{beside, no_room};
use crate::build::{self, Key};
use crate::command::args;
use crate::command::run::layout::Layout;
use crate::compiler::Spec;
use crate::message::{Failure, Message};

/// What the file is to say of itself, and the places of its columns in a state.
///
/// # Errors
/// `option` for members of different sizes; `io` for files that cannot be read.
pub fn record(
    spec: &Spec,
    flags: &args::Ensemble,
    asked: &Asked,
    share: Share,
    quantiles: Vec<f64>,
) -> Result<(Record, Vec<usize>), Failure> {
    let model = &spec.model;
    let parameters = asked.cast.parameters.first().cloned().unwrap_or_default();
    let named = model
        .parameters
        .iter()
        .map(|p| p.name.clone())
        .zip(parameters);
    let layout = Layout::new(model, None, &named.collect());
    let places = match &model.family {
        Some(_) => (0..layout.states).collect(),
        None => model.shown_coordinates(),
    };
    let members = asked.cast.count();
    if asked
        .cast
        .starts
        .iter()
        .any(|start| start.len() != asked.cast.starts[0].len())
    {
        let text = "the members have different numbers of sites";
        let help = "make an ensemble of its own for each number of sites";
        return Err(Message::option("--param", text).help(help).into());
    }
    let reduce = {
        let mut reduce = flags.reduce.clone();
        reduce.sort_unstable();
        reduce.dedup();
        reduce.into_iter().map(|one| beside::name(one).to_owned())
    };
    let ends = asked.ends;
    let record = Record {
        format: Record::FORMAT,
        lie: build::version().to_owned(),
        complete: false,
        system: model.name.clone(),
        method: asked.plan.method.label(),
        kept: asked.plan.kept(spec),
        spec: digest_of_spec(&flags.spec, spec)?,
        asked: options(flags, asked)?,
        members,
        share,
        parameters: asked.swept.clone(),
        columns: layout.coordinates(),
        times: times(asked, layout.states)?,
        rows: !ends,
        reduce: reduce.collect(),
        stops: stops(spec, &quantiles),
        events: table(flags),
        quantiles,
        histogram: None,
        counts: Vec::new(),
        failures: Vec::new(),
        numbers: None,
    };
    Ok((record, places))
}

/// The times of the rows, where there is memory for those of a member.
fn times(asked: &Asked, columns: usize) -> Result<Vec<f64>, Failure> {
    let plan = &asked.plan;
    if let (Pace::Step(step), false) = (plan.pace.0, asked.ends) {
        let rows = memory::rows(&plan.times, plan.from, step);
        let fits = memory::fits(rows * (1.0 + columns as f64) * memory::NUMBER);
        fits.map_err(|exceeded| no_room(&exceeded).at_option("--every"))?;
    }
    Ok(ensemble::times(plan, asked.ends))
}

/// What is said of the events that end members, where some are declared to do that.
fn stops(spec: &Spec, quantiles: &[f64]) -> Option<Stops> {
    let events = spec.model.events.iter();
    let mut names = events.filter(|event| event.rule.stops).peekable();
    names.peek()?;
    let quantiles = if quantiles.is_empty() {
        &QUANTILES
    } else {
        quantiles
    };
    let names = names.map(|event| event.name.clone());
    Some(Stops::of(names, quantiles.to_vec()))
}

/// What is said of the table of events: that of a share is found again by its name.
fn table(flags: &args::Ensemble) -> Option<Table> {
    let path = flags.events.as_ref()?;
    let name = path.file_name().filter(|_| flags.shard.is_some());
    Some(Table {
        file: name.map(|name| name.to_string_lossy().into_owned()),
        digest: None,
    })
}

/// A digest of the spec and of the files that it reads.
fn digest_of_spec(path: &Path, spec: &Spec) -> Result<String, Failure> {
    let text = &spec.source.text;
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut key = Key::new().update(text);
    for file in files(text) {
        key = key.update(&digest(&folder.join(file))?);
    }
    Ok(key.hex())
}

fn digest(path: &Path) -> Result<String, Failure> {
    let bytes = std::fs::read(path).map_err(|error| {
        let message = Message::io(path, format!("it cannot be read: {error}"));
        Failure::surroundings(message.help("check that it is still there"))
    })?;
    Ok(Key::digest(&bytes))
}

/// What was asked for, by option; of files their digests.
fn options(
    flags: &args::Ensemble,
    asked: &Asked,
) -> Result<Map<String, serde_json::Value>, Failure> {
    let request = serde_json::to_value(&flags.request).unwrap_or_default();
    let mut options = match request {
        serde_json::Value::Object(options) => options,
        _ => Map::new(),
    };
    options
        .retain(|_, value| !value.is_null() && value.as_array().is_none_or(|all| !all.is_empty()));
    if let Some(path) = &flags.request.initial_file {
        options.insert("initial-file".to_owned(), digest(path)?.into());
    }
    let tables = flags.request.input.iter();
    let tables = tables.filter_map(|written| written.split_once('='));
    let tables: Vec<String> = tables
        .map(|(name, path)| {
            Ok(format!(
                "{}={}",
                name.trim(),
                digest(Path::new(path.trim()))?
            ))
        })
        .collect::<Result<_, Failure>>()?;
    if !tables.is_empty() {
        options.insert("input".to_owned(), tables.into());
    }
    if let Some(draw) = asked.cast.drawn.as_ref().map(|drawn| drawn.draw) {
        options.insert("members".to_owned(), draw.count.into());
        options.insert("seed".to_owned(), draw.seed.into());
        let spread = flags.spread.clone().unwrap_or(Value::Number(0.1));
        options.insert(
            "spread".to_owned(),
            serde_json::to_value(spread).unwrap_or_default(),
        );
    }
    Ok(options)
}
