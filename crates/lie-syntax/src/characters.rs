//! Characters that mislead a reader: controls, and marks that change the order of what is seen or
//! are not seen at all.

use std::borrow::Cow;
use std::fmt::Write as _;

/// Whether a character moves the cursor, rings a bell, or begins a sequence that a terminal obeys.
/// Line breaks and tabs are layout and none.
pub fn is_control(c: char) -> bool {
    c.is_control() && !matches!(c, '\n' | '\t')
}

/// Whether a character changes the direction of what follows, so that a text reads otherwise than it
/// is ("Trojan source", CVE-2021-42574); rustc refuses these too.
pub fn is_direction_control(c: char) -> bool {
    matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// Whether a character is not seen, so that two texts look the same and are not.
pub fn is_invisible(c: char) -> bool {
    matches!(
        c,
        '\u{ad}' | '\u{34f}' | '\u{61c}' | '\u{115f}' | '\u{1160}' | '\u{17b4}' | '\u{17b5}'
            | '\u{180b}'..='\u{180f}' | '\u{200b}'..='\u{200f}' | '\u{2028}' | '\u{2029}'
            | '\u{2060}'..='\u{2065}' | '\u{206a}'..='\u{206f}' | '\u{3164}' | '\u{fe00}'..='\u{fe0f}'
            | '\u{feff}' | '\u{ffa0}' | '\u{fff0}'..='\u{fffb}' | '\u{e0000}'..='\u{e0fff}'
    )
}

/// The text with `\u{…}` for every character that misleads, for messages; line breaks stay.
pub fn visible(text: &str) -> Cow<'_, str> {
    let misleads = |c: char| is_control(c) || is_direction_control(c) || is_invisible(c);
    if !text.contains(misleads) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if misleads(c) {
            let _ = write!(shown, "\\u{{{:x}}}", u32::from(c));
        } else {
            shown.push(c);
        }
    }
    Cow::Owned(shown)
}

/// The beginning and the end of a text that is too long for a message, with the number of characters
/// that are left out between them; a text of at most `most` characters as it is.
pub fn excerpt(text: &str, most: usize) -> Cow<'_, str> {
    let count = text.chars().count();
    if count <= most {
        return Cow::Borrowed(text);
    }
    let (head, tail) = (most * 3 / 4, most / 4);
    let at = |n: usize| text.char_indices().nth(n).map_or(text.len(), |(at, _)| at);
    let left_out = count - head - tail;
    Cow::Owned(format!(
        "{} … ({left_out} characters left out) … {}",
        &text[..at(head)],
        &text[at(count - tail)..]
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_misleads_is_shown() {
        assert_eq!(visible("plain ω\n\tx"), "plain ω\n\tx");
        assert_eq!(
            visible("\u{1b}[31m\r\u{202e}a\u{200b}\u{9b}"),
            "\\u{1b}[31m\\u{d}\\u{202e}a\\u{200b}\\u{9b}"
        );
    }

    #[test]
    fn excerpts_keep_both_ends_and_count() {
        assert_eq!(excerpt("ωωωω", 4), "ωωωω");
        let long = format!("a{}z", "ω".repeat(998));
        let short = excerpt(&long, 100);
        assert!(short.starts_with("aω") && short.ends_with("ωz"), "{short}");
        assert!(short.contains("(900 characters left out)"), "{short}");
    }
}
