//! Discrete gradients in code.

use crate::engine::ARGUMENTS;
use crate::system::Dynamic;
use lie_codegen::methods::{Choice, Gradient};
use lie_codegen::plan::{Partner, Solver};
use lie_core::family::LateMatrix;
use lie_core::generic::{
    self, DiscreteGradient, GonzalezGradient, ItohAbeGradient, MeanValueGradient,
};
use lie_runtime::{Poisson, Scalar};
use std::marker::PhantomData;

/// A generic discrete gradient.
pub trait NamedGradient {
    /// Which.
    const GRADIENT: Gradient;
}

impl<S: Scalar> NamedGradient for GonzalezGradient<S, Dynamic<S>> {
    const GRADIENT: Gradient = Gradient::Gonzalez;
}
impl<S: Scalar> NamedGradient for MeanValueGradient<S, Dynamic<S>> {
    const GRADIENT: Gradient = Gradient::MeanValue;
}
impl<S: Scalar> NamedGradient for ItohAbeGradient<S, Dynamic<S>> {
    const GRADIENT: Gradient = Gradient::ItohAbe;
}

/// The discrete gradient that `orbit-energy` moves along, as the plan has it.
pub struct Planned<S: Scalar, K> {
    form: Form<S>,
    kind: PhantomData<K>,
}

enum Form<S: Scalar> {
    Coded { gradient: Gradient, start: Vec<S> },
    Gonzalez(GonzalezGradient<S, Dynamic<S>>),
    MeanValue(MeanValueGradient<S, Dynamic<S>>),
    ItohAbe(ItohAbeGradient<S, Dynamic<S>>),
}

/// Runs the kernel of a closed form.
fn coded<S: Scalar>(
    system: &Dynamic<S>,
    (gradient, name): (Gradient, &str),
    [start, end]: [&Vec<S>; 2],
    targets: [&mut [S]; 2],
) {
    let Some((codes, functions)) = system.values.compiled.gradients.get(&gradient) else {
        unreachable!("the closed form is in the plan")
    };
    let Some(place) = functions.iter().position(|function| function.name == name) else {
        unreachable!("a closed form has both kernels")
    };
    let inverse = generic::inverse_length(system, start, end);
    let mut places: [&[S]; ARGUMENTS] = Default::default();
    for (place, argument) in places.iter_mut().zip(&functions[place].arguments) {
        *place = match argument.name {
            "mu" => start,
            "inverse" => &inverse,
            _ => end,
        };
    }
    let frame = system.values.frame(places, &[], &[]);
    system.values.run(codes[place], &frame, targets);
}

impl<S: Scalar, K: NamedGradient> DiscreteGradient<S, Dynamic<S>> for Planned<S, K> {
    fn new(system: &Dynamic<S>) -> Self {
        let choice = Choice::OrbitEnergy(K::GRADIENT);
        let partner = match system.values.compiled.solvers.get(&choice) {
            Some(Solver::Generic(partner) | Solver::Eliminated(partner, _)) => Some(partner),
            _ => None,
        };
        let form = match partner {
            Some(Partner::Catalogue {
                of: Choice::OrbitEnergy(gradient),
                along,
                ..
            }) => match along {
                Some(_) => Form::Coded {
                    gradient: *gradient,
                    start: system.zero_state(),
                },
                None => generic_form(*gradient, system),
            },
            _ => generic_form(K::GRADIENT, system),
        };
        Self {
            form,
            kind: PhantomData,
        }
    }

    fn set_start(&mut self, system: &Dynamic<S>, mu: &Vec<S>) {
        match &mut self.form {
            Form::Coded { start, .. } => start.copy_from_slice(mu),
            Form::Gonzalez(gradient) => gradient.set_start(system, mu),
            Form::MeanValue(gradient) => gradient.set_start(system, mu),
            Form::ItohAbe(gradient) => gradient.set_start(system, mu),
        }
    }

    fn value(&mut self, system: &Dynamic<S>, end: &Vec<S>, out: &mut Vec<S>) {
        match &mut self.form {
            Form::Coded { gradient, start } => {
                coded(system, (*gradient, "value"), [start, end], [out, &mut []]);
            }
            Form::Gonzalez(gradient) => gradient.value(system, end, out),
            Form::MeanValue(gradient) => gradient.value(system, end, out),
            Form::ItohAbe(gradient) => gradient.value(system, end, out),
        }
    }

    fn linearize(
        &mut self,
        system: &Dynamic<S>,
        end: &Vec<S>,
        out: &mut Vec<S>,
        slopes: &mut LateMatrix<S>,
    ) {
        match &mut self.form {
            Form::Coded { gradient, start } => {
                let targets = [out.as_mut_slice(), slopes.as_mut_slice()];
                coded(system, (*gradient, "linearize"), [start, end], targets);
            }
            Form::Gonzalez(gradient) => gradient.linearize(system, end, out, slopes),
            Form::MeanValue(gradient) => gradient.linearize(system, end, out, slopes),
            Form::ItohAbe(gradient) => gradient.linearize(system, end, out, slopes),
        }
    }

    fn resolved(&mut self, system: &Dynamic<S>, end: &Vec<S>) -> S::Mask {
        match &mut self.form {
            Form::Coded { .. } => <S::Mask as lie_runtime::Mask>::splat(true),
            Form::Gonzalez(gradient) => gradient.resolved(system, end),
            Form::MeanValue(gradient) => gradient.resolved(system, end),
            Form::ItohAbe(gradient) => gradient.resolved(system, end),
        }
    }
}

fn generic_form<S: Scalar>(gradient: Gradient, system: &Dynamic<S>) -> Form<S> {
    match gradient {
        Gradient::Gonzalez => Form::Gonzalez(GonzalezGradient::new(system)),
        Gradient::MeanValue => Form::MeanValue(MeanValueGradient::new(system)),
        Gradient::ItohAbe => Form::ItohAbe(ItohAbeGradient::new(system)),
    }
}
