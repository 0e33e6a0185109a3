//! What an expression consists of.

use super::{Expr, ExprKind};

impl Expr {
    /// Its operands.
    pub fn operands(&self) -> Vec<&Self> {
        match &self.kind {
            ExprKind::Number(_) | ExprKind::Name { .. } => Vec::new(),
            ExprKind::Negative(a) => vec![a],
            ExprKind::Power(a, b) => vec![a, b],
            ExprKind::Sum(operands) | ExprKind::Product(operands) => {
                operands.iter().map(|(_, operand)| operand).collect()
            }
            ExprKind::Call { arguments, .. } => arguments.iter().collect(),
            ExprKind::IndexedSum { from, to, body, .. } => vec![from, to, body],
        }
    }

    /// Itself, its operands and theirs, in the order of the text.
    pub fn parts(&self) -> impl Iterator<Item = &Self> {
        let mut pending = vec![self];
        std::iter::from_fn(move || {
            let part = pending.pop()?;
            pending.extend(part.operands().into_iter().rev());
            Some(part)
        })
    }
}
