use super::*;
use crate::check::environment::{Allowed, Environment};
use crate::check::lower::Lowering;
use lie_symbolic::symbolic::Graph;
use lie_syntax::ast::{Expr, ExprKind};
use lie_syntax::limits::MAX_DIMENSION;
use std::sync::mpsc::RecvTimeoutError;
use std::time::Duration;

fn hamiltonian(text: &str) -> String {
    so3(&[("hamiltonian", &format!("{text:?}"))])
}

#[test]
fn constants() {
    expect(&hamiltonian("x + 1/0"), &["number at 0"]);
    expect(&hamiltonian("x/(1 - 1)"), &["number at (1 - 1)"]);
    expect(&hamiltonian("x/(y - y)"), &["number at (y - y)"]);
    expect(&hamiltonian("0^-1 + x"), &["number at 0"]);
    expect(&hamiltonian("(-2)^(1/2) + x"), &["number at (-2)"]);
    expect(&hamiltonian("sqrt(-4)*x"), &["number"]);
    expect(
        &hamiltonian("log(0)*x + asin(2)"),
        &["number at log(0)", "number at asin(2)"],
    );
    expect(
        &so3(&[(
            "parameters",
            r#"{"k": "1e400", "m": "exp(-1)", "n": "log(0)"}"#,
        )]),
        &["number at 1e400", "number at log(0)"],
    );
    for text in [
        "sqrt(-pi)*x",
        "x/(sin(1) - sin(1))",
        "x/(cos(pi) + 1)",
        "(-exp(1))^(1/2)*x",
        "(sin(0) + 0)^-1*x",
    ] {
        let found = errors(&hamiltonian(text));
        assert!(
            found.len() == 1 && found[0].starts_with("number"),
            "{text}: {found:#?}"
        );
    }
    let good = model(&hamiltonian("(-8)^2*x^2 + 2^0.5*y + x^-3 + y^(1/3) + 0*z"));
    assert!(good.graph.symbols(good.hamiltonian()).len() == 2);
}

#[test]
fn powers() {
    for text in [
        "9^9^9",
        "x^1001",
        "x^-2000",
        "(x^500)^3",
        "(x^999)*x^2",
        "2^(10^9)*x",
    ] {
        let found = errors(&hamiltonian(text));
        assert!(
            found.len() == 1 && found[0].starts_with("limit"),
            "{text}: {found:#?}"
        );
    }
    model(&hamiltonian("x^1000 + y^-1000 + 2^1000*z"));
    // a^b with a variable exponent
    let general = model(&hamiltonian("x^y + 2^z"));
    assert!(general.display(general.hamiltonian()).contains("exp("));
    expect(&hamiltonian("(-2)^x"), &["number at (-2)"]);
}

/// A chain of names, each the one before it in place of `#`.
fn chain(first: &str, step: &str) -> String {
    chain_of(200, first, step)
}

fn chain_of(count: usize, first: &str, step: &str) -> String {
    let mut lets = vec![format!("a0 = {first}")];
    lets.extend(
        (1..count).map(|i| format!("a{i} = {}", step.replace('#', &format!("a{}", i - 1)))),
    );
    so3(&[
        ("let", &format!("{lets:?}")),
        ("hamiltonian", &format!("\"a{}\"", count - 1)),
    ])
}

/// It ends at all: where a limit is missing, it takes longer than anybody waits, or all memory.
fn ends(hostile_input: fn()) {
    let (tell, told) = std::sync::mpsc::channel();
    let work = std::thread::spawn(move || {
        hostile_input();
        tell.send(())
    });
    let end = told.recv_timeout(Duration::from_secs(600));
    assert_ne!(end, Err(RecvTimeoutError::Timeout), "no end in ten minutes");
    work.join().expect("what is asserted").expect("heard");
}

#[test]
fn chains_of_names_end() {
    ends(|| {
        for (first, step) in [
            ("3^900", "#*#"),
            ("x", "#^7"),
            ("x + 1/3", "#*3^900"),
            ("2*x", "#^30"),
        ] {
            let found = errors(&chain(first, step));
            assert!(
                !found.is_empty() && found[0].starts_with("limit"),
                "{first} {step}: {found:#?}"
            );
        }
        model(&chain("x", "#*# + y"));
    });
}

/// These stay small in the arena, but their derivatives do not.
#[test]
fn derivatives_end() {
    ends(|| {
        let product = (0..3000)
            .map(|i| format!("(x + {i})"))
            .collect::<Vec<_>>()
            .join("*");
        for text in [chain_of(400, "x + y", "exp(-#)"), hamiltonian(&product)] {
            let found = errors(&text);
            assert!(
                found.len() == 1
                    && found[0].starts_with("limit")
                    && found[0].contains("derivatives"),
                "{found:#?}"
            );
        }
    });
}

#[test]
fn long_sums_end() {
    ends(|| {
        let wide = vec!["x"; 5_000].join(" + ");
        model(&hamiltonian(&wide));
        let waves = (1..500)
            .map(|i| format!("sin({i}*x + y)"))
            .collect::<Vec<_>>()
            .join(" + ");
        model(&hamiltonian(&waves));
        // A Casimir whose normal form would be huge is refused, not expanded.
        let huge = r#"["C = (x + y + z + x*y*z)^300*(x - y)^200"]"#;
        assert!(errors(&so3(&[("casimirs", huge)]))[0].starts_with("casimir"));
    });
}

#[test]
fn large_dimensions() {
    let names = |count: usize| {
        format!(
            "{:?}",
            (0..count).map(|i| format!("e{i}")).collect::<Vec<_>>()
        )
    };
    let abelian = |count: usize| {
        let algebra = format!(r#"{{"basis": {}, "brackets": []}}"#, names(count));
        system(
            &[
                ("algebra", &algebra),
                ("state", &names(count)),
                ("hamiltonian", r#""e0^2""#),
            ],
            &[],
        )
    };
    model(&abelian(MAX_DIMENSION));
    assert!(errors(&abelian(MAX_DIMENSION + 1))[0].starts_with("limit"));
}

#[test]
fn matrices_with_too_many_entries() {
    let names =
        |letter: &str| -> Vec<String> { (0..130).map(|i| format!("{letter}{i}")).collect() };
    let pairs = || (0..130).flat_map(|i| (i + 1..130).map(move |j| (i, j)));
    let spec = |brackets: Vec<String>, hamiltonian: Vec<String>| {
        let algebra = format!(r#"{{"basis": {:?}, "brackets": {brackets:?}}}"#, names("e"));
        system(
            &[
                ("algebra", &algebra),
                ("state", &format!("{:?}", names("x"))),
                ("hamiltonian", &format!("{:?}", hamiltonian.join(" + "))),
            ],
            &[],
        )
    };
    let one = || vec!["[e0, e1] = e2".to_owned()];
    let dense = spec(one(), pairs().map(|(i, j)| format!("x{i}*x{j}")).collect());
    expect(&dense, &["limit at x0*x1"]);
    assert!(errors(&dense)[0].contains("mixes 8385 pairs"));
    // the same number of pairs in one factor
    let sum = names("x").join(" + ");
    expect(
        &spec(one(), vec![format!("sin({sum})")]),
        &["limit at sin("],
    );
    // 384 pairs in many terms
    let band = pairs()
        .filter(|(i, j)| j - i < 4)
        .map(|(i, j)| format!("x{i}*x{j}"));
    model(&spec(one(), band.collect()));
    let bracket = |(i, j): (usize, usize)| format!("[e{i}, e{j}] = e{j} - e{i}");
    let full = spec(pairs().map(bracket).collect(), vec!["x0^2".into()]);
    let found = errors(&full);
    assert!(
        found[0].contains("8385 pairs of coordinates have a bracket"),
        "{found:?}"
    );
}

#[test]
fn too_many_parameters() {
    let parameters = |count: usize| {
        let each: Vec<String> = (0..count).map(|i| format!(r#""p{i}": 2"#)).collect();
        so3(&[
            ("parameters", &format!("{{{}}}", each.join(", "))),
            ("hamiltonian", r#""p7*x^2""#),
        ])
    };
    expect(&parameters(3001), &["limit at p3000"]);
    model(&parameters(3000));
}

#[test]
fn deep_trees_do_not_exhaust_the_stack() {
    let origin = Origin::Text { start: 0, end: 0 };
    let leaf = Expr {
        kind: ExprKind::Name {
            name: "x".into(),
            index: None,
        },
        origin,
    };
    let deep = (0..5000).fold(leaf, |inner, _| Expr {
        kind: ExprKind::Negative(Box::new(inner)),
        origin,
    });
    let mut graph = Graph::new();
    let mut report = Report::new();
    let text = so3(&[]);
    let Some(Body::Declaration(declaration)) = spec::read(&text, &mut report).body else {
        panic!()
    };
    assert!(report.into_diagnostics().is_empty());
    let environment = Environment::new(&declaration);
    let mut mistakes = Vec::new();
    assert!(
        Lowering::new(&mut graph, &environment, &mut mistakes, Allowed::Everything)
            .lower(&deep)
            .is_none()
    );
    assert_eq!(mistakes[0].kind, Kind::Limit);
}
