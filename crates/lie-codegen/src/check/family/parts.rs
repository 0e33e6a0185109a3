//! Expressions of a family part by part, and those of a site.

use lie_syntax::ast::{Expr, ExprKind, Family};
use lie_syntax::diagnostic::{Diagnostic, Kind};

/// A Casimir of a site, written with or without the index of the family.
pub fn on_site(expr: &Expr, family: &Family, mistakes: &mut Vec<Diagnostic>) -> Option<Expr> {
    let differs = |name: &str| family.data.iter().any(|data| data.name.text == name);
    mapped(expr, &mut |part| match &part.kind {
        ExprKind::Name { name, .. } if differs(name) => {
            let message = format!(
                "`{name}` differs from site to site, and a Casimir is the same function at each"
            );
            let help = "write it in coordinates and in parameters that are one number";
            mistakes.push(Diagnostic::new(Kind::UnknownSymbol, part.origin, message).help(help));
            None
        }
        ExprKind::IndexedSum { .. } => {
            let message = "a Casimir of a family is one of a site";
            let help = "write it without the sum, such as `x[i]^2 + y[i]^2 + z[i]^2`";
            mistakes.push(Diagnostic::new(Kind::Syntax, part.origin, message).help(help));
            None
        }
        ExprKind::Name {
            name,
            index: Some(index),
        } => {
            let own = index.along_axes().zip(&family.indices).all(|(index, own)| {
                let same = index.variable.as_ref().is_some_and(|v| v.text == own.text);
                same && index.offset == 0
            });
            if !own {
                let message = "a Casimir of a family is one of a site";
                let names: Vec<&str> = family.indices.iter().map(|i| i.text.as_str()).collect();
                let help = format!("write `{name}[{}]`", names.join(", "));
                mistakes.push(Diagnostic::new(Kind::Syntax, part.origin, message).help(help));
                return None;
            }
            Some(Expr {
                kind: ExprKind::Name {
                    name: name.clone(),
                    index: None,
                },
                origin: part.origin,
            })
        }
        _ => Some(part.clone()),
    })
}

/// The expression with its leaves and sums replaced; all of them are looked at.
pub fn mapped(expr: &Expr, leaf: &mut dyn FnMut(&Expr) -> Option<Expr>) -> Option<Expr> {
    let mut operands = |operands: &[(bool, Expr)]| -> Option<Vec<(bool, Expr)>> {
        let all: Vec<_> = operands
            .iter()
            .map(|(inverse, operand)| Some((*inverse, mapped(operand, leaf)?)))
            .collect();
        all.into_iter().collect()
    };
    let kind = match &expr.kind {
        ExprKind::Number(_) | ExprKind::Name { .. } | ExprKind::IndexedSum { .. } => {
            return leaf(expr);
        }
        ExprKind::Sum(terms) => ExprKind::Sum(operands(terms)?),
        ExprKind::Product(factors) => ExprKind::Product(operands(factors)?),
        ExprKind::Negative(a) => ExprKind::Negative(Box::new(mapped(a, leaf)?)),
        ExprKind::Power(a, b) => {
            let (a, b) = (mapped(a, leaf), mapped(b, leaf));
            ExprKind::Power(Box::new(a?), Box::new(b?))
        }
        ExprKind::Call {
            function,
            arguments,
        } => {
            let all: Vec<_> = arguments.iter().map(|a| mapped(a, leaf)).collect();
            ExprKind::Call {
                function: function.clone(),
                arguments: all.into_iter().collect::<Option<_>>()?,
            }
        }
    };
    Some(Expr {
        kind,
        origin: expr.origin,
    })
}
