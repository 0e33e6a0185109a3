//! The bounds of sums over sites.

use lie_symbolic::exact::Rational;
use lie_syntax::ast::{Expr, ExprKind, Size};
use lie_syntax::diagnostic::{Diagnostic, Kind};

/// The first site and the number of sites behind the last one; none where a sum goes over all.
pub type Span = Option<(usize, usize)>;

/// Where a sum goes, of so many sites.
pub fn span(from: &Expr, to: &Expr, size: &Size, mistakes: &mut Vec<Diagnostic>) -> Option<Span> {
    let all = size.text();
    let mut wrong = |expr: &Expr| {
        let message = "a sum goes from a number to the number of sites or less";
        let help = format!("write `0..{all}`, which is periodic, or bounds such as `1..{all}-1`");
        mistakes.push(Diagnostic::new(Kind::Syntax, expr.origin, message).help(help));
    };
    let Some(first) = number(from) else {
        wrong(from);
        return None;
    };
    let Some(left) = left(to, size) else {
        wrong(to);
        return None;
    };
    Some((first > 0 || left > 0).then_some((first, left)))
}

/// A whole number that is not negative.
fn number(expr: &Expr) -> Option<usize> {
    match &expr.kind {
        ExprKind::Number(value) => whole(value),
        _ => None,
    }
}

fn whole(value: &Rational) -> Option<usize> {
    value.to_string().parse().ok()
}

/// How many sites are behind the last one: `b` of `N - b`.
fn left(to: &Expr, size: &Size) -> Option<usize> {
    match (&to.kind, size) {
        (ExprKind::Number(value), Size::Number(count, _)) => count.checked_sub(whole(value)?),
        (ExprKind::Name { name, index: None }, Size::Parameter(own)) => {
            (*name == own.text).then_some(0)
        }
        (ExprKind::Sum(terms), Size::Parameter(_)) => match terms.as_slice() {
            [(false, all), (true, less)] => {
                left(all, size)?;
                number(less)
            }
            _ => None,
        },
        _ => None,
    }
}

/// What to do where a sum that does not go over all sites depends on one beyond the ends.
pub fn beyond(span: Span, offset: i64, variable: &str) -> Option<String> {
    let (first, left) = span?;
    let (first, left) = (first as i64, left as i64);
    if first + offset < 0 {
        return Some(format!("let `{variable}` begin with {}", -offset));
    }
    (offset > left).then(|| {
        format!("let `{variable}` end {offset} before the number of sites, as in `0..N-{offset}`; a sum over all sites, `0..N`, is periodic")
    })
}
