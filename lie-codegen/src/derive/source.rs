//! What kernels are derived from.

use super::Realization;
use crate::algebra::{Representation, TripleEntry};
use crate::model::{Descent, Model};
use crate::structure::group::Group;
use crate::structure::inertia::Body;
use crate::structure::one_parameter::Block as OneParameter;
use crate::structure::separable::Piece;
use crate::structure::spins::Spin;
use crate::structure::{group, inertia, separable, spins};
use crate::symbolic::{ExprId, Graph};

/// What the kernels are derived from.
#[derive(Clone, Debug)]
pub struct Source {
    /// The arena of all expressions.
    pub graph: Graph,
    /// Number of coordinates n.
    pub dimension: usize,
    /// Structure constants `(i, j, k, C_ij^k)` with `i < j`; none where the bracket is another one.
    pub constants: Vec<(usize, usize, usize, ExprId)>,
    /// The entries `(i, j, Pi_ij)`, `i < j`, of a Poisson matrix that is not that of a Lie algebra alone.
    pub poisson: Option<Vec<(usize, usize, ExprId)>>,
    /// The Hamiltonian, if it is an expression in mu; else that of the Lagrangian, by Newton's iteration.
    pub hamiltonian: Option<ExprId>,
    /// The Lagrangian, in the symbols of an element of the algebra.
    pub lagrangian: Option<ExprId>,
    /// The discrete Lagrangian, in the same symbols and the step size.
    pub discrete: Option<ExprId>,
    /// The energy: the Hamiltonian, of a system that depends on the time without the momentum of the time.
    pub energy: ExprId,
    /// The number of momenta of a system on `T*G`, which are its first coordinates.
    pub momenta: Option<usize>,
    /// The Casimirs.
    pub casimirs: Vec<ExprId>,
    /// The triple product `(a, b, c, d, T_abc^d)`, all nonzero entries, where the declared
    /// representation is closed under it.
    pub triple: Option<Vec<TripleEntry>>,
    /// The coordinate pieces of H, if it is a sum of functions of one coordinate each.
    pub pieces: Option<Vec<Piece>>,
    /// The declared realization.
    pub realization: Option<Realization>,
    /// The representation, where it carries collective methods.
    pub matrices: Option<Representation>,
    /// The group of the declared matrices, where it is not part of the state.
    pub group: Option<Group>,
    /// The summands of a direct sum of algebras so(3).
    pub spins: Option<Vec<Spin>>,
    /// The free rigid body that the system is.
    pub body: Option<Body>,
    /// The closed form of `exp(s ad*_(e_i))` for each basis element, where a method needs them.
    pub actions: Option<Vec<Option<Vec<OneParameter>>>>,
}

impl Source {
    /// A source without anything in it.
    pub fn empty(mut graph: Graph) -> Self {
        let hamiltonian = graph.integer(0);
        Self {
            graph,
            dimension: 0,
            constants: Vec::new(),
            poisson: None,
            hamiltonian: Some(hamiltonian),
            lagrangian: None,
            discrete: None,
            energy: hamiltonian,
            momenta: None,
            group: None,
            casimirs: Vec::new(),
            triple: None,
            pieces: None,
            realization: None,
            matrices: None,
            spins: None,
            body: None,
            actions: None,
        }
    }

    /// What the kernels of a model are derived from.
    pub fn of(model: &Model) -> Self {
        let mut graph = model.graph.clone();
        // What is proven was proven of normal forms; what is evaluated is what was written.
        let written = |id: ExprId| model.graph.as_written(id);
        let casimirs = model.casimirs.iter().map(|c| written(c.expr)).collect();
        if !model.is_lie_poisson() {
            let entries = model.poisson.entries.iter();
            return Source {
                dimension: model.dimension(),
                poisson: Some(
                    entries
                        .map(|(i, j, value)| (*i, *j, written(*value)))
                        .collect(),
                ),
                hamiltonian: Some(written(model.hamiltonian)),
                energy: written(model.energy),
                casimirs,
                realization: realization(model),
                ..Source::empty(graph)
            };
        }
        let body = inertia::body(model, &mut graph).ok();
        Source {
            graph,
            dimension: model.dimension(),
            constants: model.constants.entries().to_vec(),
            poisson: None,
            hamiltonian: model.has_expression().then_some(written(model.hamiltonian)),
            lagrangian: model.lagrangian.as_ref().map(|l| written(l.value)),
            discrete: model
                .lagrangian
                .as_ref()
                .and_then(|l| l.discrete.map(written)),
            energy: written(model.energy),
            momenta: model
                .configuration
                .as_ref()
                .and_then(|c| c.group.as_ref().map(|_| c.momenta)),
            casimirs,
            pieces: separable::pieces(model),
            actions: None,
            triple: model.representation.as_ref().and_then(|r| r.triple.clone()),
            group: group::group(model),
            realization: realization(model),
            matrices: model.representation.clone().filter(|r| r.dual.is_some()),
            spins: spins::spins(model),
            body,
        }
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
