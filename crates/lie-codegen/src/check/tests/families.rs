use super::{expect, model, system};
use crate::model::Size;
use lie_core::lattice::AXES;

/// A ring of spins with what is given instead.
fn ring(extra: &[(&str, &str)]) -> String {
    system(
        &[
            ("algebra", r#""so(3)^N""#),
            ("state", r#"["x[i]", "y[i]", "z[i]"]"#),
            ("parameters", r#"{"N": 8, "J": 1}"#),
            ("hamiltonian", r#""J*sum(i in 0..N: x[i]*x[i+1])""#),
        ],
        extra,
    )
}

fn hamiltonian(text: &str) -> Vec<(&'static str, String)> {
    vec![("hamiltonian", format!("\"{text}\""))]
}

/// The errors of a Hamiltonian.
#[track_caller]
fn refused(text: &str, expected: &[&str]) {
    let keys = hamiltonian(text);
    let keys: Vec<(&str, &str)> = keys.iter().map(|(k, v)| (*k, v.as_str())).collect();
    expect(&ring(&keys), expected);
}

#[test]
fn a_ring_has_the_casimirs_of_a_site_and_the_slots_of_its_bonds() {
    let model = model(&ring(&[]));
    let family = model.family.as_ref().expect("a family");
    assert_eq!(family.sizes, [Size::Parameter(0)]);
    assert_eq!(family.slots, [[0, 0, -1], [0, 0, 0], [0, 0, 1]]);
    assert_eq!(family.own, 1);
    assert_eq!(family.sums[0].slots, [1, 2]);
    assert_eq!(family.sums[0].spans, [None; AXES]);
    assert_eq!(family.degree, Some(2));
    assert_eq!((model.casimirs.len(), model.generic_rank), (1, 2));
    assert_eq!(
        model.display_of_family(family),
        "J*sum(i in 0..N: x[i]*x[i+1])"
    );
}

#[test]
fn open_chains_lattices_and_functions_of_sums() {
    let keys = [
        ("let", r#"["X = sum(k in 0..N: x[k])"]"#),
        (
            "hamiltonian",
            r#""sum(j in 1..N-2: x[j-1]*y[j+2]) + X^2/(2*N) + J""#,
        ),
    ];
    let open = model(&ring(&keys));
    let family = open.family.as_ref().expect("a family");
    // sums of H come behind those of the abbreviations
    assert_eq!(family.sums[1].spans, [None, None, Some((1, 2))]);
    let along = family.slots.iter().map(|slot| slot[AXES - 1]);
    assert_eq!(along.collect::<Vec<_>>(), [-3, -1, 0, 2, 3]);
    assert_eq!(family.degree, Some(4));
    let keys = [
        ("algebra", r#""so(3)^(3, M)""#),
        ("state", r#"["x[i, j]", "y[i, j]", "z[i, j]"]"#),
        ("parameters", r#"{"M": 5}"#),
        (
            "hamiltonian",
            r#""sum(i in 0..2, j in 0..M: x[i, j]*x[i+1, j] + z[i, j]*y[i, j+1])""#,
        ),
    ];
    let lattice = model(&ring(&keys));
    let family = lattice.family.as_ref().expect("a family");
    assert_eq!(family.sizes, [Size::Number(3), Size::Parameter(0)]);
    assert_eq!(family.sums[0].spans, [None, Some((0, 1)), None]);
    assert_eq!(family.sites(&[5.0]), Some([1, 3, 5]));
    assert_eq!(family.sites(&[2.5]), None);
    assert_eq!(
        lattice.display_of_family(family),
        "sum(i in 0..3-1, j in 0..M: x[i,j]*x[i+1,j] + z[i,j]*y[i,j+1])"
    );
}

#[test]
fn mistakes_of_sums_are_reported_at_their_place() {
    refused(
        "sum(i in 0..N: x[i]*x)",
        &["unknown-symbol at x: `x` is a coordinate of each site"],
    );
    refused(
        "x[i]",
        &["syntax at x[i]: `x` has an index and stands in no sum"],
    );
    refused(
        "sum(i in 0..N: x[k])",
        &["unknown-symbol at x[k]: the index `k` is not that of the sum"],
    );
    refused(
        "sum(i in 0..N: x[0]*y[i])",
        &["syntax at x[0]: `x` has a fixed index"],
    );
    refused(
        "sum(i in 0..N: x[i, i])",
        &["syntax at x[i, i]: `x` has 2 indices here"],
    );
    refused(
        "sum(i in 0..N: J[i]*x[i])",
        &["unknown-symbol at J[i]: `J` has an index and is no coordinate"],
    );
    refused(
        "sum(i in 0..N-1: x[i]*x[i+2])",
        &["domain at x[i+2]: this site is beyond the end"],
    );
    refused(
        "sum(i in 1..N: x[i]*x[i+1])",
        &["domain at x[i+1]: this site is beyond the end"],
    );
    refused(
        "sum(i in 0..N-1: x[i]*x[i-1])",
        &["domain at x[i-1]: this site is beyond the end"],
    );
    refused(
        "sum(i in 0..M: x[i])",
        &["syntax at M: a sum goes from a number to the number of sites"],
    );
    refused(
        "sum(i in 0..N: sum(j in 0..N: x[i]*x[j]))",
        &["syntax at sum(j in 0..N: x[i]*x[j]): a sum over all sites stands within"],
    );
    refused(
        "sum(J in 0..N: x[J])",
        &["duplicate-name at J: the index `J` is the name of something else"],
    );
    expect(
        &ring(&[
            ("let", r#"["X = sum(i in 0..N: x[i])"]"#),
            ("hamiltonian", r#""sum(i in 0..N: X*x[i])""#),
        ]),
        &["syntax at sum(i in 0..N: X*x[i]): a sum over all sites stands within"],
    );
}

#[test]
fn what_a_family_cannot_be_is_said() {
    expect(
        &ring(&[("algebra", r#""so(3)""#)]),
        &["syntax at so(3): the state has an index, and the algebra `so(3)` no number of copies"],
    );
    expect(
        &ring(&[("algebra", r#""so(3)^L""#)]),
        &["syntax at N: a sum goes from a number"],
    );
    expect(
        &ring(&[("parameters", r#"{"M": 8, "J": 1}"#)]),
        &["unknown-symbol at N: the number of sites `N` is not declared"],
    );
    expect(
        &ring(&[("parameters", r#"{"N": 2.5, "J": 1}"#)]),
        &["number at N: the number of sites is a whole number"],
    );
    expect(
        &ring(&[("algebra", r#""so(3)^(N, 4)""#)]),
        &["schema at \"so(3)^(N, 4)\": the numbers of indices differ"],
    );
    expect(
        &ring(&[("state", r#"["x[i]", "y[k]", "z[i]"]"#)]),
        &["syntax at y: `y` has other indices than the first coordinate"],
    );
    expect(
        &ring(&[("methods", r#"["midpoint"]"#)]),
        &["method at midpoint: a family keeps no matrix"],
    );
    expect(
        &ring(&[("initial", "[1, 2, 3]")]),
        &["schema at [: the initial state of a family is not a list"],
    );
    expect(
        &ring(&[("initial", r#"{"random": "gauss"}"#)]),
        &["schema at gauss: unknown distribution `gauss`"],
    );
    expect(
        &ring(&[("casimirs", r#"["x[i+1]^2"]"#)]),
        &["syntax at x[i+1]: a Casimir of a family is one of a site"],
    );
    expect(
        &ring(&[("casimirs", r#"["C = x[i]^2 + y[i]^2"]"#)]),
        &["casimir at x[i]^2 + y[i]^2: "],
    );
}

#[test]
fn pieces_of_functions_of_sums_and_of_longer_summands_are_found() {
    let pieces = |hamiltonian: &str| {
        let keys = hamiltonian_with(hamiltonian);
        let keys: Vec<(&str, &str)> = keys.iter().map(|(k, v)| (*k, v.as_str())).collect();
        let model = model(&ring(&keys));
        let found = model.family_pieces.as_ref().expect("a family");
        let described = |p: &crate::structure::family::Piece| p.describe(&model);
        let found = found.as_ref().map_err(String::clone);
        found.map(|found| {
            found
                .pieces
                .iter()
                .map(described)
                .collect::<Vec<_>>()
                .join(", ")
        })
    };
    let ok = |text: &str| Ok(text.to_owned());
    let err = |text: &str| Err(text.to_owned());
    assert_eq!(pieces("J*X^2"), ok("F(sums over x)"));
    assert_eq!(pieces("J*X*N + Y"), ok("f(x), f(y)"));
    assert_eq!(pieces("X*X2 + Y^2"), ok("F(sums over y), F(sums over x)"));
    assert_eq!(pieces("X*Y"), err("H mixes sums over `x` and over `y`"));
    assert_eq!(pieces("X*Z"), ok("F(sums over x)"));
    assert_eq!(pieces("X*W"), err("H mixes sums over different sites"));
    assert!(pieces("XY^2").is_err_and(|why| why.contains("more than one coordinate")));
    assert_eq!(
        pieces("sum(i in 0..N: x[i]*x[i+1] + y[i]*y[i+2] + z[i+1]*z[i+2] + z[i]^2)"),
        ok("x*x[+1], y*y[+2], z*z[+1], f(z)")
    );
    assert_eq!(
        pieces("sum(i in 0..N: x[i]*x[i+1]*x[i+2])"),
        err("`x[i]`, `x[i+1]` and `x[i+2]` are coupled by more than products")
    );
    assert_eq!(
        pieces("sum(i in 0..N: x[i]*y[i] + exp(x[i] - x[i+1]))"),
        err("`x[i]`, `x[i+1]` and `y[i]` are coupled by more than products")
    );
    // a common factor stands before the sum of the products
    assert_eq!(
        pieces("-J*sum(i in 0..N: x[i]*x[i+1] + x[i]*x[i+2])"),
        ok("x*x[+1], x*x[+2]")
    );
    // a slope that jumps depends on the other coordinate, although its derivative by it is 0
    assert_eq!(
        pieces("sum(i in 0..N: abs(x[i] - x[i+1]) + z[i]^2)"),
        ok("f(x, x[+1]), f(z)")
    );
    assert_eq!(
        pieces("sum(i in 0..N: max(x[i], 2*y[i+1]))"),
        ok("f(x, y[+1])")
    );
    for mixed in ["abs(x[i] - y[i])", "abs(x[i] + x[i+1] + x[i+2])"] {
        let found = pieces(&format!("sum(i in 0..N: {mixed})"));
        assert!(found.is_err(), "{mixed}: {found:?}");
    }
    assert_eq!(
        pieces("sum(i in 0..N: cos(x[i])*y[i+2]^2 + z[i]*z[i+2] + z[i])"),
        ok("f(x, y[+2]), z*z[+2], f(z)")
    );
}

/// A Hamiltonian with sums to write it in.
fn hamiltonian_with(text: &str) -> Vec<(&'static str, String)> {
    let sums = [
        "X = sum(i in 0..N: x[i])",
        "X2 = sum(i in 0..N: x[i]^2)",
        "Y = sum(i in 0..N: y[i])",
        "Z = sum(i in 0..N: sin(x[i+1]))",
        "W = sum(i in 1..N: x[i])",
        "XY = sum(i in 0..N: x[i] + y[i])",
    ];
    let used: Vec<&str> = sums
        .into_iter()
        .filter(|sum| {
            let name = sum.split(' ').next().unwrap_or_default();
            let words = text.split(|c: char| !c.is_alphanumeric());
            words.into_iter().any(|word| word == name)
        })
        .collect();
    let mut keys = hamiltonian(text);
    keys.push(("let", format!("{used:?}")));
    keys
}

#[test]
fn an_initial_state_is_random_or_a_file() {
    use crate::model::Start;
    let start = |text: &str| {
        let model = model(&ring(&[("initial", text)]));
        model
            .family
            .as_ref()
            .and_then(|family| family.start.clone())
    };
    let seed = start(r#"{"random": "unit-sphere", "seed": 7}"#);
    assert!(matches!(seed, Some(Start::UnitSpheres(7))));
    let file = start(r#"{"npy": "a/b.npy"}"#);
    assert!(matches!(file, Some(Start::File(name)) if name.text == "a/b.npy"));
    for (text, expected) in [
        (
            "[1, 0, 0]",
            "schema at [: the initial state of a family is not a list",
        ),
        (
            r#"{"npy": 3}"#,
            "schema at 3: `npy` is a string, not a number",
        ),
        (
            r#"{"npy": "a.npy", "seed": 1}"#,
            "schema at seed: unknown key `seed` in `initial`",
        ),
        (
            r#"{"random": "cube"}"#,
            "schema at cube: unknown distribution `cube`",
        ),
    ] {
        expect(&ring(&[("initial", text)]), &[expected]);
    }
}

#[test]
fn coefficients_have_a_value_for_each_site() {
    let keys = [
        (
            "parameters",
            r#"{"N": 4, "B": [1, "1/4", 2, 3], "J": {"values": [1, 2, 3], "unit": "K"}}"#,
        ),
        (
            "hamiltonian",
            r#""sum(i in 0..N-1: J[i]*x[i]*x[i+1] + B[i+1]*y[i]) + sum(i in 0..N: B[i]*z[i]^2)""#,
        ),
    ];
    let model = model(&ring(&keys));
    let family = model.family.as_ref().expect("a family");
    let data: Vec<_> = family
        .data
        .iter()
        .map(|data| (&*data.name, &*data.values, data.unused))
        .collect();
    // of couplings of bonds the last one is not asked for
    let expected: [(&str, &[f64], usize); 2] =
        [("B", &[1.0, 0.25, 2.0, 3.0], 0), ("J", &[1.0, 2.0, 3.0], 1)];
    assert_eq!(data, expected);
    // coefficients are no coordinates
    assert_eq!(family.degree, Some(2));
    assert_eq!(family.sums[0].slots, [1, 2]);
    assert_eq!(
        model.display_of_family(family),
        "sum(i in 0..N-1: J[i]*x[i]*x[i+1] + B[i+1]*y[i]) + sum(i in 0..N: B[i]*z[i]^2)"
    );
    let wrong = |parameters: &str, sum: &str, expected: &str| {
        let sum = format!("{sum:?}");
        expect(
            &ring(&[("parameters", parameters), ("hamiltonian", &sum)]),
            &[expected],
        );
    };
    let sum = "sum(i in 0..N: B[i]*x[i])";
    wrong(
        r#"{"N": 4, "B": [1, 2, 3]}"#,
        sum,
        "state-length at [: `B` has 3 values, and there are 4 sites",
    );
    wrong(
        r#"{"N": 2, "B": [1, "1/0"]}"#,
        sum,
        "number at 0: division by zero",
    );
    wrong(
        r#"{"N": 2, "B": [1, 2]}"#,
        "B*sum(i in 0..N: x[i])",
        "unknown-symbol at B: `B` has a value for each site and needs an index",
    );
    wrong(
        r#"{"N": 2, "B": [1, 2]}"#,
        "sum(i in 0..N: B*x[i])",
        "unknown-symbol at B: `B` has a value for each site and needs an index",
    );
    wrong(
        r#"{"N": 2, "B": [1, 2]}"#,
        "sum(i in 0..N-1: B[i+2]*x[i])",
        "domain at B[i+2]: this site is beyond the end",
    );
    wrong(
        r#"{"N": 2, "x": [1, 2]}"#,
        "sum(i in 0..N: x[i])",
        "duplicate-name at x: the parameter `x` has the name of a coordinate",
    );
    wrong(
        r#"{"N": 2, "B": {"values": [1, 2], "file": "B.npy"}}"#,
        sum,
        "schema at {: the parameter `B` has both `values` and `file`",
    );
}
