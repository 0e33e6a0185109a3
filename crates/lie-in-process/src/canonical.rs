//! A spec in coordinates in which its bracket is constant, or that of an algebra without a cocycle.

mod shift;

use std::collections::{BTreeMap, HashSet};
use std::path::Path;
use std::sync::Arc;

use lie_codegen::compile::compile_spec_in;
use lie_codegen::structure::Effort;
use lie_codegen::structure::straight::{Refusal, Straight, straight};
use lie_syntax::diagnostic::{Diagnostic, Kind};
use serde_json::Value;
use serde_json::value::RawValue;

use crate::message::{Message, Source};
use crate::request::{self, Request};
use crate::spec::Spec;

/// The keys in the order of a spec; others come behind.
const ORDER: [&str; 11] = [
    "$schema",
    "format",
    "name",
    "description",
    "references",
    "poisson",
    "state",
    "parameters",
    "functions",
    "let",
    "hamiltonian",
];

/// Such a spec.
pub struct Canonical {
    /// Its text.
    pub text: String,
    /// What the new coordinates are.
    pub sentence: String,
    /// Whether the bracket is constant in them. Else it is that of an algebra, without a cocycle.
    pub is_constant: bool,
}

impl Canonical {
    /// That of a spec, as a file of this folder: the old coordinates are abbreviations and observables, so that every function stays as it was
    /// written. What the `run` of the spec says stays where it applies, else `gauss10` takes its place.
    ///
    /// # Errors
    /// A bracket or a key that such coordinates do not have.
    pub fn of(spec: &Spec, folder: Option<&Path>) -> Result<Self, Message> {
        let mut entries: Entries = serde_json::from_str(&spec.source.text).map_err(unread)?;
        let shifted = shift::rewrite(spec, &mut entries)?;
        let is_constant = shifted.is_none();
        let sentence = match shifted {
            Some(sentence) => sentence,
            None => straightened(spec, &mut entries)?,
        };
        let plan = |text: &str| {
            let model = compile_spec_in(text, folder, Effort::Declaration).map_err(wrong)?;
            let source = Arc::new(Source {
                path: spec.source.path.clone(),
                text: text.to_owned(),
            });
            Ok(request::plan(
                &Spec::new(source, model),
                &Request::default(),
            ))
        };
        let mut text = written(&entries);
        let ran = request::plan(spec, &Request::default()).is_ok();
        if plan(&text)?.is_err() && ran {
            entries.insert("run".to_owned(), kept_of_run(&entries)?);
            text = written(&entries);
        }
        Ok(Self {
            text,
            sentence,
            is_constant,
        })
    }
}

/// Rewrites the spec in coordinates in which its bracket is constant, and says what they are.
fn straightened(spec: &Spec, entries: &mut Entries) -> Result<String, Message> {
    let found = straight(&spec.model, &names(entries)).map_err(|why| refused(spec, why))?;
    let sentence = sentence(spec, &found);
    rewrite(spec, &found, &sentence, entries)?;
    Ok(sentence)
}

/// Names that are no coordinates, parameters or abbreviations.
fn names(entries: &Entries) -> HashSet<String> {
    let objects = ["vectors", "functions"].into_iter();
    let objects = objects.filter_map(|key| entries.get(key));
    let objects = objects.filter_map(|text| serde_json::from_str::<Entries>(text.get()).ok());
    objects.flat_map(BTreeMap::into_keys).collect()
}

/// Step and end of a run, by a method that always applies.
fn kept_of_run(entries: &Entries) -> Result<Box<RawValue>, Message> {
    let run = entries.get("run").map_or("{}", |run| run.get());
    let mut run: serde_json::Map<String, Value> = serde_json::from_str(run).map_err(unread)?;
    run.retain(|key, _| ["step", "tol", "from", "until", "every"].contains(&key.as_str()));
    run.insert("method".to_owned(), "gauss10".into());
    serde_json::value::to_raw_value(&run).map_err(unread)
}

/// What is refused of a spec that was rewritten.
fn wrong(mistakes: Vec<Diagnostic>) -> Message {
    let Some(first) = mistakes.into_iter().next() else {
        return Message::new(Kind::Schema, "the spec cannot be rewritten");
    };
    let text = format!(
        "the spec in the new coordinates is refused: {}",
        first.message
    );
    let help = first.help.unwrap_or_else(|| {
        "write what it says by coordinates, and files beside the new spec".to_owned()
    });
    Message::new(first.kind, text).help(help)
}

/// What the new coordinates are.
fn sentence(spec: &Spec, found: &Straight) -> String {
    let pairs = spec.model.coordinates.iter().zip(&found.coordinates);
    let changed = pairs.filter_map(|(old, new)| {
        let replaced = new.replaced.as_ref()?;
        Some(format!("{} = {}", old.text, replaced.back))
    });
    let changed: Vec<String> = changed.collect();
    format!("the bracket is constant with {}", changed.join(", "))
}

fn refused(spec: &Spec, why: Refusal) -> Message {
    let (text, help) = match why {
        Refusal::Constant => (
            "the bracket is constant in these coordinates".to_owned(),
            "every Gauss method is a Poisson map as it is",
        ),
        Refusal::Other => (
            "no coordinates are known in which this bracket is constant".to_owned(),
            "it is for brackets {x_i, x_j} = c_ij a_i(x_i) a_j(x_j) with constant or linear a_i, and rational functions of parameters in them, and for pairs {x, y} = 1/B(x, y); `lie check` names the class of a bracket",
        ),
        Refusal::NoInverse(i) => (
            format!(
                "`{}` has no closed form in terms of the integral that would take its place",
                spec.model.coordinates[i].text
            ),
            "`canonical2`, `canonical4` and `canonical6` are Gauss methods in these coordinates on the system as it is: they find it along with their stages",
        ),
        Refusal::Zero(i) => (
            format!(
                "the initial state is where the brackets of `{}` vanish or have no value, and so has what would take its place",
                spec.model.coordinates[i].text
            ),
            "declare an `initial` beside it: no motion leaves this set, or comes to it",
        ),
    };
    Message::new(Kind::Method, text).help(help)
}

/// The entries of a spec by their keys, as text.
type Entries = BTreeMap<String, Box<RawValue>>;

fn rewrite(
    spec: &Spec,
    found: &Straight,
    sentence: &str,
    entries: &mut Entries,
) -> Result<(), Message> {
    let mut fixed = ["dissipation", "constraint"].into_iter();
    if let Some(key) = fixed.find(|key| entries.contains_key(*key)) {
        let text = format!("`{key}` is declared in the coordinates of the bracket as it is");
        let help = "write it as `forces` of these coordinates, which are taken along";
        return Err(Message::new(Kind::Method, text).help(help));
    }
    let old = || spec.model.coordinates.iter().map(|c| c.text.as_str());
    let mut lets = Vec::new();
    let mut observables = Vec::new();
    for (old, new) in old().zip(&found.coordinates) {
        if let Some(replaced) = &new.replaced {
            lets.push(Value::from(format!("{old} = {}", replaced.back)));
            observables.push(old);
        }
    }
    if let Some(declared) = entries.get("let") {
        lets.extend(serde_json::from_str::<Vec<Value>>(declared.get()).map_err(unread)?);
    }
    let names = found.coordinates.iter().map(|c| c.name.as_str());
    let mut changed = vec![
        ("poisson", Value::from(found.brackets.clone())),
        ("state", names.collect()),
        ("let", Value::from(lets)),
        ("description", Value::from(described(sentence, entries)?)),
    ];
    let initial = found.coordinates.iter().map(|c| c.initial.clone());
    if let Some(initial) = initial.collect::<Option<Vec<String>>>() {
        changed.push(("initial", Value::from(initial)));
    }
    let names: Vec<&str> = old().collect();
    let along = |force| moved(&names, found, &force);
    if let Some(forces) = entries.get("forces") {
        let forces = serde_json::from_str(forces.get()).map_err(unread)?;
        changed.push(("forces", along(forces)?));
    }
    if let Some(noise) = entries.get("noise") {
        let mut noise: Vec<Value> = serde_json::from_str(noise.get()).map_err(unread)?;
        for process in &mut noise {
            if let Some(Value::Object(force)) = process.get_mut("force").map(Value::take) {
                process["force"] = along(force)?;
            }
        }
        changed.push(("noise", Value::from(noise)));
    }
    for (key, value) in changed {
        set(entries, key, value)?;
    }
    observe(entries, observables)
}

/// Adds old coordinates to the observables: the order of that object is the order of columns.
fn observe<'a>(
    entries: &mut Entries,
    old: impl IntoIterator<Item = &'a str>,
) -> Result<(), Message> {
    let old = old
        .into_iter()
        .map(|old| format!("{0}: {0}", Value::from(old)));
    let mut observables: Vec<String> = old.collect();
    let declared = entries.get("observables").map_or("{}", |text| text.get());
    let declared = declared.trim();
    let declared = &declared[1..declared.len() - 1];
    if !declared.trim().is_empty() {
        observables.insert(0, declared.trim().to_owned());
    }
    let observables = format!("{{{}}}", observables.join(", "));
    let observables = RawValue::from_string(observables).map_err(unread)?;
    entries.insert("observables".to_owned(), observables);
    Ok(())
}

/// A force on the new coordinates, for one on the old ones.
///
/// # Errors
/// One by the name of a vector, whose components would act on several of them.
fn moved(
    names: &[&str],
    found: &Straight,
    force: &serde_json::Map<String, Value>,
) -> Result<Value, Message> {
    let on = |k: usize| {
        let value = force.get(names[k])?;
        let text = value
            .as_str()
            .map_or_else(|| value.to_string(), str::to_owned);
        Some(text)
    };
    let known = found.coordinates.iter().enumerate();
    let known = known.filter_map(|(k, new)| {
        let Some(replaced) = &new.replaced else {
            return Some((new.name.clone(), force.get(names[k])?.clone()));
        };
        let own = on(k).map(|value| format!("({value})/({})", replaced.speed));
        let beside = replaced.beside.iter();
        let beside = beside.filter_map(|(k, slope)| Some(format!("({})*({slope})", on(*k)?)));
        let terms: Vec<String> = own.into_iter().chain(beside).collect();
        (!terms.is_empty()).then(|| (new.name.clone(), terms.join(" + ").into()))
    });
    let mut all: serde_json::Map<String, Value> = known.collect();
    let others = force
        .iter()
        .filter(|(name, _)| !names.contains(&name.as_str()));
    let replaced = || found.coordinates.iter().flat_map(|new| &new.replaced);
    let mixes = replaced().any(|replaced| !replaced.beside.is_empty());
    if let Some((name, _)) = others.clone().next().filter(|_| mixes) {
        let text = format!("the force on `{name}` is one on several coordinates");
        let help = "declare it for each coordinate, as `\"x\": …`";
        return Err(Message::new(Kind::Method, text).help(help));
    }
    all.extend(others.map(|(name, value)| (name.clone(), value.clone())));
    Ok(Value::Object(all))
}

fn set(entries: &mut Entries, key: &str, value: Value) -> Result<(), Message> {
    let value = serde_json::value::to_raw_value(&value).map_err(unread)?;
    entries.insert(key.to_owned(), value);
    Ok(())
}

fn described(sentence: &str, entries: &Entries) -> Result<String, Message> {
    let said: Option<String> = match entries.get("description") {
        Some(text) => Some(serde_json::from_str(text.get()).map_err(unread)?),
        None => None,
    };
    let sentence = format!("By `lie canonical`: {sentence}.");
    Ok(said.map_or_else(|| sentence.clone(), |said| format!("{said} {sentence}")))
}

fn written(entries: &Entries) -> String {
    let known = ORDER.iter().filter_map(|key| entries.get_key_value(*key));
    let others = entries
        .iter()
        .filter(|(key, _)| !ORDER.contains(&key.as_str()));
    let lines = known.chain(others);
    let lines: Vec<String> = lines
        .map(|(key, value)| format!("  {}: {}", Value::from(key.as_str()), value.get()))
        .collect();
    format!("{{\n{}\n}}\n", lines.join(",\n"))
}

fn unread(error: serde_json::Error) -> Message {
    let text = format!("the spec cannot be rewritten: {error}");
    Message::new(Kind::Schema, text)
}
