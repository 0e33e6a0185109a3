//! Choices between expressions by the sign of one.

use super::{Lowered, Lowering};
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::Function;
use lie_syntax::diagnostic::Origin;

impl Lowering<'_, '_> {
    /// `abs(x)`, `min(x, y)`, `max(x, y)`, `piecewise(x < y: a, b)`.
    pub(super) fn choice(
        &mut self,
        function: &str,
        arguments: &[Lowered],
        origin: Origin,
    ) -> Option<Lowered> {
        let (condition, a, b) = match (function, arguments) {
            ("min", [x, y]) => (self.difference(*y, *x), *y, *x),
            (_, [x]) => (*x, x.map(|id| self.graph.neg(id)), *x),
            (_, [x, y]) => (self.difference(*x, *y), *y, *x),
            (_, [x, y, a, b, ..]) => (self.difference(*x, *y), *a, *b),
            _ => return None,
        };
        if let Some(sign) = self.constant_sign(condition.normal, origin)? {
            return Some(if sign < 0 { a } else { b });
        }
        let mut call = |g, a, b| self.graph.call(Function::Below, &[g, a, b]);
        Some(Lowered {
            normal: call(condition.normal, a.normal, b.normal),
            written: call(condition.written, a.written, b.written),
        })
    }

    fn difference(&mut self, a: Lowered, b: Lowered) -> Lowered {
        let terms = |a, b| [(a, Rational::ONE), (b, Rational::MINUS_ONE)];
        Lowered {
            normal: self.graph.linear(&terms(a.normal, b.normal)),
            written: self.graph.written_sum(&terms(a.written, b.written)),
        }
    }
}
