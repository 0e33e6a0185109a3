//! The pieces of a family.

use std::collections::BTreeSet;

use super::derivation::Derivation;
use super::{FamilyForm, FamilyPiece, FamilyPieces};
use crate::derive::{Argument, Kernel, Tape, action};
use crate::plan::function::Function;
use crate::structure::family::Form;
use crate::structure::{exponential, separable};
use lie_core::lattice::AXES;
use lie_symbolic::symbolic::{ExprId, Symbol};

/// Symbols of intermediate quantities, beyond those of all arguments.
const FIRST: usize = 1 << 24;

impl Derivation<'_, '_> {
    /// The pieces of H and of what acts, if their flows are exact.
    pub(super) fn pieces(&mut self) -> Option<FamilyPieces> {
        let model = self.planner.structure;
        let found = model.family_pieces.as_ref()?.as_ref().ok()?;
        let (found, rest) = found.moved(&mut self.planner.source.graph);
        let own = self.sites("one", 0);
        let [_, sums] = self.at();
        let (mut kinds, mut needed) = (Vec::new(), BTreeSet::new());
        for piece in found {
            let place = kinds.len();
            let (mut share, mut second) = (None, None);
            let (form, rate) = match piece.form {
                Form::Site(a, slope) | Form::Noise(a, slope) => {
                    needed.insert(a);
                    (FamilyForm::Site(a), slope)
                }
                Form::Collective(a, slope, shares) => {
                    needed.insert(a);
                    share = Some(self.share(place, [&own, &sums], &shares));
                    (FamilyForm::Collective(a), slope)
                }
                Form::Product(both, factor) => {
                    needed.extend(both);
                    (FamilyForm::Product(both), factor)
                }
                Form::Pair(both, [slope, of_other]) => {
                    needed.extend(both);
                    second = Some(of_other);
                    (FamilyForm::Pair(both), slope)
                }
                Form::Exchange(rate) => (FamilyForm::Exchange, rate),
                Form::Still => (FamilyForm::Still, self.planner.source.graph.integer(0)),
                Form::Turn(direction) => {
                    kinds.push(self.flow(place, None, &direction)?);
                    continue;
                }
                Form::Force(push, moved) => {
                    kinds.push(self.flow(place, Some(push), &moved)?);
                    continue;
                }
            };
            let formula = "the speed along the flow of a piece";
            let mut arguments = vec![own.clone(), sums.clone()];
            // the rate has the coordinates of the site alone
            arguments.extend(self.behind());
            let mut with_other = arguments.clone();
            with_other.push(self.sites("other", 1));
            if second.is_some() {
                arguments = with_other.clone();
            }
            let mut of_piece = |label: &str, rate| {
                let kernel = Kernel::scalar("rate", formula, arguments.clone(), rate);
                self.function(&format!("{label} {place}"), &kernel)
            };
            let rate = of_piece("rate of piece", rate);
            let second = second.map(|slope| of_piece("rate of the second sites of piece", slope));
            let mut time_slope = |label: &str, value, arguments| {
                let formula = "what a piece changes with the time";
                let kernel = Kernel::scalar("time_slope", formula, arguments, value);
                self.function(&format!("{label} of piece {place}"), &kernel)
            };
            let (timed, by_sums) = match piece.timed {
                None => (None, None),
                Some(of) => (Some(of.each), of.of_sums),
            };
            let timed = timed.map(|each| time_slope("time slope", each, with_other));
            let by_sums =
                by_sums.map(|slope| time_slope("time slope by sums", slope, vec![sums.clone()]));
            kinds.push(FamilyPiece {
                offset: piece.offset,
                spans: piece.spans,
                form,
                rate,
                second,
                share,
                timed,
                timed_by_sums: by_sums,
            });
        }
        let actions = separable::actions(model.bracket.algebra()?);
        let mut turns = Vec::new();
        for a in needed {
            let blocks = actions[a].as_ref()?;
            let piece = action(&mut self.planner.source, a, blocks);
            let label = format!("turn about {}", model.coordinates[a].text);
            let function = self.function(&label, &piece.kernel?);
            turns.push((a, function, piece.updates));
        }
        let rest = rest.map(|rest| {
            let formula = "what H is beside its pieces";
            let kernel = Kernel::scalar("rest", formula, vec![sums], rest);
            self.function("rest", &kernel)
        });
        Some(FamilyPieces { kinds, turns, rest })
    }

    /// The coordinates of the first site of a piece, or of the second.
    fn sites(&self, name: &'static str, which: usize) -> Argument {
        let n = self.n();
        let symbols = (which * n..(which + 1) * n).map(Symbol::Coordinate);
        Argument {
            name,
            symbols: symbols.collect(),
        }
    }

    /// Coefficients and rates of noise, which stand behind the coordinates of all slots, in whose places stands one that nothing of a family reads.
    fn behind(&self) -> Option<Argument> {
        let family = self.family;
        let noisy = super::noises(self.planner.structure) > 0;
        let skipped = family.names.iter().map(|_| Symbol::Step);
        (!family.data.is_empty() || noisy).then(|| Argument {
            name: "at",
            symbols: skipped.chain(self.coefficients()).collect(),
        })
    }

    /// The flow of a force, by the coordinates behind it, or along an element of the algebra: `exp(t ad*_xi) mu`.
    fn flow(
        &mut self,
        place: usize,
        push: Option<super::Push>,
        entries: &[ExprId],
    ) -> Option<FamilyPiece> {
        let [_, sums] = self.at();
        let mut arguments = vec![self.sites("one", 0), sums];
        arguments.extend(self.behind());
        let source = &mut self.planner.source;
        let mut tape = Tape::new(source, FIRST);
        let moved = match push {
            Some(_) => entries.to_vec(),
            None => {
                let algebra = self.planner.structure.bracket.algebra()?;
                let closed = exponential::closed_form(&algebra.exact)?;
                let before = source.exponential.replace(closed);
                let time = source.graph.symbol(Symbol::Time);
                let element = entries.iter().map(|entry| {
                    let entry = source.graph.mul(time, *entry);
                    tape.define(source, entry)
                });
                let element: Vec<ExprId> = element.collect();
                let mu = (0..entries.len()).map(|a| source.graph.symbol(Symbol::Coordinate(a)));
                let mu: Vec<ExprId> = mu.collect();
                let moved = source.closed_function(&mut tape, (&element, &mu), 0);
                source.exponential = before;
                moved
            }
        };
        let formula = "the coordinates of a site behind the flow of a piece";
        let mut kernel = Kernel::vector(&source.graph, "flow", formula, arguments, &moved);
        kernel.task.definitions = tape.definitions().to_vec();
        let rate = self.function(&format!("flow of piece {place}"), &kernel);
        Some(FamilyPiece {
            offset: [0; AXES],
            spans: [None; AXES],
            form: FamilyForm::Flow(push),
            rate,
            second: None,
            share: None,
            timed: None,
            timed_by_sums: None,
        })
    }

    /// What a site adds to these sums.
    fn share(
        &mut self,
        piece: usize,
        [own, sums]: [&Argument; 2],
        shares: &[(usize, ExprId)],
    ) -> Function {
        let mut entries = vec![self.planner.source.graph.integer(0); self.family.sums.len()];
        for (k, share) in shares {
            entries[*k] = self.planner.source.graph.as_written(*share);
        }
        let formula = ("share", "what a site adds to the sums of a piece");
        let label = format!("share of piece {piece}");
        let mut arguments = vec![own.clone()];
        arguments.extend(Some(sums.clone()).filter(|_| !self.family.shared.is_empty()));
        self.vector(&label, formula, arguments, &entries)
    }
}
