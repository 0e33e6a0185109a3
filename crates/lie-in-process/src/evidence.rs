//! What the kernels of a system give, before a judge who interprets the declaration.

use std::collections::{BTreeMap, BTreeSet};

use lie_codegen::structure::Structure;
use lie_judge::{Judge, Sample, Verdict};
use lie_measure::verify::{Kernel, Reference};
use lie_runtime::scalar::Scalar;
use serde_json::{Value, json};

use crate::words::{counted, number, short};

/// A spoiled value differs by this part of the largest: the judge must notice.
const SPOILED: f64 = 1e-4;

/// What was judged so far.
pub struct Evidence {
    judge: Option<Judge>,
    /// Whether there should be one.
    judged: bool,
    /// The worst of each kernel.
    kernels: BTreeMap<String, Verdict>,
    samples: usize,
    /// Kernels of which the judge let a spoiled value pass at every state.
    blind: BTreeMap<String, bool>,
    /// The largest distance of a reference solution from the judge's own, relative to what is allowed.
    reference: Option<f64>,
    /// Kernels that the judge should know and does not.
    unknown: BTreeSet<String>,
    /// Kernels that every system of the kind has.
    wanted: &'static [&'static str],
    /// Measurements that let a spoiled map pass.
    broken: BTreeSet<String>,
    /// Parts of the iteration that do not solve an equation with a known solution.
    unsound: Vec<String>,
}

/// The kernels of every system, those of an algebra last.
const KERNELS: [&str; 13] = [
    "hamiltonian",
    "energy",
    "gradient",
    "hessian",
    "poisson_matrix",
    "poisson_slope",
    "vector_field",
    "jacobian",
    "linearize",
    "casimirs",
    "ad",
    "ad_star",
    "ad_star_matrix",
];

impl Evidence {
    /// Nothing yet, of the system of a spec for values of its parameters.
    pub fn from_spec(text: &str, model: &Structure, parameters: &[f64]) -> Self {
        // what a spec of a family declares is one site, and is not interpreted
        if model.family.is_some() {
            return Self {
                judged: false,
                wanted: &[],
                ..Self::with_judge(None, false)
            };
        }
        let judge = Judge::of_spec(text, model, parameters);
        Self::with_judge(judge, model.is_lie_poisson())
    }

    /// The same of a judge, of a system with an algebra or without.
    fn with_judge(judge: Option<Judge>, has_algebra: bool) -> Self {
        Self {
            judge,
            judged: true,
            kernels: BTreeMap::new(),
            samples: 0,
            blind: BTreeMap::new(),
            reference: None,
            unknown: BTreeSet::new(),
            wanted: if has_algebra {
                &KERNELS
            } else {
                &KERNELS[..10]
            },
            broken: BTreeSet::new(),
            unsound: Vec::new(),
        }
    }

    /// Takes what a kernel gives.
    pub fn kernel(&mut self, kernel: Kernel) {
        self.judge(&Sample {
            kernel: kernel.name,
            arguments: kernel.arguments,
            values: kernel.values,
            velocity: kernel.gradient,
        });
    }

    /// Takes the end of a reference solution.
    pub fn reference(&mut self, solution: &Reference) {
        let Reference { span, start, end } = solution;
        let judge = self.judge.as_ref();
        if let Some(excess) = judge.and_then(|judge| judge.solution(start, *span, end)) {
            let worst = self
                .reference
                .map_or(excess, |worst| Scalar::max(worst, excess));
            self.reference = Some(worst);
        }
    }

    /// Takes a measurement that lets a spoiled map pass.
    pub fn broken(&mut self, fact: String) {
        self.broken.insert(fact);
    }

    /// Takes a part of the iteration that does not solve an equation with a known solution.
    pub fn unsound(&mut self, what: String) {
        self.unsound.push(what);
    }

    fn judge(&mut self, sample: &Sample) {
        let Some(judge) = &self.judge else { return };
        let Some(verdict) = judge.judge(sample) else {
            if !judge.exempts(&sample.kernel) {
                self.unknown.insert(sample.kernel.clone());
            }
            return;
        };
        self.samples += 1;
        let worst = self.kernels.entry(sample.kernel.clone());
        let worst = worst.or_insert_with(|| verdict.clone());
        if verdict.excess > worst.excess {
            *worst = verdict;
        }
        if let Some(spoiled) = spoiled(sample) {
            let seen = judge
                .judge(&spoiled)
                .is_some_and(|verdict| verdict.excess > 1.0);
            let blind = self.blind.entry(sample.kernel.clone()).or_insert(true);
            *blind &= !seen;
        }
    }

    /// What speaks against it.
    pub fn failures(&self) -> Vec<String> {
        let mut failures = Vec::new();
        if self.judged && self.judge.is_none() {
            failures.push("the declaration cannot be interpreted".to_owned());
        }
        let missing = self.wanted.iter().copied();
        for kernel in missing.filter(|kernel| !self.kernels.contains_key(*kernel)) {
            failures.push(format!("{kernel}: the judge has not seen it"));
        }
        for kernel in &self.unknown {
            failures.push(format!("{kernel}: the judge does not know it"));
        }
        for (kernel, verdict) in &self.kernels {
            if verdict.excess > 1.0 || verdict.excess.is_nan() {
                failures.push(format!(
                    "{kernel}: entry {} is {:?}, and {:?} by the declaration as it was written",
                    verdict.entry, verdict.value, verdict.expected
                ));
            }
        }
        for (kernel, _) in self.blind.iter().filter(|(_, blind)| **blind) {
            failures.push(format!(
                "{kernel}: a spoiled value passes, it is not judged"
            ));
        }
        if let Some(excess) = self
            .reference
            .filter(|excess| excess.is_nan() || *excess > 1.0)
        {
            failures.push(format!(
                "the reference solution differs from the solution of the declaration by {} times what is allowed",
                short(excess)
            ));
        }
        for fact in &self.broken {
            failures.push(format!(
                "{fact}: a spoiled map passes, the measurement says nothing"
            ));
        }
        for what in &self.unsound {
            failures.push(format!(
                "{what}: an equation with a known solution is not solved correctly"
            ));
        }
        failures
    }

    /// One line.
    pub fn summary(&self) -> String {
        if !self.judged {
            return "kernels: those of a family are not compared with its declaration".to_owned();
        }
        let excess = self.kernels.values().map(|verdict| verdict.excess);
        let worst = excess.fold(0.0, Scalar::max);
        let solution = self.reference.map_or(String::new(), |excess| {
            format!(
                "; the reference solution differs by {} of what is allowed",
                short(excess)
            )
        });
        format!(
            "{}, {}: at most {} of the allowed round-off away from the declaration as written{solution}",
            counted(self.kernels.len() as u64, "kernel"),
            counted(self.samples as u64, "sample"),
            short(worst),
        )
    }

    /// How far each kernel is from the declaration, in units of the round-off allowed; none of a family.
    pub fn kernels(&self) -> Option<BTreeMap<&str, f64>> {
        let kernels = self.kernels.iter();
        let excess = kernels.map(|(name, verdict)| (name.as_str(), verdict.excess));
        self.judged.then(|| excess.collect())
    }

    /// How far the reference solution is from that of the declaration, in units of what is allowed, where the judge has one.
    pub fn reference_excess(&self) -> Option<f64> {
        self.reference
    }

    /// The same as data.
    pub fn as_json(&self) -> Value {
        let kernels = self.kernels().map(|kernels| {
            let named = kernels.into_iter();
            named
                .map(|(name, excess)| (name.to_owned(), number(excess)))
                .collect::<serde_json::Map<String, Value>>()
        });
        json!({
            "kernels": kernels,
            "reference": self.reference.map(number),
            "broken_measurements": self.broken,
            "unsound_iterations": self.unsound,
            "failures": self.failures(),
        })
    }
}

/// The same sample with its largest value spoiled; none of a kernel that is zero.
fn spoiled(sample: &Sample) -> Option<Sample> {
    let sizes = sample.values.iter().map(|value| value.abs());
    let largest = sizes.clone().fold(0.0, f64::max);
    let place = sizes
        .clone()
        .position(|size| size == largest && size > 0.0)?;
    let mut spoiled = sample.clone();
    spoiled.values[place] += SPOILED * largest;
    Some(spoiled)
}
