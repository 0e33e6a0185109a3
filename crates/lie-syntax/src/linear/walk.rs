//! The walk over the syntax tree that everything shares that lowers expressions. Every operand is visited, so that
//! all mistakes of an expression are reported together.

use crate::ast::{Expr, ExprKind, Name};
use crate::diagnostic::{Diagnostic, Kind, Origin};
use crate::suggest::did_you_mean;
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::Function;

/// The largest exponent, in absolute value.
pub const MAX_EXPONENT: i64 = 1000;
/// Deeper nesting than any person writes; the walk is recursive.
const MAX_DEPTH: usize = 400;

/// An operand that was lowered.
pub struct Operand<T> {
    /// Whether it is subtracted, or divides.
    pub turned: bool,
    /// What became of it, `None` after a mistake in lists of operands.
    pub value: T,
    /// Where it stands.
    pub origin: Origin,
}

impl<T> Operand<T> {
    /// The factor of a term, or the exponent of a factor.
    pub fn sign(&self) -> Rational {
        if self.turned {
            Rational::MINUS_ONE
        } else {
            Rational::ONE
        }
    }
}

/// The operands of a sum, a product or a function.
pub type Operands<T> = Vec<Operand<Option<T>>>;

/// What the operations of the syntax tree become. `None` always means that there is a mistake.
pub trait Lower: Sized {
    /// What an expression becomes.
    type Value;

    /// Where mistakes go.
    fn mistakes(&mut self) -> &mut Vec<Diagnostic>;
    /// A number.
    fn number(&mut self, value: &Rational) -> Self::Value;
    /// A name without an index.
    fn name(&mut self, name: &str, origin: Origin) -> Option<Self::Value>;
    /// `-a`
    fn negative(&mut self, value: Self::Value, origin: Origin) -> Option<Self::Value>;
    /// `a + b - c`
    fn sum(&mut self, terms: Operands<Self::Value>, origin: Origin) -> Option<Self::Value>;
    /// `a * b / c`
    fn product(&mut self, factors: Operands<Self::Value>, origin: Origin) -> Option<Self::Value>;
    /// `a ^ b`
    fn power(
        &mut self,
        base: Operand<Self::Value>,
        exponent: Operand<Self::Value>,
        origin: Origin,
    ) -> Option<Self::Value>;
    /// `f(a, …)`
    fn call(
        &mut self,
        function: &Name,
        arguments: Operands<Self::Value>,
        origin: Origin,
    ) -> Option<Self::Value>;

    /// Whether nothing more is to be found.
    fn gives_up(&mut self) -> bool {
        false
    }

    /// Refuses an intermediate result that would eat memory.
    fn bounded(&mut self, value: Self::Value, _origin: Origin) -> Option<Self::Value> {
        Some(value)
    }

    /// Lowers an expression.
    fn walk(&mut self, expr: &Expr) -> Option<Self::Value> {
        descend(self, expr, 0)
    }

    /// Reports a mistake.
    fn fail<T>(
        &mut self,
        kind: Kind,
        origin: Origin,
        message: impl Into<String>,
        help: &str,
    ) -> Option<T> {
        let diagnostic = Diagnostic::new(kind, origin, message).help(help);
        self.mistakes().push(diagnostic);
        None
    }

    /// Reports a divisor that is zero.
    fn division_by_zero<T>(&mut self, divisor: Origin) -> Option<T> {
        let help = "the divisor is exactly zero; correct it";
        self.fail(Kind::Number, divisor, "division by zero", help)
    }

    /// Reports a negative power of zero.
    fn power_of_zero<T>(&mut self, base: Origin) -> Option<T> {
        let help = "the base is exactly zero; correct it";
        self.fail(Kind::Number, base, "a negative power of zero", help)
    }

    /// Reports an exponent that is too large.
    fn large_exponent<T>(&mut self, exponent: Origin) -> Option<T> {
        let message = format!("an exponent above {MAX_EXPONENT}");
        let help = "rescale the variables, or use `exp` and `log`";
        self.fail(Kind::Limit, exponent, message, help)
    }

    /// Reports a function that the grammar does not have; `otherwise` is the remedy where none is near.
    fn unknown_function<T>(&mut self, function: &Name, otherwise: &str) -> Option<T> {
        let help = did_you_mean(&function.text, Function::names())
            .map_or(otherwise.to_owned(), |near| {
                format!("did you mean `{near}`?")
            });
        let message = format!("unknown function `{}`", function.text);
        self.fail(Kind::UnknownFunction, function.origin, message, &help)
    }
}

fn descend<L: Lower>(lower: &mut L, expr: &Expr, depth: usize) -> Option<L::Value> {
    let origin = expr.origin;
    if depth > MAX_DEPTH {
        let help = "give parts of it names with `let`";
        return lower.fail(
            Kind::Limit,
            origin,
            "the expression is nested too deeply",
            help,
        );
    }
    if lower.gives_up() {
        return None;
    }
    let value = match &expr.kind {
        ExprKind::Number(value) => Some(lower.number(value)),
        ExprKind::Name { name, index: None } => lower.name(name, origin),
        ExprKind::Name { index: Some(_), .. } | ExprKind::IndexedSum { .. } => lower.fail(
            Kind::Syntax,
            origin,
            "indexed names and sums belong to families of systems, which are not available here",
            "write the copies out, as in x1, x2, x3",
        ),
        ExprKind::Negative(inner) => {
            let inner = descend(lower, inner, depth + 1)?;
            lower.negative(inner, origin)
        }
        ExprKind::Sum(terms) => {
            let terms = operands(
                lower,
                terms.iter().map(|(minus, term)| (*minus, term)),
                depth,
            );
            lower.sum(terms, origin)
        }
        ExprKind::Product(factors) => {
            let factors = factors.iter().map(|(divides, factor)| (*divides, factor));
            let factors = operands(lower, factors, depth);
            lower.product(factors, origin)
        }
        ExprKind::Power(base, exponent) => {
            let [base, exponent] = [base, exponent].map(|part| operand(lower, false, part, depth));
            lower.power(base.whole()?, exponent.whole()?, origin)
        }
        ExprKind::Call {
            function,
            arguments,
        } => {
            let arguments = operands(lower, arguments.iter().map(|part| (false, part)), depth);
            lower.call(function, arguments, origin)
        }
    };
    lower.bounded(value?, origin)
}

fn operand<L: Lower>(
    lower: &mut L,
    turned: bool,
    part: &Expr,
    depth: usize,
) -> Operand<Option<L::Value>> {
    Operand {
        turned,
        value: descend(lower, part, depth + 1),
        origin: part.origin,
    }
}

fn operands<'a, L: Lower>(
    lower: &mut L,
    parts: impl Iterator<Item = (bool, &'a Expr)>,
    depth: usize,
) -> Operands<L::Value> {
    parts
        .map(|(turned, part)| operand(lower, turned, part, depth))
        .collect()
}

impl<T> Operand<Option<T>> {
    /// The operand, if nothing was wrong in it.
    fn whole(self) -> Option<Operand<T>> {
        let Self {
            turned,
            value,
            origin,
        } = self;
        Some(Operand {
            turned,
            value: value?,
            origin,
        })
    }
}
