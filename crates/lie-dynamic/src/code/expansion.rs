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
