//! Discrete Lagrangians in the entries of the group element.
//!
//! The names `g_ab` stand for `delta_ab + D_ab`, and the entries of `D = g - 1` are symbols of their own, those from
//! [`ENTRIES`] on. With the combination `X = sum_a x_a rho_a` of the declared matrices in Cayley coordinates x they are those of
//! `g = (1 - X/2)^-1 (1 + X/2)`:
//!
//! ```math
//! (1 - X/2)\, D = X, \qquad D = X + X^2/2 + X^3/4 + \dots
//! ```
//!
//! Of a left-invariant system g is `g_k^-1 g_(k+1)`. Of a right-invariant one it is `f = g_(k+1) g_k^-1`, in the same
//! coordinates: the elements `q_k = g_k^-1` move by `q_k^-1 q_(k+1) = f^-1` as those of the left-invariant system whose basis has the
//! matrices `-rho_a`, where `f^-1 = cay(-X)` has the coordinates x.

use super::configuration;
use super::environment::Environment;
use crate::algebra::Representation;
use crate::algebra::cayley::{CayleyMap, combination};
use crate::model::configuration::entries_of;
use crate::model::{ENTRIES, InEntries};
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use lie_syntax::ast::{Declaration, Invariance};
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin};

/// Products in the second derivative: one of 43,000 takes seven seconds.
const MOST_PRODUCTS: usize = 100_000;

/// Whether the entries of the group element can stand in the discrete Lagrangian.
///
/// A group element without matrices, and names that its entries take, are reported.
pub fn are_sound(declaration: &Declaration, mistakes: &mut Vec<Diagnostic>) -> Option<()> {
    let origin = declaration.group.as_ref()?.origin;
    let configuration = configuration::configuration(declaration, mistakes)?;
    configuration.group.as_ref()?;
    let entries = configuration.entries();
    mistakes.extend(configuration::clashes(declaration, &entries, origin));
    Some(())
}

/// The names of the entries that may stand in the discrete Lagrangian of a declaration.
pub fn names(declaration: &Declaration) -> Vec<String> {
    let group = declaration.group.as_ref();
    let group = group.filter(|_| declaration.energy.has_step());
    let matrices = declaration.algebra().map(|algebra| &algebra.matrices[..]);
    let first = matrices.and_then(<[_]>::first);
    let named = group.zip(first);
    named.map_or_else(Vec::new, |(group, first)| {
        entries_of(&group.text, first.rows.len())
    })
}

/// Gives the names of entries their meaning.
pub fn bind<'a>(names: &'a [String], graph: &mut Graph, environment: &mut Environment<'a>) {
    let size = names.len().isqrt();
    for (place, name) in names.iter().enumerate() {
        let off = graph.symbol(Symbol::Input(ENTRIES + place));
        let unit = graph.integer(i64::from(place / size == place % size));
        let entry = graph.add(off, unit);
        environment.bind_value(name, entry);
    }
}

/// The mistake of a function whose second derivative in Cayley coordinates is too large.
///
/// The chain rule has for each pair of coordinates a product for each entry in which the function is not linear, and for each pair of
/// entries of two matrices of the basis two of them.
pub fn too_large(graph: &mut Graph, written: &InEntries, origin: Origin) -> Option<Diagnostic> {
    let used = graph.symbols(written.value).into_iter();
    let used: Vec<Symbol> = used
        .filter(|symbol| matches!(symbol, Symbol::Input(i) if *i >= ENTRIES))
        .collect();
    let bent = used.into_iter().filter(|entry| {
        let slope = graph.derivative(written.value, *entry);
        let mut symbols = graph.symbols(slope).into_iter();
        symbols.any(|symbol| matches!(symbol, Symbol::Input(_)))
    });
    let bent = bent.count();
    let filled = written.basis.iter().map(|matrix| {
        let entries = matrix.iter().flatten();
        entries.filter(|entry| !entry.is_zero()).count()
    });
    let (count, filled) = (written.basis.len(), filled.sum::<usize>());
    let products = count * (count + 1) / 2 * bent + filled * filled + 3 * written.size.pow(3);
    (products > MOST_PRODUCTS).then(|| {
        let message = format!(
            "the second derivative of the discrete Lagrangian has about {products} products, more than {MOST_PRODUCTS}"
        );
        Diagnostic::new(Kind::Limit, origin, message)
            .help("choose a smaller representation, or a Lagrangian that is linear in most entries")
    })
}

/// A lowered function of the entries; none where the algebra has no matrices.
pub fn in_entries(
    declaration: &Declaration,
    representation: Option<&Representation>,
    value: ExprId,
) -> Option<InEntries> {
    let group = declaration.group.as_ref()?.text.clone();
    let representation = representation?;
    let mut basis = representation.matrices.clone();
    // that of the system is of the opposite algebra
    if declaration.invariance == Invariance::Right {
        for entry in basis.iter_mut().flatten().flatten() {
            *entry = -&*entry;
        }
    }
    Some(InEntries {
        value,
        size: representation.dimension,
        basis,
        group,
    })
}

impl InEntries {
    /// The matrix X.
    pub fn combination(&self, graph: &mut Graph) -> Vec<ExprId> {
        let x = (0..self.basis.len()).map(|a| graph.symbol(Symbol::Input(a)));
        let x: Vec<ExprId> = x.collect();
        combination(graph, &self.basis, &x, self.size)
    }

    /// The function of the coordinates x.
    pub fn of_coordinates(&self, graph: &mut Graph) -> ExprId {
        let combined = self.combination(graph);
        let off = CayleyMap::new(graph, &self.basis, &combined, self.size).off;
        let entry = |symbol| match symbol {
            Symbol::Input(i) => i.checked_sub(ENTRIES).and_then(|k| off.get(k).copied()),
            _ => None,
        };
        graph.substitute(&[self.value], &entry)[0]
    }

    /// The coefficients of `h, h^2, ...` in the series of each entry of D where x stands for `h xi`: `X^k/2^(k-1)`.
    pub fn series(&self, graph: &mut Graph, terms: usize) -> Vec<Vec<ExprId>> {
        let combined = self.combination(graph);
        let mut power = combined.clone();
        let mut factor = Rational::ONE;
        let mut series = vec![Vec::with_capacity(terms); power.len()];
        for k in 0..terms {
            if k > 0 {
                power = crate::algebra::moving::product(graph, &power, &combined, self.size);
                factor = &factor / &Rational::from(2);
            }
            for (entry, value) in series.iter_mut().zip(&power) {
                entry.push(graph.scale(*value, &factor));
            }
        }
        series
    }
}
