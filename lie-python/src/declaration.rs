//! A checked declaration, and what is compiled of it. The compiler works without the interpreter's lock.

use crate::errors::{Mistakes, method_error};
use crate::kept::Kept;
use crate::talk::{Who, attended};
use lie_codegen::compile::{compile_spec, compile_spec_in};
use lie_codegen::methods::Choice;
use lie_codegen::model::{Configuration, Driving};
use lie_codegen::program::{Chart, Purpose};
use lie_codegen::structure::Effort;
use lie_codegen::structure::Structure;
use lie_dynamic::{Declared, Dynamic};
use lie_in_process::Work;
use lie_in_process::memory;
use lie_in_process::message::Source;
use lie_in_process::spec::Spec;
use lie_runtime::Poisson as _;
use lie_runtime::family::STATISTICS;
use pyo3::exceptions::{PyMemoryError, PyValueError};
use pyo3::prelude::*;
use std::collections::HashMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};
use std::time::Duration;

/// What a lock is of, also where a thread has panicked.
pub fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What is asked of a declaration often.
pub struct Facts {
    pub system: String,
    pub names: Vec<String>,
    /// Whether it is a family, whose coordinates are those of its sites, as many as the parameters say.
    pub family: bool,
    /// The number of axes along which its sites stand, 1 of a chain; 0 where it is no family.
    pub axes: usize,
    /// The places of the coordinates that users give.
    pub shown: Vec<usize>,
    /// The place of the time in the state, where the Hamiltonian depends on it.
    pub time: Option<usize>,
    pub parameters: Vec<(String, f64)>,
    /// The values of the parameters where none are given.
    pub defaults: Vec<f64>,
    pub casimirs: Vec<String>,
    /// What is recorded beside them, and whether it ought to be constant.
    pub quantities: Vec<(String, bool)>,
    /// The names of the inputs.
    pub inputs: Vec<String>,
    /// Whether there is noise.
    pub noisy: bool,
    pub events: Vec<String>,
    pub run: HashMap<String, Vec<String>>,
}

impl Facts {
    fn of(model: &Structure) -> Self {
        let run = model.run.iter().map(|option| {
            let values = option.values.iter().map(|(text, _)| text.clone());
            (option.name.text.clone(), values.collect())
        });
        let names = model.coordinates.iter().map(|name| name.text.clone());
        let parameters = model.parameters.iter();
        let casimirs = model
            .casimirs
            .iter()
            .flat_map(|casimir| match model.family {
                Some(_) => STATISTICS
                    .map(|of| format!("{}_{of}", casimir.name))
                    .to_vec(),
                None => vec![casimir.name.clone()],
            });
        let quantities = model.quantities.iter();
        let quantities = quantities.map(|q| (q.name.clone(), q.is_conserved()));
        let clock = model.configuration.as_ref().and_then(Configuration::clock);
        Self {
            system: model.name.clone(),
            family: model.family.is_some(),
            axes: model.family.as_ref().map_or(0, |family| family.sizes.len()),
            names: names.collect(),
            shown: model.shown_coordinates(),
            time: clock.map(|clock| clock.time),
            inputs: model
                .inputs
                .iter()
                .map(|input| input.name.clone())
                .collect(),
            noisy: model.driving.as_ref().is_some_and(Driving::is_noisy),
            parameters: parameters
                .map(|p| (p.name.clone(), p.default_value))
                .collect(),
            defaults: model.defaults(),
            casimirs: casimirs.collect(),
            quantities: quantities.collect(),
            events: model
                .events
                .iter()
                .map(|event| event.name.clone())
                .collect(),
            run: run.collect(),
        }
    }
}

/// A run of less than this is brief: making a thread for it is much of its time.
const BRIEF: Duration = Duration::from_millis(10);

/// What runs a method, compiled.
pub struct Compiled {
    label: String,
    /// The form of the group element.
    chart: Option<Chart>,
    pub work: Arc<Work>,
    /// Whether the last run was brief.
    brief: AtomicBool,
}

impl Compiled {
    /// Who makes the next run.
    pub fn who(&self) -> Who {
        match self.brief.load(Ordering::Relaxed) {
            true => Who::Here,
            false => Who::Apart,
        }
    }

    /// Learns how long a run took.
    pub fn took(&self, time: Duration) {
        self.brief.store(time < BRIEF, Ordering::Relaxed);
    }
}

/// A checked declaration.
pub struct Declaration {
    spec: Arc<Spec>,
    pub facts: Facts,
    /// What runs a method, by its label and the form of the group element.
    compiled: Mutex<Vec<Arc<Compiled>>>,
    /// What calls with these options come to.
    pub kept: Mutex<Kept>,
    /// The system without fused code for any method; none where H calls functions of Rust.
    plain: OnceLock<Option<Declared>>,
}

impl Declaration {
    pub fn new(py: Python<'_>, text: String) -> PyResult<Self> {
        let checked = attended(py, move || match compile_spec(&text) {
            Ok(model) => {
                let path = model.name.clone();
                Ok(Spec::new(Arc::new(Source { path, text }), model))
            }
            Err(diagnostics) => Err(Mistakes::new(&text, &diagnostics)),
        });
        let spec = checked?.map_err(|mistakes| mistakes.raise(py))?;
        Ok(Self {
            facts: Facts::of(&spec.model),
            spec: Arc::new(spec),
            compiled: Mutex::default(),
            kept: Mutex::default(),
            plain: OnceLock::new(),
        })
    }

    /// The declaration as it was written.
    pub fn text(&self) -> &str {
        &self.spec.source.text
    }

    /// The model with its text.
    pub fn spec(&self) -> Arc<Spec> {
        Arc::clone(&self.spec)
    }

    /// Has something done with the model, without the interpreter's lock.
    pub fn with_spec<R: Send>(&self, py: Python<'_>, work: impl FnOnce(&Spec) -> R + Send) -> R {
        py.detach(|| work(&self.spec))
    }

    /// The same without the text.
    pub fn with_model<R: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&Structure) -> R + Send,
    ) -> R {
        self.with_spec(py, |spec| work(&spec.model))
    }

    /// The same with as much work on what is searched for as is said.
    pub fn with_effort<R: Send + 'static>(
        &self,
        py: Python<'_>,
        effort: Effort,
        work: impl FnOnce(&Structure) -> R + Send + 'static,
    ) -> PyResult<R> {
        let spec = self.spec();
        let done = attended(py, move || {
            let text = &spec.source.text;
            match compile_spec_in(text, None, effort) {
                Ok(model) => Ok(work(&model)),
                Err(diagnostics) => Err(Mistakes::new(text, &diagnostics)),
            }
        });
        done?.map_err(|mistakes| mistakes.raise(py))
    }

    /// The parameters with these values, by name.
    pub fn named(&self, values: Vec<f64>) -> impl Iterator<Item = (String, f64)> + '_ {
        let names = self.facts.parameters.iter().map(|(name, _)| name.clone());
        names.zip(values)
    }

    /// What runs a method, compiled once.
    pub fn work(
        &self,
        py: Python<'_>,
        choice: &Choice,
        chart: Option<Chart>,
    ) -> PyResult<Arc<Compiled>> {
        let label = choice.label();
        let same = |known: &&Arc<Compiled>| known.label == label && known.chart == chart;
        if let Some(compiled) = lock(&self.compiled).iter().find(same) {
            return Ok(Arc::clone(compiled));
        }
        let purpose = chart.map_or(Purpose::Run, Purpose::OnGroup);
        let (spec, choice) = (self.spec(), choice.clone());
        let work = attended(py, move || {
            Work::new(&spec.model, &[choice], purpose, || None)
        });
        let Some(work) = work? else {
            self.plain(py)?;
            let text = format!("`{label}` does not run in Python yet");
            let help = "`lie run` has it; or take another method, see System.methods()";
            return Err(method_error(py, &text, help));
        };
        let compiled = Arc::new(Compiled {
            label,
            chart,
            work: Arc::new(work),
            brief: AtomicBool::new(false),
        });
        lock(&self.compiled).push(Arc::clone(&compiled));
        Ok(compiled)
    }

    /// The system without code for any method.
    fn plain(&self, py: Python<'_>) -> PyResult<&Declared> {
        if self.plain.get().is_none() {
            let spec = self.spec();
            let declared = attended(py, move || lie_in_process::declared(&spec.model));
            // another thread may have been first
            let _ = self.plain.set(declared?);
        }
        let declared = self.plain.get().and_then(Option::as_ref);
        declared.ok_or_else(|| {
            let text = "H calls functions of Rust, which do not run in Python";
            method_error(py, text, "give them as tables: docs/functions.md")
        })
    }

    /// The places of the coordinates of a system that users give.
    pub fn shown_coordinates(&self, system: &Dynamic<f64>) -> Vec<usize> {
        match self.facts.family {
            true => (0..system
                .clock()
                .map_or(system.dimension(), |clock| clock.momentum))
                .collect(),
            false => self.facts.shown.clone(),
        }
    }

    /// The system of these parameters, without code for any method.
    pub fn system(&self, py: Python<'_>, parameters: &[f64]) -> PyResult<Dynamic<f64>> {
        let family = self.spec.model.family.as_ref();
        if let Some(sizes) = family.and_then(|family| family.sites(parameters)) {
            let sites: f64 = sizes.iter().map(|size| *size as f64).product();
            let coordinates = sites * self.facts.names.len() as f64;
            memory::fits(coordinates * memory::COORDINATE)
                .map_err(|exceeded| PyMemoryError::new_err(exceeded.to_string()))?;
        }
        let system = self.plain(py)?.system(parameters);
        system.map_err(|error| PyValueError::new_err(error.to_string()))
    }
}
