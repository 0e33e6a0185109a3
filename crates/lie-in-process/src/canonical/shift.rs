//! A spec in the coordinates `mu - s`, in which a cocycle `S_ij = C_ij^k s_k` is none: every method of the algebra applies there.

use std::collections::HashSet;

use lie_codegen::model::{Cocycle, Model};
use serde_json::{Map, Value};

use super::{Entries, described, names, observe, set, unread};
use crate::message::Message;
use crate::spec::Spec;

/// A coordinate that is shifted.
struct Shifted {
    old: String,
    new: String,
    /// s as text.
    by: String,
}

/// Rewrites the spec where its cocycle is a coboundary, and says what the new coordinates are.
///
/// # Errors
/// A spec that cannot be read again.
pub(super) fn rewrite(spec: &Spec, entries: &mut Entries) -> Result<Option<String>, Message> {
    let Some(shifted) = shifted(&spec.model, names(entries)) else {
        return Ok(None);
    };
    let moved = shifted.iter().flatten();
    let moved: Vec<String> = moved
        .map(|one| format!("{} = {} + ({})", one.old, one.new, one.by))
        .collect();
    let sentence = format!("the bracket has no cocycle with {}", moved.join(", "));
    let state = shifted.iter().zip(&spec.model.coordinates);
    let state = state.map(|(one, own)| one.as_ref().map_or(own.text.as_str(), |one| &one.new));
    set(entries, "state", state.collect())?;
    set(
        entries,
        "description",
        described(&sentence, entries)?.into(),
    )?;
    let mut lets: Vec<Value> = moved.into_iter().map(Value::from).collect();
    lets.extend(read::<Vec<Value>>(entries, "let")?.unwrap_or_default());
    set(entries, "let", lets.into())?;
    if let Some(mut initial) = read::<Vec<Value>>(entries, "initial")? {
        for (value, one) in initial.iter_mut().zip(&shifted) {
            if let Some(one) = one {
                *value = format!("({}) - ({})", text(value), one.by).into();
            }
        }
        set(entries, "initial", initial.into())?;
    }
    // H(mu) is the transform of the Lagrangian whose momentum is mu - s
    if let Some(lagrangian) = read::<String>(entries, "lagrangian")? {
        let velocity: Vec<String> = read(entries, "velocity")?.unwrap_or_default();
        let terms = velocity.iter().zip(&shifted);
        let terms = terms.filter_map(|(xi, one)| Some(format!("({})*{xi}", one.as_ref()?.by)));
        let terms: Vec<String> = terms.collect();
        let lagrangian = format!("({lagrangian}) - ({})", terms.join(" + "));
        set(entries, "lagrangian", lagrangian.into())?;
    }
    if let Some(forces) = read(entries, "forces")? {
        set(entries, "forces", renamed(forces, &shifted))?;
    }
    if let Some(mut noise) = read::<Vec<Value>>(entries, "noise")? {
        for process in &mut noise {
            if let Some(Value::Object(force)) = process.get_mut("force").map(Value::take) {
                process["force"] = renamed(force, &shifted);
            }
        }
        set(entries, "noise", noise.into())?;
    }
    observe(
        entries,
        shifted.iter().flatten().map(|one| one.old.as_str()),
    )?;
    entries.remove("cocycle");
    Ok(Some(sentence))
}

/// The coordinates of the declared algebra, where a shift takes the cocycle away; those that stay are `None`.
fn shifted(model: &Model, mut taken: HashSet<String>) -> Option<Vec<Option<Shifted>>> {
    let extension = model.bracket.algebra()?.extension.as_ref()?;
    let Cocycle::Coboundary(shift) = &extension.cocycle else {
        return None;
    };
    let parameter = |p: usize| model.parameters[p].name.clone();
    let each = shift.iter().zip(&model.coordinates);
    let each = each.map(|(by, own)| {
        (!by.is_zero()).then(|| {
            let mut new = format!("{}_s", own.text);
            while model.taken.contains(&new) || !taken.insert(new.clone()) {
                new.push('_');
            }
            Shifted {
                old: own.text.clone(),
                new,
                by: by.display(&parameter),
            }
        })
    });
    Some(each.collect())
}

/// A force by the names of the new coordinates.
fn renamed(force: Map<String, Value>, shifted: &[Option<Shifted>]) -> Value {
    let name = |old: String| {
        let mut moved = shifted.iter().flatten();
        moved
            .find(|one| one.old == old)
            .map_or(old, |one| one.new.clone())
    };
    Value::Object(
        force
            .into_iter()
            .map(|(old, value)| (name(old), value))
            .collect(),
    )
}

/// A number or an expression as it was written.
fn text(value: &Value) -> String {
    value
        .as_str()
        .map_or_else(|| value.to_string(), str::to_owned)
}

fn read<T: serde::de::DeserializeOwned>(
    entries: &Entries,
    key: &str,
) -> Result<Option<T>, Message> {
    let text = entries
        .get(key)
        .map(|text| serde_json::from_str(text.get()));
    text.transpose().map_err(unread)
}
