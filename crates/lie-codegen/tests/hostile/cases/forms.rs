//! Files of the wrong form: wrong types, repeated keys, broken JSON, odd characters, large files.

use serde_json::Value;

use super::spec::{Draw, Spec, joined, string};
use super::{Case, case, raw};

pub fn cases() -> Vec<Case> {
    let mut cases = types();
    cases.extend(keys());
    cases.extend(broken());
    cases.extend(characters());
    cases.extend(large());
    cases.extend(mutations());
    cases
}

/// Values of every type. None of them is what any key wants, but for a key that takes any text.
const VALUES: &[&str] = &[
    "null",
    "true",
    "-1e308",
    "\"?\"",
    "[null]",
    "{\"a\": {\"b\": []}}",
];

/// The keys of an object of the spec, as the schema has them.
fn keys_of(object: &str) -> Vec<String> {
    let schema: Value =
        serde_json::from_str(include_str!("../../../../../specs/lie-system.schema.json"))
            .expect("the schema is JSON");
    let object = match object {
        "Spec" => &schema,
        object => &schema["$defs"][object],
    };
    let properties = object["properties"]
        .as_object()
        .expect("an object has keys");
    properties.keys().cloned().collect()
}

fn types() -> Vec<Case> {
    let mut cases = Vec::new();
    for value in VALUES {
        for key in &keys_of("Spec") {
            cases.push(case(
                &format!("{key}: {value}"),
                Spec::body().set(key, *value),
            ));
        }
        // Together, so that there are not thousands of cases.
        let all = |object: &str| {
            let members: Vec<String> = keys_of(object)
                .iter()
                .map(|key| format!("{}: {value}", string(key)))
                .collect();
            format!("{{{}}}", members.join(", "))
        };
        let body = Spec::body;
        cases.push(case(
            &format!("every key of the algebra: {value}"),
            body().set("algebra", all("Algebra")),
        ));
        cases.push(case(
            &format!("every key of a parameter: {value}"),
            body().set(
                "parameters",
                format!("{{\"p\": {}}}", all("DescribedParameter")),
            ),
        ));
        cases.push(case(
            &format!("every key of the realization: {value}"),
            body().set("realization", all("Realization")),
        ));
        cases.push(case(
            &format!("every key of the run: {value}"),
            body().set("run", all("Run")),
        ));
        cases.push(case(&format!("every key: {value}"), raw(&all("Spec"))));
        cases.push(case(&format!("the whole file: {value}"), raw(value)));
    }
    cases
}

fn keys() -> Vec<Case> {
    let twice: Vec<Case> = keys_of("Spec")
        .iter()
        .map(|key| {
            case(
                &format!("{key} twice"),
                Spec::body().and(key, "1").and(key, "1"),
            )
        })
        .collect();
    let many = |form: &dyn Fn(usize) -> String| {
        joined(100_000, ", ", |i| format!("{}: 1", string(&form(i))))
    };
    let mut cases = vec![
        case(
            "10^5 equal keys",
            raw(&format!("{{{}}}", many(&|_| "name".into()))),
        ),
        case(
            "10^5 unknown keys",
            raw(&format!("{{{}}}", many(&|i| format!("key{i}")))),
        ),
        case(
            "10^5 empty keys",
            raw(&format!("{{{}}}", many(&|_| String::new()))),
        ),
        case(
            "10^5 equal parameters",
            Spec::body().set("parameters", format!("{{{}}}", many(&|_| "p".into()))),
        ),
        case(
            "10^5 parameters that are no names",
            Spec::body().set("parameters", format!("{{{}}}", many(&|i| format!("p {i}")))),
        ),
        case(
            "10^5 keys of the run",
            Spec::body().set("run", format!("{{{}}}", many(&|i| format!("k{i}")))),
        ),
        case(
            "10^5 keys of the algebra",
            Spec::body().set("algebra", format!("{{{}}}", many(&|i| format!("k{i}")))),
        ),
        case(
            "a key of 10^6 letters",
            Spec::body().and(&"k".repeat(1_000_000), "1"),
        ),
        case(
            "keys of 10^4 letters",
            raw(&format!(
                "{{{}}}",
                joined(300, ", ", |i| format!("\"{}{i}\": 1", "k".repeat(10_000)))
            )),
        ),
        case(
            "keys that differ by escapes",
            raw(r#"{"name": "A", "n\u0061me": "B", "\u006eame": "C"}"#),
        ),
    ];
    cases.extend(twice);
    cases
}

fn broken() -> Vec<Case> {
    let body = Spec::body().json();
    let with = |end: &str| raw(&body.replace('}', &format!("{end}}}")));
    let cut = |at: usize| raw(&body[..at.min(body.len())]);
    vec![
        case("nothing", raw("")),
        case("white space", raw(" \n\t\r ")),
        case("10^6 line breaks", raw(&"\n".repeat(1_000_000))),
        case("10^6 opening brackets", raw(&"[".repeat(1_000_000))),
        case("10^6 opening braces", raw(&"{\"a\":".repeat(1_000_000))),
        case(
            "10^5 brackets in the state",
            Spec::body().set(
                "state",
                format!("{}{}", "[".repeat(100_000), "]".repeat(100_000)),
            ),
        ),
        case(
            "10^5 braces in a parameter",
            Spec::body().set(
                "parameters",
                format!("{}1{}", "{\"a\":".repeat(100_000), "}".repeat(100_000)),
            ),
        ),
        case(
            "1000 braces in the run",
            Spec::body().set(
                "run",
                format!("{}1{}", "{\"step\":".repeat(1000), "}".repeat(1000)),
            ),
        ),
        case(
            "120 braces in an unknown key",
            Spec::body().and(
                "extra",
                format!("{}1{}", "{\"a\":".repeat(120), "}".repeat(120)),
            ),
        ),
        case(
            "a comment at the end of a line",
            raw(&body.replacen(",\n", ", // a comment\n", 1)),
        ),
        case("a block comment", raw(&format!("/* a comment */ {body}"))),
        case("a comment of a shell", raw(&format!("# a comment\n{body}"))),
        case("NaN", Spec::body().set("initial", "[NaN, 0, 1]")),
        case("Infinity", Spec::body().set("initial", "[1, -Infinity, 1]")),
        case("a trailing comma", with(",")),
        case("single quotes", raw(&body.replace('"', "'"))),
        case(
            "keys without quotes",
            raw(&body.replace("\"name\"", "name")),
        ),
        case("YAML", raw("name: Body\nstate: [x, y, z]\n")),
        case("TOML", raw("name = \"Body\"\nstate = [\"x\"]\n")),
        case("XML", raw("<spec name=\"Body\"/>")),
        case(
            "Python",
            raw("{'name': None, 'state': ('x',), 'exact': True}"),
        ),
        case("two specs", raw(&format!("{body}{body}"))),
        case("two specs in a list", raw(&format!("[{body}, {body}]"))),
        case("a spec in a string", raw(&string(&body))),
        case("the first 10 bytes", cut(10)),
        case("the first 100 bytes", cut(100)),
        case("all but one byte", cut(body.len() - 1)),
        case(
            "a number with a plus",
            Spec::body().set("initial", "[+1, 0, 0]"),
        ),
        case(
            "a number in hexadecimal",
            Spec::body().set("initial", "[0x10, 0, 0]"),
        ),
        case(
            "a number with leading zeros",
            Spec::body().set("initial", "[007, 0, 0]"),
        ),
        case("a lone surrogate", raw(&body.replace("Body", "\\ud800"))),
        case(
            "a control inside a string",
            raw(&body.replace("Body", "Bo\u{1}dy")),
        ),
        case(
            "a line break inside a string",
            raw(&body.replace("x^2/2", "x^2/2\n")),
        ),
        case("an unknown escape", raw(&body.replace("Body", "\\q"))),
    ]
}

fn characters() -> Vec<Case> {
    let odd = [
        ("a zero", "\u{0}"),
        ("a mark of direction", "\u{202e}"),
        ("a joiner", "a\u{200d}b"),
        ("a variation selector", "x\u{fe0f}"),
        ("a combining mark alone", "\u{301}"),
        (
            "10^5 combining marks",
            &*format!("x{}", "\u{301}".repeat(100_000)),
        ),
        ("a name in two normal forms", "e\u{301}é"),
        ("fullwidth letters", "ｘ＋ｙ"),
        ("mathematical letters", "𝑥² + 𝒚₁"),
        ("superscripts", "x²"),
        ("a middle dot", "x·y"),
        ("a minus sign", "x − y"),
        ("Greek that looks Latin", "х + у"),
        ("emoji", "👩‍👩‍👧‍👦"),
        ("a private letter", "\u{e000}\u{f8ff}"),
        ("no character", "\u{ffff}\u{10ffff}"),
        ("a byte order mark", "\u{feff}x"),
        ("an ideographic space", "x\u{3000}+\u{3000}y"),
        ("a line separator", "x\u{2028}+ y"),
        ("10^5 letters of four bytes", &*"𝑥".repeat(100_000)),
        ("right to left", "שלום + مرحبا"),
        ("quotes", "x \\\" ' ` y"),
        ("braces and formats", "{} {0} %s ${x} $(x) `x`"),
        ("html", "<script>alert(1)</script>"),
    ];
    let mut cases = Vec::new();
    for (name, text) in odd {
        let body = Spec::body;
        cases.push(case(
            &format!("{name}, in the Hamiltonian"),
            body().text("hamiltonian", &format!("x^2 + {text}")),
        ));
        let everywhere = body()
            .text("name", text)
            .set("state", format!("[{0}, {0}, \"z\"]", string(text)))
            .set("parameters", format!("{{{}: 1}}", string(text)))
            .list("let", &[format!("{text} = x")])
            .list("casimirs", &[format!("{text} = {text}")])
            .list("methods", &[text.to_owned()])
            .list("references", &[text.to_owned()])
            .text("description", text)
            .and(text, "1");
        cases.push(case(&format!("{name}, everywhere"), everywhere));
    }
    cases
}

fn large() -> Vec<Case> {
    let body = Spec::body;
    vec![
        case(
            "16 MiB of spaces",
            raw(&format!(
                "{}{}",
                body().json(),
                " ".repeat((16 << 20) - 1000)
            )),
        ),
        case(
            "17 MiB of spaces",
            raw(&format!("{}{}", body().json(), " ".repeat(17 << 20))),
        ),
        case(
            "a description of 8 MB",
            body().text("description", &"word ".repeat(1_600_000)),
        ),
        case(
            "a description of 10^6 lines",
            body().text("description", &"*a*\n".repeat(1_000_000)),
        ),
        case(
            "a description of 10^6 brackets",
            body().text("description", &"[".repeat(1_000_000)),
        ),
        case(
            "a description of 10^6 back ticks",
            body().text("description", &"`".repeat(1_000_000)),
        ),
        case(
            "10^5 references",
            body().set(
                "references",
                format!("[{}]", vec!["\"a book\""; 100_000].join(",")),
            ),
        ),
        case(
            "a Hamiltonian of 8 MB of spaces",
            body().text("hamiltonian", &format!("x{}", " ".repeat(8 << 20))),
        ),
        case(
            "a Hamiltonian of 10^6 line breaks",
            body().text("hamiltonian", &format!("x +{} y", "\n".repeat(1_000_000))),
        ),
        case(
            "10^6 numbers",
            body().set("initial", format!("[{}1]", "1,".repeat(1_000_000))),
        ),
        case(
            "10^6 empty lists",
            body().set("state", format!("[{}[]]", "[],".repeat(1_000_000))),
        ),
        case(
            "10^5 empty texts of brackets",
            body().set(
                "algebra",
                format!(
                    r#"{{"basis": ["a"], "brackets": [{}""]}}"#,
                    "\"\",".repeat(100_000)
                ),
            ),
        ),
        case(
            "10^5 times of rows",
            body().set("run", format!("{{\"at\": [{}1]}}", "1,".repeat(100_000))),
        ),
    ]
}

/// The body with pieces cut out, repeated and exchanged.
fn mutations() -> Vec<Case> {
    let mut draw = Draw(2018);
    let whole = Spec::body()
        .set(
            "parameters",
            r#"{"k": {"default": "1/3", "exact": true}, "m": 2}"#,
        )
        .set("let", r#"["w = x/m"]"#)
        .set("casimirs", r#"["C = x^2 + y^2 + z^2"]"#)
        .set("initial", r#"[1, "1/2", 0.25]"#)
        .json();
    let characters: Vec<char> = whole.chars().collect();
    let mut cases = Vec::new();
    for number in 0..60 {
        let mut mutant = characters.clone();
        for _ in 0..1 + draw.below(4) {
            let (at, length) = (draw.below(mutant.len()), draw.below(12) + 1);
            let end = (at + length).min(mutant.len());
            match draw.below(4) {
                0 => drop(mutant.drain(at..end)),
                1 => {
                    let piece: Vec<char> = mutant[at..end].to_vec();
                    let to = draw.below(mutant.len());
                    mutant.splice(to..to, piece);
                }
                2 => {
                    mutant[at] = [
                        '"', '{', '}', '[', ']', ',', ':', '=', '^', '0', '\\', 'e', 'é',
                    ][draw.below(13)]
                }
                _ => {
                    let other = draw.below(mutant.len());
                    mutant.swap(at, other);
                }
            }
        }
        cases.push(case(
            &format!("mutant {number}"),
            raw(&mutant.into_iter().collect::<String>()),
        ));
    }
    cases
}
