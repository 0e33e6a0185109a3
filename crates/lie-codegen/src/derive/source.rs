//! What kernels are derived from.

use std::sync::Arc;

use super::Realization;
use crate::algebra::{Representation, TripleEntry};
use crate::model::{self, Descent, Discrete, Driving, Energy, Hamiltonian, Lagrangian, Model};
use crate::structure::Structure;
use crate::structure::exponential::Exponential;
use crate::structure::group::Group;
use crate::structure::inertia::Body;
use crate::structure::integrable::Motion;
use crate::structure::separable::Piece;
use crate::structure::spectrum::is_imaginary_identically;
use crate::structure::spins::Spin;
use crate::structure::unitary::Unitary;
use crate::structure::vectors::Vectors;
use lie_core::Clock;
use lie_symbolic::symbolic::{ExprId, Graph};

/// What the Poisson matrix is made of.
#[derive(Clone, Debug)]
pub enum Bracket {
    /// Structure constants `(i, j, k, C_ij^k)` with `i < j`: `Pi_ij = -C_ij^k mu_k`.
    Lie(Vec<(usize, usize, usize, ExprId)>),
    /// Its entries `(i, j, Pi_ij)`, `i < j`, where they are not those of a Lie algebra alone.
    Entries(Vec<(usize, usize, ExprId)>),
}

/// What the kernels are derived from: what is known of a system, and an arena for what is made of it.
#[derive(Clone, Debug)]
pub struct Source {
    /// The arena of all expressions.
    pub graph: Graph,
    /// The system with what was found of it.
    pub structure: Arc<Structure>,
    /// Number of coordinates n.
    pub dimension: usize,
    /// The Poisson matrix.
    pub bracket: Bracket,
    /// Hamiltonian and Lagrangian, as they were written.
    pub energy: Energy,
    /// The force and what damping adds to the generator, where something acts beside the Hamiltonian.
    pub driving: Option<Driving>,
    /// The Casimirs.
    pub casimirs: Vec<ExprId>,
    /// What is recorded beside them.
    pub quantities: Vec<ExprId>,
    /// The functions whose zeros are found.
    pub events: Vec<ExprId>,
    /// Functions of `ad*_x` in closed form, where a method needs them and the algebra has one.
    pub exponential: Option<Exponential>,
}

impl Source {
    /// What the kernels of a system are derived from.
    pub fn new(structure: &Structure) -> Self {
        // What is proven was proven of normal forms; what is evaluated is what was written.
        let written = |id: ExprId| structure.graph.as_written(id);
        let bracket = match &structure.bracket {
            model::Bracket::Lie(algebra) => Bracket::Lie(algebra.constants.entries().to_vec()),
            model::Bracket::General(matrix) => {
                let entries = matrix.entries.iter();
                let entries = entries.map(|(i, j, value)| (*i, *j, written(*value)));
                Bracket::Entries(entries.collect())
            }
        };
        Self {
            graph: structure.graph.clone(),
            dimension: structure.dimension(),
            bracket,
            energy: energy(structure, written),
            driving: structure.driving.as_ref().map(|driving| Driving {
                force: driving.force.iter().map(|f| written(*f)).collect(),
                ..driving.clone()
            }),
            casimirs: structure.casimirs.iter().map(|c| written(c.expr)).collect(),
            quantities: structure
                .quantities
                .iter()
                .map(|q| written(q.expr))
                .collect(),
            events: structure.events.iter().map(|e| written(e.expr)).collect(),
            exponential: None,
            structure: Arc::new(structure.clone()),
        }
    }

    /// The source with its arena, which is gone from what stays behind.
    pub(crate) fn lent(&mut self) -> Self {
        let graph = std::mem::take(&mut self.graph);
        Self {
            graph,
            ..self.clone()
        }
    }

    /// What was found of a system whose bracket is that of an algebra and nothing else.
    pub(super) fn lie(&self) -> Option<&Structure> {
        self.is_lie().then_some(&*self.structure)
    }

    /// The number of momenta of a system on `T*G`, or of one by a Lagrangian with the time beside it; they are its first coordinates.
    pub fn momenta(&self) -> Option<usize> {
        let configuration = self.lie()?.configuration.as_ref()?;
        let known = configuration.group.is_some() || self.is_transformed();
        known.then_some(configuration.momenta)
    }

    /// Whether H is the Legendre transform of a Lagrangian that is none on an algebra alone.
    pub fn is_transformed(&self) -> bool {
        self.energy.is_transformed()
    }

    fn representation(&self) -> Option<&Representation> {
        self.lie()?.bracket.representation()
    }

    /// The triple product `(a, b, c, d, T_abc^d)`, all nonzero entries, where the declared
    /// representation is closed under it.
    pub fn triple(&self) -> Option<&[TripleEntry]> {
        self.lie()?.bracket.triple()
    }

    /// Whether matrices with parameters have no real eigenvalues but 0.
    pub fn is_imaginary(&self) -> bool {
        let algebra = self.lie().and_then(|model| model.bracket.algebra());
        let alone = algebra.filter(|algebra| algebra.extension.is_none());
        let parametric = alone.and_then(|algebra| algebra.parametric.as_deref());
        parametric.is_some_and(is_imaginary_identically)
    }

    /// The representation, where it carries collective methods.
    pub fn matrices(&self) -> Option<&Representation> {
        let holds = self.structure.holds();
        self.representation().filter(|r| r.dual.is_some() && !holds)
    }

    /// The coordinates that carry the time, where H depends on it.
    pub fn clock(&self) -> Option<Clock> {
        self.structure.configuration.as_ref()?.clock()
    }

    /// The number of coordinates that were declared, without the time and the group element.
    pub(crate) fn own(&self) -> usize {
        let configuration = self.structure.configuration.as_ref();
        configuration.map_or(self.dimension, |c| c.own_momenta())
    }

    /// The coordinate pieces of H, if it is a sum of functions of one coordinate each.
    pub fn pieces(&self) -> Option<&[Piece]> {
        self.lie()?.pieces.as_deref()
    }

    /// The group of the declared matrices, where it is not part of the state.
    pub fn group(&self) -> Option<&Group> {
        self.lie()?.group.as_ref()
    }

    /// The summands of a direct sum of algebras so(3).
    pub fn spins(&self) -> Option<&[Spin]> {
        self.lie()?.spins.as_deref()
    }

    /// The same, where the time and what is held may be beside them.
    pub fn spheres(&self) -> Option<&[Spin]> {
        self.lie()?.spheres()
    }

    /// The parts of so(3) with vectors.
    pub fn vectors(&self) -> Option<&Vectors> {
        self.lie()?.vectors.as_ref()
    }

    /// The unitary representation that the declared matrices are.
    pub fn unitary(&self) -> Option<Unitary> {
        self.lie()?.unitary
    }

    /// The free rigid body that the system is.
    pub fn body(&self) -> Option<&Body> {
        self.lie()?.body.as_ref().ok()
    }

    /// The form of the flow, where it is known.
    pub fn motion(&self) -> Option<Motion> {
        self.lie()?.motion
    }

    /// The declared realization.
    pub fn realization(&self) -> Option<Realization> {
        realization(&self.structure)
    }

    /// The structure constants of an algebra.
    pub fn constants(&self) -> &[(usize, usize, usize, ExprId)] {
        match &self.bracket {
            Bracket::Lie(constants) => constants,
            Bracket::Entries(_) => &[],
        }
    }

    /// The discrete Lagrangian by which the system was declared.
    pub fn discrete(&self) -> Option<&Discrete> {
        self.energy.reduced()?.discrete.as_ref()
    }
}

/// The energy of a model as it was written.
fn energy(model: &Model, written: impl Fn(ExprId) -> ExprId) -> Energy {
    let of_l = |lagrangian: Lagrangian| Lagrangian {
        value: written(lagrangian.value),
        discrete: lagrangian.discrete.map(|discrete| Discrete {
            value: written(discrete.value),
            ..discrete
        }),
        ..lagrangian
    };
    let of_h = |hamiltonian: Hamiltonian| Hamiltonian {
        value: written(hamiltonian.value),
        energy: written(hamiltonian.energy),
        ..hamiltonian
    };
    match model.energy.clone() {
        Energy::Expression(h) => Energy::Expression(of_h(h)),
        Energy::Transformed(h) => Energy::Transformed(of_h(h)),
        Energy::Lagrangian(l, h) => Energy::Lagrangian(of_l(l), of_h(h)),
        Energy::Legendre(l, function) => Energy::Legendre(of_l(l), function),
    }
}

fn realization(model: &Model) -> Option<Realization> {
    let declared = model.realization.as_ref()?;
    Some(Realization {
        names: declared
            .names
            .iter()
            .map(|name| name.text.clone())
            .collect(),
        map: declared.map.clone(),
        start: declared.start.clone(),
        given: declared.given,
        descends: declared.descent == Descent::Closed,
    })
}
