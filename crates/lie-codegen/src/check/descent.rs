//! Whether Gauss methods over a realization of degree two descend, decided exactly.
//!
//! The coefficients are rational functions of the parameters. The closure is found at points where these are
//! integers, as ranks are: what holds for all parameters holds there, and what does not fails at almost every point.

use crate::algebra::quadratic::{Closure, Form, closure};
use crate::model::{CANONICAL, Descent};
use lie_symbolic::exact::{Budget, Rational};
use lie_symbolic::prove::sample::Samples;
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};

/// Work allowed for the closure at one point.
const WORK: u64 = 20_000_000;
/// Points of the parameters, and points that are tried where a coefficient has a pole.
const POINTS: usize = 2;
const TRIES: usize = 8;

/// A component of a realization, of degree two: its value, its derivatives, and their derivatives row by row.
pub(super) struct Component {
    pub value: ExprId,
    pub slopes: Vec<ExprId>,
    pub seconds: Vec<ExprId>,
}

/// Whether Gauss methods descend, for components that are functions of so many canonical coordinates.
pub(super) fn descent(graph: &Graph, components: &[Component], points: usize) -> Descent {
    let mut found = 0;
    let mut commuting = false;
    for sample in Samples::new().take(TRIES) {
        let value = |symbol| Some(sample.integer(graph, symbol));
        let forms: Option<Vec<Form>> = components
            .iter()
            .map(|component| form(graph, component, points, &value))
            .collect();
        let Some(forms) = forms else { continue };
        match closure(&forms, &Budget::new(WORK)) {
            Err(_) => return Descent::Unknown,
            Ok(Closure::Others) => return Descent::Adds { commuting: false },
            Ok(Closure::Commuting) => commuting = true,
            Ok(Closure::Nothing) => {}
        }
        found += 1;
        if found == POINTS {
            break;
        }
    }
    match (found, commuting) {
        (0, _) => Descent::Unknown,
        (_, true) => Descent::Adds { commuting },
        (_, false) => Descent::Closed,
    }
}

/// The form of a component in `(1, z)`, from its value and derivatives at one point.
fn form(
    graph: &Graph,
    component: &Component,
    points: usize,
    value: &dyn Fn(Symbol) -> Option<Rational>,
) -> Option<Form> {
    let exact = |roots: &[ExprId]| graph.evaluate_exactly(roots, value);
    let seconds = exact(&component.seconds)?;
    let slopes = exact(&component.slopes)?;
    let at_point = exact(&[component.value])?.pop()?;
    let z: Vec<Rational> = (0..points)
        .map(|i| value(Symbol::Input(CANONICAL + i)))
        .collect::<Option<_>>()?;
    let mut form = vec![vec![Rational::ZERO; points + 1]; points + 1];
    // twice J(0) = J(z) - J'(z) z + z J'' z / 2
    let mut constant = at_point.clone();
    for i in 0..points {
        let mut slope = slopes[i].clone();
        for j in 0..points {
            let second = &seconds[i * points + j];
            slope = &slope - &(second * &z[j]);
            form[i + 1][j + 1] = second.clone();
        }
        // J'(z) z = J'(0) z + z J'' z, and z J'' z / 2 is the mean of both terms that follow
        let half = &Rational::ONE / &Rational::from(2);
        let mean = &(&slopes[i] + &slope) * &half;
        constant = &constant - &(&mean * &z[i]);
        form[0][i + 1] = slope.clone();
        form[i + 1][0] = slope;
    }
    form[0][0] = &constant + &constant;
    Some(form)
}
