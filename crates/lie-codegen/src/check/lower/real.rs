//! Which powers and functions of constants are real and finite, by the exact signs of constants.

use super::Lowering;
use lie_core::functions::Domain;
use lie_symbolic::exact::Rational;
use lie_symbolic::prove::sign;
use lie_symbolic::symbolic::{Elementary, ExprId};
use lie_syntax::diagnostic::{Kind, Origin};
use lie_syntax::linear::walk::Lower as _;

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
        function: Elementary,
        id: ExprId,
        place: Origin,
    ) -> Option<bool> {
        // what is to be positive, or not negative, or not zero
        let inside = match function.domain() {
            Domain::Everywhere => return Some(false),
            Domain::Positive => id,
            Domain::AboveMinusOne => {
                let one = self.graph.integer(1);
                self.graph.add(one, id)
            }
            Domain::FromOne => {
                let one = self.graph.integer(1);
                self.graph.sub(id, one)
            }
            Domain::WithinOne | Domain::BetweenOnes => {
                let square = self.graph.pow(id, &Rational::from(2));
                let one = self.graph.integer(1);
                self.graph.sub(one, square)
            }
            Domain::NotRight => self.graph.call(Elementary::Cos, &[id]),
        };
        let sign = self.constant_sign(inside, place)?;
        Some(match function.domain() {
            Domain::Everywhere => false,
            Domain::Positive | Domain::AboveMinusOne | Domain::BetweenOnes => {
                sign.is_some_and(|sign| sign <= 0)
            }
            Domain::FromOne | Domain::WithinOne => sign == Some(-1),
            Domain::NotRight => sign == Some(0),
        })
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
