//! Runge–Kutta–Munthe-Kaas methods: a Runge–Kutta method in the algebra, one exponential per step.
//!
//! ```math
//! \sigma_i = h \sum_{j<i} a_{ij} k_j, \qquad
//! k_i = \mathrm{d}\exp^{-1}_{-\sigma_i}\!\left(\nabla H\!\left(\mathrm{Ad}^*_{\exp \sigma_i} \mu\right)\right), \qquad
//! \mu_1 = \mathrm{Ad}^*_{\exp \sigma}\, \mu, \quad \sigma = h \sum_i b_i k_i
//! ```
//!
//! The sign of `$\sigma_i$` belongs to the left-invariant convention; with the other one the order
//! falls to 2. The inverse of dexp is its series cut off,
//!
//! ```math
//! \mathrm{d}\exp^{-1}_{-\sigma}(\xi) = \xi + \tfrac12 [\sigma, \xi] + \tfrac1{12} [\sigma, [\sigma, \xi]]
//!   - \tfrac1{720} \mathrm{ad}_\sigma^4 \xi + \tfrac1{30240} \mathrm{ad}_\sigma^6 \xi - \dots
//! ```
//!
//! | method | tableau | last term kept | evaluations |
//! |---|---|---|---|
//! | [`Rkmk2`] | explicit midpoint rule | `$\mathrm{ad}_\sigma$` | 2 |
//! | [`Rkmk3`] | Kutta's method of order 3 | `$\mathrm{ad}_\sigma^2$` | 3 |
//! | [`Rkmk4`] | classical Runge–Kutta method | `$\mathrm{ad}_\sigma^3$`, whose coefficient is 0 | 4 |
//! | [`Rkmk6`] | Butcher's method of order 6 with 7 stages | `$\mathrm{ad}_\sigma^6$` | 7 |
//!
//! Explicit. They keep the coadjoint orbit and with it every Casimir; not symmetric, not Poisson maps,
//! and the energy drifts.
//!
//! Where forces act, elements x of the algebra become pairs (x, K) with a covector, of the algebra of the semidirect product of the group
//! with g*: `$\mathrm{Ad}^*_{\exp x} \mu + \varphi_1(\mathrm{ad}^*_x) K$` is their action, `$h\,(\nabla H, F)$` the slope and
//! `$([x, y],\, \mathrm{ad}^*_y K - \mathrm{ad}^*_x L)$` the bracket of (x, K) and (y, L). With these the formulas are the same, and so are the orders.
//!
//! Needs: the gradient of H, the bracket and ad*; any Lie algebra.
//!
//! References: H. Munthe-Kaas, "High order Runge–Kutta methods on manifolds", Applied Numerical
//! Mathematics 29 (1999) 115–127,
//! [doi:10.1016/S0168-9274(98)00030-0](https://doi.org/10.1016/S0168-9274(98)00030-0); the tableau
//! of order 6: J. C. Butcher, "On Runge–Kutta processes of high order", Journal of the Australian
//! Mathematical Society 4 (1964) 179–194,
//! [doi:10.1017/S1446788700023387](https://doi.org/10.1017/S1446788700023387).
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use super::explicit::{Flow, Frozen, accept, coadjoint_facts};
use super::facts::{Facts, Preserves};
use super::stepper::{FactorSink, Method, StepFailure, StepReport, Stepper};
use crate::newton::NewtonOptions;
use crate::poisson::LiePoisson;
use crate::scalar::Scalar;

/// A coefficient: numerator and denominator.
type Ratio = (f64, f64);

const ZERO: Ratio = (0.0, 1.0);
const HALF: Ratio = (1.0, 2.0);

/// An explicit tableau and how far the series of the inverse of dexp goes.
struct Tableau<const STAGES: usize> {
    /// The rows below the first stage, each as long as stages before it.
    a: &'static [&'static [Ratio]],
    b: [Ratio; STAGES],
    commutators: usize,
}

const MIDPOINT: Tableau<2> = Tableau {
    a: &[&[HALF]],
    b: [ZERO, (1.0, 1.0)],
    commutators: 1,
};

const KUTTA: Tableau<3> = Tableau {
    a: &[&[HALF], &[(-1.0, 1.0), (2.0, 1.0)]],
    b: [(1.0, 6.0), (2.0, 3.0), (1.0, 6.0)],
    commutators: 2,
};

const CLASSICAL: Tableau<4> = Tableau {
    a: &[&[HALF], &[ZERO, HALF], &[ZERO, ZERO, (1.0, 1.0)]],
    b: [(1.0, 6.0), (1.0, 3.0), (1.0, 3.0), (1.0, 6.0)],
    commutators: 3,
};

const BUTCHER: Tableau<7> = Tableau {
    a: &[
        &[(1.0, 3.0)],
        &[ZERO, (2.0, 3.0)],
        &[(1.0, 12.0), (1.0, 3.0), (-1.0, 12.0)],
        &[(-1.0, 16.0), (9.0, 8.0), (-3.0, 16.0), (-3.0, 8.0)],
        &[ZERO, (9.0, 8.0), (-3.0, 8.0), (-3.0, 4.0), HALF],
        &[
            (9.0, 44.0),
            (-9.0, 11.0),
            (63.0, 44.0),
            (18.0, 11.0),
            ZERO,
            (-16.0, 11.0),
        ],
    ],
    b: [
        (11.0, 120.0),
        ZERO,
        (27.0, 40.0),
        (27.0, 40.0),
        (-4.0, 15.0),
        (-4.0, 15.0),
        (11.0, 120.0),
    ],
    commutators: 6,
};

/// Coefficients of `ad_sigma^k xi`, k = 0 … 6, in the inverse of dexp at -sigma: `(-1)^k B_k/k!`.
const INVERSE: [Ratio; 7] = [
    (1.0, 1.0),
    HALF,
    (1.0, 12.0),
    ZERO,
    (-1.0, 720.0),
    ZERO,
    (1.0, 30240.0),
];

macro_rules! rkmk {
    ($(#[$doc:meta])* $name:ident, $order:literal, $id:literal, $stages:literal, $tableau:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        pub struct $name;

        coadjoint_facts!($name, $id, $order);

        impl<S: Scalar, P: LiePoisson<S>> Method<S, P> for $name {
            type Stepper<'a>
                = RkmkStepper<'a, S, P, $stages>
            where
                P: 'a;

            fn stepper<'a>(
                &self,
                system: &'a P,
                h: S,
                _newton: &NewtonOptions,
            ) -> Self::Stepper<'a> {
                RkmkStepper::new(system, h, &$tableau)
            }
        }
    };
}

rkmk!(
    /// The method of order 2, explicit midpoint rule; see the [module's text](self).
    Rkmk2, 2, "rkmk2", 2, MIDPOINT
);
rkmk!(
    /// The method of order 3, Kutta's tableau; see the [module's text](self).
    Rkmk3, 3, "rkmk3", 3, KUTTA
);
rkmk!(
    /// The method of order 4, classical tableau; see the [module's text](self).
    Rkmk4, 4, "rkmk4", 4, CLASSICAL
);
rkmk!(
    /// The method of order 6, Butcher's tableau of 7 stages; see the [module's text](self).
    Rkmk6, 6, "rkmk6", 7, BUTCHER
);

/// The stepper of a Runge–Kutta–Munthe-Kaas method.
pub struct RkmkStepper<'a, S: Scalar, P: LiePoisson<S>, const STAGES: usize> {
    system: &'a P,
    step: S,
    tableau: &'static Tableau<STAGES>,
    /// The `h k_i`.
    slopes: [Frozen<P::State>; STAGES],
    sigma: [Frozen<P::State>; 1],
    next: P::State,
    term: Frozen<P::State>,
    bracket: Frozen<P::State>,
    flow: Flow<P::State>,
}

impl<'a, S: Scalar, P: LiePoisson<S>, const STAGES: usize> RkmkStepper<'a, S, P, STAGES> {
    fn new(system: &'a P, h: S, tableau: &'static Tableau<STAGES>) -> Self {
        let zero = system.zero_state();
        let field = || Frozen::new(system, &zero);
        Self {
            system,
            step: h,
            tableau,
            slopes: core::array::from_fn(|_| field()),
            sigma: [field()],
            term: field(),
            bracket: field(),
            flow: Flow::new(system, &zero),
            next: zero,
        }
    }

    /// `next = Ad*_(exp sigma) mu`, with forces the affine action.
    fn act(&mut self, mu: &P::State) {
        self.sigma[0].flow(self.system, mu, &mut self.next, &mut self.flow);
    }

    /// Replaces the slope of a stage by the inverse of dexp at -sigma applied to it.
    fn correct(&mut self, stage: usize) {
        let slope = &mut self.slopes[stage];
        self.term.copy_from(slope);
        for &weight in &INVERSE[1..=self.tableau.commutators] {
            let (bracket, flow) = (&mut self.bracket, &mut self.flow);
            self.sigma[0].bracket(self.system, &self.term, bracket, flow);
            core::mem::swap(&mut self.term, &mut self.bracket);
            if weight.0 != 0.0 {
                slope.add(weight, &self.term);
            }
        }
    }
}

impl<S, P, const STAGES: usize> Stepper<S> for RkmkStepper<'_, S, P, STAGES>
where
    S: Scalar,
    P: LiePoisson<S>,
{
    type State = P::State;

    fn step<K: FactorSink<P::State>>(
        &mut self,
        mu: &mut P::State,
        sink: &mut K,
    ) -> Result<StepReport, StepFailure> {
        self.slopes[0].freeze(self.system, self.step, mu);
        for (index, row) in self.tableau.a.iter().enumerate() {
            let stage = index + 1;
            self.sigma[0].combine(row, &self.slopes);
            self.act(mu);
            self.slopes[stage].freeze(self.system, self.step, &self.next);
            self.correct(stage);
        }
        self.sigma[0].combine(&self.tableau.b, &self.slopes);
        self.act(mu);
        accept(mu, &self.next, &mut self.sigma, STAGES as u32, sink)
    }
}
