//! How long the compiler takes for random declarations: reading and checking, deriving with
//! scheduling and emission, formatting.
//!
//! `cargo bench -p lie-codegen --bench declarations` draws 1,000 declarations from a seed, prints
//! the distribution of the times and the worst 20 with their kernels. A procedural macro is built
//! without optimisation by cargo: the same with `--profile unoptimised`. Arguments after `--`:
//! `--count N`, `--seed N`, `--worst N`, `--only I,J,…` (these declarations alone), `--list FILE`
//! (the worst with their text, as Markdown), `--progress`, `--spec FILE,…` (these specs and nothing drawn).
//!
//! Times are processor time of this thread. Beside them stand counts that are the same on every machine:
//! the nodes and operands of the arena when all kernels are scheduled, and the operations of all kernels.

mod clock;
mod draw;
mod hamiltonians;
#[path = "../../tests/compiler/random/mod.rs"]
mod random;
mod report;

use std::fmt::Write as _;

use clock::Clock;
use draw::Declaration;
use lie_codegen::compile::{compile_spec, declared_choices};
use lie_codegen::derive::Source;
use lie_codegen::plan::plan;
use lie_codegen::print::{Surface, print};
use lie_symbolic::schedule::Counts;

/// What a declaration cost.
pub struct Cost {
    /// Its number in the drawing.
    pub index: usize,
    /// The kind of declaration.
    pub family: &'static str,
    /// The spec.
    pub text: String,
    /// The first mistake, of a declaration that is refused.
    pub refused: Option<String>,
    /// Seconds for reading and checking.
    pub check: f64,
    /// Seconds for deriving, scheduling and emitting.
    pub generate: f64,
    /// Seconds for formatting, as `lie expand` does and a macro does not.
    pub format: f64,
    /// Nodes and operands in the arena behind the basic kernels.
    pub arena: usize,
    /// Weighted operations of all kernels.
    pub operations: usize,
}

impl Cost {
    /// What a macro takes.
    pub fn total(&self) -> f64 {
        self.check + self.generate
    }
}

/// A kernel of a declaration.
pub struct KernelCost {
    /// Its name.
    pub name: String,
    /// Seconds for its schedule.
    pub seconds: f64,
    /// Nodes and operands that scheduling added to the arena.
    pub added: usize,
    /// Operations of the program.
    pub counts: Counts,
}

fn measure(declaration: &Declaration) -> Cost {
    let mut cost = Cost {
        index: declaration.index,
        family: declaration.family,
        text: declaration.spec.clone(),
        refused: None,
        check: 0.0,
        generate: 0.0,
        format: 0.0,
        arena: 0,
        operations: 0,
    };
    let clock = Clock::start();
    let checked = compile_spec(&declaration.spec);
    cost.check = clock.seconds();
    let model = match checked {
        Ok(model) => model,
        Err(mistakes) => {
            let message = mistakes.first().map(|mistake| mistake.message.clone());
            cost.refused = Some(message.unwrap_or_default());
            return cost;
        }
    };
    let choices = declared_choices(&model);
    let clock = Clock::start();
    let plan = plan(&model, &choices);
    let items = print(&plan, &Surface::new(&model));
    cost.generate = clock.seconds();
    cost.operations = plan.counts().iter().map(|(_, c)| c.weight()).sum();
    let clock = Clock::start();
    if let Ok(file) = syn::parse2(items) {
        drop(prettyplease::unparse(&file));
    }
    cost.format = clock.seconds();
    cost
}

/// The basic kernels of a declaration one by one, and the arena behind them.
fn dissect(cost: &mut Cost) -> Vec<KernelCost> {
    let Ok(model) = compile_spec(&cost.text) else {
        return Vec::new();
    };
    let mut source = Source::new(&model);
    let mut kernels = source.basic_kernels();
    kernels.extend(source.midpoint_kernels());
    let mut costs = Vec::new();
    for kernel in &kernels {
        let before = source.graph.size();
        let clock = Clock::start();
        let program = kernel.program(&mut source.graph);
        costs.push(KernelCost {
            name: kernel.name.to_owned(),
            seconds: clock.seconds(),
            added: source.graph.size() - before,
            counts: program.counts,
        });
    }
    cost.arena = source.graph.size();
    costs
}

struct Arguments {
    count: usize,
    seed: u64,
    worst: usize,
    only: Option<Vec<usize>>,
    list: Option<String>,
    specs: Option<String>,
    progress: bool,
}

impl Arguments {
    fn read() -> Result<Self, String> {
        let mut arguments = Self {
            count: 1000,
            seed: 2018,
            worst: 20,
            only: None,
            list: None,
            specs: None,
            progress: false,
        };
        let mut words = std::env::args().skip(1);
        while let Some(word) = words.next() {
            let mut value = || words.next().ok_or(format!("{word} needs a value"));
            let number = |text: String| {
                text.parse()
                    .map_err(|_| format!("`{text}` is not a number"))
            };
            match word.as_str() {
                "--bench" => {}
                "--count" => arguments.count = number(value()?)?,
                "--seed" => arguments.seed = number(value()?)? as u64,
                "--worst" => arguments.worst = number(value()?)?,
                "--only" => {
                    let list = value()?;
                    let numbers: Result<_, _> =
                        list.split(',').map(|n| number(n.to_owned())).collect();
                    arguments.only = Some(numbers?);
                }
                "--spec" => arguments.specs = Some(value()?),
                "--list" => arguments.list = Some(value()?),
                "--progress" => arguments.progress = true,
                _ => return Err(format!("unknown argument `{word}`")),
            }
        }
        Ok(arguments)
    }
}

fn read(files: &str) -> Result<Vec<Declaration>, String> {
    let files = files.split(',').enumerate();
    files
        .map(|(index, path)| {
            let spec = std::fs::read_to_string(path).map_err(|error| format!("{path}: {error}"))?;
            Ok(Declaration {
                index,
                family: "spec",
                spec,
            })
        })
        .collect()
}

fn main() -> Result<(), String> {
    let arguments = Arguments::read()?;
    let declarations = match &arguments.specs {
        Some(files) => read(files)?,
        None => draw::declarations(arguments.seed, arguments.count),
    };
    let wanted = |index: usize| match &arguments.only {
        Some(only) => only.contains(&index),
        None => true,
    };
    let mut costs = Vec::new();
    for declaration in declarations.iter().filter(|d| wanted(d.index)) {
        let cost = measure(declaration);
        if arguments.progress || cost.total() > 10.0 {
            eprintln!("{} {} {:.2} s", cost.index, cost.family, cost.total());
        }
        costs.push(cost);
    }
    print!("{}", report::distribution(&costs));
    costs.sort_by(|a, b| b.total().total_cmp(&a.total()));
    costs.truncate(arguments.worst);
    let mut list = String::new();
    println!("{}", report::HEAD);
    for cost in &mut costs {
        let kernels = dissect(cost);
        println!("{}", report::row(cost, &kernels));
        let _ = write!(list, "{}", report::entry(cost, &kernels));
    }
    if let Some(path) = arguments.list {
        std::fs::write(&path, list).map_err(|error| format!("{path}: {error}"))?;
    }
    Ok(())
}
