//! The slopes of the elementary functions, as expressions.

use lie_core::functions::{Curve, Elementary, Quadratic, Rules, Words};

use super::graph::{ExprId, Graph};
use crate::exact::Rational;

fn two() -> Rational {
    Rational::from(2)
}

fn half(numerator: i64) -> Rational {
    Rational::new(numerator, 2).unwrap_or(Rational::ONE)
}

impl Words for Graph {
    type Value = ExprId;

    fn integer(&mut self, value: i32) -> ExprId {
        Graph::integer(self, value.into())
    }
    fn negate(&mut self, a: &ExprId) -> ExprId {
        self.neg(*a)
    }
    fn multiply(&mut self, a: &ExprId, b: &ExprId) -> ExprId {
        self.mul(*a, *b)
    }
    fn divide(&mut self, a: &ExprId, b: &ExprId) -> ExprId {
        self.div(*a, *b)
    }
    fn root(&mut self, a: &ExprId) -> ExprId {
        self.pow(*a, &half(1))
    }
    fn quadratic(&mut self, form: Quadratic, x: &ExprId) -> ExprId {
        let (one, square) = (Graph::integer(self, 1), self.pow(*x, &two()));
        match form {
            Quadratic::Argument => *x,
            Quadratic::OnePlus => self.add(one, *x),
            Quadratic::OnePlusSquare => self.add(one, square),
            Quadratic::OneMinusSquare => self.sub(one, square),
            Quadratic::SquareMinusOne => self.sub(square, one),
        }
    }
    fn apply(&mut self, function: Elementary, x: &ExprId) -> ExprId {
        self.call(function, &[*x])
    }
}

/// The slope of a function of an expression.
pub struct Slope<'a> {
    graph: &'a mut Graph,
    x: ExprId,
    value: ExprId,
}

impl<'a> Slope<'a> {
    /// That of a function of x with its value.
    pub fn new(graph: &'a mut Graph, x: ExprId, value: ExprId) -> Self {
        // terms stand in the order in which they were first made
        graph.quadratic(Quadratic::Argument, &x);
        Self { graph, x, value }
    }
}

impl Rules for Slope<'_> {
    type Words = Graph;
    type Answer = ExprId;

    fn integral(self, slope: impl FnOnce(&mut Graph, &ExprId) -> ExprId) -> ExprId {
        slope(self.graph, &self.x)
    }
    fn exponential(self) -> ExprId {
        self.value
    }
    fn tangent(self, curve: Curve) -> ExprId {
        let form = match curve {
            Curve::Circle => Quadratic::OnePlusSquare,
            Curve::Hyperbola => Quadratic::OneMinusSquare,
        };
        self.graph.quadratic(form, &self.value)
    }
    fn cube_root(self) -> ExprId {
        let inverse = self.graph.pow(self.value, &Rational::from(-2));
        let third = Rational::new(1, 3).unwrap_or(Rational::ONE);
        self.graph.linear(&[(inverse, third)])
    }
    fn inverse(self, w: Quadratic) -> ExprId {
        let w = self.graph.quadratic(w, &self.x);
        self.graph.pow(w, &Rational::MINUS_ONE)
    }
    fn inverse_root(self, sign: i32, w: Quadratic) -> ExprId {
        let w = self.graph.quadratic(w, &self.x);
        let power = self.graph.pow(w, &half(-1));
        if sign < 0 {
            self.graph.neg(power)
        } else {
            power
        }
    }
}
