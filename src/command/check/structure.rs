//! What `lie check` says of the algebra.

use std::fmt::Write as _;

use lie_codegen::structure::algebra::{Report, Series};

fn dimensions(series: &[usize]) -> String {
    let all: Vec<String> = series.iter().map(usize::to_string).collect();
    all.join(", ")
}

/// The algebra by lines.
pub(super) fn write(report: &Report, text: &mut String) -> std::fmt::Result {
    let (generic, at_defaults) = match report.at_defaults {
        Some(_) => (
            ", for generic values of the parameters",
            " at the default parameters",
        ),
        None => ("", ""),
    };
    match (&report.name, report.alias()) {
        (Ok(name), Some(alias)) => writeln!(text, "  algebra: {name}{at_defaults} ({alias})")?,
        (Ok(name), None) => writeln!(text, "  algebra: {name}{at_defaults}")?,
        (Err(what), _) => writeln!(text, "  algebra: not recognised{at_defaults}: {what}")?,
    }
    writeln!(text, "    class: {}{generic}", report.class.words())?;
    write_series(&report.series, text)?;
    match &report.at_defaults {
        Some((class, series)) if report.has_special_defaults() => {
            writeln!(
                text,
                "    the default parameters are special: there it is {}",
                class.words()
            )?;
            write_series(series, text)?;
        }
        Some(_) => writeln!(
            text,
            "    other values of the parameters, above all zero and another sign, may give another algebra"
        )?,
        None => {}
    }
    Ok(())
}

fn write_series(series: &Series, text: &mut String) -> std::fmt::Result {
    writeln!(
        text,
        "    dimensions: derived series {}; lower central series {}; centre {}; radical {}",
        dimensions(&series.derived),
        dimensions(&series.lower_central),
        series.centre,
        series.radical,
    )?;
    let killing = series.killing;
    writeln!(
        text,
        "    Killing form: {} positive, {} negative, {} zero",
        killing.positive, killing.negative, killing.zero
    )
}
