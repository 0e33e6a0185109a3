//! Defaults of parameters: constants, finite in double precision, rational where they are exact.

use super::environment::{Allowed, Binding, Environment};
use super::lower::Lowering;
use crate::model::Parameter;
use lie_symbolic::prove::sign;
use lie_symbolic::symbolic::Graph;
use lie_syntax::ast::Declaration;
use lie_syntax::diagnostic::{Diagnostic, Kind};

/// Lowers the defaults.
pub fn parameter_defaults(
    declaration: &Declaration,
    graph: &mut Graph,
    environment: &Environment<'_>,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<Vec<Parameter>> {
    let lowered = declaration.parameters.iter().map(|parameter| {
        let (place, name) = (parameter.default.origin, &parameter.name.text);
        let default = Lowering::new(graph, environment, mistakes, Allowed::Constants)
            .lower(&parameter.default)?;
        let default_value = graph.evaluate(default, &|_| f64::NAN);
        let rational = graph.as_number(default).cloned();
        let mut refuse = |message: String, help: &str| {
            mistakes.push(Diagnostic::new(Kind::Number, place, message).help(help));
            None
        };
        if !default_value.is_finite() {
            let message = format!("the default of `{name}` is not finite in double precision");
            return refuse(message, "choose another default or other units");
        }
        if parameter.positive {
            if sign::constant(graph, default) != Some(1) {
                let message =
                    format!("the default of the positive parameter `{name}` is not positive");
                return refuse(
                    message,
                    "choose another default, or do not declare it positive",
                );
            }
            if let Some(Binding::Symbol(symbol)) = environment.get(name) {
                graph.assume_positive(symbol);
            }
        }
        if parameter.exact && rational.is_none() {
            let message = format!("the default of the exact parameter `{name}` is not rational");
            let help =
                "brackets and matrices are checked over the rationals; write a rational default, such as 1/3";
            return refuse(message, help);
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
    });
    let lowered: Vec<Option<Parameter>> = lowered.collect();
    lowered.into_iter().collect()
}
