//! Pairs and triples of declarations of every kind.

use super::*;
use crate::compile::compile_spec;
use crate::structure::Structure;
use serde_json::{Value, json};

fn system(keys: &Value) -> Structure {
    let mut spec = json!({ "format": 1, "name": "System", "hamiltonian": "0" });
    for (key, value) in keys.as_object().unwrap() {
        spec[key] = value.clone();
    }
    compile_spec(&spec.to_string()).unwrap_or_else(|mistakes| panic!("{mistakes:?}"))
}

/// Position, momentum, and their bracket.
fn pairs(keys: &Value) -> Vec<String> {
    let system = system(keys);
    let found = &system.directions;
    let name = |k: usize| name(&system, Symbol::Coordinate(k));
    let pairs = found.pairs.iter().map(|pair| {
        let (q, p) = (name(pair.position), name(pair.momentum));
        format!("{{{q}, {p}}} = {}", found.display(pair, &system))
    });
    pairs.collect()
}

#[test]
fn canonical_pairs_of_named_algebras() {
    for (algebra, expected) in [
        ("heisenberg(1)", &["{q, p} = -z"][..]),
        ("heisenberg(2)", &["{q1, p1} = -z", "{q2, p2} = -z"]),
        ("oscillator(1)", &["{q, p} = -z"]),
        ("diamond", &["{q, p} = -z"]),
        ("oscillator(2)", &["{q1, p1} = -z", "{q2, p2} = -z"]),
        ("heisenberg(1)^2", &["{q1, p1} = -z1", "{q2, p2} = -z2"]),
        ("bianchi(II)", &["{y, z} = -x"]),
        ("upper(3)", &["{m12, m23} = -m13"]),
        // a tower: the last row and column alone are canonical
        ("upper(4)", &["{m12, m24} = -m14", "{m13, m34} = -m14"]),
        // controls
        ("so(3)", &[]),
        ("se(3)", &[]),
        ("toda(3)", &[]),
        ("aff(1)", &[]),
        ("gl(2)", &[]),
    ] {
        assert_eq!(pairs(&json!({ "algebra": algebra })), expected, "{algebra}");
    }
    let family = json!({ "algebra": "heisenberg(1)^N", "parameters": { "N": 4 },
        "state": ["q[i]", "p[i]", "z[i]"], "hamiltonian": "sum(i in 0..N: p[i]^2)" });
    assert_eq!(pairs(&family), ["{q[i], p[i]} = -z[i]"]);
    let right = json!({ "algebra": "heisenberg(1)", "invariance": "right" });
    assert_eq!(pairs(&right), ["{q, p} = z"]);
}

#[test]
fn canonical_pairs_of_what_is_written_out() {
    let brackets = |basis: &[&str], brackets: &[&str], state: &[&str]| {
        let algebra = json!({ "basis": basis, "brackets": brackets });
        pairs(&json!({ "algebra": algebra, "state": state }))
    };
    let names = &["a", "b", "c", "d"];
    let factor = brackets(names, &["[a, b] = 2*c - 3*d"], &["p", "q", "u", "v"]);
    assert_eq!(factor, ["{q, p} = 2*u - 3*v"]);
    // a sum of elements is central of which none is
    let sum = brackets(
        &["a", "b", "c", "d", "n", "e", "f"],
        &["[a, b] = c + d", "[n, c] = e", "[n, d] = -e"],
        &["q", "p", "c", "d", "n", "e", "f"],
    );
    assert_eq!(sum, ["{q, p} = -c - d", "{c, n} = e", "{d, n} = -e"]);
    let general = |brackets: &[&str], state: &[&str]| {
        pairs(&json!({ "poisson": brackets, "state": state, "parameters": { "k": 1 } }))
    };
    assert_eq!(general(&["{q, p} = 1"], &["q", "p"]), ["{q, p} = 1"]);
    assert_eq!(general(&["{p, q} = 1"], &["p", "q"]), ["{q, p} = -1"]);
    assert_eq!(general(&["{q, p} = -k"], &["q", "p"]), ["{q, p} = -k"]);
    assert_eq!(
        general(&["{q, p} = exp(c)"], &["q", "p", "c"]),
        ["{q, p} = exp(c)"]
    );
    let sphere = [
        "{x, y} = z",
        "{y, z} = x",
        "{z, x} = y",
        "{q, p} = x^2 + y^2 + z^2",
    ];
    let all = ["x", "y", "z", "q", "p"];
    assert_eq!(general(&sphere, &all), ["{q, p} = x^2 + y^2 + z^2"]);
    assert_eq!(general(&["{x, y} = x*y"], &["x", "y"]), [""; 0]);
    let circulation = json!({ "algebra": "se(2)", "cocycle": ["{p1, p2} = -1/2"] });
    assert_eq!(pairs(&circulation), ["{p1, p2} = -1/2"]);
    let roles = |keys: &Value| system(keys).directions.pairs[0].roles;
    assert_eq!(roles(&circulation), Roles::Alike);
    assert_eq!(roles(&json!({ "algebra": "bianchi(II)" })), Roles::Order);
    assert_eq!(roles(&json!({ "algebra": "diamond" })), Roles::Names);
}

#[test]
fn what_carries_the_time_is_no_pair() {
    let driven = json!({ "algebra": "heisenberg(1)", "hamiltonian": "p^2/2 + cos(t)*q" });
    assert_eq!(pairs(&driven), ["{q, p} = -z"]);
    let driven = json!({ "algebra": "so(3)", "hamiltonian": "z*cos(t)" });
    assert_eq!(pairs(&driven), [""; 0]);
    assert_eq!(brackets(&system(&driven)).len(), 3);
}

#[test]
fn names_say_what_is_a_position() {
    for (position, momentum) in [
        ("q", "p"),
        ("q1", "p1"),
        ("x", "px"),
        ("x", "v"),
        ("phi", "L"),
        ("theta", "p_theta"),
        ("phi", "pphi"),
        ("Q", "P"),
        ("r", "pr"),
    ] {
        assert!(
            leaning(position) > leaning(momentum),
            "{position}, {momentum}"
        );
    }
    assert_eq!(leaning("p1"), leaning("p2"));
    assert_eq!(leaning("psi"), STRONG);
}

#[test]
fn vectors_that_turn() {
    let turns = |keys: Value| -> Vec<([usize; 3], i64)> {
        let found = system(&keys).directions.turns.clone();
        let turns = found.into_iter();
        turns
            .map(|turn| (turn.coordinates, turn.scale.to_integer().unwrap()))
            .collect()
    };
    let of = |algebra: &str| turns(json!({ "algebra": algebra }));
    assert_eq!(of("so(3)"), [([0, 1, 2], -1)]);
    assert_eq!(of("so(3)^2"), [([0, 1, 2], -1), ([3, 4, 5], -1)]);
    assert_eq!(of("se(3)"), [([0, 1, 2], -1)]);
    assert_eq!(of("so(3) + heisenberg(1)"), [([0, 1, 2], -1)]);
    assert!(of("so(4)").is_empty());
    assert!(of("sl(2)").is_empty());
    let right = json!({ "algebra": "so(3)", "invariance": "right" });
    assert_eq!(turns(right), [([0, 1, 2], 1)]);
    let spin = json!({ "state": ["x", "y", "z"], "poisson": ["{x, y} = 2*z", "{y, z} = 2*x", "{z, x} = 2*y"] });
    assert_eq!(turns(spin), [([0, 1, 2], 2)]);
}
