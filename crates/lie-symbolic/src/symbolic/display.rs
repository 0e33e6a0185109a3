//! Expressions as text, in the grammar of the language.

use rustc_hash::FxHashMap as HashMap;

use num_traits::One;

use super::Function;
use super::graph::{ExprId, Graph, Node, Symbol};
use crate::exact::Rational;

/// A shared subexpression is printed wherever it occurs, so the text needs a bound of its own.
const LONGEST: usize = 4000;

/// Longer cases are those of a table.
const LONGEST_CASES: usize = 300;

/// How tightly a piece of text binds.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
enum Binding {
    Sum,
    Product,
    Power,
    Atom,
}

impl Graph {
    /// The expression as text that the parser reads back (shortened with `…` where it is very long).
    pub fn display(&self, id: ExprId, name: &dyn Fn(Symbol) -> String) -> String {
        let mut texts: HashMap<ExprId, (String, Binding)> = HashMap::default();
        for node in self.dependencies(&[id]) {
            let mut text = self.display_node(node, name, &texts);
            if text.0.len() > LONGEST {
                text = ("…".to_string(), Binding::Atom);
            }
            texts.insert(node, text);
        }
        texts.remove(&id).map(|(text, _)| text).unwrap_or_default()
    }

    fn display_node(
        &self,
        id: ExprId,
        name: &dyn Fn(Symbol) -> String,
        texts: &HashMap<ExprId, (String, Binding)>,
    ) -> (String, Binding) {
        let inside = |id: &ExprId, least: Binding| {
            let (text, binding) = &texts[id];
            if *binding < least {
                format!("({text})")
            } else {
                text.clone()
            }
        };
        match self.node(id) {
            Node::Number(value) => number(value),
            Node::Pi => ("pi".into(), Binding::Atom),
            Node::Symbol(symbol) => (name(*symbol), Binding::Atom),
            Node::Call(Function::Below, arguments) => {
                let [g, a, b] = [0, 1, 2].map(|place| inside(&arguments[place], Binding::Sum));
                let absolute =
                    arguments[0] == arguments[2] && self.is_negative_of(arguments[1], arguments[2]);
                let text = match absolute {
                    true => format!("abs({b})"),
                    false if g.len() + a.len() + b.len() > LONGEST_CASES => "piecewise(…)".into(),
                    false => format!("piecewise({g} < 0: {a}, {b})"),
                };
                (text, Binding::Atom)
            }
            Node::Call(function, arguments) => {
                let arguments: Vec<_> = arguments.iter().map(|a| inside(a, Binding::Sum)).collect();
                let name = match function {
                    Function::Own(own) => own.label(),
                    known => known.name().to_owned(),
                };
                (format!("{name}({})", arguments.join(", ")), Binding::Atom)
            }
            Node::Product(factors) => product(&Rational::ONE, factors, &inside),
            Node::Written(terms) => self.display_sum(&Rational::ZERO, terms, &inside),
            Node::Sum { constant, terms } => self.display_sum(constant, terms, &inside),
        }
    }

    /// Whether `a = -b`, by its form.
    fn is_negative_of(&self, a: ExprId, b: ExprId) -> bool {
        let ((factor, a), (other, b)) = (self.coefficient(a), self.coefficient(b));
        if a == b {
            return factor == -&other;
        }
        let (
            Node::Sum { constant, terms },
            Node::Sum {
                constant: last,
                terms: others,
            },
        ) = (self.node(a), self.node(b))
        else {
            return false;
        };
        let opposite =
            |((x, c), (y, d)): (&(ExprId, Rational), &(ExprId, Rational))| x == y && *c == -d;
        *constant == -last && terms.len() == others.len() && terms.iter().zip(others).all(opposite)
    }

    fn display_sum(
        &self,
        constant: &Rational,
        terms: &[(ExprId, Rational)],
        inside: &dyn Fn(&ExprId, Binding) -> String,
    ) -> (String, Binding) {
        let mut text = String::new();
        for (term, coefficient) in terms {
            match (coefficient.is_negative(), text.is_empty()) {
                (true, true) => text.push('-'),
                (true, false) => text.push_str(" - "),
                (false, true) => {}
                (false, false) => text.push_str(" + "),
            }
            let whole = [(*term, Rational::ONE)];
            let factors = match self.node(*term) {
                Node::Product(factors) => &factors[..],
                Node::Number(one) if one.is_one() => &[],
                _ => &whole[..],
            };
            text.push_str(&product(&coefficient.abs(), factors, inside).0);
        }
        if !constant.is_zero() {
            let sign = if constant.is_negative() { "-" } else { "+" };
            text.push_str(&format!(" {sign} {}", constant.abs()));
        }
        let single = terms.len() == 1 && constant.is_zero() && !text.starts_with('-');
        (
            text,
            if single {
                Binding::Product
            } else {
                Binding::Sum
            },
        )
    }
}

/// `coefficient * product of base^exponent` over one fraction bar; the coefficient is positive.
fn product(
    coefficient: &Rational,
    factors: &[(ExprId, Rational)],
    inside: &dyn Fn(&ExprId, Binding) -> String,
) -> (String, Binding) {
    let power = |base: &ExprId, exponent: &Rational| {
        if exponent.is_one() {
            inside(base, Binding::Power)
        } else if exponent.to_words() == Some((1, 2)) {
            format!("sqrt({})", inside(base, Binding::Sum))
        } else if exponent.is_integer() {
            format!("{}^{exponent}", inside(base, Binding::Atom))
        } else {
            format!("{}^({exponent})", inside(base, Binding::Atom))
        }
    };
    let (above, below): (Vec<_>, Vec<_>) = factors.iter().partition(|(_, e)| !e.is_negative());
    let mut above: Vec<String> = above.iter().map(|(b, e)| power(b, e)).collect();
    let mut below: Vec<String> = below.iter().map(|(b, e)| power(b, &e.abs())).collect();
    let coefficient = coefficient.to_big();
    if !coefficient.numer().is_one() || above.is_empty() {
        above.insert(0, coefficient.numer().to_string());
    }
    if !coefficient.denom().is_one() {
        below.insert(0, coefficient.denom().to_string());
    }
    let plain = above.len() == 1 && below.is_empty();
    let mut text = above.join("*");
    match below.as_slice() {
        [] => {}
        [only] => text.push_str(&format!("/{only}")),
        _ => text.push_str(&format!("/({})", below.join("*"))),
    }
    (
        text,
        if plain {
            Binding::Power
        } else {
            Binding::Product
        },
    )
}

fn number(value: &Rational) -> (String, Binding) {
    let binding = if value.is_negative() {
        Binding::Sum
    } else if value.is_integer() {
        Binding::Atom
    } else {
        Binding::Product
    };
    (value.to_string(), binding)
}
