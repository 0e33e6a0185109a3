//! Machine code for the codes of [`lie_dynamic`], made at run time by Cranelift.
//!
//! One function for each code, with the operations in their order: the digits are those of the interpreter. Elementary functions are
//! those of the numeric core. This is the only crate with `unsafe` code: it calls what it has compiled. Before every call the
//! lengths of all slices are compared with what the code reads and writes.

#![warn(missing_docs)]

mod columns;
mod compile;
mod functions;
mod lanes;

use columns::{ColumnKernels, Columns};
use compile::{Compiler, Shape};
use cranelift_jit::JITModule;
use cranelift_module::FuncId;
use lanes::{Lanes, Wide};
use lie_dynamic::{Code, Engine, Frame, Interpreted, Lengths, Machine, Targets, place_by_place};
use lie_runtime::Scalar;
use std::mem::ManuallyDrop;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

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
    column_kernels: ColumnKernels,
    others: Others<Self>,
    _memory: Memory,
}

/// Machines for other codes than those of a plan, each with the codes that it was made of.
struct Others<M>(Mutex<Vec<Made<M>>>);

type Made<M> = (Arc<[Code]>, Option<Arc<M>>);

impl<M> Others<M> {
    fn new() -> Self {
        Self(Mutex::new(Vec::new()))
    }

    fn all(&self) -> MutexGuard<'_, Vec<Made<M>>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn has_compiled(&self, codes: &Arc<[Code]>) -> bool {
        self.all()
            .iter()
            .any(|(known, _)| Arc::ptr_eq(known, codes))
    }

    /// The machine of these codes, made where it is asked for the first time.
    fn get_or_compile(
        &self,
        codes: &Arc<[Code]>,
        make: impl FnOnce() -> Option<M>,
    ) -> Option<Arc<M>> {
        let mut all = self.all();
        if let Some((_, machine)) = all.iter().find(|(known, _)| Arc::ptr_eq(known, codes)) {
            return machine.clone();
        }
        let machine = make().map(Arc::new);
        all.push((Arc::clone(codes), machine.clone()));
        machine
    }
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
            column_kernels: ColumnKernels::new(codes.len()),
            others: Others::new(),
            _memory: memory,
        })
    }
}

impl Entry {
    fn new(code: &Code, function: Option<Function>) -> Self {
        Self {
            function,
            lengths: Lengths::new(code),
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

    fn run_columns(
        &self,
        code: usize,
        columns: &[&[f64]],
        frame: &Frame<'_, f64>,
        to: &mut [&mut [f64]],
    ) {
        let places = to.first().map_or(0, |to| to.len());
        let pairs = places - places % 2;
        let compiled = self
            .column_kernels
            .get(code, &self.codes[code], Columns::NUMBERS);
        let done = match compiled {
            Some(compiled) if pairs > 0 => {
                compiled.call(columns, frame, to, pairs);
                pairs
            }
            _ => 0,
        };
        place_by_place(done..places, columns, to, |at, out| {
            self.run(code, &frame.with_first(at), [out, &mut []]);
        });
    }

    fn compiles(&self) -> bool {
        true
    }

    fn has_compiled(&self, codes: &Arc<[Code]>) -> bool {
        self.others.has_compiled(codes)
    }

    fn compile(&self, codes: &Arc<[Code]>) -> Option<Arc<dyn Machine<f64>>> {
        let make = || Self::new(codes, Interpreted.machine(codes));
        Some(self.others.get_or_compile(codes, make)?)
    }

    fn wide(&self) -> Option<Arc<dyn Machine<Wide>>> {
        let lanes = || Arc::new(Lanes::new(&self.codes));
        Some(Arc::clone(self.wide.get_or_init(lanes)) as Arc<dyn Machine<Wide>>)
    }
}
