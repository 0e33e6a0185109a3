//! A scalar that is an expression.

use std::cell::RefCell;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use lie_core::scalar::Pack;
use lie_core::{Elementary, Scalar};

use crate::derive::{Block, Source, Tape};
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{ExprId, Function, Symbol};

/// What a trace writes to. It belongs to the thread because arithmetic has no place for it.
pub(super) struct Session {
    pub(super) source: Source,
    pub(super) tape: Tape,
    /// How many numbers were taken for arguments.
    pub(super) given: usize,
    /// Whether something was asked that has no answer for an expression.
    pub(super) branched: bool,
}

thread_local! {
    static SESSION: RefCell<Option<Session>> = const { RefCell::new(None) };
}

/// Runs code that may compute with [`Sym`], and gives the session back.
pub(super) fn run_session<T>(session: Session, run: impl FnOnce() -> T) -> (T, Session) {
    SESSION.with(|cell| {
        let before = cell.borrow_mut().replace(session);
        let value = run();
        let session = std::mem::replace(&mut *cell.borrow_mut(), before);
        (value, session.expect("the session of this trace"))
    })
}

/// The session of the trace that runs.
pub(super) fn with_session<T>(use_it: impl FnOnce(&mut Session) -> T) -> T {
    SESSION.with(|cell| {
        let mut session = cell.borrow_mut();
        use_it(session.as_mut().expect("symbols live within a trace"))
    })
}

/// An expression of the session's arena.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sym(pub(super) ExprId);

impl Sym {
    pub(crate) fn from_symbol(symbol: Symbol) -> Self {
        Self(with_session(|s| s.source.graph.symbol(symbol)))
    }

    fn number(value: Rational) -> Self {
        Self(with_session(|s| s.source.graph.number(value)))
    }

    fn call(self, function: Elementary) -> Self {
        Self(with_session(|s| s.source.graph.call(function, &[self.0])))
    }

    /// An answer that depends on the values.
    fn branch<T>(answer: T) -> T {
        with_session(|s| s.branched = true);
        answer
    }
}

impl Default for Sym {
    fn default() -> Self {
        Self::zero()
    }
}

macro_rules! operators {
    ($($trait:ident $method:ident $assign:ident $assigned:ident $build:ident;)+) => {$(
        impl $trait for Sym {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                Self(with_session(|s| s.source.graph.$build(self.0, other.0)))
            }
        }
        impl $assign for Sym {
            fn $assigned(&mut self, other: Self) {
                *self = $trait::$method(*self, other);
            }
        }
    )+};
}
operators! {
    Add add AddAssign add_assign add;
    Sub sub SubAssign sub_assign sub;
    Mul mul MulAssign mul_assign mul;
    Div div DivAssign div_assign div;
}

impl Neg for Sym {
    type Output = Self;
    fn neg(self) -> Self {
        Self(with_session(|s| s.source.graph.neg(self.0)))
    }
}

/// A number that f64 holds, exactly; what is not finite has no exact value.
fn exact(value: f64) -> Rational {
    Rational::from_f64(value).unwrap_or_else(|| Sym::branch(Rational::ZERO))
}

macro_rules! functions {
    ($($variant:ident $name:ident $single:ident $from:ident $what:literal $facts:tt)+) => {
        $(fn $name(self) -> Self {
            self.call(Elementary::$variant)
        })+
    };
}

impl Scalar for Sym {
    type Lane = Self;
    type Mask = bool;
    type Wide = Pack<Self>;
    const LANES: usize = 1;

    fn zero() -> Self {
        Self::number(Rational::ZERO)
    }
    fn one() -> Self {
        Self::number(Rational::ONE)
    }
    fn ratio(numerator: f64, denominator: f64) -> Self {
        Self::number(&exact(numerator) / &exact(denominator))
    }
    fn constant(high: f64, low: f64) -> Self {
        Self::number(&exact(high) + &exact(low))
    }
    fn from_f64(value: f64) -> Self {
        Self::number(exact(value))
    }
    fn epsilon() -> Self {
        Self::branch(Self::zero())
    }

    fn quantity(self) -> Self {
        Self(with_session(|s| s.tape.define(&mut s.source, self.0)))
    }

    fn given<const K: usize>(first: usize, _compute: impl FnOnce() -> [Self; K]) -> [Self; K] {
        with_session(|s| {
            s.given = s.given.max(first + K);
            let symbols = s.source.block(Block::Given);
            std::array::from_fn(|k| Self(symbols[first + k]))
        })
    }

    fn splat(lane: Self) -> Self {
        lane
    }
    fn lane(self, _index: usize) -> Self {
        self
    }
    fn with_lane(self, _index: usize, lane: Self) -> Self {
        lane
    }
    fn gather(numbers: [Self; 8]) -> Self::Wide {
        Pack(numbers)
    }
    fn scatter(wide: Self::Wide) -> [Self; 8] {
        wide.0
    }
    fn to_f64(self) -> f64 {
        Self::branch(f64::NAN)
    }

    fn abs(self) -> Self {
        self.powf(Self::ratio(2.0, 1.0)).sqrt()
    }
    fn sqrt(self) -> Self {
        self.powf(Self::ratio(1.0, 2.0))
    }
    lie_core::elementary_functions!(functions);
    fn atan2(self, x: Self) -> Self {
        Self(with_session(|s| {
            s.source.graph.call(Function::Atan2, &[self.0, x.0])
        }))
    }
    fn powf(self, exponent: Self) -> Self {
        let number = with_session(|s| s.source.graph.as_number(exponent.0).cloned());
        match number {
            Some(number) => Self(with_session(|s| s.source.graph.pow(self.0, &number))),
            None => (exponent * self.log()).exp(),
        }
    }

    fn max(self, other: Self) -> Self {
        if self == other {
            return self;
        }
        Self::branch(self)
    }
    fn less(self, _other: Self) -> bool {
        Self::branch(false)
    }
    fn less_equal(self, _other: Self) -> bool {
        Self::branch(false)
    }
    fn finite(self) -> bool {
        Self::branch(true)
    }
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
}
