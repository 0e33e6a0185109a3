//! Which register of the processor holds which register of a code, and when: one pass over the instructions in their order.
//!
//! Registers of a code are written once. When all of the processor's are taken, the one whose number is needed last is given up (Belady);
//! it is written to the frame unless it stands in memory anyway, as what was read, what is constant and what was stored do.

mod instructions;

use super::operation::{Layout, Operation, Place, Program, Vector};
use super::uses::{Lists, operands};
use lie_dynamic::{Code, Register};
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
}
