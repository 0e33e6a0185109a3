//! Taylor coefficients of the field, order by order.

use super::constants::{Code, Constant};
use super::planner::Planner;
use crate::derive::{Kernel, Quantity, Shape, recurrences};
use lie_symbolic::schedule::{Counts, Program};
use lie_symbolic::symbolic::ExprId;

/// The recurrence of a field, or of a field and the gradient of H.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Recurrence {
    /// The end of its type's name.
    pub suffix: &'static str,
    /// The entries of the field that do not vanish.
    pub field: Vec<usize>,
    /// Those of the gradient, where it is asked for.
    pub gradient: Option<Vec<usize>>,
    /// Order 0: the entries, then the conditions that choose branches, then what is kept for all orders.
    pub begin: Code,
    /// Order k: the entries, then the conditions, then the left and the right series of each pair.
    pub advance: Program<Quantity<Constant>>,
    /// The number of conditions.
    pub conditions: usize,
    /// The number of pairs of series whose products are summed.
    pub pairs: usize,
    /// The number of values that are kept.
    pub kept: usize,
}

impl Recurrence {
    /// The label and the operation counts of each of its two kernels; the sums of the pairs come to those of order k.
    pub fn counts(&self) -> [(String, Counts); 2] {
        let label = self.label();
        [
            (format!("{label} order 0"), self.begin.counts),
            (format!("{label} order k"), self.advance.counts),
        ]
    }

    /// The method that it is for.
    pub fn label(&self) -> &'static str {
        match self.gradient {
            None => "taylor",
            Some(_) => "lie-taylor",
        }
    }

    /// The number of entries.
    pub fn entries(&self) -> usize {
        self.field.len() + self.gradient.as_ref().map_or(0, Vec::len)
    }
}

impl Planner<'_> {
    /// The recurrence of the field, with the gradient or without.
    pub(super) fn recurrence(&mut self, with_gradient: bool) -> Recurrence {
        let arguments = Vec::new();
        let field = self.source.field();
        let field_kernel = Kernel::vector(&self.source.graph, "series", "", arguments, &field);
        let Shape::Vector(of_field) = field_kernel.shape.clone() else {
            unreachable!("a field is a vector")
        };
        let mut task = field_kernel.task;
        let mut gradient = None;
        if with_gradient {
            let slope = self.source.generator();
            let graph = &self.source.graph;
            let varying = slope.iter().copied().enumerate();
            let (places, values): (Vec<usize>, Vec<ExprId>) =
                varying.filter(|(_, value)| !graph.is_zero(*value)).unzip();
            task.outputs.extend(values);
            gradient = Some(places);
        }
        let program = lie_symbolic::schedule::schedule(&mut self.source.graph, &task);
        let found = recurrences(&program);
        let begin = self.code_of_system(&found.begin);
        let advance = found
            .advance
            .with_prepared(&mut |quantity| match *quantity {
                Quantity::Constant(id) => Quantity::Constant(self.constant_of_system(id)),
                Quantity::Rest(pair) => Quantity::Rest(pair),
                Quantity::Kept(place) => Quantity::Kept(place),
                Quantity::Order => Quantity::Order,
                Quantity::InverseOrder => Quantity::InverseOrder,
            });
        Recurrence {
            suffix: if with_gradient { "LieTaylor" } else { "Taylor" },
            field: of_field,
            gradient,
            begin,
            advance,
            conditions: found.conditions,
            pairs: found.pairs,
            kept: found.kept,
        }
    }
}
