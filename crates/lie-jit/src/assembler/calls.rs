//! Calls of elementary functions: how machine code makes them, and what it calls for lanes, lane by lane.

use super::encoding::{General, Memory, Read};
use super::function::{ARGUMENTS, FIRST, Writer};
use super::operation::{Called, Operation, Place, Vector, Width};
use lie_dynamic::{Binary, Unary};

impl Writer<'_> {
    /// Calls a function with what is shared, which is where the frame begins.
    pub fn call(&mut self, place: usize, called: Called) {
        match (self.layout.width, called) {
            (Width::One, Called::Unary(f)) => {
                // what is stored before a call is in its register still
                let before = self.program.operations[..place].iter().rev();
                let mut stores = before.map_while(|operation| match *operation {
                    Operation::Store { from, to } => Some((from, to)),
                    _ => None,
                });
                let argument = stores.find(|(_, to)| *to == Place::Shared(0));
                match argument {
                    Some((FIRST, _)) => {}
                    Some((from, _)) => self.bytes.copy(FIRST, from),
                    None => self.load_shared(FIRST, 0),
                }
                self.call_of_numbers(f as *const () as u64);
            }
            (Width::One, Called::Binary(f)) => {
                self.load_shared(FIRST, 0);
                self.load_shared(Vector(1), 1);
                self.call_of_numbers(f as *const () as u64);
            }
            _ => self.call_of_lanes(called),
        }
        self.load_arguments();
    }

    /// What a function that is called does not leave as it was.
    pub fn load_arguments(&mut self) {
        for (place, argument) in (0..).zip(ARGUMENTS) {
            let from = self.word(place);
            self.bytes.load_word(argument, from);
        }
        self.load_bases();
    }

    fn load_shared(&mut self, to: Vector, place: i32) {
        let from = Memory::At(General::Rsp, 8 * place);
        self.bytes.load(Width::One, to, Read::Whole(from));
    }

    /// A function of the numbers in the first registers, whose result is in the first one and is shared.
    pub fn call_of_numbers(&mut self, function: u64) {
        self.bytes.word_constant(General::Rax, function);
        self.bytes.call(General::Rax);
        let shared = Memory::At(General::Rsp, 0);
        self.bytes.store(Width::One, shared, FIRST);
    }

    /// A function of each lane.
    fn call_of_lanes(&mut self, called: Called) {
        let (helper, argument) = match called {
            Called::Unary(f) => (unary as *const () as u64, f as *const () as u64),
            Called::Binary(f) => (binary as *const () as u64, f as *const () as u64),
            Called::Stumpff(count) => (stumpff as *const () as u64, u64::from(count)),
            Called::Phi(count) => (phi as *const () as u64, u64::from(count)),
        };
        self.call_helper(helper, argument);
    }

    /// One of ours, with its first argument, the number of lanes and what is shared.
    pub fn call_helper(&mut self, helper: u64, argument: u64) {
        let bytes = &mut self.bytes;
        bytes.clear_upper_halves();
        bytes.word_constant(General::Rdi, argument);
        bytes.word_constant(General::Rsi, self.layout.width.lanes() as u64);
        bytes.copy_word(General::Rdx, General::Rsp);
        bytes.word_constant(General::Rax, helper);
        bytes.call(General::Rax);
    }
}

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
