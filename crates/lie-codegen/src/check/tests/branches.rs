//! Which functions have several branches.

use super::{model, so3};
use lie_symbolic::prove::branches::jumps;

#[test]
fn angles_jump_and_other_functions_do_not() {
    for (text, expected) in [
        ("x^2 + atan2(y, x)", true),
        ("log(x^2 + y^2) - atan(z/y)/3", true),
        ("atan(tan(x))", true),
        ("cos(atan(1/(x + y)))", true),
        ("atan2(k, 2) + x", false),
        ("atan(x*y) + asin(z) + log(x)", false),
        (
            "atan(x/sqrt(1 + x^2)) + atan(y/(1 + z^2)) + atan(x/k)",
            false,
        ),
        ("1/x + tan(y)", false),
        ("abs(x) + max(y, z)", false),
        ("piecewise(x < 0: y, y + x)", false),
        ("piecewise(x < 0: y, z)", true),
    ] {
        let hamiltonian = format!("{text:?}");
        let spec = so3(&[
            ("parameters", r#"{"k": {"value": 2, "positive": true}}"#),
            ("hamiltonian", &hamiltonian),
        ]);
        let model = model(&spec);
        assert_eq!(jumps(&model.graph, model.hamiltonian()), expected, "{text}");
    }
}
