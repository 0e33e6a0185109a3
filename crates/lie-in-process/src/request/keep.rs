//! What explicit methods keep by a projection.

use lie_codegen::methods::Choice;
use lie_runtime::methods::{Keep, MOST_LEVELS};

use super::plan::{Plan, Planner};
use super::{OptionValue, method};
use crate::message::Message;
use crate::spec::Spec;

/// The methods that are taken with a tolerance where something is to be kept, the first of them that applies.
const KEEPING: [&str; 2] = ["taylor", "rk4"];

impl Plan {
    /// The names of what a projection behind each step keeps: `energy` and Casimirs, as columns have them.
    pub fn kept(&self, spec: &Spec) -> Vec<String> {
        let casimirs = spec.model.casimirs.iter().filter(|_| self.keep.casimirs);
        let energy = self.keep.energy.then(|| "energy".to_owned());
        let casimirs = casimirs.map(|casimir| casimir.name.clone());
        energy.into_iter().chain(casimirs).collect()
    }
}

impl Planner<'_> {
    /// What is to be kept. Where a tolerance picks the method, what the spec says of it holds for that too.
    fn asked_to_keep(&self) -> Option<OptionValue> {
        let of_spec = || self.in_spec("keep").into_iter().next();
        self.method_option("keep")
            .or_else(|| of_spec().filter(|_| self.picks()))
    }

    /// The method that a tolerance picks where something is to be kept.
    pub(super) fn keeping(&self) -> Option<&'static str> {
        self.asked_to_keep()?;
        let front = self.request.front;
        KEEPING.into_iter().find(|id| {
            let method = method::labelled(id, front);
            method.is_ok_and(|choice| method::applies(choice, &self.spec.model).is_ok())
        })
    }

    /// What is kept behind each step of a method.
    pub(super) fn kept(&mut self, choice: &Choice) -> Keep {
        let Some(given) = self.asked_to_keep() else {
            return Keep::NOTHING;
        };
        if let Some((why, help)) = self.keeps_otherwise(choice) {
            self.foreign("keep", given.wrong(why).help(help));
            return Keep::NOTHING;
        }
        let mut keep = Keep::NOTHING;
        for word in given.split() {
            let set = match word.text.trim() {
                "energy" => self.energy(&word).map(|()| keep.energy = true),
                "casimirs" => self.casimirs(&word).map(|()| keep.casimirs = true),
                other => {
                    let message = word.wrong(format!("`{other}` is nothing that can be kept"));
                    Err(message.help("write `energy`, `casimirs`, or both: `energy,casimirs`"))
                }
            };
            self.keep(set);
        }
        let count = self.spec.model.casimirs.len() + usize::from(keep.energy);
        if keep.casimirs && count > MOST_LEVELS {
            let text = format!(
                "{count} functions are more than the {MOST_LEVELS} that can be kept together"
            );
            let help = format!("keep the energy alone, or take {}", self.instead());
            self.keep(Err::<(), _>(given.wrong(text).help(help)));
        }
        keep
    }

    /// Why a method takes no projection, and what to do.
    fn keeps_otherwise(&self, choice: &Choice) -> Option<(String, String)> {
        let front = self.request.front;
        let example = front.assignment("method", "taylor");
        let id = choice.id();
        let method = choice.solved().entry()?;
        let name = front.named("keep");
        if !method.explicit {
            let text =
                format!("`{name}` is an option of explicit methods, and {id} solves equations");
            let help = format!("leave it out, or take an explicit method such as {example}");
            return Some((text, help));
        }
        let kept = method.preserves;
        let what = match (kept.poisson, kept.orbit, kept.casimirs || kept.energy) {
            (true, ..) => "is a Poisson map",
            (_, true, _) => "stays on the coadjoint orbit",
            (.., true) => "keeps invariants by itself",
            _ => return None,
        };
        let text = format!("{id} {what}, which a projection would take from it");
        let help =
            format!("leave `{name}` out, or take a method that keeps nothing, such as {example}");
        Some((text, help))
    }

    /// Whether the energy is constant.
    fn energy(&self, word: &OptionValue) -> Result<(), Message> {
        let model = &self.spec.model;
        let Some(more) = model.beside_hamiltonian() else {
            return Ok(());
        };
        let text = format!("{more}, and only motion by H alone keeps the energy");
        Err(word
            .wrong(text)
            .help(match model.casimirs.iter().any(|casimir| !casimir.kept) {
                true => "leave it out",
                false => "keep the Casimirs alone, or leave it out",
            }))
    }

    /// Whether there are Casimirs with values.
    fn casimirs(&self, word: &OptionValue) -> Result<(), Message> {
        let model = &self.spec.model;
        let name = &model.name;
        if model.family.is_some() {
            let text =
                format!("{name} has Casimirs at each of its sites, more than can be kept together");
            let help = format!("keep the energy alone, or take {}", self.instead());
            return Err(word.wrong(text).help(help));
        }
        if model.casimirs.is_empty() {
            let text = format!("no Casimirs of {name} are known");
            return Err(word
                .wrong(text)
                .help("declare them in `casimirs`, or keep the energy alone"));
        }
        if let Some(changed) = model.casimirs.iter().find(|casimir| !casimir.kept) {
            let text = format!("the forces change the Casimir {}", changed.name);
            return Err(word
                .wrong(text)
                .help("leave it out: no level of it is to be kept"));
        }
        let jumps = model.casimirs.iter().find(|casimir| casimir.multivalued);
        jumps.map_or(Ok(()), |casimir| {
            let text = format!(
                "the Casimir {} has several branches: its value jumps",
                casimir.name
            );
            Err(word.wrong(text).help("keep the energy alone"))
        })
    }

    /// A method that keeps Casimirs, of a family and a general bracket the quadratic ones.
    fn instead(&self) -> String {
        let model = &self.spec.model;
        let method = match model.is_lie_poisson() && model.family.is_none() {
            true => "lie-midpoint",
            false => "gauss16",
        };
        self.request.front.assignment("method", method)
    }
}
