//! What the program finds.

use crate::facts;
use lie_program::protocol::number;
use serde::{Deserialize, Serialize};

/// One message.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Found {
    /// What all measurements share.
    Ground(Ground),
    /// What a kernel gives, for a judge who knows the declaration.
    Kernel(Kernel),
    /// The end of the reference solution from a state.
    Reference(Reference),
    /// A measurement that lets a spoiled map pass.
    Broken {
        /// The fact that it measures.
        fact: String,
    },
    /// A part of the iteration that does not solve an equation with a known solution.
    Unsound {
        /// The part.
        what: String,
    },
    /// One fact of one method.
    Finding {
        /// The method.
        method: String,
        /// What was measured.
        finding: facts::Finding,
    },
    /// All facts of a method were told.
    Measured {
        /// The method.
        method: String,
    },
}

/// What all measurements share.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Ground {
    /// The step.
    #[serde(with = "number")]
    pub step: f64,
    /// The span of the reference solution.
    #[serde(with = "number")]
    pub span: f64,
    /// The relative error of the reference solution.
    #[serde(with = "number")]
    pub error: f64,
    /// States at which everything is measured.
    pub states: usize,
    /// Linear first integrals.
    pub linear: usize,
    /// First integrals of degree one and two.
    pub quadratic: usize,
}

/// A value of a kernel.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Kernel {
    /// The kernel.
    pub name: String,
    /// Its arguments.
    #[serde(with = "number::lists")]
    pub arguments: Vec<Vec<f64>>,
    /// Its values, matrices by rows.
    #[serde(with = "number::list")]
    pub values: Vec<f64>,
    /// The gradient of H at the state.
    #[serde(with = "number::list")]
    pub gradient: Vec<f64>,
}

/// A solution from one state to another.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Reference {
    /// The time between them.
    #[serde(with = "number")]
    pub span: f64,
    /// The state at the start.
    #[serde(with = "number::list")]
    pub start: Vec<f64>,
    /// That at the end.
    #[serde(with = "number::list")]
    pub end: Vec<f64>,
}
