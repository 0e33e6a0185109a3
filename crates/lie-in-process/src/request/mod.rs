//! What a person asks of runs, and what it comes to for a system.
//!
//! A command line and a call from Python fill a [`Request`]; what they leave out, the `run` of the spec says, or a default.
//! [`several`] and [`plan()`] check it against the system, once for all of them, and answer every mistake together, in the
//! spelling of the [`Front`] at which it was made. A new option is a row of [`Request`], and what is made of it in
//! `solver`, `times` or `plan`; a call from Python has it as an argument of the same name.

mod cast;
mod chosen;
mod density;
mod front;
mod held;
mod keep;
mod measured;
pub mod method;
mod option_value;
mod plan;
mod point;
mod range;
mod runs;
mod several;
mod sites;
mod solver;
mod state;
mod states;
mod times;
mod value;

use std::collections::BTreeMap;
use std::path::PathBuf;

use lie_runtime::driver::Source;
use serde::{Deserialize, Serialize};

pub use cast::{Asked, Drawing, cast};
pub use front::Front;
pub use held::seed;
pub use measured::{span, step_of_facts};
pub use option_value::{OptionValue, constant};
pub use plan::{Plan, plan};
pub use point::{Point, start};
pub use runs::{Labels, Member, Several};
pub use several::{ranges, several};
pub use sites::bound_to_itself;
pub use value::{Parameter, Value};

/// The options with one value each, words or quantities: field, name as in the spec, what the value is called on the
/// command line, and the spelling of calls where that is another one.
macro_rules! request {
    (@hyphens word) => { false };
    (@hyphens quantity) => { true };
    ($($(#[$doc:meta])* $kind:ident $field:ident $name:literal $value:literal $(or $alias:literal)?;)*) => {
        /// What a person asks of runs.
        #[cfg_attr(feature = "clap", derive(clap::Args))]
        #[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
        #[serde(default, deny_unknown_fields)]
        pub struct Request {
            /// Who asks.
            #[serde(skip)]
            #[cfg_attr(feature = "clap", arg(skip))]
            pub front: Front,
            /// The method, see `lie methods`; given several times, one run for each, possibly with options of its own:
            /// --method rk4 --method "lie-midpoint --retraction cayley"
            #[cfg_attr(feature = "clap", arg(long, value_name = "ID"))]
            pub method: Vec<String>,
            /// Sets a parameter (repeatable); NAME=FROM:TO:COUNT makes a run for each of COUNT values at equal distances, both
            /// ends among them
            #[cfg_attr(feature = "clap", arg(long, value_name = "NAME=VALUE", allow_hyphen_values = true))]
            pub param: Vec<Parameter>,
            /// Makes a run for each initial state of a file: CSV, a state in each line, possibly below a line with the names of
            /// the coordinates; or NPY, a row for each state
            #[serde(rename = "initial-file")]
            #[cfg_attr(feature = "clap", arg(long, value_name = "FILE", conflicts_with = "initial"))]
            pub initial_file: Option<PathBuf>,
            /// Makes a second run behind each, with other steps, and says by how much its end is off: 1.25 times the time of the run
            #[cfg_attr(feature = "clap", arg(long))]
            pub assess: bool,
            /// Values of an input (repeatable): NAME=FILE with `time,value` in each line of CSV, or a row of NPY; each value is held from its
            /// time on
            #[cfg_attr(feature = "clap", arg(long, value_name = "NAME=FILE"))]
            pub input: Vec<String>,
            /// The same from a call.
            #[serde(skip)]
            #[cfg_attr(feature = "clap", arg(skip))]
            pub sources: BTreeMap<String, Source>,
            /// The stream of the noise, in a call that makes some of the members.
            #[serde(skip)]
            #[cfg_attr(feature = "clap", arg(skip))]
            pub stream: u64,
            $(
                $(#[$doc])*
                #[serde(rename = $name)]
                #[cfg_attr(feature = "clap", arg(
                    long,
                    value_name = $value,
                    allow_hyphen_values = request!(@hyphens $kind),
                    $(alias = $alias)?
                ))]
                pub $field: Option<Value>,
            )*
        }

        impl Request {
            /// The files that it reads beside the spec, with their options.
            pub fn files(&self) -> Vec<(&'static str, PathBuf)> {
                let states = self.initial_file.iter();
                let states = states.map(|path| ("--initial-file", path.clone()));
                let tables = self.input.iter().filter_map(|written| written.split_once('='));
                let tables = tables.map(|(_, path)| ("--input", PathBuf::from(path.trim())));
                states.chain(tables).collect()
            }

            /// An option by its name.
            pub fn get(&self, name: &str) -> Option<&Value> {
                match name {
                    $($name => self.$field.as_ref(),)*
                    _ => None,
                }
            }

            /// Sets an option by its name; whether there is one.
            pub fn set(&mut self, name: &str, value: Value) -> bool {
                match name {
                    $($name => self.$field = Some(value),)*
                    _ => return false,
                }
                true
            }

            /// Whether the value of an option is a word, which is no number.
            pub fn is_word(name: &str) -> bool {
                match name {
                    $($name => stringify!($kind) == "word",)*
                    _ => false,
                }
            }
        }

        /// Options with another name in calls.
        const IN_CALLS: &[(&str, &str)] = &[("param", "parameters"), $($(($name, $alias),)?)*];
    };
}

request! {
    /// Initial state, separated by commas
    quantity initial "initial" "V1,V2,…" or "x0";
    /// Step size; negative to go backwards. dopri5, taylor and lie-taylor choose their own steps, but land on every
    /// multiple of this
    quantity step "step" "H" or "h";
    /// Relative error at the end, in place of --step: chooses a constant step, and without --method the method too
    quantity tol "tol" "E";
    /// Time at the start (default 0); --until and --at are times too, not spans from there
    quantity from "from" "T0" or "t0";
    /// Final time
    quantity until "until" "T" or "t";
    /// Writes every K-th step (default 1) and the last one
    quantity every "every" "K";
    /// Writes the state at these times only, separated by commas; excludes --until and --every
    quantity at "at" "T1,T2,…";
    /// Writes COUNT states at equal distances from T1 to T2, both among them, in place of those of the steps; the end is that of
    /// --until or of the spec, else T2
    quantity rows "rows" "T1:T2:COUNT";
    /// Retraction of lie-midpoint and of generating methods: exp or cayley; of lie-midpoint also spec,
    /// the one that is declared
    word retraction "retraction" "NAME";
    /// Coefficients of a composition or a splitting: suzuki, triple-jump, kahan-li, …; some are for two pieces of which one is small (`lie methods` lists them)
    word composition "composition" "NAME";
    /// Pieces of a splitting: found (default: the fewest with exact flows; `lie check` lists them) or coordinate (H = sum f_i(x_i), in the order of the coordinates)
    word pieces "pieces" "NAME";
    /// Space over g* of a collective method: representation, hopf or spec (the declared realization)
    word lift "lift" "NAME";
    /// Discrete gradient of orbit-energy: gonzalez, mean-value or itoh-abe
    word gradient "gradient" "NAME";
    /// Poisson tensor of gonzalez, mean-value, itoh-abe: midpoint or mean
    word tensor "tensor" "NAME";
    /// Writes the group element beside mu, from the declared attitude or the identity on: matrix; for rotations quaternion, or
    /// euler:zxz with any axes, angles in radians that are followed from step to step
    word group "group" "CHART";
    /// Relative tolerance of dopri5 (default 1e-6), taylor and lie-taylor (default 1e-15)
    quantity rtol "rtol" "TOL";
    /// Absolute tolerance of dopri5 (default 1e-9)
    quantity atol "atol" "TOL";
    /// How implicit methods solve a step: newton (a new Jacobian in every iteration), simplified (that of
    /// the start), fixed-point (none), or automatic (default; fixed-point where that pays, newton elsewhere)
    word iteration "iteration" "NAME";
    /// Error at which that iteration ends, in units of round-off of the state (default 1/1024, so
    /// that it does not add up; 0 goes on until nothing changes)
    quantity newton_tolerance "newton-tolerance" "TOL";
    /// Iterations after which a step has failed (default: newton 50, also where that is
    /// chosen automatically; simplified 200, fixed-point 500)
    quantity max_iterations "max-iterations" "N";
    /// What has converged where stages that are evaluated together end, as in gauss16: state, map (its derivative too, so
    /// that a Poisson map is one to round-off; default of collective and isospectral methods), or tolerance (with --tol: as
    /// far as that asks, in about half of the evaluations; what the method preserves is preserved as far)
    word converge "converge" "NAME";
    /// Brings the state back behind each step of taylor, dopri5 or rk4 to the values that energy and Casimirs have at the start:
    /// energy, casimirs or energy,casimirs. They are kept to round-off; the steps are no Poisson maps for that
    word keep "keep" "WHAT";
    /// Lets the size of steps follow the motion: reversible, by an integrating step density from --step or the step that --tol chooses, or
    /// constant. A symmetric method stays reversible, so that the energy of reversible motion does not drift; the steps are no Poisson maps
    word density "density" "NAME";
    /// Seed of noise, and of initial states that are drawn (default 1)
    quantity seed "seed" "S";
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_request_comes_back_from_text_and_knows_its_keys() {
        let mut request = Request {
            method: vec!["rk4".to_owned()],
            param: vec![Parameter::Set("k".to_owned(), Value::Number(0.1 + 0.2))],
            ..Request::default()
        };
        assert!(request.set("newton-tolerance", Value::Text("1/7".to_owned())));
        assert!(!request.set("speed", Value::Number(1.0)));
        let text = serde_json::to_string(&request).unwrap();
        assert_eq!(serde_json::from_str::<Request>(&text).unwrap(), request);
        assert!(serde_json::from_str::<Request>(r#"{"speed": 1}"#).is_err());
        assert!(Request::is_word("group") && !Request::is_word("step"));
    }

    #[test]
    fn options_are_spelt_as_they_are_written() {
        let (command, call) = (Front::Command, Front::Call);
        assert_eq!(command.assignment("step", "0.1"), "`--step 0.1`");
        assert_eq!(call.assignment("step", "0.1"), "h=0.1");
        assert_eq!(call.assignment("converge", "state"), "converge=\"state\"");
        assert_eq!(call.option("newton-tolerance"), "newton_tolerance");
        for name in ["step", "until", "initial", "newton-tolerance", "at"] {
            assert_eq!(Front::canonical(&call.option(name)), name);
        }
    }
}
