//! The macro: a declaration as tokens becomes items; a broken one becomes its errors and a stub.

use std::path::{Path, PathBuf};

use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::{format_ident, quote};

use crate::compile::{compile_declaration, declared_choices};
use crate::plan::plan;
use crate::print::{Surface, name_version, print, rooted};
use crate::structure::Structure;
use lie_syntax::ast::Name;
use lie_syntax::characters::visible;
use lie_syntax::diagnostic::{
    Diagnostic, Kind, MOST_SHOWN, Origin, Report, forget_spans, not_shown,
};
use lie_syntax::front::{Body, Parsed, declaration, file, line_column, spec};

/// What `lie_poisson! { input }` expands to; `manifest` is the folder that spec paths start from.
pub fn expand_macro(input: TokenStream, manifest: &Path) -> TokenStream {
    forget_spans();
    let mut report = Report::new();
    let parsed = declaration::parse(input, &mut report);
    if let Err(diagnostics) = report.gate() {
        return failure(&parsed, &diagnostics);
    }
    match &parsed.body {
        Some(Body::Declaration(declaration)) => match compile_declaration(declaration) {
            Ok(structure) => generated(&structure, &parsed),
            Err(diagnostics) => failure(&parsed, &diagnostics),
        },
        Some(Body::Spec { path }) => expand_spec(&parsed, path, manifest),
        None => failure(&parsed, &report.into_diagnostics()),
    }
}

/// The items of a system with the methods that it declares.
fn generated(structure: &Structure, parsed: &Parsed) -> TokenStream {
    let surface = Surface::new(structure).as_declared(parsed);
    print(&plan(structure, &declared_choices(structure)), &surface)
}

/// A spec by path. The file is included as a constant, so that editing it rebuilds the crate.
fn expand_spec(parsed: &Parsed, path: &Name, manifest: &Path) -> TokenStream {
    let place: PathBuf = manifest.join(&path.text);
    let read = file::read(&place);
    if let Some(mut oversized) = read.as_ref().ok().and_then(|b| file::oversized(b.len())) {
        oversized.origin = Some(path.origin);
        return failure(parsed, &[oversized]);
    }
    let read = read.and_then(|bytes| {
        String::from_utf8(bytes).map_err(|error| std::io::Error::other(error.utf8_error()))
    });
    let text = match read {
        Ok(text) => text,
        Err(error) => {
            let message = format!("cannot read the spec `{}`: {error}", path.text);
            let diagnostic = Diagnostic::new(Kind::Io, path.origin, message)
                .help("the path is relative to the folder of the crate's Cargo.toml");
            return failure(parsed, &[diagnostic]);
        }
    };
    // cargo looks at these again: the spec, and the files that it names
    let folder = Path::new(&path.text).parent().unwrap_or(Path::new(""));
    let named = spec::files(&text).into_iter().map(|file| folder.join(file));
    let there = named.filter(|file| manifest.join(file).is_file());
    let tracked = there.filter_map(|file| file.to_str().map(str::to_owned));
    let tracked = [path.text.clone()].into_iter().chain(tracked);
    let track: TokenStream = tracked
        .map(|written| {
            quote! {
                const _: &[::core::primitive::u8] = ::core::include_bytes!(
                    ::core::concat!(::core::env!("CARGO_MANIFEST_DIR"), "/", #written)
                );
            }
        })
        .collect();
    let mut report = Report::new();
    let mut read = spec::read_in(&text, place.parent(), &mut report);
    read.visibility = parsed.visibility.clone();
    read.runtime = parsed.runtime.clone();
    match compile_read(&read, report) {
        Ok(structure) => {
            let items = generated(&structure, parsed);
            quote! { #items #track }
        }
        Err(diagnostics) => {
            let placed = diagnostics
                .into_iter()
                .map(|diagnostic| at_path(diagnostic, path, &text));
            // What was read stands in, so that those who use it hear of nothing else.
            if let Some(name) = &mut read.name {
                name.origin = path.origin;
            }
            let errors = failure(&read, &placed.collect::<Vec<_>>());
            quote! { #errors #track }
        }
    }
}

/// Checks what was read, if nothing was wrong with it.
fn compile_read(read: &Parsed, mut report: Report) -> Result<Structure, Vec<Diagnostic>> {
    report.gate()?;
    match &read.body {
        Some(Body::Declaration(declaration)) => compile_declaration(declaration),
        _ => Err(report.into_diagnostics()),
    }
}

/// A mistake of a spec file, shown at its path in the macro.
fn at_path(mut diagnostic: Diagnostic, path: &Name, text: &str) -> Diagnostic {
    if let Some(Origin::Text { start, .. }) = diagnostic.origin {
        let (line, column) = line_column(text, start);
        let written = &path.text;
        diagnostic.message = format!("{written}:{line}:{column}: {}", diagnostic.message);
    }
    diagnostic.origin = Some(path.origin);
    diagnostic
}

/// The errors, each at its token, and a stub of the type so that nothing that uses it cascades.
fn failure(parsed: &Parsed, diagnostics: &[Diagnostic]) -> TokenStream {
    let errors = diagnostics.iter().filter(|d| !d.warning);
    let rest = not_shown(errors.clone().count())
        .map(|text| syn::Error::new(Span::call_site(), text).into_compile_error());
    let errors = errors.take(MOST_SHOWN).map(|diagnostic| {
        let mut message = format!("[{}] {}", diagnostic.kind, diagnostic.message);
        if let Some(help) = &diagnostic.help {
            message.push_str(&format!("\nhelp: {help}"));
        }
        let span = match diagnostic.origin {
            Some(Origin::Span(id)) => id.span(),
            _ => Span::call_site(),
        };
        syn::Error::new(span, visible(&message)).into_compile_error()
    });
    let stub = parsed.name.as_ref().map(|name| stub(parsed, name));
    let stub = stub.map(|stub| rooted(stub, &parsed.runtime));
    quote! { #(#errors)* #rest #stub }
}

/// The types of a declaration without its content; none of it runs, since the crate fails to build.
fn stub(parsed: &Parsed, name: &Name) -> TokenStream {
    let identifier = |name: &Name| match name.origin {
        Origin::Span(id) => syn::parse_str::<Ident>(&name.text).ok().map(|mut ident| {
            ident.set_span(id.span());
            ident
        }),
        Origin::Text { .. } => syn::parse_str::<Ident>(&name.text).ok(),
    };
    let Some(ident) = identifier(name) else {
        return TokenStream::new();
    };
    let visibility = &parsed.visibility;
    let system = format_ident!("{ident}System");
    let mut seen = std::collections::BTreeSet::new();
    let parameters: Vec<Ident> = parsed
        .parameters
        .iter()
        .filter(|p| seen.insert(p.text.clone()))
        .filter_map(identifier)
        .collect();
    let n = Literal::usize_unsuffixed(parsed.dimension);
    let vector = quote! { ::lie_runtime::__private::SVector<S, #n> };
    let traits = stub_of_traits(&system, &n, &vector);
    name_version(quote! {
        #[allow(non_snake_case)]
        #[derive(Clone, Debug, PartialEq)]
        #visibility struct #ident<S = f64> { #(pub #parameters: S,)* #[doc(hidden)] pub _scalar: ::core::marker::PhantomData<S> }
        impl<S: ::lie_runtime::Scalar> ::core::default::Default for #ident<S> {
            fn default() -> Self { Self { #(#parameters: S::zero(),)* _scalar: ::core::marker::PhantomData } }
        }
        impl #ident<f64> { pub fn new() -> Self { ::core::default::Default::default() } }
        impl<S: ::lie_runtime::Scalar> #ident<S> {
            pub fn system(&self) -> ::core::result::Result<#system<S>, ::lie_runtime::ParameterError> {
                ::core::result::Result::Ok(#system { _scalar: ::core::marker::PhantomData })
            }
            pub fn initial_state(&self) -> #vector { <#vector>::repeat(S::zero()) }
            pub fn initial_attitude(&self) -> &'static [S] { &[] }
        }
        #[derive(Clone, Debug, PartialEq)]
        #visibility struct #system<S = f64> { _scalar: ::core::marker::PhantomData<S> }
        #traits
    })
}

/// Every trait that generated code may implement.
fn stub_of_traits(system: &Ident, n: &Literal, vector: &TokenStream) -> TokenStream {
    quote! {
        impl<S: ::lie_runtime::Scalar> ::lie_runtime::Poisson<S> for #system<S> {
            type State = #vector;
            type Jacobian = ::lie_runtime::__private::SMatrix<S, #n, #n>;
            fn dimension(&self) -> usize { #n }
            fn name(&self) -> &str { "" }
            fn coordinate(&self, _index: usize) -> &str { "" }
            fn zero_state(&self) -> Self::State { Self::State::repeat(S::zero()) }
            fn zero_jacobian(&self) -> Self::Jacobian { Self::Jacobian::repeat(S::zero()) }
            fn hamiltonian(&self, _mu: &Self::State) -> S { S::zero() }
            fn gradient(&self, _mu: &Self::State, _out: &mut Self::State) {}
            fn hessian(&self, _mu: &Self::State, _out: &mut Self::Jacobian) {}
            fn poisson_matrix(&self, _mu: &Self::State, _out: &mut Self::Jacobian) {}
            fn jacobian(&self, _mu: &Self::State, _out: &mut Self::Jacobian) {}
            fn casimirs(&self, _mu: &Self::State, _out: &mut [S]) {}
            fn casimir_gradient(&self, _index: usize, _mu: &Self::State, _out: &mut Self::State) {}
        }
        impl<S: ::lie_runtime::Scalar> ::lie_runtime::LiePoisson<S> for #system<S> {
            fn ad(&self, _xi: &Self::State, _eta: &Self::State, _out: &mut Self::State) {}
            fn ad_star(&self, _xi: &Self::State, _mu: &Self::State, _out: &mut Self::State) {}
            fn ad_star_matrix(&self, _xi: &Self::State, _out: &mut Self::Jacobian) {}
        }
        impl<S: ::lie_runtime::Scalar> ::lie_runtime::CayleyPoisson<S> for #system<S> {
            fn triple(&self, _x: &Self::State, _z: &Self::State, _mu: &Self::State, _out: &mut Self::State) {}
        }
        impl<S: ::lie_runtime::Scalar> ::lie_runtime::LagrangianPoisson<S> for #system<S> {
            fn lagrangian(&self, _xi: &Self::State) -> S { S::zero() }
            fn momentum(&self, _xi: &Self::State, _out: &mut Self::State) {}
            fn inertia(&self, _xi: &Self::State, _out: &mut Self::Jacobian) {}
        }
        impl<S: ::lie_runtime::Scalar> ::lie_runtime::DiscreteLagrangianPoisson<S> for #system<S> {
            fn discrete_lagrangian(&self, _h: S, _x: &Self::State) -> S { S::zero() }
            fn discrete_slope(&self, _h: S, _x: &Self::State, _out: &mut Self::State) {}
            fn discrete_curvature(&self, _h: S, _x: &Self::State, _out: &mut Self::Jacobian) {}
        }
        impl<S: ::lie_runtime::Scalar> ::lie_runtime::Lift<S> for #system<S> {
            type Lifted = #system<::lie_runtime::Dual<S>>;
            fn lift(&self) -> Self::Lifted { #system { _scalar: ::core::marker::PhantomData } }
        }
        impl<S: ::lie_runtime::Scalar> ::lie_runtime::Widen<S> for #system<S> {
            type Widened = #system<S::Wide>;
            fn widen(&self) -> Self::Widened { #system { _scalar: ::core::marker::PhantomData } }
        }
        // whatever the method is
        impl<S: ::lie_runtime::Scalar, M> ::lie_runtime::Implicit<S, M> for #system<S> {
            type Equation<'a> = ::lie_runtime::generic::Midpoint<'a, S, Self> where Self: 'a;
            fn equation<'a>(&'a self, _method: &M, h: S) -> Self::Equation<'a> {
                ::lie_runtime::generic::Midpoint::new(self, h)
            }
        }
        ::lie_runtime::generic_equations!([S: ::lie_runtime::Scalar] #system<S>, S: splitting);
    }
}
