//! From a code to Cranelift's intermediate form.

use crate::functions;
use crate::input;
use cranelift_codegen::Context;
use cranelift_codegen::ir::condcodes::FloatCC;
use cranelift_codegen::ir::{
    AbiParam, FuncRef, InstBuilder, MemFlags, StackSlotData, StackSlotKind, Value, types,
};
use cranelift_codegen::settings::{self, Configurable};
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};
use cranelift_jit::{JITBuilder, JITModule};
use cranelift_module::{FuncId, Linkage, Module, default_libcall_names};
use lie_dynamic::{Code, Instruction, Number, Source};
use std::collections::HashMap;

/// Bytes of a number, and of a pointer on every processor that is supported.
const WORD: i32 = 8;

/// Functions in the making.
pub struct Compiler {
    module: JITModule,
    context: Context,
    builder: FunctionBuilderContext,
}

/// Compiled functions in their memory.
pub struct Finished(JITModule);

impl Finished {
    /// The address of a function.
    pub fn get_finalized_function(&self, function: FuncId) -> *const u8 {
        self.0.get_finalized_function(function)
    }

    /// The memory.
    pub fn into_inner(self) -> JITModule {
        self.0
    }
}

/// What a function returns and is given.
#[derive(Clone, Copy)]
enum Kind {
    Unary,
    Binary,
    Family,
}

/// A function under construction.
struct Body<'a, 'b> {
    module: &'a mut JITModule,
    builder: &'a mut FunctionBuilder<'b>,
    called: HashMap<String, FuncRef>,
    registers: Vec<Value>,
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
    pub fn add(&mut self, code: &Code) -> Option<FuncId> {
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
        };
        body.load(code, parameters[0]);
        for instruction in &code.instructions {
            body.instruction(instruction)?;
        }
        for store in &code.stores {
            let value = body.registers[store.register as usize];
            let place = parameters[1 + usize::from(store.target)];
            let offset = i32::try_from(store.entry).ok()?.checked_mul(WORD)?;
            body.builder
                .ins()
                .store(MemFlags::trusted(), value, place, offset);
        }
        builder.ins().return_(&[]);
        builder.finalize();
        let signature = &self.context.func.signature;
        let function = self.module.declare_anonymous_function(signature).ok()?;
        self.module
            .define_function(function, &mut self.context)
            .ok()?;
        self.module.clear_context(&mut self.context);
        Some(function)
    }

    /// Makes all functions ready to be called.
    pub fn finish(mut self) -> Option<Finished> {
        self.module.finalize_definitions().ok()?;
        Some(Finished(self.module))
    }
}

impl Body<'_, '_> {
    /// The registers of the sources.
    fn load(&mut self, code: &Code, table: Value) {
        let mut slices: HashMap<usize, Value> = HashMap::new();
        for source in &code.sources {
            let value = match (input(source), source) {
                (Some((slice, entry)), _) => {
                    let builder = &mut self.builder;
                    let base = *slices.entry(slice).or_insert_with(|| {
                        let offset = slice as i32 * WORD;
                        builder
                            .ins()
                            .load(types::I64, MemFlags::trusted(), table, offset)
                    });
                    let offset = entry as i32 * WORD;
                    self.builder
                        .ins()
                        .load(types::F64, MemFlags::trusted(), base, offset)
                }
                (None, Source::Number(number)) => self.number(*number),
                (None, _) => unreachable!("only numbers are not read"),
            };
            self.registers.push(value);
        }
    }

    fn number(&mut self, number: Number) -> Value {
        self.builder.ins().f64const(number.value::<f64>())
    }

    fn instruction(&mut self, instruction: &Instruction) -> Option<()> {
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
            Instruction::Power(a, b) => {
                let arguments = [at(a), at(b)];
                self.call(&functions::name("powf"), Kind::Binary, &arguments)?
            }
            Instruction::Atan2(a, b) => {
                let arguments = [at(a), at(b)];
                self.call(&functions::name("atan2"), Kind::Binary, &arguments)?
            }
            Instruction::Call(function, a) => {
                let arguments = [at(a)];
                self.call(&functions::symbol(function), Kind::Unary, &arguments)?
            }
            Instruction::Below(a, b, c) => {
                let (a, b, c) = (at(a), at(b), at(c));
                let zero = self.builder.ins().f64const(0.0);
                let negative = self.builder.ins().fcmp(FloatCC::LessThan, a, zero);
                self.builder.ins().select(negative, b, c)
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

    /// All functions of a family below an index, each in a register.
    fn family(&mut self, name: &str, count: u8, argument: Value) -> Option<()> {
        let bytes = u32::from(count) * WORD as u32;
        let slot = StackSlotData::new(StackSlotKind::ExplicitSlot, bytes, 3);
        let slot = self.builder.create_sized_stack_slot(slot);
        let place = self.builder.ins().stack_addr(types::I64, slot, 0);
        let number = self.builder.ins().iconst(types::I64, i64::from(count));
        self.call(name, Kind::Family, &[number, argument, place]);
        for index in 0..i32::from(count) {
            let value = self
                .builder
                .ins()
                .stack_load(types::F64, slot, index * WORD);
            self.registers.push(value);
        }
        Some(())
    }

    /// Calls a function of ours; its result, if it has one.
    fn call(&mut self, name: &str, kind: Kind, arguments: &[Value]) -> Option<Value> {
        let function = match self.called.get(name) {
            Some(function) => *function,
            None => {
                let mut signature = self.module.make_signature();
                let number = AbiParam::new(types::F64);
                let word = AbiParam::new(types::I64);
                signature.params = match kind {
                    Kind::Unary => vec![number],
                    Kind::Binary => vec![number; 2],
                    Kind::Family => vec![word, number, word],
                };
                if !matches!(kind, Kind::Family) {
                    signature.returns.push(number);
                }
                let module = &mut self.module;
                let declared = module
                    .declare_function(name, Linkage::Import, &signature)
                    .ok()?;
                let function = module.declare_func_in_func(declared, self.builder.func);
                self.called.insert(name.to_owned(), function);
                function
            }
        };
        let call = self.builder.ins().call(function, arguments);
        self.builder.inst_results(call).first().copied()
    }
}
