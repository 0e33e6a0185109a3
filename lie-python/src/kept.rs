//! Calls whose options were asked before: they are checked once. What is asked again is compared with what was asked, by values
//! that do not change; whatever is not certainly the same goes the long way, which also says what is wrong with it.

use crate::declaration::{Compiled, Declaration, lock};
use lie_in_process::request::Plan;
use lie_program::protocol::Start;
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};
use std::collections::BTreeMap;
use std::sync::Arc;

/// So many calls are kept, the last ones.
const CALLS: usize = 16;
/// A longer list of times is not compared.
const TIMES: usize = 64;

/// What a call comes to but for its start.
pub struct Prepared {
    pub plan: Plan,
    pub compiled: Arc<Compiled>,
    pub label: Py<PyString>,
}

/// An option that was given.
enum Given {
    One(Py<PyAny>),
    /// The entries of a list.
    Several(Vec<Py<PyAny>>),
}

impl Given {
    /// An option, if it can be compared.
    fn new(value: &Bound<'_, PyAny>) -> Option<Self> {
        if let Ok(list) = value.cast_exact::<PyList>() {
            let comparable = list.len() <= TIMES && list.iter().all(|entry| is_constant(&entry));
            return comparable.then(|| Self::Several(list.iter().map(Bound::unbind).collect()));
        }
        is_constant(value).then(|| Self::One(value.clone().unbind()))
    }

    fn is(&self, value: &Bound<'_, PyAny>) -> bool {
        match self {
            Self::One(known) => same(known, value),
            Self::Several(known) => value.cast_exact::<PyList>().is_ok_and(|list| {
                let mut pairs = known.iter().zip(list.iter());
                known.len() == list.len() && pairs.all(|(known, value)| same(known, &value))
            }),
        }
    }
}

/// Whether a value never changes, and is what it equals.
fn is_constant(value: &Bound<'_, PyAny>) -> bool {
    value.is_none()
        || value.is_exact_instance_of::<PyFloat>()
        || value.is_exact_instance_of::<PyString>()
        || value.is_exact_instance_of::<PyInt>()
        || value.is_exact_instance_of::<PyBool>()
}

/// Whether a value is a constant, of its type too: True is not 1.
fn same(known: &Py<PyAny>, value: &Bound<'_, PyAny>) -> bool {
    let known = known.bind(value.py());
    value.is(known)
        || (value.get_type_ptr() == known.get_type_ptr() && value.eq(known).unwrap_or(false))
}

/// The last calls.
#[derive(Default)]
pub struct Kept(Vec<(Vec<Given>, Arc<Prepared>)>);

impl Kept {
    /// What a call with these options comes to, if there was one.
    pub fn find(&self, options: &Bound<'_, PyTuple>) -> Option<Arc<Prepared>> {
        let same = |(known, _): &&(Vec<Given>, _)| {
            let mut pairs = known.iter().zip(options.iter_borrowed());
            pairs.all(|(known, value)| known.is(&value))
        };
        let (_, prepared) = self.0.iter().find(same)?;
        Some(Arc::clone(prepared))
    }

    /// Keeps a call, if its options can be compared.
    pub fn keep(&mut self, options: &Bound<'_, PyTuple>, prepared: Arc<Prepared>) {
        if self.find(options).is_some() {
            return;
        }
        let given = options.iter_borrowed().map(|value| Given::new(&value));
        if let Some(given) = given.collect() {
            self.0.truncate(CALLS - 1);
            self.0.insert(0, (given, prepared));
        }
    }
}

/// Where a call starts; none where it has to be looked at.
pub fn start(
    declaration: &Declaration,
    x0: &Bound<'_, PyAny>,
    named: &Bound<'_, PyDict>,
) -> Option<Start> {
    let spec = declaration.spec();
    let mut parameters = BTreeMap::new();
    let values = match named.is_empty() {
        true => None,
        false => {
            let mut values = spec.model.defaults();
            for (name, value) in named {
                let (name, value) = (name.extract::<String>().ok()?, number(&value)?);
                let mut declared = spec.model.parameters.iter();
                let place = declared.position(|known| known.name == name)?;
                if !value.is_finite() || (spec.model.parameters[place].positive && value <= 0.0) {
                    return None;
                }
                values[place] = value;
                parameters.insert(name, value);
            }
            Some(values)
        }
    };
    let values = values.as_deref().unwrap_or(&declaration.facts.defaults);
    if spec.model.void_constraint(values).is_some() {
        return None;
    }
    let initial = match x0.is_none() {
        true => spec.model.initial_values(values)?,
        false => {
            let given = numbers(x0)?;
            if spec.model.violation(&given, values).is_some() {
                return None;
            }
            spec.model.complete_state(&given, values)?
        }
    };
    let fits = spec.fault(&initial, values).is_none();
    fits.then_some(Start {
        parameters,
        initial,
    })
}

/// A number as it is, not as text.
fn number(value: &Bound<'_, PyAny>) -> Option<f64> {
    let plain = value.is_exact_instance_of::<PyFloat>() || value.is_exact_instance_of::<PyInt>();
    plain.then(|| value.extract().ok()).flatten()
}

/// The numbers of a list, a tuple or an array.
fn numbers(state: &Bound<'_, PyAny>) -> Option<Vec<f64>> {
    if let Ok(array) = state.cast_exact::<PyArray1<f64>>() {
        return Some(array.try_readonly().ok()?.as_array().to_vec());
    }
    if let Ok(list) = state.cast_exact::<PyList>() {
        return list.iter().map(|entry| number(&entry)).collect();
    }
    let tuple = state.cast_exact::<PyTuple>().ok()?;
    tuple.iter().map(|entry| number(&entry)).collect()
}

/// A call that was made before with other starts, and this one's; none where it has to be checked.
pub fn again(
    declaration: &Declaration,
    options: &Bound<'_, PyTuple>,
    x0: &Bound<'_, PyAny>,
    named: &Bound<'_, PyDict>,
) -> Option<(Arc<Prepared>, Start)> {
    let prepared = lock(&declaration.kept).find(options)?;
    Some((prepared, start(declaration, x0, named)?))
}
