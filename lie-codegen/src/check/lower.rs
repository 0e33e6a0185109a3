//! Lowering of the syntax tree to the symbolic arena.

use std::collections::HashMap;

use super::constant;
use super::environment::{Allowed, Binding, Environment};
use crate::algebra::MAX_DEPTH;
use crate::ast::{Expr, ExprKind, Name};
use crate::diagnostic::{Diagnostic, Kind, Origin, Report};
use crate::exact::Rational;
use crate::suggest::did_you_mean;
use crate::symbolic::{ExprId, Function, Graph, Node};

/// The largest exponent, in absolute value.
const MAX_EXPONENT: i64 = 1000;
/// The longest exact constant, numerator and denominator together.
const MAX_BITS: u64 = 1 << 14;
/// The longest constants that one sum or product may put together.
const MAX_BITS_TOGETHER: u64 = 1 << 20;
/// The largest arena that expressions may fill, nodes and operands together.
const MAX_SIZE: usize = 200_000;
const TOO_LARGE: &str = "the expressions are too large";

/// An expression in the arena: its normal form, and the form in which it was written.
#[derive(Clone, Copy)]
struct Lowered {
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
}

/// Lowers expressions to one arena, reporting every mistake in them.
pub struct Lowering<'a, 'b> {
    /// The arena.
    pub graph: &'b mut Graph,
    /// The names.
    pub environment: &'b Environment<'a>,
    /// Where mistakes go.
    pub report: &'b mut Report,
    /// Which names may stand.
    pub allowed: Allowed,
    depth: usize,
    /// Signs of irrational constants, `Some(None)` where they are not decided, `None` for what is no constant.
    constants: HashMap<ExprId, Option<Option<i32>>>,
}

impl<'a, 'b> Lowering<'a, 'b> {
    /// A lowering in an environment.
    pub fn new(
        graph: &'b mut Graph,
        environment: &'b Environment<'a>,
        report: &'b mut Report,
        allowed: Allowed,
    ) -> Self {
        Self {
            graph,
            environment,
            report,
            allowed,
            depth: 0,
            constants: HashMap::new(),
        }
    }

    /// The normal form of the expression, of which the arena remembers how it was written; `None` if anything
    /// was reported.
    pub fn lower(&mut self, expr: &Expr) -> Option<ExprId> {
        let lowered = self.both(expr)?;
        self.graph.remember_written(lowered.normal, lowered.written);
        Some(lowered.normal)
    }

    fn both(&mut self, expr: &Expr) -> Option<Lowered> {
        if self.depth > MAX_DEPTH {
            return self.fail(
                Kind::Limit,
                expr.origin,
                "the expression is nested too deeply",
                "give parts of it names with `let`",
            );
        }
        // Beyond the limit there is nothing to be found: it is said once.
        if self.graph.size() > MAX_SIZE && self.report.says(TOO_LARGE) {
            return None;
        }
        self.depth += 1;
        let lowered = self.lower_kind(expr);
        self.depth -= 1;
        let lowered = lowered?;
        self.bounded(lowered.normal, expr.origin)?;
        Some(lowered)
    }

    fn fail<T>(
        &mut self,
        kind: Kind,
        origin: Origin,
        message: impl Into<String>,
        help: &str,
    ) -> Option<T> {
        self.report
            .push(Diagnostic::new(kind, origin, message).help(help));
        None
    }

    /// Refuses what would eat memory: the limits hold for every intermediate result.
    fn bounded(&mut self, id: ExprId, origin: Origin) -> Option<ExprId> {
        if self.graph.size() > MAX_SIZE {
            if self.report.says(TOO_LARGE) {
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
            return self.fail(
                Kind::Limit,
                origin,
                format!("an exponent above {MAX_EXPONENT}"),
                "rescale the variables, or use `exp` and `log`",
            );
        }
        Some(id)
    }

    fn lower_kind(&mut self, expr: &Expr) -> Option<Lowered> {
        match &expr.kind {
            ExprKind::Number(value) => Some(Lowered::plain(self.graph.number(value.clone()))),
            ExprKind::Name { index: Some(_), .. } | ExprKind::IndexedSum { .. } => self.fail(
                Kind::Syntax,
                expr.origin,
                "indexed names and sums belong to families of systems, which are not available here", "write the copies out, as in x1, x2, x3"),
            ExprKind::Name { name, index: None } => self.name(name, expr.origin),
            ExprKind::Negative(inner) => {
                let inner = self.both(inner)?;
                Some(Lowered {
                    normal: self.graph.neg(inner.normal),
                    written: self.graph.neg(inner.written),
                })
            }
            ExprKind::Sum(terms) => {
                // Every term is visited, so that all their mistakes are reported together.
                let lowered: Vec<_> = terms.iter().map(|(minus, term)| (*minus, self.both(term))).collect();
                let (mut signed, mut written) = (Vec::new(), Vec::new());
                for (minus, term) in lowered {
                    let (term, sign) = (term?, if minus { Rational::MINUS_ONE } else { Rational::ONE });
                    signed.push((term.normal, sign.clone()));
                    written.push((term.written, sign));
                }
                self.fits(signed.iter().map(|(id, _)| *id), expr.origin)?;
                Some(Lowered { normal: self.graph.linear(&signed), written: self.graph.written_sum(&written) })
            }
            ExprKind::Product(factors) => {
                let lowered: Vec<_> = factors.iter().map(|(divides, factor)| (*divides, self.both(factor))).collect();
                let (mut powers, mut written) = (Vec::new(), Vec::new());
                for ((divides, lowered), (_, factor)) in lowered.into_iter().zip(factors) {
                    let lowered = lowered?;
                    let id = lowered.normal;
                    if divides && (self.constant_sign(id, factor.origin)? == Some(0)) {
                        return self.fail(Kind::Number, factor.origin, "division by zero", "the divisor is exactly zero; correct it");
                    }
                    let exponent = if divides { Rational::MINUS_ONE } else { Rational::ONE };
                    powers.push((id, exponent.clone()));
                    written.push((lowered.written, exponent));
                }
                self.fits(powers.iter().map(|(id, _)| *id), expr.origin)?;
                Some(Lowered { normal: self.graph.power_product(&powers), written: self.graph.power_product(&written) })
            }
            ExprKind::Power(base, exponent) => {
                let (base_id, exponent_id) = (self.both(base), self.both(exponent));
                self.power(base_id?, exponent_id?, base.origin, exponent.origin)
            }
            ExprKind::Call { function, arguments } => self.call(function, arguments, expr.origin),
        }
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
                self.report.push(diagnostic);
                None
            }
        }
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

    fn power(
        &mut self,
        lowered: Lowered,
        lowered_exponent: Lowered,
        base_origin: Origin,
        origin: Origin,
    ) -> Option<Lowered> {
        let (base, exponent) = (lowered.normal, lowered_exponent.normal);
        let number = self.graph.as_number(base).cloned();
        let Some(exponent) = self.graph.as_number(exponent).cloned() else {
            // a^b = exp(b log a)
            if number.is_some_and(|n| n.is_zero() || n.is_negative()) {
                return self.fail(
                    Kind::Number,
                    base_origin,
                    "a power with a variable exponent needs a positive base",
                    "`a^b` with a variable `b` is `exp(b*log(a))`",
                );
            }
            let mut power = |base, exponent| {
                let logarithm = self.graph.call(Function::Log, &[base]);
                let product = self.graph.mul(exponent, logarithm);
                self.graph.call(Function::Exp, &[product])
            };
            return Some(Lowered {
                normal: power(base, exponent),
                written: power(lowered.written, lowered_exponent.written),
            });
        };
        if exponent.abs() > Rational::from(MAX_EXPONENT) {
            return self.fail(
                Kind::Limit,
                origin,
                format!("an exponent above {MAX_EXPONENT}"),
                "rescale the variables, or use `exp` and `log`",
            );
        }
        if let Some(number) = &number {
            if number.is_zero() && exponent.is_negative() {
                return self.fail(
                    Kind::Number,
                    base_origin,
                    "a negative power of zero",
                    "the base is exactly zero; correct it",
                );
            }
            if number.is_negative() && !exponent.is_integer() {
                return self.fail(
                    Kind::Number,
                    base_origin,
                    "a fractional power of a negative number is not real",
                    "correct the base, or use an integer exponent",
                );
            }
        }
        let needs_sign = exponent.is_negative() || !exponent.is_integer();
        let sign = if needs_sign && number.is_none() {
            self.constant_sign(base, base_origin)?
        } else {
            None
        };
        if sign == Some(0) && exponent.is_negative() || sign == Some(-1) && !exponent.is_integer() {
            return self.fail(
                Kind::Number,
                base_origin,
                "this power of a constant is not finite or not real",
                "correct the base, or use another exponent",
            );
        }
        let quantity = self.written_base(lowered.written);
        Some(Lowered {
            normal: self.graph.pow(base, &exponent),
            written: self.graph.pow(quantity, &exponent),
        })
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

    /// The sign of a constant, exactly: of rational numbers, of irrational ones by rigorous bounds where these
    /// exclude zero, and by a proof where it is zero. `Some(None)` for what is no constant; a constant of which it
    /// cannot be decided is reported.
    fn constant_sign(&mut self, id: ExprId, origin: Origin) -> Option<Option<i32>> {
        if let Some(number) = self.graph.as_number(id) {
            let sign = i32::from(!number.is_zero());
            return Some(Some(if number.is_negative() { -sign } else { sign }));
        }
        if !self.constants.contains_key(&id) {
            let constant = self.graph.symbols(id).is_empty();
            let sign = constant.then(|| constant::sign(self.graph, id));
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

    fn call(&mut self, function: &Name, arguments: &[Expr], origin: Origin) -> Option<Lowered> {
        let lowered: Vec<_> = arguments
            .iter()
            .map(|argument| self.both(argument))
            .collect();
        let known = Function::from_name(&function.text);
        let arity = match known {
            Some(known) => known.arity(),
            None if function.text == "sqrt" => 1,
            None => {
                let names = Function::ALL.iter().map(|f| f.name()).chain(["sqrt"]);
                let diagnostic = Diagnostic::new(
                    Kind::UnknownFunction,
                    function.origin,
                    format!("unknown function `{}`", function.text),
                );
                self.report.push(match did_you_mean(&function.text, names) {
                    Some(near) => diagnostic.help(format!("did you mean `{near}`?")),
                    None => diagnostic.help("the functions are sqrt, exp, log, sin, cos, tan, asin, acos, atan, sinh, cosh, tanh, atan2"),
                });
                return None;
            }
        };
        if lowered.len() != arity {
            let expected = super::size::plural(arity, "argument");
            let message = format!(
                "`{}` takes {arity} {expected}, but here are {}",
                function.text,
                lowered.len()
            );
            return self.fail(
                Kind::Arity,
                origin,
                message,
                "correct the number of arguments",
            );
        }
        let lowered: Vec<Lowered> = lowered.into_iter().collect::<Option<_>>()?;
        let (normal, written): (Vec<ExprId>, Vec<ExprId>) =
            lowered.iter().map(|l| (l.normal, l.written)).unzip();
        let Some(known) = known else {
            let half = &Rational::ONE / &Rational::from(2);
            let place = arguments[0].origin;
            if self.constant_sign(normal[0], place)? == Some(-1) {
                return self.fail(
                    Kind::Number,
                    origin,
                    "the square root of a negative number is not real",
                    "correct its argument",
                );
            }
            return Some(Lowered {
                normal: self.graph.pow(normal[0], &half),
                written: self.graph.pow(written[0], &half),
            });
        };
        if self.is_undefined(known, &normal, arguments)? {
            return self.fail(
                Kind::Number,
                origin,
                format!("`{}` is not finite here", function.text),
                "correct its argument",
            );
        }
        Some(Lowered {
            normal: self.graph.call(known, &normal),
            written: self.graph.call(known, &written),
        })
    }
}

impl Lowering<'_, '_> {
    /// Whether a function of constants is not real or not finite; `None` where that was reported as undecided.
    fn is_undefined(
        &mut self,
        function: Function,
        lowered: &[ExprId],
        arguments: &[Expr],
    ) -> Option<bool> {
        let (id, place) = (lowered[0], arguments[0].origin);
        match function {
            Function::Log => Some(self.constant_sign(id, place)?.is_some_and(|sign| sign <= 0)),
            Function::Asin | Function::Acos => {
                // 1 - x^2
                let square = self.graph.pow(id, &Rational::from(2));
                let one = self.graph.integer(1);
                let rest = self.graph.sub(one, square);
                Some(self.constant_sign(rest, place)? == Some(-1))
            }
            Function::Tan => {
                let cosine = self.graph.call(Function::Cos, &[id]);
                Some(self.constant_sign(cosine, place)? == Some(0))
            }
            _ => Some(false),
        }
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
