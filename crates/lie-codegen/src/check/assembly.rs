//! The model of a system that is proven, with the degrees of its functions and the ranks of its bracket.

use super::coordinates::Whole;
use super::energy::Declared;
use super::identities::Proven;
use super::rank;
use super::system::System;
use crate::model::{Bracket, Hamiltonian, Model};
use lie_symbolic::prove::degree;

/// The model.
pub fn assemble(whole: &Whole<'_>, system: System, proven: Proven) -> Model {
    let declaration = &*whole.declaration;
    let Proven {
        mut bracket,
        mut casimirs,
        quantities,
        events,
        taken,
    } = proven;
    let System {
        lowered,
        mut scratch,
        matrix,
        energy,
        driving,
        constraint,
        ..
    } = system;
    let degree = |function| degree::degree(&scratch, function);
    if let Bracket::General(matrix) = &mut bracket {
        let mut degrees = matrix.entries.iter().map(|(.., value)| degree(*value));
        matrix.degree = degrees.try_fold(0, |most, degree| Some(most.max(degree?)));
    }
    for casimir in &mut casimirs {
        casimir.degree = degree(casimir.expr);
    }
    let energy = energy.with(|Declared { value, energy }| Hamiltonian {
        value,
        energy,
        degree: degree(value),
    });
    let initial_origins = declaration.initial.iter().flatten().map(|e| e.origin);
    let mut model = Model {
        name: declaration.name.text.clone(),
        name_origin: declaration.name.origin,
        description: declaration.description.clone(),
        references: declaration.references.clone(),
        graph: lowered.graph,
        bracket,
        coordinates: declaration.state.clone(),
        parameters: lowered.parameters,
        invariance: declaration.invariance,
        energy,
        energy_origin: declaration.energy.expression().origin,
        constraint,
        configuration: whole.configuration.clone(),
        family: None,
        driving,
        inputs: super::driving::held::inputs(declaration),
        realization: lowered.realization,
        retraction: lowered.retraction,
        declared_casimirs: casimirs,
        quantities,
        events,
        taken,
        methods: declaration.methods.clone(),
        initial: lowered.initial,
        initial_origins: initial_origins.collect(),
        attitude: lowered.attitude,
        run: declaration.run.clone(),
        generic_rank: 0,
        initial_rank: None,
    };
    rank::ranks(&mut model, &matrix, &mut scratch, &lowered.defaults);
    model
}
