//! What is written down of a computation, and the codes that do the same.

mod parts;

use super::Recorded;
use crate::code::{Code, Instruction, Number, Register, Source, Store};
#[cfg(doc)]
use lie_runtime::scalar::Counted;
use std::cell::{Cell, RefCell};
use std::collections::HashMap;

/// A longer step is not made one program at first: compiling it takes long, and calls cost little beside its arithmetic.
pub(super) const LONGEST: usize = 20_000;

/// What is written down. Numbers go by their order of coming into being.
#[derive(Debug, Default)]
pub(super) struct Record {
    /// More instructions are not written down; [`LONGEST`] where nothing is said.
    longest: Option<usize>,
    /// For each number its source, or none of a result.
    sources: Vec<Option<Source>>,
    known: HashMap<(u8, u64, u64), Register>,
    /// Each with the first number that it gives.
    instructions: Vec<(Instruction, Register)>,
    /// The same: what was done before is not done again.
    done: HashMap<Instruction, Register>,
    /// Numbers that were asked whether they are finite.
    pub asked: Vec<Register>,
    /// Whether something was asked that the values decide, and is not written down.
    pub branched: bool,
    /// By how much lanes took less than all together, of each thing that is [counted](Counted), each time.
    pub missing: [Vec<Register>; 3],
    /// Where values are followed, what was asked of them.
    guards: Option<Vec<Guard>>,
    /// Whether that is for one number alone, not for lanes.
    single: bool,
    /// The answers that every lane has wherever the record is for it.
    answers: HashMap<Register, bool>,
}

/// What was asked of a number that is 1 where something holds and 0 elsewhere: whether that is everywhere, or anywhere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Guard {
    pub register: Register,
    /// How many numbers there were.
    pub at: Register,
    pub expected: bool,
    pub every: bool,
    /// Whether the record is only for what has this answer. Nothing is said of what was asked of all lanes and is false in some, or
    /// asked of any and is true: lanes have the bits that they have beside any others, so that each may go the way that one of the
    /// others would have to go.
    pub is_condition: bool,
}

thread_local! {
    /// It belongs to the thread because arithmetic has no place for it.
    static RECORD: RefCell<Record> = RefCell::default();
}

/// Does something with the record of this thread.
pub(super) fn with_record<T>(use_it: impl FnOnce(&mut Record) -> T) -> T {
    RECORD.with_borrow_mut(use_it)
}

impl Record {
    /// The number of a source.
    pub fn source(&mut self, source: Source) -> Register {
        if self.branched {
            return 0;
        }
        let next = self.sources.len() as Register;
        *self.known.entry(key(source)).or_insert_with(|| {
            self.sources.push(Some(source));
            next
        })
    }

    /// Whether values are followed, so that what they decide can be asked.
    pub fn follows_values(&self) -> bool {
        self.guards.is_some()
    }

    /// What was asked; nothing is from now on.
    pub fn take_guards(&mut self) -> Vec<Guard> {
        self.guards.as_mut().map(std::mem::take).unwrap_or_default()
    }

    /// What is known of a number that is 1 where something holds and 0 elsewhere.
    pub fn answer(&self, number: Register) -> Option<bool> {
        // where nothing is written down any more, numbers are not told apart
        let known = self.answers.get(&number).copied();
        known.filter(|_| !self.branched)
    }

    /// Asks of such a number whether it is 1 in every lane, or in any, which values decide; as expected it is.
    pub fn ask(&mut self, register: Register, expected: bool, every: bool) {
        let at = self.sources.len() as Register;
        let Some(guards) = &mut self.guards else {
            self.branched = true;
            return;
        };
        let is_condition = self.single || every == expected;
        guards.push(Guard {
            register,
            at,
            expected,
            every,
            is_condition,
        });
        if is_condition {
            self.answers.insert(register, expected);
        }
    }

    /// The value of a number that is written out.
    pub fn exact(&self, number: Register) -> Option<f64> {
        match self.sources.get(number as usize) {
            Some(Some(Source::Number(Number::Exact(value)))) => Some(*value),
            _ => None,
        }
    }

    /// The first number that the instruction gives.
    pub fn push(&mut self, instruction: Instruction) -> Register {
        self.branched |= self.is_full();
        match self.branched {
            true => 0,
            false => self.write(instruction),
        }
    }

    fn is_full(&self) -> bool {
        self.instructions.len() == self.longest.unwrap_or(LONGEST)
    }

    fn write(&mut self, instruction: Instruction) -> Register {
        let first = self.sources.len() as Register;
        if let Some(known) = self.done.get(&instruction) {
            return *known;
        }
        self.done.insert(instruction, first);
        self.instructions.push((instruction, first));
        let count = instruction.width() as usize;
        self.sources.extend(std::iter::repeat_n(None, count));
        first
    }

    /// The numbers that others need, each with whether it depends on an argument; none of what nothing needs.
    fn needed(&self, stored: &[Register]) -> Vec<Option<bool>> {
        let needed: Vec<Cell<bool>> = vec![Cell::new(false); self.sources.len()];
        let need = |number: Register| {
            needed[number as usize].set(true);
            number
        };
        for number in stored {
            need(*number);
        }
        for (instruction, first) in self.instructions.iter().rev() {
            let numbers = *first as usize..(first + instruction.width()) as usize;
            if needed[numbers].iter().any(Cell::get) {
                instruction.moved(&need);
            }
        }
        let varies: Vec<Cell<bool>> = self.sources.iter().map(is_argument).collect();
        for (instruction, first) in &self.instructions {
            let any = Cell::new(false);
            instruction.moved(&|number| {
                any.set(any.get() || varies[number as usize].get());
                number
            });
            for part in 0..instruction.width() {
                varies[(first + part) as usize].set(any.get());
            }
        }
        let both = needed.iter().zip(&varies);
        both.map(|(needed, varies)| needed.get().then(|| varies.get()))
            .collect()
    }

    /// The codes that store these numbers, without what they do not need: first what depends on no argument and is run once for
    /// a step size, which the second has as constants of it.
    fn codes(&self, stored: [&[Register]; 2]) -> [Code; 2] {
        let all = stored.concat();
        let needed = self.needed(&all);
        let mut kept = Vec::new();
        // what the instructions and the stores that depend on arguments take from those that do not
        let taken = RefCell::new(Vec::new());
        let constants = RefCell::new(vec![None; self.sources.len()]);
        let take = |number: Register| {
            let place = number as usize;
            let constant = needed[place] == Some(false) && self.sources[place].is_none();
            if constant && constants.borrow()[place].is_none() {
                let mut taken = taken.borrow_mut();
                constants.borrow_mut()[place] = Some(Source::OfStep(taken.len() as u32));
                taken.push(number);
            }
            number
        };
        for (instruction, first) in &self.instructions {
            let numbers = *first as usize..(first + instruction.width()) as usize;
            let Some(varies) = needed[numbers].iter().find_map(|number| *number) else {
                continue;
            };
            if varies {
                instruction.moved(&take);
            }
            kept.push((*instruction, *first, varies));
        }
        for number in all {
            take(number);
        }
        let (taken, constants) = (taken.into_inner(), constants.into_inner());
        let of = |varying: bool| {
            let kept = kept.iter().filter(move |(.., varies)| *varies == varying);
            kept.map(|(instruction, first, _)| (*instruction, *first))
        };
        [
            self.code(of(false), &self.sources, [&taken, &[]]),
            self.code(of(true), &self.with(constants), stored),
        ]
    }

    /// The sources, these among them.
    fn with(&self, others: Vec<Option<Source>>) -> Vec<Option<Source>> {
        let both = others.into_iter().zip(&self.sources);
        both.map(|(other, source)| other.or(*source)).collect()
    }

    /// The code of some instructions, given the sources of numbers that are not their results.
    fn code(
        &self,
        instructions: impl Iterator<Item = (Instruction, Register)>,
        from: &[Option<Source>],
        stored: [&[Register]; 2],
    ) -> Code {
        let instructions: Vec<_> = instructions.collect();
        let mut sources = Vec::new();
        let places = RefCell::new(vec![None; self.sources.len()]);
        let mut source = |number: Register| {
            let place = &mut places.borrow_mut()[number as usize];
            if let (None, Some(from)) = (*place, from[number as usize]) {
                *place = Some(sources.len() as Register);
                sources.push(from);
            }
        };
        for (instruction, _) in &instructions {
            let operands = RefCell::new(Vec::new());
            instruction.moved(&|number| {
                operands.borrow_mut().push(number);
                number
            });
            operands.into_inner().into_iter().for_each(&mut source);
        }
        stored.concat().into_iter().for_each(&mut source);
        let mut places = places.into_inner();
        let mut next = sources.len() as Register;
        let place_of = |places: &[Option<Register>], number: Register| {
            places[number as usize].unwrap_or_else(|| unreachable!("numbers come before their use"))
        };
        let mut moved = Vec::with_capacity(instructions.len());
        for (instruction, first) in instructions {
            moved.push(instruction.moved(&|number| place_of(&places, number)));
            for part in 0..instruction.width() {
                places[(first + part) as usize] = Some(next);
                next += 1;
            }
        }
        let stores = (0..).zip(stored).flat_map(|(target, numbers)| {
            let places = &places;
            (0..).zip(numbers).map(move |(entry, number)| Store {
                target,
                entry,
                register: place_of(places, *number),
            })
        });
        Code {
            stores: stores.collect(),
            sources,
            instructions: moved,
            registers: next,
            clear: [None, None],
        }
    }
}

fn is_argument(source: &Option<Source>) -> Cell<bool> {
    Cell::new(matches!(source, Some(Source::Argument(..))))
}

/// What tells sources apart; numbers by their bits, so that 0 and -0 are two.
fn key(source: Source) -> (u8, u64, u64) {
    match source {
        Source::Argument(argument, entry) => (0, argument.into(), entry.into()),
        Source::System(place) => (1, place.into(), 0),
        Source::OfStep(place) => (2, place.into(), 0),
        Source::Parameter(place) => (3, place.into(), 0),
        Source::Step => (4, 0, 0),
        Source::Time => (5, 0, 0),
        Source::Number(Number::Exact(value)) => (6, value.to_bits(), 0),
        Source::Number(Number::Ratio(a, b)) => (7, a.to_bits(), b.to_bits()),
        Source::Number(Number::Parts(high, low)) => (8, high.to_bits(), low.to_bits()),
    }
}

/// What was written down.
#[derive(Debug)]
pub(crate) struct Written(Record);

/// Writes down what is done in `run`. None where it gives none, or where values decide what is done.
pub(crate) fn written<T>(run: impl FnOnce() -> Option<T>) -> Option<(T, Written)> {
    written_in(Record::default(), run).ok()
}

/// Why nothing was written down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Unwritten {
    /// There are more instructions than were asked for.
    TooLong,
    /// Nothing was given, or something else decides what is done.
    Undecided,
}

/// Writes down what is done in `run` for the values that its numbers have, with what is asked of them: for one number alone, or for
/// lanes; so many instructions at most.
pub(crate) fn followed<T>(
    single: bool,
    longest: usize,
    run: impl FnOnce() -> Option<T>,
) -> Result<(T, Written), Unwritten> {
    let record = Record {
        guards: Some(Vec::new()),
        single,
        longest: Some(longest),
        ..Record::default()
    };
    written_in(record, run)
}

fn written_in<T>(
    record: Record,
    run: impl FnOnce() -> Option<T>,
) -> Result<(T, Written), Unwritten> {
    /// What was there before comes back, whatever happens.
    struct Before(Record);
    impl Drop for Before {
        fn drop(&mut self) {
            RECORD.replace(std::mem::take(&mut self.0));
        }
    }
    let before = Before(RECORD.replace(record));
    let given = run();
    let mut record = RECORD.replace(Record::default());
    drop(before);
    // nothing is written down any more
    (record.done, record.answers) = Default::default();
    match given {
        _ if record.branched && record.is_full() => Err(Unwritten::TooLong),
        Some(given) if !record.branched => Ok((given, Written(record))),
        _ => Err(Unwritten::Undecided),
    }
}

impl Written {
    /// The numbers of which it was asked whether they are finite.
    pub fn finiteness_tests(&self) -> Vec<Recorded> {
        let asked = self.0.asked.iter();
        asked
            .map(|register| Recorded::of_register(*register))
            .collect()
    }

    /// The codes that store these numbers as a vector and a matrix, the second with the results of the first as constants of the
    /// step size.
    pub fn codes<const LANES: usize>(
        &self,
        vector: &[Recorded<LANES>],
        matrix: &[Recorded<LANES>],
    ) -> [Code; 2] {
        let [vector, matrix] =
            [vector, matrix].map(|numbers| numbers.iter().map(|x| x.register).collect::<Vec<_>>());
        self.0.codes([&vector, &matrix])
    }
}
