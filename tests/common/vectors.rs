//! The reference values of `tests/data/`.

// Each test file uses its own part of this.
#![allow(dead_code)]

use serde_json::Value;

/// One file of reference values.
pub struct Reference(pub Value);

impl Reference {
    #[track_caller]
    pub fn read(path: &str) -> Self {
        let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{path}: {error}"));
        Self(serde_json::from_str(&text).unwrap_or_else(|error| panic!("{path}: {error}")))
    }

    /// Trajectory and pointwise values of a system.
    #[track_caller]
    pub fn vector(name: &str) -> Self {
        Self::read(&format!("tests/data/vectors/{name}.json"))
    }

    /// The times as they are written.
    pub fn times(&self) -> Vec<&str> {
        let times = self.0["times"].as_array().expect("times");
        times
            .iter()
            .map(|time| time.as_str().expect("a text"))
            .collect()
    }

    pub fn states(&self) -> Vec<Vec<f64>> {
        rows(&self.0["states"])
    }
}

/// A single step of a method: step size and state after it.
pub fn steps(name: &str, method: &str) -> Vec<(f64, Vec<f64>)> {
    let Reference(file) = Reference::read(&format!("tests/data/vectors/steps_{name}.json"));
    let steps = file["steps"].as_array().expect("steps");
    let of_method = steps.iter().filter(|step| step["method"] == method);
    of_method
        .map(|step| (number(&step["h"]), numbers(&step["state"])))
        .collect()
}

/// A number as text: `p/q`, or decimal with more digits than f64 holds.
#[track_caller]
pub fn number(value: &Value) -> f64 {
    let text = value.as_str().expect("a number as text");
    let float = |text: &str| {
        text.parse::<f64>()
            .unwrap_or_else(|_| panic!("the number `{text}`"))
    };
    match text.split_once('/') {
        Some((numerator, denominator)) => float(numerator) / float(denominator),
        None => float(text),
    }
}

#[track_caller]
pub fn numbers(value: &Value) -> Vec<f64> {
    value
        .as_array()
        .expect("a list")
        .iter()
        .map(number)
        .collect()
}

#[track_caller]
pub fn rows(value: &Value) -> Vec<Vec<f64>> {
    value
        .as_array()
        .expect("a list of lists")
        .iter()
        .map(numbers)
        .collect()
}
