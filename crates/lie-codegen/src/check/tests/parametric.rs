//! Matrices whose entries are rational functions of exact parameters, against those with the numbers put in.

use super::*;
use crate::algebra::known::{self, Integers};
use crate::methods::{Choice, applicability, refusal};
use crate::structure::group;
use lie_core::structure::Chart;
use lie_symbolic::exact::Fraction;

/// A spec of matrices by the text of their entries, with or without brackets.
fn spec(matrices: &[Vec<Vec<String>>], brackets: Option<&[&str]>, k: &str) -> String {
    let names: Vec<String> = (0..matrices.len()).map(|i| format!("E{i}")).collect();
    let state: Vec<String> = (0..matrices.len()).map(|i| format!("x{i}")).collect();
    let entries = names.iter().zip(matrices);
    let entries: Vec<String> = entries.map(|(e, m)| format!("\"{e}\": {m:?}")).collect();
    let brackets = brackets.map_or(String::new(), |b| format!(", \"brackets\": {b:?}"));
    let algebra = format!(
        r#"{{"basis": {names:?}, "matrices": {{{}}}{brackets}}}"#,
        entries.join(", ")
    );
    system(
        &[
            ("algebra", &algebra),
            ("state", &format!("{state:?}")),
            ("hamiltonian", r#""k*x0^2""#),
            (
                "parameters",
                &format!(r#"{{"k": {{"default": "{k}", "exact": true}}}}"#),
            ),
        ],
        &[],
    )
}

/// The matrices of a basis that is scaled by powers of k, in another basis of the space: `s_a D rho_a D^-1` with
/// `D = diag(1, k, k^2, ...)`, and behind it a shear, `1 + (k + 1) E_12`.
fn conjugated(matrices: &[Integers]) -> Vec<Vec<Vec<String>>> {
    let matrix = |(a, rho): (usize, &Integers)| {
        let scaled = |i: usize, j: usize| match rho[i][j] {
            0 => "0".to_owned(),
            value => {
                let power = i as i64 - j as i64 + (a % 3) as i64 - 1;
                format!("({value})*k^({power})")
            }
        };
        let size = rho.len();
        // S = 1 + f E_12: the first row gains f times the second, then the second column loses f times the first
        let row = |i: usize, j: usize| match i {
            0 => format!("({} + (k + 1)*({}))", scaled(0, j), scaled(1, j)),
            _ => format!("({})", scaled(i, j)),
        };
        let entry = |i: usize, j: usize| match j {
            1 => format!("{} - (k + 1)*{}", row(i, 1), row(i, 0)),
            _ => row(i, j),
        };
        let rows = (0..size).map(|i| (0..size).map(|j| entry(i, j)).collect());
        rows.collect()
    };
    matrices.iter().enumerate().map(matrix).collect()
}

/// Structure constants and triple products at a value of k.
type Tables = (
    Vec<(usize, usize, usize, Rational)>,
    Option<Vec<(usize, usize, usize, usize, Rational)>>,
);

fn tables(model: &Structure, k: &Rational) -> Tables {
    let at = |value: &Fraction| value.evaluate(&|_| k.clone()).expect("finite");
    let algebra = model.bracket.algebra().expect("an algebra");
    let constants = algebra.exact.entries().iter();
    let constants = constants.map(|(i, j, l, v)| (*i, *j, *l, at(v)));
    let triple = model.bracket.triple();
    let triple = triple.map(|entries| {
        let entries = entries.iter();
        entries
            .map(|(a, b, c, d, v)| (*a, *b, *c, *d, at(v)))
            .collect()
    });
    (constants.collect(), triple)
}

#[test]
fn the_same_as_with_the_number_put_in() {
    let families = [
        (known::so(3), true),
        (known::so(4), true),
        (known::se3(), true),
        (known::sl2(), true),
        (known::sp(2), true),
        (known::su(3), false),
        (known::mixed(&known::so(3), 7), true),
    ];
    for (matrices, closed) in families {
        let matrices = conjugated(&matrices);
        let parametric = model(&spec(&matrices, None, "1/3"));
        assert!(parametric.bracket.representation().is_none());
        let found = parametric.bracket.parametric().expect("matrices");
        assert_eq!(found.parameters().into_iter().collect::<Vec<_>>(), [0]);
        assert_eq!(found.triple.is_some(), closed);
        for (text, n, d) in [("1/3", 1, 3), ("-2", -2, 1), ("7/5", 7, 5), ("-1/9", -1, 9)] {
            let put_in = |entry: &String| entry.replace('k', &format!("({text})"));
            let numbers = matrices.iter().map(|matrix| {
                let row = |row: &Vec<String>| row.iter().map(put_in).collect();
                matrix.iter().map(row).collect()
            });
            let numbers: Vec<Vec<Vec<String>>> = numbers.collect();
            let numbers = model(&spec(&numbers, None, "1/3"));
            assert!(numbers.bracket.representation().is_some());
            let k = Rational::new(n, d).expect("a number");
            let expected = tables(&numbers, &k);
            assert_eq!(tables(&parametric, &k), expected, "{text}");
            // it is not that of another value, if anything varies
            let other = tables(&parametric, &(&k + &Rational::ONE));
            assert_ne!(other, expected, "{text}");
        }
    }
}

fn rows(rows: &[&[&str]]) -> Vec<Vec<String>> {
    let row = |row: &&[&str]| row.iter().map(|entry| (*entry).to_owned()).collect();
    rows.iter().map(row).collect()
}

/// Rotations for positive k, boosts for negative ones.
fn turning() -> Vec<Vec<Vec<String>>> {
    vec![
        rows(&[&["0", "0", "0"], &["0", "0", "-k"], &["0", "1", "0"]]),
        rows(&[&["0", "0", "k"], &["0", "0", "0"], &["-1", "0", "0"]]),
        rows(&[&["0", "-1", "0"], &["1", "0", "0"], &["0", "0", "0"]]),
    ]
}

const BRACKETS: [&str; 3] = ["[E0, E1] = k*E2", "[E1, E2] = E0", "[E2, E0] = E1"];

#[test]
fn brackets_hold_for_all_values_or_not_at_all() {
    let computed = model(&spec(&turning(), None, "2"));
    let declared = model(&spec(&turning(), Some(&BRACKETS), "2"));
    let k = Rational::new(-3, 7).expect("a number");
    assert_eq!(tables(&computed, &k), tables(&declared, &k));
    let at_one = ["[E0, E1] = E2", "[E1, E2] = E0", "[E2, E0] = E1"];
    for default in ["1", "2"] {
        let found = errors(&spec(&turning(), Some(&at_one), default));
        assert!(
            found.len() == 1 && found[0].starts_with("representation"),
            "{found:#?}"
        );
        assert!(
            found[0].contains("k - 1") || found[0].contains("-k + 1"),
            "{found:#?}"
        );
    }
}

#[test]
fn dependent_and_open_matrices() {
    let at = |k: &str| errors(&spec(&turning(), None, k));
    assert_eq!(
        at("0"),
        Vec::<String>::new(),
        "a contraction, whose matrices are independent"
    );
    // k E0 vanishes for k = 0
    let mut scaled = turning();
    scaled[2] = rows(&[&["0", "-k", "0"], &["k", "0", "0"], &["0", "0", "0"]]);
    model(&spec(&scaled, None, "1"));
    for brackets in [
        None,
        Some(&["[E0, E1] = E2", "[E1, E2] = k*E0", "[E2, E0] = k*E1"][..]),
    ] {
        expect(
            &spec(&scaled, brackets, "0"),
            &[
                "representation at k: the matrices are linearly dependent for the default parameters: E2 = 0",
            ],
        );
    }
    let mut same = turning();
    same[1] = rows(&[&["0", "0", "0"], &["0", "0", "-k^2"], &["0", "k", "0"]]);
    let found = errors(&spec(&same, None, "1"));
    assert!(
        found.len() == 1 && found[0].contains("the matrices are linearly dependent: "),
        "{found:#?}"
    );
    let mut open = turning();
    open[2] = rows(&[&["k", "0", "0"], &["0", "0", "0"], &["0", "0", "0"]]);
    let found = errors(&spec(&open, None, "1"));
    assert!(
        found.len() == 1 && found[0].contains("is outside the span"),
        "{found:#?}"
    );
    let mut pole = turning();
    pole[2] = rows(&[
        &["0", "-1/(k - 1)", "0"],
        &["1/(k - 1)", "0", "0"],
        &["0", "0", "0"],
    ]);
    let brackets = [
        "[E0, E1] = k*(k - 1)*E2",
        "[E1, E2] = E0/(k - 1)",
        "[E2, E0] = E1/(k - 1)",
    ];
    model(&spec(&pole, Some(&brackets), "2"));
    expect(&spec(&pole, None, "1"), &["number at k: [E"]);
    // one with finite brackets
    let alone = vec![rows(&[&["0", "1/(k - 1)"], &["0", "0"]])];
    expect(
        &spec(&alone, None, "1"),
        &["representation at k: the matrix of `E0` is divided by zero for the default parameters"],
    );
}

#[test]
fn names_that_are_no_exact_parameters() {
    let with = |entry: &str, extra: &[(&str, &str)]| {
        let mut matrices = turning();
        matrices[2][0][1] = entry.to_owned();
        let text = spec(&matrices, None, "2");
        let keys: Vec<String> = extra
            .iter()
            .map(|(key, v)| format!(", \"{key}\": {v}"))
            .collect();
        let end = text.rfind('}').expect("an object");
        let text = format!("{}{}}}", &text[..end], keys.concat());
        let (_, diagnostics) = run(&text);
        let first = diagnostics
            .into_iter()
            .find(|d| !d.warning)
            .expect("an error");
        (
            first.kind.to_string(),
            first.message.clone(),
            first.help.expect("a remedy"),
        )
    };
    let inexact = spec(&turning(), None, "2").replace(r#", "exact": true"#, "");
    let found = errors(&inexact);
    let expected = "unknown-symbol at k: the parameter `k` is not exact, so a matrix cannot use it";
    assert_eq!(found, [expected, expected]);
    let help = run(&inexact).1[0].help.clone().expect("a remedy");
    assert!(
        help.starts_with("declare it exact: `exact k = …;`"),
        "{help}"
    );
    for (entry, extra, kind, message, help) in [
        (
            "-q",
            &[][..],
            "unknown-symbol",
            "`q` is no exact parameter",
            "declare it as an exact parameter",
        ),
        (
            "x1",
            &[],
            "unknown-symbol",
            "`x1` is a coordinate",
            "declare it as an exact parameter",
        ),
        (
            "E1",
            &[],
            "unknown-symbol",
            "`E1` is a basis name",
            "declare it as an exact parameter",
        ),
        (
            "a",
            &[("let", r#"["a = k^2"]"#)],
            "unknown-symbol",
            "`a` is an abbreviation",
            "write it out",
        ),
        (
            "sqrt(k)",
            &[],
            "number",
            "`sqrt` is not rational",
            "an expression such as -k/2",
        ),
        (
            "k^(1/2)",
            &[],
            "number",
            "an exponent that is not an integer",
            "an expression such as -k/2",
        ),
        (
            "t",
            &[],
            "number",
            "`t` is not rational",
            "an expression such as -k/2",
        ),
    ] {
        let found = with(entry, extra);
        assert_eq!(found.0, kind, "{entry}: {found:?}");
        assert!(
            found.1.contains(message) && found.2.contains(help),
            "{entry}: {found:?}"
        );
    }
}

#[test]
fn what_needs_numbers_is_refused_by_the_name_of_the_parameter() {
    let parametric = model(&spec(&turning(), None, "2"));
    let why = "needs `matrices` of numbers, and the declared ones depend on the parameter `k`";
    for id in [
        "isospectral2",
        "isospectral4",
        "isospectral16",
        "collective4",
        "collective16",
    ] {
        let choice = Choice::from_id(id).expect("a method");
        let (reason, help) = refusal(&parametric, &choice).expect("a refusal");
        assert!(reason.contains(why), "{id}: {reason}");
        assert!(
            help.contains("write the value of `k` into the matrices"),
            "{id}: {help}"
        );
    }
    let (reason, _) = group::refusal(&parametric, Chart::Matrix).expect("a refusal");
    assert!(reason.contains(why), "{reason}");
    let put_in = spec(&turning(), None, "2")
        .replace('k', "2")
        .replace("\"2\": {", "\"k\": {");
    let numbers = model(&put_in);
    assert!(group::refusal(&numbers, Chart::Matrix).is_none());
    // everything else is the same but what has no space to go over
    let known = applicability(&numbers);
    for ((id, why), (_, of_numbers)) in applicability(&parametric).into_iter().zip(known) {
        let lifted = ["collective", "isospectral"]
            .iter()
            .any(|kind| id.starts_with(kind));
        assert_eq!(
            why.is_some(),
            of_numbers.is_some() || lifted,
            "{id}: {why:?} {of_numbers:?}"
        );
    }
    let discrete = spec(&turning(), None, "2").replace(
        r#""hamiltonian": "k*x0^2""#,
        r#""group": "g", "velocity": ["u", "v", "w"], "discrete_lagrangian": "(3 - g11 - g22 - g33)/h""#,
    );
    let found = errors(&discrete);
    assert!(
        found.len() == 1
            && found[0].starts_with("representation at (3 - g11")
            && found[0].contains(why),
        "{found:#?}"
    );
    let with = |key: &str, value: &str| {
        let text = spec(&turning(), None, "2");
        let end = text.rfind('}').expect("an object");
        errors(&format!("{}, \"{key}\": {value}}}", &text[..end]))
    };
    let identity = r#"{"matrix": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]}"#;
    for (key, value) in [
        ("attitude", identity),
        (
            "retraction",
            r#"{"map": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]}"#,
        ),
    ] {
        let found = with(key, value);
        assert!(
            found.len() == 1 && found[0].contains(why),
            "{key}: {found:#?}"
        );
    }
}

/// With entries of the group element in the state the matrices are part of the brackets, and all methods of these apply.
#[test]
fn entries_of_the_group_element_beside_them() {
    let of = |text: String| {
        text.replace(r#""k*x0^2""#, r#""x0^2/2 + x1^2/3 + x2^2/4 + R13 + k*R22""#)
            .replace("\"format\": 1", "\"format\": 1, \"group\": \"R\"")
    };
    let parametric = model(&of(spec(&turning(), None, "3/2")));
    let put_in = |entry: &String| entry.replace('k', "(3/2)");
    let numbers = turning().into_iter().map(|matrix| {
        let row = |row: Vec<String>| row.iter().map(put_in).collect();
        matrix.into_iter().map(row).collect()
    });
    let numbers: Vec<Vec<Vec<String>>> = numbers.collect();
    let numbers = model(&of(spec(&numbers, None, "3/2")));
    let k = Rational::new(3, 2).expect("a number");
    assert_eq!(tables(&parametric, &k), tables(&numbers, &k));
    assert_ne!(tables(&parametric, &Rational::ONE), tables(&numbers, &k));
}
