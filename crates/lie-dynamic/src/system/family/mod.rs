//! The sites of a family, by the codes of one of them: its field and its summands along columns of sites, its flows eight sites at a time
//! where the machine has lanes.

mod codes;
mod pieces;

pub(crate) use codes::Codes;

use crate::compiled::Values;
use crate::engine::ARGUMENTS;
use crate::system::names;
use lie_codegen::model::Size;
use lie_codegen::plan;
use lie_core::family::{Shape, Sites, Stretch, Term, size};
use lie_core::lattice::{AXES, last_axes};
use lie_core::parameter::ParameterError;
use lie_runtime::{Dual, Scalar};
use smallvec::{SmallVec, smallvec};

/// Defines a shape of as many values as there are, of which so many need no memory from the heap. They are handed on by value: with 64
/// in place of 24 for all of them a step of `gauss16` on a lattice took 1.4 times as long.
macro_rules! shape {
    ($(#[$doc:meta])* $name:ident, $count:literal, $of:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub struct $name;

        impl Shape for $name {
            type Of<T> = SmallVec<[T; $count]>;

            #[inline]
            fn make<T>(count: usize, one: impl FnMut(usize) -> T) -> Self::Of<T> {
                (0..count).map(one).collect()
            }
        }

        type $of<T> = <$name as Shape>::Of<T>;
    };
}

shape!(
    /// What a site has by itself, and sums.
    Few, 16, FewOf
);
shape!(
    /// What a site and those around it have.
    Near, 32, NearOf
);

fn zeros<S: Scalar>(count: usize) -> FewOf<S> {
    Few::make(count, |_| S::zero())
}

/// So many summands of a stretch need no memory from the heap.
const MANY: usize = 512;

/// So many sites move along a flow at a time where the machine has lanes.
const EIGHT: usize = 8;

/// One site of a family, made at run time.
#[derive(Clone)]
pub struct FamilySite<S: Scalar> {
    values: Values<S>,
    /// The same over eight numbers at once; none where the machine has nothing better than the interpreter for them.
    wide: Option<Values<S::Wide>>,
}

/// The number of layers, rows and columns.
pub(crate) fn sizes(sizes: &[Size], values: &Values<f64>) -> Result<[usize; AXES], ParameterError> {
    let along = |axis: &Size| match axis {
        Size::Number(count) => Ok(*count),
        Size::Parameter(parameter) => size(
            values.parameters[*parameter],
            names::text(&values.compiled.plan.names.parameters[*parameter]),
        ),
    };
    let sizes: Vec<usize> = sizes.iter().map(along).collect::<Result<_, _>>()?;
    match last_axes(&sizes, 1) {
        Some(sizes) => Ok(sizes),
        None => unreachable!("a lattice has at most {AXES} axes"),
    }
}

impl<S: Scalar> FamilySite<S> {
    /// A site of a family with these values.
    pub(crate) fn new(values: Values<S>) -> Self {
        let wide = values.machine.wide();
        let wide = wide.map(|machine| values.with_scalar(S::widen, machine));
        Self { values, wide }
    }

    fn plan(&self) -> &plan::Family {
        match &self.values.compiled.plan.family {
            Some(family) => family,
            None => panic!("the system is no family"),
        }
    }

    fn codes(&self) -> &Codes {
        match &self.values.compiled.family {
            Some(codes) => codes,
            None => panic!("the system is no family"),
        }
    }

    /// The number of coordinates and coefficients of all slots.
    fn places(&self) -> usize {
        self.plan().places()
    }

    /// What a kernel gives: so many numbers.
    fn vector(&self, code: usize, arguments: [&[S]; 2], count: usize) -> FewOf<S> {
        let mut out = zeros(count);
        self.values.call(code, arguments, &mut out, &mut []);
        out
    }

    /// What a kernel gives: a vector, and the power behind it.
    fn with_power(&self, code: usize, arguments: [&[S]; ARGUMENTS]) -> (FewOf<S>, S) {
        let mut all = zeros(self.plan().coordinates.len() + 1);
        let frame = self.values.frame(arguments, &[], &[]);
        self.values.run(code, &frame, [&mut all, &mut []]);
        let power = all.pop().unwrap_or(S::zero());
        (all, power)
    }

    /// What a kernel of a bond gives: so many numbers.
    fn of_bond(&self, which: usize, arguments: [&[S]; ARGUMENTS], count: usize) -> FewOf<S> {
        let Some(codes) = self.codes().bonds else {
            unreachable!("there are no bonds")
        };
        let mut out = zeros(count);
        let frame = self.values.frame(arguments, &[], &[]);
        self.values.run(codes[which], &frame, [&mut out, &mut []]);
        out
    }

    /// Runs a kernel of a site with its neighbours at each site of a stretch.
    fn along(&self, code: usize, stretch: &Stretch<'_, S>, weights: &[S], to: &mut [&mut [S]]) {
        let columns = stretch.around(self);
        let frame = self.values.frame([&[], weights, &[], &[]], &[], &[]);
        self.values.machine.run_columns(code, &columns, &frame, to);
    }
}

/// Eight numbers from a place on; where there are fewer, the last one again.
fn eight<S: Scalar>(from: &[S], place: usize) -> S::Wide {
    let last = from.len() - 1;
    S::gather(std::array::from_fn(|lane| from[(place + lane).min(last)]))
}

impl<S: Scalar> Sites<S> for FamilySite<S> {
    type Site = Few;
    type Around = Near;
    type Sums = Few;
    type Widened = FamilySite<S::Wide>;
    type Lifted = FamilySite<Dual<S>>;

    fn name(&self) -> &str {
        &self.values.compiled.plan.names.system
    }
    fn dimension(&self) -> usize {
        self.plan().coordinates.len()
    }
    fn coordinate(&self, index: usize) -> &str {
        &self.plan().coordinates[index]
    }
    fn offsets(&self) -> &[[isize; AXES]] {
        &self.codes().offsets
    }
    fn count(&self) -> usize {
        self.plan().sums.len()
    }
    fn term(&self, index: usize) -> Term<'_> {
        Term {
            slots: &self.plan().sums[index].slots,
            spans: codes::spans(&self.plan().sums[index].spans),
        }
    }
    fn data_places(&self) -> &[[usize; 2]] {
        &self.plan().data_places
    }
    fn data(&self, index: usize) -> &[S] {
        &self.values.data[index]
    }
    fn has_mean_field(&self) -> bool {
        self.plan().mean_field
    }
    fn degree(&self) -> Option<u32> {
        self.plan().degree
    }
    fn casimir_count(&self) -> usize {
        self.plan().casimirs.len()
    }
    fn casimir_name(&self, index: usize) -> &str {
        &self.plan().casimirs[index].name
    }
    fn casimir_degree(&self, index: usize) -> Option<u32> {
        self.plan().casimirs[index].degree
    }
    fn casimir_is_kept(&self, index: usize) -> bool {
        self.plan().casimirs[index].kept
    }
    fn acts(&self) -> bool {
        self.plan().driven.is_some()
    }
    fn is_forced(&self) -> bool {
        self.plan()
            .driven
            .as_ref()
            .is_some_and(|driven| driven.forced)
    }
    fn is_damped(&self) -> bool {
        let driven = self.plan().driven.as_ref();
        driven.is_some_and(|driven| driven.damped && !driven.forced)
    }
    fn noise_count(&self) -> usize {
        self.plan().noises()
    }
    fn is_timed(&self) -> bool {
        self.plan().timed
    }
    fn is_autonomous(&self) -> bool {
        self.plan().time_slope.is_none()
    }
    fn shared_count(&self) -> usize {
        self.plan().shared
    }
    fn input_name(&self, index: usize) -> &str {
        &self.plan().inputs[index].name
    }
    fn input_default(&self, index: usize) -> S {
        S::from_f64(f64::from_bits(self.plan().inputs[index].default))
    }
    fn input_sampling(&self, index: usize) -> Option<f64> {
        self.plan().inputs[index].sampling.map(f64::from_bits)
    }

    fn field(&self, at: &NearOf<S>, weights: &FewOf<S>) -> FewOf<S> {
        match self.acts() {
            true => self.driven(at, weights).0,
            false => self.vector(self.codes().field, [at, weights], self.dimension()),
        }
    }
    fn driven(&self, at: &NearOf<S>, weights: &FewOf<S>) -> (FewOf<S>, S) {
        self.with_power(self.codes().field, [at, weights, &[], &[]])
    }
    fn shared_act(&self, slope: &FewOf<S>, at: &NearOf<S>, shared: &FewOf<S>) -> (FewOf<S>, S) {
        match self.codes().act {
            Some(code) => self.with_power(code, [slope, at, shared, &[]]),
            None => unreachable!("nothing acts beside H"),
        }
    }
    fn slope(&self, term: usize, slot: usize, at: &NearOf<S>, weights: &FewOf<S>) -> FewOf<S> {
        match self.codes().slopes.get(&(term, slot)) {
            Some(code) => self.vector(*code, [at, weights], self.dimension()),
            None => zeros(self.dimension()),
        }
    }
    fn shared_summands(&self, at: &NearOf<S>, shared: &FewOf<S>) -> FewOf<S> {
        self.vector(self.codes().summands, [at, shared], self.plan().totals())
    }
    fn time_slope(&self, totals: &FewOf<S>) -> S {
        let code = self.codes().time_slope;
        code.map_or(S::zero(), |code| self.values.number(code, [&[], totals]))
    }
    fn energy(&self, totals: &FewOf<S>) -> S {
        self.values.number(self.codes().energy, [&[], totals])
    }
    fn weights(&self, totals: &FewOf<S>) -> FewOf<S> {
        let count = self.plan().totals();
        self.vector(self.codes().weights, [&[], totals], count)
    }

    fn bonds(&self) -> &[S] {
        match (&self.codes().bonds, &*self.values.data) {
            (Some(_), [.., bonds]) => bonds,
            _ => &[],
        }
    }
    fn shared_bond_summands(
        &self,
        one: &FewOf<S>,
        other: &FewOf<S>,
        value: S,
        shared: &FewOf<S>,
    ) -> FewOf<S> {
        let count = self.plan().totals();
        self.of_bond(0, [one, shared, other, &[value]], count)
    }
    fn bond_slopes(
        &self,
        one: &FewOf<S>,
        other: &FewOf<S>,
        value: S,
        weights: &FewOf<S>,
    ) -> [FewOf<S>; 2] {
        let n = self.dimension();
        let mut first = self.of_bond(1, [one, weights, other, &[value]], 2 * n);
        let second = first.drain(n..).collect();
        [first, second]
    }
    fn observable_count(&self) -> usize {
        self.plan().observables.len()
    }
    fn observable_name(&self, index: usize) -> &str {
        &self.plan().observables[index].name
    }
    fn observable_unwraps(&self, index: usize) -> bool {
        self.plan().observables[index].unwrap
    }
    fn observable(&self, index: usize, totals: &FewOf<S>) -> S {
        let code = self.codes().observables[index];
        self.values.number(code, [&[], totals])
    }

    fn ad(&self, xi: &FewOf<S>, eta: &FewOf<S>) -> FewOf<S> {
        self.vector(self.codes().ad, [xi, eta], self.dimension())
    }
    fn ad_star(&self, xi: &FewOf<S>, mu: &FewOf<S>) -> FewOf<S> {
        self.vector(self.codes().ad_star, [xi, mu], self.dimension())
    }
    fn casimir(&self, index: usize, mu: &FewOf<S>) -> S {
        let [value, _] = self.codes().casimirs[index];
        self.values.number(value, [mu, &[]])
    }
    fn casimir_gradient(&self, index: usize, mu: &FewOf<S>) -> FewOf<S> {
        let [_, gradient] = self.codes().casimirs[index];
        self.vector(gradient, [mu, &[]], self.dimension())
    }

    fn widen(&self) -> Self::Widened {
        let machine = self.values.machine.wide();
        let machine = machine.unwrap_or_else(|| self.values.interpreter());
        FamilySite::new(self.values.with_scalar(S::widen, machine))
    }
    fn lift(&self) -> Self::Lifted {
        FamilySite::new(
            self.values
                .with_scalar(Dual::constant_of, self.values.interpreter()),
        )
    }

    fn fields(&self, stretch: &Stretch<'_, S>, weights: &FewOf<S>, out: &mut [S]) {
        let mut to = stretch.in_state::<Few>(self.dimension(), out);
        self.along(self.codes().field, stretch, weights, &mut to);
    }

    fn driven_fields(&self, stretch: &Stretch<'_, S>, weights: &FewOf<S>, out: &mut [S]) -> S {
        let mut powers: SmallVec<[S; MANY]> = smallvec![S::zero(); stretch.len()];
        let mut to = stretch.in_state::<Few>(self.plan().coordinates.len(), out);
        to.push(&mut powers);
        self.along(self.codes().field, stretch, weights, &mut to);
        drop(to);
        powers.iter().fold(S::zero(), |sum, power| sum + *power)
    }

    fn sum(&self, stretch: &Stretch<'_, S>, shared: &FewOf<S>) -> FewOf<S> {
        let (count, places) = (self.plan().totals(), stretch.len());
        let mut summands: SmallVec<[S; MANY]> = smallvec![S::zero(); count * places];
        let mut to: FewOf<&mut [S]> = summands.chunks_exact_mut(places.max(1)).collect();
        self.along(self.codes().summands, stretch, shared, &mut to);
        drop(to);
        // one after the other, as the loop over sites adds them
        Few::make(count, |k| {
            let summands = summands[k * places..][..places].iter();
            summands.fold(S::zero(), |sum, summand| sum + *summand)
        })
    }
}
