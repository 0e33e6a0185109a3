//! A spec that passed every check, with its text.

use std::sync::Arc;

use lie_codegen::structure::Structure;

use crate::message::{Message, Source};

/// A spec that passed every check.
pub struct Spec {
    /// Its text.
    pub source: Arc<Source>,
    /// What it declares.
    pub model: Structure,
}

impl Spec {
    /// The warnings of the checks.
    pub fn warnings(&self) -> Vec<Message> {
        let warnings = self.model.warnings.iter().cloned();
        warnings
            .map(|warning| Message::from_spec(&self.source, warning))
            .collect()
    }
}
