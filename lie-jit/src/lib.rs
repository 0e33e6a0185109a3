//! Machine code for the codes of [`lie_dynamic`], made at run time by Cranelift.
//!
//! One function for each code, with the operations in their order: the digits are those of the interpreter. Elementary functions are
//! those of the numeric core. This is the only crate with `unsafe` code: it calls what it has compiled. Before every call the
//! lengths of all slices are compared with what the code reads and writes.

#![warn(missing_docs)]

mod compile;
mod functions;

use compile::Compiler;
use cranelift_jit::JITModule;
use lie_dynamic::{Code, Engine, Frame, Interpreted, Machine, Source, Targets};
use std::mem::ManuallyDrop;
use std::sync::Arc;

/// The engine of Cranelift. Where the processor is none that it knows, codes are interpreted.
#[derive(Clone, Copy, Debug, Default)]
pub struct Jit;

/// Codes with more instructions than this are interpreted: Cranelift's time grows faster than they are long.
const LONGEST: usize = 20_000;

/// The slices that a function reads, in the order of its table: the arguments, then the constants of the system and of the step
/// size, the parameters, step size and time.
const INPUTS: usize = 8;

/// A compiled code: reads from a table of [`INPUTS`] pointers, writes to two places.
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
    inputs: [usize; INPUTS],
    outputs: [usize; 2],
    clear: [usize; 2],
}

/// Compiled codes with the memory that they are in.
struct Compiled {
    entries: Vec<Entry>,
    interpreted: Arc<dyn Machine<f64>>,
    memory: ManuallyDrop<JITModule>,
}

// SAFETY: the functions read nothing but their arguments, and the memory they are in is not changed once they are complete.
unsafe impl Send for Compiled {}
// SAFETY: as above.
unsafe impl Sync for Compiled {}

impl Drop for Compiled {
    fn drop(&mut self) {
        // SAFETY: the module is taken once, here; its functions are called only by `run`, which borrows what is being dropped.
        unsafe { ManuallyDrop::take(&mut self.memory).free_memory() }
    }
}

impl Compiled {
    fn new(codes: &[Code], interpreted: Arc<dyn Machine<f64>>) -> Option<Self> {
        let mut compiler = Compiler::new()?;
        let mut places = Vec::with_capacity(codes.len());
        for code in codes {
            let short = code.instructions.len() <= LONGEST;
            places.push(if short {
                Some(compiler.add(code)?)
            } else {
                None
            });
        }
        let module = compiler.finish()?;
        let entries = codes.iter().zip(places).map(|(code, place)| {
            let function = place.map(|place| {
                let pointer = module.get_finalized_function(place);
                // SAFETY: the pointer is that of a function which was compiled with this signature.
                unsafe { std::mem::transmute::<*const u8, Function>(pointer) }
            });
            Entry::new(code, function)
        });
        let entries = entries.collect();
        Some(Self {
            entries,
            interpreted,
            memory: ManuallyDrop::new(module.into_inner()),
        })
    }
}

impl Entry {
    fn new(code: &Code, function: Option<Function>) -> Self {
        let mut inputs = [0; INPUTS];
        for source in &code.sources {
            if let Some((slice, entry)) = input(source) {
                inputs[slice] = inputs[slice].max(entry + 1);
            }
        }
        let mut outputs = [0; 2];
        for store in &code.stores {
            let output = &mut outputs[usize::from(store.target)];
            *output = (*output).max(store.entry as usize + 1);
        }
        Self {
            function,
            inputs,
            outputs,
            clear: code.clear.map(|count| count.unwrap_or(0) as usize),
        }
    }
}

/// The slice and the entry that a source is.
fn input(source: &Source) -> Option<(usize, usize)> {
    Some(match *source {
        Source::Argument(argument, entry) => (usize::from(argument), entry as usize),
        Source::System(position) => (4, position as usize),
        Source::OfStep(position) => (5, position as usize),
        Source::Parameter(position) => (6, position as usize),
        Source::Step => (7, 0),
        Source::Time => (7, 1),
        Source::Number(_) => return None,
    })
}

impl Machine<f64> for Compiled {
    fn run(&self, code: usize, frame: &Frame<'_, f64>, targets: Targets<'_, f64>) {
        let entry = &self.entries[code];
        let Some(function) = entry.function else {
            return self.interpreted.run(code, frame, targets);
        };
        let [a, b, c, d] = frame.arguments;
        let slices = [
            a,
            b,
            c,
            d,
            frame.system,
            frame.of_step,
            frame.parameters,
            &frame.scalars,
        ];
        for (slice, least) in slices.iter().zip(entry.inputs) {
            assert!(slice.len() >= least, "a slice is too short for its code");
        }
        let [vector, matrix] = targets;
        for (target, least) in [vector.len(), matrix.len()].iter().zip(entry.outputs) {
            assert!(*target >= least, "a target is too short for its code");
        }
        vector[..entry.clear[0]].fill(0.0);
        matrix[..entry.clear[1]].fill(0.0);
        let table = slices.map(<[f64]>::as_ptr);
        // SAFETY: every slice is as long as the code needs, and what is written is borrowed for writing.
        unsafe { function(table.as_ptr(), vector.as_mut_ptr(), matrix.as_mut_ptr()) }
    }
}
