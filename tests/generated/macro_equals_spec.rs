//! The macro and the spec are two spellings of one declaration: they give the same code, the same
//! bits, every time, wherever the files are.

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::thread;

use crate::common::{command, folder};
use lie_codegen::compile::{compile_spec, declared_choices, expand, generate};
use lie_codegen::expand::expand_macro;
use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};
use serde_json::{Map, Value};

const METHODS: [&str; 4] = ["midpoint", "gauss4", "gauss6", "lie-midpoint"];

fn specs() -> Vec<PathBuf> {
    let entries = std::fs::read_dir("specs").expect("the folder of specs");
    let mut paths: Vec<PathBuf> = entries
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.is_file() && !path.to_string_lossy().ends_with(".schema.json"))
        .collect();
    paths.sort();
    assert!(paths.len() >= 10);
    paths
}

/// The key of the function that gives the equations.
fn energy(spec: &Map<String, Value>) -> &'static str {
    let keys = ["hamiltonian", "lagrangian", "discrete_lagrangian"];
    let found = keys.into_iter().find(|key| spec.contains_key(*key));
    found.expect("a function")
}

/// A spec with all methods, without what the macro does not have.
fn read(path: &Path) -> Map<String, Value> {
    let text = std::fs::read_to_string(path).expect("the spec");
    let Ok(Value::Object(mut spec)) = serde_json::from_str(&text) else {
        panic!("{}: no object", path.display())
    };
    // matrices only where they are needed: what they add to the code is the same in both forms
    if !spec.contains_key("group")
        && let Some(algebra) = spec.get_mut("algebra").and_then(Value::as_object_mut)
    {
        algebra.remove("matrices");
    }
    let lie_poisson = spec.contains_key("algebra") && !spec.contains_key("cocycle");
    let methods = match energy(&spec) {
        "discrete_lagrangian" => vec!["discrete-euler-poincare"],
        _ => METHODS[..if lie_poisson { 4 } else { 3 }].to_vec(),
    };
    spec.insert("methods".into(), methods.into());
    spec.remove("run");
    spec
}

fn strings(value: &Value) -> impl Iterator<Item = &str> {
    value
        .as_array()
        .into_iter()
        .flatten()
        .filter_map(Value::as_str)
}

/// A number or an exact constant as it stands in an expression.
fn constant(value: &Value) -> String {
    value
        .as_str()
        .map_or_else(|| value.to_string(), str::to_owned)
}

fn list(value: &Value) -> String {
    value
        .as_array()
        .into_iter()
        .flatten()
        .map(constant)
        .collect::<Vec<_>>()
        .join(", ")
}

/// The statement or the block of an algebra.
fn in_macro(algebra: &Value) -> String {
    if let Some(name) = algebra.as_str() {
        return format!("algebra = {name};\n");
    }
    let mut block = format!("algebra {{ basis {};", list(&algebra["basis"]));
    for bracket in strings(&algebra["brackets"]) {
        block += &format!(" {bracket};");
    }
    let matrices = algebra.get("matrices").and_then(Value::as_object);
    for (name, rows) in matrices.into_iter().flatten() {
        block += &format!(" matrix {name} = {};", rows_of(rows));
    }
    block + " }\n"
}

/// `[[1, 0], [0, 1]]`
fn rows_of(matrix: &Value) -> String {
    let rows = matrix.as_array().into_iter().flatten().map(list);
    let rows: Vec<String> = rows.map(|row| format!("[{row}]")).collect();
    format!("[{}]", rows.join(", "))
}

/// The block of vectors and matrices.
fn vectors(declared: &Value) -> String {
    let declared = declared.as_object().into_iter().flatten();
    let each = declared.map(|(name, value)| match value[0].is_array() {
        true => format!(" {name} = {};", rows_of(value)),
        false => format!(" {name} = ({});", list(value)),
    });
    format!("vectors {{{} }}\n", each.collect::<String>())
}

/// The block of functions by tables.
fn functions(declared: &Value) -> String {
    let declared = declared.as_object().into_iter().flatten();
    let each = declared.map(|(name, table)| {
        let points = table["table"].as_array().into_iter().flatten();
        let points: Vec<String> = points.map(|point| format!("({})", list(point))).collect();
        let mut entry = format!(" {name} = table [{}]", points.join(", "));
        for key in ["degree", "outside"] {
            match table.get(key) {
                Some(Value::String(word)) => entry += &format!(", {key} {word}"),
                Some(number) => entry += &format!(", {key} {number}"),
                None => {}
            }
        }
        entry + ";"
    });
    format!("functions {{{} }}\n", each.collect::<String>())
}

/// The body of the macro that declares what a spec declares.
fn declaration(spec: &Map<String, Value>) -> String {
    let text = |key: &str| spec[key].as_str().expect("a string");
    let mut body = format!("pub system {};\n", text("name"));
    if let Some(algebra) = spec.get("algebra") {
        body += &in_macro(algebra);
    }
    if let Some(group) = spec.get("group").and_then(Value::as_str) {
        body += &format!("group {group};\n");
    }
    for key in ["poisson", "cocycle"] {
        if let Some(brackets) = spec.get(key) {
            let brackets: Vec<&str> = strings(brackets).collect();
            body += &format!("{key} {{ {}; }}\n", brackets.join("; "));
        }
    }
    body += &format!("state {};\nparameters {{", list(&spec["state"]));
    for (name, value) in spec
        .get("parameters")
        .and_then(Value::as_object)
        .into_iter()
        .flatten()
    {
        let (default, exact) = match value.get("default") {
            Some(default) => (default, value.get("exact") == Some(&true.into())),
            None => (value, false),
        };
        body += &format!(
            " {}{name} = {};",
            if exact { "exact " } else { "" },
            constant(default)
        );
    }
    body += " }\n";
    body += &spec.get("vectors").map_or_else(String::new, vectors);
    body += &spec.get("functions").map_or_else(String::new, functions);
    for definition in spec.get("let").into_iter().flat_map(strings) {
        body += &format!("let {definition};\n");
    }
    if let Some(velocity) = spec.get("velocity") {
        body += &format!("velocity {};\n", list(velocity));
    }
    let energy = energy(spec);
    body += &format!("{energy} = {};\n", text(energy));
    for casimir in spec.get("casimirs").into_iter().flat_map(strings) {
        body += &format!("casimir {casimir};\n");
    }
    body += &format!("methods = [{}];\n", list(&spec["methods"]));
    for key in ["invariance", "initial"] {
        match spec.get(key) {
            Some(Value::String(word)) => body += &format!("{key} = {word};\n"),
            Some(values) => body += &format!("{key} = [{}];\n", list(values)),
            None => {}
        }
    }
    body + &spec.get("attitude").map_or_else(String::new, attitude)
}

/// The block of the group element at the start.
fn attitude(declared: &Value) -> String {
    let declared = declared.as_object().into_iter().flatten();
    let each = declared.map(|(key, value)| match value {
        Value::String(axes) => format!(" {key} = {axes};"),
        _ if value[0].is_array() => format!(" {key} = {};", rows_of(value)),
        _ => format!(" {key} = [{}];", list(value)),
    });
    format!("attitude {{{} }}\n", each.collect::<String>())
}

/// The tokens without doc comments, which say in words what only one of the two forms has.
fn without_docs(tokens: TokenStream) -> TokenStream {
    let is_doc = |tree: Option<&TokenTree>| match tree {
        Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Bracket => {
            matches!(group.stream().into_iter().next(), Some(TokenTree::Ident(name)) if name == "doc")
        }
        _ => false,
    };
    let mut kept = TokenStream::new();
    let mut trees = tokens.into_iter().peekable();
    while let Some(tree) = trees.next() {
        match tree {
            TokenTree::Punct(sign) if sign.as_char() == '#' && is_doc(trees.peek()) => {
                trees.next();
            }
            TokenTree::Group(group) => {
                let inside = without_docs(group.stream());
                kept.extend([TokenTree::from(Group::new(group.delimiter(), inside))]);
            }
            other => kept.extend([other]),
        }
    }
    kept
}

fn from_text(text: &str) -> TokenStream {
    let model = compile_spec(text).unwrap_or_else(|d| panic!("{text}\n{d:#?}"));
    generate(&model, &declared_choices(&model))
}

fn from_spec(spec: &Map<String, Value>) -> TokenStream {
    from_text(&serde_json::to_string_pretty(spec).expect("JSON"))
}

fn from_macro(body: &str) -> TokenStream {
    let tokens: TokenStream = body
        .parse()
        .unwrap_or_else(|error| panic!("{body}\n{error}"));
    expand_macro(tokens, Path::new("nowhere"))
}

#[test]
fn macro_and_spec_give_the_same_tokens() {
    for path in specs() {
        let spec = read(&path);
        let body = declaration(&spec);
        let (one, other) = (
            without_docs(from_spec(&spec)).to_string(),
            without_docs(from_macro(&body)).to_string(),
        );
        assert!(!other.contains("compile_error"), "{body}\n{other}");
        assert_eq!(one, other, "{}", path.display());
        // The comparison can fail: another Hamiltonian gives other code.
        let start = format!("{} = ", energy(&spec));
        let changed = body.replacen(&start, &format!("{start}2*"), 1);
        assert_ne!(
            one,
            without_docs(from_macro(&changed)).to_string(),
            "{}",
            path.display()
        );
    }
}

#[test]
fn tables_and_cases_are_the_same_in_both() {
    for file in ["table", "cases"] {
        let path = format!("tests/data/declarations/pass/{file}.json");
        let mut spec = read(Path::new(&path));
        spec.insert("methods".into(), serde_json::json!(["gauss4"]));
        let body = declaration(&spec);
        let (one, other) = (
            without_docs(from_spec(&spec)).to_string(),
            without_docs(from_macro(&body)).to_string(),
        );
        assert!(!other.contains("compile_error"), "{body}\n{other}");
        assert_eq!(one, other, "{path}");
        let changed = without_docs(from_macro(
            &body.replacen("<", ">=", 1).replacen("(2, 3)", "(2, 4)", 1),
        ));
        assert_ne!(one, changed.to_string(), "{path}");
    }
}

#[test]
fn attitudes_are_the_same_in_both() {
    let mut spec = read(Path::new("tests/data/declarations/pass/attitude.json"));
    spec.insert("methods".into(), serde_json::json!(["gauss4"]));
    let mut all = Vec::new();
    for group in [true, false] {
        for form in [
            serde_json::json!({ "euler": "zxz", "angles": ["a", "pi/2", "-a^2"] }),
            serde_json::json!({ "quaternion": ["cos(a)", 0, "sin(a)", 0] }),
            serde_json::json!({ "matrix": [[0, -1, 0], ["cos(a)", 0, "-sin(a)"], ["sin(a)", 0, "cos(a)"]] }),
        ] {
            spec.insert("attitude".into(), form);
            if !group {
                spec.remove("group");
                spec.insert("hamiltonian".into(), "a*x^2 + y^2 + z^2/3".into());
            }
            let body = declaration(&spec);
            let (one, other) = (
                without_docs(from_spec(&spec)).to_string(),
                without_docs(from_macro(&body)).to_string(),
            );
            assert!(!other.contains("compile_error"), "{body}\n{other}");
            assert_eq!(one, other, "{body}");
            all.push(one);
        }
    }
    all.dedup();
    assert_eq!(all.len(), 6);
}

#[test]
fn mistakes_in_attitudes_of_a_macro_have_remedies() {
    for (block, says) in [
        ("", "has no entries"),
        ("quaternion = [1, 0, 0];", "3 entries, and needs 4"),
        ("quaternion = [1, 0, 0, 0]; euler = zxz;", "given twice"),
        (
            "quaternion = [1, 0, 0, 0]; quaternion = [1, 0, 0, 0];",
            "stands twice",
        ),
        ("quaternion = 1;", "list of 4 numbers"),
        (
            "euler = zz; angles = [0, 1, 0];",
            "`zz` is no sequence of axes",
        ),
        ("euler = zxz; angle = [0, 1, 0];", "has no `angle`"),
        ("quaternion = [1, 1, 0, 0];", "its norm is 1.414"),
    ] {
        let body = format!(
            "pub system Broken; algebra = so(3); state x, y, z; hamiltonian = x^2 + y^2/3; attitude {{ {block} }}"
        );
        let text = from_macro(&body).to_string();
        assert_eq!(text.matches("compile_error").count(), 1, "{block}: {text}");
        assert!(
            text.contains(says) && text.contains("help: "),
            "{block}: {text}"
        );
    }
}

#[test]
fn mistakes_in_tables_of_a_macro_have_remedies() {
    let of = |table: &str| {
        let body = format!(
            "pub system Broken; algebra = so(3); state x, y, z; functions {{ f = {table}; }} hamiltonian = x^2 + f(y);"
        );
        from_macro(&body).to_string()
    };
    assert!(!of("table [(0, 0), (1, 1/2)], degree 1, outside constant").contains("compile_error"));
    for (table, says) in [
        ("x^2", "`f` is no table"),
        ("table [0, 1]", "`f` is no table"),
        ("table [(0, 0), (1, 1)], order 1", "`f` is no table"),
        (
            "table [(0, 0), (1, 1)], degree 1, outside mirror",
            "does not say what is outside",
        ),
        ("table [(1, 0), (0, 1)], degree 1", "do not ascend here"),
        ("table [(0, 0), (1, 1)]", "too few for degree 3"),
    ] {
        let text = of(table);
        assert_eq!(text.matches("compile_error").count(), 1, "{table}: {text}");
        assert!(text.contains(says), "{table}: {text}");
    }
}

#[test]
fn a_spec_by_path_gives_the_items_of_the_spec() {
    let tokens: TokenStream = r#"pub spec = "specs/se3_heavy_top.json";"#.parse().expect("tokens");
    let items = expand_macro(tokens, Path::new(env!("CARGO_MANIFEST_DIR"))).to_string();
    let text = std::fs::read_to_string("specs/se3_heavy_top.json").expect("the spec");
    let model = compile_spec(&text).expect("a sound spec");
    let expected = generate(&model, &declared_choices(&model)).to_string();
    // Behind the items stands what makes cargo watch the file, without the machine's path to it.
    let rest = items.strip_prefix(&expected).expect("the items come first");
    assert!(
        rest.contains("include_bytes") && !items.contains(env!("CARGO_MANIFEST_DIR")),
        "{rest}"
    );
}

#[test]
fn files_that_a_spec_names_are_read_and_watched() {
    let path = "tests/data/bonds/net";
    let tokens: TokenStream = format!("spec = \"{path}.json\";").parse().expect("tokens");
    let items = expand_macro(tokens, Path::new(env!("CARGO_MANIFEST_DIR"))).to_string();
    for file in ["json", "csv"] {
        let watched = format!("\"/\" , \"{path}.{file}\"");
        assert!(items.contains(&watched), "{watched}: {items}");
    }
    assert!(!items.contains("compile_error"), "{items}");
}

#[test]
fn errors_of_a_spec_by_path_name_its_lines() {
    let folder = folder();
    let path = folder.path().join("broken.json");
    let text = std::fs::read_to_string("specs/so3_free_rigid_body.json").expect("the spec");
    let broken =
        text.replacen("I1", "J1", 1)
            .replacen("\"hamiltonian\": \"", "\"hamiltonian\": \"2y + ", 1);
    std::fs::write(&path, &broken).expect("the spec is written");
    let line = broken
        .lines()
        .position(|line| line.contains("2y +"))
        .expect("the line")
        + 1;
    let column = broken
        .lines()
        .nth(line - 1)
        .and_then(|line| line.find("2y"))
        .expect("the column")
        + 1;
    let tokens: TokenStream = r#"spec = "broken.json";"#.parse().expect("tokens");
    let items = expand_macro(tokens, folder.path()).to_string();
    assert!(
        items.contains(&format!(
            "[syntax] broken.json:{line}:{column}: `*` is missing"
        )),
        "{items}"
    );
    // A stub with all names that could be read, so that its users hear of nothing else.
    for part in [
        "struct FreeRigidBody",
        "pub J1 : S",
        "pub I2 : S",
        "fn dimension (& self) -> usize { 3 }",
    ] {
        assert!(items.contains(part), "{part}: {items}");
    }
}

#[test]
fn expansions_are_byte_equal() {
    for path in specs() {
        let text = std::fs::read_to_string(&path).expect("the spec");
        let code = || {
            let model = compile_spec(&text).expect("a sound spec");
            expand(&model, &declared_choices(&model))
        };
        assert_eq!(code(), code(), "{}", path.display());
    }
    // Another process, another folder, another name of the file, another hour of the day.
    let folder = folder();
    let copy = folder.path().join("copy.json");
    std::fs::copy("specs/se3_kirchhoff.json", &copy).expect("a copy");
    let run = |path: &Path, directory: &Path| {
        let output = command(["expand".as_ref(), path.as_os_str()])
            .args(["--method", "gauss4", "--method", "lie-midpoint"])
            .current_dir(directory)
            .env("TZ", "Asia/Kathmandu")
            .output()
            .expect("lie starts");
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        String::from_utf8(output.stdout).expect("text")
    };
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let code = run(Path::new("specs/se3_kirchhoff.json"), root);
    assert_eq!(code, run(Path::new("copy.json"), folder.path()));
    for machine in [
        env!("CARGO_MANIFEST_DIR"),
        "specs/",
        ".json",
        "copy",
        "/home/",
        "/tmp/",
    ] {
        assert!(!code.contains(machine), "{machine}");
    }
}

/// Looks at the specs, two side by side.
fn for_each_spec(look: impl Fn(&Path) + Sync) {
    let left = Mutex::new(specs());
    thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                loop {
                    // a statement of its own, so that the other does not wait
                    let next = left.lock().unwrap().pop();
                    match next {
                        Some(path) => look(&path),
                        None => break,
                    }
                }
            });
        }
    });
}

#[test]
fn the_order_of_what_is_unrelated_does_not_matter() {
    for_each_spec(order_does_not_matter);
}

/// The code of a spec is that of the same with everything in another order.
fn order_does_not_matter(path: &Path) {
    let spec = read(path);
    let code = from_spec(&spec).to_string();
    // Keys the other way round.
    let keys = spec
        .iter()
        .rev()
        .map(|(key, value)| format!("{key:?}: {value}"));
    let reversed = format!("{{{}}}", keys.collect::<Vec<_>>().join(", "));
    assert_eq!(code, from_text(&reversed).to_string(), "{}", path.display());
    // Brackets the other way round, and antisymmetry spelt out.
    let mut turned = spec.clone();
    let swapped = |bracket: &str| {
        let (pair, value) = bracket.split_once('=').expect("a bracket");
        let pair = pair.trim();
        let (a, b) = pair
            .trim_matches(['[', ']', '{', '}'])
            .split_once(',')
            .expect("a pair");
        let (open, close) = (&pair[..1], &pair[pair.len() - 1..]);
        let (a, b, value) = (a.trim(), b.trim(), value.trim());
        format!("{open}{b}, {a}{close} = -({value})")
    };
    let reverse = |brackets: &Value| -> Value {
        let brackets: Vec<&str> = strings(brackets).collect();
        brackets
            .into_iter()
            .rev()
            .map(swapped)
            .collect::<Vec<_>>()
            .into()
    };
    for key in ["poisson", "cocycle"] {
        if let Some(brackets) = turned.get_mut(key) {
            *brackets = reverse(brackets);
        }
    }
    // an algebra that goes by its name has no brackets to turn
    if let Some(algebra) = turned.get_mut("algebra").filter(|a| a.is_object()) {
        algebra["brackets"] = reverse(&algebra["brackets"]);
    }
    assert_eq!(code, from_spec(&turned).to_string(), "{}", path.display());
    // Blanks and superfluous parentheses.
    let mut spaced = spec.clone();
    let key = energy(&spec);
    spaced[key] = format!(" ( {} )\n", spec[key].as_str().expect("a function")).into();
    assert_eq!(code, from_spec(&spaced).to_string(), "{}", path.display());
    // The statements of the macro in another order.
    let body = declaration(&spec);
    let mut statements: Vec<&str> = body.lines().collect();
    let (casimirs, mut others): (Vec<&str>, Vec<&str>) = statements
        .drain(..)
        .partition(|line| line.starts_with("casimir") || line.starts_with("let"));
    others.reverse();
    let shuffled = others
        .into_iter()
        .chain(casimirs)
        .collect::<Vec<_>>()
        .join("\n");
    let one = without_docs(from_macro(&body)).to_string();
    assert_eq!(
        one,
        without_docs(from_macro(&shuffled)).to_string(),
        "{}",
        path.display()
    );
}

mod by_path {
    use lie_runtime::prelude::*;
    lie_poisson! { pub spec = "specs/se3_heavy_top.json"; }
}

mod in_place {
    use lie_runtime::prelude::*;
    lie_poisson! {
        /// The heavy top of `specs/se3_heavy_top.json`.
        pub(super) system HeavyTop;
        algebra {
            basis J1, J2, J3, P1, P2, P3;
            [J1, J2] = J3; [J2, J3] = J1; [J3, J1] = J2;
            [J1, P2] = P3; [J2, P3] = P1; [J3, P1] = P2;
            [P1, J2] = P3; [P2, J3] = P1; [P3, J1] = P2;
        }
        state m1, m2, m3, g1, g2, g3;
        parameters { I1 = 2; I2 = 3/2; I3 = 1; mgl = 1; c1 = 1/3; c2 = 1/7; c3 = 1; }
        hamiltonian = m1^2/(2*I1) + m2^2/(2*I2) + m3^2/(2*I3) + mgl*(c1*g1 + c2*g2 + c3*g3);
        casimir length2 = g1^2 + g2^2 + g3^2;
        casimir vertical_momentum = m1*g1 + m2*g2 + m3*g3;
    }
}

#[test]
fn both_give_the_same_bits() {
    use lie_runtime::prelude::*;
    let start = [0.4, 0.3, 0.9, 0.36, 0.48, 0.8];
    let options = Options::new(0.05).save(Save::Every(10));
    let one = Problem::new(
        by_path::HeavyTop::new().system().expect("finite"),
        start,
        (0.0, 10.0),
    );
    let other = Problem::new(
        in_place::HeavyTop::new().system().expect("finite"),
        start,
        (0.0, 10.0),
    );
    let one = solve(&one, LieMidpoint::exp(), &options).expect("a solution");
    let other = solve(&other, LieMidpoint::exp(), &options).expect("a solution");
    assert_eq!(one.mu, other.mu);
    assert_eq!(one.energy, other.energy);
    assert_eq!(one.casimirs, other.casimirs);
}
