//! Commands and specs of the pages.
//!
//! A page has a folder of its own, with a copy of `specs`. A block behind `<!-- file: NAME -->` is written there; any other one
//! of JSON must be a spec that compiles. A block of `sh` holds calls of `lie` that must succeed. A block of `text` that
//! begins with `$ lie` shows calls with what they print; a line `…` stands for any lines. One behind `<!-- from: PATH -->`
//! has lines of that document. Pictures that are drawn are those in `pictures`.

use std::fs;
use std::path::Path;
use std::process::Command;
use std::thread;

use lie_codegen::compile::compile_spec;

use crate::common::markdown::{Block, blocks, read};
use crate::{FOLDER, common, compare, page, pages, place, update};

/// No picture is larger, in bytes.
const LARGEST_PICTURE: usize = 80_000;

/// Whether a call needs cargo, and minutes.
fn is_slow(call: &str) -> bool {
    ["lie bench", "lie stress"]
        .iter()
        .any(|slow| call.starts_with(slow))
        || call.contains(" --compile")
}

/// Whether the slow calls are run.
fn all() -> bool {
    std::env::var_os("LIE_BOOK_ALL").is_some()
}

/// The words of a call; those in quotes are one.
fn words(call: &str) -> Vec<String> {
    let mut words = Vec::new();
    for (index, part) in call.split(['"', '\'']).enumerate() {
        if index % 2 == 1 {
            words.push(part.to_owned());
        } else {
            words.extend(part.split_whitespace().map(str::to_owned));
        }
    }
    words
}

/// Runs a call in a folder: whether it succeeded, and all that it printed.
fn run(folder: &Path, call: &str) -> (bool, String) {
    let words = words(call);
    assert_eq!(words[0], "lie", "not a call of lie: {call}");
    let log = folder.join(".log");
    let file = fs::File::create(&log).expect("a file");
    let mut command: Command = common::command(&words[1..]);
    let status = command
        .current_dir(folder)
        .stdout(file.try_clone().expect("a file"))
        .stderr(file)
        .status()
        .expect("lie starts");
    let printed = fs::read_to_string(&log).expect("text");
    fs::remove_file(&log).expect("the file was there");
    (status.success(), printed)
}

/// A line without what differs from run to run: `in 0.02 s`.
fn without_times(line: &str) -> String {
    let mut words: Vec<&str> = line.trim_end().split(' ').collect();
    for index in 1..words.len().saturating_sub(1) {
        let unit = words[index + 1].trim_end_matches([',', ';', ':', '.']);
        if words[index - 1] == "in" && unit == "s" && words[index].parse::<f64>().is_ok() {
            words[index] = "…";
        }
    }
    words.join(" ")
}

/// What of the table of a measurement is the same in every run: who is in it.
fn names(text: &str) -> Vec<String> {
    let first = |line: &str| {
        line.split("  ")
            .next()
            .unwrap_or_default()
            .replace(|c: char| c.is_ascii_digit(), "")
    };
    let mut names: Vec<String> = text.lines().map(first).collect();
    names.retain(|name| {
        !name.starts_with("reference:") && !name.starts_with("times:") && !name.is_empty()
    });
    names.sort();
    names
}

/// Whether lines are the expected ones, in which `…` stands for any.
fn matches(expected: &[String], found: &[String]) -> bool {
    match expected.first() {
        None => found.is_empty(),
        Some(line) if line == "…" => {
            (0..=found.len()).any(|skipped| matches(&expected[1..], &found[skipped..]))
        }
        Some(line) => found.first() == Some(line) && matches(&expected[1..], &found[1..]),
    }
}

/// Whether a call printed what is shown.
fn agrees(call: &str, expected: &str, printed: &str) -> bool {
    if is_slow(call) {
        return names(expected) == names(printed);
    }
    let lines = |text: &str| -> Vec<String> { text.trim().lines().map(without_times).collect() };
    matches(&lines(expected), &lines(printed))
}

/// A block of calls with what they print, run; the same with what they print now.
fn transcript(folder: &Path, block: &Block, wrong: &mut Vec<String>) -> String {
    let mut now = String::new();
    for part in block.text.split("$ ").skip(1) {
        let (call, expected) = part.split_once('\n').unwrap_or((part, ""));
        let ran = !is_slow(call) || all();
        let printed = if ran {
            run(folder, call).1
        } else {
            expected.to_owned()
        };
        let elided = expected.lines().any(|line| line == "…");
        let right = !ran || agrees(call, expected, &printed);
        if !right && (elided || !update()) {
            wrong.push(format!(
                "line {}: $ {call}\n{printed}instead of\n{expected}",
                block.line
            ));
        }
        let shown = if right || elided { expected } else { &printed };
        now.push_str(&format!("$ {call}\n{}\n\n", shown.trim_end()));
    }
    now.trim_end().to_owned() + "\n"
}

/// A block of text from a document of the repository: each line stands there.
fn excerpt(block: &Block, wrong: &mut Vec<String>) {
    let path = block
        .before
        .trim_start_matches("<!-- from: ")
        .trim_end_matches(" -->");
    let document = read(path);
    for line in block.text.lines().filter(|line| *line != "…") {
        if !document.lines().any(|other| other == line) {
            wrong.push(format!("line {}: not in {path}: {line}", block.line));
        }
    }
}

/// The name of the file that a block is, for the calls behind it.
fn file(block: &Block) -> Option<&str> {
    let name = block.before.strip_prefix("<!-- file: ")?;
    name.strip_suffix(" -->")
}

/// A block of JSON that is no file: a spec.
fn specification(block: &Block, wrong: &mut Vec<String>) {
    if let Err(error) = compile_spec(&block.text) {
        wrong.push(format!(
            "line {}: the spec is refused: {error:?}",
            block.line
        ));
    }
}

/// Copies the specs next to the page.
fn provide_specs(folder: &Path) {
    let from = Path::new(env!("CARGO_MANIFEST_DIR"));
    for specs in ["specs", "specs/brackets"] {
        fs::create_dir(folder.join(specs)).expect("a folder");
        let entries = fs::read_dir(from.join(specs)).expect("specs");
        for entry in entries.map(|entry| entry.expect("an entry")) {
            if entry.path().is_file() {
                let to = folder.join(specs).join(entry.file_name());
                fs::copy(entry.path(), to).expect("a copy");
            }
        }
    }
}

/// Runs the blocks of a page; returns what is wrong.
fn run_page(name: &str) -> Vec<String> {
    let folder = common::folder();
    let folder = folder.path();
    provide_specs(folder);
    let (text, mut wrong) = (page(name), Vec::new());
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    for block in &blocks(&text) {
        if let Some(name) = file(block) {
            fs::write(folder.join(name), &block.text).expect("the file is written");
            continue;
        }
        match block.language.as_str() {
            "json" => specification(block, &mut wrong),
            "sh" => {
                for call in block.text.lines().filter(|call| !is_slow(call) || all()) {
                    let (succeeded, printed) = run(folder, call);
                    if !succeeded {
                        wrong.push(format!("line {}: $ {call}\n{printed}", block.line));
                    }
                }
            }
            "text" if block.before.starts_with("<!-- from: ") => excerpt(block, &mut wrong),
            "text" if block.text.starts_with("$ lie ") => {
                let now = transcript(folder, block, &mut wrong);
                let end = block.line + block.text.lines().count();
                lines[block.line] = now.trim_end().to_owned();
                lines[block.line + 1..end]
                    .iter_mut()
                    .for_each(|line| *line = "\0".into());
            }
            _ => {}
        }
    }
    lines.retain(|line| line != "\0");
    let now = lines.join("\n") + "\n";
    if update() && now != text {
        fs::write(place(name), now).expect("the page is written");
    }
    for entry in fs::read_dir(folder).expect("the folder") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|end| end == "svg") {
            let picture = fs::read(&path).expect("a picture");
            let name = path.file_name().expect("a name").to_string_lossy();
            if picture.len() > LARGEST_PICTURE {
                wrong.push(format!("{name} has {} bytes", picture.len()));
            }
            compare(&format!("pictures/{name}"), &picture);
        }
    }
    wrong
}

#[test]
fn commands_print_what_the_pages_show() {
    let pages = pages();
    let wrong: Vec<String> = thread::scope(|scope| {
        let running: Vec<_> = pages
            .iter()
            .map(|name| (name, scope.spawn(move || run_page(name))))
            .collect();
        running
            .into_iter()
            .flat_map(|(name, page)| {
                let wrong = page
                    .join()
                    .unwrap_or_else(|_| vec!["a panic, see above".into()]);
                wrong
                    .into_iter()
                    .map(move |what| format!("{FOLDER}/{name}, {what}"))
            })
            .collect()
    });
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

#[test]
fn a_wrong_line_is_seen() {
    let call = "lie run specs/so3_free_rigid_body.json";
    let shown = "Body, lie-midpoint: 10 steps in 0.02 s, 1.0 iterations\nerror 1e-5\n";
    assert!(agrees(call, shown, &shown.replace("0.02", "0.03")));
    assert!(!agrees(call, shown, &shown.replace("10 steps", "11 steps")));
    assert!(agrees(call, "…\nerror 1e-5", shown));
    assert!(!agrees(call, "…\nerror 1e-6", shown));
    let table = "method  to 1e-3\ngauss16  0.7\nrk4  0.2\n";
    assert!(agrees(
        "lie bench x",
        table,
        "method  to 1e-3\nrk4  0.3\ngauss16  0.6\n"
    ));
    assert!(!agrees("lie bench x", table, "method  to 1e-3\nrk4  0.3\n"));
}
