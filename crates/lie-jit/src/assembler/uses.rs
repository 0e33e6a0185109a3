//! What instructions read, and which instructions read a register.

use lie_dynamic::{Instruction, Register};
use smallvec::SmallVec;

/// What an instruction reads.
pub fn operands(instruction: &Instruction) -> SmallVec<[Register; 3]> {
    match *instruction {
        Instruction::Add(a, b)
        | Instruction::Sub(a, b)
        | Instruction::Mul(a, b)
        | Instruction::Div(a, b)
        | Instruction::Less(a, b)
        | Instruction::LessEqual(a, b)
        | Instruction::Larger(a, b)
        | Instruction::Power(a, b)
        | Instruction::Atan2(a, b)
        | Instruction::Bits(_, a, b) => SmallVec::from_slice(&[a, b]),
        Instruction::Below(a, b, c)
        | Instruction::Blend(a, b, c)
        | Instruction::Rare(_, a, b, c) => SmallVec::from_slice(&[a, b, c]),
        Instruction::Neg(a)
        | Instruction::Sqrt(a)
        | Instruction::Abs(a)
        | Instruction::Exchange(_, a)
        | Instruction::Call(_, a)
        | Instruction::Stumpff(_, a)
        | Instruction::Phi(_, a)
        | Instruction::Shift(_, a) => SmallVec::from_slice(&[a]),
    }
}

/// Lists of numbers, one for each register of a code, one behind the other.
pub struct Lists {
    start: Vec<u32>,
    all: Vec<u32>,
}

impl Lists {
    /// Of pairs of a register and a number, which stay in their order.
    pub fn new(registers: usize, pairs: impl Iterator<Item = (Register, u32)> + Clone) -> Self {
        let mut start = vec![0; registers + 1];
        for (register, _) in pairs.clone() {
            start[register as usize + 1] += 1;
        }
        for place in 0..registers {
            start[place + 1] += start[place];
        }
        let (mut next, mut all) = (start.clone(), vec![0; start[registers] as usize]);
        for (register, number) in pairs {
            let place = &mut next[register as usize];
            all[*place as usize] = number;
            *place += 1;
        }
        Self { start, all }
    }

    pub fn of(&self, register: Register) -> &[u32] {
        let [from, to] = [0, 1].map(|k| self.start[register as usize + k] as usize);
        &self.all[from..to]
    }
}
