//! From a code to Cranelift's intermediate form.

mod calls;
pub mod chain;
mod columns;
mod functions;
pub mod making;

use self::calls::Kind;
use cranelift_codegen::Context;
use cranelift_codegen::ir::condcodes::FloatCC;
use cranelift_codegen::ir::{AbiParam, FuncRef, InstBuilder, MemFlags, Type, Value, types};
use cranelift_codegen::settings::{self, Configurable};
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};
use cranelift_jit::{JITBuilder, JITModule};
use cranelift_module::{FuncId, Module, default_libcall_names};
use lie_dynamic::{Bitwise, Code, Instruction, Number, Source};
use std::collections::HashMap;

/// Bytes of a number, and of a pointer on every processor that is supported.
pub(crate) const WORD: i32 = 8;

/// Functions in the making.
pub struct Compiler {
    pub(crate) module: JITModule,
    pub(crate) context: Context,
    pub(crate) builder: FunctionBuilderContext,
}

/// What a register of a code is.
#[derive(Clone, Copy, Debug)]
pub struct Shape {
    /// A number, or the numbers of two lanes.
    pub(crate) number: Type,
    /// Bytes from a number of a slice to the next.
    pub(crate) stride: i32,
}

impl Shape {
    /// One number.
    pub const ONE: Self = Self {
        number: types::F64,
        stride: WORD,
    };

    /// Two neighbours of so many lanes.
    pub const fn pair_of_lanes(lanes: usize) -> Self {
        Self {
            number: types::F64X2,
            stride: WORD * lanes as i32,
        }
    }
}

/// A function under construction.
pub(crate) struct Body<'a, 'b> {
    pub(crate) module: &'a mut JITModule,
    pub(crate) builder: &'a mut FunctionBuilder<'b>,
    pub(crate) called: HashMap<String, FuncRef>,
    pub(crate) registers: Vec<Value>,
    pub(crate) shape: Shape,
}

impl Compiler {
    /// None where the processor is not known.
    pub fn new() -> Option<Self> {
        let mut flags = settings::builder();
        for (name, value) in [
            ("opt_level", "speed"),
            ("enable_verifier", "false"),
            ("is_pic", "false"),
            ("use_colocated_libcalls", "false"),
            // a program of a whole step may have a frame larger than a page
            ("enable_probestack", "true"),
            ("probestack_strategy", "inline"),
        ] {
            flags.set(name, value).ok()?;
        }
        let isa = cranelift_native::builder().ok()?;
        let isa = isa.finish(settings::Flags::new(flags)).ok()?;
        let mut builder = JITBuilder::with_isa(isa, default_libcall_names());
        for (name, address) in functions::symbols() {
            builder.symbol(name, address);
        }
        let module = JITModule::new(builder);
        Some(Self {
            context: module.make_context(),
            builder: FunctionBuilderContext::new(),
            module,
        })
    }

    /// Compiles a code.
    pub fn add(&mut self, code: &Code, shape: Shape) -> Option<FuncId> {
        let pointer = self.module.target_config().pointer_type();
        let signature = &mut self.context.func.signature;
        signature.params.extend([AbiParam::new(pointer); 3]);
        let mut builder = FunctionBuilder::new(&mut self.context.func, &mut self.builder);
        let block = builder.create_block();
        builder.append_block_params_for_function_params(block);
        builder.switch_to_block(block);
        builder.seal_block(block);
        let parameters = builder.block_params(block).to_vec();
        let mut body = Body {
            module: &mut self.module,
            builder: &mut builder,
            called: HashMap::new(),
            registers: Vec::with_capacity(code.registers as usize),
            shape,
        };
        body.load(code, parameters[0]);
        for instruction in &code.instructions {
            body.instruction(instruction)?;
        }
        for store in &code.stores {
            let value = body.registers[store.register as usize];
            let place = parameters[1 + usize::from(store.target)];
            let offset = i32::try_from(store.entry).ok()?.checked_mul(shape.stride)?;
            body.builder
                .ins()
                .store(MemFlags::trusted(), value, place, offset);
        }
        builder.ins().return_(&[]);
        builder.finalize();
        self.defined()
    }

    /// The function that is in the making.
    pub(crate) fn defined(&mut self) -> Option<FuncId> {
        let signature = &self.context.func.signature;
        let function = self.module.declare_anonymous_function(signature).ok()?;
        self.module
            .define_function(function, &mut self.context)
            .ok()?;
        self.module.clear_context(&mut self.context);
        Some(function)
    }

    /// Makes all functions ready to be called.
    pub fn finish(mut self) -> Option<JITModule> {
        self.module.finalize_definitions().ok()?;
        Some(self.module)
    }
}

impl Body<'_, '_> {
    /// The registers of the sources.
    fn load(&mut self, code: &Code, table: Value) {
        let mut slices = HashMap::new();
        for source in &code.sources {
            let value = self.source(source, table, &mut slices);
            self.registers.push(value);
        }
    }

    /// A source, from the slices of a table, whose places are kept.
    pub(crate) fn source(
        &mut self,
        source: &Source,
        table: Value,
        slices: &mut HashMap<usize, Value>,
    ) -> Value {
        match (source.place(), source) {
            (Some((slice, entry)), _) => {
                let base = *slices
                    .entry(slice)
                    .or_insert_with(|| self.word(table, slice));
                let offset = entry as i32 * self.shape.stride;
                let number = self.shape.number;
                self.builder
                    .ins()
                    .load(number, MemFlags::trusted(), base, offset)
            }
            (None, Source::Number(number)) => self.number(*number),
            (None, _) => unreachable!("only numbers are not read"),
        }
    }

    /// An entry of a table of places.
    pub(crate) fn word(&mut self, table: Value, entry: usize) -> Value {
        let offset = entry as i32 * WORD;
        self.builder
            .ins()
            .load(types::I64, MemFlags::trusted(), table, offset)
    }

    fn number(&mut self, number: Number) -> Value {
        self.constant(number.value::<f64>())
    }

    fn constant(&mut self, value: f64) -> Value {
        let value = self.builder.ins().f64const(value);
        match self.shape.number.is_vector() {
            true => self.builder.ins().splat(self.shape.number, value),
            false => value,
        }
    }

    /// Does something with numbers: in each lane.
    fn in_lanes(
        &mut self,
        arguments: &[Value],
        work: &mut dyn FnMut(&mut Self, &[Value]) -> Option<Value>,
    ) -> Option<Value> {
        if !self.shape.number.is_vector() {
            return work(self, arguments);
        }
        let mut lanes = [None; 2];
        for (lane, place) in lanes.iter_mut().enumerate() {
            let builder = &mut self.builder;
            let all = arguments.iter();
            let arguments: Vec<Value> = all
                .map(|&all| builder.ins().extractlane(all, lane as u8))
                .collect();
            *place = work(self, &arguments);
        }
        Some(self.both(lanes[0]?, lanes[1]?))
    }

    /// Both lanes of a vector.
    fn both(&mut self, first: Value, second: Value) -> Value {
        let first = self
            .builder
            .ins()
            .scalar_to_vector(self.shape.number, first);
        self.builder.ins().insertlane(first, second, 1)
    }

    pub(crate) fn instruction(&mut self, instruction: &Instruction) -> Option<()> {
        let at = |register: u32| self.registers[register as usize];
        let value = match *instruction {
            Instruction::Add(a, b) => {
                let (a, b) = (at(a), at(b));
                self.builder.ins().fadd(a, b)
            }
            Instruction::Sub(a, b) => {
                let (a, b) = (at(a), at(b));
                self.builder.ins().fsub(a, b)
            }
            Instruction::Mul(a, b) => {
                let (a, b) = (at(a), at(b));
                self.builder.ins().fmul(a, b)
            }
            Instruction::Div(a, b) => {
                let (a, b) = (at(a), at(b));
                self.builder.ins().fdiv(a, b)
            }
            Instruction::Neg(a) => {
                let a = at(a);
                self.builder.ins().fneg(a)
            }
            Instruction::Sqrt(a) => {
                let a = at(a);
                self.builder.ins().sqrt(a)
            }
            Instruction::Abs(a) => {
                let a = at(a);
                self.builder.ins().fabs(a)
            }
            Instruction::Less(a, b) => self.compare(FloatCC::LessThan, at(a), at(b)),
            Instruction::LessEqual(a, b) => self.compare(FloatCC::LessThanOrEqual, at(a), at(b)),
            Instruction::Larger(a, b) => self.larger(at(a), at(b)),
            // neighbours in a pair; of single numbers there are none
            Instruction::Exchange(1, a) if self.shape.number.is_vector() => {
                let a = at(a);
                let [first, second] = [0, 1].map(|lane| self.builder.ins().extractlane(a, lane));
                self.both(second, first)
            }
            Instruction::Exchange(..) => return None,
            Instruction::Power(a, b) => {
                let arguments = [at(a), at(b)];
                self.function(&functions::name("powf"), Kind::Binary, &arguments)?
            }
            Instruction::Atan2(a, b) => {
                let arguments = [at(a), at(b)];
                self.function(&functions::name("atan2"), Kind::Binary, &arguments)?
            }
            Instruction::Call(function, a) => {
                let arguments = [at(a)];
                self.function(&functions::name(function.name()), Kind::Unary, &arguments)?
            }
            Instruction::Below(a, b, c) | Instruction::Blend(a, b, c) => {
                let (a, b, c) = (at(a), at(b), at(c));
                let zero = self.constant(0.0);
                let negative = self.builder.ins().fcmp(FloatCC::LessThan, a, zero);
                self.choose(negative, b, c)
            }
            Instruction::Bits(what, a, b) => {
                let [a, b] = [at(a), at(b)].map(|number| self.word_of(number));
                let ins = self.builder.ins();
                let word = match what {
                    Bitwise::And => ins.band(a, b),
                    Bitwise::Or => ins.bor(a, b),
                    Bitwise::Xor => ins.bxor(a, b),
                    Bitwise::Plus => ins.iadd(a, b),
                };
                self.number_of(word)
            }
            Instruction::Shift(places, a) => {
                let (a, by) = (at(a), i64::from(places.unsigned_abs()));
                let word = self.word_of(a);
                let word = match places < 0 {
                    true => self.builder.ins().ushr_imm(word, by),
                    false => self.builder.ins().ishl_imm(word, by),
                };
                self.number_of(word)
            }
            Instruction::Rare(function, a, b, c) => {
                let [a, b, c] = [at(a), at(b), at(c)];
                self.rare(function, [a, b, c])?
            }
            Instruction::Stumpff(count, a) => {
                let a = at(a);
                return self.family(&functions::name("stumpff"), count, a);
            }
            Instruction::Phi(count, a) => {
                let a = at(a);
                return self.family(&functions::name("phi"), count, a);
            }
        };
        self.registers.push(value);
        Some(())
    }

    /// 1 where it holds, 0 elsewhere.
    fn compare(&mut self, condition: FloatCC, left: Value, right: Value) -> Value {
        let [one, zero] = [1.0, 0.0].map(|value| self.constant(value));
        let holds = self.builder.ins().fcmp(condition, left, right);
        self.choose(holds, one, zero)
    }

    /// One number where a comparison holds, another one elsewhere.
    fn choose(&mut self, holds: Value, yes: Value, no: Value) -> Value {
        let number = self.shape.number;
        if !number.is_vector() {
            return self.builder.ins().select(holds, yes, no);
        }
        let ins = self.builder.ins();
        let holds = ins.bitcast(number, MemFlags::new(), holds);
        self.builder.ins().bitselect(holds, yes, no)
    }

    /// The larger one, the left where they are equal, no number where one is none.
    fn larger(&mut self, left: Value, right: Value) -> Value {
        let less = FloatCC::LessThan;
        let [less, is_none] = [(less, left), (FloatCC::Unordered, right)]
            .map(|(condition, with)| self.builder.ins().fcmp(condition, with, right));
        let is_right = self.builder.ins().bor(less, is_none);
        self.choose(is_right, right, left)
    }

    /// The bits of a number, or of both.
    fn word_of(&mut self, number: Value) -> Value {
        let word = self.word_type();
        self.builder.ins().bitcast(word, MemFlags::new(), number)
    }

    fn number_of(&mut self, word: Value) -> Value {
        let number = self.shape.number;
        self.builder.ins().bitcast(number, MemFlags::new(), word)
    }

    fn word_type(&self) -> Type {
        match self.shape.number.is_vector() {
            true => types::I64X2,
            false => types::I64,
        }
    }
}
