//! Discrete Lagrangians in the entries of the group element.

use super::*;

/// so(n) with the turn from axis i to axis j as its basis, and a discrete Lagrangian in the entries of R.
fn rotations(rows: usize, invariance: &str, value: &str, extra: &[(&str, &str)]) -> String {
    let pairs = || (0..rows).flat_map(move |i| (i + 1..rows).map(move |j| (i, j)));
    let names = |letter: &str| {
        let names = pairs().map(|(i, j)| format!("\"{letter}{}{}\"", i + 1, j + 1));
        format!("[{}]", names.collect::<Vec<String>>().join(", "))
    };
    let matrices = pairs().map(|(i, j)| {
        let mut matrix = vec![vec![0; rows]; rows];
        (matrix[i][j], matrix[j][i]) = (-1, 1);
        format!("\"e{}{}\": {matrix:?}", i + 1, j + 1)
    });
    let matrices = matrices.collect::<Vec<String>>().join(", ");
    let algebra = format!(
        "{{\"basis\": {}, \"matrices\": {{{matrices}}}}}",
        names("e")
    );
    let (state, velocity) = (names("m"), names("x"));
    let (value, invariance) = (format!("{value:?}"), format!("{invariance:?}"));
    system(
        &[
            ("algebra", &algebra),
            ("group", "\"R\""),
            ("invariance", &invariance),
            ("state", &state),
            ("velocity", &velocity),
            ("discrete_lagrangian", &value),
        ],
        extra,
    )
}

/// `sum_k k (1 - R_kk)/h`
fn body(rows: usize) -> String {
    let terms = (1..=rows).map(|k| format!("{k}*(1 - R{k}{k})"));
    format!("({})/h", terms.collect::<Vec<String>>().join(" + "))
}

/// `tr(J (1 - g))/h` has the Lagrangian `sum (J_i + J_j) x_ij^2/2`.
#[test]
fn the_hamiltonian_of_moser_and_veselovs_body() {
    for rows in [3, 4, 5, 6] {
        for invariance in ["left", "right"] {
            let model = model(&rotations(rows, invariance, &body(rows), &[]));
            let hamiltonian = model.hamiltonian();
            let pairs = (1..=rows).flat_map(|i| (i + 1..=rows).map(move |j| i + j));
            let mu = |k: usize| 0.3 + 0.7 * k as f64;
            let expected = pairs
                .enumerate()
                .map(|(k, sum)| mu(k).powi(2) / (2.0 * sum as f64));
            let expected: f64 = expected.sum();
            let found = model.graph.evaluate(hamiltonian, &|symbol| match symbol {
                Symbol::Coordinate(k) => mu(k),
                _ => f64::NAN,
            });
            assert!(
                (found / expected - 1.0).abs() < 1e-14,
                "{rows} {invariance}"
            );
        }
    }
}

/// Turns about two planes at once: `(1 - x^2/4)/(1 + x^2/4)` and `x/(1 + x^2/4)` in each, whichever invariance.
#[test]
fn entries_of_two_turns() {
    for rows in [4, 5, 6] {
        for invariance in ["left", "right"] {
            let entries = [
                ("R11", 0),
                ("R44", 1),
                ("R21", 2),
                ("R12", 3),
                ("R34", 4),
                ("R13", 5),
            ];
            for (name, which) in entries {
                let text = format!("{} + h*{name}", body(rows));
                let model = model(&rotations(rows, invariance, &text, &[]));
                let discrete = model.energy.lagrangian().and_then(|l| l.discrete.as_ref());
                let discrete = discrete.expect("it has one");
                let (h, x12, x34) = (0.5, 0.8, -1.4);
                // x34 stands behind x12 … x1n and x23 … x2n
                let place = (rows - 1) + (rows - 2);
                let found = model
                    .graph
                    .evaluate(discrete.value, &|symbol| match symbol {
                        Symbol::Input(0) => x12,
                        Symbol::Input(k) => {
                            if k == place {
                                x34
                            } else {
                                0.0
                            }
                        }
                        Symbol::Step => h,
                        _ => f64::NAN,
                    });
                let cosine = |x: f64| (1.0 - x * x / 4.0) / (1.0 + x * x / 4.0);
                let sine = |x: f64| x / (1.0 + x * x / 4.0);
                let value = 3.0 * (1.0 - cosine(x12)) + 7.0 * (1.0 - cosine(x34));
                let entry = [
                    cosine(x12),
                    cosine(x34),
                    sine(x12),
                    -sine(x12),
                    -sine(x34),
                    0.0,
                ];
                let expected = value / h + h * entry[which];
                assert!(
                    (found - expected).abs() < 1e-13,
                    "{rows} {invariance} {name}: {found} {expected}"
                );
            }
        }
    }
}

#[test]
fn what_people_read_has_the_entries() {
    let model = model(&rotations(
        5,
        "right",
        "(1 - R11 + 5 - R22 - R33 - R44 - R55 - 0 + R12^2)/h - 1/h",
        &[],
    ));
    let discrete = model.energy.lagrangian().and_then(|l| l.discrete.as_ref());
    let shown = model.display(discrete.expect("it has one").shown());
    assert!(
        shown.contains("(R11 - 1)") && shown.contains("R12^2"),
        "{shown}"
    );
}

#[test]
fn entries_stand_in_the_lagrangian_alone() {
    let entry = [("casimirs", r#"["R11"]"#)];
    expect(
        &rotations(5, "right", &body(5), &entry),
        &["unknown-symbol at R11: `R11` cannot stand here"],
    );
    // and abbreviations that serve it
    let turned = [("let", r#"["turned = 1 - R11"]"#)];
    let value = body(5).replace("1*(1 - R11)", "turned");
    assert!(
        super::model(&rotations(5, "left", &value, &turned))
            .energy
            .lagrangian()
            .is_some()
    );
    // an entry of first order has no limit
    expect(
        &rotations(5, "left", "(R12 + R11)/h", &[]),
        &["legendre at (R12 + R11)/h: the discrete Lagrangian is not consistent with any"],
    );
}

#[test]
fn a_second_derivative_that_is_too_large() {
    let squares = (1..=9).flat_map(|i| (1..=9).map(move |j| format!("R{i}{j}^4")));
    let squares = squares.collect::<Vec<String>>().join(" + ");
    let sums = format!("({squares})*h + {}", body(9));
    // 36*37/2*81 + 72^2 products, then 45*46/2*100 + 90^2
    assert!(run(&rotations(9, "right", &sums, &[])).0.is_some());
    let squares = (1..=10).flat_map(|i| (1..=10).map(move |j| format!("R_{i}_{j}^4")));
    let squares = squares.collect::<Vec<String>>().join(" + ");
    expect(
        &rotations(10, "right", &format!("({squares})*h"), &[]),
        &["limit at (R_1_1^4"],
    );
}
