//! The folders of the compiler import each other in one direction, in its three crates.
//!
//! A folder, or a file beside them, is a node, and an import is an arrow to what it needs; modules of tests are left out. Run
//! with `--nocapture` the test prints an order in which everything stands behind what it needs.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use proc_macro2::{Delimiter, TokenStream, TokenTree};

/// The crates that the compiler is made of, and the names of their roots in a path.
const CRATES: [&str; 3] = ["lie-codegen", "lie-symbolic", "lie-syntax"];
const ROOTS: [&str; 3] = ["crate", "lie_symbolic", "lie_syntax"];

/// Where each folder is needed, with the files that need it.
type Arrows = BTreeMap<String, BTreeMap<String, BTreeSet<String>>>;

/// A source file: its path within `src`, and its text.
struct Source {
    path: String,
    text: String,
}

/// All source files below a folder, without those of tests.
fn sources(root: &Path, folder: &Path, found: &mut Vec<Source>) {
    let mut entries: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    entries.sort();
    for path in entries {
        let stem = path.file_stem().unwrap().to_string_lossy();
        if stem == "tests" || stem == "lib" {
            continue;
        }
        if path.is_dir() {
            sources(root, &path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(Source {
                path: path.strip_prefix(root).unwrap().to_string_lossy().into(),
                text: fs::read_to_string(&path).unwrap(),
            });
        }
    }
}

/// The module of a file, name by name.
fn module(path: &str) -> Vec<String> {
    let path = path.trim_end_matches(".rs").trim_end_matches("/mod");
    path.split('/').map(str::to_owned).collect()
}

/// The arrows that begin in these files.
fn arrows(sources: &[Source]) -> Arrows {
    let mut all = Arrows::new();
    for source in sources {
        let own = module(&source.path);
        let mut needed = BTreeSet::new();
        imports(source.text.parse().unwrap(), &own, &mut needed);
        let arrows = all.entry(own[0].clone()).or_default();
        for folder in needed.into_iter().filter(|folder| *folder != own[0]) {
            arrows
                .entry(folder)
                .or_default()
                .insert(source.path.clone());
        }
    }
    all
}

/// The first names behind a crate in all paths of a module, those of tests left out.
fn imports(tokens: TokenStream, own: &[String], found: &mut BTreeSet<String>) {
    let trees: Vec<TokenTree> = tokens.into_iter().collect();
    let mut place = 0;
    while place < trees.len() {
        if is_for_tests(&trees[place..]) {
            // the item goes up to its body or its semicolon
            while !ends_item(&trees[place]) {
                place += 1;
            }
        } else if is_root(&trees[place]) || is(&trees[place], "super") {
            place = path(&trees, place, own, found);
        } else if let TokenTree::Group(group) = &trees[place] {
            imports(group.stream(), own, found);
        }
        place += 1;
    }
}

/// Whether a token is this word or sign; a group, whose text is long, is neither.
fn is(tree: &TokenTree, word: &str) -> bool {
    match tree {
        TokenTree::Ident(name) => name == word,
        TokenTree::Punct(sign) => word.chars().eq([sign.as_char()]),
        TokenTree::Group(_) | TokenTree::Literal(_) => false,
    }
}

fn is_root(tree: &TokenTree) -> bool {
    ROOTS.iter().any(|root| is(tree, root))
}

fn is_for_tests(trees: &[TokenTree]) -> bool {
    let [hash, TokenTree::Group(attribute), ..] = trees else {
        return false;
    };
    is(hash, "#") && attribute.stream().to_string().replace(' ', "") == "cfg(test)"
}

fn ends_item(tree: &TokenTree) -> bool {
    let body =
        |tree: &TokenTree| matches!(tree, TokenTree::Group(g) if g.delimiter() == Delimiter::Brace);
    is(tree, ";") || body(tree)
}

/// A path that begins with a crate or `super`: where it ends, and what it names.
fn path(
    trees: &[TokenTree],
    mut place: usize,
    own: &[String],
    found: &mut BTreeSet<String>,
) -> usize {
    let mut depth = own.len();
    loop {
        match &trees[place] {
            tree if is_root(tree) => depth = 0,
            tree if is(tree, "super") => depth = depth.saturating_sub(1),
            TokenTree::Group(group) if depth == 0 => {
                // `crate::{a::b, c}`
                let mut first = true;
                for tree in group.stream() {
                    if first && !is(&tree, "self") {
                        found.insert(tree.to_string());
                    }
                    first = is(&tree, ",");
                }
                return place;
            }
            TokenTree::Ident(name) if depth == 0 => {
                found.insert(name.to_string());
                return place;
            }
            _ => return place,
        }
        let colons = trees.get(place + 1..place + 3);
        if !colons.is_some_and(|colons| colons.iter().all(|tree| is(tree, ":"))) {
            return place;
        }
        place += 3;
        if place >= trees.len() {
            return trees.len() - 1;
        }
    }
}

/// An order in which everything stands behind what it needs.
///
/// # Errors
/// What is left over: circles, and what needs them.
fn order(arrows: &Arrows) -> Result<Vec<String>, BTreeSet<String>> {
    let needed = arrows.values().flat_map(BTreeMap::keys);
    let mut left: BTreeSet<String> = arrows.keys().chain(needed).cloned().collect();
    let mut order = Vec::new();
    while !left.is_empty() {
        let ready = left.iter().find(|folder| {
            let needs = arrows.get(*folder).into_iter().flat_map(BTreeMap::keys);
            needs.clone().all(|need| !left.contains(need))
        });
        let Some(ready) = ready.cloned() else {
            return Err(left);
        };
        left.remove(&ready);
        order.push(ready);
    }
    Ok(order)
}

/// The arrows among some folders, one a line, with the files that have them.
fn among(arrows: &Arrows, folders: &BTreeSet<String>) -> String {
    let mut text = String::new();
    for (from, needs) in arrows.iter().filter(|(from, _)| folders.contains(*from)) {
        for (to, files) in needs.iter().filter(|(to, _)| folders.contains(*to)) {
            let files: Vec<&str> = files.iter().map(String::as_str).collect();
            text += &format!("{from} -> {to}: {}\n", files.join(", "));
        }
    }
    text
}

fn compiler() -> Vec<Source> {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut found = Vec::new();
    for name in CRATES {
        let root = crates.join(name).join("src");
        sources(&root, &root, &mut found);
    }
    assert!(found.len() > 250, "{} files were found", found.len());
    found
}

fn planted(path: &str, text: &str) -> Source {
    Source {
        path: path.to_owned(),
        text: text.to_owned(),
    }
}

#[test]
fn no_folder_needs_one_that_needs_it() {
    let arrows = arrows(&compiler());
    match order(&arrows) {
        Ok(order) => println!("{}", order.join("\n")),
        Err(left) => panic!("there is a circle among these:\n{}", among(&arrows, &left)),
    }
}

/// A right-invariant declaration changes its sign in the checks. Behind them its invariance is read where the motion on the
/// group is known, and nowhere else.
#[test]
fn one_file_behind_the_checks_reads_the_invariance() {
    let before = ["ast", "check", "front"];
    let sources = compiler();
    let readers = sources.iter().filter(|source| {
        let folder = &module(&source.path)[0];
        !before.contains(&folder.as_str()) && source.text.contains(".invariance")
    });
    let readers: Vec<&str> = readers.map(|source| source.path.as_str()).collect();
    assert_eq!(readers, ["structure/group.rs"]);
}

/// The control: one arrow back makes a circle of all on its way, whichever way the path is written.
#[test]
fn an_arrow_back_is_found() {
    for (path, text) in [
        ("exact/planted.rs", "use crate::print::Surface;"),
        (
            "exact/planted.rs",
            "use crate::{ast::Name, print::Surface};",
        ),
        (
            "exact/deep/planted.rs",
            "use super::super::super::print::Surface;",
        ),
        (
            "exact/planted.rs",
            "fn f() { let a = [crate::print::print]; }",
        ),
    ] {
        let mut sources = compiler();
        sources.push(planted(path, text));
        let arrows = arrows(&sources);
        let left = order(&arrows).expect_err(text);
        let shown = among(&arrows, &left);
        assert!(
            shown.contains(&format!("exact -> print: {path}")),
            "{shown}"
        );
        assert!(left.contains("model"), "{left:?}");
    }
    // tests may look at anything, and so may text
    for text in [
        "#[cfg(test)] mod tests { use crate::print::Surface; }",
        "#[cfg(test)] use crate::print::Surface; use crate::exact::Rational;",
        "/// See [`crate::print::Surface`].\npub const TEXT: &str = \"crate::print::Surface\";",
        "use super::super::exact::Rational;",
    ] {
        let mut sources = compiler();
        sources.push(planted("exact/deep.rs", text));
        assert!(order(&arrows(&sources)).is_ok(), "{text}");
    }
}
