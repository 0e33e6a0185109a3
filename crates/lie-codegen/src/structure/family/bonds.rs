//! The bonds of two sites: products of a coordinate of each, exchanges, and other functions of two coordinates.

use super::{Form, Piece, Search};
use crate::model::{SiteSum, apart};
use lie_symbolic::symbolic::{ExprId, Function, Node, Symbol};

impl Search<'_> {
    /// Whether a slope changes with a coordinate, also where its derivative by that is 0: the slope of `abs(x - y)` jumps.
    pub(super) fn depends(&mut self, slope: ExprId, place: usize) -> bool {
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
        let stand = [(places[0], stands_for[0]), (places[1], stands_for[1])];
        let timed = self.time_slope(density, &stand, one)?;
        let slots = &self.family.slots;
        self.found.push(Piece {
            offset: apart(&slots[other], &slots[one]),
            spans: self.spans(sum, one),
            form: Form::Pair(both, slopes),
            timed,
        });
        Ok(())
    }

    /// The products of coordinates of two of the sites of a summand; what is left without them. The coordinates that it is another
    /// function of are `done`.
    pub(super) fn bond(
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
        let offset = apart(&slots[other], &slots[one]);
        let spans = self.spans(sum, one);
        if let Some([common, rate]) = self.exchange(&mut factors) {
            let timed = self.time_slope_of_products(common, &[[0, 0], [1, 1], [2, 2]]);
            self.found.push(Piece {
                offset,
                spans,
                form: Form::Exchange(rate),
                timed,
            });
        }
        for (ab, factor) in factors {
            let timed = self.time_slope_of_products(factor, &[ab]);
            self.found.push(Piece {
                offset,
                spans,
                form: Form::Product(ab, factor),
                timed,
            });
        }
        Ok(rest)
    }

    /// The factor and the rate of an exchange that leaves fewer products than there were, which are taken out.
    fn exchange(&mut self, factors: &mut Vec<([usize; 2], ExprId)>) -> Option<[ExprId; 2]> {
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
        Some([common, self.graph.neg(rate)])
    }
}
