//! A program as a function: where its slices are, its frame, its loop along columns, the functions that it calls.

mod body;
mod part;

use super::asides::Aside;
use super::encoding::{Bytes, General, Memory};
use super::operation::{Columns, Layout, Operand, Operation, Place, Program, Vector};
use lie_dynamic::OF_STEP;
use part::BASES_OF_A_PART;

/// Larger frames are not made.
const LARGEST_FRAME: u32 = 1 << 18;
/// Bytes of a page of the stack.
const PAGE: u32 = 4096;

/// Arguments of a function: the table of slices; the vector and the matrix, or of columns the tables of those that are read and
/// written; of columns how many bytes each has, of a code that is repeated how often, of a part of a step its record.
pub(super) const ARGUMENTS: [General; 4] = [General::Rdi, General::Rsi, General::Rdx, General::Rcx];
const TABLE: General = ARGUMENTS[0];
/// Where slices begin. The last one may have that of the table.
const BASES: [General; 7] = [
    General::Rax,
    General::Rcx,
    General::R8,
    General::R9,
    General::R10,
    General::R11,
    TABLE,
];
/// The same where registers of the caller are [kept](KEPT), as in a loop.
const BASES_BESIDE: [General; 7] = [
    General::R8,
    General::R9,
    General::R10,
    General::R11,
    General::R12,
    General::R13,
    General::R14,
];
/// Where functions of numbers have their argument and their result.
pub(super) const FIRST: Vector = Vector(0);
/// How far along columns, or how often a code was done.
const ALONG: General = General::Rbx;
/// Where a column begins.
const COLUMN: General = General::Rax;
/// What a function that uses more than the others gives back as it was.
const KEPT: [General; 4] = [General::Rbx, General::R12, General::R13, General::R14];

pub struct Writer<'a> {
    pub(super) bytes: Bytes,
    pub(super) program: &'a Program,
    pub(super) layout: Layout,
    /// The slices that are read, each with the register of its beginning.
    bases: Vec<(u8, General)>,
    calls: bool,
    /// Whether registers of the caller are used, and kept.
    keeps: bool,
    /// Bytes of the frame.
    frame: u32,
    /// What is seldom done, behind the end.
    pub(super) asides: Vec<Aside>,
}

/// The bytes of a function with its constants; none where it has more slices or a larger frame than registers and stack are for.
pub fn function(program: &Program, layout: Layout) -> Option<Vec<u8>> {
    let mut writer = Writer::new(program, layout)?;
    if let Some(part) = layout.part {
        writer.begin_part(part)?;
    }
    writer.begin();
    match (layout.columns, layout.turns) {
        (None, None) => writer.body()?,
        (None, Some(slice)) => writer.in_turns(slice)?,
        (Some(columns), _) => writer.along(columns)?,
    }
    match layout.part {
        Some(part) => writer.end_part(part),
        None => writer.end(),
    }
    writer.asides()?;
    writer.with_constants()
}

impl<'a> Writer<'a> {
    fn new(program: &'a Program, layout: Layout) -> Option<Self> {
        let mut slices = Vec::new();
        let mut read = |place: Place| match place {
            Place::Slice { slice: 0, .. } if layout.columns.is_some() => {}
            Place::Slice { slice, .. } if !slices.contains(&slice) => slices.push(slice),
            _ => {}
        };
        for operation in &program.operations {
            match operation {
                Operation::Load { from, .. } => read(*from),
                Operation::Arithmetic {
                    right: Operand::Place(place),
                    ..
                } => read(*place),
                _ => {}
            }
        }
        let mut operations = program.operations.iter();
        let calls = operations
            .any(|operation| matches!(operation, Operation::Call { .. } | Operation::Rare { .. }));
        let few = match layout.part {
            None => &BASES[..],
            Some(_) => &BASES_OF_A_PART[..],
        };
        let keeps = layout.has_loop() || slices.len() > few.len();
        let pool = if keeps { &BASES_BESIDE[..] } else { few };
        if slices.len() > pool.len() {
            return None;
        }
        let words = if calls { 8 * ARGUMENTS.len() as u32 } else { 0 };
        let places = program.shared.checked_add(program.slots)?;
        let places = places.checked_add(program.kept)?;
        let frame = places
            .checked_mul(layout.width.bytes())?
            .checked_add(words)?;
        let frame = frame.next_multiple_of(64);
        (frame <= LARGEST_FRAME).then_some(Self {
            bytes: Bytes::default(),
            bases: slices.into_iter().zip(pool.iter().copied()).collect(),
            program,
            layout,
            calls,
            keeps,
            frame,
            asides: Vec::new(),
        })
    }

    fn has_frame(&self) -> bool {
        self.frame > 0 || self.keeps
    }

    fn begin(&mut self) {
        if !self.has_frame() {
            self.load_bases();
            return;
        }
        let bytes = &mut self.bytes;
        bytes.push(General::Rbp);
        bytes.copy_word(General::Rbp, General::Rsp);
        if self.keeps {
            KEPT.into_iter().for_each(|register| bytes.push(register));
        }
        bytes.align(General::Rsp);
        let mut left = self.frame;
        while left > 0 {
            let part = left.min(PAGE);
            bytes.subtract(General::Rsp, part);
            // none of the pages that end a stack is passed over
            if self.frame > PAGE / 2 {
                bytes.touch(General::Rsp);
            }
            left -= part;
        }
        if self.calls {
            for (place, argument) in (0..).zip(ARGUMENTS) {
                let to = self.word(place);
                self.bytes.store_word(to, argument);
            }
        }
        self.load_bases();
    }

    /// Where arguments are kept over calls.
    pub(super) fn word(&self, place: u32) -> Memory {
        let places = self.program.shared + self.program.slots + self.program.kept;
        let offset = places * self.layout.width.bytes() + 8 * place;
        Memory::At(General::Rsp, offset as i32)
    }

    pub(super) fn load_bases(&mut self) {
        for (slice, base) in &self.bases {
            let from = match self.layout.part {
                Some(_) if usize::from(*slice) == OF_STEP => part::CONSTANTS_OF_STEP,
                _ => Memory::At(TABLE, 8 * i32::from(*slice)),
            };
            self.bytes.load_word(*base, from);
        }
    }

    fn end(&mut self) {
        self.bytes.clear_upper_halves();
        self.leave_frame();
        self.bytes.return_();
    }

    fn leave_frame(&mut self) {
        if self.has_frame() {
            let bytes = &mut self.bytes;
            if self.keeps {
                let kept = 8 * KEPT.len() as u8;
                bytes.address_below(General::Rsp, General::Rbp, kept);
                KEPT.into_iter()
                    .rev()
                    .for_each(|register| bytes.pop(register));
            } else {
                bytes.copy_word(General::Rsp, General::Rbp);
            }
            bytes.pop(General::Rbp);
        }
    }

    /// The loop along columns, which have something in them.
    fn along(&mut self, columns: Columns) -> Option<()> {
        self.bytes.zero(ALONG);
        let start = self.bytes.all.len();
        self.body()?;
        self.bytes.add(ALONG, columns.step);
        self.bytes.compare(ALONG, General::Rcx);
        self.bytes.jump_if_below(start);
        Some(())
    }

    /// The loop of a code that is done again and again, at least once: a slice and the vector exchange their places after each time.
    fn in_turns(&mut self, slice: u8) -> Option<()> {
        let from = Memory::At(TABLE, 8 * i32::from(slice));
        let vector = ARGUMENTS[1];
        self.bytes.zero(ALONG);
        let start = self.bytes.all.len();
        self.body()?;
        self.bytes.copy_word(COLUMN, vector);
        self.bytes.load_word(vector, from);
        self.bytes.store_word(from, COLUMN);
        if self.calls {
            let kept = self.word(1);
            self.bytes.store_word(kept, vector);
        }
        let base = self.bases.iter().find(|(known, _)| *known == slice);
        if let Some((_, base)) = base {
            self.bytes.copy_word(*base, COLUMN);
        }
        self.bytes.add(ALONG, 1);
        self.bytes.compare(ALONG, ARGUMENTS[3]);
        self.bytes.jump_if_below(start);
        Some(())
    }

    /// The constants behind the code, and the distances to them.
    fn with_constants(self) -> Option<Vec<u8>> {
        let Bytes { mut all, distances } = self.bytes;
        let copies = self.layout.width.copies_of_constants();
        all.resize(all.len().next_multiple_of(64), 0xCC);
        let start = all.len();
        for constant in &self.program.constants {
            all.extend(constant.to_le_bytes().repeat(copies));
        }
        for (place, from, constant) in distances {
            let to = start + constant as usize * 8 * copies;
            let distance = i32::try_from(to.checked_sub(from)?).ok()?;
            all[place..place + 4].copy_from_slice(&distance.to_le_bytes());
        }
        Some(all)
    }
}
