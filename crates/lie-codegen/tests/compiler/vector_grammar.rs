//! Vectors and matrices of a declaration: what is written with them is what is written out.

use lie_codegen::compile::{compile_spec, declared_choices, expand};
use lie_codegen::expand::expand_macro;
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin};
use serde_json::{Value, json};

/// A system on se(3)* with parameters and vectors.
fn system(hamiltonian: &str) -> Value {
    json!({
        "name": "Body",
        "algebra": "se(3)",
        "state": ["m1", "m2", "m3", "p1", "p2", "p3"],
        "parameters": { "a": 2, "b": 3, "c": 5, "k": 7, "l": 11, "n": 13 },
        "vectors": {
            "M": ["m1", "m2", "m3"],
            "P": ["p1", "p2", "p3"],
            "E": [0, 0, 1],
            "A": [["a", "k", 0], ["k", "b", "l"], [0, "l", "c"]],
            "D": [["1/2", 0, 0], [0, "1/3", 0], [0, 0, "1/4"]],
            "Q": [["a", "b"], ["c", "k"]],
            "Z": ["m1", "p1"],
        },
        "hamiltonian": hamiltonian,
        "methods": ["midpoint"],
    })
}

fn code(spec: &Value) -> String {
    let model = compile_spec(&spec.to_string()).expect("a system");
    expand(&model, &declared_choices(&model))
}

fn mistakes(spec: &Value) -> (String, Vec<Diagnostic>) {
    let text = spec.to_string();
    let found = compile_spec(&text).expect_err("a mistake");
    (text, found)
}

/// What is written with vectors, and the same in scalars. All parameters and coordinates stand in the common part.
const OPERATIONS: [(&str, &str); 14] = [
    ("dot(M, P)", "m1*p1 + m2*p2 + m3*p3"),
    ("norm2(M)", "m1^2 + m2^2 + m3^2"),
    ("norm(P)", "sqrt(p1^2 + p2^2 + p3^2)"),
    ("dot(E, P)", "p3"),
    (
        "dot(cross(M, P), M + E)",
        "(m2*p3 - m3*p2)*m1 + (m3*p1 - m1*p3)*m2 + (m1*p2 - m2*p1)*(m3 + 1)",
    ),
    ("norm2(cross(E, M))", "(-m2)^2 + m1^2"),
    ("norm2(M - P)", "(m1 - p1)^2 + (m2 - p2)^2 + (m3 - p3)^2"),
    ("norm2(-P)", "(-p1)^2 + (-p2)^2 + (-p3)^2"),
    ("dot(2*M/a, P)", "2*m1/a*p1 + 2*m2/a*p2 + 2*m3/a*p3"),
    (
        "dot(A*M, P)",
        "(a*m1 + k*m2)*p1 + (k*m1 + b*m2 + l*m3)*p2 + (l*m2 + c*m3)*p3",
    ),
    (
        "quad(A, M)",
        "a*m1^2 + b*m2^2 + c*m3^2 + 2*k*m1*m2 + 2*l*m2*m3",
    ),
    ("quad(Q, Z)", "a*m1^2 + k*p1^2 + (b + c)*(m1*p1)"),
    ("quad(D, M)/2", "(m1^2/2 + m2^2/3 + m3^2/4)/2"),
    (
        "dot(D*A*M, P)",
        "1/2*(a*m1 + k*m2)*p1 + 1/3*(k*m1 + b*m2 + l*m3)*p2 + 1/4*(l*m2 + c*m3)*p3",
    ),
];

const COMMON: &str = "(a + b + c + k + l + n)*(m1^4 + m2^4 + m3^4 + p1^4 + p2^4 + p3^4)";

#[test]
fn every_operation_is_the_one_written_out() {
    for (vectors, scalars) in OPERATIONS {
        let [with, without] = [vectors, scalars].map(|h| code(&system(&format!("{COMMON} + {h}"))));
        assert_eq!(with, without, "{vectors}");
        let other = code(&system(&format!("{COMMON} + 2*({scalars})")));
        assert_ne!(with, other, "{vectors}");
    }
}

/// A wrong Hamiltonian, its part that is marked, and what is said.
const SHAPES: [(&str, &str, &str); 9] = [
    (
        "dot(M, A)",
        "dot(M, A)",
        "`dot(M, A)`: M has 3 entries, A is a matrix of 3 by 3",
    ),
    (
        "dot(M, Z)",
        "dot(M, Z)",
        "`dot(M, Z)`: M has 3 entries, Z has 2 entries",
    ),
    ("m1 + norm(m1)", "norm(m1)", "`norm(m1)`: m1 is a scalar"),
    (
        "dot(cross(Z, Z), Z)",
        "cross(Z, Z)",
        "`cross(Z, Z)`: Z has 2 entries, Z has 2 entries",
    ),
    (
        "dot(Q*M, M)",
        "Q*M",
        "`Q*M`: Q is a matrix of 2 by 2, M has 3 entries",
    ),
    ("m1 + M*P", "M*P", "`M*P`: M has 3 entries, P has 3 entries"),
    (
        "m1 + sin(M)",
        "M",
        "M has 3 entries, and a scalar belongs here",
    ),
    (
        "norm(M + Z)",
        "M + Z",
        "`M + Z`: M has 3 entries, Z has 2 entries",
    ),
    ("m1/M", "m1/M", "`m1/M`: M has 3 entries"),
];

#[test]
fn a_mistake_in_a_shape_names_the_vectors_at_its_place() {
    for (hamiltonian, place, message) in SHAPES {
        let (text, found) = mistakes(&system(hamiltonian));
        let [mistake] = found.as_slice() else {
            panic!("{hamiltonian}: {found:?}")
        };
        assert_eq!(
            (mistake.kind, mistake.message.as_str()),
            (Kind::Syntax, message)
        );
        assert!(mistake.help.is_some());
        let Some(Origin::Text { start, end }) = mistake.origin else {
            panic!("{hamiltonian}: no place")
        };
        assert_eq!(&text[start..end], place, "{hamiltonian}");
    }
}

#[test]
fn a_declaration_of_a_vector_with_a_mistake_is_one_mistake() {
    let cases = [
        (
            "V",
            json!(["m1", "x9"]),
            Kind::UnknownSymbol,
            "`x9`, an entry of `V`, is not declared",
        ),
        (
            "V",
            json!([]),
            Kind::Syntax,
            "the vector `V` has no entries",
        ),
        (
            "V",
            json!([["a", "b"], ["c"]]),
            Kind::Syntax,
            "the matrix `V` has rows of 2 and of 1 entries",
        ),
        (
            "a",
            json!(["m1"]),
            Kind::DuplicateName,
            "the vector `a` has the name of something else in the declaration",
        ),
        (
            "dot",
            json!(["m1"]),
            Kind::ReservedName,
            "`dot` is a name of the language, not of a vector",
        ),
        (
            "V",
            json!("m1"),
            Kind::Schema,
            "a vector or a matrix is a list, not a string",
        ),
    ];
    for (name, value, kind, message) in cases {
        let mut spec = system("quad(V, M) + norm(V)");
        spec["vectors"][name] = value;
        let (_, found) = mistakes(&spec);
        let found: Vec<_> = found.iter().map(|m| (m.kind, m.message.as_str())).collect();
        assert_eq!(found, [(kind, message)]);
    }
}

#[test]
fn an_expansion_has_an_end() {
    let nested = (0..60).fold("M".to_owned(), |inner, _| format!("cross({inner}, M + P)"));
    let (_, found) = mistakes(&system(&format!("dot({nested}, M)")));
    assert_eq!(found[0].kind, Kind::Limit, "{found:?}");
}

#[test]
fn the_kirchhoff_body_with_matrices_is_the_one_in_coordinates() {
    let text = include_str!("../../../../specs/se3_kirchhoff.json");
    let mut written: Value = serde_json::from_str(text).expect("JSON");
    written["methods"] = json!(["midpoint", "lie-midpoint"]);
    let mut vectors = written.clone();
    vectors["vectors"] = json!({
        "m": ["m1", "m2", "m3"],
        "p": ["p1", "p2", "p3"],
        "A": [["1/2", 0, 0], [0, "1/3", 0], [0, 0, "1/4"]],
        "B": [["1/4", 0, 0], [0, 0, "1/6"], [0, "-1/8", 0]],
        "C": [["1/5", 0, 0], [0, "1/2", 0], [0, 0, "2/3"]],
    });
    vectors["hamiltonian"] = json!("quad(A, m) + quad(C, p) + dot(m, B*p)");
    vectors["casimirs"] = json!(["impulse2 = norm2(p)", "pitch = dot(m, p)"]);
    assert_eq!(code(&vectors), code(&written));
    vectors["vectors"]["B"][2][1] = json!("1/8");
    assert_ne!(code(&vectors), code(&written));
}

/// The body with full matrices in at most ten lines, and the same with its 21 coefficients written out.
#[test]
fn the_body_with_full_matrices_is_the_one_written_out() {
    let text = include_str!("../../../../specs/se3_kirchhoff_full.json");
    let lines = text.lines().skip_while(|l| !l.contains("\"algebra\""));
    let lines = lines.take_while(|l| !l.contains("\"initial\"")).count();
    assert!(lines <= 10, "{lines} lines");
    let mut vectors: Value = serde_json::from_str(text).expect("JSON");
    vectors["methods"] = json!(["midpoint", "lie-midpoint", "gauss4"]);
    let mut written = vectors.clone();
    written
        .as_object_mut()
        .expect("an object")
        .remove("vectors");
    written["casimirs"] = json!([
        "impulse2 = p1^2 + p2^2 + p3^2",
        "pitch = m1*p1 + m2*p2 + m3*p3",
    ]);
    let energy = "(3/2*m1^2 + 2*m2^2 + 5/2*m3^2 + 2*1/8*m1*m2 - 2*1/6*m1*m3 + 2*1/10*m2*m3)/2
        + m1*(1/4*p1 + 1/7*p2 - 1/9*p3) + m2*(-1/5*p1 + 1/3*p2 + 1/12*p3) + m3*(1/11*p1 - 1/8*p2 + 1/6*p3)
        + (5/4*p1^2 + 4/3*p2^2 + 7/3*p3^2 - 2*1/9*p1*p2 + 2*1/7*p1*p3 + 2*1/13*p2*p3)/2";
    written["hamiltonian"] = json!(energy);
    assert_eq!(code(&vectors), code(&written));
    written["hamiltonian"] = json!(energy.replace("1/13", "1/14"));
    assert_ne!(code(&vectors), code(&written));
}

/// A vector of the coordinates of a site takes their index; of parameters alone it takes none.
#[test]
fn vectors_of_a_family_have_the_index_of_their_site() {
    let chain = |hamiltonian: &str| {
        json!({
            "name": "Chain",
            "algebra": "so(3)^N",
            "state": ["x[i]", "y[i]", "z[i]"],
            "parameters": { "N": 8, "J": 1, "b": 2 },
            "vectors": {
                "M": ["x", "y", "z"],
                "F": [0, "b", "1/2"],
                "D": [["J", 0, 0], [0, "J", 0], [0, 0, "2*J"]],
            },
            "hamiltonian": hamiltonian,
        })
    };
    let with = "-sum(i in 0..N: dot(M[i], D*M[i+1]) + dot(F, M[i]))";
    let without =
        "-sum(i in 0..N: x[i]*J*x[i+1] + y[i]*J*y[i+1] + z[i]*2*J*z[i+1] + b*y[i] + 1/2*z[i])";
    assert_eq!(code(&chain(with)), code(&chain(without)));
    let other = with.replace("i+1", "i+2");
    assert_ne!(code(&chain(&other)), code(&chain(without)));
    let (_, found) = mistakes(&chain("sum(i in 0..N: J*dot(F[i+1], M[i]))"));
    assert_eq!(
        found[0].message,
        "`F[i+1]`: no entry is a coordinate of a site"
    );
    let (_, found) = mistakes(&chain("sum(i in 0..N: J*norm(D*M[i] + F) + M[i-1])"));
    assert!(
        found[0].message.contains("M[i-1] has 3 entries"),
        "{found:?}"
    );
}

/// The functions of vectors are words only where they are called.
#[test]
fn a_casimir_may_be_called_norm() {
    let mut spec = system("norm(M) + quad(A, P)");
    spec["parameters"] = json!({ "a": 2, "b": 3, "c": 5, "k": 7, "l": 11 });
    spec["casimirs"] = json!(["norm = norm2(P)", "dot = dot(M, P)"]);
    assert!(code(&spec).contains("norm"));
}

#[test]
fn the_macro_has_the_same_vectors() {
    let form = |hamiltonian: &str, vectors: &str| {
        let text = format!(
            "pub system Body; algebra = so(3); state x, y, z; parameters {{ a = 2.0; b = 3.0; }}
            {vectors} hamiltonian = {hamiltonian}; casimir c = x^2 + y^2 + z^2;"
        );
        expand_macro(text.parse().expect("tokens"), std::path::Path::new(".")).to_string()
    };
    let vectors = "vectors { L = (x, y, z); A = [[a, b, 0], [b, a, 0], [0, 0, 1/2]]; }";
    let with = form("quad(A, L)/2", vectors);
    let without = form("(a*x^2 + a*y^2 + z^2/2 + 2*b*x*y)/2", "");
    assert_eq!(with, without);
    assert!(!with.contains("compile_error"), "{with}");
    let wrong = form("dot(A, L)", vectors);
    assert!(
        wrong.contains("A is a matrix of 3 by 3, L has 3 entries"),
        "{wrong}"
    );
}
