//! Machine code for the codes of [`lie_dynamic`], made at run time by Cranelift.
//!
//! One function for each code, with the operations in their order: the digits are those of the interpreter. Elementary functions are
//! those of the numeric core. This is the only crate with `unsafe` code: it calls what it has compiled. Before every call the
//! lengths of all slices are compared with what the code reads and writes.

#![warn(missing_docs)]

mod columns;
mod compile;
mod functions;

use columns::Columns;
use compile::{Compiler, Shape};
use cranelift_jit::JITModule;
use cranelift_module::FuncId;
use lie_dynamic::{
    Code, Engine, Frame, Interpreted, Interpreter, Lengths, Machine, Targets, place_by_place,
};
use lie_runtime::Scalar;
use smallvec::SmallVec;
use std::mem::ManuallyDrop;
use std::sync::{Arc, OnceLock};

/// The engine of Cranelift. Where the processor is none that it knows, codes are interpreted.
#[derive(Clone, Copy, Debug, Default)]
pub struct Jit;

/// Codes with more instructions than this are interpreted: Cranelift's time grows faster than they are long.
const LONGEST: usize = 20_000;

/// A compiled code: reads from a table of the slices in a frame, writes to two places.
type Function = unsafe extern "C" fn(*const *const f64, *mut f64, *mut f64);

impl Engine for Jit {
    fn name(&self) -> &'static str {
        "cranelift"
    }

    fn machine(&self, codes: &Arc<[Code]>) -> Arc<dyn Machine<f64>> {
        let interpreted = Interpreted.machine(codes);
        match Compiled::new(codes, Arc::clone(&interpreted)) {
            Some(compiled) => Arc::new(compiled),
            None => interpreted,
        }
    }
}

/// One code: its function, and the least lengths of what it reads and writes.
struct Entry {
    /// None of a code that is too long, which is interpreted.
    function: Option<Function>,
    lengths: Lengths,
    clear: [usize; 2],
}

/// The memory of compiled functions.
struct Memory(ManuallyDrop<JITModule>);

// SAFETY: functions read nothing but their arguments, and the memory they are in is not changed once they are complete.
unsafe impl Send for Memory {}
// SAFETY: as above.
unsafe impl Sync for Memory {}

impl Drop for Memory {
    fn drop(&mut self) {
        // SAFETY: the module is taken once, here; its functions are called only by the machines that own the memory.
        unsafe { ManuallyDrop::take(&mut self.0).free_memory() }
    }
}

impl Memory {
    fn new(compiler: Compiler) -> Option<Self> {
        Some(Self(ManuallyDrop::new(compiler.finish()?)))
    }

    fn function(&self, place: FuncId) -> Function {
        let pointer = self.0.get_finalized_function(place);
        // SAFETY: the pointer is that of a function which was compiled with this signature.
        unsafe { std::mem::transmute::<*const u8, Function>(pointer) }
    }

    fn over_columns(&self, place: FuncId) -> columns::Function {
        let pointer = self.0.get_finalized_function(place);
        // SAFETY: as above.
        unsafe { std::mem::transmute::<*const u8, columns::Function>(pointer) }
    }
}

/// Compiled codes with the memory that they are in.
struct Compiled {
    entries: Vec<Entry>,
    interpreted: Arc<dyn Machine<f64>>,
    codes: Arc<[Code]>,
    wide: OnceLock<Arc<Lanes>>,
    along: Along,
    _memory: Memory,
}

impl Compiled {
    fn new(codes: &Arc<[Code]>, interpreted: Arc<dyn Machine<f64>>) -> Option<Self> {
        let mut compiler = Compiler::new()?;
        let mut places = Vec::with_capacity(codes.len());
        for code in codes.iter() {
            let short = code.instructions.len() <= LONGEST;
            places.push(if short {
                Some(compiler.add(code, Shape::ONE)?)
            } else {
                None
            });
        }
        let memory = Memory::new(compiler)?;
        let entries = codes
            .iter()
            .zip(places)
            .map(|(code, place)| Entry::new(code, place.map(|place| memory.function(place))));
        Some(Self {
            entries: entries.collect(),
            interpreted,
            codes: Arc::clone(codes),
            wide: OnceLock::new(),
            along: Along::new(codes.len()),
            _memory: memory,
        })
    }
}

impl Entry {
    fn new(code: &Code, function: Option<Function>) -> Self {
        Self {
            function,
            lengths: Lengths::of(code),
            clear: code.clear.map(|count| count.unwrap_or(0) as usize),
        }
    }

    /// Calls the function over lanes, two by two; over numbers, once.
    ///
    /// # Panics
    /// A slice is shorter than the code needs.
    fn call<S: Scalar>(&self, function: Function, frame: &Frame<'_, S>, targets: Targets<'_, S>) {
        self.lengths.check(frame, &targets);
        let [vector, matrix] = targets;
        vector[..self.clear[0]].fill(S::zero());
        matrix[..self.clear[1]].fill(S::zero());
        let mut table = frame.slices().map(|slice| slice.as_ptr().cast::<f64>());
        let mut vector = vector.as_mut_ptr().cast::<f64>();
        let mut matrix = matrix.as_mut_ptr().cast::<f64>();
        let lanes = size_of::<S>() / size_of::<f64>();
        for pair in 0..lanes.div_ceil(2) {
            if pair > 0 {
                table = table.map(|slice| slice.wrapping_add(2));
                vector = vector.wrapping_add(2);
                matrix = matrix.wrapping_add(2);
            }
            // SAFETY: every slice is as long as the code needs, what is written is borrowed for writing, and a number is
            // its lanes one behind the other, of which the function takes the first two, or the only one.
            unsafe { function(table.as_ptr(), vector, matrix) }
        }
    }
}

impl Machine<f64> for Compiled {
    fn run(&self, code: usize, frame: &Frame<'_, f64>, targets: Targets<'_, f64>) {
        let entry = &self.entries[code];
        match entry.function {
            Some(function) => entry.call(function, frame, targets),
            None => self.interpreted.run(code, frame, targets),
        }
    }

    fn along(
        &self,
        code: usize,
        columns: &[&[f64]],
        frame: &Frame<'_, f64>,
        to: &mut [&mut [f64]],
    ) {
        let places = to.first().map_or(0, |to| to.len());
        let pairs = places - places % 2;
        let compiled = self.along.get(code, &self.codes[code], Columns::NUMBERS);
        let done = match compiled {
            Some(compiled) if pairs > 0 => {
                compiled.call(columns, frame, to, pairs);
                pairs
            }
            _ => 0,
        };
        let [_, b, c, d] = frame.arguments;
        place_by_place(done..places, columns, to, |at, out| {
            let frame = Frame {
                arguments: [at, b, c, d],
                ..*frame
            };
            self.run(code, &frame, [out, &mut []]);
        });
    }

    fn wide(&self) -> Option<Arc<dyn Machine<Wide>>> {
        let lanes = || Arc::new(Lanes::new(&self.codes));
        Some(Arc::clone(self.wide.get_or_init(lanes)) as Arc<dyn Machine<Wide>>)
    }
}

/// Lanes of double precision.
type Wide = <f64 as Scalar>::Wide;

const LANES: usize = size_of::<Wide>() / size_of::<f64>();
const _: () = assert!(
    LANES.is_multiple_of(2) && LANES == <Wide as Scalar>::LANES,
    "lanes are numbers one behind the other, and come in pairs"
);

/// Codes over columns, each compiled when it is first run.
struct Along(Vec<OnceLock<Option<OverColumns>>>);

/// A code over columns.
struct OverColumns {
    function: columns::Function,
    lengths: Lengths,
    /// The entries that it does not write.
    clear: Vec<usize>,
    _memory: Memory,
}

impl Along {
    fn new(codes: usize) -> Self {
        Self((0..codes).map(|_| OnceLock::new()).collect())
    }

    /// A code; none where it is too long, or has a matrix.
    fn get(&self, place: usize, code: &Code, columns: Columns) -> Option<&OverColumns> {
        let compile = || OverColumns::new(code, columns);
        self.0[place].get_or_init(compile).as_ref()
    }
}

impl OverColumns {
    fn new(code: &Code, columns: Columns) -> Option<Self> {
        let matrix = code.stores.iter().any(|store| store.target > 0);
        if code.instructions.len() > LONGEST || matrix {
            return None;
        }
        let mut compiler = Compiler::new()?;
        let place = compiler.add_columns(code, columns)?;
        let memory = Memory::new(compiler)?;
        let written = |entry: &usize| {
            let mut stores = code.stores.iter();
            stores.any(|store| store.entry as usize == *entry)
        };
        let all = code.clear[0].unwrap_or(0) as usize;
        Some(Self {
            function: memory.over_columns(place),
            lengths: Lengths::of(code),
            clear: (0..all).filter(|entry| !written(entry)).collect(),
            _memory: memory,
        })
    }

    /// Calls the function for so many places from the first on, of numbers an even number of them; at least one is asked for.
    ///
    /// # Panics
    /// A slice is shorter than the code needs, or a column than the first target.
    fn call<S: Scalar>(
        &self,
        columns: &[&[S]],
        frame: &Frame<'_, S>,
        to: &mut [&mut [S]],
        places: usize,
    ) {
        self.lengths.check_columns(columns, frame, to);
        let enough = to.first().is_some_and(|to| to.len() >= places);
        assert!(
            enough && places > 0,
            "there are fewer places than are asked for"
        );
        for entry in &self.clear {
            to[*entry][..places].fill(S::zero());
        }
        let lanes = size_of::<S>() / size_of::<f64>();
        let mut table = frame.slices().map(|slice| slice.as_ptr().cast::<f64>());
        let columns = columns.iter().map(|column| column.as_ptr().cast::<f64>());
        let mut columns: SmallVec<[*const f64; 24]> = columns.collect();
        let to = to.iter_mut().map(|to| to.as_mut_ptr().cast::<f64>());
        let mut to: SmallVec<[*mut f64; 24]> = to.collect();
        for pair in 0..lanes.div_ceil(2) {
            if pair > 0 {
                table = table.map(|slice| slice.wrapping_add(2));
                for column in &mut columns {
                    *column = column.wrapping_add(2);
                }
                for to in &mut to {
                    *to = to.wrapping_add(2);
                }
            }
            let bytes = places * size_of::<S>();
            // SAFETY: every slice and every column is as long as the code needs, and has this many bytes from its own
            // beginning on; the function does two numbers for each step, which the places are a multiple of. What is written
            // is borrowed for writing.
            unsafe { (self.function)(table.as_ptr(), columns.as_ptr(), to.as_ptr(), bytes) }
        }
    }
}

/// Codes over lanes, each compiled when it is first run.
struct Lanes {
    entries: Vec<OnceLock<Option<(Entry, Function, Memory)>>>,
    codes: Arc<[Code]>,
    along: Along,
    interpreted: Interpreter,
}

impl Lanes {
    fn new(codes: &Arc<[Code]>) -> Self {
        Self {
            entries: codes.iter().map(|_| OnceLock::new()).collect(),
            codes: Arc::clone(codes),
            along: Along::new(codes.len()),
            interpreted: Interpreter::new(Arc::clone(codes)),
        }
    }

    fn compile(code: &Code) -> Option<(Entry, Function, Memory)> {
        if code.instructions.len() > LONGEST {
            return None;
        }
        let mut compiler = Compiler::new()?;
        let place = compiler.add(code, Shape::two_of(LANES))?;
        let memory = Memory::new(compiler)?;
        let function = memory.function(place);
        Some((Entry::new(code, Some(function)), function, memory))
    }
}

impl Machine<Wide> for Lanes {
    fn run(&self, code: usize, frame: &Frame<'_, Wide>, targets: Targets<'_, Wide>) {
        let compiled = self.entries[code].get_or_init(|| Self::compile(&self.codes[code]));
        match compiled {
            Some((entry, function, _)) => entry.call(*function, frame, targets),
            None => self.interpreted.run(code, frame, targets),
        }
    }
    fn along(
        &self,
        code: usize,
        columns: &[&[Wide]],
        frame: &Frame<'_, Wide>,
        to: &mut [&mut [Wide]],
    ) {
        let places = to.first().map_or(0, |to| to.len());
        match self
            .along
            .get(code, &self.codes[code], Columns::lanes(LANES))
        {
            Some(compiled) if places > 0 => compiled.call(columns, frame, to, places),
            _ => Machine::<Wide>::along(&self.interpreted, code, columns, frame, to),
        }
    }
}
