//! The operations of each instruction.

use super::Allocation;
use crate::assembler::operation::{
    Arithmetic, Operand, Operation, Place, Vector, WITHOUT_SIGN, called, unary,
};
use crate::assembler::uses::operands;
use lie_dynamic::{Instruction, Register};
use lie_runtime::Elementary;

impl Allocation<'_> {
    pub(super) fn instruction(&mut self, index: u32, instruction: &Instruction, result: Register) {
        match *instruction {
            Instruction::Add(a, b) => self.arithmetic(index, Arithmetic::Add, [a, b], result),
            Instruction::Sub(a, b) => self.arithmetic(index, Arithmetic::Sub, [a, b], result),
            Instruction::Mul(a, b) => self.arithmetic(index, Arithmetic::Mul, [a, b], result),
            Instruction::Div(a, b) => self.arithmetic(index, Arithmetic::Div, [a, b], result),
            Instruction::Bits(what, a, b) => {
                self.arithmetic(index, Arithmetic::of_bits(what), [a, b], result);
            }
            Instruction::Neg(a) => self.with_bits(Arithmetic::Xor, a, -0.0, result),
            Instruction::Abs(a) => {
                self.with_bits(Arithmetic::And, a, f64::from_bits(WITHOUT_SIGN), result);
            }
            Instruction::Less(a, b) => self.compare(false, [a, b], result),
            Instruction::LessEqual(a, b) => self.compare(true, [a, b], result),
            Instruction::Larger(a, b) => {
                self.of_two([a, b], result, |to, [left, right]| Operation::Larger {
                    result,
                    to,
                    left,
                    right,
                });
            }
            Instruction::Exchange(distance, a) => {
                self.of_one(a, result, |to, of| Operation::Exchange {
                    result,
                    distance,
                    to,
                    of,
                });
            }
            Instruction::Sqrt(a) => {
                self.of_one(a, result, |to, of| Operation::Sqrt { result, to, of });
            }
            Instruction::Shift(places, a) => {
                self.of_one(a, result, |to, of| Operation::Shift {
                    result,
                    to,
                    of,
                    places,
                });
            }
            Instruction::Rare(function, a, b, c) => self.rare(function, [a, b, c], result),
            Instruction::Below(a, b, c) | Instruction::Blend(a, b, c) => {
                let test = self.load(a, &[]);
                let then = self.load(b, &[test]);
                let otherwise = self.load(c, &[test, then]);
                let to = self.take(&[test, then, otherwise]);
                let zero = self.constant(0.0);
                for operand in [a, b, c] {
                    self.used(operand);
                }
                let jumps = matches!(instruction, Instruction::Below(..));
                self.do_it(Operation::Below {
                    result,
                    jumps,
                    to,
                    test,
                    zero,
                    then,
                    otherwise,
                });
                self.give(result, to);
            }
            Instruction::Power(..)
            | Instruction::Atan2(..)
            | Instruction::Call(..)
            | Instruction::Stumpff(..)
            | Instruction::Phi(..) => self.call(instruction, result),
        }
    }

    /// What is made of one number, in a register.
    fn of_one(
        &mut self,
        a: Register,
        result: Register,
        operation: impl FnOnce(Vector, Vector) -> Operation,
    ) {
        let of = self.load(a, &[]);
        self.used(a);
        let to = self.take(&[]);
        self.do_it(operation(to, of));
        self.give(result, to);
    }

    /// What is made of two numbers in registers, in another one.
    fn of_two(
        &mut self,
        [a, b]: [Register; 2],
        result: Register,
        operation: impl FnOnce(Vector, [Vector; 2]) -> Operation,
    ) {
        let left = self.load(a, &[]);
        let right = self.load(b, &[left]);
        let to = self.take(&[left, right]);
        self.used(a);
        self.used(b);
        self.do_it(operation(to, [left, right]));
        self.give(result, to);
    }

    fn compare(&mut self, equal: bool, operands: [Register; 2], result: Register) {
        let one = self.constant(1.0);
        self.of_two(operands, result, |to, [left, right]| Operation::Compare {
            result,
            equal,
            to,
            left,
            right,
            one,
        });
    }

    /// What is done with the bits of a number and those of a constant.
    fn with_bits(&mut self, what: Arithmetic, a: Register, constant: f64, result: Register) {
        let left = self.load(a, &[]);
        let right = Operand::Place(self.constant(constant));
        self.used(a);
        let to = self.take(&[]);
        self.do_it(Operation::Arithmetic {
            result,
            what,
            to,
            left,
            right,
        });
        self.give(result, to);
    }

    fn arithmetic(
        &mut self,
        index: u32,
        what: Arithmetic,
        [mut a, mut b]: [Register; 2],
        result: Register,
    ) {
        let commutes = !matches!(what, Arithmetic::Sub | Arithmetic::Div);
        let is_in_memory = |register: Register| self.vector[register as usize].is_none();
        let only_now = |register: Register| !self.is_used_after(register, index);
        // what comes from memory stands on the right, of two what is needed no more
        let of_two = only_now(a) && !only_now(b);
        if commutes && is_in_memory(a) && (!is_in_memory(b) || of_two) {
            (a, b) = (b, a);
        }
        let kept = self.vector[b as usize];
        let left = self.load(a, kept.as_slice());
        let right = match (self.vector[b as usize], self.home[b as usize]) {
            (Some(vector), _) => Operand::Vector(vector),
            (None, Some(place))
                if self.layout.is_operand_of(what, place)
                    && (self.free == 0 || !self.is_used_after(b, index)) =>
            {
                Operand::Place(place)
            }
            (None, _) => Operand::Vector(self.load(b, &[left])),
        };
        self.used(a);
        // a place that is read keeps its number until it is
        let from_memory = matches!(right, Operand::Place(_));
        if !from_memory {
            self.used(b);
        }
        let to = self.take(&[]);
        self.do_it(Operation::Arithmetic {
            result,
            what,
            to,
            left,
            right,
        });
        if from_memory {
            self.used(b);
        }
        self.give(result, to);
    }

    /// A function that is seldom called: the result stays in the register of what it usually is.
    fn rare(&mut self, function: Elementary, [a, b, c]: [Register; 3], result: Register) {
        let x = self.load(a, &[]);
        let test = self.load(b, &[x]);
        let value = self.load(c, &[x, test]);
        let scratch = self.take(&[x, test, value]);
        self.free |= 1 << scratch.0;
        let zero = self.constant(0.0);
        for operand in [a, b, c] {
            self.used(operand);
        }
        if self.vector[c as usize].is_some() {
            self.give_up(value);
        }
        self.free &= !(1 << value.0);
        let all = u32::MAX >> (32 - self.layout.width.registers());
        let kept = !self.free & all & !(1 << value.0);
        self.program.shared = self.program.shared.max(3);
        self.program.kept = self.program.kept.max(kept.count_ones());
        self.do_it(Operation::Rare {
            result,
            value,
            test,
            zero,
            x,
            scratch,
            function: unary(function).expect("every elementary function can be called"),
            kept,
        });
        self.give(result, value);
    }

    fn call(&mut self, instruction: &Instruction, result: Register) {
        let called = called(instruction).expect("these call");
        let [given, gives] = called.counts();
        self.program.shared = self.program.shared.max(given).max(gives);
        let arguments = operands(instruction);
        for (place, argument) in (0..).zip(&arguments) {
            let from = self.load(*argument, &[]);
            let to = Place::Shared(place);
            self.do_it(Operation::Store { from, to });
        }
        for argument in arguments {
            self.used(argument);
        }
        for vector in (0..self.layout.width.registers()).map(Vector) {
            if self.free & (1 << vector.0) == 0 {
                self.give_up(vector);
            }
        }
        self.do_it(Operation::Call { result, called });
        for place in 0..gives {
            let register = result + place;
            if self.is_wanted(register) {
                let to = self.take(&[]);
                let from = Place::Shared(place);
                self.do_it(Operation::Load { to, from });
                self.give(register, to);
            }
        }
    }
}
