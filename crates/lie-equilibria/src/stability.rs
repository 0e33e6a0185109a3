//! The linearisation on the leaf, and what it says of stability.
//!
//! At an equilibrium the motion linearises to `L = Pi W` with the Hessian W of `H - sum_k lambda_k C_k`. On the tangent space of the leaf
//! L has its proper eigenvalues; the others are zero, one for each Casimir. Stability is decided in this order:
//!
//! 1. W is definite on the tangent space: the equilibrium is stable, as a strict extremum of H on the leaf (energy–Casimir method;
//!    J. E. Marsden and T. S. Ratiu 1999, doi:10.1007/978-0-387-21792-5). Of a member of a family it may vanish along the
//!    family; then the family is stable.
//! 2. With first integrals F_j: where F_j is stationary on the leaf, any combination with its Hessian may be definite; where it is not, W
//!    need be definite only where F_j does not change.
//! 3. An eigenvalue has a positive real part: unstable.
//! 4. All eigenvalues are imaginary: spectrally stable, which decides nothing else.

use lie_symbolic::exact::Rational;
use num_complex::Complex64 as c64;

use crate::arithmetic::Rationals;
use crate::dense::{Singular, product, restricted, symmetric_eigen, unit_vectors};
use crate::eigenvalues::eigenvalues;
use crate::exact::Proven;
use crate::integrals::{definite_exactly, with_integrals};
use crate::proof::{Axis, Facts, Inertia, facts};
use crate::system::{Equations, Shape, Sizes};

/// An eigenvalue of the Hessian below this part of the largest counts as zero.
pub(crate) const FLAT: f64 = 1e-8;
/// A real part below this part of the largest eigenvalue counts as zero.
const IMAGINARY: f64 = 1e-6;

/// What is known of stability.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stability {
    /// Stable in the sense of Lyapunov on the leaf; of a family, the family is.
    Stable,
    /// All eigenvalues are imaginary; nothing else is decided.
    Spectral,
    /// Unstable.
    Unstable,
    /// Nothing is decided.
    Undecided,
}

/// Why.
#[derive(Clone, Debug, PartialEq)]
pub enum Reason {
    /// The Hessian on the leaf is positive (or negative) definite, but along the family.
    Definite {
        /// Whether H has a minimum.
        minimum: bool,
    },
    /// It is with first integrals, by these multipliers of H and of those that are stationary.
    Integrals {
        /// That of H.
        energy: f64,
        /// Those of the integrals that are stationary.
        stationary: Vec<(String, f64)>,
        /// Those whose values are held.
        held: Vec<String>,
    },
    /// An eigenvalue has a positive real part.
    Right,
    /// All eigenvalues are imaginary.
    Imaginary {
        /// And different from each other and from zero.
        simple: bool,
    },
    /// All eigenvalues but those along the family have negative real parts.
    Attracting,
    /// No eigenvalue has a positive real part, and some beside those along the family are imaginary.
    NoneRight,
    /// The linearisation is degenerate as far as the numbers tell: a sign that decides changes within their uncertainty.
    Degenerate,
}

/// The linearisation at an equilibrium in double precision.
#[derive(Clone, Debug)]
pub struct Linearisation {
    /// The eigenvalues on the leaf.
    pub eigenvalues: Vec<c64>,
    /// Their number beside the leaf, all zero.
    pub zeros: usize,
    /// Positive, negative and zero directions of the Hessian on the leaf.
    pub inertia: Inertia,
    /// The coefficients of q, `det(s - L) = q(s^2)` on the leaf, the constant one first, scaled so that eigenvalues are about 1.
    pub even: Vec<f64>,
    /// The size of the largest eigenvalue.
    pub scale: f64,
    tangent: Vec<Vec<f64>>,
}

/// What is decided, and whether it is proven.
#[derive(Clone, Debug, PartialEq)]
pub struct Judgement {
    /// What.
    pub stability: Stability,
    /// Why.
    pub reason: Reason,
    /// Whether rational numbers or balls prove it.
    pub proven: bool,
}

impl Judgement {
    /// What is left at an equilibrium whose linearisation has a kernel, or signs that the uncertainty of numbers changes: a proof of what decides. That
    /// all eigenvalues are imaginary decides nothing there.
    pub fn of_degenerate(self) -> Self {
        match (self.proven, self.stability) {
            (false, _) => Self {
                stability: Stability::Undecided,
                reason: Reason::Degenerate,
                proven: false,
            },
            (true, Stability::Spectral) => Self {
                stability: Stability::Undecided,
                ..self
            },
            _ => self,
        }
    }
}

impl Linearisation {
    /// Of a shape; `None` where something is not finite.
    pub fn new(sizes: Sizes, shape: &Shape<f64>) -> Option<Self> {
        let Sizes { n, m, .. } = sizes;
        let tangent = match m {
            0 => unit_vectors(n),
            _ => Singular::new(&shape.gradients, m, n)?.kernel(m).to_vec(),
        };
        let r = tangent.len();
        let form = restricted(&shape.hessian, n, &tangent);
        let bracket = restricted(&shape.bracket, n, &tangent);
        let motion = product(&bracket, &form, r);
        let eigenvalues = eigenvalues(&motion, r);
        Some(Self {
            inertia: signs(&symmetric_eigen(&form, r)?.0),
            zeros: m,
            scale: largest(&eigenvalues),
            even: even(&motion, r, largest(&eigenvalues)),
            eigenvalues,
            tangent,
        })
    }

    /// The largest real part of an eigenvalue, zero where it is round-off.
    pub fn growth(&self) -> f64 {
        let scale = largest(&self.eigenvalues);
        let growth = self.eigenvalues.iter().map(|z| z.re).fold(0.0, f64::max);
        if growth > IMAGINARY * scale {
            growth
        } else {
            0.0
        }
    }

    /// What is decided by numbers alone for a member of a family of this dimension.
    pub fn judge(&self, equations: &Equations, shape: &Shape<f64>, family: usize) -> Judgement {
        let numerical = |stability, reason| Judgement {
            stability,
            reason,
            proven: false,
        };
        if self.inertia.is_definite(family) {
            let minimum = self.inertia.negative == 0;
            return numerical(Stability::Stable, Reason::Definite { minimum });
        }
        if self.eigenvalues.len() < self.tangent.len() {
            return numerical(Stability::Undecided, Reason::Degenerate);
        }
        if self.growth() > 0.0 {
            return numerical(Stability::Unstable, Reason::Right);
        }
        if let Some(reason) = with_integrals(&self.tangent, equations, shape, family) {
            return numerical(Stability::Stable, reason);
        }
        let simple = self.inertia.zero == 0 && self.are_simple();
        numerical(Stability::Spectral, Reason::Imaginary { simple })
    }

    fn are_simple(&self) -> bool {
        let scale = largest(&self.eigenvalues);
        let far = |a: &c64, b: &c64| (a - b).norm() > 1e-5 * scale;
        let all = self.eigenvalues.iter().enumerate();
        all.clone()
            .all(|(i, a)| all.clone().all(|(j, b)| i == j || far(a, b)))
    }
}

/// What is decided where the equilibrium is proven to be there; what numbers say stands where no proof is found. The family of a stable
/// member is proven to be one where first integrals move along it: then H does not change along their flows.
pub fn proven(
    equations: &Equations,
    proof: &Proven,
    numerical: Judgement,
    family: usize,
) -> Judgement {
    let found = with_proof(equations, proof, numerical, family);
    let moved = match proof {
        Proven::Rational(_, shape) => moved(equations.sizes.n, shape),
        Proven::Enclosed(_) => 0,
    };
    Judgement {
        proven: found.proven && (found.stability != Stability::Stable || moved >= family),
        ..found
    }
}

/// How many dimensions the flows of first integrals span at a state.
fn moved(n: usize, shape: &Shape<Rational>) -> usize {
    let flow = |(gradient, _): &(Vec<Rational>, Vec<Rational>)| -> Vec<Rational> {
        let rows = shape.bracket.chunks(n);
        let product = |row: &[Rational]| {
            let terms = row.iter().zip(gradient);
            terms.fold(Rational::ZERO, |sum, (a, b)| &sum + &(a * b))
        };
        rows.map(product).collect()
    };
    let flows: Vec<Vec<Rational>> = shape.integrals.iter().map(flow).collect();
    lie_symbolic::exact::matrix::rank(&flows, flows.len().min(n))
}

fn with_proof(
    equations: &Equations,
    proof: &Proven,
    numerical: Judgement,
    family: usize,
) -> Judgement {
    let sizes = equations.sizes;
    let found = match proof {
        Proven::Rational(_, shape) => facts(&Rationals, sizes, shape),
        Proven::Enclosed(enclosed) => facts(&enclosed.balls, sizes, &enclosed.shape),
    };
    if let Some(judgement) = decided(found, family) {
        return judgement;
    }
    if let (Proven::Rational(_, shape), Reason::Integrals { .. }) = (proof, &numerical.reason) {
        let certain = definite_exactly(equations, shape, &numerical.reason, family);
        return Judgement {
            proven: certain.is_some(),
            ..numerical
        };
    }
    match (found.axis, &numerical.stability) {
        (Some(Axis::Imaginary { simple }), Stability::Spectral) => Judgement {
            reason: Reason::Imaginary { simple },
            proven: true,
            ..numerical
        },
        _ => numerical,
    }
}

/// What facts decide.
fn decided(found: Facts, family: usize) -> Option<Judgement> {
    let (stability, reason) = match (found.inertia, found.axis) {
        (Some(inertia), _) if inertia.is_definite(family) => {
            let minimum = inertia.negative == 0;
            (Stability::Stable, Reason::Definite { minimum })
        }
        (_, Some(Axis::Right)) => (Stability::Unstable, Reason::Right),
        _ => return None,
    };
    Some(Judgement {
        stability,
        reason,
        proven: true,
    })
}

fn largest(values: &[c64]) -> f64 {
    values.iter().map(|z| z.norm()).fold(0.0, f64::max)
}

pub(crate) fn signs(values: &[f64]) -> Inertia {
    let bound = FLAT * values.iter().map(|x| x.abs()).fold(0.0, f64::max);
    let count = |of: &dyn Fn(f64) -> bool| values.iter().filter(|x| of(**x)).count();
    Inertia {
        positive: count(&|x| x > bound),
        negative: count(&|x| x < -bound),
        zero: count(&|x| x.abs() <= bound),
    }
}

/// The coefficients of q in `det(s - M/scale) = q(s^2)`, the constant one first.
fn even(motion: &[f64], r: usize, scale: f64) -> Vec<f64> {
    let scale = scale.max(f64::MIN_POSITIVE);
    let motion: Vec<f64> = motion.iter().map(|x| x / scale).collect();
    let mut power = vec![0.0; r * r];
    let mut coefficients = vec![1.0];
    for k in 1..=r {
        let last = coefficients[k - 1];
        (0..r).for_each(|i| power[i * r + i] += last);
        power = product(&motion, &power, r);
        let trace: f64 = (0..r).map(|i| power[i * r + i]).sum();
        coefficients.push(-trace / k as f64);
    }
    coefficients.reverse();
    coefficients.into_iter().step_by(2).collect()
}
