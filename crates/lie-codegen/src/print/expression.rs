//! Straight-line programs as Rust: quantities used once stand where they are used, the others are
//! bound to a local. The order of operations is that of the program.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use super::Printer;
use super::function::Owner;
use super::names::{ident, index};
use crate::plan::Constant;
use lie_symbolic::exact::Rational;
use lie_symbolic::schedule::{Operation, Program, Value};
use lie_symbolic::symbolic::Function;

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
    pub(super) fn program<P: Clone + PartialEq>(
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
        let mut families = Families::of(program);
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
                match families.member(operation, &mut get) {
                    Some((tokens, declared)) => {
                        statements.extend(declared);
                        texts.push(Text {
                            tokens,
                            binding: Binding::Atom,
                            length: 0,
                        });
                        continue;
                    }
                    None => match operation {
                        Operation::Call(Function::Own(own), arguments) => {
                            let arguments: Vec<Text> = arguments.iter().map(get).collect();
                            let tokens = arguments.iter().map(|text| text.tokens.clone());
                            Text {
                                tokens: self.own_function(*own, &tokens.collect::<Vec<_>>()),
                                binding: Binding::Atom,
                                length: 1 + arguments.iter().map(|text| text.length).sum::<usize>(),
                            }
                        }
                        _ => write(operation, &mut get),
                    },
                }
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

/// Functions of closed forms that have the same argument, which are computed together.
struct Families<P>(Vec<Family<P>>);

struct Family<P> {
    argument: Value<P>,
    of_stumpff: bool,
    first: u8,
    last: u8,
    written: bool,
}

/// The family and the index of a function of closed forms, with its argument.
fn of_closed_form<P>(operation: &Operation<P>) -> Option<(bool, u8, &Value<P>)> {
    match operation {
        Operation::Call(Function::Stumpff(k), arguments) => Some((true, *k, &arguments[0])),
        Operation::Call(Function::Phi(k), arguments) => Some((false, *k, &arguments[0])),
        _ => None,
    }
}

impl<P: Clone + PartialEq> Families<P> {
    fn of(program: &Program<P>) -> Self {
        let mut families = Self(Vec::new());
        for (of_stumpff, k, argument) in program.operations.iter().filter_map(of_closed_form) {
            match families.position(of_stumpff, argument) {
                Some(position) => {
                    let family = &mut families.0[position];
                    (family.first, family.last) = (family.first.min(k), family.last.max(k));
                }
                None => families.0.push(Family {
                    argument: argument.clone(),
                    of_stumpff,
                    first: k,
                    last: k,
                    written: false,
                }),
            }
        }
        families
    }

    fn position(&self, of_stumpff: bool, argument: &Value<P>) -> Option<usize> {
        let mut families = self.0.iter();
        families.position(|f| f.of_stumpff == of_stumpff && f.argument == *argument)
    }

    /// The name of a member, and the statement that computes its family if it is the first one.
    fn member(
        &mut self,
        operation: &Operation<P>,
        get: &mut dyn FnMut(&Value<P>) -> Text,
    ) -> Option<(TokenStream, Option<TokenStream>)> {
        let (of_stumpff, k, argument) = of_closed_form(operation)?;
        let position = self.position(of_stumpff, argument)?;
        let family = &mut self.0[position];
        let name = |k: u8| format_ident!("_f{position}_{k}");
        let declared = (!std::mem::replace(&mut family.written, true)).then(|| {
            let function = ident(if of_stumpff { "stumpff" } else { "phi" });
            let names = (family.first..=family.last).map(name);
            let first = index(family.first.into());
            let count = index(usize::from(family.last - family.first) + 1);
            let argument = get(argument).tokens;
            quote! { let [#(#names),*] = ::lie_runtime::closed::#function::<S, #first, #count>(#argument); }
        });
        let name = name(k);
        Some((quote! { #name }, declared))
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
        Operation::Call(Function::Below, arguments) => choice(arguments, get),
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

/// Both branches are computed, and one is taken: in every lane its own.
fn choice<P>(arguments: &[Value<P>], get: &mut dyn FnMut(&Value<P>) -> Text) -> Text {
    let texts: Vec<Text> = arguments.iter().map(get).collect();
    let [condition, a, b] = texts.as_slice() else {
        unreachable!("a choice has a condition and two branches")
    };
    let length = texts.iter().map(|text| text.length).sum::<usize>() + 1;
    let (condition, a, b) = (enclose(condition, Binding::Atom), &a.tokens, &b.tokens);
    Text {
        tokens: quote! { S::select(#condition.less(S::zero()), #a, #b) },
        binding: Binding::Atom,
        length,
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
