//! Which powers and functions of constants are real and finite, by the exact signs of constants.

use super::Lowering;
use crate::diagnostic::{Kind, Origin};
use crate::exact::Rational;
use crate::linear::walk::Lower as _;
use crate::prove::sign;
use crate::symbolic::{ExprId, Function};

impl Lowering<'_, '_> {
    /// The sign of a constant, exactly: of rational numbers, of irrational ones by rigorous bounds where these
    /// exclude zero, and by a proof where it is zero. `Some(None)` for what is no constant; a constant of which it
    /// cannot be decided is reported.
    pub(super) fn constant_sign(&mut self, id: ExprId, origin: Origin) -> Option<Option<i32>> {
        if let Some(number) = self.graph.as_number(id) {
            let sign = i32::from(!number.is_zero());
            return Some(Some(if number.is_negative() { -sign } else { sign }));
        }
        if !self.constants.contains_key(&id) {
            let constant = self.graph.symbols(id).is_empty();
            let sign = constant.then(|| sign::constant(self.graph, id));
            self.constants.insert(id, sign);
        }
        match self.constants[&id] {
            None => Some(None),
            Some(Some(sign)) => Some(Some(sign)),
            Some(None) => self.fail(
                Kind::Number,
                origin,
                "it cannot be decided whether this constant is zero, positive or negative",
                "write it in a simpler form, or as a number",
            ),
        }
    }

    /// Whether a function of constants is not real or not finite; `None` where that was reported as undecided.
    pub(super) fn is_undefined(
        &mut self,
        function: Function,
        id: ExprId,
        place: Origin,
    ) -> Option<bool> {
        match function {
            Function::Log => Some(self.constant_sign(id, place)?.is_some_and(|sign| sign <= 0)),
            Function::Asin | Function::Acos => {
                // 1 - x^2
                let square = self.graph.pow(id, &Rational::from(2));
                let one = self.graph.integer(1);
                let rest = self.graph.sub(one, square);
                Some(self.constant_sign(rest, place)? == Some(-1))
            }
            Function::Log1p => {
                let one = self.graph.integer(1);
                let inside = self.graph.add(one, id);
                let sign = self.constant_sign(inside, place)?;
                Some(sign.is_some_and(|sign| sign <= 0))
            }
            Function::Acosh => {
                let one = self.graph.integer(1);
                let rest = self.graph.sub(id, one);
                Some(self.constant_sign(rest, place)? == Some(-1))
            }
            Function::Atanh => {
                // 1 - x^2
                let square = self.graph.pow(id, &Rational::from(2));
                let one = self.graph.integer(1);
                let rest = self.graph.sub(one, square);
                let sign = self.constant_sign(rest, place)?;
                Some(sign.is_some_and(|sign| sign <= 0))
            }
            Function::Tan => {
                let cosine = self.graph.call(Function::Cos, &[id]);
                Some(self.constant_sign(cosine, place)? == Some(0))
            }
            _ => Some(false),
        }
    }

    /// Refuses the powers of constants that are not real or not finite.
    pub(super) fn real_power(
        &mut self,
        base: ExprId,
        exponent: &Rational,
        place: Origin,
    ) -> Option<()> {
        let (negative, fractional) = (exponent.is_negative(), !exponent.is_integer());
        if !negative && !fractional {
            return Some(());
        }
        let rational = self.graph.as_number(base).is_some();
        let (message, help) = match self.constant_sign(base, place)? {
            Some(0) if negative && rational => return self.power_of_zero(place),
            Some(-1) if fractional && rational => (
                "a fractional power of a negative number is not real",
                "correct the base, or use an integer exponent",
            ),
            Some(sign) if sign == 0 && negative || sign < 0 && fractional => (
                "this power of a constant is not finite or not real",
                "correct the base, or use another exponent",
            ),
            _ => return Some(()),
        };
        self.fail(Kind::Number, place, message, help)
    }
}
