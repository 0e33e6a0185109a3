//! Straight-line programs as Rust: quantities used once stand where they are used, the others are
//! bound to a local. The order of operations is that of the program.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use super::Printer;
use super::function::Owner;
use super::names::ident;
use crate::exact::Rational;
use crate::plan::Constant;
use crate::schedule::{Operation, Program, Value};

/// An expression with more operations than this is bound to a local even if it is used once.
const LONGEST: usize = 16;

#[derive(Clone, Copy, PartialEq, PartialOrd)]
enum Binding {
    Sum,
    Product,
    Unary,
    Atom,
}

#[derive(Clone)]
struct Text {
    tokens: TokenStream,
    binding: Binding,
    length: usize,
}

impl Printer<'_> {
    /// The statements of a program and the tokens of its results.
    pub(super) fn program<P>(
        &self,
        program: &Program<P>,
        leaf: &dyn Fn(&Value<P>) -> TokenStream,
    ) -> (TokenStream, Vec<TokenStream>) {
        let mut uses = vec![0usize; program.operations.len()];
        let mut inner = vec![false; program.operations.len()];
        for value in program.operations.iter().flat_map(Operation::operands) {
            if let Value::Temporary(i) = value {
                uses[*i] += 1;
                inner[*i] = true;
            }
        }
        for value in &program.outputs {
            if let Value::Temporary(i) = value {
                uses[*i] += 1;
            }
        }
        let mut texts: Vec<Text> = Vec::with_capacity(program.operations.len());
        let mut statements = TokenStream::new();
        let mut locals = 0;
        for (position, operation) in program.operations.iter().enumerate() {
            let mut text = {
                let mut get = |value: &Value<P>| match value {
                    Value::Temporary(i) => texts[*i].clone(),
                    other => Text {
                        tokens: leaf(other),
                        binding: Binding::Atom,
                        length: 0,
                    },
                };
                write(operation, &mut get)
            };
            if uses[position] > 1 || (inner[position] && text.length > LONGEST) {
                let name: Ident = format_ident!("_t{locals}");
                locals += 1;
                let tokens = &text.tokens;
                statements.extend(quote! { let #name = #tokens; });
                text = Text {
                    tokens: quote! { #name },
                    binding: Binding::Atom,
                    length: 0,
                };
            }
            texts.push(text);
        }
        let outputs = program
            .outputs
            .iter()
            .map(|value| match value {
                Value::Temporary(i) => texts[*i].tokens.clone(),
                other => leaf(other),
            })
            .collect();
        (statements, outputs)
    }

    /// The tokens of a value that is not a temporary.
    pub(super) fn value(&self, value: &Value<Constant>, owner: Owner<'_>) -> TokenStream {
        match value {
            Value::Symbol(symbol) => {
                let name = self.local(*symbol);
                quote! { #name }
            }
            Value::Number(number) => self::number(number),
            Value::Prepared(constant) => self.constant(*constant, owner),
            Value::Temporary(i) => {
                let name = format_ident!("_t{i}");
                quote! { #name }
            }
        }
    }
}

fn write<P>(operation: &Operation<P>, get: &mut dyn FnMut(&Value<P>) -> Text) -> Text {
    let mut infix =
        |a: &Value<P>, b: &Value<P>, sign: TokenStream, binding: Binding, right: Binding| {
            let (a, b) = (get(a), get(b));
            let length = a.length + b.length + 1;
            let (left, right) = (enclose(&a, binding), enclose(&b, right));
            Text {
                tokens: quote! { #left #sign #right },
                binding,
                length,
            }
        };
    match operation {
        Operation::Add(a, b) => infix(a, b, quote!(+), Binding::Sum, Binding::Product),
        Operation::Sub(a, b) => infix(a, b, quote!(-), Binding::Sum, Binding::Product),
        Operation::Mul(a, b) => infix(a, b, quote!(*), Binding::Product, Binding::Unary),
        Operation::Div(a, b) => infix(a, b, quote!(/), Binding::Product, Binding::Unary),
        Operation::Neg(a) => {
            let mut text = of_atom(&get(a), |inner| quote! { -#inner });
            text.binding = Binding::Unary;
            text
        }
        Operation::Sqrt(a) => of_atom(&get(a), |inner| quote! { #inner.sqrt() }),
        Operation::Power(a, exponent) => {
            let exponent = number(exponent);
            of_atom(&get(a), |inner| quote! { #inner.powf(#exponent) })
        }
        Operation::Call(function, arguments) => {
            let name = ident(function.name());
            let mut arguments = arguments.iter().map(get);
            let Some(first) = arguments.next() else {
                unreachable!("every function has an argument")
            };
            let rest: Vec<Text> = arguments.collect();
            let others = rest.iter().map(|text| &text.tokens);
            let mut text = of_atom(&first, |inner| quote! { #inner.#name(#(#others),*) });
            text.length += rest.iter().map(|text| text.length).sum::<usize>();
            text
        }
    }
}

/// What is written around an operand that binds as an atom.
fn of_atom(operand: &Text, around: impl FnOnce(TokenStream) -> TokenStream) -> Text {
    Text {
        tokens: around(enclose(operand, Binding::Atom)),
        binding: Binding::Atom,
        length: operand.length + 1,
    }
}

fn enclose(text: &Text, least: Binding) -> TokenStream {
    let tokens = &text.tokens;
    if text.binding < least {
        quote! { (#tokens) }
    } else {
        tokens.clone()
    }
}

/// An exact number as a scalar.
pub fn number(value: &Rational) -> TokenStream {
    if value.is_zero() {
        return quote! { S::zero() };
    }
    if value.is_one() {
        return quote! { S::one() };
    }
    let high = value.to_f64();
    if Rational::from_f64(high).as_ref() == Some(value) {
        let literal = float(high);
        return quote! { S::from_f64(#literal) };
    }
    const EXACT: u64 = 1 << 53;
    if let Some((n, d)) = value.to_words()
        && n.unsigned_abs() <= EXACT
        && d.unsigned_abs() <= EXACT
    {
        let (n, d) = (float(n as f64), float(d as f64));
        return quote! { S::ratio(#n, #d) };
    }
    let low = Rational::from_f64(high).map_or(0.0, |high| (value - &high).to_f64());
    let (high, low) = (float(high), float(low));
    quote! { S::constant(#high, #low) }
}

fn float(value: f64) -> TokenStream {
    if !value.is_finite() {
        return if value > 0.0 {
            quote! { f64::INFINITY }
        } else {
            quote! { f64::NEG_INFINITY }
        };
    }
    let literal = Literal::f64_unsuffixed(value.abs());
    if value < 0.0 {
        quote! { -#literal }
    } else {
        quote! { #literal }
    }
}
