//! Parts of a step: where what they give goes, and how one goes on into another.

use super::{ARGUMENTS, General, Memory, TABLE, Writer};
use crate::assembler::chain::{DONE, End, LINKS_AT, MISSED, OF_STEP_AT, PART_AT, RESULTS};
use crate::assembler::operation::PartOf;
use lie_dynamic::BETWEEN;

/// Where slices begin: the table and the record are handed on.
pub const BASES_OF_A_PART: [General; 5] = [
    General::Rax,
    General::R8,
    General::R9,
    General::R10,
    General::R11,
];
const VECTOR: General = ARGUMENTS[1];
const ANSWERS: General = ARGUMENTS[2];
const RECORD: General = ARGUMENTS[3];
/// Where the beginning of the constants of the step size is.
pub const CONSTANTS_OF_STEP: Memory = Memory::At(RECORD, OF_STEP_AT as i32);

/// What a function gives back: two words.
const WHY: General = General::Rax;
const WHICH: General = General::Rdx;

impl Writer<'_> {
    /// Has the vector where the code gives it.
    pub fn begin_part(&mut self, part: PartOf) -> Option<()> {
        let at = |slice: usize| Memory::At(TABLE, 8 * slice as i32);
        match part.end {
            End::Done => self.bytes.load_word(VECTOR, at(RESULTS)),
            End::Question { from, .. } => {
                self.bytes.load_word(VECTOR, at(BETWEEN));
                if from > 0 {
                    let distance = 8 * part.lanes * from;
                    self.bytes.add(VECTOR, u32::try_from(distance).ok()?);
                }
            }
        }
        Some(())
    }

    /// Leaves where the part is not for all lanes; goes on to the next one, or leaves where there is none.
    pub fn end_part(&mut self, part: PartOf) {
        self.leave_frame();
        let missed = self.jump_unless(part, 0, true);
        match part.end {
            End::Done => self.leave_for(DONE),
            End::Question { every, .. } => {
                let no = self.jump_unless(part, 1, every);
                self.go_on(true);
                self.bytes.land(no);
                self.go_on(false);
            }
        }
        self.bytes.land(missed);
        self.leave_for(MISSED);
    }

    /// Jumps where an answer is 0: with `every` in any lane, otherwise in all lanes. Returns the place of the jump's distance. No answer is -0.
    fn jump_unless(&mut self, part: PartOf, answer: usize, every: bool) -> usize {
        let lane = |lane: usize| Memory::At(ANSWERS, 8 * (answer * part.lanes + lane) as i32);
        self.bytes.load_word(WHY, lane(0));
        for other in 1..part.lanes {
            match every {
                true => self.bytes.and_word(WHY, lane(other)),
                false => self.bytes.or_word(WHY, lane(other)),
            }
        }
        self.bytes.jump_if_zero(WHY)
    }

    /// Goes on to the part that is linked for an answer.
    fn go_on(&mut self, answer: bool) {
        let [function, record] =
            LINKS_AT[usize::from(answer)].map(|at| Memory::At(RECORD, at as i32));
        self.bytes.load_word(WHY, function);
        self.bytes.load_word(RECORD, record);
        self.bytes.jump(WHY);
    }

    fn leave_for(&mut self, why: u64) {
        self.bytes.clear_upper_halves();
        self.bytes.word_constant(WHY, why);
        self.bytes
            .load_word(WHICH, Memory::At(RECORD, PART_AT as i32));
        self.bytes.return_();
    }
}
