//! Steps whose size follows the motion.

use lie_codegen::methods::{CATALOGUE, Choice, refusal};
use lie_runtime::driver::Density;
use lie_runtime::methods::Keep;

use super::plan::Planner;
use super::{Front, OptionValue};
use crate::message::{Fault, Message};

impl Planner<'_> {
    /// Whether the steps of a method follow the motion.
    pub(super) fn density(&mut self, choice: &Choice, keep: Keep) -> Density {
        let of_spec = || self.in_spec("density").into_iter().next();
        let given = self
            .method_option("density")
            .or_else(|| of_spec().filter(|_| self.picks()));
        let Some(given) = given else {
            return Density::Constant;
        };
        match given.text.trim() {
            "reversible" => {}
            "constant" => return Density::Constant,
            other => {
                let text = format!("unknown density of steps `{other}`");
                let help = "write `reversible`, or `constant` for steps of one size";
                self.keep(Err::<(), _>(given.wrong(text).help(help)));
                return Density::Constant;
            }
        }
        if let Some((why, help)) = self.has_constant_steps(choice) {
            self.foreign("density", given.wrong(why).help(help));
        } else if let Some(message) = self.hinders_density(&given, keep) {
            self.mistakes.push(message);
        } else {
            return Density::Reversible;
        }
        Density::Constant
    }

    /// Why a method does not take a density, and which ones do.
    fn has_constant_steps(&self, choice: &Choice) -> Option<(String, String)> {
        let id = choice.id();
        let method = choice.entry()?;
        let why = if choice.is_adaptive() {
            format!("{id} chooses its own steps")
        } else if !method.symmetric {
            format!(
                "{id} is not symmetric: a step of -h does not undo one of h, and no steps of other sizes make it reversible"
            )
        } else {
            return None;
        };
        let symmetric = CATALOGUE.iter().filter(|method| method.symmetric);
        let choices = symmetric.filter_map(|method| Choice::from_id(method.id).ok());
        let apply = choices.filter(|choice| refusal(&self.spec.model, choice).is_none());
        let ids: Vec<String> = apply.map(|choice| choice.id()).collect();
        let name = self.request.front.named("density");
        let help = match ids.is_empty() {
            true => format!("leave `{name}` out"),
            false => format!("leave `{name}` out, or take one of {}", ids.join(", ")),
        };
        Some((why, help))
    }

    /// What of the system or of other options stands against it.
    fn hinders_density(&self, given: &OptionValue, keep: Keep) -> Option<Message> {
        let name = &self.spec.model.name;
        let front = self.request.front;
        if self.spec.model.family.is_some() {
            let text = format!("{name} is a family, whose Jacobian the control would need");
            return Some(given.wrong(text).help("leave it out"));
        }
        if keep != Keep::NOTHING {
            let text = "a projection behind steps takes their symmetry from them";
            let help = format!("leave `{}` out, or this", front.named("keep"));
            return Some(given.wrong(text).help(help));
        }
        None
    }
}

/// That all members of an ensemble have the same times.
pub(super) fn not_in_ensembles(front: Front) -> Message {
    let text = "the members of an ensemble go along one grid of times, and steps of this kind have their own";
    let message = Message::option(&front.option("density"), text).with_fault(Fault::Arguments);
    message.help("leave it out, or make runs of their own")
}
