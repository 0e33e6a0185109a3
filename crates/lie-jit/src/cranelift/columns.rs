//! Codes over columns: a loop over places, two numbers at a time.

use super::{Body, Compiler, Shape, WORD};
use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{AbiParam, BlockArg, InstBuilder, MemFlags, Value, types};
use cranelift_frontend::FunctionBuilder;
use cranelift_module::{FuncId, Module};
use lie_dynamic::{Code, Source};
use std::collections::HashMap;

/// Where the numbers of columns are.
#[derive(Clone, Copy, Debug)]
pub struct Columns {
    /// What the registers are, and how far apart entries of slices are.
    pub shape: Shape,
    /// Whether numbers of slices are single ones, which both lanes have.
    pub single: bool,
    /// Bytes from what is done at a time to the next.
    pub step: i32,
}

impl Columns {
    /// Columns of numbers: two neighbours at a time.
    pub const NUMBERS: Self = Self {
        shape: Shape::pair_of_lanes(1),
        single: true,
        step: 2 * WORD,
    };

    /// Columns of so many lanes, of which two neighbours are done.
    pub const fn lanes(lanes: usize) -> Self {
        let shape = Shape::pair_of_lanes(lanes);
        Self {
            shape,
            single: false,
            step: shape.stride,
        }
    }
}

/// The entry of the first argument, which is in columns.
fn column(source: &Source) -> Option<usize> {
    match source {
        Source::Argument(0, entry) => Some(*entry as usize),
        _ => None,
    }
}

impl Compiler {
    /// Compiles a code over columns.
    pub fn add_columns(&mut self, code: &Code, columns: Columns) -> Option<FuncId> {
        let pointer = self.module.target_config().pointer_type();
        let signature = &mut self.context.func.signature;
        signature.params.extend([AbiParam::new(pointer); 4]);
        let mut builder = FunctionBuilder::new(&mut self.context.func, &mut self.builder);
        let [start, each, end] = [(); 3].map(|()| builder.create_block());
        builder.append_block_params_for_function_params(start);
        builder.switch_to_block(start);
        builder.seal_block(start);
        let [table, from, to, bytes] = builder.block_params(start)[..] else {
            return None;
        };
        let mut body = Body {
            module: &mut self.module,
            builder: &mut builder,
            called: HashMap::new(),
            registers: Vec::with_capacity(code.registers as usize),
            shape: columns.shape,
        };
        // what is the same at all places, and where the columns begin
        let mut slices = HashMap::new();
        let sources = code.sources.iter();
        let known: Vec<Value> = sources
            .map(|source| match column(source) {
                Some(entry) => body.word(from, entry),
                None => body.once(source, table, &mut slices, columns.single),
            })
            .collect();
        let stores = code.stores.iter();
        let targets: Vec<Value> = stores
            .map(|store| body.word(to, store.entry as usize))
            .collect();
        let zero = body.builder.ins().iconst(types::I64, 0);
        body.builder.ins().jump(each, &[BlockArg::Value(zero)]);

        // a pair of numbers begins anywhere in a column
        let flags = MemFlags::new().with_notrap();
        let offset = body.builder.append_block_param(each, types::I64);
        body.builder.switch_to_block(each);
        for (source, known) in code.sources.iter().zip(known) {
            let value = match column(source) {
                Some(_) => {
                    let place = body.builder.ins().iadd(known, offset);
                    let number = columns.shape.number;
                    body.builder.ins().load(number, flags, place, 0)
                }
                None => known,
            };
            body.registers.push(value);
        }
        for instruction in &code.instructions {
            body.instruction(instruction)?;
        }
        for (store, target) in code.stores.iter().zip(targets) {
            let value = body.registers[store.register as usize];
            let place = body.builder.ins().iadd(target, offset);
            body.builder.ins().store(flags, value, place, 0);
        }
        let next = body.builder.ins().iadd_imm(offset, i64::from(columns.step));
        let more = body
            .builder
            .ins()
            .icmp(IntCC::UnsignedLessThan, next, bytes);
        body.builder
            .ins()
            .brif(more, each, &[BlockArg::Value(next)], end, &[]);
        builder.seal_block(each);
        builder.switch_to_block(end);
        builder.seal_block(end);
        builder.ins().return_(&[]);
        builder.finalize();
        self.defined()
    }
}

impl Body<'_, '_> {
    /// A source that is the same at all places.
    fn once(
        &mut self,
        source: &Source,
        table: Value,
        slices: &mut HashMap<usize, Value>,
        single: bool,
    ) -> Value {
        match source.place() {
            Some((slice, entry)) if single => {
                let base = *slices
                    .entry(slice)
                    .or_insert_with(|| self.word(table, slice));
                let offset = entry as i32 * WORD;
                let flags = MemFlags::trusted();
                let value = self.builder.ins().load(types::F64, flags, base, offset);
                self.builder.ins().splat(self.shape.number, value)
            }
            _ => self.source(source, table, slices),
        }
    }
}
