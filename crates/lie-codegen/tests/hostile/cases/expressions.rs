//! Expressions that are long, deep, high, or made of long numbers.

use super::spec::{Draw, Spec, each, joined};
use super::{Case, case};

pub fn cases() -> Vec<Case> {
    let mut cases = sums();
    cases.extend(chains());
    cases.extend(depth());
    cases.extend(numbers());
    cases.extend(mistakes());
    cases
}

fn energy(name: &str, text: String) -> Case {
    case(name, Spec::body().text("hamiltonian", &text))
}

const AXES: [&str; 3] = ["x", "y", "z"];

fn sums() -> Vec<Case> {
    let mut draw = Draw(11);
    let mut monomial = |most: usize| {
        format!(
            "{}*x^{}*y^{}*z^{}",
            draw.below(999) + 1,
            draw.below(most),
            draw.below(most),
            draw.below(most)
        )
    };
    let monomials = |count: usize, monomial: &mut dyn FnMut() -> String| {
        (0..count)
            .map(|_| monomial())
            .collect::<Vec<_>>()
            .join(" + ")
    };
    vec![
        energy("20000 equal terms", vec!["x"; 20_000].join(" + ")),
        energy("10^6 equal terms", vec!["x"; 1_000_000].join("+")),
        energy("3000 monomials", monomials(3000, &mut || monomial(30))),
        energy("20000 monomials", monomials(20_000, &mut || monomial(40))),
        energy("60000 monomials", monomials(60_000, &mut || monomial(900))),
        energy(
            "1000 waves",
            joined(1000, " + ", |i| format!("sin({i}*x + y)")),
        ),
        energy(
            "5000 waves",
            joined(5000, " + ", |i| format!("sin({i}*x + y*z)")),
        ),
        energy(
            "2000 roots",
            joined(2000, " + ", |i| format!("sqrt({} + x^2 + {i}*y^2)", i + 1)),
        ),
        energy(
            "1000 poles",
            joined(1000, " + ", |i| format!("1/({} + x^2 + {i}*y)", i + 2)),
        ),
        energy(
            "500 poles of high order",
            joined(500, " + ", |i| format!("({} + x^2 + {i}*y)^-{i}", i + 2)),
        ),
        energy(
            "100 different Gaussians of quadratics",
            joined(100, " + ", |i| {
                format!(
                    "exp(-((x - {i})^2 + (y - {i}/3)^2 + (z + {i}/7)^2)/{})",
                    i + 2
                )
            }),
        ),
        energy(
            "a product of 3000 sums",
            joined(3000, "*", |i| format!("(x + {i})")),
        ),
        energy(
            "a product of 60 sums",
            joined(60, "*", |i| format!("(x + {i}*y + z)")),
        ),
        energy(
            "a product of 300 sums of three",
            joined(300, "*", |i| format!("({}*x + {i}*y + z)", i + 1)),
        ),
        energy("a power of a sum", "(x + y + z + 1)^1000".into()),
        energy(
            "many powers of sums",
            joined(300, " + ", |i| format!("(x + {i}*y + z)^{}", 1000 - i)),
        ),
        energy(
            "powers of sums of powers of sums",
            (0..30).fold("x + y + z".into(), |inner, i| {
                format!("({inner})^2 + {}", AXES[i % 3])
            }),
        ),
        energy(
            "a quotient of products of sums",
            format!(
                "({})/({})",
                joined(40, "*", |i| format!("(x + {i}*y + 1)")),
                joined(40, "*", |i| format!("(z^2 + {i}*y^2 + 1)"))
            ),
        ),
        energy(
            "quotients of quotients",
            (0..150).fold("x".into(), |inner, i| {
                format!("{}/(1 + {inner})", AXES[i % 3])
            }),
        ),
        energy(
            "a power with an exponent that varies",
            joined(200, " + ", |i| format!("({} + x^2)^(y*{i} + z)", i + 1)),
        ),
        energy(
            "a tower of exponents",
            (0..100).fold("x".into(), |inner, _| format!("(2 + y^2)^({inner})")),
        ),
        energy(
            "1000 angles",
            joined(1000, " + ", |i| format!("atan2(x + {i}, y + {i}*z)")),
        ),
        energy("a dense form of 4th degree", {
            let axes = |i: usize| AXES[i % 3];
            joined(600, " + ", |i| {
                format!("{}*({} + {}*{})^4", i + 1, axes(i), i, axes(i + 1))
            })
        }),
    ]
}

fn chains() -> Vec<Case> {
    let chain = |name: &str, count: usize, first: &str, step: &str| {
        let mut lets = vec![format!("a0 = {first}")];
        lets.extend((1..count).map(|i| {
            format!(
                "a{i} = {}",
                step.replace('#', &format!("a{}", i - 1))
                    .replace('%', AXES[i % 3])
                    .replace('$', &i.to_string())
            )
        }));
        case(
            name,
            Spec::body()
                .list("let", &lets)
                .text("hamiltonian", &format!("a{}", count - 1)),
        )
    };
    vec![
        chain("a chain of squares", 400, "x", "#*# + y"),
        chain("a chain of squares, short", 12, "x", "#*# + %"),
        chain("a chain of sums", 400, "x", "# + %"),
        chain("a chain of doubled sums", 400, "x + y*z", "# + # + %^2"),
        chain("a long chain of names", 10_000, "x", "#"),
        chain("a long chain of sums", 10_000, "x", "# + $*%"),
        chain("a long chain of products", 10_000, "x", "#*%"),
        chain("a chain of waves", 400, "x", "sin(#)"),
        chain("a chain of waves and coordinates", 400, "x", "sin(# + %)"),
        chain("a long chain of waves", 3000, "x", "sin(# + %)"),
        chain("a short chain of waves", 40, "x", "sin(# + %)*cos(#)"),
        chain("a chain of roots", 400, "x^2", "sqrt(1 + # + %^2)"),
        chain("a chain of quotients", 400, "x", "%/(1 + #^2)"),
        chain("a short chain of quotients", 30, "x", "%/(1 + #^2)"),
        chain("a chain of exponentials", 400, "x + y", "exp(-#)"),
        chain("a chain of powers", 400, "x", "#^7"),
        chain("a chain of coefficients", 400, "2*x", "#^30"),
        chain("a chain of long numbers", 400, "x + 1/3", "#*3^900"),
        chain("a chain of numbers", 400, "3^900", "#*#"),
        chain("a chain of fractions", 2000, "x", "#/3 + %/7"),
        chain(
            "a chain of differences of squares",
            60,
            "x",
            "(# + %)^2 - #^2 - %^2",
        ),
        chain(
            "a chain of cancelling products",
            200,
            "x*y",
            "(# + 1)*(# - 1) + %",
        ),
        chain("a Fibonacci chain", 60, "x", "# + #*% - sin(#)"),
        case(
            "10000 abbreviations without use",
            Spec::body().list("let", &each(10_000, |i| format!("a{i} = x + {i}*y"))),
        ),
        case(
            "3000 abbreviations that all use the first",
            Spec::body()
                .list(
                    "let",
                    &each(3000, |i| {
                        if i == 0 {
                            "a0 = sin(x + y*z)".into()
                        } else {
                            format!("a{i} = a0^2 + {i}*a0")
                        }
                    }),
                )
                .text("hamiltonian", &joined(3000, " + ", |i| format!("a{i}"))),
        ),
        case(
            "a chain in a Casimir",
            Spec::body()
                .list(
                    "let",
                    &each(30, |i| {
                        if i == 0 {
                            "a0 = x^2 + y^2 + z^2".into()
                        } else {
                            format!("a{i} = sin(a{})*a{} + 1", i - 1, i - 1)
                        }
                    }),
                )
                .list("casimirs", &["a29".to_owned()]),
        ),
        case(
            "a long chain in a Casimir",
            Spec::body()
                .list(
                    "let",
                    &each(400, |i| {
                        if i == 0 {
                            "a0 = x^2 + y^2 + z^2".into()
                        } else {
                            format!("a{i} = sin(a{})*a{} + 1", i - 1, i - 1)
                        }
                    }),
                )
                .list("casimirs", &["a399".to_owned()]),
        ),
        case(
            "a chain in the brackets",
            Spec::poisson(
                3,
                &[
                    "{x0, x1} = a25".to_owned(),
                    "{x1, x2} = a24*x0".to_owned(),
                    "{x0, x2} = a23 + x1".to_owned(),
                ],
                "x0^2",
            )
            .list(
                "let",
                &each(26, |i| {
                    if i == 0 {
                        "a0 = x0 + x1*x2".into()
                    } else {
                        format!("a{i} = a{}^2 + x{}", i - 1, i % 3)
                    }
                }),
            ),
        ),
        case(
            "a chain of a Lagrangian",
            Spec::body()
                .without("hamiltonian")
                .list(
                    "velocity",
                    &["u".to_owned(), "v".to_owned(), "w".to_owned()],
                )
                .list(
                    "let",
                    &each(20, |i| {
                        if i == 0 {
                            "a0 = u^2 + v^2 + w^2".into()
                        } else {
                            format!("a{i} = sqrt(1 + a{}^2 + u*v)", i - 1)
                        }
                    }),
                )
                .text("lagrangian", "a19"),
        ),
    ]
}

fn depth() -> Vec<Case> {
    let nested = |count: usize, open: &str, close: &str| {
        format!("{}x{}", open.repeat(count), close.repeat(count))
    };
    vec![
        energy("100 parentheses", nested(100, "(", ")")),
        energy("10^5 parentheses", nested(100_000, "(", ")")),
        energy("10^5 open parentheses", "(".repeat(100_000)),
        energy("10^6 minus signs", format!("{}x", "-".repeat(1_000_000))),
        energy("a tower of 10^5 powers", vec!["x"; 100_000].join("^")),
        energy("10^5 nested waves", nested(100_000, "sin(", ")")),
        energy("60 nested waves", nested(60, "sin(", ")")),
        energy("200 nested sums", nested(200, "(y + ", ")")),
        energy(
            "a fraction of 200 stages",
            nested(200, "1/(2 + z^2 + ", ")"),
        ),
        energy("200 nested powers", nested(200, "(", ")^2")),
        energy(
            "a sum in a sum in a sum",
            nested(5000, "sum(i in 0..3: ", ")"),
        ),
        case(
            "brackets of 10^5 parentheses",
            Spec::algebra(
                3,
                &[format!("[e0, e1] = {}", nested(100_000, "(", ")"))],
                "x0",
            ),
        ),
        case(
            "brackets in brackets",
            Spec::algebra(
                3,
                &[format!(
                    "{}e0, e1{} = e2",
                    "[".repeat(10_000),
                    "]".repeat(10_000)
                )],
                "x0",
            ),
        ),
        case(
            "a name of 10^6 letters",
            Spec::body().text("hamiltonian", &"x".repeat(1_000_000)),
        ),
        case(
            "a state of a name of 10^6 letters",
            Spec::body().set(
                "state",
                format!("[\"{}\", \"y\", \"z\"]", "x".repeat(1_000_000)),
            ),
        ),
    ]
}

fn numbers() -> Vec<Case> {
    let digits = |count: usize| "7".repeat(count);
    let mut draw = Draw(13);
    let mut random = |count: usize| -> String {
        (0..count)
            .map(|_| char::from(b'1' + draw.below(9) as u8))
            .collect()
    };
    let (a, b) = (random(10_000), random(10_000));
    let fractions: Vec<String> = (0..200)
        .map(|i| format!("{}/{}*{}^2", random(1000), random(1000), AXES[i % 3]))
        .collect();
    let parameter = |value: &str| {
        Spec::body()
            .set("parameters", format!("{{\"p\": {value}}}"))
            .text("hamiltonian", "p*x^2")
    };
    vec![
        energy("a number of 10^4 digits", format!("{}*x", digits(10_000))),
        energy(
            "a number of 10^6 digits",
            format!("{}*x", digits(1_000_000)),
        ),
        energy(
            "a number of 10^7 digits",
            format!("{}*x", digits(10_000_000)),
        ),
        energy("10^6 decimals", format!("0.{}*x", digits(1_000_000))),
        energy("a rational number of 10^4 digits", format!("{a}/{b}*x")),
        energy("10^4 digits to a power", format!("{a}^1000*x")),
        energy(
            "a sum of 200 fractions of 1000 digits",
            fractions.join(" + "),
        ),
        energy(
            "a sum of fractions with different denominators",
            joined(3000, " + ", |i| format!("x/{}", 2 * i + 3)),
        ),
        energy(
            "a product of fractions",
            joined(3000, "*", |i| format!("{}/{}", i + 2, 3 * i + 4)) + "*x",
        ),
        energy("an exponent of 10^4 digits", format!("x^{a}")),
        energy(
            "a fractional exponent of 1000 digits",
            format!("x^(1/{})", digits(1000)),
        ),
        energy(
            "a sum of fractional exponents",
            joined(300, " + ", |i| {
                format!("(1 + x^2)^({}/{})", i + 1, 2 * i + 3)
            }),
        ),
        energy("1e400", "1e400*x".into()),
        energy("1e-400", "1e-400*x".into()),
        energy("1e999999999", "1e999999999*x".into()),
        energy(
            "1e-99999999999999999999",
            "1e-99999999999999999999*x".into(),
        ),
        energy("9^9^9^9", "9^9^9^9*x".into()),
        energy("2^(10^9)", "2^(10^9)*x".into()),
        energy(
            "roots of long numbers",
            joined(100, " + ", |i| format!("sqrt({}{i})*x", digits(300))),
        ),
        energy(
            "nested roots of numbers",
            (0..100).fold("2".into(), |inner, i| format!("sqrt({} + {inner})", i + 2)) + "*x",
        ),
        energy(
            "zero written as roots",
            "x/(sqrt(2) + sqrt(3) - sqrt(5 + 2*sqrt(6)))".into(),
        ),
        energy(
            "zero written as waves",
            "x/(sin(1)^2 + cos(1)^2 - 1)".into(),
        ),
        energy(
            "nearly zero",
            "x/(exp(pi*sqrt(163)) - 262537412640768744)".into(),
        ),
        energy(
            "nested exponentials of numbers",
            "exp(exp(exp(exp(exp(exp(2))))))*x".into(),
        ),
        energy("waves of large numbers", "x/sin(10^300)".into()),
        energy(
            "200 irrational divisors",
            joined(200, " + ", |i| {
                format!("x/(sin({i}) + sqrt({}) - exp({i}/100))", i + 2)
            }),
        ),
        energy(
            "constants that are hard to decide",
            joined(60, " + ", |i| {
                format!("x/(sin({i})^2 + cos({i})^2 - 1)", i = i + 1)
            }),
        ),
        case("a default of 10^4 digits", parameter(&a)),
        case(
            "a default of 10^4 digits by 10^4 digits",
            parameter(&format!("\"{a}/{b}\"")),
        ),
        case("a default of 10^6 digits", parameter(&digits(1_000_000))),
        case("a default of 1e999999999", parameter("1e999999999")),
        case("a default that is a tower", parameter("\"9^9^9^9\"")),
        case(
            "a default of nested functions",
            parameter("\"exp(sin(exp(sin(exp(sin(exp(sin(1))))))))\""),
        ),
        case(
            "initial values of 10^4 digits",
            Spec::body().set("initial", format!("[\"{a}/{b}\", {a}, \"1/{b}\"]")),
        ),
        case(
            "a bracket with 10^4 digits",
            Spec::algebra(
                3,
                &[
                    format!("[e0, e1] = {a}/{b}*e2"),
                    format!("[e1, e2] = {b}/{a}*e0"),
                ],
                "x0^2",
            ),
        ),
        case(
            "60 brackets with 1000 digits",
            Spec::algebra(
                61,
                &each(60, |i| {
                    format!(
                        "[e0, e{}] = {}{i}/{}*e{}",
                        i + 1,
                        digits(1000),
                        "3".repeat(999) + "1",
                        i + 1
                    )
                }),
                "x0^2",
            ),
        ),
        case(
            "a Casimir with 10^4 digits",
            Spec::body().list(
                "casimirs",
                &[
                    format!("{a}*(x^2 + y^2 + z^2)"),
                    format!("(x^2 + y^2 + z^2)^2/{b} + x"),
                ],
            ),
        ),
        case(
            "a step of 10^4 digits",
            Spec::body().set("run", format!("{{\"step\": \"{a}/{b}\"}}")),
        ),
    ]
}

fn mistakes() -> Vec<Case> {
    vec![
        energy(
            "10^5 unknown names",
            joined(100_000, " + ", |i| format!("u{i}")),
        ),
        energy("10^5 equal unknown names", vec!["u"; 100_000].join(" + ")),
        energy(
            "10^5 unknown functions",
            joined(100_000, " + ", |i| format!("f{i}(x)")),
        ),
        energy(
            "10^5 wrong numbers of arguments",
            vec!["sin(x, y)"; 100_000].join(" + "),
        ),
        energy("10^5 divisions by zero", vec!["1/0"; 100_000].join(" + ")),
        energy("10^5 missing signs", vec!["2x"; 100_000].join(" + ")),
        energy("10^5 long numbers", vec!["1e999"; 100_000].join(" + ")),
        energy("10^5 roots of -1", vec!["sqrt(-1)"; 100_000].join(" + ")),
        energy("10^5 tokens that are none", "#$ ".repeat(100_000)),
        energy("10^6 double quotes", "\"".repeat(1_000_000)),
        case(
            "3000 names like the unknown one",
            Spec::body()
                .set(
                    "parameters",
                    format!(
                        "{{{}}}",
                        joined(3000, ", ", |i| format!("\"{}{i}\": 1", "a".repeat(200)))
                    ),
                )
                .text(
                    "hamiltonian",
                    &joined(1000, " + ", |i| format!("{}{i}b", "a".repeat(200))),
                ),
        ),
        case(
            "3000 long names, unknown names of 10^5 letters",
            Spec::body()
                .set(
                    "parameters",
                    format!(
                        "{{{}}}",
                        joined(3000, ", ", |i| format!("\"{}{i}\": 1", "a".repeat(2000)))
                    ),
                )
                .text(
                    "hamiltonian",
                    &joined(50, " + ", |i| format!("{}{i}", "b".repeat(100_000))),
                ),
        ),
        case(
            "10^5 brackets of unknown elements",
            Spec::algebra(
                100,
                &each(100_000, |i| format!("[e{i}, e{}] = e{}", i + 1, i + 2)),
                "x0",
            ),
        ),
        case(
            "10^5 brackets with wrong values",
            Spec::algebra(
                100,
                &each(100_000, |i| {
                    format!("[e{}, e{}] = e1*e2", i % 99, i % 99 + 1)
                }),
                "x0",
            ),
        ),
        case(
            "10^5 contradicting brackets",
            Spec::algebra(100, &each(100_000, |i| format!("[e0, e1] = {i}*e2")), "x0"),
        ),
        case(
            "10^5 brackets of an element with itself",
            Spec::algebra(100, &each(100_000, |_| "[e0, e0] = e1".into()), "x0"),
        ),
        case(
            "10^5 texts that are no brackets",
            Spec::algebra(100, &each(100_000, |i| format!("e{i} is fine")), "x0"),
        ),
        case(
            "10^5 unknown methods",
            Spec::body().list("methods", &each(100_000, |i| format!("m{i}"))),
        ),
        case(
            "10^5 equal methods",
            Spec::body().list("methods", &each(100_000, |_| "lie-midpoint".into())),
        ),
        case(
            "every composition of a composition",
            Spec::body().list(
                "methods",
                &["compose4(".repeat(1000) + "lie-midpoint" + &")".repeat(1000)],
            ),
        ),
        case(
            "10^5 initial values",
            Spec::body().set("initial", format!("[{}]", vec!["1"; 100_000].join(","))),
        ),
        case(
            "10^5 names of the state",
            Spec::body().list("state", &each(100_000, |i| format!("x{i}"))),
        ),
        case(
            "10^5 equal names of the state",
            Spec::body().list("state", &each(100_000, |_| "x".into())),
        ),
        case(
            "10^5 equal elements",
            Spec::body().set(
                "algebra",
                format!(
                    "{{\"basis\": {}}}",
                    super::spec::strings(&each(100_000, |_| "e".into()))
                ),
            ),
        ),
        case(
            "10^5 abbreviations of one name",
            Spec::body().list("let", &each(100_000, |i| format!("a = {i}"))),
        ),
        case(
            "10^5 abbreviations that use later ones",
            Spec::body().list("let", &each(100_000, |i| format!("a{i} = a{}", i + 1))),
        ),
        case(
            "10^5 abbreviations with reserved names",
            Spec::body().list(
                "let",
                &each(100_000, |i| {
                    format!("{} = {i}", ["fn", "sin", "pi", "t", "energy"][i % 5])
                }),
            ),
        ),
        case(
            "10^5 Casimirs with unknown names",
            Spec::body().list("casimirs", &each(100_000, |i| format!("C{i} = u{i}"))),
        ),
        case(
            "10^5 Casimirs",
            Spec::body().list(
                "casimirs",
                &each(100_000, |i| format!("C{i} = x^2 + y^2 + z^2 + {i}")),
            ),
        ),
    ]
}
