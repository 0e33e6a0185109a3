//! The method of a run: as it is given, else the usual one for the system and the tolerance.

use lie_codegen::methods::{Choice, OptionError};

use super::plan::Planner;
use super::{OptionValue, method};

/// The method where none is given, for Lie–Poisson brackets and for others.
const METHODS: [&str; 2] = ["lie-midpoint", "midpoint"];
/// That of a tolerance. Where it is loose too: `gauss8` takes 1.4 to 3 times as many iterations, which cost 0.65 to 0.85 of one of `gauss16`.
const OF_TOLERANCE: &str = "gauss16";
/// That of a tolerance where branches meet: its steps end there.
const OF_JOINTS: (&str, Choice) = ("taylor", Choice::Taylor);
/// That of a system by a discrete Lagrangian in coordinates of the exponential map.
const DISCRETE: &str = "discrete-euler-poincare";

impl Planner<'_> {
    /// Whether a tolerance is given without a method, which is picked then: by who asks, or in the spec.
    pub(super) fn picks(&self) -> bool {
        let in_spec = self.request.tol.is_none() && !self.in_spec("method").is_empty();
        self.wants_tolerance() && self.request.method.is_empty() && !in_spec
    }

    /// Whether H or a force has branches that meet where the motion takes it, and a method's steps can end there. At times that are known
    /// beforehand steps of every method end.
    fn has_joints(&self) -> bool {
        let model = &self.spec.model;
        let noisy = model
            .driving
            .as_ref()
            .is_some_and(|driving| driving.noises > 0);
        let met = model.joints.iter().any(|joint| !joint.is_known);
        met && !noisy && method::applies(OF_JOINTS.1, model).is_ok()
    }

    /// The method as it is given, or the usual one.
    fn label(&self) -> OptionValue {
        let picks = self.picks();
        let option = self.request.front.option("method");
        if let Some(label) = self.request.method.first() {
            return OptionValue::flag(&option, label);
        }
        if let (Some(given), false) = (self.in_spec("method").into_iter().next(), picks) {
            return given;
        }
        let model = &self.spec.model;
        let discrete = model.energy.lagrangian().and_then(|l| l.discrete.as_ref());
        let keeping = self.keeping().filter(|_| picks);
        let usual = if let Some(keeping) = keeping {
            keeping
        } else if picks && self.has_joints() {
            OF_JOINTS.0
        } else if picks || model.family.is_some() {
            OF_TOLERANCE
        } else if discrete.is_some_and(|discrete| discrete.in_entries.is_none()) {
            DISCRETE
        } else {
            METHODS[usize::from(!model.is_lie_poisson())]
        };
        OptionValue::flag(&option, usual)
    }

    pub(super) fn method(&mut self) -> Option<Choice> {
        let front = self.request.front;
        let id = self.label();
        let place = id.wrong("").place;
        let found =
            method::labelled(&id.text, front).map_err(|message| message.at_place(place.clone()));
        let mut choice = self.keep(found)?;
        for name in method::OPTIONS {
            if id.text.contains(&format!("--{name}")) {
                if let Some(given) = self.requested(name) {
                    self.twice(name, &given, &id.text);
                }
                continue;
            }
            let Some(given) = self.method_option(name) else {
                continue;
            };
            match choice.clone().with_option(name, &given.text) {
                Ok(chosen) => choice = chosen,
                Err(OptionError::Foreign) => {
                    let text = format!("`{name}` is not an option of {}", choice.id());
                    let help = method::help_on_options(&choice, front);
                    self.foreign(name, given.wrong(text).help(help));
                }
                Err(OptionError::Value(text, help)) => {
                    self.mistakes.push(given.wrong(text).help(help));
                    return None;
                }
            }
        }
        let applies = method::applies(choice, &self.spec.model);
        self.keep(applies.map_err(|message| message.at_place(place)))
    }
}
