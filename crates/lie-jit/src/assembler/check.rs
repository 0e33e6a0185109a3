//! A program is followed, operation by operation, before it becomes machine code: what every register and every place holds, by the
//! instructions of the code alone. Nothing here is taken from how registers were allocated.

use super::operation::{
    Arithmetic, Called, Layout, Operand, Operation, Place, Program, Vector, WITHOUT_SIGN, called,
    unary,
};
use super::uses::operands;
use lie_dynamic::{Code, Instruction, Register, Source};
use std::collections::{HashMap, HashSet};

/// What a register or a place holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Held {
    /// An entry of a slice.
    Entry(u8, u32),
    /// A number.
    Bits(u64),
    /// The result of an instruction.
    Result(Register),
}

struct Followed<'a> {
    code: &'a Code,
    layout: Layout,
    program: &'a Program,
    /// The entries of slices that the code reads. Every call compares lengths with these, and with those of `expected`.
    readable: HashSet<(u8, u32)>,
    /// What these are to have in the end.
    expected: HashMap<(u8, u32), Option<Held>>,
    /// The instruction that has a register as the first of its results.
    instructions: Vec<Option<&'a Instruction>>,
    vectors: Vec<Option<Held>>,
    slots: Vec<Option<Held>>,
    shared: Vec<Option<Held>>,
    stored: HashMap<(u8, u32), Held>,
}

/// Whether a program computes what its code does, reads and writes nothing but what the code does and its own frame, and names only
/// registers that exist.
pub fn computes(program: &Program, code: &Code, layout: Layout) -> bool {
    let mut followed = Followed::new(program, code, layout);
    let operations = program.operations.iter();
    let all = operations.map(|operation| followed.operation(operation));
    all.collect::<Option<()>>().is_some() && followed.has_stored_all()
}

impl<'a> Followed<'a> {
    fn new(program: &'a Program, code: &'a Code, layout: Layout) -> Self {
        let mut instructions = vec![None; code.sources.len()];
        for instruction in &code.instructions {
            instructions.push(Some(instruction));
            let others = instruction.width() as usize - 1;
            instructions.resize(instructions.len() + others, None);
        }
        let places = code.sources.iter().filter_map(Source::place);
        let mut followed = Self {
            instructions,
            code,
            layout,
            program,
            readable: places
                .map(|(slice, entry)| (slice as u8, entry as u32))
                .collect(),
            expected: HashMap::new(),
            vectors: vec![None; usize::from(layout.width.registers())],
            slots: vec![None; program.slots as usize],
            shared: vec![None; program.shared as usize],
            stored: HashMap::new(),
        };
        for store in &code.stores {
            let held = followed.meant(store.register);
            // of two stores to one entry the last counts
            followed.expected.insert((store.target, store.entry), held);
        }
        followed
    }

    /// What a register of the code is.
    fn meant(&self, register: Register) -> Option<Held> {
        let Some(source) = self.code.sources.get(register as usize) else {
            return Some(Held::Result(register));
        };
        Some(match (source.place(), source) {
            (Some((slice, entry)), _) => Held::Entry(slice as u8, entry as u32),
            (None, Source::Number(number)) => Held::Bits(number.value::<f64>().to_bits()),
            (None, _) => return None,
        })
    }

    fn instruction(&self, result: Register) -> Option<&'a Instruction> {
        *self.instructions.get(result as usize)?
    }

    fn at(&self, vector: Vector) -> Option<Held> {
        *self.vectors.get(usize::from(vector.0))?
    }

    /// What a place holds; none where nothing may be read.
    fn read(&self, place: Place) -> Option<Held> {
        match place {
            Place::Slice { slice, entry } => {
                let is_readable = self.readable.contains(&(slice, entry));
                is_readable.then_some(Held::Entry(slice, entry))
            }
            Place::Target { target, entry } => self.stored.get(&(target, entry)).copied(),
            Place::Slot(slot) => *self.slots.get(slot as usize)?,
            Place::Shared(place) => *self.shared.get(place as usize)?,
            Place::Constant(constant) => {
                let bits = self.program.constants.get(constant as usize)?;
                Some(Held::Bits(*bits))
            }
        }
    }

    fn write(&mut self, place: Place, held: Held) -> Option<()> {
        match place {
            Place::Slice { .. } | Place::Constant(_) => return None,
            Place::Target { target, entry } => {
                self.expected.get(&(target, entry))?;
                self.stored.insert((target, entry), held);
            }
            Place::Slot(slot) => *self.slots.get_mut(slot as usize)? = Some(held),
            Place::Shared(place) => *self.shared.get_mut(place as usize)? = Some(held),
        }
        Some(())
    }

    fn hold(&mut self, vector: Vector, held: Held) -> Option<()> {
        *self.vectors.get_mut(usize::from(vector.0))? = Some(held);
        Some(())
    }

    fn operand(&self, what: Arithmetic, operand: Operand) -> Option<Held> {
        match operand {
            Operand::Vector(vector) => self.at(vector),
            Operand::Place(place) if self.layout.is_operand_of(what, place) => self.read(place),
            Operand::Place(_) => None,
        }
    }

    /// Whether these are what an instruction reads; of a sum and a product in either order.
    fn are_read(&self, instruction: &Instruction, found: &[Held]) -> Option<()> {
        let meant: Option<Vec<Held>> = operands(instruction)
            .into_iter()
            .map(|operand| self.meant(operand))
            .collect();
        let meant = meant?;
        let commutes = matches!(
            instruction,
            Instruction::Add(..) | Instruction::Mul(..) | Instruction::Bits(..)
        );
        let turned = commutes && found.iter().rev().eq(&meant);
        (found == meant || turned).then_some(())
    }

    fn operation(&mut self, operation: &Operation) -> Option<()> {
        match *operation {
            Operation::Load { to, from } => {
                let held = self.read(from)?;
                self.hold(to, held)
            }
            Operation::Store { from, to } => {
                let held = self.at(from)?;
                self.write(to, held)
            }
            Operation::Arithmetic {
                result,
                what,
                to,
                left,
                right,
            } => {
                let instruction = self.instruction(result)?;
                let (left, right) = (self.at(left)?, self.operand(what, right)?);
                match (instruction, what) {
                    (Instruction::Add(..), Arithmetic::Add)
                    | (Instruction::Sub(..), Arithmetic::Sub)
                    | (Instruction::Mul(..), Arithmetic::Mul)
                    | (Instruction::Div(..), Arithmetic::Div) => {
                        self.are_read(instruction, &[left, right])?;
                    }
                    (Instruction::Bits(meant, ..), _) if Arithmetic::of_bits(*meant) == what => {
                        self.are_read(instruction, &[left, right])?;
                    }
                    (Instruction::Neg(_), Arithmetic::Xor)
                        if right == Held::Bits((-0.0_f64).to_bits()) =>
                    {
                        self.are_read(instruction, &[left])?;
                    }
                    (Instruction::Abs(_), Arithmetic::And) if right == Held::Bits(WITHOUT_SIGN) => {
                        self.are_read(instruction, &[left])?;
                    }
                    _ => return None,
                }
                self.hold(to, Held::Result(result))
            }
            Operation::Compare {
                result,
                equal,
                to,
                left,
                right,
                one,
            } => {
                let instruction = self.instruction(result)?;
                let is_one = self.read(one)? == Held::Bits(1.0_f64.to_bits());
                let is_other = ![left, right].contains(&to);
                let same = match instruction {
                    Instruction::Less(..) => !equal,
                    Instruction::LessEqual(..) => equal,
                    _ => false,
                };
                if !(is_one && is_other && same) {
                    return None;
                }
                let read = [self.at(left)?, self.at(right)?];
                self.are_read(instruction, &read)?;
                self.hold(to, Held::Result(result))
            }
            Operation::Larger {
                result,
                to,
                left,
                right,
            } => {
                let instruction = self.instruction(result)?;
                let is_other = ![left, right].contains(&to);
                if !(is_other && matches!(instruction, Instruction::Larger(..))) {
                    return None;
                }
                let read = [self.at(left)?, self.at(right)?];
                self.are_read(instruction, &read)?;
                self.hold(to, Held::Result(result))
            }
            Operation::Exchange {
                result,
                distance,
                to,
                of,
            } => {
                let instruction = self.instruction(result)?;
                let same = matches!(instruction, Instruction::Exchange(d, _) if *d == distance);
                let within = usize::from(distance) < self.layout.width.lanes();
                let of = self.at(of).filter(|_| same && within)?;
                self.are_read(instruction, &[of])?;
                self.hold(to, Held::Result(result))
            }
            Operation::Sqrt { result, to, of } => {
                let instruction = self.instruction(result)?;
                let is_root = matches!(instruction, Instruction::Sqrt(_));
                let of = self.at(of).filter(|_| is_root)?;
                self.are_read(instruction, &[of])?;
                self.hold(to, Held::Result(result))
            }
            Operation::Shift {
                result,
                to,
                of,
                places,
            } => {
                let instruction = self.instruction(result)?;
                let is_same = matches!(instruction, Instruction::Shift(by, _) if *by == places);
                let of = self.at(of).filter(|_| is_same)?;
                self.are_read(instruction, &[of])?;
                self.hold(to, Held::Result(result))
            }
            Operation::Below {
                result,
                jumps: _,
                to,
                test,
                zero,
                then,
                otherwise,
            } => {
                let instruction = self.instruction(result)?;
                let is_other = ![test, then, otherwise].contains(&to);
                let is_choice =
                    matches!(instruction, Instruction::Below(..) | Instruction::Blend(..));
                if !(self.is_zero(zero) && is_other && is_choice) {
                    return None;
                }
                let read = [self.at(test)?, self.at(then)?, self.at(otherwise)?];
                self.are_read(instruction, &read)?;
                self.hold(to, Held::Result(result))
            }
            Operation::Rare {
                result,
                value,
                test,
                zero,
                x,
                scratch,
                function,
                kept,
            } => {
                let instruction = self.instruction(result)?;
                let is_same = matches!(instruction, Instruction::Rare(of, ..)
                    if std::ptr::fn_addr_eq(unary(*of)?, function));
                self.at_exists(scratch)?;
                let read = [self.at(x)?, self.at(test)?, self.at(value)?];
                let is_kept = |vector: Vector| kept & (1 << vector.0) != 0;
                let has_places = kept.count_ones() <= self.program.kept && self.program.shared >= 3;
                let is_scratch = ![value, x].contains(&scratch) && !is_kept(scratch);
                if !(is_same && self.is_zero(zero) && has_places && is_scratch) || is_kept(value) {
                    return None;
                }
                self.are_read(instruction, &read)?;
                for (place, held) in self.vectors.iter_mut().enumerate() {
                    if !is_kept(Vector(place as u8)) {
                        *held = None;
                    }
                }
                self.shared.fill(None);
                self.hold(value, Held::Result(result))
            }
            Operation::Call { result, called } => self.call(result, called),
        }
    }

    fn at_exists(&self, vector: Vector) -> Option<()> {
        (usize::from(vector.0) < self.vectors.len()).then_some(())
    }

    /// Whether a place has the number 0 for all lanes.
    fn is_zero(&self, place: Place) -> bool {
        self.layout.is_operand(place) && self.read(place) == Some(Held::Bits(0))
    }

    fn call(&mut self, result: Register, found: Called) -> Option<()> {
        let instruction = self.instruction(result)?;
        let same = match (called(instruction)?, found) {
            (Called::Unary(f), Called::Unary(g)) => std::ptr::fn_addr_eq(f, g),
            (Called::Binary(f), Called::Binary(g)) => std::ptr::fn_addr_eq(f, g),
            (Called::Stumpff(m), Called::Stumpff(n)) | (Called::Phi(m), Called::Phi(n)) => m == n,
            _ => false,
        };
        let [given, gives] = found.counts();
        let given: Option<Vec<Held>> = (0..given)
            .map(|place| self.read(Place::Shared(place)))
            .collect();
        self.are_read(instruction, &given.filter(|_| same)?)?;
        self.vectors.fill(None);
        for place in 0..gives {
            self.write(Place::Shared(place), Held::Result(result + place))?;
        }
        Some(())
    }

    /// Whether every entry has what the last store to it says.
    fn has_stored_all(&self) -> bool {
        self.expected
            .iter()
            .all(|(place, held)| held.is_some() && self.stored.get(place).copied() == *held)
    }
}
