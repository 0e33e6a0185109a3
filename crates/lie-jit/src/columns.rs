//! Codes over columns: a loop over places, two numbers at a time.

use crate::compile::{Body, Compiler, Shape, WORD};
use crate::make::{Purpose, make};
use crate::memory::Memory;
use crate::registers::Registers;
use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{AbiParam, BlockArg, InstBuilder, MemFlags, Value, types};
use cranelift_frontend::FunctionBuilder;
use cranelift_module::{FuncId, Module};
use lie_dynamic::{Code, Frame, Lengths, Source};
use lie_runtime::Scalar;
use smallvec::SmallVec;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::OnceLock;

/// A function over columns: reads from a table of the slices in a frame and from a table of columns, writes to a table of
/// columns, and does this for so many bytes of each.
pub type Function =
    unsafe extern "C" fn(*const *const f64, *const *const f64, *const *mut f64, usize);

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

/// Codes over columns, each compiled when it is first run.
pub struct ColumnKernels(Vec<OnceLock<Option<OverColumns>>>);

/// A code over columns.
pub struct OverColumns {
    function: Function,
    /// How many neighbours it does: of numbers places, of lanes those of a place.
    pub at_once: usize,
    lengths: Lengths,
    /// The entries that it does not write.
    clear: Vec<usize>,
    _memory: Memory,
}

impl ColumnKernels {
    pub fn new(codes: usize) -> Self {
        Self((0..codes).map(|_| OnceLock::new()).collect())
    }

    /// A code; none where it is too long, or has a matrix.
    pub fn get(&self, place: usize, made: (&Code, Purpose, Registers)) -> Option<&OverColumns> {
        let compile = || OverColumns::new(made.0, made.1, made.2);
        self.0[place].get_or_init(compile).as_ref()
    }
}

impl OverColumns {
    fn new(code: &Code, purpose: Purpose, registers: Registers) -> Option<Self> {
        if code.stores.iter().any(|store| store.target > 0) {
            return None;
        }
        let made = make(code, purpose, registers)?;
        let written = |entry: &usize| {
            let mut stores = code.stores.iter();
            stores.any(|store| store.entry as usize == *entry)
        };
        let all = code.clear[0].unwrap_or(0) as usize;
        Some(Self {
            function: made.memory.over_columns(made.place),
            at_once: made.at_once,
            lengths: Lengths::new(code),
            clear: (0..all).filter(|entry| !written(entry)).collect(),
            _memory: made.memory,
        })
    }

    /// Calls the function for these places, at least one; of numbers, as many as are done at a time or a multiple of it.
    ///
    /// # Panics
    /// A slice is shorter than the code needs, or a column than the first target; or there are other places than that.
    pub fn call<S: Scalar>(
        &self,
        columns: &[&[S]],
        frame: &Frame<'_, S>,
        to: &mut [&mut [S]],
        places: Range<usize>,
    ) {
        self.lengths.check_columns(columns, frame, to);
        let enough = to.first().is_some_and(|to| to.len() >= places.end);
        assert!(
            enough && !places.is_empty(),
            "there are fewer places than are asked for"
        );
        for entry in &self.clear {
            to[*entry][places.clone()].fill(S::zero());
        }
        let lanes = size_of::<S>() / size_of::<f64>();
        assert!(
            (places.len() * lanes).is_multiple_of(self.at_once),
            "numbers are done several at a time"
        );
        let mut table = frame.slices().map(|slice| slice.as_ptr().cast::<f64>());
        let columns = columns.iter();
        let columns = columns.map(|column| column[places.clone()].as_ptr().cast::<f64>());
        let mut columns: SmallVec<[*const f64; 24]> = columns.collect();
        let to = to.iter_mut();
        let to = to.map(|to| to[places.clone()].as_mut_ptr().cast::<f64>());
        let mut to: SmallVec<[*mut f64; 24]> = to.collect();
        for first in (0..lanes).step_by(self.at_once) {
            if first > 0 {
                table = table.map(|slice| slice.wrapping_add(self.at_once));
                for column in &mut columns {
                    *column = column.wrapping_add(self.at_once);
                }
                for to in &mut to {
                    *to = to.wrapping_add(self.at_once);
                }
            }
            let bytes = places.len() * size_of::<S>();
            // SAFETY: every slice and every column is as long as the code needs, and has this many bytes from its own
            // beginning on; the function does so many numbers for each step, which the places are a multiple of. What is
            // written is borrowed for writing.
            unsafe { (self.function)(table.as_ptr(), columns.as_ptr(), to.as_ptr(), bytes) }
        }
    }
}
