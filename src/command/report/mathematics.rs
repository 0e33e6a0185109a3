//! What the mathematics of a system is, in formulas.

use lie_codegen::model::configuration::WIENER;
use lie_codegen::model::{Driving, QuantityKind};
use lie_codegen::plan::plan;
use lie_codegen::structure::Structure;
use lie_in_process::formula::names;
use lie_syntax::front::Names;

use super::mathml::{formula, identifier};
use super::page::escaped;

/// Brackets beyond this number say less than the name of the algebra.
const MOST: usize = 24;

/// Formulas under their titles.
pub fn formulas(model: &Structure) -> Vec<(&'static str, Vec<String>)> {
    let names = names(model);
    let mut all = Vec::new();
    let brackets = brackets(model, &names);
    if !brackets.is_empty() {
        all.push(("Brackets of the algebra:", brackets));
    }
    let brackets = poisson_brackets(model, &names);
    if !brackets.is_empty() {
        let title = match model.is_almost_poisson() {
            true => "Almost-Poisson brackets:",
            false => "Poisson brackets:",
        };
        all.push((title, brackets));
    }
    let energy = match (&model.family, model.energy.expression()) {
        (Some(family), _) => Some(model.display_of_family(family)),
        (None, Some(hamiltonian)) => Some(model.display(hamiltonian.energy)),
        (None, None) => None,
    };
    if let Some(energy) = energy {
        all.push((
            "Hamiltonian:",
            vec![formula(&format!("H = {energy}"), &names)],
        ));
    }
    if let Some(lagrangian) = model.energy.lagrangian() {
        let (title, name) = match lagrangian.reduced {
            true => ("Reduced Lagrangian:", "l"),
            false => ("Lagrangian:", "L"),
        };
        let text = format!("{name} = {}", model.display(lagrangian.value));
        all.push((title, vec![formula(&text, &names)]));
    }
    let acting = model.acting().into_iter();
    let acting: Vec<String> = acting
        .map(|(what, formula)| {
            format!(
                "<p>{}: <code>{}</code></p>",
                escaped(&what),
                escaped(&formula)
            )
        })
        .collect();
    if !acting.is_empty() {
        all.push(("Beside the Hamiltonian:", acting));
    }
    let casimirs = model.casimirs.iter();
    let casimirs = casimirs.map(|casimir| {
        let text = format!("{} = {}", casimir.name, model.display(casimir.expr));
        let formula = formula(&text, &names);
        match casimir.kept {
            true => formula,
            false => format!("{formula}<p>It is not kept: what acts changes it.</p>"),
        }
    });
    let casimirs: Vec<String> = casimirs.collect();
    if !casimirs.is_empty() {
        all.push(("Casimirs:", casimirs));
    }
    for (kind, title) in [
        (QuantityKind::Integral, "First integrals:"),
        (QuantityKind::Observable, "Observables:"),
    ] {
        let quantities = model
            .quantities
            .iter()
            .filter(|quantity| quantity.kind == kind);
        let formulas = quantities.map(|quantity| {
            let text = format!("{} = {}", quantity.name, model.display_quantity(quantity));
            formula(&text, &names)
        });
        let formulas: Vec<String> = formulas.collect();
        if !formulas.is_empty() {
            all.push((title, formulas));
        }
    }
    if model.family.is_none() {
        let plan = plan(model, &[]);
        let lines = plan
            .system
            .poisson
            .iter()
            .flat_map(|kernel| kernel.explicit.iter());
        let hidden = |name: &str| {
            let shown = model.shown_coordinates();
            let place = model.coordinates.iter().position(|c| c.text == name);
            place.is_some_and(|place| !shown.contains(&place))
        };
        let motion = lines.filter(|line| {
            let left = line.split_once('=').map(|(left, _)| left.trim());
            let name = left.and_then(|left| left.strip_suffix('\''));
            name.is_some_and(|name| !hidden(name))
        });
        let mut motion: Vec<String> = motion.map(|line| formula(line, &names)).collect();
        if !motion.is_empty() {
            motion.extend(processes(model));
            all.push(("Equations of motion:", motion));
        }
    }
    all
}

/// What the rates of noise in the equations are.
fn processes(model: &Structure) -> Option<String> {
    let noisy = model.driving.as_ref().is_some_and(Driving::is_noisy);
    let rate = identifier(WIENER);
    noisy.then(|| {
        format!("<p><math>{rate}</math> are the rates of the Wiener processes of the noise, in the sense of Stratonovich.</p>")
    })
}

/// `[e1, e2] = e3`
fn brackets(model: &Structure, names: &Names) -> Vec<String> {
    let Some(algebra) = model.bracket.algebra() else {
        return Vec::new();
    };
    let size = algebra.basis.len();
    let pairs = (0..size).flat_map(|i| (i + 1..size).map(move |j| (i, j)));
    let pairs: Vec<(usize, usize)> = pairs
        .filter(|(i, j)| !algebra.constants.upper(*i, *j).is_empty())
        // what carries the time has names that nobody wrote
        .filter(|(i, j)| {
            [i, j]
                .iter()
                .all(|k| !algebra.basis[**k].text.starts_with('_'))
        })
        .collect();
    if pairs.len() > MOST {
        return vec![format!(
            "<p>{} brackets that are not zero, of {size} elements</p>",
            pairs.len()
        )];
    }
    let bracket = |(i, j): (usize, usize)| {
        let terms = algebra.constants.upper(i, j).iter().map(|(.., k, value)| {
            format!("({})*{}", model.display(*value), algebra.basis[*k].text)
        });
        let text = terms
            .collect::<Vec<_>>()
            .join(" + ")
            .replace("(1)*", "")
            .replace("(-1)*", "-");
        let name = |i: usize| &*algebra.basis[i].text;
        bracketed(['[', ']'], [name(i), name(j)], &text, names)
    };
    pairs.into_iter().map(bracket).collect()
}

/// `{q, p} = 1`, where structure constants do not say it all.
fn poisson_brackets(model: &Structure, names: &Names) -> Vec<String> {
    let Some(matrix) = model.bracket.matrix() else {
        return Vec::new();
    };
    if matrix.entries.len() > MOST {
        let many = matrix.entries.len();
        return vec![format!("<p>{many} brackets that are not zero</p>")];
    }
    let bracket = |&(i, j, value): &(usize, usize, _)| {
        let name = |i: usize| &*model.coordinates[i].text;
        bracketed(['{', '}'], [name(i), name(j)], &model.display(value), names)
    };
    matrix.entries.iter().map(bracket).collect()
}

/// A bracket of two names, and what it is.
fn bracketed([open, close]: [char; 2], of: [&str; 2], value: &str, names: &Names) -> String {
    let [first, second] = of.map(identifier);
    let left = format!("<mo>{open}</mo>{first}<mo>,</mo>{second}<mo>{close}</mo><mo>=</mo>");
    formula(value, names).replacen("<mrow>", &format!("<mrow>{left}"), 1)
}
