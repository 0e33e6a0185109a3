//! LaTeX, of what KaTeX and MathJax know.

use super::{GREEK, Notation};

/// Formulas as LaTeX, an equation as a line of `aligned`.
pub struct Latex;

/// Functions that have a name there.
const KNOWN: [&str; 10] = [
    "exp", "log", "sin", "cos", "tan", "sinh", "cosh", "tanh", "min", "max",
];

/// Text in which nothing means anything.
fn plain(text: &str) -> String {
    let mut plain = String::new();
    for c in text.chars() {
        match c {
            '#' | '$' | '%' | '&' | '_' | '{' | '}' => plain.extend(['\\', c]),
            '^' => plain.push_str(r"\textasciicircum{}"),
            '~' => plain.push_str(r"\textasciitilde{}"),
            '\\' => plain.push_str(r"\textbackslash{}"),
            _ => plain.push(c),
        }
    }
    plain
}

impl Notation for Latex {
    fn number(&self, digits: &str) -> String {
        digits.to_owned()
    }

    fn letter(&self, name: &str, index: &str) -> String {
        let greek = GREEK.iter().any(|(word, _)| *word == name);
        let letter = match (greek, name.chars().count()) {
            (true, _) => format!(r"\{name}"),
            (false, 1) => plain(name),
            (false, _) => format!(r"\mathit{{{}}}", plain(name)),
        };
        match index.chars().count() {
            0 => letter,
            1 => format!("{letter}_{{{}}}", plain(index)),
            _ if index.chars().all(|c| c.is_ascii_digit()) => format!("{letter}_{{{index}}}"),
            _ => format!(r"{letter}_{{\mathrm{{{}}}}}", plain(index)),
        }
    }

    fn word(&self, name: &str) -> String {
        format!(r"\mathit{{{}}}", plain(name))
    }

    fn indexed(&self, name: &str, indices: &str) -> String {
        match name.contains('_') {
            true => format!("{{{name}}}_{{{indices}}}"),
            false => format!("{name}_{{{indices}}}"),
        }
    }

    fn sign(&self, sign: char) -> String {
        match sign {
            ',' => ", ".to_owned(),
            sign => format!(" {sign} "),
        }
    }

    fn negative(&self, text: &str) -> String {
        format!("-{text}")
    }

    fn group(&self, text: &str) -> String {
        text.to_owned()
    }

    fn parentheses(&self, text: &str) -> String {
        let tall = [r"\frac", r"\sum", r"\begin", "^"];
        match tall.iter().any(|part| text.contains(part)) {
            true => format!(r"\left({text}\right)"),
            false => format!("({text})"),
        }
    }

    fn fraction(&self, over: &str, under: &str) -> String {
        format!(r"\frac{{{}}}{{{}}}", over, under)
    }

    fn power(&self, base: &str, exponent: &str) -> String {
        format!("{base}^{{{}}}", exponent)
    }

    fn product(&self, factors: &[String]) -> String {
        let mut text = String::new();
        for factor in factors {
            // two numbers side by side would be one
            let digits = text.ends_with(|c: char| c.is_ascii_digit())
                && factor.starts_with(|c: char| c.is_ascii_digit());
            match (text.is_empty(), digits) {
                (true, _) => {}
                (false, true) => text.push_str(r" \cdot "),
                (false, false) => text.push_str(r"\,"),
            }
            text.push_str(factor);
        }
        text
    }

    fn sum(&self, index: &str, [from, to]: [&str; 2], body: &str) -> String {
        format!(r"\sum_{{{from} \le {index} < {to}}} {body}")
    }

    fn sum_of_bonds(&self, body: &str) -> String {
        format!(r"\sum_{{\mathrm{{bonds}}}} {body}")
    }

    fn cases(&self, [left, right]: [&str; 2], [yes, no]: [&str; 2]) -> String {
        format!(
            r"\begin{{cases}}{} & {left} < {right} \\ {} & \text{{otherwise}}\end{{cases}}",
            yes, no
        )
    }

    fn call(&self, function: &str, arguments: &[String]) -> String {
        match (function, arguments) {
            ("sqrt", [x]) => format!(r"\sqrt{{{}}}", x),
            ("cbrt", [x]) => format!(r"\sqrt[3]{{{}}}", x),
            ("abs", [x]) => format!(r"\left|{}\right|", x),
            ("norm", [x]) => format!(r"\left\|{}\right\|", x),
            (function, arguments) => {
                let arguments = self.parentheses(&arguments.join(", "));
                match KNOWN.contains(&function) {
                    true => format!(r"\{function}{arguments}"),
                    false => format!(r"\operatorname{{{}}}{arguments}", plain(function)),
                }
            }
        }
    }

    fn rate(&self, name: &str) -> String {
        format!("{name}'")
    }

    fn equation(&self, sides: &[String]) -> String {
        sides.join(" &= ")
    }

    fn verbatim(&self, text: &str) -> String {
        format!(r"\texttt{{{}}}", plain(text))
    }
}

#[cfg(test)]
mod tests {
    use super::super::formula;
    use super::*;
    use lie_syntax::front::Names;

    #[test]
    fn what_is_shown_is_what_was_written() {
        let names = ["a", "b", "c", "x", "y", "x1", "k_rot", "omega_2"];
        let names: Names = names.into_iter().collect();
        for (text, latex) in [
            (
                "x1' = x1^2 - k_rot*pi*y",
                r"x_{1}' &= x_{1}^{2} - k_{\mathrm{rot}}\,\pi\,y",
            ),
            ("x^(-3/2) + x^2.5", r"x^{-\frac{3}{2}} + x^{\frac{5}{2}}"),
            (
                "sqrt(x^2 + 1)/log1p(y)",
                r"\frac{\sqrt{x^{2} + 1}}{\operatorname{log1p}(y)}",
            ),
            ("a - (b - c)", "a - (b - c)"),
            ("-x*(y - a)/2", r"-\frac{x\,(y - a)}{2}"),
            ("x*(-y)", r"x\,(-y)"),
            (
                "(x/y)^2*omega_2",
                r"\left(\frac{x}{y}\right)^{2}\,\omega_{2}",
            ),
            (
                "abs(x)*atan2(x, y)",
                r"\left|x\right|\,\operatorname{atan2}(x, y)",
            ),
            (
                "piecewise(x < 0: -x, x^2)",
                r"\begin{cases}-x & x < 0 \\ x^{2} & \text{otherwise}\end{cases}",
            ),
            ("H = x + $&_", r"\texttt{H = x + \$\&\_}"),
        ] {
            assert_eq!(formula(text, &names, &Latex), latex, "{text}");
        }
        let sites: Names = ["x", "N"].into_iter().collect();
        let sites = sites.with_indices(true);
        for (text, latex) in [
            (
                "sum(i in 0..N: x[i])^2/(2*N)",
                r"\frac{\left(\sum_{0 \le i < N} x_{i}\right)^{2}}{2\,N}",
            ),
            (
                "sum(i in 0..N: x[i] + x[i+1])",
                r"\sum_{0 \le i < N} (x_{i} + x_{i + 1})",
            ),
        ] {
            assert_eq!(formula(text, &sites, &Latex), latex, "{text}");
        }
    }
}
