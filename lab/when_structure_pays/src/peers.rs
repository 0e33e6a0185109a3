//! Methods from elsewhere: the crate `ode_solvers`, and heyoka by a script.

use crate::contest::{Entrant, Problem, See, Setting, outside, tolerances};
use lie_runtime::{Poisson, State};
use ode_solvers::{Dop853, Dopri5, OutputType, SVector, System};
use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Command, Stdio};

/// The time of one call of a solver, which makes 100,000 steps at most.
const TIME: f64 = 500.0;

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

macro_rules! solver {
    ($name:literal, $method:ident) => {
        outside(
            $name,
            |problem: &Problem<P>, setting: Setting, until: f64, see: See<'_>| {
                let Setting::Tolerance(tolerance) = setting else {
                    return Err("no tolerance".to_owned());
                };
                let mut mu = SVector::<f64, N>::from_column_slice(problem.start.as_slice());
                let delta = problem.delta;
                let all = (until / delta).round();
                let mut done = 0.0;
                while done < all {
                    let looks = f64::min((TIME / delta).ceil(), all - done);
                    // the last point of its dense output is extrapolated if it is the end
                    let end = (looks + 0.25) * delta;
                    let field = Field(&problem.system);
                    let mut solver = $method::new(field, 0.0, end, delta, mu, tolerance, tolerance);
                    // between its steps the solver interpolates, which moves no step
                    solver.set_output(OutputType::Dense);
                    solver.integrate().map_err(|error| error.to_string())?;
                    let seen = solver.y_out();
                    if seen.len() != looks as usize + 1 {
                        return Err(format!("{} looks of {looks}", seen.len()));
                    }
                    for (k, state) in seen.iter().enumerate().skip(1) {
                        see((done + k as f64) * delta, state.as_slice());
                    }
                    mu = seen[seen.len() - 1];
                    done += looks;
                }
                Ok(())
            },
        )
    };
}

/// Dormand and Prince's methods for a system of N coordinates.
pub fn solvers<P: Poisson<f64> + 'static, const N: usize>() -> Vec<Entrant<P>> {
    vec![
        solver!("ode_solvers Dopri5", Dopri5),
        solver!("ode_solvers Dop853", Dop853),
    ]
}

/// heyoka, if there is a python3 that has it.
pub fn heyoka<P: Poisson<f64> + 'static>() -> Option<Entrant<P>> {
    let found = Command::new("python3")
        .args(["-c", "import heyoka"])
        .stderr(Stdio::null())
        .status();
    if !found.is_ok_and(|status| status.success()) {
        eprintln!("skipped: heyoka, which python3 does not have (`pip install heyoka`)");
        return None;
    }
    let run = |problem: &Problem<P>, setting: Setting, until: f64, see: See<'_>| {
        let looks = (until / problem.delta).round() as u64;
        asked(problem, setting, looks, 0.0, see).map(|_| ())
    };
    let mut settings = tolerances();
    settings.retain(|setting| matches!(setting, Setting::Tolerance(tol) if *tol < 3e-3));
    Some(Entrant {
        name: "heyoka".to_owned(),
        control: true,
        settings,
        run: Box::new(run),
        cost: Box::new(|problem, setting| asked(problem, setting, 0, 0.02, &mut |_, _| {})),
    })
}

/// The seconds for a unit of time, if some are to be spent on finding out; the states at looks.
fn asked<P: Poisson<f64>>(
    problem: &Problem<P>,
    setting: Setting,
    looks: u64,
    enough: f64,
    see: See<'_>,
) -> Result<f64, String> {
    let Setting::Tolerance(tolerance) = setting else {
        return Err("no tolerance".to_owned());
    };
    let start: Vec<String> = problem
        .start
        .as_slice()
        .iter()
        .map(|x| format!("{x:?}"))
        .collect();
    let request = format!(
        "{{\"system\": {}, \"start\": [{}], \"tolerance\": {tolerance:?}, \"delta\": {:?}, \"looks\": {looks}, \"enough\": {enough:?}}}",
        problem.outside,
        start.join(", "),
        problem.delta
    );
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/heyoka_states.py");
    let mut child = Command::new("python3")
        .arg(script)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .map_err(|error| error.to_string())?;
    let failed = |error: std::io::Error| error.to_string();
    child
        .stdin
        .take()
        .ok_or("no input")?
        .write_all(request.as_bytes())
        .map_err(failed)?;
    let mut answer = BufReader::with_capacity(1 << 20, child.stdout.take().ok_or("no output")?);
    let mut line = String::new();
    answer.read_line(&mut line).map_err(failed)?;
    let seconds: f64 = line
        .trim()
        .parse()
        .map_err(|_| format!("heyoka says `{}`", line.trim()))?;
    let n = problem.start.as_slice().len();
    let mut bytes = vec![0; 8 * n];
    let mut mu = vec![0.0; n];
    for look in 1..=looks {
        answer.read_exact(&mut bytes).map_err(failed)?;
        for (x, bytes) in mu.iter_mut().zip(bytes.chunks_exact(8)) {
            *x = f64::from_le_bytes(bytes.try_into().unwrap_or([0; 8]));
        }
        see(look as f64 * problem.delta, &mu);
    }
    child.wait().map_err(failed)?;
    Ok(seconds)
}
