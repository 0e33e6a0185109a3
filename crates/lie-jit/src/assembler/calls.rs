//! What machine code for lanes calls: elementary functions, lane by lane.

use lie_dynamic::{Binary, Unary};

/// The numbers that compiled code shares with a function.
///
/// # Safety
/// The frame has so many of them.
unsafe fn shared<'a>(numbers: *mut f64, count: usize) -> &'a mut [f64] {
    // SAFETY: as above; compiled code does nothing while the function works
    unsafe { std::slice::from_raw_parts_mut(numbers, count) }
}

/// A function of one number, of each lane.
///
/// # Safety
/// `numbers` are those that compiled code shares: of each lane one.
pub unsafe extern "sysv64" fn unary(f: Unary, lanes: usize, numbers: *mut f64) {
    // SAFETY: as above
    for x in unsafe { shared(numbers, lanes) } {
        *x = f(*x);
    }
}

/// A function of one number, of the lanes whose test is not 0 or above; what it usually is stays in the others.
///
/// # Safety
/// The same with three of each lane: the numbers, the tests, and what it usually is.
pub unsafe extern "sysv64" fn rare(f: Unary, lanes: usize, numbers: *mut f64) {
    // SAFETY: as above
    let (numbers, others) = unsafe { shared(numbers, 3 * lanes) }.split_at_mut(lanes);
    let (tests, usual) = others.split_at(lanes);
    for ((x, test), usual) in numbers.iter_mut().zip(tests).zip(usual) {
        *x = if *test >= 0.0 { *usual } else { f(*x) };
    }
}

/// A function of two numbers, of each lane.
///
/// # Safety
/// The same with two of each lane.
pub unsafe extern "sysv64" fn binary(f: Binary, lanes: usize, numbers: *mut f64) {
    // SAFETY: as above
    let (left, right) = unsafe { shared(numbers, 2 * lanes) }.split_at_mut(lanes);
    for (x, y) in left.iter_mut().zip(right) {
        *x = f(*x, *y);
    }
}

/// Functions of a family, of each lane: index after index.
fn family<const MOST: usize>(
    of: fn(u8, f64) -> [f64; MOST],
    count: u8,
    lanes: usize,
    numbers: &mut [f64],
) {
    for lane in 0..lanes {
        let all = of(count, numbers[lane]);
        for (index, value) in all.iter().take(usize::from(count)).enumerate() {
            numbers[index * lanes + lane] = *value;
        }
    }
}

/// # Safety
/// The same with `count` of each lane.
pub unsafe extern "sysv64" fn stumpff(count: u64, lanes: usize, numbers: *mut f64) {
    // SAFETY: as above
    let numbers = unsafe { shared(numbers, count as usize * lanes) };
    family(lie_dynamic::stumpff, count as u8, lanes, numbers);
}

/// # Safety
/// The same with `count` of each lane.
pub unsafe extern "sysv64" fn phi(count: u64, lanes: usize, numbers: *mut f64) {
    // SAFETY: as above
    let numbers = unsafe { shared(numbers, count as usize * lanes) };
    family(lie_dynamic::phi, count as u8, lanes, numbers);
}
