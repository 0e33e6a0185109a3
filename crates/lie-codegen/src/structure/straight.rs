//! Coordinates in which an elementwise bracket is constant.
//!
//! With `{x_i, x_j} = c_ij a_i(x_i) a_j(x_j)` and `y_i = int dx_i/a_i` the bracket is `{y_i, y_j} = c_ij`. There every Gauss method is a Poisson
//! map that keeps all linear Casimirs, and has its order; in x it is neither. Where `a_i = x_i + a` that is
//! `y_i = log(x_i + a)`, or `log(-x_i - a)` on the other side, which no motion leaves.

use super::elementwise::{at_start, elementwise};
use crate::model::Model;
use lie_symbolic::exact::Fraction;
use lie_symbolic::symbolic::{ExprId, Symbol};
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
    /// Where it is a logarithm, what of.
    pub logarithm: Option<Logarithm>,
    /// The initial value, where the system has one.
    pub initial: Option<String>,
}

/// A logarithm in the place of a coordinate x.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Logarithm {
    /// x as a function of it.
    pub back: String,
    /// `a(x)`: a force on it is one on x over this.
    pub speed: String,
}

/// Why there are none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// The bracket is constant as it is.
    Constant,
    /// It is none that a change of each coordinate alone makes constant.
    Other,
    /// A logarithm has no value at the initial state, for this coordinate.
    Zero(usize),
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
    let form = elementwise(model, &matrix, &mut graph).ok_or(Refusal::Other)?;
    if form.is_constant() {
        return Err(Refusal::Constant);
    }
    let mut taken = taken.clone();
    let name = |symbol| model.symbol_name(symbol);
    let mut coordinates = Vec::new();
    for (i, speed) in form.speeds.iter().enumerate() {
        let x = graph.symbol(Symbol::Coordinate(i));
        let given = model.initial.as_ref().map(|initial| initial[i]);
        let own = model.coordinates[i].text.clone();
        if speed.degree() == 0 || !form.moves(i) {
            coordinates.push(Coordinate {
                name: own,
                logarithm: None,
                initial: given.map(|value| model.display(value)),
            });
            continue;
        }
        let along = speed.at(x, &mut graph);
        let negative = match at_start(model, &graph, along) {
            Some(value) if value == 0.0 || value.is_nan() => return Err(Refusal::Zero(i)),
            Some(value) => value < 0.0,
            None => false,
        };
        let mut inside = |value: ExprId| {
            let inside = speed.at(value, &mut graph);
            let inside = if negative { graph.neg(inside) } else { inside };
            format!("log({})", graph.display(inside, &name))
        };
        let initial = given.map(&mut inside);
        let mut new = format!("log_{own}");
        while model.taken.contains(&new) || !taken.insert(new.clone()) {
            new.push('_');
        }
        let shift = added(&display(model, &speed.at_zero().neg()));
        let sign = if negative { "-" } else { "" };
        coordinates.push(Coordinate {
            logarithm: Some(Logarithm {
                back: format!("{sign}exp({new}){shift}"),
                speed: graph.display(along, &name),
            }),
            name: new,
            initial,
        });
    }
    let mut brackets = Vec::new();
    for (i, row) in form.constants.iter().enumerate() {
        for (j, value) in row.iter().enumerate().skip(i + 1) {
            if !value.is_zero() {
                let [x, y] = [i, j].map(|k| &coordinates[k].name);
                brackets.push(format!("{{{x}, {y}}} = {}", display(model, value)));
            }
        }
    }
    Ok(Straight {
        coordinates,
        brackets,
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
        let x = x.logarithm.as_ref().expect("a logarithm");
        assert_eq!((&*x.back, &*x.speed), ("-exp(log_x) + a", "x - a"));
        assert_eq!(y.initial.as_deref(), Some("log(a)"));
        assert_eq!((z.name.as_str(), &z.logarithm), ("z", &None));
    }

    #[test]
    fn others_have_a_reason() {
        let on_the_line = of(r#""{x, y} = x*y""#, "[0, 1, 1]");
        assert_eq!(on_the_line, Err(Refusal::Zero(0)));
        assert_eq!(of(r#""{x, y} = 3""#, "[0, 1, 1]"), Err(Refusal::Constant));
        let tangled = of(r#""{x, y} = 1 + x*y""#, "[0, 1, 1]");
        assert_eq!(tangled, Err(Refusal::Other));
    }
}
