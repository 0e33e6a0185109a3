//! The codes of a family: those of one site.

use crate::code::Code;
use crate::compiled::CodeBuilder;
use crate::system::flows;
use lie_codegen::derive::Update;
use lie_codegen::plan::{Family, FamilyForm, FamilyPiece, Function, Push};
use lie_core::family::{Effects, Kind, Span};
use lie_core::lattice::AXES;
use std::collections::HashMap;

/// The codes of one site, and where its neighbours are.
#[derive(Debug)]
pub struct Codes {
    pub offsets: Vec<[isize; AXES]>,
    pub field: usize,
    pub act: Option<usize>,
    pub slopes: HashMap<(usize, usize), usize>,
    pub summands: usize,
    pub energy: usize,
    pub time_slope: Option<usize>,
    pub weights: usize,
    pub observables: Vec<usize>,
    /// What a bond adds to sums and to slopes.
    pub bonds: Option<[usize; 2]>,
    pub ad: usize,
    pub ad_star: usize,
    /// Of each Casimir the value and the gradient.
    pub casimirs: Vec<[usize; 2]>,
    pub kinds: Vec<Kind>,
    pub pieces: Vec<PieceCodes>,
    /// What H is beside its pieces.
    pub rest: Option<usize>,
}

/// The codes of a piece.
#[derive(Debug)]
pub struct PieceCodes {
    pub form: FamilyForm,
    pub rate: usize,
    /// Of the second sites of a function of two coordinates.
    pub second: Option<usize>,
    pub share: Option<usize>,
    /// The turns about its coordinates.
    pub turns: Vec<Turn>,
    /// The derivative by the time, of a site or a bond and of sums.
    pub timed: [Option<usize>; 2],
    pub effects: Effects,
}

/// The flow `exp(t ad*_(e_a))`.
#[derive(Clone, Debug)]
pub struct Turn {
    /// The coordinate a.
    pub coordinate: usize,
    pub code: usize,
    /// What is done with each result.
    pub updates: Vec<(usize, Update)>,
}

/// Over which sites a sum goes.
pub fn spans(spans: &[Option<(usize, usize)>; AXES]) -> [Span; AXES] {
    spans.map(|span| match span {
        None => Span::All,
        Some((first, left)) => Span::Within { first, left },
    })
}

fn offset(offset: [i64; AXES]) -> [isize; AXES] {
    offset.map(|distance| distance as isize)
}

fn effects(piece: &FamilyPiece) -> Effects {
    Effects {
        timed: piece.timed.is_some(),
        pushes: piece.push().is_some(),
        works: piece.push() == Some(Push::Friction),
    }
}

impl Codes {
    pub fn new(family: &Family, making: &mut CodeBuilder) -> Self {
        let (site, sums) = (family.coordinates.len(), family.totals());
        let mut kernel =
            |function: &Function, count| making.push(Code::from_kernel(function, count));
        let slopes = family.slopes.iter();
        let slopes = slopes
            .map(|(term, slot, function)| ((*term, *slot), kernel(function, site)))
            .collect();
        let casimirs = family.casimirs.iter();
        let casimirs = casimirs
            .map(|casimir| [kernel(&casimir.value, 1), kernel(&casimir.gradient, site)])
            .collect();
        let driven = family.driven.as_ref();
        let field = kernel(&family.field, site + driven.iter().len());
        let act = driven.map(|driven| kernel(&driven.act, site + 1));
        let [ad, ad_star] = [&family.ad, &family.ad_star].map(|function| kernel(function, site));
        let [summands, weights] =
            [&family.summands, &family.weights].map(|function| kernel(function, sums));
        let energy = kernel(&family.energy, 1);
        let time_slope = family.time_slope.as_ref().map(|slope| kernel(slope, 1));
        let bonds = family.bonds.as_ref();
        let bonds = bonds.map(|of| [kernel(&of.summands, sums), kernel(&of.slopes, 2 * site)]);
        let observables = family.observables.iter();
        let observables = observables
            .map(|observed| kernel(&observed.value, 1))
            .collect();
        let (mut kinds, mut pieces, mut rest) = (Vec::new(), Vec::new(), None);
        if let Some(of_family) = &family.pieces {
            let of_rest = of_family.rest.as_ref();
            rest = of_rest.map(|rest| making.push(Code::from_kernel(rest, 1)));
            let turns = of_family
                .turns
                .iter()
                .map(|(coordinate, function, updates)| {
                    let (code, updates) = flows::updates(function, updates, making);
                    let coordinate = *coordinate;
                    Turn {
                        coordinate,
                        code,
                        updates,
                    }
                });
            let turns: Vec<Turn> = turns.collect();
            let turns_of = |all: &[usize]| {
                let known = |a: &usize| turns.iter().find(|turn| turn.coordinate == *a).cloned();
                all.iter().filter_map(known).collect()
            };
            for piece in &of_family.kinds {
                kinds.push(Kind {
                    offset: offset(piece.offset),
                    spans: spans(&piece.spans),
                    collective: piece.share.is_some(),
                });
                let share = piece.share.as_ref();
                pieces.push(PieceCodes {
                    form: piece.form,
                    rate: making.push(Code::from_kernel(
                        &piece.rate,
                        match piece.form {
                            FamilyForm::Flow(_) => site,
                            _ => 1,
                        },
                    )),
                    second: (piece.second.as_ref())
                        .map(|rate| making.push(Code::from_kernel(rate, 1))),
                    share: share.map(|share| making.push(Code::from_kernel(share, sums))),
                    turns: match piece.form {
                        FamilyForm::Site(a) | FamilyForm::Collective(a) => turns_of(&[a]),
                        FamilyForm::Product(both) | FamilyForm::Pair(both) => turns_of(&both),
                        FamilyForm::Exchange | FamilyForm::Still | FamilyForm::Flow(_) => {
                            Vec::new()
                        }
                    },
                    timed: [&piece.timed, &piece.timed_by_sums].map(|slope| {
                        let slope = slope.as_ref();
                        slope.map(|slope| making.push(Code::from_kernel(slope, 1)))
                    }),
                    effects: effects(piece),
                });
            }
        }
        Self {
            offsets: family.offsets.iter().map(|o| offset(*o)).collect(),
            field,
            act,
            slopes,
            summands,
            energy,
            time_slope,
            observables,
            bonds,
            weights,
            ad,
            ad_star,
            casimirs,
            kinds,
            pieces,
            rest,
        }
    }
}
