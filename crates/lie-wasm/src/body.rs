//! From a code to the body of a function.

use crate::module::Imports;
use lie_dynamic::{Bitwise, Code, Instruction, Register, SLICES};
use wasm_encoder::{BlockType, Function, Ieee64, InstructionSink, MemArg, MemArgTarget, ValType};

/// Bytes of a number, and of an address.
const NUMBER: u32 = 8;
const ADDRESS: u32 = 4;
/// The parameters, which are the first locals: addresses of the table and of both targets.
const TABLE: u32 = 0;
const TARGETS: [u32; 2] = [1, 2];

/// Where a register is.
#[derive(Clone, Copy)]
enum Place {
    Local(u32),
    Constant(f64),
}

/// A body under construction.
struct Body<'a> {
    out: InstructionSink<'a>,
    imports: &'a mut Imports,
    registers: Vec<Place>,
    /// The next local for a number.
    next: u32,
}

/// The body of a code. Locals are the parameters, the addresses of slices, and the registers that are no constants.
pub fn function(code: &Code, imports: &mut Imports) -> Function {
    let places = code
        .sources
        .iter()
        .filter(|source| source.place().is_some());
    let loaded = places.count() as u32;
    let results: u32 = code.instructions.iter().map(Instruction::width).sum();
    let locals = [
        (SLICES as u32, ValType::I32),
        (loaded + results, ValType::F64),
    ];
    let mut bytes = Vec::new();
    let mut body = Body {
        out: InstructionSink::new(&mut bytes),
        imports,
        registers: Vec::with_capacity(code.registers as usize),
        next: TARGETS[1] + 1 + SLICES as u32,
    };
    body.load(code);
    for instruction in &code.instructions {
        body.instruction(instruction);
    }
    body.store(code);
    body.out.end();
    let mut function = Function::new(locals);
    function.raw(bytes);
    function
}

/// The place of an entry behind an address. Offsets are bytes.
fn entry(entry: usize, size: u32) -> MemArg {
    MemArg {
        offset: entry as u64 * u64::from(size),
        align: size.ilog2(),
        target: MemArgTarget::Memory(0),
        ordering: None,
    }
}

impl<'a> Body<'a> {
    /// The registers of the sources.
    fn load(&mut self, code: &Code) {
        let local = |slice: usize| TARGETS[1] + 1 + slice as u32;
        let mut known = [false; SLICES];
        for source in &code.sources {
            match (source.place(), source) {
                (Some((slice, position)), _) => {
                    if !known[slice] {
                        known[slice] = true;
                        self.out
                            .local_get(TABLE)
                            .i32_load(entry(slice, ADDRESS))
                            .local_set(local(slice));
                    }
                    self.out
                        .local_get(local(slice))
                        .f64_load(entry(position, NUMBER));
                    self.result();
                }
                (None, lie_dynamic::Source::Number(number)) => {
                    self.registers.push(Place::Constant(number.value()));
                }
                (None, _) => unreachable!("only numbers are not read"),
            }
        }
    }

    /// What was computed last becomes the next register.
    fn result(&mut self) {
        self.out.local_set(self.next);
        self.registers.push(Place::Local(self.next));
        self.next += 1;
    }

    fn operand(&mut self, register: Register) {
        match self.registers[register as usize] {
            Place::Local(local) => self.out.local_get(local),
            Place::Constant(value) => self.out.f64_const(Ieee64::from(value)),
        };
    }

    fn operands(&mut self, registers: &[Register]) -> &mut InstructionSink<'a> {
        for register in registers {
            self.operand(*register);
        }
        &mut self.out
    }

    fn call(&mut self, name: &'static str, arguments: &[Register]) {
        let function = self.imports.index(name);
        self.operands(arguments).call(function);
    }

    fn instruction(&mut self, instruction: &Instruction) {
        match *instruction {
            Instruction::Add(a, b) => {
                self.operands(&[a, b]).f64_add();
            }
            Instruction::Sub(a, b) => {
                self.operands(&[a, b]).f64_sub();
            }
            Instruction::Mul(a, b) => {
                self.operands(&[a, b]).f64_mul();
            }
            Instruction::Div(a, b) => {
                self.operands(&[a, b]).f64_div();
            }
            Instruction::Neg(a) => {
                self.operands(&[a]).f64_neg();
            }
            Instruction::Sqrt(a) => {
                self.operands(&[a]).f64_sqrt();
            }
            Instruction::Abs(a) => {
                self.operands(&[a]).f64_abs();
            }
            Instruction::Less(a, b) => {
                self.operands(&[a, b]).f64_lt().f64_convert_i32_u();
            }
            Instruction::LessEqual(a, b) => {
                self.operands(&[a, b]).f64_le().f64_convert_i32_u();
            }
            Instruction::Larger(a, b) => {
                self.operands(&[b, a, a, b]).f64_lt();
                self.operands(&[b, b]).f64_ne().i32_or().select();
            }
            // of one lane it is the same number
            Instruction::Exchange(_, a) => self.operand(a),
            Instruction::Power(a, b) => self.call("powf", &[a, b]),
            Instruction::Atan2(a, b) => self.call("atan2", &[a, b]),
            Instruction::Call(function, a) => self.call(function.name(), &[a]),
            Instruction::Below(a, b, c) | Instruction::Blend(a, b, c) => {
                let out = self.operands(&[b, c, a]);
                out.f64_const(Ieee64::from(0.0)).f64_lt().select();
            }
            Instruction::Bits(what, a, b) => {
                for register in [a, b] {
                    self.operand(register);
                    self.out.i64_reinterpret_f64();
                }
                let out = &mut self.out;
                match what {
                    Bitwise::And => out.i64_and(),
                    Bitwise::Or => out.i64_or(),
                    Bitwise::Xor => out.i64_xor(),
                    Bitwise::Plus => out.i64_add(),
                }
                .f64_reinterpret_i64();
            }
            Instruction::Shift(places, a) => {
                let out = self.operands(&[a]).i64_reinterpret_f64();
                let out = out.i64_const(i64::from(places.unsigned_abs()));
                match places < 0 {
                    true => out.i64_shr_u(),
                    false => out.i64_shl(),
                }
                .f64_reinterpret_i64();
            }
            Instruction::Rare(function, a, b, c) => {
                let out = self.operands(&[b]).f64_const(Ieee64::from(0.0)).f64_ge();
                out.if_(BlockType::Result(ValType::F64));
                self.operands(&[c]).else_();
                self.call(function.name(), &[a]);
                self.out.end();
            }
            Instruction::Stumpff(count, a) => return self.family("stumpff", count, a),
            Instruction::Phi(count, a) => return self.family("phi", count, a),
        }
        self.result();
    }

    /// All functions of a family below an index, each in a register.
    fn family(&mut self, name: &'static str, count: u8, argument: Register) {
        let function = self.imports.index(name);
        for index in 0..count {
            self.out
                .i32_const(i32::from(count))
                .i32_const(i32::from(index));
            self.operand(argument);
            self.out.call(function);
            self.result();
        }
    }

    /// Writes the results, behind zeros where not every entry has one.
    fn store(&mut self, code: &Code) {
        for (target, clear) in TARGETS.iter().zip(code.clear) {
            if let Some(count) = clear {
                let bytes = (count * NUMBER) as i32;
                let out = self.out.local_get(*target);
                out.i32_const(0).i32_const(bytes).memory_fill(0);
            }
        }
        for store in &code.stores {
            self.out.local_get(TARGETS[usize::from(store.target)]);
            self.operand(store.register);
            self.out.f64_store(entry(store.entry as usize, NUMBER));
        }
    }
}
