//! What a family of systems cannot have.

use lie_core::lattice::AXES;
use lie_syntax::ast::{Declaration, Dissipation, DissipationKind, Energy, Family, Structure};
use lie_syntax::diagnostic::{Diagnostic, Kind};

/// Sites, and how they are numbered.
const LATTICES: &str = "write `so(3)^N` with `x[i]`, `so(3)^(N, M)` with `x[i, j]`, or `so(3)^(L, N, M)` with `x[i, j, k]`";

/// What a family cannot have.
pub fn violations(declaration: &Declaration, family: &Family) -> Vec<Diagnostic> {
    let mut mistakes = Vec::new();
    let mut refuse = |place, message: &str, help: &str| {
        mistakes.push(Diagnostic::new(Kind::Schema, place, message).help(help));
    };
    match &declaration.structure {
        Structure::Lie { cocycle, .. } if cocycle.is_empty() => {}
        Structure::Lie { .. } | Structure::General { .. } => refuse(
            declaration.place(),
            "a family consists of copies of a Lie algebra, without other brackets",
            "write `algebra` alone, such as `so(3)^N`",
        ),
    }
    if !matches!(declaration.energy, Energy::Hamiltonian(_)) {
        let place = declaration.energy.expression().origin;
        let help = "write `hamiltonian`, a function of sums such as `sum(i in 0..N: x[i]*x[i+1])`";
        refuse(place, "a family is given by its Hamiltonian", help);
    }
    if let Some(name) = &declaration.group {
        let message = "the group element of a family is not followed";
        refuse(name.origin, message, "remove `group`");
    }
    if let Some(attitude) = &declaration.attitude {
        let message = "the group elements of the sites of a family are not followed";
        refuse(attitude.origin, message, "remove `attitude`");
    }
    let mut dissipation = declaration.dissipation.iter();
    let metriplectic = |d: &&Dissipation| matches!(d.kind, DissipationKind::Metriplectic { .. });
    if let Some(entry) = dissipation.find(metriplectic) {
        let message = "the metric of a family acts at each site, where H is shared with others: K grad H = 0 is not proven";
        let help = "use `double-bracket` or `rayleigh`, or declare the sites as one system: `so(3)^3` without an index in the state";
        refuse(entry.origin, message, help);
    }
    if let Some(event) = declaration.events.first() {
        let message = "events of a family are not found";
        let help = "remove it, or declare the sites as one system: `so(3)^3` without an index in the state";
        refuse(event.name.origin, message, help);
    }
    if let Some((name, _)) = declaration.integrals.first() {
        let message = "first integrals of a family are not proven";
        let help = "remove it, or declare it among the `observables`: a function of sums such as `sum(i in 0..N: z[i])`";
        refuse(name.origin, message, help);
    }
    if let Some(bonds) = &family.bonds {
        if family.indices.len() > 1 {
            let count = family.indices.len();
            let message =
                format!("bonds join the sites of a chain, and these have {count} indices");
            let help = "number the sites by one index, `so(3)^N` with `x[i]`: with bonds they may be those of any lattice";
            refuse(bonds.origin, &message, help);
        }
        let parameters = declaration.parameters.iter().map(|p| &p.name);
        let lets = declaration.lets.iter().map(|(name, _)| name);
        let data = family.data.iter().map(|data| &data.name);
        let inputs = declaration.inputs.iter().map(|input| &input.name);
        let mut names = declaration
            .state
            .iter()
            .chain(parameters)
            .chain(lets)
            .chain(data)
            .chain(inputs);
        if let Some(name) = names.find(|name| name.text == "value") {
            let message = "`value` is the number of a bond in sums over bonds";
            refuse(name.origin, message, "choose another name");
        }
    }
    if let Some(realization) = &declaration.realization {
        let message = "a family takes no realization";
        refuse(realization.origin, message, "remove `realization`");
    }
    if let Some(retraction) = &declaration.retraction {
        let message = "a family takes no retraction";
        refuse(retraction.origin, message, "remove `retraction`");
    }
    if family.sizes.len() != family.indices.len() {
        let (sizes, indices) = (family.sizes.len(), family.indices.len());
        let message = format!("{indices} in the names of the state, and {sizes} in the algebra");
        let message = format!("the numbers of indices differ: {message}");
        refuse(declaration.place(), &message, LATTICES);
    } else if family.sizes.len() > AXES {
        let message = format!("lattices have at most {AXES} dimensions");
        refuse(declaration.place(), &message, LATTICES);
    }
    mistakes
}
