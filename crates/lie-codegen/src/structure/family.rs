//! The pieces of the Hamiltonian of a family whose flows are exact: functions of one coordinate, products of a coordinate of
//! each of two sites and other functions of them, on so(3) the exchange of two spins, and functions of sums of functions of one coordinate;
//! and behind them what acts on each site, where its flow is exact.

mod acting;
mod bonds;
mod timed;

use std::array::from_fn;
use std::collections::BTreeMap;

use crate::model::{Family, Model, SiteSum, data_number};
use crate::structure::separable;
use crate::structure::spins::Spin;
use lie_core::lattice::AXES;
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};

/// A piece, the same for all sites that it goes over.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Piece {
    /// The distance of the second site of a bond; 0 of a function of one.
    pub offset: [i64; AXES],
    /// Where the first sites are.
    pub spans: [Option<(usize, usize)>; AXES],
    /// What it is.
    pub form: Form,
    /// Its derivative by the time, where it depends on it by itself.
    pub timed: Option<TimeSlope>,
}

/// The derivative of a piece by the time.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TimeSlope {
    /// What a site or a bond adds, in the symbols of [`Form`].
    pub each: ExprId,
    /// What a function of sums has beside that.
    pub of_sums: Option<ExprId>,
}

/// What a piece is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Form {
    /// A function of a coordinate, with its derivative; coordinate a of the site is `Symbol::Coordinate(a)`, and coefficients
    /// that differ from site to site are those around it.
    Site(usize, ExprId),
    /// A function of sums over functions of one coordinate, all of which its flow keeps: its derivative by that coordinate of a
    /// site, in which the sums are the symbols that they are in H, and what a site adds to each of these sums.
    Collective(usize, ExprId, Vec<(usize, ExprId)>),
    /// A multiple of a product of a coordinate of each site; its coefficients are those around the first.
    Product([usize; 2], ExprId),
    /// A function of a coordinate of each site, both of which its flow keeps, by its derivatives; the coordinates of the second site
    /// stand behind those of the first.
    Pair([usize; 2], [ExprId; 2]),
    /// `s_1' = rate (s_1 + s_2) x s_1`, and the opposite of that for the other spin.
    Exchange(ExprId),
    /// A function that moves no site.
    Still,
    /// Noise along a coordinate, with what it has in the place of the derivative of a function of it.
    Noise(usize, ExprId),
    /// Noise along another direction: the element of the algebra.
    Turn(Vec<ExprId>),
    /// A force: the coordinates of the site behind it, over `Symbol::Time`.
    Force(Push, Vec<ExprId>),
}

/// Which force.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Push {
    /// Friction and constant forces, which do work.
    Friction,
    /// Noise.
    Noise,
}

/// The pieces of a Hamiltonian.
#[derive(Clone, Debug)]
pub struct Pieces {
    /// The arena of their expressions, which has those of the model.
    pub graph: Graph,
    /// The pieces.
    pub pieces: Vec<Piece>,
    /// What H is beside them, where that changes with the time: a function of it and of inputs.
    pub rest: Option<ExprId>,
}

impl Pieces {
    /// The pieces in another arena, and the rest.
    pub fn moved(&self, to: &mut Graph) -> (Vec<Piece>, Option<ExprId>) {
        let (mut all, mut rest) = (self.pieces.clone(), self.rest);
        let mut ids: Vec<&mut ExprId> = rest.iter_mut().collect();
        for piece in &mut all {
            match &mut piece.form {
                Form::Site(_, id)
                | Form::Product(_, id)
                | Form::Exchange(id)
                | Form::Noise(_, id) => ids.push(id),
                Form::Pair(_, both) => ids.extend(both),
                Form::Collective(_, id, shares) => {
                    ids.push(id);
                    ids.extend(shares.iter_mut().map(|(_, share)| share));
                }
                Form::Still => {}
                Form::Turn(entries) | Form::Force(_, entries) => ids.extend(entries),
            }
            if let Some(TimeSlope { each, of_sums }) = &mut piece.timed {
                ids.push(each);
                ids.extend(of_sums);
            }
        }
        let roots: Vec<ExprId> = ids.iter().map(|id| **id).collect();
        for (id, image) in ids.into_iter().zip(to.import(&self.graph, &roots)) {
            *id = image;
        }
        (all, rest)
    }
}

impl Piece {
    /// What it is, in the names of the coordinates.
    pub fn describe(&self, model: &Model) -> String {
        let name = |a: usize| &model.coordinates[a].text;
        let straight = self.offset.iter().position(|distance| *distance != 0);
        let offset = &self.offset[straight.unwrap_or(AXES - 1)..];
        let at: Vec<String> = offset
            .iter()
            .map(|distance| format!("{distance:+}"))
            .collect();
        let at = at.join(",");
        match &self.form {
            Form::Site(a, _) => format!("f({})", name(*a)),
            Form::Collective(a, ..) => format!("F(sums over {})", name(*a)),
            Form::Product([a, b], _) => format!("{}*{}[{at}]", name(*a), name(*b)),
            Form::Pair([a, b], _) => format!("f({}, {}[{at}])", name(*a), name(*b)),
            Form::Exchange(_) => format!("exchange with [{at}]"),
            Form::Still => "f(t)".to_owned(),
            Form::Noise(a, _) => format!("noise along {}", name(*a)),
            Form::Turn(_) => "noise along a direction".to_owned(),
            Form::Force(Push::Friction, _) => "friction".to_owned(),
            Form::Force(Push::Noise, _) => "noise as a force".to_owned(),
        }
    }
}

/// The pieces, or why H does not consist of such.
///
/// # Errors
/// The reason.
pub fn pieces(model: &Model, family: &Family, spins: Option<&[Spin]>) -> Result<Pieces, String> {
    let mut graph = model.graph.clone();
    let mut search = Search {
        model,
        family,
        spins,
        graph: &mut graph,
        found: Vec::new(),
    };
    search.collective()?;
    let moving = family.sums.iter().enumerate();
    for (k, sum) in moving.filter(|(_, sum)| sum.moves) {
        if sum.over_bonds {
            return Err("bonds between any two sites are in no order".into());
        }
        search.sum(k, sum)?;
    }
    let rest = search.rest()?;
    search.acting()?;
    let found = search.found;
    let actions = model.bracket.algebra().map(separable::actions);
    let actions = actions.unwrap_or_default();
    let needed = found.iter().flat_map(|piece| match &piece.form {
        Form::Site(a, _) | Form::Collective(a, ..) | Form::Noise(a, _) => vec![*a],
        Form::Product(both, _) | Form::Pair(both, _) => both.to_vec(),
        Form::Exchange(_) | Form::Still | Form::Turn(_) | Form::Force(..) => Vec::new(),
    });
    for a in needed {
        if actions.get(a).is_none_or(Option::is_none) {
            let name = &model.coordinates[a].text;
            return Err(format!(
                "the flow of a function of `{name}` has no closed form"
            ));
        }
    }
    Ok(Pieces {
        graph,
        pieces: found,
        rest,
    })
}

struct Search<'a> {
    model: &'a Model,
    family: &'a Family,
    spins: Option<&'a [Spin]>,
    graph: &'a mut Graph,
    found: Vec<Piece>,
}

impl Search<'_> {
    fn n(&self) -> usize {
        self.model.dimension()
    }

    fn symbol_of_sum(&self, k: usize) -> Symbol {
        Symbol::Coordinate(self.family.names.len() + k)
    }

    /// `dF/dT_k`
    fn weight(&mut self, k: usize) -> ExprId {
        let symbol = self.symbol_of_sum(k);
        self.graph.derivative(self.family.energy, symbol)
    }

    /// Whether `dF/dT_k` depends on another sum, or on its own.
    fn mixed(&mut self, k: usize, other: usize) -> bool {
        let (weight, symbol) = (self.weight(k), self.symbol_of_sum(other));
        let mixed = self.graph.derivative(weight, symbol);
        !self.graph.is_zero(mixed)
    }

    /// The functions of sums that are not linear in them: those that belong together are one piece.
    fn collective(&mut self) -> Result<(), String> {
        let count = self.family.sums.len();
        let mut left: Vec<usize> = (0..count)
            .filter(|k| (0..count).any(|other| self.mixed(*k, other)))
            .collect();
        while let Some(first) = left.pop() {
            let (mut group, mut next) = (vec![first], 0);
            while let Some(&k) = group.get(next) {
                let (with, without): (Vec<usize>, Vec<usize>) =
                    left.iter().partition(|other| self.mixed(k, **other));
                group.extend(with);
                left = without;
                next += 1;
            }
            group.sort_unstable();
            let piece = self.function_of_sums(&group)?;
            self.found.push(piece);
        }
        Ok(())
    }

    /// The piece that is a function of these sums.
    fn function_of_sums(&mut self, group: &[usize]) -> Result<Piece, String> {
        let n = self.n();
        let (mut known, mut slope, mut shares) = (None, self.graph.integer(0), Vec::new());
        for &k in group {
            let sum = &self.family.sums[k];
            let places = self.graph.coordinates(sum.summand);
            let [place] = places.as_slice() else {
                return Err("H is a function of a sum, not linear in it, whose summand depends on more than one coordinate".into());
            };
            let symbols = self.graph.symbols(sum.summand);
            if symbols
                .into_iter()
                .any(|symbol| data_number(symbol).is_some())
            {
                return Err("H is a function of a sum, not linear in it, whose coefficients differ from site to site".into());
            }
            let (slot, a) = (place / n, place % n);
            let spans = self.spans(sum, slot);
            let (coordinate, of_all) = *known.get_or_insert((a, spans));
            if coordinate != a {
                let names = [coordinate, a].map(|a| &self.model.coordinates[a].text);
                return Err(format!(
                    "H mixes sums over `{}` and over `{}`",
                    names[0], names[1]
                ));
            }
            if of_all != spans {
                return Err("H mixes sums over different sites".into());
            }
            let (place, own) = (*place, self.graph.symbol(Symbol::Coordinate(a)));
            let share = self.graph.substitute(&[sum.summand], &|symbol| {
                (symbol == Symbol::Coordinate(place)).then_some(own)
            })[0];
            let by_site = self.graph.derivative(share, Symbol::Coordinate(a));
            let weight = self.weight(k);
            let term = self.graph.mul(weight, by_site);
            slope = self.graph.add(slope, term);
            shares.push((k, share));
        }
        let (a, spans) = known.unwrap_or_default();
        Ok(Piece {
            offset: [0; AXES],
            spans,
            timed: self.time_slope_of_sums(&shares)?,
            form: Form::Collective(a, slope, shares),
        })
    }

    fn sum(&mut self, k: usize, sum: &SiteSum) -> Result<(), String> {
        let weight = self.weight(k);
        if !self.graph.coordinates(weight).is_empty() {
            // a function of sums is a piece of its own
            return Ok(());
        }
        let mut density = self.graph.mul(weight, sum.summand);
        let mut done = Vec::new();
        for (place, &one) in sum.slots.iter().enumerate() {
            for &other in &sum.slots[place + 1..] {
                density = self.bond(density, [one, other], sum, &mut done)?;
            }
        }
        for &slot in &sum.slots {
            self.site(density, slot, sum, &done)?;
        }
        self.still(density, sum)
    }

    /// An expression at the site of a summand, its coefficients as those around the site in a slot.
    fn around(&mut self, expression: ExprId, slot: usize) -> ExprId {
        let symbols = self.graph.symbols(expression).into_iter();
        let moved = symbols.filter_map(|symbol| {
            let moved = self.family.data_from(symbol, slot)?;
            Some((symbol, self.graph.symbol(moved)))
        });
        let moved: BTreeMap<Symbol, ExprId> = moved.collect();
        self.graph
            .substitute(&[expression], &|symbol| moved.get(&symbol).copied())[0]
    }

    /// The spans of a sum as those of the site in a slot.
    fn spans(&self, sum: &SiteSum, slot: usize) -> [Option<(usize, usize)>; AXES] {
        let distance = self.family.slots[slot];
        let moved = |axis: usize| {
            let (first, left) = sum.spans[axis]?;
            let moved = |count: usize, by: i64| usize::try_from(count as i64 + by).unwrap_or(0);
            Some((moved(first, distance[axis]), moved(left, -distance[axis])))
        };
        from_fn(moved)
    }

    /// The functions of single coordinates of the site in a slot.
    fn site(
        &mut self,
        density: ExprId,
        slot: usize,
        sum: &SiteSum,
        done: &[usize],
    ) -> Result<(), String> {
        let n = self.n();
        let spans = self.spans(sum, slot);
        for a in 0..n {
            let place = slot * n + a;
            if done.contains(&place) {
                continue;
            }
            let slope = self.graph.derivative(density, Symbol::Coordinate(place));
            for other in self.graph.coordinates(slope) {
                if other != place && self.depends(slope, other) {
                    let names = &self.family.names;
                    return Err(format!("H mixes `{}` and `{}`", names[place], names[other]));
                }
            }
            let (own, zero) = (
                self.graph.symbol(Symbol::Coordinate(a)),
                self.graph.integer(0),
            );
            let slope = self.graph.substitute(&[slope], &|symbol| match symbol {
                Symbol::Coordinate(p) if p == place => Some(own),
                Symbol::Coordinate(_) => Some(zero),
                _ => None,
            })[0];
            if self.graph.is_zero(slope) {
                continue;
            }
            let slope = self.around(slope, slot);
            let timed = self.time_slope(density, &[(place, a)], slot)?;
            let known = self
                .found
                .iter_mut()
                .find_map(|piece| match &mut piece.form {
                    Form::Site(b, slope) if *b == a && piece.spans == spans => {
                        Some((slope, &mut piece.timed))
                    }
                    _ => None,
                });
            match known {
                Some((known, known_timed)) => {
                    *known = self.graph.add(*known, slope);
                    match (known_timed, timed) {
                        (Some(known), Some(more)) => {
                            known.each = self.graph.add(known.each, more.each);
                        }
                        (known, more) => *known = known.take().or(more),
                    }
                }
                None => self.found.push(Piece {
                    offset: [0; AXES],
                    spans,
                    form: Form::Site(a, slope),
                    timed,
                }),
            }
        }
        Ok(())
    }
}
