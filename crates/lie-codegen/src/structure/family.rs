//! The pieces of the Hamiltonian of a family whose flows are exact: functions of one coordinate, products of a coordinate of
//! each of two sites and other functions of them, on so(3) the exchange of two spins, and functions of sums of functions of one coordinate.

use std::collections::BTreeMap;

use crate::model::{Family, Model, SiteSum, data_number};
use crate::structure::separable;
use crate::structure::spins::Spin;
use lie_symbolic::symbolic::{ExprId, Function, Graph, Node, Symbol};

/// A piece, the same for all sites that it goes over.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Piece {
    /// The distance of the second site of a bond; 0 of a function of one.
    pub offset: [i64; 2],
    /// Where the first sites are.
    pub spans: [Option<(usize, usize)>; 2],
    /// What it is.
    pub form: Form,
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
}

/// The pieces of a Hamiltonian.
#[derive(Clone, Debug)]
pub struct Pieces {
    /// The arena of their expressions, which has those of the model.
    pub graph: Graph,
    /// The pieces.
    pub pieces: Vec<Piece>,
}

impl Pieces {
    /// The pieces in another arena.
    pub fn moved(&self, to: &mut Graph) -> Vec<Piece> {
        let mut all = self.pieces.clone();
        let mut ids: Vec<&mut ExprId> = Vec::new();
        for piece in &mut all {
            match &mut piece.form {
                Form::Site(_, id) | Form::Product(_, id) | Form::Exchange(id) => ids.push(id),
                Form::Pair(_, both) => ids.extend(both),
                Form::Collective(_, id, shares) => {
                    ids.push(id);
                    ids.extend(shares.iter_mut().map(|(_, share)| share));
                }
            }
        }
        let roots: Vec<ExprId> = ids.iter().map(|id| **id).collect();
        for (id, image) in ids.into_iter().zip(to.import(&self.graph, &roots)) {
            *id = image;
        }
        all
    }
}

impl Piece {
    /// What it is, in the names of the coordinates.
    pub fn describe(&self, model: &Model) -> String {
        let name = |a: usize| &model.coordinates[a].text;
        let at = match self.offset {
            [0, right] => format!("{right:+}"),
            [down, right] => format!("{down:+},{right:+}"),
        };
        match &self.form {
            Form::Site(a, _) => format!("f({})", name(*a)),
            Form::Collective(a, ..) => format!("F(sums over {})", name(*a)),
            Form::Product([a, b], _) => format!("{}*{}[{at}]", name(*a), name(*b)),
            Form::Pair([a, b], _) => format!("f({}, {}[{at}])", name(*a), name(*b)),
            Form::Exchange(_) => format!("exchange with [{at}]"),
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
    for (k, sum) in family.sums.iter().enumerate() {
        search.sum(k, sum)?;
    }
    let found = search.found;
    let actions = model.bracket.algebra().map(separable::actions);
    let actions = actions.unwrap_or_default();
    let needed = found.iter().flat_map(|piece| match &piece.form {
        Form::Site(a, _) | Form::Collective(a, ..) => vec![*a],
        Form::Product(both, _) | Form::Pair(both, _) => both.to_vec(),
        Form::Exchange(_) => Vec::new(),
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
            offset: [0, 0],
            spans,
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
        Ok(())
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
    fn spans(&self, sum: &SiteSum, slot: usize) -> [Option<(usize, usize)>; 2] {
        let distance = self.family.slots[slot];
        let moved = |axis: usize| {
            let (first, left) = sum.spans[axis]?;
            let moved = |count: usize, by: i64| usize::try_from(count as i64 + by).unwrap_or(0);
            Some((moved(first, distance[axis]), moved(left, -distance[axis])))
        };
        [moved(0), moved(1)]
    }

    /// Whether a slope changes with a coordinate, also where its derivative by that is 0: the slope of `abs(x - y)` jumps.
    fn depends(&mut self, slope: ExprId, place: usize) -> bool {
        let symbol = Symbol::Coordinate(place);
        let change = self.graph.derivative(slope, symbol);
        if !self.graph.is_zero(change) {
            return true;
        }
        let parts = self.graph.dependencies(&[slope]).into_iter();
        let mut conditions = parts.filter_map(|part| match self.graph.node(part) {
            Node::Call(Function::Below, arguments) => Some(arguments[0]),
            _ => None,
        });
        conditions.any(|condition| self.graph.symbols(condition).contains(&symbol))
    }

    /// The function of two coordinates that a summand contains, if no other coordinate is mixed with these.
    fn pair(&mut self, density: ExprId, places: [usize; 2], sum: &SiteSum) -> Result<(), String> {
        let n = self.n();
        let [one, other] = places.map(|place| place / n);
        let both = places.map(|place| place % n);
        let slopes = places.map(|place| self.graph.derivative(density, Symbol::Coordinate(place)));
        for slope in slopes {
            let others = self.graph.coordinates(slope).into_iter();
            let mut others = others.filter(|place| !places.contains(place));
            if let Some(third) = others.find(|place| self.depends(slope, *place)) {
                let names = [places[0], places[1], third].map(|place| &self.family.names[place]);
                return Err(format!(
                    "`{}`, `{}` and `{}` are coupled by more than products",
                    names[0], names[1], names[2]
                ));
            }
        }
        let zero = self.graph.integer(0);
        let stands_for = [both[0], n + both[1]];
        let symbols = stands_for.map(|place| self.graph.symbol(Symbol::Coordinate(place)));
        let slopes = self.graph.substitute(&slopes, &|symbol| match symbol {
            Symbol::Coordinate(place) if place == places[0] => Some(symbols[0]),
            Symbol::Coordinate(place) if place == places[1] => Some(symbols[1]),
            // the slopes do not depend on the others
            Symbol::Coordinate(_) => Some(zero),
            _ => None,
        });
        let slopes = [slopes[0], slopes[1]].map(|slope| self.around(slope, one));
        let slots = &self.family.slots;
        self.found.push(Piece {
            offset: [
                slots[other][0] - slots[one][0],
                slots[other][1] - slots[one][1],
            ],
            spans: self.spans(sum, one),
            form: Form::Pair(both, slopes),
        });
        Ok(())
    }

    /// The products of coordinates of two of the sites of a summand; what is left without them. The coordinates that it is another
    /// function of are `done`.
    fn bond(
        &mut self,
        density: ExprId,
        [one, other]: [usize; 2],
        sum: &SiteSum,
        done: &mut Vec<usize>,
    ) -> Result<ExprId, String> {
        let n = self.n();
        let mut rest = density;
        let mut factors = Vec::new();
        for a in 0..n {
            let slope = self
                .graph
                .derivative(density, Symbol::Coordinate(one * n + a));
            for b in 0..n {
                let factor = self
                    .graph
                    .derivative(slope, Symbol::Coordinate(other * n + b));
                let places = [one * n + a, other * n + b];
                let product = !self.graph.is_zero(factor);
                if !product {
                    let back = self
                        .graph
                        .derivative(density, Symbol::Coordinate(places[1]));
                    if !self.depends(slope, places[1]) && !self.depends(back, places[0]) {
                        continue;
                    }
                }
                if !product || !self.graph.coordinates(factor).is_empty() {
                    self.pair(density, places, sum)?;
                    done.extend(places);
                    continue;
                }
                let product =
                    [one * n + a, other * n + b].map(|p| self.graph.symbol(Symbol::Coordinate(p)));
                let product = self.graph.product(&[factor, product[0], product[1]]);
                rest = self.graph.sub(rest, product);
                factors.push(([a, b], self.around(factor, one)));
            }
        }
        let slots = &self.family.slots;
        let offset = [
            slots[other][0] - slots[one][0],
            slots[other][1] - slots[one][1],
        ];
        let spans = self.spans(sum, one);
        let exchange = self.exchange(&mut factors);
        let forms = exchange.into_iter().map(Form::Exchange);
        let products = factors
            .into_iter()
            .map(|(ab, factor)| Form::Product(ab, factor));
        let forms: Vec<Form> = forms.chain(products).collect();
        self.found.extend(forms.into_iter().map(|form| Piece {
            offset,
            spans,
            form,
        }));
        Ok(rest)
    }

    /// The rate of an exchange that leaves fewer products than there were, which are taken out.
    fn exchange(&mut self, factors: &mut Vec<([usize; 2], ExprId)>) -> Option<ExprId> {
        let [spin] = self.spins? else {
            return None;
        };
        let zero = self.graph.integer(0);
        let diagonal: [ExprId; 3] = std::array::from_fn(|a| {
            let found = factors.iter().find(|(ab, _)| *ab == [a, a]);
            found.map_or(zero, |(_, factor)| *factor)
        });
        let common = [(0, 1), (0, 2), (1, 2)]
            .into_iter()
            .find(|(a, b)| diagonal[*a] == diagonal[*b] && diagonal[*a] != zero)
            .map(|(a, _)| diagonal[a])?;
        factors.retain(|([a, b], _)| a != b);
        for (a, factor) in diagonal.into_iter().enumerate() {
            let rest = self.graph.sub(factor, common);
            if !self.graph.is_zero(rest) {
                factors.push(([a, a], rest));
            }
        }
        let rate = self.graph.mul(common, spin.scale);
        Some(self.graph.neg(rate))
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
            let known = self
                .found
                .iter_mut()
                .find_map(|piece| match &mut piece.form {
                    Form::Site(b, slope) if *b == a && piece.spans == spans => Some(slope),
                    _ => None,
                });
            match known {
                Some(known) => *known = self.graph.add(*known, slope),
                None => self.found.push(Piece {
                    offset: [0, 0],
                    spans,
                    form: Form::Site(a, slope),
                }),
            }
        }
        Ok(())
    }
}
