//! Which register of the processor holds which register of a code, and when: one pass over the instructions in their order.
//!
//! Registers of a code are written once. When all of the processor's are taken, the one whose number is needed last is given up (Belady);
//! it is written to the frame unless it stands in memory anyway, as what was read, what is constant and what was stored do.

use super::operation::{
    Arithmetic, Layout, Operand, Operation, Place, Program, Vector, WITHOUT_SIGN, called, unary,
};
use super::uses::{Lists, operands};
use lie_dynamic::{Code, Instruction, Register};
use lie_runtime::Elementary;
use std::collections::HashMap;

struct Allocation<'a> {
    code: &'a Code,
    layout: Layout,
    /// The instructions that read a register; that behind the last one is the end.
    uses: Lists,
    /// How many of them are done.
    done: Vec<u32>,
    /// The stores of a register, by their place.
    stores: Lists,
    vector: Vec<Option<Vector>>,
    home: Vec<Option<Place>>,
    holder: [Register; 32],
    free: u32,
    free_slots: Vec<u32>,
    constants: HashMap<u64, u32>,
    program: Program,
}

/// A code over the registers of the processor.
pub fn allocate(code: &Code, layout: Layout) -> Program {
    Allocation::new(code, layout).run()
}

impl<'a> Allocation<'a> {
    fn new(code: &'a Code, layout: Layout) -> Self {
        let registers = code.registers as usize;
        let last: HashMap<(u8, u32), usize> = (0..)
            .zip(&code.stores)
            .map(|(place, store)| ((store.target, store.entry), place))
            .collect();
        // of two stores to one entry the last counts
        let stores = (0..)
            .zip(&code.stores)
            .filter(|(place, store)| last[&(store.target, store.entry)] == *place as usize);
        let stores = stores.map(|(place, store)| (store.register, place));
        let stores = Lists::new(registers, stores.collect::<Vec<_>>().into_iter());

        let mut wanted = vec![false; registers];
        for store in &code.stores {
            wanted[store.register as usize] = true;
        }
        let sources = code.sources.len() as Register;
        let mut reads = Vec::with_capacity(2 * code.instructions.len());
        let mut result = code.registers;
        for (index, instruction) in code.instructions.iter().enumerate().rev() {
            result -= instruction.width();
            let results = result as usize..(result + instruction.width()) as usize;
            if wanted[results].contains(&true) {
                for operand in operands(instruction) {
                    wanted[operand as usize] = true;
                    reads.push((operand, index as u32));
                }
            }
        }
        reads.reverse();
        let end = code.instructions.len() as u32;
        let stored = (0..sources).filter(|source| !stores.of(*source).is_empty());
        reads.extend(stored.map(|source| (source, end)));

        let registers_here = layout.width.registers();
        let mut allocation = Self {
            code,
            layout,
            uses: Lists::new(registers, reads.into_iter()),
            done: vec![0; registers],
            stores,
            vector: vec![None; registers],
            home: vec![None; registers],
            holder: [0; 32],
            free: u32::MAX >> (32 - registers_here),
            free_slots: Vec::new(),
            constants: HashMap::new(),
            program: Program::default(),
        };
        for (register, source) in code.sources.iter().enumerate() {
            let place = match (source.place(), source) {
                (Some((slice, entry)), _) => Place::Slice {
                    slice: slice as u8,
                    entry: entry as u32,
                },
                (None, lie_dynamic::Source::Number(number)) => {
                    allocation.constant(number.value::<f64>())
                }
                (None, other) => unreachable!("{other:?} is in a slice"),
            };
            allocation.home[register] = Some(place);
        }
        allocation
    }

    fn run(mut self) -> Program {
        let mut result = self.code.sources.len() as Register;
        let code = self.code;
        for (index, instruction) in (0..).zip(&code.instructions) {
            let results = result..result + instruction.width();
            if results.clone().any(|register| self.is_wanted(register)) {
                self.instruction(index, instruction, result);
            }
            result = results.end;
        }
        for source in 0..code.sources.len() as Register {
            if !self.stores.of(source).is_empty() {
                let vector = self.load(source, &[]);
                self.store(source, vector);
                self.used(source);
            }
        }
        self.program
    }

    fn is_wanted(&self, register: Register) -> bool {
        !self.uses.of(register).is_empty() || !self.stores.of(register).is_empty()
    }

    /// The place of a constant.
    fn constant(&mut self, value: f64) -> Place {
        let all = &mut self.program.constants;
        let new = all.len() as u32;
        Place::Constant(*self.constants.entry(value.to_bits()).or_insert_with(|| {
            all.push(value.to_bits());
            new
        }))
    }

    /// The instruction that reads a register next; none of one that is not needed any more.
    fn next_use(&self, register: Register) -> Option<u32> {
        let done = self.done[register as usize] as usize;
        self.uses.of(register).get(done).copied()
    }

    fn is_used_after(&self, register: Register, index: u32) -> bool {
        let last = self.uses.of(register).last();
        last.is_some_and(|last| *last > index)
    }

    fn do_it(&mut self, operation: Operation) {
        self.program.operations.push(operation);
    }

    /// A register that is free from now on, none of these.
    fn take(&mut self, kept: &[Vector]) -> Vector {
        if self.free == 0 {
            let all = (0..self.layout.width.registers()).map(Vector);
            let others = all.filter(|vector| !kept.contains(vector));
            let last = others.max_by_key(|vector| {
                let holder = self.holder[usize::from(vector.0)];
                let next = self.next_use(holder).unwrap_or(u32::MAX);
                (next, self.home[holder as usize].is_some())
            });
            let vector = last.expect("an instruction has fewer operands than there are registers");
            self.give_up(vector);
        }
        let vector = Vector(self.free.trailing_zeros() as u8);
        self.free &= self.free - 1;
        vector
    }

    /// Frees a register; what it holds goes to memory, where it is not there yet.
    fn give_up(&mut self, vector: Vector) {
        let holder = self.holder[usize::from(vector.0)];
        if self.home[holder as usize].is_none() {
            let slot = self.free_slots.pop().unwrap_or_else(|| {
                self.program.slots += 1;
                self.program.slots - 1
            });
            let to = Place::Slot(slot);
            self.do_it(Operation::Store { from: vector, to });
            self.home[holder as usize] = Some(to);
        }
        self.vector[holder as usize] = None;
        self.free |= 1 << vector.0;
    }

    fn hold(&mut self, register: Register, vector: Vector) {
        self.vector[register as usize] = Some(vector);
        self.holder[usize::from(vector.0)] = register;
    }

    /// The register of the processor that holds one of the code.
    fn load(&mut self, register: Register, kept: &[Vector]) -> Vector {
        if let Some(vector) = self.vector[register as usize] {
            return vector;
        }
        let to = self.take(kept);
        let from = self.home[register as usize].expect("what is in no register is in memory");
        self.do_it(Operation::Load { to, from });
        self.hold(register, to);
        to
    }

    /// An operand is read once.
    fn used(&mut self, register: Register) {
        self.done[register as usize] += 1;
        self.forget(register);
    }

    /// Frees what a register has, if nothing needs it any more.
    fn forget(&mut self, register: Register) {
        if self.next_use(register).is_some() {
            return;
        }
        if let Some(vector) = self.vector[register as usize].take() {
            self.free |= 1 << vector.0;
        }
        if let Some(Place::Slot(slot)) = self.home[register as usize] {
            self.free_slots.push(slot);
            self.home[register as usize] = None;
        }
    }

    /// A result is there: it is stored where it has to be, and can be read from there.
    fn give(&mut self, register: Register, vector: Vector) {
        self.hold(register, vector);
        self.store(register, vector);
        self.forget(register);
    }

    fn store(&mut self, register: Register, from: Vector) {
        for k in 0..self.stores.of(register).len() {
            let store = self.code.stores[self.stores.of(register)[k] as usize];
            let to = Place::Target {
                target: store.target,
                entry: store.entry,
            };
            self.do_it(Operation::Store { from, to });
            self.home[register as usize].get_or_insert(to);
        }
    }

    fn instruction(&mut self, index: u32, instruction: &Instruction, result: Register) {
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
