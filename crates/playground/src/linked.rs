//! Kernels as modules of WebAssembly that the page adds to the module it runs already.
//!
//! The page instantiates the bytes over the memory that the compiler itself uses, and puts the functions into its table, where
//! a function pointer of Rust is a place: a kernel is called as any function by a pointer, and the page has no part in it.

use lie_dynamic::{Code, Engine, Frame, Interpreted, Lengths, Machine, Targets};
use lie_wasm::Host;
use std::cell::Cell;
use std::sync::Arc;

#[link(wasm_import_module = "page")]
unsafe extern "C" {
    /// Instantiates a module of so many bytes whose imports are functions at these places of the table; the place of the first
    /// function of the module, which the others follow, or 0 where the browser does not take it.
    safe fn link(bytes: *const u8, length: usize, imports: *const usize, count: usize) -> usize;
    /// Removes so many functions from the table.
    safe fn unlink(first: usize, count: usize);
}

/// The engine of the page. Where the browser takes no module, codes are interpreted.
#[derive(Debug, Default)]
pub struct Linking {
    /// Whether the browser has taken the last module.
    linked: Cell<bool>,
}

impl Engine for Linking {
    fn name(&self) -> &'static str {
        match self.linked.get() {
            true => "webassembly",
            false => Interpreted.name(),
        }
    }

    fn machine(&self, codes: &Arc<[Code]>) -> Arc<dyn Machine<f64>> {
        let module = lie_wasm::module(codes);
        let places = module.imports.iter().map(|import| match import.host {
            Host::Unary(function) => function as usize,
            Host::Binary(function) => function as usize,
            Host::Family(function) => function as usize,
        });
        let imports: Vec<usize> = places.collect();
        let (bytes, interpreted) = (&module.bytes, Interpreted.machine(codes));
        let first = link(bytes.as_ptr(), bytes.len(), imports.as_ptr(), imports.len());
        self.linked.set(first != 0);
        if first == 0 {
            return interpreted;
        }
        let mut next = first;
        let kernels = module.compiled.iter().zip(codes.iter());
        let kernels = kernels.map(|(compiled, code)| {
            let kernel = compiled.then(|| kernel(next));
            next += usize::from(*compiled);
            (kernel, Lengths::new(code))
        });
        let kernels = kernels.collect();
        Arc::new(Linked {
            kernels,
            first,
            count: next - first,
            interpreted,
        })
    }
}

/// A function of a module: reads from a table of slices, writes to two places.
type Kernel = unsafe extern "C" fn(*const *const f64, *mut f64, *mut f64);

fn kernel(place: usize) -> Kernel {
    // SAFETY: the page has put a function of this signature there; calls compare the signature again.
    unsafe { std::mem::transmute::<*const (), Kernel>(place as *const ()) }
}

/// Codes whose functions are in the table.
struct Linked {
    kernels: Vec<(Option<Kernel>, Lengths)>,
    first: usize,
    count: usize,
    interpreted: Arc<dyn Machine<f64>>,
}

impl Machine<f64> for Linked {
    fn run(&self, code: usize, frame: &Frame<'_, f64>, targets: Targets<'_, f64>) {
        let (Some(kernel), lengths) = &self.kernels[code] else {
            return self.interpreted.run(code, frame, targets);
        };
        lengths.check(frame, &targets);
        let [vector, matrix] = targets;
        let table = frame.slices().map(<[f64]>::as_ptr);
        // SAFETY: every slice is as long as the code needs, and what is written is borrowed for writing.
        unsafe { kernel(table.as_ptr(), vector.as_mut_ptr(), matrix.as_mut_ptr()) }
    }
}

impl Drop for Linked {
    fn drop(&mut self) {
        unlink(self.first, self.count);
    }
}
