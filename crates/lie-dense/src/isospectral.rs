//! The isospectral midpoint rule on matrices, by fixed-point iteration.
//!
//! ```text
//! W = (1 - p) V (1 + p),   W1 = (1 + p) V (1 - p) = W + 2 [p, V],   p = h/2 P(V)
//! ```
//!
//! W1 is similar to W, so that the whole spectrum is kept; the step is a symmetric Poisson map of order 2, the same as
//! [`Isospectral2`] and [`LieMidpoint::cayley`](lie_runtime::methods::LieMidpoint::cayley) on a system with structure constants.
//! The unknown is V, and an iteration is
//!
//! ```text
//! V <- W + [p, V] + p V p,   [p, V] = X - X^H,   p V p = X p,   X = p V
//! ```
//!
//! one product of matrices and half of another. It starts from the polynomial through the last midpoints where a step
//! follows another. The sum `W + 2 [p, V]` carries its rounding error on to the next step.
//!
//! Whatever [`NewtonOptions::iteration`] says, this is a fixed-point iteration, which contracts where h times the norms of P and
//! of its derivative is small; where it does not, the step fails.
//!
//! Reference: K. Modin, M. Viviani, "Lie–Poisson methods for isospectral flows", Foundations of Computational
//! Mathematics 20 (2020) 889–921, [doi:10.1007/s10208-019-09428-w](https://doi.org/10.1007/s10208-019-09428-w).

use crate::predictor::Predictor;
use crate::product::Planes;
use crate::skew::SkewHermitian;
use crate::stream::StreamMap;
use crate::system::MatrixFlow;
use lie_runtime::methods::{
    FactorSink, Isospectral2, Method, Retraction, StepFailure, StepReport, Stepper,
};
use lie_runtime::newton::{FailureReason, NewtonOptions};
use lie_runtime::{State, Unknown};

/// Updates up to this many units of round-off that no longer shrink are round-off themselves.
const STAGNATION: f64 = 256.0;
/// The ratio from which on two updates do not shrink.
const STILL: f64 = 15.0 / 16.0;

impl<M: StreamMap> Method<f64, MatrixFlow<M>> for Isospectral2 {
    type Stepper<'a>
        = IsospectralStepper<'a, M>
    where
        M: 'a;

    fn stepper<'a>(
        &self,
        system: &'a MatrixFlow<M>,
        h: f64,
        newton: &NewtonOptions,
    ) -> IsospectralStepper<'a, M> {
        IsospectralStepper::new(system, h, newton)
    }
}

/// The stepper of [`Isospectral2`] on a [`MatrixFlow`].
pub struct IsospectralStepper<'a, M: StreamMap> {
    system: &'a MatrixFlow<M>,
    step: f64,
    options: NewtonOptions,
    predictor: Predictor,
    /// V, and the one before it.
    midpoint: SkewHermitian,
    before: SkewHermitian,
    stream: SkewHermitian,
    /// `[p, V]`
    change: SkewHermitian,
    /// The state at the end of the last step, and what its sum lacks.
    end: SkewHermitian,
    lacking: SkewHermitian,
    streams: Planes,
    vorticity: Planes,
    product: Planes,
}

impl<'a, M: StreamMap> IsospectralStepper<'a, M> {
    fn new(system: &'a MatrixFlow<M>, h: f64, options: &NewtonOptions) -> Self {
        let size = system.map().size();
        let zero = SkewHermitian::zeros(size);
        let planes = Planes::zeros(size);
        Self {
            system,
            step: h,
            options: *options,
            predictor: Predictor::new(size * size),
            midpoint: zero.clone(),
            before: zero.clone(),
            stream: zero.clone(),
            change: zero.clone(),
            end: zero.clone(),
            lacking: zero,
            streams: planes.clone(),
            vorticity: planes.clone(),
            product: planes,
        }
    }

    /// The midpoint V of the last step.
    pub fn midpoint(&self) -> &SkewHermitian {
        &self.midpoint
    }

    /// One iteration; returns the sizes of the update and of the new midpoint.
    fn iterate(&mut self, w: &SkewHermitian) -> [f64; 2] {
        core::mem::swap(&mut self.midpoint, &mut self.before);
        let map = self.system.map();
        map.stream(&self.before, &mut self.stream);
        self.streams.spread(&self.stream, 0.5 * self.step);
        self.vorticity.spread(&self.before, 1.0);
        self.product
            .multiply(&self.streams, &self.vorticity, &mut self.change);
        // the planes of V are free
        self.vorticity.multiply_below(&self.product, &self.streams);
        let inputs = [w, &self.change, &self.before];
        self.vorticity.advance(inputs, &mut self.midpoint)
    }

    /// Solves for the midpoint.
    fn solve(&mut self, w: &SkewHermitian) -> Result<StepReport, StepFailure> {
        let mut report = StepReport {
            substeps: 1,
            ..StepReport::default()
        };
        let mut previous = f64::INFINITY;
        let mut first = f64::INFINITY;
        loop {
            let [update, size] = self.iterate(w);
            report.iterations += 1;
            report.fixed_point += 1;
            report.evaluations += 1;
            report.residual = update;
            let refused = |reason| StepFailure {
                reason,
                lanes: 1,
                report,
            };
            if !(update * 0.0 + size * 0.0 == 0.0) {
                return Err(refused(FailureReason::NotFinite));
            }
            if report.iterations == 1 {
                first = update;
            }
            if self.has_converged(update, previous, size) {
                return Ok(report);
            }
            if report.iterations >= self.options.max_iterations {
                let grown = update > first;
                return Err(refused(if grown {
                    FailureReason::Diverged
                } else {
                    FailureReason::NotConverged
                }));
            }
            previous = update;
        }
    }

    /// Whether the error that is left is below the tolerance, as the rate of the last updates predicts, or the updates have
    /// come to rest at round-off: they shrink no more.
    fn has_converged(&self, update: f64, previous: f64, size: f64) -> bool {
        let round_off = f64::EPSILON * size;
        let goal = self.options.tolerance * round_off;
        if previous.is_infinite() {
            return update <= goal;
        }
        let rate = update / previous;
        let left = update * rate / (1.0 - rate);
        let at_rest = rate >= STILL && update <= STAGNATION * round_off;
        at_rest || (rate < 1.0 && left <= goal) || update <= 0.0
    }

    /// `W1 = W + 2 [p, V]`, with what the last sum lacked.
    fn finish(&mut self, mu: &mut SkewHermitian) {
        let change = self.change.as_slice().iter();
        let lacking = self.lacking.as_mut_slice().iter_mut();
        for ((mu, &change), lacking) in mu.as_mut_slice().iter_mut().zip(change).zip(lacking) {
            let advance = 2.0 * change - *lacking;
            let sum = *mu + advance;
            *lacking = (sum - *mu) - advance;
            *mu = sum;
        }
        self.end.copy_from(mu);
    }
}

impl<M: StreamMap> Stepper<f64> for IsospectralStepper<'_, M> {
    type State = SkewHermitian;

    fn step<K: FactorSink<SkewHermitian>>(
        &mut self,
        mu: &mut SkewHermitian,
        sink: &mut K,
    ) -> Result<StepReport, StepFailure> {
        self.system.check(mu);
        if self.end != *mu {
            self.predictor.forget();
            self.lacking.fill(0.0);
        }
        if !self.predictor.predict(self.midpoint.as_mut_slice()) {
            self.midpoint.copy_from(mu);
        }
        let solved = self.solve(mu).and_then(|report| {
            if self.change.finite() {
                return Ok(report);
            }
            Err(StepFailure {
                reason: FailureReason::NotFinite,
                lanes: 1,
                report,
            })
        });
        let report = match solved {
            Ok(report) => report,
            Err(failure) => {
                self.predictor.forget();
                self.end.fill(f64::NAN);
                return Err(failure);
            }
        };
        self.finish(mu);
        self.predictor.record(self.midpoint.as_slice());
        if sink.is_active() {
            // h grad H in the coordinates of the algebra, which are paired with those of the state
            self.stream.weigh(-self.step);
            sink.push(Retraction::Cayley, &self.stream);
        }
        Ok(report)
    }
}
