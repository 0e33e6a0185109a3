//! Codes by lot, of all instructions and with more numbers than there are registers: the same bits in all registers, and no changed
//! program passes the check.

use super::random::Random;
use crate::assembler::operation::{
    Arithmetic, Layout, Operand, Operation, Place, Program, Vector, Width,
};
use crate::assembler::{allocation, check, function};
use crate::{Jit, Registers};
use lie_dynamic::{
    Bitwise, Code, Engine, Frame, Instruction, Interpreted, Interpreter, Machine, Number, Source,
    Store,
};
use lie_runtime::{Elementary, Scalar};
use std::sync::Arc;

type Wide = <f64 as Scalar>::Wide;

/// Entries of every slice.
const ENTRIES: u32 = 12;

pub fn below(random: &mut Random, end: u32) -> u32 {
    ((random.number() + 1.0) / 2.0 * f64::from(end)) as u32 % end
}

/// A code by lot with so many instructions; with a matrix, or without.
fn code(random: &mut Random, length: u32, calls: bool, matrix: bool) -> Code {
    let mut sources = vec![
        Source::Number(Number::Exact(0.5)),
        Source::Number(Number::Ratio(1.0, 3.0)),
        Source::Number(Number::Exact(-0.0)),
        Source::Step,
    ];
    for entry in 0..ENTRIES {
        sources.push(match below(random, 4) {
            0 | 1 => Source::Argument(0, entry),
            2 => Source::Argument(1, entry),
            _ => Source::System(entry),
        });
    }
    let mut registers = sources.len() as u32;
    let mut instructions = Vec::new();
    for _ in 0..length {
        let [a, b, c] = [(); 3].map(|()| below(random, registers));
        // bits of numbers that are none are not said
        let [d, e] = [(); 2].map(|()| below(random, sources.len() as u32));
        let instruction = match below(random, if calls { 46 } else { 41 }) {
            0..10 => Instruction::Add(a, b),
            10..18 => Instruction::Sub(a, b),
            18..28 => Instruction::Mul(a, b),
            28 if a % 2 == 0 => Instruction::Div(a, b),
            28 => Instruction::Larger(a, b),
            29 if a % 2 == 0 => Instruction::Less(a, b),
            29 => Instruction::LessEqual(a, b),
            30..32 => Instruction::Neg(a),
            32..34 => Instruction::Sqrt(a),
            34 => Instruction::Abs(a),
            35 => Instruction::Below(a, b, c),
            36 | 37 => Instruction::Blend(a, b, c),
            38 => Instruction::Bits(Bitwise::And, d, e),
            39 => Instruction::Bits(Bitwise::Xor, d, e),
            40 => Instruction::Shift(if a % 2 == 0 { 3 } else { -3 }, d),
            41 => Instruction::Power(a, b),
            42 => Instruction::Atan2(a, b),
            43 => Instruction::Call(Elementary::Sinh, a),
            44 => Instruction::Rare(Elementary::Sinh, a, b, c),
            _ => Instruction::Stumpff(4, a),
        };
        registers += instruction.width();
        instructions.push(instruction);
    }
    let stores = (0..20).map(|entry| Store {
        target: u8::from(matrix && entry % 3 == 0),
        entry,
        register: registers - 1 - below(random, registers),
    });
    let clear = Some(25);
    Code {
        stores: stores.collect(),
        sources,
        instructions,
        registers,
        clear: [clear, clear.filter(|_| matrix)],
    }
}

/// Bits, where what is not a number is one.
fn bits(number: f64) -> u64 {
    match number.is_nan() {
        true => f64::NAN.to_bits(),
        false => number.to_bits(),
    }
}

pub fn lanes<S: Scalar>(numbers: &[S]) -> Vec<u64> {
    let all = numbers.iter();
    let all = all.flat_map(|x| (0..S::LANES).map(|lane| bits(x.lane(lane).to_f64())));
    all.collect()
}

pub fn drawn<S: Scalar>(random: &mut Random, count: usize) -> Vec<S> {
    let number = |random: &mut Random| {
        let values = random.numbers(S::LANES).into_iter().enumerate();
        values.fold(S::zero(), |x, (lane, value)| {
            x.with_lane(lane, S::Lane::from_f64(2.0 * value))
        })
    };
    (0..count).map(|_| number(random)).collect()
}

/// What a machine writes for a code, at one place and along columns.
fn written<S: Scalar>(machine: &dyn Machine<S>, code: usize, seed: u64, columns: bool) -> Vec<u64> {
    let mut random = Random(seed);
    let slices: [Vec<S>; 8] = [(); 8].map(|()| drawn(&mut random, ENTRIES as usize));
    let [a, b, c, d, system, of_step, parameters, scalars] = &slices;
    let frame = Frame::new([a, b, c, d], [system, of_step, parameters], scalars);
    let seven = S::from_f64(7.0);
    if !columns {
        let (mut vector, mut matrix) = (vec![seven; 25], vec![seven; 25]);
        machine.run(code, &frame, [&mut vector, &mut matrix]);
        return lanes(&[vector, matrix].concat());
    }
    let mut found = Vec::new();
    for places in [1, 2, 3, 7, 8, 9, 21, 32] {
        let all: Vec<Vec<S>> = a.iter().map(|_| drawn(&mut random, places)).collect();
        let read: Vec<&[S]> = all.iter().map(Vec::as_slice).collect();
        let mut out = vec![vec![seven; places]; 25];
        let mut to: Vec<&mut [S]> = out.iter_mut().map(Vec::as_mut_slice).collect();
        machine.run_columns(code, &read, &frame, &mut to);
        found.extend(lanes(&out.concat()));
    }
    found
}

#[test]
fn codes_by_lot_have_the_same_bits_in_all_registers() {
    let mut random = Random(40);
    let mut of_lengths = |matrix: bool| -> Arc<[Code]> {
        let lengths = [3, 10, 40, 100, 300, 1000].into_iter();
        let codes = lengths.flat_map(|length| [false, true].map(|calls| (length, calls)));
        codes
            .map(|(length, calls)| code(&mut random, length, calls, matrix))
            .collect()
    };
    for (codes, columns) in [
        (of_lengths(true), false),
        (of_lengths(false), false),
        (of_lengths(false), true),
    ] {
        let expected = Interpreted.machine(&codes);
        let expected_wide = Interpreter::new(Arc::clone(&codes));
        let expected_wide: &dyn Machine<Wide> = &expected_wide;
        for registers in Registers::ALL {
            let Some(engine) = Jit::with(registers) else {
                continue;
            };
            let machine = engine.machine(&codes);
            let wide = machine.wide().unwrap();
            for seed in 0..codes.len() {
                let numbers = |machine| written(machine, seed, seed as u64, columns);
                let one = numbers(expected.as_ref());
                assert_eq!(one, numbers(machine.as_ref()), "{registers:?} {seed}");
                let numbers = |machine| written(machine, seed, seed as u64, columns);
                let eight = numbers(expected_wide);
                assert_eq!(eight, numbers(wide.as_ref()), "{registers:?} {seed}");
                assert!(eight.len() == 8 * one.len() && one.iter().any(|x| *x != one[0]));
            }
        }
    }
}

const LAYOUTS: [Layout; 4] = [
    Layout::NUMBER,
    Layout::lanes(Width::Four, 8),
    Layout::lanes(Width::Eight, 8),
    Layout::columns_of_numbers(Width::Eight),
];

/// A program with one of its operations changed in every way that this one can be.
fn changed(program: &Program, at: usize, layout: Layout) -> Vec<Program> {
    let with = |operation: Operation| {
        let mut program = program.clone();
        program.operations[at] = operation;
        program
    };
    let mut left_out = program.clone();
    left_out.operations.remove(at);
    let beyond = Vector(layout.width.registers());
    let mut all = Vec::new();
    // an argument may be there already, as a result
    let shares = Place::Shared(0);
    if !matches!(program.operations[at], Operation::Store { to, .. } if to == shares) {
        all.push(left_out);
    }
    match program.operations[at] {
        Operation::Load { to, .. } => all.extend([
            with(Operation::Load {
                to,
                from: Place::Slice {
                    slice: 0,
                    entry: 1_000_000,
                },
            }),
            with(Operation::Load {
                to,
                from: Place::Slot(program.slots),
            }),
            with(Operation::Load {
                to,
                from: Place::Constant(program.constants.len() as u32),
            }),
        ]),
        Operation::Store { from, .. } => all.extend([
            with(Operation::Store {
                from,
                to: Place::Target {
                    target: 0,
                    entry: 25,
                },
            }),
            with(Operation::Store {
                from,
                to: Place::Slice { slice: 0, entry: 0 },
            }),
            with(Operation::Store {
                from: beyond,
                to: Place::Slot(0),
            }),
        ]),
        Operation::Arithmetic {
            result,
            what,
            to,
            left,
            right,
        } => {
            let other = match what {
                Arithmetic::Add => Arithmetic::Sub,
                Arithmetic::Sub | Arithmetic::Div => Arithmetic::Add,
                Arithmetic::Xor => Arithmetic::And,
                Arithmetic::And | Arithmetic::Or | Arithmetic::Plus => Arithmetic::Xor,
                Arithmetic::Mul => Arithmetic::Div,
            };
            for (what, to, left, right) in [
                (other, to, left, right),
                (what, beyond, left, right),
                (what, to, beyond, right),
                (what, to, left, Operand::Vector(beyond)),
                (what, to, left, Operand::Place(Place::Slot(program.slots))),
            ] {
                all.push(with(Operation::Arithmetic {
                    result,
                    what,
                    to,
                    left,
                    right,
                }));
            }
        }
        Operation::Sqrt { result, of, .. } => all.push(with(Operation::Sqrt {
            result,
            to: beyond,
            of,
        })),
        Operation::Compare {
            result,
            equal,
            to,
            left,
            right,
            one,
        } => all.extend([
            with(Operation::Compare {
                result,
                equal: !equal,
                to,
                left,
                right,
                one,
            }),
            with(Operation::Compare {
                result,
                equal,
                to: left,
                left,
                right,
                one,
            }),
        ]),
        Operation::Larger {
            result,
            left,
            right,
            to,
        } => all.extend([
            with(Operation::Larger {
                result,
                left: right,
                right: left,
                to,
            }),
            with(Operation::Larger {
                result,
                left,
                right,
                to: right,
            }),
        ]),
        Operation::Exchange {
            result,
            distance,
            to,
            of,
        } => all.extend([
            with(Operation::Exchange {
                result,
                distance: distance ^ 3,
                to,
                of,
            }),
            with(Operation::Exchange {
                result,
                distance,
                to,
                of: beyond,
            }),
        ]),
        Operation::Shift {
            result,
            to,
            of,
            places,
        } => {
            for (places, to, of) in [
                (-places, to, of),
                (places, beyond, of),
                (places, to, beyond),
            ] {
                all.push(with(Operation::Shift {
                    result,
                    to,
                    of,
                    places,
                }));
            }
        }
        Operation::Rare {
            result,
            value,
            test,
            zero,
            x,
            scratch,
            function,
            kept,
        } => {
            let other = lie_dynamic::UNARY[0].1;
            let with_value = kept | 1 << value.0;
            let with_scratch = kept | 1 << scratch.0;
            for (function, scratch, kept) in [
                (other, scratch, kept),
                (function, x, kept),
                (function, value, kept),
                (function, beyond, kept),
                (function, scratch, with_value),
                (function, scratch, with_scratch),
            ] {
                all.push(with(Operation::Rare {
                    result,
                    value,
                    test,
                    zero,
                    x,
                    scratch,
                    function,
                    kept,
                }));
            }
            // a register that is needed later and is not kept
            let mut fewer = program.clone();
            fewer.kept = 0;
            all.extend((kept != 0).then_some(fewer));
        }
        Operation::Below {
            result,
            jumps,
            test,
            zero,
            then,
            otherwise,
            ..
        } => all.push(with(Operation::Below {
            result,
            jumps,
            to: then,
            test,
            zero,
            then,
            otherwise,
        })),
        Operation::Call { called, .. } => all.push(with(Operation::Call {
            result: 1_000_000,
            called,
        })),
    }
    all
}

#[test]
fn changed_programs_are_refused() {
    let mut random = Random(41);
    let mut refused = 0;
    for length in [5, 30, 200] {
        for layout in LAYOUTS {
            let code = code(&mut random, length, true, layout.columns.is_none());
            let program = allocation::allocate(&code, layout);
            assert!(check::computes(&program, &code, layout));
            for at in 0..program.operations.len() {
                for changed in changed(&program, at, layout) {
                    let passes = check::computes(&changed, &code, layout);
                    assert!(
                        !passes,
                        "{:?} {:?}",
                        program.operations[at],
                        changed.operations.get(at)
                    );
                    refused += 1;
                }
            }
            let read = program
                .operations
                .iter()
                .find_map(|operation| match operation {
                    Operation::Load {
                        from: Place::Constant(constant),
                        ..
                    }
                    | Operation::Arithmetic {
                        right: Operand::Place(Place::Constant(constant)),
                        ..
                    } => Some(*constant),
                    _ => None,
                });
            if let Some(constant) = read {
                let mut changed = program.clone();
                changed.constants[constant as usize] ^= 1;
                assert!(!check::computes(&changed, &code, layout));
            }
            // a code of which one operation that is needed is another one
            let sum = program
                .operations
                .iter()
                .find_map(|operation| match operation {
                    Operation::Arithmetic {
                        result,
                        what: Arithmetic::Add,
                        ..
                    } => Some(*result),
                    _ => None,
                });
            let mut flipped = code.clone();
            let mut first = code.sources.len() as u32;
            for instruction in &mut flipped.instructions {
                if let (Instruction::Add(a, b), true) = (*instruction, sum == Some(first)) {
                    *instruction = Instruction::Sub(a, b);
                }
                first += instruction.width();
            }
            assert_eq!(check::computes(&program, &flipped, layout), sum.is_none());
        }
    }
    assert!(refused > 2_000, "{refused}");
}

/// A frame that no stack is for is left to others, a large one is not.
#[test]
fn frames_have_a_bound() {
    for (sums, fits) in [(100, true), (3_000, true), (5_000, false)] {
        let sources: Vec<Source> = (0..2).map(|entry| Source::Argument(0, entry)).collect();
        let mut instructions: Vec<Instruction> =
            (0..sums).map(|k| Instruction::Mul(k, 1)).collect();
        let last = sums + 1;
        instructions.extend((0..sums).map(|k| Instruction::Add(last + k, 2 + k)));
        let registers = 2 + 2 * sums;
        let code = Code {
            stores: vec![Store {
                target: 0,
                entry: 0,
                register: registers - 1,
            }],
            sources,
            instructions,
            registers,
            clear: [None, None],
        };
        let layout = Layout::lanes(Width::Eight, 8);
        let program = allocation::allocate(&code, layout);
        assert!(check::computes(&program, &code, layout));
        assert_eq!(
            function::function(&program, layout).is_some(),
            fits,
            "{sums}"
        );
        let codes: Arc<[Code]> = [code].into();
        let expected: &dyn Machine<Wide> = &Interpreter::new(Arc::clone(&codes));
        let machine = Jit.machine(&codes).wide().unwrap();
        let [a, b] = [expected, machine.as_ref()].map(|machine| written(machine, 0, 3, false));
        assert_eq!(a, b);
    }
}
