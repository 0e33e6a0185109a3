//! The interpreter, machine code in all registers that the processor has, WebAssembly and CPython give the same bits: every code of every
//! spec, with every method that applies, on random numbers.

#[path = "../../../tests/common/cpython/mod.rs"]
mod cpython;
#[path = "../../../tests/common/random.rs"]
mod random;
mod wasmi_engine;

use cpython::CPython;
use lie_codegen::compile::{compile_spec, with_options};
use lie_codegen::methods::{Choice, applicability};
use lie_codegen::plan::plan;
use lie_dynamic::{
    Bitwise, Code, Declared, Dynamic, Engine, Frame, Instruction, Interpreted, Interpreter,
    Machine, Number, SLICES, Source, Store,
};
use lie_jit::{Jit, JitWith, Registers};
use lie_runtime::Elementary;
use lie_runtime::Scalar;
use random::Random;
use std::sync::{Arc, Mutex};
use wasmi_engine::Wasmi;

type Wide = <f64 as Scalar>::Wide;

/// The interpreter, which keeps the codes it is asked for.
#[derive(Default)]
struct Listening(Mutex<Vec<Arc<[Code]>>>);

impl Engine for Listening {
    fn name(&self) -> &'static str {
        "listening"
    }
    fn machine(&self, codes: &Arc<[Code]>) -> Arc<dyn Machine<f64>> {
        self.0.lock().unwrap().push(Arc::clone(codes));
        Interpreted.machine(codes)
    }
}

/// Machine code in all registers that this processor has.
fn machine_code() -> Vec<JitWith> {
    let all = Registers::ALL.into_iter();
    all.filter_map(Jit::with).collect()
}

/// Machine code and these.
fn engines<'a>(machine_code: &'a [JitWith], others: &[&'a dyn Engine]) -> Vec<&'a dyn Engine> {
    let all = machine_code.iter().map(|engine| engine as &dyn Engine);
    all.chain(others.iter().copied()).collect()
}

/// The codes of a spec with all methods that apply to it; none where no system is made of it at run time.
fn codes(text: &str) -> Option<Arc<[Code]>> {
    let model = compile_spec(text).unwrap();
    let methods = applicability(&model).into_iter();
    let choices: Vec<Choice> = methods
        .filter(|(_, reason)| reason.is_none())
        .filter_map(|(id, _)| Choice::from_id(id).ok())
        .collect();
    let all = [
        plan(&model, &with_options(&model, &choices)),
        plan(&model, &[]),
    ];
    let plan = all.into_iter().find(Dynamic::supports)?;
    let listening = Listening::default();
    Declared::new(plan, &listening);
    listening.0.into_inner().unwrap().pop()
}

/// The slices of a code as it reads them.
fn frame<S: Copy>(numbers: &[Vec<S>]) -> Frame<'_, S> {
    let arguments = [0, 1, 2, 3].map(|argument| numbers[argument].as_slice());
    Frame::new(
        arguments,
        [&numbers[4], &numbers[5], &numbers[6]],
        &numbers[7],
    )
}

/// The bits of a number; a zero has no sign, and what is not a number is one.
fn bits(number: f64) -> u64 {
    match number.is_nan() {
        true => f64::NAN.to_bits(),
        false => (number + 0.0).to_bits(),
    }
}

/// What a code writes for these numbers, entry by entry.
fn written<S: Scalar>(
    machine: &dyn Machine<S>,
    code: usize,
    of: &Code,
    numbers: &[Vec<S>],
) -> Vec<u64> {
    let frame = frame(numbers);
    let size = |target: u8| {
        let stores = of.stores.iter().filter(|store| store.target == target);
        let last = stores.map(|store| store.entry + 1).max().unwrap_or(0);
        last.max(of.clear[usize::from(target)].unwrap_or(0)) as usize
    };
    // what is not written stays
    let seven = S::from_f64(7.0);
    let (mut vector, mut matrix) = (vec![seven; size(0)], vec![seven; size(1)]);
    machine.run(code, &frame, [&mut vector, &mut matrix]);
    let all = vector.iter().chain(&matrix);
    all.flat_map(bits_of_lanes).collect()
}

fn bits_of_lanes<S: Scalar>(x: &S) -> impl Iterator<Item = u64> {
    let x = *x;
    (0..S::LANES).map(move |lane| bits(x.lane(lane).to_f64()))
}

/// Numbers by lot, of each lane one of its own.
fn by_lot<S: Scalar>(random: &mut Random, count: usize) -> Vec<S> {
    let number = |values: &[f64]| {
        let lanes = values.iter().enumerate();
        lanes.fold(S::zero(), |x, (lane, value)| {
            x.with_lane(lane, S::Lane::from_f64(*value))
        })
    };
    let values = random.numbers(count * S::LANES);
    values.chunks_exact(S::LANES).map(number).collect()
}

/// Numbers for all slices of a code.
fn numbers<S: Scalar>(code: &Code, random: &mut Random) -> Vec<Vec<S>> {
    let mut lengths = [0; SLICES];
    lengths[SLICES - 1] = 2;
    for (slice, entry) in code.sources.iter().filter_map(Source::place) {
        lengths[slice] = lengths[slice].max(entry + 1);
    }
    lengths.map(|length| by_lot(random, length)).to_vec()
}

/// The positions of codes that differ between engines.
fn differences(codes: &Arc<[Code]>, others: &[(&dyn Engine, &Arc<[Code]>)]) -> Vec<usize> {
    let reference = Interpreted.machine(codes);
    let machines: Vec<_> = others
        .iter()
        .map(|(engine, codes)| engine.machine(codes))
        .collect();
    let mut random = Random(2018);
    let mut found = Vec::new();
    for (position, code) in codes.iter().enumerate() {
        for _ in 0..20 {
            let numbers = numbers(code, &mut random);
            let expected = written(reference.as_ref(), position, code, &numbers);
            let differs = |machine: &Arc<dyn Machine<f64>>| {
                written(machine.as_ref(), position, code, &numbers) != expected
            };
            if machines.iter().any(differs) {
                found.push(position);
                break;
            }
        }
    }
    found
}

fn specs() -> Vec<(String, String)> {
    let folders = ["specs", "tests/data/families"].into_iter();
    let files = folders.flat_map(|folder| {
        let folder = format!("{}/../../{folder}", env!("CARGO_MANIFEST_DIR"));
        std::fs::read_dir(folder).unwrap()
    });
    let files = files.map(|file| file.unwrap().path());
    let mut found: Vec<_> = files
        .filter(|path| path.is_file() && !path.ends_with("lie-system.schema.json"))
        .map(|path| {
            (
                path.display().to_string(),
                std::fs::read_to_string(path).unwrap(),
            )
        })
        .collect();
    found.sort();
    found
}

/// Some of them, which take a third of a minute, or all: `.ci/nightly` asks for these.
fn some_specs() -> impl Iterator<Item = (String, String)> {
    let every = match std::env::var_os("LIE_ALL_SPECS") {
        Some(_) => 1,
        None => 3,
    };
    specs().into_iter().step_by(every)
}

#[test]
fn all_codes() {
    let (mut run, machine_code) = (0, machine_code());
    let engines = engines(&machine_code, &[&Wasmi, &CPython]);
    for (name, text) in some_specs() {
        let Some(codes) = codes(&text) else { continue };
        let all: Vec<_> = engines.iter().map(|engine| (*engine, &codes)).collect();
        let found = differences(&codes, &all);
        assert!(
            found.is_empty(),
            "{name}: codes {found:?} of {}",
            codes.len()
        );
        run += 1;
    }
    assert!(run >= 4, "{run} specs");
}

/// What a code gives along columns of so many places, of which each has numbers of its own.
fn run_columns<S: Scalar>(
    machine: &dyn Machine<S>,
    code: usize,
    of: &Code,
    numbers: &[Vec<S>],
    columns: &[Vec<S>],
) -> Vec<u64> {
    let frame = frame(numbers);
    let places = columns.first().map_or(PLACES, Vec::len);
    let entries = of.stores.iter().map(|store| store.entry + 1).max();
    let entries = entries.max(of.clear[0]).unwrap_or(0) as usize;
    let mut out = vec![S::from_f64(7.0); entries * places];
    let mut to: Vec<&mut [S]> = out.chunks_exact_mut(places).collect();
    let columns: Vec<&[S]> = columns.iter().map(Vec::as_slice).collect();
    machine.run_columns(code, &columns, &frame, &mut to);
    out.iter().flat_map(bits_of_lanes).collect()
}

const PLACES: usize = 11;

/// Whether some code gives other bits along columns by machine code than by the interpreter; `moved` reads the last column at another
/// place.
fn differs_along<S: Scalar>(
    codes: &[Code],
    [one, other]: [&dyn Machine<S>; 2],
    moved: bool,
) -> Option<usize> {
    let mut random = Random(1951);
    // vectors of which every entry is written or cleared
    let whole = |code: &Code| {
        let entries = code.stores.iter().map(|store| store.entry + 1).max();
        code.clear[0].is_some() || entries == Some(code.stores.len() as u32)
    };
    let vectors = codes
        .iter()
        .enumerate()
        .filter(|(_, code)| code.stores.iter().all(|store| store.target == 0) && whole(code));
    for (place, code) in vectors {
        let numbers: Vec<Vec<S>> = numbers(code, &mut random);
        let of_places = numbers[0].iter().map(|_| by_lot(&mut random, PLACES));
        let columns: Vec<Vec<S>> = of_places.collect();
        let mut read = columns.clone();
        if let Some(last) = read.last_mut().filter(|_| moved) {
            last.rotate_left(1);
        }
        let expected = run_columns(one, place, code, &numbers, &columns);
        if run_columns(other, place, code, &numbers, &read) != expected {
            return Some(place);
        }
    }
    None
}

#[test]
fn along_columns_every_place_has_its_own_bits() {
    for (name, text) in some_specs() {
        let Some(codes) = codes(&text) else { continue };
        let interpreter = Interpreter::new(Arc::clone(&codes));
        let one: &dyn Machine<f64> = &interpreter;
        let one_of_lanes: &dyn Machine<Wide> = &interpreter;
        for engine in machine_code() {
            let other = engine.machine(&codes);
            let lanes = other.wide().expect("lanes of machine code");
            let name = format!("{name} {}", engine.name());
            for moved in [false, true] {
                let of_numbers = differs_along(&codes, [one, other.as_ref()], moved);
                let of_lanes = differs_along(&codes, [one_of_lanes, lanes.as_ref()], moved);
                assert_eq!(of_numbers.is_some(), moved, "{name}: {of_numbers:?}");
                assert_eq!(of_lanes.is_some(), moved, "{name}: {of_lanes:?}");
            }
        }
    }
}

/// The positions of codes that differ over lanes from the interpreter's.
fn differences_of_lanes(codes: &Arc<[Code]>, engine: &JitWith, others: &Arc<[Code]>) -> Vec<usize> {
    let reference = Interpreter::new(Arc::clone(codes));
    let lanes = engine.machine(others).wide();
    let lanes = lanes.expect("lanes of machine code");
    let mut random = Random(2018);
    let mut found = Vec::new();
    for (position, code) in codes.iter().enumerate() {
        let differs = (0..4).any(|_| {
            let numbers: Vec<Vec<Wide>> = numbers(code, &mut random);
            let expected = written(&reference, position, code, &numbers);
            written(lanes.as_ref(), position, code, &numbers) != expected
        });
        if differs {
            found.push(position);
        }
    }
    found
}

#[test]
fn every_lane_has_its_own_bits() {
    for (name, text) in some_specs() {
        let Some(codes) = codes(&text) else { continue };
        for engine in machine_code() {
            let found = differences_of_lanes(&codes, &engine, &codes);
            assert!(
                found.is_empty(),
                "{name} {}: codes {found:?}",
                engine.name()
            );
        }
    }
}

/// Every instruction once, with numbers of every kind, zeros to clear and entries that stay.
fn every_instruction() -> Code {
    use Instruction::{
        Abs, Add, Atan2, Below, Bits, Blend, Call, Div, Larger, Less, LessEqual, Mul, Neg, Phi,
        Power, Rare, Shift, Sqrt, Stumpff, Sub,
    };
    let numbers = [
        Number::Exact(0.5),
        Number::Ratio(1.0, 3.0),
        Number::Parts(0.1, 1e-18),
    ];
    let mut sources: Vec<Source> = numbers.map(Source::Number).to_vec();
    sources.extend([
        Source::Argument(0, 2),
        Source::Argument(3, 0),
        Source::System(1),
    ]);
    sources.extend([
        Source::OfStep(0),
        Source::Parameter(0),
        Source::Step,
        Source::Time,
    ]);
    let mut instructions = vec![
        Add(0, 3),
        Sub(1, 4),
        Mul(2, 5),
        Div(6, 7),
        Neg(8),
        Mul(9, 9),
        Sqrt(15),
        Power(15, 1),
        Atan2(3, 4),
        Below(3, 4, 5),
        Below(2, 4, 0),
        Stumpff(5, 3),
        Phi(3, 4),
        Stumpff(2, 3),
        Blend(3, 4, 5),
        Blend(2, 4, 0),
        Bits(Bitwise::And, 3, 4),
        Bits(Bitwise::Or, 3, 0),
        Bits(Bitwise::Xor, 4, 1),
        Bits(Bitwise::Plus, 3, 5),
        Shift(62, 3),
        Shift(-7, 4),
        Rare(Elementary::Sinh, 3, 4, 5),
        Rare(Elementary::Exp, 3, 0, 4),
    ];
    instructions.extend(Elementary::ALL.iter().map(|&function| Call(function, 15)));
    instructions.extend([Abs(4), Less(3, 4), LessEqual(4, 4)]);
    let results = instructions.iter().map(Instruction::width);
    let negative = sources.len() as u32 + results.sum::<u32>();
    let none = negative + 1;
    instructions.extend([Neg(15), Sqrt(negative), Larger(3, 4), Larger(4, 3)]);
    instructions.extend([Larger(3, none), Larger(none, 3), Larger(negative, negative)]);
    let results: u32 = instructions.iter().map(Instruction::width).sum();
    let registers = sources.len() as u32 + results;
    let stores = (0..registers).map(|register| Store {
        target: (register % 2) as u8,
        entry: register,
        register,
    });
    let stores = stores.collect();
    Code {
        sources,
        instructions,
        stores,
        registers,
        clear: [Some(registers + 3), None],
    }
}

#[test]
fn every_instruction_is_the_interpreters() {
    let codes: Arc<[Code]> = [every_instruction()].into();
    let machine_code = machine_code();
    for engine in engines(&machine_code, &[&Wasmi, &CPython]) {
        let found = differences(&codes, &[(engine, &codes)]);
        assert_eq!(found, [0; 0], "{}", engine.name());
    }
    for engine in &machine_code {
        let found = differences_of_lanes(&codes, engine, &codes);
        assert_eq!(found, [0; 0], "lanes of {}", engine.name());
    }
}

/// One operation that is another one is found, and a product and a sum that are contracted would be.
#[test]
fn a_flipped_operation_is_found() {
    let (_, text) = specs()
        .into_iter()
        .find(|(name, _)| name.contains("se3_heavy_top"))
        .unwrap();
    let codes = codes(&text).unwrap();
    let adds = |code: &Code| {
        code.instructions
            .iter()
            .any(|i| matches!(i, Instruction::Add(..)))
    };
    let position = codes.iter().position(adds).unwrap();
    let mut flipped = codes.to_vec();
    for instruction in &mut flipped[position].instructions {
        if let Instruction::Add(a, b) = *instruction {
            *instruction = Instruction::Sub(a, b);
            break;
        }
    }
    let flipped = flipped.into();
    let machine_code = machine_code();
    for engine in engines(&machine_code, &[&Wasmi]) {
        assert_eq!(differences(&codes, &[(engine, &flipped)]), [position]);
    }
    for engine in &machine_code {
        let found = differences_of_lanes(&codes, engine, &flipped);
        assert_eq!(found, [position], "lanes of {}", engine.name());
    }
    if cpython::there_is_cpython() {
        assert_eq!(differences(&codes, &[(&CPython, &flipped)]), [position]);
    }
}

/// A code that no host takes is interpreted, and those beside it are not.
#[test]
fn codes_that_are_too_long_are_left_out() {
    let short = every_instruction();
    let mut long = short.clone();
    while long.registers <= lie_wasm::LONGEST {
        long.instructions
            .push(Instruction::Add(3, long.registers - 1));
        long.registers += 1;
    }
    long.stores[0].register = long.registers - 1;
    let codes: Arc<[Code]> = [short.clone(), long, short].into();
    assert_eq!(lie_wasm::module(&codes).compiled, [true, false, true]);
    assert_eq!(differences(&codes, &[(&Wasmi, &codes)]), [0; 0]);
}
