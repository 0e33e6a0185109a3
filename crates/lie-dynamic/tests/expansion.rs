//! Elementary functions that are written out in instructions have the bits of those that are called.

use lie_core::Elementary;
use lie_dynamic::{
    Code, Frame, Instruction, Interpreter, Machine, Number, Register, Source, Store,
};
use lie_runtime::Scalar;
use lie_runtime::scalar::F64x8;
use std::sync::Arc;

/// All functions that are programs of one argument, and what they are added to.
fn code() -> Code {
    let functions = Elementary::ALL.iter().copied();
    let mut instructions: Vec<_> = functions.map(|f| Instruction::Call(f, 0)).collect();
    instructions.push(Instruction::Add(0, 1));
    let registers = 2 + instructions.len() as Register;
    let stores = (0..registers).map(|register| Store {
        target: 0,
        entry: register,
        register,
    });
    Code {
        sources: vec![Source::Argument(0, 0), Source::Number(Number::Exact(0.5))],
        stores: stores.collect(),
        instructions,
        registers,
        clear: [None, None],
    }
}

fn run<S: Scalar>(code: &Code, at: S) -> Vec<S> {
    let mut out = vec![S::zero(); code.stores.len()];
    let at = [at];
    let frame = Frame::new([&at, &[], &[], &[]], [&[], &[], &[]], &[]);
    let machine = Interpreter::new(Arc::from([code.clone()]));
    machine.run(0, &frame, [&mut out, &mut []]);
    out
}

#[test]
fn what_is_written_out_has_the_bits_of_calls() {
    let code = code();
    let expanded = code.expanded();
    let is_program = |i: &Instruction| match i {
        Instruction::Call(function, _) => function.program(0.5).is_some(),
        _ => false,
    };
    assert!(code.instructions.iter().any(is_program));
    assert!(!expanded.instructions.iter().any(is_program));
    let bits = |x: &f64| if x.is_nan() { 0 } else { x.to_bits() };
    let arguments = [
        0.0,
        -0.0,
        0.3,
        -1.7,
        1e-310,
        25.0,
        -3e5,
        5e5,
        -745.0,
        800.0,
        1e300,
        f64::NAN,
        f64::INFINITY,
    ];
    for x in arguments {
        let [calls, written]: [Vec<u64>; 2] =
            [&code, &expanded].map(|code| run(code, x).iter().map(bits).collect());
        assert_eq!(calls, written, "{x:e}");
    }
    let lanes = F64x8::new([0.1, 3.0, -20.0, 1e6, -0.0, 0.7, 710.0, 2.0]);
    let [calls, written] = [&code, &expanded].map(|code| run(code, lanes));
    for (one, other) in calls.iter().zip(&written) {
        for lane in 0..8 {
            assert_eq!(bits(&one.lane(lane)), bits(&other.lane(lane)));
        }
    }
}

/// Sine and cosine of an angle share its reduction and both polynomials.
#[test]
fn programs_share_what_they_have_in_common() {
    let length = |functions: &[Elementary]| {
        let mut code = code();
        let functions = functions.iter();
        code.instructions = functions.map(|&f| Instruction::Call(f, 0)).collect();
        code.registers = 2 + code.instructions.len() as Register;
        code.stores.truncate(code.registers as usize);
        code.expanded().instructions.len()
    };
    let sine = length(&[Elementary::Sin]);
    let both = length(&[Elementary::Sin, Elementary::Cos, Elementary::Sin]);
    assert!(both < sine + 8, "{sine} {both}");
    assert_eq!(length(&[Elementary::Asin]), 1);
}
