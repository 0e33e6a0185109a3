//! Steps of the Euler equations on the sphere, for `lab/dense/run`.
//!
//! Reads `w0_N.bin` (an N x N complex matrix, rows first) and a step size in `h_N.txt` from the folder that it is given, measures
//! one line of JSON each for N = 32, 64, 128, and writes the states after the steps to `ours_N_….bin`. With `--long` behind the
//! folder: spectrum and energy over 10,000 steps instead.

#[path = "../src/triangle.rs"]
mod triangle;

use lie_dense::{MatrixFlow, SkewHermitian, SpectrumMonitor, SphereEuler, StreamMap, spectrum};
use lie_runtime::diagnostics::DriftMonitor;
use lie_runtime::driver::{Options, Save, solve_observed};
use lie_runtime::methods::{Isospectral2, Method, StepReport, Stepper};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::{Scalar, State};
use nalgebra::Complex;
use ndarray::linalg::general_mat_mul;
use ndarray::{Array2, LinalgScalar, ShapeBuilder};
use rustix::time::{ClockId, clock_gettime};
use std::path::Path;
use triangle::lower_product;

const STEPS: usize = 100;

/// Microseconds that this thread had a processor.
fn processor() -> f64 {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    1e6 * time.tv_sec as f64 + 1e-3 * time.tv_nsec as f64
}

/// The shortest time of some calls, in microseconds.
fn shortest(count: usize, mut call: impl FnMut()) -> f64 {
    let times = (0..count).map(|_| {
        let start = processor();
        call();
        processor() - start
    });
    times.fold(f64::INFINITY, f64::min)
}

/// The shortest time of so many products, each with one of which the lower triangle is computed.
fn products_of<A: LinalgScalar>(size: usize, count: usize, entry: impl Fn(f64) -> A) -> f64 {
    // the rows of a column are side by side, as in the step
    let matrix = |seed: f64| -> Array2<A> {
        let shape = (size, size).f();
        Array2::from_shape_fn(shape, |(i, j)| entry(seed * (i * 31 + j * 17 + 1) as f64))
    };
    let mut all: Vec<[Array2<A>; 3]> = (0..count)
        .map(|k| [0.1, 0.4, 0.7].map(|seed| matrix(seed + 0.1 * k as f64)))
        .collect();
    shortest(200, || {
        for [left, right, out] in &mut all {
            general_mat_mul(A::one(), left, right, A::zero(), out);
        }
        for [left, right, out] in &mut all {
            lower_product(left.view(), right.view(), out.view_mut());
        }
    })
}

/// The matrix products of an iteration alone: three, and three of which the lower triangle is computed.
fn products(size: usize) -> f64 {
    products_of(size, 3, f64::sin)
}

/// The same by complex products: one, and one of which the lower triangle is computed.
fn complex_products(size: usize) -> f64 {
    products_of(size, 1, |angle| Complex::new(angle.sin(), angle.cos()))
}

fn numbers(path: &Path) -> Vec<f64> {
    let bytes = std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    bytes
        .as_chunks::<8>()
        .0
        .iter()
        .map(|&bytes| f64::from_le_bytes(bytes))
        .collect()
}

/// Steps from a state; the state at the end, the time of the shortest run in microseconds, and iterations.
fn run(
    flow: &MatrixFlow<SphereEuler>,
    start: &SkewHermitian,
    h: f64,
    options: &NewtonOptions,
    repetitions: usize,
) -> (SkewHermitian, f64, u32) {
    let mut end = start.clone();
    let mut iterations = 0;
    // each step by the shortest of its times
    let mut times = [f64::INFINITY; STEPS];
    for _ in 0..repetitions {
        let mut stepper = Isospectral2::new().stepper(flow, h, options);
        end.copy_from(start);
        iterations = 0;
        for time in &mut times {
            let before = processor();
            let report: StepReport = stepper.step(&mut end, &mut ()).expect("the step is small");
            *time = time.min(processor() - before);
            iterations += report.iterations;
        }
    }
    (end, times.iter().sum(), iterations)
}

fn measure(folder: &Path, size: usize) {
    let (start, h) = state(folder, size);
    let flow = MatrixFlow::new(SphereEuler::new(size).expect("large enough"));
    let repetitions = 9;
    let (products, complex) = (products(size), complex_products(size));
    let mut stream = SkewHermitian::zeros(size);
    let streams = shortest(200, || flow.map().stream(&start, &mut stream));
    for (name, tolerance) in [("round-off", 1.0 / 1024.0), ("1e-10", 1e-10 / f64::EPSILON)] {
        let options = NewtonOptions {
            tolerance,
            ..NewtonOptions::default()
        };
        let (end, time, iterations) = run(&flow, &start, h, &options, repetitions);
        let pairs = spectrum(&end).into_iter().zip(spectrum(&start));
        let change = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, Scalar::max);
        println!(
            "{{\"peer\":\"lie-dense\",\"N\":{size},\"until\":\"{name}\",\"us_per_step\":{},\"iterations\":{},\"us_per_iteration\":{},\"us_products\":{products},\"us_complex_products\":{complex},\"us_stream\":{streams},\"spectrum\":{change:e}}}",
            time / STEPS as f64,
            f64::from(iterations) / STEPS as f64,
            time / f64::from(iterations),
        );
        let mut bytes = Vec::new();
        for row in 0..size {
            for column in 0..size {
                let (re, im) = end.entry(row, column);
                bytes.extend(re.to_le_bytes());
                bytes.extend(im.to_le_bytes());
            }
        }
        std::fs::write(folder.join(format!("ours_{size}_{name}.bin")), bytes)
            .expect("the folder can be written to");
    }
}

/// What is kept over many steps, by the driver.
fn long(folder: &Path, size: usize) {
    let (start, h) = state(folder, size);
    let steps = 10_000;
    let sphere = SphereEuler::new(size).expect("large enough");
    let problem = MatrixFlow::new(sphere)
        .problem(start, (0.0, f64::from(steps) * h))
        .expect("the same size");
    let (mut spectrum, mut drift) = (SpectrumMonitor::new(), DriftMonitor::new());
    let options = Options::new(h).save(Save::Every(500));
    let before = processor();
    let solution = solve_observed(
        &problem,
        Isospectral2::new(),
        &options,
        (&mut spectrum, &mut drift),
    )
    .expect("the step is small");
    let energy = &drift.drift().energy;
    println!(
        "{{\"N\":{size},\"steps\":{steps},\"seconds\":{},\"iterations\":{},\"spectrum\":{:e},\"energy\":{:e},\"energy_growth\":{}}}",
        (processor() - before) * 1e-6,
        solution.stats.newton as f64 / f64::from(steps),
        spectrum.change / spectrum.radius(),
        energy.relative().unwrap_or(f64::NAN),
        energy.growth().unwrap_or(f64::NAN),
    );
}

/// The initial state of a size, and the step.
fn state(folder: &Path, size: usize) -> (SkewHermitian, f64) {
    let entries = numbers(&folder.join(format!("w0_{size}.bin")));
    let entry = |row: usize, column: usize| {
        let place = 2 * (row * size + column);
        (entries[place], entries[place + 1])
    };
    let start = SkewHermitian::from_entries(size, entry).expect("a skew-Hermitian matrix");
    let text = std::fs::read_to_string(folder.join(format!("h_{size}.txt"))).expect("the step");
    (start, text.trim().parse().expect("a number"))
}

fn main() {
    // cargo adds an argument of its own
    let arguments: Vec<String> = std::env::args()
        .skip(1)
        .filter(|argument| argument != "--bench")
        .collect();
    let Some(folder) = arguments.first() else {
        println!("run lab/dense/run, which calls this with a folder of initial states");
        return;
    };
    for size in [32, 64, 128] {
        if arguments.iter().any(|argument| argument == "--long") {
            long(Path::new(folder), size);
        } else {
            measure(Path::new(folder), size);
        }
    }
}
