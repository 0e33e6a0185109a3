//! Constants that stand alone: the values of options on the command line.

use super::environment::{Allowed, Environment};
use super::lower::Lowering;
use crate::diagnostic::{Diagnostic, Report};
use crate::front::parse_constant_text;
use crate::symbolic::Graph;

/// The value of an exact constant (`1/7`, `-1/2`, `cos(11/10)`), in double precision; it need not
/// be finite there.
///
/// # Errors
/// Every mistake in it; places count the bytes of `text`.
pub fn constant(text: &str) -> Result<f64, Vec<Diagnostic>> {
    let mut report = Report::new();
    let mut graph = Graph::new();
    let environment = Environment::default();
    let value = parse_constant_text(text, 0, &mut report).and_then(|expr| {
        let mut lowering = Lowering::new(&mut graph, &environment, &mut report, Allowed::Constants);
        lowering.lower(&expr)
    });
    match value {
        Some(value) => Ok(graph.evaluate(value, &|_| f64::NAN)),
        None => Err(report.into_diagnostics()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnostic::Kind;

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
