//! The equations of steps: fused ones in code, generic ones with the elimination of the plan.

use crate::compiled::elimination::{Blocks, Elimination, Scratch};
use crate::compiled::{Call, CallArgument, FusedCodes};
use crate::engine::ARGUMENTS;
use crate::system::Dynamic;
use lie_codegen::methods::Choice;
use lie_codegen::plan::{Chart, Ending, Fused, Guess, Item, Solver};
use lie_core::{SquareMatrix, equation::newton_update, generic};
use lie_runtime::methods::Retraction;
use lie_runtime::{Clock, Equation, Mask as _, Poisson, Scalar, Unknown};
use std::cell::RefCell;

/// A fused equation at work.
struct Running<'a, S> {
    codes: &'a FusedCodes,
    row: &'a Fused,
    base: Vec<S>,
    field: Vec<S>,
    of_step: Vec<S>,
    ratios: Vec<S>,
    /// An update of Newton's iteration with the residual behind it.
    both: Vec<S>,
}

/// A generic equation whose type is forgotten: what surrounds it is compiled for its unknown alone.
pub type Generic<'a, S, U, M> = Box<dyn Equation<S, State = Vec<S>, Unknown = U, Matrix = M> + 'a>;

/// The equation of the step of a method as the plan has it; the generic one where it has nothing.
pub struct Planned<'a, S: Scalar, U, M> {
    system: &'a Dynamic<S>,
    h: S,
    generic: Generic<'a, S, U, M>,
    fused: Option<Running<'a, S>>,
    elimination: Option<&'a Elimination>,
    scratch: RefCell<Scratch<S>>,
}

impl<'a, S, U, M> Planned<'a, S, U, M>
where
    S: Scalar,
    U: Unknown<S>,
    M: SquareMatrix<S>,
{
    /// The equation of a step of size h, `generic` being the generic one of the same step.
    pub(crate) fn new(
        system: &'a Dynamic<S>,
        choice: &Choice,
        h: S,
        generic: Generic<'a, S, U, M>,
    ) -> Self {
        let solver = system.values.compiled.solvers.get(choice);
        let (mut fused, mut elimination) = (None, None);
        match solver {
            Some(Solver::Fused(suffix)) => {
                fused = system.values.compiled.fused.get(suffix).map(|codes| {
                    elimination = Some(&codes.elimination);
                    let Item::Fused(row) = &system.values.compiled.plan.items[codes.item] else {
                        unreachable!("the row of a fused equation")
                    };
                    let zero = system.zero_state();
                    Running {
                        codes,
                        row,
                        field: zero.clone(),
                        both: [zero.as_slice(), &zero].concat(),
                        base: zero,
                        of_step: system.values.step_constants(&codes.step, h),
                        ratios: vec![S::zero(); 2 * spins(system, row)],
                    }
                });
            }
            Some(Solver::Eliminated(_, suffix)) => {
                elimination = system.values.compiled.eliminations.get(suffix);
            }
            Some(Solver::Generic(_)) | None => {}
        }
        Self {
            system,
            h,
            generic,
            fused,
            elimination,
            scratch: RefCell::default(),
        }
    }

    /// The generic equation at the state of the fused one, and the unknown with what the iteration left out.
    fn partner(&mut self, unknown: &U) -> (&mut Generic<'a, S, U, M>, Option<U>) {
        let Some(fused) = &self.fused else {
            return (&mut self.generic, None);
        };
        self.generic.set_base(&fused.base);
        let completed = fused.codes.completed.as_ref().map(|call| {
            let mut all = unknown.clone();
            let targets = [all.part_mut(0), &mut []];
            let at = (self.h, unknown.part(0));
            fused.run(self.system, call, at, targets);
            all
        });
        (&mut self.generic, completed)
    }
}

/// How many spins an equation asks for.
fn spins<S: Scalar>(system: &Dynamic<S>, row: &Fused) -> usize {
    let spherical = row.partner.choice() == Some(&Choice::SphericalMidpoint);
    let spins = system.plan().structure.spins.as_ref().filter(|_| spherical);
    spins.map_or(0, |spins| spins.coordinates.len())
}

impl<S: Scalar> Running<'_, S> {
    /// What the runtime computes from the state and the unknown before a kernel.
    fn prepare(&mut self, system: &Dynamic<S>, unknown: &[S]) {
        if !self.ratios.is_empty() {
            generic::sphere_ratios_into(system, &self.base, unknown, &mut self.ratios);
        }
    }

    fn run(
        &self,
        system: &Dynamic<S>,
        call: &Call,
        (h, unknown): (S, &[S]),
        targets: [&mut [S]; 2],
    ) {
        let inverse = match call.arguments.contains(&CallArgument::Inverse) {
            true => generic::inverse_length(system, &self.base, &unknown.to_vec()),
            false => [S::zero()],
        };
        let mut places: [&[S]; ARGUMENTS] = [&[]; ARGUMENTS];
        for (place, argument) in places.iter_mut().zip(&call.arguments) {
            *place = match argument {
                CallArgument::Base => &self.base,
                CallArgument::Unknown => unknown,
                CallArgument::Inverse => &inverse,
                CallArgument::Ratios => &self.ratios,
            };
        }
        let scalars = [h];
        let frame = system.values.frame(places, &self.of_step, &scalars);
        system.values.run(call.code, &frame, targets);
    }
}

impl<S, U, M> Equation<S> for Planned<'_, S, U, M>
where
    S: Scalar,
    U: Unknown<S>,
    M: SquareMatrix<S> + Blocks<S>,
{
    type State = Vec<S>;
    type Unknown = U;
    type Matrix = M;

    fn zero_unknown(&self) -> Self::Unknown {
        self.generic.zero_unknown()
    }

    fn zero_matrix(&self) -> Self::Matrix {
        self.generic.zero_matrix()
    }

    fn set_base(&mut self, mu: &Vec<S>) {
        match &mut self.fused {
            Some(fused) => fused.base.copy_from_slice(mu),
            None => self.generic.set_base(mu),
        }
    }

    fn scale(&self, mu: &Vec<S>) -> S {
        match &self.fused {
            Some(_) => self.system.norm(mu),
            None => self.generic.scale(mu),
        }
    }

    fn clock(&self) -> Option<Clock> {
        match &self.fused {
            Some(_) => self.system.clock(),
            None => self.generic.clock(),
        }
    }

    fn initial_guess(&mut self, unknown: &mut Self::Unknown) {
        let Some(fused) = &mut self.fused else {
            return self.generic.initial_guess(unknown);
        };
        let factor = match fused.row.guess {
            Guess::WholeStep => self.h,
            Guess::HalfStep => self.h * S::from_f64(0.5),
            Guess::Kernel => {
                let Some(call) = &fused.codes.guess else {
                    unreachable!("the guess is a kernel")
                };
                let targets = [unknown.part_mut(0), &mut []];
                return fused.run(self.system, call, (self.h, &[]), targets);
            }
        };
        let mut field = std::mem::take(&mut fused.field);
        self.system.vector_field(&fused.base, &mut field);
        let entries = unknown.part_mut(0);
        entries.copy_from_slice(&fused.base);
        for (entry, slope) in entries.iter_mut().zip(&field) {
            *entry += factor * *slope;
        }
        fused.field = field;
    }

    fn leave_out(&self, unknown: &mut Self::Unknown) {
        let Some(fused) = &self.fused else {
            return self.generic.leave_out(unknown);
        };
        let entries = unknown.part_mut(0);
        for index in &fused.codes.left_out {
            entries[*index] = fused.base[*index];
        }
    }

    fn residual(&mut self, unknown: &Self::Unknown, residual: &mut Self::Unknown) {
        let Some(fused) = &mut self.fused else {
            return self.generic.residual(unknown, residual);
        };
        let (unknown, call) = (unknown.part(0), &fused.codes.residual);
        fused.prepare(self.system, unknown);
        let targets = [residual.part_mut(0), &mut []];
        fused.run(self.system, call, (self.h, unknown), targets);
    }

    fn approach(
        &mut self,
        unknown: &Self::Unknown,
        residual: &mut Self::Unknown,
        active: S::Mask,
    ) -> S {
        if self.fused.is_some() {
            self.residual(unknown, residual);
            return S::zero();
        }
        self.generic.approach(unknown, residual, active)
    }

    fn linearize(
        &mut self,
        unknown: &Self::Unknown,
        residual: &mut Self::Unknown,
        matrix: &mut Self::Matrix,
    ) {
        let Some(fused) = &mut self.fused else {
            return self.generic.linearize(unknown, residual, matrix);
        };
        let (unknown, call) = (unknown.part(0), &fused.codes.linearize);
        fused.prepare(self.system, unknown);
        let targets = [residual.part_mut(0), matrix.block_mut(0, 0)];
        fused.run(self.system, call, (self.h, unknown), targets);
    }

    fn factor(&self, matrix: &mut Self::Matrix) -> S::Mask {
        let Some(elimination) = self.elimination else {
            return self.generic.factor(matrix);
        };
        let mut scratch = self.scratch.borrow_mut();
        elimination.factor(&self.system.values, matrix, &mut scratch)
    }

    fn solve(&self, factors: &Self::Matrix, residual: &mut Self::Unknown) {
        let Some(elimination) = self.elimination else {
            return self.generic.solve(factors, residual);
        };
        let mut scratch = self.scratch.borrow_mut();
        elimination.solve(&self.system.values, factors, residual, &mut scratch);
    }

    fn newton_update(
        &mut self,
        unknown: &Self::Unknown,
        update: &mut Self::Unknown,
        factors: &mut Self::Matrix,
    ) -> (S, S::Mask) {
        let fused = self.fused.as_mut();
        let updated = fused.and_then(|fused| Some((fused.codes.update.as_ref()?, fused)));
        let Some((call, fused)) = updated else {
            return newton_update(self, unknown, update, factors);
        };
        let unknown = unknown.part(0);
        fused.prepare(self.system, unknown);
        let mut both = std::mem::take(&mut fused.both);
        let factors = factors.block_mut(0, 0);
        let targets = [both.as_mut_slice(), &mut *factors];
        fused.run(self.system, call, (self.h, unknown), targets);
        let (solution, residual) = both.split_at(unknown.len());
        update.part_mut(0).copy_from_slice(solution);
        let residual = S::largest_magnitude(residual);
        let safe = fused.codes.elimination.are_safe(factors, unknown.len());
        fused.both = both;
        (residual, safe)
    }

    fn jacobian_cost(&self) -> f64 {
        let known = self.fused.as_ref().and_then(|fused| fused.codes.cost);
        known.unwrap_or_else(|| self.generic.jacobian_cost())
    }

    fn result(&mut self, unknown: &Self::Unknown, mu: &mut Vec<S>) {
        let Some(fused) = &mut self.fused else {
            return self.generic.result(unknown, mu);
        };
        match fused.row.ending {
            Ending::Unknown => mu.copy_from_slice(unknown.part(0)),
            Ending::Partner => {
                let (generic, completed) = self.partner(unknown);
                generic.result(completed.as_ref().unwrap_or(unknown), mu);
            }
            Ending::Kernel => {
                let Some(call) = &fused.codes.result else {
                    unreachable!("the ending is a kernel")
                };
                let (unknown, targets) = (unknown.part(0), [mu.as_mut_slice(), &mut []]);
                fused.prepare(self.system, unknown);
                fused.run(self.system, call, (self.h, unknown), targets);
            }
        }
    }

    fn resolved(&mut self, unknown: &Self::Unknown, end: &Vec<S>) -> S::Mask {
        match &self.fused {
            Some(_) => S::Mask::splat(true),
            None => self.generic.resolved(unknown, end),
        }
    }

    fn within_chart(&mut self, unknown: &Self::Unknown) -> S::Mask {
        let Some(fused) = &self.fused else {
            return self.generic.within_chart(unknown);
        };
        match fused.row.chart {
            None => S::Mask::splat(true),
            Some(Chart::OfField) => {
                let (_, completed) = self.partner(unknown);
                let point = completed.as_ref().unwrap_or(unknown).part(0).to_vec();
                generic::cayley_chart_of_step(self.system, self.h, &point)
            }
            Some(Chart::OfFactor) => {
                let mut xi = self.system.zero_state();
                let _ = self.group_factor(unknown, &mut xi);
                generic::cayley_chart(self.system, &xi)
            }
            Some(Chart::OfPartner) => {
                let (generic, completed) = self.partner(unknown);
                generic.within_chart(completed.as_ref().unwrap_or(unknown))
            }
        }
    }

    fn earlier_factor(&mut self, unknown: &Self::Unknown, eta: &mut Vec<S>) -> Option<Retraction> {
        let (generic, completed) = self.partner(unknown);
        generic.earlier_factor(completed.as_ref().unwrap_or(unknown), eta)
    }

    fn group_factor(&mut self, unknown: &Self::Unknown, xi: &mut Vec<S>) -> Option<Retraction> {
        let (generic, completed) = self.partner(unknown);
        generic.group_factor(completed.as_ref().unwrap_or(unknown), xi)
    }

    fn velocity(&mut self, unknown: &Self::Unknown, stage: usize, xi: &mut Vec<S>) -> usize {
        let (generic, completed) = self.partner(unknown);
        generic.velocity(completed.as_ref().unwrap_or(unknown), stage, xi)
    }
}
