//! The command line of the commands that measure many methods.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use lie_in_process::request::{Parameter, Request, Value};

use super::Cpu;

/// What the commands that measure many methods share.
#[derive(Args, Clone, Debug, Default)]
pub struct Measured {
    /// The spec file
    #[arg(value_name = "SPEC")]
    pub spec: PathBuf,
    /// The methods, separated by commas, each an id (with every option that applies) or an id with
    /// options: `midpoint,lie-midpoint --retraction cayley`; all that apply without it
    /// (repeatable)
    #[arg(long, visible_alias = "method", value_name = "LIST")]
    pub methods: Vec<String>,
    /// Sets a parameter (repeatable)
    #[arg(long, value_name = "NAME=VALUE", allow_hyphen_values = true)]
    pub param: Vec<Parameter>,
    /// Initial state, separated by commas
    #[arg(long, alias = "x0", value_name = "V1,V2,…", allow_hyphen_values = true)]
    pub initial: Option<Value>,
    /// Says nothing on stderr unless something fails
    #[arg(long)]
    pub quiet: bool,
    /// Build a program with cargo and measure that, in place of machine code made here (bench then compares with the crate
    /// ode_solvers too)
    #[arg(long)]
    pub compile: bool,
    /// Which processor to compile for (the results are the same, bit for bit); as --fma, implies --compile
    #[arg(long, value_enum)]
    pub cpu: Option<Cpu>,
    /// Rounds a product and its sum once (faster; other digits than on a processor without it)
    #[arg(long)]
    pub fma: bool,
}

impl Measured {
    /// Where the system starts, as it is asked for.
    pub fn start(&self) -> Request {
        Request {
            param: self.param.clone(),
            initial: self.initial.clone(),
            ..Request::default()
        }
    }

    /// Whether cargo builds what measures.
    pub fn is_compiled(&self) -> bool {
        self.compile || self.fma || self.cpu.is_some()
    }
}

/// `lie verify`.
#[derive(Args, Debug)]
#[command(
    after_help = "Exit codes: 0 every claim holds, 1 a claim fails, 2 invalid input, 130 Ctrl-C, 143 SIGTERM, 129 SIGHUP.
A family is verified with up to 64 coordinates."
)]
pub struct Verify {
    #[command(flatten)]
    pub measured: Measured,
    /// The step at which facts are measured (default: from the Jacobian of the vector field)
    #[arg(long, alias = "h", value_name = "H", allow_hyphen_values = true)]
    pub step: Option<Value>,
    /// Seed of the states near the initial one, and of paths of noise
    #[arg(
        long,
        value_name = "N",
        default_value_t = 1,
        allow_hyphen_values = true
    )]
    pub seed: u32,
    /// Prints one JSON object in place of the table
    #[arg(long)]
    pub json: bool,
}

/// `lie bench`.
#[derive(Args, Debug)]
#[command(
    after_help = "Without --until, the end is taken from the spec's `run`, but is at most 20; without either it is 10.
A family is measured with up to 100000 coordinates, by machine code made here alone.
energy and casimirs need no reference solution: they can be measured over any span (--until 1e6 --budget 5).
Exit codes: 0 done, 1 the reference solution was not confirmed, 2 invalid input, 130 Ctrl-C, \
        143 SIGTERM, 129 SIGHUP."
)]
pub struct Bench {
    #[command(flatten)]
    pub measured: Measured,
    /// Final time
    #[arg(long, alias = "t", value_name = "T", allow_hyphen_values = true)]
    pub until: Option<Value>,
    /// Seconds that a single run may take (default 0.2)
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    pub budget: Option<String>,
    /// The error that is set against run time
    #[arg(long, value_enum, default_value_t)]
    pub measure: Sense,
    /// The surface of `--measure section`: where this coordinate rises through this value; the middle of the
    /// coordinate that moves most without it
    #[arg(long, value_name = "NAME=VALUE", allow_hyphen_values = true)]
    pub section: Option<String>,
    /// Draws error against run time
    #[arg(long, value_name = "FILE.svg")]
    pub plot: Option<PathBuf>,
    /// Writes every measured point as CSV
    #[arg(long, value_name = "FILE.csv")]
    pub out: Option<PathBuf>,
}

/// `--measure`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Sense {
    /// Of the state at the end
    #[default]
    State,
    /// The largest drift of the energy over the run
    Energy,
    /// The largest drift of a Casimir over the run
    Casimirs,
    /// The time by which the end is ahead of the exact solution, or behind
    Phase,
    /// The distance from the exact points on a surface of section
    Section,
}

/// `lie stress`.
#[derive(Args, Debug)]
#[command(
    after_help = "Exit codes: 0 no claimed invariant is lost without a message, 1 one is, 2 invalid input, 130 Ctrl-C, \
        143 SIGTERM, 129 SIGHUP.
A family is stressed with up to 64 coordinates."
)]
pub struct Stress {
    #[command(flatten)]
    pub measured: Measured,
    /// Steps of the long run
    #[arg(
        long,
        value_name = "N",
        default_value = "10000000",
        allow_hyphen_values = true
    )]
    pub steps: String,
    /// Draws a map of what happened
    #[arg(long, value_name = "FILE.svg")]
    pub plot: Option<PathBuf>,
    /// Writes every experiment as CSV
    #[arg(long, value_name = "FILE.csv")]
    pub out: Option<PathBuf>,
}
