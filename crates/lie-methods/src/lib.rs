//! The methods of the catalogue over numbers, for systems made at run time.
//!
//! All methods are compiled here for double precision, so that cargo does it beside [`lie_dynamic`], which compiles them for a scalar that
//! records, and with full optimisation. Where an engine compiles programs, steps of methods without a solver become one program and
//! those of others run by traces; what is compiled here makes the steps that no program is for.
//!
//! ```
//! use lie_dynamic::{Dynamic, Interpreted};
//! use lie_methods::method;
//! use lie_codegen::{compile::compile_spec, methods::Choice, plan::plan};
//! use lie_runtime::{Poisson, newton::NewtonOptions};
//!
//! let spec = r#"{ "format": 1, "name": "Body", "algebra": "so(3)", "state": ["x", "y", "z"],
//!                 "hamiltonian": "x^2/2 + y^2/4 + z^2/6" }"#;
//! let model = compile_spec(spec).map_err(|errors| format!("{errors:?}"))?;
//! let midpoint = Choice::from_id("midpoint").map_err(|error| error.message)?;
//! let system = Dynamic::new(plan(&model, std::slice::from_ref(&midpoint)), &[], &Interpreted)?;
//! let method = method(&midpoint, Default::default());
//! let mut stepper = method.any_stepper(&system, 0.1, &NewtonOptions::default());
//! let mut mu = vec![0.3, -0.4, 1.2];
//! let energy = system.hamiltonian(&mu);
//! stepper.step(&mut mu).map_err(|failure| format!("{failure:?}"))?;
//! assert!((system.hamiltonian(&mu) - energy).abs() < 1e-15);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![forbid(unsafe_code)]
#![warn(missing_docs)]

use lie_codegen::methods::Choice;
use lie_dynamic::{
    Method, RecordedMethod, Tolerances, TracedInLanes, TracedMethod, at_defaults_over, composition,
    explicit, has_equation, method_over,
};
use lie_runtime::Scalar;
use lie_runtime::methods as m;

/// Numbers side by side.
type Wide = <f64 as Scalar>::Wide;

/// The method of a choice with its own defaults: series at the tolerance at which they are exact on every grid.
pub fn at_defaults(choice: &Choice) -> Method {
    match choice {
        Choice::Taylor | Choice::LieTaylor => at_defaults_over(choice),
        other => method(other, Tolerances::default()),
    }
}

/// The method of a choice. Whether it applies to a system is for the catalogue to say.
pub fn method(choice: &Choice, tolerances: Tolerances) -> Method {
    if let Some(apart) = explicit(choice) {
        return Box::new(RecordedMethod::patient(choice, apart));
    }
    if !has_equation(choice) {
        return method_over(choice, tolerances);
    }
    composition(choice, move |base| Some(method(base, tolerances))).unwrap_or_else(|| {
        let apart = method_over(choice, tolerances);
        Box::new(TracedMethod::new(choice, apart))
    })
}

/// The method of a choice over lanes, for systems side by side ([`Dynamic::in_lanes`](lie_dynamic::Dynamic::in_lanes)) that take it
/// ([`Dynamic::takes_lanes`](lie_dynamic::Dynamic::takes_lanes)).
///
/// The step is a program, which is compiled for lanes as for numbers, but for those that are
/// [compiled for lanes](lie_dynamic::is_compiled_for_lanes): series choose their own steps.
pub fn method_in_lanes(choice: &Choice, tolerances: Tolerances) -> Option<Method<Wide>> {
    Some(match choice {
        Choice::Taylor => Box::new(m::Taylor::from(tolerances)),
        Choice::Dopri5 => Box::new(m::Dopri5::from(tolerances)),
        // kernel by kernel for families, whose steps are loops over their sites
        Choice::Rk4 => Box::new(RecordedMethod::patient(choice, Box::new(m::Rk4))),
        _ if has_equation(choice) => {
            let traced = move |choice: &Choice| -> Option<Method<Wide>> {
                let alone = method_over(choice, tolerances);
                Some(Box::new(TracedInLanes::new(choice, alone)))
            };
            composition(choice, traced).or_else(|| traced(choice))?
        }
        _ => {
            let claims = explicit::<f64>(choice)?.claims();
            Box::new(RecordedMethod::at_once(choice, claims))
        }
    })
}
