//! Tables from CSV files are those written in the spec, and mistakes in them have a file and a line.

use std::fs;
use std::path::{Path, PathBuf};

use lie_codegen::compile::{compile_spec, compile_spec_in, expand};
use lie_codegen::structure::Effort;
use lie_syntax::diagnostic::{Diagnostic, Kind};

/// A spec whose Hamiltonian calls the table.
fn spec(table: &str) -> String {
    format!(
        r#"{{"name": "Body", "algebra": "so(3)", "state": ["x", "y", "z"],
            "functions": {{"drag": {{"table": {table}, "degree": 1}}}},
            "hamiltonian": "x^2/2 + y^2/3 + drag(z)", "initial": [0.1, 0.2, 0.3]}}"#
    )
}

/// A folder of its own for each test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::create_dir_all(&folder).expect("a folder for files of the test");
    folder
}

/// The code of the spec with a table file of these bytes, or the first mistake.
fn code(folder: &Path, bytes: &[u8]) -> Result<String, Diagnostic> {
    fs::write(folder.join("drag.csv"), bytes).expect("a file for the test");
    let model = compile_spec_in(&spec(r#""drag.csv""#), Some(folder), Effort::Declaration);
    let model = model.map_err(|mut mistakes| mistakes.remove(0))?;
    Ok(expand(&model, &[]))
}

#[test]
fn a_file_gives_the_code_of_the_list() {
    let folder = folder("same_code");
    let list = spec("[[-1, 0.1], [0, 0], [1.5, 0.7], [2, -3e-1]]");
    let expected = expand(&compile_spec(&list).expect("a sound spec"), &[]);
    for text in [
        "-1,0.1\n0,0\n1.5,0.7\n2,-3e-1\n",
        "\u{feff}v, drag\r\n-1, 0.1\r\n0, 0\r\n+1.5, 0.7\r\n2, -0.3",
        "# measured\n\"v\",\"drag\"\n\n-1,0.1\n0,0\n# again\n1.5,0.7\n2,-3e-1",
    ] {
        assert_eq!(code(&folder, text.as_bytes()).unwrap(), expected, "{text}");
    }
    // the control: another digit is other code
    let other = code(&folder, b"-1,0.1\n0,0\n1.5,0.7000000001\n2,-3e-1\n").unwrap();
    assert_ne!(other, expected);
}

#[test]
fn mistakes_name_the_file_and_the_line() {
    let folder = folder("mistakes");
    for (text, kind, expected) in [
        ("v,drag\n0,0\n1,x\n", Kind::Number, "drag.csv:3: `x` is not"),
        ("0,0\n\n1,2,3\n", Kind::Schema, "drag.csv:3: the line has 3"),
        ("0 0\n1 1\n", Kind::Schema, "drag.csv:1: the line has 1"),
        ("0,0\n2,1\n1,1\n", Kind::Number, "drag.csv:3: the arguments"),
        ("0,0\n0.0,1\n", Kind::Number, "drag.csv:2: the arguments"),
        ("a,b\nc,d\n0,0\n", Kind::Number, "drag.csv:2: `c` is not"),
        // no line of numbers is taken for names
        ("nan,nan\n0,0\n1,1\n", Kind::Number, "drag.csv:1: `nan`"),
        (".5,.5\n1,1\n2,2\n", Kind::Number, "drag.csv:1: `.5`"),
        ("1/2,1/3\n1,1\n2,2\n", Kind::Number, "drag.csv:1: `1/2`"),
        ("--1,0\n1,1\n2,2\n", Kind::Number, "drag.csv:1: `--1`"),
        ("+-1,0\n1,1\n2,2\n", Kind::Number, "drag.csv:1: `+-1`"),
        ("v,drag\n", Kind::Number, "`drag` has 0 points"),
    ] {
        let found = code(&folder, text.as_bytes()).expect_err(text);
        assert_eq!(found.kind, kind, "{text}: {found:?}");
        assert!(found.message.starts_with(expected), "{text}: {found:?}");
        assert!(found.origin.is_some() && found.help.is_some(), "{found:?}");
    }
    let latin = code(&folder, b"v,drag\n0,\xe9\n").expect_err("no UTF-8");
    assert_eq!(
        (latin.kind, &*latin.message),
        (Kind::Schema, "drag.csv is not UTF-8")
    );
}

#[test]
fn a_path_without_a_readable_file_is_refused() {
    let folder = folder("paths");
    for (path, within, kind, expected) in [
        (
            "none.csv",
            Some(&*folder),
            Kind::Io,
            "the table `none.csv` cannot be read",
        ),
        (
            "drag.npy",
            Some(&*folder),
            Kind::Schema,
            "`drag.npy` is no CSV file",
        ),
        ("drag.csv", None, Kind::Io, "`drag.csv` cannot be read here"),
    ] {
        let text = spec(&format!("{path:?}"));
        let found = compile_spec_in(&text, within, Effort::Declaration).expect_err(path);
        assert_eq!(found[0].kind, kind, "{found:?}");
        assert!(found[0].message.starts_with(expected), "{found:?}");
        assert!(found[0].help.is_some());
    }
}
