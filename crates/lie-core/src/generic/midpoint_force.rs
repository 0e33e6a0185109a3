//! The force of the Lie–Poisson midpoint method with the exponential map.

use super::dexp_series::dexp_of_minus;
use super::series::{Scratch, coadjoint_action_in};
use crate::matrix::SquareMatrix;
use crate::poisson::LiePoisson;
use crate::scalar::Scalar;
use crate::state::{State, copies};

/// The force `F(p)` at the midpoint, half of it carried to the beginning of the step and half to its end by half of the motion:
/// `(h/2) exp(-ad*_xi/2) F` and `(h/2) exp(ad*_xi/2) F`, the discrete Lagrange–d'Alembert principle.
///
/// So the spatial momentum changes by exactly h times the force, carried to space by the group element in the middle of the step:
/// `Ad*_(g1^-1) mu1 - Ad*_(g^-1) mu = h Ad*_(gm^-1) F(p)`, `gm = g exp(xi/2)`.
#[derive(Debug)]
pub(super) struct MidpointForce<V, M> {
    /// h/2 times the force, at the beginning.
    carried: V,
    /// The base with it.
    base: V,
    half: V,
    force: V,
    slopes: M,
    scratch: Scratch<V>,
    columns: [V; 3],
}

impl<V, M> MidpointForce<V, M> {
    /// Space for the forces of a system.
    pub(super) fn new<S, P>(system: &P) -> Self
    where
        S: Scalar,
        V: State<S>,
        P: LiePoisson<S, State = V, Jacobian = M>,
    {
        let zero = system.zero_state();
        Self {
            carried: zero.clone(),
            base: zero.clone(),
            half: zero.clone(),
            force: zero.clone(),
            slopes: system.zero_jacobian(),
            scratch: Scratch::new(&zero),
            columns: copies(&zero),
        }
    }

    /// The base of a step of size h with what is carried to it of the force at p: `mu + (h/2) exp(-ad*_xi/2) F(p)`.
    pub(super) fn pushed<S, P>(&mut self, system: &P, h: S, [p, xi, mu]: [&V; 3]) -> &V
    where
        S: Scalar,
        V: State<S>,
        P: LiePoisson<S, State = V, Jacobian = M>,
    {
        self.set_half(-S::ratio(1.0, 2.0), xi);
        self.carry(system, h * S::ratio(1.0, 2.0), p);
        self.base.copy_from(mu);
        self.base.axpy(S::one(), &self.carried);
        &self.base
    }

    /// The same; [`MidpointForce::slope`] refers to it.
    pub(super) fn linearize<S, P>(&mut self, system: &P, h: S, [p, xi, mu]: [&V; 3]) -> &V
    where
        S: Scalar,
        V: State<S>,
        M: SquareMatrix<S>,
        P: LiePoisson<S, State = V, Jacobian = M>,
    {
        system.force_slope(p, &mut self.slopes);
        let half = h * S::ratio(1.0, 2.0);
        for row in 0..system.dimension() {
            for column in 0..system.dimension() {
                let entry = half * self.slopes.get(row, column);
                self.slopes.set(row, column, entry);
            }
        }
        self.pushed(system, h, [p, xi, mu])
    }

    /// The derivative of the base along a coordinate of p, with which xi moves by `along`.
    pub(super) fn slope<S, P>(&mut self, system: &P, column: usize, along: &V, out: &mut V)
    where
        S: Scalar,
        V: State<S>,
        M: SquareMatrix<S>,
        P: LiePoisson<S, State = V, Jacobian = M>,
    {
        for (row, entry) in self.force.as_mut_slice().iter_mut().enumerate() {
            *entry = self.slopes.get(row, column);
        }
        let (half, scratch) = (&self.half, &mut self.scratch);
        coadjoint_action_in(system, half, &self.force, out, scratch);
        let [turn, ..] = &mut self.columns;
        turn.fill(S::zero());
        turn.axpy(-S::ratio(1.0, 2.0), along);
        let kept = dexp_of_minus(system, half, self.columns.each_mut());
        let [turn, ..] = &mut self.columns;
        for entry in turn.as_mut_slice() {
            *entry = S::select(kept, *entry, S::zero());
        }
        system.ad_star(turn, &self.carried, &mut self.force);
        out.axpy(S::one(), &self.force);
    }

    /// Adds `h exp(ad*_xi/2) F(p)` to the end of a step without force.
    pub(super) fn add_to_end<S, P>(&mut self, system: &P, h: S, [p, xi]: [&V; 2], end: &mut V)
    where
        S: Scalar,
        V: State<S>,
        P: LiePoisson<S, State = V, Jacobian = M>,
    {
        self.set_half(S::ratio(1.0, 2.0), xi);
        self.carry(system, h, p);
        end.axpy(S::one(), &self.carried);
    }

    fn set_half<S: Scalar>(&mut self, half: S, xi: &V)
    where
        V: State<S>,
    {
        for (half_xi, &xi) in self.half.as_mut_slice().iter_mut().zip(xi.as_slice()) {
            *half_xi = half * xi;
        }
    }

    /// Sets what is carried to a weight times the force at p, along the half.
    fn carry<S, P>(&mut self, system: &P, weight: S, p: &V)
    where
        S: Scalar,
        V: State<S>,
        P: LiePoisson<S, State = V, Jacobian = M>,
    {
        system.force(p, &mut self.force);
        for entry in self.force.as_mut_slice() {
            *entry *= weight;
        }
        let (force, scratch) = (&self.force, &mut self.scratch);
        coadjoint_action_in(system, &self.half, force, &mut self.carried, scratch);
    }
}
