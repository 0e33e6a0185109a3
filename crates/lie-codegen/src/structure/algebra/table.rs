//! An algebra over the rationals as a table of brackets, with what linear algebra does to it: subalgebras, quotients,
//! the Killing form.

use super::subspace::{Signature, Subspace, Vector, signature};
use crate::algebra::StructureConstants;
use lie_symbolic::exact::{Budget, Exhausted, Rational};

/// The brackets of a basis.
#[derive(Clone, Debug)]
pub struct Table {
    /// `brackets[i][j]` lists the `(k, C_ij^k)`.
    brackets: Vec<Vec<Vec<(usize, Rational)>>>,
}

impl Table {
    /// The table of structure constants.
    pub fn new(constants: &StructureConstants<Rational>) -> Self {
        Self {
            brackets: constants.table(),
        }
    }

    /// The table of a basis whose brackets are known as vectors.
    pub fn from_brackets(
        dimension: usize,
        mut bracket: impl FnMut(usize, usize) -> Result<Vector, Exhausted>,
    ) -> Result<Self, Exhausted> {
        let mut entries = Vec::new();
        for i in 0..dimension {
            for j in i + 1..dimension {
                let value = bracket(i, j)?.into_iter().enumerate();
                let value = value.filter(|(_, c)| !c.is_zero());
                entries.extend(value.map(|(k, c)| (i, j, k, c)));
            }
        }
        Ok(Self::new(&StructureConstants::new(dimension, entries)))
    }

    /// Its dimension n.
    pub fn dimension(&self) -> usize {
        self.brackets.len()
    }

    /// Its structure constants.
    pub fn constants(&self) -> StructureConstants<Rational> {
        let mut entries = Vec::new();
        for (i, row) in self.brackets.iter().enumerate() {
            for (j, value) in row.iter().enumerate().skip(i + 1) {
                entries.extend(value.iter().map(|(k, c)| (i, j, *k, c.clone())));
            }
        }
        StructureConstants::new(self.dimension(), entries)
    }

    /// The `(j, k, C_ij^k)` of one i.
    pub fn brackets_of(&self, i: usize) -> impl Iterator<Item = (usize, usize, &Rational)> {
        let row = self.brackets[i].iter().enumerate();
        row.flat_map(|(j, value)| value.iter().map(move |(k, c)| (j, *k, c)))
    }

    /// The finest direct sum of ideals that are spanned by basis elements: each once, with how often it occurs.
    pub fn blocks(&self) -> Vec<(Self, usize)> {
        let mut kinds: Vec<(StructureConstants<Rational>, usize)> = Vec::new();
        for (_, block) in self.constants().blocks(None) {
            match kinds.iter_mut().find(|(kind, _)| *kind == block) {
                Some((_, count)) => *count += 1,
                None => kinds.push((block, 1)),
            }
        }
        let table = |(kind, count)| (Self::new(&kind), count);
        kinds.into_iter().map(table).collect()
    }

    /// Whether all brackets vanish.
    pub fn is_abelian(&self) -> bool {
        self.brackets.iter().flatten().all(Vec::is_empty)
    }

    /// A basis element.
    pub fn unit(&self, i: usize) -> Vector {
        let mut unit = vec![Rational::ZERO; self.dimension()];
        unit[i] = Rational::ONE;
        unit
    }

    /// The bracket of two vectors.
    pub fn bracket(
        &self,
        x: &[Rational],
        y: &[Rational],
        budget: &Budget,
    ) -> Result<Vector, Exhausted> {
        let mut value = vec![Rational::ZERO; self.dimension()];
        for (i, a) in x.iter().enumerate().filter(|(_, a)| !a.is_zero()) {
            for (j, b) in y.iter().enumerate().filter(|(_, b)| !b.is_zero()) {
                let brackets = &self.brackets[i][j];
                if brackets.is_empty() {
                    continue;
                }
                let product = a * b;
                for (k, c) in brackets {
                    let term = &product * c;
                    budget.spend_on(&term)?;
                    value[*k] = &value[*k] + &term;
                }
            }
        }
        Ok(value)
    }

    /// `[a, b]` of two subspaces.
    pub fn product(
        &self,
        a: &Subspace,
        b: &Subspace,
        budget: &Budget,
    ) -> Result<Subspace, Exhausted> {
        let mut space = Subspace::zero(self.dimension());
        let same = a == b;
        for (i, x) in a.basis().iter().enumerate() {
            for y in &b.basis()[if same { i + 1 } else { 0 }..] {
                if space.is_full() {
                    return Ok(space);
                }
                space.insert(self.bracket(x, y, budget)?, budget)?;
            }
        }
        Ok(space)
    }

    /// The whole algebra as a subspace.
    pub fn as_subspace(&self, budget: &Budget) -> Result<Subspace, Exhausted> {
        let n = self.dimension();
        Subspace::span(n, (0..n).map(|i| self.unit(i)), budget)
    }

    /// The vectors x with `[x, y] = 0` for all y of a subspace.
    pub fn centralizer(&self, of: &Subspace, budget: &Budget) -> Result<Subspace, Exhausted> {
        let n = self.dimension();
        let mut equations = Subspace::zero(n);
        for y in of.basis() {
            let columns: Vec<Vector> = (0..n)
                .map(|i| self.bracket(&self.unit(i), y, budget))
                .collect::<Result<_, _>>()?;
            for k in 0..n {
                if equations.is_full() {
                    return Ok(Subspace::zero(n));
                }
                equations.insert(columns.iter().map(|c| c[k].clone()).collect(), budget)?;
            }
        }
        Subspace::span(n, equations.annihilated(), budget)
    }

    /// The subalgebra on the basis of a subspace that is closed.
    pub fn subalgebra(&self, space: &Subspace, budget: &Budget) -> Result<Self, Exhausted> {
        let basis = space.basis();
        Self::from_brackets(basis.len(), |i, j| {
            let value = self.bracket(&basis[i], &basis[j], budget)?;
            Ok(space.pivots().iter().map(|&p| value[p].clone()).collect())
        })
    }

    /// The quotient by an ideal, in the basis elements that are no pivots of the ideal.
    pub fn quotient(&self, ideal: &Subspace, budget: &Budget) -> Result<Self, Exhausted> {
        let places = ideal.complement_places();
        Self::from_brackets(places.len(), |i, j| {
            let (x, y) = (self.unit(places[i]), self.unit(places[j]));
            let value = ideal.reduced(self.bracket(&x, &y, budget)?, budget)?;
            Ok(places.iter().map(|&p| value[p].clone()).collect())
        })
    }

    /// The matrix of ad_x on the basis of an ideal: column j holds the coordinates of `[x, b_j]`.
    pub fn action(
        &self,
        x: &[Rational],
        ideal: &Subspace,
        budget: &Budget,
    ) -> Result<Vec<Vector>, Exhausted> {
        let mut rows = vec![Vec::new(); ideal.dimension()];
        for b in ideal.basis() {
            let value = self.bracket(x, b, budget)?;
            for (row, &pivot) in rows.iter_mut().zip(ideal.pivots()) {
                row.push(value[pivot].clone());
            }
        }
        Ok(rows)
    }

    /// `tr ad_i` of every basis element.
    pub fn traces(&self) -> Vector {
        let trace = |row: &Vec<Vec<(usize, Rational)>>| {
            let diagonal = row
                .iter()
                .enumerate()
                .flat_map(|(j, value)| value.iter().filter(move |(k, _)| *k == j).map(|(_, c)| c));
            diagonal.fold(Rational::ZERO, |sum, c| &sum + c)
        };
        self.brackets.iter().map(trace).collect()
    }

    /// The Killing form `K_ij = tr(ad_i ad_j) = sum_kl C_ik^l C_jl^k`.
    pub fn killing_form(&self, budget: &Budget) -> Result<Vec<Vector>, Exhausted> {
        let n = self.dimension();
        let mut form = vec![vec![Rational::ZERO; n]; n];
        for (i, of_first) in self.brackets.iter().enumerate() {
            // (ad_i)_lk by l
            let mut columns: Vec<Vec<(usize, &Rational)>> = vec![Vec::new(); n];
            for (k, value) in of_first.iter().enumerate() {
                value.iter().for_each(|(l, c)| columns[*l].push((k, c)));
            }
            for (j, of_second) in self.brackets.iter().enumerate().skip(i) {
                let sum = trace_of_product(&columns, of_second, budget)?;
                form[i][j] = sum.clone();
                form[j][i] = sum;
            }
        }
        Ok(form)
    }

    /// The signature of the Killing form.
    pub fn killing_signature(&self, budget: &Budget) -> Result<Signature, Exhausted> {
        signature(self.killing_form(budget)?, budget)
    }

    /// The radical: what is orthogonal to `[g, g]` in the Killing form, the largest solvable ideal.
    pub fn radical(&self, derived: &Subspace, budget: &Budget) -> Result<Subspace, Exhausted> {
        let n = self.dimension();
        let killing = self.killing_form(budget)?;
        let mut equations = Subspace::zero(n);
        for y in derived.basis() {
            let mut row = vec![Rational::ZERO; n];
            for (line, factor) in killing.iter().zip(y).filter(|(_, f)| !f.is_zero()) {
                for (entry, value) in row.iter_mut().zip(line).filter(|(_, v)| !v.is_zero()) {
                    let product = factor * value;
                    budget.spend_on(&product)?;
                    *entry = &*entry + &product;
                }
            }
            equations.insert(row, budget)?;
        }
        Subspace::span(n, equations.annihilated(), budget)
    }
}

/// `sum_kl A_lk B_kl`, A by rows and B by columns.
fn trace_of_product(
    rows: &[Vec<(usize, &Rational)>],
    columns: &[Vec<(usize, Rational)>],
    budget: &Budget,
) -> Result<Rational, Exhausted> {
    let mut sum = Rational::ZERO;
    budget.spend(rows.len() as u64 / 4)?;
    for (row, column) in rows.iter().zip(columns).filter(|(row, _)| !row.is_empty()) {
        for (to, d) in column {
            for (_, c) in row.iter().filter(|(k, _)| k == to) {
                let product = *c * d;
                budget.spend_on(&product)?;
                sum = &sum + &product;
            }
        }
    }
    Ok(sum)
}
