//! Codes over eight lanes that exchange them, run once and again and again: the bits of the interpreter in all registers.

#[path = "../../../tests/common/random.rs"]
mod random;

use lie_dynamic::{
    Code, Engine, Frame, Instruction, Interpreter, Machine, Number, SLICES, Source, Store,
};
use lie_jit::{Jit, Registers};
use lie_runtime::{Elementary, Scalar};
use random::Random;
use std::sync::Arc;

type Wide = <f64 as Scalar>::Wide;

/// Entries of the vector that is carried on.
const ENTRIES: usize = 5;

/// A code by lot that gives as many numbers as its second argument has; with calls of functions, or without.
fn code(random: &mut Random, length: usize, calls: bool) -> Code {
    let mut below = |end: u32| ((random.number() + 1.0) / 2.0 * f64::from(end)) as u32 % end;
    let entries = 0..ENTRIES as u32;
    let mut sources = vec![
        Source::Number(Number::Ratio(1.0, 3.0)),
        Source::Argument(0, 2),
        Source::Argument(2, 1),
        Source::Argument(3, 0),
        Source::System(1),
        Source::OfStep(0),
    ];
    sources.extend(entries.clone().map(|entry| Source::Argument(1, entry)));
    let mut registers = sources.len() as u32;
    let mut instructions = Vec::new();
    for _ in 0..length {
        let [a, b, c] = [(); 3].map(|()| below(registers));
        let instruction = match below(if calls { 26 } else { 24 }) {
            0..5 => Instruction::Add(a, b),
            5..9 => Instruction::Sub(a, b),
            9..14 => Instruction::Mul(a, b),
            14..20 => Instruction::Exchange([1, 2, 4, 6][below(4) as usize], a),
            20 => Instruction::Abs(a),
            21 => Instruction::Neg(a),
            22 => Instruction::Sqrt(a),
            23 => Instruction::Below(a, b, c),
            24 => Instruction::Call(Elementary::Sin, a),
            _ => Instruction::Stumpff(3, a),
        };
        registers += instruction.width();
        instructions.push(instruction);
    }
    // each lane of the vector is moved at least once
    let last = registers;
    instructions.push(Instruction::Exchange(4, last - 1));
    instructions.push(Instruction::Exchange(1, last));
    registers += 2;
    let stores = entries.map(|entry| Store {
        target: 0,
        entry,
        register: registers - 1 - entry,
    });
    Code {
        stores: stores.collect(),
        sources,
        instructions,
        registers,
        clear: [None, None],
    }
}

fn drawn(random: &mut Random, count: usize) -> Vec<Wide> {
    let mut number = || {
        let values = random.numbers(Wide::LANES).into_iter().enumerate();
        values.fold(Wide::zero(), |x, (lane, value)| x.with_lane(lane, value))
    };
    (0..count).map(|_| number()).collect()
}

fn bits(numbers: &[Wide]) -> Vec<u64> {
    let lanes = numbers.iter().flat_map(|x| (0..8).map(|lane| x.lane(lane)));
    lanes
        .map(|x| if x.is_nan() { f64::NAN } else { x })
        .map(f64::to_bits)
        .collect()
}

/// What a machine makes of vectors: by one run, and by so many in turns.
fn made(machine: &dyn Machine<Wide>, code: usize, seed: u64) -> Vec<u64> {
    let mut random = Random(seed);
    let slices: [Vec<Wide>; SLICES] = [(); SLICES].map(|()| drawn(&mut random, ENTRIES));
    let [a, b, c, d, system, of_step, parameters, scalars] = &slices;
    let frame = Frame::new([a, b, c, d], [system, of_step, parameters], scalars);
    let mut all = vec![Wide::from_f64(7.0); ENTRIES];
    machine.run(code, &frame, [&mut all, &mut []]);
    for count in [0, 1, 2, 5, 8] {
        let (mut one, mut other) = (b.clone(), vec![Wide::from_f64(7.0); ENTRIES]);
        machine.repeat(code, count, &frame, [&mut one, &mut other]);
        all.extend(one);
        all.extend(other);
    }
    bits(&all)
}

#[test]
fn lanes_are_exchanged_in_all_registers() {
    let mut random = Random(50);
    let lengths = [1, 10, 40, 200, 600].into_iter();
    let codes: Arc<[Code]> = lengths
        .flat_map(|length| [false, true].map(|calls| (length, calls)))
        .map(|(length, calls)| code(&mut random, length, calls))
        .collect();
    let interpreter = Interpreter::new(Arc::clone(&codes));
    let nothing: Arc<[Code]> = Arc::from(vec![]);
    let mut tried = 0;
    for registers in Registers::ALL {
        let Some(engine) = Jit::with(registers) else {
            continue;
        };
        let machine = engine.machine(&nothing).wide().unwrap();
        let machine = machine.compile(&codes).unwrap();
        for code in 0..codes.len() {
            let expected = made(&interpreter, code, code as u64);
            assert_eq!(
                expected,
                made(machine.as_ref(), code, code as u64),
                "{registers:?} {code}"
            );
            // another order of the lanes is seen
            let mut turned = codes.to_vec();
            let instruction = turned[code].instructions.last_mut().unwrap();
            let Instruction::Exchange(distance, _) = instruction else {
                unreachable!("the last one exchanges");
            };
            *distance = 2;
            let turned = machine.compile(&turned.into()).unwrap();
            assert_ne!(
                expected,
                made(turned.as_ref(), code, code as u64),
                "{registers:?} {code}"
            );
        }
        tried += 1;
    }
    assert!(tried > 0);
}

#[test]
#[should_panic(expected = "too short")]
fn vectors_that_take_turns_are_both_long_enough() {
    let codes: Arc<[Code]> = [code(&mut Random(51), 5, false)].into();
    let machine = Jit.machine(&Arc::from(vec![])).wide().unwrap();
    let machine = machine.compile(&codes).unwrap();
    let slices = [(); SLICES].map(|()| vec![Wide::zero(); ENTRIES]);
    let [a, b, c, d, system, of_step, parameters, scalars] = &slices;
    let frame = Frame::new([a, b, c, d], [system, of_step, parameters], scalars);
    let (mut one, mut other) = (b.clone(), vec![Wide::zero(); ENTRIES - 1]);
    machine.repeat(0, 1, &frame, [&mut one, &mut other]);
}
