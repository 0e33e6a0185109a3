//! The declaration in all its coordinates: those of one site of a family, and those that a group element and the time add.

use std::borrow::Cow;

use super::family::sites::{self, SiteSums};
use super::{configuration, entries};
use crate::model::configuration::Configuration;
use lie_syntax::ast::Declaration;
use lie_syntax::diagnostic::Diagnostic;

/// A declaration whose state has all coordinates.
pub struct Whole<'a> {
    /// The declaration.
    pub declaration: Cow<'a, Declaration>,
    /// The group element and the time, where they are among the coordinates.
    pub configuration: Option<Configuration>,
    /// The sums of a family over its sites, of which the declaration has one.
    pub sums: Option<SiteSums>,
}

/// Takes the sums out of a declaration, and writes the group element and the time into it; `None` where that fails.
pub fn whole<'a>(
    declaration: &'a Declaration,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<Whole<'a>> {
    let (mut configuration, mut sums) = (None, None);
    let declaration = if let Some(family) = &declaration.family {
        let (site, found) = sites::sites(declaration, family, mistakes)?;
        sums = Some(found);
        Cow::Owned(site)
    } else if declaration.energy.has_step() && declaration.group.is_some() {
        entries::are_sound(declaration, mistakes)?;
        Cow::Borrowed(declaration)
    } else if let Some(found) = configuration::configuration(declaration, mistakes) {
        let whole = configuration::extended(declaration, &found, mistakes);
        configuration = Some(found);
        Cow::Owned(whole)
    } else {
        Cow::Borrowed(declaration)
    };
    Some(Whole {
        declaration,
        configuration,
        sums,
    })
}
