//! Diagnostics: what is wrong, where, and what to do about it.

use std::cell::RefCell;
use std::fmt;

use proc_macro2::Span;

use crate::characters::excerpt;

/// The longest message and the longest remedy in characters; of more nobody would read the end. What
/// a message quotes should be much shorter: [`LONGEST_QUOTE`].
const LONGEST_TEXT: usize = 1000;
/// The longest expression that a message quotes, in characters.
pub const LONGEST_QUOTE: usize = 400;
/// How many mistakes are shown: whoever has more mends these first.
pub const MOST_SHOWN: usize = 50;
/// How many mistakes, and how many warnings, are kept at all.
const MOST_KEPT: usize = 1000;

/// What is said in place of the mistakes that are not shown, of `count` in all.
pub fn not_shown(count: usize) -> Option<String> {
    let rest = count.checked_sub(MOST_SHOWN).filter(|rest| *rest > 0)?;
    let at_least = if count >= MOST_KEPT { "at least " } else { "" };
    let (noun, verb) = if rest == 1 {
        ("message", "is")
    } else {
        ("messages", "are")
    };
    Some(format!(
        "{at_least}{rest} more {noun} {verb} not shown; fix these first"
    ))
}

/// The word for so many things.
pub fn plural(count: usize, word: &str) -> String {
    if count == 1 {
        word.to_string()
    } else {
        format!("{word}s")
    }
}

thread_local! {
    static SPANS: RefCell<Vec<Span>> = const { RefCell::new(Vec::new()) };
}

/// A span by its number among those that this thread has met. A span itself cannot leave its thread, nor be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SpanId(usize);

impl SpanId {
    fn new(span: Span) -> Self {
        SPANS.with_borrow_mut(|spans| {
            spans.push(span);
            Self(spans.len() - 1)
        })
    }

    /// The span, on the thread that has met it.
    pub fn span(self) -> Span {
        let known = SPANS.with_borrow(|spans| spans.get(self.0).copied());
        known.unwrap_or_else(Span::call_site)
    }
}

/// Forgets the spans of an earlier invocation.
pub fn forget_spans() {
    SPANS.take();
}

/// The place of a token: a span of the macro input, or a byte range of the spec file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Origin {
    /// A token of a macro invocation.
    Span(SpanId),
    /// A byte range of a spec file, or of an expression given on the command line.
    Text {
        /// First byte.
        start: usize,
        /// One past the last byte.
        end: usize,
    },
}

impl Origin {
    /// The place of a span.
    pub fn from_span(span: Span) -> Self {
        Self::Span(SpanId::new(span))
    }

    /// Its span, or that of the invocation.
    pub fn span(self) -> Span {
        match self {
            Self::Span(id) => id.span(),
            Self::Text { .. } => Span::call_site(),
        }
    }

    /// The smallest place that covers both.
    pub fn join(self, end: Origin) -> Origin {
        match (self, end) {
            (Origin::Text { start, .. }, Origin::Text { end, .. }) if start <= end => {
                Origin::Text { start, end }
            }
            (Origin::Span(a), Origin::Span(b)) => {
                let (a, b) = (a.span(), b.span());
                Origin::from_span(a.join(b).unwrap_or(a))
            }
            (start, _) => start,
        }
    }
}

macro_rules! kinds {
    ($($name:ident $text:literal $doc:literal),+ $(,)?) => {
        /// The kind of a mistake, as it stands in `error[KIND]`.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum Kind { $(#[doc = $doc] $name),+ }
        impl Kind {
            /// Every kind.
            pub const ALL: &'static [Kind] = &[$(Kind::$name),+];
            /// The kind as it is printed.
            pub fn as_str(self) -> &'static str {
                match self { $(Kind::$name => $text),+ }
            }
            /// What it is said of, in a sentence.
            pub fn meaning(self) -> &'static str {
                match self { $(Kind::$name => $doc),+ }
            }
        }
    };
}
kinds! {
    Syntax "syntax" "Malformed expression or declaration.",
    Schema "schema" "Malformed JSON, unknown or repeated key, wrong type of a value.",
    Number "number" "Malformed constant, or a constant divided by zero.",
    UnknownSymbol "unknown-symbol" "A name that is not declared.",
    UnknownFunction "unknown-function" "A function that the grammar does not have.",
    Arity "arity" "Wrong number of arguments.",
    DuplicateName "duplicate-name" "A name declared twice in one name space.",
    ReservedName "reserved-name" "A name that the language keeps for itself.",
    Basis "basis" "Empty basis; unknown or repeated basis name in `matrices`.",
    Antisymmetry "antisymmetry" "`[a, a]` is not zero, or `[b, a]` disagrees with `[a, b]`.",
    DuplicateBracket "duplicate-bracket" "The same pair twice, with different values.",
    Jacobi "jacobi" "The Jacobi identity fails.",
    Representation "representation" "The matrices do not represent the brackets.",
    Casimir "casimir" "A declared Casimir is not a Casimir, or cannot be proven to be one.",
    Integral "integral" "A declared first integral is none, or cannot be proven to be one.",
    Event "event" "An event that can have no zeros, or no direction.",
    Cocycle "cocycle" "The cocycle identity fails.",
    Constraint "constraint" "Constraints are not linear, depend on each other, or leave the motion open; the initial state violates one.",
    StateLength "state-length" "Length of the state or the initial values differs from the basis.",
    EmptyHamiltonian "empty-hamiltonian" "The text of the Hamiltonian is blank.",
    Domain "domain" "The Hamiltonian, its gradient or a Casimir is not finite at the initial state.",
    Method "method" "The method does not apply to the system, or is not built yet.",
    Legendre "legendre" "The Legendre transform fails.",
    Splitting "splitting" "The Hamiltonian cannot be split in this way.",
    Dissipation "dissipation" "A dissipation that is malformed, or lacks what it promises.",
    Input "input" "Values of an input that cannot be used.",
    Option "option" "Bad or missing option.",
    Io "io" "A file cannot be read or written.",
    Toolchain "toolchain" "cargo is missing or failed.",
    Checkpoint "checkpoint" "A checkpoint does not fit.",
    Limit "limit" "A size limit is exceeded, or what the compiler can be trusted with.",
    Unused "unused" "Only a warning: a parameter or an abbreviation that nothing uses.",
    Smoothness "smoothness" "Only a warning: the Hamiltonian or its gradient jumps where branches meet.",
    Motionless "motionless" "Only a warning: all brackets are zero, or the Hamiltonian is constant.",
}
impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

/// One mistake (or warning) with its place and its remedy.
#[derive(Clone, Debug)]
pub struct Diagnostic {
    /// Kind of the mistake.
    pub kind: Kind,
    /// What is wrong, and why, in the words of the field.
    pub message: String,
    /// Where; `None` only where there is no token to point at.
    pub origin: Option<Origin>,
    /// What to do.
    pub help: Option<String>,
    /// Whether it only warns.
    pub warning: bool,
}

impl Diagnostic {
    /// An error at a place.
    pub fn new(kind: Kind, origin: Origin, message: impl Into<String>) -> Self {
        Self {
            origin: Some(origin),
            ..Self::placeless(kind, message)
        }
    }

    /// An error without a place in the text.
    pub fn placeless(kind: Kind, message: impl Into<String>) -> Self {
        Self {
            kind,
            message: excerpt(&message.into(), LONGEST_TEXT).into_owned(),
            origin: None,
            help: None,
            warning: false,
        }
    }

    /// Adds the remedy.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(excerpt(&help.into(), LONGEST_TEXT).into_owned());
        self
    }

    /// Turns the error into a warning.
    #[must_use]
    pub fn warning(mut self) -> Self {
        self.warning = true;
        self
    }
}

/// Collects the diagnostics of the stages; a stage runs on what the earlier ones left standing.
///
/// It keeps the first thousand mistakes: a file of garbage has one for every few bytes. Whoever makes a
/// report asks it in the end, by [`gate`](Self::gate), [`into_diagnostics`](Self::into_diagnostics) or
/// [`ignore`](Self::ignore). One that is dropped before panics, even where it is empty: so any test on that
/// path finds where mistakes get lost.
#[derive(Debug, Default)]
#[must_use = "mistakes get lost in a report that nobody asks"]
pub struct Report {
    diagnostics: Vec<Diagnostic>,
    errors: usize,
    /// Whether it was asked since the last mistake.
    asked: bool,
}

impl Drop for Report {
    fn drop(&mut self) {
        if !self.asked && !std::thread::panicking() {
            let found = &self.diagnostics;
            panic!("a report was dropped before anybody asked it; it holds {found:?}");
        }
    }
}

impl Report {
    /// An empty report.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a diagnostic.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        self.asked = false;
        let warnings = self.diagnostics.len() - self.errors;
        let kept = if diagnostic.warning {
            warnings
        } else {
            self.errors
        };
        if kept < MOST_KEPT {
            self.errors += usize::from(!diagnostic.warning);
            self.diagnostics.push(diagnostic);
        }
    }

    /// The value that a check found, or `None` and its mistakes in the report.
    pub fn accept<T>(&mut self, found: Result<T, Vec<Diagnostic>>) -> Option<T> {
        found.map_err(|mistakes| self.extend(mistakes)).ok()
    }

    /// Whether any error (not only warnings) was reported.
    pub fn has_errors(&self) -> bool {
        self.errors > 0
    }

    /// The gate behind a stage: everything reported so far if there is an error.
    ///
    /// # Errors
    /// All diagnostics, in the order in which they were found.
    pub fn gate(&mut self) -> Result<(), Vec<Diagnostic>> {
        self.asked = true;
        if !self.has_errors() {
            return Ok(());
        }
        self.errors = 0;
        Err(std::mem::take(&mut self.diagnostics))
    }

    /// All diagnostics.
    pub fn into_diagnostics(mut self) -> Vec<Diagnostic> {
        self.asked = true;
        std::mem::take(&mut self.diagnostics)
    }

    /// Drops what was reported; the reason says to the reader of the call why nobody has to hear it.
    pub fn ignore(mut self, _reason: &'static str) {
        self.asked = true;
    }
}

impl Extend<Diagnostic> for Report {
    fn extend<T: IntoIterator<Item = Diagnostic>>(&mut self, diagnostics: T) {
        diagnostics.into_iter().for_each(|d| self.push(d));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_and_numbers_of_messages_are_bounded() {
        let long =
            Diagnostic::placeless(Kind::Syntax, "x".repeat(1 << 20)).help("y".repeat(1 << 20));
        assert!(long.message.len() < 2 * LONGEST_TEXT);
        assert!(long.message.contains("characters left out"));
        assert!(long.help.is_some_and(|help| help.len() < 2 * LONGEST_TEXT));
        let mut report = Report::new();
        for _ in 0..5000 {
            report.push(Diagnostic::placeless(Kind::Unused, "idle").warning());
        }
        assert!(!report.has_errors());
        report.push(Diagnostic::placeless(Kind::Syntax, "wrong"));
        assert!(report.has_errors(), "warnings crowd no error out");
        let kept = report.gate().unwrap_err();
        assert_eq!(kept.len(), MOST_KEPT + 1);
        assert!(!report.has_errors(), "what was taken is gone");
        assert!(report.into_diagnostics().is_empty());
        assert_eq!(not_shown(MOST_SHOWN), None);
        assert_eq!(
            not_shown(MOST_SHOWN + 1).as_deref(),
            Some("1 more message is not shown; fix these first")
        );
        assert!(not_shown(MOST_KEPT).is_some_and(|text| text.starts_with("at least 950 more")));
    }

    /// Whether a report panics when it is dropped after this was done to it.
    fn forgotten(last: impl FnOnce(Report) + std::panic::UnwindSafe) -> bool {
        std::panic::catch_unwind(|| last(Report::new())).is_err()
    }

    #[test]
    fn a_report_that_nobody_asks_panics() {
        let wrong = || Diagnostic::placeless(Kind::Syntax, "wrong");
        assert!(forgotten(drop));
        assert!(forgotten(|mut report| report.push(wrong())));
        assert!(forgotten(|report| assert!(!report.has_errors())));
        assert!(!forgotten(|mut report| assert!(report.gate().is_ok())));
        assert!(!forgotten(|report| report.ignore("nothing is in it")));
        assert!(!forgotten(|report| drop(report.into_diagnostics())));
        assert!(!forgotten(|mut report| {
            report.push(wrong());
            assert!(report.gate().is_err());
        }));
        assert!(
            forgotten(|mut report| {
                assert!(report.gate().is_ok());
                report.push(wrong());
            }),
            "what is reported behind the gate is asked for again"
        );
    }
}
