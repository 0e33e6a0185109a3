use super::{Class, class};
use crate::compile::compile_spec;

fn class_of(state: &str, brackets: &[&str], hamiltonian: &str) -> Option<Class> {
    let list = |items: Vec<String>| items.join(", ");
    let quoted = |text: &str| format!("\"{text}\"");
    let state = list(state.split(' ').map(quoted).collect());
    let brackets = list(brackets.iter().map(|text| quoted(text)).collect());
    let spec = format!(
        r#"{{"format": 1, "name": "Bracket", "state": [{state}], "poisson": [{brackets}], "hamiltonian": "{hamiltonian}"}}"#
    );
    class(&compile_spec(&spec).expect("a spec without mistakes"))
}

#[test]
fn each_class_is_found() {
    let of = |state, brackets: &[&str]| class_of(state, brackets, "x^2").expect("a class");
    assert_eq!(
        of("x y z u", &["{x, z} = 1", "{y, u} = 2", "{z, u} = 3"]),
        Class::Constant
    );
    assert_eq!(of("x y", &["{x, y} = -x*y/2"]), Class::LogCanonical);
    assert_eq!(of("x y", &["{x, y} = (1 + x)*y"]), Class::Elementwise);
    let field = ["{x, z} = 1", "{y, u} = 1", "{z, u} = 1 + cos(x)*y"];
    assert_eq!(of("x y z u", &field), Class::Magnetic(vec![0, 1]));
    // the positions come last
    let field = ["{z, x} = 1", "{u, y} = 1", "{x, y} = 1 + z*u"];
    assert_eq!(of("x y z u", &field), Class::Magnetic(vec![2, 3]));
    let nambu = [
        "{y, z} = x^3 + y*z/2 + x",
        "{z, x} = y^3 + x*z/2",
        "{x, y} = z^3 + x*y/2",
    ];
    let Class::Jacobian(casimir) = of("x y z", &nambu) else {
        panic!("no Jacobian bracket");
    };
    assert!(casimir.contains("z*x*y/2"), "{casimir}");
    let euler = ["{x, y} = z", "{y, z} = x", "{z, x} = y"];
    assert!(matches!(of("x y z", &euler), Class::Jacobian(_)));
    let affine = ["{x, y} = z + 1", "{y, z} = x", "{z, x} = y"];
    assert!(matches!(of("x y z", &affine), Class::Jacobian(_)));
    assert_eq!(of("x y z u", &affine), Class::Affine);
}

#[test]
fn near_misses_are_in_no_class() {
    // conformal to a Jacobian bracket, with a factor that is no constant
    let conformal = [
        "{x, y} = (1 + x)*z",
        "{y, z} = (1 + x)*x",
        "{z, x} = (1 + x)*y",
    ];
    assert_eq!(class_of("x y z", &conformal, "x^2"), None);
    // a function of momenta in the place of the field
    assert_eq!(class_of("x y", &["{x, y} = 1 + x*y"], "x^2"), None);
}
