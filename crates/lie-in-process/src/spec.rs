//! A spec that passed every check, with its text.

use std::sync::{Arc, OnceLock};

use lie_codegen::check::domain::{Domain, Fault};
use lie_codegen::structure::Structure;

use crate::message::{Message, Source};

/// A spec that passed every check.
pub struct Spec {
    /// Its text.
    pub source: Arc<Source>,
    /// What it declares.
    pub model: Structure,
    /// What must be finite where a run begins, derived for the first of them.
    domain: OnceLock<Domain>,
}

impl Spec {
    /// The model of a text.
    pub const fn new(source: Arc<Source>, model: Structure) -> Self {
        Self {
            source,
            model,
            domain: OnceLock::new(),
        }
    }

    /// The first thing that is not finite at a state: H, its gradient, a Casimir.
    pub fn fault(&self, state: &[f64], parameters: &[f64]) -> Option<Fault> {
        let domain = self.domain.get_or_init(|| Domain::of(&self.model));
        domain.fault(&self.model, state, parameters)
    }

    /// The warnings of the checks.
    pub fn warnings(&self) -> Vec<Message> {
        let warnings = self.model.warnings.iter().cloned();
        warnings
            .map(|warning| Message::from_spec(&self.source, warning))
            .collect()
    }
}
