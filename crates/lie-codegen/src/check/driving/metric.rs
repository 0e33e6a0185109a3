//! What the matrices of a dissipation promise.

use crate::model::{Family, Input, data_number, shared_number};
use lie_core::lattice::{AXES, count};
use lie_symbolic::exact::Budget;
use lie_symbolic::prove::proof::{Proof, Prover};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin};

/// Work allowed for what is proven of one dissipation.
const WORK: u64 = 4_000_000;
/// Of larger metrics the minors are not written out.
const MOST_MINORS: usize = 6;
/// Eigenvalues that are negative by less, of the largest entry, are rounding.
const ROUNDING: f64 = 1e-15;

/// A matrix of expressions by rows.
pub type Rows = Vec<Vec<ExprId>>;

/// Checks of one dissipation.
pub struct Checks<'a> {
    /// Where it stands.
    pub origin: Origin,
    /// How many coordinates were declared.
    pub own: usize,
    /// The defaults of the parameters.
    pub defaults: &'a [f64],
    /// The family, and its inputs.
    pub sites: Option<(&'a Family, &'a [Input])>,
    /// The names of symbols.
    pub name: &'a dyn Fn(Symbol) -> String,
}

impl Checks<'_> {
    fn mistake(&self, message: impl Into<String>, help: &str) -> Diagnostic {
        Diagnostic::new(Kind::Dissipation, self.origin, message).help(help)
    }

    /// Whether a matrix has a row and a column for each declared coordinate.
    pub fn shape(&self, what: &str, rows: &Rows) -> Option<Diagnostic> {
        let n = self.own;
        (rows.len() != n || rows.iter().any(|row| row.len() != n)).then(|| {
            let columns = rows.first().map_or(0, Vec::len);
            let ragged = rows.iter().position(|row| row.len() != columns);
            if let Some(place) = ragged {
                let message = format!(
                    "row {} of {what} has {} entries, the first one {columns}",
                    place + 1,
                    rows[place].len()
                );
                return self.mistake(
                    message,
                    "write a row and a column for every coordinate of the state",
                );
            }
            let message = format!(
                "{what} has {} rows of {columns}, but there are {n} coordinates",
                rows.len()
            );
            self.mistake(
                message,
                "write a row and a column for every coordinate of the state",
            )
        })
    }

    /// Whether a strength is not negative, at the default parameters.
    pub fn strength(&self, graph: &Graph, strength: ExprId) -> Option<Diagnostic> {
        let value = self.least(graph, strength);
        (value < 0.0 || value.is_nan()).then(|| {
            let message =
                format!("the strength is {value} at the default parameters: H would grow");
            self.mistake(
                message,
                "a double bracket damps; write a strength that is not negative",
            )
        })
    }

    /// Whether a temperature is not negative, at the default parameters.
    pub fn temperature(&self, graph: &Graph, temperature: ExprId) -> Option<Diagnostic> {
        let value = self.value(graph, temperature);
        (value < 0.0 || value.is_nan()).then(|| {
            let message = format!("the temperature is {value} at the default parameters");
            self.mistake(message, "write a temperature that is not negative")
        })
    }

    /// Whether a matrix is symmetric, identically.
    pub fn symmetric(&self, graph: &mut Graph, what: &str, rows: &Rows) -> Option<Diagnostic> {
        if let Some(mistake) = self.shape(what, rows) {
            return Some(mistake);
        }
        let n = self.own;
        let pairs = (0..n).flat_map(|i| (0..i).map(move |j| (i, j)));
        let pairs: Vec<_> = pairs
            .map(|(i, j)| (i, j, graph.sub(rows[i][j], rows[j][i])))
            .collect();
        let budget = Budget::new(WORK);
        let mut prover = Prover::new(graph, &budget, &[], self.name);
        let unequal = pairs
            .into_iter()
            .find(|(.., difference)| !prover.vanishes(*difference));
        unequal.map(|(i, j, _)| {
            let message = format!(
                "{what} is not symmetric: rows {} and {} differ",
                j + 1,
                i + 1
            );
            self.mistake(
                message,
                "write the same entry in row i, column j and in row j, column i",
            )
        })
    }

    /// Whether `<w, M w>` is negative for no w, at the default parameters.
    pub fn damps(&self, graph: &Graph, what: &str, rows: &Rows) -> Option<Diagnostic> {
        if let Some(mistake) = self.shape(what, rows) {
            return Some(mistake);
        }
        let n = self.own;
        let value = |i: usize, j: usize| self.value(graph, rows[i][j]);
        let symmetric = |i: usize, j: usize| 0.5 * (value(i, j) + value(j, i));
        let mut entries: Vec<Vec<f64>> = (0..n)
            .map(|i| (0..n).map(|j| symmetric(i, j)).collect())
            .collect();
        let largest = entries
            .iter()
            .flatten()
            .fold(0.0f64, |most, x| most.max(x.abs()));
        let rounding = ROUNDING * largest;
        // L D L^T with the largest pivot first
        let mut left: Vec<usize> = (0..n).collect();
        while !left.is_empty() {
            let at = |k: &usize| entries[*k][*k];
            let place = (0..left.len()).max_by(|a, b| at(&left[*a]).total_cmp(&at(&left[*b])));
            let pivot = left.swap_remove(place.unwrap_or(0));
            let d = entries[pivot][pivot];
            let rest = left
                .iter()
                .any(|i| entries[*i][pivot].abs() > rounding.sqrt() * largest.sqrt());
            if d < -rounding || d.is_nan() || (d <= rounding && rest) {
                let message = format!(
                    "{what} has a negative eigenvalue at the default parameters: H would grow"
                );
                return Some(
                    self.mistake(message, "write a matrix M with <w, M w> >= 0 for every w"),
                );
            }
            if d <= rounding {
                continue;
            }
            for &i in &left {
                for &j in &left {
                    let change = entries[i][pivot] * entries[pivot][j] / d;
                    entries[i][j] -= change;
                }
            }
        }
        None
    }

    /// `K = L L^T` of a factor with a row for each declared coordinate.
    ///
    /// # Errors
    /// A factor of another shape.
    pub fn square(&self, graph: &mut Graph, factor: &Rows) -> Result<Rows, Diagnostic> {
        let width = factor.first().map_or(0, Vec::len);
        if factor.len() != self.own || width == 0 || factor.iter().any(|row| row.len() != width) {
            let message = format!(
                "the factor L has {} rows, but there are {} coordinates",
                factor.len(),
                self.own
            );
            return Err(self.mistake(
                message,
                "write a row for every coordinate, all of the same length",
            ));
        }
        let entry = |graph: &mut Graph, a: &[ExprId], b: &[ExprId]| {
            let products: Vec<ExprId> = a.iter().zip(b).map(|(a, b)| graph.mul(*a, *b)).collect();
            graph.sum(&products)
        };
        let rows = factor.iter();
        Ok(rows
            .map(|a| factor.iter().map(|b| entry(graph, a, b)).collect())
            .collect())
    }

    /// Whether a metric K is symmetric and nowhere negative, `K grad H = 0` and `{S, H} = 0`.
    ///
    /// # Errors
    /// What does not hold, or is not proven.
    pub fn metriplectic(
        &self,
        graph: &mut Graph,
        rows: &Rows,
        factor: bool,
        degenerate: &[ExprId],
        bracket: ExprId,
    ) -> Result<(), Diagnostic> {
        let budget = Budget::new(WORK);
        let domain: Vec<ExprId> = rows.iter().flatten().copied().collect();
        let mut prover = Prover::new(graph, &budget, &domain, self.name);
        let shown = |proof: Proof| match proof {
            Proof::Zero => None,
            Proof::Nonzero(text) => Some(format!(" = {text}")),
            Proof::Unproven { values, .. } => {
                Some(format!(" could not be shown to be zero, {values}"))
            }
        };
        if let Some(rest) = shown(prover.examine(bracket)) {
            let message = format!(
                "the entropy is no first integral of the Hamiltonian motion: {{S, H}}{rest}"
            );
            return Err(self.mistake(
                message,
                "choose a Casimir, or another function S with {S, H} = 0",
            ));
        }
        for (i, component) in degenerate.iter().enumerate() {
            if let Some(rest) = shown(prover.examine(*component)) {
                let coordinate = (self.name)(Symbol::Coordinate(i));
                let message = format!(
                    "the metric does not keep H: the component of K grad H along `{coordinate}`{rest}"
                );
                let help = "K grad H must be zero, as of |grad H|^2 - grad H grad H^T; with a factor L, L^T grad H = 0";
                return Err(self.mistake(message, help));
            }
        }
        if factor {
            return Ok(());
        }
        if let Some(mistake) = self.symmetric(graph, "the metric K", rows) {
            return Err(mistake);
        }
        if self.own > MOST_MINORS {
            let message = format!(
                "a metric of {} rows is not proven to have no negative eigenvalue",
                self.own
            );
            let help = "give a factor L with K = L L^T by `factor`: it needs no proof";
            return Err(self.mistake(message, help));
        }
        let minors: Vec<ExprId> = (1u32..1 << self.own)
            .map(|set| minor(graph, rows, set))
            .collect();
        let budget = Budget::new(WORK);
        let mut prover = Prover::new(graph, &budget, &domain, self.name);
        match minors.into_iter().all(|minor| prover.is_nonnegative(minor)) {
            true => Ok(()),
            false => Err(self.mistake(
                "it could not be shown that the metric K has no negative eigenvalue",
                "declare as positive the parameters that are, `{\"value\": 2, \"positive\": true}`, or give a factor L with \
                 K = L L^T by `factor`, which needs no proof",
            )),
        }
    }

    /// The columns of L and the entries of D of a symmetric matrix `L D L^T`, of the unit matrix where there is none. Columns whose pivot is
    /// zero, at the default parameters, are zero.
    pub fn factors(&self, graph: &mut Graph, rows: Option<&Rows>) -> (Rows, Vec<ExprId>) {
        let n = self.own;
        let (zero, one) = (graph.integer(0), graph.integer(1));
        let mut columns = vec![vec![zero; n]; n];
        let mut pivots = vec![one; n];
        for j in 0..n {
            columns[j][j] = one;
            let Some(rows) = rows else { continue };
            let rest = |graph: &mut Graph, i: usize, columns: &Rows, pivots: &[ExprId]| {
                let mut sum = rows[i][j];
                for k in 0..j {
                    let product = graph.product(&[columns[k][i], columns[k][j], pivots[k]]);
                    sum = graph.sub(sum, product);
                }
                sum
            };
            pivots[j] = rest(graph, j, &columns, &pivots);
            let is_zero = self.value(graph, pivots[j]).abs() <= ROUNDING;
            if is_zero {
                (columns[j][j], pivots[j]) = (zero, zero);
                continue;
            }
            for i in j + 1..n {
                let sum = rest(graph, i, &columns, &pivots);
                columns[j][i] = graph.div(sum, pivots[j]);
            }
        }
        (columns, pivots)
    }

    /// Whether the field of every Hamiltonian has no divergence, as on unimodular algebras.
    pub fn unimodular(&self, graph: &Graph, divergence: &[ExprId]) -> Option<Diagnostic> {
        let budget = Budget::new(WORK);
        let mut prover = Prover::new(graph, &budget, &[], self.name);
        let vanish = divergence.iter().all(|part| prover.vanishes(*part));
        (!vanish).then(|| {
            let message = "a Rayleigh dissipation has no noise that leaves exp(-H/T) invariant here: the algebra is not unimodular";
            self.mistake(message, "use a double bracket with its temperature, or declare `noise` by itself")
        })
    }

    /// The smallest value over all sites, at time 0 and with inputs that nobody sets; no number where there is none at some site.
    fn least(&self, graph: &Graph, expression: ExprId) -> f64 {
        let Some((family, inputs)) = self.sites else {
            return self.value(graph, expression);
        };
        let shared = |number: usize| match number.checked_sub(1) {
            Some(input) => inputs[input].default,
            None => 0.0,
        };
        let sizes = family.sites(self.defaults).unwrap_or([1; AXES]);
        let differs = |symbol: &Symbol| data_number(*symbol).is_some();
        let sites = match graph.symbols(expression).iter().any(differs) {
            true => count(sizes),
            false => 1,
        };
        let at = |place: usize| {
            graph.evaluate(expression, &|symbol| match symbol {
                Symbol::Parameter(k) => self.defaults[k],
                other => match shared_number(other) {
                    Some(number) => shared(number),
                    None => family.value_at(other, place, sizes).unwrap_or(f64::NAN),
                },
            })
        };
        let least = |least: f64, value: f64| match least.is_nan() || value >= least {
            true => least,
            false => value,
        };
        (0..sites).map(at).fold(f64::INFINITY, least)
    }

    fn value(&self, graph: &Graph, expression: ExprId) -> f64 {
        graph.evaluate(expression, &|symbol| match symbol {
            Symbol::Parameter(k) => self.defaults[k],
            _ => f64::NAN,
        })
    }
}

/// The determinant of the rows and columns in a set: all of these are not negative where a symmetric matrix has no negative eigenvalue.
fn minor(graph: &mut Graph, rows: &Rows, set: u32) -> ExprId {
    let places: Vec<usize> = (0..rows.len()).filter(|k| set >> k & 1 == 1).collect();
    determinant(graph, rows, &places, &places)
}

fn determinant(graph: &mut Graph, rows: &Rows, down: &[usize], across: &[usize]) -> ExprId {
    let Some((&first, rest)) = down.split_first() else {
        return graph.integer(1);
    };
    let mut terms = Vec::new();
    for (place, &column) in across.iter().enumerate() {
        let others: Vec<usize> = across.iter().copied().filter(|c| *c != column).collect();
        let inner = determinant(graph, rows, rest, &others);
        let term = graph.mul(rows[first][column], inner);
        terms.push(if place % 2 == 0 {
            term
        } else {
            graph.neg(term)
        });
    }
    graph.sum(&terms)
}
