//! Families of copies of an algebra.

use std::array::from_fn;
use std::sync::Arc;

use super::Model;
use lie_core::lattice::{self, AXES, last_axes};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
pub use lie_syntax::ast::Start;

/// [`Symbol::Input`] of the first coefficient that differs from site to site.
const DATA: usize = 1 << 22;

/// [`Symbol::Input`] of the first number that all sites share.
const SHARED: usize = 1 << 23;

/// The symbol of what all sites share, by its place in [`Family::shared`].
pub fn shared_symbol(number: usize) -> Symbol {
    Symbol::Input(SHARED + number)
}

/// The place of a symbol of [`shared_symbol`].
pub fn shared_number(symbol: Symbol) -> Option<usize> {
    match symbol {
        Symbol::Input(place) => place.checked_sub(SHARED),
        _ => None,
    }
}

/// The symbol of the coefficient at a place of [`Family::data_places`].
pub fn data_symbol(number: usize) -> Symbol {
    Symbol::Input(DATA + number)
}

/// The symbol of a component of dH/dmu at a site, in what acts there.
pub fn slope_symbol(coordinate: usize) -> Symbol {
    Symbol::Input(coordinate)
}

/// The place of a symbol of [`data_symbol`].
pub fn data_number(symbol: Symbol) -> Option<usize> {
    match symbol {
        Symbol::Input(place) => place.checked_sub(DATA).filter(|number| *number < DATA),
        _ => None,
    }
}

/// A family `A^N`: H is a function of sums over the sites.
#[derive(Clone, Debug)]
pub struct Family {
    /// The number of sites along each axis, of which there are one to [`AXES`].
    pub sizes: Vec<Size>,
    /// The distances, in layers, rows and columns, of the sites that a summand or the motion of a site depends on; a chain is a row.
    /// Coordinate a of a site in slot s is [`Symbol::Coordinate`](lie_symbolic::symbolic::Symbol::Coordinate) `s n + a`.
    pub slots: Vec<[i64; AXES]>,
    /// The slot of the site itself.
    pub own: usize,
    /// The names of all these coordinates, such as `x[i+1]`.
    pub names: Vec<String>,
    /// What has a value for each site.
    pub data: Vec<SiteData>,
    /// Of what sums and motions of sites depend on the slot, and which coefficient it is.
    pub data_places: Vec<[usize; 2]>,
    /// Its names, such as `B[i+1]`, and behind them those of the second site of a bond and of its value, where there are bonds.
    pub data_names: Vec<String>,
    /// Whether the last of `data` are bonds: rows `i, j, value`.
    pub has_bonds: bool,
    /// Whether a state carries the time: something acts on sites, or something depends on the time or on inputs.
    pub timed: bool,
    /// The names of what all sites share: the time and behind it the inputs, or none where nothing depends on them.
    pub shared: Vec<String>,
    /// The sums `T_k`; `Symbol::Coordinate(slots n + k)` in H.
    pub sums: Vec<SiteSum>,
    /// H.
    pub energy: ExprId,
    /// `dH/dt` where H depends on the time, a function of sums.
    pub time_slope: Option<ExprId>,
    /// The total degree of H in the coordinates, where it is a polynomial.
    pub degree: Option<u32>,
    /// Where a run starts.
    pub start: Option<Start>,
}

/// The number of sites along one axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Size {
    /// A number.
    Number(usize),
    /// The value of a parameter.
    Parameter(usize),
}

/// A coefficient that has a value for each site.
#[derive(Clone, Debug)]
pub struct SiteData {
    /// Its name.
    pub name: String,
    /// Its values, site after site.
    pub values: Arc<[f64]>,
    /// Layers, rows and columns of a lattice, of which there is a value for each site.
    pub sizes: Option<[usize; AXES]>,
    /// The number of last sites of a chain of which no sum asks for the value, so that it may be left out.
    pub unused: usize,
    /// Unit, for people, as Markdown within a line.
    pub unit: Option<String>,
    /// Description, for people, as Markdown.
    pub description: Option<String>,
}

impl SiteData {
    /// The smallest and the largest value.
    pub fn range(&self) -> [f64; 2] {
        let values = self.values.iter();
        values.fold(
            [f64::INFINITY, f64::NEG_INFINITY],
            |[least, most], value| [value.min(least), value.max(most)],
        )
    }
}

/// A sum over sites.
#[derive(Clone, Debug)]
pub struct SiteSum {
    /// The summand.
    pub summand: ExprId,
    /// The slots whose coordinates H depends on by it; none of a sum for observables alone.
    pub slots: Vec<usize>,
    /// Whether it goes over bonds.
    pub over_bonds: bool,
    /// Whether H depends on it, and not observables alone.
    pub moves: bool,
    /// For each axis the first site and the number of sites behind the last one; none where it goes over all.
    pub spans: [Option<(usize, usize)>; AXES],
}

impl Family {
    /// The symbol of the rate of a Wiener process of the site.
    pub fn rate_symbol(&self, process: usize) -> Symbol {
        data_symbol(self.data_names.len() + process)
    }

    /// The name of a symbol at a site; none of what has no name there.
    pub fn name_at_site(&self, symbol: Symbol) -> Option<&String> {
        match (data_number(symbol), shared_number(symbol)) {
            (Some(number), _) => self.data_names.get(number),
            (_, Some(number)) => self.shared.get(number),
            _ => None,
        }
    }

    /// The symbol of a coordinate of the second site of a bond; behind them that of its value.
    pub fn bond_symbol(&self, coordinate: usize) -> Symbol {
        data_symbol(self.data_places.len() + coordinate)
    }

    /// Functions of the n coordinates of a site at the site itself, in its slot.
    pub fn at_own(&self, graph: &mut Graph, functions: &[ExprId], n: usize) -> Vec<ExprId> {
        let own = (0..n).map(|k| graph.symbol(Symbol::Coordinate(self.own * n + k)));
        let own: Vec<ExprId> = own.collect();
        graph.substitute(functions, &|symbol| match symbol {
            Symbol::Coordinate(k) => own.get(k).copied(),
            _ => None,
        })
    }

    /// The symbol of a coefficient as seen from the site in a slot.
    pub fn data_from(&self, symbol: Symbol, slot: usize) -> Option<Symbol> {
        let [at, which] = *self.data_places.get(data_number(symbol)?)?;
        let moved = apart(&self.slots[at], &self.slots[slot]);
        let mut places = self.data_places.iter();
        let place = places.position(|[slot, other]| self.slots[*slot] == moved && *other == which);
        place.map(data_symbol)
    }

    /// The value of a coefficient at the site at a place, of so many layers, rows and columns.
    pub fn value_at(&self, symbol: Symbol, place: usize, sizes: [usize; AXES]) -> Option<f64> {
        let [slot, which] = *self.data_places.get(data_number(symbol)?)?;
        let offset = self.slots[slot].map(|distance| distance as isize);
        let place = lattice::place(lattice::site(place, sizes), offset, sizes);
        self.data[which].values.get(place).copied()
    }

    /// The seed of a random initial state.
    pub fn seed(&self) -> Option<u64> {
        match self.start {
            Some(Start::UnitSpheres(seed)) => Some(seed),
            _ => None,
        }
    }

    /// Layers, rows and columns for these values of the parameters; none where a value is no size.
    pub fn sites(&self, parameters: &[f64]) -> Option<[usize; AXES]> {
        let sizes = self.sizes.iter().map(|size| size.value(parameters));
        last_axes(&sizes.collect::<Option<Vec<_>>>()?, 1)
    }
}

/// The distance of one site from another, from the distances of both.
pub fn apart(site: &[i64; AXES], from: &[i64; AXES]) -> [i64; AXES] {
    from_fn(|axis| site[axis] - from[axis])
}

impl Model {
    /// The state of a family for the coordinates of so many sites: what is carried beside them is 0, and the unit.
    pub fn complete_sites(&self, mut of_sites: Vec<f64>, sites: usize) -> Vec<f64> {
        if self.is_timed() {
            of_sites.extend([0.0, 0.0, 1.0]);
            of_sites.extend(self.inputs.iter().map(|input| input.default));
            let noises = self.driving.as_ref().map_or(0, |driving| driving.noises);
            of_sites.resize(of_sites.len() + noises * sites, 0.0);
        }
        of_sites
    }

    /// How many numbers each site of a family has in a whole state: its coordinates, and the rates of its noise.
    pub fn numbers_of_a_site(&self) -> usize {
        self.dimension() + self.driving.as_ref().map_or(0, |driving| driving.noises)
    }

    /// The coordinates of sites in a whole state of a family.
    pub fn of_sites<'a>(&self, state: &'a [f64]) -> &'a [f64] {
        let carried = if self.is_timed() {
            3 + self.inputs.len()
        } else {
            0
        };
        let sites = (state.len() - carried) / self.numbers_of_a_site();
        &state[..sites * self.dimension()]
    }
}

/// What is wrong with rows `i, j, value` of bonds between so many sites.
pub fn wrong_bond(rows: &[f64], sites: usize) -> Option<String> {
    let site = |place: f64| place >= 0.0 && place.fract() == 0.0 && place < sites as f64;
    rows.chunks_exact(3)
        .enumerate()
        .find_map(|(number, bond)| match *bond {
            [i, j, _] if !site(i) || !site(j) => Some(format!(
                "bond {number} joins the sites {i} and {j}, and there are {sites} sites"
            )),
            [i, j, _] if i == j => Some(format!("bond {number} joins the site {i} to itself")),
            _ => None,
        })
}

impl Size {
    /// The number for these values of the parameters; none where it is no size.
    pub fn value(&self, parameters: &[f64]) -> Option<usize> {
        let value = match self {
            Self::Number(count) => *count as f64,
            Self::Parameter(p) => parameters[*p],
        };
        let whole = value >= 1.0 && value <= (1_u64 << 31) as f64 && value.fract() == 0.0;
        whole.then_some(value as usize)
    }
}
