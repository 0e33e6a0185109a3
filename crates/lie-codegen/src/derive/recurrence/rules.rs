//! The recurrences of the elementary functions of one number, by their differential equations.

use super::{At, Lowering, Term, number};
use lie_core::functions::{Curve, Elementary, Quadratic, Rules, Words};
use lie_symbolic::exact::Rational;
use lie_symbolic::schedule::{Operation, Value};

/// A function of what varies.
pub(super) struct Composed<'a> {
    pub lowering: &'a mut Lowering,
    pub function: Elementary,
    pub u: &'a Term,
}

impl Composed<'_> {
    fn at_zero(&mut self) -> Value {
        let u = std::slice::from_ref(self.u);
        self.lowering.at_zero(self.function, u)
    }
}

impl Rules for Composed<'_> {
    type Words = Lowering;
    type Answer = Term;

    /// `Dy = g Du`
    fn integral(mut self, slope: impl FnOnce(&mut Lowering, &Term) -> Term) -> Term {
        let zero = self.at_zero();
        let Self { lowering, u, .. } = self;
        let g = slope(lowering, u);
        let first = lowering.keep(g.zero.clone());
        let ends = lowering.advance.mul(u.row(), first);
        let Some(row) = g.row else {
            return Term::varying(zero, ends);
        };
        let pair = (lowering.slope(&u.row()), row);
        let known = lowering.pairs.iter().position(|known| *known == pair);
        let rest = match known {
            Some(place) => Value::Prepared(super::Quantity::Rest(place)),
            None => lowering.rest(&pair.0, &pair.1),
        };
        let rest = lowering.over_order(rest);
        Term::varying(zero, lowering.advance.add(ends, rest))
    }

    /// `Dy = y Du`
    fn exponential(mut self) -> Term {
        let zero = self.at_zero();
        let Self { lowering, u, .. } = self;
        let first = lowering.keep(zero.clone());
        let (place, rest) = lowering.reserve();
        let ends = lowering.advance.mul(u.row(), first);
        let rest = lowering.over_order(rest);
        let row = lowering.advance.add(ends, rest);
        lowering.pairs[place] = (lowering.slope(&u.row()), row.clone());
        Term::varying(zero, row)
    }

    fn sine(self, curve: Curve) -> Term {
        self.lowering.pair(self.u, curve).0
    }

    fn cosine(self, curve: Curve) -> Term {
        self.lowering.pair(self.u, curve).1
    }

    /// `Dy = w Du`, `w = 1 + y y` on the circle and `1 - y y` on the hyperbola.
    fn tangent(mut self, curve: Curve) -> Term {
        let zero = self.at_zero();
        let Self { lowering, u, .. } = self;
        let square = lowering.begin.mul(zero.clone(), zero.clone());
        let w = match curve {
            Curve::Circle => lowering.begin.add(number(1), square),
            Curve::Hyperbola => lowering.begin.sub(number(1), square),
        };
        let first = lowering.keep(w);
        let (of_w, with_w) = lowering.reserve();
        let ends = lowering.advance.mul(u.row(), first);
        let with_w = lowering.over_order(with_w);
        let row = lowering.advance.add(ends, with_w);
        let y = Term::varying(zero, row);
        let mut w_row = lowering.product(&y, &y);
        if curve == Curve::Hyperbola {
            w_row = lowering.advance.neg(w_row);
        }
        lowering.pairs[of_w] = (lowering.slope(&u.row()), w_row);
        y
    }

    /// As a power: `u Dy = y Du/3`.
    fn cube_root(mut self) -> Term {
        let zero = self.at_zero();
        let third = Rational::new(1, 3).unwrap_or(Rational::ONE);
        let row = self.lowering.power(self.u, &third, &zero);
        Term::varying(zero, row)
    }

    /// `w Dy = Du`
    fn inverse(mut self, w: Quadratic) -> Term {
        let zero = self.at_zero();
        let w = self.lowering.quadratic(w, self.u);
        self.lowering.integral(zero, &self.u.row(), &w)
    }

    /// The same with a root for w, or `w Dy = -Du`.
    fn inverse_root(mut self, sign: i32, w: Quadratic) -> Term {
        let zero = self.at_zero();
        let Self { lowering, u, .. } = self;
        let inside = lowering.quadratic(w, u);
        let root = lowering.root(&inside);
        let known = match sign {
            -1 => lowering.advance.neg(u.row()),
            _ => u.row(),
        };
        lowering.integral(zero, &known, &root)
    }
}

/// Formulas of terms, of which some may not vary.
impl Words for Lowering {
    type Value = Term;

    fn integer(&mut self, value: i32) -> Term {
        Term {
            zero: number(value.into()),
            row: None,
        }
    }
    fn negate(&mut self, a: &Term) -> Term {
        Term {
            zero: self.begin.neg(a.zero.clone()),
            row: a.row.clone().map(|row| self.advance.neg(row)),
        }
    }
    fn multiply(&mut self, a: &Term, b: &Term) -> Term {
        let varies = a.row.is_some() || b.row.is_some();
        Term {
            zero: self.begin.mul(a.zero.clone(), b.zero.clone()),
            row: varies.then(|| self.product(a, b)),
        }
    }
    fn divide(&mut self, a: &Term, b: &Term) -> Term {
        let varies = a.row.is_some() || b.row.is_some();
        let zero = Operation::Div(a.zero.clone(), b.zero.clone());
        let zero = self.begin.push(zero);
        let row = varies.then(|| self.quotient(a, b, &zero));
        Term { zero, row }
    }
    fn root(&mut self, a: &Term) -> Term {
        let zero = self.begin.push(Operation::Sqrt(a.zero.clone()));
        let row = a.row.is_some().then(|| self.square_root(a, &zero));
        Term { zero, row }
    }
    fn quadratic(&mut self, form: Quadratic, x: &Term) -> Term {
        let one = number(1);
        let (zero, row): (Value, Option<At>) = match form {
            Quadratic::Argument => return x.clone(),
            Quadratic::OnePlus => (self.begin.add(one, x.zero.clone()), x.row.clone()),
            square => {
                let Term { zero, row } = self.multiply(x, x);
                match square {
                    Quadratic::SquareMinusOne => (self.begin.sub(zero, one), row),
                    Quadratic::OneMinusSquare => {
                        let zero = self.begin.sub(one, zero);
                        (zero, row.map(|row| self.advance.neg(row)))
                    }
                    _ => (self.begin.add(one, zero), row),
                }
            }
        };
        Term { zero, row }
    }
    fn apply(&mut self, function: Elementary, x: &Term) -> Term {
        if x.row.is_some() {
            return self.call(function.into(), std::slice::from_ref(x));
        }
        let zero = self.at_zero(function, std::slice::from_ref(x));
        Term { zero, row: None }
    }
}
