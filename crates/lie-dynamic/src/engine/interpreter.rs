//! Code run by a loop over its instructions, for every scalar: the reference of all other ways.

use super::machine::{Engine, Frame, Machine, Targets};
use crate::code::{Code, Instruction, Number, Register, Source};
use lie_core::closed;
use lie_runtime::{Mask, Scalar};
use std::sync::Arc;

/// The engine of the interpreter.
#[derive(Clone, Copy, Debug, Default)]
pub struct Interpreted;

impl Engine for Interpreted {
    fn name(&self) -> &'static str {
        "interpreter"
    }

    fn machine(&self, codes: &Arc<[Code]>) -> Arc<dyn Machine<f64>> {
        Arc::new(Interpreter::new(Arc::clone(codes)))
    }
}

/// Codes over a scalar.
#[derive(Clone, Debug)]
pub struct Interpreter(Arc<[Code]>);

/// Up to so many registers need no memory from the heap: room for the least of these that is enough is made, for small scalars.
const FEW: usize = 128;
const SOME: usize = 512;
const MANY: usize = 2048;
const SMALL: usize = 16;

impl Interpreter {
    /// Ready to run these.
    pub fn new(codes: Arc<[Code]>) -> Self {
        Self(codes)
    }
}

impl<S: Scalar> Machine<S> for Interpreter {
    fn run(&self, code: usize, frame: &Frame<'_, S>, targets: Targets<'_, S>) {
        let code = &self.0[code];
        let count = code.registers as usize;
        let is_small = size_of::<S>() <= SMALL;
        match count {
            ..=FEW => run_on_stack::<S, FEW>(code, frame, targets),
            ..=SOME if is_small => run_on_stack::<S, SOME>(code, frame, targets),
            ..=MANY if is_small => run_on_stack::<S, MANY>(code, frame, targets),
            _ => run(code, frame, &mut vec![S::zero(); count], targets),
        }
    }
}

/// With so many registers, which take room on the stack while it runs alone.
#[inline(never)]
fn run_on_stack<S: Scalar, const REGISTERS: usize>(
    code: &Code,
    frame: &Frame<'_, S>,
    targets: Targets<'_, S>,
) {
    run(code, frame, &mut [S::zero(); REGISTERS], targets);
}

impl Number {
    /// The number over a scalar.
    pub fn value<S: Scalar>(self) -> S {
        match self {
            Self::Exact(value) => S::from_f64(value),
            Self::Ratio(numerator, denominator) => S::ratio(numerator, denominator),
            Self::Parts(high, low) => S::constant(high, low),
        }
    }
}

fn load<S: Scalar>(source: &Source, frame: &Frame<'_, S>) -> S {
    match (source.place(), source) {
        (Some((slice, entry)), _) => frame.slices()[slice][entry],
        (None, Source::Number(number)) => number.value(),
        (None, other) => unreachable!("{other:?} is in a slice"),
    }
}

impl Instruction {
    /// The number that it gives over a scalar; none where it gives several.
    #[inline(always)]
    pub(crate) fn single<S: Scalar>(&self, at: &impl Fn(Register) -> S) -> Option<S> {
        Some(match *self {
            Self::Add(a, b) => at(a) + at(b),
            Self::Sub(a, b) => at(a) - at(b),
            Self::Mul(a, b) => at(a) * at(b),
            Self::Div(a, b) => at(a) / at(b),
            Self::Neg(a) => -at(a),
            Self::Sqrt(a) => at(a).sqrt(),
            Self::Abs(a) => at(a).abs(),
            Self::Exchange(distance, a) => exchanged(at(a), usize::from(distance)),
            Self::Power(a, b) => at(a).powf(at(b)),
            Self::Atan2(a, b) => at(a).atan2(at(b)),
            Self::Call(function, a) => function.apply(at(a)),
            Self::Below(a, b, c) | Self::Blend(a, b, c) => {
                S::select(at(a).less(S::zero()), at(b), at(c))
            }
            Self::Bits(what, a, b) => words([at(a), at(b)], |a, b| what.of(a, b)),
            Self::Shift(places, a) => words([at(a); 2], |a, _| Self::shifted(a, places)),
            Self::Rare(function, a, b, c) => {
                let is_usual = S::zero().less_equal(at(b));
                match is_usual.all() {
                    true => at(c),
                    false => S::select(is_usual, at(c), function.apply(at(a))),
                }
            }
            Self::Less(a, b) => S::select(at(a).less(at(b)), S::one(), S::zero()),
            Self::LessEqual(a, b) => S::select(at(a).less_equal(at(b)), S::one(), S::zero()),
            Self::Larger(a, b) => at(a).max(at(b)),
            Self::Stumpff(..) | Self::Phi(..) => return None,
        })
    }

    /// All functions of a family, the first of these.
    pub(crate) fn family<S: Scalar>(
        &self,
        at: &impl Fn(Register) -> S,
    ) -> [S; closed::MOST_FUNCTIONS] {
        match *self {
            Self::Stumpff(count, a) => closed::counted::stumpff(usize::from(count), at(a)),
            Self::Phi(count, a) => closed::counted::phi(usize::from(count), at(a)),
            _ => [S::zero(); closed::MOST_FUNCTIONS],
        }
    }
}

/// The lanes of a number with places i and i xor a distance exchanged.
fn exchanged<S: Scalar>(number: S, distance: usize) -> S {
    S::from_lanes(|lane| number.lane(lane ^ distance))
}

/// Something done with the words of bits of double precision, lane by lane.
#[inline(never)]
fn words<S: Scalar>([a, b]: [S; 2], with: impl Fn(u64, u64) -> u64) -> S {
    let word = |x: S, lane: usize| x.lane(lane).to_f64().to_bits();
    S::from_lanes(|lane| {
        let word = with(word(a, lane), word(b, lane));
        S::Lane::from_f64(f64::from_bits(word))
    })
}

fn run<S: Scalar>(
    code: &Code,
    frame: &Frame<'_, S>,
    registers: &mut [S],
    mut targets: Targets<'_, S>,
) {
    for (register, source) in registers.iter_mut().zip(&code.sources) {
        *register = load(source, frame);
    }
    let mut next = code.sources.len();
    for instruction in &code.instructions {
        let at = |register: u32| registers[register as usize];
        if let Some(value) = instruction.single(&at) {
            registers[next] = value;
            next += 1;
            continue;
        }
        let all = instruction.family(&at);
        let width = instruction.width() as usize;
        registers[next..next + width].copy_from_slice(&all[..width]);
        next += width;
    }
    for (target, clear) in targets.iter_mut().zip(code.clear) {
        if let Some(count) = clear {
            target[..count as usize].fill(S::zero());
        }
    }
    for store in &code.stores {
        targets[usize::from(store.target)][store.entry as usize] =
            registers[store.register as usize];
    }
}

/// All functions of closed forms below an index, in the first entries, as machine code calls them: with a copy for each count, which is
/// several times as fast as [`closed::counted`].
macro_rules! below {
    ($name:ident, $($count:literal)+) => {
        #[doc = "All of these functions below an index, in the first entries, for what is compiled."]
        pub fn $name(count: u8, x: f64) -> [f64; closed::MOST_FUNCTIONS] {
            let mut all = [0.0; closed::MOST_FUNCTIONS];
            match count {
                $($count => all[..$count].copy_from_slice(&closed::$name::<f64, 0, $count>(x)),)+
                _ => unreachable!("closed forms have at most 14 functions"),
            }
            all
        }
    };
}
below!(stumpff, 1 2 3 4 5 6 7 8 9 10 11 12 13 14);
below!(phi, 1 2 3 4 5 6 7 8 9 10 11 12 13 14);
