//! What pieces change with the time, which moves its momentum.

use super::{Form, Piece, Search, TimeSlope};
use crate::model::{SiteSum, shared_symbol};
use lie_core::lattice::AXES;
use lie_symbolic::symbolic::{ExprId, Symbol};

/// The symbol of the time.
const TIME: usize = 0;

impl Search<'_> {
    /// The derivative by the time; none where that is 0.
    fn by_time(&mut self, value: ExprId) -> Option<ExprId> {
        let slope = self.graph.derivative(value, shared_symbol(TIME));
        (!self.graph.is_zero(slope)).then_some(slope)
    }

    /// An expression with some coordinates under other symbols and 0 for all others.
    fn alone(&mut self, value: ExprId, stand: &[(usize, usize)]) -> ExprId {
        let zero = self.graph.integer(0);
        let symbols = stand.iter().map(|(place, symbol)| {
            let symbol = self.graph.symbol(Symbol::Coordinate(*symbol));
            (*place, symbol)
        });
        let symbols: Vec<(usize, ExprId)> = symbols.collect();
        self.graph.substitute(&[value], &|symbol| match symbol {
            Symbol::Coordinate(place) => {
                let known = symbols.iter().find(|(known, _)| *known == place);
                Some(known.map_or(zero, |(_, symbol)| *symbol))
            }
            _ => None,
        })[0]
    }

    /// The slope, unless it has no value where coordinates are 0.
    fn checked(&self, slope: ExprId) -> Result<ExprId, String> {
        let defaults = self.model.defaults();
        let value = self.graph.evaluate(slope, &|symbol| match symbol {
            Symbol::Parameter(p) => defaults[p],
            Symbol::Coordinate(place) => 0.25 + 1.0 / (3.0 + place as f64),
            _ => 0.375,
        });
        match value.is_finite() {
            true => Ok(slope),
            false => Err(
                "what H changes with the time has no value where coordinates are 0, so that its pieces are not told apart"
                    .into(),
            ),
        }
    }

    /// What the part of a density that depends on some coordinates changes with the time, these under other symbols, at the site in a slot.
    pub(super) fn time_slope(
        &mut self,
        density: ExprId,
        stand: &[(usize, usize)],
        slot: usize,
    ) -> Result<Option<TimeSlope>, String> {
        let Some(slope) = self.by_time(density) else {
            return Ok(None);
        };
        let [with, without] = [stand, &[]].map(|stand| self.alone(slope, stand));
        let slope = self.graph.sub(with, without);
        if self.graph.is_zero(slope) {
            return Ok(None);
        }
        let each = self.around(slope, slot);
        Ok(Some(TimeSlope {
            each: self.checked(each)?,
            of_sums: None,
        }))
    }

    /// The same of a factor times the sum of products of a coordinate of the first site and one of the second.
    pub(super) fn time_slope_of_products(
        &mut self,
        factor: ExprId,
        products: &[[usize; 2]],
    ) -> Option<TimeSlope> {
        let slope = self.by_time(factor)?;
        let n = self.n();
        let products = products.iter().map(|[a, b]| {
            let both = [*a, n + b].map(|place| self.graph.symbol(Symbol::Coordinate(place)));
            self.graph.product(&both)
        });
        let products: Vec<ExprId> = products.collect();
        let sum = self.graph.sum(&products);
        Some(TimeSlope {
            each: self.graph.mul(slope, sum),
            of_sums: None,
        })
    }

    /// The same of a function of sums, of which each site has these shares.
    pub(super) fn time_slope_of_sums(
        &mut self,
        shares: &[(usize, ExprId)],
    ) -> Result<Option<TimeSlope>, String> {
        let stand = shares.iter().map(|(k, _)| self.symbol_of_sum(*k));
        let stand: Vec<(usize, usize)> = stand
            .filter_map(|symbol| match symbol {
                Symbol::Coordinate(place) => Some((place, place)),
                _ => None,
            })
            .collect();
        let of_sums = match self.by_time(self.family.energy) {
            None => None,
            Some(slope) => {
                let [with, without] = [&stand[..], &[]].map(|stand| self.alone(slope, stand));
                let slope = self.graph.sub(with, without);
                Some(self.checked(slope)?).filter(|slope| !self.graph.is_zero(*slope))
            }
        };
        let mut terms = Vec::new();
        for (k, share) in shares {
            if let Some(slope) = self.by_time(*share) {
                let weight = self.weight(*k);
                terms.push(self.graph.mul(weight, slope));
            }
        }
        let each = self.graph.sum(&terms);
        let moves = !self.graph.is_zero(each) || of_sums.is_some();
        Ok(moves.then_some(TimeSlope { each, of_sums }))
    }

    /// What a summand is where all coordinates are 0, as a piece where that changes with the time.
    pub(super) fn still(&mut self, density: ExprId, sum: &SiteSum) -> Result<(), String> {
        let Some(slope) = self.by_time(density) else {
            return Ok(());
        };
        let each = self.alone(slope, &[]);
        if self.graph.is_zero(each) {
            return Ok(());
        }
        let timed = TimeSlope {
            each: self.checked(each)?,
            of_sums: None,
        };
        self.found.push(Piece {
            offset: [0; AXES],
            spans: sum.spans,
            form: Form::Still,
            timed: Some(timed),
        });
        Ok(())
    }

    /// What H is where all sums are 0, where that changes with the time.
    pub(super) fn rest(&mut self) -> Result<Option<ExprId>, String> {
        let Some(slope) = self.by_time(self.family.energy) else {
            return Ok(None);
        };
        let slope = self.alone(slope, &[]);
        if self.graph.is_zero(slope) {
            return Ok(None);
        }
        self.checked(slope)?;
        Ok(Some(self.alone(self.family.energy, &[])))
    }
}
