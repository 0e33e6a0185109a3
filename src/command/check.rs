//! `lie check`: what a spec declares, and what can be done with it.

mod casimirs;
mod constraint;
mod joints;
mod motions;
mod recorded;
mod signs;
mod splitting;
mod structure;

use std::fmt::Write as _;
use std::path::Path;

use lie_codegen::methods::{Choice, refusal};
use lie_codegen::structure::{Effort, Structure, bracket_class};
use lie_in_process::report::{Report, sites};
use lie_in_process::request::{self, Request, several};
use lie_in_process::words::{by, counted};
use lie_program::protocol::Start;
use lie_runtime::lattice::{AXES, count, shown};
use lie_syntax::ast::BONDS;
use serde_json::Value;

use super::{args, print};
use crate::compiler::{self, Spec};
use crate::message::{Failure, INVALID, Message, SURROUNDINGS};
use crate::render;

/// Checks specs and reports on those that are sound.
///
/// # Errors
/// Mistakes of any of them, after the reports on the others.
pub fn run(arguments: &args::Check) -> Result<u8, Failure> {
    let mut reports = Vec::new();
    let mut failure = Failure {
        messages: Vec::new(),
        code: 0,
    };
    let effort = if arguments.deep {
        Effort::Deep
    } else {
        Effort::Report
    };
    for path in &arguments.specs {
        match compiler::load_with(path, effort) {
            Ok(spec) => {
                render::print(&spec.warnings());
                if let Err(found) = defaults_of_run(&spec) {
                    failure.code = INVALID;
                    failure.messages.extend(found);
                    continue;
                }
                let report = Words(Report::new(&spec.model));
                if arguments.json {
                    reports.push(report.0.json(&spec.model));
                } else {
                    print(&report.text(&spec, path))?;
                }
            }
            Err(found) => {
                // An invalid spec outweighs one that cannot be read.
                let unread = found.code == SURROUNDINGS && failure.code != 0;
                failure.code = if unread { failure.code } else { found.code };
                failure.messages.extend(found.messages);
            }
        }
    }
    if arguments.json && !reports.is_empty() {
        let single = arguments.specs.len() == 1;
        let value = if single {
            reports.swap_remove(0)
        } else {
            Value::from(reports)
        };
        print(&format!("{value:#}\n"))?;
    }
    if failure.messages.is_empty() {
        Ok(0)
    } else {
        Err(failure)
    }
}

/// The `run` of a spec as `lie run` would take it without flags. Without an initial state the flags
/// have to bring one.
fn defaults_of_run(spec: &Spec) -> Result<(), Vec<Message>> {
    let family = spec.model.family.as_ref();
    let start = family.is_some_and(|family| family.start.is_some());
    if spec.model.run.is_empty() || (spec.model.initial.is_none() && !start) {
        return Ok(());
    }
    several(spec, &Request::default()).map(|_| ())
}

/// The initial state of a spec, if it has one, where it says which way the time goes.
fn start(spec: &Spec) -> Option<Start> {
    if spec.model.directions.pairs.is_empty() {
        return None;
    }
    let start = request::start(spec, &Request::default()).ok();
    start.map(|start| start.named(spec))
}

/// A report in words.
struct Words(Report);

impl Words {
    fn text(&self, spec: &Spec, path: &Path) -> String {
        let mut text = format!("{} ({})\n", spec.model.name, path.display());
        // Writing to a string does not fail.
        let _ = self.write(&spec.model, start(spec).as_ref(), &mut text);
        text.push('\n');
        text
    }

    fn write(
        &self,
        model: &Structure,
        start: Option<&Start>,
        text: &mut String,
    ) -> std::fmt::Result {
        write_system(model, text)?;
        signs::write(model, start, text)?;
        motions::write(model, text)?;
        splitting::write(model, &self.0.splitting, text)?;
        self.write_operations(text)?;
        self.write_methods(model, text)?;
        joints::write(&model.joints, &self.0.methods, text)
    }

    /// The operations of each kernel.
    fn write_operations(&self, text: &mut String) -> std::fmt::Result {
        let widest = self
            .0
            .operations
            .iter()
            .map(|(kernel, _)| kernel.chars().count())
            .max();
        let widest = widest.unwrap_or(0).max(10);
        writeln!(
            text,
            "  operations {:widest$}   add   mul   div  call",
            "",
            widest = widest - 8
        )?;
        for (kernel, [add, mul, div, call]) in &self.0.operations {
            writeln!(
                text,
                "    {kernel:widest$} {add:5} {mul:5} {div:5} {call:5}"
            )?;
        }
        Ok(())
    }

    /// The methods that apply, and why the others do not.
    fn write_methods(&self, model: &Structure, text: &mut String) -> std::fmt::Result {
        let apply = self.0.methods.iter().filter(|(_, reason)| reason.is_none());
        let apply: Vec<&str> = apply.map(|(id, _)| *id).collect();
        let options = self.with_options(model);
        list(text, "  methods that apply: ", &apply)?;
        let also = options.iter().filter(|(_, reason)| reason.is_none());
        let also: Vec<&str> = also.map(|(label, _)| label.as_str()).collect();
        if !also.is_empty() {
            list(text, "  and with options: ", &also)?;
        }
        if let Some(smallest) = model.smallest.filter(|_| model.family.is_none()) {
            writeln!(
                text,
                "  collective methods from order 8 on go over {}",
                smallest.description()
            )?;
        }
        // what has the same reason stands together
        let mut refused: Vec<(&str, Vec<&str>)> = Vec::new();
        let plain = self.0.methods.iter().map(|(id, reason)| (*id, reason));
        let with_options = options.iter().map(|(label, reason)| (&**label, reason));
        for (name, reason) in plain.chain(with_options) {
            let Some(reason) = reason.as_deref().filter(|reason| *reason != NOT_BUILT) else {
                continue;
            };
            match refused.iter_mut().find(|(known, _)| *known == reason) {
                Some((_, names)) => names.push(name),
                None => refused.push((reason, vec![name])),
            }
        }
        for (reason, names) in refused {
            sentence(text, &format!("    not {}: {reason}", names.join(", ")))?;
        }
        Ok(())
    }

    /// The methods with options other than their defaults, and why they do not apply.
    fn with_options(&self, model: &Structure) -> Vec<(String, Option<String>)> {
        let mut options = Vec::new();
        for (id, default) in &self.0.methods {
            let Ok(choice) = Choice::from_id(id) else {
                continue;
            };
            for choice in choice.variants().into_iter().skip(1) {
                let reason = refusal(model, &choice).map(|(why, _)| why);
                // what is refused without options for the same reason is said already
                if reason.is_none() || reason != *default {
                    options.push((choice.label(), reason));
                }
            }
        }
        options
    }
}

/// How large a family is.
fn write_family(model: &Structure, sizes: [usize; AXES], text: &mut String) -> std::fmt::Result {
    let sites = count(sizes);
    let lattice = match shown(&sizes) {
        [columns] => format!("a chain of {columns}"),
        axes => format!("a lattice of {}", by(axes)),
    };
    let (dimension, rank, _) = model.counts();
    let of_all = |of_site: usize| sites.saturating_mul(of_site);
    let (dimension, rank) = (of_all(dimension), of_all(rank));
    let corank = of_all(model.casimirs_to_find());
    writeln!(
        text,
        "  {lattice} sites: dimension {dimension}, generic rank {rank}, {corank} independent Casimirs"
    )?;
    for data in model.family.iter().flat_map(|family| &family.data) {
        if data.name == BONDS {
            writeln!(text, "  bonds: {}", data.values.len() / 3)?;
            continue;
        }
        let values = counted(data.values.len() as u64, "value");
        let [least, most] = data.range();
        writeln!(
            text,
            "  {}: {values} from {least} to {most}, one for each site",
            data.name
        )?;
    }
    Ok(())
}

/// What the system is: its rank, its functions, its Casimirs.
fn write_system(model: &Structure, text: &mut String) -> std::fmt::Result {
    let (dimension, generic_rank, initial_rank) = model.counts();
    if let Some(sizes) = sites(model) {
        write_family(model, sizes, text)?;
    }
    write!(text, "  dimension {dimension}, generic rank {generic_rank}")?;
    match initial_rank {
        _ if model.family.is_some() => writeln!(text, " of a site")?,
        Some(rank) => writeln!(text, ", rank {rank} at the initial state")?,
        None => writeln!(text, ", no initial state")?,
    }
    if let Some(rank) = initial_rank.filter(|rank| *rank < generic_rank) {
        writeln!(
            text,
            "  warning: the initial state lies on a singular leaf, of dimension {rank}: the motion stays there, \
             and the Casimirs alone do not determine the leaf"
        )?;
    }
    if let Some(report) = &model.algebra {
        structure::write(report, text)?;
    }
    if let Some(configuration) = &model.configuration {
        writeln!(text, "  {}", configuration.description())?;
    }
    constraint::write(model, text)?;
    if let Some(cocycle) = model.cocycle_in_words() {
        writeln!(text, "  cocycle: {cocycle}")?;
    }
    if let Some(class) = bracket_class::class(model) {
        writeln!(text, "  bracket: {}", class.describe(model))?;
    }
    let shared = model.family.iter().flat_map(|family| &family.shared);
    let shared: Vec<&str> = shared.map(String::as_str).collect();
    if !shared.is_empty() {
        writeln!(text, "  beside the sites: {}", shared.join(", "))?;
    }
    if let Some(retraction) = &model.retraction {
        let ends = match retraction.second {
            None => "tau(x) = map",
            Some(_) => "tau(x) = second^-1 map",
        };
        writeln!(
            text,
            "  retraction: {ends}, for `lie-midpoint --retraction spec` and its compositions"
        )?;
    }
    if let Some(attitude) = model.display_attitude() {
        writeln!(text, "  attitude at the start: {attitude}")?;
    }
    if let Some(lagrangian) = model.energy.lagrangian() {
        if let Some(discrete) = &lagrangian.discrete {
            writeln!(text, "  l_d = {}", model.display(discrete.shown()))?;
        }
        let name = if lagrangian.reduced { "l" } else { "L" };
        writeln!(text, "  {name} = {}", model.display(lagrangian.value))?;
    }
    match (&model.family, model.energy.expression()) {
        (Some(family), _) => writeln!(text, "  H = {}", model.display_of_family(family))?,
        (None, Some(hamiltonian)) => writeln!(text, "  H = {}", model.display(hamiltonian.energy))?,
        (None, None) => writeln!(
            text,
            "  H = Legendre transform of the Lagrangian, solved by Newton's iteration"
        )?,
    }
    for (what, formula) in model.acting() {
        writeln!(text, "  {what}: {formula}")?;
    }
    for sentence in model.what_dissipation_does() {
        writeln!(text, "    {sentence}")?;
    }
    casimirs::write(model, text)?;
    recorded::write(model, text)
}

/// The reason of methods whose names are only kept.
const NOT_BUILT: &str = "not built yet";

/// A title and what it lists, in lines of at most 100 characters.
fn list(text: &mut String, title: &str, items: &[&str]) -> std::fmt::Result {
    let mut width = title.len();
    write!(text, "{title}")?;
    for (index, item) in items.iter().enumerate() {
        let comma = if index + 1 < items.len() { "," } else { "" };
        let space = if index > 0 { " " } else { "" };
        if index > 0 && width + space.len() + item.len() + comma.len() > 100 {
            write!(text, "\n    {item}{comma}")?;
            width = 4 + item.len() + comma.len();
        } else {
            write!(text, "{space}{item}{comma}")?;
            width += space.len() + item.len() + comma.len();
        }
    }
    writeln!(text)
}

/// A sentence in lines of at most 100 characters; what follows the first is indented further.
fn sentence(text: &mut String, sentence: &str) -> std::fmt::Result {
    let indent = sentence.len() - sentence.trim_start().len();
    let mut line = " ".repeat(indent);
    for (index, word) in sentence.split_whitespace().enumerate() {
        if index > 0 && line.chars().count() + 1 + word.chars().count() > 100 {
            writeln!(text, "{line}")?;
            line = " ".repeat(indent + 4);
        } else if index > 0 {
            line.push(' ');
        }
        line.push_str(word);
    }
    writeln!(text, "{line}")
}
