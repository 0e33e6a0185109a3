//! What machine code does, one operation after the other, over registers that exist and places in memory.

use super::chain::End;
use lie_dynamic::{Binary, Bitwise, Instruction, Register, Unary};
use lie_runtime::Elementary;

/// How wide the registers are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Width {
    /// Eight numbers, AVX-512.
    Eight,
    /// Four numbers, AVX2.
    Four,
    /// One number, AVX2.
    One,
}

impl Width {
    /// Numbers in a register.
    pub const fn lanes(self) -> usize {
        match self {
            Self::Eight => 8,
            Self::Four => 4,
            Self::One => 1,
        }
    }

    /// Bytes of a register as it stands in memory.
    pub const fn bytes(self) -> u32 {
        8 * self.lanes() as u32
    }

    /// How many registers there are.
    pub const fn registers(self) -> u8 {
        match self {
            Self::Eight => 32,
            Self::Four | Self::One => 16,
        }
    }

    /// How often a constant is written: AVX-512 reads one number into all lanes, AVX2 reads a register, and signs of one number
    /// change in two.
    pub const fn copies_of_constants(self) -> usize {
        match self {
            Self::Eight => 1,
            Self::Four => 4,
            Self::One => 2,
        }
    }
}

/// Where the numbers of a code are.
#[derive(Clone, Copy, Debug)]
pub struct Layout {
    pub width: Width,
    /// Bytes from an entry of a slice to the next.
    pub stride: u32,
    /// Of columns the first argument and the vector are a table of columns, which the code is done along.
    pub columns: Option<Columns>,
    /// The slice that takes turns with the vector, where the code is done again and again.
    pub turns: Option<u8>,
    /// How it ends where it is a part of a step.
    pub part: Option<PartOf>,
}

/// How a part of a step ends.
#[derive(Clone, Copy, Debug)]
pub struct PartOf {
    /// What comes after it.
    pub end: End,
    /// How many numbers an answer has, one behind the other.
    pub lanes: usize,
}

/// How columns are gone along.
#[derive(Clone, Copy, Debug)]
pub struct Columns {
    /// Bytes from what is done at a time to the next.
    pub step: u32,
    /// Whether entries of slices are single numbers, which all lanes have.
    pub single: bool,
}

impl Layout {
    /// One number.
    pub const NUMBER: Self = Self {
        width: Width::One,
        stride: 8,
        columns: None,
        turns: None,
        part: None,
    };

    /// Neighbours of so many lanes.
    pub const fn lanes(width: Width, lanes: usize) -> Self {
        Self {
            width,
            stride: 8 * lanes as u32,
            columns: None,
            turns: None,
            part: None,
        }
    }

    /// The same as a part of a step, whose answers have so many lanes.
    pub const fn part(self, lanes: usize, end: End) -> Self {
        Self {
            part: Some(PartOf { end, lanes }),
            ..self
        }
    }

    /// The same, done again and again, each time from what the time before gave in place of a slice.
    pub const fn repeated(self, slice: u8) -> Self {
        Self {
            turns: Some(slice),
            ..self
        }
    }

    /// Columns of numbers: neighbours at a time.
    pub const fn columns_of_numbers(width: Width) -> Self {
        Self {
            width,
            stride: 8,
            columns: Some(Columns {
                step: width.bytes(),
                single: true,
            }),
            turns: None,
            part: None,
        }
    }

    /// Columns of so many lanes, of which neighbours are done.
    pub const fn columns_of_lanes(width: Width, lanes: usize) -> Self {
        Self {
            columns: Some(Columns {
                step: 8 * lanes as u32,
                single: false,
            }),
            ..Self::lanes(width, lanes)
        }
    }

    /// Whether the code is done more than once in a call.
    pub fn has_loop(&self) -> bool {
        self.columns.is_some() || self.turns.is_some()
    }

    /// Whether a place has one number, which a load puts into all lanes.
    pub fn is_single(&self, place: Place) -> bool {
        match place {
            Place::Slice { slice, .. } => {
                slice > 0 && self.columns.is_some_and(|columns| columns.single)
            }
            Place::Constant(_) => self.width == Width::Eight,
            _ => false,
        }
    }

    /// Whether arithmetic takes an operand from a place.
    pub fn is_operand(&self, place: Place) -> bool {
        self.width == Width::Eight || !self.is_single(place)
    }

    /// The same of some arithmetic: with bits of one number two numbers are read, which constants alone have.
    pub fn is_operand_of(&self, what: Arithmetic, place: Place) -> bool {
        let has_two = self.width != Width::One || matches!(place, Place::Constant(_));
        self.is_operand(place) && (has_two || !what.is_of_bits())
    }
}

/// A register of the processor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Vector(pub u8);

/// A place in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// An entry of a slice that is read.
    Slice { slice: u8, entry: u32 },
    /// An entry of the vector, or of the matrix.
    Target { target: u8, entry: u32 },
    /// A place of the frame.
    Slot(u32),
    /// A constant.
    Constant(u32),
    /// A place of the frame by which functions are given arguments and give results.
    Shared(u32),
}

/// An operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operand {
    Vector(Vector),
    Place(Place),
}

/// What is done with two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arithmetic {
    Add,
    Sub,
    Mul,
    Div,
    /// Exclusive or of all bits: with the constant -0 the sign changes.
    Xor,
    /// The bits that both have.
    And,
    /// The bits that one has.
    Or,
    /// The sum of both words.
    Plus,
}

impl Arithmetic {
    /// Whether it is done with bits, of which a register of one number has those of two.
    pub const fn is_of_bits(self) -> bool {
        matches!(self, Self::Xor | Self::And | Self::Or | Self::Plus)
    }

    /// What is done with bits.
    pub const fn of_bits(what: Bitwise) -> Self {
        match what {
            Bitwise::And => Self::And,
            Bitwise::Or => Self::Or,
            Bitwise::Xor => Self::Xor,
            Bitwise::Plus => Self::Plus,
        }
    }
}

/// All bits but that of the sign.
pub const WITHOUT_SIGN: u64 = u64::MAX >> 1;

/// A function that is called lane by lane.
#[derive(Clone, Copy, Debug)]
pub enum Called {
    Unary(Unary),
    Binary(Binary),
    /// All functions of a family below an index.
    Stumpff(u8),
    Phi(u8),
}

impl Called {
    /// Numbers that it is given, and that it gives.
    pub fn counts(&self) -> [u32; 2] {
        match self {
            Self::Unary(_) => [1, 1],
            Self::Binary(_) => [2, 1],
            Self::Stumpff(count) | Self::Phi(count) => [1, u32::from(*count)],
        }
    }
}

/// What is done. What computes says which register of the code it gives.
#[derive(Clone, Copy, Debug)]
pub enum Operation {
    Load {
        to: Vector,
        from: Place,
    },
    Store {
        from: Vector,
        to: Place,
    },
    Arithmetic {
        result: Register,
        what: Arithmetic,
        to: Vector,
        left: Vector,
        right: Operand,
    },
    Sqrt {
        result: Register,
        to: Vector,
        of: Vector,
    },
    /// The number of a place, which is 1, where `left` is less than `right`, or equal too; 0 elsewhere. The register that it gives is
    /// none of its operands.
    Compare {
        result: Register,
        equal: bool,
        to: Vector,
        left: Vector,
        right: Vector,
        one: Place,
    },
    /// The larger one, as [`Instruction::Larger`] says. The register that it gives is none of its operands.
    Larger {
        result: Register,
        to: Vector,
        left: Vector,
        right: Vector,
    },
    /// The numbers of a register whose places differ by xor with a distance, each in the place of the other.
    Exchange {
        result: Register,
        distance: u8,
        to: Vector,
        of: Vector,
    },
    /// The bits so many places to the left, or to the right where that is negative.
    Shift {
        result: Register,
        to: Vector,
        of: Vector,
        places: i8,
    },
    /// `then` where `test` is below the number of a place, which is 0, `otherwise` elsewhere. The register that it gives is none
    /// of its operands. Of one number it may be a jump.
    Below {
        result: Register,
        jumps: bool,
        to: Vector,
        test: Vector,
        zero: Place,
        then: Vector,
        otherwise: Vector,
    },
    /// `value` becomes the function of `x` where `test` is not at or above the number of a place, which is 0. Of registers those
    /// of `kept` are kept, by their bits.
    Rare {
        result: Register,
        value: Vector,
        test: Vector,
        zero: Place,
        x: Vector,
        scratch: Vector,
        function: Unary,
        kept: u32,
    },
    /// Calls a function with what is shared, which has its results from `result` on; registers are lost.
    Call {
        result: Register,
        called: Called,
    },
}

/// A code over registers that exist.
#[derive(Clone, Debug, Default)]
pub struct Program {
    pub operations: Vec<Operation>,
    /// The bits of constants.
    pub constants: Vec<u64>,
    /// Places of the frame.
    pub slots: u32,
    /// Places that functions share.
    pub shared: u32,
    /// Places for registers that are kept where a function is seldom called.
    pub kept: u32,
}

/// An elementary function as it is called.
pub fn unary(function: Elementary) -> Option<Unary> {
    let mut all = lie_dynamic::UNARY.iter();
    let found = all.find(|(known, _)| *known == function.name());
    found.map(|(_, f)| *f)
}

/// The function that an instruction calls, if it does.
pub fn called(instruction: &Instruction) -> Option<Called> {
    let binary = |name: &str| {
        let mut all = lie_dynamic::BINARY.iter();
        all.find(|(known, _)| *known == name).map(|(_, f)| *f)
    };
    match instruction {
        Instruction::Call(function, _) => unary(*function).map(Called::Unary),
        Instruction::Power(..) => binary("powf").map(Called::Binary),
        Instruction::Atan2(..) => binary("atan2").map(Called::Binary),
        Instruction::Stumpff(count, _) => Some(Called::Stumpff(*count)),
        Instruction::Phi(count, _) => Some(Called::Phi(*count)),
        _ => None,
    }
}
