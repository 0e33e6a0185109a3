//! What a system has beyond its declaration: found exactly, once, and looked up by everything that comes after.

pub mod algebra;
pub mod bracket_class;
pub mod casimirs;
mod completion;
pub mod conjugate;
pub mod directions;
mod driving;
pub mod elementwise;
pub mod exponential;
pub mod family;
pub mod flows;
pub mod found;
pub mod group;
pub mod inertia;
pub mod integrable;
pub mod integrals;
pub mod lifts;
pub mod matrices;
pub mod motions;
#[cfg(test)]
mod numbers;
pub mod one_parameter;
pub mod separable;
pub mod smoothness;
pub mod spectrum;
pub mod spins;
pub mod straight;
pub mod unitary;
pub mod vectors;

use std::ops::Deref;
use std::sync::Arc;

use crate::model::{Casimir, Model};
use lie_symbolic::prove::joints::Joint;
use lie_symbolic::symbolic::ExprId;
use lie_syntax::diagnostic::Diagnostic;

pub use completion::Search;

/// How much work is done to find what nobody declared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Effort {
    /// So much that a declaration is not slow to compile.
    Declaration,
    /// So much that a report on a system is there within seconds.
    Report,
    /// So much as somebody waits for who asks for it.
    Deep,
}

/// A checked system with everything that is found of it. Expressions are in the arena of the model, which has those that
/// were declared and behind them those that were found.
#[derive(Clone, Debug)]
pub struct Structure {
    /// What was declared.
    pub model: Arc<Model>,
    /// What is said of it that is no mistake.
    pub warnings: Vec<Diagnostic>,
    /// The independent Casimirs, the declared ones first.
    pub casimirs: Vec<Casimir>,
    /// How the search for those that were not declared ended.
    pub search: Search,
    /// Class, series and name of the algebra; none of brackets that are not linear.
    pub algebra: Option<algebra::Report>,
    /// The group of the declared matrices, where it is not part of the state.
    pub group: Option<group::Group>,
    /// The summands of a direct sum of algebras so(3).
    pub spins: Option<Vec<spins::Spin>>,
    /// Those of one beside which the time and what is held are coordinates.
    pub driven_spins: Option<Vec<spins::Spin>>,
    /// The parts of so(3) with vectors.
    pub vectors: Option<vectors::Vectors>,
    /// The unitary representation that the declared matrices are.
    pub unitary: Option<unitary::Unitary>,
    /// The smallest linear symplectic space over the system.
    pub smallest: Option<lifts::Smallest>,
    /// H without a function of Casimirs, where that makes it shorter on a space over g*.
    pub gauged: Option<ExprId>,
    /// The free rigid body that the system is, or why it is none.
    pub body: Result<inertia::Body, inertia::Other>,
    /// The form of the flow, where it is known.
    pub motion: Option<integrable::Motion>,
    /// The coordinates on which H depends, if it is a sum of functions of one of them each; else two that it mixes. None where H
    /// has no expression.
    pub separable: Option<Result<Vec<usize>, (usize, usize)>>,
    /// The pieces of H, if it is such a sum.
    pub pieces: Option<Vec<separable::Piece>>,
    /// The ways to split H into the fewest pieces with exact flows.
    pub splitting: Arc<found::Searched>,
    /// The pieces of the H of a family and of what acts on it, or why there are none; none of other systems.
    pub family_pieces: Option<Result<Arc<family::Pieces>, String>>,
    /// Which pairs of coordinates are canonical, and which triples turn.
    pub directions: Arc<directions::Directions>,
    /// Coordinates in which the bracket is constant, where it is not as it is and they are known.
    pub conjugate: Option<conjugate::Conjugate>,
    /// Where branches of H meet.
    pub joints: Vec<Joint>,
    /// Constants of the motion, or why none are looked for; none where the effort is that for a declaration.
    pub motions: Option<Result<motions::Motions, &'static str>>,
}

/// A structure has what its model has.
impl Structure {
    /// The summands of a direct sum of algebras so(3), beside which the time and what is held may be coordinates.
    pub fn spheres(&self) -> Option<&[spins::Spin]> {
        let driven = self.driven_spins.as_deref();
        self.spins.as_deref().or(driven)
    }
}

impl Deref for Structure {
    type Target = Model;

    fn deref(&self) -> &Model {
        &self.model
    }
}

// a value that any thread may have
const _: fn() = || {
    fn is_shared<T: Send + Sync>() {}
    is_shared::<Structure>();
};

/// Finds the structure of a system.
pub fn structure(mut model: Model, effort: Effort) -> Structure {
    let mut graph = model.graph.clone();
    let (mut casimirs, search) = completion::completed(&model, effort, &mut graph);
    driving::mark_kept(&model, &mut casimirs, &mut graph);
    let conjugate = conjugate::conjugate(&model, &mut graph);
    model.graph = graph;
    let (spins, vectors) = (spins::spins(&model), vectors::vectors(&model));
    let (driven_spins, spins) = match model.configuration.is_some() && model.family.is_none() {
        true => (spins, None),
        false => (None, spins),
    };
    let unitary = unitary::unitary(&model);
    let (few, many) = (spins.as_deref(), vectors.as_ref());
    let separable = separable(&model);
    let pieces = separable.as_ref().and_then(|found| {
        let coordinates = found.as_ref().ok()?;
        Some(separable::pieces(model.bracket.algebra()?, coordinates))
    });
    let splitting = found::search(&model, &casimirs, pieces.as_deref());
    let family_pieces = model.family.as_ref();
    let family_pieces =
        family_pieces.map(|family| family::pieces(&model, family, few).map(Arc::new));
    let motion = integrable::motion(&model, few);
    let directions = Arc::new(directions::directions(&model));
    let joints = smoothness::joints(&model);
    let algebra = algebra::report(
        &model,
        match effort {
            Effort::Declaration => algebra::WORK,
            Effort::Report | Effort::Deep => algebra::DEEP,
        },
    );
    let motions = match effort {
        Effort::Declaration => None,
        Effort::Report => Some(motions::WORK),
        Effort::Deep => Some(motions::DEEP),
    };
    let motions = motions.map(|work| motions::find(&model, &casimirs, work));
    let smallest = lifts::smallest(&model, few, many, unitary);
    let group = group::group(&model);
    let alone = model.family.is_none() && model.driving.is_none();
    let (body, gauged) = match model.is_lie_poisson() && alone {
        true => {
            let mut graph = model.graph.clone();
            let body = inertia::body(&model, few, &mut graph);
            let gauged = lifts::gauge(&model, (few, many, unitary), &mut graph);
            model.graph = graph;
            (body, gauged)
        }
        false => (Err(inertia::Other::Algebra), None),
    };
    Structure {
        model: Arc::new(model),
        warnings: Vec::new(),
        casimirs,
        search,
        algebra,
        group,
        spins,
        driven_spins,
        vectors,
        unitary,
        smallest,
        gauged,
        body,
        motion,
        separable,
        pieces,
        splitting: Arc::new(splitting),
        family_pieces,
        directions,
        conjugate,
        joints,
        motions,
    }
}

/// The coordinates of which H is a sum of functions of one each, or two that it mixes.
fn separable(model: &Model) -> Option<Result<Vec<usize>, (usize, usize)>> {
    let hamiltonian = model.energy.expression()?;
    let mut scratch = model.graph.clone();
    let n = model.dimension();
    Some(separable::coordinates(&mut scratch, hamiltonian.value, n))
}
