//! The values of constants that stand alone, the options on the command line.

use super::environment::{Allowed, Environment};
use super::lower::Lowering;
use lie_symbolic::symbolic::Graph;
use lie_syntax::ast::Expr;
use lie_syntax::diagnostic::Diagnostic;

/// The value of an expression without names, in double precision; it need not be finite there.
///
/// # Errors
/// Every mistake in it.
pub fn constant_value(expr: &Expr) -> Result<f64, Vec<Diagnostic>> {
    let mut graph = Graph::new();
    let environment = Environment::default();
    let mut mistakes = Vec::new();
    let value =
        Lowering::new(&mut graph, &environment, &mut mistakes, Allowed::Constants).lower(expr);
    let value = value.ok_or(mistakes)?;
    Ok(graph.evaluate(value, &|_| f64::NAN))
}

#[cfg(test)]
mod tests {
    use crate::compile::constant;
    use lie_syntax::diagnostic::Kind;

    #[test]
    fn signs_are_exact() {
        // zero, though not in double precision
        for zero in [
            "sin(pi)",
            "sqrt(6) - sqrt(2)*sqrt(3)",
            "sin(1)^2 + cos(1)^2 - 1",
            "exp(log(2)/2) - sqrt(2)",
            "cos(pi/4)*sqrt(2) - 1",
            "tan(pi/3)^2 - 3",
            "log(6) - log(2) - log(3)",
            "asin(1/2)*6 - pi",
        ] {
            let text = format!("1/({zero})");
            let found = constant(&text).err().unwrap_or_default();
            assert_eq!(found.len(), 1, "{text}: {found:?}");
            assert_eq!(found[0].message, "division by zero", "{text}");
            for wrong in ["sqrt", "log"] {
                let text = format!("{wrong}({zero} - 1e-40)");
                let found = constant(&text).err().unwrap_or_default();
                assert_eq!(found.len(), 1, "{text}: {found:?}");
                assert!(constant(&format!("{wrong}({zero} + 1e-40)")).is_ok());
            }
            assert!(constant(&format!("sqrt({zero})")).is_ok());
            assert!(constant(&format!("log({zero})")).is_err());
        }
        // zero in double precision, and not in truth
        for small in [
            "1 + 1e-30 - cos(0)",
            "cos(1e-20) - 1",
            "tanh(50) - 1",
            "exp(1e-20) - 1",
            "sqrt(1 + 1e-25) - 1",
        ] {
            assert!(constant(&format!("1/({small})")).is_ok(), "{small}");
        }
        assert!(constant("asin(1)").is_ok() && constant("acos(1 + 1e-30)").is_err());
        assert!(constant("tan(pi/2)").is_err() && constant("tan(pi/2 + 1e-30)").is_ok());
        // beyond the digits and beyond the prover: refused, not guessed
        let text = "1/(cos(1e-40) - 1 + 1/2e80)";
        let found = constant(text).err().unwrap_or_default();
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].message.contains("cannot be decided"), "{found:?}");
    }

    #[test]
    fn constants_are_exact_until_the_end() {
        assert_eq!(constant("1/7").ok(), Some(1.0 / 7.0));
        assert_eq!(constant(" -0.1 ").ok(), Some(-0.1));
        assert_eq!(constant("1e20 + 1 - 1e20").ok(), Some(1.0));
        assert_eq!(constant("cos(11/10)").ok(), Some(1.1_f64.cos()));
        for (text, kind) in [
            ("", Kind::Number),
            ("one", Kind::Number),
            ("1/0", Kind::Number),
            ("1..5", Kind::Number),
            ("2(3)", Kind::Syntax),
        ] {
            let found = constant(text).err().unwrap_or_default();
            assert_eq!(
                found.first().map(|d| d.kind),
                Some(kind),
                "{text}: {found:?}"
            );
        }
    }
}
