//! What kernels are derived from.

use super::Realization;
use crate::algebra::{Representation, TripleEntry};
use crate::model::{self, Descent, Discrete, Energy, Hamiltonian, Lagrangian, Model};
use crate::structure::exponential::Exponential;
use crate::structure::found::Found;
use crate::structure::group::Group;
use crate::structure::inertia::Body;
use crate::structure::integrable::{self, Motion};
use crate::structure::one_parameter::Block as OneParameter;
use crate::structure::separable::Piece;
use crate::structure::spins::Spin;
use crate::structure::vectors::Vectors;
use crate::structure::{group, inertia, lifts, separable, spins, vectors};
use crate::symbolic::{ExprId, Graph};

/// What the Poisson matrix is made of.
#[derive(Clone, Debug)]
pub enum Bracket {
    /// Structure constants `(i, j, k, C_ij^k)` with `i < j`: `Pi_ij = -C_ij^k mu_k`.
    Lie(Vec<(usize, usize, usize, ExprId)>),
    /// Its entries `(i, j, Pi_ij)`, `i < j`, where they are not those of a Lie algebra alone.
    Entries(Vec<(usize, usize, ExprId)>),
}

/// What the kernels are derived from.
#[derive(Clone, Debug)]
pub struct Source {
    /// The arena of all expressions.
    pub graph: Graph,
    /// Number of coordinates n.
    pub dimension: usize,
    /// The Poisson matrix.
    pub bracket: Bracket,
    /// Hamiltonian and Lagrangian, as they were written.
    pub energy: Energy,
    /// The number of momenta of a system on `T*G`, which are its first coordinates.
    pub momenta: Option<usize>,
    /// The Casimirs.
    pub casimirs: Vec<ExprId>,
    /// The triple product `(a, b, c, d, T_abc^d)`, all nonzero entries, where the declared
    /// representation is closed under it.
    pub triple: Option<Vec<TripleEntry>>,
    /// The coordinate pieces of H, if it is a sum of functions of one coordinate each.
    pub pieces: Option<Vec<Piece>>,
    /// The pieces of H up to Casimirs, and H without these, where a splitting is asked for.
    pub found: Option<Found>,
    /// The declared realization.
    pub realization: Option<Realization>,
    /// The representation, where it carries collective methods.
    pub matrices: Option<Representation>,
    /// The group of the declared matrices, where it is not part of the state.
    pub group: Option<Group>,
    /// The summands of a direct sum of algebras so(3).
    pub spins: Option<Vec<Spin>>,
    /// The parts of so(3) with vectors.
    pub vectors: Option<Vectors>,
    /// H without a function of Casimirs, where that makes it shorter on a space over g*.
    pub gauged: Option<ExprId>,
    /// The free rigid body that the system is.
    pub body: Option<Body>,
    /// The form of the flow, where it is known.
    pub motion: Option<Motion>,
    /// The closed form of `exp(s ad*_(e_i))` for each basis element, where a method needs them.
    pub actions: Option<Vec<Option<Vec<OneParameter>>>>,
    /// Functions of `ad*_x` in closed form, where a method needs them and the algebra has one.
    pub exponential: Option<Exponential>,
}

impl Source {
    /// A source without anything in it.
    pub fn empty(mut graph: Graph) -> Self {
        let zero = graph.integer(0);
        Self {
            graph,
            dimension: 0,
            bracket: Bracket::Lie(Vec::new()),
            energy: Energy::Expression(Hamiltonian {
                value: zero,
                energy: zero,
                degree: Some(0),
                pieces: Ok(Vec::new()),
            }),
            momenta: None,
            group: None,
            casimirs: Vec::new(),
            triple: None,
            pieces: None,
            found: None,
            realization: None,
            matrices: None,
            spins: None,
            vectors: None,
            gauged: None,
            body: None,
            motion: None,
            actions: None,
            exponential: None,
        }
    }

    /// What the kernels of a model are derived from.
    pub fn of(model: &Model) -> Self {
        let graph = model.graph.clone();
        // What is proven was proven of normal forms; what is evaluated is what was written.
        let written = |id: ExprId| model.graph.as_written(id);
        let general = Source {
            dimension: model.dimension(),
            energy: energy(model, written),
            casimirs: model.casimirs.iter().map(|c| written(c.expr)).collect(),
            realization: realization(model),
            ..Source::empty(graph)
        };
        let algebra = match &model.bracket {
            model::Bracket::Lie(algebra) => algebra,
            model::Bracket::Extended(_, matrix) | model::Bracket::General(matrix) => {
                let entries = matrix.entries.iter();
                let entries = entries.map(|(i, j, value)| (*i, *j, written(*value)));
                let bracket = Bracket::Entries(entries.collect());
                return Source { bracket, ..general };
            }
        };
        let mut graph = general.graph;
        let body = inertia::body(model, &mut graph).ok();
        let gauged = lifts::gauge(model, &mut graph);
        let representation = algebra.representation.as_ref();
        let configuration = model.configuration.as_ref();
        Source {
            graph,
            bracket: Bracket::Lie(algebra.constants.entries().to_vec()),
            momenta: configuration.and_then(|c| c.group.as_ref().map(|_| c.momenta)),
            pieces: separable::pieces(model),
            triple: representation.and_then(|r| r.triple.clone()),
            group: group::group(model),
            matrices: representation.filter(|r| r.dual.is_some()).cloned(),
            spins: spins::spins(model),
            motion: integrable::motion(model),
            vectors: vectors::vectors(model),
            gauged,
            body,
            ..general
        }
    }

    /// The structure constants of an algebra.
    pub fn constants(&self) -> &[(usize, usize, usize, ExprId)] {
        match &self.bracket {
            Bracket::Lie(constants) => constants,
            Bracket::Entries(_) => &[],
        }
    }

    /// The discrete Lagrangian by which the system was declared.
    pub fn discrete(&self) -> Option<ExprId> {
        Some(self.energy.lagrangian()?.discrete?.value)
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
