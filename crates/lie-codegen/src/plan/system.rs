//! The kernels of the traits of a system.

use super::function::Function;
use super::planner::Planner;
use crate::derive::{Kernel, Shape};
use crate::methods::Choice;
use crate::model::Model;
use crate::model::{self, QuantityKind};
use crate::structure::flows;
use lie_core::{Clock, EventRule};
use lie_symbolic::prove::degree::degree;
use lie_symbolic::symbolic::Symbol;

/// What a system says of itself, and its kernels by trait.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct System {
    /// The total degree of H, if it is a polynomial.
    pub hamiltonian_degree: Option<u32>,
    /// The largest total degree of an entry of the Poisson matrix that is not linear, if all are polynomials.
    pub poisson_degree: Option<u32>,
    /// Whether the Jacobi identity is not asked of the Poisson matrix.
    pub almost_poisson: bool,
    /// Where the time is among the coordinates, if H depends on it.
    pub clock: Option<Clock>,
    /// Whether H does not depend on the time.
    pub autonomous: bool,
    /// How many functions of the time are 0 where branches of H meet.
    pub joints: usize,
    /// Whether forces act.
    pub forced: bool,
    /// Whether forces are linear and mix coordinates.
    pub force_mixes: bool,
    /// Whether the generator of the motion is not the gradient of H.
    pub damped: bool,
    /// The entropy of a metriplectic term that has a discrete form.
    pub entropy: Option<Entropy>,
    /// The inputs, each with the bits of the time between samplings where it has one.
    pub inputs: Vec<Option<u64>>,
    /// The number of Wiener processes.
    pub noises: usize,
    /// The Casimirs.
    pub casimirs: Vec<Casimir>,
    /// What is recorded beside them.
    pub quantities: Vec<Quantity>,
    /// The functions whose zeros are found.
    pub events: Vec<Event>,
    /// What the energy is.
    pub energy: Energy,
    /// Whether Hessian and Jacobian are written out: some method that was asked for solves an equation.
    pub derivatives: bool,
    /// The kernels of `Poisson`.
    pub poisson: Vec<Function>,
    /// Whether the bracket is that of a Lie algebra.
    pub lie: bool,
    /// The kernels of `LiePoisson`; none where a method needs nothing but the field.
    pub algebra: Vec<Function>,
    /// Those of them that give functions of `ad*_xi` in closed form, where there is one.
    pub exponential: Vec<Function>,
    /// The kernel of `CayleyPoisson`, where the representation is closed under the triple product.
    pub triple: Option<Function>,
    /// The kernels of `LagrangianPoisson`, of a system by its Lagrangian.
    pub lagrangian: Vec<Function>,
    /// How many coordinates are momenta with a velocity each, where not all are.
    pub velocities: Option<usize>,
    /// The kernels of `DiscreteLagrangianPoisson`, of a system by its discrete Lagrangian.
    pub discrete: Vec<Function>,
}

/// A conserved function of the bracket.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Casimir {
    /// Its name.
    pub name: String,
    /// Its total degree, if it is a polynomial.
    pub degree: Option<u32>,
    /// Whether it has several branches.
    pub multivalued: bool,
    /// Whether the motion keeps it.
    pub kept: bool,
    /// Its gradient; `None` where a method needs nothing but the field.
    pub gradient: Option<Function>,
}

/// What is known of the entropy of a metriplectic term.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Entropy {
    /// Its total degree, if it is a polynomial.
    pub degree: Option<u32>,
}

/// A function of the state that is recorded.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Quantity {
    /// Its name.
    pub name: String,
    /// What it is.
    pub kind: QuantityKind,
    /// Whether its jumps by 2 pi are taken out along a run.
    pub unwrap: bool,
    /// Whether its drift is an error of the method.
    pub conserved: bool,
}

/// A function whose zeros along a run are found.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Event {
    /// Its name.
    pub name: String,
    /// Which zeros count, and what they do.
    pub rule: EventRule,
}

/// How the energy of a state is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Energy {
    /// It is an expression.
    Expression,
    /// It is the Legendre transform of a Lagrangian, by Newton's iteration from a point of a branch.
    Legendre,
}

impl System {
    /// All kernels.
    pub fn functions(&self) -> impl Iterator<Item = &Function> {
        let gradients = self
            .casimirs
            .iter()
            .filter_map(|casimir| casimir.gradient.as_ref());
        self.poisson
            .iter()
            .chain(&self.algebra)
            .chain(&self.exponential)
            .chain(&self.triple)
            .chain(gradients)
            .chain(&self.lagrangian)
            .chain(&self.discrete)
    }
}

impl Planner<'_> {
    /// The kernels of the traits.
    pub(super) fn system(&mut self) -> System {
        let derivatives = self.needs_derivatives();
        let field_alone = self.needs_field_alone();
        // the group element is found by brackets
        let without_bracket = field_alone && self.source.group().is_none();
        let kernels = if derivatives {
            self.source.basic_kernels()
        } else {
            self.source.explicit_kernels()
        };
        let (mut poisson, mut algebra, mut triple) = (Vec::new(), Vec::new(), None);
        let mut joints = 0;
        let (gradients, others): (Vec<Kernel>, Vec<Kernel>) = kernels
            .into_iter()
            .partition(|kernel| kernel.name == "casimir_gradient");
        for kernel in others {
            match kernel.name {
                "casimirs" => {
                    let count = self.source.casimirs.len();
                    poisson.push(self.values_in_a_slice(kernel, count));
                }
                "joints" => {
                    joints = kernel.outputs();
                    poisson.push(self.values_in_a_slice(kernel, joints));
                }
                "quantities" | "events" => {
                    let count = kernel.outputs();
                    poisson.push(self.values_in_a_slice(kernel, count));
                }
                "ad" if without_bracket => {}
                "ad_star" | "ad_star_matrix" if field_alone => {}
                "ad" | "ad_star" | "ad_star_matrix" => algebra.push(self.function(&kernel)),
                "triple" => triple = Some(self.function(&kernel)),
                _ => poisson.push(self.function(&kernel)),
            }
        }
        let casimirs = self.casimir_gradients(&gradients, field_alone);
        let slopes = self.methods.is_empty() || self.methods.iter().any(Choice::follows_slopes);
        let exponential = self.source.exponential_kernels(slopes);
        let exponential = self.functions(&exponential);
        let lagrangian = self.source.lagrangian_kernels().unwrap_or_default();
        let lagrangian = self.functions(&lagrangian);
        let of_some = self.source.energy.lagrangian().filter(|l| !l.reduced);
        let velocities = of_some.map(|lagrangian| lagrangian.velocity.len());
        let discrete = self.source.discrete_kernels().unwrap_or_default();
        System {
            hamiltonian_degree: self.degree_of_h(),
            // of an algebra nothing is said: its Poisson matrix is linear
            poisson_degree: self
                .structure
                .bracket
                .matrix()
                .and_then(|matrix| matrix.degree),
            almost_poisson: self.structure.constraint.is_some(),
            clock: self.source.clock(),
            autonomous: self.is_autonomous(),
            joints,
            forced: self.source.force().is_some(),
            force_mixes: flows::force_mixes(self.structure),
            damped: self.source.is_damped(),
            entropy: self.entropy(derivatives),
            inputs: model_inputs(self.structure),
            noises: self.structure.driving.as_ref().map_or(0, |d| d.noises),
            casimirs,
            quantities: self.quantities(),
            events: self.events(),
            energy: match self.source.energy.expression() {
                Some(_) => Energy::Expression,
                None => Energy::Legendre,
            },
            derivatives,
            poisson,
            lie: self.source.is_lie(),
            algebra,
            exponential,
            triple,
            lagrangian,
            velocities,
            discrete: self.functions(&discrete),
        }
    }

    fn is_autonomous(&self) -> bool {
        let time = self
            .source
            .clock()
            .map(|clock| Symbol::Coordinate(clock.time));
        let energy = self.source.energy.expression();
        // a Legendre transform takes the time with it
        let depends =
            |time| energy.is_none_or(|h| self.source.graph.symbols(h.energy).contains(&time));
        !time.is_some_and(depends)
    }

    /// The entropy of a metriplectic term, where a method may use it.
    fn entropy(&self, derivatives: bool) -> Option<Entropy> {
        let (entropy, _) = self.source.metriplectic().filter(|_| derivatives)?;
        Some(Entropy {
            degree: degree(&self.source.graph, entropy),
        })
    }

    /// The total degree of H in the coordinates, where it is a polynomial in them.
    pub(super) fn degree_of_h(&self) -> Option<u32> {
        self.source.energy.expression()?.degree
    }

    pub(super) fn functions(&mut self, kernels: &[Kernel]) -> Vec<Function> {
        kernels.iter().map(|kernel| self.function(kernel)).collect()
    }

    /// Whether a method that is asked for solves an equation, or none is named, so that it may be any.
    fn needs_derivatives(&self) -> bool {
        let explicit = |choice: &Choice| choice.entry().is_some_and(|row| row.explicit);
        self.methods.is_empty() || !self.methods.iter().all(explicit)
    }

    /// Whether every method that is asked for needs nothing of the system but its field.
    fn needs_field_alone(&self) -> bool {
        !self.methods.is_empty() && self.methods.iter().all(Choice::follows_field)
    }

    /// All Casimirs into a slice, which has no entries that would have to be cleared.
    fn values_in_a_slice(&mut self, mut kernel: Kernel, count: usize) -> Function {
        if let Shape::Vector(indices) = &kernel.shape
            && indices.len() == count
        {
            kernel.shape = Shape::Vector((0..self.source.dimension.max(count)).collect());
        }
        self.function(&kernel)
    }

    fn quantities(&self) -> Vec<Quantity> {
        let quantities = self.structure.quantities.iter();
        let quantity = |quantity: &model::Quantity| Quantity {
            name: quantity.name.clone(),
            kind: quantity.kind,
            unwrap: quantity.unwrap,
            conserved: quantity.is_conserved(),
        };
        quantities.map(quantity).collect()
    }

    fn events(&self) -> Vec<Event> {
        let events = self.structure.events.iter();
        let event = |event: &model::Event| Event {
            name: event.name.clone(),
            rule: event.rule,
        };
        events.map(event).collect()
    }

    fn casimir_gradients(&mut self, kernels: &[Kernel], by_duals: bool) -> Vec<Casimir> {
        let model = self.structure;
        let casimirs = model.casimirs.iter().zip(kernels);
        casimirs
            .map(|(casimir, kernel)| Casimir {
                name: casimir.name.clone(),
                degree: casimir.degree,
                multivalued: casimir.multivalued,
                kept: casimir.kept,
                gradient: (!by_duals).then(|| Function {
                    label: format!("casimir_gradient {}", casimir.name),
                    ..self.function(kernel)
                }),
            })
            .collect()
    }
}

/// The times between samplings of the inputs, as bits.
fn model_inputs(model: &Model) -> Vec<Option<u64>> {
    let inputs = model.inputs.iter();
    inputs
        .map(|input| input.sampling.map(f64::to_bits))
        .collect()
}
