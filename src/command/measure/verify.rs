//! `lie verify`: claimed against measured.

use std::collections::BTreeMap;

use lie_codegen::diagnostic::Kind;
use lie_codegen::judge::Judge;
use lie_codegen::program::Purpose;
use serde_json::{Map, Value, json};

use super::evidence::Evidence;
use super::table::{self, short};
use super::{Ended, bed, interrupted, list};
use crate::command::run::values::Given;
use crate::command::{args, print};
use crate::interrupt::Interrupt;
use crate::message::{Failure, Message};

/// The facts that are measured at the step itself: an order takes many steps, the iteration others of its own.
const SINGLE: [&str; 7] = [
    "symmetric",
    "energy",
    "quadratic Casimirs",
    "other Casimirs",
    "quadratic integrals",
    "orbit",
    "Poisson",
];

/// One line of results.
struct Finding {
    method: String,
    fact: String,
    claim: f64,
    measured: f64,
    bound: f64,
    verdict: String,
    note: String,
    /// Not a number where nothing was measured.
    step: f64,
}

impl Finding {
    fn read(fields: &[&str]) -> Option<Self> {
        let number = |index: usize| fields.get(index)?.parse::<f64>().ok();
        Some(Self {
            method: (*fields.get(1)?).to_owned(),
            fact: (*fields.get(2)?).to_owned(),
            claim: number(3)?,
            measured: number(4)?,
            bound: number(5)?,
            verdict: (*fields.get(6)?).to_owned(),
            note: (*fields.get(7)?).to_owned(),
            step: number(8).unwrap_or(f64::NAN),
        })
    }

    fn fails(&self) -> bool {
        self.verdict == "fails"
    }

    /// `fact: measured where at most bound is allowed`.
    fn failure(&self) -> String {
        let allowed = if self.claim == 0.0 {
            format!("at most {}", short(self.bound))
        } else {
            format!("at least {}", short(self.bound))
        };
        let mut text = format!(
            "{}: {} is claimed, {} was measured, where {allowed} holds",
            self.method,
            self.fact,
            short(self.measured)
        );
        if self.step.is_finite() {
            text.push_str(&format!(" with a step of {}", short(self.step)));
        }
        if !self.note.is_empty() {
            text.push_str(&format!(" ({})", self.note));
        }
        text
    }

    /// What the table shows.
    fn cell(&self) -> String {
        match self.verdict.as_str() {
            "absent" => "–".to_owned(),
            "holds" => format!("{} ✓", short(self.measured)),
            "fails" => format!("{} ✗", short(self.measured)),
            _ => short(self.measured),
        }
    }

    fn as_json(&self) -> Value {
        let number = |value: f64| {
            if value.is_finite() {
                json!(value)
            } else {
                Value::Null
            }
        };
        json!({
            "claim": number(self.claim), "measured": number(self.measured),
            "bound": number(self.bound), "verdict": self.verdict, "note": self.note,
            "step": number(self.step),
        })
    }
}

/// Verifies methods on a spec.
///
/// # Errors
/// Invalid input, or surroundings that fail.
pub fn run(arguments: &args::Verify) -> Result<u8, Failure> {
    let flags = &arguments.measured;
    let step = match &arguments.step {
        None => None,
        Some(text) => {
            let given = Given::flag("--step", text);
            let value = given.number()?;
            if value == 0.0 {
                let message = given.wrong("a step of zero measures nothing");
                return Err(message
                    .help("leave it out, or give a step such as 0.1")
                    .into());
            }
            Some(value)
        }
    };
    let bed = bed(flags, |spec| list::all(&spec.model))?;
    let interrupt = Interrupt::install();
    let program = bed.program(flags, Purpose::Verify, &interrupt)?;
    let mut numbers = vec![("seed", f64::from(arguments.seed))];
    numbers.extend(step.map(|step| ("step", step)));
    let mut findings = Vec::new();
    let mut ground = Vec::new();
    let judge = Judge::of_spec(&bed.spec.source.text, &bed.spec.model, &bed.parameters);
    let mut evidence = Evidence::before(judge, bed.spec.model.is_lie_poisson());
    let ended = bed.measure(
        flags,
        program,
        &numbers,
        &interrupt,
        &mut |fields| match fields.first() {
            Some(&"finding") => findings.extend(Finding::read(fields)),
            Some(&"ground") => ground = fields[1..].iter().map(|f| (*f).to_owned()).collect(),
            _ => evidence.take(fields),
        },
    )?;
    if let Ended::Said(word, text) = &ended {
        let what = if word == "ground" {
            format!("nothing can be measured on {}: {text}", bed.spec.model.name)
        } else {
            format!("{word} {text}")
        };
        let message = Message::new(Kind::Domain, what).at_option("--initial");
        return Err(message
            .help("give another initial state with `--initial`, or a smaller `--step`")
            .into());
    }
    if arguments.json {
        print(&format!(
            "{:#}\n",
            as_json(&bed.spec.model.name, &ground, &findings, &evidence)
        ))?;
    } else {
        print(&report(&bed.spec.model.name, &ground, &findings, &evidence))?;
    }
    if let Ended::Interrupted(code) = ended {
        return Ok(interrupted(flags, code));
    }
    let failed: Vec<&Finding> = findings.iter().filter(|finding| finding.fails()).collect();
    for finding in &failed {
        eprintln!("failed: {}", finding.failure());
    }
    for failure in evidence.failures() {
        eprintln!("failed: {failure}");
    }
    Ok(u8::from(!failed.is_empty() || !evidence.holds()))
}

fn facts(findings: &[Finding]) -> Vec<&str> {
    let mut facts: Vec<&str> = Vec::new();
    for finding in findings {
        if !facts.contains(&finding.fact.as_str()) {
            facts.push(&finding.fact);
        }
    }
    facts
}

fn methods(findings: &[Finding]) -> Vec<&str> {
    let mut methods: Vec<&str> = findings.iter().map(|f| f.method.as_str()).collect();
    methods.dedup();
    methods
}

/// The steps at which a method's invariants were measured: where the one asked for failed, smaller ones.
fn steps(findings: &[Finding], method: &str) -> String {
    let own = findings
        .iter()
        .filter(|finding| finding.method == method && SINGLE.contains(&finding.fact.as_str()))
        .map(|finding| finding.step.abs());
    let (least, most) = own
        .filter(|step| step.is_finite())
        .fold((f64::INFINITY, 0.0_f64), |(least, most), step| {
            (least.min(step), most.max(step))
        });
    if most == 0.0 {
        "–".to_owned()
    } else if least == most {
        short(most)
    } else {
        format!("{} to {}", short(least), short(most))
    }
}

fn report(system: &str, ground: &[String], findings: &[Finding], evidence: &Evidence) -> String {
    // what holds of the form and not of the method is summed up below the table
    let (folded, facts): (Vec<&str>, Vec<&str>) = facts(findings)
        .into_iter()
        .partition(|fact| OF_THE_FORM.contains(fact) && all_hold(findings, fact));
    let by_place: BTreeMap<(&str, &str), &Finding> = findings
        .iter()
        .map(|finding| ((finding.method.as_str(), finding.fact.as_str()), finding))
        .collect();
    let mut rows = vec![
        ["method", "step"]
            .into_iter()
            .chain(facts.iter().copied())
            .map(str::to_owned)
            .collect::<Vec<_>>(),
    ];
    for method in methods(findings) {
        let cell = |fact: &&str| match by_place.get(&(method, *fact)) {
            Some(finding) => match (finding.fact.as_str(), finding.claim) {
                ("order", claim) => format!("{claim}: {}", finding.cell()),
                _ => finding.cell(),
            },
            None => "–".to_owned(),
        };
        rows.push(
            [method.to_owned(), steps(findings, method)]
                .into_iter()
                .chain(facts.iter().map(cell))
                .collect(),
        );
    }
    let claimed = findings
        .iter()
        .filter(|f| matches!(f.verdict.as_str(), "holds" | "fails"));
    let failed = findings.iter().filter(|finding| finding.fails()).count();
    let number = |index: usize| {
        let value = ground.get(index).and_then(|text| text.parse().ok());
        short(value.unwrap_or(f64::NAN))
    };
    format!(
        "{system}: {} methods, step {}, {} states, {} linear and {} quadratic first integrals, reference to {}\n\n{}\n\
         ✓ claimed and measured, ✗ claimed and not measured, no sign: not claimed; relative to the size of the terms\n\
         {}{}{} claims, {failed} fail\n",
        methods(findings).len(),
        number(0),
        ground.get(3).map_or("", String::as_str),
        ground.get(4).map_or("", String::as_str),
        ground.get(5).map_or("", String::as_str),
        number(2),
        table::text(&rows),
        summary(findings, &folded),
        evidence.summary(),
        claimed.count(),
    )
}

/// Facts that no method claims of itself: two forms of its code agree, the driver shows its steps.
const OF_THE_FORM: [&str; 5] = [
    "generic form",
    "row exchanges",
    "failed steps",
    "rows",
    "group",
];

fn all_hold(findings: &[Finding], fact: &str) -> bool {
    let of_fact = findings.iter().filter(|finding| finding.fact == fact);
    of_fact.into_iter().all(|finding| !finding.fails())
}

/// One line on the facts that hold everywhere.
fn summary(findings: &[Finding], folded: &[&str]) -> String {
    let parts: Vec<String> = folded
        .iter()
        .map(|fact| {
            let holds = |f: &&Finding| f.fact == *fact && f.verdict == "holds";
            let count = findings.iter().filter(holds).count();
            let what = match *fact {
                "generic form" => "the generic form makes the same steps",
                "row exchanges" => "elimination in fixed order",
                "failed steps" => "a failed step leaves the state",
                "rows" => "rows on and off the grid",
                _ => "group element",
            };
            format!("{what} ({count})")
        })
        .collect();
    match parts.is_empty() {
        true => String::new(),
        false => format!("also hold, of so many methods: {}\n", parts.join(", ")),
    }
}

fn as_json(system: &str, ground: &[String], findings: &[Finding], evidence: &Evidence) -> Value {
    let mut all = Map::new();
    for finding in findings {
        let method = all
            .entry(finding.method.clone())
            .or_insert_with(|| Value::Object(Map::new()));
        method[finding.fact.as_str()] = finding.as_json();
    }
    let number = |index: usize| {
        let value: Option<f64> = ground.get(index).and_then(|text| text.parse().ok());
        json!(value)
    };
    json!({
        "system": system,
        "step": number(0), "span": number(1), "reference_error": number(2),
        "states": number(3), "linear_integrals": number(4), "quadratic_integrals": number(5),
        "methods": all,
        "judge": evidence.as_json(),
        "failed": findings.iter().filter(|finding| finding.fails()).count(),
    })
}
