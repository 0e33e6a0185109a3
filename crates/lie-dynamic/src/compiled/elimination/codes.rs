//! Eliminations as codes over registers: the operations of the table, in its order.

use super::table::Table;
use crate::code::{Code, Instruction, Number, Register, Source, Store};
use std::collections::BTreeMap;

/// Where the entries of a matrix in square blocks are: block after block, each row after row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Rows of a block.
    size: usize,
    /// Blocks in a row of them.
    across: usize,
}

/// More blocks in a row of them do not fit the arguments of a code, of which the matrix is one and each part of a vector another.
const MOST: usize = crate::engine::ARGUMENTS - 1;

impl Layout {
    /// Of so many rows, in blocks of a size.
    pub fn new(size: usize, rows: usize) -> Self {
        Self {
            size,
            across: rows.div_ceil(size),
        }
    }

    /// Whether it is that of a matrix.
    pub fn fits(&self, across: usize, dimension: usize) -> bool {
        across == self.across && across <= MOST && dimension == self.size * across
    }

    /// The number of entries.
    pub fn entries(&self) -> usize {
        (self.size * self.across).pow(2)
    }

    /// The place of an entry.
    pub fn place(&self, row: usize, column: usize) -> usize {
        let block = row / self.size * self.across + column / self.size;
        (block * self.size + row % self.size) * self.size + column % self.size
    }
}

/// A code in the making.
#[derive(Default)]
struct CodeBuilder(Code);

impl CodeBuilder {
    /// A source, which come before all instructions.
    fn source(&mut self, source: Source) -> Register {
        self.0.add_source(source)
    }

    fn push(&mut self, instruction: Instruction) -> Register {
        self.0.instructions.push(instruction);
        self.0.registers += 1;
        self.0.registers - 1
    }

    /// `a - b c`
    fn subtracted(&mut self, a: Register, b: Register, c: Register) -> Register {
        let product = self.push(Instruction::Mul(b, c));
        self.push(Instruction::Sub(a, product))
    }

    fn store(&mut self, target: u8, entries: impl IntoIterator<Item = (usize, Register)>) {
        let entries = entries.into_iter();
        self.0.stores.extend(entries.map(|(entry, register)| Store {
            target,
            entry: entry as u32,
            register,
        }));
    }
}

/// Registers of entries of a matrix.
type Entries = BTreeMap<(usize, usize), Register>;

const ONE: Source = Source::Number(Number::Exact(1.0));

impl Table {
    /// The entries of a matrix that are read, which are an argument.
    fn entries(&self, layout: Layout, making: &mut CodeBuilder) -> Entries {
        let places = self.places().into_iter();
        let sources = places.map(|(row, column)| {
            let entry = layout.place(row, column) as u32;
            let register = making.source(Source::Argument(0, entry));
            ((row, column), register)
        });
        sources.collect()
    }

    /// Replaces entries by those of the triangular factors.
    fn factor_entries(&self, entries: &mut Entries, one: Register, making: &mut CodeBuilder) {
        for pivot in self.pivots() {
            let index = pivot.index;
            let inverse = (!self.keeps_one(pivot)).then(|| {
                let inverse = making.push(Instruction::Div(one, entries[&(index, index)]));
                entries.insert((index, index), inverse);
                inverse
            });
            for row in &pivot.below {
                let mut multiplier = entries[&(*row, index)];
                if let Some(inverse) = inverse {
                    multiplier = making.push(Instruction::Mul(multiplier, inverse));
                    entries.insert((*row, index), multiplier);
                }
                for column in &pivot.right {
                    let (entry, above) = (entries[&(*row, *column)], entries[&(index, *column)]);
                    let entry = making.subtracted(entry, multiplier, above);
                    entries.insert((*row, *column), entry);
                }
            }
        }
    }

    /// Replaces a right side by the solution.
    fn solve_entries(&self, entries: &Entries, vector: &mut [Register], making: &mut CodeBuilder) {
        for pivot in self.pivots() {
            let value = vector[pivot.index];
            for row in &pivot.below {
                let multiplier = entries[&(*row, pivot.index)];
                vector[*row] = making.subtracted(vector[*row], multiplier, value);
            }
        }
        for pivot in self.pivots().iter().rev() {
            let index = pivot.index;
            let mut sum = vector[index];
            for column in &pivot.right {
                sum = making.subtracted(sum, entries[&(index, *column)], vector[*column]);
            }
            vector[index] = match self.keeps_one(pivot) {
                true => sum,
                false => making.push(Instruction::Mul(sum, entries[&(index, index)])),
            };
        }
    }

    /// What replaces a matrix by its triangular factors: all entries that the elimination reads.
    pub fn factorisation(&self, layout: Layout) -> Code {
        let mut making = CodeBuilder::default();
        let mut entries = self.entries(layout, &mut making);
        let one = making.source(ONE);
        self.factor_entries(&mut entries, one, &mut making);
        let stored = entries.into_iter();
        making.store(
            0,
            stored.map(|((i, j), register)| (layout.place(i, j), register)),
        );
        making.0
    }

    /// What solves by the factors, the first argument; each part of the right side is one more.
    pub fn solution(&self, layout: Layout) -> Code {
        let mut making = CodeBuilder::default();
        let entries = self.entries(layout, &mut making);
        let rows = 0..layout.size * layout.across;
        let right = rows.map(|row| {
            let (part, entry) = (row / layout.size, row % layout.size);
            making.source(Source::Argument(1 + part as u8, entry as u32))
        });
        let mut vector: Vec<Register> = right.collect();
        self.solve_entries(&entries, &mut vector, &mut making);
        making.store(0, vector.into_iter().enumerate());
        making.0
    }

    /// A code that writes a residual and its Jacobian, of so many rows, with what follows: it writes the solution, the
    /// residual behind it, and the triangular factors.
    pub fn update(&self, linearize: &Code, size: usize) -> Code {
        let mut making = CodeBuilder(linearize.clone());
        let [one, zero] = [1.0, 0.0].map(|x| making.source(Source::Number(Number::Exact(x))));
        let (mut residual, mut entries) = (vec![zero; size], Entries::new());
        for Store {
            target,
            entry,
            register,
        } in std::mem::take(&mut making.0.stores)
        {
            let entry = entry as usize;
            match target {
                0 => residual[entry] = register,
                _ => {
                    entries.insert((entry / size, entry % size), register);
                }
            }
        }
        making.0.clear = [None, None];
        self.factor_entries(&mut entries, one, &mut making);
        let mut solution = residual.clone();
        self.solve_entries(&entries, &mut solution, &mut making);
        making.store(0, solution.into_iter().chain(residual).enumerate());
        let factors = entries.into_iter();
        making.store(
            1,
            factors.map(|((i, j), register)| (i * size + j, register)),
        );
        making.0
    }
}
