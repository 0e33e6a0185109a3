//! Splittings of a Hamiltonian into pieces whose flows are exact.
//!
//! The simplest pieces are functions of one coordinate each ([`Coordinate`]):
//!
//! ```math
//! H(\mu) = \sum_i f_i(\mu_i), \qquad
//! \varphi^i_t(\mu) = \exp\!\left(t f_i'(\mu_i)\, \mathrm{ad}^*_{e_i}\right) \mu
//! ```
//!
//! Along the flow of a piece its coordinate is constant, so that each flow is explicit and exact. With
//! the sweeps through all n pieces, forwards and backwards,
//!
//! ```math
//! \chi_t = \varphi^n_t \circ \dots \circ \varphi^1_t, \qquad
//! \chi^*_t = \varphi^1_t \circ \dots \circ \varphi^n_t
//! ```
//!
//! a step is
//!
//! | method | one step | sweeps |
//! |---|---|---|
//! | [`Splitting1`] | `$\chi_h$` (Lie, Trotter) | 1 |
//! | [`Splitting2`] | `$\chi^*_{h/2} \circ \chi_{h/2}$` (Strang) | 2 |
//! | [`Splitting2`], near-integrable | the same with other times: [`Scheme::Saba2`], [`Scheme::Saba4`], [`Scheme::Sbab2`], [`Scheme::Sbab4`] | 4, 8, 4, 8 |
//! | [`Splitting4`] | `$\chi^*_{s_{12} h} \circ \chi_{s_{11} h} \circ \dots \circ \chi^*_{s_2 h} \circ \chi_{s_1 h}$` (Blanes, Moan: S6), or a composition of Strang steps: [`Scheme::Suzuki`], [`Scheme::TripleJump`]; near-integrable: [`Scheme::McLachlan84`] | 12, 10, 6, 10 |
//! | [`Splitting6`] | the same with 10 stages (S10), or [`Scheme::KahanLi`], [`Scheme::Yoshida`], [`Scheme::Suzuki`], [`Scheme::TripleJump`] | 20, 18, 14, 50, 18 |
//! | [`Splitting8`] | composition of Strang steps, [`Scheme::KahanLi`] or [`Scheme::SuzukiUmeno`] | 34, 30 |
//!
//! Where a sweep turns, the same piece is the last of one and the first of the next: the two are one
//! flow over the sum of the times. This holds within a step, also between the stages of a composition;
//! the last flow of a step and the first of the next are not joined, so that a step depends on nothing
//! but its state.
//!
//! Explicit, Poisson maps; they keep the coadjoint orbit and every Casimir, and the energy without
//! drift though not exactly. All but [`Splitting1`] are symmetric. A step fails only where numbers
//! overflow or H has no value.
//!
//! The pieces are by default those that were found ([`FoundPoisson`]): functions of linear forms whose elements commute, and
//! of Casimirs c of the algebra or of subalgebras, which commute with them,
//!
//! ```math
//! H(\mu) = \sum_a f_a(\langle v_{a1}, \mu\rangle, \dots, c_{a1}(\mu), \dots) + \text{Casimirs}, \qquad
//! \varphi^a_t(\mu) = \exp\Big(t \sum_i \partial_i f_a\, \mathrm{ad}^*_{v_{ai}}\Big) \prod_j
//! \exp\big(t\, \partial_j f_a\, \mathrm{ad}^*_{\nabla c_{aj}(\mu)}\big)\, \mu
//! ```
//!
//! in which all of these quantities, and so the slopes, are constant. The gradient of a Casimir of a subalgebra is constant along the flow that
//! the Casimir generates: `$|m|^2$` on se(3) turns the other vector about m and leaves m. Every quadratic H has such pieces. Casimirs of the
//! algebra generate no flow:
//! `$H - C/(2 I_2)$` of the free rigid body has two pieces, where H has three. The energy of H is kept as well, as is
//! each Casimir; where the group element is reconstructed, what was taken away moves it. Where the functions of one coordinate each are
//! as few, they are taken, and the step is that of [`Coordinate`].
//!
//! Of two pieces A, the first, and B, of which one is small, `$A + \varepsilon B$`, the near-integrable schemes have errors
//! `$O(\varepsilon h^4 + \varepsilon^2 h^2)$` (SABA2), `$O(\varepsilon h^8 + \varepsilon^2 h^2)$` (SABA4) and
//! `$O(\varepsilon h^8 + \varepsilon^2 h^4)$` (McLachlan's (8, 4)); SBAB2 and SBAB4 are for `$\varepsilon A + B$`. For more pieces
//! nothing of this holds.
//!
//! Needs: pieces ([`FoundPoisson`], [`SeparablePoisson`] for [`Coordinate`]); any Lie algebra. Linear friction, constant forces and noise along constant
//! directions are pieces behind those of H ([`DrivenFlows`]).
//!
//! References: R. I. McLachlan, "Explicit Lie–Poisson integration and the Euler equations", Physical
//! Review Letters 71 (1993) 3043–3046,
//! [doi:10.1103/PhysRevLett.71.3043](https://doi.org/10.1103/PhysRevLett.71.3043); sweeps from the
//! coefficients of a splitting in two: R. I. McLachlan, "On the numerical integration of ordinary
//! differential equations by symmetric composition methods", SIAM Journal on Scientific Computing 16
//! (1995) 151–168, [doi:10.1137/0916010](https://doi.org/10.1137/0916010); integrals of subalgebras: A. Thimm, "Integrable geodesic
//! flows on homogeneous spaces", Ergodic Theory and Dynamical Systems 1 (1981) 495–517,
//! [doi:10.1017/S0143385700001401](https://doi.org/10.1017/S0143385700001401); for the coefficients see
//! [`Scheme`].
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use super::coefficients::{Parts, Scheme};
use super::facts::{Facts, Preserves};
use super::stepper::{
    FactorSink, Method, Retraction, StepFailure, StepReport, Stepper, not_finite,
};
use crate::generic::DrivenFlows;
use crate::newton::NewtonOptions;
use crate::pieces::{FoundPoisson, PieceFlows, SeparablePoisson};
use crate::scalar::{Mask, Scalar};
use crate::state::{State, Unknown};

/// The most sweeps of a scheme.
const SWEEPS: usize = 50;

/// A splitting of order 1, 2, 4, 6 or 8; see the [module's text](self).
///
/// ```
/// use lie_core::methods::{Scheme, Splitting2, Splitting4};
/// let strang = Splitting2::new();
/// let suzuki = Splitting4::new().scheme(Scheme::Suzuki);
/// let coordinates = Splitting4::new().coordinate();
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Splitting<const ORDER: u32, K = Found> {
    scheme: Option<Scheme>,
    pieces: K,
}

/// The pieces of H by coordinates, in ascending order: those of [`SeparablePoisson`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Coordinate;

/// The pieces that were found, the one with the longest flow last: those of [`FoundPoisson`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Found;

/// The splitting of order 1, of Lie and Trotter.
pub type Splitting1 = Splitting<1>;
/// The splitting of order 2, of Strang.
pub type Splitting2 = Splitting<2>;
/// A splitting of order 4, by default that of Blanes and Moan with 6 stages.
pub type Splitting4 = Splitting<4>;
/// A splitting of order 6, by default that of Blanes and Moan with 10 stages.
pub type Splitting6 = Splitting<6>;
/// A splitting of order 8, by default the composition of Kahan and Li of 17 Strang steps.
pub type Splitting8 = Splitting<8>;

impl<const ORDER: u32> Default for Splitting<ORDER> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const ORDER: u32> Splitting<ORDER> {
    /// The splitting with the default scheme of its order.
    pub const fn new() -> Self {
        const {
            assert!(
                matches!(ORDER, 1 | 2 | 4 | 6 | 8),
                "splittings have order 1, 2, 4, 6 or 8"
            );
        }
        Self {
            scheme: Scheme::default_of_splitting(ORDER),
            pieces: Found,
        }
    }

    /// The same with the functions of one coordinate each that H is the sum of, in ascending order.
    #[must_use]
    pub const fn coordinate(self) -> Splitting<ORDER, Coordinate> {
        Splitting {
            scheme: self.scheme,
            pieces: Coordinate,
        }
    }
}

impl<const ORDER: u32, K: Copy> Splitting<ORDER, K> {
    /// The same with other coefficients.
    ///
    /// # Panics
    /// If there is no such scheme of this order (the table is in the [module's text](self)).
    #[must_use]
    pub const fn scheme(self, scheme: Scheme) -> Self {
        assert!(
            scheme.sweeps(ORDER).is_some() || scheme.composition(ORDER).is_some(),
            "there is no such splitting of this order"
        );
        Self {
            scheme: Some(scheme),
            pieces: self.pieces,
        }
    }

    /// The size of each sweep in units of the step; returns their number.
    fn sweeps<S: Scalar>(self, sizes: &mut [S; SWEEPS]) -> usize {
        let mut count = 0;
        let mut push = |size: S| {
            sizes[count] = size;
            count += 1;
        };
        let Some(scheme) = self.scheme else {
            push(Parts::ONE.number());
            return count;
        };
        if let Some(half) = scheme.sweeps(ORDER) {
            for parts in half.iter().chain(half.iter().rev()) {
                push(parts.number());
            }
        } else if let Some(half) = scheme.composition(ORDER) {
            for parts in half.iter().chain(half.iter().rev().skip(1)) {
                let size = parts.number::<S>() * Parts::HALF.number();
                push(size);
                push(size);
            }
        }
        count
    }

    /// The stepper over these flows.
    fn over<S: Scalar, F: PieceFlows<S>>(
        self,
        flows: F,
        zero: F::State,
        h: S,
    ) -> SplittingStepper<S, F> {
        let mut sizes = [S::zero(); SWEEPS];
        let count = self.sweeps(&mut sizes);
        let mut sweeps = [Sweep::default(); SWEEPS];
        let mut before = S::zero();
        for (sweep, &size) in sweeps.iter_mut().zip(&sizes[..count]) {
            *sweep = Sweep {
                turn: (before + size) * h,
                time: size * h,
            };
            before = size;
        }
        SplittingStepper {
            flows,
            sweeps,
            count,
            end: before * h,
            step: h,
            next: zero.clone(),
            factor: zero,
        }
    }
}

impl<const ORDER: u32, K> Facts for Splitting<ORDER, K> {
    const ID: &'static str = match ORDER {
        1 => "splitting1",
        2 => "splitting2",
        4 => "splitting4",
        6 => "splitting6",
        _ => "splitting8",
    };
    const ORDER: u32 = ORDER;
    const SYMMETRIC: bool = ORDER != 1;
    const EXPLICIT: bool = true;
    const PRESERVES: Preserves = Preserves::POISSON;
    const FORCES: bool = true;
}

impl<S, P, const ORDER: u32> Method<S, P> for Splitting<ORDER, Coordinate>
where
    S: Scalar,
    P: SeparablePoisson<S>,
{
    type Stepper<'a>
        = SplittingStepper<S, DrivenFlows<'a, P, P::Flows<'a>, P::State>>
    where
        P: 'a;

    fn stepper<'a>(&self, system: &'a P, h: S, _newton: &NewtonOptions) -> Self::Stepper<'a> {
        let flows = DrivenFlows::new(system, system.flows());
        self.over(flows, system.zero_state(), h)
    }
}

impl<S, P, const ORDER: u32> Method<S, P> for Splitting<ORDER>
where
    S: Scalar,
    P: FoundPoisson<S>,
{
    type Stepper<'a>
        = SplittingStepper<S, P::Found<'a>>
    where
        P: 'a;

    fn stepper<'a>(&self, system: &'a P, h: S, _newton: &NewtonOptions) -> Self::Stepper<'a> {
        self.over(system.found(), system.zero_state(), h)
    }
}

/// One sweep: the time of its first piece, joined with the last of the sweep before, and of the
/// others.
#[derive(Clone, Copy, Debug, Default)]
struct Sweep<S> {
    turn: S,
    time: S,
}

/// The stepper of a splitting.
pub struct SplittingStepper<S: Scalar, F: PieceFlows<S>> {
    flows: F,
    sweeps: [Sweep<S>; SWEEPS],
    count: usize,
    /// The time of the last piece of the last sweep.
    end: S,
    step: S,
    next: F::State,
    factor: F::State,
}

impl<S: Scalar, F: PieceFlows<S>> SplittingStepper<S, F> {
    /// One step of `next`.
    #[inline]
    fn advance(&mut self) {
        let pieces = self.flows.pieces();
        if pieces < 2 {
            if pieces == 1 {
                self.flows.flow(0, self.step, &mut self.next);
            }
            return;
        }
        let mut sweeps = self.sweeps[..self.count].iter();
        let last = loop {
            let Some(up) = sweeps.next() else { break 0 };
            self.flows.ascend(up.turn, up.time, &mut self.next);
            let Some(down) = sweeps.next() else {
                break pieces - 1;
            };
            self.flows.descend(down.turn, down.time, &mut self.next);
        };
        self.flows.flow(last, self.end, &mut self.next);
    }

    /// The same piece by piece, with the factors given away in the lanes of the mask.
    fn advance_with<K: FactorSink<F::State>>(&mut self, good: S::Mask, sink: &mut K) {
        let pieces = self.flows.pieces();
        let Self {
            flows,
            next,
            factor,
            ..
        } = self;
        let mut flow = |piece: usize, t: S| {
            flows.follow(piece, t, next, factor, &mut |factor| {
                for entry in factor.as_mut_slice() {
                    *entry = S::select(good, *entry, S::zero());
                }
                sink.push(Retraction::Exp, factor);
            });
        };
        if pieces < 2 {
            if pieces == 1 {
                flow(0, self.step);
            }
            self.give_rest(good, sink);
            return;
        }
        for (index, sweep) in self.sweeps[..self.count].iter().enumerate() {
            let place = |piece: usize| {
                if index % 2 == 0 {
                    piece
                } else {
                    pieces - 1 - piece
                }
            };
            flow(place(0), sweep.turn);
            for piece in 1..pieces - 1 {
                flow(place(piece), sweep.time);
            }
        }
        let last = if self.count.is_multiple_of(2) {
            0
        } else {
            pieces - 1
        };
        flow(last, self.end);
        self.give_rest(good, sink);
    }

    /// The factor of what H is beside the pieces, which leaves mu where it is: behind all others, at the mu of
    /// the end, it is what it is before them, at that of the beginning.
    fn give_rest<K: FactorSink<F::State>>(&mut self, good: S::Mask, sink: &mut K) {
        if self.flows.rest(self.step, &self.next, &mut self.factor) {
            for entry in self.factor.as_mut_slice() {
                *entry = S::select(good, *entry, S::zero());
            }
            sink.push(Retraction::Exp, &self.factor);
        }
    }
}

impl<S: Scalar, F: PieceFlows<S>> Stepper<S> for SplittingStepper<S, F> {
    type State = F::State;

    fn step<K: FactorSink<F::State>>(
        &mut self,
        mu: &mut F::State,
        sink: &mut K,
    ) -> Result<StepReport, StepFailure> {
        self.flows.gather(mu, &mut self.next);
        self.advance();
        let finite = self.next.finite();
        if sink.is_active() && finite.any() {
            // only at the end it is known which lanes have no factors to give away
            self.flows.gather(mu, &mut self.next);
            self.advance_with(finite, sink);
        }
        self.flows.scatter(finite, &self.next, mu);
        let report = StepReport {
            evaluations: self.count as u32,
            substeps: 1,
            ..StepReport::default()
        };
        if finite.all() {
            Ok(report)
        } else {
            Err(not_finite((!finite).bits(), report))
        }
    }
}
