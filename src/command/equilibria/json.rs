//! What was found, for programs.

use lie_equilibria::{Equations, Equilibrium, LowRank, Presence, Reason, c64};
use lie_in_process::words::number;
use serde_json::{Value, json};

use super::words::{change, word};
use super::{Leaf, Range};

fn numbers(values: &[f64]) -> Vec<Value> {
    values.iter().map(|value| number(*value)).collect()
}

/// The names of coordinates and Casimirs, and the dimension of the leaf.
fn head(name: &str, equations: &Equations) -> Value {
    let casimirs = equations.system.casimirs.iter();
    let casimirs: Vec<&str> = casimirs.map(|casimir| casimir.name.as_str()).collect();
    json!({
        "system": name,
        "coordinates": equations.system.coordinates,
        "casimirs": casimirs,
        "leaf_dimension": equations.sizes.n - equations.sizes.m,
    })
}

/// The equilibria of a leaf.
pub fn leaf(name: &str, equations: &Equations, leaf: &Leaf) -> Value {
    let mut value = head(name, equations);
    value["casimir_values"] = numbers(&leaf.levels).into();
    value["starts"] = leaf.found.starts.into();
    value["converged"] = leaf.found.converged.into();
    value["paths"] = match leaf.found.paths {
        None => Value::Null,
        Some(paths) => json!({
            "all": paths.all,
            "isolated": paths.isolated,
            "real": paths.real,
            "singular": paths.singular,
            "infinite": paths.infinite,
            "lost": paths.lost,
        }),
    };
    value["equilibria"] = leaf.equilibria.iter().map(equilibrium).collect();
    value["lower_rank"] = leaf.low_rank.iter().map(low_rank).collect();
    value
}

/// A state at rest where the rank of the bracket drops.
fn low_rank(one: &LowRank) -> Value {
    json!({
        "state": numbers(&one.state),
        "uncertainty": number(one.error),
        "energy": number(one.energy),
        "rank": one.rank,
        "independent_casimirs": one.gradients,
        "family_dimension": one.family,
        "degenerate": one.degenerate,
        "found": one.hits,
        "eigenvalues": spectrum(&one.eigenvalues),
        "stability": word(one.judgement.stability),
        "proven": one.judgement.proven,
        "reason": reason(&one.judgement.reason),
    })
}

fn spectrum(values: &[c64]) -> Vec<Value> {
    values.iter().map(|z| json!([z.re, z.im])).collect()
}

fn equilibrium(one: &Equilibrium) -> Value {
    let linear = &one.linearisation;
    let exact = match &one.presence {
        Presence::Rational(state) => state.iter().map(ToString::to_string).collect(),
        _ => Value::Null,
    };
    json!({
        "state": numbers(&one.state),
        "exact_state": exact,
        "multipliers": numbers(&one.multipliers),
        "energy": number(one.energy),
        "uncertainty": number(one.error),
        "family_dimension": one.family,
        "degenerate": one.degenerate,
        "other_leaf": one.on_other_leaf,
        "found": one.hits,
        "existence": match one.presence {
            Presence::Rational(_) => "rational",
            Presence::Enclosed => "enclosed",
            Presence::Numerical => "numerical",
        },
        "eigenvalues": spectrum(&linear.eigenvalues),
        "zero_eigenvalues": linear.zeros,
        "hessian_signs": [linear.inertia.positive, linear.inertia.negative, linear.inertia.zero],
        "stability": word(one.judgement.stability),
        "proven": one.judgement.proven,
        "reason": reason(&one.judgement.reason),
    })
}

fn reason(reason: &Reason) -> Value {
    match reason {
        Reason::Definite { minimum } => {
            json!({ "kind": if *minimum { "minimum" } else { "maximum" } })
        }
        Reason::Integrals {
            energy,
            stationary,
            held,
        } => {
            let weights: serde_json::Map<String, Value> = stationary
                .iter()
                .map(|(name, weight)| (name.clone(), number(*weight)))
                .collect();
            json!({ "kind": "integrals", "energy": number(*energy), "integrals": weights, "held": held })
        }
        Reason::Right => json!({ "kind": "positive real part" }),
        Reason::Attracting => json!({ "kind": "negative real parts" }),
        Reason::NoneRight => json!({ "kind": "no positive real part" }),
        Reason::Degenerate => json!({ "kind": "degenerate" }),
        Reason::Imaginary { simple } => json!({ "kind": "imaginary", "simple": simple }),
    }
}

/// The branches over a range: their points at its values, and where they change.
pub fn range(name: &str, equations: &Equations, range: &Range) -> Value {
    let n = equations.sizes.n;
    let branch = |branch: &lie_equilibria::Branch| {
        let points = branch.points.iter().filter(|point| point.grid.is_some());
        let points = points.map(|point| {
            json!({
                "value": point.parameter,
                "state": numbers(&point.y[..n]),
                "multipliers": numbers(&point.y[n..]),
                "energy": number(point.energy),
                "growth": number(point.growth),
                "stability": word(point.stability),
                "threshold": point.threshold.map(change),
            })
        });
        let changes = branch.changes.iter().map(|found| {
            json!({
                "value": found.parameter,
                "error": number(found.error),
                "kind": change(found.kind),
                "from": word(found.stability[0]),
                "to": word(found.stability[1]),
                "state": numbers(&found.y[..n]),
                "energy": number(found.energy),
            })
        });
        json!({
            "family_dimension": branch.family,
            "points": points.collect::<Vec<_>>(),
            "changes": changes.collect::<Vec<_>>(),
        })
    };
    let mut value = head(name, equations);
    value["parameter"] = range.name.clone().into();
    value["values"] = numbers(&range.values).into();
    value["searched_at"] = numbers(&range.traced.nodes).into();
    value["branches"] = range.traced.branches.iter().map(branch).collect();
    value
}
