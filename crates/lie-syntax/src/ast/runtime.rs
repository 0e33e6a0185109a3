//! Where the crate of a user finds the runtime.

use proc_macro2::TokenStream;
use syn::parse::Parser;

/// The path of the runtime in the crate of its user: `::lie_runtime`, or where another crate re-exports it.
#[derive(Clone, Debug, Default)]
pub struct Runtime {
    /// The other path.
    path: Option<TokenStream>,
}

impl Runtime {
    /// The runtime at a path such as `my_crate::lie_runtime`.
    ///
    /// # Errors
    /// What is no path of a module: names, joined by `::`.
    pub fn parse(path: &str) -> Result<Self, NoPath> {
        let tokens: TokenStream = path.parse().map_err(|_| NoPath(path.to_owned()))?;
        Self::from_tokens(tokens).ok_or_else(|| NoPath(path.to_owned()))
    }

    /// The same of tokens; `None` if they are no path.
    pub fn from_tokens(path: TokenStream) -> Option<Self> {
        let parsed = syn::Path::parse_mod_style.parse2(path.clone());
        parsed.ok().map(|_| Self { path: Some(path) })
    }

    /// The tokens of the path, where it is another one.
    pub fn path(&self) -> Option<&TokenStream> {
        self.path.as_ref()
    }
}

/// What was given as the path of the runtime, and is none.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NoPath(pub String);

impl std::fmt::Display for NoPath {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "`{}` is not the path of a crate or module", self.0)
    }
}

impl std::error::Error for NoPath {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_is_names_and_colons() {
        for path in [
            "a",
            "::a",
            "crate::a",
            "self::a::b",
            "super::super::a",
            "r#type::a",
        ] {
            assert!(Runtime::parse(path).is_ok(), "{path}");
        }
        for path in [
            "", "a::", "a.b", "a::<u8>", "a b", "1", "\"a\"", "a::(b)", "(", "a-b", "dyn",
        ] {
            let found = Runtime::parse(path).unwrap_err().to_string();
            assert!(found.contains(&format!("`{path}`")), "{found}");
        }
    }
}
