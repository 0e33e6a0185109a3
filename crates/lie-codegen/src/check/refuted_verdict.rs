//! Verdicts of the prover that numbers refute.

use lie_symbolic::prove::contradiction;
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin};

/// A verdict that numbers refute.
pub fn refuted_verdict(origin: Origin) -> Option<Diagnostic> {
    let text = contradiction::take()?;
    let message = format!(
        "the compiler contradicts itself: values at a point refute what it has proven about `{text}`"
    );
    let help = "this is a bug in the compiler, not in the declaration; please report it with the declaration";
    Some(Diagnostic::new(Kind::Limit, origin, message).help(help))
}
