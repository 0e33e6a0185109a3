//! The pieces of H, which are looked for once.

use std::sync::OnceLock;

use super::Model;
use crate::structure::found::{self, Chosen, Found, Searched};

/// What is looked for when it is first asked for, and kept.
#[derive(Clone, Debug, Default)]
pub struct Kept {
    searched: OnceLock<Searched>,
    chosen: OnceLock<Option<Chosen>>,
}

impl Model {
    /// The ways to split H into the fewest pieces.
    pub fn splitting(&self) -> &Searched {
        self.kept.searched.get_or_init(|| found::search(self))
    }

    /// The way of them that is taken, and the order of its pieces.
    pub fn chosen(&self) -> Option<(&Found, &Chosen)> {
        let ways = &self.splitting().ways;
        let chosen = self.kept.chosen.get_or_init(|| crate::plan::chosen(self));
        let chosen = chosen.as_ref()?;
        Some((ways.get(chosen.way)?, chosen))
    }
}
