//! Formulas as MathML, which browsers set themselves.

use lie_codegen::model::configuration::WIENER;
use lie_in_process::formula::{self, GREEK, Notation};
use lie_syntax::front::Names;

use super::page::escaped;

/// A formula `left = right`, or an expression alone; as it is written where it is none of the grammar's.
pub fn formula(text: &str, names: &Names) -> String {
    formula::formula(text, names, &MathMl)
}

/// A name: Greek letters, and what follows a letter or a bar below as an index.
pub fn identifier(name: &str) -> String {
    formula::identifier(name, &MathMl)
}

struct MathMl;

impl Notation for MathMl {
    fn number(&self, digits: &str) -> String {
        format!("<mn>{digits}</mn>")
    }

    fn letter(&self, name: &str, index: &str) -> String {
        let greek = GREEK.iter().find(|(word, _)| *word == name);
        let letter = greek.map_or(name, |(_, letter)| letter);
        let letter = match letter {
            // the rate of a Wiener process
            WIENER => "<mover accent=\"true\"><mi>W</mi><mo>˙</mo></mover>".to_owned(),
            letter => format!("<mi>{}</mi>", escaped(letter)),
        };
        match index {
            "" => letter,
            index => format!("<msub>{letter}<mi>{}</mi></msub>", escaped(index)),
        }
    }

    fn word(&self, name: &str) -> String {
        format!("<mtext>{}</mtext>", escaped(name))
    }

    fn indexed(&self, name: &str, indices: &str) -> String {
        format!("<msub>{name}<mrow>{indices}</mrow></msub>")
    }

    fn sign(&self, sign: char) -> String {
        let sign = if sign == '-' { '−' } else { sign };
        format!("<mo>{sign}</mo>")
    }

    fn negative(&self, text: &str) -> String {
        self.sign('-') + text
    }

    fn group(&self, text: &str) -> String {
        format!("<mrow>{text}</mrow>")
    }

    fn parentheses(&self, text: &str) -> String {
        format!("<mrow><mo>(</mo>{text}<mo>)</mo></mrow>")
    }

    fn fraction(&self, over: &str, under: &str) -> String {
        format!("<mfrac><mrow>{over}</mrow><mrow>{under}</mrow></mfrac>")
    }

    fn power(&self, base: &str, exponent: &str) -> String {
        format!("<msup><mrow>{base}</mrow><mrow>{exponent}</mrow></msup>")
    }

    fn product(&self, factors: &[String]) -> String {
        factors.join("<mspace width=\"0.17em\"/>")
    }

    fn sum(&self, index: &str, [from, to]: [&str; 2], body: &str) -> String {
        let below = format!("{index}<mo>=</mo>{from}");
        let above = format!("{to}<mo>−</mo><mn>1</mn>");
        format!("<munderover><mo>∑</mo><mrow>{below}</mrow><mrow>{above}</mrow></munderover>{body}")
    }

    fn sum_of_bonds(&self, body: &str) -> String {
        format!("<munder><mo>∑</mo><mtext>bonds</mtext></munder>{body}")
    }

    fn cases(&self, [left, right]: [&str; 2], [yes, no]: [&str; 2]) -> String {
        let row = |value: &str, condition: &str| {
            format!("<mtr><mtd>{value}</mtd><mtd>{condition}</mtd></mtr>")
        };
        let first = row(yes, &format!("<mrow>{left}<mo>&lt;</mo>{right}</mrow>"));
        let last = row(no, "<mtext>otherwise</mtext>");
        format!("<mrow><mo>{{</mo><mtable columnalign=\"left\">{first}{last}</mtable></mrow>")
    }

    fn call(&self, function: &str, arguments: &[String]) -> String {
        match (function, arguments) {
            ("sqrt", [x]) => format!("<msqrt>{x}</msqrt>"),
            ("cbrt", [x]) => format!("<mroot><mrow>{x}</mrow><mn>3</mn></mroot>"),
            ("exp", [x]) => format!("<msup><mi>e</mi><mrow>{x}</mrow></msup>"),
            ("abs", [x]) => format!("<mrow><mo>|</mo>{x}<mo>|</mo></mrow>"),
            ("norm", [x]) => format!("<mrow><mo>‖</mo>{x}<mo>‖</mo></mrow>"),
            _ => format!(
                "<mi>{}</mi><mo>(</mo>{}<mo>)</mo>",
                escaped(function),
                arguments.join("<mo>,</mo>")
            ),
        }
    }

    fn rate(&self, name: &str) -> String {
        // a prime or a dot is hardly seen in fonts that are not made for mathematics
        self.fraction(&format!("<mi>d</mi>{name}"), "<mi>d</mi><mi>t</mi>")
    }

    fn equation(&self, sides: &[String]) -> String {
        let sides = sides.join("<mo>=</mo>");
        format!("<math display=\"block\"><mrow>{sides}</mrow></math>")
    }

    fn verbatim(&self, text: &str) -> String {
        format!("<p><code>{}</code></p>", escaped(text))
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
        let cases = formula("piecewise(x < 0: -x, x)", &names());
        assert!(
            cases.contains("<mtable") && cases.contains("<mo>&lt;</mo>"),
            "{cases}"
        );
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
