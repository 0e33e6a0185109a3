//! Parts of a record: what some of what was written down needs of the rest.

use super::{Guard, Record, Written};
use crate::code::{Code, Instruction, Number, Register, Source};
use std::cell::RefCell;

impl Record {
    /// The results that were there when there were so many numbers, and are needed after it for these; without those that depend on no
    /// argument.
    fn crossing(&self, at: Register, stored: &[Register]) -> Vec<Register> {
        let needed = self.needed(stored);
        let found = RefCell::new(Vec::new());
        let take = |number: Register| {
            let place = number as usize;
            if number < at && self.sources[place].is_none() && needed[place] == Some(true) {
                found.borrow_mut().push(number);
            }
            number
        };
        for number in stored {
            take(*number);
        }
        let later = self.instructions.iter();
        for (instruction, first) in later.skip_while(|(_, first)| *first < at) {
            let numbers = *first as usize..(first + instruction.width()) as usize;
            if needed[numbers].iter().any(Option::is_some) {
                instruction.moved(&take);
            }
        }
        found.into_inner()
    }

    /// The same with some results from sources.
    fn given(&self, given: &[(Register, Source)]) -> Self {
        let mut sources = self.sources.clone();
        for (number, source) in given {
            sources[*number as usize] = Some(*source);
        }
        let is_needed = |(instruction, first): &&(Instruction, Register)| {
            let numbers = *first as usize..(first + instruction.width()) as usize;
            sources[numbers].contains(&None)
        };
        let instructions = self.instructions.iter().filter(is_needed);
        Self {
            instructions: instructions.copied().collect(),
            known: self.known.clone(),
            sources,
            ..Self::default()
        }
    }

    /// 1 in the lanes where all answers are the expected ones.
    fn answers(&mut self, guards: &[Guard]) -> Register {
        let one = self.source(Source::Number(Number::Exact(1.0)));
        let mut guards = guards.to_vec();
        guards.sort_by_key(|guard| guard.register);
        guards.dedup_by_key(|guard| (guard.register, guard.expected));
        let mut product = None;
        for guard in guards {
            let number = match guard.expected {
                true => guard.register,
                false => self.write(Instruction::Sub(one, guard.register)),
            };
            product = Some(match product {
                Some(all) => self.write(Instruction::Mul(all, number)),
                None => number,
            });
        }
        product.unwrap_or(one)
    }
}

impl Written {
    /// The codes of a part of it, which has some results from sources: the second stores these as a vector, as a matrix whether the
    /// answers to what was asked are the expected ones, and another number.
    pub fn part(
        &self,
        given: &[(Register, Source)],
        vector: &[Register],
        guards: &[Guard],
        asked: Option<Register>,
    ) -> [Code; 2] {
        let mut record = self.0.given(given);
        let answers = record.answers(guards);
        let matrix: Vec<Register> = [answers].into_iter().chain(asked).collect();
        record.codes([vector, &matrix])
    }

    /// The results that were there when there were so many numbers, and are needed after it for these.
    pub fn crossing(&self, at: Register, stored: &[Register]) -> Vec<Register> {
        self.0.crossing(at, stored)
    }
}
