//! The equations of steps: the generic ones, traced. What loops cannot give is derived, and the trace is given it.

use lie_core::generic::{self, DiscreteGradientStep, SecondKind};

use super::generating::MOST_SCHEDULED;
use super::tape::Tangents;
use super::{Generating, Kernel, Source};
use crate::derive::trace::{self, Formulas, SymbolicActions, SymbolicFunction, SymbolicGradient};
use crate::methods::{Gradient, Retraction};
use crate::structure::inertia::Body;
use crate::structure::separable;

impl Source {
    /// Residual, Jacobian and result of the Poisson midpoint rule.
    pub fn midpoint_kernels(&mut self) -> Vec<Kernel> {
        let formulas = Formulas {
            residual: "`r = u - mu - h f(m)`, `m = (mu + u)/2`",
            linearize: "`r = u - mu - h f(m)`, `m = (mu + u)/2`, and `dr/du = 1 - (h/2) Df(m)`",
            result: "`mu1 = u`",
        };
        trace::kernels(self, &formulas, |system, h| {
            trace::step(generic::Midpoint::new(system, h))
        })
        .expect("nothing is compared")
    }

    /// Residual, Jacobian and result of the spherical midpoint method.
    pub fn spherical_kernels(&mut self) -> Option<Vec<Kernel>> {
        self.spheres()?;
        let formulas = Formulas {
            residual: "`r = d - h f(w)`, `w = rho s`, `s = 2 mu + d`",
            linearize: "`r = d - h f(w)`, `w = rho s`, and `dr/dd = 1 - h rho Df(w) (1 - s s^T/s.s)`",
            result: "`mu1 = mu + d - s (2 mu.d + d.d)/s.s`",
        };
        trace::kernels(self, &formulas, |system, h| {
            let equation = generic::Spherical::new(system, h);
            trace::complete(equation, "`d = h f(mu)`").with_given("ratios")
        })
    }

    /// Residual and Jacobian of the discrete rigid body.
    pub fn discrete_body_kernels(&mut self) -> Option<Vec<Kernel>> {
        let (three, many) = (
            Formulas {
                residual: "`r = q0 u - (h/2) f(u) - mu`, `q0 = sqrt(1 - v.v)`, `v = (c h/2) grad H(u)`",
                linearize: "`r = q0 u - (h/2) f(u) - mu`, and `dr/du = q0 - u (v^T V)/q0 - (h/2) Df(u)`, `V = (c h/2) H''`",
                result: "",
            },
            Formulas {
                residual: "`r = U - (1 - X/2) M (1 + X/2)`, `X = h grad H(U)`",
                linearize: "`r = U - (1 - X/2) M (1 + X/2)`, and the entries of `1 + (Y^T R + R Y)/2 h H''`, `Y = M (1 + X/2)`",
                result: "",
            },
        );
        match self.body()? {
            Body::Three => trace::kernels(self, &three, |system, h| {
                trace::linearized(generic::DiscreteTop::new(system, h))
            }),
            Body::Many { .. } => trace::kernels(self, &many, |system, h| {
                trace::linearized(generic::DiscreteBody::new(system, h))
            }),
        }
    }

    /// Residual and Jacobian along a discrete gradient in closed form, of a polynomial H of a degree.
    pub fn discrete_gradient_kernels(&mut self, gradient: Gradient, degree: u32) -> Vec<Kernel> {
        let closed = self.closed_gradient(gradient, degree);
        let formulas = Formulas {
            residual: "`r = u - mu - h Pi(m) g(mu, u)`, `m = (mu + u)/2`",
            linearize: "`r = u - mu - h Pi(m) g(mu, u)`, `m = (mu + u)/2`, and `dr/du`",
            result: "",
        };
        let kernels = trace::kernels(self, &formulas, |system, h| {
            let system = system.with_gradient(closed);
            let step = DiscreteGradientStep::<_, _, SymbolicGradient>::new(&system, h);
            trace::linearized(step).with_given("inverse")
        });
        kernels.expect("nothing is compared")
    }

    /// Residual, Jacobian and result of the retraction method with the Cayley map.
    pub fn cayley_kernels(&mut self) -> Option<Vec<Kernel>> {
        self.triple()?;
        let formulas = Formulas {
            residual: "`r = m - ad*_x m/2 - Q_y m - mu`, `x = h grad H(m)`, `y = x/2`",
            linearize: "`r = m - ad*_x m/2 - Q_y m - mu`, `x = h grad H(m)`, `y = x/2`, and `dr/dm`",
            result: "`mu1 = mu + ad*_x m = mu + h f(m)`",
        };
        trace::kernels(self, &formulas, |system, h| {
            trace::step(generic::CayleyMidpoint::new(system, h))
        })
    }

    /// Residual, Jacobian and result of the retraction method with the exponential; `None` where that has no closed
    /// form, or derivatives swell.
    pub fn exp_kernels(&mut self) -> Option<Vec<Kernel>> {
        self.exponential.as_ref()?;
        let formulas = Formulas {
            residual: "`r = m - phi1(ad*_x) mu`, `x = h grad H(m)`",
            linearize: "`r = m - phi1(ad*_x) mu`, `x = h grad H(m)`, and `dr/dm`",
            result: "`mu1 = exp(ad*_x) mu`",
        };
        let size = self.graph.size();
        let kernels = trace::kernels(self, &formulas, |system, h| {
            trace::step(generic::ExpMidpoint::new(system, h)).deriving(Tangents::Inline)
        });
        kernels.filter(|_| self.graph.size() - size <= MOST_SCHEDULED)
    }

    /// The equation of the generating-function method in coordinates of the second kind; `None`
    /// where an action has no closed form, or derivatives swell.
    pub fn second_kind_kernels(&mut self) -> Option<Vec<Kernel>> {
        let algebra = self.lie()?.bracket.algebra()?;
        if !separable::actions(algebra).iter().all(Option::is_some) {
            return None;
        }
        let formulas = Formulas {
            residual: "`r_i = p_i - (m_(i-1))_i`, `m_i = exp(xi_i ad*_(e_i)) m_(i-1)`, `xi = grad S(p)`",
            linearize: "`r_i = p_i - (m_(i-1))_i` and `dr/dp`, by `dm_i/dxi_i = ad*_(e_i) m_i`",
            result: "`mu1 = m_n`",
        };
        let size = self.graph.size();
        let function = SymbolicFunction(Generating::Second);
        let kernels = trace::kernels(self, &formulas, |system, _| {
            let equation = SecondKind::<_, _, _, SymbolicActions>::with_actions(system, function);
            trace::complete(equation, "`p_i = (m_(i-1))_i` with `xi = grad S(mu)`")
        });
        kernels.filter(|_| self.graph.size() - size <= MOST_SCHEDULED)
    }

    /// Residual, Jacobian and result of the generating-function method with the Cayley map; `None`
    /// without a triple product, or where they swell.
    pub fn cayley_generating_kernels(&mut self, order: u32) -> Option<Vec<Kernel>> {
        self.triple()?;
        let formulas = Formulas {
            residual: "`r = p - ad*_y p - Q_y p - mu`, `y = grad S(p)/2`",
            linearize: "`r = p - ad*_y p - Q_y p - mu`, `y = grad S(p)/2`, and `dr/dp`",
            result: "`mu1 = mu + 2 ad*_y p`",
        };
        let size = self.graph.size();
        let function = SymbolicFunction(Generating::First(Retraction::Cayley, order));
        let kernels = trace::kernels(self, &formulas, |system, h| {
            trace::step(generic::CayleyRetraction::with_function(
                system, function, h,
            ))
        });
        kernels.filter(|_| self.graph.size() - size <= MOST_SCHEDULED)
    }
}
