//! The crate `ode_solvers` as a control: Dormand and Prince's methods of orders 5 and 8, their tolerances
//! alike, no dense output.

use lie_measure::bench::{Control, ControlRun};
use lie_runtime::{Poisson, State};
use ode_solvers::{Dop853, Dopri5, OutputType, SVector, System};

struct Field<'a, P>(&'a P);

impl<P: Poisson<f64>, const N: usize> System<f64, SVector<f64, N>> for Field<'_, P> {
    fn system(&self, _t: f64, mu: &SVector<f64, N>, slope: &mut SVector<f64, N>) {
        let mut state = self.0.zero_state();
        let mut field = self.0.zero_state();
        state.as_mut_slice().copy_from_slice(mu.as_slice());
        self.0.vector_field(&state, &mut field);
        slope.as_mut_slice().copy_from_slice(field.as_slice());
    }
}

/// The controls for a system of N coordinates.
pub fn all<P: Poisson<f64>, const N: usize>() -> Vec<Control<P>> {
    macro_rules! control {
        ($label:literal, $method:ident) => {
            Control {
                label: $label,
                run: Box::new(|system: &P, start: &[f64], until, tolerance, watch| {
                    let start = SVector::<f64, N>::from_column_slice(start);
                    let field = Field(system);
                    let mut solver =
                        $method::new(field, 0.0, until, until, start, tolerance, tolerance);
                    solver.set_output(OutputType::Sparse);
                    let stats = solver.integrate().ok()?;
                    if let Some(watch) = watch {
                        let seen = solver.x_out().iter().zip(solver.y_out());
                        seen.for_each(|(&time, mu)| watch(time, mu.as_slice()));
                    }
                    Some(ControlRun {
                        end: solver.y_out().last()?.as_slice().to_vec(),
                        evaluations: u64::from(stats.num_eval),
                        steps: u64::from(stats.accepted_steps),
                    })
                }),
            }
        };
    }
    vec![
        control!("ode_solvers Dopri5", Dopri5),
        control!("ode_solvers Dop853", Dop853),
    ]
}
