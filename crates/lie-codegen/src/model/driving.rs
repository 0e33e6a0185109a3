//! What acts beside the Hamiltonian.

use super::Model;
use lie_symbolic::symbolic::ExprId;

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
}

impl Driving {
    /// Whether forces act, and not damping along orbits alone.
    pub fn is_forced(&self) -> bool {
        let along = |acting: &Acting| matches!(acting, Acting::DoubleBracket(..));
        !self.declared.iter().all(along)
    }

    /// Whether damping along orbits acts.
    pub fn is_damped(&self) -> bool {
        let along = |acting: &Acting| matches!(acting, Acting::DoubleBracket(..));
        self.declared.iter().any(along)
    }
}

impl Model {
    /// What acts beside the Hamiltonian, each as a name with a formula: `("force on x", "-k*x")`.
    pub fn acting(&self) -> Vec<(String, String)> {
        let declared = self.driving.iter().flat_map(|driving| &driving.declared);
        declared.map(|acting| self.words(acting)).collect()
    }

    fn words(&self, acting: &Acting) -> (String, String) {
        let matrix = |rows: &[Vec<ExprId>]| {
            let row = |row: &Vec<ExprId>| {
                let entries: Vec<String> = row.iter().map(|e| self.display(*e)).collect();
                format!("[{}]", entries.join(", "))
            };
            let rows: Vec<String> = rows.iter().map(row).collect();
            format!("[{}]", rows.join(", "))
        };
        match acting {
            Acting::Force(place, value) => {
                let name = format!("force on {}", self.coordinates[*place].text);
                (name, self.display(*value))
            }
            Acting::DoubleBracket(strength, metric) => {
                let metric = metric.as_ref().map_or("1".to_owned(), |rows| matrix(rows));
                let strength = self.display(*strength);
                let name = "double bracket, mu' += c ad*_{G ad*_{grad H} mu} mu";
                (name.to_owned(), format!("c = {strength}, G = {metric}"))
            }
            Acting::Metriplectic(entropy, metric) => {
                let entropy = self.display(*entropy);
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
        }
    }

    /// What dissipation alone does to H and to entropies, as sentences; nothing where forces may do anything.
    pub fn what_dissipation_does(&self) -> Vec<String> {
        let Some(driving) = &self.driving else {
            return Vec::new();
        };
        let mut sentences = Vec::new();
        let (mut pushes, mut damps) = (false, false);
        for acting in &driving.declared {
            match acting {
                Acting::Force(..) => pushes = true,
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
            (false, true) => sentences = vec!["H never grows".into()],
            (false, false) => sentences.push("H is constant".into()),
        }
        sentences
    }
}
