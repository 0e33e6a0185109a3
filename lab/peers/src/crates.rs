//! Other crates: ode_solvers, differential-equations, diffsol.

use crate::trial::{Outcome, Trials};

/// Quarter decades.
fn tolerances(quick: bool) -> impl Iterator<Item = f64> {
    let every = if quick { 4 } else { 1 };
    (8..64)
        .step_by(every)
        .map(|k| 10_f64.powf(-0.25 * f64::from(k)))
}

/// Runs all of them on a right-hand side.
pub fn measure<'a, const N: usize>(
    trials: &mut Trials<'a>,
    field: impl Fn(&[f64], &mut [f64]) + Copy + 'a,
    start: [f64; N],
    until: f64,
    quick: bool,
) {
    by_ode_solvers(trials, field, start, until, quick);
    by_differential_equations(trials, field, start, until, quick);
    by_diffsol(trials, field, start, until, quick);
}

/// Runs those that take long vectors.
pub fn measure_large<'a>(
    trials: &mut Trials<'a>,
    field: impl Fn(&[f64], &mut [f64]) + Copy + 'a,
    start: &'a [f64],
    until: f64,
    quick: bool,
) {
    use ode_solvers::{DVector, Dop853, OutputType, System};
    struct Wrapped<F>(F);
    impl<F: Fn(&[f64], &mut [f64])> System<f64, DVector<f64>> for Wrapped<F> {
        fn system(&self, _x: f64, y: &DVector<f64>, dy: &mut DVector<f64>) {
            self.0(y.as_slice(), dy.as_mut_slice());
        }
    }
    for tolerance in tolerances(quick) {
        let run = move |end: &mut [f64]| {
            let (system, y) = (Wrapped(field), DVector::from_column_slice(start));
            let mut solver = Dop853::new(system, 0.0, until, until, y, tolerance, tolerance);
            solver.set_output(OutputType::Sparse);
            let stats = solver.integrate().ok()?;
            end.copy_from_slice(solver.y_out().last()?.as_slice());
            let steps = u64::from(stats.accepted_steps);
            Some(Outcome { steps })
        };
        let setting = format!("tol {tolerance:.1e}");
        if trials
            .add_peer("ode_solvers", "Dop853", setting, Box::new(run))
            .is_break()
        {
            break;
        }
    }
}

fn by_ode_solvers<'a, const N: usize>(
    trials: &mut Trials<'a>,
    field: impl Fn(&[f64], &mut [f64]) + Copy + 'a,
    start: [f64; N],
    until: f64,
    quick: bool,
) {
    use ode_solvers::{Dop853, Dopri5, OutputType, SVector, System};
    #[derive(Clone, Copy)]
    struct Wrapped<F>(F);
    impl<F: Fn(&[f64], &mut [f64]), const N: usize> System<f64, SVector<f64, N>> for Wrapped<F> {
        #[inline(always)]
        fn system(&self, _x: f64, y: &SVector<f64, N>, dy: &mut SVector<f64, N>) {
            self.0(y.as_slice(), dy.as_mut_slice());
        }
    }
    macro_rules! by {
        ($solver:ident, $name:literal) => {
            for tolerance in tolerances(quick) {
                let run = move |end: &mut [f64]| {
                    let (system, y) = (Wrapped(field), SVector::<f64, N>::from(start));
                    let mut solver =
                        $solver::new(system, 0.0, until, until, y, tolerance, tolerance);
                    solver.set_output(OutputType::Sparse);
                    let stats = solver.integrate().ok()?;
                    end.copy_from_slice(solver.y_out().last()?.as_slice());
                    let steps = u64::from(stats.accepted_steps);
                    Some(Outcome { steps })
                };
                let setting = format!("tol {tolerance:.1e}");
                if trials
                    .add_peer("ode_solvers", $name, setting, Box::new(run))
                    .is_break()
                {
                    break;
                }
            }
        };
    }
    by!(Dop853, "Dop853");
    by!(Dopri5, "Dopri5");
}

fn by_differential_equations<'a, const N: usize>(
    trials: &mut Trials<'a>,
    field: impl Fn(&[f64], &mut [f64]) + Copy + 'a,
    start: [f64; N],
    until: f64,
    quick: bool,
) {
    use differential_equations::prelude::*;
    struct Wrapped<F>(F);
    impl<F: Fn(&[f64], &mut [f64]), const N: usize> ODE<f64, [f64; N]> for Wrapped<F> {
        #[inline(always)]
        fn diff(&self, _t: f64, y: &[f64; N], dydt: &mut [f64; N]) {
            self.0(y, dydt);
        }
    }
    for tolerance in tolerances(quick) {
        let run = move |end: &mut [f64]| {
            let method = ExplicitRungeKutta::dop853();
            let method = method.rtol(tolerance).atol(tolerance).max_steps(10_000_000);
            let system = Wrapped(field);
            let problem = IVP::ode(&system, 0.0, until, start)
                .t_eval([until])
                .method(method);
            let solution = problem.solve().ok()?;
            end.copy_from_slice(solution.y.last()?);
            let steps = solution.steps.accepted as u64;
            Some(Outcome { steps })
        };
        let setting = format!("tol {tolerance:.1e}");
        let peer = "differential-equations";
        if trials
            .add_peer(peer, "dop853", setting, Box::new(run))
            .is_break()
        {
            break;
        }
    }
}

fn by_diffsol<'a, const N: usize>(
    trials: &mut Trials<'a>,
    field: impl Fn(&[f64], &mut [f64]) + Copy + 'a,
    start: [f64; N],
    until: f64,
    quick: bool,
) {
    use diffsol::{NalgebraMat, OdeBuilder, OdeSolverMethod, OdeSolverStopReason, Vector as _};
    for tolerance in tolerances(quick) {
        let problem = OdeBuilder::<NalgebraMat<f64>>::new()
            .rtol(tolerance)
            .atol([tolerance])
            .rhs(move |y: &[f64], _p: &[f64], _t: f64, dy: &mut [f64]| field(y, dy))
            .init(
                move |_p: &[f64], _t: f64, y: &mut [f64]| y.copy_from_slice(&start),
                N,
            )
            .build();
        let Ok(problem) = problem else { continue };
        let run = move |end: &mut [f64]| {
            let mut solver = problem.tsit45().ok()?;
            solver.set_stop_time(until).ok()?;
            let mut steps = 1;
            while solver.step().ok()? != OdeSolverStopReason::TstopReached {
                steps += 1;
            }
            end.copy_from_slice(&solver.state().y.clone_as_vec());
            Some(Outcome { steps })
        };
        let setting = format!("tol {tolerance:.1e}");
        if trials
            .add_peer("diffsol", "tsit45", setting, Box::new(run))
            .is_break()
        {
            break;
        }
    }
}
