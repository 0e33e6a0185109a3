//! Functions that the compiler cannot look into: those of a user, in Rust.
//!
//! Two of them are equal where function, derivatives and arguments are. That is all that is known of them, and what
//! follows from it holds for every function in their place.

use std::collections::BTreeSet;
use std::f64::consts::FRAC_PI_2;
use std::sync::{Mutex, PoisonError};

use crate::exact::Rational;

/// The largest number of arguments.
pub const MOST_ARGUMENTS: usize = 4;

/// A function as it was declared.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Declared {
    /// Its name in expressions.
    pub name: String,
    /// Where it is found in Rust.
    pub path: String,
    /// The number of its arguments, from 1 to [`MOST_ARGUMENTS`].
    pub arity: usize,
    /// Where the derivatives by the arguments are found, one for each; none where dual numbers give them.
    pub derivatives: Vec<String>,
    /// How many derivatives are continuous; `None` where all of them are.
    pub smooth: Option<u32>,
}

/// A partial derivative of such a function, of order 0 the function itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Opaque {
    declared: &'static Declared,
    orders: [u8; MOST_ARGUMENTS],
}

/// The declarations that were met. They live as long as the compiler, so that a function is a value that is copied.
static MET: Mutex<BTreeSet<&'static Declared>> = Mutex::new(BTreeSet::new());

impl Opaque {
    /// The function of a declaration.
    pub fn new(declared: Declared) -> Self {
        let mut met = MET.lock().unwrap_or_else(PoisonError::into_inner);
        let known = met.get(&declared).copied();
        let declared = known.unwrap_or_else(|| {
            let kept: &'static Declared = Box::leak(Box::new(declared));
            met.insert(kept);
            kept
        });
        Self {
            declared,
            orders: [0; MOST_ARGUMENTS],
        }
    }

    /// How it was declared.
    pub fn declared(self) -> &'static Declared {
        self.declared
    }

    /// The arguments by which it is differentiated, each as often as it is.
    pub fn differentiated(self) -> Vec<usize> {
        let orders = self.orders.iter().enumerate();
        let each = orders.flat_map(|(place, order)| vec![place; usize::from(*order)]);
        each.collect()
    }

    /// Its derivative by an argument.
    #[must_use]
    pub fn derivative(mut self, argument: usize) -> Self {
        self.orders[argument] += 1;
        self
    }

    /// What it is called: `f'`, of several arguments `f^(1, 0)`.
    pub fn label(self) -> String {
        let Declared { name, arity, .. } = self.declared;
        match *arity {
            1 => format!("{name}{}", "'".repeat(self.orders[0].into())),
            _ if self.orders == [0; MOST_ARGUMENTS] => name.clone(),
            arity => {
                let orders: Vec<_> = self.orders[..arity].iter().map(u8::to_string).collect();
                format!("{name}^({})", orders.join(", "))
            }
        }
    }

    // Where values decide which form of a program errs less, or whether an identity that was proven for every function
    // is contradicted, a function stands in: `sin(phase + sum_i weight_i x_i)`, whose derivatives are known as well.

    /// By how much the function that stands in grows with an argument.
    pub fn weight(argument: usize) -> Rational {
        let eighths = i64::try_from(8 + argument).unwrap_or(8);
        Rational::new(eighths, 8).unwrap_or(Rational::ONE)
    }

    /// The phase of the function that stands in, another one for another function, and the quarter turns of the derivative.
    pub fn phase(self) -> (Rational, u8) {
        let name = self.declared.name.bytes();
        let sum = name.fold(7, |sum: i64, byte| (sum * 31 + i64::from(byte)) % 1009);
        let phase = Rational::new(sum, 1009).unwrap_or(Rational::ONE);
        let turns = self.orders.iter().fold(0, |sum, order| (sum + order) % 4);
        (phase, turns)
    }

    /// What the derivatives of the function that stands in are multiplied by.
    pub fn amplitude(self) -> Rational {
        let factors = self.differentiated().into_iter().map(Self::weight);
        factors.fold(Rational::ONE, |product, factor| &product * &factor)
    }

    /// The value of the function that stands in.
    pub fn stand_in(self, arguments: &[f64]) -> f64 {
        let (phase, turns) = self.phase();
        let weighted = arguments.iter().enumerate();
        let weighted = weighted.map(|(place, x)| Self::weight(place).to_f64() * x);
        let angle = phase.to_f64() + f64::from(turns) * FRAC_PI_2 + weighted.sum::<f64>();
        self.amplitude().to_f64() * libm::sin(angle)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_of_what_stands_in_are_slopes() {
        let f = Opaque::new(Declared {
            name: "f".into(),
            path: "crate::f".into(),
            arity: 2,
            derivatives: Vec::new(),
            smooth: None,
        });
        for f in [f, f.derivative(1), f.derivative(0).derivative(1)] {
            for argument in 0..2 {
                let at = |shift: f64| {
                    let mut arguments = [0.3, -0.8];
                    arguments[argument] += shift;
                    f.stand_in(&arguments)
                };
                let slope = (at(1e-5) - at(-1e-5)) / 2e-5;
                let derivative = f.derivative(argument).stand_in(&[0.3, -0.8]);
                assert!((slope - derivative).abs() < 1e-9, "{}", f.label());
                // the control: the derivative by the other argument is another number
                let other = f.derivative(1 - argument).stand_in(&[0.3, -0.8]);
                assert!((slope - other).abs() > 1e-3);
            }
        }
        assert_eq!(f.derivative(1).label(), "f^(0, 1)");
        assert_eq!(f.derivative(0).differentiated(), [0]);
    }
}
