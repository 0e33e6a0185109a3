//! What is published: packages with licences and without tests, mathematics where documentation is hosted, one version, and a top
//! folder in which every entry is explained.

use crate::common::markdown::read;
use std::fs;
use std::path::{Path, PathBuf};

/// Files of a folder whose names end so, at any depth.
fn files(folder: &Path, end: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            found.extend(files(&path, end));
        } else if path.to_string_lossy().ends_with(end) {
            found.push(path);
        }
    }
    found
}

/// The manifests of the crates that are published, by their folders; the command is the root.
fn published() -> Vec<(String, String)> {
    let mut folders = vec!["lie-macros".to_owned(), "lie-runtime".to_owned()];
    for entry in fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("crates")).expect("crates")
    {
        let name = entry.expect("an entry").file_name();
        folders.push(format!("crates/{}", name.to_string_lossy()));
    }
    let manifest = |folder: String| (read(&format!("{folder}/Cargo.toml")), folder);
    let all = folders.into_iter().map(manifest);
    let all = all.filter(|(text, _)| !text.contains("publish = false"));
    let all: Vec<(String, String)> = all.map(|(text, folder)| (folder, text)).collect();
    assert!(all.len() > 8, "only {all:?}");
    all
}

#[test]
fn packages_have_their_licences_and_no_tests() {
    for (folder, manifest) in published() {
        assert!(
            manifest.contains("\ninclude.workspace = true\n"),
            "{folder}"
        );
        assert!(
            manifest.contains("\nlicense.workspace = true\n"),
            "{folder}"
        );
        for licence in ["LICENSE-MIT", "LICENSE-APACHE"] {
            assert_eq!(
                read(&format!("{folder}/{licence}")),
                read(licence),
                "{folder}"
            );
        }
    }
}

/// Whoever writes formulas has the header that renders them in the package, for hosted documentation too.
#[test]
fn formulas_are_rendered_where_documentation_is_hosted() {
    let header = read("docs/katex/katex.html");
    let mut with_formulas = 0;
    for (folder, manifest) in published() {
        let sources = files(
            &Path::new(env!("CARGO_MANIFEST_DIR"))
                .join(&folder)
                .join("src"),
            ".rs",
        );
        let mut texts = sources
            .iter()
            .map(|path| fs::read_to_string(path).expect("a source"));
        if !texts.any(|text| text.contains("docs/katex.html")) {
            continue;
        }
        with_formulas += 1;
        assert_eq!(
            read(&format!("{folder}/docs/katex.html")),
            header,
            "{folder}"
        );
        let arguments = "[package.metadata.docs.rs]\nrustdoc-args = [\"--html-in-header\", \"docs/katex.html\"]\n";
        assert!(manifest.contains(arguments), "{folder}");
    }
    assert!(with_formulas > 1);
}

#[test]
fn the_version_is_the_same_everywhere() {
    let version = env!("CARGO_PKG_VERSION");
    assert!(read("CITATION.cff").contains(&format!("\nversion: {version}\n")));
    assert!(
        read("lie-python/conda/recipe.yaml").contains(&format!("\n  version: \"{version}\"\n"))
    );
    assert!(read("CHANGELOG.md").contains(&format!("\n## {version}, ")));
    for (folder, _) in published() {
        let standalone = format!("{folder}/src/standalone.toml");
        if Path::new(env!("CARGO_MANIFEST_DIR"))
            .join(&standalone)
            .exists()
        {
            assert!(
                read(&standalone).contains(&format!("\nversion = \"{version}\"\n")),
                "{folder}"
            );
        }
    }
}

/// What builds, environments and commands leave is not the tree.
#[test]
fn the_top_folder_is_small_and_explained() {
    const LEFT: [&str; 3] = [".git", "target", ".venv"];
    let page = read("ARCHITECTURE.md");
    let table = page.split("## The top folder\n").nth(1).expect("its table");
    let table = table.split("\n## ").next().expect("its rows");
    let ignored = |name: &str| {
        LEFT.contains(&name)
            || [".svg", ".csv"].iter().any(|end| name.ends_with(end))
            || name.ends_with("_cache")
    };
    let entries = fs::read_dir(env!("CARGO_MANIFEST_DIR")).expect("the top");
    let entries = entries.map(|entry| entry.expect("an entry").file_name());
    let names: Vec<String> = entries
        .map(|name| name.to_string_lossy().into_owned())
        .collect();
    let names: Vec<&String> = names.iter().filter(|name| !ignored(name)).collect();
    assert!(names.len() <= 22, "{names:?}");
    for name in names {
        assert!(
            table.contains(&format!("`{name}`")),
            "{name} is not in the table of ARCHITECTURE.md"
        );
    }
}
