//! What acts beside the Hamiltonian: forces and dissipation, in the form that both front ends hand on.

use super::entries::Line;
use super::vectors::Value;
use super::{Names, expression, families, item};
use crate::ast::{Dissipation, DissipationKind, Expr, Metric, Name, Noise};
use crate::diagnostic::{Diagnostic, Kind, Origin, Report};
use crate::suggest::meant;

/// The forces by coordinate, in the order of the state; a vector of coordinates stands for them.
pub fn forces(
    lines: &[(Name, Line<'_>)],
    (state, indices): (&[Name], &[Name]),
    names: &Names,
    report: &mut Report,
) -> Vec<(Name, Expr)> {
    let mut forces: Vec<(Name, Expr)> = Vec::new();
    for (name, line) in lines {
        let Some(value) = value(line, names, report) else {
            continue;
        };
        let Some(parts) = parts(name, value, (state, indices), names, report) else {
            continue;
        };
        for (coordinate, value) in parts {
            if forces.iter().any(|(known, _)| known.text == coordinate) {
                let message = format!("the force on `{coordinate}` stands twice");
                let mistake = Diagnostic::new(Kind::DuplicateName, name.origin, message);
                report.push(mistake.help("write their sum once"));
                continue;
            }
            let origin = name.origin;
            let text = coordinate;
            forces.push((Name { text, origin }, value));
        }
    }
    forces.sort_by_key(|(name, _)| state.iter().position(|known| known.text == name.text));
    forces
}

/// The coordinates that a force is given for, each with its own.
fn parts(
    name: &Name,
    value: Value,
    (state, indices): (&[Name], &[Name]),
    names: &Names,
    report: &mut Report,
) -> Option<Vec<(String, Expr)>> {
    let written: Vec<String> = state
        .iter()
        .map(|name| families::written(name, indices))
        .collect();
    let place = |text: &str| written.iter().position(|known| known == text);
    let mut mistake = |message: String, help: String| {
        report.push(Diagnostic::new(Kind::UnknownSymbol, name.origin, message).help(help));
        None
    };
    if let Some(place) = place(&name.text) {
        return match value {
            Value::Scalar(value) => Some(vec![(state[place].text.clone(), value)]),
            _ => mistake(
                format!("the force on the coordinate `{}` is a vector", name.text),
                "write a number for it, or name a vector of coordinates".into(),
            ),
        };
    }
    let of_site = families::written(
        &Name {
            text: String::new(),
            ..name.clone()
        },
        indices,
    );
    let vector = name.text.strip_suffix(&of_site);
    let coordinates = vector.and_then(|vector| names.vectors().coordinates(vector));
    let declared = |text: &&str| state.iter().any(|known| known.text == **text);
    let coordinates = coordinates.filter(|all| all.iter().all(declared));
    let Some(coordinates) = coordinates else {
        let known = written.iter().map(String::as_str);
        let bare = state.iter().position(|known| known.text == name.text);
        let near = bare.map(|place| written[place].as_str());
        let help = match near.or_else(|| meant(&name.text, known.clone())) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!(
                "a force is given for one of {}, or for a vector whose entries are coordinates",
                known.collect::<Vec<_>>().join(", ")
            ),
        };
        return mistake(
            format!("`{}` is no coordinate of the state", name.text),
            help,
        );
    };
    match value {
        Value::Vector(values) if values.len() == coordinates.len() => {
            let coordinates = coordinates.into_iter().map(str::to_owned);
            Some(coordinates.zip(values).collect())
        }
        _ => mistake(
            format!(
                "`{}` has {} entries, and the force on it has another shape",
                name.text,
                coordinates.len()
            ),
            "write a vector with as many entries".into(),
        ),
    }
}

fn value(line: &Line<'_>, names: &Names, report: &mut Report) -> Option<Value> {
    if line.tokens.is_empty() {
        // the message of what is missing
        item::formula(&[], ("a force", "-k*m1"), line.place, names, report);
        return None;
    }
    expression::parse_value(&line.tokens, names, report)
}

/// A noise as it was written: along a Hamiltonian, or a force.
pub enum Noisy<'a> {
    /// The Hamiltonian.
    Hamiltonian(Line<'a>),
    /// What is given for coordinates, and where it is said.
    Force(Vec<(Name, Line<'a>)>, Origin),
}

impl Noisy<'_> {
    /// What it declares; `None` where an expression is wrong, which is reported.
    pub fn noise(
        &self,
        state: (&[Name], &[Name]),
        names: &Names,
        report: &mut Report,
    ) -> Option<Noise> {
        match self {
            Self::Hamiltonian(line) => {
                let what = ("the Hamiltonian of a noise", "sigma*x");
                let value = item::formula(&line.tokens, what, line.place, names, report)?;
                Some(Noise::Hamiltonian(value))
            }
            Self::Force(lines, origin) if lines.is_empty() => {
                let help = "name the coordinates that it moves, as in `{\"force\": {\"m1\": \"s\"}}` or `force(m1 = s);`";
                let message = "a noise without a force";
                report.push(Diagnostic::new(Kind::Schema, *origin, message).help(help));
                None
            }
            Self::Force(lines, _) => {
                let parts = forces(lines, state, names, report);
                (!parts.is_empty()).then_some(Noise::Force(parts))
            }
        }
    }
}

/// A dissipation as it was written.
pub struct Entry {
    /// Its kind, as text, with its place.
    pub kind: Name,
    /// What is given for it.
    pub fields: Vec<(Name, Value)>,
}

/// The kinds, each with what has to be given and what may be.
const KINDS: [(&str, &[&str], &[&str]); 3] = [
    ("double-bracket", &["strength"], &["metric", "temperature"]),
    ("metriplectic", &["entropy"], &["metric", "factor"]),
    ("rayleigh", &["matrix"], &["temperature"]),
];

impl Entry {
    /// What it declares.
    ///
    /// # Errors
    /// An unknown kind, and what is missing, superfluous or of another shape.
    pub fn kind(self, form: Kind) -> Result<Dissipation, Box<Diagnostic>> {
        let (kind, origin) = (self.kind.text.as_str(), self.kind.origin);
        let Some((_, needed, optional)) = KINDS.iter().find(|(known, ..)| *known == kind) else {
            let known = KINDS.map(|(known, ..)| known);
            let help = match meant(kind, known) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("the kinds are {}", known.join(", ")),
            };
            let message = format!("unknown kind of dissipation `{kind}`");
            return Err(Diagnostic::new(form, origin, message).help(help).into());
        };
        let known: Vec<&str> = needed.iter().chain(optional.iter()).copied().collect();
        let mut fields = self.fields.iter();
        if let Some((field, _)) = fields.find(|(field, _)| !known.contains(&field.text.as_str())) {
            let message = format!("`{kind}` has no `{}`", field.text);
            let help = format!("it takes {}", known.join(", "));
            return Err(Diagnostic::new(form, field.origin, message)
                .help(help)
                .into());
        }
        let absent = |name: &str| {
            let message = format!("`{kind}` has no `{name}`");
            Diagnostic::new(form, origin, message).help(format!("add `{name}`"))
        };
        if let Some(missing) = known.first().filter(|name| self.given(name).is_none()) {
            return Err(absent(missing).into());
        }
        let kind = match kind {
            "double-bracket" => DissipationKind::DoubleBracket {
                strength: self.scalar("strength", form)?,
                metric: self.matrix("metric", form)?,
            },
            "metriplectic" => {
                let metric = self.matrix("metric", form)?;
                let metric = match (metric, self.matrix("factor", form)?) {
                    (Some(rows), None) => Metric::Entries(rows),
                    (None, Some(rows)) => Metric::Factor(rows),
                    _ => {
                        let message = "`metriplectic` takes one of `metric` and `factor`";
                        let help = "give the metric K, or a factor L of it: K = L L^T";
                        return Err(Diagnostic::new(form, origin, message).help(help).into());
                    }
                };
                DissipationKind::Metriplectic {
                    entropy: self.scalar("entropy", form)?,
                    metric,
                }
            }
            _ => DissipationKind::Rayleigh {
                matrix: self
                    .matrix("matrix", form)?
                    .ok_or_else(|| absent("matrix"))?,
            },
        };
        let temperature = self
            .given("temperature")
            .map(|_| self.scalar("temperature", form));
        Ok(Dissipation {
            kind,
            origin,
            temperature: temperature.transpose()?,
        })
    }

    fn given(&self, name: &str) -> Option<&(Name, Value)> {
        self.fields.iter().find(|(field, _)| field.text == name)
    }

    fn scalar(&self, name: &str, form: Kind) -> Result<Expr, Box<Diagnostic>> {
        match self.given(name) {
            Some((_, Value::Scalar(scalar))) => Ok(scalar.clone()),
            other => {
                let place = other.map_or(self.kind.origin, |(field, _)| field.origin);
                let message = format!("`{name}` is one number or expression");
                let help = format!("write an expression for `{name}`");
                Err(Diagnostic::new(form, place, message).help(help).into())
            }
        }
    }

    fn matrix(&self, name: &str, form: Kind) -> Result<Option<Vec<Vec<Expr>>>, Box<Diagnostic>> {
        match self.given(name) {
            None => Ok(None),
            Some((_, Value::Matrix(rows))) => Ok(Some(rows.clone())),
            Some((field, _)) => {
                let message = format!("`{name}` is a matrix");
                let help = "write its rows, as in `[[1, 0], [0, 2]]`, or name one of `vectors`";
                Err(Diagnostic::new(form, field.origin, message)
                    .help(help)
                    .into())
            }
        }
    }
}
