//! The motion of a site: its field with all neighbours, and what acts on it.

use super::Driven;
use super::derivation::Derivation;
use crate::derive::{Argument, Source};
use crate::model::{self, slope_symbol};
use crate::plan::function::Function;
use lie_symbolic::symbolic::{ExprId, Symbol};

impl Derivation<'_, '_> {
    /// The slopes of all sums, and the motion of a site.
    pub(super) fn slopes_and_field(
        &mut self,
    ) -> (Vec<(usize, usize, Function)>, Function, Option<Driven>) {
        let (n, family) = (self.n(), self.family);
        let mut terms: Vec<Vec<ExprId>> = vec![Vec::new(); n];
        let mut slopes = Vec::new();
        for (k, sum) in family.sums.iter().enumerate() {
            for &slot in &sum.slots {
                let slope = self.slope(k, slot);
                let label = format!(
                    "slope of sum {k} by {}",
                    family.names[slot * n..(slot + 1) * n].join(", ")
                );
                let formula = (
                    "slope",
                    "`out = dF/dT_k ds_k/dmu`, at the site of the summand",
                );
                let at = self.at().to_vec();
                slopes.push((k, slot, self.vector(&label, formula, at, &slope)));
                let moved = self.moved(&slope, slot);
                terms
                    .iter_mut()
                    .zip(moved)
                    .for_each(|(all, one)| all.push(one));
            }
        }
        let source = &mut self.planner.source;
        let gradient: Vec<ExprId> = terms.iter().map(|terms| source.graph.sum(terms)).collect();
        let (motion, driven) = self.driven();
        let source = &mut self.planner.source;
        let field = match motion {
            None => {
                let mu = own(source, family, n);
                source.ad_star_of(&gradient, &mu)
            }
            Some(motion) => source.graph.substitute(&motion, &|symbol| {
                let mut slopes = (0..n).map(slope_symbol).zip(&gradient);
                slopes
                    .find(|(slope, _)| *slope == symbol)
                    .map(|(_, value)| *value)
            }),
        };
        let field: Vec<ExprId> = field.into_iter().map(|f| source.graph.tidy(f)).collect();
        let formula = match &driven {
            None => "`mu_i' = ad*_(dH/dmu_i) mu_i` of a site with all its neighbours",
            Some(_) => {
                "`mu_i' = ad*_xi mu_i + F` of a site with all its neighbours, and the power behind it"
            }
        };
        let at = self.at().to_vec();
        let field = self.vector("field of a site", ("field", formula), at, &field);
        (slopes, field, driven)
    }

    /// The motion of a site from dH/dmu there, and the power behind it, where something acts beside H.
    fn driven(&mut self) -> (Option<Vec<ExprId>>, Option<Driven>) {
        let (n, family, structure) = (self.n(), self.family, self.planner.structure);
        let Some(driving) = &structure.driving else {
            return (None, None);
        };
        let source = &mut self.planner.source;
        let mu = own(source, family, n);
        let slopes: Vec<Symbol> = (0..n).map(slope_symbol).collect();
        let xi: Vec<ExprId> = (slopes.iter().zip(&driving.damping))
            .map(|(slope, more)| {
                let (slope, more) = (source.graph.symbol(*slope), source.graph.as_written(*more));
                source.graph.add(slope, more)
            })
            .collect();
        let mut motion = source.ad_star_of(&xi, &mu);
        for (sum, force) in motion.iter_mut().zip(&driving.force) {
            let force = source.graph.as_written(*force);
            *sum = source.graph.add(*sum, force);
        }
        motion.push(source.graph.as_written(driving.damping[n]));
        let tidy: Vec<ExprId> = motion.iter().map(|f| source.graph.tidy(*f)).collect();
        let [at, weights] = self.at();
        let slope = Argument {
            name: "slope",
            symbols: slopes,
        };
        let formula = (
            "act",
            "`mu_i' = ad*_xi mu_i + F`, from `dH/dmu_i`, and the power behind it",
        );
        let mut arguments = vec![slope, at];
        arguments.extend(Some(weights).filter(|_| !family.shared.is_empty()));
        let act = self.vector("motion of a site", formula, arguments, &tidy);
        let driven = Driven {
            act,
            forced: driving.is_forced(&structure.graph),
            damped: driving.is_damped(&structure.graph),
            noises: driving.noises,
        };
        (Some(motion), Some(driven))
    }
}

/// The coordinates of the site itself.
fn own(source: &mut Source, family: &model::Family, n: usize) -> Vec<ExprId> {
    let places = family.own * n..(family.own + 1) * n;
    let symbols = places.map(|place| source.graph.symbol(Symbol::Coordinate(place)));
    symbols.collect()
}
