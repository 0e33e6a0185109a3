//! What the documents say is so: excerpts are current, tables agree with the code, places exist.

use std::path::Path;
use std::process::Command;

use lie_codegen::compile::{compile_spec, declared_choices, expand};
use lie_codegen::methods::{CATALOGUE, Choice, Method};
use lie_syntax::constructors::FAMILIES;

use crate::common::catalogue::words;
use crate::common::markdown::{blocks_in, links, marked, read};

const DOCUMENTS: [&str; 6] = [
    "README.md",
    "ARCHITECTURE.md",
    "CONTRIBUTING.md",
    "CHANGELOG.md",
    "docs/declaration.md",
    "docs/algebras.md",
];

#[test]
fn the_first_shell_code_of_the_readme_is_the_two_commands() {
    let readme = read("README.md");
    let first = &blocks_in(&readme, "sh")[0];
    let commands: Vec<&str> = first.lines().collect();
    assert!(
        commands[0].starts_with("cargo run --release -- run specs/se3_heavy_top.json "),
        "{first}"
    );
    assert!(commands[1].starts_with("cargo test"), "{first}");
    assert_eq!(commands.len(), 2);
    let run = &blocks_in(&readme, "text")[0];
    let arguments = commands[0].trim_start_matches("cargo run --release -- ");
    assert_eq!(
        run.lines().next(),
        Some(format!("$ lie {arguments}").as_str())
    );
}

/// Rust blocks are doctests of the library; the excerpt of generated code is compared here.
#[test]
fn generated_code_in_the_readme_is_current() {
    let excerpts = blocks_in(&read("README.md"), "rs");
    assert_eq!(excerpts.len(), 1);
    let spec = read("specs/so3_free_rigid_body.json");
    let model = compile_spec(&spec).expect("a valid spec");
    let code = expand(&model, &declared_choices(&model));
    assert!(
        code.contains(&excerpts[0]),
        "the README's excerpt is stale; `lie expand` prints\n{code}"
    );
    assert!(
        !code.contains(&excerpts[0].replace('6', "7")),
        "any text would do"
    );
}

#[test]
fn the_declaration_of_the_readme_is_the_example() {
    let readme = read("README.md");
    let example = read("examples/01_rigid_body.rs");
    let declaration = |text: &str| -> Vec<String> {
        let lines = text
            .lines()
            .skip_while(|line| !line.contains("pub system RigidBody"));
        lines
            .take_while(|line| *line != "}")
            .map(str::to_owned)
            .collect()
    };
    assert!(declaration(&readme).len() > 5);
    assert_eq!(declaration(&readme), declaration(&example));
}

#[test]
fn the_mistake_in_the_readme_is_what_the_command_prints() {
    let text = read("README.md");
    let block = blocks_in(&text, "text")
        .into_iter()
        .find(|block| block.contains("$ lie check"));
    let block = block.expect("an example of a mistake");
    let (command, message) = block.split_once('\n').expect("two lines");
    let output = Command::new(env!("CARGO_BIN_EXE_lie"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(command.trim_start_matches("$ lie ").split(' '))
        .output()
        .expect("the command starts");
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(
        String::from_utf8_lossy(&output.stderr).trim(),
        message.trim()
    );
}

/// The ids in the first cell of a row, without `(ID)`.
fn ids(cell: &str) -> Vec<&str> {
    let quoted = cell.split('`').skip(1).step_by(2);
    quoted
        .map(|id| id.strip_suffix("(ID)").unwrap_or(id))
        .collect()
}

#[test]
fn the_methods_of_the_readme_are_those_of_the_catalogue() {
    let readme = read("README.md");
    let (_, section) = readme.split_once("## The methods").expect("the section");
    let rows: Vec<Vec<&str>> = section
        .lines()
        .skip_while(|line| !line.starts_with("| `"))
        .take_while(|line| line.starts_with("| `"))
        .map(|line| line.split('|').skip(1).map(str::trim).collect())
        .collect();
    let mut listed: Vec<&str> = rows.iter().flat_map(|row| ids(row[0])).collect();
    for method in CATALOGUE {
        let row = rows.iter().find(|row| ids(row[0]).contains(&method.id));
        let row = row.unwrap_or_else(|| panic!("{} is not in the README", method.id));
        let position = ids(row[0]).iter().position(|id| *id == method.id);
        let (orders, remark) = row[1].split_once("; ").map_or_else(
            || {
                row[1]
                    .split_once(", not")
                    .map_or((row[1], ""), |(o, _)| (o, "not symmetric"))
            },
            |(orders, remark)| (orders, remark),
        );
        let orders: Vec<&str> = orders.split(", ").collect();
        let order = orders[position.unwrap_or(0).min(orders.len() - 1)];
        assert_eq!(order, method.order.to_string(), "{}", method.id);
        // the first splitting is the only one of its row that is not symmetric
        if method.id != "splitting1" {
            assert_eq!(remark != "not symmetric", method.symmetric, "{}", method.id);
        }
        if !method.id.starts_with("compose") {
            let solves = if method.explicit { "no" } else { "yes" };
            assert_eq!(row[2], solves, "{}", method.id);
        }
        assert_eq!(row[3], words(method), "{}", method.id);
        listed.retain(|id| *id != method.id);
    }
    assert_eq!(listed, [""; 0], "methods that do not exist");
}

/// The type of a method in the runtime.
fn type_name(method: &Method) -> String {
    let id = match method.id.starts_with("compose") {
        true => format!("{}(midpoint)", method.id),
        false => method.id.to_owned(),
    };
    let choice = Choice::from_id(&id).unwrap_or_else(|_| panic!("{id}"));
    let value = choice.constructor().to_string();
    let (_, path) = value.split_once("methods").expect("a path");
    let letter = |c: char| c.is_alphanumeric() || c == '_';
    path.trim_start_matches([' ', ':'])
        .split(|c| !letter(c))
        .next()
        .unwrap_or_default()
        .to_owned()
}

/// Those of Gauss come by a glob, of every number of stages.
#[test]
fn the_prelude_has_the_methods_of_the_catalogue() {
    let runtime = read("lie-runtime/src/lib.rs");
    let (_, prelude) = runtime
        .split_once("pub mod prelude {")
        .expect("the prelude");
    assert!(prelude.contains("pub use crate::methods::gauss::*;"));
    let (_, list) = prelude
        .split_once("pub use crate::methods::{")
        .expect("the list");
    let (list, _) = list.split_once('}').expect("its end");
    let listed = list.split(',').map(str::trim);
    let mut listed: Vec<&str> = listed.filter(|name| !name.is_empty()).collect();
    listed.sort_unstable();
    let types = CATALOGUE.iter().map(type_name);
    let mut expected: Vec<String> = types.filter(|name| !name.starts_with("Gauss")).collect();
    expected.extend(["Method", "Scheme", "Stepper"].map(str::to_owned));
    expected.sort();
    let expected = expected.join(", ");
    assert_eq!(
        listed.join(", "),
        expected,
        "the list is to be {{{expected}}}"
    );
}

/// Links and paths of files in code marks lead somewhere.
#[test]
fn places_in_the_documents_exist() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut count = 0;
    for document in DOCUMENTS {
        let text = read(document);
        let links = links(&text).into_iter();
        let links = links.filter(|link| !link.starts_with("http"));
        let marked = marked(&text);
        let paths = marked.iter().filter(|word| {
            let folders = [
                "lie-", "src/", "specs/", "tests/", "docs/", "crates/", "lab/",
            ];
            word.contains('/')
                && !word.contains(' ')
                && folders.iter().any(|folder| word.starts_with(folder))
        });
        // links start at the document, paths at the root
        let folder = Path::new(document).parent().expect("a folder");
        let links = links.map(|link| folder.join(link));
        let places = links.chain(paths.map(|path| Path::new(path).to_owned()));
        for place in places.filter(|place| !place.to_string_lossy().contains("NAME")) {
            let place = place.display();
            assert!(
                root.join(place.to_string()).exists(),
                "{document}: {place} does not exist"
            );
            count += 1;
        }
    }
    assert!(count > 20, "only {count} places found");
}

/// The dependencies of a package by its manifest, those for tests left out.
fn dependencies(manifest: &str) -> Vec<String> {
    let text = read(manifest);
    let section = text.split("\n[dependencies]\n").nth(1).unwrap_or_default();
    let section = section.split("\n[").next().unwrap_or_default();
    let name = |line: &str| {
        line.split(['.', ' ', '='])
            .next()
            .unwrap_or_default()
            .to_owned()
    };
    section
        .lines()
        .map(name)
        .filter(|name| name.starts_with("lie-"))
        .collect()
}

#[test]
fn no_arrow_between_crates_points_back() {
    for (package, needs) in [
        ("crates/lie-core", ""),
        ("crates/lie-symbolic", "lie-core"),
        ("crates/lie-syntax", "lie-core lie-symbolic"),
        ("crates/lie-codegen", "lie-core lie-symbolic lie-syntax"),
        ("lie-macros", "lie-codegen"),
        ("lie-runtime", "lie-core lie-macros"),
        ("crates/lie-dense", "lie-runtime"),
        ("crates/lie-program", "lie-runtime"),
        ("crates/lie-measure", "lie-program lie-runtime"),
        (
            "crates/lie-dynamic",
            "lie-codegen lie-core lie-runtime lie-symbolic",
        ),
        ("crates/lie-methods", "lie-codegen lie-dynamic lie-runtime"),
        ("crates/lie-tangents", "lie-codegen lie-dynamic lie-runtime"),
        ("crates/lie-jit", "lie-codegen lie-dynamic lie-runtime"),
        ("crates/lie-wasm", "lie-dynamic lie-runtime"),
        (
            "crates/lie-in-process",
            "lie-codegen lie-dynamic lie-jit lie-judge lie-measure lie-methods lie-program lie-runtime lie-spectra lie-symbolic lie-syntax lie-tangents",
        ),
        (
            ".",
            "lie-codegen lie-core lie-dynamic lie-equilibria lie-in-process lie-measure lie-methods lie-output lie-plot lie-program \
             lie-runtime lie-spectra lie-symbolic lie-syntax",
        ),
        ("crates/lie-equilibria", "lie-symbolic"),
        (
            "crates/lie-judge",
            "lie-codegen lie-core lie-symbolic lie-syntax",
        ),
        ("crates/lie-spectra", "lie-runtime"),
        (
            "crates/lie-output",
            "lie-in-process lie-program lie-runtime",
        ),
        ("crates/lie-plot", ""),
    ] {
        let found = dependencies(&format!("{package}/Cargo.toml"));
        assert_eq!(found.join(" "), needs, "{package}");
    }
}

#[test]
fn the_version_of_rust_is_the_same_everywhere() {
    let manifest = read("Cargo.toml");
    let version = manifest
        .split("rust-version = \"")
        .nth(1)
        .and_then(|rest| rest.split('"').next());
    let version = version.expect("a version");
    assert!(read("README.md").contains(&format!("Rust {version} or later")));
    assert!(read("CONTRIBUTING.md").contains(&format!("Rust {version} or later")));
    assert!(read("CONTRIBUTING.md").contains(&format!("cargo +{version} check")));
}

/// The first cell of a row with the dimension that the second one gives.
#[test]
fn the_table_of_algebras_is_that_of_the_compiler() {
    let page = read("docs/algebras.md");
    for family in FAMILIES {
        for name in family.names {
            let named = ["(", "`", "^"].map(|end| format!("`{name}{end}"));
            assert!(
                named.iter().any(|text| page.contains(text)),
                "{name} is not in the table"
            );
        }
    }
    for (name, dimension) in [("so(3)", 3), ("sl(2)", 3), ("se(2)", 3), ("se(3)", 6)] {
        let row = page
            .lines()
            .find(|line| line.starts_with(&format!("| `{name}`")));
        assert!(
            row.is_some_and(|row| row.contains(&format!("| {dimension} |"))),
            "{name}"
        );
        let spec = format!(r#"{{"name": "A", "algebra": "{name}", "hamiltonian": "1"}}"#);
        let model = compile_spec(&spec).expect("a sound spec");
        assert_eq!(model.coordinates.len(), dimension);
        let state: Vec<&str> = model
            .coordinates
            .iter()
            .map(|name| name.text.as_str())
            .collect();
        assert!(
            row.is_some_and(|row| row.contains(&format!("`{}`", state.join(", ")))),
            "{state:?}"
        );
    }
}

#[test]
fn the_schema_is_the_one_that_the_command_prints() {
    let output = Command::new(env!("CARGO_BIN_EXE_lie"))
        .arg("schema")
        .output()
        .expect("the command starts");
    let printed = String::from_utf8(output.stdout).expect("UTF-8");
    let help = "write it anew with `lie schema > specs/lie-system.schema.json`";
    assert_eq!(printed, read("specs/lie-system.schema.json"), "{help}");
}
