//! Tokens as formatted text.

use proc_macro2::TokenStream;

/// Items as a formatted file.
pub(crate) fn format(tokens: TokenStream) -> String {
    match syn::parse2(tokens.clone()) {
        Ok(file) => air(&prettyplease::unparse(&file)),
        // What is printed is valid Rust; should it not be, the text as it is shows where.
        Err(_) => tokens.to_string(),
    }
}

/// A blank line between items and between methods, which the printer leaves out.
fn air(text: &str) -> String {
    let mut aired = String::with_capacity(text.len() + text.len() / 32);
    let mut ended = false;
    for line in text.lines() {
        let start = line.trim_start();
        let goes_on = ["}", "else", ")"].iter().any(|end| start.starts_with(end));
        if ended && !goes_on {
            aired.push('\n');
        }
        ended = start == "}";
        aired.push_str(line);
        aired.push('\n');
    }
    aired
}
