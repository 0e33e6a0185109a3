//! Systems of many elements, brackets, parameters and Casimirs.

use super::spec::{Draw, Spec, each, joined, names};
use super::{Case, case};

pub fn cases() -> Vec<Case> {
    let mut cases = brackets();
    cases.extend(parameters());
    cases.extend(casimirs());
    cases.extend(general());
    cases
}

fn pairs(n: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..n).flat_map(move |i| (i + 1..n).map(move |j| (i, j)))
}

/// `gl(n)`: the element e_(a*n + b) has a one in row a and column b.
fn matrices(n: usize) -> Vec<String> {
    let mut brackets = Vec::new();
    for (p, q) in pairs(n * n) {
        let ((a, b), (c, d)) = ((p / n, p % n), (q / n, q % n));
        let mut terms = Vec::new();
        if b == c {
            terms.push(format!("e{}", a * n + d));
        }
        if d == a {
            terms.push(format!("-e{}", c * n + b));
        }
        if !terms.is_empty() {
            brackets.push(format!("[e{p}, e{q}] = {}", terms.join(" ")));
        }
    }
    brackets
}

/// Brackets with eight random terms for a share of the pairs.
fn random(n: usize, share: usize, seed: u64) -> Vec<String> {
    let mut draw = Draw(seed);
    let mut brackets = Vec::new();
    for (i, j) in pairs(n) {
        if draw.below(share) == 0 {
            let terms = joined(8, " + ", |_| String::new());
            let terms: Vec<String> = terms
                .split(" + ")
                .map(|_| {
                    format!(
                        "{}/{}*e{}",
                        draw.below(99) + 1,
                        draw.below(99) + 1,
                        draw.below(n)
                    )
                })
                .collect();
            brackets.push(format!("[e{i}, e{j}] = {}", terms.join(" + ")));
        }
    }
    brackets
}

/// A two-step nilpotent algebra whose brackets have eight terms: the last eight elements commute with all.
fn nilpotent(n: usize, most: usize) -> Vec<String> {
    let free = n - 8;
    let all = pairs(free).take(most);
    all.map(|(i, j)| {
        format!(
            "[e{i}, e{j}] = {}",
            joined(8, " + ", |k| format!("{}*e{}", i + 2 * j + k, free + k))
        )
    })
    .collect()
}

fn brackets() -> Vec<Case> {
    let full = |n: usize| -> Vec<String> {
        pairs(n)
            .map(|(i, j)| format!("[e{i}, e{j}] = e{j} - e{i}"))
            .collect()
    };
    let long = |n: usize| -> Vec<String> {
        pairs(n)
            .map(|(i, j)| {
                format!(
                    "[e{i}, e{j}] = {}",
                    joined(n, " + ", |k| format!("{}*e{k}", i * j + k))
                )
            })
            .collect()
    };
    let quadratic = |n: usize| {
        pairs(n)
            .map(|(i, j)| format!("x{i}*x{j}"))
            .collect::<Vec<_>>()
            .join(" + ")
    };
    let squares = |n: usize| joined(n, " + ", |i| format!("{}*x{i}^2", i + 1));
    let algebra = |name: &str, n: usize, brackets: Vec<String>, energy: &str| {
        case(name, Spec::algebra(n, &brackets, energy))
    };
    vec![
        algebra("256 elements, all pairs", 256, full(256), "x0^2"),
        algebra("64 elements, all pairs", 64, full(64), &squares(64)),
        algebra("110 elements, all pairs", 110, full(110), "x0^2"),
        algebra("40 elements, brackets of 40 terms", 40, long(40), "x0^2"),
        algebra("gl(16)", 256, matrices(16), "x0^2"),
        algebra("gl(10), all squares", 100, matrices(10), &squares(100)),
        algebra("gl(7), all products", 49, matrices(7), &quadratic(49)),
        algebra(
            "256 elements, random brackets of 8 terms",
            256,
            random(256, 4, 1),
            "x0^2",
        ),
        algebra(
            "256 elements, few random brackets of 8 terms",
            256,
            random(256, 100, 2),
            "x0^2",
        ),
        algebra(
            "100 elements, random brackets of 8 terms",
            100,
            random(100, 1, 3),
            "x0^2",
        ),
        algebra(
            "256 elements, 6000 nilpotent brackets of 8 terms",
            256,
            nilpotent(256, 6000),
            "x0^2",
        ),
        algebra(
            "200 elements, 3000 nilpotent brackets, all squares",
            200,
            nilpotent(200, 3000),
            &squares(200),
        ),
        algebra(
            "64 elements, all nilpotent brackets, all products",
            64,
            nilpotent(64, 9999),
            &quadratic(64),
        ),
        algebra(
            "256 elements, 10^5 repeated brackets",
            256,
            each(100_000, |_| "[e0, e1] = e2".into()),
            "x0^2",
        ),
        algebra(
            "256 elements, all products",
            256,
            vec!["[e0, e1] = e2".into()],
            &quadratic(256),
        ),
        algebra(
            "100 elements, all products",
            100,
            vec!["[e0, e1] = e2".into()],
            &quadratic(100),
        ),
        algebra(
            "256 elements, one wave of all",
            256,
            vec!["[e0, e1] = e2".into()],
            &format!("sin({})", joined(256, " + ", |i| format!("x{i}"))),
        ),
        algebra(
            "100 elements, one wave of all",
            100,
            full(100),
            &format!("sin({})", joined(100, " + ", |i| format!("x{i}"))),
        ),
        algebra(
            "256 elements, a power of the sum of all",
            256,
            vec!["[e0, e1] = e2".into()],
            &format!("({})^40", joined(256, " + ", |i| format!("x{i}"))),
        ),
        algebra(
            "60 elements, a root of all squares",
            60,
            full(60),
            &format!("sqrt({})", squares(60)),
        ),
        algebra("257 elements", 257, full(257), "x0^2"),
        algebra("20000 elements", 20_000, vec![], "x0^2"),
        algebra("256 elements, no brackets", 256, vec![], &squares(256)),
        case("256 elements, matrices of size 60", dense_matrices(256, 60)),
        case("20 elements, matrices of size 64", dense_matrices(20, 64)),
        case(
            "100 elements, dense matrices of size 10",
            dense_matrices(100, 10),
        ),
        case(
            "cocycle on all pairs of 100",
            Spec::algebra(100, &[], &squares(100)).list(
                "cocycle",
                &pairs(100)
                    .map(|(i, j)| format!("{{x{i}, x{j}}} = {}", i + j))
                    .collect::<Vec<_>>(),
            ),
        ),
        case(
            "cocycle on gl(9)",
            Spec::algebra(81, &matrices(9), "x0^2").list(
                "cocycle",
                &pairs(81)
                    .map(|(i, j)| format!("{{x{i}, x{j}}} = {}", i * j))
                    .collect::<Vec<_>>(),
            ),
        ),
        case(
            "gl(14), every method",
            Spec::algebra(196, &matrices(14), &squares(196))
                .set("methods", r#"["lie-midpoint", "gauss4", "splitting2"]"#),
        ),
    ]
}

fn dense_matrices(count: usize, size: usize) -> Spec {
    let matrix = |seed: usize| {
        let mut draw = Draw(seed as u64);
        let rows = joined(size, ",", |_| "#".into());
        let rows: Vec<String> = rows
            .split(',')
            .map(|_| {
                format!(
                    "[{}]",
                    (0..size)
                        .map(|_| (draw.below(199) as i64 - 99).to_string())
                        .collect::<Vec<_>>()
                        .join(",")
                )
            })
            .collect();
        format!("[{}]", rows.join(","))
    };
    let matrices = joined(count, ", ", |i| format!("\"e{i}\": {}", matrix(i)));
    let basis = super::spec::strings(&names("e", count));
    Spec::algebra(count, &[], "x0^2").set(
        "algebra",
        format!(r#"{{"basis": {basis}, "matrices": {{{matrices}}}}}"#),
    )
}

fn parameters() -> Vec<Case> {
    let used = |count: usize, value: &str, term: &dyn Fn(usize) -> String| {
        let each = joined(count, ", ", |i| format!("\"p{i}\": {value}"));
        Spec::body()
            .set("parameters", format!("{{{each}}}"))
            .text("hamiltonian", &joined(count, " + ", term))
    };
    let linear = |i: usize| format!("p{i}*x^2");
    vec![
        case("3000 parameters in a sum", used(3000, "2", &linear)),
        case("3001 parameters", used(3001, "2", &linear)),
        case("100000 parameters", used(100_000, "2", &linear)),
        case(
            "3000 parameters in waves",
            used(3000, "2", &|i| format!("sin(p{i}*x + y)")),
        ),
        case(
            "3000 parameters in quotients",
            used(3000, "2", &|i| {
                format!("{}/(1 + p{i})", ["x", "y", "z"][i % 3])
            }),
        ),
        case(
            "3000 parameters in powers",
            used(3000, "2", &|i| {
                format!("p{i}^{}*{}^2", i % 9, ["x", "y", "z"][i % 3])
            }),
        ),
        case(
            "1000 parameters, product of sums",
            used(1000, "2", &|i| format!("p{i}*x"))
                .text("hamiltonian", &joined(1000, "*", |i| format!("(x + p{i})"))),
        ),
        case(
            "3000 parameters, defaults of 1000 digits",
            used(3000, &format!("\"1/{}\"", "7".repeat(1000)), &linear),
        ),
        case(
            "3000 parameters, defaults by functions",
            used(3000, "\"sin(1)^2 + cos(1)^2 - exp(log(2)/3)\"", &linear),
        ),
        case(
            "3000 described parameters",
            used(
                3000,
                &format!(r#"{{"default": 1, "description": "{}"}}"#, "a".repeat(1000)),
                &linear,
            ),
        ),
        case("300 exact parameters in brackets", exact_parameters(300)),
        case("30 exact parameters in dense brackets", exact_matrices(30)),
        case(
            "3000 parameters without use",
            used(3000, "2", &|_| "x^2".into()),
        ),
        case(
            "3000 positive parameters",
            used(3000, r#"{"value": 2, "positive": true}"#, &|i| {
                format!("exp(log(p{i})/3)*x^2")
            }),
        ),
    ]
}

/// [e0, ei] = p ei with a parameter in each.
fn exact_parameters(count: usize) -> Spec {
    let n = 200;
    let each: String = joined(count, ", ", |i| {
        format!(r#""k{i}": {{"default": 3, "exact": true}}"#)
    });
    let brackets: Vec<String> = (1..n)
        .map(|i| {
            format!(
                "[e0, e{i}] = (k{} + 1)/(k{} - 1)*e{i}",
                i % count,
                (i * 7) % count
            )
        })
        .collect();
    Spec::algebra(n, &brackets, "x0^2").set("parameters", format!("{{{each}}}"))
}

/// gl(4) with its basis scaled by parameters.
fn exact_matrices(count: usize) -> Spec {
    let each: String = joined(count, ", ", |i| {
        format!(r#""k{i}": {{"default": 3, "exact": true}}"#)
    });
    let scale = |i: usize| format!("(k{} + {i}*k{} + 1)", i % count, (i * 5 + 1) % count);
    let mut brackets = Vec::new();
    for bracket in matrices(4) {
        let (left, right) = bracket.split_once(" = ").expect("a bracket");
        let index = |text: &str| -> usize {
            text.trim_matches(|c: char| !c.is_ascii_digit())
                .parse()
                .expect("an index")
        };
        let (a, b) = left.split_once(", ").expect("a pair");
        let scaled: Vec<String> = right
            .split(' ')
            .map(|term| {
                format!(
                    "{}{}*{}/{}*{}",
                    if term.starts_with('-') { "-" } else { "" },
                    scale(index(a)),
                    scale(index(b)),
                    scale(index(term)),
                    term.trim_start_matches('-')
                )
            })
            .collect();
        brackets.push(format!(
            "{left} = {}",
            scaled.join(" + ").replace("+ -", "- ")
        ));
    }
    Spec::algebra(16, &brackets, "x0^2").set("parameters", format!("{{{each}}}"))
}

fn casimirs() -> Vec<Case> {
    let abelian =
        |n: usize, casimirs: Vec<String>| Spec::algebra(n, &[], "x0^2").list("casimirs", &casimirs);
    let random = |n: usize, count: usize| {
        let mut draw = Draw(5);
        let mut all = Vec::new();
        for _ in 0..count {
            let terms: Vec<String> = (0..n)
                .map(|i| format!("{}*x{i}", draw.below(2_000_000) as i64 - 1_000_000))
                .collect();
            all.push(terms.join(" + ").replace("+ -", "- "));
        }
        all
    };
    let one = |text: String| Spec::body().list("casimirs", &[text]);
    vec![
        case(
            "299 Casimirs on 256 coordinates",
            abelian(
                256,
                each(299, |i| format!("x{} + x{}^2", i % 256, (i * 7) % 256)),
            ),
        ),
        case(
            "256 Casimirs on 256 coordinates",
            abelian(256, each(256, |i| format!("x{i}"))),
        ),
        case(
            "299 waves on 256 coordinates",
            abelian(
                256,
                each(299, |i| {
                    format!("sin(x{} + {i}*x{})", i % 256, (i * 7 + 1) % 256)
                }),
            ),
        ),
        case(
            "299 equal Casimirs",
            abelian(256, each(299, |i| format!("{}*x0", i + 1))),
        ),
        case(
            "10000 Casimirs",
            abelian(
                256,
                each(10_000, |i| format!("x{}^{}", i % 256, i / 256 + 1)),
            ),
        ),
        case(
            "100 dense Casimirs on 100 coordinates",
            abelian(100, random(100, 100)),
        ),
        case(
            "200 dense Casimirs on 256 coordinates",
            abelian(256, random(256, 200)),
        ),
        case(
            "60 dense waves on 60 coordinates",
            abelian(
                60,
                each(60, |k| {
                    joined(60, " + ", |i| format!("sin({}*x{i})", i * k + 1))
                }),
            ),
        ),
        case(
            "40 products on 40 coordinates",
            abelian(
                40,
                each(40, |k| {
                    joined(40, "*", |i| format!("(x{i} + {})", i * k + 1))
                }),
            ),
        ),
        case(
            "299 constants as Casimirs",
            abelian(256, each(299, |i| format!("{i}"))),
        ),
        case(
            "299 Casimirs that are none",
            Spec::body().list("casimirs", &each(299, |i| format!("x^{}", i + 1))),
        ),
        case(
            "299 powers of the Casimir",
            Spec::body().list(
                "casimirs",
                &each(299, |i| format!("(x^2 + y^2 + z^2)^{}", i + 1)),
            ),
        ),
        case(
            "a Casimir of 20000 terms",
            one(joined(20_000, " + ", |i| format!("x^{}*{i}/7", i % 40))),
        ),
        case(
            "a Casimir with a power that would be huge",
            one("C = (x + y + z + x*y*z)^300*(x - y)^200".into()),
        ),
        case(
            "a Casimir with nested roots",
            one((0..40).fold("x^2 + y^2 + z^2".into(), |inner, _| {
                format!("sqrt(1 + {inner})")
            })),
        ),
        case(
            "a Casimir with nested waves",
            one((0..40).fold("x^2 + y^2 + z^2".into(), |inner, _| {
                format!("sin({inner})*cos({inner})")
                    .chars()
                    .take(20_000)
                    .collect()
            })),
        ),
        case(
            "a Casimir with 12 roots of sums",
            one(joined(12, "*", |i| {
                format!("(1 + sqrt(x^2 + y^2 + z^2 + {i}))")
            })),
        ),
        case(
            "a Casimir with 200 angles",
            one(joined(200, " + ", |i| format!("atan2(x + {i}, y^2 + z)"))),
        ),
        case(
            "a Casimir that is zero after expansion",
            one("(x + y)^60 - (y + x)^60 + (x*y + z)^40*((x + 1)^2 - x^2 - 2*x - 1)".into()),
        ),
        case(
            "a Casimir with exponentials of sums",
            one(joined(30, "*", |i| {
                format!("(exp(x*{i}) + exp(y) + exp(z))")
            })),
        ),
    ]
}

fn general() -> Vec<Case> {
    let poisson = |name: &str, n: usize, brackets: Vec<String>| {
        case(name, Spec::poisson(n, &brackets, "x0^2/2"))
    };
    let polynomial = |power: usize| format!("(x0 + 2*x1 + 3*x2 + 5)^{power}");
    let three = |value: &dyn Fn(usize) -> String| {
        vec![
            format!("{{x0, x1}} = {}", value(0)),
            format!("{{x1, x2}} = {}", value(1)),
            format!("{{x0, x2}} = {}", value(2)),
        ]
    };
    let many = |terms: usize, seed: u64| {
        move |k: usize| {
            let mut draw = Draw(seed + k as u64);
            let terms: Vec<String> = (0..terms)
                .map(|_| {
                    format!(
                        "{}*x0^{}*x1^{}*x2^{}",
                        draw.below(99) + 1,
                        draw.below(60),
                        draw.below(60),
                        draw.below(60)
                    )
                })
                .collect();
            terms.join(" + ")
        }
    };
    vec![
        poisson(
            "brackets with powers of sums",
            3,
            three(&|k| polynomial(60 + k)),
        ),
        poisson(
            "brackets with high powers of sums",
            3,
            three(&|k| polynomial(900 + k)),
        ),
        poisson("brackets of 300 random terms", 3, three(&many(300, 1))),
        poisson("brackets of 3000 random terms", 3, three(&many(3000, 2))),
        poisson(
            "brackets with rational functions",
            3,
            three(&|k| format!("1/({}) + x0/({})", polynomial(7 + k), polynomial(9))),
        ),
        poisson(
            "brackets with roots and waves",
            3,
            three(&|k| {
                joined(60, " + ", |i| {
                    format!("sqrt(x{}^2 + {i})*sin(x{}*{i})", k, (k + 1) % 3)
                })
            }),
        ),
        poisson(
            "log-canonical brackets of 80",
            80,
            pairs(80)
                .map(|(i, j)| format!("{{x{i}, x{j}}} = {}*x{i}*x{j}", i + j))
                .collect(),
        ),
        poisson(
            "log-canonical brackets of 256",
            256,
            pairs(256)
                .map(|(i, j)| format!("{{x{i}, x{j}}} = {}*x{i}*x{j}", i + j))
                .collect(),
        ),
        poisson("random quadratic brackets of 40", 40, {
            let mut draw = Draw(7);
            pairs(40)
                .map(|(i, j)| {
                    format!(
                        "{{x{i}, x{j}}} = x{}*x{} + x{}*x{}",
                        draw.below(40),
                        draw.below(40),
                        draw.below(40),
                        draw.below(40)
                    )
                })
                .collect()
        }),
        poisson("random brackets of 12 with 30 terms", 12, {
            let mut draw = Draw(8);
            pairs(12)
                .map(|(i, j)| {
                    format!(
                        "{{x{i}, x{j}}} = {}",
                        (0..30)
                            .map(|_| format!(
                                "x{}^3*x{}^2*x{}",
                                draw.below(12),
                                draw.below(12),
                                draw.below(12)
                            ))
                            .collect::<Vec<_>>()
                            .join(" + ")
                    )
                })
                .collect()
        }),
        poisson(
            "canonical pairs, 256",
            256,
            each(128, |i| format!("{{x{}, x{}}} = 1", 2 * i, 2 * i + 1)),
        ),
        poisson(
            "canonical pairs of waves, 100",
            100,
            each(50, |i| {
                format!(
                    "{{x{}, x{}}} = {}",
                    2 * i,
                    2 * i + 1,
                    joined(20, " + ", |k| format!(
                        "cos({k}*x{} + x{})",
                        2 * i,
                        2 * i + 1
                    ))
                )
            }),
        ),
        case(
            "brackets with Casimirs of high degree",
            Spec::poisson(3, &three(&|k| format!("x{}", [2, 0, 1][k])), "x0^2").list(
                "casimirs",
                &[
                    "(x0^2 - x1^2 + x2^2)^90".to_owned(),
                    "x0^90*x1^90*(x0 + x1 + x2)^90".to_owned(),
                ],
            ),
        ),
    ]
}
