//! The algebra: brackets, Jacobi identity, representation.

use crate::algebra::written::{Represented, declared_matrices};
use crate::algebra::{Parametric, Representation, StructureConstants, brackets, jacobi};
use crate::model;
use lie_symbolic::exact::{Budget, Fraction};
use lie_symbolic::symbolic::Graph;
use lie_syntax::ast::{self, Declaration, Invariance};
use lie_syntax::diagnostic::Diagnostic;
use lie_syntax::linear::{Scope, WORK};

/// A Lie algebra in which nothing is wrong.
pub struct Algebra {
    /// Structure constants, rational functions of the exact parameters.
    pub constants: StructureConstants<Fraction>,
    /// The declared matrices, where they are numbers.
    pub representation: Option<Representation>,
    /// The declared matrices, where they have parameters.
    pub parametric: Option<Parametric>,
}

impl Algebra {
    /// The algebra of the system, with its constants in the arena: of a right-invariant declaration the opposite one.
    pub fn into_system(self, declaration: &Declaration, graph: &mut Graph) -> model::Algebra {
        let turned = match declaration.invariance {
            Invariance::Left => self,
            Invariance::Right => self.opposite(),
        };
        model::Algebra {
            basis: declaration.basis().to_vec(),
            constants: turned.constants.map(|value| graph.rational_function(value)),
            exact: turned.constants,
            representation: turned.representation,
            parametric: turned.parametric.map(Box::new),
            extension: None,
        }
    }

    /// The opposite algebra: the right-invariant system is the left-invariant one on it.
    fn opposite(self) -> Self {
        let mut representation = self.representation;
        if let Some(representation) = &mut representation {
            // What is dual changes its sign with the matrices, and so does the triple product of three of them.
            let dual = representation.dual.iter_mut().flatten();
            let columns = representation.columns.iter_mut();
            let covectors = columns.flat_map(|columns| &mut columns.covectors);
            let matrices = representation
                .matrices
                .iter_mut()
                .chain(dual)
                .chain(covectors);
            for entry in matrices.flatten().flatten() {
                *entry = -&*entry;
            }
        }
        let mut parametric = self.parametric;
        let matrices = parametric.iter_mut().flat_map(|found| &mut found.matrices);
        for entry in matrices.flatten().flatten() {
            *entry = entry.neg();
        }
        Self {
            constants: self.constants.map(Fraction::neg),
            representation,
            parametric,
        }
    }
}

/// Checks everything that does not depend on the functions, so that a slip in the Hamiltonian
/// does not hide one in a bracket.
pub fn lie_algebra(
    declaration: &Declaration,
    algebra: &ast::Algebra,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<Algebra> {
    let scope = Scope::new(declaration);
    let budget = Budget::new(WORK);
    let matrices = (!algebra.matrices.is_empty()).then(|| {
        let matrices = declared_matrices(algebra, &scope, &budget);
        matrices.map_err(|found| mistakes.extend(found)).ok()
    });
    let constants = match (&algebra.brackets, &matrices) {
        (Some(declared), _) => {
            let constants = brackets::structure_constants(declared, &scope, &budget);
            let constants = constants.map_err(|found| mistakes.extend(found)).ok()?;
            if let Some(violation) = jacobi::violation(algebra, &constants, &scope, &budget) {
                mistakes.push(violation);
                return None;
            }
            constants
        }
        // Commutators of matrices satisfy the Jacobi identity.
        (None, Some(matrices)) => {
            let constants = matrices.as_ref()?.constants(&scope, &budget);
            constants.map_err(|mistake| mistakes.push(mistake)).ok()?
        }
        (None, None) => StructureConstants::new(algebra.basis.len(), Vec::new()),
    };
    let (mut representation, mut parametric) = (None, None);
    if let Some(matrices) = matrices {
        let found = matrices?.represent(&constants, &scope, &budget, mistakes);
        match found.map_err(|mistake| mistakes.push(mistake)).ok()? {
            Represented::Numbers(found) => representation = Some(found),
            Represented::Functions(mut found) => {
                found.gives_brackets = algebra.brackets.is_none();
                parametric = Some(found);
            }
        }
    }
    Some(Algebra {
        constants,
        representation,
        parametric,
    })
}
