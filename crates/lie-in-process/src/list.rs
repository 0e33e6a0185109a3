//! The methods that are measured where none is named.

use lie_codegen::compile::with_options;
use lie_codegen::methods::{CATALOGUE, Choice, Lift, Method, refusal};
use lie_codegen::structure::Structure;

/// Every method that applies to a system, with every option that applies. Of the compositions, which are
/// as many as schemes times bases: every scheme of one base, and the lowest order of the other bases.
pub fn applicable(model: &Structure) -> Vec<Choice> {
    let (composing, plain): (Vec<&Method>, Vec<&Method>) = CATALOGUE
        .iter()
        .partition(|method| method.id.starts_with("compose"));
    let plain: Vec<Choice> = plain
        .iter()
        .filter_map(|method| Choice::from_id(method.id).ok())
        .collect();
    let mut all = with_options(model, &plain);
    // from order 8 on the smallest space is one of those that may be asked for, and another one is that of isospectral methods
    all.retain(
        |choice| !matches!(choice, Choice::Collective(8.., lift) if *lift != Lift::Smallest),
    );
    // Lie–Poisson bases first: what they keep, compositions keep
    let mut bases: Vec<Choice> = all
        .iter()
        .filter(|choice| {
            let fits = |method: &Method| method.symmetric && method.order == 2;
            choice.entry().is_some_and(fits) && !choice.is_near_integrable()
        })
        .cloned()
        .collect();
    bases.sort_by_key(|choice| {
        let keeps = choice.entry().map(|method| method.preserves);
        !keeps.is_some_and(|keeps| keeps.poisson)
    });
    for (number, base) in bases.iter().enumerate() {
        for (place, method) in composing.iter().enumerate() {
            let id = format!("{}({})", method.id, base.id());
            let Ok(composed) = Choice::from_id(&id) else {
                continue;
            };
            let of_base = composed
                .variants()
                .into_iter()
                .filter(|choice| choice.solved() == base && refusal(model, choice).is_none());
            let wanted = match (number, place) {
                (0, _) => usize::MAX,
                (_, 0) => 1,
                _ => 0,
            };
            all.extend(of_base.take(wanted));
        }
    }
    all
}

/// The same with the default schemes of compositions and splittings alone, and of the bases of compositions one
/// for each set of invariants that they keep.
pub fn fewer(model: &Structure) -> Vec<Choice> {
    let scheme = |choice: &Choice| {
        let options = choice.options();
        let found = options.iter().find(|(name, _)| *name == "composition");
        found.map(|(_, value)| *value)
    };
    let mut all = applicable(model);
    all.retain(|choice| {
        Choice::from_id(&choice.id()).is_ok_and(|default| scheme(&default) == scheme(choice))
    });
    let mut bases: Vec<Choice> = Vec::new();
    for choice in &all {
        let base = choice.solved();
        let kept = |choice: &Choice| {
            choice
                .entry()
                .map(|method| (method.explicit, method.preserves))
        };
        let known = bases.iter().any(|known| kept(known) == kept(base));
        if base != choice && !known {
            bases.push(base.clone());
        }
    }
    all.retain(|choice| choice.solved() == choice || bases.contains(choice.solved()));
    all
}
