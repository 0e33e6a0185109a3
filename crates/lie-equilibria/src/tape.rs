//! Expressions as a list of operations, for many evaluations.

use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{ExprId, Function, Graph, Node, Symbol};

use crate::arithmetic::Arithmetic;

/// One operation; places are those of earlier ones.
enum Operation<N> {
    Given(usize),
    Constant(N),
    Pi,
    Sum(N, Vec<(usize, N)>),
    Product(Vec<(usize, Rational)>),
    Call(Function, Vec<usize>),
}

/// Expressions over one kind of numbers.
pub struct Tape<A: Arithmetic> {
    arithmetic: A,
    operations: Vec<Operation<A::Number>>,
    outputs: Vec<usize>,
}

impl<A: Arithmetic> Tape<A> {
    /// The tape of expressions; `input` says which of the inputs a symbol is. `None` if it is none of them.
    pub fn new(
        arithmetic: A,
        graph: &Graph,
        roots: &[ExprId],
        input: impl Fn(Symbol) -> Option<usize>,
    ) -> Option<Self> {
        let nodes = graph.dependencies(roots);
        let mut places = vec![usize::MAX; nodes.iter().map(|id| id.index() + 1).max().unwrap_or(0)];
        let mut operations = Vec::with_capacity(nodes.len());
        for id in nodes {
            let terms = |terms: &[(ExprId, Rational)]| {
                let terms = terms.iter();
                terms
                    .map(|(term, c)| (places[term.index()], arithmetic.rational(c)))
                    .collect()
            };
            let operation = match graph.node(id) {
                Node::Number(value) => Operation::Constant(arithmetic.rational(value)),
                Node::Pi => Operation::Pi,
                Node::Symbol(symbol) => Operation::Given(input(*symbol)?),
                Node::Sum {
                    constant,
                    terms: all,
                } => Operation::Sum(arithmetic.rational(constant), terms(all)),
                Node::Written(all) => {
                    Operation::Sum(arithmetic.rational(&Rational::ZERO), terms(all))
                }
                Node::Product(factors) => {
                    let factors = factors.iter();
                    let factors = factors.map(|(base, e)| (places[base.index()], e.clone()));
                    Operation::Product(factors.collect())
                }
                Node::Call(function, arguments) => {
                    let arguments = arguments.iter().map(|id| places[id.index()]);
                    Operation::Call(*function, arguments.collect())
                }
            };
            places[id.index()] = operations.len();
            operations.push(operation);
        }
        let outputs = roots.iter().map(|root| places[root.index()]).collect();
        Some(Self {
            arithmetic,
            operations,
            outputs,
        })
    }

    /// The numbers that it computes with.
    pub fn arithmetic(&self) -> &A {
        &self.arithmetic
    }

    /// The values of the expressions; `None` where one has none.
    pub fn evaluate(&self, inputs: &[A::Number]) -> Option<Vec<A::Number>> {
        let arithmetic = &self.arithmetic;
        let mut values: Vec<A::Number> = Vec::with_capacity(self.operations.len());
        for operation in &self.operations {
            let value = match operation {
                Operation::Given(place) => inputs[*place].clone(),
                Operation::Constant(value) => value.clone(),
                Operation::Pi => arithmetic.pi()?,
                Operation::Sum(constant, terms) => {
                    terms.iter().fold(constant.clone(), |sum, (place, c)| {
                        arithmetic.add(&sum, &arithmetic.mul(c, &values[*place]))
                    })
                }
                Operation::Product(factors) => {
                    let mut product: Option<A::Number> = None;
                    for (place, exponent) in factors {
                        let power = match exponent.is_one() {
                            true => values[*place].clone(),
                            false => arithmetic.power(&values[*place], exponent)?,
                        };
                        product = Some(match product {
                            None => power,
                            Some(product) => arithmetic.mul(&product, &power),
                        });
                    }
                    product.unwrap_or_else(|| arithmetic.rational(&Rational::ONE))
                }
                Operation::Call(function, arguments) => {
                    let arguments = arguments.iter().map(|place| values[*place].clone());
                    arithmetic.call(*function, &arguments.collect::<Vec<_>>())?
                }
            };
            values.push(value);
        }
        let outputs = self.outputs.iter();
        Some(outputs.map(|place| values[*place].clone()).collect())
    }
}
