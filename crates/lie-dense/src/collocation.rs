//! Methods for any vector field, by fixed-point iteration: a Jacobian of `N^2` rows would cost more than everything else.

use crate::stream::StreamMap;
use crate::system::MatrixFlow;
use lie_runtime::Poisson;
use lie_runtime::generic::{Gauss, Midpoint};
use lie_runtime::methods::ImplicitStepper;
use lie_runtime::methods::{Gauss4, Gauss6, ImplicitMidpoint, Method};
use lie_runtime::newton::{Iteration, NewtonOptions};

macro_rules! by_fixed_point {
    ($method:ty, $equation:ty) => {
        /// By fixed-point iteration, whatever the options say.
        impl<M: StreamMap> Method<f64, MatrixFlow<M>> for $method {
            type Stepper<'a>
                = ImplicitStepper<f64, $equation>
            where
                M: 'a;

            fn stepper<'a>(
                &self,
                system: &'a MatrixFlow<M>,
                h: f64,
                newton: &NewtonOptions,
            ) -> Self::Stepper<'a> {
                let options = NewtonOptions {
                    iteration: Iteration::FixedPoint,
                    ..*newton
                };
                let equation = <$equation>::new(system, h);
                ImplicitStepper::new(equation, system.zero_state(), &options)
            }
        }
    };
}

by_fixed_point!(ImplicitMidpoint, Midpoint<'a, f64, MatrixFlow<M>>);
by_fixed_point!(Gauss4, Gauss<'a, f64, MatrixFlow<M>, 2>);
by_fixed_point!(Gauss6, Gauss<'a, f64, MatrixFlow<M>, 3>);
