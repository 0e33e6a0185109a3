//! The doc lines of a system.

use crate::model::{Bracket, Model};
use crate::structure::Structure;

/// What the bracket is, in words.
fn bracket_in_words(model: &Model) -> String {
    let dimension = model.dimension();
    let dual = format!("on the dual of a Lie algebra of dimension {dimension}");
    match &model.bracket {
        Bracket::Lie(_) => dual,
        Bracket::General(matrix) => {
            let brackets = matrix.entries.iter().map(|(i, j, value)| {
                let [a, b] = [*i, *j].map(|index| &model.coordinates[index].text);
                format!("`{{{a}, {b}}} = {}`", model.display(*value))
            });
            let brackets: Vec<String> = brackets.collect();
            match brackets.as_slice() {
                [] => "with the bracket that is zero".into(),
                brackets => format!("with the brackets {}", brackets.join(", ")),
            }
        }
    }
}

/// The algebra by name and class; nothing where there is none, or where it is too large for a declaration.
fn algebra_in_words(structure: &Structure) -> Option<String> {
    let report = structure.algebra.as_ref()?;
    let class = report.class.words();
    let at_defaults = report.at_defaults.is_some();
    let generic = if at_defaults {
        " for generic parameters"
    } else {
        ""
    };
    Some(match &report.name {
        Ok(name) if at_defaults => {
            format!("The algebra is `{name}` at the default parameters, and {class}{generic}.")
        }
        Ok(name) => format!("The algebra is `{name}`: {class}."),
        Err(_) => format!("The algebra is {class}{generic}."),
    })
}

/// The doc lines of the generated type: the user's own, then the mathematics.
pub(super) fn docs(structure: &Structure) -> Vec<String> {
    let model = &structure.model;
    let mut docs = model.description.clone();
    let names: Vec<&str> = model.coordinates.iter().map(|c| c.text.as_str()).collect();
    docs.push(String::new());
    let energy = match model.energy.expression() {
        Some(hamiltonian) => format!("`H = {}`", model.display(hamiltonian.energy)),
        None => "The Legendre transform of its Lagrangian, by Newton's iteration,".to_owned(),
    };
    if let Some(lagrangian) = model.energy.lagrangian() {
        let velocity: Vec<&str> = lagrangian
            .velocity
            .iter()
            .map(|v| v.text.as_str())
            .collect();
        if let Some(discrete) = &lagrangian.discrete {
            docs.push(format!(
                "Discrete Lagrangian `l_d = {}` of a step with the coordinates `{}`.",
                model.display(discrete.shown()),
                velocity.join(", ")
            ));
        }
        docs.push(format!(
            "Lagrangian `l = {}` of the velocity `{}`.",
            model.display(lagrangian.value),
            velocity.join(", ")
        ));
    }
    if let Some(family) = &model.family {
        let energy = model.display_of_family(family);
        docs.push(format!("`H = {energy}` on a family of sites,"));
        docs.push(
            "a state holds the first coordinates of all of them, then the second, and so on."
                .into(),
        );
    }
    let each = if model.family.is_some() {
        "Each site".to_owned()
    } else {
        energy
    };
    docs.push(format!("{each} {},", bracket_in_words(model)));
    docs.push(format!(
        "coordinates `{}`; the Poisson matrix has generic rank {}.",
        names.join(", "),
        model.generic_rank
    ));
    if let Some(constraint) = &model.constraint {
        let basis = constraint.basis_in_words(model).into_iter();
        let basis = basis.map(|(coordinate, element)| format!("`{coordinate}` along `{element}`"));
        docs.push(format!(
            "Constraint `{}` on the velocity: the bracket is almost Poisson, with the momenta {}.",
            constraint.forms.join(", "),
            basis.collect::<Vec<_>>().join(", ")
        ));
    }
    if let Some(configuration) = &model.configuration {
        docs.push(format!("Coordinates: {}.", configuration.description()));
    }
    docs.extend(algebra_in_words(structure));
    if !structure.casimirs.is_empty() {
        let casimirs: Vec<String> = structure
            .casimirs
            .iter()
            .map(|c| format!("`{} = {}`", c.name, model.display(c.expr)))
            .collect();
        let missing = model.casimirs_to_find().saturating_sub(casimirs.len());
        let missing = match missing {
            0 => String::new(),
            _ => format!(
                " ({} of {} known)",
                casimirs.len(),
                casimirs.len() + missing
            ),
        };
        docs.push(format!("Casimirs: {}{missing}.", casimirs.join(", ")));
    }
    for (what, formula) in model.acting() {
        docs.push(format!("Beside H: {what}: `{formula}`."));
    }
    for casimir in structure.casimirs.iter().filter(|c| !c.kept) {
        docs.push(format!("What acts changes `{}`.", casimir.name));
    }
    if !structure.quantities.is_empty() {
        let quantities = structure.quantities.iter();
        let names: Vec<String> = quantities
            .map(|q| format!("`{}` ({})", q.name, q.kind.name()))
            .collect();
        docs.push(format!("Recorded: {}.", names.join(", ")));
    }
    for casimir in structure.casimirs.iter().filter(|c| c.multivalued) {
        docs.push(format!(
            "`{}` is multi-valued: it may jump, and its drift is not measured.",
            casimir.name
        ));
    }
    for reference in &model.references {
        docs.push(String::new());
        docs.push(format!("Reference: {reference}"));
    }
    docs.into_iter()
        .map(|line| line.trim_end().to_string())
        .collect()
}
