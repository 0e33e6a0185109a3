//! The sections of a module.

use crate::body;
use crate::host::Host;
use lie_dynamic::Code;
use wasm_encoder as wasm;
use wasm_encoder::{EntityType, ExportKind, ValType};

/// The module that imports are from.
pub const NAMESPACE: &str = "lie";
/// The memory that is imported.
pub const MEMORY: &str = "memory";
/// Codes with more registers than this are left out: hosts limit the locals of a function.
pub const LONGEST: u32 = 20_000;

/// A module of WebAssembly.
#[derive(Clone, Debug)]
pub struct Module {
    /// Its bytes.
    pub bytes: Vec<u8>,
    /// The functions it imports from [`NAMESPACE`], in their order.
    pub imports: Vec<Import>,
    /// Of each code, whether it is in the module; those with more than [`LONGEST`] registers are not.
    pub compiled: Vec<bool>,
}

/// A function that a module imports.
#[derive(Clone, Copy, Debug)]
pub struct Import {
    /// Its name.
    pub name: &'static str,
    /// What the host gives for it.
    pub host: Host,
}

/// The name of the function of a code, by the code's position.
pub fn export_name(position: usize) -> String {
    position.to_string()
}

/// The functions that a module imports, in the order of their first calls.
#[derive(Default)]
pub(crate) struct Imports(Vec<Import>);

impl Imports {
    /// The index of a function, which is imported if it is not yet.
    pub fn index(&mut self, name: &'static str) -> u32 {
        let known = self.0.iter().position(|import| import.name == name);
        let position = known.unwrap_or_else(|| {
            let Some(host) = Host::named(name) else {
                unreachable!("`{name}` is not a function of codes");
            };
            self.0.push(Import { name, host });
            self.0.len() - 1
        });
        position as u32
    }
}

/// The types of functions, in the order of their section.
#[derive(Clone, Copy)]
enum Type {
    Kernel,
    Unary,
    Binary,
    Family,
}

fn type_of(host: Host) -> Type {
    match host {
        Host::Unary(_) => Type::Unary,
        Host::Binary(_) => Type::Binary,
        Host::Family(_) => Type::Family,
    }
}

fn types() -> wasm::TypeSection {
    const ADDRESS: ValType = ValType::I32;
    const NUMBER: ValType = ValType::F64;
    let mut types = wasm::TypeSection::new();
    types.ty().function([ADDRESS; 3], []);
    types.ty().function([NUMBER], [NUMBER]);
    types.ty().function([NUMBER; 2], [NUMBER]);
    types
        .ty()
        .function([ValType::I32, ValType::I32, NUMBER], [NUMBER]);
    types
}

fn imported(imports: &[Import]) -> wasm::ImportSection {
    let mut section = wasm::ImportSection::new();
    let memory = wasm::MemoryType {
        minimum: 0,
        maximum: None,
        memory64: false,
        shared: false,
        page_size_log2: None,
    };
    section.import(NAMESPACE, MEMORY, memory);
    for import in imports {
        let entity = EntityType::Function(type_of(import.host) as u32);
        section.import(NAMESPACE, import.name, entity);
    }
    section
}

/// The module of codes.
pub fn module(codes: &[Code]) -> Module {
    let codes: Vec<_> = codes.iter().map(Code::expanded).collect();
    let compiled: Vec<bool> = codes.iter().map(|code| code.registers <= LONGEST).collect();
    let mut imports = Imports::default();
    let mut bodies = wasm::CodeSection::new();
    let mut functions = wasm::FunctionSection::new();
    let mut names = Vec::new();
    let short = compiled.iter().zip(&codes).enumerate();
    for (position, (_, code)) in short.filter(|(_, (compiled, _))| **compiled) {
        bodies.function(&body::function(code, &mut imports));
        functions.function(Type::Kernel as u32);
        names.push(export_name(position));
    }
    // functions are numbered after those that are imported
    let mut exports = wasm::ExportSection::new();
    for (index, name) in (imports.0.len() as u32..).zip(&names) {
        exports.export(name, ExportKind::Func, index);
    }
    let mut module = wasm::Module::new();
    module
        .section(&types())
        .section(&imported(&imports.0))
        .section(&functions)
        .section(&exports)
        .section(&bodies);
    Module {
        bytes: module.finish(),
        imports: imports.0,
        compiled,
    }
}
