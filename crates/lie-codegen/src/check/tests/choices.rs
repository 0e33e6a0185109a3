//! `abs`, `min`, `max` and `piecewise`: names, constants, proofs, and how smooth they are.

use super::*;
use crate::structure::smoothness::joints;
use lie_symbolic::prove::joints::reached;

const NAMES: [&str; 4] = ["abs", "min", "max", "piecewise"];

fn of(hamiltonian: &str) -> Structure {
    let hamiltonian = format!("{hamiltonian:?}");
    model(&so3(&[
        (
            "parameters",
            r#"{"k": {"value": 2, "positive": true}, "a": 1.5}"#,
        ),
        ("hamiltonian", &hamiltonian),
    ]))
}

/// The places of the joints and the first derivatives that jump there.
fn jumps(hamiltonian: &str) -> Vec<(String, Option<u32>)> {
    let found = joints(&of(hamiltonian)).into_iter();
    found.map(|joint| (joint.place, joint.jump)).collect()
}

#[test]
fn their_names_are_reserved() {
    for name in NAMES {
        let state = format!(r#"["{name}", "y", "z"]"#);
        let found = errors(&so3(&[("state", &state), ("hamiltonian", r#""y^2""#)]));
        let expected = format!("reserved-name at {name}: `{name}` is a word of the language");
        assert_eq!(found, [expected]);
    }
}

#[test]
fn constants_take_their_branch_at_once() {
    for (text, same) in [
        ("abs(-3/2)*x", "3/2*x"),
        ("max(2, 3)*x + min(pi, 3)*y", "3*x + 3*y"),
        ("piecewise(1 < 1: y, x)", "x"),
        ("piecewise(1 <= 1: x, y)", "x"),
        ("piecewise(sqrt(2)*sqrt(3) < sqrt(6): y, x)", "x"),
        ("abs(k)*x", "k*x"),
        ("piecewise(x < y: z, z)", "z"),
    ] {
        let (one, other) = (of(text), of(same));
        assert_eq!(
            one.display(one.hamiltonian()),
            other.display(other.hamiltonian()),
            "{text}"
        );
    }
    let found = errors(&so3(&[("hamiltonian", r#""x/abs(sin(pi))""#)]));
    assert!(found[0].contains("division by zero"), "{found:?}");
}

#[test]
fn what_is_shown_is_read_again() {
    for text in [
        "abs(x) + 2*abs(x - y)",
        "max(x, y)*z",
        "piecewise(x < 0: -x^3, x < 1: x^3, 3*x - 2)",
    ] {
        let one = of(text);
        let shown = one.display(one.hamiltonian());
        let other = of(&shown);
        assert_eq!(shown, other.display(other.hamiltonian()));
    }
    assert_eq!(
        of("abs(x - y)*z").display(of("abs(x - y)*z").hamiltonian()),
        "abs(x - y)*z"
    );
}

fn casimir(text: &str) -> Vec<String> {
    let casimirs = format!("[{text:?}]");
    errors(&so3(&[("casimirs", &casimirs)]))
}

#[test]
fn identities_hold_on_every_branch_or_are_no_identities() {
    let r = "(x^2 + y^2 + z^2)";
    for form in [
        "abs(R - 1)",
        "max(R, 2)",
        "min(R, R^2) + max(R, R^2)",
        "piecewise(R < 1: R^2, 2*R - 1)",
        "R + abs(x)^2 - x^2",
        "R + abs(x*y) - abs(x)*abs(y)",
        "R + max(x, y) + min(x, y) - x - y",
        "R + max(x, y) - (x + y + abs(x - y))/2",
        "R + piecewise(x < 0: -x, x) - abs(x)",
        "R + abs(abs(x)) - abs(x)",
        "R + abs(x) - sqrt(x^2)",
    ] {
        let found = casimir(&form.replace('R', r));
        let errors: Vec<&String> = found
            .iter()
            .filter(|f| !f.contains("is multi-valued"))
            .collect();
        assert!(errors.is_empty(), "{form}: {found:?}");
    }
    for form in [
        "R + abs(x)",
        "R + abs(x) - x",
        "R + max(x, y) - x",
        "R + piecewise(x < 100: 0, x)",
        "piecewise(x < 0: R, R + y)",
        "R + abs(x*y) - abs(x)*y",
        // the branch with the logarithm says nothing of the other one
        "R + piecewise(x < 0: y, log(x) - log(x))",
    ] {
        let found = casimir(&form.replace('R', r));
        assert!(
            found.iter().any(|f| f.starts_with("casimir at")),
            "{form}: {found:?}"
        );
    }
}

#[test]
fn the_first_derivative_that_jumps_is_found() {
    for (text, place, jump) in [
        ("abs(x)", "x = 0", Some(1)),
        ("abs(x)^3 + y^2", "x = 0", Some(3)),
        ("x*abs(x)", "x = 0", Some(2)),
        ("max(x, y)", "x - y = 0", Some(1)),
        ("max(x, 0)^4", "x = 0", Some(4)),
        ("piecewise(x < 1: y, z)", "x = 1", Some(0)),
        ("piecewise(x < 1: x^2, 2*x - 1)", "x = 1", Some(2)),
        (
            "piecewise(x < a: x^3, 3*a*x^2 - 3*a^2*x + a^3)",
            "x - a = 0",
            Some(3),
        ),
        ("piecewise(2*x > y: 0, (2*x - y)^5)", "y - 2*x = 0", Some(5)),
        ("abs(x^2 + y^2 - 1)", "x^2 + y^2 = 1", Some(1)),
        (
            "piecewise(hypot(x, y) < 2: x^2 + y^2, 4)",
            "sqrt(x^2 + y^2) = 2",
            Some(1),
        ),
        ("piecewise(x*y < 1: 0, (x*y - 1)^2*z)", "x*y = 1", Some(2)),
        ("piecewise(x < 0: sin(x), x - x^3/6)", "x = 0", Some(5)),
        ("abs(x + exp(x)) + y", "x + exp(x) = 0", None),
    ] {
        let found = jumps(text);
        assert_eq!(found, [(place.to_owned(), jump)], "{text}");
    }
    // the sign of a parameter is no joint, and branches that fit have none
    for text in [
        "abs(a)*x^2",
        "abs(x)^2 + y",
        "piecewise(x < 0: (x + 1)^2, x^2 + 2*x + 1)",
        "x^4",
    ] {
        assert_eq!(jumps(text), [], "{text}");
    }
    // the same joint twice, and several
    assert_eq!(jumps("abs(x) + piecewise(x > 0: x^2, 0)").len(), 1);
    assert_eq!(jumps("piecewise(x < 0: 0, x < 1: x^3, 3*x - 2)").len(), 2);
    let ramp = jumps("piecewise(x < 0: 0, x < 1/2: x, 1/2)");
    assert_eq!(ramp, [("x = 0, 1/2".to_owned(), Some(1))]);
}

#[test]
fn orders_are_the_least_of_all_joints() {
    let order = |text: &str, order| reached(&joints(&of(text)), order);
    assert_eq!(order("x*abs(x)*y", 4), Some(2));
    assert_eq!(order("x*abs(x)*y", 1), Some(1));
    assert_eq!(order("abs(y)^3 + x*abs(x)", 6), Some(2));
    assert_eq!(order("x^2", 6), Some(6));
    assert_eq!(order("abs(x + exp(x))", 6), None);
}

#[test]
fn a_function_that_jumps_is_warned_of() {
    for (text, says) in [
        (
            "piecewise(x < 1: y, z)",
            Some("the function jumps where x = 1"),
        ),
        ("x^2 + abs(y)", Some("the gradient jumps where y = 0")),
        ("x^2 + abs(y)*y", None),
    ] {
        let hamiltonian = format!("{text:?}");
        let (_, found) = run(&so3(&[("hamiltonian", &hamiltonian)]));
        let messages: Vec<&str> = found.iter().map(|d| d.message.as_str()).collect();
        match says {
            Some(says) => assert!(
                messages.len() == 1 && messages[0].starts_with(says),
                "{messages:?}"
            ),
            None => assert!(messages.is_empty(), "{messages:?}"),
        }
        assert!(
            found
                .iter()
                .all(|d| d.warning && d.kind == Kind::Smoothness)
        );
    }
}
