//! Lattices of two and of three dimensions.

use super::{expect, model, system};
use crate::model::Size;

/// Spins on a lattice with what is given instead.
fn cube(extra: &[(&str, &str)]) -> String {
    system(
        &[
            ("algebra", r#""so(3)^(L, 2, M)""#),
            ("state", r#"["x[i, j, k]", "y[i, j, k]", "z[i, j, k]"]"#),
            ("parameters", r#"{"L": 3, "M": 4}"#),
            (
                "hamiltonian",
                r#""sum(i in 0..L, j in 0..2, k in 0..M-1: x[i, j, k]*x[i+1, j, k] + z[i, j, k]*y[i, j-1, k+1])""#,
            ),
        ],
        extra,
    )
}

#[test]
fn sums_go_along_three_axes() {
    let model = model(&cube(&[]));
    let family = model.family.as_ref().expect("a family");
    let sizes = [Size::Parameter(0), Size::Number(2), Size::Parameter(1)];
    assert_eq!(family.sizes, sizes);
    assert_eq!(family.sums[0].spans, [None, None, Some((0, 1))]);
    assert!(family.slots.is_sorted() && family.slots.contains(&[-1, -1, 1]));
    assert_eq!(family.slots[family.own], [0, 0, 0]);
    assert_eq!(family.sites(&[3.0, 4.0]), Some([3, 2, 4]));
    assert_eq!(family.sites(&[3.0, 0.5]), None);
    assert_eq!(
        model.display_of_family(family),
        "sum(i in 0..L, j in 0..2, k in 0..M-1: x[i,j,k]*x[i+1,j,k] + z[i,j,k]*y[i,j-1,k+1])"
    );
    let pieces = model.family_pieces.as_ref().expect("a family");
    let pieces = &pieces.as_ref().expect("products").pieces;
    let pieces: Vec<String> = pieces.iter().map(|p| p.describe(&model)).collect();
    assert_eq!(pieces, ["y*z[+1,-1]", "x*x[+1,+0,+0]"]);
}

#[test]
fn mistakes_of_lattices_are_reported_at_their_place() {
    let sum = |text: &str, expected: &str| {
        let text = format!("{text:?}");
        expect(&cube(&[("hamiltonian", &text)]), &[expected]);
    };
    sum(
        "sum(i in 0..L, j in 0..2, k in 0..M: x[i, j])",
        "syntax at x[i, j]: `x` has 2 indices here",
    );
    sum(
        "sum(i in 0..L, j in 0..2, k in 0..M: x[i, j, k, k])",
        "syntax at ,: a site has at most 3 indices",
    );
    sum(
        "sum(i in 0..L, j in 0..2, k in 0..M: x[i, k, j])",
        "unknown-symbol at x[i, k, j]: the index `k` is not that of the sum",
    );
    sum(
        "sum(i in 0..L, j in 0..2: x[i, j, j])",
        "syntax at sum(i in 0..L, j in 0..2: x[i, j, j]): the sum has 2 indices, and the sites have 3 indices",
    );
    sum(
        "sum(i in 0..L, j in 0..2, k in 0..M, l in 0..2: x[i, j, k])",
        "syntax at sum(i in 0..L, j in 0..2, k in 0..M, l in 0..2: x[i, j, k]): the sum has 4 indices, and the sites have 3 indices",
    );
    sum(
        "sum(i in 0..L, j in 0..1, k in 0..M: x[i, j, k]*x[i, j+1, k]*x[i, j+2, k])",
        "domain at x[i, j+2, k]: this site is beyond the end",
    );
    for algebra in ["so(3)^(L, M)", "so(3)^L"] {
        let text = format!("{algebra:?}");
        let says = format!("schema at {text}: the numbers of indices differ: 3 in the names");
        expect(&cube(&[("algebra", &text)]), &[&says]);
    }
    expect(
        &cube(&[
            ("algebra", r#""so(3)^(L, 2, M, 2)""#),
            (
                "state",
                r#"["x[i, j, k, l]", "y[i, j, k, l]", "z[i, j, k, l]"]"#,
            ),
        ]),
        &[r#"schema at "so(3)^(L, 2, M, 2)": lattices have at most 3 dimensions"#],
    );
    expect(
        &cube(&[("bonds", "[[0, 1, 1]]")]),
        &["schema at [: bonds join the sites of a chain, and these have 3 indices"],
    );
}

/// Where values are left out is known while their layers and rows are.
#[test]
fn values_of_a_lattice_keep_their_layers() {
    let with = |values: &str| {
        let parameters = format!(r#"{{"L": 2, "M": 3, "K": {values}}}"#);
        let sum = r#""sum(i in 0..L, j in 0..2, k in 0..M-1: K[i, j, k]*z[i, j, k]*z[i, j, k+1])""#;
        cube(&[("parameters", &parameters), ("hamiltonian", sum)])
    };
    let short = [1.0, 2.0, 0.0, 3.0, 4.0, 0.0, 5.0, 6.0, 0.0, 7.0, 8.0, 0.0];
    let whole = [1.0, 2.0, 9.0, 3.0, 4.0, 9.0, 5.0, 6.0, 9.0, 7.0, 8.0, 9.0];
    for (given, values) in [
        ("[[[1, 2], [3, 4]], [[5, 6], [7, 8]]]", short),
        ("[[1, 2], [3, 4], [5, 6], [7, 8]]", short),
        ("[[[1, 2, 9], [3, 4, 9]], [[5, 6, 9], [7, 8, 9]]]", whole),
        ("[[1, 2, 9], [3, 4, 9], [5, 6, 9], [7, 8, 9]]", whole),
        ("[1, 2, 9, 3, 4, 9, 5, 6, 9, 7, 8, 9]", whole),
    ] {
        let model = model(&with(given));
        let data = &model.family.as_ref().expect("a family").data[0];
        assert_eq!((&*data.values, data.sizes), (&values[..], Some([2, 2, 3])));
    }
    for (given, found) in [
        ("[[[1, 2, 3], [4, 5, 6]]]", "1 x 2 x 3"),
        ("[[1, 2, 3], [4, 5, 6], [7, 8, 9]]", "3 x 3"),
        ("[[1, 2, 3], [4, 5, 6]]", "1 x 2 x 3"),
        ("[1, 2, 3]", "3"),
        ("[[[1], [2]], [[3], [4]]]", "2 x 2 x 1"),
    ] {
        let says =
            format!("state-length at [: `K` has {found} values, and there are 2 x 2 x 3 sites");
        expect(&with(given), &[&says]);
    }
    for (given, says) in [
        (
            "[[[1, 2], [3]], [[5, 6], [7, 8]]]",
            "schema at [: the rows of the parameter `K` have different lengths",
        ),
        (
            "[[[1, 2], [3, 4]], [[5, 6]]]",
            "schema at [: the layers of the parameter `K` have different shapes",
        ),
        (
            "[[[1, 2], [3, 4]], [5, 6]]",
            "schema at [: the layers of the parameter `K` have different shapes",
        ),
        (
            "[[[1, 2], 3], [[5, 6], [7, 8]]]",
            "schema at 3: a row of the parameter `K` is a list, not a number",
        ),
        (
            "[[[[1]]]]",
            "schema at [: a value of the parameter `K` is a number",
        ),
    ] {
        expect(&with(given), &[says]);
    }
}

/// Where values of a lattice are left out is known while their rows are.
#[test]
fn values_of_a_lattice_keep_their_rows() {
    let lattice = |values: &str| {
        let parameters = format!(r#"{{"N": 2, "M": 3, "K": {values}}}"#);
        cube(&[
            ("algebra", r#""so(3)^(N, M)""#),
            ("state", r#"["x[i, j]", "y[i, j]", "z[i, j]"]"#),
            ("parameters", &parameters),
            (
                "hamiltonian",
                r#""sum(i in 0..N, j in 0..M-1: K[i, j]*z[i, j]*z[i, j+1])""#,
            ),
        ])
    };
    for (given, values) in [
        ("[[1, 2], [3, 4]]", [1.0, 2.0, 0.0, 3.0, 4.0, 0.0]),
        ("[[1, 2, 5], [3, 4, 6]]", [1.0, 2.0, 5.0, 3.0, 4.0, 6.0]),
        ("[1, 2, 5, 3, 4, 6]", [1.0, 2.0, 5.0, 3.0, 4.0, 6.0]),
    ] {
        let model = model(&lattice(given));
        let data = &model.family.as_ref().expect("a family").data[0];
        assert_eq!((&*data.values, data.sizes), (&values[..], Some([1, 2, 3])));
    }
    for (given, found) in [("[[1, 2, 3]]", "1 x 3"), ("[1, 2, 3, 4]", "4")] {
        let says = format!("state-length at [: `K` has {found} values, and there are 2 x 3 sites");
        expect(&lattice(given), &[&says]);
    }
}
