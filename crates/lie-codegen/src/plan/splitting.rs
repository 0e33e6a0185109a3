//! The flows of the pieces of a Hamiltonian: those of one coordinate each, and those that were found.

use super::constants::Table;
use super::function::Function;
use super::planner::Planner;
use crate::derive::{FoundKernel, Kernel, PieceKernel, Source, Update};
use crate::methods::{Choice, Pieces};
use crate::structure::Structure;
use crate::structure::found::Chosen;
use lie_symbolic::schedule::Counts;

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
        /// Whether a splitting is asked for, so that their flows have code of their own.
        fused: bool,
        /// H without the Casimirs, in the names of the declaration, where some are taken away.
        text: Option<String>,
    },
}

/// A piece that was found.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct FoundPiece {
    /// Its terms, in the names of the declaration.
    pub terms: Vec<String>,
    /// The parts of its flow, one after the other.
    pub parts: Vec<FoundPart>,
    /// The gradient of the piece.
    pub direction: Function,
}

/// A part of the flow of a piece, whose element is constant along it.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct FoundPart {
    /// Flows that make it up, one after the other; `None` where the exponential of its direction is used.
    pub flows: Option<Vec<Flow>>,
    /// Its direction, where there are other parts.
    pub direction: Option<Function>,
}

impl Found {
    /// The flows that are not those of H itself.
    pub fn flows(&self) -> impl Iterator<Item = &Flow> {
        let pieces: &[FoundPiece] = match self {
            Found::Same => &[],
            Found::Pieces { pieces, .. } => pieces,
        };
        let parts = pieces.iter().flat_map(|piece| &piece.parts);
        parts.flat_map(|part| part.flows.iter().flatten())
    }
}

/// What a series costs, for choosing between ways to split H: more than closed forms.
const SERIES: usize = 10_000;

/// The way to split H whose step of order 2 has the fewest operations, and the order of its pieces.
pub fn chosen(structure: &Structure) -> Option<Chosen> {
    let searched = &structure.splitting;
    let first = searched.ways.first()?;
    if first.declared {
        return Some(Chosen {
            way: 0,
            order: (0..first.pieces.len()).collect(),
            costs: vec![0],
        });
    }
    let source = Source::new(structure);
    let ways = searched.ways.iter().map(|way| {
        let mut source = source.clone();
        let way = way.moved(&searched.graph, &mut source.graph);
        let kernels = source.found_kernels(&way);
        let costs: Vec<usize> = kernels.iter().map(|k| cost(&mut source, k)).collect();
        let mut order: Vec<usize> = (0..costs.len()).collect();
        order.sort_by_key(|place| costs[*place]);
        // each piece acts twice, the last one once
        let last = order.last().map_or(0, |place| costs[*place]);
        (2 * costs.iter().sum::<usize>() - last, order)
    });
    let ways: Vec<(usize, Vec<usize>)> = ways.collect();
    let way = (0..ways.len()).min_by_key(|way| ways[*way].0)?;
    Some(Chosen {
        way,
        order: ways[way].1.clone(),
        costs: ways.iter().map(|(cost, _)| *cost).collect(),
    })
}

/// The operations of the flow of a piece, in units of one multiplication.
fn cost(source: &mut Source, kernel: &FoundKernel) -> usize {
    let mut cost = 0;
    for part in &kernel.parts {
        let Some(flows) = &part.flows else {
            cost += SERIES;
            continue;
        };
        for flow in flows {
            cost += flow.kernel.as_ref().map_or(SERIES, |kernel| {
                let mut counts = kernel.program(&mut source.graph).counts;
                count_updates(&mut counts, &flow.updates);
                counts.weight()
            });
        }
    }
    cost
}

/// Adds what is done with the outputs of a flow.
fn count_updates(counts: &mut Counts, updates: &[Update]) {
    for update in updates {
        match update {
            Update::Add | Update::Subtract => counts.add += 1,
            Update::Multiply => counts.mul += 1,
            Update::Divide => counts.div += 1,
            Update::Replace => {}
        }
    }
}

impl Planner<'_> {
    /// The flows of the pieces that were found: of code of their own where a splitting is asked for, else by the exponentials of
    /// their directions, which need an algebra.
    ///
    /// They come behind all other kernels, whose code does not depend on them then.
    pub(super) fn found_splitting(&mut self, chosen: Option<&Chosen>) -> Option<Found> {
        let chosen = chosen?;
        let searched = &self.structure.splitting;
        let found = &searched.ways[chosen.way];
        if found.declared {
            return Some(Found::Same);
        }
        let mut methods = self.methods.iter();
        let fused = methods.any(|choice| matches!(choice, Choice::Splitting(_, _, Pieces::Found)));
        if !fused && !self.source.is_lie() {
            return None;
        }
        let found = found.moved(&searched.graph, &mut self.source.graph);
        let (rest, whole) = (found.rest, found.whole);
        let kernels = self.source.found_kernels(&found);
        let pieces = chosen.order.iter().enumerate();
        let pieces = pieces
            .map(|(place, piece)| self.found_piece(place + 1, &kernels[*piece], fused))
            .collect();
        Some(Found::Pieces {
            pieces,
            whole,
            fused,
            text: rest.map(|rest| self.text(rest)),
        })
    }

    fn found_piece(&mut self, number: usize, kernel: &FoundKernel, fused: bool) -> FoundPiece {
        let label = format!("found direction {number}");
        let alone = kernel.parts.len() == 1;
        let parts = kernel.parts.iter().enumerate();
        let parts = parts.map(|(place, part)| {
            let idle = part.flows.as_ref().is_some_and(Vec::is_empty);
            let flows = part.flows.as_ref().filter(|_| fused || idle);
            let flows = flows.map(|flows| {
                let flows = flows.iter();
                flows.map(|flow| self.flow(flow, "found")).collect()
            });
            let label = format!("{label}.{}", place + 1);
            FoundPart {
                flows,
                direction: (!alone).then(|| self.direction(label, &part.direction)),
            }
        });
        FoundPiece {
            parts: parts.collect(),
            terms: kernel.terms.iter().map(|term| self.text(*term)).collect(),
            direction: self.direction(label, &kernel.direction),
        }
    }

    fn direction(&mut self, label: String, kernel: &Kernel) -> Function {
        self.labelled(label, kernel, &mut Table::default())
    }

    /// The flows where H has pieces: of code of their own where a splitting is asked for, else the key of the generic
    /// ones.
    pub(super) fn splitting(
        &mut self,
        chosen: Option<&Chosen>,
    ) -> Option<Result<Splitting, String>> {
        let pieces = self.source.splitting_kernels()?;
        let ways = &self.structure.splitting.ways;
        let same = chosen.is_some_and(|chosen| ways[chosen.way].declared);
        let splits = |choice: &Choice| match choice {
            Choice::Splitting(_, _, Pieces::Coordinate) => true,
            Choice::Splitting(_, _, Pieces::Found) => same,
            _ => false,
        };
        if !self.methods.iter().any(splits) {
            let key = if same {
                "splitting"
            } else {
                "coordinate_splitting"
            };
            return Some(Err(key.to_owned()));
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
            count_updates(&mut function.program.counts, &piece.updates);
            function
        });
        Flow {
            coordinate: piece.coordinate,
            function,
            updates: piece.updates.clone(),
        }
    }
}
