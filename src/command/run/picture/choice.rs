//! `--picture`: components, orbit, phase, section, attitude, compare.

use lie_codegen::structure::Structure;
use lie_codegen::structure::group;
use lie_in_process::request::{OptionValue, Several};
use lie_in_process::words::counted;
use lie_syntax::suggest::did_you_mean;

use super::section::Chosen;
use crate::build;
use crate::command::args;
use crate::command::run::layout::Layout;
use crate::compiler::Spec;
use crate::message::Message;

const FLAG: &str = "--picture";
const NAMES: [&str; 6] = [
    "components",
    "orbit",
    "phase",
    "section",
    "attitude",
    "compare",
];

/// What is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// Coordinates and errors of invariants over time.
    Components,
    /// The coadjoint orbit of a three-dimensional algebra, with level curves of H.
    Orbit,
    /// One coordinate against another.
    Phase([usize; 2]),
    /// The points in which a coordinate rises through a value.
    Section(Chosen),
    /// The third axis of a rotation.
    Attitude,
    /// Several runs side by side.
    Compare,
}

/// What the flags ask for; none where nothing is drawn.
///
/// # Errors
/// `option`: there is no such picture, or none of this system.
pub fn kind(
    spec: &Spec,
    flags: &args::Run,
    several: &Several,
    layout: &Layout,
) -> Result<Option<Kind>, Message> {
    let Some(text) = &flags.picture else {
        let kind = match several.members.len() {
            1 => Kind::Components,
            _ => Kind::Compare,
        };
        return match flags.plot.is_some() {
            true => few(kind, several).map(Some),
            false => Ok(None),
        };
    };
    let given = OptionValue::flag(FLAG, text);
    if flags.plot.is_none() {
        let message = given.wrong("there is no file for the picture");
        return Err(message.help(format!(
            "add `--plot {}.svg`",
            spec.model.name.to_lowercase()
        )));
    }
    let (name, rest) = match text.split_once(':') {
        Some((name, rest)) => (name, Some(given.part(text.len() - rest.len()..text.len()))),
        None => (text.as_str(), None),
    };
    if let (Some(rest), false) = (&rest, matches!(name, "phase" | "section")) {
        let message = rest.wrong(format!("`{name}` takes no choice"));
        return Err(message.help(format!("write `--picture {name}`")));
    }
    let kind = match name {
        "components" => Kind::Components,
        "compare" => Kind::Compare,
        "orbit" => orbit(spec, &given)?,
        "attitude" => attitude(spec, several, &given)?,
        "phase" => Kind::Phase(axes(layout, rest.as_ref(), &given)?),
        "section" => section(spec, layout, rest.as_ref(), &given)?,
        other => {
            let message = given.wrong(format!("there is no picture `{other}`"));
            let help = match did_you_mean(other, NAMES.iter().copied()) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("the pictures are {}", NAMES.join(", ")),
            };
            return Err(message.help(help));
        }
    };
    few(kind, several).map(Some)
}

/// The most runs that colours tell apart.
const MOST: usize = 14;

fn few(kind: Kind, several: &Several) -> Result<Kind, Message> {
    let runs = several.members.len();
    let most = match kind {
        Kind::Components => 1,
        Kind::Phase(_) | Kind::Section(_) => usize::MAX,
        _ => MOST,
    };
    if runs <= most {
        return Ok(kind);
    }
    let text = format!("{runs} runs are too many for this picture, which takes {most}");
    let help = match kind {
        Kind::Components => "take `--picture compare`, `phase` or `section`",
        _ => "take fewer runs, or `--picture phase`, which takes any number",
    };
    Err(Message::option("--plot", text).help(help))
}

fn orbit(spec: &Spec, given: &OptionValue) -> Result<Kind, Message> {
    match no_orbit(&spec.model) {
        Some(why) => Err(given.wrong(why).help(elsewhere(&spec.model))),
        None => Ok(Kind::Orbit),
    }
}

/// What is drawn of systems of which a picture says nothing.
fn elsewhere(model: &Structure) -> &'static str {
    match model.counts().0 {
        1 if model.family.is_none() => "take `--picture components`",
        _ => "take `--picture phase`, which draws one coordinate against another",
    }
}

/// Why no orbit is drawn of a system; none where one is, as of motion that is damped along its orbit.
pub fn no_orbit(model: &Structure) -> Option<String> {
    let n = model.shown_coordinates().len();
    if model.family.is_some() {
        return Some(format!(
            "{} is a family, and orbits are drawn of systems with 3 coordinates",
            model.name
        ));
    }
    if model.is_energy_driven() {
        return Some(format!(
            "H of {} changes with the time, and an orbit has level curves of one that does not",
            model.name
        ));
    }
    if let Some(left) = model.casimirs.iter().find(|casimir| !casimir.kept) {
        return Some(format!(
            "what acts beside H of {} changes the Casimir {}: the motion leaves its orbit",
            model.name, left.name
        ));
    }
    if n != 3 {
        return Some(format!(
            "{} has {}, and orbits are drawn of systems with 3",
            model.name,
            counted(n as u64, "coordinate")
        ));
    }
    if model.casimirs.len() != 1 {
        return Some(format!(
            "{} has {} Casimirs, and an orbit that is a surface has one",
            model.name,
            model.casimirs.len()
        ));
    }
    if build::declared(model).is_none() {
        return Some(format!(
            "the Hamiltonian of {} is not known to the command as an expression",
            model.name
        ));
    }
    None
}

fn attitude(spec: &Spec, several: &Several, given: &OptionValue) -> Result<Kind, Message> {
    let followed = several.plans.iter().all(|plan| plan.chart.is_some());
    let name = &spec.model.name;
    let wrong = match group::group(&spec.model) {
        None => Some(format!("{name} has no group of matrices that is followed")),
        Some(group) => (!group.turns_space()).then(|| {
            format!("the matrices of {name} do not begin with a rotation of three rows and columns")
        }),
    };
    if let Some(text) = wrong {
        return Err(given.wrong(text).help(elsewhere(&spec.model)));
    }
    match followed {
        true => Ok(Kind::Attitude),
        false => {
            let message = given.wrong("the group element is not followed");
            Err(message.help(
                "add `--group matrix`, or for rotations `--group quaternion` or Euler angles",
            ))
        }
    }
}

fn coordinate(layout: &Layout, given: &OptionValue) -> Result<usize, Message> {
    named(&layout.coordinates(), "coordinate", given)
}

/// The column behind the time with a name: a coordinate, or what is recorded beside the state.
fn column(layout: &Layout, given: &OptionValue) -> Result<usize, Message> {
    match layout.columns.made(1..layout.element) {
        // of a family the columns behind the state are those of all its sites
        columns if layout.has_recorded() => named(&columns, "column", given),
        _ => coordinate(layout, given),
    }
}

fn named(names: &[String], what: &str, given: &OptionValue) -> Result<usize, Message> {
    let name = given.text.trim();
    names.iter().position(|known| known == name).ok_or_else(|| {
        let message = given.wrong(format!("unknown {what} `{name}`"));
        let known = names.iter().map(String::as_str);
        message.help(match did_you_mean(name, known) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!(
                "the {what}s are {}",
                names[..names.len().min(12)].join(", ")
            ),
        })
    })
}

fn axes(
    layout: &Layout,
    rest: Option<&OptionValue>,
    given: &OptionValue,
) -> Result<[usize; 2], Message> {
    if layout.states < 2 {
        return Err(given
            .wrong("there is one coordinate alone")
            .help("take `--picture components`"));
    }
    let Some(rest) = rest else { return Ok([0, 1]) };
    match rest.split().as_slice() {
        [x, y] => Ok([column(layout, x)?, column(layout, y)?]),
        _ => {
            let names = layout.columns.made(1..3);
            let message = rest.wrong("a phase portrait has two coordinates");
            Err(message.help(format!(
                "write it like `--picture phase:{}`",
                names.join(",")
            )))
        }
    }
}

fn section(
    spec: &Spec,
    layout: &Layout,
    rest: Option<&OptionValue>,
    given: &OptionValue,
) -> Result<Kind, Message> {
    let (n, ..) = spec.model.counts();
    if n < 3 || layout.states != n || build::declared(&spec.model).is_none() {
        let model = &spec.model;
        let name = &model.name;
        let text = if let Some(more) = model.beside_hamiltonian() {
            format!("{more}, and sections are drawn of motion by H alone, on which it is constant")
        } else if model.family.is_some() {
            format!("{name} is a family, and sections are drawn of single systems")
        } else if n < 3 {
            "a section needs three coordinates".to_owned()
        } else if layout.states != n {
            format!(
                "{name} carries the time beside its coordinates, and sections are drawn without it"
            )
        } else {
            format!("the Hamiltonian of {name} is not known to the command as an expression")
        };
        return Err(given.wrong(text).help(elsewhere(model)));
    }
    let (place, value) = match rest {
        None => (0, 0.0),
        Some(rest) => match rest.text.split_once('=') {
            None => (coordinate(layout, rest)?, 0.0),
            Some((name, _)) => {
                let value = rest.part(name.len() + 1..rest.text.len()).number()?;
                (coordinate(layout, &rest.part(0..name.len()))?, value)
            }
        },
    };
    let mut others = (0..n).filter(|k| *k != place);
    let axes = [(); 2].map(|()| others.next().unwrap_or(0));
    Ok(Kind::Section(Chosen {
        coordinate: place,
        value,
        axes,
    }))
}
