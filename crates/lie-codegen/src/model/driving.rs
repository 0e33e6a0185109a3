//! What acts beside the Hamiltonian.

use super::{Model, shared_number};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};

/// Forces and dissipation of a system: `mu' = Pi(mu) xi + F`.
#[derive(Clone, Debug)]
pub struct Driving {
    /// The force F, 0 where none acts.
    pub force: Vec<ExprId>,
    /// What the generator xi has beside the gradient of H. The component along the time is the power `<F, grad H> - c |v|^2_G` of what
    /// acts, `v = Pi grad H`, which the momentum of the time gives: H with that momentum stays constant.
    pub damping: Vec<ExprId>,
    /// What was declared, in its order.
    pub declared: Vec<Acting>,
    /// The number of Wiener processes, whose rates are the last of what is held. Of several, but for families, the last is no noise: its
    /// sign is the coin that tells in which order splittings take the others.
    pub noises: usize,
}

/// What is set from outside, and held from one sampling to the next.
#[derive(Clone, Debug)]
pub struct Input {
    /// Its name.
    pub name: String,
    /// Its value where nobody sets it.
    pub default: f64,
    /// The time from one sampling to the next; every step where it is absent.
    pub sampling: Option<f64>,
}

/// One thing that acts.
#[derive(Clone, Debug)]
pub enum Acting {
    /// A force on a coordinate.
    Force(usize, ExprId),
    /// A double bracket with its strength and its metric, the identity where there is none.
    DoubleBracket(ExprId, Option<Vec<Vec<ExprId>>>),
    /// An entropy with the metric.
    Metriplectic(ExprId, Vec<Vec<ExprId>>),
    /// A matrix that takes `R grad H`.
    Rayleigh(Vec<Vec<ExprId>>),
    /// Noise along a Hamiltonian.
    HamiltonianNoise(ExprId),
    /// Noise as a force on coordinates.
    ForceNoise(Vec<(usize, ExprId)>),
    /// The noise of a dissipation at a temperature.
    Temperature(ExprId),
}

impl Driving {
    /// Whether forces act, and not what moves along orbits alone.
    pub fn is_forced(&self, graph: &Graph) -> bool {
        self.force.iter().any(|force| !graph.is_zero(*force))
    }

    /// Whether the generator is not the gradient of H.
    pub fn is_damped(&self, graph: &Graph) -> bool {
        self.damping.iter().any(|more| !graph.is_zero(*more))
    }

    /// Whether a force was declared.
    pub fn pushes(&self) -> bool {
        let force = |acting: &Acting| matches!(acting, Acting::Force(..) | Acting::ForceNoise(_));
        self.declared.iter().any(force)
    }

    /// Whether noise moves along orbits.
    pub fn has_noise_along_orbits(&self) -> bool {
        let pairs = self.declared.windows(2);
        let mut warm =
            pairs.map(|pair| matches!(pair, [Acting::DoubleBracket(..), Acting::Temperature(_)]));
        let along = |acting: &Acting| matches!(acting, Acting::HamiltonianNoise(_));
        warm.any(|warm| warm) || self.declared.iter().any(along)
    }

    /// Whether there is noise.
    pub fn is_noisy(&self) -> bool {
        self.noises > 0
    }
}

impl Model {
    /// What acts beside the Hamiltonian, each as a name with a formula: `("force on x", "-k*x")`.
    pub fn acting(&self) -> Vec<(String, String)> {
        let declared = self.driving.iter().flat_map(|driving| &driving.declared);
        declared.map(|acting| self.words(acting)).collect()
    }

    /// The name of a symbol of what acts, of a family at a site.
    pub fn acting_name(&self, symbol: Symbol) -> String {
        let of_site = self.family.as_ref().and_then(|family| match symbol {
            Symbol::Coordinate(place) => family.names.get(place),
            symbol => family.name_at_site(symbol),
        });
        of_site.cloned().unwrap_or_else(|| self.symbol_name(symbol))
    }

    fn display_acting(&self, expression: ExprId) -> String {
        (self.graph).display(expression, &|symbol| self.acting_name(symbol))
    }

    /// The name of a coordinate on which something acts.
    fn target(&self, place: usize) -> &str {
        match &self.family {
            Some(family) => &family.names[family.own * self.dimension() + place],
            None => &self.coordinates[place].text,
        }
    }

    fn words(&self, acting: &Acting) -> (String, String) {
        let matrix = |rows: &[Vec<ExprId>]| {
            let row = |row: &Vec<ExprId>| {
                let entries: Vec<String> = row.iter().map(|e| self.display_acting(*e)).collect();
                format!("[{}]", entries.join(", "))
            };
            let rows: Vec<String> = rows.iter().map(row).collect();
            format!("[{}]", rows.join(", "))
        };
        match acting {
            Acting::Force(place, value) => {
                let name = format!("force on {}", self.target(*place));
                (name, self.display_acting(*value))
            }
            Acting::DoubleBracket(strength, metric) => {
                let metric = metric.as_ref().map_or("1".to_owned(), |rows| matrix(rows));
                let strength = self.display_acting(*strength);
                let name = "double bracket, mu' += c ad*_{G ad*_{grad H} mu} mu";
                (name.to_owned(), format!("c = {strength}, G = {metric}"))
            }
            Acting::Metriplectic(entropy, metric) => {
                let entropy = self.display_acting(*entropy);
                let name = "metriplectic, mu' += K grad S";
                (
                    name.to_owned(),
                    format!("S = {entropy}, K = {}", matrix(metric)),
                )
            }
            Acting::Rayleigh(rows) => {
                let name = "Rayleigh, mu' -= R grad H";
                (name.to_owned(), format!("R = {}", matrix(rows)))
            }
            Acting::HamiltonianNoise(function) => {
                let name = "noise along a Hamiltonian, Stratonovich";
                (
                    name.to_owned(),
                    format!("sigma = {}", self.display_acting(*function)),
                )
            }
            Acting::ForceNoise(parts) => {
                let part = |(place, value): &(usize, ExprId)| {
                    format!("{}: {}", self.target(*place), self.display_acting(*value))
                };
                let parts: Vec<String> = parts.iter().map(part).collect();
                (
                    "noise as a force, Stratonovich".to_owned(),
                    parts.join(", "),
                )
            }
            Acting::Temperature(value) => {
                let name = "with its noise at the temperature";
                (name.to_owned(), self.display_acting(*value))
            }
        }
    }

    /// Whether H changes from outside: with the time or with inputs.
    pub fn is_energy_driven(&self) -> bool {
        let energy = self.energy.value(|hamiltonian| hamiltonian.energy);
        let sums = self.family.iter().flat_map(|family| &family.sums);
        let summands = sums.filter(|sum| sum.moves).map(|sum| sum.summand);
        let of_sums = self.family.iter().map(|family| family.energy);
        self.contains_outside(std::iter::once(energy).chain(summands).chain(of_sums))
    }

    fn contains_outside(&self, functions: impl IntoIterator<Item = ExprId>) -> bool {
        let clock = self.configuration.as_ref().and_then(|c| c.clock());
        let outside = |symbol: &Symbol| match symbol {
            Symbol::Coordinate(place) => clock.is_some_and(|clock| *place >= clock.time),
            other => shared_number(*other).is_some(),
        };
        let mut symbols = functions
            .into_iter()
            .flat_map(|part| self.graph.symbols(part));
        symbols.any(|symbol| outside(&symbol))
    }

    /// Why the motion is more than that of an H that keeps itself, as the beginning of a sentence; none where it is not.
    pub fn beside_hamiltonian(&self) -> Option<String> {
        let name = &self.name;
        match (self.is_timed(), self.is_energy_driven()) {
            (false, _) => None,
            (true, true) => Some(format!("H of {name} changes with the time")),
            // the time may be there for what is recorded
            (true, false) => {
                let acts = self.driving.is_some();
                acts.then(|| format!("more than H acts on {name}"))
            }
        }
    }

    /// What dissipation alone does to H and to entropies, as sentences; nothing where forces may do anything.
    pub fn what_dissipation_does(&self) -> Vec<String> {
        let Some(driving) = &self.driving else {
            return Vec::new();
        };
        let mut sentences = Vec::new();
        // a strength that changes is not known to stay positive
        let strengths = driving.declared.iter().filter_map(|acting| match acting {
            Acting::DoubleBracket(strength, _) => Some(*strength),
            _ => None,
        });
        let changes = self.is_energy_driven() || self.contains_outside(strengths);
        let (mut pushes, mut damps) = (false, false);
        for acting in &driving.declared {
            match acting {
                Acting::Force(..)
                | Acting::HamiltonianNoise(_)
                | Acting::ForceNoise(_)
                | Acting::Temperature(_) => pushes = true,
                Acting::DoubleBracket(..) | Acting::Rayleigh(_) => damps = true,
                Acting::Metriplectic(entropy, _) => {
                    let entropy = self.display(*entropy);
                    sentences.push(format!(
                        "K grad H = 0 and {{S, H}} = 0 are proven: S = {entropy} never falls"
                    ));
                }
            }
        }
        match (pushes, damps) {
            (true, _) => sentences.clear(),
            _ if changes => {}
            (false, true) => sentences = vec!["H never grows".into()],
            (false, false) => sentences.push("H is constant".into()),
        }
        sentences
    }
}
