//! Structure constants and matrices at the default values of the exact parameters.

use super::algebra::Algebra;
use crate::model::Parameter;
use lie_symbolic::exact::Rational;
use lie_syntax::ast::Declaration;
use lie_syntax::diagnostic::{Diagnostic, Kind};
use lie_syntax::linear::Scope;

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
    let matrices = algebra.and_then(|algebra| algebra.parametric.as_ref());
    let matrices = matrices.into_iter().flat_map(|found| &found.matrices);
    let values = entries.iter().map(|e| &e.3);
    let values = values.chain(matrices.flatten().flatten());
    let work = values.fold(0, |sum: u64, value| {
        sum.saturating_add(value.evaluation_work(bits))
    });
    if work > WORK {
        let message = "the structure constants are too large to be evaluated exactly";
        return Err(Diagnostic::new(Kind::Limit, place, message)
            .help("simplify the brackets or the matrices, or choose a default with fewer digits"));
    }
    let value = |p: usize| defaults[p].clone();
    if let Some((i, j, ..)) = entries.iter().find(|e| e.3.evaluate(&value).is_none()) {
        let [a, b] = [*i, *j].map(|index| &declaration.basis()[index].text);
        let message = format!("[{a}, {b}] is divided by zero for the default parameters");
        return Err(Diagnostic::new(Kind::Number, place, message).help("choose another default"));
    }
    let found = algebra.and_then(|algebra| parametric_matrices(declaration, algebra, &value));
    match found {
        Some((message, help)) => {
            let used = algebra.and_then(|algebra| algebra.parametric.as_ref());
            let first = used.and_then(|used| used.parameters().into_iter().next());
            let place = first.map_or(place, |p| parameters[p].origin);
            Err(Diagnostic::new(Kind::Representation, place, message).help(help))
        }
        None => Ok(defaults),
    }
}

/// What is wrong with matrices at the defaults of their parameters, with the remedy: they are finite, and where they are generic
/// ones that are independent, independent.
fn parametric_matrices(
    declaration: &Declaration,
    algebra: &Algebra,
    value: &dyn Fn(usize) -> Rational,
) -> Option<(String, &'static str)> {
    let parametric = algebra.parametric.as_ref()?;
    let relation = match parametric.relation(value) {
        Ok(relation) => relation?,
        Err(k) => {
            let name = &declaration.basis()[k].text;
            let message =
                format!("the matrix of `{name}` is divided by zero for the default parameters");
            return Some((message, "choose another default"));
        }
    };
    // brackets that are declared may have matrices that are not faithful, with which nothing is computed
    if !parametric.gives_brackets && parametric.triple.is_none() {
        return None;
    }
    let terms = relation.into_iter().enumerate();
    let terms = terms.filter(|(_, c)| !c.is_zero());
    let terms: Vec<_> = terms.map(|(k, c)| (k, c.into())).collect();
    let relation = Scope::new(declaration).display(&terms);
    let message =
        format!("the matrices are linearly dependent for the default parameters: {relation} = 0");
    Some((message, "choose another default, or other matrices"))
}
