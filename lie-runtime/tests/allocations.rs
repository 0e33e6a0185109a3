//! A step allocates nothing.

use crate::systems;

use lie_runtime::methods::{FactorSink, Method, Retraction, Stepper};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;
use systems::heavy_top::{HeavyTop, START};
use systems::quartic_lagrangian::{BODY, QuarticBody};
use systems::state;

/// Counts the group factors.
struct Count(usize);

impl<V> FactorSink<V> for Count {
    fn push(&mut self, _retraction: Retraction, _xi: &V) {
        self.0 += 1;
    }
}

fn allocations<S: Scalar, M>(method: &M, options: &NewtonOptions) -> u64
where
    M: Method<S, HeavyTop<S>>,
{
    let system = HeavyTop::<S>::default();
    let mut mu = state(&system, &START);
    let mut stepper = method.stepper(&system, S::ratio(1.0, 10.0), options);
    let mut count = Count(0);
    allocation_counter::measure(|| {
        for _ in 0..10 {
            stepper
                .step(&mut mu, &mut count)
                .expect("the step converges");
        }
    })
    .count_total
}

/// Nor does the Legendre transform by Newton's iteration, nor a step of a Lagrangian.
#[test]
fn steps_of_lagrangian_systems_allocate_nothing() {
    fn count<S: Scalar, M: Method<S, QuarticBody>>(method: M, options: &NewtonOptions) -> u64 {
        let mut mu = state::<S, _>(&QuarticBody, &BODY);
        let mut stepper = method.stepper(&QuarticBody, S::ratio(1.0, 10.0), options);
        let steps = || {
            for _ in 0..10 {
                stepper.step(&mut mu, &mut ()).expect("the step converges");
            }
        };
        allocation_counter::measure(steps).count_total
    }
    for options in [
        NewtonOptions::default(),
        NewtonOptions::simplified(),
        NewtonOptions::fixed_point(),
    ] {
        assert_eq!(count::<f64, _>(Variational2::exp(), &options), 0);
        assert_eq!(count::<f64, _>(Variational2::cayley(), &options), 0);
        assert_eq!(count::<f64, _>(Variational4::exp(), &options), 0);
        assert_eq!(count::<f64, _>(Variational6::exp(), &options), 0);
        assert_eq!(count::<F64x8, _>(Variational4::exp(), &options), 0);
        assert_eq!(count::<f64, _>(LieMidpoint::exp(), &options), 0);
    }
}

#[test]
fn steps_allocate_nothing() {
    let control = allocation_counter::measure(|| drop(std::hint::black_box(Box::new(START))));
    assert_eq!(control.count_total, 1, "the counter counts");
    for options in [
        NewtonOptions::default(),
        NewtonOptions::simplified(),
        NewtonOptions::fixed_point(),
    ] {
        assert_eq!(allocations::<f64, _>(&ImplicitMidpoint, &options), 0);
        assert_eq!(allocations::<f64, _>(&Gauss4, &options), 0);
        assert_eq!(allocations::<f64, _>(&Gauss6, &options), 0);
        assert_eq!(allocations::<f64, _>(&LieMidpoint::exp(), &options), 0);
        assert_eq!(allocations::<f64, _>(&LieMidpoint::cayley(), &options), 0);
        assert_eq!(allocations::<f64, _>(&Generating4::exp(), &options), 0);
        assert_eq!(allocations::<f64, _>(&Generating4::cayley(), &options), 0);
        assert_eq!(allocations::<f64, _>(&Generating6::exp(), &options), 0);
        assert_eq!(allocations::<f64, _>(&GeneratingSecondKind2, &options), 0);
        assert_eq!(allocations::<f64, _>(&Rk4, &options), 0);
        assert_eq!(allocations::<f64, _>(&Dopri5::default(), &options), 0);
        assert_eq!(allocations::<F64x8, _>(&Gauss6, &options), 0);
        assert_eq!(allocations::<F64x8, _>(&LieMidpoint::exp(), &options), 0);
        assert_eq!(allocations::<f32, _>(&LieMidpoint::exp(), &options), 0);
    }
}
