//! Machine code in AVX-512 and AVX2, side by side; elsewhere in pairs by Cranelift.
//!
//! `cargo bench -p lie-jit`. The candidates of a row take turns, the least of many rounds counts, and what is shown beside nanoseconds is
//! the ratio to the last column. Rows: the field in eight lanes; a step of a method whose stages are lanes, and an iteration of it (with
//! its product, which is compiled with the core); a step of eight members of an ensemble; all codes of a plan made ready, over numbers and,
//! each when it is first run, over lanes.

use lie_codegen::compile::compile_spec;
use lie_codegen::methods::Choice;
use lie_codegen::plan::{Plan, plan};
use lie_dynamic::{Code, Dynamic, Engine, Frame, Interpreted, Machine, SLICES};
use lie_jit::{Jit, JitWith, Registers};
use lie_methods::{method, method_in_lanes};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::{Poisson, Scalar, Widen};
use std::hint::black_box;
use std::sync::{Arc, Mutex};
use std::time::Instant;

type Wide = <f64 as Scalar>::Wide;

/// Rounds, each shorter than what other programs leave at a time.
const ROUNDS: usize = 100;
const STEPS: usize = 100;

/// What is measured, made for an engine: does it so often.
type Work = Box<dyn FnMut(usize)>;

/// Nanoseconds of each candidate, the least of all rounds, in turns.
fn least(candidates: &mut [Work], times: usize) -> Vec<f64> {
    let mut least = vec![f64::INFINITY; candidates.len()];
    for _ in 0..ROUNDS {
        for (candidate, least) in candidates.iter_mut().zip(&mut least) {
            let start = Instant::now();
            candidate(times);
            *least = least.min(start.elapsed().as_nanos() as f64 / times as f64);
        }
    }
    least
}

fn row(what: &str, unit: f64, times: usize, make: &dyn Fn(JitWith) -> Option<Work>) {
    let engines: Vec<JitWith> = Registers::ALL.into_iter().filter_map(Jit::with).collect();
    let made: Option<Vec<Work>> = engines.iter().map(|engine| make(*engine)).collect();
    let Some(mut candidates) = made else {
        println!("{what:44} does not apply");
        return;
    };
    let found = least(&mut candidates, times);
    let last = found.last().copied().unwrap_or(f64::NAN);
    let cells = engines.iter().zip(&found);
    let cells = cells.map(|(engine, time)| {
        format!("{} {:9.1} ({:.2})", engine.name(), time / unit, time / last)
    });
    println!("{what:44} {}", cells.collect::<Vec<_>>().join("   "));
}

fn planned(spec: &str, ids: &[&str]) -> Plan {
    let path = format!("{}/../../specs/{spec}.json", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).expect("a spec of the project");
    let model = compile_spec(&text).unwrap_or_else(|errors| panic!("{errors:?}"));
    let choices = ids.iter().map(|id| Choice::from_id(id).expect("a method"));
    plan(&model, &choices.collect::<Vec<_>>())
}

fn system(spec: &str, ids: &[&str], engine: JitWith) -> Dynamic<f64> {
    let made = Dynamic::new(planned(spec, ids), &[], &engine);
    made.unwrap_or_else(|error| panic!("{error:?}"))
}

fn start(spec: &str) -> Vec<f64> {
    let made = Dynamic::new(planned(spec, &[]), &[], &Interpreted);
    let made = made.unwrap_or_else(|error| panic!("{error:?}"));
    made.initial_state().expect("a start")
}

fn field(spec: &'static str) {
    row(
        &format!("{spec}: field in lanes, ns"),
        1.0,
        5_000,
        &|engine| {
            let wide = system(spec, &[], engine).widen();
            let mu: Vec<Wide> = start(spec).into_iter().map(Wide::from_f64).collect();
            let mut out = wide.zero_state();
            Some(Box::new(move |times| {
                for _ in 0..times {
                    wide.vector_field(black_box(&mu), &mut out);
                }
                black_box(&out);
            }))
        },
    );
}

/// Iterations of so many steps.
fn iterations(spec: &str, id: &str, h: f64, steps: usize) -> f64 {
    let engine = Registers::widest()
        .and_then(Jit::with)
        .expect("the widest are here");
    let choice = Choice::from_id(id).expect("a method");
    let (system, mut mu) = (system(spec, &[id], engine), start(spec));
    let method = method(&choice, Default::default());
    let mut stepper = method.any_stepper(&system, h, &NewtonOptions::default());
    let all = (0..steps).map(|_| stepper.step(&mut mu).map_or(0, |report| report.iterations));
    all.map(f64::from).sum()
}

/// A row of steps over numbers, whose time is shown in these units.
fn steps(what: &str, unit: f64, spec: &'static str, id: &'static str, h: f64) {
    row(&format!("{spec}: {id}, {what}, ns"), unit, 1, &|engine| {
        let choice = Choice::from_id(id).ok()?;
        let system = system(spec, &[id], engine).without_patience();
        let start = start(spec);
        let method = method(&choice, Default::default());
        Some(Box::new(move |times| {
            for _ in 0..times {
                let mut mu = start.clone();
                let mut stepper = method.any_stepper(&system, h, &NewtonOptions::default());
                for _ in 0..STEPS {
                    let _ = black_box(stepper.step(&mut mu));
                }
            }
        }))
    });
}

fn stages(spec: &'static str, id: &'static str, h: f64) {
    let unit = iterations(spec, id, h, STEPS);
    let each = unit / STEPS as f64;
    println!("{spec}: {id}, h = {h}: {each} iterations a step");
    steps("an iteration", unit, spec, id, h);
}

fn ensemble(spec: &'static str, id: &'static str, h: f64) {
    row(
        &format!("{spec}: {id}, a step of eight members, ns"),
        STEPS as f64,
        1,
        &|engine| {
            let choice = Choice::from_id(id).ok()?;
            let system = system(spec, &[id], engine).without_patience();
            let lanes = Dynamic::in_lanes(&[&system; 8]);
            let start: Vec<Wide> = start(spec)
                .into_iter()
                .map(|x| Wide::new(std::array::from_fn(|lane| x + 0.01 * lane as f64)))
                .collect();
            let method = method_in_lanes(&choice, Default::default())?;
            Some(Box::new(move |times| {
                for _ in 0..times {
                    let mut mu = start.clone();
                    let mut stepper =
                        method.any_stepper(&lanes, Wide::from_f64(h), &NewtonOptions::default());
                    for _ in 0..STEPS {
                        let _ = black_box(stepper.step(&mut mu));
                    }
                }
            }))
        },
    );
}

/// Keeps the codes that it is asked for.
#[derive(Default)]
struct Listening(Mutex<Vec<Arc<[Code]>>>);

impl Engine for Listening {
    fn name(&self) -> &'static str {
        "listening"
    }
    fn machine(&self, codes: &Arc<[Code]>) -> Arc<dyn Machine<f64>> {
        self.0.lock().expect("one thread").push(Arc::clone(codes));
        Interpreted.machine(codes)
    }
}

fn making(spec: &'static str, ids: &'static [&'static str]) {
    let listening = Listening::default();
    let _ = Dynamic::new(planned(spec, ids), &[], &listening);
    let codes = listening
        .0
        .into_inner()
        .expect("one thread")
        .pop()
        .expect("codes");
    let instructions: usize = codes.iter().map(|code| code.instructions.len()).sum();
    println!(
        "{spec}, {ids:?}: {} codes, {instructions} instructions",
        codes.len()
    );
    for lanes in [false, true] {
        let what = if lanes {
            "and over lanes"
        } else {
            "made over numbers"
        };
        row(&format!("{spec}: {what}, us"), 1000.0, 1, &|engine| {
            let codes = Arc::clone(&codes);
            Some(Box::new(move |times| {
                for _ in 0..times {
                    let machine = engine.machine(&codes);
                    if !lanes {
                        continue;
                    }
                    let wide = machine.wide().expect("lanes");
                    let zeros = vec![Wide::zero(); 4096];
                    let [a, b, c, d, e, f, g, h] = [zeros.as_slice(); SLICES];
                    let frame = Frame::new([a, b, c, d], [e, f, g], h);
                    let (mut vector, mut matrix) = (zeros.clone(), zeros.clone());
                    for code in 0..codes.len() {
                        wide.run(code, &frame, [&mut vector, &mut matrix]);
                    }
                }
            }))
        });
    }
}

fn main() {
    for spec in [
        "so3_free_rigid_body",
        "se3_heavy_top",
        "su3_quadratic",
        "so3_nonpolynomial",
    ] {
        field(spec);
    }
    for (spec, h) in [
        ("so3_free_rigid_body", 1.0),
        ("se3_heavy_top", 0.5),
        ("so3_nonpolynomial", 0.5),
    ] {
        stages(spec, "gauss16", h);
        stages(spec, "collective16", h);
    }
    for (spec, h) in [("so3_free_rigid_body", 0.05), ("se3_heavy_top", 0.02)] {
        for id in ["rk4", "splitting4", "midpoint", "gauss4", "lie-midpoint"] {
            steps("a step", STEPS as f64, spec, id, h);
        }
        for id in ["rk4", "splitting4", "midpoint", "lie-midpoint", "taylor"] {
            ensemble(spec, id, h);
        }
    }
    making("so3_free_rigid_body", &["gauss16"]);
    making(
        "se3_heavy_top",
        &["gauss4", "gauss16", "lie-midpoint", "taylor"],
    );
}
