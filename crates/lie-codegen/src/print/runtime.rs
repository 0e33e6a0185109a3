//! Where generated code finds the runtime.

use proc_macro2::{Group, TokenStream, TokenTree};
use syn::parse::Parser;

/// The crate of that name, which the printer writes in full wherever it is used.
const RUNTIME: &str = "lie_runtime";

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
    pub fn at(path: &str) -> Result<Self, NoPath> {
        let tokens: TokenStream = path.parse().map_err(|_| NoPath(path.to_owned()))?;
        Self::of_tokens(tokens).ok_or_else(|| NoPath(path.to_owned()))
    }

    /// The same of tokens; `None` if they are no path.
    pub(crate) fn of_tokens(path: TokenStream) -> Option<Self> {
        let parsed = syn::Path::parse_mod_style.parse2(path.clone());
        parsed.ok().map(|_| Self { path: Some(path) })
    }

    /// The tokens with every path into the runtime begun there.
    pub(crate) fn root(&self, tokens: TokenStream) -> TokenStream {
        match &self.path {
            Some(path) => rooted(tokens, path),
            None => tokens,
        }
    }
}

/// What was given as the path of the runtime, and is none.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NoPath(pub(crate) String);

impl std::fmt::Display for NoPath {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "`{}` is not the path of a crate or module", self.0)
    }
}

impl std::error::Error for NoPath {}

/// Replaces `::lie_runtime`. It is an absolute path wherever it stands, but for a visibility that the user wrote.
fn rooted(tokens: TokenStream, path: &TokenStream) -> TokenStream {
    let is_colon = |tree: &TokenTree| matches!(tree, TokenTree::Punct(p) if p.as_char() == ':');
    let is = |tree: &TokenTree, word: &str| matches!(tree, TokenTree::Ident(i) if i == word);
    let mut out: Vec<TokenTree> = Vec::new();
    for tree in tokens {
        let before = out.last();
        match tree {
            TokenTree::Group(group) if !before.is_some_and(|tree| is(tree, "pub")) => {
                let mut inner = Group::new(group.delimiter(), rooted(group.stream(), path));
                inner.set_span(group.span());
                out.push(inner.into());
            }
            tree if is(&tree, RUNTIME)
                && out.iter().rev().take(2).filter(|t| is_colon(t)).count() == 2 =>
            {
                out.truncate(out.len() - 2);
                out.extend(path.clone());
            }
            tree => out.push(tree),
        }
    }
    out.into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use quote::quote;

    #[test]
    fn absolute_paths_begin_at_the_runtime() {
        let tokens = quote! {
            pub(in a::lie_runtime) struct T<S: ::lie_runtime::Scalar>(::lie_runtime::X<S>);
            impl ::lie_runtime::Y for lie_runtime { fn f() { ::core::g(<::lie_runtime::Z>::h()) } }
        };
        let unchanged = Runtime::default().root(tokens.clone());
        assert_eq!(unchanged.to_string(), tokens.to_string());
        let rooted = Runtime::at("crate::deep::rt").unwrap().root(tokens);
        let expected = quote! {
            pub(in a::lie_runtime) struct T<S: crate::deep::rt::Scalar>(crate::deep::rt::X<S>);
            impl crate::deep::rt::Y for lie_runtime { fn f() { ::core::g(<crate::deep::rt::Z>::h()) } }
        };
        assert_eq!(rooted.to_string(), expected.to_string());
    }

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
            assert!(Runtime::at(path).is_ok(), "{path}");
        }
        for path in [
            "", "a::", "a.b", "a::<u8>", "a b", "1", "\"a\"", "a::(b)", "(", "a-b", "dyn",
        ] {
            let found = Runtime::at(path).unwrap_err().to_string();
            assert!(found.contains(&format!("`{path}`")), "{found}");
        }
    }
}
