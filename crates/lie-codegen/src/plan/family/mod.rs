//! The kernels of a family: those of one site and of the sums that it takes part in.

mod derivation;
mod motion;
mod pieces;
mod sums;

use std::sync::Arc;

use super::constants::Table;
use super::function::Function;
use super::names::Names;
use super::planner::{Planner, parameters};
use super::system::{Energy, System};
use super::{Constants, Plan};
use crate::derive::{Source, Update};
use crate::model::{self, Size};
use crate::structure::Structure;
pub use crate::structure::family::Push;
use derivation::Derivation;
use lie_core::lattice::AXES;

/// What is generated for a family.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Family {
    /// The names of the coordinates of a site.
    pub coordinates: Vec<String>,
    /// The number of sites along each axis.
    pub sizes: Vec<Size>,
    /// The distances of the slots.
    pub offsets: Vec<[i64; AXES]>,
    /// The slot of the site itself.
    pub own: usize,
    /// What has a value for each site.
    pub data: Vec<Data>,
    /// Which slots and coefficients kernels read.
    pub data_places: Vec<[usize; 2]>,
    /// The sums.
    pub sums: Vec<Sum>,
    /// Whether a state carries the time.
    pub timed: bool,
    /// How many numbers all sites share, behind the sums: the time and the inputs, or none.
    pub shared: usize,
    /// The inputs.
    pub inputs: Vec<Input>,
    /// What a bond adds to sums and slopes; the last of `data` are the bonds then.
    pub bonds: Option<BondFunctions>,
    /// Whether some `dF/dT_k` depends on the state.
    pub mean_field: bool,
    /// The total degree of H, if it is a polynomial.
    pub degree: Option<u32>,
    /// The seed of a random initial state.
    pub seed: Option<u64>,
    /// The vector field of a site with all its neighbours; where something acts beside H, with the power behind it.
    pub field: Function,
    /// What acts beside H.
    pub driven: Option<Driven>,
    /// The derivative of each summand by the coordinates in each of its slots, times `dF/dT_k`.
    pub slopes: Vec<(usize, usize, Function)>,
    /// The summands.
    pub summands: Function,
    /// H as a function of the sums.
    pub energy: Function,
    /// `dH/dt` as a function of the sums, where H depends on the time.
    pub time_slope: Option<Function>,
    /// `dF/dT_k` where they depend on the state.
    pub weights: Function,
    /// What is recorded of the sums.
    pub observables: Vec<Observed>,
    /// The bracket of the algebra of a site.
    pub ad: Function,
    /// Its coadjoint action.
    pub ad_star: Function,
    /// The Casimirs of a site.
    pub casimirs: Vec<SiteCasimir>,
    /// The pieces of H, where their flows are exact.
    pub pieces: Option<FamilyPieces>,
}

/// What is set from outside, for all sites.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Input {
    /// Its name.
    pub name: String,
    /// Its value where nobody sets it, by its bits.
    pub default: u64,
    /// The time from one sampling to the next, by its bits; every step where it is absent.
    pub sampling: Option<u64>,
}

/// What acts on a site beside H.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Driven {
    /// The vector field of a site from dH/dmu there, and the power behind it.
    pub act: Function,
    /// Whether forces are among it.
    pub forced: bool,
    /// Whether damping along orbits is.
    pub damped: bool,
    /// The number of Wiener processes of a site.
    pub noises: usize,
}

/// What a bond adds.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct BondFunctions {
    /// To the sums, 0 to those that do not go over bonds.
    pub summands: Function,
    /// To dH/dmu at its first site, and behind it at the second one.
    pub slopes: Function,
}

/// A function of the sums that is recorded.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Observed {
    /// Its name.
    pub name: String,
    /// Whether its jumps by 2 pi are taken out along a run.
    pub unwrap: bool,
    /// Its value.
    pub value: Function,
}

/// A Casimir of a site.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct SiteCasimir {
    /// Its name.
    pub name: String,
    /// Its total degree, if it is a polynomial.
    pub degree: Option<u32>,
    /// Whether the motion keeps it.
    pub kept: bool,
    /// Its value.
    pub value: Function,
    /// Its gradient.
    pub gradient: Function,
}

/// A coefficient that has a value for each site.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Data {
    /// Its name.
    pub name: String,
    /// What it is, for people.
    pub doc: String,
    /// The values of the declaration, by their bits.
    pub bits: Arc<[u64]>,
    /// Layers, rows and columns of a lattice, of which there is a value for each site.
    pub sizes: Option<[usize; AXES]>,
    /// The number of last sites of a chain of which no sum asks for the value, so that it may be left out.
    pub unused: usize,
    /// Whether these are the bonds: two sites and a value of each.
    pub bonds: bool,
}

impl Data {
    /// The values of the declaration, site after site.
    pub fn values(&self) -> impl ExactSizeIterator<Item = f64> {
        self.bits.iter().map(|bits| f64::from_bits(*bits))
    }
}

/// The pieces of the Hamiltonian of a family.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct FamilyPieces {
    /// The pieces.
    pub kinds: Vec<FamilyPiece>,
    /// `exp(t ad*_(e_a))` for each coordinate that they need.
    pub turns: Vec<(usize, Function, Vec<Update>)>,
    /// What H is beside them, where that changes with the time.
    pub rest: Option<Function>,
}

/// A piece, the same for all sites that it goes over.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct FamilyPiece {
    /// The distance of the second site of a bond.
    pub offset: [i64; AXES],
    /// Where the first sites are.
    pub spans: [Option<(usize, usize)>; AXES],
    /// What it is.
    pub form: FamilyForm,
    /// The derivative of a function of one coordinate, or of one of two by that of the first site, the factor of a product, or the
    /// rate of an exchange; of a flow of its own the coordinates of the site behind it.
    pub rate: Function,
    /// The derivative of a function of two coordinates by that of the second site.
    pub second: Option<Function>,
    /// What a site adds to the sums of which it is a function.
    pub share: Option<Function>,
    /// The derivative by the time of a site or a bond, where it has one.
    pub timed: Option<Function>,
    /// What a function of sums has beside that.
    pub timed_by_sums: Option<Function>,
}

impl FamilyPiece {
    /// Whether it is a force, and whether it does work.
    pub fn push(&self) -> Option<Push> {
        match self.form {
            FamilyForm::Flow(push) => push,
            _ => None,
        }
    }
}

/// What a piece is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FamilyForm {
    /// A function of a coordinate.
    Site(usize),
    /// A function of sums over functions of a coordinate.
    Collective(usize),
    /// A product of a coordinate of each site.
    Product([usize; 2]),
    /// Another function of a coordinate of each site.
    Pair([usize; 2]),
    /// The exchange of two spins.
    Exchange,
    /// A function that moves no site.
    Still,
    /// A flow of its own: of a force, or else along the orbit.
    Flow(Option<Push>),
}

/// A sum over sites.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Sum {
    /// The slots that its summand depends on.
    pub slots: Vec<usize>,
    /// By layer, row and column the first site and the number of sites behind the last; none where it goes over all.
    pub spans: [Option<(usize, usize)>; AXES],
}

impl Family {
    /// All kernels.
    pub fn functions(&self) -> impl Iterator<Item = &Function> {
        let casimirs = self.casimirs.iter();
        let casimirs = casimirs.flat_map(|casimir| [&casimir.value, &casimir.gradient]);
        let mean = self.mean_field.then_some(&self.weights);
        [&self.field]
            .into_iter()
            .chain(self.driven.iter().map(|driven| &driven.act))
            .chain(self.slopes.iter().map(|(_, _, function)| function))
            .chain([&self.summands, &self.energy])
            .chain(&self.time_slope)
            .chain(
                self.bonds
                    .iter()
                    .flat_map(|bonds| [&bonds.summands, &bonds.slopes]),
            )
            .chain(self.observables.iter().map(|observed| &observed.value))
            .chain(mean)
            .chain([&self.ad, &self.ad_star])
            .chain(casimirs)
            .chain(self.pieces.iter().flat_map(|pieces| {
                let turns = pieces.turns.iter().map(|(_, function, _)| function);
                let kinds = pieces.kinds.iter();
                let kinds = kinds.flat_map(|kind| {
                    let more = kind.second.iter().chain(&kind.share);
                    let timed = kind.timed.iter().chain(&kind.timed_by_sums);
                    [&kind.rate].into_iter().chain(more).chain(timed)
                });
                kinds.chain(turns).chain(&pieces.rest)
            }))
    }

    /// The number of coordinates and coefficients in all slots together, and of rates of Wiener processes of the site.
    pub fn places(&self) -> usize {
        self.offsets.len() * self.coordinates.len() + self.data_places.len() + self.noises()
    }

    /// Whether kernels of pieces read anything behind the coordinates: coefficients, or rates of Wiener processes.
    pub fn has_coefficients(&self) -> bool {
        !self.data.is_empty() || self.noises() > 0
    }

    /// The number of sums, and of what all sites share behind them.
    pub fn totals(&self) -> usize {
        self.sums.len() + self.shared
    }

    /// The number of Wiener processes of a site.
    pub fn noises(&self) -> usize {
        self.driven.as_ref().map_or(0, |driven| driven.noises)
    }
}

/// The number of Wiener processes of a site.
fn noises(structure: &Structure) -> usize {
    structure
        .driving
        .as_ref()
        .map_or(0, |driving| driving.noises)
}

/// The plan of a family.
pub(super) fn plan(structure: &Structure, family: &model::Family) -> Plan {
    let mut names = Names::new(structure);
    let n = structure.dimension();
    let of_slots = (0..family.names.len()).map(|place| {
        let (slot, name) = (place / n, &structure.coordinates[place % n].text);
        format!("_{slot}{name}")
    });
    let of_sums = (0..family.sums.len()).map(|k| format!("_w{k}"));
    names.coordinates = of_slots.chain(of_sums).collect();
    let places = family.data_places.iter();
    names.data = places
        .map(|[slot, which]| format!("_{slot}{}", family.data[*which].name))
        .chain(
            family
                .has_bonds
                .then(|| {
                    let second = structure.coordinates.iter();
                    let second = second.map(|name| format!("_other{}", name.text));
                    second.chain(["_value".to_owned()])
                })
                .into_iter()
                .flatten(),
        )
        .chain((0..noises(structure)).map(|process| format!("_dw{process}")))
        .collect();
    let shared = family.shared.iter();
    names.shared = shared.map(|name| format!("_all_{name}")).collect();
    let mut planner = Planner {
        structure,
        source: Source::new(structure),
        names,
        methods: Vec::new(),
        constants: Table::default(),
        items: Vec::new(),
        known: Vec::new(),
        eliminations: Vec::new(),
    };
    let planned = Derivation::new(&mut planner, family).family();
    planner.family(planned)
}

impl Planner<'_> {
    fn family(mut self, family: Family) -> Plan {
        let defaults: Vec<_> = self
            .structure
            .parameters
            .iter()
            .map(|p| p.default)
            .collect();
        let defaults = self.preparation(&defaults);
        let table = std::mem::take(&mut self.constants);
        let constants: Constants = self.prepared(&table, "_k");
        Plan {
            names: self.names,
            docs: super::docs::docs(self.structure),
            parameters: parameters(self.structure),
            defaults,
            initial: None,
            attitude: None,
            constants,
            system: System {
                hamiltonian_degree: family.degree,
                poisson_degree: None,
                almost_poisson: false,
                autonomous: family.time_slope.is_none(),
                clock: None,
                joints: 0,
                forced: false,
                force_mixes: false,
                damped: false,
                entropy: None,
                inputs: family.inputs.iter().map(|input| input.sampling).collect(),
                noises: 0,
                casimirs: Vec::new(),
                quantities: Vec::new(),
                events: Vec::new(),
                energy: Energy::Expression,
                derivatives: false,
                poisson: Vec::new(),
                lie: true,
                algebra: Vec::new(),
                exponential: Vec::new(),
                triple: None,
                lagrangian: Vec::new(),
                velocities: None,
                discrete: Vec::new(),
            },
            structure: super::Structure::default(),
            items: Vec::new(),
            generic: Vec::new(),
            splitting: None,
            found: None,
            family: Some(Box::new(family)),
        }
    }
}
