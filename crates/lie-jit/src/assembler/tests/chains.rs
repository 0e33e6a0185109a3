//! Parts by lot that go on one into another: linked ones give the bits of those that are called one by one, and stop at the same part.

use super::programs::{below, drawn, lanes};
use super::random::Random;
use crate::{Jit, Registers};
use lie_dynamic::{
    BETWEEN, Chain, Code, Engine, Frame, Instruction, Machine, Next, Number, Separate, Source,
    Stop, Store,
};
use lie_runtime::{Elementary, Scalar};
use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

/// Two parts behind each, so deep; each gives so many numbers to later ones, the last ones so many as the end of a step.
const DEPTH: usize = 4;
const GIVEN: usize = 5;
const RESULTS: u32 = 11;
const PARTS: usize = (1 << DEPTH) - 1;
const BETWEEN_ALL: usize = GIVEN * (DEPTH - 1);
/// Entries of every slice.
const ENTRIES: u32 = 9;

type Parts = Vec<(Arc<[Code]>, Next)>;

fn depth(part: usize) -> usize {
    (part + 1).ilog2() as usize
}

/// A part: what it reads, computes and asks is drawn by lot.
fn part(random: &mut Random, place: usize, length: u32) -> (Arc<[Code]>, Next) {
    let given = (GIVEN * depth(place)) as u32;
    let mut sources = vec![
        Source::Number(Number::Exact(1.0)),
        Source::Argument(0, 0),
        Source::Argument(0, 1),
        Source::Argument(1, 0),
        Source::Step,
        Source::Time,
    ];
    sources.extend((0..given).map(|entry| Source::Argument(BETWEEN as u8, entry)));
    // more slices than a part has registers of its own for, or few
    if random.number() > 0.0 {
        sources.extend((0..ENTRIES).map(Source::System));
        sources.extend((0..ENTRIES).map(Source::Parameter));
    }
    if random.number() > -0.5 {
        sources.extend((0..ENTRIES - below(random, 4)).map(Source::OfStep));
    }
    let (mut registers, mut instructions) = (sources.len() as u32, Vec::new());
    let mut add = |instruction| {
        instructions.push(instruction);
        registers += 1;
        registers
    };
    let mut count = sources.len() as u32;
    for _ in 0..length {
        let [a, b] = [(); 2].map(|()| below(random, count));
        count = add(match below(random, 12) {
            0..4 => Instruction::Add(a, b),
            4..7 => Instruction::Sub(a, b),
            7..10 => Instruction::Mul(a, b),
            10 => Instruction::Call(Elementary::Tanh, a),
            _ => Instruction::Rare(Elementary::Sinh, a, b, a),
        });
    }
    let mut drawn_number = || below(random, count);
    let [a, b, c] = [(); 3].map(|()| drawn_number());
    // seldom is a part not for these numbers
    let mut expected = 0;
    if place % 5 == 4 {
        expected = add(Instruction::LessEqual(a, b)) - 1;
    }
    let asked = add(Instruction::Less(b, c)) - 1;
    let is_end = depth(place) == DEPTH - 1;
    let (vector, answers) = match is_end {
        true => (RESULTS, vec![expected]),
        false => (GIVEN as u32, vec![expected, asked]),
    };
    let vector = (0..vector).map(|entry| (0, entry, drawn_number()));
    let mut stores: Vec<_> = vector.collect();
    stores.extend((0..).zip(answers).map(|(entry, answer)| (1, entry, answer)));
    let code = Code {
        stores: stores
            .into_iter()
            .map(|(target, entry, register)| Store {
                target,
                entry,
                register,
            })
            .collect(),
        sources,
        instructions,
        registers,
        clear: [None, None],
    };
    let next = match is_end {
        true => Next::End,
        false => Next::Question {
            from: given as usize,
            every: random.number() > 0.0,
            parts: [2 * place + 1, 2 * place + 2],
        },
    };
    (Arc::from([code]), next)
}

/// The same with everything that is asked of all lanes asked of any, and the other way round.
fn otherwise(parts: &Parts) -> Parts {
    let parts = parts.iter().map(|(code, next)| {
        let next = match *next {
            Next::Question { from, every, parts } => Next::Question {
                from,
                every: !every,
                parts,
            },
            Next::End => Next::End,
        };
        (Arc::clone(code), next)
    });
    parts.collect()
}

/// Steps from states by lot: where each stops, and the bits of what it gave. Parts are added where they are wanted.
fn followed<S: Scalar>(
    chain: &mut dyn Chain<S>,
    parts: &Parts,
    seed: u64,
) -> Vec<(Stop, Vec<u64>)> {
    let mut added = BTreeSet::new();
    let steps = (0..24).map(|step| {
        let mut random = Random(1000 * seed + step);
        let [state, memory, system, parameters, scalars] =
            [(); 5].map(|()| drawn::<S>(&mut random, ENTRIES as usize));
        let frame = Frame::new(
            [&state, &memory, &[], &[]],
            [&system, &[], &parameters],
            &scalars,
        );
        let mut to = vec![S::zero(); RESULTS as usize];
        let mut from = 0;
        loop {
            let stop = chain.follow(from, &frame, &mut to);
            let Stop::Unknown(place) = stop else {
                let expected = lanes(&[chain.answers()]);
                let is_done = matches!(stop, Stop::Done(_));
                return (stop, if is_done { lanes(&to) } else { expected });
            };
            assert!(added.insert(place), "a part is asked for once");
            let (code, next) = &parts[place];
            assert!(chain.add(place, code, *next));
            let constants = drawn(&mut Random(place as u64), ENTRIES as usize);
            let of_step = chain.of_step(place);
            let length = of_step.len();
            of_step.copy_from_slice(&constants[..length]);
            from = place;
        }
    });
    steps.collect()
}

fn chains<S: Scalar>(
    machine: &Arc<dyn Machine<S>>,
    parts: &Parts,
    seed: u64,
) -> Vec<(Stop, Vec<u64>)> {
    let by_calls = |parts| {
        let mut separate = Separate::new(machine, PARTS, BETWEEN_ALL);
        followed(&mut separate, parts, seed)
    };
    let mut linked = machine
        .chain(PARTS, BETWEEN_ALL)
        .expect("parts are linked here");
    let found = followed(linked.as_mut(), parts, seed);
    assert!(found == by_calls(parts), "{seed}");
    // the control
    assert_eq!(found != by_calls(&otherwise(parts)), S::LANES > 1, "{seed}");
    found
}

#[test]
fn parts_that_are_linked_give_the_bits_of_those_that_are_called() {
    let none: Arc<[Code]> = Arc::from([]);
    for registers in [Registers::Avx512, Registers::Avx2] {
        let Some(engine) = Jit::with(registers) else {
            continue;
        };
        let machine = engine.machine(&none);
        let wide = machine.wide().unwrap();
        let mut random = Random(7);
        let mut stops = [BTreeSet::new(), BTreeSet::new()];
        for (seed, length) in (0..28).zip([1, 3, 10, 30, 60, 100, 200].into_iter().cycle()) {
            let parts: Parts = (0..PARTS)
                .map(|place| part(&mut random, place, length))
                .collect();
            let one = chains(&machine, &parts, seed);
            let eight = chains(&wide, &parts, seed);
            for (stops, found) in stops.iter_mut().zip([one, eight]) {
                stops.extend(found.into_iter().map(|(stop, _)| match stop {
                    Stop::Done(part) => (true, part),
                    Stop::Missed(part) | Stop::Unknown(part) => (false, part),
                }));
            }
        }
        // ends of a step, and parts that are not for all numbers
        for (stops, least) in stops.iter().zip([7, 5]) {
            let done = stops.iter().filter(|(done, _)| *done).count();
            assert!(done >= least && done < stops.len(), "{stops:?}");
        }
    }
}

/// What a chain does not have is refused before anything is linked to it.
#[test]
fn parts_go_on_to_others_of_their_chain() {
    let Some(engine) = Registers::widest().and_then(Jit::with) else {
        return;
    };
    let machine = engine.machine(&Arc::from([]));
    let (code, _) = part(&mut Random(3), 0, 10);
    let refused = |from, parts| {
        let question = Next::Question {
            from,
            every: true,
            parts,
        };
        let separate: Box<dyn Chain<f64>> = Box::new(Separate::new(&machine, 3, GIVEN));
        let linked = machine.chain(3, GIVEN).expect("parts are linked here");
        [separate, linked].map(|mut chain| {
            let add = || chain.add(0, &code, question);
            let refused = catch_unwind(AssertUnwindSafe(add)).is_err();
            let frame = Frame::new([&[]; 4], [&[]; 3], &[]);
            assert!(!refused || chain.follow(0, &frame, &mut []) == Stop::Unknown(0));
            refused
        })
    };
    assert_eq!(refused(0, [1, 2]), [false; 2]);
    assert_eq!(refused(0, [1, 3]), [true; 2]);
    assert_eq!(refused(GIVEN + 1, [1, 2]), [true; 2]);
}
