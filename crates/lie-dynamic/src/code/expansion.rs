//! Elementary functions that are programs, written out in instructions.

use super::{Code, Instruction, Number, Register, Source};
use crate::recording::program;
use lie_core::Elementary;
use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::OnceLock;

/// The program of a function of one argument; none of those that are called.
fn known_program(function: Elementary) -> Option<&'static Code> {
    static ALL: OnceLock<Vec<(Elementary, Code)>> = OnceLock::new();
    let all = ALL.get_or_init(|| {
        let all = Elementary::ALL.iter();
        all.filter_map(|&function| Some((function, program(function)?)))
            .collect()
    });
    let mut all = all.iter();
    all.find(|(known, _)| *known == function)
        .map(|(_, code)| code)
}

fn program_of(instruction: &Instruction) -> Option<(&'static Code, Register)> {
    match instruction {
        Instruction::Call(function, of) => Some((known_program(*function)?, *of)),
        _ => None,
    }
}

/// A code with functions written out, as far as it is done.
struct Expansion {
    code: Code,
    /// The numbers among the sources, by their bits.
    numbers: HashMap<u64, Register>,
    /// The results of programs: sine and cosine of an angle have most of theirs in common.
    known: HashMap<Instruction, Register>,
}

impl Code {
    /// The same with the elementary functions written out that are programs ([`Elementary::program`]), for engines of double precision
    /// and its lanes. Over other scalars a call is the function of that scalar.
    pub fn expanded(&self) -> Cow<'_, Self> {
        if !self.instructions.iter().any(|i| program_of(i).is_some()) {
            return Cow::Borrowed(self);
        }
        let mut expansion = Expansion {
            code: Self {
                instructions: Vec::new(),
                ..self.clone()
            },
            numbers: HashMap::new(),
            known: HashMap::new(),
        };
        for (register, source) in (0..).zip(&self.sources) {
            if let Source::Number(Number::Exact(value)) = source {
                expansion.numbers.insert(value.to_bits(), register);
            }
        }
        // registers of sources come first
        for instruction in &self.instructions {
            if let Some((program, _)) = program_of(instruction) {
                program.sources.iter().for_each(|s| expansion.source(s));
            }
        }
        expansion.code.registers = expansion.code.sources.len() as Register;
        let mut places: Vec<Register> = (0..self.sources.len() as Register).collect();
        for instruction in &self.instructions {
            match program_of(instruction) {
                Some((program, of)) => {
                    let result = expansion.write_out(program, places[of as usize]);
                    places.push(result);
                }
                None => {
                    let first = expansion.push(instruction.moved(&|of| places[of as usize]));
                    places.extend(first..first + instruction.width());
                }
            }
        }
        for store in &mut expansion.code.stores {
            store.register = places[store.register as usize];
        }
        Cow::Owned(expansion.code)
    }
}

impl Expansion {
    /// The numbers that a program reads become sources.
    fn source(&mut self, source: &Source) {
        if let Source::Number(Number::Exact(value)) = source {
            let sources = &mut self.code.sources;
            self.numbers.entry(value.to_bits()).or_insert_with(|| {
                sources.push(*source);
                sources.len() as Register - 1
            });
        }
    }

    /// The first register of the results.
    fn push(&mut self, instruction: Instruction) -> Register {
        let first = self.code.registers;
        self.code.registers += instruction.width();
        self.code.instructions.push(instruction);
        first
    }

    /// The result of a program of the number in a register.
    fn write_out(&mut self, program: &Code, of: Register) -> Register {
        let sources = program.sources.iter();
        let mut places: Vec<Register> = sources
            .map(|source| match source {
                Source::Number(Number::Exact(value)) => self.numbers[&value.to_bits()],
                _ => of,
            })
            .collect();
        for instruction in &program.instructions {
            let moved = instruction.moved(&|of| places[of as usize]);
            let place = match self.known.get(&moved) {
                Some(place) => *place,
                None => self.push(moved),
            };
            self.known.insert(moved, place);
            places.push(place);
        }
        places[program.stores[0].register as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::code::Store;
    use crate::{Frame, Interpreter, Machine};
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
        let is_program = |i: &Instruction| program_of(i).is_some();
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
}
