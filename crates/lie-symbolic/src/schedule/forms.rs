//! The forms of a task that are tried: as derived, with the sums that were written taken apart, combined over
//! common powers; each of them collected by monomials, with definitions folded in, and factored.

use super::collect::Collector;
use super::{combine, factor, fold};
use crate::symbolic::{ExprId, Graph, Symbol};

/// The expressions of a task in one form: first those of the definitions, then the outputs.
pub type Roots = Vec<ExprId>;

/// The form in which the task was derived, and the same over common powers: what others are measured by.
pub fn references(graph: &mut Graph, roots: &[ExprId]) -> Vec<Roots> {
    let mut forms = vec![roots.to_vec()];
    forms.extend(combine::combine(graph, roots));
    forms
}

/// All other forms, without those that are known.
pub fn rewritten(graph: &mut Graph, references: &[Roots], collector: &mut Collector) -> Vec<Roots> {
    let mut bases: Vec<Roots> = references.to_vec();
    for form in references {
        let normal: Roots = form.iter().map(|id| graph.normal(*id)).collect();
        add(&mut bases, normal.clone());
        if let Some(combined) = combine::combine(graph, &normal) {
            add(&mut bases, combined);
        }
    }
    for index in 0..bases.len() {
        if let Some(collected) = collector.collect(graph, &bases[index]) {
            add(&mut bases, collected);
        }
    }
    bases.split_off(references.len())
}

/// A form with definitions folded in, factored, or both.
pub fn variants(
    graph: &mut Graph,
    symbols: &[Symbol],
    form: &Roots,
    collector: &mut Collector,
) -> Vec<Roots> {
    let known = collector.known();
    let mut forms = vec![form.clone()];
    if let Some(folded) = fold::fold(graph, symbols, form) {
        add(&mut forms, folded);
    }
    for index in 0..forms.len() {
        if let Some(factored) = factor::factor(graph, &forms[index], known, &mut collector.answers)
        {
            add(&mut forms, factored);
        }
    }
    forms
}

pub fn add(forms: &mut Vec<Roots>, form: Roots) {
    if !forms.contains(&form) {
        forms.push(form);
    }
}
