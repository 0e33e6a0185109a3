//! The splitting of Ninomiya and Victoir: the motion and noise in turns.
//!
//! Of the equation of Stratonovich
//!
//! ```math
//! \mathrm{d}\mu = f(\mu)\, \mathrm{d}t + \sum_k g_k(\mu) \circ \mathrm{d}W_k
//! ```
//!
//! with the motion f, forces and damping among it, a step is
//!
//! ```math
//! \mu_1 = \Phi_{h/2} \circ \varphi^{k_r}_{\Delta W_{k_r}} \circ \dots \circ \varphi^{k_1}_{\Delta W_{k_1}} \circ \Phi_{h/2}
//! ```
//!
//! `$\varphi^k$` is the exact flow of `$g_k$` ([`Noise`]), and `$\Phi$` a step of [`LieMidpoint`] without noise. The processes follow each other
//! in their order or against it, as a fair coin says in each step.
//!
//! Weak order 2: means of functions of mu have errors `$O(h^2)$`, with one process and with several that do not commute. With the rates held
//! over a step, as all other methods take noise, and without the coin, that is order 1. In the mean square the order is 1 for noise that commutes, 1/2 for
//! other noise, as of every method that knows the increments alone. A step of -h with the same noise undoes one of h.
//!
//! Without forces each path stays on its coadjoint orbit, and the map of a path is a Poisson map where nothing damps.
//!
//! Needs: a Lie algebra, and noise along constant directions, of the algebra or as a force: they may depend on the time and on inputs.
//!
//! References: S. Ninomiya, N. Victoir, "Weak approximation of stochastic differential equations and application to derivative pricing", Applied
//! Mathematical Finance 15 (2008) 107–121, [doi:10.1080/13504860701413958](https://doi.org/10.1080/13504860701413958).
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use super::compose::Masked;
use super::facts::{Facts, Preserves};
use super::lie_midpoint::{Exp, LieMidpoint};
use super::stepper::{FactorSink, Method, Retraction, StepFailure, StepReport, Stepper};
use crate::generic::{Noise, excite, quieten};
use crate::newton::NewtonOptions;
use crate::poisson::LiePoisson;
use crate::scalar::{Mask, Scalar};
use crate::state::{State, Unknown};

/// The splitting of Ninomiya and Victoir, weak order 2; see the [module's text](self).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NinomiyaVictoir;

impl Facts for NinomiyaVictoir {
    const ID: &'static str = "ninomiya-victoir";
    const ORDER: u32 = 2;
    const SYMMETRIC: bool = true;
    const EXPLICIT: bool = false;
    const PRESERVES: Preserves = Preserves::POISSON;
    const FORCES: bool = true;
    const DAMPING: bool = true;
}

impl<S, P> Method<S, P> for NinomiyaVictoir
where
    S: Scalar,
    P: LiePoisson<S>,
    LieMidpoint<Exp>: Method<S, P>,
{
    type Stepper<'a>
        = NinomiyaVictoirStepper<'a, S, P, <LieMidpoint<Exp> as Method<S, P>>::Stepper<'a>>
    where
        P: 'a;

    fn stepper<'a>(&self, system: &'a P, h: S, newton: &NewtonOptions) -> Self::Stepper<'a> {
        let zero = || system.zero_state();
        let half = h * S::ratio(1.0, 2.0);
        NinomiyaVictoirStepper {
            turns: Turns {
                system,
                step: h,
                half: LieMidpoint::exp().stepper(system, half, newton),
                noise: Noise::new(system),
                before: zero(),
                state: zero(),
            },
            factor: zero(),
        }
    }
}

/// The stepper of [`NinomiyaVictoir`].
pub struct NinomiyaVictoirStepper<'a, S: Scalar, P: LiePoisson<S>, T> {
    turns: Turns<'a, S, P, T>,
    factor: P::State,
}

struct Turns<'a, S: Scalar, P: LiePoisson<S>, T> {
    system: &'a P,
    step: S,
    /// Half a step of the motion.
    half: T,
    noise: Noise<P::State>,
    before: P::State,
    state: P::State,
}

impl<S, P, T> Turns<'_, S, P, T>
where
    S: Scalar,
    P: LiePoisson<S>,
    T: Stepper<S, State = P::State>,
{
    /// A step of `state`, from `before`.
    fn run<K: FactorSink<P::State>>(&mut self, sink: &mut K) -> Result<StepReport, StepFailure> {
        let mut report = StepReport {
            substeps: 1,
            ..StepReport::default()
        };
        let mut failure: Option<StepFailure> = None;
        let system = self.system;
        self.state.copy_from(&self.before);
        for turn in 0..2 {
            if turn == 1 {
                excite(system, &self.before, &mut self.state);
                let give = &mut |xi: &mut P::State| sink.push(Retraction::Exp, xi);
                self.noise.flow(system, self.step, &mut self.state, give);
            }
            quieten(system, &mut self.state);
            match self.half.step(&mut self.state, sink) {
                Ok(part) => report.add::<S>(&part),
                Err(new) => {
                    let known = failure.get_or_insert(StepFailure { lanes: 0, ..new });
                    known.lanes |= new.lanes;
                    report.add::<S>(&new.report);
                }
            }
        }
        excite(system, &self.before, &mut self.state);
        match failure {
            None => Ok(report),
            Some(failure) => Err(StepFailure { report, ..failure }),
        }
    }
}

impl<S, P, T> Stepper<S> for NinomiyaVictoirStepper<'_, S, P, T>
where
    S: Scalar,
    P: LiePoisson<S>,
    T: Stepper<S, State = P::State>,
{
    type State = P::State;

    fn carry(&mut self, visit: &mut dyn FnMut(&mut S)) -> bool {
        self.turns.half.carry(visit)
    }

    fn step<K: FactorSink<P::State>>(
        &mut self,
        mu: &mut P::State,
        sink: &mut K,
    ) -> Result<StepReport, StepFailure> {
        let Self { turns, factor } = self;
        turns.before.copy_from(mu);
        let outcome = turns.run(&mut ());
        let failed = S::Mask::from_bits(outcome.as_ref().err().map_or(0, |failure| failure.lanes));
        mu.assign_where(!failed, &turns.state);
        if sink.is_active() && !failed.all() {
            // only behind the last part it is known which lanes have no factors to give away
            let _same = turns.run(&mut Masked::<S, _, _> {
                sink,
                failed,
                factor,
            });
        }
        outcome
    }
}
