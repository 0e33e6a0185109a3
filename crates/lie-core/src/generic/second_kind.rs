//! The equation of generating-function methods in coordinates of the second kind.

use super::generating::SecondKind2;
use super::series::{Scratch, coadjoint_action_in};
use crate::equation::Equation;
use crate::generating::GeneratingFunction;
use crate::matrix::SquareMatrix;
use crate::methods::Retraction;
use crate::poisson::{LiePoisson, Lift, Poisson};
use crate::scalar::{Dual, Scalar};
use crate::state::{State, copies};

/// How momenta move along the elements of the basis.
pub trait Actions<S: Scalar, P: LiePoisson<S>> {
    /// The actions with their scratch space.
    fn new(system: &P) -> Self;
    /// `out = exp(s ad*_(e_i)) m`
    fn act(&mut self, system: &P, i: usize, s: S, m: &P::State, out: &mut P::State);
}

/// Actions by the series of the exponential.
#[derive(Clone, Debug)]
pub struct SeriesActions<V> {
    element: V,
    scratch: Scratch<V>,
}

impl<S: Scalar, P: LiePoisson<S>> Actions<S, P> for SeriesActions<P::State> {
    fn new(system: &P) -> Self {
        let zero = system.zero_state();
        Self {
            scratch: Scratch::new(&zero),
            element: zero,
        }
    }

    fn act(&mut self, system: &P, i: usize, s: S, m: &P::State, out: &mut P::State) {
        self.element.as_mut_slice()[i] = s;
        coadjoint_action_in(system, &self.element, m, out, &mut self.scratch);
        self.element.as_mut_slice()[i] = S::zero();
    }
}

/// The method `mu1 = Ad*_g mu` with `g = exp(xi_1 e_1) … exp(xi_n e_n)`, `xi = grad S(p)`, for any
/// Lie algebra.
///
/// Unknown: p. With `m_0 = mu` and `m_i = exp(xi_i ad*_(e_i)) m_(i-1)`, the equation
/// `D_R^-T p = mu` (`D_R` the right-trivialised tangent of the coordinates, its columns are
/// `Ad_(exp(xi_1 e_1) … exp(xi_(i-1) e_(i-1))) e_i`) is `r_i(p) = p_i - (m_(i-1))_i`, entire in xi,
/// and the new state is `m_n`, on the coadjoint orbit of mu to round-off whatever the error of p.
/// Jacobian: `dm_i/dxi_l` is `ad*_(e_l) m_l` moved on by the actions l+1 to i.
/// Start: the fixed-point form of the equation at mu.
#[derive(Clone, Debug)]
pub struct SecondKind<'a, S, P, G, A = SeriesActions<<P as Poisson<S>>::State>>
where
    S: Scalar,
    P: LiePoisson<S>,
{
    system: &'a P,
    function: G,
    actions: A,
    base: P::State,
    xi: P::State,
    hessian: P::Jacobian,
    tangents: P::Jacobian,
    columns: [P::State; 3],
}

impl<'a, S, P> SecondKind<'a, S, P, SecondKind2<'a, S, P>>
where
    S: Scalar,
    P: Lift<S> + LiePoisson<S>,
    P::Lifted: LiePoisson<Dual<S>>,
{
    /// The equation of a step of size h, order 2.
    pub fn new(system: &'a P, h: S) -> Self {
        Self::with_function(system, SecondKind2::new(system, h), h)
    }
}

impl<'a, S, P, G> SecondKind<'a, S, P, G>
where
    S: Scalar,
    P: LiePoisson<S>,
    G: GeneratingFunction<S, State = P::State, Jacobian = P::Jacobian>,
{
    /// The equation of the step of a generating function, which knows the size of the step.
    pub fn with_function(system: &'a P, function: G, _h: S) -> Self {
        Self::with_actions(system, function)
    }
}

impl<'a, S, P, G, A> SecondKind<'a, S, P, G, A>
where
    S: Scalar,
    P: LiePoisson<S>,
    G: GeneratingFunction<S, State = P::State, Jacobian = P::Jacobian>,
    A: Actions<S, P>,
{
    /// The same by actions of any kind.
    pub fn with_actions(system: &'a P, function: G) -> Self {
        let zero = system.zero_state();
        Self {
            system,
            function,
            actions: A::new(system),
            base: zero.clone(),
            xi: zero.clone(),
            hessian: system.zero_jacobian(),
            tangents: system.zero_jacobian(),
            columns: copies(&zero),
        }
    }

    /// Calls `visit` with i and `m_(i-1)` before each action and leaves `m_n` in `columns[0]`.
    fn walk(&mut self, mut visit: impl FnMut(usize, &P::State)) {
        let [moment, moved, _] = &mut self.columns;
        moment.copy_from(&self.base);
        for i in 0..self.system.dimension() {
            visit(i, moment);
            let s = self.xi.as_slice()[i].quantity();
            self.actions.act(self.system, i, s, moment, moved);
            core::mem::swap(moment, moved);
        }
    }

    fn evaluate(&mut self, unknown: &P::State, residual: &mut P::State) {
        self.walk(|i, moment| {
            residual.as_mut_slice()[i] = unknown.as_slice()[i] - moment.as_slice()[i];
        });
    }
}

impl<S, P, G, A> Equation<S> for SecondKind<'_, S, P, G, A>
where
    S: Scalar,
    P: LiePoisson<S>,
    G: GeneratingFunction<S, State = P::State, Jacobian = P::Jacobian>,
    A: Actions<S, P>,
{
    crate::generic::unknown_of_a_state!();

    fn set_base(&mut self, mu: &P::State) {
        self.base.copy_from(mu);
    }

    fn initial_guess(&mut self, unknown: &mut P::State) {
        self.function.gradient(&self.base, &mut self.xi);
        self.walk(|i, moment| unknown.as_mut_slice()[i] = moment.as_slice()[i]);
    }

    fn residual(&mut self, unknown: &P::State, residual: &mut P::State) {
        self.function.gradient(unknown, &mut self.xi);
        self.evaluate(unknown, residual);
    }

    fn linearize(&mut self, unknown: &P::State, residual: &mut P::State, matrix: &mut P::Jacobian) {
        self.function
            .linearize(unknown, &mut self.xi, &mut self.hessian);
        let [moment, moved, column] = &mut self.columns;
        let (system, actions) = (self.system, &mut self.actions);
        moment.copy_from(&self.base);
        for i in 0..self.system.dimension() {
            residual.as_mut_slice()[i] = unknown.as_slice()[i] - moment.as_slice()[i];
            // dm_(i-1)/dxi_l; component i stays when action i moves the rest
            for j in 0..self.system.dimension() {
                let mut sum = if i == j { S::one() } else { S::zero() };
                for l in 0..i {
                    sum -= self.tangents.get(i, l) * self.hessian.get(l, j).quantity();
                }
                matrix.set(i, j, sum);
            }
            let s = self.xi.as_slice()[i].quantity();
            actions.act(system, i, s, moment, moved);
            core::mem::swap(moment, moved);
            if i + 1 == self.system.dimension() {
                break;
            }
            for l in 0..i {
                for (row, entry) in column.as_mut_slice().iter_mut().enumerate() {
                    *entry = self.tangents.get(row, l);
                }
                actions.act(system, i, s, column, moved);
                for (row, &entry) in moved.as_slice().iter().enumerate() {
                    self.tangents.set(row, l, entry);
                }
            }
            moved.fill(S::zero());
            moved.as_mut_slice()[i] = S::one();
            system.ad_star(moved, moment, column);
            for (row, &entry) in column.as_slice().iter().enumerate() {
                self.tangents.set(row, i, entry);
            }
        }
    }

    fn result(&mut self, unknown: &P::State, mu: &mut P::State) {
        self.function.gradient(unknown, &mut self.xi);
        self.walk(|_, _| ());
        mu.copy_from(&self.columns[0]);
    }

    fn group_factor(&mut self, unknown: &P::State, xi: &mut P::State) -> Option<Retraction> {
        self.function.gradient(unknown, xi);
        Some(Retraction::SecondKind)
    }
}
