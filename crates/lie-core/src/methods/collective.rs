//! Collective symplectic methods: Gauss on a symplectic space over g*, projected.
//!
//! A linear symplectic action of g on a space with the momentum map J gives the Hamiltonian `$H \circ J$`, whose
//! flow lies over that of H. Where the matrices of the action are closed under `(abc + cba)/2`, up to matrices that
//! commute with them, the Gauss method descends to g*:
//!
//! ```math
//! \mu = J(z_0), \qquad z_1 = \Phi^{\text{Gauss}}_{H \circ J,\, h}(z_0), \qquad \mu_1 = J(z_1)
//! ```
//!
//! Order 2s with s stages, symmetric, a Poisson map; keeps every Casimir and the coadjoint orbit, and the
//! energy without drift though not exactly. The step does not depend on the point `z_0` over mu, and is
//! computed without it, in the momenta of the stages.
//!
//! * [`Collective4::representation`](Collective::representation) and its kin lift to `T*V` of the declared
//!   representation V, with `J_k(q, p) = -p rho(e_k) q`. See [`Isospectral`](super::Isospectral), which is
//!   the same method.
//! * [`Collective4::hopf`](Collective::hopf) and its kin lift to `T*R^2` by the Hopf map
//!
//!   ```math
//!   J(q, p) = \tfrac14 \bigl(2 q_1 q_2 + 2 p_1 p_2,\; 2 q_2 p_1 - 2 q_1 p_2,\;
//!   q_1^2 + p_1^2 - q_2^2 - p_2^2\bigr), \qquad |J| = \tfrac14 (q^2 + p^2)
//!   ```
//!
//!   for so(3), and for direct sums of so(3), one map for each. In quaternions z the action is a
//!   multiplication from the left, and with `B_i = -x_i/2`, `x_i = h grad H(m_i)`:
//!
//!   ```math
//!   Q_i = 1 + \sum_j a_{ij} B_j Q_j, \qquad m_i = Q_i\, \mu\, \overline{Q_i}, \qquad
//!   \mu_1 = \mu + \sum_i b_i\, \mathrm{ad}^*_{x_i} m_i
//!   ```
//!
//! * [`Collective16::quaternion`](ParallelCollective::quaternion) and its kin lift so(3)* with vectors `Gamma_a` that
//!   commute, se(3)* for a single one, to `T*H`, H the quaternions:
//!
//!   ```math
//!   J(q, P) = \bigl(\Pi = \mathrm{Im}(\bar q P),\; \Gamma_a = \bar q\, a\, q\bigr), \qquad
//!   q' = q w, \quad P' = P w + c \sum_a (a q)\, \chi_a, \quad w = \tfrac{c}{2} \Omega
//!   ```
//!
//!   with the derivatives Omega of H by Pi and `chi_a` by `Gamma_a`, and imaginary labels a that are constant: a single one is
//!   `|Gamma| k`, several are the vectors themselves at a step where q = 1. Gauss methods keep `|q|`, and commute with
//!   `q -> g q, P -> g P` and with `P -> P + s q`, by which two points over a state differ; after each step P is made
//!   orthogonal to q, along which it would drift.
//!
//! * [`Collective16::unitary`](ParallelCollective::unitary) and its kin lift over a unitary representation on `C^N`, such as those
//!   of su(N) and u(N), to `C^(N x (N-1))`. A state is `mu_k = (i/2) tr(M rho(e_k))` of a Hermitian matrix M in the span of
//!   `i rho`, and with its lowest eigenvalue
//!
//!   ```math
//!   M = \lambda_{\min} + X X^H, \qquad J_k(X) = \tfrac{i}{2}\, \mathrm{tr}\, \rho(e_k) (\lambda_{\min} + X X^H), \qquad
//!   X' = -\rho(\nabla H(J)) X
//!   ```
//!
//!   Unitary matrices from the right lead from a factor X of `M - lambda_min` to all others and commute with Gauss methods,
//!   which keep `X^H X`: so the spectrum of M stays, and points do not grow. The label `lambda_min` is a Casimir. For N = 2 it is
//!   the Hopf map. Rows beside the columns, as over `T*V`, are not needed: su(3) has 12 coordinates in the place of 36.
//!
//! From order 8 on the stages are evaluated together on the points, and two things are chosen so that the iteration is short:
//! from H the compiler takes a multiple of a quadratic Casimir where its gradient loses terms by that, which moves other points over the
//! same states; and over a representation V it takes as few columns and rows, points of `T*V^r`, as determine the momentum.
//!
//! * [`Collective4::given`](Collective::given) and its kin lift to the points of a realization that the declaration
//!   gives ([`RealizedPoisson`](crate::RealizedPoisson)). Points over mu are found by a Gauss–Newton iteration. The
//!   step does not depend on which point it is where the components of J are of degree at most two and the
//!   matrices of their flows are closed too ([`ClosedRealization`]).
//!
//! Why closed: the stages of the Gauss method over `z_0` are `Q_i z_0`, and `J_k` of such a stage is the quadratic form
//! of `T_i A_k Q_i` at `z_0`, with `A_k` the matrix of the flow of `J_k` and `T_i` the symplectic adjoint of `Q_i`. In powers
//! of h it is a series of words in the `A_k` that commutators and `(abc + cba)/2` make of them. Where all
//! of these are in the span of the `A_k`, its form is a function of mu; where some `B A_k B` is not, the step
//! depends on the point. That J generates symplectic maps, with which Gauss methods commute, is not enough: there
//! need not be enough of them to move one point over mu to any other.
//!
//! Needs: see [`MatrixPoisson`](crate::MatrixPoisson), [`UnitaryPoisson`](crate::UnitaryPoisson) and
//! [`SpinPoisson`](crate::SpinPoisson); gradient
//! and Hessian of H.
//!
//! References: R. I. McLachlan, K. Modin, O. Verdier, "Collective symplectic integrators", Nonlinearity 27
//! (2014) 1525–1542, [doi:10.1088/0951-7715/27/6/1525](https://doi.org/10.1088/0951-7715/27/6/1525).
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use super::facts::{Facts, Preserves};
use super::lifted::{LiftedStepper, StageLift};
use super::realized::RealizedStepper;
use super::stepper::Method;
use crate::newton::NewtonOptions;
use crate::poisson::{LiePoisson, Widen};
use crate::scalar::Scalar;
use crate::structure::ClosedRealization;

/// The lift to `T*V` of the declared representation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Representation;

/// The lift of so(3)* by the Hopf map.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Hopf;

/// The lift of so(3)* with vectors, of se(3)* for one, to `T*H`, H the quaternions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Quaternion;

/// The lift to `C^(N x (N-1))` over a unitary representation on `C^N`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Unitary;

/// The smallest lift of a system: the Hopf map, else quaternions, else that over a unitary representation, else columns of the
/// declared one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Smallest;

/// The lift to the points of the declared realization.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Given;

/// The collective Gauss method with 1, 2 or 3 stages; see the [module's text](self).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Collective<L, const STAGES: usize> {
    lift: L,
}

/// Order 2.
pub type Collective2<L> = Collective<L, 1>;
/// Order 4.
pub type Collective4<L> = Collective<L, 2>;
/// Order 6.
pub type Collective6<L> = Collective<L, 3>;

impl<const STAGES: usize> Collective<Representation, STAGES> {
    /// Over the declared representation.
    pub const fn representation() -> Self {
        Self {
            lift: Representation,
        }
    }
}

impl<const STAGES: usize> Collective<Hopf, STAGES> {
    /// Over so(3)* by the Hopf map.
    pub const fn hopf() -> Self {
        Self { lift: Hopf }
    }
}

impl<const STAGES: usize> Collective<Given, STAGES> {
    /// Over the declared realization.
    pub const fn given() -> Self {
        Self { lift: Given }
    }
}

impl<L, const STAGES: usize> Facts for Collective<L, STAGES> {
    const ID: &'static str = match STAGES {
        1 => "collective2",
        2 => "collective4",
        _ => "collective6",
    };
    const ORDER: u32 = 2 * STAGES as u32;
    const SYMMETRIC: bool = true;
    const EXPLICIT: bool = false;
    const PRESERVES: Preserves = Preserves::POISSON;
    const DAMPING: bool = true;
}

/// The collective Gauss method with four to eight stages, which are evaluated together on the points of the space L themselves,
/// by fixed-point iteration from the continued polynomial of the last step (see
/// [`StageParallel`](crate::generic::StageParallel)); see the [module's text](self). It goes on until the derivative of the
/// step has converged too ([`Convergence::Map`](crate::newton::Convergence::Map)), so that the executed map is a Poisson map
/// to round-off. A step on which that does not contract is refused.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ParallelCollective<L, const STAGES: usize> {
    lift: L,
}

/// Order 8.
pub type Collective8<L> = ParallelCollective<L, 4>;
/// Order 10.
pub type Collective10<L> = ParallelCollective<L, 5>;
/// Order 12.
pub type Collective12<L> = ParallelCollective<L, 6>;
/// Order 14.
pub type Collective14<L> = ParallelCollective<L, 7>;
/// Order 16.
pub type Collective16<L> = ParallelCollective<L, 8>;

impl<const STAGES: usize> ParallelCollective<Hopf, STAGES> {
    /// Over so(3)* by the Hopf map.
    pub const fn hopf() -> Self {
        Self { lift: Hopf }
    }
}

impl<const STAGES: usize> ParallelCollective<Smallest, STAGES> {
    /// Over the smallest space that there is: by the Hopf map for sums of so(3), by quaternions for so(3) with vectors, by
    /// factors of a Hermitian matrix for su(n) and u(n), else the columns of the declared representation.
    pub const fn smallest() -> Self {
        Self { lift: Smallest }
    }
}

impl<const STAGES: usize> ParallelCollective<Quaternion, STAGES> {
    /// Over so(3)* with vectors by quaternions.
    pub const fn quaternion() -> Self {
        Self { lift: Quaternion }
    }
}

impl<const STAGES: usize> ParallelCollective<Unitary, STAGES> {
    /// Over a unitary representation by factors of a Hermitian matrix.
    pub const fn unitary() -> Self {
        Self { lift: Unitary }
    }
}

impl<const STAGES: usize> ParallelCollective<Representation, STAGES> {
    /// Over the declared representation.
    pub const fn representation() -> Self {
        Self {
            lift: Representation,
        }
    }
}

impl<L, const STAGES: usize> Facts for ParallelCollective<L, STAGES> {
    const ID: &'static str = match STAGES {
        4 => "collective8",
        5 => "collective10",
        6 => "collective12",
        7 => "collective14",
        _ => "collective16",
    };
    const ORDER: u32 = 2 * STAGES as u32;
    const SYMMETRIC: bool = true;
    const EXPLICIT: bool = false;
    const FIXED_POINT: bool = true;
    const PRESERVES: Preserves = Preserves::POISSON;
    const DAMPING: bool = true;
}

impl<S, P, L, const STAGES: usize> Method<S, P> for ParallelCollective<L, STAGES>
where
    S: Scalar,
    P: LiePoisson<S> + Widen<S>,
    P::Widened: LiePoisson<S::Wide>,
    L: StageLift<S, P>,
{
    type Stepper<'a>
        = LiftedStepper<'a, S, P, L>
    where
        P: 'a;

    fn stepper<'a>(&self, system: &'a P, h: S, newton: &NewtonOptions) -> Self::Stepper<'a> {
        LiftedStepper::new(STAGES, system, h, newton)
    }
}

impl<S, P, const STAGES: usize> Method<S, P> for Collective<Given, STAGES>
where
    S: Scalar,
    P: ClosedRealization<S>,
{
    type Stepper<'a>
        = RealizedStepper<'a, S, P, STAGES>
    where
        P: 'a;

    fn stepper<'a>(&self, system: &'a P, h: S, newton: &NewtonOptions) -> Self::Stepper<'a> {
        RealizedStepper::new(system, h, newton)
    }
}

/// Lifts that are solved in the momenta of the stages.
pub trait Reduced {}
impl Reduced for Representation {}
impl Reduced for Hopf {}

by_equation!([L: Reduced, const STAGES: usize] Collective<L, STAGES>);
