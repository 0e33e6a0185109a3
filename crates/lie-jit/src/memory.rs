//! What machine code is called with.

use crate::columns;
pub use crate::make::{Memory, Place};

/// A compiled code: reads from a table of the slices in a frame, writes to two places.
pub type Function = unsafe extern "C" fn(*const *const f64, *mut f64, *mut f64);

/// A compiled code that is repeated: reads from a table of the slices in a frame, of which one takes turns with the vector, so many times.
pub type Repeated = unsafe extern "C" fn(*mut *const f64, *mut f64, *mut f64, usize);

impl Memory {
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
