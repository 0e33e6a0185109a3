//! The command lines of `lie exponents` and `lie frequencies`.

use std::path::PathBuf;

use clap::Args;
use lie_in_process::exponents::Asked;
use lie_in_process::request::{Parameter, Request, Value};

/// `lie exponents`.
#[derive(Args, Debug)]
#[command(
    after_help = "The tangents of the steps themselves are applied to vectors, which are made orthonormal behind each of them. An error is the
standard error of the mean, from 20 parts of the time, or the distance of the mean over its second half where that is larger.
Step, end and initial state are those of the spec's `run` where they are not given. Numbers may be exact constants: 1/7, -1/2.
Exit codes: 0 done, 1 surroundings failed, 2 invalid input, 3 a step failed: what was summed before is shown, 130 Ctrl-C, \
        143 SIGTERM, 129 SIGHUP: the same."
)]
pub struct Exponents {
    /// The spec file
    #[arg(value_name = "SPEC")]
    pub spec: PathBuf,
    /// The method, see `lie methods`, possibly with options of its own: "lie-midpoint --retraction cayley"
    #[arg(long, value_name = "ID")]
    pub method: Option<String>,
    /// Step size; negative along the flow backwards
    #[arg(long, alias = "h", value_name = "H", allow_hyphen_values = true)]
    pub step: Option<Value>,
    /// Final time
    #[arg(long, alias = "t", value_name = "T", allow_hyphen_values = true)]
    pub until: Option<Value>,
    /// Sets a parameter (repeatable)
    #[arg(long, value_name = "NAME=VALUE", allow_hyphen_values = true)]
    pub param: Vec<Parameter>,
    /// Initial state, separated by commas
    #[arg(long, alias = "x0", value_name = "V1,V2,…", allow_hyphen_values = true)]
    pub initial: Option<Value>,
    /// A time at the start that the sums leave out, in which orbit and vectors settle
    #[arg(long, value_name = "T0", allow_hyphen_values = true)]
    pub transient: Option<Value>,
    /// How many exponents, the largest ones; all without it
    #[arg(long, value_name = "K", allow_hyphen_values = true)]
    pub count: Option<Value>,
    /// Seed of the first vectors
    #[arg(long, value_name = "S", allow_hyphen_values = true)]
    pub seed: Option<Value>,
    /// Prints one JSON object
    #[arg(long)]
    pub json: bool,
    /// Says nothing on stderr unless something fails
    #[arg(long)]
    pub quiet: bool,
}

impl Exponents {
    /// What is asked of the steps, and beside them.
    pub fn asked(&self) -> (Request, Asked) {
        let request = Request {
            method: self.method.iter().cloned().collect(),
            param: self.param.clone(),
            initial: self.initial.clone(),
            step: self.step.clone(),
            until: self.until.clone(),
            seed: self.seed.clone(),
            ..Request::default()
        };
        let asked = Asked {
            transient: self.transient.clone(),
            count: self.count.clone(),
        };
        (request, asked)
    }
}

/// `lie frequencies`.
#[derive(Args, Debug)]
#[command(
    after_help = "The system is run as by `lie run`, and each signal is what its rows have in a column; they must be at equal distances. The
frequencies are angular. The drift is the difference between those of the first half of the time and of the second: an estimate of
the error of a regular motion, and the diffusion of a chaotic one.
Exit codes: as of `lie run`."
)]
pub struct Frequencies {
    /// The spec file
    #[arg(value_name = "SPEC")]
    pub spec: PathBuf,
    /// What is analysed, columns of `lie run` separated by commas: coordinates, Casimirs, declared functions, energy
    #[arg(long, value_name = "NAME,…", required = true, value_delimiter = ',')]
    pub of: Vec<String>,
    /// How many lines of each
    #[arg(long, value_name = "K", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..=100))]
    pub count: u32,
    /// Power of the window of Hann: a larger one keeps lines that are not shown from disturbing the others, and tells neighbours
    /// apart after a longer time
    #[arg(long, value_name = "P", default_value_t = 2, value_parser = clap::value_parser!(u8).range(0..=5))]
    pub window: u8,
    #[command(flatten)]
    pub request: Request,
    /// Prints one JSON object
    #[arg(long)]
    pub json: bool,
    /// Says nothing on stderr unless something fails
    #[arg(long)]
    pub quiet: bool,
}
