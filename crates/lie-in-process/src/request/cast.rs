//! The members of an ensemble: the initial states and parameters of several runs, or states drawn around them.

use lie_runtime::driver::{Density, Pace};

use super::density::not_in_ensembles;
use super::plan::{Planner, plan};
use super::several::{Sweep, points, sweeps};
use super::sites::bound_to_itself;
use super::states::states;
use super::{OptionValue, Plan, Request, Value};
use crate::declared;
use lie_syntax::diagnostic::Kind;

use crate::draw::{Draw, Drawn, Spread, keeps_norm};
use crate::ensemble::Cast;
use crate::message::{Fault, Message};
use crate::spec::Spec;

/// The standard deviation where none is given.
const SPREAD: f64 = 0.1;

/// What is asked for of members that are drawn.
#[derive(Clone, Copy, Debug, Default)]
pub struct Drawing<'a> {
    /// How many.
    pub members: Option<&'a Value>,
    /// Their seed.
    pub seed: Option<u64>,
    /// How far they go.
    pub spread: Option<&'a Value>,
}

/// An ensemble as it is asked for.
#[derive(Clone)]
pub struct Asked {
    /// How each member is run.
    pub plan: Plan,
    /// Who takes part.
    pub cast: Cast,
    /// Whether the ends alone are kept: where neither `every` nor `at` is asked for.
    pub ends: bool,
    /// The parameters with several values, the last one fastest.
    pub swept: Vec<(String, Vec<f64>)>,
}

/// The ensemble of a request: of all values of the parameters the members with its initial states, which come from the file, or
/// are drawn around the one that is given, or are that alone.
///
/// # Errors
/// Every mistake.
pub fn cast(spec: &Spec, request: &Request, drawing: Drawing<'_>) -> Result<Asked, Vec<Message>> {
    let front = request.front;
    if let [_, second, ..] = request.method.as_slice() {
        let given = OptionValue::flag(&front.option("method"), second);
        let message = given.wrong("an ensemble has one method");
        return Err(vec![message.help("make an ensemble for each method")]);
    }
    let (swept, fixed) = sweeps(request)?;
    let mut flags = Request {
        param: fixed,
        ..request.clone()
    };
    let file = flags.initial_file.take();
    let states = file.as_ref().map(|path| states(spec, path)).transpose();
    let states = states.map_err(|message| vec![message])?;
    let planned = plan(spec, &flags);
    let points = points(spec, &flags, &swept, states);
    let draw = draw(spec, request, drawing);
    let (plan, points, mut draw) = match (planned, points, draw) {
        (Ok(plan), Ok(points), Ok(draw)) => (plan, points, draw),
        (plan, points, draw) => {
            let found = plan.err().into_iter().chain(points.err()).chain(draw.err());
            return Err(found.flatten().collect());
        }
    };
    if plan.density != Density::Constant {
        return Err(vec![not_in_ensembles(front)]);
    }
    if let (Pace::Tolerance(_), Some(every)) = (plan.pace.0, &request.every) {
        let given = OptionValue::value(&front.option("every"), every);
        let message = given.wrong("with a tolerance each member has a step of its own");
        let example = front.assignment("at", "1,2,3");
        return Err(vec![message.help(format!("give times, such as {example}"))]);
    }
    let bound = points.iter().find_map(|(_, point)| {
        bound_to_itself(&spec.model, &plan.method, &point.parameters, front)
    });
    if let Some(message) = bound {
        return Err(vec![message]);
    }
    if let (Some(_), Some(asked)) = (&file, draw) {
        if asked.count != points.len() {
            return Err(vec![as_many(request, drawing, points.len())]);
        }
        draw = None;
    }
    if draw.is_none() && file.is_none() && swept.is_empty() {
        let option = front.option("members");
        let text = "nothing says how many members there are";
        let message = Message::option(&option, text).with_fault(Fault::Arguments);
        let example = front.assignment("members", "1000");
        return Err(vec![message.help(format!(
            "give {example} to draw initial states, a file of them, or a parameter with several values"
        ))]);
    }
    let drawn = draw.map(|draw| drawn(spec, draw)).transpose()?;
    let of_all = |values: &Vec<f64>| points.iter().all(|(_, point)| point.parameters == *values);
    let parameters = match points.first() {
        Some((_, first)) if of_all(&first.parameters) => vec![first.parameters.clone()],
        _ => points
            .iter()
            .map(|(_, point)| point.parameters.clone())
            .collect(),
    };
    let lacks = |drawn: &Drawn| {
        let mut values = parameters.iter();
        !values.all(|values| has_distribution(drawn, values))
    };
    if drawn.as_ref().is_some_and(lacks) {
        let given = drawing
            .spread
            .cloned()
            .unwrap_or(Value::Text(String::new()));
        let given = OptionValue::value(&front.option("spread"), &given);
        let message = given.wrong("the orbits have no uniform distribution in these coordinates: the group does not keep their Euclidean norm");
        let example = front.assignment("spread", "0.1");
        return Err(vec![
            message.help(format!("give a standard deviation, such as {example}")),
        ]);
    }
    Ok(Asked {
        ends: request.every.is_none() && request.at.is_none(),
        plan,
        cast: Cast {
            parameters,
            starts: points.into_iter().map(|(_, point)| point.initial).collect(),
            drawn,
        },
        swept: swept
            .into_iter()
            .map(|Sweep { name, values }| (name, values))
            .collect(),
    })
}

/// How states are drawn, if they are.
fn draw(
    spec: &Spec,
    request: &Request,
    drawing: Drawing<'_>,
) -> Result<Option<Draw>, Vec<Message>> {
    let front = request.front;
    let mut planner = Planner::new(spec, request);
    let Some(members) = drawing.members else {
        for (name, given) in [
            ("seed", drawing.seed.is_some()),
            ("spread", drawing.spread.is_some()),
        ] {
            if given && request.initial_file.is_none() {
                let text = "no initial states are drawn";
                let message = planner
                    .option_mistake(name, text)
                    .with_fault(Fault::Arguments);
                let example = front.assignment("members", "1000");
                planner
                    .mistakes
                    .push(message.help(format!("say how many, such as {example}")));
            }
        }
        return match planner.mistakes.is_empty() {
            true => Ok(None),
            false => Err(planner.mistakes),
        };
    };
    let members = OptionValue::value(&front.option("members"), members);
    let example = front.assignment("members", "1000");
    let many = |message: Message| message.help(format!("say how many, such as {example}"));
    let count = planner.keep(members.count().map_err(many));
    let spread = match drawing.spread {
        None => Some(Spread::Normal(SPREAD)),
        Some(Value::Text(text)) if text.trim() == "orbit" => Some(Spread::Orbit),
        Some(value) => {
            let given = OptionValue::value(&front.option("spread"), value);
            let number = given.number().map_err(|message| {
                message.help("give a standard deviation such as 0.1, or `orbit`")
            });
            let number = number.and_then(|number| match number >= 0.0 {
                true => Ok(Spread::Normal(number)),
                false => {
                    let message = given.wrong("a standard deviation is not negative");
                    Err(message.help("give a number such as 0.1, or `orbit`"))
                }
            });
            planner.keep(number)
        }
    };
    match (count, spread) {
        (Some(count), Some(spread)) => Ok(Some(Draw {
            count: count as usize,
            seed: drawing.seed.unwrap_or(1),
            spread,
        })),
        _ => Err(planner.mistakes),
    }
}

/// The number of members is said twice, differently.
fn as_many(request: &Request, drawing: Drawing<'_>, count: usize) -> Message {
    let front = request.front;
    let given = drawing
        .members
        .cloned()
        .unwrap_or(Value::Text(String::new()));
    let given = OptionValue::value(&front.option("members"), &given);
    let file = front.option("initial-file");
    let message = given.wrong(format!("with `{file}` there are {count} members, one for each initial state and value of a parameter"));
    message.help(format!("leave out `{}`", front.option("members")))
}

/// What draws them.
fn drawn(spec: &Spec, draw: Draw) -> Result<Drawn, Vec<Message>> {
    let declared = declared(&spec.model).ok_or_else(|| {
        let text = format!(
            "members of {} would need a program that cargo builds: H calls functions of Rust",
            spec.model.name
        );
        let message = Message::new(Kind::Method, text).at_option("SPEC");
        vec![message.help("run them by `lie run --initial-file`, which builds one")]
    })?;
    Ok(Drawn {
        draw,
        declared,
        orbits: spec.model.is_lie_poisson(),
    })
}

/// Whether orbits have the distribution that is asked for: a uniform one where the group keeps the norm.
fn has_distribution(drawn: &Drawn, parameters: &[f64]) -> bool {
    if drawn.draw.spread != Spread::Orbit {
        return true;
    }
    let system = drawn.declared.system(parameters);
    drawn.orbits && system.is_ok_and(|system| keeps_norm(&system))
}
