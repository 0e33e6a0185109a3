//! The flows of the coordinate pieces of a separable Hamiltonian.

use super::constants::Table;
use super::function::Function;
use super::planner::Planner;
use crate::derive::{PieceKernel, Update};
use crate::methods::Choice;

/// The flows of all pieces.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Splitting {
    /// One for each piece.
    pub flows: Vec<Flow>,
}

/// The flow of one piece.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Flow {
    /// The coordinate of which the piece is a function.
    pub coordinate: usize,
    /// What changes the state over a time t; without it the flow is that of its series.
    pub function: Option<Function>,
    /// What is done with each output of the function.
    pub updates: Vec<Update>,
}

impl Planner<'_> {
    /// The flows where H has pieces: of code of their own where a splitting is asked for, else the key of the generic
    /// ones.
    pub(super) fn splitting(&mut self) -> Option<Result<Splitting, String>> {
        let pieces = self.source.splitting_kernels()?;
        let splits = |choice: &Choice| matches!(choice, Choice::Splitting(..));
        if !self.methods.iter().any(splits) {
            return Some(Err("splitting".to_owned()));
        }
        let flows = pieces.iter().map(|piece| self.flow(piece)).collect();
        Some(Ok(Splitting { flows }))
    }

    fn flow(&mut self, piece: &PieceKernel) -> Flow {
        let function = piece.kernel.as_ref().map(|kernel| {
            let coordinate = &self.names.coordinates[piece.coordinate];
            let label = format!("splitting flow {coordinate}");
            let mut function = self.labelled(label, kernel, &mut Table::default());
            for update in &piece.updates {
                match update {
                    Update::Add | Update::Subtract => function.program.counts.add += 1,
                    Update::Multiply => function.program.counts.mul += 1,
                    Update::Divide => function.program.counts.div += 1,
                }
            }
            function
        });
        Flow {
            coordinate: piece.coordinate,
            function,
            updates: piece.updates.clone(),
        }
    }
}
