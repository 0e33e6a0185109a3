//! Isospectral symplectic Runge–Kutta methods of Gauss, in the declared representation.
//!
//! With a matrix representation `$\rho$`, the tableau (a, b, c) of Gauss with s stages and any matrix W of
//! the momentum `$\mathrm{tr}(W \rho(e_k)) = \mu_k$`:
//!
//! ```math
//! x_i = h\, \nabla H(m_i), \qquad B_i = -\rho(x_i), \qquad
//! Q_i = 1 + \sum_j a_{ij} B_j Q_j, \qquad T_i = 1 - \sum_j a_{ij} T_j B_j
//! ```
//!
//! ```math
//! m_i[k] = \mathrm{tr}\bigl(W\, T_i\, \rho(e_k)\, Q_i\bigr), \qquad
//! \mu_1 = \mu + \sum_i b_i\, \mathrm{ad}^*_{x_i} m_i
//! ```
//!
//! It is the Gauss method on `T*V`, V the space of the representation, for the Hamiltonian `H o J` with
//! `J_k(q, p) = -p rho(e_k) q`, written in g* alone: the coordinates (q, p) do not appear. Order 2s,
//! symmetric, a Poisson map; keeps every Casimir and the coadjoint orbit, and the energy without drift
//! though not exactly. The unknowns are the stage momenta `m_i`.
//!
//! With one stage and a representation closed under `(abc + cba)/2` the step is that of
//! [`LieMidpoint::cayley`](super::LieMidpoint::cayley), whose equation is used.
//!
//! [`Collective`](super::Collective) is the same method under the name that it has as a symplectic method
//! on `T*V`, and can take the Hopf map instead.
//!
//! Needs: a representation whose closure under `(abc + cba)/2` adds nothing but matrices that commute with it
//! ([`MatrixPoisson`](crate::MatrixPoisson)): those of so(n), sp(2n), u(n), se(n), associative algebras are
//! closed, su(n) becomes u(n). On others, such as the adjoint representation of su(3), the method would
//! leave the orbit. Gradient and Hessian of H. Steps are refused beyond a pole of the method, where `1 - s A B` is
//! singular for some s from 0 to 1: only matrices with real eigenvalues have one.
//!
//! References: K. Modin, M. Viviani, "Lie–Poisson methods for isospectral flows", Foundations of
//! Computational Mathematics 20 (2020) 889–921,
//! [doi:10.1007/s10208-019-09428-w](https://doi.org/10.1007/s10208-019-09428-w); R. I. McLachlan, K. Modin,
//! O. Verdier, "Collective symplectic integrators", Nonlinearity 27 (2014) 1525–1542,
//! [doi:10.1088/0951-7715/27/6/1525](https://doi.org/10.1088/0951-7715/27/6/1525).
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use super::collective::Representation;
use super::facts::{Facts, Preserves};
use super::lifted::LiftedStepper;
use super::stepper::Method;
use crate::newton::NewtonOptions;
use crate::poisson::Widen;
use crate::scalar::Scalar;
use crate::structure::ColumnPoisson;

/// The isospectral Gauss method with 1, 2 or 3 stages; see the [module's text](self).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Isospectral<const STAGES: usize>;

/// Order 2.
pub type Isospectral2 = Isospectral<1>;
/// Order 4.
pub type Isospectral4 = Isospectral<2>;
/// Order 6.
pub type Isospectral6 = Isospectral<3>;

impl<const STAGES: usize> Isospectral<STAGES> {
    /// In the declared representation.
    pub const fn new() -> Self {
        Self
    }
}

impl<const STAGES: usize> Facts for Isospectral<STAGES> {
    const ID: &'static str = match STAGES {
        1 => "isospectral2",
        2 => "isospectral4",
        _ => "isospectral6",
    };
    const ORDER: u32 = 2 * STAGES as u32;
    const SYMMETRIC: bool = true;
    const EXPLICIT: bool = false;
    const PRESERVES: Preserves = Preserves::POISSON;
    const DAMPING: bool = true;
}

by_equation!([const STAGES: usize] Isospectral<STAGES>);

/// The isospectral Gauss method with four to eight stages, which are evaluated together: in columns `x_j` and rows `y_j`,
/// which the stages move by `x_j' = -rho(xi) x_j` and `y_j' = y_j rho(xi)`, with as few columns as determine the momentum. It
/// is [`ParallelCollective`](super::ParallelCollective) over the declared representation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ParallelIsospectral<const STAGES: usize>;

/// Order 8.
pub type Isospectral8 = ParallelIsospectral<4>;
/// Order 10.
pub type Isospectral10 = ParallelIsospectral<5>;
/// Order 12.
pub type Isospectral12 = ParallelIsospectral<6>;
/// Order 14.
pub type Isospectral14 = ParallelIsospectral<7>;
/// Order 16.
pub type Isospectral16 = ParallelIsospectral<8>;

impl<const STAGES: usize> ParallelIsospectral<STAGES> {
    /// In the declared representation.
    pub const fn new() -> Self {
        Self
    }
}

impl<const STAGES: usize> Facts for ParallelIsospectral<STAGES> {
    const ID: &'static str = match STAGES {
        4 => "isospectral8",
        5 => "isospectral10",
        6 => "isospectral12",
        7 => "isospectral14",
        _ => "isospectral16",
    };
    const ORDER: u32 = 2 * STAGES as u32;
    const SYMMETRIC: bool = true;
    const EXPLICIT: bool = false;
    const FIXED_POINT: bool = true;
    const PRESERVES: Preserves = Preserves::POISSON;
    const DAMPING: bool = true;
}

impl<S, P, const STAGES: usize> Method<S, P> for ParallelIsospectral<STAGES>
where
    S: Scalar,
    P: ColumnPoisson<S> + Widen<S>,
    P::Widened: ColumnPoisson<S::Wide>,
{
    type Stepper<'a>
        = LiftedStepper<'a, S, P, Representation>
    where
        P: 'a;

    fn stepper<'a>(&self, system: &'a P, h: S, newton: &NewtonOptions) -> Self::Stepper<'a> {
        LiftedStepper::new(STAGES, system, h, newton)
    }
}
