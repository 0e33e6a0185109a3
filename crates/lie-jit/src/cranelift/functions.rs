//! What compiled code calls: the elementary functions of the numeric core.

use lie_dynamic::{BINARY, UNARY};

/// Writes all Stumpff functions below an index.
///
/// SAFETY: compiled code gives a place for so many numbers.
unsafe extern "C" fn stumpff(count: u64, x: f64, out: *mut f64) {
    let all = lie_dynamic::stumpff(count as u8, x);
    // SAFETY: as above, and the array has at least `count` entries
    unsafe { std::ptr::copy_nonoverlapping(all.as_ptr(), out, count as usize) }
}
/// The same of the functions `phi_k`.
///
/// SAFETY: compiled code gives a place for so many numbers.
unsafe extern "C" fn phi(count: u64, x: f64, out: *mut f64) {
    let all = lie_dynamic::phi(count as u8, x);
    // SAFETY: as above, and the array has at least `count` entries
    unsafe { std::ptr::copy_nonoverlapping(all.as_ptr(), out, count as usize) }
}

/// The symbol of a function in compiled code.
pub fn name(function: &str) -> String {
    format!("lie_{function}")
}

/// All symbols with their addresses.
pub fn symbols() -> Vec<(String, *const u8)> {
    let unary = UNARY.iter().map(|(of, f)| (name(of), *f as *const u8));
    let binary = BINARY.iter().map(|(of, f)| (name(of), *f as *const u8));
    let families = [
        (name("stumpff"), stumpff as *const u8),
        (name("phi"), phi as *const u8),
    ];
    unary.chain(binary).chain(families).collect()
}
