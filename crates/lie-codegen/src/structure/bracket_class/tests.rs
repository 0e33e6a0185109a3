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
    assert_eq!(
        of("x y", &["{x, y} = (1 + x)*y"]),
        Class::Elementwise(Vec::new())
    );
    let one = of("x y", &["{x, y} = (1 + x^2)*y"]);
    assert_eq!(one, Class::Elementwise(vec!["atan(x)".to_owned()]));
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
    let pairs = ["{x, y} = 1/(1 + x^2 + y^2)", "{z, u} = u*(z + 1)"];
    let Class::Conjugate(found) = of("x y z u", &pairs) else {
        panic!("no conjugate pairs");
    };
    let (integral, place) = found[0].split_once(" in ").expect("a place");
    assert_eq!(place, "the place of y beside x");
    assert_eq!(sorted(integral), sorted("y + y*x^2 + y^3/3"));
    let Class::Conjugate(found) = of("y z x", &pairs[..1]) else {
        panic!("no conjugate pair beside a Casimir");
    };
    assert!(
        found[0].ends_with("in the place of x beside y"),
        "{found:?}"
    );
    let euler = ["{x, y} = z", "{y, z} = x", "{z, x} = y"];
    assert!(matches!(of("x y z", &euler), Class::Jacobian(_)));
    let affine = ["{x, y} = z + 1", "{y, z} = x", "{z, x} = y"];
    assert!(matches!(of("x y z", &affine), Class::Jacobian(_)));
    assert_eq!(of("x y z u", &affine), Class::Affine);
}

/// Terms of a sum in an order of their own.
fn sorted(sum: &str) -> Vec<String> {
    let mut terms: Vec<String> = sum
        .split(" + ")
        .map(|term| {
            let mut factors: Vec<&str> = term.split('*').collect();
            factors.sort_unstable();
            factors.join("*")
        })
        .collect();
    terms.sort_unstable();
    terms
}

/// The Casimir of a function times a Jacobian bracket is found whatever the function is made of, also where it is a quotient or a logarithm.
#[test]
fn a_function_times_a_jacobian_bracket_has_its_casimir() {
    let of = |brackets: &[&str]| {
        let found = class_of("x y z", brackets, "x^2");
        let Some(Class::Multiple(casimir)) = found else {
            panic!("{brackets:?}: {found:?}");
        };
        sorted(&casimir)
    };
    let factored = [
        "{x, y} = (1 + x)*z",
        "{y, z} = (1 + x)*x",
        "{z, x} = (1 + x)*y",
    ];
    assert_eq!(of(&factored), sorted("x^2/2 + y^2/2 + z^2/2"));
    let expanded = [
        "{x, y} = z + x*y*z",
        "{y, z} = x + x^2*y",
        "{z, x} = 3*y^2 + 3*x*y^3",
    ];
    assert_eq!(of(&expanded), sorted("x^2/2 + y^3 + z^2/2"));
    let divided = [
        "{x, y} = 2*z/(1 + x*z)^2",
        "{y, z} = y/(1 + x*z)^2",
        "{z, x} = x/(1 + x*z)^2",
    ];
    assert_eq!(of(&divided), sorted("y*x + z^2"));
    // of several multipliers one is taken whose exponents are whole
    let powers = ["{y, z} = 2*z*(1 + x*y)", "{x, y} = 3*x*(1 + x*y)"];
    assert_eq!(of(&powers), sorted("log(x^2) + 3*log(z^2)/2"));
    let inverse = ["{x, y} = 1/z", "{y, z} = 1/x", "{z, x} = 1/y"];
    assert_eq!(of(&inverse), sorted("x*y*z"));
    let quotient = ["{y, z} = -y*(1 + z + x*y)", "{z, x} = x*(1 + z + x*y)"];
    assert_eq!(of(&quotient), sorted("y/x"));
}

/// The function that it is multiplied with may be any that all entries have as a factor, or be multiplied out.
#[test]
fn any_common_factor_is_taken_out() {
    let gradient = ["2*z + x*y", "x^3 + y*z", "y^4 + x*z"];
    let expected = sorted("x^4/4 + y^5/5 + z^2 + z*x*y");
    for factor in [
        "(1 + x^2)",
        "exp(y)",
        "sin(x*y + z)*exp(y)",
        "1/(2 + z^2)",
        "sqrt(2 + z + x^2)",
        "(1 + x*y*z)^3",
        "(exp(x) + z)",
        "(1 + x + 2*y + z)^6",
    ] {
        let pairs = ["{x, y}", "{y, z}", "{z, x}"];
        let brackets = pairs.iter().zip(gradient);
        let brackets: Vec<String> = brackets
            .map(|(pair, slope)| format!("{pair} = {factor}*({slope})"))
            .collect();
        let brackets: Vec<&str> = brackets.iter().map(String::as_str).collect();
        let Some(Class::Multiple(casimir)) = class_of("x y z", &brackets, "x^2") else {
            panic!("{factor}");
        };
        assert_eq!(sorted(&casimir), expected, "{factor}");
    }
    // neither of them rational
    let both = [
        "{x, y} = cosh(z)*exp(z)",
        "{y, z} = cosh(z)*cos(x)",
        "{z, x} = 2*cosh(z)*y",
    ];
    let Some(Class::Multiple(casimir)) = class_of("x y z", &both, "x^2") else {
        panic!("a function times a Jacobian bracket");
    };
    assert_eq!(sorted(&casimir), sorted("sin(x) + y^2 + exp(z)"));
}

#[test]
fn near_misses_are_in_no_class() {
    // a function of momenta in the place of the field
    assert_eq!(class_of("x y", &["{x, y} = 1 + x*y"], "x^2"), None);
}
