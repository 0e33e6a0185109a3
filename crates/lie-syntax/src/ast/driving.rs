//! What acts beside the Hamiltonian.

use super::{Declaration, Expr, Name};
use crate::diagnostic::Origin;

/// What dissipates energy beside the forces.
#[derive(Clone, Debug)]
pub struct Dissipation {
    /// Of what kind.
    pub kind: DissipationKind,
    /// Where its kind stands.
    pub origin: Origin,
    /// The temperature of the noise that belongs to it, where there is one.
    pub temperature: Option<Expr>,
}

/// The kinds of dissipation, with matrices by rows.
#[derive(Clone, Debug)]
pub enum DissipationKind {
    /// `mu' += c ad*_{G ad*_{grad H} mu} mu`: along the coadjoint orbit.
    DoubleBracket {
        /// The strength c.
        strength: Expr,
        /// The metric G; the identity where it is absent.
        metric: Option<Vec<Vec<Expr>>>,
    },
    /// `mu' += K grad S`: what keeps H.
    Metriplectic {
        /// The entropy S.
        entropy: Expr,
        /// The metric K.
        metric: Metric,
    },
    /// `mu' -= R grad H`.
    Rayleigh {
        /// The matrix R.
        matrix: Vec<Vec<Expr>>,
    },
}

/// A symmetric matrix without negative eigenvalues.
#[derive(Clone, Debug)]
pub enum Metric {
    /// Its entries.
    Entries(Vec<Vec<Expr>>),
    /// A factor L of it: `K = L L^T`.
    Factor(Vec<Vec<Expr>>),
}

impl Dissipation {
    /// Every expression in it.
    pub fn expressions(&self) -> impl Iterator<Item = &Expr> {
        let (scalar, matrix) = match &self.kind {
            DissipationKind::DoubleBracket { strength, metric } => {
                (Some(strength), metric.as_ref())
            }
            DissipationKind::Metriplectic { entropy, metric } => {
                let (Metric::Entries(rows) | Metric::Factor(rows)) = metric;
                (Some(entropy), Some(rows))
            }
            DissipationKind::Rayleigh { matrix } => (None, Some(matrix)),
        };
        let entries = matrix.into_iter().flatten().flatten();
        scalar.into_iter().chain(&self.temperature).chain(entries)
    }

    /// The same with other expressions; `None` where there is none for one of them.
    pub fn mapped(&self, other: &mut dyn FnMut(&Expr) -> Option<Expr>) -> Option<Self> {
        let mut found = self.clone();
        let (scalar, matrix) = match &mut found.kind {
            DissipationKind::DoubleBracket { strength, metric } => {
                (Some(strength), metric.as_mut())
            }
            DissipationKind::Metriplectic { entropy, metric } => {
                let (Metric::Entries(rows) | Metric::Factor(rows)) = metric;
                (Some(entropy), Some(rows))
            }
            DissipationKind::Rayleigh { matrix } => (None, Some(matrix)),
        };
        let entries = matrix.into_iter().flatten().flatten();
        for expression in scalar
            .into_iter()
            .chain(&mut found.temperature)
            .chain(entries)
        {
            *expression = other(expression)?;
        }
        Some(found)
    }
}

/// A Wiener process W, and what it does, in the sense of Stratonovich.
#[derive(Clone, Debug)]
pub enum Noise {
    /// `mu' += ad*_{grad sigma} mu dW/dt` with a function sigma of the state.
    Hamiltonian(Expr),
    /// A force times `dW/dt`, by coordinate.
    Force(Vec<(Name, Expr)>),
}

/// A quantity that somebody outside sets, and that is held from one sampling to the next.
#[derive(Clone, Debug)]
pub struct Input {
    /// Its name.
    pub name: Name,
    /// Its value where nobody sets it.
    pub default: Expr,
    /// The time from one sampling to the next; every step where it is absent.
    pub sampling: Option<Expr>,
}

impl Declaration {
    /// Whether something acts beside the Hamiltonian, or from outside.
    pub fn is_driven(&self) -> bool {
        let acts = !self.forces.is_empty() || !self.dissipation.is_empty();
        acts || !self.noise.is_empty() || !self.inputs.is_empty()
    }

    /// The expressions of what acts beside the Hamiltonian.
    pub fn driving(&self) -> impl Iterator<Item = &Expr> {
        let forces = self.forces.iter().map(|(_, value)| value);
        let dissipation = self.dissipation.iter().flat_map(Dissipation::expressions);
        let noise = self.noise.iter().flat_map(|noise| match noise {
            Noise::Hamiltonian(value) => vec![value],
            Noise::Force(parts) => parts.iter().map(|(_, value)| value).collect(),
        });
        forces.chain(dissipation).chain(noise)
    }

    /// What acts first, as it stands in the declaration.
    pub fn place_of_driving(&self) -> Option<Origin> {
        let force = self.forces.first().map(|(name, _)| name.origin);
        let dissipation = self.dissipation.first().map(|d| d.origin);
        let noise = self.noise.first().and_then(|noise| match noise {
            Noise::Hamiltonian(value) => Some(value.origin),
            Noise::Force(parts) => parts.first().map(|(name, _)| name.origin),
        });
        let input = self.inputs.first().map(|input| input.name.origin);
        force.or(dissipation).or(noise).or(input)
    }
}
