//! Casimirs that nobody declared.

use super::*;
use crate::model::CasimirKind;
use crate::structure::Search;

const SE3: &str = r#"{"basis": ["J1", "J2", "J3", "P1", "P2", "P3"], "brackets": [
    "[J1, J2] = J3", "[J2, J3] = J1", "[J3, J1] = J2",
    "[J1, P2] = P3", "[J2, P3] = P1", "[J3, P1] = P2",
    "[P1, J2] = P3", "[P2, J3] = P1", "[P3, J1] = P2"]}"#;

fn se3(extra: &[(&str, &str)]) -> Structure {
    let base = [
        ("algebra", SE3),
        ("state", r#"["m1", "m2", "m3", "g1", "g2", "g3"]"#),
        ("hamiltonian", r#""m1^2 + m2 + m3 + g3""#),
    ];
    model(&system(&base, extra))
}

/// Name, text and kind of each.
fn all(model: &Structure) -> Vec<(String, String, CasimirKind)> {
    let casimirs = model.casimirs.iter();
    casimirs
        .map(|c| (c.name.clone(), model.display(c.expr), c.kind))
        .collect()
}

fn texts(model: &Structure) -> Vec<String> {
    all(model)
        .into_iter()
        .map(|(name, text, _)| format!("{name} = {text}"))
        .collect()
}

#[test]
fn what_is_not_declared_is_found_and_named() {
    let none = se3(&[]);
    assert_eq!(
        texts(&none),
        ["C1 = m1*g1 + m2*g2 + m3*g3", "C2 = g1^2 + g2^2 + g3^2"]
    );
    assert!(
        none.casimirs
            .iter()
            .all(|c| c.degree == Some(2) && c.kind == CasimirKind::Polynomial)
    );
    // the declared ones come first, and what depends on them is left out
    let one = se3(&[("casimirs", r#"["length = sqrt(g1^2 + g2^2 + g3^2)"]"#)]);
    assert_eq!(
        texts(&one),
        [
            "length = sqrt(g1^2 + g2^2 + g3^2)",
            "C1 = m1*g1 + m2*g2 + m3*g3"
        ]
    );
    assert_eq!(one.casimirs[0].kind, CasimirKind::Declared);
    // names that are taken are skipped: by a parameter, by a declared Casimir without a name
    let named = se3(&[
        ("casimirs", r#"["g1^2 + g2^2 + g3^2"]"#),
        ("parameters", r#"{"C2": 1}"#),
    ]);
    assert_eq!(
        texts(&named),
        ["C1 = g1^2 + g2^2 + g3^2", "C3 = m1*g1 + m2*g2 + m3*g3"]
    );
    // of a complete set nothing is looked for
    let both = se3(&[(
        "casimirs",
        r#"["g1^2 + g2^2 + g3^2", "m1*g1 + m2*g2 + m3*g3 + g1^2 + g2^2 + g3^2"]"#,
    )]);
    assert!(
        both.casimirs
            .iter()
            .all(|c| c.kind == CasimirKind::Declared)
    );
    assert_eq!(both.casimirs.len(), 2);
}

#[test]
fn brackets_with_constant_terms() {
    // a planar rotation of a plane with a magnetic field
    let plane = |cocycle: &str| {
        let algebra = r#"{"basis": ["r", "p", "q"], "brackets": ["[r, p] = q", "[r, q] = -p"]}"#;
        let base = [
            ("algebra", algebra),
            ("state", r#"["l", "x", "y"]"#),
            ("hamiltonian", r#""l^2""#),
            ("parameters", r#"{"b": {"default": 2, "exact": true}}"#),
        ];
        model(&system(&base, &[("cocycle", cocycle)]))
    };
    assert_eq!(
        texts(&plane(r#"["{x, y} = 1/2"]"#)),
        ["C1 = -l + x^2 + y^2"]
    );
    assert_eq!(
        texts(&plane(r#"["{x, y} = b"]"#)),
        ["C1 = 2*b*l - x^2 - y^2"]
    );
    // affine brackets of coordinates, and others
    let general = |brackets: &str| {
        let base = [("state", r#"["x", "y", "z"]"#), ("hamiltonian", r#""x^2""#)];
        model(&system(&base, &[("poisson", brackets)]))
    };
    let affine = general(r#"["{x, y} = z + 1", "{y, z} = x", "{z, x} = y"]"#);
    assert_eq!(texts(&affine), ["C1 = 2*z + x^2 + y^2 + z^2"]);
    let quadratic = general(r#"["{x, y} = x*y + 1"]"#);
    assert_eq!(texts(&quadratic), ["C1 = z"]);
    let tangled = general(r#"["{x, y} = (1 + x*y)*exp(z)", "{y, z} = 0"]"#);
    assert_eq!(texts(&tangled), ["C1 = z"]);
    // monomials of log-canonical ones, and coordinates that are in no bracket
    assert_eq!(texts(&general(r#"["{x, y} = x*y"]"#)), ["C1 = z"]);
    let species = general(r#"["{x, y} = -x*y/2", "{x, z} = x*z/2", "{y, z} = -y*z"]"#);
    assert_eq!(texts(&species), ["C1 = x^2*y*z"]);
    let species = general(r#"["{x, y} = x*y/2", "{x, z} = x*z/3", "{y, z} = y*z"]"#);
    assert_eq!(texts(&species), ["C1 = x^6*z^3/y^2"]);
}

#[test]
fn those_of_a_class_of_brackets() {
    let general = |brackets: &str, more: &[(&str, &str)]| {
        let base = [("state", r#"["x", "y", "z"]"#), ("hamiltonian", r#""x^2""#)];
        model(&system(&base, &[&[("poisson", brackets)], more].concat()))
    };
    let kind = |model: &Structure| (model.casimirs[0].kind, model.casimirs[0].degree);
    // Jacobian ones, of any degree, and of other functions
    let cubic = r#"["{y, z} = x^3 + y*z/2", "{z, x} = y^3 + x*z/2", "{x, y} = z^3 + x*y/2"]"#;
    let cubic = general(cubic, &[]);
    assert_eq!(texts(&cubic), ["C1 = x^4/4 + z*x*y/2 + y^4/4 + z^4/4"]);
    assert_eq!(kind(&cubic), (CasimirKind::Polynomial, Some(4)));
    let exact = ("parameters", r#"{"a": {"default": 2, "exact": true}}"#);
    let bent = r#"["{y, z} = a*x^5", "{z, x} = -a*y^3", "{x, y} = z^2"]"#;
    assert_eq!(
        texts(&general(bent, &[exact])),
        ["C1 = a*x^6/6 - a*y^4/4 + z^3/3"]
    );
    // elementwise ones: products of powers whatever the signs, and logarithms where there are other terms
    let shifted = r#"["{x, y} = (1 + x)*(y - 2)", "{x, z} = 3*(1 + x)*z", "{y, z} = (y - 2)*z"]"#;
    let shifted = general(shifted, &[]);
    assert_eq!(texts(&shifted), ["C1 = (x + 1)*z/(y - 2)^3"]);
    let mixed = r#"["{x, y} = 2*(1 + x)*y", "{x, z} = -(1 + x)/3", "{y, z} = 3*y"]"#;
    // a logarithm has a value on both sides
    let expected = ["C1 = 6*z + 9*log((x + 1)^2)/2 + log(y^2)/2"];
    for initial in ["[1, 1, 1]", "[-3, 1, 1]"] {
        assert_eq!(texts(&general(mixed, &[("initial", initial)])), expected);
    }
    let nowhere = general(mixed, &[("initial", "[-1, 1, 1]")]);
    assert_eq!(nowhere.search, Search::Singular);
    assert!(texts(&nowhere).is_empty());
    let with_parameter = r#"["{x, y} = a*x*y", "{x, z} = -x*z", "{y, z} = a^2*y*z"]"#;
    let with_parameter = general(with_parameter, &[exact]);
    assert_eq!(
        texts(&with_parameter),
        ["C1 = a^2*log(x^2)/2 + log(y^2)/2 + a*log(z^2)/2"]
    );
    assert_eq!(kind(&with_parameter), (CasimirKind::Function, None));
    // where a factor below is zero at the initial state, the reciprocal is taken
    let both = r#"["{x, y} = (a + x)*(y - 3)", "{x, z} = 3*(a + x)*z", "{y, z} = (y - 3)*z"]"#;
    let of_both = |initial| texts(&general(both, &[exact, ("initial", initial)]));
    assert_eq!(of_both("[0, 0, 1]"), ["C1 = (a + x)*z/(y - 3)^3"]);
    assert_eq!(of_both("[1, 3, 1]"), ["C1 = (y - 3)^3/((a + x)*z)"]);
    assert!(of_both("[-2, 3, 1]").is_empty());
    // coordinates in no bracket, and roots
    let root = r#"["{y, z} = z/(2*sqrt(x))", "{x, y} = sqrt(x)"]"#;
    assert_eq!(texts(&general(root, &[])), ["C1 = sqrt(x)*z"]);
    assert_eq!(texts(&general(r#"["{x, y} = sqrt(2)"]"#, &[])), ["C1 = z"]);
    // a function times a Jacobian bracket, and one whose Casimir has no such integral
    let multiple = r#"["{y, z} = (1 + x)*x", "{z, x} = (1 + x)*y^2", "{x, y} = (1 + x)*z"]"#;
    let multiple = general(multiple, &[]);
    assert!(
        texts(&multiple)[0].contains("y^3/3"),
        "{:?}",
        texts(&multiple)
    );
    let times = r#"["{y, z} = exp(x)*x", "{z, x} = exp(x)*y", "{x, y} = exp(x)*z"]"#;
    assert_eq!(texts(&general(times, &[])), ["C1 = x^2/2 + y^2/2 + z^2/2"]);
    let other = r#"["{y, z} = y*exp(x*y)", "{z, x} = x*exp(x*y)", "{x, y} = 2*z"]"#;
    let other = general(other, &[]);
    assert!(texts(&other).is_empty() && matches!(other.search, Search::None(_)));
}

#[test]
fn systems_of_the_time_and_on_a_group() {
    let timed = model(&so3(&[("hamiltonian", r#""x^2 + t*y^2""#)]));
    assert_eq!(texts(&timed), ["C1 = x^2 + y^2 + z^2"]);
    let right = model(&so3(&[("invariance", r#""right""#)]));
    assert_eq!(texts(&right), ["C1 = x^2 + y^2 + z^2"]);
}

#[test]
fn rational_ones_are_defined_at_the_initial_state() {
    let plane = |initial: &str| {
        let algebra = r#"{"basis": ["r", "p", "q"], "brackets": ["[r, p] = p", "[r, q] = q"]}"#;
        let base = [
            ("algebra", algebra),
            ("state", r#"["l", "x", "y"]"#),
            ("hamiltonian", r#""l^2""#),
        ];
        model(&system(&base, &[("initial", initial)]))
    };
    let found = plane("[1, 2, 3]");
    assert_eq!(texts(&found), ["C1 = x/y"]);
    assert_eq!(
        (found.casimirs[0].kind, found.casimirs[0].degree),
        (CasimirKind::Rational, None)
    );
    assert_eq!(texts(&plane("[1, 2, 0]")), ["C1 = y/x"]);
    let nowhere = plane("[1, 0, 0]");
    assert_eq!(
        (texts(&nowhere).len(), nowhere.search, nowhere.initial_rank),
        (0, Search::Singular, Some(0))
    );
}
