//! What acts beside the Hamiltonian in a step along a discrete gradient.

use super::kernels::multiply;
use super::noise::quieten;
use crate::clock::Clock;
use crate::matrix::SquareMatrix;
use crate::poisson::Poisson;
use crate::scalar::Scalar;
use crate::state::State;

/// Force and damping at the middle `m = (mu + u)/2` of a step along a discrete gradient g.
///
/// They are such that the balance of energy is exact: H changes by `h <F, g> - h c <v, G v>`, with the motion v along g that the
/// double bracket damps. So the force along the momentum of the time, which takes up what H loses, is `c <v, G v> - <F, g>`
/// with the discrete gradient, and no function of the state.
#[derive(Clone, Debug)]
pub(super) struct Beside<V, M> {
    pub(super) middle: V,
    /// The force, 0 where none acts.
    pub(super) force: V,
    /// `c G v`, 0 where nothing damps.
    pub(super) damping: V,
    /// The derivative of the force in m.
    slopes: M,
    column: V,
    turned: V,
}

impl<V, M> Beside<V, M> {
    /// The space of a system.
    pub(super) fn new<S, P>(system: &P) -> Self
    where
        S: Scalar,
        V: State<S>,
        P: Poisson<S, State = V, Jacobian = M>,
    {
        let zero = system.zero_state();
        Self {
            middle: zero.clone(),
            force: zero.clone(),
            damping: zero.clone(),
            slopes: system.zero_jacobian(),
            column: zero.clone(),
            turned: zero,
        }
    }

    /// Sets the middle, and the force there.
    pub(super) fn set_middle<S, P>(&mut self, system: &P, start: &V, end: &V)
    where
        S: Scalar,
        V: State<S>,
        P: Poisson<S, State = V, Jacobian = M>,
    {
        let pairs = start.as_slice().iter().zip(end.as_slice());
        for (middle, (&x, &y)) in self.middle.as_mut_slice().iter_mut().zip(pairs) {
            *middle = S::ratio(1.0, 2.0) * (x + y);
        }
        self.set_force(system);
    }

    /// Sets the middle to a state, and the force there.
    pub(super) fn set_at<S, P>(&mut self, system: &P, point: &V)
    where
        S: Scalar,
        V: State<S>,
        P: Poisson<S, State = V, Jacobian = M>,
    {
        self.middle.copy_from(point);
        self.set_force(system);
    }

    fn set_force<S, P>(&mut self, system: &P)
    where
        S: Scalar,
        V: State<S>,
        P: Poisson<S, State = V, Jacobian = M>,
    {
        if system.is_forced() {
            system.force(&self.middle, &mut self.force);
        }
    }

    /// Makes `xi = g + c G T g` and `T xi + F` of a discrete gradient g and `T g`, with a tensor T.
    pub(super) fn act<S, P>(&mut self, system: &P, tensor: &M, xi: &mut V, field: &mut V)
    where
        S: Scalar,
        V: State<S>,
        M: SquareMatrix<S>,
        P: Poisson<S, State = V, Jacobian = M>,
    {
        if system.is_damped() {
            self.damp(system, field);
        }
        self.balance(system, xi, field);
        if system.is_damped() {
            xi.axpy(S::one(), &self.damping);
            multiply(tensor, xi, field);
        }
        field.axpy(S::one(), &self.force);
    }

    /// Sets the damping to `c G v`.
    pub(super) fn damp<S, P>(&mut self, system: &P, v: &V)
    where
        S: Scalar,
        V: State<S>,
        P: Poisson<S, State = V, Jacobian = M>,
    {
        system.damping(&self.middle, v, &mut self.damping);
    }

    /// Sets the force along the momentum of the time, from the discrete gradient and the motion that is damped.
    pub(super) fn balance<S, P>(&mut self, system: &P, gradient: &V, v: &V)
    where
        S: Scalar,
        V: State<S>,
        P: Poisson<S, State = V, Jacobian = M>,
    {
        let Some(clock) = system.clock() else {
            return;
        };
        let mut power = S::zero();
        let forces = self.force.as_slice().iter().zip(gradient.as_slice());
        for (index, (&force, &velocity)) in forces.enumerate() {
            if index != clock.momentum {
                power += force * velocity;
            }
        }
        if system.noise_count() > 0 {
            power -= self.power_of_noise(system, gradient, clock);
        }
        let mut loss = S::zero();
        for (&v, &damping) in v.as_slice().iter().zip(self.damping.as_slice()) {
            loss += v * damping;
        }
        self.force.as_mut_slice()[clock.momentum] = loss - power;
    }

    /// What the noise in the force does, which is no work of the forces.
    fn power_of_noise<S, P>(&mut self, system: &P, gradient: &V, clock: Clock) -> S
    where
        S: Scalar,
        V: State<S>,
        P: Poisson<S, State = V, Jacobian = M>,
    {
        let mut power = S::zero();
        self.turned.copy_from(&self.middle);
        for weight in [S::one(), -S::one()] {
            system.force(&self.turned, &mut self.column);
            let forces = self.column.as_slice().iter().zip(gradient.as_slice());
            for (index, (&force, &velocity)) in forces.enumerate() {
                if index != clock.momentum {
                    power += weight * force * velocity;
                }
            }
            quieten(system, &mut self.turned);
        }
        power
    }

    /// Sets the derivative of the force in the middle, times a weight.
    pub(super) fn linearize<S, P>(&mut self, system: &P, weight: S)
    where
        S: Scalar,
        V: State<S>,
        M: SquareMatrix<S>,
        P: Poisson<S, State = V, Jacobian = M>,
    {
        if !system.is_forced() {
            return;
        }
        system.force_slope(&self.middle, &mut self.slopes);
        for row in 0..system.dimension() {
            for column in 0..system.dimension() {
                let entry = weight * self.slopes.get(row, column);
                self.slopes.set(row, column, entry);
            }
        }
    }

    /// An entry of that derivative.
    pub(super) fn slope<S>(&self, row: usize, column: usize) -> S
    where
        S: Scalar,
        M: SquareMatrix<S>,
    {
        self.slopes.get(row, column)
    }

    /// Adds `c G v_j` to each column of a matrix, with `v_j` from a function.
    pub(super) fn damp_columns<S, P>(
        &mut self,
        system: &P,
        derivative: &mut M,
        mut v: impl FnMut(&M, usize, &mut V),
    ) where
        S: Scalar,
        V: State<S>,
        M: SquareMatrix<S>,
        P: Poisson<S, State = V, Jacobian = M>,
    {
        for index in 0..system.dimension() {
            v(derivative, index, &mut self.column);
            system.damping(&self.middle, &self.column, &mut self.turned);
            for (row, &entry) in self.turned.as_slice().iter().enumerate() {
                derivative.set(row, index, derivative.get(row, index) + entry);
            }
        }
    }
}
