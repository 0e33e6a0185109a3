//! The places of Rust files where one operator, comparison, sign or constant can be another one: a line of JSON for each.
//!
//! Left out are tests, what the compiler computes (constants, types, patterns), and what macros are given.

use proc_macro2::Span;
use serde_json::json;
use syn::spanned::Spanned as _;
use syn::visit::{self, Visit};
use syn::{BinOp, Expr, Lit, UnOp};

fn main() {
    for file in std::env::args().skip(1) {
        let text = std::fs::read_to_string(&file).expect("a file");
        let parsed = syn::parse_file(&text).expect("Rust");
        Sites {
            file: &file,
            text: &text,
        }
        .visit_file(&parsed);
    }
}

struct Sites<'a> {
    file: &'a str,
    text: &'a str,
}

impl Sites<'_> {
    /// The expression at a span is another one.
    fn say(&self, whole: Span, place: Span, other: &str) {
        let range = whole.byte_range();
        let site = json!({
            "file": self.file, "line": place.start().line, "start": range.start, "end": range.end, "old": &self.text[range], "new": other,
        });
        println!("{site}");
    }
}

fn other(op: &BinOp) -> Option<&'static str> {
    Some(match op {
        BinOp::Add(_) => "-",
        BinOp::Sub(_) => "+",
        BinOp::Mul(_) => "/",
        BinOp::Div(_) => "*",
        BinOp::And(_) => "||",
        BinOp::Or(_) => "&&",
        BinOp::Eq(_) => "!=",
        BinOp::Ne(_) => "==",
        BinOp::Lt(_) => "<=",
        BinOp::Le(_) => "<",
        BinOp::Gt(_) => ">=",
        BinOp::Ge(_) => ">",
        BinOp::AddAssign(_) => "-=",
        BinOp::SubAssign(_) => "+=",
        BinOp::MulAssign(_) => "/=",
        BinOp::DivAssign(_) => "*=",
        _ => return None,
    })
}

/// Whether a condition binds names, which have to be seen behind it.
fn binds(expr: &Expr) -> bool {
    match expr {
        Expr::Let(_) => true,
        Expr::Binary(binary) => binds(&binary.left) || binds(&binary.right),
        _ => false,
    }
}

fn is_test(attributes: &[syn::Attribute]) -> bool {
    attributes.iter().any(|attribute| match &attribute.meta {
        syn::Meta::Path(path) => path.is_ident("test"),
        syn::Meta::List(list) => {
            list.path.is_ident("cfg") && list.tokens.to_string().contains("test")
        }
        syn::Meta::NameValue(_) => false,
    })
}

impl Visit<'_> for Sites<'_> {
    fn visit_expr_binary(&mut self, binary: &syn::ExprBinary) {
        let whole = binary.left.span().byte_range().start..binary.right.span().byte_range().end;
        if let Some(new) = other(&binary.op)
            && !binds(&binary.left)
            && !binds(&binary.right)
        {
            let op = binary.op.span().byte_range();
            let changed = format!(
                "{}{new}{}",
                &self.text[whole.start..op.start],
                &self.text[op.end..whole.end]
            );
            self.say(binary.span(), binary.op.span(), &changed);
        }
        visit::visit_expr_binary(self, binary);
    }

    fn visit_expr_unary(&mut self, unary: &syn::ExprUnary) {
        if matches!(unary.op, UnOp::Neg(_) | UnOp::Not(_)) {
            self.say(
                unary.span(),
                unary.op.span(),
                &self.text[unary.expr.span().byte_range()],
            );
        }
        visit::visit_expr_unary(self, unary);
    }

    fn visit_expr_lit(&mut self, literal: &syn::ExprLit) {
        let text = &self.text[literal.lit.span().byte_range()];
        let changed = match &literal.lit {
            Lit::Int(_) => format!("{text} + 1"),
            Lit::Float(float) if float.base10_parse::<f64>().is_ok_and(|value| value == 0.0) => {
                text.replacen("0.0", "1.0", 1)
            }
            Lit::Float(_) => format!("{text} * 1.01"),
            Lit::Bool(value) => (!value.value).to_string(),
            _ => return,
        };
        self.say(literal.span(), literal.span(), &changed);
    }

    fn visit_expr_repeat(&mut self, repeat: &syn::ExprRepeat) {
        self.visit_expr(&repeat.expr);
    }

    fn visit_item_fn(&mut self, function: &syn::ItemFn) {
        if function.sig.constness.is_none() && !is_test(&function.attrs) {
            visit::visit_item_fn(self, function);
        }
    }

    fn visit_impl_item_fn(&mut self, function: &syn::ImplItemFn) {
        if function.sig.constness.is_none() && !is_test(&function.attrs) {
            visit::visit_impl_item_fn(self, function);
        }
    }

    fn visit_item_mod(&mut self, module: &syn::ItemMod) {
        if !is_test(&module.attrs) {
            visit::visit_item_mod(self, module);
        }
    }

    fn visit_attribute(&mut self, _: &syn::Attribute) {}
    fn visit_expr_const(&mut self, _: &syn::ExprConst) {}
    fn visit_generic_argument(&mut self, _: &syn::GenericArgument) {}
    fn visit_impl_item_const(&mut self, _: &syn::ImplItemConst) {}
    fn visit_item_const(&mut self, _: &syn::ItemConst) {}
    fn visit_item_enum(&mut self, _: &syn::ItemEnum) {}
    fn visit_item_static(&mut self, _: &syn::ItemStatic) {}
    fn visit_pat(&mut self, _: &syn::Pat) {}
    fn visit_trait_item_const(&mut self, _: &syn::TraitItemConst) {}
    fn visit_type(&mut self, _: &syn::Type) {}
}
