//! Lowering of the syntax tree to the symbolic arena.

mod choices;
mod real;

use std::collections::HashMap;

use super::environment::{Allowed, Binding, Environment};
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{Elementary, ExprId, Function, Graph, Node};
use lie_syntax::ast::{Expr, Name};
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin, plural};
use lie_syntax::linear::walk::{Lower, MAX_EXPONENT, Operand, Operands};

/// The longest exact constant, numerator and denominator together.
const MAX_BITS: u64 = 1 << 14;
/// The longest constants that one sum or product may put together.
const MAX_BITS_TOGETHER: u64 = 1 << 20;
/// The largest arena that expressions may fill, nodes and operands together.
const MAX_SIZE: usize = 200_000;
const TOO_LARGE: &str = "the expressions are too large";
/// An expression in the arena: its normal form, and the form in which it was written.
#[derive(Clone, Copy)]
pub struct Lowered {
    normal: ExprId,
    written: ExprId,
}

impl Lowered {
    fn plain(id: ExprId) -> Self {
        Self {
            normal: id,
            written: id,
        }
    }

    fn map(self, mut operation: impl FnMut(ExprId) -> ExprId) -> Self {
        Self {
            normal: operation(self.normal),
            written: operation(self.written),
        }
    }
}

/// Lowers expressions to one arena, reporting every mistake in them.
pub struct Lowering<'a, 'b> {
    /// The arena.
    pub graph: &'b mut Graph,
    /// The names.
    pub environment: &'b Environment<'a>,
    /// Where mistakes go.
    pub mistakes: &'b mut Vec<Diagnostic>,
    /// Which names may stand.
    pub allowed: Allowed,
    /// Signs of irrational constants, `Some(None)` where they are not decided, `None` for what is no constant.
    constants: HashMap<ExprId, Option<Option<i32>>>,
}

impl<'a, 'b> Lowering<'a, 'b> {
    /// A lowering in an environment.
    pub fn new(
        graph: &'b mut Graph,
        environment: &'b Environment<'a>,
        mistakes: &'b mut Vec<Diagnostic>,
        allowed: Allowed,
    ) -> Self {
        Self {
            graph,
            environment,
            mistakes,
            allowed,
            constants: HashMap::new(),
        }
    }

    /// The normal form of the expression, of which the arena remembers how it was written; `None` if anything
    /// was reported.
    pub fn lower(&mut self, expr: &Expr) -> Option<ExprId> {
        let lowered = self.walk(expr)?;
        self.graph.remember_written(lowered.normal, lowered.written);
        Some(lowered.normal)
    }

    /// Whether it was said already that the expressions are too large.
    fn is_said(&self) -> bool {
        let mut mistakes = self.mistakes.iter().rev();
        mistakes.any(|mistake| mistake.message == TOO_LARGE)
    }

    fn permitted(&self, id: ExprId) -> bool {
        let symbols = self.graph.symbols(id);
        symbols
            .into_iter()
            .all(|symbol| self.allowed.permits(symbol))
    }

    /// Whether the constants of the operands together are of reasonable length.
    fn fits(&mut self, operands: impl Iterator<Item = ExprId>, origin: Origin) -> Option<()> {
        let together: u64 = operands.map(|id| bits(self.graph, id)).sum();
        if together > MAX_BITS_TOGETHER {
            return self.fail(
                Kind::Limit,
                origin,
                "the exact constants here are too long",
                "round or rescale them",
            );
        }
        Some(())
    }

    /// `a^b = exp(b log a)`
    fn variable_power(&mut self, base: &Operand<Lowered>, exponent: Lowered) -> Option<Lowered> {
        let number = self.graph.as_number(base.value.normal);
        if number.is_some_and(|n| n.is_zero() || n.is_negative()) {
            return self.fail(
                Kind::Number,
                base.origin,
                "a power with a variable exponent needs a positive base",
                "`a^b` with a variable `b` is `exp(b*log(a))`",
            );
        }
        let mut power = |base, exponent| {
            let logarithm = self.graph.call(Elementary::Log, &[base]);
            let product = self.graph.mul(exponent, logarithm);
            self.graph.call(Elementary::Exp, &[product])
        };
        Some(Lowered {
            normal: power(base.value.normal, exponent.normal),
            written: power(base.value.written, exponent.written),
        })
    }

    fn square_root(&mut self, argument: Lowered, place: Origin, origin: Origin) -> Option<Lowered> {
        if self.constant_sign(argument.normal, place)? == Some(-1) {
            return self.fail(
                Kind::Number,
                origin,
                "the square root of a negative number is not real",
                "correct its argument",
            );
        }
        let half = &Rational::ONE / &Rational::from(2);
        Some(argument.map(|id| self.graph.pow(id, &half)))
    }

    /// `hypot(x, y) = (x^2 + y^2)^(1/2)`
    fn hypotenuse(&mut self, x: Lowered, y: Lowered) -> Lowered {
        let two = Rational::from(2);
        let half = &Rational::ONE / &two;
        let normal = [x, y].map(|a| (self.graph.pow(a.normal, &two), Rational::ONE));
        let written = [x, y].map(|a| {
            let quantity = self.written_base(a.written);
            (self.graph.pow(quantity, &two), Rational::ONE)
        });
        let sum = Lowered {
            normal: self.graph.linear(&normal),
            written: self.graph.written_sum(&written),
        };
        sum.map(|id| self.graph.pow(id, &half))
    }

    /// A quotient that is raised to a power stays one quantity.
    fn written_base(&mut self, id: ExprId) -> ExprId {
        let (_, product) = self.graph.coefficient(id);
        let quotient = match self.graph.node(product) {
            Node::Product(factors) => {
                factors.len() > 1 && factors.iter().any(|(_, e)| e.is_negative())
            }
            _ => false,
        };
        if quotient {
            self.graph.written_product(id)
        } else {
            id
        }
    }
}

impl Lower for Lowering<'_, '_> {
    type Value = Lowered;

    fn mistakes(&mut self) -> &mut Vec<Diagnostic> {
        self.mistakes
    }

    fn number(&mut self, value: &Rational) -> Lowered {
        Lowered::plain(self.graph.number(value.clone()))
    }

    fn name(&mut self, name: &str, origin: Origin) -> Option<Lowered> {
        if name == "pi" {
            return Some(Lowered::plain(self.graph.pi()));
        }
        let known = match self.environment.get(name) {
            Some(Binding::Symbol(symbol)) => Some(self.graph.symbol(symbol)),
            Some(Binding::Let(value)) => Some(value?),
            _ => None,
        };
        match known {
            Some(id) if self.permitted(id) => Some(Lowered {
                normal: id,
                written: self.graph.as_written(id),
            }),
            _ => {
                let diagnostic = self.environment.unknown(name, origin, self.allowed);
                self.mistakes.push(diagnostic);
                None
            }
        }
    }

    fn negative(&mut self, value: Lowered, _: Origin) -> Option<Lowered> {
        Some(value.map(|id| self.graph.neg(id)))
    }

    fn sum(&mut self, terms: Operands<Lowered>, origin: Origin) -> Option<Lowered> {
        let (mut normal, mut written) = (Vec::new(), Vec::new());
        for term in terms {
            let sign = term.sign();
            let value = term.value?;
            normal.push((value.normal, sign.clone()));
            written.push((value.written, sign));
        }
        self.fits(normal.iter().map(|(id, _)| *id), origin)?;
        Some(Lowered {
            normal: self.graph.linear(&normal),
            written: self.graph.written_sum(&written),
        })
    }

    fn product(&mut self, factors: Operands<Lowered>, origin: Origin) -> Option<Lowered> {
        let (mut normal, mut written) = (Vec::new(), Vec::new());
        for factor in factors {
            let exponent = factor.sign();
            let value = factor.value?;
            if factor.turned && self.constant_sign(value.normal, factor.origin)? == Some(0) {
                return self.division_by_zero(factor.origin);
            }
            normal.push((value.normal, exponent.clone()));
            written.push((value.written, exponent));
        }
        self.fits(normal.iter().map(|(id, _)| *id), origin)?;
        Some(Lowered {
            normal: self.graph.power_product(&normal),
            written: self.graph.power_product(&written),
        })
    }

    fn power(
        &mut self,
        base: Operand<Lowered>,
        exponent: Operand<Lowered>,
        _: Origin,
    ) -> Option<Lowered> {
        let Some(number) = self.graph.as_number(exponent.value.normal).cloned() else {
            return self.variable_power(&base, exponent.value);
        };
        if number.abs() > Rational::from(MAX_EXPONENT) {
            return self.large_exponent(exponent.origin);
        }
        self.real_power(base.value.normal, &number, base.origin)?;
        let quantity = self.written_base(base.value.written);
        Some(Lowered {
            normal: self.graph.pow(base.value.normal, &number),
            written: self.graph.pow(quantity, &number),
        })
    }

    fn call(
        &mut self,
        function: &Name,
        arguments: Operands<Lowered>,
        origin: Origin,
    ) -> Option<Lowered> {
        let own = self.environment.function(&function.text);
        if own.is_some() && !self.allowed.has_own_functions() {
            let message = format!(
                "`{}` is a function of Rust, whose values are not known here",
                function.text
            );
            return self.fail(
                Kind::UnknownFunction,
                origin,
                message,
                "write a value or a formula",
            );
        }
        let own = own.map(Function::Own);
        let known = own.or_else(|| Function::from_name(&function.text));
        let arity = match known {
            Some(known) => known.arity(),
            None if matches!(&*function.text, "sqrt" | "abs") => 1,
            None if matches!(&*function.text, "hypot" | "min" | "max") => 2,
            None if function.text == "piecewise" => 4,
            None => {
                let names: Vec<&str> = Function::names().collect();
                let help = format!("the functions are {}", names.join(", "));
                return self.unknown_function(function, &help);
            }
        };
        if arguments.len() != arity {
            let expected = plural(arity, "argument");
            let message = format!(
                "`{}` takes {arity} {expected}, but here are {}",
                function.text,
                arguments.len()
            );
            return self.fail(
                Kind::Arity,
                origin,
                message,
                "correct the number of arguments",
            );
        }
        let place = arguments[0].origin;
        let lowered: Vec<Lowered> = arguments
            .into_iter()
            .map(|a| a.value)
            .collect::<Option<_>>()?;
        let known = match (known, lowered.as_slice()) {
            (Some(known), _) => known,
            (None, [x, y]) if function.text == "hypot" => return Some(self.hypotenuse(*x, *y)),
            (None, _) if function.text == "sqrt" => {
                return self.square_root(lowered[0], place, origin);
            }
            (None, _) => return self.choice(&function.text, &lowered, origin),
        };
        if let Function::Elementary(elementary) = known
            && self.is_undefined(elementary, lowered[0].normal, place)?
        {
            return self.fail(
                Kind::Number,
                origin,
                format!("`{}` is not finite here", function.text),
                "correct its argument",
            );
        }
        let (normal, written): (Vec<ExprId>, Vec<ExprId>) =
            lowered.iter().map(|l| (l.normal, l.written)).unzip();
        Some(Lowered {
            normal: self.graph.call(known, &normal),
            written: self.graph.call(known, &written),
        })
    }

    // beyond the limit there is nothing to be found: it is said once
    fn gives_up(&mut self) -> bool {
        self.graph.size() > MAX_SIZE && self.is_said()
    }

    // the limits hold for every intermediate result
    fn bounded(&mut self, value: Lowered, origin: Origin) -> Option<Lowered> {
        let id = value.normal;
        if self.graph.size() > MAX_SIZE {
            if self.is_said() {
                return None;
            }
            return self.fail(
                Kind::Limit,
                origin,
                TOO_LARGE,
                "shorten them; powers of sums need not be multiplied out",
            );
        }
        if bits(self.graph, id) > MAX_BITS {
            return self.fail(
                Kind::Limit,
                origin,
                format!("an exact constant here has more than {MAX_BITS} bits"),
                "such a number is beyond double precision anyway; round it or rescale",
            );
        }
        if let Node::Product(factors) = self.graph.node(id)
            && factors
                .iter()
                .any(|(_, exponent)| exponent.abs() > Rational::from(MAX_EXPONENT))
        {
            return self.large_exponent(origin);
        }
        Some(value)
    }
}

/// The length of the longest exact constant of a node.
fn bits(graph: &Graph, id: ExprId) -> u64 {
    match graph.node(id) {
        Node::Number(value) => value.bits(),
        Node::Sum { constant, terms } => terms
            .iter()
            .map(|(_, c)| c.bits())
            .max()
            .unwrap_or(0)
            .max(constant.bits()),
        Node::Product(factors) => factors.iter().map(|(_, e)| e.bits()).max().unwrap_or(0),
        _ => 0,
    }
}
