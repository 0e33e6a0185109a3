//! Machines give their memory back: a process of its own, in which nothing else takes any.

use lie_dynamic::{Code, Engine, Frame, Instruction, Source, Store};
use lie_jit::{Jit, Registers};
use lie_runtime::Scalar;
use std::sync::Arc;

/// Bytes of the process: those mapped, those in memory.
fn size() -> Option<[usize; 2]> {
    let all = std::fs::read_to_string("/proc/self/statm").ok()?;
    let mut words = all.split(' ').map(|word| word.parse::<usize>());
    Some([words.next()?.ok()? * 4096, words.next()?.ok()? * 4096])
}

fn product() -> Arc<[Code]> {
    let codes = [Code {
        sources: vec![Source::Argument(0, 0), Source::Argument(0, 1)],
        instructions: vec![Instruction::Mul(0, 1)],
        stores: vec![Store {
            target: 0,
            entry: 0,
            register: 2,
        }],
        registers: 3,
        clear: [None, None],
    }];
    codes.into()
}

#[test]
fn machines_give_their_memory_back() {
    let Some(engine) = Registers::widest().and_then(Jit::with) else {
        return;
    };
    let codes = product();
    let make = |count: usize| {
        for _ in 0..count {
            let machine = engine.machine(&codes);
            let wide = machine.wide().unwrap();
            let frame = [Scalar::from_f64(3.0); 2];
            let mut out = [Scalar::from_f64(0.0)];
            let empty = &[];
            let frame = Frame::new([&frame, empty, empty, empty], [empty; 3], empty);
            wide.run(0, &frame, [&mut out, &mut []]);
            assert_eq!(out[0].lane(7), 9.0);
        }
    };
    make(1_000);
    let Some(before) = size() else { return };
    let most = 20_000;
    make(most);
    let after = size().unwrap();
    // a page of each would be 160 MB
    for (before, after) in before.into_iter().zip(after) {
        assert!(after < before + (16 << 20), "{before} {after}");
    }
    // the control: machines that are kept keep their pages
    let kept: Vec<_> = (0..5_000).map(|_| engine.machine(&codes)).collect();
    let with_kept = size().unwrap();
    assert!(
        with_kept[0] > after[0] + (16 << 20),
        "{after:?} {with_kept:?}"
    );
    drop(kept);
}
