//! Whether what acts beside the Hamiltonian has a flow in closed form.

use super::Structure;
use crate::model::{Driving, Model};
use lie_symbolic::exact::Budget;
use lie_symbolic::prove::joints::joints_in;
use lie_symbolic::prove::proof::Prover;
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};

/// Work allowed for one system.
const WORK: u64 = 2_000_000;

/// Why a method does not apply: what acts, and what to use.
type Refusal = (String, String);

impl Structure {
    /// How many pieces what acts adds to those of H in a splitting: one for forces, and one for noise.
    pub fn pieces_beside(&self) -> usize {
        self.driving.as_ref().map_or(0, |driving| {
            usize::from(driving.is_forced(&self.graph)) + usize::from(driving.is_noisy())
        })
    }
}

/// Why what acts is no piece of a splitting: forces that are not linear in the coordinates, a double bracket, noise that is not along
/// constant directions.
pub fn unsplittable(model: &Model) -> Option<Refusal> {
    let mut parts = Parts::of(model)?;
    let noise = parts.unsteady_noise();
    noise.or_else(|| parts.damping()).or_else(|| parts.force())
}

/// Whether forces are linear in the coordinates, and that on one of them depends on others.
pub fn force_mixes(model: &Model) -> bool {
    model.family.is_none() && Parts::of(model).is_some_and(|mut parts| parts.force_mixes())
}

/// Why noise has no flow in closed form, or that there is none.
pub fn unsteady_noise(model: &Model) -> Option<Refusal> {
    match Parts::of(model).filter(|parts| parts.driving.is_noisy()) {
        Some(mut parts) => parts.unsteady_noise(),
        None => Some((
            "the method is for noise, and none acts".into(),
            "use `lie-midpoint`, which it is made of".into(),
        )),
    }
}

/// What acts, in an arena that may be littered.
struct Parts<'a> {
    model: &'a Model,
    driving: &'a Driving,
    graph: Graph,
    /// How many coordinates move: those before the time.
    moving: usize,
    /// The place at which the generator has what the time takes.
    time: usize,
}

impl<'a> Parts<'a> {
    fn of(model: &'a Model) -> Option<Self> {
        let clock = model.configuration.as_ref()?.clock()?;
        Some(Self {
            model,
            driving: model.driving.as_ref()?,
            graph: model.graph.clone(),
            moving: clock.time,
            time: clock.time,
        })
    }

    /// Whether an expression is shown to vanish.
    fn vanishes(&self, value: ExprId) -> bool {
        let name = |symbol| self.model.acting_name(symbol);
        let budget = Budget::new(WORK);
        self.graph.is_zero(value)
            || Prover::new(&self.graph, &budget, &self.driving.force, &name).vanishes(value)
    }

    /// A coordinate, other than one of them, that is not shown to be absent: a derivative does not vanish, or it says which branch is taken.
    fn depends(&mut self, value: ExprId, but: Option<usize>) -> Option<usize> {
        let moving = (0..self.moving).filter(|place| Some(*place) != but);
        let on = moving.into_iter().find(|place| {
            let slope = self.graph.derivative(value, Symbol::Coordinate(*place));
            !self.vanishes(slope)
        });
        on.or_else(|| self.branches_on(value).filter(|place| Some(*place) != but))
    }

    /// A coordinate by which branches are taken.
    fn branches_on(&mut self, value: ExprId) -> Option<usize> {
        let places = joints_in(&mut self.graph, value, &|_| true).into_iter();
        let mut on = places.flat_map(|place| self.graph.coordinates(place));
        on.find(|place| *place < self.moving)
    }

    fn rates(&self) -> std::ops::Range<usize> {
        let all = self.model.dimension();
        all - self.driving.noises..all
    }

    /// Expressions without noise.
    fn quiet(&mut self, values: &[ExprId]) -> Vec<ExprId> {
        let (rates, zero) = (self.rates(), self.graph.integer(0));
        self.graph.substitute(values, &|symbol| match symbol {
            Symbol::Coordinate(place) if rates.contains(&place) => Some(zero),
            _ => None,
        })
    }

    fn coordinate(&self, place: usize) -> &str {
        &self.model.coordinates[place].text
    }

    fn unsteady_noise(&mut self) -> Option<Refusal> {
        let driving = self.driving;
        for (what, values) in [
            ("noise along a Hamiltonian", &driving.damping),
            ("noise as a force", &driving.force),
        ] {
            for (place, value) in values.iter().enumerate() {
                // the power of what acts, in which there is no noise
                if what.ends_with("Hamiltonian") && place == self.time {
                    continue;
                }
                for rate in self.rates() {
                    let part = self.graph.derivative(*value, Symbol::Coordinate(rate));
                    let Some(on) = self.depends(part, None) else {
                        continue;
                    };
                    let message = format!(
                        "{what} has a flow in closed form along constant directions alone, and here its direction depends on `{}`",
                        self.coordinate(on)
                    );
                    let help = "use `lie-midpoint`, which takes any noise";
                    return Some((message, help.into()));
                }
            }
        }
        None
    }

    fn damping(&mut self) -> Option<Refusal> {
        let damping = self.quiet(&self.driving.damping);
        let mut others = damping.into_iter().enumerate();
        let damps = others.any(|(place, value)| place != self.time && !self.vanishes(value));
        damps.then(|| {
            let other = match self.driving.is_noisy() {
                true => "ninomiya-victoir",
                false => "lie-midpoint",
            };
            (
                "a double bracket damps, whose flow has no closed form".into(),
                format!("use `{other}`, which keeps the orbit"),
            )
        })
    }

    fn force(&mut self) -> Option<Refusal> {
        let force = self.quiet(&self.driving.force);
        for (place, value) in force.into_iter().enumerate() {
            let branches = self.branches_on(value);
            for by in 0..self.moving {
                let slope = self.graph.derivative(value, Symbol::Coordinate(by));
                if branches != Some(by) && self.depends(slope, None).is_none() {
                    continue;
                }
                let message = format!(
                    "what acts beside H has an exact flow where it is linear in the coordinates, and on `{}` it is not linear in `{}`",
                    self.coordinate(place),
                    self.coordinate(by)
                );
                let help = "use `lie-midpoint`, `gauss16` or `taylor`, which take any force";
                return Some((message, help.into()));
            }
        }
        None
    }

    fn force_mixes(&mut self) -> bool {
        let force = self.quiet(&self.driving.force);
        let mut moving = force.into_iter().take(self.moving).enumerate();
        moving.any(|(place, value)| self.depends(value, Some(place)).is_some())
            && self.force().is_none()
    }
}
