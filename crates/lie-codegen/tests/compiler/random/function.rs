//! Functions of random shape that are smooth everywhere.

use proptest::prelude::*;

/// A function of coordinates and parameters.
#[derive(Clone, Debug)]
pub enum Function {
    Coordinate(usize),
    Parameter(usize),
    Number(i64, i64),
    Add(Box<Function>, Box<Function>),
    Subtract(Box<Function>, Box<Function>),
    Multiply(Box<Function>, Box<Function>),
    /// `a/(2 + b^2)`
    Divide(Box<Function>, Box<Function>),
    /// `atan2(a, 3 + b^2)`
    Atan2(Box<Function>, Box<Function>),
    /// `(2 + sin(a))^b`, the power with a variable exponent.
    General(Box<Function>, Box<Function>),
    /// `a^n`
    Integer(Box<Function>, i32),
    /// `(1 + a^2)^(p/q)`
    Rational(Box<Function>, i64, i64),
    Call(Call, Box<Function>),
}

/// Functions of one argument, each in a form that is smooth and of moderate size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Call {
    Sin,
    Cos,
    Tan,
    Sinh,
    Cosh,
    Tanh,
    Atan,
    Asin,
    Acos,
    Exp,
    Log,
    Sqrt,
    Cbrt,
    Log1p,
    Expm1,
    Asinh,
    Acosh,
    Atanh,
}

impl Call {
    pub const ALL: [Call; 18] = [
        Call::Sin,
        Call::Cos,
        Call::Tan,
        Call::Sinh,
        Call::Cosh,
        Call::Tanh,
        Call::Atan,
        Call::Asin,
        Call::Acos,
        Call::Exp,
        Call::Log,
        Call::Sqrt,
        Call::Cbrt,
        Call::Log1p,
        Call::Expm1,
        Call::Asinh,
        Call::Acosh,
        Call::Atanh,
    ];

    fn text(self, a: &str) -> String {
        match self {
            Call::Sin => format!("sin({a})"),
            Call::Cos => format!("cos({a})"),
            Call::Tan => format!("tan(tanh({a}))"),
            Call::Sinh => format!("sinh(tanh({a}))"),
            Call::Cosh => format!("cosh(tanh({a}))"),
            Call::Tanh => format!("tanh({a})"),
            Call::Atan => format!("atan({a})"),
            Call::Asin => format!("asin(sin({a})/2)"),
            Call::Acos => format!("acos(cos({a})/3)"),
            Call::Exp => format!("exp(sin({a}))"),
            Call::Log => format!("log(3/2 + ({a})^2)"),
            Call::Sqrt => format!("sqrt(1/2 + ({a})^2)"),
            Call::Cbrt => format!("cbrt(-1 - ({a})^2)"),
            Call::Log1p => format!("log1p(({a})^2)"),
            Call::Expm1 => format!("expm1(sin({a}))"),
            Call::Asinh => format!("asinh({a})"),
            Call::Acosh => format!("acosh(3/2 + ({a})^2)"),
            Call::Atanh => format!("atanh(sin({a})/2)"),
        }
    }
}

fn boxed(function: Function) -> Box<Function> {
    Box::new(function)
}

/// Functions of `n` coordinates `x0, …` and parameters `k0, …`.
pub fn function(n: usize, parameters: usize) -> impl Strategy<Value = Function> {
    let leaf = prop_oneof![
        6 => (0..n).prop_map(Function::Coordinate),
        2 => (0..parameters).prop_map(Function::Parameter),
        1 => (-3i64..4, 1i64..4).prop_map(|(p, q)| Function::Number(p, q)),
    ];
    leaf.prop_recursive(4, 14, 2, |inner| {
        let pair = || (inner.clone(), inner.clone()).prop_map(|(a, b)| (boxed(a), boxed(b)));
        let one = || inner.clone().prop_map(boxed);
        prop_oneof![
            2 => pair().prop_map(|(a, b)| Function::Add(a, b)),
            2 => pair().prop_map(|(a, b)| Function::Subtract(a, b)),
            4 => pair().prop_map(|(a, b)| Function::Multiply(a, b)),
            1 => pair().prop_map(|(a, b)| Function::Divide(a, b)),
            1 => pair().prop_map(|(a, b)| Function::Atan2(a, b)),
            1 => pair().prop_map(|(a, b)| Function::General(a, b)),
            2 => (one(), 2i32..4).prop_map(|(a, n)| Function::Integer(a, n)),
            1 => (one(), prop::sample::select(vec![(1, 2), (-1, 2), (3, 2), (-3, 2), (-1, 1), (1, 3), (-2, 3)]))
                .prop_map(|(a, (p, q))| Function::Rational(a, p, q)),
            3 => (prop::sample::select(Call::ALL.to_vec()), one()).prop_map(|(call, a)| Function::Call(call, a)),
        ]
    })
}

impl Function {
    /// The function in the grammar.
    pub fn text(&self) -> String {
        match self {
            Function::Coordinate(i) => format!("x{i}"),
            Function::Parameter(p) => format!("k{p}"),
            Function::Number(p, q) => format!("({p}/{q})"),
            Function::Add(a, b) => format!("({} + {})", a.text(), b.text()),
            Function::Subtract(a, b) => format!("({} - {})", a.text(), b.text()),
            Function::Multiply(a, b) => format!("{}*{}", a.text(), b.text()),
            Function::Divide(a, b) => format!("{}/(2 + ({})^2)", a.text(), b.text()),
            Function::Atan2(a, b) => format!("atan2({}, 3 + ({})^2)", a.text(), b.text()),
            Function::General(a, b) => format!("(2 + sin({}))^({})", a.text(), b.text()),
            Function::Integer(a, n) => format!("({})^{n}", a.text()),
            Function::Rational(a, p, q) => format!("(1 + ({})^2)^({p}/{q})", a.text()),
            Function::Call(call, a) => call.text(&a.text()),
        }
    }
}
