//! What compiled code calls: the elementary functions of the numeric core.

use lie_codegen::symbolic::Function;
use lie_runtime::Scalar;

macro_rules! unary {
    ($($name:ident)+) => {
        $(extern "C" fn $name(x: f64) -> f64 { Scalar::$name(x) })+
        fn unary() -> Vec<(String, *const u8)> {
            vec![$((name(stringify!($name)), $name as *const u8)),+]
        }
    };
}
unary!(exp log sin cos tan asin acos atan sinh cosh tanh cbrt log1p expm1 asinh acosh atanh);

extern "C" fn atan2(y: f64, x: f64) -> f64 {
    Scalar::atan2(y, x)
}
extern "C" fn powf(x: f64, exponent: f64) -> f64 {
    Scalar::powf(x, exponent)
}
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

/// The symbol of a function of one number.
pub fn symbol(function: Function) -> String {
    name(function.name())
}

/// All symbols with their addresses.
pub fn symbols() -> Vec<(String, *const u8)> {
    let mut all = unary();
    all.extend([
        (name("atan2"), atan2 as *const u8),
        (name("powf"), powf as *const u8),
        (name("stumpff"), stumpff as *const u8),
        (name("phi"), phi as *const u8),
    ]);
    all
}
