//! Identities that must hold: sums that are shown to be zero, or not.

use super::confirmation::Finding;
use super::normal::{NormalForm, Verdict};
use super::residues;
use crate::exact::Budget;
use crate::symbolic::{ExprId, Graph, Symbol};

/// Longer expressions are not printed in full.
const LONGEST: usize = 300;
/// Work allowed to show a sum that is not zero.
const SHOWN: u64 = 100_000;

/// What is known of a sum that should be zero.
pub enum Proof {
    /// It is zero.
    Zero,
    /// It is not, and this is its text.
    Nonzero(String),
    /// It is zero at sample points, or no point of its domain was found, but that proves nothing.
    Unproven {
        /// Its text, where it is short.
        text: Option<String>,
        /// What is known of its values, as a clause.
        values: &'static str,
    },
}

/// Proofs that sums vanish.
pub struct Prover<'a> {
    graph: &'a Graph,
    normal: NormalForm<'a>,
    name: &'a dyn Fn(Symbol) -> String,
}

impl<'a> Prover<'a> {
    /// Proofs wherever the functions of `domain` are real and defined, with the names of symbols.
    pub fn new(
        graph: &'a Graph,
        budget: &'a Budget,
        domain: &[ExprId],
        name: &'a dyn Fn(Symbol) -> String,
    ) -> Self {
        Self {
            graph,
            normal: NormalForm::with_domain(graph, budget, domain),
            name,
        }
    }

    /// Examines a sum. One that does not vanish modulo a prime is not zero for sure: little work is done to show it then.
    pub fn examine(&mut self, sum: ExprId) -> Proof {
        if !residues::is_nonzero(self.graph, sum) {
            return self.decide(sum);
        }
        let budget = Budget::new(SHOWN);
        match Prover::new(self.graph, &budget, &[], self.name).decide(sum) {
            Proof::Nonzero(shown) => Proof::Nonzero(shown),
            Proof::Unproven { text, .. } => Proof::Nonzero(text.unwrap_or_else(long)),
            Proof::Zero => Proof::Nonzero(long()),
        }
    }

    /// Examines a sum whose text nobody is shown if it is not zero.
    pub fn examine_hidden(&mut self, sum: ExprId) -> Proof {
        match residues::is_nonzero(self.graph, sum) {
            true => Proof::Nonzero(String::new()),
            false => self.decide(sum),
        }
    }

    /// Examines a sum by its normal form.
    fn decide(&mut self, sum: ExprId) -> Proof {
        let text = |text: String| (text.chars().count() <= LONGEST).then_some(text);
        let shown = match self.normal.verdict(sum) {
            Verdict::Zero => return Proof::Zero,
            Verdict::Nonzero(value) => self.normal.display(&value, self.name),
            Verdict::Undecided | Verdict::Contradicted => {
                let shown = text(self.graph.display(sum, self.name));
                let values = match self.normal.finding(sum) {
                    Finding::Zero => "although it is at sample points",
                    Finding::Unknown => "and no point was found at which it is defined",
                    Finding::Nonzero => return Proof::Nonzero(shown.unwrap_or_else(long)),
                };
                return Proof::Unproven {
                    text: shown,
                    values,
                };
            }
        };
        Proof::Nonzero(text(shown).unwrap_or_else(long))
    }

    /// Whether a sum is shown to be nowhere negative.
    pub fn is_nonnegative(&mut self, sum: ExprId) -> bool {
        self.normal.is_nonnegative(sum)
    }

    /// Whether a sum is shown to vanish.
    pub fn vanishes(&mut self, sum: ExprId) -> bool {
        matches!(self.normal.verdict(sum), Verdict::Zero)
    }
}

fn long() -> String {
    "a long expression, not zero".into()
}
