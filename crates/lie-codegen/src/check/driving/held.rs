//! What is held from step to step.

use super::*;
use crate::model::configuration::WIENER;

/// What is held from step to step: inputs with their defaults, then the rates of Wiener processes.
pub fn held(declaration: &Declaration, mistakes: &mut Vec<Diagnostic>) -> Vec<(String, Rational)> {
    let mut held = defaults(declaration, mistakes);
    let own = declaration.dimension();
    let warm = declaration
        .dissipation
        .iter()
        .filter(|d| d.temperature.is_some());
    let count = declaration.noise.len() + own * warm.count();
    let count = with_coin(count);
    held.extend((1..=count).map(|k| (format!("{WIENER}{k}"), Rational::ZERO)));
    held
}

/// The inputs with their defaults; wrong ones, and wrong times of sampling, are reported.
pub fn defaults(
    declaration: &Declaration,
    mistakes: &mut Vec<Diagnostic>,
) -> Vec<(String, Rational)> {
    let mut held = Vec::new();
    for input in &declaration.inputs {
        let default = match &input.default.kind {
            ExprKind::Number(value) => Ok(value.clone()),
            _ => constant_value(&input.default)
                .map(|value| Rational::from_f64(value).unwrap_or(Rational::ZERO)),
        };
        match default {
            Ok(default) => held.push((input.name.text.clone(), default)),
            Err(wrong) => mistakes.extend(wrong),
        }
        let sampling = input
            .sampling
            .as_ref()
            .map(|value| (value.origin, constant_value(value)));
        match sampling {
            Some((origin, Ok(value))) if !(value > 0.0 && value.is_finite()) => {
                let message = format!("`{}` is sampled every {value}", input.name.text);
                let help = "write a time that is positive, or leave `sampling` out to sample before every step";
                mistakes.push(Diagnostic::new(Kind::Input, origin, message).help(help));
            }
            Some((_, Err(wrong))) => mistakes.extend(wrong),
            _ => {}
        }
    }
    held
}

/// So many Wiener processes with the one whose sign is a coin, which several processes have.
pub fn with_coin(processes: usize) -> usize {
    processes + usize::from(processes > 1)
}

/// The inputs of a declaration that passed its checks.
pub fn inputs(declaration: &Declaration) -> Vec<Input> {
    let value = |expr: &Expr| constant_value(expr).unwrap_or(f64::NAN);
    let inputs = declaration.inputs.iter();
    inputs
        .map(|input| Input {
            name: input.name.text.clone(),
            default: value(&input.default),
            sampling: input.sampling.as_ref().map(value),
        })
        .collect()
}
