//! Generating functions for any system, by dual numbers.

mod any_bracket;
mod derivatives;
mod slopes;

use crate::generating::GeneratingFunction;
use crate::generic::direction;
use crate::matrix::SquareMatrix;
use crate::poisson::{CayleyPoisson, LiePoisson, Lift, Poisson};
use crate::scalar::{Dual, Scalar};
use crate::state::State;
use derivatives::seeded;

/// `S = h H`, for every retraction: the Lie–Poisson midpoint method. Where something damps, h times the generator takes the place
/// of the gradient of S, and that is no function's.
#[derive(Clone, Copy, Debug)]
pub struct Generating2<'a, S, P> {
    system: &'a P,
    step: S,
}

impl<'a, S: Scalar, P: Poisson<S>> Generating2<'a, S, P> {
    /// The function of a step of size h.
    pub fn new(system: &'a P, h: S) -> Self {
        Self { system, step: h }
    }
}

impl<S: Scalar, P: Poisson<S>> GeneratingFunction<S> for Generating2<'_, S, P> {
    type State = P::State;
    type Jacobian = P::Jacobian;

    fn gradient(&mut self, p: &P::State, xi: &mut P::State) {
        direction(self.system, self.step, p, xi);
    }

    /// `h f(p)`: fewer operations than `ad*_xi p`, of which f is a multiple where nothing forces.
    fn motion<L: LiePoisson<S, State = P::State>>(
        &mut self,
        system: &L,
        p: &P::State,
        xi: &P::State,
        out: &mut P::State,
    ) {
        if self.system.is_forced() {
            system.ad_star(xi, p, out);
            return;
        }
        self.system.vector_field(p, out);
        for entry in out.as_mut_slice() {
            *entry *= self.step;
        }
    }

    fn linearize(&mut self, p: &P::State, xi: &mut P::State, hessian: &mut P::Jacobian) {
        self.gradient(p, xi);
        self.system.generator_slope(p, hessian);
        for row in 0..self.system.dimension() {
            for column in 0..self.system.dimension() {
                hessian.set(row, column, self.step * hessian.get(row, column));
            }
        }
    }
}

/// The gradient over dual numbers along each coordinate: gradient and Hessian of a function given
/// over [`Lift::Lifted`].
///
/// Generated code uses it where a Hessian written out would be too long.
pub fn linearize_by_duals<S, F, V, M>(
    function: &mut F,
    zero: &F::State,
    p: &V,
    xi: &mut V,
    hessian: &mut M,
) where
    S: Scalar,
    F: GeneratingFunction<Dual<S>>,
    V: State<S>,
    M: SquareMatrix<S>,
{
    let (mut q, mut gradient) = (zero.clone(), zero.clone());
    for (entry, &value) in q.as_mut_slice().iter_mut().zip(p.as_slice()) {
        *entry = Dual::constant_of(value);
    }
    for column in 0..p.as_slice().len() {
        q.as_mut_slice()[column].derivative = S::one();
        function.gradient(&q, &mut gradient);
        q.as_mut_slice()[column].derivative = S::zero();
        for (row, entry) in gradient.as_slice().iter().enumerate() {
            hessian.set(row, column, entry.derivative);
        }
    }
    for (entry, dual) in xi.as_mut_slice().iter_mut().zip(gradient.as_slice()) {
        *entry = dual.value;
    }
}

macro_rules! by_duals {
    ($(#[$doc:meta])* $name:ident of $bracket:ident, $slope:path $(; $($lifted:tt)+)?) => {
        $(#[$doc])*
        #[derive(Clone, Debug)]
        pub struct $name<'a, S, P> {
            system: &'a P,
            step: S,
        }

        impl<'a, S: Scalar, P: Poisson<S>> $name<'a, S, P> {
            /// The function of a step of size h.
            pub fn new(system: &'a P, h: S) -> Self {
                Self { system, step: h }
            }
        }

        impl<S, P> GeneratingFunction<S> for $name<'_, S, P>
        where
            S: Scalar,
            P: Lift<S> + $bracket<S>,
            P::Lifted: $bracket<Dual<S>>,
            $($($lifted)+: $bracket<Dual<Dual<S>>>,)?
        {
            type State = P::State;
            type Jacobian = P::Jacobian;

            fn gradient(&mut self, p: &P::State, xi: &mut P::State) {
                $slope(self.system, self.step, p, xi);
            }

            fn linearize(&mut self, p: &P::State, xi: &mut P::State, hessian: &mut P::Jacobian) {
                let lifted = self.system.lift();
                let h = Dual::constant_of(self.step);
                let mut q = seeded(&lifted, p.as_slice(), None);
                let mut gradient = lifted.zero_state();
                for column in 0..self.system.dimension() {
                    q.as_mut_slice()[column].derivative = S::one();
                    $slope(&lifted, h, &q, &mut gradient);
                    q.as_mut_slice()[column].derivative = S::zero();
                    for (row, entry) in gradient.as_slice().iter().enumerate() {
                        hessian.set(row, column, entry.derivative);
                    }
                }
                for (entry, dual) in xi.as_mut_slice().iter_mut().zip(gradient.as_slice()) {
                    *entry = dual.value;
                }
            }
        }
    };
}

by_duals!(
    /// `S = h H + h^3 S3` in exponential coordinates, `S3 = H''(X, X)/24` with `X = f(p)`.
    Generating4 of LiePoisson,
    slopes::exp4
);
by_duals!(
    /// `S = h H + h^3 S3 + h^5 S5` in exponential coordinates: [`Generating4`], and with
    /// `X2 = ad*_(grad H) X`, `eta = grad S3`
    /// `S5 = (-<X2, eta>/12 + H''(X, ad*_eta p)/4 + H''(X2, X2)/288 + H'''(X, X, X2)/96
    /// + H''''(X, X, X, X)/384)/5`.
    Generating6 of LiePoisson,
    slopes::exp6;
    // the gradient is one of dual numbers already
    <P::Lifted as Lift<Dual<S>>>::Lifted
);
by_duals!(
    /// `S = h H + h^3 S3` in Cayley coordinates,
    /// `S3 = H''(X, X)/24 - <p, T(xi, xi, xi)>/12` with `X = f(p)`, `xi = grad H(p)`.
    CayleyGenerating4 of CayleyPoisson,
    slopes::cayley4
);
by_duals!(
    /// `S = h H + h^2 S2` in coordinates of the second kind,
    /// `S2 = sum_(i<j) H_i H_j C_ji^k p_k/2`.
    SecondKind2 of LiePoisson,
    slopes::second_kind
);
by_duals!(
    /// `S = h H + h^3 S3` in the coordinates `(X, p)` of the flat spray of any Poisson bracket, `S3 = H''(f, f)/24` with the field f.
    HamiltonJacobi4 of Poisson,
    any_bracket::fourth_order
);
by_duals!(
    /// `S = h H + h^3 S3 + h^5 S5` in the coordinates `(X, p)` of the flat spray of any Poisson bracket: [`HamiltonJacobi4`], and with
    /// `g = grad H`, `a = Pi'[f] g`, `c = Pi''[f, f] g`, `eta = grad S3`
    /// `S5 = (-<a, eta>/12 + H''(f, Pi eta)/4 + H''(a, a)/288 + H''(f, c)/96 + H'''(f, f, a)/96
    /// + H''''(f, f, f, f)/384)/5`.
    HamiltonJacobi6 of Poisson,
    any_bracket::sixth_order
);
