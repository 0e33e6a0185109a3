use super::{Terms, refusal};
use crate::compile::compile_spec;
use crate::structure::Structure;

const SO3: &str = r#"{"basis": ["e1", "e2", "e3"], "brackets": ["[e1, e2] = e3", "[e2, e3] = e1", "[e3, e1] = e2"]}"#;

fn model(algebra: &str, state: &[&str], rest: &str) -> Structure {
    let state: Vec<String> = state.iter().map(|name| format!("{name:?}")).collect();
    let spec = format!(
        r#"{{"format": 1, "name": "Test", "algebra": {algebra}, "state": [{}], {rest}}}"#,
        state.join(", ")
    );
    compile_spec(&spec).expect("a spec without mistakes")
}

fn body(rest: &str) -> Structure {
    model(SO3, &["x", "y", "z"], rest)
}

/// The pieces of the first way.
fn terms(model: &Structure) -> Option<Terms> {
    let searched = &model.splitting;
    let way = searched.ways.first()?;
    Some(super::terms(model, searched, way))
}

fn pieces(model: &Structure) -> Vec<Vec<String>> {
    terms(model).expect("pieces").pieces
}

#[test]
fn a_multiple_of_the_casimir_is_taken_away() {
    let body = body(r#""hamiltonian": "x^2/2 + y^2/4 + z^2/6""#);
    assert_eq!(pieces(&body), [["x^2/4"], ["-z^2/12"]]);
    assert!(terms(&body).is_some_and(|terms| terms.shifted));
}

/// Of equal moments two squares are one multiple of the Casimir.
#[test]
fn a_symmetric_body_is_one_piece() {
    let symmetric = body(r#""hamiltonian": "x^2/2 + y^2/2 + z^2/6""#);
    assert_eq!(pieces(&symmetric), [["-z^2/3"]]);
}

#[test]
fn an_inertia_matrix_is_brought_to_squares() {
    let full = body(r#""hamiltonian": "x^2 + x*y + y^2 + y*z + z^2 + z""#);
    assert_eq!(pieces(&full).len(), 3);
    assert_eq!(refusal(&full, 2), None);
    // a product alone has no square to begin with
    let product = body(r#""hamiltonian": "x*y""#);
    assert_eq!(pieces(&product).len(), 2);
    // one square of a form is one piece
    let square = body(r#""hamiltonian": "(x + 2*y - 3*z)^2/2 + x + 2*y - 3*z""#);
    assert_eq!(pieces(&square).len(), 1);
}

#[test]
fn linear_terms_are_one_form() {
    let linear = body(r#""hamiltonian": "x + 2*y + 3*z""#);
    assert_eq!(pieces(&linear), [["x + 2*y + 3*z"]]);
}

#[test]
fn coordinates_that_commute_are_one_piece() {
    let two = r#"{"basis": ["e1", "e2", "e3", "f1", "f2", "f3"], "brackets": ["[e1, e2] = e3", "[e2, e3] = e1",
        "[e3, e1] = e2", "[f1, f2] = f3", "[f2, f3] = f1", "[f3, f1] = f2"]}"#;
    let state = ["x", "y", "z", "u", "v", "w"];
    let coupled = model(
        two,
        &state,
        r#""hamiltonian": "x*u + 2*y*v + 3*z*w + exp(x*u)""#,
    );
    let found = pieces(&coupled);
    assert_eq!(found.len(), 3, "{found:?}");
    assert!(found.iter().any(|terms| terms.len() == 2), "{found:?}");
}

#[test]
fn what_cannot_be_split_is_named() {
    let body = body(r#""hamiltonian": "sin(x) + sqrt(1 + x^2 + 2*y^2)""#);
    assert_eq!(terms(&body), None);
    let (reason, _) = refusal(&body, 2).expect("a reason");
    assert!(
        reason.contains("`sqrt(x^2 + 2*y^2 + 1)` contains `x` and `y`"),
        "{reason}"
    );
    let cubic = self::body(r#""hamiltonian": "x*y*z""#);
    assert_eq!(terms(&cubic), None);
}

/// A divisor that vanishes at the default parameters is not one.
#[test]
fn divisors_have_values() {
    let body =
        body(r#""parameters": {"a": 0, "b": 1}, "hamiltonian": "a*x^2 + x*y + b*y^2 + z^2/3""#);
    let found = pieces(&body);
    assert!(
        found.iter().flatten().all(|term| !term.contains("/a")),
        "{found:?}"
    );
}

const SE3: &str = r#"{"basis": ["J1", "J2", "J3", "P1", "P2", "P3"], "brackets": ["[J1, J2] = J3", "[J2, J3] = J1",
    "[J3, J1] = J2", "[J1, P2] = P3", "[J2, P3] = P1", "[J3, P1] = P2", "[P1, J2] = P3", "[P2, J3] = P1", "[P3, J1] = P2"]}"#;

fn top(rest: &str) -> Structure {
    model(SE3, &["a", "b", "c", "p", "q", "r"], rest)
}

/// Casimirs of the algebra are constants: they may be factors, and stand in functions.
#[test]
fn casimirs_are_arguments() {
    let product = body(r#""hamiltonian": "(x^2 + y^2 + z^2)*z""#);
    assert_eq!(pieces(&product).len(), 1);
    let both = body(r#""hamiltonian": "(x^2 + y^2 + z^2)*z + cos(x^2 + y^2 + z^2)*x^2""#);
    assert_eq!(pieces(&both).len(), 2);
    let root = top(r#""hamiltonian": "sqrt(p^2 + q^2 + r^2)*c""#);
    assert_eq!(pieces(&root).len(), 1);
    let mixed = top(r#""hamiltonian": "exp(a*p + b*q + c*r)*r^2 + (p^2 + q^2 + r^2)^2*c""#);
    assert_eq!(pieces(&mixed).len(), 1);
    // one of the Casimir and a coordinate
    let hidden = body(r#""hamiltonian": "(x^2 + y^2 + 2*z^2)*z + sqrt(1 + x^2 + y^2)""#);
    assert_eq!(pieces(&hidden).len(), 1);
    // the control: another function of the same degree
    let other = body(r#""hamiltonian": "(x^2 + 2*y^2 + 3*z^2)*z""#);
    assert_eq!(terms(&other), None);
    // a function of Casimirs alone moves nothing
    let idle = body(r#""hamiltonian": "sin(x^2 + y^2 + z^2)""#);
    assert_eq!(pieces(&idle).len(), 0);
}

/// `|m|^2` is no Casimir of se(3), and its flow is exact.
#[test]
fn casimirs_of_subalgebras_are_arguments() {
    let lagrange = top(r#""hamiltonian": "(a^2 + b^2)/2 + c^2/3 + r""#);
    assert_eq!(pieces(&lagrange).len(), 2);
    let kinetic = top(r#""hamiltonian": "(a^2 + b^2)/2 + c^2/3""#);
    assert_eq!(pieces(&kinetic).len(), 1);
    let heavy = top(r#""parameters": {"i": 1, "j": 2, "k": 3, "g": 1},
            "hamiltonian": "a^2/(2*i) + b^2/(2*j) + c^2/(2*k) + g*r""#);
    assert_eq!(pieces(&heavy).len(), 2);
    let size = top(r#""hamiltonian": "sqrt(1 + a^2 + b^2 + c^2) + q""#);
    assert_eq!(pieces(&size).len(), 2);
    // the control: no function of the size
    let other = top(r#""hamiltonian": "sqrt(1 + a^2 + 2*b^2 + 3*c^2) + q""#);
    assert_eq!(terms(&other), None);
}

/// What is declared stays where nothing is gained.
#[test]
fn the_declared_pieces_are_kept() {
    let body = body(r#""hamiltonian": "cos(x) + y^4 + z^3""#);
    let searched = &body.splitting;
    assert!(searched.ways.len() == 1 && searched.ways[0].declared);
    assert_eq!(pieces(&body).len(), 3);
}

fn by_entries(brackets: &str, hamiltonian: &str) -> Structure {
    let spec = format!(
        r#"{{"format": 1, "name": "Entries", "state": ["x", "y", "z", "u"], "poisson": [{brackets}],
            "hamiltonian": "{hamiltonian}"}}"#
    );
    compile_spec(&spec).expect("a spec without mistakes")
}

/// Predators and prey: one piece for each monomial, and one for all logarithms.
#[test]
fn monomials_are_pieces_of_a_log_canonical_bracket() {
    let brackets = r#""{x, y} = -x*y/2", "{x, z} = x*z/2", "{y, z} = -y*z""#;
    let model = by_entries(brackets, "2*x + y + 2*z + log(y) - 2*log(z)");
    assert_eq!(model.splitting.count(), 4);
    // a power, a function of a monomial, and a product of two functions of it
    let model = by_entries(brackets, "x^2*y + sin(x*y^2) + exp(x)*x");
    assert_eq!(model.splitting.count(), 3);
    // functions of the same monomial are one piece
    let model = by_entries(brackets, "x^2*y + exp(x^4*y^2)");
    assert_eq!(model.splitting.count(), 1);
    // a sum of two monomials in a function is none
    let model = by_entries(brackets, "sin(x + y)");
    assert_eq!(model.splitting.count(), 0);
    let (reason, _) = super::refusal(&model, 2).expect("no pieces");
    assert!(reason.contains("`sin(x + y)`"), "{reason}");
}

/// A power of a sum is taken apart once, and nothing is divided by a parameter.
#[test]
fn what_is_long_ends_and_what_may_vanish_is_no_divisor() {
    let brackets = r#""{x, y} = x*y""#;
    for (power, pieces) in [(9, 10), (14, 0), (60, 0)] {
        let model = by_entries(brackets, &format!("(x + y)^{power}"));
        assert_eq!(model.splitting.count(), pieces, "{power}");
    }
    let spec = r#"{"format": 1, "name": "Forms", "state": ["q", "p"], "poisson": ["{q, p} = 1"],
        "parameters": { "a": 0, "b": 1 }, "hamiltonian": "(a*q + p)^4 + sin(q + b*p) + q^2"}"#;
    let model = compile_spec(spec).expect("a spec without mistakes");
    assert_eq!(model.splitting.count(), 3);
    let none = spec.replace("sin(q + b*p)", "sin(a*q + b*p)");
    let model = compile_spec(&none).expect("a spec without mistakes");
    assert_eq!(model.splitting.count(), 0);
}

/// A charged particle in the plane: kicks, and motions along each axis, in every field of the positions; none where a function mixes momenta.
#[test]
fn a_magnetic_field_has_flows_along_the_axes() {
    let magnetic = |field: &str| format!(r#""{{x, z}} = 1", "{{y, u}} = 1", "{{z, u}} = {field}""#);
    let energy = "z^2/2 + u^2/2 + cos(x) + y^4/4";
    for field in ["2", "1 + x*y^2", "1 + cos(x) + exp(-y^2)"] {
        let model = by_entries(&magnetic(field), energy);
        assert_eq!(model.splitting.count(), 2, "{field}");
    }
    // a kick is a piece of its own where it mixes the positions
    let model = by_entries(&magnetic("1 + x*y"), &format!("{energy} + x*y/5"));
    assert_eq!(model.splitting.count(), 3);
    let model = by_entries(&magnetic("1 + x*y"), "sqrt(1 + z^2 + u^2) + x^2");
    assert_eq!(model.splitting.count(), 0);
    // no series and no quadrature goes on behind a joint
    let model = by_entries(&magnetic("1 + abs(x)"), energy);
    assert_eq!(model.splitting.count(), 0);
}
