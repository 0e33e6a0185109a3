//! Algebras by name: dimension, number of Casimirs, representation, names; equality with what the committed specs
//! write out; what is said of a wrong name.

use std::fmt::Write as _;

use lie_codegen::algebra::Representation;
use lie_codegen::compile::{compile_spec, expand, with_options};
use lie_codegen::methods::Choice;
use lie_codegen::model::{Algebra, Bracket};
use lie_codegen::structure::Structure;
use lie_codegen::structure::algebra::{DEEP, report};
use lie_syntax::diagnostic::{Diagnostic, Origin};
use serde_json::{Value, json};

fn compiled(algebra: &Value) -> Result<Structure, Vec<Diagnostic>> {
    let spec = json!({ "name": "System", "algebra": algebra, "hamiltonian": "1" });
    compile_spec(&spec.to_string())
}

fn model(algebra: &str) -> Structure {
    compiled(&json!(algebra)).unwrap_or_else(|mistakes| panic!("{algebra}: {mistakes:?}"))
}

fn algebra(model: &Structure) -> &Algebra {
    match &model.bracket {
        Bracket::Lie(algebra) => algebra,
        _ => panic!("no algebra"),
    }
}

/// What carries collective methods: dual matrices, or the whole triple product.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Closed {
    Triple,
    Dual,
    No,
}
use Closed::{Dual, No, Triple};

fn closed(representation: &Representation) -> Closed {
    match (&representation.triple, &representation.dual) {
        (Some(_), Some(_)) => Triple,
        (None, Some(_)) => Dual,
        _ => No,
    }
}

/// Name, dimension, number of independent Casimirs, size of the matrices and what they are closed under.
const KNOWN: &[(&str, usize, usize, usize, Closed)] = &[
    ("so(2)", 1, 1, 2, Triple),
    ("so(3)", 3, 1, 3, Triple),
    ("so(4)", 6, 2, 4, Triple),
    ("so(5)", 10, 2, 5, Triple),
    ("so(6)", 15, 3, 6, Triple),
    ("so(2, 1)", 3, 1, 3, Triple),
    ("so(3, 1)", 6, 2, 4, Triple),
    ("so(0, 3)", 3, 1, 3, Triple),
    ("so(2, 3)", 10, 2, 5, Triple),
    ("su(2)", 3, 1, 4, Triple),
    ("su(3)", 8, 2, 6, Dual),
    ("su(4)", 15, 3, 8, Dual),
    ("su(5)", 24, 4, 10, Dual),
    ("u(1)", 1, 1, 2, Triple),
    ("u(2)", 4, 2, 4, Triple),
    ("u(3)", 9, 3, 6, Triple),
    ("sl(2)", 3, 1, 2, Triple),
    ("sl(3)", 8, 2, 3, Dual),
    ("sl(4)", 15, 3, 4, Dual),
    ("gl(1)", 1, 1, 1, Triple),
    ("gl(2)", 4, 2, 2, Triple),
    ("gl(4)", 16, 4, 4, Triple),
    ("aff(1)", 2, 0, 2, Triple),
    ("aff(2)", 6, 0, 3, Triple),
    ("aff(3)", 12, 0, 4, Triple),
    ("sp(2)", 3, 1, 2, Triple),
    ("sp(4)", 10, 2, 4, Triple),
    ("sp(6)", 21, 3, 6, Triple),
    ("se(2)", 3, 1, 3, Triple),
    ("e(3)", 6, 2, 4, Triple),
    ("se(4)", 10, 2, 5, Triple),
    ("se(5)", 15, 3, 6, Triple),
    ("galilei(1)", 3, 1, 3, Triple),
    ("galilei(2)", 6, 2, 4, Triple),
    ("galilei(3)", 10, 2, 5, Triple),
    ("poincare(1)", 3, 1, 3, Triple),
    ("poincare(2)", 6, 2, 4, Triple),
    ("poincare(3)", 10, 2, 5, Triple),
    ("poincare(4)", 15, 3, 6, Triple),
    ("heisenberg(1)", 3, 1, 3, Triple),
    ("heisenberg(4)", 9, 1, 6, Triple),
    ("diamond", 4, 2, 4, Triple),
    ("oscillator(3)", 8, 2, 8, Triple),
    ("upper(2)", 1, 1, 2, Triple),
    ("upper(3)", 3, 1, 3, Triple),
    ("upper(4)", 6, 2, 4, Triple),
    ("upper(6)", 15, 3, 6, Triple),
    ("toda(2)", 3, 1, 3, Triple),
    ("toda(3)", 5, 1, 5, Triple),
    ("toda(6)", 11, 1, 11, Triple),
    ("R", 1, 1, 2, Triple),
    ("R^4", 4, 4, 5, Triple),
    ("abelian(2)", 2, 2, 3, Triple),
    ("bianchi(I)", 3, 3, 4, Triple),
    ("bianchi(II)", 3, 1, 3, Triple),
    ("bianchi(III)", 3, 1, 3, Triple),
    ("bianchi(IV)", 3, 1, 3, No),
    ("bianchi(V)", 3, 1, 3, Triple),
    ("bianchi(VI, -1/4)", 3, 1, 3, No),
    ("bianchi(VI, 0)", 3, 1, 3, Triple),
    ("bianchi(VI0)", 3, 1, 3, Triple),
    ("bianchi(VII, 9/4)", 3, 1, 3, No),
    ("bianchi(VII, 0)", 3, 1, 3, Triple),
    ("bianchi(VIII)", 3, 1, 3, Triple),
    ("bianchi(IX)", 3, 1, 3, Triple),
    ("so(3) + R^2", 5, 3, 6, Triple),
    ("so(3)^4", 12, 4, 12, Triple),
    ("(so(3) + R)^2", 8, 4, 10, Triple),
    ("so(3) + su(2) + so(3)", 9, 3, 10, Triple),
    ("semidirect(so(3), R^3)", 6, 2, 4, Triple),
    ("semidirect(so(3), R^3, R^3)", 9, 3, 5, Triple),
    ("semidirect(so(3), adjoint)", 6, 2, 4, Triple),
    ("semidirect(sl(2), R^2)", 5, 1, 3, Triple),
    ("semidirect(sl(2), dual(R^2))", 5, 1, 5, Triple),
    ("semidirect(sl(2), coadjoint)", 6, 2, 6, No),
    ("semidirect(su(2), R^4)", 7, 1, 5, Triple),
    ("semidirect(so(3) + so(3), R^6)", 12, 4, 7, Triple),
    ("tangent(so(3))", 6, 2, 6, Triple),
    ("tangent(sl(2))", 6, 2, 4, Triple),
    ("tangent(se(3))", 12, 4, 8, Triple),
];

#[test]
fn dimension_casimirs_and_representation() {
    let mut wrong = String::new();
    for &(name, dimension, casimirs, size, kind) in KNOWN {
        let model = model(name);
        let algebra = algebra(&model);
        let n = algebra.basis.len();
        let representation = algebra.representation.as_ref().expect("matrices");
        let found = (
            n,
            n - model.generic_rank,
            representation.dimension,
            closed(representation),
        );
        if found != (dimension, casimirs, size, kind) {
            writeln!(wrong, "{name}: {found:?}").expect("a string");
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

fn committed(name: &str) -> Value {
    let path = format!("{}/../../specs/{name}.json", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("a spec");
    serde_json::from_str(&text).expect("JSON")
}

/// The code of a spec with several methods, among them those that use the matrices.
fn code(spec: &Value) -> String {
    let model = compile_spec(&spec.to_string()).unwrap_or_else(|mistakes| panic!("{mistakes:?}"));
    let ids = [
        "lie-midpoint",
        "gauss4",
        "cf4",
        "isospectral4",
        "collective4",
    ];
    let choices = ids.map(|id| Choice::from_id(id).expect("a method"));
    expand(&model, &with_options(&model, &choices))
}

#[test]
fn the_committed_specs_by_name_give_the_same_code() {
    for (spec, name, other) in [
        ("so3_free_rigid_body", json!("so(3)"), json!("so(2, 1)")),
        (
            "se3_heavy_top",
            json!("se(3)"),
            json!("semidirect(so(3), adjoint)"),
        ),
        ("se3_kirchhoff", json!("e(3)"), json!("poincare(2)")),
        ("so4_manakov", json!("so(4)"), json!("so(3)^2")),
        ("e2_pendulum", json!("se(2)"), json!("so(3)")),
        ("sl2_quadratic", json!("sl(2)"), json!("sp(2)")),
        ("heisenberg_h3", json!("heisenberg(1)"), json!("upper(3)")),
        ("su3_quadratic", json!("su(3)"), json!("sl(3)")),
        (
            "toda3_solvable",
            json!({ "named": "toda(3)", "matrices": {} }),
            json!("aff(1)^2 + R"),
        ),
    ] {
        let mut spec = committed(spec);
        let written = code(&spec);
        spec["algebra"] = name.clone();
        // the basis has the names of the spec; what differs in another algebra is seen
        let named = code(&spec);
        assert!(written == named, "{name}: the code differs");
        if name != "se(3)" {
            spec["casimirs"] = json!([]);
        }
        spec["algebra"] = other.clone();
        let differs = match compile_spec(&spec.to_string()) {
            Ok(_) => code(&spec) != written,
            Err(_) => true,
        };
        assert!(differs, "{other}: the code is that of {name}");
    }
}

#[test]
fn the_names_are_those_of_the_committed_specs() {
    for (spec, name) in [
        ("so3_free_rigid_body", "so(3)"),
        ("se3_heavy_top", "se(3)"),
        ("so4_manakov", "so(4)"),
        ("e2_pendulum", "se(2)"),
        ("sl2_quadratic", "sl(2)"),
        ("heisenberg_h3", "heisenberg(1)"),
        ("su3_quadratic", "su(3)"),
        ("toda3_solvable", "toda(3)"),
    ] {
        let written = &committed(spec)["algebra"]["basis"];
        assert_eq!(*written, json!(names(name).0), "{name}");
    }
    for (spec, name) in [
        ("so3_free_rigid_body", "so(3)"),
        ("se3_kirchhoff", "se(3)"),
        ("so4_manakov", "so(4)"),
        ("se2_circulation", "se(2)"),
        ("sl2_quadratic", "sl(2)"),
        ("heisenberg_h3", "heisenberg(1)"),
        ("su3_quadratic", "su(3)"),
        ("toda3_solvable", "toda(3)"),
    ] {
        assert_eq!(committed(spec)["state"], json!(names(name).1), "{name}");
    }
}

/// Basis and state of a declaration without `state`.
fn names(name: &str) -> (Vec<String>, Vec<String>) {
    let model = model(name);
    let texts = |names: &[lie_syntax::ast::Name]| names.iter().map(|n| n.text.clone()).collect();
    (texts(&algebra(&model).basis), texts(&model.coordinates))
}

#[test]
fn names_of_sums_are_different() {
    for (name, basis, state) in [
        ("so(3) + R^2", "e1 e2 e3 P1 P2", "x y z p1 p2"),
        (
            "so(3)^2",
            "e1_1 e2_1 e3_1 e1_2 e2_2 e3_2",
            "x1 y1 z1 x2 y2 z2",
        ),
        ("so(2) + R + so(2)", "E12_1 P E12_2", "m12_1 p m12_2"),
        ("R + R + R^2", "P_1 P_2 P1_3 P2_3", "p_1 p_2 p1_3 p2_3"),
        ("(R + so(2))^2", "P1 E12_1 P2 E12_2", "p1 m12_1 p2 m12_2"),
        (
            "semidirect(so(2), R^2, R^2)",
            "E12 P1_1 P2_1 P1_2 P2_2",
            "m12 p1_1 p2_1 p1_2 p2_2",
        ),
        (
            "semidirect(se(2), R^3)",
            "J1 P1_1 P2_1 P1_2 P2_2 P3_2",
            "L1 p1_1 p2_1 p1_2 p2_2 p3_2",
        ),
        ("tangent(so(3))", "e1 e2 e3 de1 de2 de3", "x y z dx dy dz"),
        ("diamond", "N Q P Z", "n q p z"),
        ("aff(1)", "E P", "m p"),
        ("poincare(1)", "K P H", "k p E"),
    ] {
        let (found, coordinates) = names(name);
        assert_eq!(
            (found.join(" "), coordinates.join(" ")),
            (basis.into(), state.into()),
            "{name}"
        );
    }
    assert_eq!(names("so(10)").0[0], "E1_2");
}

/// The constants as text, `12:3=1` for `[e1, e2] = e3 + …`.
fn constants(model: &Structure) -> String {
    let entries = algebra(model).exact.entries().iter();
    let entry =
        entries.map(|(i, j, k, value)| format!("{i}{j}:{k}={}", value.display(&|p| p.to_string())));
    entry.collect::<Vec<_>>().join(" ")
}

#[test]
fn brackets_are_the_known_ones() {
    for (name, brackets) in [
        ("bianchi(VI, -1/4)", "01:1=-1/4 01:2=-1/4 02:1=-1 02:2=-1/4"),
        ("bianchi(VIII)", "01:2=-1 02:1=-1 12:0=1"),
        ("diamond", "01:2=1 02:1=-1 12:3=1"),
        ("galilei(1)", "02:1=1"),
        ("poincare(1)", "01:2=1 02:1=1"),
        ("so(2, 1)", "01:2=1 02:1=-1 12:0=-1"),
        ("semidirect(R, R^2)", "02:1=1"),
        ("tangent(aff(1))", "01:1=1 03:3=1 12:3=-1"),
    ] {
        assert_eq!(constants(&model(name)), brackets, "{name}");
    }
}

#[test]
fn changes_of_a_named_algebra() {
    let of = |value: Value| {
        let basis = value["named"]
            .as_str()
            .map_or(0, |_| match &value["basis"] {
                Value::Array(basis) => basis.len(),
                _ => names(value["named"].as_str().expect("a name")).0.len(),
            });
        let central = value["central"].as_array().map_or(0, Vec::len);
        let state: Vec<String> = (0..basis.max(central + basis))
            .map(|i| format!("x{i}"))
            .collect();
        let spec =
            json!({ "name": "System", "algebra": value, "state": state, "hamiltonian": "1" });
        compile_spec(&spec.to_string())
    };
    let sound = |value: Value| of(value.clone()).unwrap_or_else(|m| panic!("{value}: {m:?}"));
    // the Bargmann algebra: mass is the central charge of the Galilean one
    let bargmann = sound(json!({
        "named": "galilei(3)", "central": ["M"],
        "brackets": ["[K1, P1] = M", "[K2, P2] = M", "[P3, K3] = -M"],
    }));
    assert_eq!(
        (algebra(&bargmann).basis.len(), 11 - bargmann.generic_rank),
        (11, 3)
    );
    assert!(algebra(&bargmann).representation.is_none());
    // sl(2) in the basis of so(2, 1), with its matrices
    let turned = sound(json!({
        "named": "sl(2)", "basis": ["a = (e - f)/2", "b = h/2", "c = (e + f)/2"],
    }));
    assert_eq!(constants(&turned), "01:2=-1 02:1=1 12:0=1");
    assert_eq!(
        closed(algebra(&turned).representation.as_ref().expect("matrices")),
        Triple
    );
    // sl(2) on binary quadratic forms, which is its adjoint representation
    let forms = json!({
        "h": [[2, 0, 0], [0, 0, 0], [0, 0, -2]], "e": [[0, 1, 0], [0, 0, 2], [0, 0, 0]],
        "f": [[0, 0, 0], [2, 0, 0], [0, 1, 0]],
    });
    let product = compiled(&json!({ "named": "sl(2)", "action": forms })).expect("sound");
    let kept = (
        product.coordinates.len() - product.generic_rank,
        product.coordinates[3].text.as_str(),
    );
    assert_eq!(kept, (2, "p1"));
    assert_eq!(
        constants(&product).replace("03:3=2", "").len() + 6,
        constants(&product).len()
    );
    // an element that is left out acts as zero
    let bianchi = compiled(&json!({ "named": "R", "action": { "P": [[1, "1/2"], [0, 1]] } }));
    assert_eq!(
        constants(&bianchi.expect("sound")),
        "01:1=1 02:1=1/2 02:2=1"
    );
    // other names alone
    let renamed = sound(json!({ "named": "so(3)", "basis": ["L1", "L2", "L3"] }));
    assert_eq!(constants(&renamed), constants(&model("so(3)")));
    assert_eq!(algebra(&renamed).basis[1].text, "L2");
    // another representation, which is checked against the brackets
    let spin = json!({
        "e1": [[0, 0, 0, "-1/2"], [0, 0, "-1/2", 0], [0, "1/2", 0, 0], ["1/2", 0, 0, 0]],
        "e2": [[0, "-1/2", 0, 0], ["1/2", 0, 0, 0], [0, 0, 0, "-1/2"], [0, 0, "1/2", 0]],
        "e3": [[0, 0, "-1/2", 0], [0, 0, 0, "1/2"], ["1/2", 0, 0, 0], [0, "-1/2", 0, 0]],
    });
    let wrong = of(
        json!({ "named": "so(2, 1)", "matrices": { "E12": [[1]], "E13": [[0]], "E23": [[0]] } }),
    );
    assert_eq!(
        wrong.expect_err("no representation")[0].kind.as_str(),
        "representation"
    );
    let spin = sound(json!({ "named": "so(3)", "matrices": spin }));
    assert_eq!(
        algebra(&spin).representation.as_ref().map(|r| r.dimension),
        Some(4)
    );
}

/// Kind and text of each mistake of a spec with this value of `algebra`.
fn mistakes(algebra: &str) -> Vec<(String, String, Diagnostic)> {
    let spec = format!(r#"{{"name": "System", "hamiltonian": "1", "algebra": {algebra}}}"#);
    let found = compile_spec(&spec).err().unwrap_or_default();
    let text = |diagnostic: Diagnostic| {
        let place = match diagnostic.origin {
            Some(Origin::Text { start, end }) => spec[start..end].to_owned(),
            _ => String::new(),
        };
        (diagnostic.kind.as_str().to_owned(), place, diagnostic)
    };
    found.into_iter().map(text).collect()
}

#[test]
fn wrong_names_are_refused_with_a_remedy() {
    for (algebra, kind, place, help) in [
        (r#""""#, "syntax", r#""""#, "so(3)"),
        (r#""sso(3)""#, "unknown-symbol", "sso", "`so`"),
        (r#""SO(3)""#, "unknown-symbol", "SO", "`so`"),
        (r#""so3""#, "unknown-symbol", "so3", "so(3)"),
        (r#""SU2 + R""#, "unknown-symbol", "SU2", "su(2)"),
        (
            r#""kac_moody(3)""#,
            "unknown-symbol",
            "kac_moody",
            "`heisenberg(n)`",
        ),
        (
            r#""semidirekt(so(3), R^3)""#,
            "unknown-symbol",
            "semidirekt",
            "`semidirect`",
        ),
        (r#""so(0)""#, "number", "0", "at least 2"),
        (r#""so(1)""#, "number", "1", "at least 2"),
        (r#""so(-3)""#, "number", "-3", "at least 2"),
        (r#""so(5/2)""#, "number", "5/2", "whole number"),
        (r#""so(n)""#, "number", "n", "whole number"),
        (r#""so(1, 0)""#, "number", "0", "at least 2"),
        (r#""sp(3)""#, "number", "3", "sp(2) or sp(4)"),
        (r#""bianchi(X)""#, "number", "X", "VIII and IX"),
        (r#""bianchi(9)""#, "number", "9", "Roman"),
        (r#""bianchi(VI)""#, "number", "VI", "at most zero"),
        (r#""bianchi(VI, 1)""#, "number", "1", "at most zero"),
        (r#""bianchi(IX, 1)""#, "number", "1", "bianchi(IX)"),
        (r#""so()""#, "arity", "so()", "so(n)"),
        (r#""so""#, "arity", "so", "so(n)"),
        (r#""su(2, 3)""#, "arity", "su(2, 3)", "su(n)"),
        (
            r#""tangent(so(3), R)""#,
            "arity",
            "tangent(so(3), R)",
            "tangent(A)",
        ),
        (
            r#""semidirect(so(3))""#,
            "arity",
            "semidirect(so(3))",
            "R^3",
        ),
        (
            r#""semidirect(so(3), R^2)""#,
            "representation",
            "R^2",
            "R^3",
        ),
        (r#""semidirect(so(3), S^2)""#, "syntax", "S^2", "adjoint"),
        (r#""so(,3)""#, "syntax", "so(,3)", "so(3)"),
        (r#""so(3) * so(3)""#, "syntax", "*", "A + B"),
        (r#""so(3) x so(3)""#, "syntax", "x", "A + B"),
        (r#""so(3) + ""#, "syntax", "+", "so(3)"),
        (r#""so(3)^N""#, "syntax", "N", "so(3)^4"),
        (r#""so(3)^""#, "syntax", "^", "so(3)^4"),
        (r#""so(3)^1.5""#, "number", "1.5", "so(3)^4"),
        (r#""so(3)^0""#, "number", "0", "at least 1"),
        (r#""so(3""#, "syntax", "(", "closing"),
        (r#""()""#, "syntax", "(", "so(3)"),
        (r#""so(1000)""#, "limit", "so(1000)", "smaller"),
        (
            r#""gl(99999999999999999999)""#,
            "limit",
            "gl(99999999999999999999)",
            "smaller",
        ),
        (r#""R + so(3)^100""#, "limit", "so(3)^100", "smaller"),
        (r#""R^257""#, "limit", "R^257", "smaller"),
        (r#""R^200 + R^200""#, "limit", "R^200 + R^200", "smaller"),
        (
            r#""tangent(so(20))""#,
            "limit",
            "tangent(so(20))",
            "smaller",
        ),
        (r#"{"named": "so(4"}"#, "syntax", "(", "closing"),
    ] {
        let found = mistakes(algebra);
        let first = found
            .first()
            .unwrap_or_else(|| panic!("{algebra} is taken"));
        let remedy = first.2.help.clone().unwrap_or_default();
        assert_eq!(
            (first.0.as_str(), first.1.as_str()),
            (kind, place),
            "{algebra}: {first:?}"
        );
        assert!(remedy.contains(help), "{algebra}: {remedy}");
    }
    let deep = format!("\"{}so(3){}\"", "(".repeat(100_000), ")".repeat(100_000));
    assert_eq!(mistakes(&deep)[0].0, "limit");
}

#[test]
fn wrong_changes_are_refused_with_a_remedy() {
    for (changes, kind, place) in [
        (r#""basis": ["a", "b"]"#, "basis", r#"a", "b"#),
        (
            r#""basis": ["a", "b", "c = e3"]"#,
            "basis",
            r#"a", "b", "c = e3"#,
        ),
        (
            r#""basis": ["a = e1", "b = 2*e1", "c = e3"]"#,
            "basis",
            r#"a = e1", "b = 2*e1", "c = e3"#,
        ),
        (
            r#""basis": ["a = e1", "b = e4", "c = e3"]"#,
            "unknown-symbol",
            "e4",
        ),
        (
            r#""basis": ["a = e1*e2", "b = e2", "c = e3"]"#,
            "syntax",
            "e1*e2",
        ),
        (r#""brackets": ["[e1, e2] = e3"]"#, "basis", "[e1, e2] = e3"),
        (r#""central": ["e1"]"#, "duplicate-name", "e1"),
        (
            r#""central": ["Z"], "brackets": ["[e1, e4] = Z"]"#,
            "unknown-symbol",
            "e4",
        ),
        (
            r#""central": ["Z"], "brackets": ["[e1, e1] = Z"]"#,
            "antisymmetry",
            "[e1, e1] = Z",
        ),
        (
            r#""central": ["Z"], "brackets": ["[e1, e2] = e3"]"#,
            "unknown-symbol",
            "e3",
        ),
        (
            r#""central": ["Z"], "brackets": ["[e1, e2] = Z", "[e2, e1] = Z"]"#,
            "duplicate-bracket",
            "[e2, e1] = Z",
        ),
        (r#""basis": ["a", "b", "c"]"#, "schema", ""),
        (r#""action": {"e1": [[1]], "e4": [[0]]}"#, "basis", "e4"),
        (
            r#""action": {"e1": [[1]], "e2": [[0, 1]]}"#,
            "representation",
            "[[0, 1]]",
        ),
        (r#""action": {"e1": [[1]], "e2": [["1/x"]]}"#, "number", "x"),
        (
            r#""action": {"e1": [[0, 1], [-1, 0]], "e3": [[0, 0], [1, 0]]}"#,
            "representation",
            "[[0, 1], [-1, 0]]",
        ),
    ] {
        let algebra = format!(r#"{{"named": "so(3)", {changes}}}"#);
        let found = mistakes(&algebra);
        let first = found
            .first()
            .unwrap_or_else(|| panic!("{changes} is taken"));
        let place = if place.is_empty() {
            algebra.as_str()
        } else {
            place
        };
        assert_eq!(first.0, kind, "{changes}: {first:?}");
        assert!(first.1.contains(place), "{changes}: {first:?}");
        assert!(first.2.help.is_some(), "{changes}");
    }
    // every cocycle of so(3) is one; one of the Galilean algebra that is none
    let found = mistakes(
        r#"{"named": "galilei(3)", "central": ["M"], "brackets": ["[K1, P1] = M", "[K2, P2] = M"]}"#,
    );
    assert_eq!(
        (found[0].0.as_str(), found[0].1.contains("[K1, P1] = M")),
        ("cocycle", true)
    );
}

#[test]
fn macro_and_spec_give_the_same_code() {
    for (spec, body) in [
        (json!("so(3) + R^2"), "algebra = so(3) + R^2;"),
        (
            json!("semidirect(so(3), R^3, R^3)"),
            "algebra = semidirect(so(3), R^3, R^3);",
        ),
        (json!("bianchi(VI, -1/4)"), "algebra = bianchi(VI, -1/4);"),
        (
            json!({ "named": "tangent(sl(2))", "matrices": {} }),
            "algebra = tangent(sl(2));",
        ),
    ] {
        let (_, state) = names(spec.as_str().unwrap_or("tangent(sl(2))"));
        let energy = format!("{}^2/2", state.join("^2/2 + "));
        let spec = json!({ "name": "System", "algebra": spec, "hamiltonian": energy });
        let model = compile_spec(&spec.to_string()).expect("a sound spec");
        let items = lie_codegen::compile::generate(&model, &[]).to_string();
        let body = format!("pub system System; {body} hamiltonian = {energy};");
        let tokens = body.parse().expect("tokens");
        let folder = std::path::Path::new("nowhere");
        let expanded = lie_codegen::expand::expand_macro(tokens, folder).to_string();
        assert!(!expanded.contains("compile_error"), "{expanded}");
        assert_eq!(items == expanded, !body.contains("tangent"), "{body}");
    }
    let body = "pub system System; algebra { named = galilei(1); central M; [K, P] = M; } state k, p, E, m; \
                hamiltonian = p^2/2 + m;";
    let spec = json!({
        "name": "System", "state": ["k", "p", "E", "m"], "hamiltonian": "p^2/2 + m",
        "algebra": { "named": "galilei(1)", "central": ["M"], "brackets": ["[K, P] = M"] },
    });
    let body = body.parse().expect("tokens");
    let expanded = lie_codegen::expand::expand_macro(body, std::path::Path::new("nowhere"));
    let model = compile_spec(&spec.to_string()).expect("a sound spec");
    let items = lie_codegen::compile::generate(&model, &[]);
    assert_eq!(expanded.to_string(), items.to_string());
}

/// The names that `lie check` gives can be written, and then mean the same.
#[test]
fn names_that_are_recognised_can_be_written() {
    let recognised = |name: &str| report(&model(name), DEEP).and_then(|report| report.name.ok());
    let mut count = 0;
    for (name, dimension, ..) in KNOWN.iter().filter(|known| known.1 <= 10) {
        let Some(found) = recognised(name) else {
            continue;
        };
        // complex algebras are no families
        if found.contains(",C)") {
            continue;
        }
        count += 1;
        assert_eq!(
            algebra(&model(&found)).exact.dimension(),
            *dimension,
            "{name}"
        );
        assert_eq!(recognised(&found), Some(found), "{name}");
    }
    assert!(count > 40, "{count}");
}
