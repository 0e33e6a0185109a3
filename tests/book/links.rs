//! Links of the pages.

use std::collections::BTreeSet;
use std::path::Path;

use crate::common::markdown::{blocks_in, links, prose, read};
use crate::{FOLDER, page, pages, place};

/// Where files of the repository are, for readers of the built book.
const REPOSITORY: &str = "https://github.com/lie-poisson/lie-poisson/blob/main/";

/// The anchors of a page, as mdBook makes them of its headings.
fn anchors(text: &str) -> BTreeSet<String> {
    let headings = prose(text);
    let headings = headings.lines().filter(|line| line.starts_with('#'));
    headings
        .map(|line| {
            let words = line.trim_start_matches('#').trim().to_lowercase();
            let kept = words
                .chars()
                .filter(|c| c.is_alphanumeric() || " _-".contains(*c));
            kept.map(|c| if c == ' ' { '-' } else { c }).collect()
        })
        .collect()
}

/// What is wrong with a link of a page.
fn wrong(name: &str, link: &str) -> Option<&'static str> {
    if let Some(path) = link.strip_prefix(REPOSITORY) {
        let path = path.split('#').next().unwrap_or_default();
        let there = Path::new(env!("CARGO_MANIFEST_DIR")).join(path).exists();
        return (!there).then_some("no such file in the repository");
    }
    if link.starts_with("http") {
        return None;
    }
    let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
    let folder = Path::new(name).parent().expect("a folder");
    let file = match file {
        "" => name.to_owned(),
        file => folder.join(file).to_string_lossy().into_owned(),
    };
    if !place(&file).exists() {
        return Some("no such file in the book");
    }
    (!anchor.is_empty() && !anchors(&page(&file)).contains(anchor)).then_some("no such heading")
}

#[test]
fn links_lead_somewhere() {
    let mut count = 0;
    for name in pages() {
        for link in links(&prose(&page(&name))) {
            assert_eq!(wrong(&name, &link), None, "{FOLDER}/{name}: {link}");
            count += 1;
        }
    }
    assert!(count > 20, "only {count} links found");
    assert!(wrong("SUMMARY.md", "nowhere.md").is_some());
    assert!(wrong("limits.md", "limits.md#nothing").is_some());
    assert!(wrong("limits.md", &format!("{REPOSITORY}nothing")).is_some());
}

#[test]
fn every_page_is_in_the_table_of_contents() {
    let listed: BTreeSet<String> = pages().into_iter().collect();
    let mut found = BTreeSet::new();
    let mut folders = vec![place("")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|end| end == "md") {
                let name = path.strip_prefix(place("")).expect("below");
                found.insert(name.to_string_lossy().into_owned());
            }
        }
    }
    found.remove("SUMMARY.md");
    assert_eq!(found, listed);
}

#[test]
fn the_rust_of_every_page_is_compiled() {
    let library = read("src/lib.rs");
    for name in pages() {
        let text = page(&name);
        let included = library.contains(&format!("include_str!(\"../{FOLDER}/{name}\")"));
        assert_eq!(included, !blocks_in(&text, "rust").is_empty(), "{name}");
    }
}
