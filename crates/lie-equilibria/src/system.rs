//! A Poisson system by its expressions, and the equations of its relative equilibria.

use lie_symbolic::exact::{Precision, Rational};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};

use crate::arithmetic::{Arithmetic, Balls, Complexes, Degrees, Floats, Rationals};
use crate::tape::Tape;

/// Digits of proofs, in bits.
const BITS: u64 = 256;

/// A function with its name.
#[derive(Clone, Debug)]
pub struct Named {
    /// Its name.
    pub name: String,
    /// The function, of coordinates and parameters.
    pub value: ExprId,
}

/// A Poisson system `x' = Pi(x) grad H(x)` and a leaf of it.
#[derive(Clone, Debug)]
pub struct System {
    /// The arena of all expressions. Coordinate i is [`Symbol::Coordinate`], parameter p is [`Symbol::Parameter`].
    pub graph: Graph,
    /// Names of the n coordinates.
    pub coordinates: Vec<String>,
    /// Names of the parameters.
    pub parameters: Vec<String>,
    /// H.
    pub hamiltonian: ExprId,
    /// Independent Casimirs, as many as the generic rank of Pi is below n.
    pub casimirs: Vec<Named>,
    /// Their values on the leaf, functions of the parameters.
    pub levels: Vec<ExprId>,
    /// The entries `(i, j, Pi_ij)`, `i < j`, that are not zero.
    pub bracket: Vec<(usize, usize, ExprId)>,
    /// Whether Pi satisfies the identity of Jacobi, and there are leaves.
    pub has_leaves: bool,
    /// First integrals.
    pub integrals: Vec<Named>,
    /// A state that tells the scale, functions of the parameters.
    pub state: Vec<ExprId>,
}

/// Where the values of one evaluation of the second tape stand.
#[derive(Clone, Copy, Debug)]
pub struct Sizes {
    /// Coordinates n.
    pub n: usize,
    /// Casimirs m.
    pub m: usize,
    /// First integrals.
    pub integrals: usize,
}

/// The equations `grad H - sum_k lambda_k grad C_k = 0`, `C_k = c_k` in the n + m unknowns `y = (x, lambda)`, and what linearises the motion.
pub struct Equations {
    /// How many of what there are.
    pub sizes: Sizes,
    /// The system.
    pub system: System,
    /// The parameter along which branches are followed.
    pub(crate) varying: Option<usize>,
    /// The residual F, its derivative by y by rows, and the derivative of F by the parameter that varies.
    first: Vec<ExprId>,
    /// The values of [`Shape`].
    second: Vec<ExprId>,
    floats: Tape<Floats>,
    shape: Tape<Floats>,
    places: Tape<Floats>,
}

/// What linearises the motion at a state, over one kind of numbers.
#[derive(Clone, Debug)]
pub struct Shape<N> {
    /// H.
    pub energy: N,
    /// The Hessian of `H - sum_k lambda_k C_k`, n x n by rows.
    pub hessian: Vec<N>,
    /// The gradients of the Casimirs, m x n by rows.
    pub gradients: Vec<N>,
    /// Pi, n x n by rows.
    pub bracket: Vec<N>,
    /// The Hessians of the Casimirs, n x n by rows each.
    pub casimirs: Vec<Vec<N>>,
    /// Gradient and Hessian of each first integral.
    pub integrals: Vec<(Vec<N>, Vec<N>)>,
}

/// The residual F, its derivative by y, and that by the parameter that varies.
#[derive(Clone, Debug)]
pub struct Linear<N> {
    /// n + m values.
    pub residual: Vec<N>,
    /// (n + m) x (n + m), by rows.
    pub slope: Vec<N>,
    /// n + m values.
    pub by_parameter: Vec<N>,
}

impl Equations {
    /// The equations of a system; `varying` is the parameter along which branches are followed.
    ///
    /// # Errors
    /// What cannot be evaluated: an expression depends on something else than coordinates and parameters, or calls a function of Rust.
    pub fn new(mut system: System, varying: Option<usize>) -> Result<Self, String> {
        let (n, m) = (system.coordinates.len(), system.casimirs.len());
        let graph = &mut system.graph;
        let mut lagrange = system.hamiltonian;
        for (k, casimir) in system.casimirs.iter().enumerate() {
            let lambda = graph.symbol(Symbol::Input(k));
            let term = graph.mul(lambda, casimir.value);
            lagrange = graph.sub(lagrange, term);
        }
        let unknown = |k: usize| match k.checked_sub(n) {
            None => Symbol::Coordinate(k),
            Some(k) => Symbol::Input(k),
        };
        let gradient = |graph: &mut Graph, of: ExprId| -> Vec<ExprId> {
            (0..n)
                .map(|i| graph.derivative(of, Symbol::Coordinate(i)))
                .collect()
        };
        let hessian = |graph: &mut Graph, rows: &[ExprId]| -> Vec<ExprId> {
            let places = rows
                .iter()
                .flat_map(|row| (0..n).map(move |j| (*row, Symbol::Coordinate(j))));
            places
                .map(|(row, symbol)| graph.derivative(row, symbol))
                .collect()
        };
        let mut residual = gradient(graph, lagrange);
        let whole = hessian(graph, &residual);
        for (casimir, level) in system.casimirs.iter().zip(&system.levels) {
            residual.push(graph.sub(casimir.value, *level));
        }
        let mut slope = Vec::new();
        for row in &residual {
            slope.extend((0..n + m).map(|k| graph.derivative(*row, unknown(k))));
        }
        let zero = graph.integer(0);
        let by_parameter = residual.iter().map(|row| match varying {
            Some(p) => graph.derivative(*row, Symbol::Parameter(p)),
            None => zero,
        });
        let by_parameter: Vec<ExprId> = by_parameter.collect();
        let mut second = vec![system.hamiltonian];
        second.extend(whole);
        let mut hessians = Vec::new();
        for casimir in &system.casimirs {
            let slope = gradient(graph, casimir.value);
            hessians.extend(hessian(graph, &slope));
            second.extend(slope);
        }
        let mut bracket = vec![zero; n * n];
        for (i, j, value) in &system.bracket {
            bracket[i * n + j] = *value;
            bracket[j * n + i] = graph.neg(*value);
        }
        second.extend(bracket);
        second.extend(hessians);
        for integral in &system.integrals {
            let slope = gradient(graph, integral.value);
            let whole = hessian(graph, &slope);
            second.extend(slope);
            second.extend(whole);
        }
        let first = [residual, slope, by_parameter].concat();
        let places = [system.levels.clone(), system.state.clone()].concat();
        let sizes = Sizes {
            n,
            m,
            integrals: system.integrals.len(),
        };
        let make = |roots: &[ExprId]| {
            let own = system.graph.dependencies(roots).into_iter();
            let own = own.flat_map(|id| system.graph.own_functions(id)).next();
            if let Some(own) = own {
                return Err(format!("`{}` is a function of Rust", own.label()));
            }
            Tape::new(Floats, &system.graph, roots, |symbol| sizes.place(symbol)).ok_or_else(|| {
                "an expression depends on more than coordinates and parameters".to_owned()
            })
        };
        Ok(Self {
            floats: make(&first)?,
            shape: make(&second)?,
            places: make(&places)?,
            sizes,
            varying,
            first,
            second,
            system,
        })
    }

    /// The number of unknowns n + m.
    pub fn unknowns(&self) -> usize {
        self.sizes.n + self.sizes.m
    }

    /// F with its derivatives; `None` where something is not finite.
    pub fn linear(&self, y: &[f64], parameters: &[f64]) -> Option<Linear<f64>> {
        let values = self.floats.evaluate(&[y, parameters].concat())?;
        let finite = values.iter().all(|value| value.is_finite());
        finite.then(|| self.sizes.linear(values))
    }

    /// What linearises the motion; `None` where something is not finite.
    pub fn shape(&self, y: &[f64], parameters: &[f64]) -> Option<Shape<f64>> {
        let values = self.shape.evaluate(&[y, parameters].concat())?;
        let finite = values.iter().all(|value| value.is_finite());
        finite.then(|| self.sizes.shape(values))
    }

    /// The values of the Casimirs on the leaf and the state that tells the scale.
    pub fn leaf(&self, parameters: &[f64]) -> Option<(Vec<f64>, Vec<f64>)> {
        let unknown = vec![f64::NAN; self.unknowns()];
        let mut values = self.places.evaluate(&[&unknown, parameters].concat())?;
        let finite = values.iter().all(|value| value.is_finite());
        let state = values.split_off(self.sizes.m);
        finite.then_some((values, state))
    }

    /// F and its derivatives over the complex numbers with the degrees of F in x and in lambda, where F is a polynomial.
    pub fn polynomial(&self) -> Option<(Tape<Complexes>, [Vec<u32>; 2])> {
        let degrees = self.tape(Degrees, &self.first[..self.unknowns()])?;
        let Sizes { n, m, .. } = self.sizes;
        let of = |x: u32, lambda: u32| {
            let inputs = [
                vec![x; n],
                vec![lambda; m],
                vec![0; self.system.parameters.len()],
            ];
            degrees.evaluate(&inputs.concat())
        };
        let degrees = [of(1, 0)?, of(0, 1)?];
        Some((self.tape(Complexes, &self.first)?, degrees))
    }

    /// The tapes of proofs in rational numbers.
    pub fn rational(&self) -> Option<[Tape<Rationals>; 2]> {
        Some([
            self.tape(Rationals, &self.first)?,
            self.tape(Rationals, &self.second)?,
        ])
    }

    /// The tapes of proofs in balls.
    pub fn balls(&self) -> Option<[Tape<Balls>; 2]> {
        let balls = Balls(Precision::new(BITS));
        Some([
            self.tape(balls.clone(), &self.first)?,
            self.tape(balls, &self.second)?,
        ])
    }

    fn tape<A: Arithmetic>(&self, arithmetic: A, roots: &[ExprId]) -> Option<Tape<A>> {
        let sizes = self.sizes;
        Tape::new(arithmetic, &self.system.graph, roots, |symbol| {
            sizes.place(symbol)
        })
    }
}

impl Sizes {
    fn place(self, symbol: Symbol) -> Option<usize> {
        match symbol {
            Symbol::Coordinate(i) => (i < self.n).then_some(i),
            Symbol::Input(k) => (k < self.m).then_some(self.n + k),
            Symbol::Parameter(p) => Some(self.n + self.m + p),
            Symbol::Step | Symbol::Time => None,
        }
    }

    /// The values of the first tape, in their places.
    pub fn linear<N: Clone>(self, mut values: Vec<N>) -> Linear<N> {
        let all = self.n + self.m;
        let by_parameter = values.split_off(all + all * all);
        let slope = values.split_off(all);
        Linear {
            residual: values,
            slope,
            by_parameter,
        }
    }

    /// The values of the second tape, in their places.
    pub fn shape<N: Clone>(self, values: Vec<N>) -> Shape<N> {
        let (n, m) = (self.n, self.m);
        let mut values = values.into_iter();
        let energy = values.by_ref().take(1).collect::<Vec<N>>().remove(0);
        let mut take = |count: usize| -> Vec<N> { values.by_ref().take(count).collect() };
        Shape {
            energy,
            hessian: take(n * n),
            gradients: take(m * n),
            bracket: take(n * n),
            casimirs: (0..m).map(|_| take(n * n)).collect(),
            integrals: (0..self.integrals)
                .map(|_| (take(n), take(n * n)))
                .collect(),
        }
    }
}

/// The rational number with the fewest digits that is this one in double precision: 0.1 is 1/10.
pub fn shortest(value: f64) -> Option<Rational> {
    let text = format!("{value:e}");
    let (digits, exponent) = text.split_once('e')?;
    let (whole, part) = digits.split_once('.').unwrap_or((digits, ""));
    let number: i64 = format!("{whole}{part}").parse().ok()?;
    let exponent = exponent.parse::<i32>().ok()? - part.len() as i32;
    Some(&Rational::from(number) * &Rational::from(10).pow(exponent)?)
}
