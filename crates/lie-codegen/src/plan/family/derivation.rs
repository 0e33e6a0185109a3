//! What is derived for a family: the kernels of one site.

use std::collections::BTreeMap;

use super::{Data, Family, SiteCasimir, Sum};
use crate::derive::{Argument, Kernel, Source};
use crate::model::{self, apart, data_symbol, shared_symbol};
use crate::plan::constants::Table;
use crate::plan::function::Function;
use crate::plan::planner::{Planner, described};
use lie_symbolic::symbolic::{ExprId, Symbol};
use lie_syntax::ast::BONDS;

/// The derivation of the kernels.
pub(super) struct Derivation<'p, 'm> {
    pub(super) planner: &'p mut Planner<'m>,
    pub(super) family: &'m model::Family,
    /// `dF/dT_k`: an expression in the parameters, or the symbol of a weight.
    pub(super) weights: Vec<ExprId>,
    /// `dF/dT_k` where it depends on the state, else 0.
    mean: Vec<ExprId>,
}

impl<'p, 'm> Derivation<'p, 'm> {
    pub(super) fn new(planner: &'p mut Planner<'m>, family: &'m model::Family) -> Self {
        let graph = &mut planner.source.graph;
        let energy = graph.as_written(family.energy);
        let (mut weights, mut mean) = (Vec::new(), Vec::new());
        for k in 0..family.sums.len() {
            let symbol = Symbol::Coordinate(family.names.len() + k);
            let slope = graph.derivative(energy, symbol);
            let symbols = graph.symbols(slope);
            let varies = symbols.iter().any(|s| matches!(s, Symbol::Coordinate(_)));
            let zero = graph.integer(0);
            weights.push(if varies { graph.symbol(symbol) } else { slope });
            mean.push(if varies { slope } else { zero });
        }
        Self {
            planner,
            family,
            weights,
            mean,
        }
    }

    pub(super) fn n(&self) -> usize {
        self.planner.source.dimension
    }

    /// The coefficients, and the rates of Wiener processes.
    pub(super) fn coefficients(&self) -> impl Iterator<Item = Symbol> + use<> {
        let first = self.family.data_names.len();
        let rates = first..first + super::noises(self.planner.structure);
        (0..self.family.data_places.len())
            .chain(rates)
            .map(data_symbol)
    }

    pub(super) fn at(&self) -> [Argument; 2] {
        let places = 0..self.family.names.len();
        let sums = places.end..places.end + self.family.sums.len();
        [
            Argument {
                name: "at",
                symbols: places
                    .map(Symbol::Coordinate)
                    .chain(self.coefficients())
                    .collect(),
            },
            Argument {
                name: "weights",
                symbols: sums
                    .map(Symbol::Coordinate)
                    .chain((0..self.family.shared.len()).map(shared_symbol))
                    .collect(),
            },
        ]
    }

    pub(super) fn function(&mut self, label: &str, kernel: &Kernel) -> Function {
        let label = label.to_owned();
        self.planner.labelled(label, kernel, &mut Table::default())
    }

    pub(super) fn vector(
        &mut self,
        label: &str,
        (name, formula): (&'static str, &'static str),
        arguments: Vec<Argument>,
        entries: &[ExprId],
    ) -> Function {
        let kernel = Kernel::vector(
            &self.planner.source.graph,
            name,
            formula,
            arguments,
            entries,
        );
        self.function(label, &kernel)
    }

    /// The derivative of a summand by the coordinates in a slot, times the weight of its sum.
    pub(super) fn slope(&mut self, k: usize, slot: usize) -> Vec<ExprId> {
        let (n, weight) = (self.n(), self.weights[k]);
        let graph = &mut self.planner.source.graph;
        let summand = graph.as_written(self.family.sums[k].summand);
        let places = slot * n..(slot + 1) * n;
        places
            .map(|place| {
                let slope = graph.derivative(summand, Symbol::Coordinate(place));
                graph.mul(weight, slope)
            })
            .collect()
    }

    /// The expressions with each site moved, so that the one in `slot` comes to stand at the site itself.
    pub(super) fn moved(&mut self, expressions: &[ExprId], slot: usize) -> Vec<ExprId> {
        let (n, slots) = (self.n(), &self.family.slots);
        let place = |symbol: Symbol| match symbol {
            Symbol::Coordinate(place) if place < n * slots.len() => {
                let moved = apart(&slots[place / n], &slots[slot]);
                let moved = slots.iter().position(|s| *s == moved)?;
                Some(Symbol::Coordinate(moved * n + place % n))
            }
            symbol => self.family.data_from(symbol, slot),
        };
        let graph = &mut self.planner.source.graph;
        let symbols = expressions.iter().flat_map(|e| graph.symbols(*e));
        let symbols: Vec<Symbol> = symbols.collect();
        let mut targets: BTreeMap<Symbol, ExprId> = BTreeMap::new();
        for symbol in symbols {
            if let Some(target) = place(symbol) {
                targets.insert(symbol, graph.symbol(target));
            }
        }
        graph.substitute(expressions, &|symbol| targets.get(&symbol).copied())
    }

    pub(super) fn family(mut self) -> Family {
        let family = self.family;
        let (slopes, field, driven) = self.slopes_and_field();
        let summands: Vec<ExprId> = family
            .sums
            .iter()
            .map(|sum| match sum.over_bonds {
                true => self.planner.source.graph.integer(0),
                false => self.planner.source.graph.as_written(sum.summand),
            })
            .collect();
        let bonds = self.bonds();
        let at = self.at().to_vec();
        let formula = ("summands", "`out_k = s_k(mu_i, …)`");
        let summands = self.vector("summands", formula, at, &summands);
        let energy = self.planner.source.graph.as_written(family.energy);
        let formula = "`H = F(T_1, …)`, a function of the sums over all sites";
        let energy = Kernel::scalar("energy", formula, self.at().to_vec(), energy);
        let energy = self.function("energy", &energy);
        let time_slope = self.time_slope();
        let mean = self.mean.clone();
        let formula = ("weights", "`out_k = dF/dT_k`");
        let at = self.at().to_vec();
        let weights = self.vector("weights", formula, at, &mean);
        let observables = self.observables();
        let zero = self.planner.source.graph.integer(0);
        let mean_field = mean.iter().any(|slope| *slope != zero);
        let [ad, ad_star] = self.brackets();
        Family {
            coordinates: self
                .planner
                .structure
                .coordinates
                .iter()
                .map(|c| c.text.clone())
                .collect(),
            sizes: family.sizes.clone(),
            offsets: family.slots.clone(),
            own: family.own,
            data_places: family.data_places.clone(),
            data: family
                .data
                .iter()
                .map(|data| Data {
                    name: data.name.clone(),
                    doc: described(
                        &data.name,
                        data.unit.as_deref(),
                        data.description.as_deref(),
                    ),
                    bits: data.values.iter().map(|value| value.to_bits()).collect(),
                    sizes: data.sizes,
                    unused: data.unused,
                    bonds: family.has_bonds && data.name == BONDS,
                })
                .collect(),
            sums: family
                .sums
                .iter()
                .map(|sum| Sum {
                    slots: sum.slots.clone(),
                    spans: sum.spans,
                })
                .collect(),
            timed: family.timed,
            shared: family.shared.len(),
            inputs: self.inputs(),
            bonds,
            mean_field,
            degree: family.degree,
            seed: family.seed(),
            field,
            driven,
            slopes,
            summands,
            energy,
            time_slope,
            weights,
            observables,
            ad,
            ad_star,
            casimirs: self.casimirs(),
            pieces: self.pieces(),
        }
    }

    /// The bracket and the coadjoint action.
    fn brackets(&mut self) -> [Function; 2] {
        let (n, all) = (self.n(), self.planner.names.coordinates.len());
        let symbols = |from: usize| (from..from + n).map(Symbol::Input).collect::<Vec<_>>();
        let (xi, other) = (symbols(0), symbols(all));
        let source = &mut self.planner.source;
        let expressions = |source: &mut Source, symbols: &[Symbol]| -> Vec<ExprId> {
            symbols.iter().map(|s| source.graph.symbol(*s)).collect()
        };
        let (of_xi, of_other) = (expressions(source, &xi), expressions(source, &other));
        let ad = source.ad_of(&of_xi, &of_other);
        let ad_star = source.ad_star_of(&of_xi, &of_other);
        let arguments = |name| {
            let (xi, other) = (xi.clone(), other.clone());
            vec![
                Argument {
                    name: "xi",
                    symbols: xi,
                },
                Argument {
                    name,
                    symbols: other,
                },
            ]
        };
        let of_ad = ("ad", "`out = [xi, eta]`");
        let of_ad_star = ("ad_star", "`out = ad*_xi mu`");
        [
            self.vector("ad", of_ad, arguments("eta"), &ad),
            self.vector("ad_star", of_ad_star, arguments("mu"), &ad_star),
        ]
    }

    /// The Casimirs of a site, in the coordinates of slot 0.
    fn casimirs(&mut self) -> Vec<SiteCasimir> {
        let n = self.n();
        let model = self.planner.structure;
        let mut casimirs = Vec::new();
        for casimir in &model.casimirs {
            let graph = &mut self.planner.source.graph;
            let value = graph.as_written(casimir.expr);
            let symbols = (0..n).map(Symbol::Coordinate);
            let gradient: Vec<ExprId> = symbols.map(|s| graph.derivative(value, s)).collect();
            let argument = Argument {
                name: "mu",
                symbols: (0..n).map(Symbol::Coordinate).collect(),
            };
            let formula = "`C(mu_i)`";
            let kernel = Kernel::scalar("casimir", formula, vec![argument.clone()], value);
            let value = self.function(&format!("casimir {}", casimir.name), &kernel);
            let formula = ("casimir_gradient", "`out = dC/dmu_i`");
            let label = format!("casimir_gradient {}", casimir.name);
            let gradient = self.vector(&label, formula, vec![argument], &gradient);
            casimirs.push(SiteCasimir {
                name: casimir.name.clone(),
                degree: casimir.degree,
                kept: casimir.kept,
                value,
                gradient,
            });
        }
        casimirs
    }
}
