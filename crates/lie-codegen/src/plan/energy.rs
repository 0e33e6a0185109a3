//! Methods that keep the energy: discrete gradients, with orbits, and collocation.
//!
//! For a quadratic H the discrete gradients are the gradient at the middle: the methods along them
//! run on the equations of the midpoint rule and of Gauss collocation. For other polynomials they have
//! closed forms, which are fused; for all else the generic equation is assembled from the kernels and
//! its elimination specialised to the pattern.

use super::constants::Table;
use super::equation::{Gradient as Closed, Item, Solver, Unknown};
use super::planner::Planner;
use super::steps::Form;
use crate::methods::{Choice, Gradient, Tensor};

/// Polynomials up to this degree have fused closed forms.
const CLOSED: u32 = 6;
/// Beyond this number of nodes of H times coordinates to the power of the derivatives that are taken,
/// closed forms swell.
const LARGEST: usize = 10_000;

/// What a discrete gradient is called.
struct Names {
    /// The method.
    method: &'static str,
    /// The same with orbits.
    orbit: &'static str,
    /// The gradient.
    gradient: &'static str,
    /// Doc lines of its fused equation.
    docs: &'static [&'static str],
}

const fn names(gradient: Gradient) -> Names {
    match gradient {
        Gradient::Gonzalez => Names {
            method: "Gonzalez",
            orbit: "OrbitGonzalez",
            gradient: "GonzalezGradient",
            docs: &[
                "The midpoint discrete gradient method, unknown `u = mu1`: `u - mu - h Pi((mu + u)/2) g(mu, u) = 0`.",
            ],
        },
        Gradient::MeanValue => Names {
            method: "MeanValue",
            orbit: "OrbitMeanValue",
            gradient: "MeanValueGradient",
            docs: &[
                "The mean-value discrete gradient method, unknown `u = mu1`: `u - mu - h Pi((mu + u)/2) g(mu, u) = 0`.",
            ],
        },
        Gradient::ItohAbe => Names {
            method: "ItohAbe",
            orbit: "OrbitItohAbe",
            gradient: "ItohAbeGradient",
            docs: &[
                "The symmetrised coordinate-increment method, unknown `u = mu1`: `u - mu - h Pi((mu + u)/2) g(mu, u) = 0`.",
            ],
        },
    }
}

impl Planner<'_> {
    pub(super) fn quadratic(&self) -> bool {
        self.degree_of_h().is_some_and(|degree| degree <= 2)
    }

    /// The degree of H if discrete gradients have closed forms of reasonable size.
    fn closed(&self) -> Option<u32> {
        let hamiltonian = self.source.energy.expression()?;
        let degree = hamiltonian.degree?;
        let nodes = self.source.graph.dependencies(&[hamiltonian.value]);
        let size = (2..degree).fold(nodes.len(), |size, _| {
            size.saturating_mul(self.source.dimension)
        });
        (degree <= CLOSED && size <= LARGEST).then_some(degree)
    }

    /// The equation of a discrete gradient method.
    pub(super) fn discrete_gradient(&mut self, gradient: Gradient) -> Solver {
        if self.quadratic() {
            return self.midpoint();
        }
        let names = names(gradient);
        self.once(names.method, |planner| {
            let choice = Choice::DiscreteGradient(gradient, Tensor::Midpoint);
            let partner = planner.partner(&choice);
            if let Some(degree) = planner.closed() {
                let kernels = planner.source.discrete_gradient_kernels(gradient, degree);
                let form = Form {
                    docs: names.docs,
                    ..Form::new(names.method, gradient.name(), partner)
                };
                return planner.fused(form, &kernels);
            }
            let pattern = planner.step_pattern(gradient);
            planner.eliminated(
                partner,
                names.method,
                gradient.name(),
                Unknown::State,
                pattern,
            )
        })
    }

    /// The equation of coadjoint motion along a discrete gradient.
    pub(super) fn orbit_energy(&mut self, gradient: Gradient) -> Solver {
        // for a quadratic H all three are the mean value, by one node
        let gradient = if self.quadratic() {
            Gradient::MeanValue
        } else {
            gradient
        };
        let names = names(gradient);
        self.once(names.orbit, |planner| {
            let degree = planner.closed().filter(|degree| *degree > 2);
            if let Some(degree) = degree {
                planner.closed_gradient(gradient, degree);
            }
            let derivative = planner.derivative_pattern(gradient);
            let pattern = planner.exp_pattern(&derivative);
            let mut partner = planner.partner(&Choice::OrbitEnergy(gradient));
            if degree.is_some() {
                partner = partner.with_own_code(names.gradient);
            }
            let label = format!("orbit-energy {}", gradient.name());
            planner.eliminated(partner, names.orbit, &label, Unknown::State, pattern)
        })
    }

    /// The equation of energy-preserving collocation.
    pub(super) fn cohen_hairer(&mut self, stages: usize) -> Solver {
        if stages == 1 {
            return self.discrete_gradient(Gradient::MeanValue);
        }
        if self.quadratic() {
            return self.gauss(stages);
        }
        let order = 2 * stages;
        self.once(&format!("cohen-hairer{order}"), |planner| {
            let pattern = planner.step_pattern(Gradient::MeanValue);
            let (suffix, label) = (
                format!("CohenHairer{order}"),
                format!("cohen-hairer{order}"),
            );
            let partner = planner.partner(&Choice::CohenHairer(2 * stages as u32));
            planner.eliminated(partner, &suffix, &label, Unknown::Stages(stages), pattern)
        })
    }

    fn closed_gradient(&mut self, gradient: Gradient, degree: u32) {
        let kernels = self.source.gradient_kernels(gradient, degree);
        let mut none = Table::default();
        let functions = kernels.iter().map(|kernel| {
            let label = format!("{} gradient {}", gradient.name(), kernel.name);
            self.labelled(label, kernel, &mut none)
        });
        let functions = functions.collect();
        self.items.push(Item::Gradient(Closed {
            gradient,
            functions,
        }));
    }
}
