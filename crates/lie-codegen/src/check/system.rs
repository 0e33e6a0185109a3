//! A system whose expressions are known, and whose identities are not proven.

use super::coordinates::Whole;
use super::energy::{Declared, Motion};
use super::expressions::Lowered;
use super::{breadth, central, cocycle, derivatives, driving, exactness, matrix};
use crate::model::{Algebra, Constraint, Driving, Energy, PoissonMatrix};
use lie_symbolic::symbolic::{Graph, Symbol};
use lie_syntax::ast::Declaration;
use lie_syntax::diagnostic::Diagnostic;

/// Lowered expressions with the Hamiltonian and the Poisson matrix that they make.
pub struct System {
    /// The expressions, in the arena of the model.
    pub lowered: Lowered,
    /// An arena that may be littered, with the Poisson matrix in it.
    pub scratch: Graph,
    /// As the system has it: the opposite one of a right-invariant declaration.
    pub algebra: Option<Algebra>,
    /// The Poisson matrix.
    pub matrix: PoissonMatrix,
    /// The Hamiltonian.
    pub energy: Energy<Declared>,
    /// What acts beside it.
    pub driving: Option<Driving>,
    /// What its velocity satisfies, where the system is what that leaves.
    pub constraint: Option<Constraint>,
}

/// Finds Hamiltonian and Poisson matrix, and refuses what is too large for what comes next.
pub fn system(
    whole: &Whole<'_>,
    mut lowered: Lowered,
    name: &dyn Fn(Symbol) -> String,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<System> {
    let (declaration, configuration) = (&*whole.declaration, whole.configuration.as_ref());
    let graph = &mut lowered.graph;
    let algebra = lowered.algebra.take();
    let mut algebra = algebra.map(|algebra| algebra.into_system(declaration, graph));
    let unit = configuration
        .and_then(|c| c.clock())
        .map(|clock| clock.time + 1);
    // of an algebra with a cocycle that no extension has
    let mut declared = None;
    if let Some(plain) = algebra.take_if(|_| !lowered.brackets.is_empty()) {
        let brackets = &lowered.brackets;
        mistakes.extend(exactness::constants(brackets, graph, &lowered.parameters));
        let constants = &plain.constants;
        let identity =
            cocycle::cocycle_identity(declaration, brackets, constants, &mut graph.clone(), name);
        mistakes.extend(identity);
        algebra = configuration.zip(unit).and_then(|(c, unit)| {
            central::extension(&plain, brackets, (c.own_momenta(), unit), graph)
        });
        match algebra {
            Some(_) => lowered.brackets.clear(),
            None => declared = Some(plain.constants),
        }
    }
    let is_lie = algebra.is_some();
    let representation = algebra.as_ref().and_then(|a| a.representation.as_ref());
    let motion = Motion {
        representation,
        parametric: algebra.as_ref().and_then(|a| a.parametric.as_deref()),
        declaration,
        parameters: &lowered.parameters,
        configuration,
        is_lie,
        on_algebra: configuration.is_none() && is_lie,
    };
    let energy = motion.energy(graph, lowered.energy);
    let energy = energy.map_err(|mistake| mistakes.push(mistake)).ok()?;
    let constants = algebra.as_ref().map(|algebra| &algebra.constants);
    let constants = constants
        .or(declared.as_ref())
        .map(|constants| (constants, unit));
    let acting = std::mem::take(&mut lowered.acting);
    let defaults = lowered.parameters.iter().map(|p| p.default_value);
    let sources = driving::Sources {
        whole,
        constants,
        brackets: &lowered.brackets,
        energy: &energy,
        defaults: &defaults.collect::<Vec<_>>(),
        name,
    };
    let driving = driving::driving(graph, &sources, acting, mistakes);
    let mut scratch = graph.clone();
    let matrix = matrix::poisson_matrix(
        &mut scratch,
        declaration.dimension(),
        constants,
        &lowered.brackets,
    );
    // The matrix of an algebra is looked at here and no more: it leaves the arena as it is.
    if !is_lie {
        graph.clone_from(&scratch);
    }
    let system = System {
        lowered,
        scratch,
        algebra,
        matrix,
        energy,
        driving,
        constraint: None,
    };
    mistakes.extend(too_large(declaration, &system));
    (!super::has_errors(mistakes)).then_some(system)
}

/// Why a system is too large for what comes next.
pub fn too_large(declaration: &Declaration, system: &System) -> Option<Diagnostic> {
    let System {
        lowered,
        scratch,
        matrix,
        energy,
        ..
    } = system;
    let hamiltonian = energy.value(|hamiltonian| hamiltonian.value);
    let hamiltonian = (hamiltonian, declaration.energy.expression().origin);
    let origins = declaration.casimirs.iter().map(|c| c.value.origin);
    let casimirs = lowered.casimirs.iter().copied().zip(origins);
    let origins = declaration.integrals.iter().map(|(_, f)| f.origin);
    let integrals = lowered.integrals.iter().copied().zip(origins);
    breadth::fill(scratch, (matrix, declaration.place()), hamiltonian)
        .or_else(|| derivatives::kernels(scratch, matrix, hamiltonian, (casimirs, integrals)))
}
