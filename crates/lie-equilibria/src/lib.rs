//! Relative equilibria of Poisson systems `x' = Pi(x) grad H(x)` on a symplectic leaf: where they are, how they linearise, whether they
//! are stable, and how they go on in a parameter.
//!
//! On the leaf `C_k(x) = c_k` of independent Casimirs C_k the motion stands still where H is stationary,
//! `grad H(x) = sum_k lambda_k grad C_k(x)` (the energy–Casimir principle). That is a square system in `(x, lambda)`, which is
//!
//! - searched from many starts, and, where it is polynomial and small, solved by paths in the complex plane ([`Found`]);
//! - proven to have a solution, in rational numbers or in a box of balls ([`exact`]);
//! - linearised on the leaf, with a proof of what the spectrum and the Hessian say ([`stability`], [`proof`]);
//! - followed in a parameter through folds, with the changes of stability refined ([`Branch`]).
//!
//! A [`System`] is given by its expressions: one formula is evaluated in double precision, over the complex numbers, in rational numbers
//! and in balls.

#![forbid(unsafe_code)]
#![warn(missing_docs)]

mod arithmetic;
mod branch;
mod crossing;
mod curve;
mod dense;
mod descent;
mod discriminant;
mod eigenvalues;
pub mod exact;
mod family;
mod field;
mod follower;
mod homotopy;
mod integrals;
mod level;
mod low_rank;
mod low_rank_search;
mod newton;
mod place;
pub mod proof;
mod random;
mod scales;
mod scaling;
mod search;
pub mod stability;
mod system;
mod tape;
mod uncertainty;

pub use branch::{Branch, Change, ChangeKind, Point, Traced, trace};
pub use homotopy::Paths;
pub use low_rank::LowRank;
pub use newton::At;
pub use num_complex::Complex64 as c64;
pub use place::Ranks;
pub use scales::Scale;
pub use search::{Candidate, Found};
pub use stability::{Judgement, Linearisation, Reason, Stability};
pub use system::{Equations, Named, Shape, Sizes, System, shortest};

use exact::{Proven, Prover};
use lie_symbolic::exact::Rational;

/// What is known of an equilibrium being there.
#[derive(Clone, Debug, PartialEq)]
pub enum Presence {
    /// It has these coordinates, which solve the equations exactly.
    Rational(Vec<Rational>),
    /// There is exactly one in a box around the coordinates.
    Enclosed,
    /// Numbers say so.
    Numerical,
}

/// A relative equilibrium, or a member of a family of them.
#[derive(Clone, Debug)]
pub struct Equilibrium {
    /// The n coordinates.
    pub state: Vec<f64>,
    /// The multipliers lambda of the Casimirs.
    pub multipliers: Vec<f64>,
    /// H.
    pub energy: f64,
    /// By how much state and multipliers are known at least, where the equilibrium is degenerate and not proven to be there; else 0.
    pub error: f64,
    /// The dimension of the family, 0 where it is isolated.
    pub family: usize,
    /// Whether the linearisation has a kernel along which no equilibria go on, as far as the numbers tell.
    pub degenerate: bool,
    /// Whether it is certainly on another leaf than the initial state; `None` where that is open.
    pub on_other_leaf: Option<bool>,
    /// How often the search found it.
    pub hits: usize,
    /// Whether it is proven to be there.
    pub presence: Presence,
    /// The linearisation.
    pub linearisation: Linearisation,
    /// Its stability.
    pub judgement: Judgement,
}

/// Degenerate equilibria closer than this part of the scale, at the same energy, are one.
const NEAR: f64 = 1e-3;

impl Equilibrium {
    /// The same list where each degenerate equilibrium stands once: what is flat to the third order or more is found as several points, of which
    /// a rational one that is proven to be there stands for all.
    pub fn merged(all: Vec<Self>) -> Vec<Self> {
        let (mut sure, rest): (Vec<Self>, Vec<Self>) = all
            .into_iter()
            .partition(|one| one.presence != Presence::Numerical);
        let mut kept: Vec<Self> = Vec::new();
        for one in sure.drain(..).chain(rest) {
            let twin = |other: &&mut Self| {
                let apart = dense::norm(&dense::difference(&one.state, &other.state));
                let size = dense::norm(&one.state).max(dense::norm(&other.state));
                one.degenerate
                    && other.degenerate
                    && apart <= (NEAR * size).max(one.error)
                    && search::close(one.energy, other.energy)
            };
            match kept.iter_mut().find(twin) {
                Some(other) => {
                    let apart = dense::norm(&dense::difference(&one.state, &other.state));
                    other.hits += one.hits;
                    if other.presence == Presence::Numerical {
                        other.error = other.error.max(apart);
                    }
                }
                None => kept.push(one),
            }
        }
        kept.sort_by(|a, b| a.energy.total_cmp(&b.energy));
        kept
    }

    /// What is known of a solution at values of the parameters, and at the exact ones that they stand for.
    pub fn new(
        prover: &Prover<'_>,
        at: At<'_>,
        exact: &[Rational],
        candidate: &Candidate,
    ) -> Option<Self> {
        let equations = at.equations;
        let reach = if candidate.degenerate {
            candidate.reach
        } else {
            0.0
        };
        let proof = prover.prove(&candidate.y, reach, exact);
        let (mut y, mut energy, mut error) = (candidate.y.clone(), candidate.energy, 0.0);
        let presence = match &proof {
            Some(Proven::Rational(exact, shape)) => {
                y = exact.iter().map(Rational::to_f64).collect();
                energy = shape.energy.to_f64();
                Presence::Rational(exact[..equations.sizes.n].to_vec())
            }
            Some(Proven::Enclosed(found)) => {
                y.clone_from(&found.middle);
                let sure = found.shape.energy.sign();
                energy = sure.map_or(0.0, |_| found.shape.energy.to_f64());
                Presence::Enclosed
            }
            None => {
                at.round_zeros(&mut y, &mut energy);
                error = reach;
                Presence::Numerical
            }
        };
        let shape = equations.shape(&y, at.parameters);
        let shape = shape.or_else(|| equations.shape(&candidate.y, at.parameters))?;
        let linearisation = Linearisation::new(equations.sizes, &shape)?;
        let family = candidate.dimension;
        let mut judgement = linearisation.judge(equations, &shape, family);
        if let Some(proof) = &proof {
            judgement = stability::proven(equations, proof, judgement, family);
        }
        if candidate.degenerate {
            judgement = judgement.of_degenerate();
        }
        let (state, multipliers) = y.split_at(equations.sizes.n);
        Some(Self {
            state: state.to_vec(),
            multipliers: multipliers.to_vec(),
            energy,
            error,
            family,
            degenerate: candidate.degenerate,
            hits: candidate.hits,
            on_other_leaf: at.is_on_other_leaf(&candidate.y),
            presence,
            linearisation,
            judgement,
        })
    }
}
