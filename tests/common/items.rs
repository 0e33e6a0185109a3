//! Generated code item by item, by the layout in which it is written: what closes an item stands at its indentation.

use std::collections::HashSet;

/// The items and the members of impls that other code has none of the kind of, each kind once.
pub fn beside(code: &str, system: &str, other: &str, other_system: &str) -> String {
    let mut known = HashSet::new();
    written(other, other_system, &mut known);
    written(code, system, &mut known)
}

/// What is not known yet, which is known from then on.
fn written(code: &str, system: &str, known: &mut HashSet<String>) -> String {
    let lines: Vec<&str> = code.lines().collect();
    let mut text = String::new();
    for item in pieces(&lines, 0) {
        let kind = kind(item, system);
        if known.insert(kind.clone()) {
            for member in members(item) {
                known.insert(format!("{kind} {}", self::kind(member, system)));
            }
            text += &format!("\n{}\n", lines_of(item));
            continue;
        }
        let new: Vec<&[&str]> = members(item)
            .into_iter()
            .filter(|member| known.insert(format!("{kind} {}", self::kind(member, system))))
            .collect();
        if !new.is_empty() {
            let head = &item[..opening(item) + 1];
            let new: Vec<String> = new.into_iter().map(lines_of).collect();
            text += &format!("\n{}\n{}\n}}\n", lines_of(head), new.join("\n\n"));
        }
    }
    text
}

/// The text, without the blank lines before it.
fn lines_of(item: &[&str]) -> String {
    item.join("\n").trim_start_matches('\n').to_owned()
}

/// The members of an impl; none of another item.
fn members<'a>(item: &'a [&'a str]) -> Vec<&'a [&'a str]> {
    let is_impl = item.iter().any(|line| line.starts_with("impl"));
    match (is_impl, opening(item) + 1, item.len() - 1) {
        (true, first, last) if first < last => pieces(&item[first..last], 4),
        _ => Vec::new(),
    }
}

/// The line that opens the body.
fn opening(item: &[&str]) -> usize {
    let opens = |line: &&str| line.ends_with('{') && !is_beside(line);
    item.iter().position(opens).unwrap_or(item.len() - 1)
}

/// Comments and attributes.
fn is_beside(line: &str) -> bool {
    let line = line.trim_start();
    line.starts_with("//") || line.starts_with("#[")
}

/// The lines, cut behind each that closes something at this indentation.
fn pieces<'a>(lines: &'a [&'a str], indentation: usize) -> Vec<&'a [&'a str]> {
    let closes = |line: &&str| {
        let body = line.get(indentation..).unwrap_or_default();
        let ends = body.starts_with('}') || body.ends_with(';') || body.ends_with('}');
        ends && !body.starts_with(' ') && !is_beside(line)
    };
    lines.split_inclusive(closes).collect()
}

/// Everything up to the body, whatever the system and its sizes are called.
fn kind(item: &[&str], system: &str) -> String {
    let head = item.iter().filter(|line| !is_beside(line));
    let mut text = String::new();
    for line in head {
        text += line.trim();
        text.push(' ');
        if line.ends_with(['{', ';', '}']) {
            break;
        }
    }
    let text = text.replace(system, "System");
    text.chars().filter(|c| !c.is_ascii_digit()).collect()
}
