//! Names that no declaration may use.

use lie_symbolic::symbolic::Function;

/// The keywords of Rust, strict and reserved, of every edition up to 2024: generated code uses the
/// user's names as they are.
const KEYWORDS: &[&str] = &[
    "abstract", "as", "async", "await", "become", "box", "break", "const", "continue", "crate",
    "do", "dyn", "else", "enum", "extern", "false", "final", "fn", "for", "gen", "if", "impl",
    "in", "let", "loop", "macro", "match", "mod", "move", "mut", "override", "priv", "pub", "ref",
    "return", "self", "Self", "static", "struct", "super", "trait", "true", "try", "type",
    "typeof", "unsafe", "unsized", "use", "virtual", "where", "while", "yield",
];
/// Words of the language; `energy` is a column of every output.
const WORDS: &[&str] = &["pi", "t", "energy", "sum"];

/// Whether a name is a keyword of Rust.
pub fn is_keyword(name: &str) -> bool {
    KEYWORDS.contains(&name)
}

/// Whether the language keeps a name for itself.
pub fn is_reserved(name: &str) -> bool {
    is_keyword(name) || WORDS.contains(&name) || name.starts_with('_') || Function::is_name(name)
}
