//! Taylor coefficients by the recurrence of the plan.

use crate::code::Code;
use crate::compiled::CodeBuilder;
use crate::engine::ARGUMENTS;
use crate::recording::Development;
use crate::system::Dynamic;
use lie_codegen::plan;
use lie_core::generic::PowerSeries;
use lie_runtime::recurrence::{KeptSeries, MOST_ORDERS};
use lie_runtime::{GradientRecurrence, GradientSeries, Poisson, Recurrence, Scalar, Series};
use std::ops::Range;

/// A recurrence in code.
#[derive(Debug)]
pub struct Codes {
    begin: usize,
    advance: usize,
    field: Vec<usize>,
    gradient: Vec<usize>,
    conditions: usize,
    pairs: usize,
    kept: usize,
}

impl Codes {
    pub(crate) fn new(recurrence: &plan::Recurrence, making: &mut CodeBuilder) -> Self {
        Self {
            begin: making.push(Code::from_beginning(&recurrence.begin)),
            advance: making.push(Code::from_advance(&recurrence.advance)),
            field: recurrence.field.clone(),
            gradient: recurrence.gradient.clone().unwrap_or_default(),
            conditions: recurrence.conditions,
            pairs: recurrence.pairs,
            kept: recurrence.kept,
        }
    }

    /// How many conditions choose branches.
    pub(crate) fn conditions(&self) -> usize {
        self.conditions
    }

    fn entries(&self) -> usize {
        self.field.len() + self.gradient.len()
    }

    /// Where the results begin that are not entries or conditions.
    fn rest(&self) -> usize {
        self.entries() + self.conditions
    }
}

/// The recurrence of a system by codes.
pub(crate) struct ByCodes<'a, S: Scalar> {
    system: &'a Dynamic<S>,
    codes: &'a Codes,
    /// What the code of an order writes.
    results: Vec<S>,
    kept: Vec<S>,
    /// The pairs of series, order after order.
    left: Vec<S>,
    right: Vec<S>,
    /// The sums of the next order without their first and last terms.
    rest: Vec<S>,
    gradient: Vec<S>,
    /// The conditions that choose branches, order after order.
    conditions: Vec<S>,
}

impl<'a, S: Scalar> ByCodes<'a, S> {
    pub(crate) fn new(system: &'a Dynamic<S>, codes: &'a Codes) -> Self {
        let zeros = |count: usize| vec![S::zero(); count];
        Self {
            system,
            codes,
            results: zeros(codes.rest() + codes.kept.max(2 * codes.pairs)),
            kept: zeros(codes.kept),
            left: zeros(MOST_ORDERS * codes.pairs),
            right: zeros(MOST_ORDERS * codes.pairs),
            rest: zeros(codes.pairs),
            gradient: system.zero_state(),
            conditions: zeros(MOST_ORDERS * codes.conditions),
        }
    }

    /// The conditions of the first orders, one order after the other.
    pub(crate) fn conditions(&self, orders: Range<usize>) -> &[S] {
        let count = self.codes.conditions;
        &self.conditions[orders.start * count..orders.end * count]
    }

    pub(crate) fn begin(&mut self, mu: &[S], field: &mut [S]) {
        let codes = self.codes;
        self.run(codes.begin, mu, None, field);
        let kept = &self.results[codes.rest()..][..codes.kept];
        self.kept.copy_from_slice(kept);
        self.rest.fill(S::zero());
    }

    pub(crate) fn advance(&mut self, k: usize, coefficient: &[S], field: &mut [S]) {
        self.run(self.codes.advance, coefficient, Some(k), field);
        self.push(k);
    }

    /// Runs the code of an order; the entries go to the field and the gradient.
    fn run(&mut self, code: usize, state: &[S], k: Option<usize>, field: &mut [S]) {
        let codes = self.codes;
        let order = k.map_or([S::zero(); 2], |k| {
            [S::from_f64(k as f64), S::ratio(1.0, k as f64)]
        });
        let places: [&[S]; ARGUMENTS] = [state, &self.rest, &self.kept, &order];
        let frame = self.system.values.frame(places, &[], &[]);
        self.system
            .values
            .run(code, &frame, [&mut self.results, &mut []]);
        field.fill(S::zero());
        let (of_field, others) = self.results.split_at(codes.field.len());
        for (place, value) in codes.field.iter().zip(of_field) {
            field[*place] = *value;
        }
        for (place, value) in codes.gradient.iter().zip(others) {
            self.gradient[*place] = *value;
        }
        let (from, count) = (k.unwrap_or(0) * codes.conditions, codes.conditions);
        let found = &self.results[codes.entries()..][..count];
        self.conditions[from..][..count].copy_from_slice(found);
    }

    /// Takes the coefficients of order k of all pairs and sums those of the next, as generated code does: the even and the odd
    /// terms in chains of their own.
    fn push(&mut self, k: usize) {
        let codes = self.codes;
        let pairs = codes.pairs;
        let (left, right) = self.results[codes.rest()..][..2 * pairs].split_at(pairs);
        self.left[k * pairs..][..pairs].copy_from_slice(left);
        self.right[k * pairs..][..pairs].copy_from_slice(right);
        for m in 0..pairs {
            let u = |j: usize| self.left[j * pairs + m];
            let v = |j: usize| self.right[j * pairs + m];
            if k == 1 {
                self.rest[m] = u(1) * v(1);
                continue;
            }
            // the terms j = 2 … k - 1 of order k + 1
            let (mut even, mut odd) = (S::zero(), S::zero());
            let count = k - 2;
            if count % 2 == 1 {
                even += u(k - 1) * v(2);
            }
            for pair in 0..count / 2 {
                let j = 2 + 2 * pair;
                even += u(j) * v(k + 1 - j);
                odd += u(j + 1) * v(k - j);
            }
            let newest = u(1) * v(k) + u(k) * v(1);
            self.rest[m] = newest + (even + odd);
        }
    }
}

/// The recurrence of a system; where the plan has none, the field over truncated series.
pub struct Coefficients<'a, S: Scalar> {
    by_codes: Option<ByCodes<'a, S>>,
    whole: Option<Development<'a, S>>,
    /// Whether that has developed the last series.
    is_kept: bool,
    power: Option<PowerSeries<S, Dynamic<S>>>,
}

impl<'a, S: Scalar> Coefficients<'a, S> {
    fn new(system: &'a Dynamic<S>, codes: Option<&'a Codes>) -> Self {
        Self {
            by_codes: codes.map(|codes| ByCodes::new(system, codes)),
            whole: None,
            is_kept: false,
            power: codes.is_none().then(|| PowerSeries::new(system)),
        }
    }
}

impl<S: Scalar> Recurrence<S> for Coefficients<'_, S> {
    type State = Vec<S>;
    type Carry = ();

    fn begin(&mut self, mu: &Vec<S>, field: &mut Vec<S>) {
        match (&mut self.by_codes, &mut self.power) {
            (Some(by_codes), _) => by_codes.begin(mu, field),
            (None, Some(power)) => power.begin(mu, field),
            (None, None) => {}
        }
    }

    fn advance(&mut self, k: usize, (): (), coefficient: &Vec<S>, field: &mut Vec<S>) {
        match (&mut self.by_codes, &mut self.power) {
            (Some(by_codes), _) => by_codes.advance(k, coefficient, field),
            (None, Some(power)) => power.advance(k, (), coefficient, field),
            (None, None) => {}
        }
    }

    fn develop(
        &mut self,
        mu: &Vec<S>,
        unit: S,
        part: S,
        last: usize,
        rows: &[Vec<S>],
        lanes: S::Mask,
    ) -> bool {
        let whole = self.whole.as_mut();
        self.is_kept = whole.is_some_and(|whole| whole.run(mu, [unit, part], last, rows, lanes));
        self.is_kept
    }

    fn kept(&self) -> Option<KeptSeries<'_, S>> {
        let whole = self.whole.as_ref().filter(|_| self.is_kept);
        whole?.series()
    }

    fn sum(&mut self, time: S, out: &mut Vec<S>) -> bool {
        if let Some(whole) = self.whole.as_ref().filter(|_| self.is_kept) {
            whole.sum(time, out);
        }
        self.is_kept
    }

    fn conditions(&self, k: usize) -> &[S] {
        match (&self.by_codes, &self.whole) {
            (Some(by_codes), Some(whole)) if self.is_kept => {
                let count = by_codes.codes.conditions;
                &whole.conditions()[k * count..][..count]
            }
            (Some(by_codes), _) => by_codes.conditions(k..k + 1),
            (None, _) => &[],
        }
    }
}

impl<S: Scalar> GradientRecurrence<S> for Coefficients<'_, S> {
    fn gradient(&self) -> &Vec<S> {
        match (&self.power, &self.by_codes) {
            (Some(power), _) => power.gradient(),
            (None, Some(by_codes)) => &by_codes.gradient,
            (None, None) => unreachable!("a recurrence is by codes or by power series"),
        }
    }
}

impl<S: Scalar> Series<S> for Dynamic<S> {
    type Recurrence<'a> = Coefficients<'a, S>;
    fn series(&self) -> Coefficients<'_, S> {
        let codes = self.values.compiled.taylor.as_ref();
        Coefficients {
            whole: codes.and_then(|_| Development::new(self)),
            ..Coefficients::new(self, codes)
        }
    }
}

impl<S: Scalar> GradientSeries<S> for Dynamic<S> {
    type Recurrence<'a> = Coefficients<'a, S>;
    fn gradient_series(&self) -> Coefficients<'_, S> {
        Coefficients::new(self, self.values.compiled.lie_taylor.as_ref())
    }
}
