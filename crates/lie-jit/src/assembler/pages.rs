//! Memory for machine code: first written, then executed, never both at once; given back when it is dropped.

use rustix::mm::{MapFlags, MprotectFlags, ProtFlags, mmap_anonymous, mprotect, munmap};
use std::ptr::NonNull;

/// Pages that hold machine code.
pub struct Pages {
    start: NonNull<u8>,
    length: usize,
}

// SAFETY: the pages are not written any more, and are mapped until they are dropped.
unsafe impl Send for Pages {}
// SAFETY: as above.
unsafe impl Sync for Pages {}

impl Pages {
    /// Pages with these bytes, at least one; none where the system refuses them.
    pub fn new(bytes: &[u8]) -> Option<Self> {
        let length = bytes.len();
        let writable = ProtFlags::READ | ProtFlags::WRITE;
        // SAFETY: these are new pages, which nothing else knows.
        let start =
            unsafe { mmap_anonymous(std::ptr::null_mut(), length, writable, MapFlags::PRIVATE) };
        let start = NonNull::new(start.ok()?.cast::<u8>())?;
        // what follows gives them back, whether it succeeds or not
        let pages = Self { start, length };
        // SAFETY: so many bytes were mapped for writing just now.
        unsafe { std::ptr::copy_nonoverlapping(bytes.as_ptr(), start.as_ptr(), length) };
        let executable = MprotectFlags::READ | MprotectFlags::EXEC;
        // SAFETY: nothing refers to what is in these pages.
        unsafe { mprotect(start.as_ptr().cast(), length, executable) }.ok()?;
        Some(pages)
    }

    /// The address of a byte.
    pub fn at(&self, offset: usize) -> *const u8 {
        assert!(offset < self.length, "a function is in its pages");
        self.start.as_ptr().wrapping_add(offset)
    }
}

impl Drop for Pages {
    fn drop(&mut self) {
        // SAFETY: they are given back once, here; functions in them are called only by what owns them.
        let given_back = unsafe { munmap(self.start.as_ptr().cast(), self.length) };
        debug_assert!(given_back.is_ok(), "{given_back:?}");
    }
}
