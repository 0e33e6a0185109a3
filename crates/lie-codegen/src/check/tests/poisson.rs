use super::*;
use crate::model::{Bracket, Cocycle};
use lie_symbolic::exact::{Fraction, Rational};

/// Brackets of coordinates with what is given.
fn general(state: &str, brackets: &str, extra: &[(&str, &str)]) -> String {
    system(
        &[
            ("poisson", brackets),
            ("state", state),
            ("hamiltonian", r#""1""#),
        ],
        extra,
    )
}

const FOUR: &str = r#"["x", "y", "z", "w"]"#;

#[test]
fn brackets_that_are_poisson() {
    for (brackets, rank, degree) in [
        (r#"["{x, y} = 1", "{z, w} = 1"]"#, 4, Some(0)),
        (r#"["{x, y} = 1"]"#, 2, Some(0)),
        (
            r#"["{x, y} = z + 1", "{y, z} = x", "{z, x} = y"]"#,
            2,
            Some(1),
        ),
        // log-canonical: {x_i, x_j} = a_ij x_i x_j for every antisymmetric matrix a
        (
            r#"["{x, y} = x*y", "{x, z} = -2*x*z", "{y, z} = y*z/3", "{z, w} = 5*z*w"]"#,
            4,
            Some(2),
        ),
        // the gradient of a function of three coordinates, times any function: {x, y} = f dF/dz
        (
            r#"["{x, y} = (x + y^2)*2*z", "{y, z} = (x + y^2)*y", "{z, x} = (x + y^2)*x"]"#,
            2,
            Some(3),
        ),
        (
            r#"["{x, y} = exp(z)*sin(x)", "{y, z} = exp(x)*sin(x)", "{z, x} = exp(y)*sin(x)"]"#,
            2,
            None,
        ),
        (r#"["{x, y} = 1/(1 + z^2)", "{z, w} = 1"]"#, 0, None),
        (
            r#"["{x, y} = (sin(z)^2 + cos(z)^2)*x", "{z, w} = 1"]"#,
            4,
            Some(1),
        ),
        // Sklyanin's algebra: the Jacobian determinants of two quadrics
        (
            r#"["{x, y} = z*w", "{y, z} = x*w", "{z, x} = y*w",
                "{x, w} = 2*y*z", "{y, w} = -3*z*x", "{z, w} = x*y"]"#,
            2,
            Some(2),
        ),
    ] {
        let text = general(FOUR, brackets, &[]);
        if rank == 0 {
            // {z, w} = 1 moves z, on which {x, y} depends
            assert_eq!(kinds(&text), ["jacobi"], "{brackets}");
            continue;
        }
        let model = model(&text);
        assert_eq!(model.generic_rank, rank, "{brackets}");
        let Bracket::General(matrix) = &model.bracket else {
            panic!("{:?}", model.bracket)
        };
        assert_eq!(matrix.degree, degree, "{brackets}");
        assert!(!model.is_lie_poisson());
    }
}

/// The kinds of the errors.
fn kinds(text: &str) -> Vec<String> {
    let all = errors(text);
    let kind = |line: &String| line.split(' ').next().unwrap_or_default().to_owned();
    all.iter().map(kind).collect()
}

#[test]
fn one_wrong_coefficient_of_a_quadratic_bracket() {
    let sklyanin = |last: &str| {
        let brackets = format!(
            r#"["{{x, y}} = z*w", "{{y, z}} = x*w", "{{z, x}} = y*w",
                "{{x, w}} = 2*y*z", "{{y, w}} = -3*z*x", "{{z, w}} = {last}"]"#
        );
        let casimirs = r#"["x^2 + y^2 + z^2", "w^2 + x^2 + 2*y^2 + 4*z^2"]"#;
        general(FOUR, &brackets, &[("casimirs", casimirs)])
    };
    assert_eq!(model(&sklyanin("x*y")).casimirs.len(), 2);
    for wrong in ["-x*y", "3*x*y", "x*y + z", "x*y + y*z"] {
        assert!(
            kinds(&sklyanin(wrong)).contains(&"jacobi".to_owned()),
            "{wrong}"
        );
    }
    let found = errors(&sklyanin("3*x*y"));
    assert!(found[0].contains("(x, y, z): {x, {y, z}}"), "{found:?}");
}

#[test]
fn the_jacobi_identity_names_coordinates_and_residual() {
    let found = errors(&general(
        r#"["x", "y", "z"]"#,
        r#"["{x, y} = z", "{x, z} = y", "{y, z} = k*y"]"#,
        &[("parameters", r#"{"k": 2}"#)],
    ));
    assert_eq!(
        found,
        [
            "jacobi at {x, y} = z: the Jacobi identity fails for (x, y, z): \
          {x, {y, z}} + {y, {z, x}} + {z, {x, y}} = z*k"
        ]
    );
}

#[test]
fn casimirs_and_ranks() {
    let volterra = r#"["{x, y} = x*y", "{x, z} = a*x*z", "{y, z} = b*y*z"]"#;
    let state = r#"["x", "y", "z"]"#;
    let parameters = ("parameters", r#"{"a": 2, "b": "1/3"}"#);
    let with = |casimir: &str, initial: &str| {
        let casimirs = format!("[{casimir:?}]");
        let keys = [
            parameters,
            ("casimirs", casimirs.as_str()),
            ("initial", initial),
        ];
        general(state, volterra, &keys)
    };
    let found = model(&with("b*log(x) - a*log(y) + log(z)", "[1, 2, 3]"));
    assert_eq!((found.generic_rank, found.initial_rank), (2, Some(2)));
    let found = model(&with("z*x^b*y^-a", "[0.5, 2, 3]"));
    assert_eq!(found.casimirs.len(), 1);
    assert_eq!(
        kinds(&with("b*log(x) - a*log(y) + 2*log(z)", "[1, 2, 3]")),
        ["casimir"]
    );
    // on the boundary the rank is lower
    let found = model(&general(
        state,
        volterra,
        &[parameters, ("initial", "[0, 0, 3]")],
    ));
    assert_eq!((found.generic_rank, found.initial_rank), (2, Some(0)));
    // entries that are not rational
    let transcendental = r#"["{x, y} = exp(z)", "{y, z} = exp(x)", "{z, x} = exp(y)"]"#;
    let found = model(&general(state, transcendental, &[("initial", "[1, 2, 3]")]));
    assert_eq!((found.generic_rank, found.initial_rank), (2, Some(2)));
    let found = model(&general(
        state,
        r#"["{x, y} = sin(z)"]"#,
        &[("initial", "[1, 2, 0]")],
    ));
    assert_eq!((found.generic_rank, found.initial_rank), (2, Some(0)));
}

#[test]
fn cocycles() {
    let algebra = r#"{"basis": ["a", "b", "c", "d"], "brackets": ["[a, b] = c", "[a, c] = d"]}"#;
    let with = |cocycle: &str| {
        system(
            &[
                ("algebra", algebra),
                ("cocycle", cocycle),
                ("state", FOUR),
                ("hamiltonian", r#""1""#),
                (
                    "parameters",
                    r#"{"k": {"default": 1, "exact": true}, "m": 1}"#,
                ),
            ],
            &[],
        )
    };
    // S(b, c) and S(a, d) belong to cocycles; S(b, d) = -S([a, c], b) does not without S(c, c)
    for cocycle in [r#"["{y, z} = k"]"#, r#"["{x, w} = 1/k", "{x, y} = 3"]"#] {
        let model = model(&with(cocycle));
        let extension = model.bracket.algebra().and_then(|a| a.extension.as_ref());
        let extension = extension.expect("a central extension");
        assert!(matches!(extension.cocycle, Cocycle::Proper), "{cocycle}");
        assert_eq!((model.dimension(), extension.unit), (7, 6));
        assert_eq!(model.counts().0, 4);
        assert!(!model.is_timed());
    }
    // the constants of an extension are rational functions of the parameters
    let irrational = model(&with(r#"["{z, y} = sqrt(2)*k"]"#));
    let Bracket::General(matrix) = &irrational.bracket else {
        panic!("{:?}", irrational.bracket)
    };
    assert_eq!(matrix.degree, Some(1));
    for cocycle in [
        r#"["{y, w} = 1"]"#,
        r#"["{z, w} = k"]"#,
        r#"["{y, w} = sqrt(2)"]"#,
    ] {
        assert_eq!(kinds(&with(cocycle)), ["cocycle"], "{cocycle}");
    }
    let found = errors(&with(r#"["{y, z} = 1", "{y, w} = k"]"#));
    assert_eq!(
        found,
        [
            "cocycle at {y, w} = k: the cocycle identity fails for (a, b, c): \
          S([a, b], c) + S([b, c], a) + S([c, a], b) = k"
        ]
    );
    assert_eq!(kinds(&with(r#"["{y, z} = m"]"#)), ["unknown-symbol"]);
    // constants that are zero add nothing
    assert!(model(&with(r#"["{y, w} = 0"]"#)).is_lie_poisson());
}

/// A gyrostat: the cocycle of a rotor's momentum is that of a shift, also with parameters, and the Cayley map is that of the shifted body.
#[test]
fn coboundaries() {
    let with = |value: &str, more: &[(&str, &str)]| {
        let cocycle = format!(r#"["{{x, y}} = {value}", "{{y, z}} = -1/2"]"#);
        let base = [
            ("algebra", r#""so(3)""#),
            ("cocycle", cocycle.as_str()),
            ("hamiltonian", r#""x^2/2 + y^2/3 + z^4/5""#),
            ("parameters", r#"{"l": {"default": "3/2", "exact": true}}"#),
        ];
        model(&system(&base, more))
    };
    let right = [("invariance", r#""right""#)];
    for (more, sign) in [(&[][..], "-"), (&right, "")] {
        for (value, shift) in [("3/2", "3/2"), ("l", "l")] {
            let model = with(value, more);
            let algebra = model.bracket.algebra().expect("an algebra");
            let extension = algebra.extension.as_ref().expect("a central extension");
            let Cocycle::Coboundary(found) = &extension.cocycle else {
                panic!("{:?}", extension.cocycle)
            };
            // {x, y} = -z + S_xy, so that nu = mu - s with s_z = S_xy; of a right-invariant body the bracket is +z
            let shown: Vec<String> = found.iter().map(|s| s.display(&|_| "l".into())).collect();
            let other = if sign == "-" { "-1/2" } else { "1/2" };
            let expected = match (sign, shift) {
                ("-", shift) => shift.to_owned(),
                (_, shift) => format!("-{shift}"),
            };
            assert_eq!(shown, [other, "0", &expected], "{value} {more:?}");
            let representation = algebra.representation.as_ref().expect("matrices");
            let triple = representation.triple.as_ref().expect("it is closed");
            // what a triple product has beside that of so(3) is the shift, along the central element
            let unit = extension.unit;
            let added = triple.iter().filter(|entry| entry.3 == unit).count();
            assert!(added > 0 && representation.matrices.len() == 6);
        }
    }
    // the products of the matrices rho(e_i) + s_i rho(Z), beside those of the time
    let hat = |i: usize, shift: &str| {
        let entry = |r: usize, c: usize| match (r, c) {
            (3, 5) => format!("\"{shift}\""),
            _ if r < 3 && c < 3 && r != i && c != i => format!(
                "{}",
                if (r + 3 - i) % 3 == 2 { 1 } else { -1 } * i32::from(r != c)
            ),
            _ => "0".to_owned(),
        };
        let row = |r| {
            format!(
                "[{}]",
                (0..6).map(|c| entry(r, c)).collect::<Vec<_>>().join(", ")
            )
        };
        format!("[{}]", (0..6).map(row).collect::<Vec<_>>().join(", "))
    };
    let unit = |places: &[(usize, usize)]| {
        let entry = |r, c| if places.contains(&(r, c)) { "1" } else { "0" };
        let row = |r| {
            format!(
                "[{}]",
                (0..6).map(|c| entry(r, c)).collect::<Vec<_>>().join(", ")
            )
        };
        format!("[{}]", (0..6).map(row).collect::<Vec<_>>().join(", "))
    };
    let algebra = format!(
        r#"{{"basis": ["a", "b", "c", "P", "T", "Z"], "matrices": {{"a": {}, "b": {}, "c": {}, "P": {}, "T": {}, "Z": {}}}}}"#,
        hat(0, "-1/2"),
        hat(1, "0"),
        hat(2, "3/2"),
        unit(&[(3, 4)]),
        unit(&[(4, 5)]),
        unit(&[(3, 5)]),
    );
    let written = model(&system(
        &[
            ("algebra", algebra.as_str()),
            ("state", r#"["x", "y", "z", "p", "q", "u"]"#),
            ("hamiltonian", r#""x^2/2 + y^2/3 + z^4/5 + p""#),
        ],
        &[],
    ));
    let at = |value: &Fraction| value.evaluate(&|_| Rational::new(3, 2).expect("a number"));
    let triple = |model: &Model| -> Vec<_> {
        let representation = model.bracket.representation();
        let triple = representation
            .and_then(|r| r.triple.as_deref())
            .expect("it is closed");
        let entries = triple.iter().map(|(a, b, c, d, v)| (*a, *b, *c, *d, at(v)));
        entries.collect()
    };
    assert_eq!(triple(&with("l", &[])), triple(&written));
    assert_eq!(triple(&with("3/2", &[])), triple(&written));
}
