//! The modules of `lie-wasm` run by wasmi, as an engine for systems made at run time.

use lie_dynamic::{Code, Engine, Frame, Interpreted, Lengths, Machine, Targets};
use lie_wasm::{Host, MEMORY, NAMESPACE, export_name};
use std::sync::{Arc, Mutex};
use wasmi::{Linker, Memory, MemoryType, Module, Store, TypedFunc};

/// WebAssembly by wasmi.
pub struct Wasmi;

impl Engine for Wasmi {
    fn name(&self) -> &'static str {
        "webassembly"
    }

    fn machine(&self, codes: &Arc<[Code]>) -> Arc<dyn Machine<f64>> {
        Arc::new(Instance::new(codes))
    }
}

type Kernel = TypedFunc<(i32, i32, i32), ()>;

/// An instance of a module.
struct Instance {
    kernels: Vec<Option<Kernel>>,
    lengths: Vec<Lengths>,
    interpreted: Arc<dyn Machine<f64>>,
    memory: Memory,
    store: Mutex<Store<()>>,
}

impl Instance {
    fn new(codes: &Arc<[Code]>) -> Self {
        let module = lie_wasm::module(codes);
        let engine = wasmi::Engine::default();
        let mut store = Store::new(&engine, ());
        let mut linker = Linker::new(&engine);
        let memory = Memory::new(&mut store, MemoryType::new(1, None)).unwrap();
        linker.define(NAMESPACE, MEMORY, memory).unwrap();
        for import in &module.imports {
            let name = import.name;
            let linked = match import.host {
                Host::Unary(f) => linker.func_wrap(NAMESPACE, name, move |x: f64| f(x)),
                Host::Binary(f) => linker.func_wrap(NAMESPACE, name, move |x: f64, y: f64| f(x, y)),
                Host::Family(f) => {
                    linker.func_wrap(NAMESPACE, name, move |n: u32, k: u32, x: f64| f(n, k, x))
                }
            };
            linked.unwrap();
        }
        // this validates the bytes as well
        let bytes = Module::new(&engine, &module.bytes).unwrap();
        let instance = linker.instantiate_and_start(&mut store, &bytes).unwrap();
        let kernels = (0..).zip(&module.compiled).map(|(position, compiled)| {
            let name = export_name(position);
            compiled.then(|| instance.get_typed_func(&store, &name).unwrap())
        });
        Self {
            kernels: kernels.collect(),
            lengths: codes.iter().map(Lengths::new).collect(),
            interpreted: Interpreted.machine(codes),
            memory,
            store: Mutex::new(store),
        }
    }
}

/// The table of a frame at address 0, its slices and the targets behind it; with the addresses of the targets.
fn laid_out(frame: &Frame<'_, f64>, targets: &Targets<'_, f64>) -> (Vec<u8>, [usize; 2]) {
    let slices = frame.slices();
    let mut table = Vec::new();
    let mut numbers = Vec::new();
    let begin = slices.len() * 8;
    let mut add = |slice: &[f64]| {
        let address = begin + numbers.len();
        for number in slice {
            numbers.extend_from_slice(&number.to_le_bytes());
        }
        address
    };
    for slice in slices {
        table.extend((add(slice) as u32).to_le_bytes());
    }
    let places = [add(targets[0]), add(targets[1])];
    table.resize(begin, 0);
    table.append(&mut numbers);
    (table, places)
}

impl Machine<f64> for Instance {
    fn run(&self, code: usize, frame: &Frame<'_, f64>, mut targets: Targets<'_, f64>) {
        let Some(kernel) = self.kernels[code] else {
            return self.interpreted.run(code, frame, targets);
        };
        self.lengths[code].check(frame, &targets);
        let (bytes, places) = laid_out(frame, &targets);
        let mut guard = self.store.lock().unwrap();
        let store = &mut *guard;
        let missing = bytes.len().saturating_sub(self.memory.data_size(&*store));
        self.memory
            .grow(&mut *store, missing.div_ceil(1 << 16) as u64)
            .unwrap();
        self.memory.write(&mut *store, 0, &bytes).unwrap();
        let [vector, matrix] = places.map(|place| place as i32);
        kernel.call(&mut *store, (0, vector, matrix)).unwrap();
        for (target, place) in targets.iter_mut().zip(places) {
            let written = &self.memory.data(&*store)[place..place + 8 * target.len()];
            let (numbers, _) = written.as_chunks();
            for (number, bytes) in target.iter_mut().zip(numbers) {
                *number = f64::from_le_bytes(*bytes);
            }
        }
    }
}
