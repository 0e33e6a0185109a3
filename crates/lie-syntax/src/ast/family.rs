//! What a declaration of a family of systems has: its sites, what differs from one to the other, and where it starts.

use super::{Expr, Name};
use crate::diagnostic::Origin;

/// An index `i + offset` (modulo the size of the family) or a constant one.
#[derive(Clone, Debug)]
pub struct Index {
    /// The running index, if there is one.
    pub variable: Option<Name>,
    /// What is added to it.
    pub offset: i64,
    /// The index along the next axis of a lattice.
    pub next: Option<Box<Index>>,
}

impl Index {
    /// The index along each axis.
    pub fn along_axes(&self) -> impl Iterator<Item = &Self> {
        std::iter::successors(Some(self), |index| index.next.as_deref())
    }
}

/// The number of sites of a family along one axis.
#[derive(Clone, Debug)]
pub enum Size {
    /// A number.
    Number(usize, Origin),
    /// The value of a parameter, which a run may set.
    Parameter(Name),
}

impl Size {
    /// It as it is written.
    pub fn text(&self) -> String {
        match self {
            Self::Number(count, _) => count.to_string(),
            Self::Parameter(name) => name.text.clone(),
        }
    }

    /// Where it stands.
    pub fn origin(&self) -> Origin {
        match self {
            Self::Number(_, origin) => *origin,
            Self::Parameter(name) => name.origin,
        }
    }
}

/// What makes a declaration that of a family `A^N`: its algebra and its state are those of a site.
#[derive(Clone, Debug)]
pub struct Family {
    /// The number of sites, of a lattice those along each axis.
    pub sizes: Vec<Size>,
    /// The indices in the names of the state.
    pub indices: Vec<Name>,
    /// What has a value for each site.
    pub data: Vec<SiteData>,
    /// Bonds between any two sites: rows `i, j, value`.
    pub bonds: Option<SiteData>,
    /// Where a run starts.
    pub start: Option<Start>,
}

/// The word for bonds, in a sum in the place of an index.
pub const BONDS: &str = "bonds";

/// A coefficient of a family that has a value for each site, `B[i]` in its sums.
#[derive(Clone, Debug)]
pub struct SiteData {
    /// Its name.
    pub name: Name,
    /// The values, site after site, of a lattice row after row and layer after layer.
    pub values: SiteValues,
    /// How many there are along each axis; one number where they are one list.
    pub shape: Vec<usize>,
    /// Where they stand.
    pub origin: Origin,
    /// Unit, for people, as Markdown within a line.
    pub unit: Option<String>,
    /// Description, for people, as Markdown.
    pub description: Option<String>,
}

/// The values of a coefficient.
#[derive(Clone, Debug)]
pub enum SiteValues {
    /// Expressions in constants.
    Written(Vec<Expr>),
    /// The numbers of a file.
    Read(Vec<f64>),
}

/// The initial state of a family.
#[derive(Clone, Debug)]
pub enum Start {
    /// A point on the unit sphere for each site, at random with a seed.
    UnitSpheres(u64),
    /// The numbers of a file in NumPy's format; the path is relative to that of the spec.
    File(Name),
}
