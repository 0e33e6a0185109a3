//! Requests and their answers.

use lie_codegen::compile::compile_spec;
use lie_codegen::methods::{Choice, applicability, refusal};
use lie_codegen::plan::plan;
use lie_codegen::structure::Structure;
use lie_dynamic::{Dynamic, Engine as _};
use lie_methods::at_defaults;
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin};
use lie_syntax::front::line_column;
use serde_json::{Value, json};

use crate::run::Run;

#[cfg(target_arch = "wasm32")]
use crate::linked::Linking as Running;
#[cfg(not(target_arch = "wasm32"))]
use lie_dynamic::Interpreted as Running;

/// Steps of one request at most: a page stays alive between requests.
const MOST_STEPS: u64 = 100_000;

/// A page's run, if there is one.
#[derive(Default)]
pub struct Session {
    run: Option<Run>,
}

impl Session {
    /// Answers a request; a mistake in the request itself is answered by `{"error": "…"}`.
    pub fn answer(&mut self, request: &str) -> String {
        let answer = match serde_json::from_str::<Value>(request) {
            Err(error) => json!({ "error": error.to_string() }),
            Ok(request) if request["declaration"].is_string() => self.open(&request),
            Ok(request) if request["steps"].is_u64() => self.advance(&request),
            Ok(_) => json!({ "error": "a request holds `declaration` or `steps`" }),
        };
        answer.to_string()
    }

    fn open(&mut self, request: &Value) -> Value {
        self.run = None;
        let text = request["declaration"].as_str().unwrap_or_default();
        match opened(text, request) {
            Ok((run, about)) => {
                self.run = Some(run);
                about
            }
            Err(diagnostics) => {
                json!({ "diagnostics": diagnostics.iter().map(|d| shown(d, text)).collect::<Vec<_>>() })
            }
        }
    }

    fn advance(&mut self, request: &Value) -> Value {
        let Some(run) = &mut self.run else {
            return json!({ "error": "no declaration was given before" });
        };
        let steps = request["steps"].as_u64().unwrap_or(1).min(MOST_STEPS);
        let every = request["every"].as_u64().unwrap_or(1).max(1);
        for (name, value) in request["inputs"].as_object().into_iter().flatten() {
            let value = value.as_f64().filter(|value| value.is_finite());
            let set = match value {
                Some(value) => run.set_input(name, value),
                None => Err(format!("the input `{name}` is not a number")),
            };
            if let Err(error) = set {
                return json!({ "error": error });
            }
        }
        run.advance(steps, every)
    }
}

/// A diagnostic without a place.
fn refused(kind: Kind, message: String, help: String) -> Vec<Diagnostic> {
    let mut diagnostic =
        Diagnostic::new(kind, Origin::Text { start: 0, end: 0 }, message).help(help);
    diagnostic.origin = None;
    vec![diagnostic]
}

fn opened(text: &str, request: &Value) -> Result<(Run, Value), Vec<Diagnostic>> {
    let model = compile_spec(text)?;
    let asked = request["method"].as_str().filter(|id| !id.is_empty());
    let choice = Choice::from_id(asked.unwrap_or("midpoint"));
    let choice =
        choice.map_err(|unusable| refused(Kind::Method, unusable.message, unusable.help))?;
    if let Some((reason, help)) = refusal(&model, &choice) {
        return Err(refused(
            Kind::Method,
            format!("{} does not apply: {reason}", choice.label()),
            help,
        ));
    }
    let step = request["step"]
        .as_f64()
        .filter(|step| step.is_finite() && *step != 0.0);
    let step = step.ok_or_else(|| {
        refused(
            Kind::Option,
            "the step is not a number other than zero".to_owned(),
            "write one, such as 0.01".to_owned(),
        )
    })?;
    let planned = plan(&model, std::slice::from_ref(&choice));
    if !Dynamic::supports(&planned) {
        let text = "functions of Rust do not run in a page";
        return Err(refused(
            Kind::Method,
            text.to_owned(),
            "use the command `lie run`".to_owned(),
        ));
    }
    let method = at_defaults(&choice);
    let engine: Running = Default::default();
    let system = Dynamic::new(planned, &[], &engine).map_err(|error| {
        refused(
            Kind::Domain,
            error.to_string(),
            "change the parameter's default".to_owned(),
        )
    })?;
    let mu = system.initial_state().ok_or_else(|| {
        refused(
            Kind::Option,
            "there is no initial state".to_owned(),
            "add `\"initial\": [1, 0, 0]`".to_owned(),
        )
    })?;
    let mut about = about(&model, &choice, engine.name());
    let seed = request["seed"].as_u64().unwrap_or(1);
    let run = Run::new(system, method, (step, seed), mu);
    if let (Some(about), Value::Object(more)) = (about.as_object_mut(), run.about()) {
        about.extend(more);
    }
    Ok((run, about))
}

/// What a page shows of a system.
fn about(model: &Structure, choice: &Choice, engine: &str) -> Value {
    let methods = applicability(model)
        .into_iter()
        .filter(|(_, reason)| reason.is_none());
    let methods: Vec<&str> = methods
        .map(|(id, _)| id)
        .filter(|id| !id.starts_with("compose"))
        .collect();
    let plan = plan(model, &[]);
    let lines = plan
        .system
        .poisson
        .iter()
        .flat_map(|kernel| kernel.explicit.iter());
    let equations: Vec<&String> = lines
        .filter(|line| line.contains("' =") || line.starts_with("H ="))
        .collect();
    json!({
        "name": model.name,
        "method": choice.label(),
        "engine": engine,
        "rank": model.counts().1,
        "rotates": rotates(model),
        "methods": methods,
        "equations": equations,
    })
}

/// Whether the first three coordinates are the angular momentum of a body: those of so(3), with brackets `[e1, e2] = e3` and
/// cyclic; grad H is its angular velocity in the body then.
fn rotates(model: &Structure) -> bool {
    let Some(algebra) = model.bracket.algebra() else {
        return false;
    };
    let of = |i: usize, j: usize| -> Vec<(usize, String)> {
        let entries = algebra.constants.upper(i, j).iter();
        entries
            .map(|(.., k, value)| (*k, model.display(*value)))
            .collect()
    };
    algebra.basis.len() >= 3
        && of(0, 1) == [(2, "1".to_owned())]
        && of(1, 2) == [(0, "1".to_owned())]
        && of(0, 2) == [(1, "-1".to_owned())]
}

fn shown(diagnostic: &Diagnostic, text: &str) -> Value {
    let place = match diagnostic.origin {
        Some(Origin::Text { start, .. }) => Some(line_column(text, start)),
        _ => None,
    };
    json!({
        "line": place.map(|(line, _)| line),
        "column": place.map(|(_, column)| column),
        "kind": diagnostic.kind.to_string(),
        "message": diagnostic.message,
        "help": diagnostic.help,
        "warning": diagnostic.warning,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const TOP: &str = include_str!("../../../specs/se3_heavy_top.json");

    fn asked(session: &mut Session, request: &Value) -> Value {
        serde_json::from_str(&session.answer(&request.to_string())).expect("JSON")
    }

    fn open(session: &mut Session, declaration: &str, method: &str, step: f64) -> Value {
        asked(
            session,
            &json!({ "declaration": declaration, "method": method, "step": step }),
        )
    }

    #[test]
    fn the_heavy_top_runs() {
        let mut session = Session::default();
        let about = open(&mut session, TOP, "lie-midpoint", 0.01);
        assert_eq!(about["name"], "HeavyTop");
        assert_eq!(about["engine"], "interpreter");
        assert_eq!(about["rotates"], true);
        assert_eq!(
            about["invariants"],
            json!(["energy", "length2", "vertical_momentum"])
        );
        assert!(
            about["methods"]
                .as_array()
                .expect("a list")
                .contains(&json!("gauss4"))
        );
        let first = asked(&mut session, &json!({ "steps": 500, "every": 50 }));
        let second = asked(&mut session, &json!({ "steps": 500, "every": 50 }));
        let rows = |answer: &Value| answer["rows"].as_array().expect("rows").clone();
        assert_eq!(
            (rows(&first).len(), rows(&second).len()),
            (11, 10),
            "the start is a row once"
        );
        let energy = |row: &Value| row[7].as_f64().expect("a number");
        let (start, end) = (energy(&rows(&first)[0]), energy(&rows(&second)[9]));
        assert!(
            (end / start - 1.0).abs() < 1e-5 && end != start,
            "{start} {end}"
        );
        assert_eq!(rows(&second)[9][0], 10.0);
        assert_eq!(second["stopped"], Value::Null);
    }

    /// In two requests as in one: the same bits but for the solver's start, which is far below the step's error.
    #[test]
    fn requests_go_on() {
        let end = |steps: &[u64]| -> Vec<f64> {
            let mut session = Session::default();
            open(&mut session, TOP, "rk4", 0.01);
            let answers = steps
                .iter()
                .map(|steps| asked(&mut session, &json!({ "steps": steps, "every": steps })));
            let last = answers.last().expect("an answer");
            let rows = last["rows"].as_array().expect("rows").clone();
            serde_json::from_value(rows[rows.len() - 1].clone()).expect("numbers")
        };
        assert_eq!(end(&[100])[1..], end(&[50, 50])[1..]);
    }

    #[test]
    fn a_wrong_sign_is_shown_at_its_place() {
        let mut session = Session::default();
        let wrong = TOP.replace("[J3, J1] = J2", "[J3, J1] = P2");
        let answer = open(&mut session, &wrong, "lie-midpoint", 0.01);
        let first = &answer["diagnostics"][0];
        assert_eq!(first["kind"], "jacobi", "{answer}");
        assert!(first["help"].is_string());
        let typo = TOP.replace("mgl*(c1*g1", "mgl*(c1*q1");
        let answer = open(&mut session, &typo, "lie-midpoint", 0.01);
        let line = TOP
            .lines()
            .position(|line| line.contains("\"hamiltonian\""))
            .expect("it is there")
            + 1;
        assert_eq!(answer["diagnostics"][0]["line"], line, "{answer}");
        assert_eq!(
            asked(&mut session, &json!({ "steps": 1 }))["error"],
            "no declaration was given before"
        );
    }

    #[test]
    fn what_cannot_run_says_why() {
        let mut session = Session::default();
        for (method, step, says) in [
            ("gauss5", 0.1, "gauss5"),
            ("moser-veselov", 0.1, "does not apply"),
            ("rk4", 0.0, "step"),
        ] {
            let answer = open(&mut session, TOP, method, step);
            let message = answer["diagnostics"][0]["message"]
                .as_str()
                .expect("a message");
            assert!(message.contains(says), "{message}");
        }
        assert!(session.answer("{").contains("error"));
        assert!(session.answer("{}").contains("declaration"));
    }

    /// A step that fails ends the run where it is, and says what to do.
    #[test]
    fn a_failed_step_is_told() {
        let mut session = Session::default();
        let wild = r#"{ "format": 1, "name": "Wild", "algebra": "so(3)", "state": ["x", "y", "z"],
            "hamiltonian": "x*y*z^3 + x^4", "initial": [3, 2, 4] }"#;
        let about = open(&mut session, wild, "gauss4", 5.0);
        assert_eq!(about["rank"], 2, "{about}");
        let answer = asked(&mut session, &json!({ "steps": 50 }));
        assert!(
            answer["stopped"]
                .as_str()
                .is_some_and(|text| text.contains("failed")),
            "{answer}"
        );
    }
}
