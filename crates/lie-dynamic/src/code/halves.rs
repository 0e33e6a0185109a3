//! A code over eight lanes in registers of fewer: each of its registers becomes two, of the lower and of the upper half.

use super::{Code, Instruction, Register, Source, Store};
use crate::engine::ARGUMENTS;

/// The slice that has the step size and the time.
const SCALARS: u8 = ARGUMENTS as u8 + 3;

impl Code {
    /// Whether lanes are exchanged, so that all of them have to be there.
    pub fn exchanges(&self) -> bool {
        let mut instructions = self.instructions.iter();
        instructions.any(|instruction| matches!(instruction, Instruction::Exchange(..)))
    }

    /// The same over half as many lanes, of which there are `lanes` now: entry k of a slice or a target, and register k, are 2k with the
    /// lower half and 2k + 1 with the upper one. Halves that are exchanged take each other's place.
    #[must_use]
    pub fn halved(&self, lanes: u8) -> Self {
        let half = lanes / 2;
        let mut halved = Self {
            registers: self.sources.len() as Register * 2,
            clear: self.clear.map(|count| count.map(|count| 2 * count)),
            ..Self::default()
        };
        // where the halves of each register are
        let mut places: Vec<[Register; 2]> = Vec::with_capacity(self.registers as usize);
        for source in &self.sources {
            places.push([0, 1].map(|part| {
                halved.sources.push(source.half(part));
                halved.sources.len() as Register - 1
            }));
        }
        for instruction in &self.instructions {
            if let Instruction::Exchange(distance, a) = *instruction {
                let [low, high] = places[a as usize];
                let turned = match distance & half {
                    0 => [low, high],
                    _ => [high, low],
                };
                places.push(match distance & (half - 1) {
                    0 => turned,
                    within => turned.map(|part| halved.push(Instruction::Exchange(within, part))),
                });
                continue;
            }
            let [low, high] = [0, 1].map(|part| {
                halved.push(instruction.moved(&|register| places[register as usize][part]))
            });
            places.extend((0..instruction.width()).map(|k| [low + k, high + k]));
        }
        halved.stores = self
            .stores
            .iter()
            .flat_map(|store| {
                let places = &places;
                (0..2).map(move |part| Store {
                    entry: 2 * store.entry + part,
                    register: places[store.register as usize][part as usize],
                    ..*store
                })
            })
            .collect();
        halved
    }

    /// Adds an instruction; the first register that it gives.
    fn push(&mut self, instruction: Instruction) -> Register {
        let first = self.registers;
        self.registers += instruction.width();
        self.instructions.push(instruction);
        first
    }
}

impl Source {
    /// What a half of it is, 0 the lower one.
    fn half(self, part: u32) -> Self {
        match self {
            Self::Argument(argument, entry) => Self::Argument(argument, 2 * entry + part),
            Self::System(place) => Self::System(2 * place + part),
            Self::OfStep(place) => Self::OfStep(2 * place + part),
            Self::Parameter(place) => Self::Parameter(2 * place + part),
            Self::Number(_) => self,
            // by their places in a frame
            Self::Step => Self::Argument(SCALARS, part),
            Self::Time => Self::Argument(SCALARS, 2 + part),
        }
    }
}
