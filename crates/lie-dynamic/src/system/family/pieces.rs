//! The flows of the pieces of a family.

use super::codes::{PieceCodes, Turn};
use super::{EIGHT, FamilySite, Few, FewOf, eight, zeros};
use crate::compiled::Values;
use crate::engine::ARGUMENTS;
use crate::system::flows::update;
use lie_codegen::plan::FamilyForm;
use lie_core::family::{Kind, Pieces, Shape as _, Sites as _, Strip, site_by_site};
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

/// The flow of a piece over a time t.
fn flow<S: Scalar>(
    values: &Values<S>,
    piece: &PieceCodes,
    t: S,
    sums: &[S],
    one: &mut [S],
    other: &mut [S],
) {
    let rate = |one: &[S]| values.number(piece.rate, [one, sums]) * t;
    match (piece.form, piece.turns.as_slice()) {
        (FamilyForm::Product([a, b]), [first, second]) => {
            let rate = rate(one);
            let (of_first, of_second) = (rate * other[b], rate * one[a]);
            turn(values, first, of_first, one);
            turn(values, second, of_second, other);
        }
        (_, [only]) => {
            let angle = rate(one);
            turn(values, only, angle, one);
        }
        _ => unreachable!("exchanges are turns about the sum of both sites, which the core does"),
    }
}

impl<S: Scalar> Pieces<S> for FamilySite<S> {
    fn kinds(&self) -> &[Kind] {
        &self.codes().kinds
    }

    fn exchange(&self, kind: usize) -> Option<S> {
        let piece = &self.codes().pieces[kind];
        let (site, sums) = (zeros(self.dimension()), zeros(self.count()));
        (piece.form == FamilyForm::Exchange).then(|| self.values.number(piece.rate, [&site, &sums]))
    }

    fn share(&self, kind: usize, one: &FewOf<S>) -> FewOf<S> {
        match self.codes().pieces[kind].share {
            Some(code) => self.vector(code, [one, &[]], self.count()),
            None => zeros(self.count()),
        }
    }

    fn flow(&self, kind: usize, t: S, sums: &FewOf<S>, one: &mut FewOf<S>, other: &mut FewOf<S>) {
        flow(
            &self.values,
            &self.codes().pieces[kind],
            t,
            sums,
            one,
            other,
        );
    }

    fn flows(&self, kind: usize, t: S, sums: &FewOf<S>, strip: &Strip, mu: &mut [S]) {
        let Some(wide) = &self.wide else {
            return site_by_site(self, kind, t, sums, strip, mu);
        };
        let (piece, dimension, count) = (&self.codes().pieces[kind], self.dimension(), strip.count);
        let part = |site: usize, k: usize| k * strip.sites + strip.places[site];
        let sites = 1 + usize::from(strip.bonds);
        let (t, sums) = (t.widen(), Few::make(sums.len(), |k| sums[k].widen()));
        let mut both = [zeros(dimension), zeros(dimension)];
        for i in (0..count).step_by(EIGHT) {
            for (site, values) in both.iter_mut().enumerate() {
                for (k, x) in values.iter_mut().enumerate() {
                    *x = eight(&mu[part(site, k)..][..count], i);
                }
            }
            let [one, other] = &mut both;
            flow(wide, piece, t, &sums, one, other);
            let lanes = EIGHT.min(count - i);
            for (site, values) in both.iter().enumerate().take(sites) {
                for (k, x) in values.iter().enumerate() {
                    mu[part(site, k) + i..][..lanes].copy_from_slice(&S::scatter(*x)[..lanes]);
                }
            }
        }
    }
}
