//! Lyapunov exponents of a flow along an orbit, by the tangent of its numerical step.
//!
//! Let `Phi` be a step of size h from x, and `D` its derivative there, which dual numbers compute through the step and its solver. With
//! orthonormal vectors in the columns of `Q_0`,
//!
//! > D(x_k) Q_k = Q_(k+1) R_(k+1), lambda_i = lim 1/(N h) sum_k log |R_k,ii|
//!
//! where R is upper triangular: G. Benettin, L. Galgani, A. Giorgilli, J.-M. Strelcyn, Lyapunov characteristic exponents for smooth
//! dynamical systems and for Hamiltonian systems, Meccanica 15 (1980) 9–20 and 21–30, doi:10.1007/BF02128236 and
//! doi:10.1007/BF02128237. Lengths and angles are Euclidean in the coordinates; the limits do not depend on that. Exponents have the
//! unit of one over the time.
//!
//! A Poisson map keeps the Casimirs, and is symplectic on leaves: on one of dimension 2r the exponents come in pairs `±lambda`, and
//! the n - 2r others are zero. Over a finite time that holds up to O(1/T); where the Poisson tensor is constant and canonical it holds to
//! round-off, since the first vectors are chosen so.

use lie_runtime::diagnostics::{AnyMethod, AnyStepper};
use lie_runtime::methods::StepFailure;
use lie_runtime::newton::NewtonOptions;
use lie_runtime::{Dual, Poisson, Scalar, State as _};
use nalgebra::DMatrix;

use crate::blocks::Blocks;
use crate::frame::{Frame, frame};

/// How exponents are measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// The size of a step; negative along the flow backwards.
    pub step: f64,
    /// The time at the start, of which H may be a function.
    pub from: f64,
    /// Steps before the sums begin.
    pub transient: u64,
    /// Steps of the sums.
    pub steps: u64,
    /// How many exponents; as many as coordinates at most.
    pub count: usize,
    /// Of the first vectors.
    pub seed: u64,
}

/// An exponent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exponent {
    /// Its value, one over the unit of the time.
    pub value: f64,
    /// The standard error of the mean, from 20 parts of the time, or the distance of the mean over its second half where that is
    /// larger; no number where there are less than two parts.
    pub error: f64,
}

/// Exponents of an orbit.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    /// The exponents, the largest first.
    pub exponents: Vec<Exponent>,
    /// The number of all of them: that of the coordinates, but for those that carry the time.
    pub dimension: usize,
    /// The number r of pairs: half the dimension of the leaf of the start.
    pub pairs: usize,
    /// Steps before the sums.
    pub transient: u64,
    /// Steps of the sums.
    pub steps: u64,
    /// The time of the sums, positive.
    pub time: f64,
    /// The step that failed, counted from 1, and why. What was summed before it is there.
    pub failure: Option<(u64, StepFailure)>,
}

impl Spectrum {
    /// Whether all exponents are there.
    pub fn is_whole(&self) -> bool {
        self.exponents.len() == self.dimension
    }

    /// The sum of all: the mean of the divergence of the flow.
    pub fn sum(&self) -> Option<f64> {
        let sum = || self.exponents.iter().map(|exponent| exponent.value).sum();
        self.is_whole().then(sum)
    }

    /// How far pairs are from `±lambda`: the largest `|lambda_i + lambda_(n+1-i)|`, i = 1 … r.
    pub fn pairing(&self) -> Option<f64> {
        let sum = |i: usize| {
            let (first, last) = (&self.exponents[i], &self.exponents[self.dimension - 1 - i]);
            (first.value + last.value).abs()
        };
        let pairs = 0..self.pairs;
        (self.is_whole() && self.pairs > 0).then(|| pairs.map(sum).fold(0.0, f64::max))
    }

    /// How far those of the Casimirs are from zero: the largest magnitude among the n - 2r in the middle.
    pub fn casimirs(&self) -> Option<f64> {
        let middle = self.pairs..self.dimension - self.pairs;
        let size = |exponent: &Exponent| exponent.value.abs();
        (self.is_whole() && !middle.is_empty())
            .then(|| self.exponents[middle].iter().map(size).fold(0.0, f64::max))
    }
}

/// Measures them from a start. `goes_on` hears after each step how many are done, and answers whether to go on. The vectors are made
/// orthonormal behind every step, so that none outgrows the others between, whatever the step.
pub fn exponents<P: Poisson<Dual<f64>>>(
    system: &P,
    method: &dyn AnyMethod<Dual<f64>, P>,
    newton: &NewtonOptions,
    start: &[f64],
    options: &Options,
    goes_on: &mut dyn FnMut(u64) -> bool,
) -> Spectrum {
    let mut orbit = Orbit::new(system, method, newton, start, options);
    let (dimension, count) = (orbit.shown.len(), orbit.vectors.ncols());
    let mut blocks = Blocks::new(options.steps, count);
    let mut failure = None;
    for step in 0..options.transient + options.steps {
        if let Err(why) = orbit.step(options.from + step as f64 * options.step) {
            failure = Some((step + 1, why));
            break;
        }
        let grown = orbit.orthonormalize();
        if step >= options.transient {
            blocks.add((0..count).map(|k| Scalar::log(grown[(k, k)].abs())));
        }
        if !goes_on(step + 1) {
            break;
        }
    }
    let step = options.step.abs();
    let of = |k: usize| {
        let (mean, error) = blocks.mean(k);
        Exponent {
            value: mean / step,
            error: error / step,
        }
    };
    let mut exponents: Vec<Exponent> = match blocks.done() {
        0 => Vec::new(),
        _ => (0..count).map(of).collect(),
    };
    exponents.sort_by(|a, b| b.value.total_cmp(&a.value));
    Spectrum {
        exponents,
        dimension,
        pairs: orbit.pairs,
        transient: options.transient,
        steps: blocks.done(),
        time: blocks.done() as f64 * step,
        failure,
    }
}

/// A state on its orbit, with vectors that its steps carry along.
struct Orbit<'a, P: Poisson<Dual<f64>>> {
    system: &'a P,
    /// One for each vector: a stepper begins its iterations at what it has found before.
    steppers: Vec<Box<dyn AnyStepper<Dual<f64>, P::State> + 'a>>,
    /// The coordinates that do not carry the time, in which vectors live.
    shown: Vec<usize>,
    state: Vec<f64>,
    next: Vec<f64>,
    dual: P::State,
    vectors: DMatrix<f64>,
    pairs: usize,
}

impl<'a, P: Poisson<Dual<f64>>> Orbit<'a, P> {
    fn new(
        system: &'a P,
        method: &dyn AnyMethod<Dual<f64>, P>,
        newton: &NewtonOptions,
        start: &[f64],
        options: &Options,
    ) -> Self {
        let clock = system.clock();
        let holds = |i: &usize| clock.is_some_and(|clock| clock.holds(*i));
        let shown: Vec<usize> = (0..system.dimension()).filter(|i| !holds(i)).collect();
        let mut dual = system.zero_state();
        for (entry, value) in dual.as_mut_slice().iter_mut().zip(start) {
            *entry = Dual::constant_of(*value);
        }
        let Frame { vectors, pairs } = frame(system, &dual, &shown, options.seed);
        let count = options.count.clamp(1, shown.len());
        let step = Dual::constant_of(options.step);
        let steppers = (0..count).map(|_| method.any_stepper(system, step, newton));
        Self {
            steppers: steppers.collect(),
            state: start.to_vec(),
            next: start.to_vec(),
            dual,
            vectors: vectors.columns(0, count).into_owned(),
            pairs,
            shown,
            system,
        }
    }

    /// A step from a time on, of the state and of all vectors.
    fn step(&mut self, time: f64) -> Result<(), StepFailure> {
        if let Some(clock) = self.system.clock() {
            self.state[clock.time] = time;
        }
        // norms see derivatives too: vectors of the size of the state keep the two in proportion
        let size = self.shown.iter().map(|i| self.state[*i].abs());
        let size = match size.fold(0.0, f64::max) {
            0.0 => 1.0,
            size => size,
        };
        for (k, stepper) in self.steppers.iter_mut().enumerate() {
            let dual = self.dual.as_mut_slice();
            for (entry, value) in dual.iter_mut().zip(&self.state) {
                *entry = Dual::constant_of(*value);
            }
            for (row, i) in self.shown.iter().enumerate() {
                dual[*i].derivative = size * self.vectors[(row, k)];
            }
            stepper.step(&mut self.dual)?;
            let dual = self.dual.as_slice();
            for (row, i) in self.shown.iter().enumerate() {
                self.vectors[(row, k)] = dual[*i].derivative / size;
            }
            if k == 0 {
                let values = self.next.iter_mut().zip(dual);
                values.for_each(|(next, entry)| *next = entry.value);
            }
        }
        self.state.copy_from_slice(&self.next);
        Ok(())
    }

    /// Makes the vectors orthonormal; answers R.
    fn orthonormalize(&mut self) -> DMatrix<f64> {
        let decomposed = std::mem::take(&mut self.vectors).qr();
        self.vectors = decomposed.q();
        decomposed.unpack_r()
    }
}
