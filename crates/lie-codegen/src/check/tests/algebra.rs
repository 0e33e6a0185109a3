use super::*;
use crate::algebra::{Representation, known};
use crate::model::Algebra;

fn algebra_of(model: &Structure) -> &Algebra {
    model.bracket.algebra().expect("an algebra")
}

fn matrices_of(model: &Structure) -> Representation {
    model.bracket.representation().expect("matrices").clone()
}

/// A spec of an algebra with coordinates x0, x1, ….
fn with_brackets(basis: &[&str], brackets: &[&str], extra: &[(&str, &str)]) -> String {
    let state: Vec<String> = (0..basis.len()).map(|i| format!("x{i}")).collect();
    let algebra = format!(r#"{{"basis": {basis:?}, "brackets": {brackets:?}}}"#);
    let state = format!("{state:?}");
    system(
        &[
            ("algebra", &algebra),
            ("state", &state),
            ("hamiltonian", r#""x0^2""#),
        ],
        extra,
    )
}

fn with_matrices(matrices: &[known::Integers], brackets: Option<&[&str]>) -> String {
    let names: Vec<String> = (0..matrices.len()).map(|i| format!("E{i}")).collect();
    let state: Vec<String> = (0..matrices.len()).map(|i| format!("x{i}")).collect();
    let entries: Vec<String> = names
        .iter()
        .zip(matrices)
        .map(|(name, m)| format!("\"{name}\": {m:?}"))
        .collect();
    let brackets = brackets.map_or(String::new(), |b| format!(", \"brackets\": {b:?}"));
    let algebra = format!(
        r#"{{"basis": {names:?}, "matrices": {{{}}}{brackets}}}"#,
        entries.join(", ")
    );
    let state = format!("{state:?}");
    system(
        &[
            ("algebra", &algebra),
            ("state", &state),
            ("hamiltonian", r#""x0^2""#),
        ],
        &[],
    )
}

#[test]
fn messages_name_the_triple_and_the_residual() {
    let basis = ["J1", "J2", "J3", "P1", "P2", "P3"];
    let mut brackets = [
        "[J1, J2] = J3",
        "[J2, J3] = J1",
        "[J3, J1] = J2",
        "[J1, P2] = P3",
        "[J2, P3] = P1",
        "[J3, P1] = P2",
        "[P1, J2] = P3",
        "[P2, J3] = P1",
        "[P3, J1] = P2",
    ];
    assert_eq!(
        model(&with_brackets(&basis, &brackets, &[])).generic_rank,
        4
    );
    brackets[3] = "[J1, P2] = P3 + 1e-18*P3";
    let found = errors(&with_brackets(&basis, &brackets, &[]));
    assert_eq!(found.len(), 1);
    let expected = "the Jacobi identity fails for (J1, J2, P1): [[J1, J2], P1] + [[J2, P1], J1] + [[P1, J1], J2] = 0";
    assert!(
        found[0].starts_with("jacobi") && !found[0].contains(expected),
        "{found:#?}"
    );
    assert!(found[0].contains("1/1000000000000000000*"), "{found:#?}");
}

#[test]
fn exact_parameters() {
    let basis = ["a", "b", "c"];
    let exact = ("parameters", r#"{"k": {"default": "1/3", "exact": true}}"#);
    let good = model(&with_brackets(
        &basis,
        &["[a, b] = k*b", "[a, c] = c/(1 + k^2)"],
        &[exact],
    ));
    let algebra = algebra_of(&good);
    let entries: Vec<String> = algebra
        .constants
        .entries()
        .iter()
        .map(|e| good.display(e.3))
        .collect();
    assert_eq!(entries, ["k", "1/(k^2 + 1)"]);
    let default = |p: usize| good.parameters[p].exact.clone().expect("exact");
    let numbers = algebra.exact.try_map(|c| c.evaluate(&default)).unwrap();
    assert_eq!(numbers.entries()[1].3, Rational::new(9, 10).unwrap());
    assert_eq!(good.generic_rank, 2);
    // [[a,b],c] + [[b,c],a] + [[c,a],b] = k a + (1 - k) (-a)…: holds for one value of k only.
    let found = errors(&with_brackets(
        &basis,
        &["[a, b] = k*b", "[a, c] = -c", "[b, c] = a"],
        &[exact],
    ));
    assert!(
        found.len() == 1 && found[0].contains("= (-k + 1)*a") || found[0].contains("= (k - 1)*a"),
        "{found:#?}"
    );
    // A pole at the default value.
    let pole = ("parameters", r#"{"k": {"default": 1, "exact": true}}"#);
    expect(
        &with_brackets(&basis, &["[a, b] = b/(k - 1)"], &[pole]),
        &["number at k"],
    );
    expect(
        &with_brackets(&basis, &["[a, b] = b/(k - k)"], &[exact]),
        &["number at (k - k)"],
    );
    let irrational = (
        "parameters",
        r#"{"k": {"default": "sqrt(2)", "exact": true}}"#,
    );
    expect(
        &with_brackets(&basis, &["[a, b] = k*b"], &[irrational]),
        &["number at sqrt(2): the default of the exact"],
    );
}

#[test]
fn brackets_that_disagree() {
    let basis = ["a", "b", "c"];
    let with = |brackets: &[&str]| with_brackets(&basis, brackets, &[]);
    model(&with(&[
        "[a, b] = c",
        "[b, a] = -c",
        "[a, b] = 2*c/2",
        "[a, a] = 0",
        "[c, c] = b - b",
    ]));
    expect(
        &with(&["[a, b] = c", "[b, a] = c"]),
        &["antisymmetry at [b, a] = c: [b, a] disagrees with [a, b] = c"],
    );
    expect(
        &with(&["[b, a] = c", "[b, a] = 2*c"]),
        &["duplicate-bracket at [b, a] = 2*c: [b, a] was already given another value: [b, a] = c"],
    );
    expect(&with(&["[a, a] = c"]), &["antisymmetry at [a, a] = c"]);
    expect(
        &with(&["[a, d] = e", "[b, f] = a"]),
        &[
            "unknown-symbol at d",
            "unknown-symbol at e",
            "unknown-symbol at f",
        ],
    );
    let (_, found) = run(&with_brackets(&["Jx", "Jy", "Jz"], &["[Jx, Jy] = JZ"], &[]));
    assert_eq!(found[0].help.as_deref(), Some("did you mean `Jz`?"));
}

#[test]
fn right_sides_are_linear() {
    let parameters = (
        "parameters",
        r#"{"k": {"default": 1, "exact": true}, "m": 2}"#,
    );
    let with = |value: &str| {
        with_brackets(
            &["a", "b", "c"],
            &[&format!("[a, b] = {value}")],
            &[parameters, ("let", r#"["w = 3"]"#)],
        )
    };
    for value in [
        "c",
        "2*c/k",
        "(c + 0)*(k - 1/2)^2",
        "-c^1",
        "k^-2*c",
        "0",
        "c*2^10",
        "-(-c)",
    ] {
        model(&with(value));
    }
    for value in [
        "c*c",
        "c^2",
        "1",
        "c + 1",
        "1/c",
        "k",
        "sin(k)*c",
        "pi*c",
        "k^(1/2)*c",
        "c^c",
        "sqrt(4)*c",
    ] {
        let found = errors(&with(value));
        assert!(
            found.len() == 1 && found[0].starts_with("syntax"),
            "{value}: {found:#?}"
        );
    }
    for value in ["m*c", "w*c", "x0", "q"] {
        let found = errors(&with(value));
        assert!(
            found.len() == 1 && found[0].starts_with("unknown-symbol"),
            "{value}: {found:#?}"
        );
    }
    expect(&with("c/0"), &["number at 0"]);
    expect(&with("c/(k - k)"), &["number at (k - k)"]);
    expect(&with("(k + 1)^1001*c"), &["limit at 1001"]);
    expect(&with("(k^900)^2*c"), &["limit at (k^900)^2*c"]);
}

#[test]
fn brackets_from_matrices() {
    let se3 = model(&with_matrices(&known::se3(), None));
    assert_eq!(algebra_of(&se3).constants.entries().len(), 9);
    let representation = matrices_of(&se3);
    assert_eq!(
        (representation.dimension, representation.triple.is_some()),
        (4, true)
    );
    let su3 = model(&with_matrices(&known::su(3), None));
    assert_eq!((su3.generic_rank, matrices_of(&su3).triple), (6, None));
    let mut dependent = known::sl2();
    dependent.push(vec![vec![2, 3], vec![0, -2]]);
    let found = errors(&with_matrices(&dependent, None));
    assert!(
        found[0].starts_with("representation") && found[0].contains("linearly dependent: "),
        "{found:#?}"
    );
    let open = [known::unit(2, 0, 1), known::unit(2, 1, 0)];
    assert!(errors(&with_matrices(&open, None))[0].starts_with("representation"));
}

#[test]
fn matrices_are_checked_against_brackets() {
    let so3 = ["[E0, E1] = E2", "[E1, E2] = E0", "[E2, E0] = E1"];
    let good = known::se3().into_iter().take(3).collect::<Vec<_>>();
    model(&with_matrices(&good, Some(&so3)));
    let mut wrong = good.clone();
    wrong[2][0][1] = 1;
    let found = errors(&with_matrices(&wrong, Some(&so3)));
    assert!(
        found.len() == 1 && found[0].contains("do not represent [E0, E1] = E2: entry (1, 2)"),
        "{found:#?}"
    );
    // A representation need not be faithful where the brackets are declared.
    let trivial = vec![vec![vec![0; 2]; 2]; 3];
    assert_eq!(
        matrices_of(&model(&with_matrices(&trivial, Some(&so3)))).triple,
        None
    );
    let mut ragged = good.clone();
    ragged[1].pop();
    assert!(errors(&with_matrices(&ragged, Some(&so3)))[0].starts_with("representation"));
    let missing: Vec<_> = good.iter().take(2).cloned().collect();
    let text = with_matrices(&missing, Some(&["[E0, E1] = E0"]))
        .replace(r#"["E0", "E1"]"#, r#"["E0", "E1", "E2"]"#)
        .replace(r#"["x0", "x1"]"#, r#"["x0", "x1", "x2"]"#);
    let found = errors(&text);
    assert!(
        found[0] == "representation at E2: no matrix for E2",
        "{found:#?}"
    );
    expect(
        &with_matrices(&good, Some(&so3)).replace("\"E2\": [[", "\"E3\": [["),
        &["basis at E3"],
    );
    expect(
        &with_matrices(&good, Some(&so3)).replace("-1", "\"sqrt(2)\""),
        &["number"; 3],
    );
}

#[test]
fn right_invariance_is_the_opposite_algebra() {
    let se3 = with_matrices(&known::se3(), None);
    let left = model(&se3);
    let right = model(&se3.replace("\"format\": 1", "\"format\": 1, \"invariance\": \"right\""));
    let [of_left, of_right] = [&left, &right].map(|model| algebra_of(model).exact.entries());
    for (a, b) in of_left.iter().zip(of_right) {
        assert_eq!(a.3.as_constant(), Some(-b.3.as_constant().unwrap()));
    }
    let (a, b) = (matrices_of(&left), matrices_of(&right));
    assert_eq!(a.matrices[0][1][2], -&b.matrices[0][1][2]);
    assert_eq!(a.triple, b.triple);
}

#[test]
fn ranks_at_the_initial_state() {
    let so3 = |initial: &str| model(&so3(&[("initial", initial)])).initial_rank;
    assert_eq!(so3("[1, 2, 3]"), Some(2));
    assert_eq!(so3("[0, 0, 0]"), Some(0));
    assert_eq!(so3("[0, 0, 1e-300]"), Some(2));
    assert_eq!(model(&super::so3(&[])).initial_rank, None);
}
