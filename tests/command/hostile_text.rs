//! Text of a spec is data: rustdoc neither runs it, nor takes it into its pages, nor stumbles over
//! it; a terminal does not obey it; and no mistake fills the screen.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::common::{folder, lie, spec};
use lie_syntax::characters::{is_control, is_direction_control};
use serde_json::json;

/// Texts that rustdoc would run, resolve or take into the page.
const HOSTILE: &[&str] = &[
    "```\npanic!(\"fence\")\n```",
    "```rust\npanic!(\"language\")\n```",
    "~~~\npanic!(\"tildes\")\n~~~",
    "> ```\n> panic!(\"quotation\")\n> ```",
    "- ```\n  panic!(\"list\")\n  ```",
    "1. a\n\n        panic!(\"numbered\")",
    "text\n\n    panic!(\"indented\")\n\ntext",
    "-     panic!(\"indented in a list\")",
    "\t panic!(\"tab\")",
    "` ```\npanic!(\"after a span\")\n``` `",
    "\\```\npanic!(\"after a backslash\")\n\\```",
    "<pre><code>\n\n```\npanic!(\"html\")\n```\n</code></pre>",
    "<script>alert(1)</script>",
    "<img src=x onerror=alert(1)>",
    "<details><b>not closed",
    "[click](javascript:alert(1)) and ![pixel](https://example.org/pixel.png)",
    "[Nowhere] [`Nowhere`] [a][Nowhere] [b]: Nowhere",
    "[`crate::nowhere`]: a [struct@Nowhere]",
    "[Body]: https://example.org\n[`Body`]: https://example.org",
    "https://example.org is a bare address, <https://example.org> another",
    "&lt;script&gt; &#60;b&#62;",
    "# Errors\nno heading\n===\nnor this\n---",
    "| a | b |\n|---|---|\n| c | d |\n\na\n:-:",
    "[^1] a note\n\n[^1]: <b>the note</b>",
    "- [ ] a task\n- [x] done",
    "*/ } fn main() {} /* \" #[doc = \"x\"]",
    "ends in a backslash \\",
    "`not closed",
];

fn rustdoc(folder: &Path, file: &str, arguments: &[&str]) -> Output {
    let cargo = std::env::var_os("CARGO").map(PathBuf::from);
    let beside = cargo.map(|cargo| cargo.with_file_name("rustdoc"));
    let program = beside.filter(|path| path.exists());
    let output = Command::new(program.unwrap_or_else(|| "rustdoc".into()))
        .args(["--edition=2024", "--crate-name=page", "-Dwarnings"])
        .args(arguments)
        .arg(file)
        .current_dir(folder)
        .env_remove("RUSTDOCFLAGS")
        .output();
    output.expect("rustdoc starts")
}

/// A crate of structs, each with one of these doc comments.
fn crate_of(folder: &Path, comments: &[String]) {
    let mut text = "//! Comments.\npub struct Body;\n".to_owned();
    for (index, comment) in comments.iter().enumerate() {
        let _ = writeln!(text, "{comment}pub struct Comment{index};");
    }
    std::fs::write(folder.join("page.rs"), text).expect("the crate is written");
}

/// The number of blocks of code that rustdoc would run.
fn doctests(folder: &Path) -> usize {
    let output = rustdoc(folder, "page.rs", &["--test", "--test-args=--list"]);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let lines = text.lines().filter(|line| line.ends_with(": test"));
    lines.count()
}

/// What rustdoc has against the crate.
fn warnings(folder: &Path) -> String {
    let output = rustdoc(folder, "page.rs", &["--out-dir=pages"]);
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// The pages of the crate, all of them.
fn pages(folder: &Path) -> String {
    let entries = std::fs::read_dir(folder.join("pages/page")).expect("the pages");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let paths = paths.filter(|path| path.extension().is_some_and(|e| e == "html"));
    paths
        .map(|path| std::fs::read_to_string(path).expect("a page"))
        .collect()
}

/// The doc comments of a generated file.
fn comments(code: &str) -> Vec<String> {
    assert!(
        !code.contains("#[doc =") && !code.contains("/**"),
        "a comment that is no `///`"
    );
    let mut comments = vec![String::new()];
    for line in code.lines().map(str::trim_start) {
        let last = comments.last_mut().expect("at least one");
        if line.starts_with("///") {
            last.push_str(line);
            last.push('\n');
        } else if !last.is_empty() {
            comments.push(String::new());
        }
    }
    comments.retain(|comment| !comment.is_empty());
    comments
}

#[test]
fn rustdoc_neither_runs_nor_obeys_the_text_of_a_spec() {
    let folder = folder();
    // What the texts do where nobody escapes them, or this test would pass with any.
    let raw: Vec<String> = HOSTILE
        .iter()
        .map(|text| text.lines().map(|line| format!("/// {line}\n")).collect())
        .collect();
    crate_of(folder.path(), &raw);
    assert!(doctests(folder.path()) >= 8);
    let found = warnings(folder.path());
    for lint in ["broken_intra_doc_links", "bare_urls", "invalid_html_tags"] {
        assert!(found.contains(lint), "{lint} is not among\n{found}");
    }

    let path = spec(folder.path(), |spec| {
        spec["description"] = HOSTILE.join("\n\n").into();
        spec["references"] = HOSTILE.to_vec().into();
        let mut energy = "x^2/(2*I1) + y^2/(2*I2) + z^2/(2*I3)".to_owned();
        for (index, text) in HOSTILE.iter().enumerate() {
            spec["parameters"][format!("p{index}")] =
                json!({ "default": 1, "description": text, "unit": text });
            let _ = write!(energy, " + p{index}");
        }
        spec["hamiltonian"] = energy.into();
    });
    let expanded = lie(&format!("expand {}", path.display())).ok();
    let escaped = comments(&expanded.stdout);
    assert!(escaped.len() > HOSTILE.len(), "every parameter has one");
    crate_of(folder.path(), &escaped);
    assert_eq!(doctests(folder.path()), 0, "{}", expanded.stdout);
    assert_eq!(warnings(folder.path()), "");
    let pages = pages(folder.path());
    for tag in [
        "<script>alert",
        "<img src=x",
        "<b>not",
        "javascript:alert(1)\"",
        "<h2 id=\"nor",
    ] {
        assert!(!pages.contains(tag), "{tag} is in the page");
    }
    // Quotes are curled, as in any text.
    for text in [
        "&lt;script&gt;alert(1)&lt;/script&gt;",
        "panic!(“list”)",
        "[click](javascript",
    ] {
        assert!(pages.contains(text), "{text} is not shown");
    }
}

#[test]
fn a_terminal_does_not_obey_what_a_spec_says() {
    let folder = folder();
    let hostile = "\u{1b}[31m\u{9b}2J\u{7}\r\u{202e}\u{7f}x";
    let changes: [(&str, serde_json::Value); 8] = [
        ("name", hostile.into()),
        ("description", hostile.into()),
        ("references", json!([hostile])),
        ("state", json!(["x", hostile, "z"])),
        ("hamiltonian", format!("x + {hostile}").into()),
        ("methods", json!([hostile])),
        ("invariance", hostile.into()),
        (hostile, 1.into()),
    ];
    for (key, value) in changes {
        let path = spec(folder.path(), |spec| spec[key] = value);
        let text = std::fs::read_to_string(&path).expect("the spec");
        // As escapes of JSON, and as the characters themselves where JSON lets them stand.
        for text in [text.replace("\u{9b}", "\\u009b"), text] {
            std::fs::write(&path, text).expect("the spec is written");
            for command in ["check", "run", "expand"] {
                let run = lie(&format!("{command} {}", path.display()));
                assert_eq!(run.code, Some(2), "{key}: {}", run.stderr);
                let printed = format!("{}{}", run.stderr, run.stdout);
                let obeyed = printed
                    .chars()
                    .find(|c| is_control(*c) || is_direction_control(*c));
                assert_eq!(obeyed, None, "{key}: {:?}", run.stderr);
            }
        }
    }
}

#[test]
fn no_mistake_fills_the_screen() {
    let folder = folder();
    let terms = |form: &dyn Fn(usize) -> String| -> String {
        let terms: Vec<String> = (0..20_000).map(form).collect();
        terms.join(" + ")
    };
    let long = "y".repeat(1 << 20);
    let cases: [(&str, serde_json::Value, &str); 7] = [
        (
            "hamiltonian",
            terms(&|i| format!("unknown{i}")).into(),
            "950 more messages",
        ),
        (
            "hamiltonian",
            terms(&|i| format!("x{i}(y)")).into(),
            "more messages",
        ),
        (
            "hamiltonian",
            format!("x + {long}").into(),
            "characters left out",
        ),
        (
            "casimirs",
            json!([terms(&|i| format!("x^{}*{i}/7", i % 40))]),
            "casimir",
        ),
        ("name", format!("{long}.").into(), "syntax"),
        ("methods", json!([long]), "characters left out"),
        ("initial", json!(vec!["one"; 100_000]), "950 more messages"),
    ];
    for (key, value, says) in cases {
        let path = spec(folder.path(), |spec| spec[key] = value);
        let run = lie(&format!("check {}", path.display()));
        assert_eq!(run.code, Some(2), "{key}");
        assert!(
            run.stderr.len() < 60_000,
            "{key}: {} bytes",
            run.stderr.len()
        );
        assert!(run.stderr.contains(says), "{key}: {}", run.stderr);
    }
}

#[test]
fn the_size_of_a_file_has_a_limit() {
    let folder = folder();
    let path = spec(folder.path(), |_| {});
    let text = std::fs::read_to_string(&path).expect("the spec");
    let padded = |length: usize| format!("{text}{}", " ".repeat(length - text.len()));
    std::fs::write(&path, padded(16 << 20)).expect("the spec is written");
    lie(&format!("check {}", path.display())).ok();
    std::fs::write(&path, padded((16 << 20) + 1)).expect("the spec is written");
    let place = format!("{}:1:1", path.display());
    lie(&format!("check {}", path.display())).error("limit", &place);
    lie("check /dev/zero").error("limit", "/dev/zero:1:1");
}
