//! What other languages write gets a remedy that works when it is applied to the letter.

use super::*;

/// The first mistake: message and remedy.
fn first(text: &str) -> (String, String) {
    let diagnostics = parse(text).expect_err(text);
    let first = diagnostics.into_iter().next().expect("a mistake");
    (first.message, first.help.expect("a remedy"))
}

/// Text, the part of it that is wrong, and what the remedy writes instead.
const APPLIED: &[(&str, &str, &str)] = &[
    // Python and NumPy
    ("1 + np.sin(x)", "np.sin(x)", "sin(x)"),
    ("math.sqrt(x^2 + 1)", "math.sqrt(x^2 + 1)", "sqrt(x^2+1)"),
    ("np.pi*x", "np.pi", "pi"),
    ("std::exp(-x)", "std::exp(-x)", "exp(-x)"),
    ("x**2", "**", "^"),
    ("pow(x + y, 2)", "pow(x + y, 2)", "(x+y)^2"),
    ("fabs(x)", "fabs(x)", "abs(x)"),
    ("fmax(x, y)", "fmax(x, y)", "max(x, y)"),
    ("sign(x)", "sign(x)", "piecewise(x < 0: -1, 1)"),
    ("log10(x^2)", "log10(x^2)", "log(x^2)/log(10)"),
    ("log2(x)", "log2(x)", "log(x)/log(2)"),
    ("arctan2(y, x)", "arctan2(y, x)", "atan2(y, x)"),
    ("arcsinh(x)", "arcsinh(x)", "asinh(x)"),
    ("arcosh(x)", "arcosh(x)", "acosh(x)"),
    ("arctanh(x)", "arctanh(x)", "atanh(x)"),
    ("cuberoot(x)", "cuberoot(x)", "cbrt(x)"),
    ("1_000*x", "1_000", "1000"),
    (".5*x", ".5", "0.5"),
    // Matlab and Julia
    ("x.^2", ".^", "^"),
    ("x .* y", ".*", "*"),
    ("x./y", "./", "/"),
    ("pi()*x", "pi()", "pi"),
    ("y()^2", "y()", "y"),
    ("2x", "2x", "2*x"),
    ("sec(x)", "sec(x)", "1/cos(x)"),
    ("coth(x)", "coth(x)", "1/tanh(x)"),
    // Mathematica and LaTeX
    ("Sin[x]^2", "Sin[x]", "sin(x)"),
    ("sqrt[x^2 + 1]", "sqrt[x^2 + 1]", "sqrt(x^2+1)"),
    ("x y", "x y", "x*y"),
    ("sin^2(x)", "sin^2(x)", "sin(x)^2"),
    ("sqrt x", "sqrt x", "sqrt(x)"),
    ("ln(x)", "ln(x)", "log(x)"),
    // characters
    ("x²", "²", "^2"),
    ("x·y", "x·y", "x*y"),
    ("x×y", "×", "*"),
    ("x−y", "−", "-"),
    ("½*x", "½", "(1/2)"),
];

#[test]
fn remedies_work_to_the_letter() {
    for (text, wrong, right) in APPLIED {
        let (message, help) = first(text);
        assert!(
            help.starts_with(&format!("write `{right}`"))
                || help.ends_with(&format!("written `{right}`")),
            "{text}: {message}: {help}"
        );
        let mended = text.replacen(wrong, right, 1);
        assert!(parse(&mended).is_ok(), "{text} becomes {mended}");
    }
}

#[test]
fn what_the_grammar_does_not_have_is_said_to_be_missing() {
    for (text, says) in [
        ("floor(x)", "a Hamiltonian jumps nowhere"),
        (
            "where(x, y, z)",
            "cases are written `piecewise(x < 0: -x, x)`",
        ),
        ("norm(x)", "of a vector"),
        ("det(x)", "in the components"),
        ("diff(x^2, x)", "derivatives are taken by the compiler"),
        ("x < y", "a comparison stands in `piecewise` alone"),
        ("x > 0 ? x : y", "a comparison stands in `piecewise` alone"),
        ("|x|", "`abs(x)`"),
        ("x'", "nothing to transpose"),
        ("x % 2", "no remainder"),
        ("x^2 # kinetic", "no comments"),
        ("x @ y", "is written A*v"),
        ("\\frac{x}{2}", "LaTeX is not read"),
        ("$x^2$", "LaTeX is not read"),
        ("“x^2”", "without quotes"),
        ("'x^2'", "nothing to transpose"),
        ("lambda x: x^2", "the formula alone"),
        ("x and y", "the formula alone"),
        ("x[0]^2", "the name of the coordinate"),
        ("x.dot(y)", "without a module or an object"),
        ("x^2, y^2", "a comma stands between the arguments"),
        ("0,5*x", "a decimal number has a point: write `0.5`"),
        ("atan(x, y)", "`atan2(a, b)`"),
        ("log(x, 2)", "`log(a)/log(b)`"),
        ("x\u{200b} + y", "remove it"),
    ] {
        let (message, help) = first(text);
        assert!(help.contains(says), "{text}: {message}: {help}");
    }
    let hidden = first("x\u{200b} + y").0;
    assert!(hidden.contains("U+200B"), "{hidden}");
}

#[test]
fn declared_names_are_no_habits() {
    let names: Names = ["and", "Sin", "x"].into_iter().collect();
    let mut report = Report::new();
    parse_expression_text("and*Sin + x", 0, &names, &mut report).expect("an expression");
    parse_expression_text("x and", 0, &names, &mut report);
    let found = report.into_diagnostics();
    assert!(found[0].message.starts_with("`*` is missing"), "{found:?}");
}

/// A system on so(3), and the one mistake that a change of its text makes: the place, message and remedy.
fn mistake(from: &str, to: &str) -> (String, String, String) {
    const BODY: &str = r#"{
  "name": "Body",
  "algebra": { "basis": ["e1", "e2", "e3"], "brackets": ["[e1, e2] = e3", "[e2, e3] = e1", "[e3, e1] = e2"] },
  "state": ["x", "y", "z"],
  "let": ["w = x/2"],
  "hamiltonian": "x^2 + w*y",
  "casimirs": ["C = x^2 + y^2"],
  "initial": [1, 0.5, -2]
}"#;
    let text = BODY.replacen(from, to, 1);
    assert_ne!(text, BODY, "{from}");
    let mut report = Report::new();
    crate::front::spec::read(&text, &mut report);
    let [found] = <[Diagnostic; 1]>::try_from(report.into_diagnostics()).expect("one mistake");
    let [(_, place)] = places(&text, std::slice::from_ref(&found))[..] else {
        panic!("no place");
    };
    let help = found.help.expect("a remedy");
    (place.to_owned(), found.message, help)
}

#[test]
fn a_value_is_given_by_one_sign() {
    for (from, to, sign) in [
        ("[e1, e2] = e3", "[e1, e2] == e3", "=="),
        ("[e1, e2] = e3", "[e1, e2] := e3", ":="),
        ("[e1, e2] = e3", "[e1, e2]: e3", ":"),
        ("[e1, e2] = e3", "[e1, e2] -> e3", "->"),
        ("C = x", "C: x", ":"),
        ("C = x", "C == x", "=="),
        ("w = x", "w := x", ":="),
    ] {
        let (place, message, help) = mistake(from, to);
        assert_eq!((place.as_str(), help.as_str()), (sign, "write `=`"), "{to}");
        assert!(message.contains(sign), "{message}");
    }
}

#[test]
fn a_casimir_is_no_equation() {
    for (text, place, remedy) in [
        ("C = x^2 + y^2 = 1", "= 1", "write `x^2+y^2`; its value"),
        ("x^2 + y^2 == 1/2", "== 1/2", "write `x^2+y^2`; its value"),
        ("x^2 = z - y", "= z - y", "write `x^2 - (z-y)`"),
    ] {
        let (found, message, help) = mistake("C = x^2 + y^2", text);
        assert_eq!(found, place);
        assert!(message.contains("not an equation"), "{message}");
        assert!(help.starts_with(remedy), "{text}: {help}");
    }
}

#[test]
fn brackets_stand_alone() {
    for between in [", ", "; ", " "] {
        let both = format!("[e1, e2] = e3{between}[e2, e3] = e1");
        let (place, message, help) = mistake("[e1, e2] = e3\", \"[e2, e3] = e1", &both);
        assert_eq!(place, "[e2, e3]", "{both}");
        assert!(message.starts_with("a second bracket"), "{message}");
        assert_eq!(help, "write one string for each bracket");
    }
}

#[test]
fn an_initial_state_by_names_becomes_a_list() {
    let by_name = r#"{ "z": -2, "x": 1, "y": "1/2" }"#;
    let (place, message, help) = mistake("[1, 0.5, -2]", by_name);
    assert_eq!(
        (place.as_str(), message.as_str()),
        ("{", "`initial` is a list, not an object")
    );
    assert_eq!(help, "write `[1, \"1/2\", -2]`, in the order of the state");
    let (_, message, help) = mistake("[1, 0.5, -2]", "\"random\"");
    assert_eq!(message, "`initial` is a list, not a string");
    assert_eq!(help, "write a list with one value for each of x, y, z");
    let (_, _, help) = mistake("[1, 0.5, -2]", "\"1, 1/2, f(-2, 3)\"");
    assert_eq!(
        help,
        "write `[\"1\", \"1/2\", \"f(-2, 3)\"]`, in the order of the state"
    );
}

#[test]
fn names_with_a_number_in_brackets() {
    let (place, message, help) = mistake("[\"x\",", "[\"x[0]\",");
    assert_eq!((place.as_str(), help.as_str()), ("x[0]", "write `x0`"));
    assert!(message.contains("not elements of a list"), "{message}");
}

#[test]
fn what_json_does_not_have() {
    for (from, to, place, remedy) in [
        ("\"name\"", "// a body\n\"name\"", "//", "remove it"),
        ("\"Body\",", "\"Body\", # a body", "#", "remove it"),
        ("{\n", "/* a body */ {\n", "/*", "remove it"),
        ("-2]\n}", "-2]\n}\n// end", "//", "remove it"),
        ("0.5", "NaN", "NaN", "a finite number"),
        ("0.5", "nan", "nan", "a finite number"),
        ("0.5", "-Infinity", "-Infinity", "a finite number"),
        ("0.5", "inf", "inf", "a finite number"),
        ("0.5", ".5", ".", "the zero"),
        ("0.5", "True", "True", "`true`"),
        ("\"Body\"", "'Body'", "'", "double quotes"),
    ] {
        let (found, message, help) = mistake(from, to);
        assert_eq!(found, place, "{to}: {message}");
        assert!(help.contains(remedy), "{to}: {help}");
    }
}
