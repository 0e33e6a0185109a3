//! Forces and dissipation: what is refused, and what the equations are.

use super::*;
use crate::derive::Source;
use lie_symbolic::exact::Budget;
use lie_symbolic::prove::proof::Prover;

const RAYLEIGH: &str = r#"[{"kind": "rayleigh", "matrix": [[1, 0, 0], [0, "1/2", 0], [0, 0, 0]]}]"#;

fn metriplectic(entropy: &str, metric: &str) -> String {
    so3(&[(
        "dissipation",
        &format!(r#"[{{"kind": "metriplectic", "entropy": "{entropy}", {metric}}}]"#),
    )])
}

/// `|grad H|^2 1 - grad H grad H^T` of `H = x^2 + 2 y^2`.
const DEGENERATE: &str =
    r#""metric": [["16*y^2", "-8*x*y", 0], ["-8*x*y", "4*x^2", 0], [0, 0, "4*x^2 + 16*y^2"]]"#;

#[test]
fn the_field_has_the_force_and_its_power() {
    let model = model(&so3(&[
        ("forces", r#"{"x": "-x/2 + cos(t)", "z": "3"}"#),
        ("casimirs", r#"["C = x^2 + y^2 + z^2"]"#),
    ]));
    let mut source = Source::new(&model);
    let field = source.field();
    // x, y, z, p, t, 1
    let at = [0.5, 0.25, 2.0, 0.0, 0.0, 1.0];
    let value = |id| {
        source.graph.evaluate(id, &|symbol| match symbol {
            Symbol::Coordinate(i) => at[i],
            other => panic!("{other:?}"),
        })
    };
    let values: Vec<f64> = field.iter().map(|id| value(*id)).collect();
    // mu x grad H with grad H = (1, 1, 0), and F = (3/4, 0, 3)
    assert_eq!(values[..3], [-2.0 + 0.75, 2.0, 0.25 + 3.0]);
    // p' = -<F, grad H>, t' = 1
    assert_eq!(values[3..], [-0.75, 1.0, 0.0]);
    assert!(!model.casimirs[0].kept);
}

#[test]
fn a_double_bracket_stays_on_the_orbit_and_takes_energy() {
    let model = model(&so3(&[
        (
            "dissipation",
            r#"[{"kind": "double-bracket", "strength": "1/2"}]"#,
        ),
        ("casimirs", r#"["C = x^2 + y^2 + z^2"]"#),
    ]));
    let mut source = Source::new(&model);
    let field = source.field();
    let at = [0.5, 0.25, 2.0, 0.0, 0.0, 1.0];
    let values: Vec<f64> = field
        .iter()
        .map(|id| {
            source.graph.evaluate(*id, &|symbol| match symbol {
                Symbol::Coordinate(i) => at[i],
                other => panic!("{other:?}"),
            })
        })
        .collect();
    let dot = |a: &[f64]| a.iter().zip(at).map(|(a, b)| a * b).sum::<f64>();
    assert!(dot(&values[..3]).abs() < 1e-15);
    // H' = -c |mu x grad H|^2
    let v = [-2.0, 2.0, 0.25_f64];
    let power = -0.5 * v.iter().map(|v| v * v).sum::<f64>();
    assert!((values[0] + values[1] - power).abs() < 1e-15);
    assert!((values[3] + power).abs() < 1e-15);
    assert!(model.casimirs[0].kept);
}

#[test]
fn an_entropy_grows_and_the_energy_stays() {
    for metric in [
        DEGENERATE,
        r#""factor": [["4*y", 0], ["-2*x", 0], [0, "0"]]"#,
    ] {
        let model = model(&metriplectic("x^2 + y^2 + z^2", metric));
        let mut source = Source::new(&model);
        let field = source.field();
        let name = |symbol| model.symbol_name(symbol);
        let budget = Budget::new(1_000_000);
        let mut prover = Prover::new(&source.graph, &budget, &[], &name);
        assert!(prover.vanishes(field[3]), "H is constant");
        assert!(!prover.vanishes(field[2]), "and something acts");
    }
}

#[test]
fn what_a_metric_must_hold_is_proven() {
    // the entropy is none of the Hamiltonian motion
    expect(
        &metriplectic("x^2", DEGENERATE),
        &["dissipation at metriplectic: the entropy is no first integral"],
    );
    // it takes energy
    let identity = r#""metric": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]"#;
    expect(
        &metriplectic("x^2 + y^2 + z^2", identity),
        &["dissipation at metriplectic: the metric does not keep H"],
    );
    // it has a negative eigenvalue
    let negative = DEGENERATE.replace("\"4*x^2 + 16*y^2\"", "\"-x^2\"");
    expect(
        &metriplectic("x^2 + y^2 + z^2", &negative),
        &["dissipation at metriplectic: it could not be shown that the metric K"],
    );
    // it is not symmetric: K grad H = 0 all the same
    let bent = r#""metric": [[0, 0, 0], [0, 0, 0], ["2*y", "-x", 0]]"#;
    expect(
        &metriplectic("x^2 + y^2 + z^2", bent),
        &["dissipation at metriplectic: the metric K is not symmetric"],
    );
}

#[test]
fn what_is_malformed_is_said_at_its_place() {
    let forces = |value: &str| so3(&[("forces", value)]);
    expect(
        &forces(r#"{"w": "1"}"#),
        &["unknown-symbol at w: `w` is no coordinate"],
    );
    expect(
        &forces(r#"{"x": "k"}"#),
        &["unknown-symbol at k: unknown symbol `k`"],
    );
    expect(
        &forces(r#"{"x": ""}"#),
        &["syntax at \"\": a force is missing"],
    );
    let dissipation = |value: &str| so3(&[("dissipation", value)]);
    expect(
        &dissipation(r#"[{"kind": "gilbert"}]"#),
        &["schema at gilbert: unknown kind of dissipation `gilbert`"],
    );
    expect(
        &dissipation(r#"[{"kind": "rayleigh"}]"#),
        &["schema at rayleigh: `rayleigh` has no `matrix`"],
    );
    expect(
        &dissipation(r#"[{"kind": "rayleigh", "matrix": [[1]]}]"#),
        &["dissipation at rayleigh: the matrix R has 1 rows of 1, but there are 3 coordinates"],
    );
    expect(
        &dissipation(r#"[{"kind": "rayleigh", "matrix": [[1, 0, 0], [0, -1, 0], [0, 0, 1]]}]"#),
        &["dissipation at rayleigh: the matrix R has a negative eigenvalue"],
    );
    expect(
        &dissipation(r#"[{"kind": "double-bracket", "strength": -1}]"#),
        &["dissipation at double-bracket: the strength is -1"],
    );
    expect(
        &dissipation(r#"[{"kind": "double-bracket", "strength": "x"}]"#),
        &["unknown-symbol at x: `x` cannot stand here"],
    );
}

#[test]
fn a_vector_stands_for_its_coordinates() {
    let vectors = ("vectors", r#"{"m": ["x", "y", "z"], "d": [0, 0, 1]}"#);
    let model = model(&so3(&[
        vectors,
        ("forces", r#"{"m": "cross(m, d) - 2*m"}"#),
    ]));
    let driving = model.driving.as_ref().expect("forces");
    let shown: Vec<String> = driving
        .force
        .iter()
        .take(3)
        .map(|f| model.display(*f))
        .collect();
    assert_eq!(shown, ["-2*x + y", "-x - 2*y", "-2*z"]);
    expect(
        &so3(&[vectors, ("forces", r#"{"m": "2"}"#)]),
        &["unknown-symbol at m: `m` has 3 entries, and the force on it has another shape"],
    );
    expect(
        &so3(&[vectors, ("forces", r#"{"m": "d", "z": "1"}"#)]),
        &["duplicate-name at z: the force on `z` stands twice"],
    );
}

#[test]
fn methods_of_the_hamiltonian_alone_are_refused_with_the_reason() {
    use crate::methods::{Choice, refusal};
    let model = model(&so3(&[("dissipation", RAYLEIGH)]));
    let why = |id: &str| {
        Choice::from_id(id)
            .ok()
            .and_then(|choice| refusal(&model, &choice))
    };
    assert!(why("gauss16").is_none());
    assert!(why("compose4(midpoint)").is_none());
    assert!(why("splitting2").is_none());
    let (reason, _) = why("generating4").expect("a reason");
    assert!(reason.contains("beside the Hamiltonian"), "{reason}");
}

/// What acts is a piece of a splitting where its flow is known, which is proven, and refused with the term for which it is not.
#[test]
fn splittings_take_what_has_a_flow() {
    use crate::methods::{Choice, refusal};
    let why = |spec: &str, id: &str| {
        let choice = Choice::from_id(id).expect("a method");
        refusal(&model(spec), &choice).map_or(String::new(), |(reason, _)| reason)
    };
    for (key, value) in [
        ("forces", r#"{"x": "-x/2", "z": "cos(t)*(1 - z)"}"#),
        // linear once it is multiplied out
        ("forces", r#"{"y": "(y - 1)^2 - y*(y + 3)"}"#),
        (
            "noise",
            r#"[{"hamiltonian": "x - 2*z"}, {"force": {"y": "cos(t)"}}]"#,
        ),
    ] {
        let spec = so3(&[(key, value)]);
        for id in ["splitting2", "splitting6", "compose4(splitting2)"] {
            assert_eq!(why(&spec, id), "", "{value}");
        }
    }
    for (key, value, reason) in [
        (
            "forces",
            r#"{"x": "-x^3"}"#,
            "on `x` it is not linear in `x`",
        ),
        (
            "forces",
            r#"{"x": "-y*z"}"#,
            "on `x` it is not linear in `y`",
        ),
        (
            "forces",
            r#"{"x": "-max(y, 0)"}"#,
            "on `x` it is not linear in `y`",
        ),
        (
            "noise",
            r#"[{"hamiltonian": "x^2"}]"#,
            "its direction depends on `x`",
        ),
        (
            "noise",
            r#"[{"force": {"y": "z"}}]"#,
            "its direction depends on `z`",
        ),
        (
            "dissipation",
            r#"[{"kind": "double-bracket", "strength": 1}]"#,
            "a double bracket damps",
        ),
    ] {
        let spec = so3(&[(key, value)]);
        let found = why(&spec, "splitting2");
        assert!(found.contains(reason), "{value}: {found}");
    }
    let mixing = so3(&[("forces", r#"{"x": "-y - x/2", "y": "2 - t*z"}"#)]);
    assert_eq!(why(&mixing, "splitting2"), "");
    let free = so3(&[]);
    assert!(why(&free, "ninomiya-victoir").contains("the method is for noise"));
    let warm = so3(&[(
        "dissipation",
        r#"[{"kind": "double-bracket", "strength": 1, "temperature": "1/2"}]"#,
    )]);
    assert_eq!(why(&warm, "ninomiya-victoir"), "");
    assert!(why(&warm, "splitting2").contains("a double bracket damps"));
}

/// What is refused names what was declared: noise is no double bracket, and forces are not the time.
#[test]
fn refusals_name_what_was_declared() {
    use crate::methods::{Choice, refusal};
    let why = |extra: &[(&str, &str)], id: &str| {
        let choice = Choice::from_id(id).expect("a method");
        refusal(&model(&so3(extra)), &choice).expect("a refusal")
    };
    let noise = ("noise", r#"[{"hamiltonian": "x"}]"#);
    let warm = r#"[{"kind": "double-bracket", "strength": 1, "temperature": "1/2"}]"#;
    let (found, help) = why(&[noise], "generating2");
    assert!(found.starts_with("noise moves along the orbit"), "{found}");
    assert!(help.ends_with("leave `noise` out"), "{help}");
    let (found, help) = why(&[("dissipation", warm)], "generating2");
    assert!(found.starts_with("a double bracket damps"), "{found}");
    assert!(help.ends_with("leave `dissipation` out"), "{help}");
    let timed = ("hamiltonian", r#""x^2 + t*z""#);
    let input = ("inputs", r#"{"u": {"default": 0}}"#);
    for (extra, parts) in [
        (&[timed][..], "the time makes"),
        (&[noise], "noise makes"),
        (&[noise, timed], "the time and noise make"),
        (&[("forces", r#"{"x": "-x"}"#)], "forces make"),
        (
            &[("forces", r#"{"x": "-t*x"}"#)],
            "the time and forces make",
        ),
        (&[input, noise], "inputs and noise make"),
        (
            &[("dissipation", warm)],
            "dissipation and its temperature make",
        ),
    ] {
        let known = format!("it is for the declared algebra alone, and {parts} that larger");
        let found = model(&so3(extra)).why_not_declared_algebra();
        assert_eq!(found, Some(known), "{extra:?}");
    }
    let (found, _) = why(&[timed], "moser-veselov");
    assert!(found.contains("the time makes that larger"), "{found}");
    // spins keep their lengths under noise
    let spheres = Choice::SphericalMidpoint;
    assert_eq!(refusal(&model(&so3(&[noise])), &spheres), None);
    assert_eq!(model(&so3(&[])).why_not_declared_algebra(), None);
}
