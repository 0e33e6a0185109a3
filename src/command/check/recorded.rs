//! What `lie check` says of first integrals and observables.

use std::fmt::Write as _;

use lie_codegen::model::QuantityKind;
use lie_codegen::structure::Structure;
use lie_codegen::structure::integrals::brackets;

/// Them, and the brackets of the first integrals with each other.
pub(super) fn write(model: &Structure, text: &mut String) -> std::fmt::Result {
    for (kind, title) in [
        (QuantityKind::Integral, "first integrals, proven"),
        (QuantityKind::Observable, "observables"),
    ] {
        let quantities = model.quantities.iter();
        let mut quantities = quantities
            .filter(|quantity| quantity.kind == kind)
            .peekable();
        if quantities.peek().is_some() {
            writeln!(text, "  {title}:")?;
        }
        for quantity in quantities {
            let angle = if quantity.unwrap { ", unwrapped" } else { "" };
            let (name, value) = (&quantity.name, model.display_quantity(quantity));
            writeln!(text, "    {name} = {value}{angle}")?;
        }
        if kind == QuantityKind::Integral {
            write_brackets(model, text)?;
        }
    }
    Ok(())
}

fn write_brackets(model: &Structure, text: &mut String) -> std::fmt::Result {
    let brackets = brackets(model);
    if !brackets.is_empty() && brackets.iter().all(|bracket| bracket.value.is_none()) {
        return writeln!(text, "    all brackets of them with each other are 0");
    }
    for bracket in brackets {
        let ([a, b], value) = (bracket.of, bracket.value);
        let value = value.unwrap_or_else(|| "0".to_owned());
        writeln!(text, "    {{{a}, {b}}} = {value}")?;
    }
    Ok(())
}
