//! Habits of other languages: how Python, Matlab, Julia, Mathematica and LaTeX write what the grammar
//! writes otherwise, or does not have.

/// Functions of other languages and what to write: `%a` and `%b` are the arguments, `%A` and `%B` the
/// same as operands, in parentheses where they need some.
const FUNCTIONS: &[(&str, &str)] = &[
    ("ln", "log(%a)"),
    ("log10", "log(%a)/log(10)"),
    ("log2", "log(%a)/log(2)"),
    ("exp2", "2^%A"),
    ("pow", "%A^%B"),
    ("power", "%A^%B"),
    ("square", "%A^2"),
    ("cube", "%A^3"),
    ("fabs", "abs(%a)"),
    ("fmin", "min(%a, %b)"),
    ("fmax", "max(%a, %b)"),
    ("minimum", "min(%a, %b)"),
    ("maximum", "max(%a, %b)"),
    ("sign", "piecewise(%a < 0: -1, 1)"),
    ("sgn", "piecewise(%a < 0: -1, 1)"),
    ("heaviside", "piecewise(%a < 0: 0, 1)"),
    ("sec", "1/cos(%a)"),
    ("csc", "1/sin(%a)"),
    ("cosec", "1/sin(%a)"),
    ("cot", "1/tan(%a)"),
    ("sech", "1/cosh(%a)"),
    ("csch", "1/sinh(%a)"),
    ("coth", "1/tanh(%a)"),
    ("sinc", "sin(%a)/%A"),
    ("arcsin", "asin(%a)"),
    ("arccos", "acos(%a)"),
    ("arctan", "atan(%a)"),
    ("arctan2", "atan2(%a, %b)"),
    ("arcsinh", "asinh(%a)"),
    ("arccosh", "acosh(%a)"),
    ("arctanh", "atanh(%a)"),
    ("arsinh", "asinh(%a)"),
    ("arcosh", "acosh(%a)"),
    ("artanh", "atanh(%a)"),
    ("cuberoot", "cbrt(%a)"),
    ("sh", "sinh(%a)"),
    ("ch", "cosh(%a)"),
    ("th", "tanh(%a)"),
    ("tg", "tan(%a)"),
];

/// Functions that the grammar does not have, by the reason.
const WITHOUT: &[(&[&str], &str)] = &[
    (
        &["floor", "ceil", "round", "mod", "rem"],
        "a Hamiltonian jumps nowhere: cases that fit together are written `piecewise(x < 0: -x, x)`",
    ),
    (
        &["step", "if", "ifelse", "where", "select", "clip", "clamp"],
        "cases are written `piecewise(x < 0: -x, x)`; there are min(a, b) and max(a, b) too",
    ),
    (
        &[
            "tr",
            "trace",
            "det",
            "transpose",
            "inv",
            "matmul",
            "outer",
            "sum",
            "prod",
        ],
        "write it out in the components; of vectors there are dot(v, w), cross(v, w), norm(v), norm2(v) and quad(A, v)",
    ),
    (
        &[
            "diff",
            "grad",
            "gradient",
            "D",
            "derivative",
            "jacobian",
            "integrate",
            "int",
            "limit",
        ],
        "derivatives are taken by the compiler; write the function itself",
    ),
    (
        &["conj", "real", "imag", "re", "im", "arg"],
        "all quantities are real",
    ),
    (&["rand", "random", "randn"], "a system is deterministic"),
];

/// Characters that other languages use, with the reason why none stands here.
const SIGNS: &[(&str, &str)] = &[
    (
        "<>?",
        "a comparison stands in `piecewise` alone, as in `piecewise(x < 0: -x, x)`",
    ),
    ("&", "there is no logic: a Hamiltonian is one formula"),
    ("|", "write the absolute value of x as `abs(x)`"),
    ("!", "there is no factorial: write its value"),
    (
        "@",
        "a matrix times a vector is written A*v; there are no handles of functions",
    ),
    (
        "$\\",
        "LaTeX is not read: write `x^2/2`, `sin(x)`, `sqrt(x)`, `a*b`",
    ),
    (
        "#%",
        "remove it: an expression has no comments and no remainder",
    ),
    ("∞", "values are finite: remove it"),
    (
        "'’′",
        "remove it: names have no primes, and there is nothing to transpose",
    ),
    ("\"“”„`‘", "an expression is written without quotes"),
    ("~", "remove it"),
];

/// Words of programming languages that are no names here.
const WORDS: &[&str] = &[
    "lambda", "def", "function", "return", "and", "or", "not", "if", "else", "then", "end", "for",
    "while", "where", "fn", "let", "do",
];

/// Letters of other scripts that look like Latin ones.
const TWINS: &[(char, char)] = &[
    ('а', 'a'),
    ('с', 'c'),
    ('е', 'e'),
    ('і', 'i'),
    ('ј', 'j'),
    ('о', 'o'),
    ('р', 'p'),
    ('ѕ', 's'),
    ('х', 'x'),
    ('у', 'y'),
    ('А', 'A'),
    ('В', 'B'),
    ('С', 'C'),
    ('Е', 'E'),
    ('Н', 'H'),
    ('І', 'I'),
    ('К', 'K'),
    ('М', 'M'),
    ('О', 'O'),
    ('Р', 'P'),
    ('Т', 'T'),
    ('Х', 'X'),
    ('Α', 'A'),
    ('Β', 'B'),
    ('Ε', 'E'),
    ('Ζ', 'Z'),
    ('Η', 'H'),
    ('Ι', 'I'),
    ('Κ', 'K'),
    ('Μ', 'M'),
    ('Ν', 'N'),
    ('Ο', 'O'),
    ('Ρ', 'P'),
    ('Τ', 'T'),
    ('Χ', 'X'),
    ('ο', 'o'),
];

/// The functions of other languages that are known, each with what to write for a call of it.
pub fn functions() -> impl Iterator<Item = (&'static str, String)> {
    let names = FUNCTIONS.iter().map(|(name, _)| *name);
    names.filter_map(|name| Some((name, function(name, &[])?)))
}

/// What to write for a call of a function of another language, its arguments as text.
pub fn function(name: &str, arguments: &[String]) -> Option<String> {
    let name = name.to_lowercase();
    let (_, form) = FUNCTIONS.iter().find(|(other, _)| *other == name)?;
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
    let mut written = (*form).to_owned();
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
    let found = WITHOUT.iter().find(|(names, _)| names.contains(&name));
    found.map(|(_, reason)| *reason)
}

/// Why there is no such sign.
pub fn sign(c: char) -> Option<&'static str> {
    let found = SIGNS.iter().find(|(signs, _)| signs.contains(c));
    found.map(|(_, reason)| *reason)
}

/// Whether a name is a word of programming languages.
pub fn is_word(name: &str) -> bool {
    WORDS.contains(&name)
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
    let twin = |c: char| {
        TWINS
            .iter()
            .find(|(other, _)| *other == c)
            .map_or(c, |(_, latin)| *latin)
    };
    let latin: String = name.nfkc().map(twin).collect();
    (latin != name).then_some(latin)
}
