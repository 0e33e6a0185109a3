//! What is typed into a shell.

/// A word as a shell takes it.
pub fn word(text: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "-_./,=:+".contains(c);
    match text.chars().all(plain) {
        true if !text.is_empty() => text.to_owned(),
        _ => format!("'{}'", text.replace('\'', r"'\''")),
    }
}

/// A call of the command with these words.
pub fn line(words: &[String]) -> String {
    let quoted: Vec<String> = words.iter().map(|text| word(text)).collect();
    format!("lie {}", quoted.join(" "))
}
