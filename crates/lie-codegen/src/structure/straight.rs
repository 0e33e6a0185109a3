//! Coordinates in which an elementwise bracket is constant, or one of pairs `{x, y} = 1/B(x, y)`.
//!
//! With `{x_i, x_j} = c_ij a_i(x_i) a_j(x_j)` and `y_i = int dx_i/a_i` the bracket is `{y_i, y_j} = c_ij`. There every Gauss method is a Poisson
//! map that keeps all linear Casimirs, and has its order; in x it is neither. Where `a_i = x_i + a` that is
//! `y_i = log(x_i + a)`, or `log(-x_i - a)` on the other side, which no motion leaves. Of a pair it is `Y = int B dy`, where y is a function of x
//! and Y in closed form, or else `X = int B dx`, where x is one of X and y.

use super::conjugate::inverse::inverse;
use super::conjugate::{Change, Form, conjugate};
use super::elementwise::{affine, at_start, elementwise};
use crate::model::Model;
use lie_symbolic::exact::{Fraction, Rational};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use std::collections::HashSet;

/// The coordinates, as they would be declared.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Straight {
    /// One for each of the system, in their order.
    pub coordinates: Vec<Coordinate>,
    /// The brackets that do not vanish.
    pub brackets: Vec<String>,
}

/// One of them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Coordinate {
    /// Its name: that of the system's where that stays.
    pub name: String,
    /// What it is a function of, where it is none that is declared.
    pub replaced: Option<Replaced>,
    /// The initial value, where the system has one.
    pub initial: Option<String>,
}

/// A logarithm or an integral in the place of a coordinate x.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Replaced {
    /// x as a function of it, and of coordinates that stay.
    pub back: String,
    /// A force on it is one on x over this, and
    pub speed: String,
    /// those on other coordinates times these.
    pub beside: Vec<(usize, String)>,
}

/// Why there are none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// The bracket is constant as it is.
    Constant,
    /// No coordinates are known in which it is constant.
    Other,
    /// A logarithm has no value at the initial state, for this coordinate, or an integral no inverse near it.
    Zero(usize),
    /// This coordinate has no closed form in terms of the integral that takes its place.
    NoInverse(usize),
}

/// The coordinates of a system, for states on the side of its initial one, under names that nothing has, nor are taken.
///
/// # Errors
/// Why there are none.
pub fn straight(model: &Model, taken: &HashSet<String>) -> Result<Straight, Refusal> {
    let others = model.family.is_some() || model.realization.is_some();
    if others || model.is_almost_poisson() {
        return Err(Refusal::Other);
    }
    let mut graph = model.graph.clone();
    let matrix = model.own_matrix().ok_or(Refusal::Other)?;
    let form = elementwise(model, &matrix, &mut graph);
    if form.is_some_and(|form| form.is_constant()) {
        return Err(Refusal::Constant);
    }
    let mut found = conjugate(model, &mut graph).ok_or(Refusal::Other)?;
    for change in &mut found.changes {
        if back(model, &mut graph, change).is_none() {
            let other = change.turned(model, &matrix, &mut graph);
            if let Some(other) = other.filter(|other| back(model, &mut graph, other).is_some()) {
                *change = other;
            }
        }
    }
    let mut taken = taken.clone();
    let mut coordinates = Vec::new();
    for i in 0..matrix.dimension {
        let mut changes = found.changes.iter();
        let coordinate = match changes.find(|change| change.coordinate == i) {
            Some(change) => match &change.form {
                Form::Logarithm(speed) => logarithm(model, &mut graph, i, speed, &mut taken)?,
                Form::Integral(_) | Form::Elementwise => {
                    integral(model, &mut graph, change, &mut taken)?
                }
            },
            None => Coordinate {
                name: model.coordinates[i].text.clone(),
                replaced: None,
                initial: initial(model, i).map(|value| model.display(value)),
            },
        };
        coordinates.push(coordinate);
    }
    let name = |symbol| model.symbol_name(symbol);
    let brackets = found.brackets.iter().map(|(i, j, value)| {
        let [x, y] = [*i, *j].map(|k| &coordinates[k].name);
        format!("{{{x}, {y}}} = {}", graph.display(*value, &name))
    });
    Ok(Straight {
        brackets: brackets.collect(),
        coordinates,
    })
}

fn initial(model: &Model, i: usize) -> Option<ExprId> {
    model.initial.as_ref().map(|initial| initial[i])
}

/// A name that nothing has, `log_x` or `int_x`.
fn fresh(model: &Model, prefix: &str, i: usize, taken: &mut HashSet<String>) -> String {
    let mut new = format!("{prefix}_{}", model.coordinates[i].text);
    while model.taken.contains(&new) || !taken.insert(new.clone()) {
        new.push('_');
    }
    new
}

/// `log |a(x)|` on the side of the initial state.
fn logarithm(
    model: &Model,
    graph: &mut Graph,
    i: usize,
    speed: &[Fraction; 2],
    taken: &mut HashSet<String>,
) -> Result<Coordinate, Refusal> {
    let name = |symbol| model.symbol_name(symbol);
    let x = graph.symbol(Symbol::Coordinate(i));
    let along = affine(speed, x, graph);
    let negative = match at_start(model, graph, along) {
        Some(value) if value == 0.0 || value.is_nan() => return Err(Refusal::Zero(i)),
        Some(value) => value < 0.0,
        None => false,
    };
    let initial = initial(model, i).map(|value| {
        let inside = affine(speed, value, graph);
        let inside = if negative { graph.neg(inside) } else { inside };
        format!("log({})", graph.display(inside, &name))
    });
    let new = fresh(model, "log", i, taken);
    let shift = added(&display(model, &speed[0].neg()));
    let sign = if negative { "-" } else { "" };
    Ok(Coordinate {
        replaced: Some(Replaced {
            back: format!("{sign}exp({new}){shift}"),
            speed: graph.display(along, &name),
            beside: Vec::new(),
        }),
        name: new,
        initial,
    })
}

/// The coordinate as a function of its change, [`Symbol::Input`], in closed form, on the side of the initial state.
fn back(model: &Model, graph: &mut Graph, change: &Change) -> Option<ExprId> {
    let w = graph.symbol(Symbol::Input(0));
    let start = |graph: &Graph, value: ExprId| at_start(model, graph, value);
    inverse(graph, change.value, change.coordinate, w, &start)
}

/// `int B dy`, where y is a function of it in closed form, on the side of the initial state.
fn integral(
    model: &Model,
    graph: &mut Graph,
    change: &Change,
    taken: &mut HashSet<String>,
) -> Result<Coordinate, Refusal> {
    let i = change.coordinate;
    if at_start(model, graph, change.slope).is_some_and(|slope| slope == 0.0 || slope.is_nan()) {
        return Err(Refusal::Zero(i));
    }
    let back = back(model, graph, change).ok_or(Refusal::NoInverse(i))?;
    let new = fresh(model, "int", i, taken);
    let name = |symbol| match symbol {
        Symbol::Input(_) => new.clone(),
        other => model.symbol_name(other),
    };
    let initial = model.initial.as_ref().map(|initial| {
        let at = |symbol| match symbol {
            Symbol::Coordinate(k) => initial.get(k).copied(),
            _ => None,
        };
        let value = graph.substitute(&[change.value], &at)[0];
        graph.display(value, &name)
    });
    let speed = graph.pow(change.slope, &Rational::from(-1));
    let beside = change.beside.iter();
    let beside = beside.map(|(k, slope)| (*k, graph.display(*slope, &name)));
    Ok(Coordinate {
        replaced: Some(Replaced {
            back: graph.display(back, &name),
            speed: graph.display(speed, &name),
            beside: beside.collect(),
        }),
        name: new.clone(),
        initial,
    })
}

fn display(model: &Model, value: &Fraction) -> String {
    value.display(&|p| model.parameters[p].name.clone())
}

/// A term at the end of a sum.
fn added(term: &str) -> String {
    match term.strip_prefix('-') {
        _ if term == "0" => String::new(),
        _ if term.contains(' ') => format!(" + ({term})"),
        Some(size) => format!(" - {size}"),
        None => format!(" + {term}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile::compile_spec;

    fn of(brackets: &str, initial: &str) -> Result<Straight, Refusal> {
        let spec = format!(
            r#"{{"format": 1, "name": "Bracket", "state": ["x", "y", "z"], "poisson": [{brackets}], "hamiltonian": "x^2",
                "parameters": {{"a": {{"default": 2, "exact": true}}}}, "initial": {initial}}}"#
        );
        let taken = HashSet::from(["log_y".to_owned()]);
        straight(
            &compile_spec(&spec).expect("a spec without mistakes"),
            &taken,
        )
    }

    #[test]
    fn logarithms_are_of_the_side_of_the_initial_state() {
        let bracket = r#""{x, y} = 2*(x - a)*y", "{y, z} = a*y""#;
        let found = of(bracket, r#"["1", "a", "3"]"#).expect("coordinates");
        assert_eq!(found.brackets, ["{log_x, log_y_} = 2", "{log_y_, z} = a"]);
        let [x, y, z] = &found.coordinates[..] else {
            panic!("{found:?}");
        };
        assert_eq!(x.initial.as_deref(), Some("log(a - 1)"));
        let x = x.replaced.as_ref().expect("a logarithm");
        assert_eq!((&*x.back, &*x.speed), ("-exp(log_x) + a", "x - a"));
        assert_eq!(y.initial.as_deref(), Some("log(a)"));
        assert_eq!((z.name.as_str(), &z.replaced), ("z", &None));
    }

    /// The inverse at values: it is x again, on the side of the initial state, wherever that is.
    #[test]
    fn integrals_have_their_inverse() {
        let found = of(r#""{x, y} = 2*a*exp(1 - y/2)/(1 + z^2)""#, "[0, 1, 1]");
        let found = found.expect("coordinates");
        assert_eq!(found.brackets, ["{x, int_y} = a"]);
        for (bracket, initial, back, beside) in [
            ("1/(1 + x^2)", "[0, 1, 1]", "int_y/(x^2 + 1)", "2*x*y"),
            ("1/y", "[0, -1, 1]", "-sqrt(2*int_y)", ""),
            ("1/(2*y + 1)^2", "[0, 1, 1]", "", ""),
        ] {
            let found = of(&format!("\"{{x, y}} = {bracket}\""), initial);
            let found = found.expect("coordinates");
            let y = found.coordinates[1].replaced.as_ref().expect("an integral");
            assert!(back.is_empty() || y.back == back, "{bracket}: {y:?}");
            let slopes: Vec<&str> = y.beside.iter().map(|(_, slope)| slope.as_str()).collect();
            assert_eq!(slopes.concat(), beside, "{bracket}");
        }
    }

    /// Of degree three in y, which stays, and of degree two or an exponential in x, which is replaced.
    #[test]
    fn the_other_coordinate_is_replaced_where_only_it_has_an_inverse() {
        for (bracket, initial, is_root) in [
            ("1/(1 + x + y^2)", "[0, 1, 1]", true),
            ("-a*exp(-x)/(2 + y + y^3)", "[0, 1, 1]", false),
        ] {
            let found = of(&format!("\"{{x, y}} = {bracket}\""), initial).expect("coordinates");
            let [x, y, _] = &found.coordinates[..] else {
                panic!("{found:?}");
            };
            assert!(found.brackets[0].starts_with("{int_x, y} = "), "{found:?}");
            assert_eq!((y.name.as_str(), &y.replaced), ("y", &None), "{bracket}");
            let x = x.replaced.as_ref().expect("an integral");
            assert_eq!(x.back.contains("sqrt("), is_root, "{}", x.back);
            assert_eq!(x.beside.len(), 1, "{x:?}");
        }
        // of both roles the declared one, where it has an inverse
        let found = of(r#""{x, y} = 1/(1 + x^2)""#, "[0, 1, 1]").expect("coordinates");
        assert_eq!(found.brackets, ["{x, int_y} = 1"]);
    }

    #[test]
    fn others_have_a_reason() {
        let on_the_line = of(r#""{x, y} = x*y""#, "[0, 1, 1]");
        assert_eq!(on_the_line, Err(Refusal::Zero(0)));
        assert_eq!(of(r#""{x, y} = 3""#, "[0, 1, 1]"), Err(Refusal::Constant));
        let tangled = of(r#""{x, y} = 1 + x*y""#, "[0, 1, 1]");
        assert_eq!(tangled, Err(Refusal::Other));
        let of_degree_three = of(r#""{x, y} = 1/(1 + x^2 + y^2)""#, "[0, 1, 1]");
        assert_eq!(of_degree_three, Err(Refusal::NoInverse(1)));
    }
}
