//! Expressions that are linear in basis names, with rational functions of exact parameters as
//! coefficients: the right sides of brackets, entries of matrices as the case without basis names, and exact
//! constants as that without any.

mod names;
mod scope;
pub mod walk;

use std::collections::BTreeMap;

use crate::ast::{Expr, ExprKind, Name};
use crate::diagnostic::{Diagnostic, Kind, Origin};
use lie_symbolic::exact::{Budget, Exhausted, Fraction, Rational};
use lie_symbolic::symbolic::Function;
use scope::Meaning;
use walk::{Lower, MAX_EXPONENT, Operand, Operands};

pub use scope::Scope;

/// Work allowed for the exact checks of one algebra: seconds, not minutes.
pub const WORK: u64 = 20_000_000;

/// `constant + sum of coefficient * e_k`.
#[derive(Clone, Debug, Default)]
struct Form {
    constant: Fraction,
    linear: BTreeMap<usize, Fraction>,
}

impl Form {
    fn is_scalar(&self) -> bool {
        self.linear.values().all(Fraction::is_zero)
    }
}

impl From<Fraction> for Form {
    fn from(constant: Fraction) -> Self {
        Self {
            constant,
            linear: BTreeMap::new(),
        }
    }
}

/// Lowers one expression, and finds every mistake in it.
struct Lowering<'a, 'b> {
    place: Place<'a, 'b>,
    mistakes: Vec<Diagnostic>,
    budget: &'b Budget,
}

/// Where an expression stands, which tells the names that it may use.
#[derive(Clone, Copy)]
enum Place<'a, 'b> {
    /// On the right side of a bracket: basis names and exact parameters.
    Bracket(&'b Scope<'a>),
    /// In a matrix: exact parameters.
    Matrix(&'b Scope<'a>),
    /// Where a constant stands: no names.
    Constant,
}

fn lowered(value: &Expr, place: Place<'_, '_>, budget: &Budget) -> Result<Form, Vec<Diagnostic>> {
    let mut lowering = Lowering {
        place,
        mistakes: Vec::new(),
        budget,
    };
    lowering.walk(value).ok_or(lowering.mistakes)
}

/// The right side of a bracket: the nonzero coefficients by basis index.
///
/// # Errors
/// Every mistake in it.
pub fn bracket_value(
    value: &Expr,
    scope: &Scope<'_>,
    budget: &Budget,
) -> Result<Vec<(usize, Fraction)>, Vec<Diagnostic>> {
    let form = lowered(value, Place::Bracket(scope), budget)?;
    let wrong = if !form.constant.is_zero() {
        let constant = form.constant.display(&|p| scope.parameter(p));
        let place = constant_term(value, scope, budget).unwrap_or(value.origin);
        let message = format!(
            "the right side of a bracket is linear in the basis, but it has the constant term {constant}"
        );
        Diagnostic::new(Kind::Syntax, place, message)
            .help("write a linear combination of basis names, or 0")
    } else if form.linear.values().any(|c| degree(c) > MAX_EXPONENT) {
        let message = format!("a coefficient has a degree above {MAX_EXPONENT} in the parameters");
        Diagnostic::new(Kind::Limit, value.origin, message).help("simplify the bracket")
    } else {
        let terms = form.linear.into_iter();
        return Ok(terms.filter(|(_, c)| !c.is_zero()).collect());
    };
    Err(vec![wrong])
}

/// A linear combination with rational coefficients: those that are not zero, by basis index.
///
/// # Errors
/// Every mistake in it.
pub fn rational_form(
    value: &Expr,
    scope: &Scope<'_>,
    budget: &Budget,
) -> Result<BTreeMap<usize, Rational>, Vec<Diagnostic>> {
    let terms = bracket_value(value, scope, budget)?.into_iter();
    let rational = |(k, value): (usize, Fraction)| Some((k, value.as_constant()?));
    terms
        .map(rational)
        .collect::<Option<_>>()
        .ok_or_else(Vec::new)
}

/// An entry of a matrix, a rational function of exact parameters.
///
/// # Errors
/// Every mistake in it.
pub fn entry_value(
    value: &Expr,
    scope: &Scope<'_>,
    budget: &Budget,
) -> Result<Fraction, Vec<Diagnostic>> {
    let entry = lowered(value, Place::Matrix(scope), budget)?.constant;
    if degree(&entry) > MAX_EXPONENT {
        let message = format!("an entry has a degree above {MAX_EXPONENT} in the parameters");
        let wrong = Diagnostic::new(Kind::Limit, value.origin, message);
        return Err(vec![wrong.help("simplify the entry")]);
    }
    Ok(entry)
}

/// The largest total degree in numerator and denominator.
fn degree(value: &Fraction) -> i64 {
    let below = value
        .denominator()
        .map(|(f, e)| i64::from(f.degree()).saturating_mul(e.into()));
    below.fold(i64::from(value.numerator().degree()), i64::max)
}

/// The place of the first term that has a constant part.
fn constant_term(value: &Expr, scope: &Scope<'_>, budget: &Budget) -> Option<Origin> {
    let ExprKind::Sum(terms) = &value.kind else {
        return None;
    };
    let constant = |term| lowered(term, Place::Bracket(scope), budget).map(|form| form.constant);
    let found = terms
        .iter()
        .find(|(_, term)| constant(term).is_ok_and(|c| !c.is_zero()));
    found.map(|(_, term)| term.origin)
}

/// The value of an exact rational constant.
///
/// # Errors
/// Every mistake in it, and anything that is no such constant.
pub fn rational(value: &Expr, budget: &Budget) -> Result<Rational, Vec<Diagnostic>> {
    let form = lowered(value, Place::Constant, budget)?;
    form.constant.as_constant().ok_or_else(Vec::new)
}

impl Lowering<'_, '_> {
    fn limited<T>(&mut self, result: Result<T, Exhausted>, origin: Origin) -> Option<T> {
        result
            .or_else(|Exhausted| {
                self.fail(
                    Kind::Limit,
                    origin,
                    "this expression is too large to be expanded exactly",
                    "simplify it; powers of sums grow fast",
                )
                .ok_or(())
            })
            .ok()
    }

    /// What is said of anything that is not rational.
    fn irrational<T>(&mut self, origin: Origin, what: &str) -> Option<T> {
        let (kind, rule, help) = match self.place {
            Place::Bracket(_) => (
                Kind::Syntax,
                "the right side of a bracket is linear in the basis, with rational functions of exact parameters as coefficients",
                "write a linear combination of basis names, such as 2*e1 - k^2*e2",
            ),
            Place::Matrix(_) => (
                Kind::Number,
                "the entries of matrices are rational numbers, or rational functions of exact parameters",
                "write an integer, a fraction such as 1/2, a decimal number, or an expression such as -k/2",
            ),
            Place::Constant => (
                Kind::Number,
                "an exact rational constant is expected here",
                "write an integer, a fraction such as 1/2, or a decimal number",
            ),
        };
        self.fail(kind, origin, format!("{what}: {rule}"), help)
    }

    fn scale(&mut self, form: &Form, factor: &Fraction, origin: Origin) -> Option<Form> {
        let budget = self.budget;
        let constant = self.limited(form.constant.mul(factor, budget), origin)?;
        let mut linear = BTreeMap::new();
        for (k, value) in &form.linear {
            linear.insert(*k, self.limited(value.mul(factor, budget), origin)?);
        }
        Some(Form { constant, linear })
    }
}

impl Lower for Lowering<'_, '_> {
    type Value = Form;

    fn mistakes(&mut self) -> &mut Vec<Diagnostic> {
        &mut self.mistakes
    }

    fn number(&mut self, value: &Rational) -> Form {
        Fraction::from(value.clone()).into()
    }

    fn negative(&mut self, value: Form, origin: Origin) -> Option<Form> {
        self.scale(&value, &Fraction::from(Rational::MINUS_ONE), origin)
    }

    fn sum(&mut self, terms: Operands<Form>, origin: Origin) -> Option<Form> {
        let budget = self.budget;
        let mut sum = Form::default();
        for term in terms {
            let sign = term.sign();
            let form = term.value?;
            let added = sum.constant.add(&form.constant.scale(&sign), budget);
            sum.constant = self.limited(added, origin)?;
            for (k, value) in form.linear {
                let entry = sum.linear.entry(k).or_default();
                let added = entry.add(&value.scale(&sign), budget);
                *entry = self.limited(added, origin)?;
            }
        }
        Some(sum)
    }

    fn product(&mut self, factors: Operands<Form>, origin: Origin) -> Option<Form> {
        let mut product = Form::from(Fraction::from(Rational::ONE));
        for factor in factors {
            let form = factor.value?;
            if factor.turned {
                if !form.is_scalar() {
                    return self.irrational(origin, "a basis name stands in a denominator");
                }
                let inverse = form.constant.recip(self.budget);
                let Some(inverse) = self.limited(inverse, factor.origin)? else {
                    return self.division_by_zero(factor.origin);
                };
                product = self.scale(&product, &inverse, origin)?;
            } else if form.is_scalar() {
                product = self.scale(&product, &form.constant, origin)?;
            } else if product.is_scalar() {
                product = self.scale(&form, &product.constant, origin)?;
            } else {
                return self.irrational(origin, "a product of basis names");
            }
        }
        Some(product)
    }

    fn power(
        &mut self,
        base: Operand<Form>,
        exponent: Operand<Form>,
        origin: Origin,
    ) -> Option<Form> {
        let constant = exponent.value.constant.as_constant();
        let integer = constant
            .filter(|_| exponent.value.linear.is_empty())
            .filter(Rational::is_integer);
        let Some(integer) = integer else {
            return self.irrational(exponent.origin, "an exponent that is not an integer");
        };
        let small = |e: &i64| (-MAX_EXPONENT..=MAX_EXPONENT).contains(e);
        let Some(integer) = integer.to_integer().filter(small) else {
            return self.large_exponent(exponent.origin);
        };
        if integer == 1 {
            return Some(base.value);
        }
        if !base.value.is_scalar() {
            return self.irrational(origin, "a power of a basis name");
        }
        let power = base.value.constant.pow(integer as i32, self.budget);
        match self.limited(power, origin)? {
            Some(power) => Some(power.into()),
            None => self.power_of_zero(base.origin),
        }
    }

    fn call(&mut self, function: &Name, _: Operands<Form>, origin: Origin) -> Option<Form> {
        let name = &function.text;
        if Function::is_name(name) {
            return self.irrational(origin, &format!("`{name}` is not rational"));
        }
        self.unknown_function(
            function,
            "coefficients are rational: they have no functions",
        )
    }

    fn name(&mut self, name: &str, origin: Origin) -> Option<Form> {
        if name == "pi" || name == "t" {
            return self.irrational(origin, &format!("`{name}` is not rational"));
        }
        let (scope, wrong): (_, fn(_, _, _, &Scope<'_>) -> _) = match self.place {
            Place::Bracket(scope) => (scope, names::not_in_brackets),
            Place::Matrix(scope) => (scope, names::not_in_matrices),
            Place::Constant => {
                let message = format!("`{name}` is not a number");
                let help = "write an exact rational constant, such as 1/2";
                return self.fail(Kind::Number, origin, message, help);
            }
        };
        match (scope.meaning(name), self.place) {
            (Some(Meaning::Basis(k)), Place::Bracket(_)) => {
                let linear = BTreeMap::from([(k, Fraction::from(Rational::ONE))]);
                Some(Form {
                    constant: Fraction::default(),
                    linear,
                })
            }
            (Some(Meaning::Exact(parameter)), _) => Some(Fraction::variable(parameter).into()),
            (other, _) => {
                self.mistakes.push(wrong(name, origin, other, scope));
                None
            }
        }
    }
}
