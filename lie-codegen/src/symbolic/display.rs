//! Expressions as text, in the grammar of the language.

use std::collections::HashMap;

use super::graph::{ExprId, Graph, Node, Symbol};
use crate::exact::Rational;

/// A shared subexpression is printed wherever it occurs, so the text needs a bound of its own.
const LONGEST: usize = 4000;

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
        let mut texts: HashMap<ExprId, (String, Binding)> = HashMap::new();
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
            if *binding < least { format!("({text})") } else { text.clone() }
        };
        match self.node(id) {
            Node::Number(value) => number(value),
            Node::Pi => ("pi".into(), Binding::Atom),
            Node::Symbol(symbol) => (name(*symbol), Binding::Atom),
            Node::Call(function, arguments) => {
                let arguments: Vec<_> = arguments.iter().map(|a| inside(a, Binding::Sum)).collect();
                (format!("{}({})", function.name(), arguments.join(", ")), Binding::Atom)
            }
            Node::Product(factors) => {
                let power = |base: &ExprId, exponent: &Rational| {
                    if exponent.is_one() {
                        inside(base, Binding::Product)
                    } else if exponent.to_words() == Some((1, 2)) {
                        format!("sqrt({})", inside(base, Binding::Sum))
                    } else if exponent.is_integer() {
                        format!("{}^{exponent}", inside(base, Binding::Atom))
                    } else {
                        format!("{}^({exponent})", inside(base, Binding::Atom))
                    }
                };
                let (above, below): (Vec<_>, Vec<_>) = factors.iter().partition(|(_, e)| !e.is_negative());
                let mut text = above.iter().map(|(b, e)| power(b, e)).collect::<Vec<_>>().join("*");
                if text.is_empty() {
                    text.push('1');
                }
                for (base, exponent) in &below {
                    let flipped = exponent.abs();
                    let text_below =
                        if flipped.is_one() { inside(base, Binding::Power) } else { power(base, &flipped) };
                    text.push('/');
                    text.push_str(&text_below);
                }
                let binding = if factors.len() == 1 && below.is_empty() { Binding::Power } else { Binding::Product };
                (text, binding)
            }
            Node::Sum { constant, terms } => {
                let mut text = String::new();
                for (term, coefficient) in terms {
                    let sign = if coefficient.is_negative() { "-" } else { "+" };
                    if !text.is_empty() {
                        text.push(' ');
                        text.push_str(sign);
                        text.push(' ');
                    } else if coefficient.is_negative() {
                        text.push('-');
                    }
                    let size = coefficient.abs();
                    if !size.is_one() {
                        text.push_str(&format!("{size}*"));
                    }
                    text.push_str(&inside(term, Binding::Product));
                }
                if !constant.is_zero() {
                    let sign = if constant.is_negative() { "-" } else { "+" };
                    text.push_str(&format!(" {sign} {}", constant.abs()));
                }
                let binding =
                    if terms.len() == 1 && constant.is_zero() && !text.starts_with('-') { Binding::Product } else { Binding::Sum };
                (text, binding)
            }
        }
    }
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
