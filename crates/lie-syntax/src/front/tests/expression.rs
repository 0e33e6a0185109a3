//! Meanings and mistakes of expressions.

use super::*;
use crate::front::parse_constant_text;
use crate::front::text::Source;

fn meaning(text: &str) -> String {
    parse(text).map_or_else(|d| format!("{:?}", places(text, &d)), |e| explicit(&e))
}

fn mistakes(text: &str) -> Vec<(Kind, &str)> {
    places(text, &parse(text).err().unwrap_or_default())
}

/// The single mistake of a text: kind, place and remedy.
fn mistake(text: &str) -> (Kind, &str, String) {
    let diagnostics = parse(text).expect_err(text);
    assert_eq!(diagnostics.len(), 1, "{text}: {diagnostics:?}");
    let (kind, place) = places(text, &diagnostics)[0];
    (
        kind,
        place,
        diagnostics[0]
            .help
            .clone()
            .expect("every mistake has a remedy"),
    )
}

#[test]
fn precedence() {
    for (text, expected) in [
        ("x + y*z - 2", "(x+(y*z)-2)"),
        ("-x^2", "(-(x^2))"),
        ("x^2/a + y", "(((x^2)/a)+y)"),
        ("x^y^z", "(x^(y^z))"),
        ("x^-1", "(x^(-1))"),
        ("x^-y^2", "(x^(-(y^2)))"),
        ("x^(1/2)", "(x^(1/2))"),
        ("x/y/z*a", "(x/y/z*a)"),
        ("x - y - z", "(x-y-z)"),
        ("x*-y", "(x*(-y))"),
        ("x - -y", "(x-(-y))"),
        ("--x", "(-(-x))"),
        ("-x*y", "((-x)*y)"),
        ("2^-x*y", "((2^(-x))*y)"),
        ("(x)", "x"),
        ("atan2(x + 1, y)/2", "(atan2((x+1),y)/2)"),
        ("1.5e-3*x", "(3/2000*x)"),
        ("2e4", "20000"),
        ("2*e3", "(2*e3)"),
        ("pi*t", "(pi*t)"),
        ("Δ*ω", "(Δ*ω)"),
        ("x + y_1 + Δx", "(x+y_1+Δx)"),
    ] {
        assert_eq!(meaning(text), expected, "{text}");
    }
}

#[test]
fn places_of_parts() {
    let text = "a + sin( x )^2";
    let Expr {
        kind: ExprKind::Sum(terms),
        origin,
    } = parse(text).unwrap()
    else {
        panic!()
    };
    let part = |origin| match origin {
        Origin::Text { start, end } => &text[start..end],
        Origin::Span(_) => panic!(),
    };
    assert_eq!(part(origin), text);
    assert_eq!(part(terms[1].1.origin), "sin( x )^2");
    let ExprKind::Power(base, _) = &terms[1].1.kind else {
        panic!()
    };
    assert_eq!(part(base.origin), "sin( x )");
    let Expr {
        kind: ExprKind::Power(base, _),
        ..
    } = parse("(x+y)^2").unwrap()
    else {
        panic!()
    };
    assert!(matches!(base.origin, Origin::Text { start: 0, end: 5 }));
}

#[test]
fn a_missing_product_is_named() {
    for (text, place, help) in [
        ("2x", "2x", "write `2*x`"),
        ("2x^2", "2x", "write `2*x`"),
        ("a + 2 x", "2 x", "write `2*x`"),
        ("2(x+y)", "2(", "write `2*(x+y)`"),
        ("x(y)", "x(", "write `x*(y)`"),
        ("(a)(b)", "(a)(", "write `(a)*(b)`"),
        ("-(a)b", "(a)b", "write `(a)*b`"),
        ("x^2(y)", "2(", "write `2*(y)`"),
        ("sin(x)cos(y)", "sin(x)cos", "write `sin(x)*cos(y)`"),
        ("a/b c", "b c", "write `b*c`"),
        ("x 2", "x 2", "write `x*2`"),
        ("pi(x)", "pi(", "write `pi*(x)`"),
        (
            "2e3",
            "2e3",
            "write `2*e3`, or `2000` if the number is meant",
        ),
        ("2sin(x)", "2sin", "write `2*sin`"),
        ("2pi", "2pi", "write `2*pi`"),
    ] {
        assert_eq!(
            mistake(text),
            (Kind::Syntax, place, help.to_owned()),
            "{text}"
        );
    }
}

#[test]
fn malformed_numbers() {
    for (text, place) in [
        ("1..5", "1..5"),
        ("a + 1.2.3", "1.2.3"),
        (".5", "."),
        ("1.x", "1.x"),
        ("1f64*x", "1f64"),
        ("1_000", "1_000"),
        ("0x1", "0x1"),
        ("2q", "2q"),
    ] {
        let found = mistakes(text);
        assert_eq!(found[0], (Kind::Number, place), "{text}");
    }
}

#[test]
fn functions() {
    assert_eq!(
        mistake("sni(x)"),
        (Kind::UnknownFunction, "sni", "did you mean `sin`?".into())
    );
    assert_eq!(mistake("ln(x)").2, "write `log(x)`");
    assert_eq!(mistake("pow(x, 2)").2, "write `x^2`");
    assert!(
        mistake("gamma(x)")
            .2
            .starts_with("the functions are sqrt, exp")
    );
    assert_eq!(
        mistake("1 + sin(x, y)"),
        (Kind::Arity, "sin(x, y)", "write `sin(a)`".into())
    );
    assert_eq!(
        mistake("atan2(x)"),
        (Kind::Arity, "atan2(x)", "write `atan2(a, b)`".into())
    );
    assert_eq!(
        mistake("sin()"),
        (Kind::Arity, "sin()", "write `sin(a)`".into())
    );
    assert_eq!(
        mistake("2*sin"),
        (Kind::Syntax, "sin", "write `sin(…)`".into())
    );
    assert_eq!(mistake("sum + 1").0, Kind::Syntax);
    assert_eq!(mistakes("sin x").first(), Some(&(Kind::Syntax, "sin")));
}

#[test]
fn signs_and_delimiters() {
    for (text, place, help) in [
        ("+x", "+", "remove it"),
        ("x*+y", "+", "remove it"),
        ("x^+2", "+", "remove it"),
        ("x**2", "*", "a power is written `^`"),
        (
            "x +",
            "+",
            "write a number, a name or parentheses behind it",
        ),
        ("(x + y", "(", "add its closing partner"),
        ("x + y)", ")", "remove it, or add the opening one before it"),
        ("x = y", "=", "write the expression alone, without `=`"),
        ("x × y", "×", "write `*`"),
        ("x · y", "·", "write `*`"),
        ("ω·Π", "ω·Π", "write `ω*Π`"),
        ("x²", "²", "write `^2`"),
        ("x − y", "−", "write `-`"),
        ("x₁", "₁", "write `1`"),
        ("()", ")", "write one, or remove them"),
        (
            "sin(x,)",
            ")",
            "write a number, a name or parentheses after `,`",
        ),
    ] {
        assert_eq!(
            mistake(text),
            (Kind::Syntax, place, help.to_owned()),
            "{text}"
        );
    }
    for text in [
        "x ! y",
        "x; y",
        "\"x\"",
        "{x}",
        "x /",
        "/x",
        "x,y",
        "[x]",
        "#",
        "x \u{0} y",
        "'",
    ] {
        assert_eq!(mistake(text).0, Kind::Syntax, "{text}");
    }
}

#[test]
fn several_mistakes_at_once() {
    assert_eq!(
        mistakes("2x + sni(y) + 1_0"),
        [
            (Kind::Syntax, "2x"),
            (Kind::UnknownFunction, "sni"),
            (Kind::Number, "1_0")
        ]
    );
}

#[test]
fn families_are_read_and_refused() {
    let not_built = |text| {
        let (kind, place, help) = mistake(text);
        assert_eq!(
            (kind, help.as_str()),
            (
                Kind::Syntax,
                "a family has an algebra such as `so(3)^N` and a state such as `x[i]`; else write the copies out, as in x1, x2, x3"
            ),
            "{text}"
        );
        place
    };
    assert_eq!(not_built("1 + x[i+1]^2"), "x[i+1]");
    assert_eq!(
        mistake("x[0]"),
        (
            Kind::Syntax,
            "x[0]",
            "write the name of the coordinate as it stands in the state".into()
        )
    );
    assert_eq!(not_built("x[i-2]"), "x[i-2]");
    assert_eq!(
        not_built("2*sum(i in 0..N: x[i]^2)"),
        "sum(i in 0..N: x[i]^2)"
    );
    assert_eq!(
        not_built("sum(i in 1..5: sum(j in 0..N-1: x[j]))"),
        "sum(i in 1..5: sum(j in 0..N-1: x[j]))"
    );
    assert_eq!(mistake("sum(x, y)").2, "write `sum(i in 0..N: …)`");
    assert_eq!(mistake("sum(i in 0: x)").0, Kind::Syntax);
    assert_eq!(mistake("x[i*2]").0, Kind::Syntax);
    assert_eq!(
        mistake("x[99999999999999999999]").2,
        "write `x[i]`, `x[i+1]`, `x[i-2]` or `x[0]`"
    );
}

#[test]
fn nesting_is_limited_and_length_is_not() {
    for text in [
        "(".repeat(100_000),
        "-".repeat(100_000),
        "x^".repeat(100_000),
        "sin(".repeat(100_000),
        "x^-".repeat(100_000),
        "sum(i in ".repeat(100_000),
    ] {
        assert_eq!(parse(&text).unwrap_err()[0].kind, Kind::Limit);
    }
    assert!(parse(&format!("{}x{}", "(".repeat(90), ")".repeat(90))).is_ok());
    let long = "x + ".repeat(100_000) + "y";
    assert!(matches!(parse(&long).unwrap().kind, ExprKind::Sum(terms) if terms.len() == 100_001));
    assert_eq!(mistake("1e999999999").0, Kind::Limit);
}

#[test]
fn constants_have_no_names() {
    let constant = |text: &str| {
        let mut report = Report::new();
        let value = parse_constant_text(text, 0, &mut report);
        report
            .gate()
            .map(|()| explicit(&value.unwrap()))
            .map_err(|d| d[0].kind)
    };
    assert_eq!(constant("-1/2").unwrap(), "((-1)/2)");
    assert_eq!(constant("cos(11/10)*pi").unwrap(), "(cos((11/10))*pi)");
    for text in ["one", "", "  ", "x/2", "t"] {
        assert_eq!(constant(text), Err(Kind::Number), "{text:?}");
    }
}

#[test]
fn a_declared_function_name_is_left_to_the_check_of_names() {
    let names: Names = ["exp"].into_iter().collect();
    let mut report = Report::new();
    assert!(parse_expression_text("exp + 1", 0, &names, &mut report).is_some());
    assert!(report.gate().is_ok());
}

#[test]
fn places_go_through_json_escapes() {
    let raw = r#""\u0394 + \"\\q\u00e9 \ud835\udf14*w""#;
    let source = Source::json(raw, 100).unwrap();
    assert_eq!(source.text, "Δ + \"\\qé 𝜔*w");
    let tokens: Vec<(String, &str)> = source
        .tokens()
        .iter()
        .map(|t| match t.origin {
            Origin::Text { start, end } => (
                crate::front::token::render(std::slice::from_ref(t)),
                &raw[start - 100..end - 100],
            ),
            Origin::Span(_) => panic!(),
        })
        .collect();
    let expected = [
        ("Δ", r"\u0394"),
        ("+", "+"),
        ("\"", r#"\""#),
        ("\\", r"\\"),
        ("qé", r"q\u00e9"),
        ("𝜔", r"\ud835\udf14"),
        ("*", "*"),
        ("w", "w"),
    ];
    assert_eq!(tokens, expected.map(|(a, b)| (a.to_owned(), b)));
    for raw in [
        r#""\ud835""#,
        r#""\ud835x""#,
        r#""\ud835\u0041""#,
        r#""\udf14""#,
    ] {
        assert_eq!(
            Source::json(raw, 0).unwrap_err().kind,
            Kind::Schema,
            "{raw}"
        );
    }
}

#[test]
fn cases_are_choices_of_the_smaller() {
    for (text, expected) in [
        ("piecewise(x < 0: -x, x)", "piecewise(x,0,(-x),x)"),
        ("piecewise(x <= y: a, b)", "piecewise(y,x,b,a)"),
        ("piecewise(x > y: a, b)", "piecewise(y,x,a,b)"),
        ("piecewise(x >= y: a, b)", "piecewise(x,y,b,a)"),
        (
            "2*piecewise(x < 0: 1, x < 1: 2, 3)",
            "(2*piecewise(x,0,1,piecewise(x,1,2,3)))",
        ),
        (
            "abs(x) + min(x, y)*max(2, z)",
            "(abs(x)+(min(x,y)*max(2,z)))",
        ),
    ] {
        assert_eq!(meaning(text), expected, "{text}");
    }
}

#[test]
fn mistakes_in_cases_have_a_place_and_a_form() {
    for (text, place) in [
        ("piecewise(x, y)", "x"),
        ("piecewise(x)", "x"),
        ("piecewise(x < 0, y)", ","),
        ("piecewise(x < 0: y)", ")"),
        ("piecewise(x < 0: y, z, a)", ","),
    ] {
        let (kind, found, help) = mistake(text);
        assert_eq!((kind, found), (Kind::Syntax, place), "{text}");
        assert!(help.contains("`piecewise(x < 0: -x, x)`"), "{text}: {help}");
    }
    for text in [
        "piecewise(x == 0: y, z)",
        "piecewise(x < 0 < y: 1, 2)",
        "piecewise(x < 0: y, z",
    ] {
        assert_eq!(mistakes(text).len(), 1, "{text}: {:?}", mistakes(text));
    }
    assert_eq!(mistake("abs(x, y)").0, Kind::Arity);
    assert_eq!(mistake("max(x)").0, Kind::Arity);
    assert_eq!(mistakes("piecewise"), [(Kind::Syntax, "piecewise")]);
}
