//! The command line, as clap reads it. Values that may be exact constants stay text here.

mod measured;

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

pub use measured::{Bench, Measured, Sense, Stress, Verify};

/// Structure-preserving integrators for Lie–Poisson systems.
#[derive(Debug, Parser)]
#[command(
    name = "lie",
    version,
    about,
    max_term_width = 100,
    disable_help_subcommand = true
)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Checks specs: algebra, Hamiltonian, Casimirs, and which methods apply
    Check(Check),
    /// Prints the generated Rust code of a spec
    Expand(Expand),
    /// Integrates a spec with its generated, compiled code
    Run(Box<Run>),
    /// Measures every fact that the methods claim, on a spec
    Verify(Verify),
    /// Compares methods on a spec: the error at the end against the run time
    Bench(Bench),
    /// Takes methods to the limits of steps, parameters and states, and through a long run
    Stress(Stress),
    /// Writes a page of HTML: mathematics, trajectory, orbit, errors against run time, generated code
    Report(Box<Report>),
    /// Lists the methods: order, what they preserve, what they need, reference
    Methods(Methods),
    /// Prints the JSON Schema of spec files
    Schema,
    /// Writes a spec that runs, for an algebra by its name
    New(New),
    /// Shows where built programs are kept, or removes them
    Cache(Cache),
    #[command(flatten)]
    Later(Later),
}

/// Names that are kept for commands to come.
#[derive(Debug, Subcommand)]
pub enum Later {
    #[command(hide = true)]
    Ensemble(Anything),
    #[command(hide = true)]
    Merge(Anything),
    #[command(hide = true)]
    Resume(Anything),
    #[command(hide = true)]
    Advise(Anything),
    #[command(hide = true)]
    Equilibria(Anything),
}

impl Later {
    /// The name as it was typed.
    pub fn name(&self) -> &'static str {
        match self {
            Later::Ensemble(_) => "ensemble",
            Later::Merge(_) => "merge",
            Later::Resume(_) => "resume",
            Later::Advise(_) => "advise",
            Later::Equilibria(_) => "equilibria",
        }
    }
}

/// `lie new`.
#[derive(Args, Debug)]
pub struct New {
    /// The name of the file, without `.json`
    #[arg(value_name = "NAME")]
    pub name: String,
    /// The algebra, as in `"algebra"` of a spec
    #[arg(long, value_name = "ALGEBRA", default_value = "so(3)")]
    pub algebra: String,
}

/// `lie report`.
#[derive(Args, Debug)]
#[command(
    after_help = "Exit codes: 0 the page is written, 1 a file cannot be, 2 invalid input, 3 a run stopped early and the \
        page says why, 130 Ctrl-C, 143 SIGTERM, 129 SIGHUP."
)]
pub struct Report {
    /// The spec file
    #[arg(value_name = "SPEC")]
    pub spec: PathBuf,
    /// The method, see `lie methods`; given several times, all are compared, and the first is shown in full
    #[arg(long, value_name = "ID")]
    pub method: Vec<String>,
    /// Step size
    #[arg(long, value_name = "H", allow_hyphen_values = true)]
    pub step: Option<String>,
    /// Relative error at the end, in place of --step
    #[arg(long, value_name = "E", allow_hyphen_values = true)]
    pub tol: Option<String>,
    /// Final time
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub until: Option<String>,
    /// Sets a parameter (repeatable)
    #[arg(long, value_name = "NAME=VALUE", allow_hyphen_values = true)]
    pub param: Vec<String>,
    /// Initial state, separated by commas
    #[arg(long, value_name = "V1,V2,…", allow_hyphen_values = true)]
    pub initial: Option<String>,
    /// Leaves out the comparison of methods, which takes some seconds
    #[arg(long)]
    pub no_bench: bool,
    /// Where the page goes (default: the name of the spec, .html)
    #[arg(long, value_name = "FILE.html")]
    pub out: Option<PathBuf>,
    /// Says nothing on stderr unless something fails
    #[arg(long)]
    pub quiet: bool,
}

/// `lie cache`.
#[derive(Args, Debug)]
pub struct Cache {
    /// Removes all that is in it
    #[arg(long)]
    pub clear: bool,
}

/// Whatever follows the name of a command that does not exist yet.
#[derive(Args, Debug)]
pub struct Anything {
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    _rest: Vec<String>,
}

/// `lie check`.
#[derive(Args, Debug)]
pub struct Check {
    /// The spec files
    #[arg(value_name = "SPEC", required = true)]
    pub specs: Vec<PathBuf>,
    /// Prints one JSON object (an array for several specs)
    #[arg(long)]
    pub json: bool,
    /// Looks for Casimirs as long as it takes, up to minutes
    #[arg(long)]
    pub deep: bool,
}

/// `lie expand`.
#[derive(Args, Debug)]
pub struct Expand {
    /// The spec file
    #[arg(value_name = "SPEC")]
    pub spec: PathBuf,
    /// Emits fused code for this method (repeatable), in place of the spec's `methods`: an id, with every option that
    /// applies, or with options such as "lie-midpoint --retraction cayley"
    #[arg(long, value_name = "ID")]
    pub method: Vec<String>,
    /// The path at which the code finds the runtime, where another crate re-exports it [default: ::lie_runtime]
    #[arg(long = "crate", value_name = "PATH")]
    pub runtime: Option<String>,
    /// Prints the plan of the code instead: what is computed, with operation counts
    #[arg(long)]
    pub plan: bool,
}

/// `lie methods`.
#[derive(Args, Debug)]
pub struct Methods {
    /// Prints the catalogue as JSON
    #[arg(long)]
    pub json: bool,
}

/// `lie run`.
#[derive(Args, Clone, Debug, Default)]
#[command(after_help = "Numbers may be exact constants: 1/7, -1/2, cos(11/10).
Flags override the `run` keys of the spec; without either: --method lie-midpoint (midpoint \
    if the bracket is not the Lie–Poisson bracket of an algebra) --step 0.01 --until 10.
Exit codes: 0 done, 1 surroundings failed, 2 invalid input, 3 integration stopped early, 130 Ctrl-C, 143 SIGTERM, \
    129 SIGHUP: ended in order, rows kept.")]
pub struct Run {
    /// The spec file
    #[arg(value_name = "SPEC", required = true)]
    pub specs: Vec<PathBuf>,
    /// The method, see `lie methods`; given several times, one run for each, possibly with options of its own:
    /// --method rk4 --method "lie-midpoint --retraction cayley"
    #[arg(long, value_name = "ID")]
    pub method: Vec<String>,
    /// Step size; negative to go backwards. dopri5, taylor and lie-taylor choose their own steps, but land on every
    /// multiple of this
    #[arg(long, value_name = "H", allow_hyphen_values = true)]
    pub step: Option<String>,
    /// Relative error at the end, in place of --step: chooses a constant step, and without --method the method too
    #[arg(long, value_name = "E", allow_hyphen_values = true)]
    pub tol: Option<String>,
    /// Final time
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub until: Option<String>,
    /// Writes every K-th step (default 1) and the last one
    #[arg(long, value_name = "K", allow_hyphen_values = true)]
    pub every: Option<String>,
    /// Writes the state at these times only, separated by commas; excludes --until and --every
    #[arg(long, value_name = "T1,T2,…", allow_hyphen_values = true)]
    pub at: Option<String>,
    /// Sets a parameter (repeatable); NAME=FROM:TO:COUNT makes a run for each of COUNT values at equal distances, both ends
    /// among them
    #[arg(long, value_name = "NAME=VALUE", allow_hyphen_values = true)]
    pub param: Vec<String>,
    /// Initial state, separated by commas
    #[arg(long, value_name = "V1,V2,…", allow_hyphen_values = true)]
    pub initial: Option<String>,
    /// Makes a run for each initial state of a file: CSV, a state in each line, possibly below a line with the names of the
    /// coordinates; or NPY, a row for each state
    #[arg(long, value_name = "FILE", conflicts_with = "initial")]
    pub initial_file: Option<PathBuf>,
    #[command(flatten)]
    pub method_options: MethodOptions,
    /// Writes the group element beside mu, from the identity on: matrix, or quaternion for rotations
    #[arg(long, value_name = "CHART")]
    pub group: Option<String>,
    /// Relative tolerance of dopri5 (default 1e-6), taylor and lie-taylor (default 1e-15)
    #[arg(long, value_name = "TOL", allow_hyphen_values = true)]
    pub rtol: Option<String>,
    /// Absolute tolerance of dopri5 (default 1e-9)
    #[arg(long, value_name = "TOL", allow_hyphen_values = true)]
    pub atol: Option<String>,
    #[command(flatten)]
    pub solver: SolverOptions,
    /// Form of the output (default: what the extension of --out says, csv where there is none)
    #[arg(long, value_enum)]
    pub format: Option<Format>,
    /// Writes to a file instead of stdout
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Draws the runs: .svg, .png or .pdf
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
    /// What --plot draws: components (over time, with the errors of the invariants; default of one run), orbit (the coadjoint
    /// orbit of a three-dimensional algebra), phase or phase:X,Y, section or section:X=VALUE, attitude (with --group), compare
    /// (runs side by side; default of several)
    #[arg(long, value_name = "KIND")]
    pub picture: Option<String>,
    /// Says nothing on stderr unless something fails
    #[arg(long)]
    pub quiet: bool,
    /// Build a program with cargo and run that, in place of machine code made here: for very long runs (the results are the
    /// same, bit for bit)
    #[arg(long)]
    pub compile: bool,
    /// Which processor to compile for (the results are the same, bit for bit); as --fma, implies --compile
    #[arg(long, value_enum)]
    pub cpu: Option<Cpu>,
    /// Rounds a product and its sum once (faster; other digits than on a processor without it)
    #[arg(long)]
    pub fma: bool,
}

/// The solver of implicit methods.
#[derive(Args, Clone, Debug, Default)]
pub struct SolverOptions {
    /// How implicit methods solve a step: newton (a new Jacobian in every iteration), simplified (that of
    /// the start), fixed-point (none), or automatic (default; fixed-point where that pays, newton elsewhere)
    #[arg(long, value_name = "NAME")]
    pub iteration: Option<String>,
    /// Error at which that iteration ends, in units of round-off of the state (default 1/1024, so
    /// that it does not add up; 0 goes on until nothing changes)
    #[arg(long, value_name = "TOL", allow_hyphen_values = true)]
    pub newton_tolerance: Option<String>,
    /// Iterations after which a step has failed (default: newton 50, also where that is
    /// chosen automatically; simplified 200, fixed-point 500)
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    pub max_iterations: Option<String>,
    /// What has converged where stages that are evaluated together end, as in gauss16: state, map (its derivative too, so
    /// that a Poisson map is one to round-off; default of collective and isospectral methods), or tolerance (with --tol: as
    /// far as that asks, in about half of the evaluations; what the method preserves is preserved as far)
    #[arg(long, value_name = "NAME")]
    pub converge: Option<String>,
}

/// The options by which a method is chosen, see `lie methods`.
#[derive(Args, Clone, Debug, Default)]
pub struct MethodOptions {
    /// Retraction of lie-midpoint and of generating methods: exp or cayley
    #[arg(long, value_name = "NAME")]
    pub retraction: Option<String>,
    /// Coefficients of a composition or a splitting: suzuki, triple-jump, kahan-li, …; for two pieces of which one is small: saba2, saba4, sbab2, sbab4, mclachlan-8-4
    #[arg(long, value_name = "NAME")]
    pub composition: Option<String>,
    /// Pieces of a splitting: found (default: the fewest with exact flows; `lie check` lists them) or coordinate (H = sum f_i(x_i), in the order of the coordinates)
    #[arg(long, value_name = "NAME")]
    pub pieces: Option<String>,
    /// Space over g* of a collective method: representation, hopf or spec (the declared realization)
    #[arg(long, value_name = "NAME")]
    pub lift: Option<String>,
    /// Discrete gradient of orbit-energy: gonzalez, mean-value or itoh-abe
    #[arg(long, value_name = "NAME")]
    pub gradient: Option<String>,
    /// Poisson tensor of gonzalez, mean-value, itoh-abe: midpoint or mean
    #[arg(long, value_name = "NAME")]
    pub tensor: Option<String>,
}

impl MethodOptions {
    /// An option by its name, with its flag.
    pub fn get(&self, name: &str) -> Option<(&'static str, &String)> {
        let (flag, value) = match name {
            "retraction" => ("--retraction", &self.retraction),
            "composition" => ("--composition", &self.composition),
            "pieces" => ("--pieces", &self.pieces),
            "lift" => ("--lift", &self.lift),
            "gradient" => ("--gradient", &self.gradient),
            "tensor" => ("--tensor", &self.tensor),
            _ => return None,
        };
        value.as_ref().map(|value| (flag, value))
    }
}

/// `--format`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// A header line, then one line per row
    Csv,
    /// One object with columns and rows
    Json,
    /// A numpy array of float64, one row per time
    Npy,
}

/// `--cpu`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Cpu {
    /// This machine's, with every instruction that it has
    #[default]
    Native,
    /// Any of this machine's architecture
    Portable,
}
