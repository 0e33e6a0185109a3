//! Machine code for the codes of [`lie_dynamic`], made at run time.
//!
//! One function for each code, with the operations in their order: the digits are those of the interpreter. Elementary functions are
//! those of the numeric core. On x86-64 under Unix an assembler of our own makes the functions (`assembler`) where the processor has AVX2 or
//! AVX-512, and codes are interpreted where it has neither; Cranelift makes them elsewhere (`cranelift`), and is built there alone,
//! since it takes long to compile. Before every call the lengths of all slices are compared with what the code reads and writes.

#![warn(missing_docs)]

#[cfg(all(unix, target_arch = "x86_64"))]
mod assembler;
mod columns;
#[cfg(not(all(unix, target_arch = "x86_64")))]
mod cranelift;
mod lanes;
mod make;
mod memory;
mod registers;

#[cfg(all(unix, target_arch = "x86_64"))]
use assembler::chain;
#[cfg(not(all(unix, target_arch = "x86_64")))]
use cranelift::chain;

use chain::Parts;
use columns::ColumnKernels;
use lanes::{Lanes, Wide};
use lie_dynamic::{
    Cache, Chain, Code, Engine, Frame, Interpreted, Lengths, Machine, SLICES, Targets,
    place_by_place,
};
use lie_runtime::Scalar;
use make::Purpose;
use memory::{Function, Memory};
pub use registers::Registers;
use std::hash::{Hash, Hasher};
use std::sync::{Arc, OnceLock};

/// The engine of machine code, in the widest registers of this processor. Where it has none that code is made for, codes are
/// interpreted.
#[derive(Clone, Copy, Debug, Default)]
pub struct Jit;

impl Jit {
    /// The same in these registers, for tests and measurements; none where the processor does not have them.
    pub fn with(registers: Registers) -> Option<JitWith> {
        registers.are_here().then_some(JitWith(registers))
    }
}

/// The engine of machine code in registers that were asked for, see [`Jit::with`].
#[derive(Clone, Copy, Debug)]
pub struct JitWith(Registers);

fn machine(codes: &Arc<[Code]>, registers: Option<Registers>) -> Arc<dyn Machine<f64>> {
    let interpreted = Interpreted.machine(codes);
    let compiled =
        registers.and_then(|known| Compiled::new(codes, Arc::clone(&interpreted), known));
    match compiled {
        Some(compiled) => Arc::new(compiled),
        None => interpreted,
    }
}

impl Engine for Jit {
    fn name(&self) -> &'static str {
        Registers::widest().map_or("interpreter", |_| "machine code")
    }

    fn machine(&self, codes: &Arc<[Code]>) -> Arc<dyn Machine<f64>> {
        machine(codes, Registers::widest())
    }
}

impl Engine for JitWith {
    fn name(&self) -> &'static str {
        match self.0 {
            Registers::Avx512 => "AVX-512",
            Registers::Avx2 => "AVX2",
            Registers::Pairs => "cranelift",
        }
    }

    fn machine(&self, codes: &Arc<[Code]>) -> Arc<dyn Machine<f64>> {
        machine(codes, Some(self.0))
    }
}

/// One code: its function, and the least lengths of what it reads and writes.
struct Entry {
    function: Function,
    /// How many lanes it does.
    at_once: usize,
    lengths: Lengths,
    clear: [usize; 2],
}

/// Compiled codes with the memory that they are in.
struct Compiled {
    /// None of a code that is too long, which is interpreted.
    entries: Vec<Option<Entry>>,
    interpreted: Arc<dyn Machine<f64>>,
    codes: Arc<[Code]>,
    registers: Registers,
    wide: OnceLock<Arc<Lanes>>,
    column_kernels: ColumnKernels,
    others: Others<Self>,
    parts: Arc<Parts>,
    _memory: Memory,
}

/// Machines for other codes than those of a plan.
type Others<M> = Cache<M, SameCodes>;

/// Codes that are told apart by their place in memory, which they keep while they are known.
#[derive(Clone)]
struct SameCodes(Arc<[Code]>);

impl PartialEq for SameCodes {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl Eq for SameCodes {}

impl Hash for SameCodes {
    fn hash<H: Hasher>(&self, state: &mut H) {
        Arc::as_ptr(&self.0).cast::<Code>().hash(state);
    }
}

impl Compiled {
    fn new(
        codes: &Arc<[Code]>,
        interpreted: Arc<dyn Machine<f64>>,
        registers: Registers,
    ) -> Option<Self> {
        let made = make::over_numbers(codes, registers)?;
        let entries = made.places.iter().zip(codes.iter()).map(|(place, code)| {
            let function = made.memory.function((*place)?);
            Some(Entry::new(code, function, 1))
        });
        Some(Self {
            entries: entries.collect(),
            interpreted,
            codes: Arc::clone(codes),
            registers,
            wide: OnceLock::new(),
            column_kernels: ColumnKernels::new(codes.len()),
            others: Others::default(),
            parts: Arc::default(),
            _memory: made.memory,
        })
    }
}

impl Entry {
    fn new(code: &Code, function: Function, at_once: usize) -> Self {
        Self {
            function,
            at_once,
            lengths: Lengths::new(code),
            clear: code.clear.map(|count| count.unwrap_or(0) as usize),
        }
    }

    /// Calls the function over as many lanes as it does at a time, until all are done; over numbers, once.
    ///
    /// # Panics
    /// A slice is shorter than the code needs.
    fn call<S: Scalar>(&self, frame: &Frame<'_, S>, targets: Targets<'_, S>) {
        self.lengths.check(frame, &targets);
        let [vector, matrix] = targets;
        if self.clear != [0, 0] {
            vector[..self.clear[0]].fill(S::zero());
            matrix[..self.clear[1]].fill(S::zero());
        }
        let mut table = [std::ptr::null(); SLICES];
        for (to, slice) in table.iter_mut().zip(frame.slices()) {
            *to = slice.as_ptr().cast::<f64>();
        }
        let mut vector = vector.as_mut_ptr().cast::<f64>();
        let mut matrix = matrix.as_mut_ptr().cast::<f64>();
        let lanes = size_of::<S>() / size_of::<f64>();
        let mut done = 0;
        loop {
            // SAFETY: every slice is as long as the code needs, what is written is borrowed for writing, and a number is
            // its lanes one behind the other, of which the function takes so many from the first on; they divide the lanes.
            unsafe { (self.function)(table.as_ptr(), vector, matrix) }
            done += self.at_once;
            if done >= lanes {
                return;
            }
            table = table.map(|slice| slice.wrapping_add(self.at_once));
            vector = vector.wrapping_add(self.at_once);
            matrix = matrix.wrapping_add(self.at_once);
        }
    }
}

impl Machine<f64> for Compiled {
    fn run(&self, code: usize, frame: &Frame<'_, f64>, targets: Targets<'_, f64>) {
        match &self.entries[code] {
            Some(entry) => entry.call(frame, targets),
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
        let made = (&self.codes[code], Purpose::ColumnsOfNumbers, self.registers);
        let compiled = self.column_kernels.get(code, made);
        match compiled.filter(|compiled| compiled.at_once <= places) {
            Some(compiled) => {
                let rest = places % compiled.at_once;
                compiled.call(columns, frame, to, 0..places - rest);
                if rest > 0 {
                    // those at the end once more: the same numbers
                    compiled.call(columns, frame, to, places - compiled.at_once..places);
                }
            }
            None => place_by_place(0..places, columns, to, |at, out| {
                self.run(code, &frame.with_first(at), [out, &mut []]);
            }),
        }
    }

    fn compiles(&self) -> bool {
        true
    }

    fn compiles_quickly(&self) -> bool {
        self.registers != Registers::Pairs
    }

    fn has_compiled(&self, codes: &Arc<[Code]>) -> bool {
        self.others.has_tried(&SameCodes(Arc::clone(codes)))
    }

    fn compile(&self, codes: &Arc<[Code]>) -> Option<Arc<dyn Machine<f64>>> {
        let make = || Self::new(codes, Interpreted.machine(codes), self.registers);
        Some(self.others.get(&SameCodes(Arc::clone(codes)), make)?)
    }

    fn chain(&self, parts: usize, between: usize) -> Option<Box<dyn Chain<f64>>> {
        chain::linked(self.registers, &self.parts, parts, between)
    }

    fn wide(&self) -> Option<Arc<dyn Machine<Wide>>> {
        let lanes = || Arc::new(Lanes::new(&self.codes, self.registers));
        Some(Arc::clone(self.wide.get_or_init(lanes)) as Arc<dyn Machine<Wide>>)
    }
}
