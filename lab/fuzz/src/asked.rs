//! What is asked of runs: requests, and files of initial states.

use std::path::Path;
use std::sync::{Arc, LazyLock};

use lie_codegen::compile::compile_spec;
use lie_in_process::message::{Message, Place, Source};
use lie_in_process::request::{
    Front, Parameter, Request, constant, plan, several, span, start, step_of_facts,
};
use lie_in_process::spec::Spec;

use crate::{file, folder, remedied};

/// Systems of which runs are asked: by a bracket, with parameters and Casimirs, by a Lagrangian, with a group, and a family.
const SPECS: [&str; 5] = [
    include_str!("../../../specs/canonical_pendulum.json"),
    include_str!("../../../specs/so3_free_rigid_body.json"),
    include_str!("../../../specs/so3_quartic_lagrangian.json"),
    include_str!("../../../specs/so3_cotangent_group.json"),
    FAMILY,
];

/// Two sites, the states of which are in a file.
const FAMILY: &str = r#"{
    "format": 1, "name": "Two", "algebra": "so(3)^2", "state": ["x[i]", "y[i]", "z[i]"],
    "hamiltonian": "sum(i in 0..2: x[i]*x[i+1] + z[i]^2)",
    "initial": { "npy": "state.npy" }
}"#;

/// More runs at once take time and memory, as they should.
const FEW: f64 = 100.0;

static SYSTEMS: LazyLock<Vec<Spec>> = LazyLock::new(|| {
    let spec = |text: &&str| {
        let source = Source {
            path: folder().join("spec.json").display().to_string(),
            text: (*text).to_owned(),
        };
        let model = compile_spec(text).expect("a spec that is right");
        Spec::new(Arc::new(source), model)
    };
    SPECS.iter().map(spec).collect()
});

/// A request as JSON, asked of every system from a command line and in a call. Whether it is one.
pub fn request(text: &str) -> bool {
    let Ok(mut request) = serde_json::from_str::<Request>(text) else {
        return false;
    };
    let written = serde_json::to_string(&request).expect("a request is JSON");
    assert_eq!(
        serde_json::from_str::<Request>(&written).ok(),
        Some(request.clone()),
        "it does not come back"
    );
    // files are other targets
    request.initial_file = None;
    for front in [Front::Command, Front::Call] {
        request.front = front;
        for spec in &*SYSTEMS {
            checked(plan(spec, &request));
            checked(start(spec, &request));
            checked(span(spec, &request).map_err(|message| vec![message]));
            checked(step_of_facts(spec, &request).map_err(|message| vec![message]));
            if runs(&request) <= FEW {
                checked(several(spec, &request));
            }
        }
    }
    true
}

/// So many runs are asked for by ranges of parameters.
fn runs(request: &Request) -> f64 {
    let count = |parameter: &Parameter| match parameter {
        Parameter::Written(text) => text
            .rsplit_once(':')
            .and_then(|(_, count)| constant(count).ok()),
        Parameter::Set(..) => None,
    };
    request.param.iter().filter_map(count).product()
}

/// A file of initial states, CSV or NPY.
pub fn initial_file(bytes: &[u8]) {
    states(&file("states", bytes));
}

/// An array of NumPy: the states of the sites of a family, and initial states.
pub fn npy(bytes: &[u8]) {
    let path = file("state.npy", bytes);
    let family = SYSTEMS.last().expect("the family");
    if let Some(point) = checked(start(family, &Request::default())) {
        assert_eq!(point.initial.len(), 6);
        assert!(point.initial.iter().all(|value| value.is_finite()));
    }
    states(&path);
}

fn states(path: &Path) {
    let request = Request {
        initial_file: Some(path.to_owned()),
        ..Request::default()
    };
    for (spec, width) in [(&SYSTEMS[1], 3), (&SYSTEMS[4], 6)] {
        let found = checked(several(spec, &request));
        for member in found.iter().flat_map(|found| &found.members) {
            assert_eq!(member.start.initial.len(), width);
            assert!(member.start.initial.iter().all(|value| value.is_finite()));
        }
    }
}

/// What was found; of mistakes, that they have remedies and that their places are inside of what was written.
fn checked<T>(found: Result<T, Vec<Message>>) -> Option<T> {
    let messages = match found {
        Ok(found) => return Some(found),
        Err(messages) => messages,
    };
    assert!(!messages.is_empty(), "refused without an error");
    for message in messages {
        remedied(&message.text, message.help.as_deref());
        let (text, range) = match &message.place {
            Place::Text(source, range) => (&source.text, range),
            Place::Argument {
                value: Some((text, range)),
                ..
            } => (text, range),
            _ => continue,
        };
        assert!(
            text.get(range.clone()).is_some(),
            "{range:?}: {}",
            message.text
        );
    }
    None
}
