//! The rules of the elementary functions.

use super::{At, Lowering, Term, number};
use crate::exact::Rational;
use crate::schedule::{Operation, Value};
use crate::symbolic::Function;

impl Lowering {
    pub(super) fn call(&mut self, function: Function, arguments: &[Term]) -> Term {
        let u = &arguments[0];
        match function {
            Function::Sin | Function::Sinh => self.pair(u, function == Function::Sinh).0,
            Function::Cos | Function::Cosh => self.pair(u, function == Function::Cosh).1,
            Function::Exp => self.exponential(u),
            Function::Log => {
                let zero = self.at_zero(function, arguments);
                self.integral(zero, &u.row(), u)
            }
            Function::Tan | Function::Tanh => self.tangent(function, u),
            Function::Asin
            | Function::Acos
            | Function::Atan
            | Function::Asinh
            | Function::Acosh
            | Function::Atanh => self.arc(function, u),
            Function::Cbrt => {
                let zero = self.at_zero(function, arguments);
                let third = Rational::new(1, 3).unwrap_or(Rational::ONE);
                let row = self.power(u, &third, &zero);
                Term::varying(zero, row)
            }
            Function::Log1p => {
                let zero = self.at_zero(function, arguments);
                let w = self.begin.add(number(1), u.zero.clone());
                self.integral(zero, &u.row(), &Term::varying(w, u.row()))
            }
            Function::Expm1 => {
                let zero = self.at_zero(function, arguments);
                Term::varying(zero, self.exponential(u).row())
            }
            Function::Atan2 => self.angle(u, &arguments[1]),
            Function::Below => self.choice(arguments),
            Function::Own(_) => unreachable!("such fields have no recurrence of their own"),
            Function::Stumpff(_) | Function::Phi(_) => {
                unreachable!(
                    "functions of closed forms of the exponential stand in no vector field"
                )
            }
        }
    }

    /// The function at order 0.
    fn at_zero(&mut self, function: Function, arguments: &[Term]) -> Value {
        let zeros = arguments.iter().map(|term| term.zero.clone());
        self.begin.push(Operation::Call(function, zeros.collect()))
    }

    /// The coefficients of the branch that is taken at order 0.
    fn choice(&mut self, arguments: &[Term]) -> Term {
        let zero = self.at_zero(Function::Below, arguments);
        let [condition, a, b] = arguments else {
            unreachable!("a choice has a condition and two branches")
        };
        if a.row.is_none() && b.row.is_none() {
            return Term { zero, row: None };
        }
        let condition = self.keep(condition.zero.clone());
        let operands = vec![condition, a.row(), b.row()];
        let row = self
            .advance
            .push(Operation::Call(Function::Below, operands));
        Term::varying(zero, row)
    }

    /// Sine and cosine.
    fn pair(&mut self, u: &Term, hyperbolic: bool) -> (Term, Term) {
        let key = (u.zero.clone(), hyperbolic);
        if let Some(known) = self.circular.get(&key) {
            return known.clone();
        }
        let functions = if hyperbolic {
            [Function::Sinh, Function::Cosh]
        } else {
            [Function::Sin, Function::Cos]
        };
        let [sine, cosine] = functions.map(|f| self.at_zero(f, std::slice::from_ref(u)));
        let (of_sine, with_cosine) = self.reserve();
        let (of_cosine, with_sine) = self.reserve();
        let mut row = |zero: &Value, rest: At| {
            let first = self.keep(zero.clone());
            let ends = self.advance.mul(u.row(), first);
            let rest = self.over_order(rest);
            self.advance.add(ends, rest)
        };
        let sine_row = row(&cosine, with_cosine);
        let mut cosine_row = row(&sine, with_sine);
        if !hyperbolic {
            cosine_row = self.advance.neg(cosine_row);
        }
        let slope = self.slope(&u.row());
        self.pairs[of_sine] = (slope.clone(), cosine_row.clone());
        self.pairs[of_cosine] = (slope, sine_row.clone());
        let both = (
            Term::varying(sine, sine_row),
            Term::varying(cosine, cosine_row),
        );
        self.circular.insert(key, both.clone());
        both
    }

    /// `Dy = y Du`
    fn exponential(&mut self, u: &Term) -> Term {
        let zero = self.at_zero(Function::Exp, std::slice::from_ref(u));
        let first = self.keep(zero.clone());
        let (place, rest) = self.reserve();
        let ends = self.advance.mul(u.row(), first);
        let rest = self.over_order(rest);
        let row = self.advance.add(ends, rest);
        self.pairs[place] = (self.slope(&u.row()), row.clone());
        Term::varying(zero, row)
    }

    /// `w Dy = k v` for a row v: `y_k = (v - sum_(0<j<k) w_j (k-j) y_(k-j) / k)/w_0`
    fn integral(&mut self, zero: Value, known: &At, w: &Term) -> Term {
        let inverse = self.inverse(w.zero.clone());
        let (place, rest) = self.reserve();
        let rest = self.over_order(rest);
        let known = self.advance.sub(known.clone(), rest);
        let row = self.advance.mul(known, inverse);
        self.pairs[place] = (w.row(), self.slope(&row));
        Term::varying(zero, row)
    }

    /// `Dy = w Du`, `w = 1 + y y` of the tangent and `1 - y y` of the hyperbolic one.
    fn tangent(&mut self, function: Function, u: &Term) -> Term {
        let zero = self.at_zero(function, std::slice::from_ref(u));
        let square = self.begin.mul(zero.clone(), zero.clone());
        let hyperbolic = function == Function::Tanh;
        let w = match hyperbolic {
            true => self.begin.sub(number(1), square),
            false => self.begin.add(number(1), square),
        };
        let first = self.keep(w);
        let (of_w, with_w) = self.reserve();
        let ends = self.advance.mul(u.row(), first);
        let with_w = self.over_order(with_w);
        let row = self.advance.add(ends, with_w);
        let y = Term::varying(zero, row.clone());
        let mut w_row = self.product(&y, &y);
        if hyperbolic {
            w_row = self.advance.neg(w_row);
        }
        self.pairs[of_w] = (self.slope(&u.row()), w_row);
        y
    }

    /// `w Dy = Du`; the inverse cosine is that of `-Du`.
    fn arc(&mut self, function: Function, u: &Term) -> Term {
        let zero = self.at_zero(function, std::slice::from_ref(u));
        let square = self.begin.mul(u.zero.clone(), u.zero.clone());
        let square_row = self.product(u, u);
        let (w, known) = match function {
            Function::Atan => {
                let w = self.begin.add(number(1), square);
                (Term::varying(w, square_row), u.row())
            }
            Function::Atanh => {
                let w = self.begin.sub(number(1), square);
                (Term::varying(w, self.advance.neg(square_row)), u.row())
            }
            _ => {
                let (inside, inside_row) = match function {
                    Function::Asinh => (self.begin.add(square, number(1)), square_row),
                    Function::Acosh => (self.begin.sub(square, number(1)), square_row),
                    _ => {
                        let inside = self.begin.sub(number(1), square);
                        (inside, self.advance.neg(square_row))
                    }
                };
                let root = self.begin.push(Operation::Sqrt(inside.clone()));
                let inside = Term::varying(inside, inside_row);
                let root_row = self.root(&inside, &root);
                let known = match function {
                    Function::Acos => self.advance.neg(u.row()),
                    _ => u.row(),
                };
                (Term::varying(root, root_row), known)
            }
        };
        self.integral(zero, &known, &w)
    }

    /// `w Dy = v Du - u Dv`, `w = u u + v v`
    fn angle(&mut self, u: &Term, v: &Term) -> Term {
        let zero = self.at_zero(Function::Atan2, &[u.clone(), v.clone()]);
        let square = |lowering: &mut Self, x: &Term| {
            let zero = lowering.begin.mul(x.zero.clone(), x.zero.clone());
            let row = x.row.is_some().then(|| lowering.product(x, x));
            (zero, row.unwrap_or(number(0)))
        };
        let ((uu, uu_row), (vv, vv_row)) = (square(self, u), square(self, v));
        let (w, w_row) = (self.begin.add(uu, vv), self.advance.add(uu_row, vv_row));
        let turned = |lowering: &mut Self, x: &Term, y: &Term| {
            let Some(row) = &y.row else {
                return number(0);
            };
            let first = lowering.keep(x.zero.clone());
            let ends = lowering.advance.mul(first, row.clone());
            let Some(other) = &x.row else {
                return ends;
            };
            let slope = lowering.slope(row);
            let rest = lowering.rest(other, &slope);
            let rest = lowering.over_order(rest);
            lowering.advance.add(ends, rest)
        };
        let (one, other) = (turned(self, v, u), turned(self, u, v));
        let known = self.advance.sub(one, other);
        self.integral(zero, &known, &Term::varying(w, w_row))
    }
}
