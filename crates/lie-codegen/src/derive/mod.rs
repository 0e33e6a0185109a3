//! From a checked system to the kernels that its traits need, as expressions.

mod canonical;
mod cayley;
mod coadjoint;
mod discrete_gradient;
mod entries;
mod exponential;
mod field;
mod found;
mod generating;
mod kernel;
mod lagrangian;
mod leaner;
mod lifts;
mod poisson;
mod realization;
mod recurrence;
mod retraction;
mod second_kind;
mod shears;
mod source;
mod splitting;
mod tape;
pub mod trace;
mod traced;

pub(crate) use discrete_gradient::Closed;
pub use found::{FoundKernel, PartKernel};
pub use generating::{Function, Generating};
pub(crate) use generating::{Slope, slope, symmetric};
pub use kernel::{Argument, Kernel, Shape};
pub(crate) use leaner::{Derived, leaner_jacobian};
pub use lifts::Points;
pub use realization::Realization;
pub use recurrence::{Quantity, Recurrences, recurrences};
pub(crate) use second_kind::moved;
pub use source::{Bracket, Source};
pub(crate) use splitting::{Definitions, action};
pub use splitting::{PieceKernel, Update};
pub(crate) use tape::{Tangents, Tape};

use crate::model::Acting;
use lie_symbolic::symbolic::{ExprId, Symbol};

/// Vector arguments of kernels besides the state; each has n symbols.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Block {
    /// An element of the algebra, or a multiple of `h grad H`.
    Xi,
    /// A second element of the algebra.
    Eta,
    /// The unknown of an equation.
    Unknown,
    /// The sum of the two ends of a step.
    Middle,
    /// The difference of the two ends of a step.
    Difference,
    /// The difference divided by its length.
    Direction,
    /// What the runtime computes with comparisons, as the inverse of that length.
    Given,
    /// Its first symbol: the correction of a gradient along the direction.
    Correction,
    /// How that correction depends on the end of the step.
    Tilt,
}

impl Block {
    /// The number of blocks.
    pub(crate) const COUNT: usize = Self::Tilt as usize + 1;
}

impl Source {
    pub(crate) fn coordinates(&mut self) -> Vec<ExprId> {
        (0..self.dimension)
            .map(|i| self.graph.symbol(Symbol::Coordinate(i)))
            .collect()
    }

    pub(crate) fn symbols(&self, block: Block) -> Vec<Symbol> {
        let start = block as usize * self.dimension;
        (start..start + self.dimension).map(Symbol::Input).collect()
    }

    pub(crate) fn block(&mut self, block: Block) -> Vec<ExprId> {
        self.symbols(block)
            .into_iter()
            .map(|s| self.graph.symbol(s))
            .collect()
    }

    /// Both halves of the structure constants: `(i, j, k, C_ij^k)` for all i, j.
    pub(crate) fn all_constants(&mut self) -> Vec<(usize, usize, usize, ExprId)> {
        let mut all = Vec::with_capacity(2 * self.constants().len());
        for (i, j, k, value) in self.constants().to_vec() {
            let negative = self.graph.neg(value);
            all.push((i, j, k, value));
            all.push((j, i, k, negative));
        }
        all
    }

    /// `(ad*_xi mu)_j = C_ij^k xi^i mu_k`
    pub(crate) fn ad_star_of(&mut self, xi: &[ExprId], mu: &[ExprId]) -> Vec<ExprId> {
        let mut terms: Vec<Vec<ExprId>> = vec![Vec::new(); self.dimension];
        for (i, j, k, value) in self.all_constants() {
            let term = self.graph.product(&[value, xi[i], mu[k]]);
            terms[j].push(term);
        }
        terms
            .into_iter()
            .map(|terms| self.graph.sum(&terms))
            .collect()
    }

    /// The bracket: `[xi, eta]^k = C_ij^k xi^i eta^j`
    pub(crate) fn ad_of(&mut self, xi: &[ExprId], eta: &[ExprId]) -> Vec<ExprId> {
        let mut terms: Vec<Vec<ExprId>> = vec![Vec::new(); self.dimension];
        for (i, j, k, value) in self.all_constants() {
            let term = self.graph.product(&[value, xi[i], eta[j]]);
            terms[k].push(term);
        }
        terms
            .into_iter()
            .map(|terms| self.graph.sum(&terms))
            .collect()
    }

    /// The matrix of `mu -> ad*_xi mu`, row by row: `out_jk = C_ij^k xi^i`
    pub(crate) fn ad_star_matrix_of(&mut self, xi: &[ExprId]) -> Vec<Vec<ExprId>> {
        let zero = self.graph.integer(0);
        let mut rows = vec![vec![zero; self.dimension]; self.dimension];
        for (i, j, k, value) in self.all_constants() {
            let term = self.graph.mul(value, xi[i]);
            rows[j][k] = self.graph.add(rows[j][k], term);
        }
        rows
    }

    /// `out_b = T_abc^d x^a z^c m_d`
    pub(crate) fn triple_of(&mut self, x: &[ExprId], z: &[ExprId], m: &[ExprId]) -> Vec<ExprId> {
        cayley::triple_of(self, x, z, m)
    }

    /// `Pi_ab`, row by row
    pub(crate) fn poisson_matrix(&mut self) -> Vec<Vec<ExprId>> {
        field::poisson_matrix(self)
    }

    /// H, and 0 where it has no expression: nothing is derived from it then.
    pub(crate) fn function(&mut self) -> ExprId {
        match self.energy.expression() {
            Some(hamiltonian) => hamiltonian.value,
            None => self.graph.integer(0),
        }
    }

    /// Whether H calls functions of Rust.
    pub(crate) fn has_own_functions(&mut self) -> bool {
        let function = self.function();
        !self.graph.own_functions(function).is_empty()
    }

    /// `dH/dmu_i`
    pub(crate) fn gradient_of_h(&mut self) -> Vec<ExprId> {
        let function = self.function();
        (0..self.dimension)
            .map(|i| self.graph.derivative(function, Symbol::Coordinate(i)))
            .collect()
    }

    /// The generator xi: `dH/dmu_i`, with what damping adds.
    pub(crate) fn generator(&mut self) -> Vec<ExprId> {
        let gradient = self.gradient_of_h();
        let Some(driving) = &self.driving else {
            return gradient;
        };
        let both = gradient.into_iter().zip(&driving.damping);
        both.map(|(g, more)| self.graph.add(g, *more)).collect()
    }

    /// Whether the generator is not the gradient of H.
    pub(crate) fn is_damped(&self) -> bool {
        let driving = self.driving.as_ref();
        driving.is_some_and(|driving| driving.is_damped(&self.graph))
    }

    /// The force F, where one acts.
    pub(crate) fn force(&self) -> Option<Vec<ExprId>> {
        let driving = self.driving.as_ref()?;
        let driving = Some(driving).filter(|driving| driving.is_forced(&self.graph))?;
        Some(driving.force.clone())
    }

    /// The entropy and the metric, where one metriplectic term acts, and its entropy depends on the declared coordinates alone.
    pub(crate) fn metriplectic(&self) -> Option<(ExprId, Vec<Vec<ExprId>>)> {
        let mut found = None;
        for acting in &self.driving.as_ref()?.declared {
            if let Acting::Metriplectic(entropy, metric) = acting
                && found.replace((*entropy, metric.clone())).is_some()
            {
                return None;
            }
        }
        let outside = |symbol| matches!(symbol, Symbol::Coordinate(place) if place >= self.own());
        found.filter(|(entropy, _)| !self.graph.symbols(*entropy).into_iter().any(outside))
    }

    /// `f = Pi(mu) xi + F`
    pub(crate) fn field(&mut self) -> Vec<ExprId> {
        let (generator, force) = (self.generator(), self.force());
        let mu = self.coordinates();
        let mut field = self.poisson_times(&generator, &mu);
        for (slot, force) in field.iter_mut().zip(force.unwrap_or_default()) {
            *slot = self.graph.add(*slot, force);
        }
        field.into_iter().map(|f| self.graph.tidy(f)).collect()
    }

    /// `df_i/dmu_j`
    pub(crate) fn jacobian_of(&mut self, field: &[ExprId]) -> Vec<Vec<ExprId>> {
        field::jacobian(self, field)
    }

    /// The Hessian of H, both halves, row by row.
    pub(crate) fn hessian_of_h(&mut self) -> Vec<Vec<ExprId>> {
        let gradient = self.gradient_of_h();
        gradient
            .into_iter()
            .map(|g| {
                (0..self.dimension)
                    .map(|j| self.graph.derivative(g, Symbol::Coordinate(j)))
                    .collect()
            })
            .collect()
    }

    /// The expressions with the coordinates replaced by another block of symbols.
    pub(crate) fn at_point(&mut self, expressions: &[ExprId], point: &[ExprId]) -> Vec<ExprId> {
        self.graph.substitute(expressions, &|symbol| match symbol {
            Symbol::Coordinate(i) => Some(point[i]),
            _ => None,
        })
    }

    /// The kernels of the basic traits.
    pub fn basic_kernels(&mut self) -> Vec<Kernel> {
        self.kernels_of_traits(true)
    }

    /// Those of them that steps without equations need: no Hessian, and no Jacobian of the field.
    pub fn explicit_kernels(&mut self) -> Vec<Kernel> {
        self.kernels_of_traits(false)
    }

    fn kernels_of_traits(&mut self, derivatives: bool) -> Vec<Kernel> {
        let mut kernels = field::kernels(self, derivatives);
        if self.is_lie() {
            kernels.extend(coadjoint::kernels(self));
        } else {
            kernels.push(poisson::slope(self));
        }
        if self.triple().is_some() {
            kernels.push(cayley::triple(self));
        }
        kernels
    }

    /// The kernels of a Lagrangian, if there is one.
    pub fn lagrangian_kernels(&mut self) -> Option<Vec<Kernel>> {
        let lagrangian = self.energy.lagrangian()?.clone();
        Some(lagrangian::kernels(self, &lagrangian))
    }

    /// The kernels of a discrete Lagrangian, if there is one.
    pub fn discrete_kernels(&mut self) -> Option<Vec<Kernel>> {
        let discrete = self.discrete()?.clone();
        Some(lagrangian::discrete_kernels(self, &discrete))
    }

    /// The map of the realization and its derivatives.
    pub fn realization_kernels(&mut self) -> Option<Vec<Kernel>> {
        let realization = self.realization()?;
        Some(realization::kernels(self, &realization))
    }

    /// The tangents of the declared retraction, and what its elements do.
    pub fn retraction_kernels(&mut self) -> Option<Vec<Kernel>> {
        retraction::kernels(self)
    }

    /// The coordinates in which the bracket is constant, and the field in them.
    pub fn canonical_kernels(&mut self) -> Option<Vec<Kernel>> {
        canonical::kernels(self)
    }

    /// The flows of the coordinate pieces of a separable Hamiltonian.
    pub fn splitting_kernels(&mut self) -> Option<Vec<PieceKernel>> {
        let pieces = self.pieces()?.to_vec();
        let slopes = self.gradient_of_h();
        Some(splitting::kernels(self, &pieces, &slopes))
    }

    /// Gradient and Hessian of a generating function; `None` where they swell.
    pub fn generating_function(&mut self, generating: Generating) -> Option<Function> {
        generating::function(self, generating)
    }
}
