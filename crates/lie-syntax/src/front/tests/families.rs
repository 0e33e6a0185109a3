//! Families in the macro.

use super::declaration::{declared, mistakes};
use super::*;

#[test]
fn a_family_is_read_as_in_a_spec() {
    let text = "pub system Ring; algebra = so(3)^N; state x[i], y[i], z[i]; parameters { N = 8; }
        hamiltonian = sum(i in 0..N: x[i]*x[i+1]); initial = random(unit-sphere, 5);";
    let declaration = declared(text);
    let family = declaration.family.expect("a family");
    assert!(matches!(
        family.start,
        Some(crate::ast::Start::UnitSpheres(5))
    ));
    assert_eq!(
        (
            family.sizes.len(),
            family.indices.len(),
            declaration.state.len()
        ),
        (1, 1, 3)
    );
    for (from, to, expected) in [
        ("so(3)^N", "so(3)", "so"),
        ("= so(3)^N", "{ basis a, b, c; }", "algebra"),
        ("random(unit-sphere, 5)", "[1, 2]", "["),
        ("random(unit-sphere, 5)", "random(unit-sphere, x)", "random"),
        ("random(unit-sphere, 5)", "random(cube)", "random"),
        ("y[i]", "y[j]", "y"),
    ] {
        let found = mistakes(&text.replacen(from, to, 1));
        assert_eq!(found.len(), 1, "{to}: {found:?}");
        assert_eq!(found[0].0, Kind::Syntax);
        assert!(found[0].1.starts_with(expected), "{to}: {found:?}");
    }
}

#[test]
fn a_lattice_has_up_to_three_indices_and_lists_as_deep() {
    let text =
        "pub system Cube; algebra = so(3)^(L, 2, M); state x[i, j, k], y[i, j, k], z[i, j, k];
        parameters { L = 2; M = 2; B = [[[1, 2], [3, 4]], [[5, 6], [7, 8]]]; }
        hamiltonian = sum(i in 0..L, j in 0..2, k in 0..M: B[i, j, k]*x[i, j, k]*x[i+1, j, k-1]);";
    let family = declared(text).family.expect("a family");
    assert_eq!((family.sizes.len(), family.indices.len()), (3, 3));
    assert_eq!(family.data[0].shape, [2, 2, 2]);
    for (from, to, expected) in [
        ("[7, 8]]", "[7]]", "[7]"),
        ("[[5, 6], [7, 8]]", "[[5, 6]]", "[[5, 6]]"),
        ("[1, 2]", "[1]", "[3, 4]"),
        ("[5, 6], [7, 8]", "[5, 6, 7, 8]", "[[5, 6, 7, 8]]"),
        ("x[i+1, j, k-1]", "x[i+1, j, k-1, k]", ","),
        ("x[i+1, j, k-1]", "x[i+1, j, ]", "]"),
        ("so(3)^(L, 2, M)", "so(3)^(L, 2, )", "so"),
        ("so(3)^(L, 2, M)", "so(3)^(L)", "so"),
        ("z[i, j, k]", "z[i, j]", "z"),
    ] {
        let found = mistakes(&text.replacen(from, to, 1));
        assert_eq!(found.len(), 1, "{to}: {found:?}");
        assert_eq!(found[0].0, Kind::Syntax);
        assert!(found[0].1.starts_with(expected), "{to}: {found:?}");
    }
}
