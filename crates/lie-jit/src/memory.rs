//! What machine code is in, and what it is called with.

#[cfg(all(unix, target_arch = "x86_64"))]
use crate::assembler::Pages;
use crate::columns;
use crate::compile::Compiler;
use cranelift_jit::JITModule;
use cranelift_module::FuncId;
use std::mem::ManuallyDrop;

/// A compiled code: reads from a table of the slices in a frame, writes to two places.
pub type Function = unsafe extern "C" fn(*const *const f64, *mut f64, *mut f64);

/// A compiled code that is repeated: reads from a table of the slices in a frame, of which one takes turns with the vector, so many times.
pub type Repeated = unsafe extern "C" fn(*mut *const f64, *mut f64, *mut f64, usize);

/// The memory of compiled functions.
pub enum Memory {
    /// That of Cranelift.
    Module(Box<ManuallyDrop<JITModule>>),
    /// That of the assembler.
    #[cfg(all(unix, target_arch = "x86_64"))]
    Own(Pages),
}

// SAFETY: functions read nothing but their arguments, and the memory they are in is not changed once they are complete.
unsafe impl Send for Memory {}
// SAFETY: as above.
unsafe impl Sync for Memory {}

impl Drop for Memory {
    fn drop(&mut self) {
        match self {
            // SAFETY: the module is taken once, here; its functions are called only by the machines that own the memory.
            Self::Module(module) => unsafe { ManuallyDrop::take(module.as_mut()).free_memory() },
            #[cfg(all(unix, target_arch = "x86_64"))]
            Self::Own(_) => {}
        }
    }
}

/// A function of a memory.
#[derive(Clone, Copy)]
pub enum Place {
    /// Of a module.
    Id(FuncId),
    /// So many bytes behind the beginning.
    #[cfg(all(unix, target_arch = "x86_64"))]
    Offset(usize),
}

impl Memory {
    /// That of a module.
    pub fn of_module(compiler: Compiler) -> Option<Self> {
        let module = ManuallyDrop::new(compiler.finish()?);
        Some(Self::Module(Box::new(module)))
    }

    /// # Panics
    /// The place is one of another memory.
    fn pointer(&self, place: Place) -> *const u8 {
        match (self, place) {
            (Self::Module(module), Place::Id(id)) => module.get_finalized_function(id),
            #[cfg(all(unix, target_arch = "x86_64"))]
            (Self::Own(pages), Place::Offset(offset)) => pages.at(offset),
            #[cfg(all(unix, target_arch = "x86_64"))]
            _ => panic!("a function is in the memory that it was made in"),
        }
    }

    /// A function.
    pub fn function(&self, place: Place) -> Function {
        let pointer = self.pointer(place);
        // SAFETY: the pointer is that of a function which was compiled with this signature.
        unsafe { std::mem::transmute::<*const u8, Function>(pointer) }
    }

    /// A function that is repeated.
    pub fn repeated(&self, place: Place) -> Repeated {
        let pointer = self.pointer(place);
        // SAFETY: as above.
        unsafe { std::mem::transmute::<*const u8, Repeated>(pointer) }
    }

    /// A function over columns.
    pub fn over_columns(&self, place: Place) -> columns::Function {
        let pointer = self.pointer(place);
        // SAFETY: as above.
        unsafe { std::mem::transmute::<*const u8, columns::Function>(pointer) }
    }
}
