//! Measures the weak orders of methods on noise over 10^6 paths for each step; writes `lab/docs/weak_orders.md`.
//!
//! ```text
//! cargo run --release -p lab --features long --bin weak_orders            # all rows, more than an hour
//! cargo run --release -p lab --features long --bin weak_orders -- 20000   # over so many paths, to standard output
//! cargo run --release -p lab --features long --bin weak_orders -- 20000 top   # of rows that say `top` alone
//! ```

use lie_measure::facts::{Finding, Ground};
use lie_runtime::diagnostics::AnyMethod;
use lie_runtime::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

const PATHS: usize = 1_000_000;
/// The largest step where errors of order 2 are measured, or small ones: shorter ones leave nothing but the scatter of paths.
const LONG: Option<f64> = Some(0.4);
/// The same where both are small.
const LONGEST: Option<f64> = Some(0.8);

lie_poisson! {
    /// A body with noise along one direction.
    pub system OneNoise;
    algebra = so(3);
    state x, y, z;
    hamiltonian = x^2/2 + y^2/4 + z^2/6 + x^3/9 + y/5;
    noise { hamiltonian = (x + 2*y - z)/3; }
    initial = [3/5, -1/2, 7/10];
}

lie_poisson! {
    /// A body with noise along two directions that do not commute.
    pub system TwoNoises;
    algebra = so(3);
    state x, y, z;
    hamiltonian = x^2/2 + y^2/4 + z^2/6 + x^3/9 + y/5;
    noise { hamiltonian = 2*x/5 + y/5; hamiltonian = z/2 - x/3; }
    initial = [3/5, -1/2, 7/10];
}

lie_poisson! {
    /// A body with noise along two quadratic Hamiltonians.
    pub system Bent;
    algebra = so(3);
    state x, y, z;
    hamiltonian = x^2/2 + y^2/4 + z^2/6 + x^3/9 + y/5;
    noise { hamiltonian = x^2/3 - y*z/4; hamiltonian = z^2/5 + x*y/3; }
    initial = [3/5, -1/2, 7/10];
}

lie_poisson! {
    /// A body under a torque that depends on the time, with drag and a torque that fluctuates.
    pub system Forced;
    algebra = so(3);
    state x, y, z;
    hamiltonian = x^2/2 + y^2/4 + z^2/6;
    forces { x = cos(2*t)/3 - x/5; y = -2*y/5; z = 1/4 - 3*z/5; }
    noise { force(x = 1/3, z = 1/5); force(y = 2/5); }
    initial = [3/5, -1/2, 7/10];
}

lie_poisson! {
    /// A body in a bath: friction, and the noise that belongs to it.
    pub system Bath;
    algebra = so(3);
    state x, y, z;
    hamiltonian = x^2/2 + y^2/4 + z^2/6;
    dissipation { rayleigh(matrix = [[1/5, 0, 0], [0, 2/5, 0], [0, 0, 3/5]], temperature = 1/2); }
    initial = [3/5, -1/2, 7/10];
}

lie_poisson! {
    /// A spin in a field with an easy axis, with Gilbert damping at a temperature.
    pub system Spin;
    algebra = so(3);
    state x, y, z;
    hamiltonian = -z - x^2/3;
    dissipation { double-bracket(strength = 1/5, temperature = 1/2); }
    initial = [3/5, -1/2, 7/10];
}

lie_poisson! {
    /// A heavy top on which torques and its support fluctuate.
    pub system Top;
    algebra = se(3);
    state L1, L2, L3, G1, G2, G3;
    hamiltonian = L1^2/2 + L2^2/3 + L3^2/2 + G3 + G1/4;
    noise { hamiltonian = L1/3 + G2/4; hamiltonian = L3/4 + G1/3; }
    initial = [2/5, 1/5, 3/2, 3/5, 0, 4/5];
}

/// A row that is measured when it is asked for.
struct Row {
    system: &'static str,
    method: &'static str,
    measure: Box<dyn Fn(usize) -> Finding + Send + Sync>,
}

/// The rows of a system by some methods.
macro_rules! rows {
    ($rows:ident, $name:literal, $system:ident, $step:expr, [$($id:literal $method:expr),* $(,)?]) => {
        let system = $system::new().system().expect("a system");
        let start = $system::<f64>::new().initial_state();
        let lifted = system.lift();
        let ground = Ground::new(&system, &start, 1, $step).expect("it moves");
        let noise = ground.with_noise(&system, &lifted, (1, None)).noise.expect("it has noise");
        let both = Arc::new((system, noise));
        $(let shared = Arc::clone(&both);
        $rows.push(Row {
            system: $name,
            method: $id,
            measure: Box::new(move |paths| {
                let (system, noise) = &*shared;
                let method: Box<dyn AnyMethod<f64, _>> = Box::new($method);
                noise.weak_order(system, &*method, Some(paths))
            }),
        });)*
    };
}

fn main() {
    let mut arguments = std::env::args().skip(1);
    let chosen = arguments.next();
    let chosen = chosen.map(|text| text.parse().expect("a number of paths"));
    let mut rows: Vec<Row> = Vec::new();
    rows!(rows, "body, one direction", OneNoise, None, [
        "rk4" Rk4, "midpoint" ImplicitMidpoint, "gauss4" Gauss4, "lie-midpoint(cayley)" LieMidpoint::cayley(),
        "rkmk2" Rkmk2, "cf4" CommutatorFree4, "splitting1" Splitting1::new(),
    ]);
    rows!(rows, "body, one direction", OneNoise, LONG, [
        "splitting2" Splitting2::new(), "ninomiya-victoir" NinomiyaVictoir,
    ]);
    rows!(rows, "body, two directions", TwoNoises, None, [
        "rk4" Rk4, "midpoint" ImplicitMidpoint, "gauss4" Gauss4,
        "rkmk2" Rkmk2, "cf4" CommutatorFree4, "splitting1" Splitting1::new(),
    ]);
    rows!(rows, "body, two directions", TwoNoises, LONGEST, [
        "splitting2" Splitting2::new(),
    ]);
    rows!(rows, "body, two directions", TwoNoises, LONG, [
        "ninomiya-victoir" NinomiyaVictoir,
    ]);
    rows!(rows, "body, two quadratic Hamiltonians", Bent, None, [
        "rk4" Rk4, "lie-midpoint(cayley)" LieMidpoint::cayley(),
    ]);
    rows!(rows, "torques and drag", Forced, LONG, [
        "rk4" Rk4, "lie-midpoint(cayley)" LieMidpoint::cayley(), "splitting2" Splitting2::new(), "ninomiya-victoir" NinomiyaVictoir,
    ]);
    rows!(rows, "friction at a temperature", Bath, LONG, [
        "lie-midpoint(cayley)" LieMidpoint::cayley(), "splitting2" Splitting2::new(),
    ]);
    rows!(rows, "Gilbert damping at a temperature", Spin, LONG, [
        "lie-midpoint(cayley)" LieMidpoint::cayley(), "ninomiya-victoir" NinomiyaVictoir,
    ]);
    rows!(rows, "heavy top", Top, LONG, [
        "splitting2" Splitting2::new(),
    ]);
    let words: Vec<String> = arguments.collect();
    rows.retain(|row| {
        let name = format!("{} {}", row.system, row.method);
        words.iter().all(|word| name.contains(word))
    });
    let table = measured(&rows, chosen.unwrap_or(PATHS));
    if chosen.is_some() {
        println!("{table}");
        return;
    }
    let page = include_str!("weak_orders.md").replace("{table}", table.trim_end());
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/weak_orders.md");
    std::fs::write(path, &page).expect("the page can be written");
    println!("{page}");
}

/// The table of all rows, which several threads measure.
fn measured(rows: &[Row], paths: usize) -> String {
    let next = AtomicUsize::new(0);
    let lines = Mutex::new(vec![String::new(); rows.len()]);
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some((number, row)) = {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    rows.get(number).map(|row| (number, row))
                } {
                    let line = line(row, &(row.measure)(paths));
                    eprint!("{line}");
                    lines.lock().expect("no thread panics")[number] = line;
                }
            });
        }
    });
    let mut table = String::from("| noise | method | weak order | |\n|---|---|---|---|\n");
    table.extend(lines.into_inner().expect("no thread panics"));
    table
}

fn line(row: &Row, finding: &Finding) -> String {
    let Finding { measured, note, .. } = finding;
    let (system, method) = (row.system, row.method);
    match measured.is_finite() {
        true => format!("| {system} | `{method}` | {measured:.2} | {note} |\n"),
        false => format!("| {system} | `{method}` | | {note} |\n"),
    }
}
