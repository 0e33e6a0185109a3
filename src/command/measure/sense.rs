//! The sense in which `lie bench` measures errors: from the flags, and in words.

use lie_in_process::request::OptionValue;
use lie_measure::bench::{Measure, Plane};
use lie_syntax::front::names::normalised;
use lie_syntax::suggest::did_you_mean;

use super::Bed;
use crate::command::args::{self, Sense};
use crate::message::{Failure, Message};

/// So many coordinates are listed where one is not known.
const LISTED: usize = 24;

/// What the flags ask for.
///
/// # Errors
/// A surface without its measure, or that is none; the energy of a system with the time, or beside whose H something acts; Casimirs of a system
/// that has none.
pub fn measure(arguments: &args::Bench, bed: &Bed) -> Result<Measure, Failure> {
    let plane = arguments.section.as_deref();
    let plane = plane.map(|text| surface(text, bed)).transpose()?;
    if plane.is_some() && arguments.measure != Sense::Section {
        let text = "a surface says something with `--measure section` alone";
        let message = Message::option("--section", text);
        return Err(message
            .help("add `--measure section`, or leave the surface out")
            .into());
    }
    Ok(match arguments.measure {
        Sense::State => Measure::State,
        Sense::Energy => {
            let model = &bed.spec.model;
            if let Some(more) = model.beside_hamiltonian() {
                let text = format!("{more}, and the drift of its energy says nothing of a method");
                let message = Message::option("--measure", text);
                let help = "measure `state`, or `casimirs` where the system has one";
                return Err(message.help(help).into());
            }
            Measure::Energy
        }
        Sense::Phase => Measure::Phase,
        Sense::Section => Measure::Section(plane),
        Sense::Casimirs => {
            let model = &bed.spec.model;
            if model
                .casimirs
                .iter()
                .all(|casimir| casimir.multivalued || !casimir.kept)
            {
                let text = match (model.casimirs.len(), model.casimirs_to_find()) {
                    (0, 0) => format!("{} has no Casimir", model.name),
                    (0, _) => format!("no Casimir of {} is known", model.name),
                    _ => format!(
                        "every Casimir of {} jumps between branches, so that its drift says nothing",
                        model.name
                    ),
                };
                let message = Message::option("--measure", text);
                let help = match model.casimirs_to_find() {
                    0 => "measure `state` or `energy`",
                    _ => "declare one in the spec, or measure `state` or `energy`",
                };
                return Err(message.help(help).into());
            }
            Measure::Casimirs
        }
    })
}

/// `NAME=VALUE`.
fn surface(text: &str, bed: &Bed) -> Result<Plane, Message> {
    let layout = bed.layout();
    let coordinates = layout.coordinates();
    let names = || coordinates.iter().map(String::as_str);
    let given = OptionValue::flag("--section", text);
    let Some(equals) = text.find('=') else {
        let example = names().next().unwrap_or("x").to_owned();
        let message = given.wrong(format!("`{text}` is not NAME=VALUE"));
        return Err(message.help(format!("write it like `--section {example}=0`")));
    };
    let name = normalised(text[..equals].trim());
    let place = names().position(|known| known == name.as_str());
    let Some(place) = place else {
        let message = given
            .part(0..equals)
            .wrong(format!("unknown coordinate `{name}`"));
        return Err(message.help(match did_you_mean(name.as_str(), names()) {
            Some(near) => format!("did you mean `{near}`?"),
            None if layout.states > LISTED => format!(
                "there are {} coordinates: {}, …",
                layout.states,
                names().take(LISTED).collect::<Vec<_>>().join(", ")
            ),
            None => format!(
                "the coordinates are {}",
                names().collect::<Vec<_>>().join(", ")
            ),
        }));
    };
    Ok(Plane {
        coordinate: match bed.spec.model.family {
            Some(_) => place,
            None => bed.spec.model.shown_coordinates()[place],
        },
        value: given.part(equals + 1..text.len()).number()?,
    })
}

/// The name of a coordinate by its place in the state.
pub fn coordinate(bed: &Bed, place: usize) -> String {
    match bed.spec.model.family {
        Some(_) => bed.layout().columns.get(1 + place).into_owned(),
        None => bed.spec.model.coordinates[place].text.clone(),
    }
}

/// What times are given to, in the head of the table.
pub fn head(measure: Measure) -> &'static str {
    match measure {
        Measure::State => "a relative error at the end",
        Measure::Energy => "a largest relative drift of the energy",
        Measure::Casimirs => "a largest relative drift of a Casimir",
        Measure::Phase => "a difference in time at the end",
        Measure::Section(_) => "a relative distance on the surface of section",
    }
}

/// What is measured, in a word or two: the title of the picture.
pub fn word(measure: Measure) -> &'static str {
    match measure {
        Measure::State => "error",
        Measure::Energy => "energy drift",
        Measure::Casimirs => "Casimir drift",
        Measure::Phase => "difference in time",
        Measure::Section(_) => "distance on the section",
    }
}

/// The errors of the picture, in words.
pub fn axis(measure: Measure, until: f64) -> String {
    match measure {
        Measure::State => format!("relative error at t = {until}"),
        Measure::Energy => format!("largest relative drift of the energy to t = {until}"),
        Measure::Casimirs => format!("largest relative drift of a Casimir to t = {until}"),
        Measure::Phase => format!("difference in time at t = {until}"),
        Measure::Section(_) => {
            format!("relative distance on the surface of section to t = {until}")
        }
    }
}

/// The name of a method's least error.
pub fn least(measure: Measure) -> &'static str {
    match measure {
        Measure::State => "least error",
        Measure::Energy | Measure::Casimirs => "least drift",
        Measure::Phase => "least",
        Measure::Section(_) => "least distance",
    }
}
