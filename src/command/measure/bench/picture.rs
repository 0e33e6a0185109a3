//! The picture of `lie bench`: error against run time, a panel for each set of what methods keep.

use super::by_method;
use crate::command::measure::{Bed, sense};
use lie_codegen::methods::Choice;
use lie_measure::bench::{Options, Point, Reference};
use lie_plot::frontier::{Curve, Frontier};

/// The name of a method without its order and options; the base of a composition belongs to it.
fn family(label: &str) -> String {
    let id = label.split(' ').next().unwrap_or(label);
    id.chars().filter(|c| !c.is_ascii_digit()).collect()
}

/// What a method keeps, in a few words; compositions keep what their base keeps.
fn class(choice: Option<&Choice>) -> String {
    let Some(method) = choice.and_then(|choice| choice.solved().entry()) else {
        return "controls".to_owned();
    };
    let kept = method.preserves;
    let words = match (kept.poisson, kept.orbit, kept.energy) {
        (true, _, true) => "Poisson and energy",
        (true, _, false) if method.explicit => "Poisson, explicit",
        (true, _, false) => "Poisson",
        (false, true, true) => "orbit and energy",
        (false, true, false) => "orbit",
        (false, false, true) => "energy, quadratic Casimirs",
        (false, false, false) if kept.quadratic_invariants => "quadratic invariants",
        _ => "controls",
    };
    words.to_owned()
}

/// The picture as SVG.
pub(super) fn draw(
    bed: &Bed,
    options: &Options,
    points: &[Point],
    reference: Option<Reference>,
) -> String {
    let errors = sense::axis(options.measure, options.until);
    let curves = by_method(points).into_iter().map(|(method, points)| {
        let choice = bed.choices.iter().find(|choice| choice.label() == method);
        let control = class(choice) == "controls";
        Curve {
            name: choice.map_or(method.to_owned(), Choice::title),
            class: class(choice),
            family: family(method),
            order: choice
                .and_then(Choice::entry)
                .map_or(if method.ends_with("853") { 8 } else { 5 }, |m| m.order),
            control,
            points: points.iter().map(|p| (p.seconds, p.error)).collect(),
        }
    });
    Frontier {
        title: format!(
            "{}: {} against run time",
            bed.spec.model.name,
            sense::word(options.measure)
        ),
        subtitle: format!("{errors} against run time per unit of time"),
        axis: sense::word(options.measure).to_owned(),
        floor: reference.map_or(f64::NAN, |reference| reference.floor),
        curves: curves.collect(),
    }
    .to_svg()
}
