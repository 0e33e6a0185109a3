//! The flows of the coordinate pieces of a separable Hamiltonian.

use super::constants::Table;
use super::function::Function;
use super::planner::Planner;
use crate::derive::{FoundKernel, PieceKernel, Update};
use crate::methods::Choice;
use crate::structure::found;

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

/// The flows of the pieces that were found.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Found {
    /// Those of H itself are the fewest.
    Same,
    /// Others.
    Pieces {
        /// The pieces, that with the longest flow last.
        pieces: Vec<FoundPiece>,
        /// Whether they are all of H.
        whole: bool,
        /// H without the Casimirs, in the names of the declaration, where some are taken away.
        text: Option<String>,
    },
}

/// A piece that was found.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct FoundPiece {
    /// Its terms, in the names of the declaration.
    pub terms: Vec<String>,
    /// Flows that make up its own, one after the other; `None` where the series is summed.
    pub flows: Option<Vec<Flow>>,
    /// The gradient of the piece.
    pub direction: Function,
}

impl FoundPiece {
    /// The operations of its flow.
    fn cost(&self) -> usize {
        let cost = |flows: &Vec<Flow>| flows.iter().map(Flow::cost).sum();
        self.flows.as_ref().map_or(usize::MAX, cost)
    }
}

impl Found {
    /// The flows that are not those of H itself.
    pub fn flows(&self) -> impl Iterator<Item = &Flow> {
        let pieces: &[FoundPiece] = match self {
            Found::Same => &[],
            Found::Pieces { pieces, .. } => pieces,
        };
        pieces.iter().flat_map(|piece| piece.flows.iter().flatten())
    }
}

impl Flow {
    /// The operations of one flow.
    fn cost(&self) -> usize {
        let counts = self
            .function
            .as_ref()
            .map(|function| function.program.counts);
        counts.map_or(usize::MAX, |counts| counts.weight())
    }
}

impl Planner<'_> {
    /// The flows of the pieces that were found, where a splitting is asked for.
    ///
    /// They are looked for behind all other kernels, whose code does not depend on them then.
    pub(super) fn found(&mut self) -> Option<Found> {
        let mut methods = self.methods.iter();
        if !methods.any(|choice| matches!(choice, Choice::Splitting(..))) {
            return None;
        }
        self.source.found = found::found(self.model, &mut self.source.graph);
        let found = self.source.found.as_ref()?;
        if found.declared {
            return Some(Found::Same);
        }
        let (rest, whole) = (found.rest, found.whole);
        let kernels = self.source.found_kernels()?;
        let mut pieces: Vec<FoundPiece> = kernels
            .iter()
            .enumerate()
            .map(|(place, kernel)| self.found_piece(place + 1, kernel))
            .collect();
        pieces.sort_by_key(FoundPiece::cost);
        Some(Found::Pieces {
            pieces,
            whole,
            text: rest.map(|rest| self.text(rest)),
        })
    }

    fn found_piece(&mut self, number: usize, kernel: &FoundKernel) -> FoundPiece {
        let flows = kernel.flows.as_ref().map(|flows| {
            let flows = flows.iter();
            flows.map(|flow| self.flow(flow, "found")).collect()
        });
        let label = format!("found direction {number}");
        FoundPiece {
            terms: kernel.terms.iter().map(|term| self.text(*term)).collect(),
            flows,
            direction: self.labelled(label, &kernel.direction, &mut Table::default()),
        }
    }

    /// The flows where H has pieces: of code of their own where a splitting is asked for, else the key of the generic
    /// ones.
    pub(super) fn splitting(&mut self) -> Option<Result<Splitting, String>> {
        let pieces = self.source.splitting_kernels()?;
        let splits = |choice: &Choice| matches!(choice, Choice::Splitting(..));
        if !self.methods.iter().any(splits) {
            return Some(Err("splitting".to_owned()));
        }
        let flows = pieces
            .iter()
            .map(|piece| self.flow(piece, "splitting"))
            .collect();
        Some(Ok(Splitting { flows }))
    }

    fn flow(&mut self, piece: &PieceKernel, kind: &str) -> Flow {
        let function = piece.kernel.as_ref().map(|kernel| {
            let coordinate = &self.names.coordinates[piece.coordinate];
            let label = format!("{kind} flow {coordinate}");
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
