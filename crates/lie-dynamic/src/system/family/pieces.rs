//! The flows of the pieces of a family.

use super::codes::{PieceCodes, Turn};
use super::{EIGHT, FamilySite, Few, FewOf, Near, NearOf, eight, zeros};
use crate::compiled::Values;
use crate::engine::ARGUMENTS;
use crate::system::flows::update;
use lie_codegen::plan::FamilyForm;
use lie_core::family::{Effects, Kind, Pieces, Shape as _, Sites as _, Strip, site_by_site};
use lie_runtime::Scalar;

/// The turn of a site by an angle.
fn turn<S: Scalar>(values: &Values<S>, turn: &Turn, angle: S, site: &mut [S]) {
    let mut results = zeros(turn.updates.len());
    let mut arguments: [&[S]; ARGUMENTS] = [&[]; ARGUMENTS];
    arguments[0] = site;
    let scalars = [S::zero(), angle];
    let frame = values.frame(arguments, &[], &scalars);
    values.run(turn.code, &frame, [&mut results, &mut []]);
    update(&turn.updates, &results, site);
}

/// A rate of a piece.
fn rate<S: Scalar>(values: &Values<S>, code: usize, arguments: [&[S]; ARGUMENTS]) -> S {
    let mut rate = [S::zero()];
    let frame = values.frame(arguments, &[], &[]);
    values.run(code, &frame, [&mut rate, &mut []]);
    rate[0]
}

/// What kernels of two sites read: the coefficients stand before the second one, where there are any.
fn of_two<'a, S: Scalar>(
    values: &Values<S>,
    one: &'a [S],
    [sums, at]: [&'a [S]; 2],
    other: &'a [S],
) -> [&'a [S]; ARGUMENTS] {
    let plan = values.compiled.plan.family.as_ref();
    match plan.is_some_and(|family| family.has_coefficients()) {
        false => [one, sums, other, &[]],
        true => [one, sums, at, other],
    }
}

/// The flow of a piece over a time t.
fn flow<S: Scalar>(
    values: &Values<S>,
    piece: &PieceCodes,
    t: S,
    [sums, at]: [&[S]; 2],
    one: &mut [S],
    other: &mut [S],
) {
    let speed = |one: &[S]| rate(values, piece.rate, [one, sums, at, &[]]) * t;
    match (piece.form, piece.turns.as_slice()) {
        (FamilyForm::Still, _) => {}
        (FamilyForm::Flow(_), _) => {
            let mut moved: FewOf<S> = zeros(one.len());
            let scalars = [S::zero(), t];
            let frame = values.frame([one, sums, at, &[]], &[], &scalars);
            values.run(piece.rate, &frame, [&mut moved, &mut []]);
            one.copy_from_slice(&moved);
        }
        (FamilyForm::Pair(_), [first, second]) => {
            let arguments = of_two(values, one, [sums, at], other);
            let speed = |code| rate(values, code, arguments) * t;
            let speeds = [Some(piece.rate), piece.second].map(|code| code.map_or(S::zero(), speed));
            turn(values, first, speeds[0], one);
            turn(values, second, speeds[1], other);
        }
        (FamilyForm::Product([a, b]), [first, second]) => {
            let speed = speed(one);
            let (of_first, of_second) = (speed * other[b], speed * one[a]);
            turn(values, first, of_first, one);
            turn(values, second, of_second, other);
        }
        (_, [only]) => {
            let angle = speed(one);
            turn(values, only, angle, one);
        }
        _ => unreachable!("exchanges are turns about the sum of both sites, which the core does"),
    }
}

impl<S: Scalar> Pieces<S> for FamilySite<S> {
    fn kinds(&self) -> &[Kind] {
        &self.codes().kinds
    }

    fn shared_exchange(&self, kind: usize, at: &NearOf<S>, sums: &FewOf<S>) -> Option<S> {
        let piece = &self.codes().pieces[kind];
        let site: FewOf<S> = zeros(self.dimension());
        let is_one = piece.form == FamilyForm::Exchange;
        is_one.then(|| rate(&self.values, piece.rate, [&site, sums, at, &[]]))
    }

    fn shared_share(&self, kind: usize, one: &FewOf<S>, sums: &FewOf<S>) -> FewOf<S> {
        let count = self.plan().totals();
        match self.codes().pieces[kind].share {
            Some(code) => self.vector(code, [one, sums], count),
            None => zeros(count),
        }
    }

    fn effects(&self, kind: usize) -> Effects {
        self.codes().pieces[kind].effects
    }

    fn time_slope_of(
        &self,
        kind: usize,
        (sums, at): (&FewOf<S>, &NearOf<S>),
        one: &FewOf<S>,
        other: &FewOf<S>,
    ) -> S {
        let arguments = of_two(&self.values, one, [sums, at], other);
        let [code, _] = self.codes().pieces[kind].timed;
        code.map_or(S::zero(), |code| rate(&self.values, code, arguments))
    }

    fn time_slope_of_sums(&self, kind: usize, sums: &FewOf<S>) -> S {
        let [_, code] = self.codes().pieces[kind].timed;
        code.map_or(S::zero(), |code| self.values.number(code, [sums, &[]]))
    }

    fn rest(&self, shared: &FewOf<S>) -> S {
        let code = self.codes().rest;
        code.map_or(S::zero(), |code| self.values.number(code, [shared, &[]]))
    }

    fn flow_of(
        &self,
        kind: usize,
        t: S,
        (sums, at): (&FewOf<S>, &NearOf<S>),
        one: &mut FewOf<S>,
        other: &mut FewOf<S>,
    ) {
        let piece = &self.codes().pieces[kind];
        flow(&self.values, piece, t, [sums, at], one, other);
    }

    fn flows(
        &self,
        kind: usize,
        t: S,
        (sums, data): (&FewOf<S>, &[S]),
        strip: &Strip,
        mu: &mut [S],
    ) {
        let Some(wide) = &self.wide else {
            return site_by_site(self, kind, t, (sums, data), strip, mu);
        };
        let (piece, dimension, count) = (&self.codes().pieces[kind], self.dimension(), strip.count);
        let part = |site: usize, k: usize| k * strip.sites + strip.places[site];
        // the coefficients stand behind the coordinates of all slots
        let mut at = Near::make(self.places(), |_| S::Wide::zero());
        let coordinates = self.offsets().len() * dimension;
        let sites = 1 + usize::from(strip.bonds);
        let (t, sums) = (t.widen(), Few::make(sums.len(), |k| sums[k].widen()));
        let mut both = [zeros(dimension), zeros(dimension)];
        for i in (0..count).step_by(EIGHT) {
            for (site, values) in both.iter_mut().enumerate() {
                for (k, x) in values.iter_mut().enumerate() {
                    *x = eight(&mu[part(site, k)..][..count], i);
                }
            }
            let parts = data.chunks_exact(strip.sites);
            for (x, part) in at[coordinates..].iter_mut().zip(parts) {
                *x = eight(&part[strip.places[0]..][..count], i);
            }
            let [one, other] = &mut both;
            flow(wide, piece, t, [&sums, &at], one, other);
            let lanes = EIGHT.min(count - i);
            for (site, values) in both.iter().enumerate().take(sites) {
                for (k, x) in values.iter().enumerate() {
                    mu[part(site, k) + i..][..lanes].copy_from_slice(&S::scatter(*x)[..lanes]);
                }
            }
        }
    }
}
