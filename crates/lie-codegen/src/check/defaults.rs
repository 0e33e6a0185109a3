//! Structure constants at the default values of the exact parameters.

use super::algebra::Algebra;
use crate::model::Parameter;
use lie_symbolic::exact::Rational;
use lie_syntax::ast::Declaration;
use lie_syntax::diagnostic::{Diagnostic, Kind};

/// Work that exact evaluation may cost, in products of words.
const WORK: u64 = 300_000_000;

/// The defaults by parameter (zero for those that are not exact). The constants must be finite
/// there, because the exact rank at the initial state needs their values.
///
/// # Errors
/// Constants that are not finite, or too large to be evaluated.
pub fn exact_defaults(
    declaration: &Declaration,
    algebra: Option<&Algebra>,
    parameters: &[Parameter],
) -> Result<Vec<Rational>, Diagnostic> {
    let defaults: Vec<Rational> = parameters
        .iter()
        .map(|p| p.exact.clone().unwrap_or(Rational::ZERO))
        .collect();
    let place = parameters
        .iter()
        .find(|p| p.exact.is_some())
        .map_or(declaration.place(), |p| p.origin);
    let bits = defaults
        .iter()
        .map(Rational::bits)
        .max()
        .unwrap_or(0)
        .max(16);
    let entries = algebra.map_or(&[][..], |algebra| algebra.constants.entries());
    let work = entries.iter().fold(0, |sum: u64, e| {
        sum.saturating_add(e.3.evaluation_work(bits))
    });
    if work > WORK {
        let message = "the structure constants are too large to be evaluated exactly";
        return Err(Diagnostic::new(Kind::Limit, place, message)
            .help("simplify the brackets, or choose a default with fewer digits"));
    }
    let value = |p: usize| defaults[p].clone();
    if let Some((i, j, ..)) = entries.iter().find(|e| e.3.evaluate(&value).is_none()) {
        let [a, b] = [*i, *j].map(|index| &declaration.basis()[index].text);
        let message = format!("[{a}, {b}] is divided by zero for the default parameters");
        return Err(Diagnostic::new(Kind::Number, place, message).help("choose another default"));
    }
    Ok(defaults)
}
