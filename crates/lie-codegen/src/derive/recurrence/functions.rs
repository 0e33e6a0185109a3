//! The rules of the elementary functions.

use super::rules::Composed;
use super::{At, Lowering, Term, number};
use lie_core::functions::Curve;
use lie_symbolic::schedule::{Operation, Value};
use lie_symbolic::symbolic::Function;

impl Lowering {
    pub(super) fn call(&mut self, function: Function, arguments: &[Term]) -> Term {
        let u = &arguments[0];
        match function {
            Function::Elementary(function) => function.rule(Composed {
                lowering: self,
                function,
                u,
            }),
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
    pub(super) fn at_zero(&mut self, function: impl Into<Function>, arguments: &[Term]) -> Value {
        let zeros = arguments.iter().map(|term| term.zero.clone());
        let call = Operation::Call(function.into(), zeros.collect());
        self.begin.push(call)
    }

    /// The coefficients of the branch that is taken at order 0.
    fn choice(&mut self, arguments: &[Term]) -> Term {
        let zero = self.at_zero(Function::Below, arguments);
        let [condition, a, b] = arguments else {
            unreachable!("a choice has a condition and two branches")
        };
        let known = |known: &Term| known.zero == condition.zero;
        if condition.row.is_some() && !self.conditions.iter().any(known) {
            self.conditions.push(condition.clone());
        }
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
    pub(super) fn pair(&mut self, u: &Term, curve: Curve) -> (Term, Term) {
        let key = (u.zero.clone(), curve);
        if let Some(known) = self.circular.get(&key) {
            return known.clone();
        }
        let functions = [curve.sine(), curve.cosine()];
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
        if curve == Curve::Circle {
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

    /// `w Dy = k v` for a row v: `y_k = (v - sum_(0<j<k) w_j (k-j) y_(k-j) / k)/w_0`
    pub(super) fn integral(&mut self, zero: Value, known: &At, w: &Term) -> Term {
        let inverse = self.inverse(w.zero.clone());
        let (place, rest) = self.reserve();
        let rest = self.over_order(rest);
        let known = self.advance.sub(known.clone(), rest);
        let row = self.advance.mul(known, inverse);
        self.pairs[place] = (w.row(), self.slope(&row));
        Term::varying(zero, row)
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
