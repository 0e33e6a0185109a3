//! Where generated code finds the runtime.

use proc_macro2::{Group, TokenStream, TokenTree};

use lie_syntax::ast::Runtime;

/// The crate of that name, which the printer writes in full wherever it is used.
const RUNTIME: &str = "lie_runtime";

/// The tokens with every path into the runtime begun where it is found.
pub fn rooted(tokens: TokenStream, runtime: &Runtime) -> TokenStream {
    match runtime.path() {
        Some(path) => begun(tokens, path),
        None => tokens,
    }
}

/// Replaces `::lie_runtime`. It is an absolute path wherever it stands, but for a visibility that the user wrote.
fn begun(tokens: TokenStream, path: &TokenStream) -> TokenStream {
    let is_colon = |tree: &TokenTree| matches!(tree, TokenTree::Punct(p) if p.as_char() == ':');
    let is = |tree: &TokenTree, word: &str| matches!(tree, TokenTree::Ident(i) if i == word);
    let mut out: Vec<TokenTree> = Vec::new();
    for tree in tokens {
        let before = out.last();
        match tree {
            TokenTree::Group(group) if !before.is_some_and(|tree| is(tree, "pub")) => {
                let mut inner = Group::new(group.delimiter(), begun(group.stream(), path));
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
        let unchanged = rooted(tokens.clone(), &Runtime::default());
        assert_eq!(unchanged.to_string(), tokens.to_string());
        let found = rooted(tokens, &Runtime::parse("crate::deep::rt").unwrap());
        let expected = quote! {
            pub(in a::lie_runtime) struct T<S: crate::deep::rt::Scalar>(crate::deep::rt::X<S>);
            impl crate::deep::rt::Y for lie_runtime { fn f() { ::core::g(<crate::deep::rt::Z>::h()) } }
        };
        assert_eq!(found.to_string(), expected.to_string());
    }
}
