//! Habits of other languages: how Python, Matlab, Julia, Mathematica and LaTeX write what the grammar
//! writes otherwise, or does not have.

use crate::hints;

/// The functions of other languages that are known, each with what to write for a call of it.
pub fn functions() -> impl Iterator<Item = (&'static str, String)> {
    hints::table("functions").filter_map(|(name, _)| Some((name, function(name, &[])?)))
}

/// What to write for a call of a function of another language, its arguments as text.
pub fn function(name: &str, arguments: &[String]) -> Option<String> {
    let form = hints::lookup_word("functions", &name.to_lowercase())?;
    let operand = |text: &String| {
        let simple = text
            .chars()
            .all(|c| c.is_alphanumeric() || c == '_' || c == '.');
        if simple {
            text.clone()
        } else {
            format!("({text})")
        }
    };
    let mut written = form.to_owned();
    let examples = ["a".to_owned(), "b".to_owned()];
    for (index, (plain, grouped)) in [("%a", "%A"), ("%b", "%B")].into_iter().enumerate() {
        let text = arguments.get(index).unwrap_or(&examples[index]);
        written = written
            .replace(plain, text)
            .replace(grouped, &operand(text));
    }
    Some(written)
}

/// Why the grammar has no such function.
pub fn without(name: &str) -> Option<&'static str> {
    hints::lookup_word("no such functions", name)
}

/// Why a declaration has no such key, and what to write.
pub fn key(name: &str) -> Option<&'static str> {
    hints::lookup_word("no such keys", &name.to_lowercase())
}

/// Why there is no such sign.
pub fn sign(c: char) -> Option<&'static str> {
    hints::lookup_character("no such signs", c)
}

/// What to write in place of a word of programming languages.
pub fn word(name: &str) -> Option<&'static str> {
    hints::lookup_word("words of programs", name)
}

/// What is meant by a name that nobody declared: message and remedy.
pub fn constant(name: &str) -> Option<(String, &'static str)> {
    Some(match name {
        "π" | "PI" | "Pi" | "M_PI" => (format!("unknown symbol `{name}`"), "did you mean `pi`?"),
        "e" | "E" => (
            format!("unknown symbol `{name}`"),
            "a power of Euler's number is written `exp(x)`, the number itself `exp(1)`",
        ),
        "i" | "j" | "im" | "I" => (
            format!("unknown symbol `{name}`"),
            "all quantities are real; declare it as a parameter if it is one",
        ),
        "inf" | "Inf" | "INF" | "infinity" | "Infinity" | "nan" | "NaN" | "NAN" => (
            format!("`{name}` is not a valid number"),
            "write a finite value",
        ),
        "True" | "False" | "None" | "null" => (
            format!("`{name}` is not a number"),
            "write a number or an expression",
        ),
        _ => return None,
    })
}

/// The same name in Latin letters, of one with letters that only look so.
pub fn in_latin(name: &str) -> Option<String> {
    use unicode_normalization::UnicodeNormalization as _;
    let (others, latin) = hints::table("letters").next()?;
    let twin = |c: char| {
        let mut pairs = others.chars().zip(latin.chars());
        let found = pairs.find(|(other, _)| *other == c);
        found.map_or(c, |(_, latin)| latin)
    };
    let latin: String = name.nfkc().map(twin).collect();
    (latin != name).then_some(latin)
}
