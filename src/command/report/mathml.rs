//! Formulas as MathML, which browsers set themselves.

use lie_codegen::ast::{Expr, ExprKind, Index};
use lie_codegen::diagnostic::Report;
use lie_codegen::front::{Names, parse_expression_text};

use super::page::escaped;

/// Letters by their names.
const GREEK: [(&str, &str); 33] = [
    ("alpha", "α"),
    ("beta", "β"),
    ("gamma", "γ"),
    ("delta", "δ"),
    ("epsilon", "ε"),
    ("zeta", "ζ"),
    ("eta", "η"),
    ("theta", "θ"),
    ("iota", "ι"),
    ("kappa", "κ"),
    ("lambda", "λ"),
    ("mu", "μ"),
    ("nu", "ν"),
    ("xi", "ξ"),
    ("pi", "π"),
    ("rho", "ρ"),
    ("sigma", "σ"),
    ("tau", "τ"),
    ("phi", "φ"),
    ("chi", "χ"),
    ("psi", "ψ"),
    ("omega", "ω"),
    ("Gamma", "Γ"),
    ("Delta", "Δ"),
    ("Theta", "Θ"),
    ("Lambda", "Λ"),
    ("Xi", "Ξ"),
    ("Pi", "Π"),
    ("Sigma", "Σ"),
    ("Upsilon", "Υ"),
    ("Phi", "Φ"),
    ("Psi", "Ψ"),
    ("Omega", "Ω"),
];

/// How tightly a form binds.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
enum Binding {
    Sum,
    Product,
    Power,
}

/// A formula `left = right`, or an expression alone; as it is written where it is none of the grammar's.
pub fn formula(text: &str, names: &Names) -> String {
    let parts: Vec<&str> = text.splitn(2, '=').map(str::trim).collect();
    let sides: Option<Vec<String>> = parts.iter().map(|part| side(part, names)).collect();
    match sides {
        Some(sides) => format!(
            "<math display=\"block\"><mrow>{}</mrow></math>",
            sides.join("<mo>=</mo>")
        ),
        None => format!("<p><code>{}</code></p>", escaped(text)),
    }
}

/// One side of an equation; `x'` is the derivative by the time.
fn side(text: &str, names: &Names) -> Option<String> {
    if let Some(name) = text.strip_suffix('\'') {
        // a prime or a dot is hardly seen in fonts that are not made for mathematics
        let over = format!("<mi>d</mi>{}", identifier(name));
        return Some(fraction(&over, "<mi>d</mi><mi>t</mi>"));
    }
    if text.chars().all(|c| c.is_alphanumeric() || c == '_')
        && !text.starts_with(|c: char| c.is_ascii_digit())
    {
        return Some(identifier(text));
    }
    let mut report = Report::new();
    let parsed = parse_expression_text(text, 0, names, &mut report);
    let sound = report.gate().is_ok();
    parsed
        .filter(|_| sound)
        .map(|parsed| of(&parsed, Binding::Sum))
}

/// A name: Greek letters, and what follows a letter or a bar below as an index.
pub fn identifier(name: &str) -> String {
    let letters = name.trim_end_matches(|c: char| c.is_ascii_digit() || c == '_');
    let base = letters.split('_').next().unwrap_or(letters);
    if base.chars().count() > 3 && GREEK.iter().all(|(word, _)| *word != base) {
        return format!("<mtext>{}</mtext>", escaped(name));
    }
    let digits = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let (base, index) = match name.split_once('_') {
        Some((base, index)) if !base.is_empty() && !index.is_empty() => (base, index),
        _ if !digits.is_empty() => (digits, &name[digits.len()..]),
        _ => (name, ""),
    };
    let letter = GREEK
        .iter()
        .find(|(word, _)| *word == base)
        .map_or(base, |(_, letter)| letter);
    let letter = format!("<mi>{}</mi>", escaped(letter));
    match index {
        "" => letter,
        index => format!("<msub>{letter}<mi>{}</mi></msub>", escaped(index)),
    }
}

fn of(expression: &Expr, around: Binding) -> String {
    let (text, own) = match &expression.kind {
        ExprKind::Number(value) => {
            let text = value.to_string();
            match text.split_once('/') {
                Some((over, under)) => (
                    fraction(&format!("<mn>{over}</mn>"), &format!("<mn>{under}</mn>")),
                    Binding::Product,
                ),
                None => (format!("<mn>{text}</mn>"), Binding::Power),
            }
        }
        ExprKind::Name { name, index: None } => (identifier(name), Binding::Power),
        ExprKind::Name {
            name,
            index: Some(index),
        } => (
            format!(
                "<msub>{}<mrow>{}</mrow></msub>",
                identifier(name),
                indices(index)
            ),
            Binding::Power,
        ),
        ExprKind::Negative(_) => {
            let (negative, text) = signed(expression);
            let sign = if negative { "<mo>−</mo>" } else { "" };
            (format!("{sign}{text}"), Binding::Sum)
        }
        ExprKind::Sum(terms) => (sum(terms), Binding::Sum),
        ExprKind::Product(_) => match signed(expression) {
            (true, text) => (format!("<mo>−</mo>{text}"), Binding::Sum),
            (false, text) => (text, Binding::Product),
        },
        ExprKind::Power(base, exponent) => {
            let base = match base.kind {
                ExprKind::Name { .. } => of(base, Binding::Power),
                _ => enclosed(&of(base, Binding::Sum), is_atom(base)),
            };
            (
                format!(
                    "<msup><mrow>{base}</mrow><mrow>{}</mrow></msup>",
                    of(exponent, Binding::Sum)
                ),
                Binding::Power,
            )
        }
        ExprKind::Call {
            function,
            arguments,
        } => (call(&function.text, arguments), Binding::Power),
        ExprKind::IndexedSum {
            index,
            from,
            to,
            body,
        } => {
            let below = format!(
                "{}<mo>=</mo>{}",
                identifier(&index.text),
                of(from, Binding::Sum)
            );
            let above = format!("{}<mo>−</mo><mn>1</mn>", of(to, Binding::Sum));
            let sign = format!(
                "<munderover><mo>∑</mo><mrow>{below}</mrow><mrow>{above}</mrow></munderover>"
            );
            (
                format!("{sign}{}", of(body, Binding::Product)),
                Binding::Sum,
            )
        }
    };
    enclosed(&text, own >= around)
}

fn is_atom(expression: &Expr) -> bool {
    match &expression.kind {
        ExprKind::Number(value) => !value.to_string().contains(['/', '-']),
        ExprKind::Call { function, .. } => matches!(&*function.text, "abs" | "norm"),
        kind => matches!(kind, ExprKind::Name { .. }),
    }
}

fn enclosed(text: &str, bare: bool) -> String {
    match bare {
        true => format!("<mrow>{text}</mrow>"),
        false => format!("<mrow><mo>(</mo>{text}<mo>)</mo></mrow>"),
    }
}

fn fraction(over: &str, under: &str) -> String {
    format!("<mfrac><mrow>{over}</mrow><mrow>{under}</mrow></mfrac>")
}

fn sum(terms: &[(bool, Expr)]) -> String {
    let mut text = String::new();
    for (number, (minus, term)) in terms.iter().enumerate() {
        // a minus of its own joins the sign
        let (negative, term) = signed(term);
        text.push_str(match (number, *minus != negative) {
            (_, true) => "<mo>−</mo>",
            (0, false) => "",
            (_, false) => "<mo>+</mo>",
        });
        text.push_str(&term);
    }
    text
}

/// Whether a minus stands before a term, and the rest of it.
fn signed(term: &Expr) -> (bool, String) {
    match &term.kind {
        ExprKind::Negative(inner) => {
            let (negative, text) = signed(inner);
            (!negative, text)
        }
        ExprKind::Product(factors) => match factors.as_slice() {
            [
                (
                    false,
                    Expr {
                        kind: ExprKind::Negative(first),
                        ..
                    },
                ),
                rest @ ..,
            ] => {
                let bare = std::iter::once((false, (**first).clone())).chain(rest.iter().cloned());
                (true, product(&bare.collect::<Vec<_>>()))
            }
            factors => (false, product(factors)),
        },
        _ => (false, of(term, Binding::Product)),
    }
}

fn product(factors: &[(bool, Expr)]) -> String {
    let side = |divides: bool| -> Vec<&Expr> {
        factors
            .iter()
            .filter(|(own, _)| *own == divides)
            .map(|(_, factor)| factor)
            .collect()
    };
    let joined = |factors: &[&Expr], alone: bool| -> String {
        let around = if alone && factors.len() == 1 {
            Binding::Sum
        } else {
            Binding::Product
        };
        let parts: Vec<String> = factors.iter().map(|factor| of(factor, around)).collect();
        parts.join("<mspace width=\"0.17em\"/>")
    };
    let (over, under) = (side(false), side(true));
    if under.is_empty() {
        return joined(&over, false);
    }
    let over = if over.is_empty() {
        "<mn>1</mn>".to_owned()
    } else {
        joined(&over, true)
    };
    fraction(&over, &joined(&under, true))
}

fn indices(index: &Index) -> String {
    let variable = index
        .variable
        .as_ref()
        .map_or(String::new(), |name| identifier(&name.text));
    let offset = match (index.offset, variable.is_empty()) {
        (0, false) => String::new(),
        (offset, true) => format!("<mn>{offset}</mn>"),
        (offset, false) if offset < 0 => format!("<mo>−</mo><mn>{}</mn>", -offset),
        (offset, false) => format!("<mo>+</mo><mn>{offset}</mn>"),
    };
    let second = index.second.as_ref().map_or(String::new(), |second| {
        format!("<mo>,</mo>{}", indices(second))
    });
    format!("{variable}{offset}{second}")
}

fn call(function: &str, arguments: &[Expr]) -> String {
    let list: Vec<String> = arguments
        .iter()
        .map(|argument| of(argument, Binding::Sum))
        .collect();
    match (function, list.as_slice()) {
        ("sqrt", [x]) => format!("<msqrt>{x}</msqrt>"),
        ("cbrt", [x]) => format!("<mroot><mrow>{x}</mrow><mn>3</mn></mroot>"),
        ("exp", [x]) => format!("<msup><mi>e</mi><mrow>{x}</mrow></msup>"),
        ("abs", [x]) => format!("<mrow><mo>|</mo>{x}<mo>|</mo></mrow>"),
        ("norm", [x]) => format!("<mrow><mo>‖</mo>{x}<mo>‖</mo></mrow>"),
        _ => format!(
            "<mi>{}</mi><mo>(</mo>{}<mo>)</mo>",
            escaped(function),
            list.join("<mo>,</mo>")
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names() -> Names {
        ["m1", "m2", "omega", "x", "I1", "k_x"]
            .into_iter()
            .collect()
    }

    #[test]
    fn fractions_indices_and_signs() {
        let text = formula("m1' = -m1*m2/(2*I1) + sqrt(omega)^2", &names());
        assert!(
            text.contains("<mrow><mi>d</mi><msub><mi>m</mi><mi>1</mi></msub></mrow><mrow><mi>d</mi><mi>t</mi></mrow>"),
            "{text}"
        );
        assert!(
            text.contains("<mfrac>") && text.contains("<msqrt>") && text.contains("<mi>ω</mi>"),
            "{text}"
        );
        assert_eq!(text.matches("<mo>−</mo>").count(), 1, "{text}");
        assert!(
            !text.contains("<mo>(</mo><mrow><mn>2</mn>"),
            "a fraction needs no parentheses: {text}"
        );
    }

    #[test]
    fn parentheses_stand_where_they_must() {
        let open = |text: &str| formula(text, &names()).matches("<mo>(</mo>").count();
        assert_eq!(open("(x + m1)*m2"), 1);
        assert_eq!(open("x - (m1 - m2)"), 1);
        assert_eq!(open("(x + m1)^2"), 1);
        assert_eq!(open("(-x)^2"), 1);
        assert_eq!(open("(x + m1)/m2"), 0);
        assert_eq!(open("x + m1*m2"), 0);
        assert_eq!(open("sin(x)"), 1);
        assert_eq!(
            open("-x*m1/m2 - (-x)*m1"),
            0,
            "{}",
            formula("-x*m1/m2 - (-x)*m1", &names())
        );
        assert_eq!(open("m1*(-x)"), 1);
    }

    #[test]
    fn what_is_no_formula_is_shown_as_it_is() {
        assert_eq!(
            formula("x + <b>", &names()),
            "<p><code>x + &lt;b&gt;</code></p>"
        );
    }
}
