//! Defaults of parameters: constants, finite in double precision, rational where they are exact.

use super::environment::{Allowed, Binding, Environment};
use super::lower::Lowering;
use crate::model::Parameter;
use lie_symbolic::prove::sign;
use lie_symbolic::symbolic::Graph;
use lie_syntax::ast::Declaration;
use lie_syntax::diagnostic::{Diagnostic, Kind, Report};

/// Lowers the defaults.
pub fn check(
    declaration: &Declaration,
    graph: &mut Graph,
    environment: &Environment<'_>,
    report: &mut Report,
) -> Option<Vec<Parameter>> {
    let lowered: Vec<Option<Parameter>> = declaration
        .parameters
        .iter()
        .map(|parameter| {
            let place = parameter.default.origin;
            let default = Lowering::new(graph, environment, report, Allowed::Constants).lower(&parameter.default)?;
            let default_value = graph.evaluate(default, &|_| f64::NAN);
            let name = &parameter.name.text;
            if !default_value.is_finite() {
                report.push(Diagnostic::new(Kind::Number, place, format!("the default of `{name}` is not finite in double precision")).help("choose another default or other units"));
                return None;
            }
            if parameter.positive {
                if sign::constant(graph, default) != Some(1) {
                    report.push(
                        Diagnostic::new(Kind::Number, place, format!("the default of the positive parameter `{name}` is not positive"))
                            .help("choose another default, or do not declare it positive"),
                    );
                    return None;
                }
                let position = environment.get(name);
                if let Some(Binding::Symbol(symbol)) = position {
                    graph.assume_positive(symbol);
                }
            }
            let rational = graph.as_number(default).cloned();
            if parameter.exact && rational.is_none() {
                report.push(
                    Diagnostic::new(Kind::Number, place, format!("the default of the exact parameter `{name}` is not rational"))
                        .help("brackets are checked over the rationals; write a rational default, such as 1/3"),
                );
                return None;
            }
            Some(Parameter {
                name: name.clone(),
                origin: parameter.name.origin,
                default,
                default_value,
                exact: rational.filter(|_| parameter.exact),
                positive: parameter.positive,
                unit: parameter.unit.clone(),
                description: parameter.description.clone(),
            })
        })
        .collect();
    lowered.into_iter().collect()
}
