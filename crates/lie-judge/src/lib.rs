//! A judge of generated kernels: the declaration interpreted as it was written.
//!
//! Names are looked up in the syntax tree, derivatives are taken by jets with rules of their own, brackets are read off the declared ones, and
//! systems on `T*G` or of the time are read as what they mean. Shared with what the compiler does after parsing are the values of elementary
//! functions, the order of coordinates, which of them a constraint determines, and the Casimirs that it found. Every expected value comes with a bound of the round-off that
//! the written formula has there, inputs known to one unit in their last place: a kernel that differs by many such units
//! computes something else.

#![forbid(unsafe_code)]
#![warn(missing_docs)]

mod acting;
mod constrained;
mod derivatives;
mod functions;
mod interpret;
mod kernels;
mod linear;
mod number;
mod rounded;
mod series;
mod solution;
mod system;
#[cfg(test)]
mod tests;

use kernels::{Expected, Kernels, by_rows, inputs, known};
use lie_codegen::model::Configuration;
use lie_codegen::structure::Structure;
use lie_syntax::ast::{Declaration, Energy, Expr, ExprKind};
use lie_syntax::diagnostic::{Origin, Report};
use lie_syntax::front::{Body, spec};
use linear::dot;
use number::Number;
use system::Declared;

/// A kernel that differs by so many units of its round-off is wrong.
const UNITS: f64 = 8.0;
/// A solution that differs by more than this part of the state is another.
const SOLUTION: f64 = 1e-9;
/// The same for what is only known by a limit, as a part of the largest entry.
const LIMIT: f64 = 1e-5;

/// What a kernel gave for its arguments.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// The kernel, `casimir_gradient K` for that of the Casimir K.
    pub kernel: String,
    /// Its vector arguments.
    pub arguments: Vec<Vec<f64>>,
    /// What it wrote, matrices by rows.
    pub values: Vec<f64>,
    /// The gradient of H at the state, near which the velocity of a Lagrangian is sought.
    pub velocity: Vec<f64>,
}

/// How a kernel compares with the declaration.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// The largest difference in units of what is allowed: 1 at most for a kernel that is right.
    pub excess: f64,
    /// The entry where it is.
    pub entry: usize,
    /// Its value.
    pub value: f64,
    /// What it should be.
    pub expected: f64,
}

/// The judge of one system.
#[derive(Debug)]
pub struct Judge {
    kernels: Kernels,
    /// The Casimirs of the model as they were declared, or would have been.
    casimirs: Vec<Expr>,
    /// What is recorded beside them.
    quantities: Vec<Expr>,
    /// The functions of the events.
    events: Vec<Expr>,
}

impl Judge {
    /// The judge of a spec that passed its checks, for values of the parameters.
    pub fn of_spec(text: &str, structure: &Structure, parameters: &[f64]) -> Option<Self> {
        let mut report = Report::new();
        let read = spec::read(text, &mut report);
        report.gate().ok()?;
        let Some(Body::Declaration(declaration)) = read.body else {
            return None;
        };
        Some(Self::new(&declaration, structure, parameters))
    }

    /// The judge of a declaration that passed its checks.
    pub fn new(declaration: &Declaration, structure: &Structure, parameters: &[f64]) -> Self {
        let declared = |origin: Origin| {
            let declared = declaration.casimirs.iter().map(|casimir| &casimir.value);
            let mut declared = declared.chain(declaration.recorded());
            declared.find(|value| match (value.origin, origin) {
                (Origin::Text { start: a, .. }, Origin::Text { start: b, .. }) => a == b,
                (Origin::Span(a), Origin::Span(b)) => {
                    format!("{:?}", a.span()) == format!("{:?}", b.span())
                }
                _ => false,
            })
        };
        let constraint = structure.constraint.as_ref();
        let determined = constraint.map_or_else(Vec::new, |c| c.determined.clone());
        Self {
            casimirs: structure
                .casimirs
                .iter()
                .filter_map(|c| c.written.clone().or_else(|| declared(c.origin).cloned()))
                .collect(),
            quantities: structure
                .quantities
                .iter()
                .filter_map(|q| {
                    let declared = declared(q.origin).cloned();
                    declared.or_else(|| coordinate(declaration, &q.name))
                })
                .collect(),
            events: declaration.events.iter().map(|e| e.when.clone()).collect(),
            kernels: Kernels::new(Declared {
                declaration: declaration.clone(),
                configuration: structure
                    .configuration
                    .clone()
                    .map(|reduced| Configuration {
                        momenta: reduced.momenta + determined.len(),
                        ..reduced
                    }),
                determined,
                parameters: parameters.to_vec(),
            }),
        }
    }

    /// Compares; `None` for a kernel that the judge does not know.
    pub fn judge(&self, sample: &Sample) -> Option<Verdict> {
        let (expected, of_limit) = self.expected(sample)?;
        if expected.len() != sample.values.len() {
            return Some(Verdict {
                excess: f64::INFINITY,
                entry: 0,
                value: f64::NAN,
                expected: f64::NAN,
            });
        }
        let largest = expected.iter().flatten().map(|e| e.value().abs());
        let limit = if of_limit {
            LIMIT * largest.fold(0.0, f64::max)
        } else {
            0.0
        };
        let mut worst = Verdict {
            excess: 0.0,
            entry: 0,
            value: 0.0,
            expected: 0.0,
        };
        for (entry, (&value, expected)) in sample.values.iter().zip(&expected).enumerate() {
            let Some(expected) = expected.as_ref().map(Number::known) else {
                continue;
            };
            let difference = (value - expected.value).abs();
            let allowed = UNITS * f64::EPSILON * expected.error + limit + f64::MIN_POSITIVE;
            let excess = difference / allowed;
            // a bound that is no number bounds nothing, and a kernel that is none is wrong where the declaration is one
            let excess = if expected.value.is_finite() && !value.is_finite() {
                f64::INFINITY
            } else if excess.is_nan() {
                0.0
            } else {
                excess
            };
            if excess > worst.excess {
                worst = Verdict {
                    excess,
                    entry,
                    value,
                    expected: expected.value,
                };
            }
        }
        Some(worst)
    }

    /// Whether the declaration alone does not say what a kernel should give: the matrices and the velocity of the larger
    /// algebra of a system on `T*G` or of the time are the compiler's own.
    pub fn exempts(&self, kernel: &str) -> bool {
        self.kernels.declared.configuration.is_some()
            && matches!(
                kernel,
                "triple" | "imaginary" | "lagrangian" | "momentum" | "inertia"
            )
    }

    /// How far a state at a time is from the solution of the declared equations, in units of what is allowed: 1 at most for one
    /// that is right. `None` where the solution is too much work, or not had from the declaration alone.
    pub fn solution(&self, start: &[f64], span: f64, end: &[f64]) -> Option<f64> {
        let declared = &self.kernels.declared;
        if !matches!(declared.declaration.energy, Energy::Hamiltonian(_)) {
            return None;
        }
        let (expected, _) = solution::solution(declared, start, span)?;
        let size = expected.iter().fold(0.0_f64, |m, x| f64::max(m, x.abs()));
        let pairs = expected.iter().zip(end);
        let largest = pairs.fold(0.0_f64, |m, (a, b)| {
            let gap = (a - b).abs();
            if gap.is_nan() {
                f64::INFINITY
            } else {
                m.max(gap)
            }
        });
        Some(largest / (SOLUTION * size))
    }

    /// What the kernel should give, and whether that is known by a limit alone.
    fn expected(&self, sample: &Sample) -> Option<(Expected, bool)> {
        let kernels = &self.kernels;
        let discrete = matches!(
            kernels.declared.declaration.energy,
            Energy::DiscreteLagrangian { .. }
        );
        let (name, index) = match sample.kernel.split_once(' ') {
            Some((name, index)) => (name, index.parse().ok()?),
            None => (sample.kernel.as_str(), 0),
        };
        let exact = |values: Vec<Number>| Some((known(values), false));
        match (name, sample.arguments.as_slice()) {
            ("ad", [xi, eta]) => exact(kernels.ad(xi, eta)),
            ("ad_star", [xi, mu]) => exact(kernels.ad_star(xi, mu)),
            ("ad_star_matrix", [xi]) => exact(kernels.ad_star_matrix(xi)),
            // the matrices of a larger algebra are the compiler's own
            ("triple", [x, z, mu]) if kernels.declared.configuration.is_none() => {
                exact(kernels.triple(x, z, mu)?)
            }
            ("imaginary", [xi]) if kernels.declared.configuration.is_none() => {
                let said = sample.values.first()?.round();
                let possible = if kernels.has_real_eigenvalue(xi)? {
                    0.0
                } else {
                    said
                };
                exact(vec![Number::rounded(possible, 1.0)])
            }
            ("casimirs", [mu]) => exact(self.values(&self.casimirs, mu)),
            ("quantities", [mu]) => exact(self.recorded(mu)),
            ("events", [mu]) => exact(self.values(&self.events, mu)),
            ("casimir_gradient", [mu]) => exact(kernels.slope_of(self.casimirs.get(index)?, mu)),
            ("lagrangian" | "momentum" | "inertia", [xi])
                if kernels.declared.configuration.is_none() =>
            {
                Some((self.lagrangian(name, xi), discrete))
            }
            ("discrete_lagrangian" | "discrete_slope" | "discrete_curvature", [h, x]) => {
                exact(self.discrete(name, *h.first()?, x))
            }
            ("momentum_map" | "pullback" | "pushforward" | "curvature", [z, ..]) => {
                let along = sample.arguments.get(1).map_or(&[][..], Vec::as_slice);
                exact(self.realization(name, z, along)?)
            }
            (_, [mu, ..]) => {
                let values = self.at_state(name, mu, sample)?;
                let exact = matches!(name, "poisson_matrix" | "poisson_slope");
                Some((values, discrete && !exact))
            }
            _ => None,
        }
    }

    /// The same for a kernel of the state.
    fn at_state(&self, name: &str, mu: &[f64], sample: &Sample) -> Option<Expected> {
        let at = self.kernels.at(mu, &sample.velocity);
        Some(match name {
            "hamiltonian" => known(vec![at.hamiltonian.clone()]),
            "energy" => known(vec![at.energy.clone()]),
            "gradient" => known(at.gradient.clone()),
            "hessian" => by_rows(&at.hessian),
            "poisson_matrix" => known(at.poisson.concat()),
            "poisson_slope" => at.poisson_slope(sample.arguments.get(1)?),
            // what moves along the orbit, and the force
            "vector_field" | "driven_field" => at.field(),
            "jacobian" => at.jacobian(),
            "linearize" => [at.field(), at.jacobian()].concat(),
            _ => return None,
        })
    }

    fn values(&self, functions: &[Expr], mu: &[f64]) -> Vec<Number> {
        let declared = &self.kernels.declared;
        let mu = inputs(mu);
        let value = |function: &Expr| declared.function(function, &mu);
        functions.iter().map(value).collect()
    }

    /// What is recorded: the work of what acts, minus the momentum of the time, then what is declared.
    fn recorded(&self, mu: &[f64]) -> Vec<Number> {
        let declared = &self.kernels.declared;
        let configuration = declared.configuration.as_ref();
        let configuration = configuration.filter(|_| declared.declaration.is_driven());
        let work = configuration.map(|c| Number::input(mu[c.momenta - 1]).neg());
        let others = self.values(&self.quantities, mu);
        let held = declared.configuration.iter().flat_map(|c| c.held_places());
        let inputs = held.take(declared.declaration.inputs.len());
        let inputs = inputs.map(|place| Number::input(mu[place]));
        work.into_iter().chain(others).chain(inputs).collect()
    }

    fn lagrangian(&self, name: &str, xi: &[f64]) -> Expected {
        let declared = &self.kernels.declared;
        let of = |xi: &[Number]| declared.lagrangian(xi, &[]);
        let names = ["lagrangian", "momentum"];
        known(chosen(name, names, self.kernels.function(xi, of)))
    }

    fn discrete(&self, name: &str, h: f64, x: &[f64]) -> Vec<Number> {
        let declared = &self.kernels.declared;
        let of = |x: &[Number]| declared.discrete(&Number::rounded(h, 1.0), x);
        let names = ["discrete_lagrangian", "discrete_slope"];
        chosen(name, names, self.kernels.function(x, of))
    }

    fn realization(&self, name: &str, z: &[f64], along: &[f64]) -> Option<Vec<Number>> {
        let declared = &self.kernels.declared;
        let n = declared.declaration.state.len();
        let components = (0..n).map(|k| {
            let of = |z: &[Number]| match declared.momentum_map(z) {
                Some(map) => map[k].clone(),
                None => Number::rounded(f64::NAN, 0.0),
            };
            self.kernels.function(z, of)
        });
        let components: Vec<_> = components.collect();
        let along = inputs(along);
        let combine = |of: fn(&Derivatives) -> &Vec<Number>| {
            let entries = components.first().map_or(0, |c| of(c).len());
            let sum = |place: usize| {
                let terms = components.iter().zip(&along);
                Number::sum(terms.map(|(c, xi)| of(c)[place].mul(xi)))
            };
            (0..entries).map(sum).collect::<Vec<_>>()
        };
        Some(match name {
            "momentum_map" => components.iter().map(|c| c.0.clone()).collect(),
            "pullback" => combine(|c| &c.1),
            "curvature" => combine(|c| &c.2),
            _ => components.iter().map(|c| dot(&c.1, &along)).collect(),
        })
    }
}

/// A value, its gradient, and its second derivatives row by row.
type Derivatives = (Number, Vec<Number>, Vec<Number>);

/// A declared coordinate as a function of the state, which it is with a constraint.
fn coordinate(declaration: &Declaration, name: &str) -> Option<Expr> {
    let declared = declaration.state.iter().find(|known| known.text == name)?;
    declaration.is_constrained().then(|| Expr {
        kind: ExprKind::Name {
            name: declared.text.clone(),
            index: None,
        },
        origin: declared.origin,
    })
}

/// Value, gradient or second derivatives, by the name of the kernel.
fn chosen(
    name: &str,
    [value_name, slope_name]: [&str; 2],
    (value, slope, second): Derivatives,
) -> Vec<Number> {
    if name == value_name {
        vec![value]
    } else if name == slope_name {
        slope
    } else {
        second
    }
}
