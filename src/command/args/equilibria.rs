//! The command line of `lie equilibria`.

use std::path::PathBuf;

use clap::Args;
use lie_in_process::request::{Parameter, Request, Value};

/// `lie equilibria`.
#[derive(Args, Debug)]
#[command(
    after_help = "The leaf is that of the initial state: where the Casimirs have the values that they have there, or those of --casimir.
Numbers may be exact constants: 1/7, -1/2, cos(11/10).
Exit codes: 0 done, 1 surroundings failed, 2 invalid input."
)]
pub struct Equilibria {
    /// The spec file
    #[arg(value_name = "SPEC")]
    pub spec: PathBuf,
    /// Sets a parameter (repeatable); NAME=FROM:TO:COUNT for one of them follows the branches of equilibria over that range
    #[arg(long, value_name = "NAME=VALUE", allow_hyphen_values = true)]
    pub param: Vec<Parameter>,
    /// Initial state, separated by commas
    #[arg(long, alias = "x0", value_name = "V1,V2,…", allow_hyphen_values = true)]
    pub initial: Option<Value>,
    /// Sets the value of a Casimir, in place of that at the initial state (repeatable)
    #[arg(long, value_name = "NAME=VALUE", allow_hyphen_values = true)]
    pub casimir: Vec<String>,
    /// Starts of the search beside the initial state and the axes
    #[arg(long, value_name = "N", default_value_t = 200, value_parser = clap::value_parser!(u32).range(0..=1_000_000))]
    pub starts: u32,
    /// Seed of the starts
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u32,
    /// Prints one JSON object
    #[arg(long)]
    pub json: bool,
    /// Draws the branches of --param NAME=FROM:TO:COUNT, solid where they are stable, dashed elsewhere
    #[arg(long, value_name = "FILE.svg")]
    pub plot: Option<PathBuf>,
    /// Says nothing on stderr unless something fails
    #[arg(long)]
    pub quiet: bool,
}

impl Equilibria {
    /// What is asked of the start, but for the ranges of parameters.
    pub fn start(&self) -> Request {
        Request {
            param: self.param.clone(),
            initial: self.initial.clone(),
            ..Request::default()
        }
    }
}
